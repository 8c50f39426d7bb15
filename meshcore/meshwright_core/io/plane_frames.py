"""The plane in space that the points of a mesh file lie in, to within noise."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.planes import Plane, Vector

_THIN = 1e-6
"""Distance from a plane, relative to the size of the mesh, up to which points lie in it: that
within which points are at the same place, and above the rounding of single precision."""

Floats = NDArray[np.float64]


def flattened(points: Floats, elements: NDArray[np.int64]) -> tuple[Floats, Plane | None, bool]:
    """The points in the plane that they lie in.

    Args:
        points: (n, 3).
        elements: (m, k) elements, neighbours in agreement; most of them run counter-clockwise seen
            from the side that the plane's normal points to.

    Returns:
        the points (n, 3), in the coordinates of a plane if that is not one z = const; that plane,
        None for z = const and for surfaces that are not plane; and whether they are plane.
    """
    z = points[:, 2]
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    if np.ptp(z) <= _THIN * size:
        if np.ptp(z) > 0:
            points = points.copy()
            points[:, 2] = np.median(z)
        return points, None, True
    centre = points.mean(axis=0)
    normal = np.linalg.svd(np.cov((points - centre).T))[2][2]
    axis = np.zeros(3)
    axis[np.argmax(np.abs(normal))] = 1.0
    if np.ptp(points @ axis) <= _THIN * size:
        normal = axis
    if np.ptp((points - centre) @ normal) > _THIN * size:
        return points, None, False
    if area_vector(points - centre, elements) @ normal < 0:
        normal = -normal
    u, v = axes_of(normal)
    distance = float(np.median(points @ normal))
    plane = Plane(_vector(distance * normal), _vector(u), _vector(v))
    flat = plane.in_plane(points)
    return np.column_stack([flat, np.zeros(len(flat))]), plane, True


def _vector(values: Floats) -> Vector:
    x, y, z = (values + 0.0).tolist()
    return x, y, z


def area_vector(points: Floats, elements: NDArray[np.int64]) -> Floats:
    """The sum (3,) of the elements' area vectors."""
    corner = points[elements]
    return np.asarray(0.5 * np.cross(corner, np.roll(corner, -1, axis=1)).sum(axis=(0, 1)))


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
    first = (int(np.argmax(np.abs(n))) + 1) % 3
    u = np.zeros(3)
    u[first] = 1.0
    u -= (u @ n) * n
    u /= np.linalg.norm(u)
    return np.array([u, np.cross(n, u)])
