"""Makes the levels in assets/levels/ anew, each with the fewest operations that a search finds.

    python docs/make_levels.py              all of them
    python docs/make_levels.py star two-*   only these

A level is a recipe: perfect meshes that random operations have spoilt, and shapes as the meshers
leave them. The start is drawn without a fold, and so is the end of the way that is kept. How few
operations will do is looked for exhaustively (``app.fewest``) and, where that does not come to an
end, by the solver, whose ways are shortened from their ends. ``meshwright bench --suite levels``
checks what is kept.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import math
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from agent.policies import load, shipped
from agent.shortening import shorten
from agent.solver import solve
from app import levels
from app.document import Document
from app.fewest import Answer, Found, fewest
from app.levels import Level
from meshcore import HalfEdgeMesh, quality, shapes
from meshcore.generate import benchmark_mesh, mesh_domain
from meshcore.smoothing import relax

Make = Callable[[np.random.Generator], HalfEdgeMesh]

NODES = 60_000
"""States of the exhaustive search for a way; the bench proves with more."""
TRIES = 400
"""Meshes that are drawn for one recipe."""
DIGITS = 6


@dataclass(frozen=True)
class Recipe:
    """What to make, and what of it to keep: ways of ``par`` operations, among them ``uses``."""

    name: str
    title: str
    text: str
    make: Make
    par: tuple[int, int] = (0, 99)
    uses: tuple[str, ...] = ()
    most: int = 0
    seconds: float = 1.0
    """Time of the solver for one of :data:`SEEDS` runs, where the exhaustive search has no end."""
    only: bool = False
    """Whether every shortest way has one of ``uses``."""


SEEDS = 6


# Perfect meshes


def lattice(places: Sequence[tuple[int, int]]) -> HalfEdgeMesh:
    """The equilateral triangles whose corners i (1, 0) + j (1/2, sqrt(3)/2) are all given."""
    number = {place: n for n, place in enumerate(places)}
    cells = [
        [number[corner] for corner in corners]
        for i, j in places
        for corners in (((i, j), (i + 1, j), (i, j + 1)), ((i, j), (i, j + 1), (i - 1, j + 1)))
        if all(corner in number for corner in corners)
    ]
    used = sorted({corner for cell in cells for corner in cell})
    again = {old: new for new, old in enumerate(used)}
    points = [places[old] for old in used]
    return HalfEdgeMesh.from_elements(
        np.array([(i + 0.5 * j, math.sqrt(0.75) * j) for i, j in points]),
        np.array([[again[corner] for corner in cell] for cell in cells]),
    )


def regular(side: int) -> HalfEdgeMesh:
    """A regular hexagon of triangles."""
    reach = range(-side, side + 1)
    return lattice([(i, j) for j in reach for i in reach if abs(i + j) <= side])


def triangle(side: int, cut: int = 0) -> HalfEdgeMesh:
    """A large triangle, with its tips cut off ``cut`` edges deep."""
    span = range(side + 1)
    return lattice([
        (i, j) for j in span for i in span
        if i + j <= side and i <= side - cut and j <= side - cut and i + j >= cut
    ])  # fmt: skip


def rhombus(columns: int, rows: int) -> HalfEdgeMesh:
    """A parallelogram of triangles."""
    return lattice([(i, j) for j in range(rows + 1) for i in range(columns + 1)])


def squares(
    columns: int, rows: int, inside: Callable[[int, int], bool] | None = None
) -> HalfEdgeMesh:
    """A grid of unit squares, those alone that are ``inside`` (column, row)."""
    cells = [(i, j) for j in range(rows) for i in range(columns) if inside is None or inside(i, j)]
    rings = [((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)) for i, j in cells]
    places = sorted({corner for ring in rings for corner in ring}, key=lambda at: at[::-1])
    number = {place: n for n, place in enumerate(places)}
    return HalfEdgeMesh.from_elements(
        np.array(places, float), np.array([[number[corner] for corner in ring] for ring in rings])
    )


def shaped(name: str, kind: str, max_edge: float | None = None) -> Make:
    """A shape of the gallery as the meshers leave it."""
    return lambda rng: mesh_domain(shapes.shape(name), kind, max_edge=max_edge)


def polygon(kind: str, sides: int, max_edge: float | None = None) -> Make:
    """A random polygon of the benchmark, as there or with triangles as large as ``max_edge``."""
    if max_edge is None:
        return lambda rng: benchmark_mesh(kind, sides, rng)
    return lambda rng: mesh_domain(
        shapes.random_polygon(sides, rng), kind, max_edge=max_edge, min_angle=20.0
    )


def spoilt(start: Callable[[], HalfEdgeMesh], *operations: str) -> Make:
    """A perfect mesh after these operations at random places."""

    def make(rng: np.random.Generator) -> HalfEdgeMesh:
        mesh = start()
        for operation in operations:
            allowed = [
                int(e) * mesh.k + side for e in mesh.element_ids() for side in range(mesh.k)
                if mesh.check(operation, int(e) * mesh.k + side)
            ]  # fmt: skip
            if not allowed:
                return start()
            mesh.apply(operation, int(rng.choice(allowed)))
        return mesh

    return make


# Ways


def drawn(mesh: HalfEdgeMesh, way: Found) -> bool:
    """Whether nothing is folded at the end, when it is played as a person plays it."""
    document = Document(mesh.copy())
    for operation, halfedge in way:
        document.submit(operation, halfedge)
    return not len(quality.inverted(document.mesh))


def best(mesh: HalfEdgeMesh, recipe: Recipe) -> tuple[Found, int, Answer] | None:
    """A shortest way whose end can be drawn, how many operations will not do, all that is known."""
    goal = mesh.optimum
    answer = fewest(mesh, goal, recipe.most, nodes=NODES)
    ways = [list(way) for way in answer.sequences]
    if ways:
        drawable = [way for way in ways if drawn(mesh, way)]
        return (drawable[0], answer.proved, answer) if drawable else None
    if recipe.par[1] < 6 or recipe.most:
        return None
    found = [
        solve(mesh, load(shipped(mesh.kind)[0]), seconds=recipe.seconds, seed=seed, coarsen=False)
        for seed in range(SEEDS)
    ]
    ways = [s.operations for s in found if s.score <= goal and not s.inverted]
    ways = [shorter(mesh, way, goal) for way in sorted(ways, key=len)[:3]]
    ways = [way for way in sorted(ways, key=len) if drawn(mesh, way)]
    return (ways[0], answer.proved, answer) if ways else None


def shorter(mesh: HalfEdgeMesh, way: Found, goal: int) -> Found:
    """The way with its end replaced by shorter ones, from every state on it, while that helps."""
    way = shorten(mesh, way, seconds=0.5)
    at = len(way)
    while at > 0:
        at -= 1
        state = mesh.copy()
        for operation, halfedge in way[:at]:
            state.apply(operation, halfedge)
        left = len(way) - at
        answer = fewest(state, goal, deepest=min(left - 1, 7), nodes=8_000, slots=1 << 18)
        for end in answer.sequences:
            if drawn(mesh, [*way[:at], *end]):
                way = [*way[:at], *end]
                break
        if not answer.sequences and answer.proved < min(left - 1, 7):
            break
    return way


def sound(mesh: HalfEdgeMesh) -> bool:
    """Whether the start can be looked at: nothing folded, no angle too flat or too sharp."""
    if len(relax(mesh)) or mesh.n_elements > 60:
        return False
    return float(quality.scaled_jacobian(mesh).min()) > 0.25


def fits(recipe: Recipe, ways: Sequence[Found], length: int) -> bool:
    """Whether it is what the recipe wants."""
    if not recipe.par[0] <= length <= recipe.par[1]:
        return False
    wanted = Counter(recipe.uses)
    used = [Counter(operation.value for operation, _ in way) for way in ways]
    enough = [not wanted - one for one in used]
    return min(enough) if recipe.only else max(enough)


def rounded(mesh: HalfEdgeMesh) -> HalfEdgeMesh:
    """The mesh as a file keeps it: without gaps, few digits."""
    mesh = mesh.copy()
    mesh.compact()
    return HalfEdgeMesh.from_elements(
        np.round(mesh.points[:, :2], DIGITS), mesh.elements(), mesh.geometric(), mesh.desired()
    )


def made(recipe: Recipe, number: int) -> Level | None:
    """The level of a recipe: the first of its meshes that fits; None if none does."""
    for seed in range(TRIES):
        rng = np.random.default_rng((number, seed))
        mesh = recipe.make(rng)
        if not sound(mesh):
            continue
        mesh = rounded(mesh)
        if not recipe.most and mesh.score == mesh.optimum:
            continue
        found = best(mesh, recipe)
        if found is None:
            continue
        way, proved, answer = found
        ways = [list(one) for one in answer.sequences] or [way]
        if not fits(recipe, [way] if not recipe.only else ways, len(way)):
            continue
        sys.stderr.write(f"{recipe.name}: seed {seed}, {len(answer.sequences)} ways\n")
        return Level(
            recipe.name, number, recipe.title, mesh.kind, recipe.text, mesh.optimum, recipe.most,
            len(way), proved >= len(way) - 1, levels.way_of(mesh, way),
            mesh.points[: mesh.slots, :2], mesh.elements(), mesh.geometric(), mesh.desired(),
        )  # fmt: skip
    return None


# What there is


def _ell(column: int, row: int) -> bool:
    return column < 2 or row < 2


def _ring(column: int, row: int) -> bool:
    return (column, row) != (1, 1)


RECIPES = (
    Recipe(
        "one-flip",
        "One flip",
        "Inside, six triangles should meet at a vertex. Flip the edge between the two vertices that"
        " have one edge too many: it goes to the two that lack one.",
        spoilt(lambda: regular(2), "flip"),
        (1, 1),
        ("flip",),
    ),
    Recipe(
        "quarter-turn",
        "A turn to the left or right",
        "Among quads, four edges should meet at a vertex. An edge turns in the hexagon of its two"
        " quads, left or right: one of the two ways makes all four vertices regular.",
        spoilt(lambda: squares(4, 3), "flip_left"),
        (1, 1),
    ),
    Recipe(
        "two-flips",
        "Two flips",
        "A flip takes one edge from each of its ends and gives one to each of the corners across."
        " Here it takes two, and the order matters. Undo costs nothing.",
        spoilt(lambda: rhombus(4, 3), "flip", "flip"),
        (2, 2),
        ("flip", "flip"),
        only=True,
    ),
    Recipe(
        "two-turns",
        "Two turns",
        "Two edges have turned, close to each other. Look at what the score would become before"
        " you click: the best first step need not look like much.",
        spoilt(lambda: squares(4, 4, _ell), "flip_left", "flip_right"),
        (2, 2),
        only=True,
    ),
    Recipe(
        "one-too-many",
        "One vertex too many",
        "Where only four triangles meet, no flip helps: there is a vertex too many. Collapse one of"
        " its edges, and it merges with a neighbour.",
        spoilt(lambda: triangle(4), "split"),
        (1, 1),
        ("collapse",),
        only=True,
    ),
    Recipe(
        "close-the-quad",
        "One quad too many",
        "A collapse closes a quad: two opposite corners merge. It mends two corners with three"
        " edges that face each other.",
        spoilt(lambda: squares(4, 3), "split"),
        (1, 1),
        ("collapse",),
        only=True,
    ),
    Recipe(
        "open-a-vertex",
        "Open a vertex",
        "A vertex with too many edges can be split along one of them: a quad opens there. The split"
        " is the collapse backwards.",
        spoilt(lambda: squares(4, 3), "collapse"),
        (1, 2),
        ("split",),
    ),
    Recipe(
        "make-room",
        "Make room",
        "Eight edges meet at one vertex. A split puts a new vertex on an edge; it has only four"
        " neighbours at first, and flips bring it the others.",
        spoilt(lambda: regular(2), "collapse"),
        (3, 3),
        ("split", "flip", "flip"),
    ),
    Recipe(
        "to-the-boundary",
        "All the way through",
        "An edge that opens cuts the next quad, and the next, up to the boundary on both sides. One"
        " end gains an edge, the other loses one: good for a vertex with three beside one with"
        " five.",
        spoilt(lambda: squares(4, 3), "global_split"),
        (1, 2),
        ("global_split",),
        only=True,
    ),
    Recipe(
        "three-blocks",
        "Only the blocks",
        "Every vertex is regular, but there are more quads than the shape needs. Delete straight"
        " lines that run from boundary to boundary, until only its blocks are left.",
        lambda rng: squares(4, 4, _ell),
        most=3,
    ),
    Recipe(
        "flip-and-merge",
        "Flips and a collapse",
        "Operations help each other: a flip brings the surplus to where a collapse can use it.",
        spoilt(lambda: triangle(5, 1), "split", "flip", "flip"),
        (3, 3),
        ("flip", "collapse"),
        only=True,
    ),
    Recipe(
        "four-for-quads",
        "A bit of everything",
        "A split, a collapse and two turns have spoilt a grid. Four operations mend it; perhaps"
        " not these four.",
        spoilt(lambda: squares(5, 3), "split", "flip_left", "flip_right", "collapse"),
        (4, 4),
        only=True,
    ),
    Recipe(
        "first-polygon",
        "A polygon as it comes",
        "No more puzzles: these triangles are what a mesher made of a polygon. On the boundary the"
        " angle says how many edges a vertex should have.",
        polygon("tri", 6, 0.7),
        (4, 5),
    ),
    Recipe(
        "ell",
        "The L",
        "Every triangle of a coarse mesh was cut into three quads, which leaves a vertex with three"
        " edges in each. At the end no irregular vertex remains.",
        shaped("l-shape", "quad"),
        (1, 99),
    ),
    Recipe(
        "tee",
        "The T, in triangles",
        "Two reflex corners want five edges each, the other corners three. s* is not zero: what the"
        " corners lack, by rounding their angles, no connectivity can give.",
        shaped("t-shape", "tri", 0.5),
        (1, 99),
    ),
    Recipe(
        "notch",
        "The notch",
        "A sharp reflex corner asks for four quads around it, its neighbours for one each. Where"
        " should the lines go that leave the notch?",
        shaped("single-notch", "quad"),
        (1, 99),
    ),
    Recipe(
        "double-notch",
        "Two notches, in triangles",
        "More triangles, more ways: count before you click, and watch that no surplus is pushed"
        " about in a circle.",
        shaped("double-notch", "tri", 0.5),
        (1, 99),
    ),
    Recipe(
        "plate",
        "The plate with a hole",
        "Around a hole the defects of the corners add up to nothing: four of the hole against four"
        " of the plate. So s* is 0, and a ring of quads is possible.",
        shaped("square-with-hole", "quad"),
        (1, 99),
    ),
    Recipe(
        "large-polygon",
        "Ten corners, in triangles",
        "A random polygon like those that the agent has learnt on. Play it against the agent.",
        polygon("tri", 10, 0.5),
        (6, 99),
    ),
    Recipe(
        "star",
        "The star",
        "Five tips want one quad each, five reflex corners three each: together four edges are"
        " missing, whatever you do. The optimum is s = 4, and the star can never be perfect.",
        shaped("star", "quad"),
        (1, 99),
        seconds=6.0,
    ),
)


def main(arguments: Sequence[str] | None = None) -> None:
    """Make the levels that were asked for."""
    parser = argparse.ArgumentParser(description="Make the levels in assets/levels/ anew.")
    parser.add_argument("names", nargs="*", help="names or patterns; left out: all")
    wanted = parser.parse_args(arguments).names or ["*"]
    for number, recipe in enumerate(RECIPES, 1):
        if not any(fnmatch.fnmatch(recipe.name, pattern) for pattern in wanted):
            continue
        level = made(recipe, number)
        if level is None:
            sys.stderr.write(f"{recipe.name}: none of {TRIES} meshes fits\n")
            continue
        path = levels.FOLDER / f"{number:02d}-{recipe.name}.json"
        for old in levels.FOLDER.glob(f"[0-9][0-9]-{recipe.name}.json"):
            old.unlink()
        path.write_text(written(levels.record(level)), "utf-8")
        mesh = level.mesh()
        sys.stderr.write(
            f"{path.name}: {mesh.n_elements} elements, s {mesh.score}, s* {level.goal},"
            f" par {level.par}{', proved' if level.proved else ''}\n"
        )


def written(record: dict[str, object]) -> str:
    """JSON with one line for each entry, so that a change of a level can be read."""
    lines = [f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in record.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


if __name__ == "__main__":
    main()
