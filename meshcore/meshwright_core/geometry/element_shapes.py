"""The shape of elements: the worst corner's 2 J / (|a|^2 + |b|^2), which sees the aspect ratio.

a and b are the sides at a corner, J = a x b. It is 1 for a square, and falls with skewness like the
scaled Jacobian, but also with the ratio of the sides: a rectangle of 10 to 1 has 0.2. A triangle is
measured by its mean ratio, 2 sqrt(3) times twice its area over the sum of its squared sides.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry.outline import Outline
from meshwright_core.geometry.quality import reference_normals

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


def corner_shapes(p: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """(m, k) shape at each corner of quads at p (m, 4, 3), or of triangles (the same at each), with
    the signs of `reference` (m, 3); 0 where both sides have no length.
    """
    forward = np.roll(p, -1, axis=1) - p
    backward = np.roll(p, 1, axis=1) - p
    area = np.einsum("ikj,ij->ik", np.cross(forward, backward), reference)
    square = np.einsum("ikj,ikj->ik", forward, forward)
    total = square + np.roll(square, 1, axis=1)
    scale = 2.0
    if p.shape[1] == 3:
        total, scale = np.repeat(square.sum(axis=1, keepdims=True), 3, axis=1), 2.0 * np.sqrt(3.0)
    found: np.ndarray = scale * area / np.where(total > 0.0, total, np.inf)
    return found


def element_shapes(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) shape of each element, in the order of `mesh.elements()`; 0 or less where folded."""
    elements = mesh.elements()
    normal = Outline.of(mesh).normal(mesh.points[mesh.vertices()])
    reference = reference_normals(mesh.points, elements, normal)
    smallest: np.ndarray = corner_shapes(mesh.points[elements], reference).min(axis=1)
    return smallest
