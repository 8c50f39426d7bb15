"""Finds arcs in the boundary of a mesh with straight edges, and places the mesh on them."""

from __future__ import annotations

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
"""Distance of boundary vertices from the arcs through them, relative to the size of the mesh."""
_COLLINEAR = 1e-9
"""Distance from a line, relative to the size, below which a point lies on it."""


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
