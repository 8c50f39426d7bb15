"""The plane that a mesh lies in, and vector areas."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar
from weakref import WeakKeyDictionary

import numpy as np

from meshwright_core.core.composite_curves import place_all
from meshwright_core.geometry.edge_kernels import NODES, WEIGHTS, bulges

if TYPE_CHECKING:
    from meshwright_core.core.mesh_boundary import MeshBoundary
    from meshwright_core.mesh import HalfEdgeMesh

FLAT = 1e-7
"""Distance from a plane, relative to the extent, below which points lie in it."""


def unit(vectors: np.ndarray) -> np.ndarray:
    """`vectors` (..., 3) divided by their lengths; zero stays zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(lengths > 0.0, lengths, 1.0)


def vector_areas(points: np.ndarray, elements: np.ndarray) -> np.ndarray:
    """(m, 3) vector areas of elements (m, k) with straight sides: normal to the element, as long
    as its area.
    """
    p = points[elements]
    p = p - p[:, :1]
    return 0.5 * np.cross(p, np.roll(p, -1, axis=1)).sum(axis=1)


class OutlineArea:
    """Keeps the vector areas (3,) that the boundary loops of meshes enclose."""

    _known: ClassVar[WeakKeyDictionary[MeshBoundary, np.ndarray]] = WeakKeyDictionary()

    @classmethod
    def of(cls, mesh: HalfEdgeMesh) -> np.ndarray:
        """The vector area of the loops: along the normal of a plane mesh, to the side from which
        its boundary turns counter-clockwise.
        """
        boundary = mesh.boundary_info
        area = cls._known.get(boundary)
        if area is None:
            loops, curves = np.array(boundary.loops, np.int64), boundary.curves
            span = np.zeros((len(loops), 2))
            span[:, 1] = boundary.lengths()[loops]
            starts = place_all(curves, loops, np.zeros(len(loops)))
            ends = np.stack([starts, starts], axis=1)
            area = bulges(curves, loops, span, ends, NODES, WEIGHTS).sum(axis=0)
            cls._known[boundary] = area
        return area


def plane_normal(
    mesh: HalfEdgeMesh, points: np.ndarray | None = None, own: np.ndarray | None = None
) -> np.ndarray | None:
    """(3,) unit normal of the plane that all `points` (n, 3) lie in, or None.

    It points to the side from which the boundary turns counter-clockwise; without a boundary in
    this plane along `own` (3,), the sum of the elements' vector areas.

    Args:
        mesh: the mesh.
        points: those to look at; None: all vertices of the mesh.
        own: see above.
    """
    if points is None:
        points = mesh.points
        if len(points) != mesh.n_vertices:
            points = points[mesh.vertices()]
    if not len(points):
        return None
    outline = OutlineArea.of(mesh)
    if not points[:, 2].any() and outline[2] > 0.0:
        return np.array([0.0, 0.0, 1.0])
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    for area in (outline, own):
        length = 0.0 if area is None else float(np.linalg.norm(area))
        if area is None or length <= 1e-12 * size * size:
            continue
        normal: np.ndarray = area / length
        if np.ptp(points @ normal) <= FLAT * size:
            return normal
    return None
