"""Planes in space that meshes lie in, and coordinates in them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def area_vector(points: Floats, elements: NDArray[np.int64]) -> Floats:
    """The sum (3,) of the elements' area vectors."""
    corner = points[elements]
    return 0.5 * np.cross(corner, np.roll(corner, -1, axis=1)).sum(axis=(0, 1))


def best_axes(points: Floats, elements: NDArray[np.int64]) -> Floats:
    """Two unit vectors (2, 3) in the plane that the elements face, counter-clockwise."""
    normal = area_vector(points - points[elements.ravel()].mean(axis=0), elements)
    return axes_of(normal)


def axes_of(normal: Floats) -> Floats:
    """Two unit vectors (2, 3) at right angles to a normal (3,), right-handed with it.

    They are axes of space where the normal is one.
    """
    length = np.linalg.norm(normal)
    n = normal / length if length > 0 else np.array([0.0, 0.0, 1.0])
    least = int(np.argmax(np.abs(n)))
    first = (least + 1) % 3
    u = np.zeros(3)
    u[first] = 1.0
    u -= (u @ n) * n
    u /= np.linalg.norm(u)
    v = np.cross(n, u)
    return np.array([u, v])
