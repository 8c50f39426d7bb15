"""The arrow that shows a half-edge: inside its element, parallel to the edge."""

from __future__ import annotations

import numpy as np

DEEP = 9.0
"""The largest distance from the edge to the arrow, in pixels."""
POINT = 9.0


def arrow(corners: np.ndarray, side: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Start (2,) and end (2,) of the shaft and the triangle (3, 2) of the head, in pixels.

    corners (k, 2): those of the element; side: the index of the half-edge in it.
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
