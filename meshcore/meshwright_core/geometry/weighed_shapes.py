"""The shape of elements as searches weigh it: the scaled Jacobian, less for long thin elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.element_sines import THIN
from meshwright_core.geometry.quality import scaled_jacobian

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


def weighed_shapes(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) scaled Jacobian of each element, or :data:`THIN` times its shape if that is less: the
    measure of :func:`meshwright_core.geometry.element_sines.thinness` for whole elements, in the
    order of `mesh.elements()`.
    """
    found: np.ndarray = np.minimum(scaled_jacobian(mesh), THIN * element_shapes(mesh))
    return found


def weighed_worst(mesh: HalfEdgeMesh) -> float:
    """The least of :func:`weighed_shapes`, 1 for a mesh without elements."""
    return float(weighed_shapes(mesh).min(initial=1.0))
