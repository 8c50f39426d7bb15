"""The shape of elements: the worst corner's 2 J / (|a|^2 + |b|^2), which sees the aspect ratio.

a and b are the sides at a corner, J = a x b. It is 1 for a square, and falls with skewness like the
scaled Jacobian, but also with the ratio of the sides: a rectangle of 10 to 1 has 0.2. A triangle is
measured by its mean ratio. With curved sides it is the worst over the samples of the element's map.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.geometry.coons import curved_shape
from meshwright_core.geometry.curved_elements import curved_elements
from meshwright_core.geometry.planes import plane_normal
from meshwright_core.geometry.quality import reference_normals
from meshwright_core.geometry.smoothing import element_shape

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


@kernel
def _shapes(points, elements, curved, reference):
    """(m,) shapes of elements (m, k)."""
    found = np.zeros(len(elements))
    for e in range(len(elements)):
        row = curved.row[e]
        if row < 0:
            found[e] = element_shape(points, elements, e, reference)
        else:
            found[e] = curved_shape(curved, points, row, reference[e])
    return found


def element_shapes(
    mesh: HalfEdgeMesh, ids: np.ndarray | None = None, normal: np.ndarray | None = None
) -> np.ndarray:
    """(m,) shape of each element, in the order of `mesh.elements()`; 0 or less where folded.

    Args:
        mesh: the mesh.
        ids: (m,) the elements to measure, ascending, of a mesh in a plane; None: all.
        normal: (3,) that of the mesh's plane, if the caller knows it.
    """
    if ids is None:
        ids, elements, halfedges = mesh.element_ids(), mesh.elements(), None
    else:
        elements, halfedges = mesh.corners(ids), mesh.halfedges_of(ids).ravel()
    plane = plane_normal(mesh) if normal is None else normal
    if plane is None:  # on other surfaces all sides count as straight
        halfedges = np.zeros(0, np.int64)
    reference = reference_normals(mesh.points, elements, plane)
    elements = np.ascontiguousarray(elements, np.int64)
    curved = curved_elements(mesh, ids, elements, halfedges)
    found: np.ndarray = _shapes(mesh.points, elements, curved, np.ascontiguousarray(reference))
    return found
