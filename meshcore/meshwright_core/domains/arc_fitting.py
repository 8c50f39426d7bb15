"""Finds arcs in the polylines of a domain, or in the boundary of a mesh, and puts them there."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.curves.curve import Curve
from meshwright_core.curves.fitting import fit_arcs
from meshwright_core.domains.domain import Domain, turning_angles
from meshwright_core.domains.mesh_on_domain import placed
from meshwright_core.errors import MeshError
from meshwright_core.geometry.true_edges import TrueEdges
from meshwright_core.mesh import HalfEdgeMesh

Points = NDArray[np.float64]

TOLERANCE = 1e-4
"""Distance of the points of a polyline from the arcs that stand for it, relative to the size."""
_COLLINEAR = 1e-9
"""Distance from a line, relative to the size, below which a point lies on it."""


def with_arcs(domain: Domain, tolerance: float = TOLERANCE) -> Domain:
    """The domain with arcs and segments in place of its polylines.

    Curves that are no polylines stay; so do names, where the pieces of a polyline have one.

    Args:
        domain: between polygons or curves.
        tolerance: relative to the size of the domain.
    """
    reach = tolerance * domain.diameter
    angle = CORNER_ANGLE if domain.sides is None else domain.sides.corner_angle
    regions, names = [], []
    for region in domain.regions:
        loops = [_fitted_loop(loop, reach) for loop in region.loops]
        regions.append((region.name, loops))
        names.append([[""] * len(loop) for loop in loops])
    if len(regions) == 1:
        return Domain.from_curves(regions[0][1], domain.name, angle)
    return Domain.from_regions(regions, domain.name, angle)


def mesh_with_arcs(
    mesh: HalfEdgeMesh, corner_angle: float | None = None, tolerance: float = TOLERANCE
) -> HalfEdgeMesh:
    """The mesh with its boundary on arcs and segments that are found in it.

    Args:
        mesh: in the plane, with straight edges; it is not changed.
        corner_angle: degrees by which the boundary turns at a corner; None for the default.
        tolerance: relative to the extent of the mesh.

    Raises:
        MeshError: as :func:`meshwright_core.domains.mesh_on_domain.placed`.
    """
    live = mesh.points[mesh.vertices()]
    if live[:, 2].any():
        raise MeshError("arcs are found only in meshes in the plane z = 0")
    size = float(np.linalg.norm(np.ptp(live, axis=0)))
    edges = TrueEdges(mesh, size)
    angle = CORNER_ANGLE if corner_angle is None else corner_angle
    regions = []
    for number in range(edges.region_count):
        loops = []
        for rim in edges.rims(number):
            points = np.array([edges.line(h)[0] for h in rim.tolist()])
            loops.append(fitted_polygon(points, tolerance * size, _COLLINEAR * size))
        name = mesh.region_names[number] if number < len(mesh.region_names) else ""
        regions.append((name, loops))
    if len(regions) == 1:
        return placed(mesh, Domain.from_curves(regions[0][1], "", angle))
    return placed(mesh, Domain.from_regions(regions, "", angle))


def fitted_polygon(points: Points, reach: float, straight: float = 0.0) -> list[Curve]:
    """Arcs and segments around a closed polygon (n, 2).

    Args:
        points: in order; the first is not repeated.
        reach: distance of the points from the arcs, at most.
        straight: distance from the line through its neighbours below which a point is left out.
    """
    kept = points[_bends(points, straight)]
    if len(kept) < 3:
        kept = points
    # from the sharpest point on: an arc cannot go on there
    first = int(np.argmax(turning_angles(kept)))
    line = np.roll(kept, -first, axis=0)
    return fit_arcs(np.vstack([line, line[:1]]), reach)


def _bends(points: Points, straight: float) -> NDArray[np.bool_]:
    """(n,) whether the points of a polygon are off the lines through their neighbours."""
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    way, off = after - before, points - before
    length = np.hypot(*way.T)
    across = np.abs(way[:, 0] * off[:, 1] - way[:, 1] * off[:, 0])
    found: NDArray[np.bool_] = across > straight * np.where(length > 0.0, length, 1.0)
    return found


def _fitted_loop(loop: Sequence[Curve], reach: float) -> list[Curve]:
    """The curves of a closed loop, each run of straight edges fitted."""
    polygonal = [curve.straight or curve.kind == "polyline" for curve in loop]
    if all(polygonal):
        points = np.concatenate([_corners(curve)[:-1] for curve in loop])
        return fitted_polygon(points, reach)
    first = polygonal.index(False)
    curves = [*loop[first:], *loop[:first]]
    found: list[Curve] = []
    for straight, run in groupby(curves, lambda curve: curve.straight or curve.kind == "polyline"):
        pieces = list(run)
        if not straight or (len(pieces) == 1 and pieces[0].straight):
            found += pieces
            continue
        points = np.concatenate([*(_corners(curve)[:-1] for curve in pieces), [pieces[-1].end]])
        found += fit_arcs(points, reach)
    return found


def _corners(curve: Curve) -> Points:
    """(n, 2) the points of a polyline or a straight curve."""
    if curve.kind == "polyline":
        points: Points = np.asarray(curve.data["points"])
        return points
    return np.array([curve.start, curve.end])
