"""Random operations on random meshes, checked one by one against the naive face list.

The hypothesis tests run it for a while; `meshwright bench --suite fuzz` for a million operations.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from meshwright_core.core.arrays import DEGREE, DESIRED, JOURNAL_TOP, RESTORED
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.errors import MeshError
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations import catalogue
from meshwright_core.operations.catalogue import Operation
from meshwright_core.testing.curved_starts import bent, grid_regions, region_areas
from meshwright_core.testing.face_list_oracle import Edge, FaceList, Range, Refused

_LARGEST = 60  # elements; beyond it a run starts afresh, since the face list is slow
_RUN = 150  # operations before a run is undone to its beginning and a new one starts
_STUCK = 100  # refusals in a row after which a mesh counts as used up, a single quad for instance


def face_list(mesh: HalfEdgeMesh) -> FaceList:
    """The mesh as a :class:`FaceList`."""
    live = mesh.vertices().tolist()
    desired, geometric, locked = mesh.desired(), mesh.geometric(), mesh.locked()
    return FaceList(
        [tuple(row) for row in mesh.elements().tolist()],
        {v: int(desired[v]) for v in live},
        {v for v in live if geometric[v]},
        {v for v in live if locked[v]},
        mesh.regions().tolist(),
        edge_ranges(mesh),
    )


def edge_ranges(mesh: HalfEdgeMesh) -> dict[Edge, Range]:
    """The curve and the range of each edge along a curve, in the direction of the curve."""
    halfedges = mesh.halfedges_of(mesh.element_ids()).ravel()
    curve, span = edge_places(mesh.arrays, halfedges, mesh.k)
    along = np.flatnonzero((curve >= 0) & (span[:, 0] < span[:, 1]))
    rows = zip(halfedges[along].tolist(), curve[along].tolist(), span[along].tolist(), strict=True)
    return {
        (mesh.origin(h), mesh.target(h)): (number, start, stop) for h, number, (start, stop) in rows
    }


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
    validate_every: int = 10,
    curved: bool = False,
    interfaces: bool = False,
) -> dict[str, float | int | str]:
    """Apply so many random operations of `kind`; MeshError at the first disagreement.

    Each attempt compares the verdicts of the mesh and the face list, which must be the same; each
    applied operation must give the same faces, the same ranges of edges along curves, the same sum
    of Delta and Euler characteristic. curved, interfaces: see :func:`start_mesh`. The validator
    runs on every `validate_every`-th; at the end of each run of some 150
    operations all of them are undone to the first bit, redone to the last, and the run's end state
    is compared.
    """
    rng = np.random.default_rng(seed)
    applied = attempts = undone = 0
    began = time.perf_counter()
    while applied < operations:
        mesh = start_mesh(kind, 7, rng, curved, interfaces)
        areas = region_areas(mesh) if curved else np.zeros(0)
        names = [str(name) for name in mesh.allowed(-1)]
        oracle = face_list(mesh)
        first = snapshot(mesh)
        delta_sum, euler = oracle.delta_sum(), oracle.euler()
        done = refused = 0
        while done < _RUN and applied < operations and mesh.n_elements <= _LARGEST:
            if refused > _STUCK:
                break
            attempts += 1
            operation = names[int(rng.integers(len(names)))]
            ids = mesh.element_ids()
            h = int(ids[rng.integers(len(ids))]) * mesh.k + int(rng.integers(mesh.k))
            oracle, changed = _attempt(mesh, oracle, operation, h, seed, attempts)
            if not changed:
                refused += 1
                continue
            refused = 0
            applied += 1
            done += 1
            if oracle.delta_sum() != delta_sum or mesh.optimum != abs(delta_sum):
                raise MeshError(f"seed {seed}, attempt {attempts}: {operation} changed sum Delta")
            if mesh.euler != euler:
                raise MeshError(f"seed {seed}, attempt {attempts}: {operation} changed V - E + F")
            if applied % validate_every == 0:
                mesh.validate()
            if progress is not None and applied % 1000 == 0:
                progress(applied)
        mesh.validate()
        if curved:
            _check_shape(mesh, areas, f"seed {seed}, attempt {attempts}")
        undone += _undo_and_redo_all(mesh, first, seed, attempts)
    return {
        "kind": kind,
        "operations": applied,
        "attempts": attempts,
        "undone": undone,
        "violations": 0,
        "seconds": time.perf_counter() - began,
    }


def _attempt(
    mesh: HalfEdgeMesh, oracle: FaceList, operation: str, h: int, seed: int, attempt: int
) -> tuple[FaceList, bool]:
    """One operation on both; the face list after it and whether it was allowed."""
    a, b = mesh.origin(h), mesh.target(h)
    where = f"seed {seed}, attempt {attempt}: {operation} on {a}-{b}"
    verdict = mesh.check(operation, h)
    new: list[int] = []
    if verdict:
        score, code = mesh.score, catalogue.CODES[mesh.k][operation]
        known = catalogue.CATALOGUE[code].score_formula
        predicted = catalogue.score_change(mesh.arrays, code, h) if known else None
        edit = mesh.apply(Operation(operation), h)
        new = list(edit.new_vertices)
        if mesh.score != score + edit.score_change or predicted not in (None, edit.score_change):
            raise MeshError(f"{where} reported a wrong change of s")
    try:
        after = oracle.after(operation, a, b, new)
    except Refused as refusal:
        if verdict:
            raise MeshError(f"{where} was allowed, though: {refusal}") from None
        return oracle, False
    if not verdict:
        raise MeshError(f"{where} was refused ({verdict.reason}), without need")
    found = face_list(mesh)
    if after.regions != found.regions:
        raise MeshError(f"{where} gave other faces or regions than it should")
    if not same_ranges(mesh, after.ranges, found.ranges):
        raise MeshError(f"{where} put an edge in a wrong place of its curve")
    degrees = after.degrees()
    if any(mesh.arrays.vertex[v, DEGREE] != d for v, d in degrees.items()):
        raise MeshError(f"{where} left a wrong degree")
    if any(mesh.arrays.vertex[v, DESIRED] != after.desired[v] for v in degrees):
        raise MeshError(f"{where} left a wrong desired degree")
    return after, True


def same_ranges(mesh: HalfEdgeMesh, expected: dict[Edge, Range], found: dict[Edge, Range]) -> bool:
    """Whether edges lie on the same curves at the same places, those on closed ones modulo the
    length.
    """
    if expected.keys() != found.keys():
        return False
    lengths = mesh.boundary_info.lengths()
    for edge, (curve, start, stop) in expected.items():
        other, first, last = found[edge]
        turn = (start - first) / lengths[curve]
        near = 1e-9 * lengths[curve]
        if other != curve or abs(stop - start - (last - first)) > near:
            return False
        whole = round(turn) if mesh.boundary_info.curves.closed[curve] else 0
        if abs(turn - whole) * lengths[curve] > near:
            return False
    return True


def _check_shape(mesh: HalfEdgeMesh, areas: np.ndarray, where: str) -> None:
    """All vertices lie on their curves, and the regions have the same areas as at the start."""
    size = float(np.ptp(mesh.points[mesh.vertices()], axis=0).max())
    off = float(mesh.off_curve().max())
    if off > 1e-12 * size:
        raise MeshError(f"{where}: a vertex lies {off} off its curve")
    change = float(np.abs(region_areas(mesh) - areas).max())
    if change > 1e-12 * size * size:
        raise MeshError(f"{where}: the area of a region changed by {change}")


def _undo_and_redo_all(
    mesh: HalfEdgeMesh, first: tuple[np.ndarray, ...], seed: int, attempt: int
) -> int:
    """Undo everything, compare with the first state, redo everything, compare with the last."""
    last, top = snapshot(mesh), int(mesh.arrays.counters[JOURNAL_TOP])
    count = mesh.steps
    while mesh.undo():
        continue
    if not agree(first, snapshot(mesh)):
        raise MeshError(f"seed {seed}, attempt {attempt}: undo did not restore the first bit")
    while mesh.redo():
        continue
    if not agree(last, snapshot(mesh)) or int(mesh.arrays.counters[JOURNAL_TOP]) != top:
        raise MeshError(f"seed {seed}, attempt {attempt}: redo did not restore the last bit")
    return count
