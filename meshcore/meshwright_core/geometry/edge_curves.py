"""The true shape of the edges of a mesh: on boundary and interfaces that of the curve between
their ends (:mod:`meshwright_core.geometry.edge_parts`). All other edges are straight.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from meshwright_core.core.arrays import ELEMENT_SLOTS, ORIGIN, TWIN
from meshwright_core.core.composite_curves import Curves, place_all
from meshwright_core.geometry.edge_parts import EdgeParts
from meshwright_core.geometry.planes import plane_normal, vector_areas
from meshwright_core.geometry.turning import BENDS, CurveTurning, Turning

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


def ends_of(mesh: HalfEdgeMesh, halfedges: np.ndarray) -> np.ndarray:
    """(n, 2) vertices where half-edges (n,) start and end."""
    ahead = halfedges - halfedges % mesh.k + (halfedges + 1) % mesh.k
    origin = mesh.arrays.edge[:, ORIGIN]
    return np.stack([origin[halfedges], origin[ahead]], axis=1).astype(np.int64)


def curve_halfedges(mesh: HalfEdgeMesh) -> np.ndarray:
    """Ids, ascending, of all half-edges along curves: on the boundary, and both of an edge between
    two regions.
    """
    slots = mesh.k * int(mesh.arrays.counters[ELEMENT_SLOTS])
    origin, twin = mesh.arrays.edge[:slots, ORIGIN], mesh.arrays.edge[:slots, TWIN]
    found = (origin >= 0) & (twin < 0)
    region = mesh.arrays.region[: slots // mesh.k]
    if len(region) and (region != region[0]).any():
        own = np.repeat(region, mesh.k)
        found |= (twin >= 0) & (own != own[np.maximum(twin, 0)]) & (origin >= 0)
    return np.flatnonzero(found)


def bent_edges(
    mesh: HalfEdgeMesh, halfedges: np.ndarray | None = None
) -> tuple[np.ndarray, EdgeParts]:
    """The half-edges that are not straight, of those given (n,) or of all, and their places."""
    found = curve_halfedges(mesh) if halfedges is None else np.asarray(halfedges, np.int64)
    parts = EdgeParts.of(mesh.arrays, found, mesh.k)
    rows = np.flatnonzero(parts.turning(CurveTurning.of(mesh)) > BENDS)
    return found[rows], parts.take(rows)


def curved_halfedges(mesh: HalfEdgeMesh) -> np.ndarray:
    """Ids, ascending, of the half-edges whose true edge is not straight; both of an interface."""
    return bent_edges(mesh)[0]


def is_straight(mesh: HalfEdgeMesh, h: int) -> bool:
    """Whether the true edge of half-edge h is a segment, to 1e-7 radians of turning."""
    return not len(bent_edges(mesh, np.array([h]))[0])


def edge_points(mesh: HalfEdgeMesh, h: int, w: ArrayLike) -> np.ndarray:
    """(n, 3) points of the true edge of half-edge h at the fractions w (n,) of its parameters.

    0 is the origin of h, 1 its target; both are met to the bit.
    """
    shares = np.asarray(w, np.float64).reshape(-1)
    edge = EdgeParts.of(mesh.arrays, np.array([h]), mesh.k)
    return edge.points(np.zeros(len(shares), np.int64), shares)


def edge_polyline(mesh: HalfEdgeMesh, h: int, tolerance: float) -> np.ndarray:
    """(n, 3) polyline of the true edge of half-edge h, from its origin to its target.

    It leaves the edge by no more than `tolerance` > 0, and has a point at every kink.
    """
    return EdgeParts.of(mesh.arrays, np.array([h]), mesh.k).polylines(tolerance)[0]


def curved_edge_polylines(
    mesh: HalfEdgeMesh, tolerance: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Polylines of all edges that are not straight, each edge once, for drawing.

    Returns:
        halfedges (n,), ascending, of two the lower one; where the points of each begin (n + 1,);
        points (p, 3), each polyline from the origin of its half-edge to the target. Accuracy as in
        :func:`edge_polyline`.
    """
    halfedges, parts = bent_edges(mesh)
    twin = mesh.arrays.edge[halfedges, TWIN]
    once = np.flatnonzero((twin < 0) | (twin > halfedges))
    points, first = parts.take(once).polylines(tolerance)
    return halfedges[once], first, points


def loop_polyline(curves: Curves, turning: Turning, loop: int, turn: float) -> np.ndarray:
    """(n, 3) points around a closed curve, so close that it turns by no more than `turn` radians
    between them; the first is not repeated.
    """
    spans = np.arange(curves.first_span[loop], curves.first_span[loop + 1])
    pieces = np.maximum(np.ceil(turning.inside[spans] / turn), 1).astype(np.int64)
    share = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    start, stop = curves.start[spans], curves.stop[spans]
    t = np.repeat(start, pieces) + share * np.repeat((stop - start) / pieces, pieces)
    return place_all(curves, np.full(len(t), loop, np.int64), t)


def element_areas(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) areas of the elements with their true edges, in the order of `mesh.elements()`.

    Signed in a plane: negative where an element turns clockwise. On other surfaces the lengths of
    the vector areas.
    """
    areas = vector_areas(mesh.points, mesh.elements())
    halfedges, parts = bent_edges(mesh)
    rows = np.searchsorted(mesh.element_ids(), halfedges // mesh.k)
    np.add.at(areas, rows, parts.bulges())
    normal = plane_normal(mesh)
    if normal is None:
        lengths: np.ndarray = np.linalg.norm(areas, axis=1)
        return lengths
    signed: np.ndarray = areas @ normal
    return signed
