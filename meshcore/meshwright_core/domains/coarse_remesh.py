"""A coarse quad mesh of the domain that a fine one covers, and the way back to its curves.

A search among block layouts need not start from thousands of elements: their outline, with its
corners, is all that matters. The outline becomes a domain whose sides are polylines through the
boundary vertices, and that is meshed coarsely. What comes of it is put on the curves of the given
mesh again, which carry their names.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.core.projected_seats import projected_seats
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.mesh_on_domain import with_curved_sides
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.errors import MeshError
from meshwright_core.mesh import HalfEdgeMesh

_SAME = 1e-9
"""Distance, relative to the size, up to which two corners count as the same."""


def coarse_mesh(mesh: HalfEdgeMesh, seed: int = 0) -> HalfEdgeMesh | None:
    """A coarse quad mesh of the same domain with the same corners, desired degrees and s*.

    None where there is none: not in the plane z = 0, several regions or components, locked
    vertices, desired degrees that were set by hand along a side, or an outline that cannot be
    meshed so.
    """
    live, boundary = mesh.vertices(), mesh.boundary()
    geometric, desired = mesh.geometric(), mesh.desired()
    plain = boundary & ~geometric
    flat = mesh.kind == "quad" and not mesh.points[live, 2].any()
    if not flat or len(np.unique(mesh.regions())) > 1 or mesh.locked()[live].any():
        return None
    if (desired[plain] != 3).any() or (desired[live][~boundary[live]] != 4).any():
        return None
    loops = mesh.boundary_loops()
    areas = [_area(mesh.points[loop]) for loop in loops]
    if sum(area > 0.0 for area in areas) != 1:
        return None
    order = sorted(range(len(loops)), key=lambda i: -areas[i])
    try:
        rings = [mesh.points[loops[i], :2] for i in order]
        flags = [geometric[loops[i]] for i in order]
        domain = with_curved_sides(Domain(rings[0], rings[1:], flags[0], flags[1:]))
        coarse = mesh_domain(domain, "quad", seed=seed)
    except MeshError:
        return None
    if not _take_corners(coarse, mesh):
        return None
    coarse = coarse.copy()
    return coarse if coarse.optimum == mesh.optimum else None


def _take_corners(coarse: HalfEdgeMesh, mesh: HalfEdgeMesh) -> bool:
    """Give the coarse mesh the corners of the other with their desired degrees; whether each of
    them has a vertex there. Smooth joints of the polylines are no corners.
    """
    from scipy.spatial import cKDTree  # here: it takes a quarter of a second

    corners = np.flatnonzero(mesh.boundary() & mesh.geometric())
    found = np.flatnonzero(coarse.boundary() & coarse.geometric())
    size = float(np.ptp(mesh.points[mesh.vertices()], axis=0).max())
    same = np.zeros(len(found), bool)
    if len(corners):
        away, nearest = cKDTree(mesh.points[corners]).query(coarse.points[found])
        same = away <= _SAME * size
        if len(np.unique(nearest[same])) < len(corners) or same.sum() > len(corners):
            return False
        desired = mesh.desired()[corners[nearest]]
        for vertex, degree in zip(found[same], desired[same], strict=True):
            coarse.set_desired(int(vertex), int(degree))
    for vertex in found[~same].tolist():
        if coarse.desired()[vertex] != 3:
            return False
        coarse.set_geometric(vertex, False)
    return True


def on_curves_of(mesh: HalfEdgeMesh, made: HalfEdgeMesh) -> HalfEdgeMesh:
    """The mesh `made`, which came of :func:`coarse_mesh` of `mesh`, on the curves of `mesh`.

    Boundary vertices are projected to them; regions and names are those of `mesh`. Raises MeshError
    if the two have different outlines.
    """
    live = made.vertices()
    row = np.full(made.slots, -1, np.int64)
    row[live] = np.arange(len(live))
    loops = [row[loop] for loop in made.boundary_loops()]
    points = made.points[live]
    seats = projected_seats(points, loops, mesh.boundary_info)
    return HalfEdgeMesh.from_elements(
        points, row[made.elements()], made.geometric()[live], made.desired()[live],
        boundary=mesh.boundary_info, seats=seats,
        regions=np.full(made.n_elements, int(mesh.regions()[0])),
    )  # fmt: skip


def _area(ring: np.ndarray) -> float:
    x, y = ring[:, 0], ring[:, 1]
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
