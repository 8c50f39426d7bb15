"""Speed of the engine: operations per second in compiled code and from Python, by mesh size.

Triangles are a sheared grid, quads a grid. *Near* means half-edges drawn from a thousand elements
that lie together; *anywhere* means from the whole mesh, so that the processor's caches show. The
medians of a few rounds on fresh copies are reported.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from meshwright.console import Update
from meshwright_core import HalfEdgeMesh, Operation
from meshwright_core.core.arrays import JOURNALLING
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.operations import catalogue
from meshwright_core.operations.refusals import ALLOWED, NEED_ROOM

SUMMARY = "operations per second of the engine, in compiled code and from Python"

SIZES = (1_000, 10_000, 100_000, 1_000_000)
ROUNDS = 5
NEAR = 1_000


@bare_kernel
def flip_all(m, halfedges):
    """Flip every half-edge of the list that may be flipped; return how many were."""
    done = 0
    for h in halfedges:
        if catalogue.check(m, catalogue.TRI_FLIP, h, 0) == ALLOWED:
            catalogue.rewrite(m, catalogue.TRI_FLIP, h)
            done += 1
    return done


@bare_kernel
def apply_all(m, codes, halfedges, start):
    """Try one operation after another; return where it stopped for want of room, how many done."""
    done = 0
    for i in range(start, len(codes)):
        code = catalogue.check(m, codes[i], halfedges[i], 0)
        if code == NEED_ROOM:
            return i, done
        if code == ALLOWED:
            catalogue.rewrite(m, codes[i], halfedges[i])
            done += 1
    return len(codes), done


def grid(kind: str, elements: int) -> HalfEdgeMesh:
    """Return a grid of about so many elements, its elements in rows."""
    cells = max(2, round((elements / (2 if kind == "tri" else 1)) ** 0.5))
    x, y = np.meshgrid(np.arange(cells + 1.0), np.arange(cells + 1.0))
    a = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    b, c, d = a + 1, a + cells + 2, a + cells + 1
    points = np.column_stack([x.ravel(), y.ravel()])
    if kind == "quad":
        return HalfEdgeMesh.from_elements(points, np.column_stack([a, b, c, d]))
    triangles = np.stack([np.column_stack([a, b, c]), np.column_stack([a, c, d])], axis=1)
    return HalfEdgeMesh.from_elements(points, triangles.reshape(-1, 3))


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Measure everything; ``quick`` leaves out the large meshes and most of the operations."""
    rng = np.random.default_rng(seed)
    rounds = 1 if quick else ROUNDS
    share = 100 if quick else 1
    found: dict[str, Any] = {"unit": "operations per second", "rounds": rounds}
    for size in SIZES[:2] if quick else SIZES:
        update(0, f"{size:,} elements")
        found[f"{size:,} elements"] = by_size(size, rounds, share, rng)
    small = grid("quad", 400)
    found["all quad operations compiled, 400 elements"] = median(
        rounds, lambda: compiled_mixed(small, GLOBAL, 200_000 // share, 400, rng, fresh_every=300)
    )
    found["flips from Python"] = rivals(grid("tri", 1_000 if quick else 100_000), rng)
    return found


def by_size(size: int, rounds: int, share: int, rng: np.random.Generator) -> dict[str, float]:
    """Return the numbers for meshes of one size."""
    triangles, quads = grid("tri", size), grid("quad", size)
    row: dict[str, float] = {}
    for place, span in (("near", NEAR), ("anywhere", size)):
        measures: dict[str, Callable[[int], float]] = {
            "flips compiled": lambda n: compiled_flips(triangles, 2_000_000 // share, n, rng),
            "flips from Python": lambda n: python_flips(triangles, 100_000 // share, n, rng),
            "flip split collapse compiled": lambda n: compiled_mixed(
                triangles, LOCAL, 1_000_000 // share, n, rng
            ),
            "quad flips split collapse compiled": lambda n: compiled_mixed(
                quads, LOCAL, 1_000_000 // share, n, rng
            ),
        }
        for name, measure in measures.items():
            row[f"{name}, {place}"] = median(rounds, partial(measure, span))
    return row


LOCAL = ("flip", "flip_left", "flip_right", "split", "collapse")
GLOBAL = (*LOCAL, "global_split", "cleanup", "chord_collapse")


def median(rounds: int, measure: Callable[[], float]) -> float:
    """Return the median of some rounds, after one that is thrown away."""
    measure()
    return statistics.median(measure() for _ in range(rounds))


def somewhere(mesh: HalfEdgeMesh, count: int, span: int, rng: np.random.Generator) -> np.ndarray:
    """Return random half-edges of the first ``span`` element slots from the middle on."""
    slots = mesh.n_elements
    first = max(0, slots // 2 - span // 2)
    last = min(slots, first + span)
    return rng.integers(mesh.k * first, mesh.k * last, count)


def compiled_flips(mesh: HalfEdgeMesh, count: int, span: int, rng: np.random.Generator) -> float:
    """Return flips per second inside compiled code, refused ones not counted."""
    work = without_journal(mesh)
    halfedges = somewhere(work, count, span, rng)
    start = time.perf_counter()
    done = flip_all(work.arrays, halfedges)
    return float(done / (time.perf_counter() - start))


def compiled_mixed(
    mesh: HalfEdgeMesh,
    names: tuple[str, ...],
    count: int,
    span: int,
    rng: np.random.Generator,
    fresh_every: int = 0,
) -> float:
    """Return random valid operations per second inside compiled code, refused ones not counted.

    ``fresh_every`` so many tries a fresh copy is taken, off the clock, since global splits make
    meshes grow without end.
    """
    work = without_journal(mesh)
    known = catalogue.CODES[work.k]
    codes = np.array([known[Operation(n)] for n in names if n in known])
    chosen = codes[rng.integers(len(codes), size=count)]
    halfedges = somewhere(work, count, span, rng)
    seconds, done, at = 0.0, 0, 0
    while at < count:
        stop = min(count, at + fresh_every) if fresh_every else count
        while at < stop:
            start = time.perf_counter()
            at, more = apply_all(work.arrays, chosen[:stop], halfedges, at)
            seconds += time.perf_counter() - start
            done += more
            if at < stop:  # the mesh enlarges its arrays, off the clock
                work.apply(catalogue.NAMES[int(chosen[at])], int(halfedges[at]))
                at += 1
        if fresh_every:
            work = without_journal(mesh)
    return done / seconds


def python_flips(mesh: HalfEdgeMesh, count: int, span: int, rng: np.random.Generator) -> float:
    """Return checked and journalled flips per second when called from Python one by one."""
    work = mesh.copy()
    halfedges = [int(h) for h in somewhere(work, count, span, rng)]
    done = 0
    start = time.perf_counter()
    for h in halfedges:
        if work.check("flip", h):
            work.apply("flip", h)
            done += 1
    return done / (time.perf_counter() - start)


def without_journal(mesh: HalfEdgeMesh) -> HalfEdgeMesh:
    """Return a copy that records no history, as rollouts use it."""
    work = mesh.copy()
    work.arrays.counters[JOURNALLING] = 0
    return work


def rivals(triangles: HalfEdgeMesh, rng: np.random.Generator) -> dict[str, float | str]:
    """Return flips per second of other packages, called from Python, where they are installed."""
    return {
        "elements": float(triangles.n_elements),
        "meshwright": median(1, lambda: python_flips(triangles, 20_000, triangles.n_elements, rng)),
        "openmesh": openmesh_flips(triangles, 20_000, rng),
        "compas": compas_flips(triangles, 5_000, rng),
    }


def openmesh_flips(mesh: HalfEdgeMesh, count: int, rng: np.random.Generator) -> float | str:
    """Return flips per second of OpenMesh's Python bindings, or that they are not installed."""
    try:
        import openmesh
    except ImportError:
        return "not installed"
    work = openmesh.TriMesh(mesh.points, mesh.elements())
    edges = [work.edge_handle(int(e)) for e in rng.integers(work.n_edges(), size=count)]
    done = 0
    start = time.perf_counter()
    for edge in edges:
        if work.is_flip_ok(edge):
            work.flip(edge)
            done += 1
    return done / (time.perf_counter() - start)


def compas_flips(mesh: HalfEdgeMesh, count: int, rng: np.random.Generator) -> float | str:
    """Return flips per second of compas, or that it is not installed."""
    try:
        from compas.datastructures import Mesh
        from compas.datastructures.mesh.operations.swap import trimesh_swap_edge
    except ImportError:
        return "not installed"
    work = Mesh.from_vertices_and_faces(mesh.points.tolist(), mesh.elements().tolist())
    inner = [edge for edge in work.edges() if not work.is_edge_on_boundary(edge)]
    chosen = [inner[int(i)] for i in rng.permutation(len(inner))[:count]]
    done = 0
    start = time.perf_counter()
    for u, v in chosen:  # an edge that another flip took away is passed over
        if v in work.halfedge[u] and trimesh_swap_edge(work, (u, v)) is not False:
            done += 1
    return done / (time.perf_counter() - start)
