"""Random operations on random meshes, checked one by one against the naive face list.

The hypothesis tests run it for a while; `meshwright bench --suite fuzz` for a million operations.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

import numpy as np

from meshwright_core.core.arrays import DELTA_SUM, ELEMENT_SLOTS, JOURNAL_TOP, ORIGIN, RESTORED
from meshwright_core.core.entry_points import entry
from meshwright_core.errors import MeshError
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations import catalogue
from meshwright_core.testing import face_list_rewrites
from meshwright_core.testing.comparison import Comparison, face_list
from meshwright_core.testing.curved_starts import bent, grid_regions, region_areas
from meshwright_core.testing.face_list_oracle import Refused

_SMALLEST, _LARGEST = 8, 60
"""Elements beyond which a run makes no more new ones lie between these: most rules concern small
meshes."""
_GROWING = ("split", "global_split", "insert_ring", "divide_chord")
_RUN = 300  # operations before a run is undone to its beginning and a new one starts
_STUCK = 100  # refusals in a row after which a mesh counts as used up, a single quad for instance


def snapshot(mesh: HalfEdgeMesh) -> tuple[np.ndarray, ...]:
    """Copies of all arrays of the mesh that an undo must restore, whole capacity included."""
    m = mesh.arrays
    return (
        m.edge.copy(),
        m.vertex.copy(),
        m.points.copy(),
        m.irregular.copy(),
        m.element_mark.copy(),
        m.counters[:RESTORED].copy(),
        m.parameter.copy(),
        m.region.copy(),
    )


def agree(first: tuple[np.ndarray, ...], second: tuple[np.ndarray, ...]) -> bool:
    """Whether two snapshots are equal to the bit where both have slots (arrays may have grown)."""
    for a, b in zip(first, second, strict=True):
        shared = min(len(a), len(b))
        if a[:shared].tobytes() != b[:shared].tobytes():
            return False
    return True


def start_mesh(
    kind: str, size: int, rng: np.random.Generator, curved: bool = False, interfaces: bool = False
) -> HalfEdgeMesh:
    """A small grid with random corners, holes and flags, of `kind`, some size x size quads at most.

    curved: with arcs as sides; else coordinates are random: the rules of connectivity do not look
    at them. interfaces: of several regions.
    """
    width, height = int(rng.integers(2, size + 1)), int(rng.integers(1, max(2, size // 2) + 1))
    corners = np.array([i + j * (width + 1) for j in range(height) for i in range(width)])
    quads = np.column_stack([corners, corners + 1, corners + width + 2, corners + width + 1])
    regions = np.zeros(len(quads), np.int64)
    if interfaces:
        regions = grid_regions(width, height, rng)
    inner = [q for q in range(len(quads)) if 0 < q % width < width - 1 and width <= q]
    inner = [q for q in inner if q < len(quads) - width]
    if inner and rng.random() < 0.5:
        hole = int(rng.choice(inner))
        quads, regions = np.delete(quads, hole, axis=0), np.delete(regions, hole)
    elements = quads
    if kind == "tri":
        turned = rng.random(len(quads)) < 0.5
        first = np.where(turned[:, None], quads[:, [0, 1, 3]], quads[:, [0, 1, 2]])
        second = np.where(turned[:, None], quads[:, [1, 2, 3]], quads[:, [0, 2, 3]])
        elements = np.concatenate([first, second])
        regions = np.concatenate([regions, regions])
    n = (width + 1) * (height + 1)
    points = rng.random((n, 2))
    if curved:
        points = 0.3 * points + np.column_stack(
            [np.arange(n) % (width + 1), np.arange(n) // (width + 1)]
        )
    geometric = rng.random(n) < rng.choice([0.0, 0.15, 0.4])
    mesh = HalfEdgeMesh.from_elements(points, elements, geometric, regions=regions)
    # the heuristic on random coordinates is random; these are the degrees of straight sides
    boundary = mesh.boundary()
    usual = np.where(boundary, 4 if kind == "tri" else 3, 6 if kind == "tri" else 4)
    own = (rng.random(n) < 0.1) & mesh.geometric()
    mesh = HalfEdgeMesh.from_elements(points, elements, geometric, usual + own, regions=regions)
    if curved:
        mesh = bent(mesh, rng)
    for v in np.flatnonzero(rng.random(n) < 0.03):
        mesh.set_locked(int(v))
    return mesh.copy()


def fuzz(
    kind: str,
    operations: int,
    seed: int = 0,
    progress: Callable[[int], None] | None = None,
    compare_every: int = 100,
    curved: bool = False,
    interfaces: bool = False,
) -> dict[str, float | int | str]:
    """Apply so many random operations of `kind`; MeshError at the first disagreement.

    Each attempt compares the verdicts of the mesh and the face list, which must be the same. After
    each applied operation everything that it has written is compared: faces, regions, twins,
    degrees, desired degrees, s and the ranges of edges along curves; and Euler characteristic and
    sum of Delta are as at the start. After every `compare_every`-th the validator runs and all of
    the mesh is compared. At the end of each run of some 300 operations all of them are undone to
    the first bit, redone to the last, and the run's end state is compared. curved, interfaces: see
    :func:`start_mesh`.
    """
    rng = np.random.default_rng(seed)
    draw = _draws(rng)
    applied = attempts = undone = 0
    began = time.perf_counter()
    while applied < operations:
        mesh = start_mesh(kind, 7, rng, curved, interfaces)
        areas = region_areas(mesh) if curved else np.zeros(0)
        size = float(np.ptp(mesh.points[mesh.vertices()], axis=0).max())
        names = list(catalogue.CODES[mesh.k])
        both = Comparison(mesh, face_list(mesh))
        first = snapshot(mesh)
        delta_sum, euler = both.oracle.delta_sum(), both.oracle.euler()
        done = refused = 0
        largest = int(rng.integers(_SMALLEST, _LARGEST))
        try:
            while done < _RUN and applied < operations and refused <= _STUCK:
                h = next(draw) % (mesh.k * int(mesh.arrays.counters[ELEMENT_SLOTS]))
                if mesh.arrays.edge[h, ORIGIN] < 0:
                    continue
                operation = names[next(draw) % len(names)]
                if mesh.n_elements > largest and operation in _GROWING:
                    continue
                attempts += 1
                if not _attempt(both, operation, h):
                    refused += 1
                    continue
                refused = 0
                applied += 1
                done += 1
                sums = int(mesh.arrays.counters[DELTA_SUM]), both.oracle.delta_sum()
                if sums != (delta_sum, delta_sum):
                    raise MeshError(f"{operation} changed the sum of Delta")
                if mesh.euler != euler:
                    raise MeshError(f"{operation} changed V - E + F")
                if applied % compare_every == 0:
                    both.whole()
                if progress is not None and applied % 1000 == 0:
                    progress(applied)
            both.whole()
            if curved:
                _check_shape(mesh, areas, size)
            undone += _undo_and_redo_all(mesh, first)
        except MeshError as error:
            raise MeshError(f"seed {seed}, attempt {attempts}: {error}") from None
    return {
        "kind": kind,
        "operations": applied,
        "attempts": attempts,
        "undone": undone,
        "violations": 0,
        "seconds": time.perf_counter() - began,
    }


def _draws(rng: np.random.Generator) -> Iterator[int]:
    """Random integers from 0 to 2**62 without end, many at a time."""
    while True:
        yield from rng.integers(1 << 62, size=4096).tolist()


def _attempt(both: Comparison, operation: str, h: int) -> bool:
    """One operation on both, if it is allowed; whether it was."""
    mesh, oracle = both.mesh, both.oracle
    a, b = mesh.origin(h), mesh.target(h)
    verdict = mesh.check(operation, h)
    new: tuple[int, ...] = ()
    try:
        if verdict:
            score, code = mesh.score, catalogue.CODES[mesh.k][operation]
            known = catalogue.CATALOGUE[code].score_formula
            predicted = entry(catalogue.score_change, 2)(mesh.arrays, code, h) if known else None
            edit = mesh.apply(operation, h)
            new = edit.new_vertices
            change = edit.score_change
            if mesh.score != score + change or predicted not in (None, change):
                raise MeshError("reported a wrong change of s")
        try:
            done = face_list_rewrites.apply(oracle, operation, a, b, new)
        except Refused as refusal:
            if verdict:
                raise MeshError(f"was allowed, though: {refusal}") from None
            return False
        if not verdict:
            raise MeshError(f"was refused ({verdict.reason}), without need")
        both.step(done)
    except MeshError as error:
        raise MeshError(f"{operation} on {a}-{b}: {error}") from None
    return True


def _check_shape(mesh: HalfEdgeMesh, areas: np.ndarray, size: float) -> None:
    """All vertices lie on their curves, and the regions have the same areas as at the start, within
    rounding in a domain of that size.
    """
    off = float(mesh.off_curve().max())
    if off > 1e-12 * size:
        raise MeshError(f"a vertex lies {off} off its curve")
    change = float(np.abs(region_areas(mesh) - areas).max())
    if change > 1e-12 * size * size:
        raise MeshError(f"the area of a region changed by {change}")


def _undo_and_redo_all(mesh: HalfEdgeMesh, first: tuple[np.ndarray, ...]) -> int:
    """Undo everything, compare with the first state, redo everything, compare with the last."""
    last, top = snapshot(mesh), int(mesh.arrays.counters[JOURNAL_TOP])
    count = mesh.steps
    while mesh.undo():
        continue
    if not agree(first, snapshot(mesh)):
        raise MeshError("undo did not restore the first bit")
    while mesh.redo():
        continue
    if not agree(last, snapshot(mesh)) or int(mesh.arrays.counters[JOURNAL_TOP]) != top:
        raise MeshError("redo did not restore the last bit")
    return count
