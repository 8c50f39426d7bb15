"""Small random meshes with curves as boundary and interfaces, for tests and the fuzz benchmark."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from meshwright_core.core.arrays import ORIGIN
from meshwright_core.core.composite_curves import (
    joined_curves,
    place_all,
    span_length,
    tangents,
)
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.core.mesh_boundary import CurvePiece
from meshwright_core.mesh import HalfEdgeMesh

_GAUSS_NODES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(24)


def grid_regions(width: int, height: int, rng: np.random.Generator) -> np.ndarray:
    """The region of each cell (width * height,) of a grid, row by row, by a random pattern.

    Two halves, an insert, three regions that meet in a vertex, or each cell one of two or three.
    """
    x, y = np.tile(np.arange(width), height), np.repeat(np.arange(height), width)
    pattern = rng.integers(4)
    if pattern == 1 and width > 2 and height > 2:
        inside = (x > 0) & (x < width - 1) & (y > 0) & (y < height - 1)
        return inside.astype(np.int64)
    halves = (2 * x >= width).astype(np.int64)
    if pattern == 2 and height > 1:
        return halves * (1 + (2 * y >= height))
    if pattern == 3:
        return rng.integers(int(rng.integers(2, 4)), size=width * height)
    return halves


def bent(mesh: HalfEdgeMesh, rng: np.random.Generator) -> HalfEdgeMesh:
    """The same mesh with an arc for every stretch of its curves between geometric vertices.

    Its vertices lie on them evenly; of closed curves without geometric vertex one is a circle's
    worth of arcs.
    """
    old, geometric = mesh.boundary_info, mesh.geometric()
    curve = mesh.curve_ids().astype(np.int64)
    chains, pieces = [], []
    seat = np.zeros(mesh.slots)
    for number, line in enumerate(_vertices_along(mesh)):
        closed = bool(old.curves.closed[number])
        stops = np.flatnonzero(geometric[line]).tolist()
        if closed and len(stops) < 2:
            stops = sorted({*stops, 0, len(line) // 2})
        if closed:
            # the first stop becomes the start of the curve
            line = np.roll(line, -stops[0])
            stops = [stop - stops[0] for stop in stops] + [len(line)]
            line = np.append(line, line[0])
        else:
            stops = sorted({0, *stops, len(line) - 1})
        spans, t, drawn = [], 0.0, []
        for first, last in pairwise(stops):
            a, b = mesh.points[line[first]], mesh.points[line[last]]
            arc = _arc(a, b, float(rng.uniform(-0.6, 0.6)))
            length = span_length(arc)
            share = np.arange(last - first) / (last - first)
            own = curve[line[first:last]] == number
            seat[line[first:last][own]] = (t + share * length)[own]
            drawn.append(CurvePiece(t, t + length, "arc"))
            spans.append(arc)
            t += length
        if not closed and curve[line[-1]] == number:
            seat[line[-1]] = t
        chains.append(spans)
        pieces.append(tuple(drawn))
    curves = joined_curves(chains, old.curves.closed.tolist())
    boundary = replace(old, curves=curves, pieces=tuple(pieces))
    # the ends of spans are sums of lengths, rounded as the seats are
    seat = np.where(curve >= 0, np.minimum(seat, boundary.lengths()[np.maximum(curve, 0)]), 0.0)
    return HalfEdgeMesh.from_elements(
        mesh.points,
        mesh.elements(),
        geometric,
        mesh.desired(),
        boundary=boundary,
        seats=(curve, seat),
        regions=mesh.regions(),
    )


def _arc(a: np.ndarray, b: np.ndarray, bulge: float) -> np.ndarray:
    """A span (3, 4): the circular arc from a to b with the tangent of a quarter of its angle."""
    cosine = (1.0 - bulge * bulge) / (1.0 + bulge * bulge)
    chord = b - a
    apex = 0.5 * (a + b)
    apex[:2] += bulge / (1.0 - bulge * bulge) * np.array([chord[1], -chord[0]])
    return np.array([[*a, 1.0], [*(cosine * apex), cosine], [*b, 1.0]])


def _vertices_along(mesh: HalfEdgeMesh) -> list[np.ndarray]:
    """The vertices of each curve in order, closed ones without repeating the first."""
    halfedges = mesh.halfedges_of(mesh.element_ids()).ravel()
    curve, span = edge_places(mesh.arrays, halfedges, mesh.k)
    lines = []
    for number in range(mesh.boundary_info.count):
        on_it = np.flatnonzero((curve == number) & (span[:, 1] > span[:, 0]))
        on_it = on_it[np.argsort(span[on_it, 0])]
        line = mesh.arrays.edge[halfedges[on_it], ORIGIN].astype(np.int64)
        if not mesh.boundary_info.curves.closed[number]:
            line = np.append(line, mesh.target(int(halfedges[on_it[-1]])))
        lines.append(line)
    return lines


def region_areas(mesh: HalfEdgeMesh) -> np.ndarray:
    """(r,) area of each region of a plane mesh, its sides along the curves between vertices."""
    halfedges = mesh.halfedges_of(mesh.element_ids()).ravel()
    curve, span = edge_places(mesh.arrays, halfedges, mesh.k)
    curves, lengths = mesh.boundary_info.curves, mesh.boundary_info.lengths()
    pieces: list[tuple[int, int, float, float]] = []  # region, curve, and a range within a span
    regions = mesh.arrays.region[halfedges // mesh.k].tolist()
    for region, number, (start, stop) in zip(regions, curve.tolist(), span.tolist(), strict=True):
        if number < 0:
            continue
        first, last = curves.first_span[number], curves.first_span[number + 1]
        ends, length = curves.start[first:last].tolist(), float(lengths[number])
        low, high = min(start, stop), max(start, stop)
        knots = (t for turn in (0.0, length) for t in (end + turn for end in ends))
        cuts = [low, *sorted({t for t in knots if low < t < high}), high]
        steps = pairwise(cuts if start < stop else cuts[::-1])
        pieces += [(region, number, a, b) for a, b in steps]
    areas = np.zeros(len(mesh.region_names))
    if pieces:
        of, which, begin, end = map(np.array, zip(*pieces, strict=True))
        np.add.at(areas, of, _swept(mesh, which, begin, end))
    return areas


def _swept(mesh: HalfEdgeMesh, which: np.ndarray, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Half the integrals (n,) of x dy - y dx along the curves `which` (n,) from parameters `begin`
    to `end` (n,), which lie in the same span.
    """
    half = 0.5 * (end - begin)
    t = 0.5 * (begin + end)[:, None] + half[:, None] * _GAUSS_NODES
    numbers = np.repeat(which, len(_GAUSS_NODES))
    p = place_all(mesh.boundary_info.curves, numbers, t.ravel())
    d = tangents(mesh.boundary_info.curves, numbers, t.ravel())
    turning: np.ndarray = (p[:, 0] * d[:, 1] - p[:, 1] * d[:, 0]).reshape(t.shape)
    return 0.5 * half * (turning @ _GAUSS_WEIGHTS)
