"""A lower bound of the Jacobian of a quad between segments and arcs of circles, from its samples.

Where it is positive the quad is valid at every point, not only at the samples of
:mod:`meshwright_core.geometry.coons`. `docs/jacobian_bound.md` derives it:

    J >= min J_s - (1 / 2 n) (M_u Q + P W + M_v P + Q W)

for samples J_s at the (n + 1)^2 points of a grid, with M_i = 1.03 r_i a_i^2 of the arc of radius
r_i that turns by a_i along side i (0 for segments), M_u = max(M_0, M_2), M_v = max(M_1, M_3),
W = |V_0 - V_1 + V_2 - V_3| + (M_0 + M_1 + M_2 + M_3) / 2, P = max |X_u| + (M_u + W) / 2 n and
Q = max |X_v| + (M_v + W) / 2 n, the maxima over the samples.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BEND = 1.03
"""Largest second derivative of an arc of spans of up to 45 degrees by its parameter from 0 to 1, in
radii times squared angle; 1 if the parameter were the arc length."""


def jacobian_bound(corners: Array, bends: Array, along: Array, across: Array, parts: int) -> Array:
    """(m,) lower bounds of the Jacobian over quads whose sides are segments and arcs.

    Args:
        corners: (m, 4, 2).
        bends: (m, 4) radius times squared angle, in radians, of each side; 0 for segments.
        along: (m, s, 2) derivatives X_u of the Coons map at the samples.
        across: (m, s, 2) derivatives X_v.
        parts: n, with the samples at all points of an (n + 1) x (n + 1) grid.
    """
    most = BEND * bends
    bend_u, bend_v = np.maximum(most[:, 0], most[:, 2]), np.maximum(most[:, 1], most[:, 3])
    reach = 0.5 / parts
    twist = np.linalg.norm(corners[:, 0] - corners[:, 1] + corners[:, 2] - corners[:, 3], axis=1)
    twist = twist + 0.5 * most.sum(axis=1)
    first = np.linalg.norm(along, axis=2).max(axis=1) + reach * (bend_u + twist)
    second = np.linalg.norm(across, axis=2).max(axis=1) + reach * (bend_v + twist)
    sampled = along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0]
    slope = bend_u * second + first * twist + bend_v * first + second * twist
    bound: Array = sampled.min(axis=1) - reach * slope
    return bound
