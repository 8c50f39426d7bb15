"""Coordinates in the plane of a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.geometry.planes import plane_normal, unit

if TYPE_CHECKING:
    from meshwright_core.blocks.structure import BlockStructure


@dataclass(frozen=True, eq=False)
class PlaneFrame:
    """An origin and two axes in the plane, from above which elements run counter-clockwise."""

    origin: np.ndarray
    """(3,)"""
    axes: np.ndarray
    """(2, 3) orthonormal."""

    @classmethod
    def of(cls, structure: BlockStructure) -> PlaneFrame:
        """The plane of the mesh; that of x and y where it lies in z = const. Raises MeshError for a
        mesh that is not plane.
        """
        normal = plane_normal(structure.mesh)
        if normal is None:
            raise MeshError("The mesh does not lie in a plane; block grids are made in planes.")
        origin = np.zeros(3)
        if abs(normal[2]) == 1.0:
            origin[2] = structure.points[0, 2]
            return cls(origin, np.array([[1.0, 0.0, 0.0], [0.0, np.sign(normal[2]), 0.0]]))
        origin = structure.points[0]
        first = unit(np.cross(normal, np.eye(3)[int(np.abs(normal).argmin())]))
        return cls(origin, np.stack([first, np.cross(normal, first)]))

    def flat(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) coordinates of points (n, 3)."""
        return np.ascontiguousarray((points - self.origin) @ self.axes.T)

    def space(self, flat: np.ndarray) -> np.ndarray:
        """(n, 3) points at coordinates (n, 2)."""
        return self.origin + flat @ self.axes
