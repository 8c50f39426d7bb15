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


def element_shapes(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) shape of each element, in the order of `mesh.elements()`; 0 or less where folded.

    Measured at the samples of :mod:`meshwright_core.geometry.quality`, so that an element is
    folded here if and only if it counts as inverted there.
    """
    ids, elements = mesh.element_ids(), mesh.elements()
    normal = plane_normal(mesh)
    if normal is None:
        reference, halfedges = reference_normals(mesh.points, elements), np.zeros(0, np.int64)
    else:
        reference, halfedges = np.tile(normal, (len(ids), 1)), None
    curved = curved_elements(mesh, ids, elements, halfedges)
    found: np.ndarray = _shapes(
        mesh.points, elements, curved, np.ascontiguousarray(reference, float)
    )
    return found
