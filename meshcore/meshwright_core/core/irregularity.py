"""Desired degrees of vertices and corners of the boundary (section 2.1 and equation 2)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from meshwright_core.core.compilation import bare_kernel

TRIANGLE_INSIDE, TRIANGLE_STRAIGHT = 6, 4
QUAD_INSIDE, QUAD_STRAIGHT = 4, 3
"""Desired degree inside and on a straight side, for triangles (60 degrees) and quads (90)."""

CORNER_ANGLE = 0.01
"""Degrees by which the boundary must turn at a vertex that counts as a corner by default."""


@bare_kernel
def usual_desired(k, boundary):
    """Desired degree of a new vertex, inside or on a straight side."""
    if k == 3:
        return TRIANGLE_STRAIGHT if boundary else TRIANGLE_INSIDE
    return QUAD_STRAIGHT if boundary else QUAD_INSIDE


def turning_angles(points: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Angle in degrees by which the boundary turns at each vertex, without sign.

    points, before, after: (n, 3) coordinates of boundary vertices and their boundary neighbours.
    """
    come, go = points - before, after - points
    cross = np.linalg.norm(np.cross(come, go), axis=1)
    return np.degrees(np.arctan2(cross, np.einsum("ij,ij->i", come, go)))


def planar_boundary_angles(points: np.ndarray, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Interior angle in degrees, in (0, 360), at boundary vertices of a mesh in a plane z = const.

    points, before, after: (n, 3); the domain lies to the left of before -> point -> after.
    """
    come, go = points - before, after - points
    cross = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0]
    return 180.0 - np.degrees(np.arctan2(cross, np.einsum("ij,ij->i", come, go)))


def desired_on_boundary(angles: np.ndarray, k: int) -> np.ndarray:
    """Equation 2 on the boundary: max(round(angle / alpha) + 1, 2), alpha = 60 or 90 degrees.

    A tolerance of 1e-9 is added, so that an angle of exactly 1.5 alpha always rounds up.
    """
    alpha = 60.0 if k == 3 else 90.0
    return np.maximum(np.floor(angles / alpha + 0.5 + 1e-9).astype(np.int64) + 1, 2)


def usual_desired_degree(k: int, boundary: bool) -> int:
    """Desired degree of a vertex that is not geometric, inside or on a straight side."""
    if k == 3:
        return TRIANGLE_STRAIGHT if boundary else TRIANGLE_INSIDE
    return QUAD_STRAIGHT if boundary else QUAD_INSIDE


def desired_between(angles: Sequence[float], k: int, boundary: bool) -> int:
    """The sum rule: desired degree of a vertex from the angles of the regions around it.

    Each sector between two curves, of boundary or interface, takes max(1, round(angle / alpha))
    elements, alpha = 60 or 90 degrees; the degree is their number, and one more on the boundary.
    With one sector on the boundary this is equation 2.

    Args:
        angles: degrees, of each sector inside the domain.
        k: 3 or 4 sides of an element.
        boundary: whether one of the sectors around the vertex is outside.
    """
    degrees = desired_on_boundary(np.asarray(angles, np.float64), k)
    return int((degrees - 1).sum()) + boundary
