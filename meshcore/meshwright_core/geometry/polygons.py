"""Tests of points against polygons in the plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

BLOCK = 1 << 20
"""Pairs of a point and an edge that are tested at once."""


def contains(polygons: np.ndarray, x: ArrayLike, y: ArrayLike) -> np.ndarray:
    """Whether each polygon contains the point (x, y), by the even-odd rule.

    Counts the edges that a ray from the point to the right crosses; the orientation of a polygon
    does not matter, and it may cross itself.

    Args:
        polygons: (..., k, 2) corners in order.
        x: coordinates that broadcast with the leading axes of `polygons`.
        y: coordinates of the same shape as `x`.
    """
    ax, ay = polygons[..., 0], polygons[..., 1]
    bx, by = np.roll(ax, -1, axis=-1), np.roll(ay, -1, axis=-1)
    px, py = np.asarray(x)[..., None], np.asarray(y)[..., None]
    straddles = (ay > py) != (by > py)
    # a level edge is never crossed: its rise only has to be no zero
    crossing = ax + (py - ay) * (bx - ax) / np.where(ay == by, 1.0, by - ay)
    inside: np.ndarray = np.count_nonzero(straddles & (px < crossing), axis=-1) % 2 == 1
    return inside


def points_inside(points: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """(n,) which of the points (n, 2) lie in the polygon (k, 2), by the even-odd rule."""
    inside = np.zeros(len(points), bool)
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
    step = max(1, BLOCK // len(polygon))
    for first in range(0, len(near), step):
        rows = near[first : first + step]
        inside[rows] = contains(polygon, points[rows, 0], points[rows, 1])
    return inside
