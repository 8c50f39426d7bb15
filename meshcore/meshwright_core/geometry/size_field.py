"""The size of a mesh's elements as a function of place, to be followed by another mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry.edge_curves import element_areas

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

_NEAREST = 6
"""Elements that the size at a point is interpolated between."""


def element_sizes(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) edge length of the square, or equilateral triangle, of the area of each element."""
    areas = np.abs(element_areas(mesh))
    sizes: np.ndarray = np.sqrt(areas if mesh.k == 4 else areas * (4.0 / np.sqrt(3.0)))
    return sizes


class SizeField:
    """Element sizes at points, interpolated between the nearest elements.

    Args:
        mesh: with at least one element; later edits of it are not seen.
    """

    def __init__(self, mesh: HalfEdgeMesh) -> None:
        """Take the sizes of all elements at their centres."""
        from scipy.spatial import cKDTree  # here: it takes a quarter of a second

        sizes = element_sizes(mesh)
        self.largest = float(sizes.max())
        self._log = np.log(np.maximum(sizes, 1e-9 * self.largest + 1e-300))
        self._tree = cKDTree(mesh.points[mesh.elements()].mean(axis=1))

    def at(self, points: np.ndarray) -> np.ndarray:
        """(n,) sizes at points (n, 3): the geometric mean over the nearest elements, weighted by
        the inverse square of their distance.
        """
        count = min(_NEAREST, len(self._log))
        distance, element = self._tree.query(points, k=count)
        distance, element = distance.reshape(len(points), -1), element.reshape(len(points), -1)
        near = np.exp(self._log[element[:, 0]])[:, None]
        weight = 1.0 / (distance**2 + (0.25 * near) ** 2)
        found: np.ndarray = np.exp((weight * self._log[element]).sum(axis=1) / weight.sum(axis=1))
        return found

    def ratios(self, mesh: HalfEdgeMesh) -> np.ndarray:
        """(m,) size of each element of another mesh relative to the size wanted at its centre."""
        centres = mesh.points[mesh.elements()].mean(axis=1)
        found: np.ndarray = element_sizes(mesh) / self.at(centres)
        return found
