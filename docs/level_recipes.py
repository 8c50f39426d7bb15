"""Recipes of the levels: regular meshes after random operations, and shapes of the gallery."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from meshwright_agent.search.annealing import Operations
from meshwright_core import HalfEdgeMesh
from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import benchmark_mesh, mesh_domain

Make = Callable[[np.random.Generator], HalfEdgeMesh]
Suits = Callable[[HalfEdgeMesh, Sequence[Operations]], bool]


@dataclass(frozen=True)
class Recipe:
    """How to make a level, and which meshes to keep: those with shortest solutions of ``par``
    operations that contain ``uses``.
    """

    name: str
    title: str
    text: str
    make: Make
    par: tuple[int, int] = (0, 99)
    uses: tuple[str, ...] = ()
    only: bool = False
    """Whether every shortest solution must contain ``uses``."""
    most: int = 0
    """The most elements at the goal, 0 for any number."""
    suits: Suits = lambda mesh, ways: True
    """A further condition on the start and its shortest solutions."""
    nodes: int = 60_000
    """The most states of the exhaustive search."""


# Regular meshes


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
    """A large triangle of triangles whose tips are cut off ``cut`` edges deep."""
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
    """A grid of unit squares, restricted to those that are ``inside`` (column, row)."""
    cells = [(i, j) for j in range(rows) for i in range(columns) if inside is None or inside(i, j)]
    rings = [((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)) for i, j in cells]
    places = sorted({corner for ring in rings for corner in ring}, key=lambda at: at[::-1])
    number = {place: n for n, place in enumerate(places)}
    return HalfEdgeMesh.from_elements(
        np.array(places, float), np.array([[number[corner] for corner in ring] for ring in rings])
    )


def inside(mesh: HalfEdgeMesh) -> bool:
    """Whether all irregular vertices lie inside."""
    return not bool((mesh.boundary() & (mesh.irregularity() != 0)).any())


def shaped(name: str, kind: str, max_edge: float | None = None) -> Make:
    """A shape of the gallery as the mesh generators make it."""
    return lambda rng: mesh_domain(gallery.shape(name), kind, max_edge=max_edge)


def polygon(kind: str, sides: int, max_edge: float | None = None) -> Make:
    """A random polygon as in the benchmark, or with triangles as large as ``max_edge``."""
    if max_edge is None:
        return lambda rng: benchmark_mesh(kind, sides, rng)
    return lambda rng: mesh_domain(
        gallery.random_polygon(sides, rng), kind, max_edge=max_edge, min_angle=20.0
    )


def scrambled(start: Callable[[], HalfEdgeMesh], *operations: str) -> Make:
    """A regular mesh after these operations at random places."""

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


# The recipes


def _ell(column: int, row: int) -> bool:
    return column < 2 or row < 2


def _ring(column: int, row: int) -> bool:
    return (column, row) != (2, 2)


RECIPES = (
    Recipe(
        "one-flip",
        "One flip",
        "Inside, six triangles should meet at a vertex. Flip the edge between the two vertices that"
        " have one edge too many: it goes to the two that lack one.",
        scrambled(lambda: regular(2), "flip"),
        (1, 1),
        ("flip",),
        suits=lambda mesh, ways: inside(mesh),
    ),
    Recipe(
        "quarter-turn",
        "A turn to the left or right",
        "Among quads, four edges should meet at a vertex. An edge turns in the hexagon of its two"
        " quads, left or right: one of the two ways makes all four vertices regular.",
        scrambled(lambda: squares(4, 3), "flip_left"),
        (1, 1),
    ),
    Recipe(
        "two-flips",
        "Two flips",
        "A flip takes one edge from each of its ends and gives one to each of the corners across."
        " Here it takes two, and the order matters. Undo costs nothing.",
        scrambled(lambda: rhombus(4, 3), "flip", "flip"),
        (2, 2),
        ("flip", "flip"),
        only=True,
        suits=lambda mesh, ways: len(ways) == 1,
    ),
    Recipe(
        "two-turns",
        "Two turns",
        "Two edges have turned, close to each other. Look at what the score would become before"
        " you click: the best first step need not look like much.",
        scrambled(lambda: squares(4, 4, _ell), "flip_left", "flip_right"),
        (2, 2),
        suits=lambda mesh, ways: len(ways) == 1,
    ),
    Recipe(
        "one-too-many",
        "One vertex too many",
        "Where only four triangles meet, no flip helps: there is a vertex too many. Collapse one of"
        " its edges, and it merges with a neighbour.",
        scrambled(lambda: triangle(4), "split"),
        (1, 1),
        ("collapse",),
        only=True,
    ),
    Recipe(
        "close-the-quad",
        "One quad too many",
        "A collapse closes a quad: two opposite corners merge. Here two vertices of degree 3"
        " become a regular one.",
        scrambled(lambda: squares(4, 3), "split"),
        (1, 1),
        ("collapse",),
        only=True,
    ),
    Recipe(
        "open-a-vertex",
        "Open a vertex",
        "A vertex with too many edges can be split along one of them: a quad opens there. One turn"
        " beside it does the rest.",
        scrambled(lambda: squares(4, 3), "collapse"),
        (1, 2),
        ("split",),
    ),
    Recipe(
        "make-room",
        "Make room",
        "Eight edges meet at one vertex. A split puts a new vertex on an edge; it has only four"
        " neighbours at first, and flips bring it the others.",
        scrambled(lambda: regular(2), "collapse"),
        (3, 3),
        ("split", "flip", "flip"),
        suits=lambda mesh, ways: inside(mesh),
    ),
    Recipe(
        "to-the-boundary",
        "All the way through",
        "An edge that opens cuts the next quad, and the next, up to the boundary on both sides. One"
        " end gains an edge, the other loses one: good for a vertex with three beside one with"
        " five.",
        scrambled(lambda: squares(4, 3), "global_split"),
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
        scrambled(lambda: triangle(5, 1), "split", "flip", "flip"),
        (3, 3),
        ("flip", "collapse"),
        only=True,
    ),
    Recipe(
        "four-for-quads",
        "A bit of everything",
        "A split, a collapse and two turns were applied to a grid. Four operations repair it,"
        " not necessarily the inverses of these.",
        scrambled(lambda: squares(5, 3), "split", "flip_left", "flip_right", "collapse"),
        (4, 4),
        only=True,
    ),
    Recipe(
        "first-polygon",
        "A polygon as it comes",
        "No more puzzles: these triangles are what a mesher made of a polygon. On the boundary"
        " the angle determines the desired degree of a vertex.",
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
        nodes=100_000,
    ),
    Recipe(
        "tee",
        "The T, in triangles",
        "A right angle is one and a half triangles wide, so the desired degree of every corner"
        " is rounded up. No connectivity reaches their sum: s* is not zero here.",
        shaped("t-shape", "tri"),
        (1, 99),
    ),
    Recipe(
        "notch",
        "The notch",
        "The reflex corner of the notch should have four quads around it, all other corners one"
        " each. Where should the three lines go that leave the notch?",
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
        "The desired degrees of the corners balance: four reflex corners at the hole, four"
        " others outside. So s* is 0, and rings of quads can run around the hole.",
        scrambled(
            lambda: squares(5, 5, _ring),
            "collapse",
            "split",
            "flip_left",
            "flip_right",
            "global_split",
        ),
        (5, 5),
        nodes=60_000,
    ),
    Recipe(
        "large-polygon",
        "Ten corners, in triangles",
        "A random polygon like those that the agent has learnt on. Play it against the agent.",
        polygon("tri", 10, 0.5),
        (6, 99),
        nodes=300_000,
    ),
    Recipe(
        "star",
        "The star",
        "Five tips should have one quad each, five reflex corners three each: together four"
        " edges are missing. The optimum is s = 4, and the star can never be perfect.",
        shaped("star", "quad"),
        (1, 99),
    ),
)
