"""Builds the arrays of a half-edge mesh from points and elements, in plain numpy."""

from __future__ import annotations

import numpy as np

from meshwright_core.core.arrays import (
    BOUNDARY_EDGES,
    CURVE,
    DEGREE,
    DELTA_SUM,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    FLAGS,
    FREE_VERTEX,
    GEOMETRIC,
    HALF,
    IRREGULAR,
    ORIGIN,
    PLACE,
    SCORE,
    TWIN,
    VERTEX_SLOTS,
    VERTICES,
    MeshArrays,
    allocate,
)
from meshwright_core.core.curve_corners import corners, desired_by_sectors, sectors
from meshwright_core.core.irregularity import (
    CORNER_ANGLE,
    QUAD_INSIDE,
    TRIANGLE_INSIDE,
    desired_on_boundary,
    planar_boundary_angles,
    turning_angles,
)
from meshwright_core.core.mesh_boundary import Chain, MeshBoundary, Seats, polyline_boundary
from meshwright_core.core.region_interfaces import interface_chains
from meshwright_core.errors import MeshError


def checked_input(points: np.ndarray, elements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points as (n, 3) float64 and elements as (m, k) int64; MeshError if they are invalid."""
    points = np.asarray(points, dtype=float)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise MeshError(f"points must be an (n, 2) or (n, 3) array, not of shape {points.shape}")
    elements = np.asarray(elements)
    if elements.ndim != 2 or elements.shape[1] not in (3, 4):
        raise MeshError(f"elements must be an (m, 3) or (m, 4) array, not {elements.shape}")
    if len(elements) == 0:
        raise MeshError("the mesh has no elements")
    whole = np.issubdtype(elements.dtype, np.integer)
    if not whole and not (elements == np.floor(elements)).all():
        raise MeshError("elements must hold whole numbers")
    elements = elements.astype(np.int64)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    if elements.min() < 0 or elements.max() >= len(points):
        row = int(np.argmax(((elements < 0) | (elements >= len(points))).any(axis=1)))
        raise MeshError(
            f"element {row} names a vertex that does not exist: {elements[row].tolist()} with"
            f" {len(points)} points"
        )
    in_order = np.sort(elements, axis=1)
    repeated = (in_order[:, 1:] == in_order[:, :-1]).any(axis=1)
    if repeated.any():
        row = int(np.argmax(repeated))
        raise MeshError(f"element {row} repeats a vertex: {elements[row].tolist()}")
    used = np.zeros(len(points), bool)
    used[elements] = True
    wrong = used & ~np.isfinite(points).all(axis=1)
    if wrong.any():
        vertex = int(np.argmax(wrong))
        raise MeshError(
            f"point {vertex} has a coordinate that is not a finite number: {points[vertex]}"
        )
    return points, elements


def twins_of(elements: np.ndarray) -> np.ndarray:
    """The twin of each half-edge k*e + i of (m, k) elements, -1 on the boundary.

    Raises MeshError where an edge has three elements or two that are oriented against each other.
    """
    k = elements.shape[1]
    origin = elements.ravel()
    target = np.roll(elements, -1, axis=1).ravel()
    low, high = np.minimum(origin, target), np.maximum(origin, target)
    key = low * (int(elements.max()) + 1) + high
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    same = ordered[1:] == ordered[:-1]
    if (same[1:] & same[:-1]).any():
        h = order[int(np.argmax(same[1:] & same[:-1]))]
        raise MeshError(
            f"the mesh is not manifold: more than two elements share the edge"
            f" {origin[h]}-{target[h]}"
        )
    first, second = order[:-1][same], order[1:][same]
    clash = origin[first] == origin[second]
    if clash.any():
        h, t = (int(pair[np.argmax(clash)]) for pair in (first, second))
        raise MeshError(
            f"elements {h // k} and {t // k} run the same way along the edge"
            f" {origin[h]}-{target[h]}: they are oriented against each other or overlap"
        )
    twin = np.full(len(origin), -1, np.int64)
    twin[first] = second
    twin[second] = first
    return twin


def halves_of(elements: np.ndarray, twin: np.ndarray, slots: int) -> np.ndarray:
    """One outgoing half-edge for each of `slots` vertices, the one without twin on the boundary.

    -1 for vertices of no element. Raises MeshError at pinched vertices.
    """
    k = elements.shape[1]
    origin = elements.ravel()
    half = np.full(slots, -1, np.int64)
    half[origin] = np.arange(len(origin))
    open_edges = np.flatnonzero(twin < 0)
    starts = np.bincount(origin[open_edges], minlength=slots)
    if (starts > 1).any():
        raise MeshError(
            f"the mesh is not manifold: its parts touch only in vertex {int(np.argmax(starts > 1))}"
        )
    half[origin[open_edges]] = open_edges

    # one sweep from `half` must meet as many half-edges as leave the vertex
    expected = np.bincount(origin, minlength=slots)
    met = np.zeros(slots, np.int64)
    vertices = np.flatnonzero(half >= 0)
    at = half[vertices]
    while len(vertices):
        met[vertices] += 1
        at = twin[at - 1 + k * (at % k == 0)]
        going = (at >= 0) & (at != half[vertices])
        vertices, at = vertices[going], at[going]
    if (met != expected).any():
        vertex = int(np.argmax(met != expected))
        raise MeshError(f"the mesh is not manifold: its parts touch only in vertex {vertex}")
    return half


def boundary_chain(elements: np.ndarray, twin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The boundary edges as (from, to) vertex ids, the domain on their left."""
    open_edges = np.flatnonzero(twin < 0)
    k = elements.shape[1]
    flat = elements.ravel()
    return flat[open_edges], flat[open_edges + 1 - k * ((open_edges + 1) % k == 0)]


def counter_clockwise(points: np.ndarray, elements: np.ndarray) -> np.ndarray:
    """The elements (m, k), each turned if the mesh lies in a plane z = const and is clockwise.

    It is if the signed areas sum up to less than zero: with the boundary counter-clockwise they are
    the area inside, whatever is inverted.
    """
    checked, corners = checked_input(points, elements)
    places = checked[corners.ravel()]
    if not is_flat(places):
        return elements
    x, y = (places[:, axis].reshape(corners.shape) - places[0, axis] for axis in (0, 1))
    twice = (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum()
    return np.roll(elements[:, ::-1], 1, axis=1) if twice < 0.0 else elements


def is_flat(points: np.ndarray) -> bool:
    """Whether points (n, 3) lie in a plane z = const."""
    z = points[:, 2]
    return bool(z.max() - z.min() <= 1e-12 * max(1.0, float(np.abs(points).max())))


def boundary_angles(
    points: np.ndarray,
    elements: np.ndarray,
    vertices: np.ndarray,
    before: np.ndarray,
    after: np.ndarray,
) -> np.ndarray:
    """Angle in degrees of the domain at boundary vertices: by the boundary's directions in a plane
    z = const, else the sum of the elements' angles there.
    """
    if is_flat(points[elements.ravel()]):
        return planar_boundary_angles(points[vertices], points[before], points[after])
    corner = points[elements]
    back = np.roll(corner, 1, axis=1) - corner
    ahead = np.roll(corner, -1, axis=1) - corner
    cross = np.linalg.norm(np.cross(ahead, back), axis=2)
    angle = np.degrees(np.arctan2(cross, np.einsum("eci,eci->ec", ahead, back)))
    return np.bincount(elements.ravel(), weights=angle.ravel(), minlength=len(points))[vertices]


def build(
    points: np.ndarray,
    elements: np.ndarray,
    geometric: np.ndarray | None,
    desired_degree: np.ndarray | None,
    corner_angle: float = CORNER_ANGLE,
    boundary: MeshBoundary | None = None,
    seats: Seats | None = None,
    regions: np.ndarray | None = None,
) -> tuple[MeshArrays, MeshBoundary]:
    """Arrays of the mesh with these (n, 2|3) points and (m, k) elements, and its curves.

    See `from_elements`; here `boundary` and `seats` are taken as they are, and no point is moved.
    """
    points, elements = checked_input(points, elements)
    n, (m, k) = len(points), elements.shape
    twin = twins_of(elements)
    half = halves_of(elements, twin, n)
    start, end = boundary_chain(elements, twin)
    before, after = np.full(n, -1), np.full(n, -1)
    after[start], before[end] = end, start
    regions = checked_regions(regions, m)
    chains: list[Chain] = []
    drawn = boundary is not None and seats is not None
    if boundary is not None:
        ends = [v for one in boundary.interfaces for v in one[3:] if 0 <= v < n]
        junctions = np.array(ends, np.int64)
    else:
        chains, junctions = interface_chains(elements, twin, regions)

    flags = np.zeros(n, np.int32)
    if geometric is not None:
        flags[np.asarray(geometric, bool)] = GEOMETRIC
        flags[half < 0] = 0
    elif not drawn:
        turn = turning_angles(points[start], points[before[start]], points[after[start]])
        flags[start[turn > corner_angle]] = GEOMETRIC
        for chain in chains:
            flags[_corners(points, chain, corner_angle)] = GEOMETRIC
    flags[junctions] |= GEOMETRIC
    if boundary is None or seats is None:
        loops = [Chain(loop, True) for loop in trace_loops(start, end)]
        names = ("",) * (int(regions.max()) + 1)
        boundary, seats = polyline_boundary(points, [*loops, *chains], flags > 0, names)

    arrays = allocate(k, n + n // 4 + 64, m + m // 4 + 64)
    arrays.edge[: k * m, ORIGIN] = elements.ravel()
    arrays.edge[: k * m, TWIN] = twin
    arrays.points[:n] = points
    arrays.vertex[:n, HALF] = half
    arrays.vertex[:n, CURVE] = np.where(half >= 0, seats.curve, -1)
    arrays.parameter[:n] = np.where(arrays.vertex[:n, CURVE] >= 0, seats.parameter, 0.0)
    arrays.region[:m] = regions
    arrays = arrays._replace(curves=boundary.curves, interface=boundary.table())
    arrays.counters[ELEMENT_SLOTS] = m

    degree = np.bincount(elements.ravel(), minlength=n)
    degree[start] += 1
    curved = drawn or len(chains) > 0
    found = sectors(arrays) if curved and (geometric is None or desired_degree is None) else None
    if found is not None and drawn and geometric is None:
        flags[corners(found, arrays, boundary, corner_angle)[:n]] = GEOMETRIC
    if desired_degree is None:
        desired = np.where(half >= 0, TRIANGLE_INSIDE if k == 3 else QUAD_INSIDE, 0)
        if found is not None and is_flat(points[elements.ravel()]):
            there = np.unique(found.vertex)
            desired[there] = desired_by_sectors(found, k, n)[there]
        else:
            angle = boundary_angles(points, elements, start, before[start], after[start])
            desired[start] = desired_on_boundary(angle, k)
    else:
        desired = np.where(half >= 0, np.asarray(desired_degree, np.int64), 0)
        if len(desired) != n or (desired[half >= 0] < 1).any():
            raise MeshError("desired_degree must hold one positive number for each point")
    arrays.vertex[:n, DEGREE] = degree
    arrays.vertex[:n, DESIRED] = desired
    arrays.vertex[:n, FLAGS] = flags
    delta = degree - desired
    irregular = np.flatnonzero(delta)
    arrays.irregular[: len(irregular)] = irregular
    arrays.vertex[irregular, PLACE] = np.arange(len(irregular))
    counters = arrays.counters
    counters[VERTEX_SLOTS] = n
    counters[VERTICES], counters[ELEMENTS] = int((half >= 0).sum()), m
    counters[BOUNDARY_EDGES] = len(start)
    counters[SCORE], counters[DELTA_SUM] = int(np.abs(delta).sum()), int(delta.sum())
    counters[IRREGULAR] = len(irregular)
    for vertex in np.flatnonzero(half < 0)[::-1]:
        arrays.vertex[vertex, HALF] = -2 - counters[FREE_VERTEX]
        counters[FREE_VERTEX] = vertex
    return arrays, boundary


def checked_regions(regions: np.ndarray | None, elements: int) -> np.ndarray:
    """The region of each element as (m,) int64, 0 where none is given; MeshError if invalid."""
    if regions is None:
        return np.zeros(elements, np.int64)
    regions = np.asarray(regions)
    if regions.shape != (elements,) or not np.issubdtype(regions.dtype, np.integer):
        raise MeshError("regions must hold one whole number for each element")
    if regions.min() < 0 or regions.max() > np.iinfo(np.int32).max:
        raise MeshError("regions must be numbered from 0")
    return regions.astype(np.int64)


def _corners(points: np.ndarray, chain: Chain, corner_angle: float) -> np.ndarray:
    """The vertices at which an interface turns by more than `corner_angle` degrees."""
    line = chain.vertices
    before, after = np.roll(line, 1), np.roll(line, -1)
    if not chain.closed:
        line, before, after = line[1:-1], line[:-2], line[2:]
    return line[turning_angles(points[line], points[before], points[after]) > corner_angle]


def trace_loops(start: np.ndarray, end: np.ndarray) -> list[np.ndarray]:
    """Closed loops of vertex ids from boundary edges (start[i], end[i]), each begun at its least
    id.
    """
    onward = dict(zip(start.tolist(), end.tolist(), strict=True))
    loops = []
    for first in sorted(onward):
        if first not in onward:
            continue
        loop = [first]
        vertex = onward.pop(first)
        while vertex != first:
            loop.append(vertex)
            vertex = onward.pop(vertex)
        loops.append(np.array(loop, np.int64))
    return loops
