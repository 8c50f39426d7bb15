"""Makes the levels in meshwright_assets/levels, with the fewest operations that are found.

    python docs/make_levels.py              all of them
    python docs/make_levels.py star two-*   only these

The levels are described in level_recipes.py. No element is inverted at the start, nor at the end of
the stored solution. The fewest operations are found by exhaustive search
(``meshwright_agent.search.exhaustive``); where that takes too long, by beam search and by the
solver, whose solutions are shortened. ``meshwright bench --suite levels`` checks the result.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from level_recipes import RECIPES, Recipe

from meshwright.document.document import Document
from meshwright.puzzles import level as levels
from meshwright.puzzles.level import Level
from meshwright_agent.policy.policy_files import load, shipped
from meshwright_agent.search.annealing import Operations
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.exhaustive import FewestResult, fewest
from meshwright_agent.search.shortening import shorten
from meshwright_agent.search.solver import solve
from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry import quality
from meshwright_core.geometry.smoothing import relax
from meshwright_core.operations.catalogue import Operation, of_kind

TRIES = 400
"""The most random meshes tried for one recipe."""
DIGITS = 6
SEEDS, SECONDS = 6, 1.0
"""Number and seconds of runs of the solver if the exhaustive search does not end."""
WIDTH, DEPTH = 150, 14
"""States that the beam search keeps, and its depth in operations."""


# Solutions


def drawn(mesh: HalfEdgeMesh, way: Operations) -> bool:
    """Whether no element is inverted at the end, with smoothing as in the window."""
    document = Document(mesh.copy())
    for operation, halfedge in way:
        document.submit(operation, halfedge)
    return not len(quality.inverted(document.mesh))


def best(mesh: HalfEdgeMesh, recipe: Recipe) -> tuple[Operations, int, FewestResult] | None:
    """A shortest solution without inverted elements at its end, a lower bound, all solutions."""
    goal = mesh.optimum
    answer = fewest(mesh, goal, recipe.most, nodes=recipe.nodes)
    ways = [list(way) for way in answer.sequences]
    if ways:
        drawable = [way for way in ways if drawn(mesh, way)]
        return (drawable[0], answer.proved, answer) if drawable else None
    if recipe.par[1] < 6 or recipe.most:
        return None
    ways = [*solved(mesh, goal), *beamed(mesh, goal)]
    ways = [shorter(mesh, way, goal) for way in sorted(ways, key=len)[:3]]
    ways = [way for way in sorted(ways, key=len) if drawn(mesh, way)]
    return (ways[0], answer.proved, answer) if ways else None


def solved(mesh: HalfEdgeMesh, goal: int) -> list[Operations]:
    """Solutions of the agent."""
    policy = load(shipped(mesh.kind)[0])
    found = [
        solve(mesh, policy, seconds=SECONDS, seed=seed, coarsen=False) for seed in range(SEEDS)
    ]
    return [s.operations for s in found if s.score <= goal and not s.inverted]


def beamed(mesh: HalfEdgeMesh, goal: int) -> list[Operations]:
    """Beam search: solutions from the best states of each depth; those of the first depth that
    reaches the goal.
    """
    beam: list[Operations] = [[]]
    for _ in range(DEPTH):
        found: list[tuple[int, int, Operations]] = []
        for way in beam:
            work = replayed(mesh, way)
            for operation, halfedge in allowed(work):
                work.apply(operation, halfedge)
                found.append((work.score, work.irregular_count, [*way, (operation, halfedge)]))
                work.undo()
        found.sort(key=lambda one: one[:2])
        ends = [way for score, _, way in found if score <= goal]
        ends = [way for way in ends[:40] if drawn(mesh, way)]
        if ends:
            return ends
        kept: dict[tuple[int, ...], Operations] = {}
        for score, irregular, way in found[: 20 * WIDTH]:
            kept.setdefault((score, irregular, *fingerprint(replayed(mesh, way))), way)
            if len(kept) == WIDTH:
                break
        beam = list(kept.values())
    return []


def allowed(mesh: HalfEdgeMesh) -> Iterator[tuple[Operation, int]]:
    """All allowed operations that policies choose."""
    names = [info.operation for info in of_kind(mesh.kind) if info.policy]
    halfedges = mesh.halfedges_of(mesh.element_ids()).ravel().tolist()
    yield from ((name, h) for h in halfedges for name in names if mesh.check(name, h))


def fingerprint(mesh: HalfEdgeMesh) -> tuple[int, ...]:
    """A hash of degrees and irregularities that depends on the connectivity only."""
    delta, degree = mesh.irregularity(), mesh.degree()
    vertices = mesh.vertices()
    sums = [sum(1000 * int(degree[w]) + int(delta[w]) for w in mesh.neighbours(int(v)))
            for v in vertices]  # fmt: skip
    pairs = zip(degree[vertices].tolist(), delta[vertices].tolist(), sums, strict=True)
    return (hash(tuple(sorted(pairs))),)


def shorter(mesh: HalfEdgeMesh, way: Operations, goal: int) -> Operations:
    """The solution with its end, from any of its states, replaced by shorter ones."""
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
    """Whether no element of the start is inverted and no angle is too flat or too sharp."""
    if len(relax(mesh)) or mesh.n_elements > 60:
        return False
    return float(quality.scaled_jacobian(mesh).min()) > 0.25


def fits(recipe: Recipe, mesh: HalfEdgeMesh, ways: Sequence[Operations], length: int) -> bool:
    """Whether the mesh and its solutions fulfil the recipe."""
    if not recipe.par[0] <= length <= recipe.par[1]:
        return False
    wanted = Counter(recipe.uses)
    used = [Counter(operation.value for operation, _ in way) for way in ways]
    if not recipe.suits(mesh, ways):
        return False
    enough = [not wanted - one for one in used]
    return all(enough) if recipe.only else any(enough)


def rounded(mesh: HalfEdgeMesh) -> HalfEdgeMesh:
    """The mesh as it is stored: ids without gaps, rounded coordinates."""
    mesh = mesh.copy()
    mesh.compact()
    return HalfEdgeMesh.from_elements(
        np.round(mesh.points[:, :2], DIGITS), mesh.elements(), mesh.geometric(), mesh.desired()
    )


def made(recipe: Recipe, number: int) -> Level | None:
    """The level of a recipe: the first of its meshes that fulfils it, or None."""
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
        if not fits(recipe, mesh, ways if recipe.only or recipe.par[1] < 6 else [way], len(way)):
            continue
        sys.stderr.write(f"{recipe.name}: seed {seed}, {len(answer.sequences)} ways\n")
        return Level(
            recipe.name, number, recipe.title, mesh.kind, recipe.text, mesh.optimum, recipe.most,
            len(way), proved >= len(way) - 1, levels.way_of(mesh, way),
            mesh.points[: mesh.slots, :2], mesh.elements(), mesh.geometric(), mesh.desired(),
        )  # fmt: skip
    return None


def main(arguments: Sequence[str] | None = None) -> None:
    """Make the levels named on the command line."""
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
    """JSON with one line for each entry, for legible diffs."""
    lines = [f"  {json.dumps(key)}: {json.dumps(value)}" for key, value in record.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


if __name__ == "__main__":
    main()
