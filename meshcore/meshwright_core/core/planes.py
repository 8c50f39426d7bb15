"""Planes in space: a mesh in one is edited in the coordinates of the plane."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

Vector = tuple[float, float, float]


class Plane(NamedTuple):
    """A plane with coordinates: the point (x, y, z) there is origin + x u + y v + z (u x v)."""

    origin: Vector
    u: Vector
    """A unit vector in the plane."""
    v: Vector
    """A unit vector in the plane, at right angles to `u`."""

    @property
    def normal(self) -> np.ndarray:
        """(3,) the unit vector u x v, from whose side the mesh runs counter-clockwise."""
        return np.cross(self.u, self.v)

    def in_space(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3) given in the plane's coordinates, in space (n, 3)."""
        axes = np.array([self.u, self.v, self.normal])
        return np.array(self.origin) + points @ axes

    def in_plane(self, points: np.ndarray) -> np.ndarray:
        """Points (n, 3) in space as (n, 2) coordinates in the plane; heights are dropped."""
        return (points - np.array(self.origin)) @ np.array([self.u, self.v]).T

    @property
    def sound(self) -> bool:
        """Whether the numbers are finite and the vectors are unit ones at right angles."""
        axes = np.array([self.u, self.v])
        if not (np.isfinite(axes).all() and np.isfinite(self.origin).all()):
            return False
        return bool(np.abs(axes @ axes.T - np.eye(2)).max() < 1e-9)
