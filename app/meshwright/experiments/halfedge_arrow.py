"""The arrow of a half-edge: just inside its element, along its own side of the edge."""

from __future__ import annotations

import numpy as np

DEEP = 9.0
"""Pixels from the edge to the arrow, at most."""
POINT = 9.0


def arrow(corners: np.ndarray, side: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Tail (2,), neck (2,) and the triangle (3, 2) of the point, in pixels.

    corners (k, 2): of the element; side: which of its edges the half-edge is.
    """
    a, b = corners[side], corners[(side + 1) % len(corners)]
    centre = corners.mean(axis=0)
    depth = max(float(np.hypot(*(centre - (a + b) / 2.0))), 1e-6)
    share = min(0.22, DEEP / depth)
    a, b = a + (centre - a) * share, b + (centre - b) * share
    tail, head = a + (b - a) * 0.12, b - (b - a) * 0.12
    length = max(float(np.hypot(*(head - tail))), 1e-6)
    along = (head - tail) / length
    size = min(POINT, 0.5 * length)
    neck = head - along * size
    across = np.array([-along[1], along[0]]) * 0.45 * size
    return tail, neck, np.array([head, neck + across, neck - across])
