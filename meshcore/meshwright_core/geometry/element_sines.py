"""The smallest sine of quads as a compiled search changes them: at corners, and where sides bend at
all samples of the Coons map (:mod:`meshwright_core.geometry.coons`).

A sine does not see how long and thin an element is, so each is weighed by :func:`thinness`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import ELEMENT_SLOTS, ORIGIN, along_curve
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.curve_edges import edge_curve, edge_range
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.coons import (
    NODES,
    SAMPLES,
    CurvedElements,
    Samples,
    derivatives,
    place_sides,
)
from meshwright_core.geometry.turning import BENDS, turning_between
from meshwright_core.geometry.vectors import determinant, inner

MOST_TURN = np.radians(300.0)
"""Radians that one edge may turn: the samples of an element see no more."""


THIN = 4.0
"""Half of P/Q + Q/P, with the lengths P and Q of the sides at a corner, beyond which its sine
counts less: sides of about 1 to 8."""


@bare_kernel
def thinness(p, q):
    """The factor that the sine at a corner with sides of lengths p and q is weighed by.

    1 up to :data:`THIN`; beyond, the weighed sine is THIN times the corner's shape
    2 J / (p^2 + q^2), which falls with the ratio of the sides.
    """
    return min(1.0, 2.0 * THIN * p * q / (p * p + q * q + 1e-300))


@by_reference
class Gauge(NamedTuple):
    """Where elements with bending sides are measured, and scratch for one of them."""

    samples: Samples
    points: np.ndarray
    """(4, 3) the corners of the element; the fields from here on are scratch."""
    elements: np.ndarray
    """(1, 4) rows of `points`."""
    sides: np.ndarray
    curve: np.ndarray
    base: np.ndarray
    parameter: np.ndarray
    zero: np.ndarray
    d: np.ndarray
    slope: np.ndarray
    vectors: np.ndarray


def gauge() -> Gauge:
    """A gauge at the samples of quads; one for each thread."""
    return Gauge(
        SAMPLES[4], np.zeros((4, 3)), np.arange(4).reshape(1, 4), np.full((1, 4), -1),
        np.zeros(4, np.int64), np.zeros((4, 2)), np.zeros(4), np.zeros(1, np.int64),
        np.zeros((4, NODES, 3)), np.zeros((4, NODES, 3)), np.zeros((4, 3)),
    )  # fmt: skip


@bare_kernel
def _straight_sine(m, e):
    """The smallest weighed sine of quad e at its corners, by its chords."""
    worst = 1.0
    for i in range(4):
        o, s = m.edge[4 * e + i, ORIGIN], m.edge[4 * e + (i + 1) % 4, ORIGIN]
        t = m.edge[4 * e + (i + 3) % 4, ORIGIN]
        px, py = m.points[s, 0] - m.points[o, 0], m.points[s, 1] - m.points[o, 1]
        qx, qy = m.points[t, 0] - m.points[o, 0], m.points[t, 1] - m.points[o, 1]
        p, q = np.sqrt(px * px + py * py), np.sqrt(qx * qx + qy * qy)
        sine = (px * qy - py * qx) / (p * q) if p * q > 0.0 else 0.0
        worst = min(worst, thinness(p, q) * sine)
    return worst


@bare_kernel
def element_sine(m, turning, gauge, e):
    """The smallest weighed sine of quad e, at its corners and at the samples if a side bends.

    0 where a side turns by more than :data:`MOST_TURN`.
    """
    bent = False
    for i in range(4):
        gauge.sides[0, i] = -1
        h = 4 * e + i
        if not along_curve(m, h, 4):
            continue
        c = edge_curve(m, h, 4)
        if c < 0:
            continue
        gauge.base[i, 0], gauge.base[i, 1] = edge_range(m, h, c, 4)
        low, high = min(gauge.base[i, 0], gauge.base[i, 1]), max(gauge.base[i, 0], gauge.base[i, 1])
        turn = turning_between(m.curves, turning, c, low, high)
        if turn > MOST_TURN:
            return 0.0
        if turn > BENDS:
            gauge.curve[i], gauge.sides[0, i] = c, i
            bent = True
    if not bent:
        return _straight_sine(m, e)
    for i in range(4):
        for c in range(3):
            gauge.points[i, c] = m.points[m.edge[4 * e + i, ORIGIN], c]
    curved = CurvedElements(
        m.curves, gauge.samples, gauge.elements, gauge.zero, gauge.zero, gauge.sides, gauge.curve,
        gauge.base, gauge.parameter,
    )  # fmt: skip
    place_sides(curved, gauge.points, 0, gauge.d, gauge.slope)
    p, q, normal = gauge.vectors[0], gauge.vectors[1], gauge.vectors[2]
    normal[2] = 1.0
    worst = 1.0
    for s in range(len(gauge.samples.nearest)):
        derivatives(curved, gauge.points, 0, s, gauge.d, gauge.slope, p, q)
        first, second = np.sqrt(inner(p, p)), np.sqrt(inner(q, q))
        lengths = first * second
        sine = determinant(p, q, normal) / lengths if lengths > 0.0 else 0.0
        worst = min(worst, thinness(first, second) * sine)
    return worst


@kernel
def worst_around(m, turning, gauge, active, least):
    """The smallest :func:`element_sine` of the quads with a vertex marked in `active` (empty: of
    all). Ends at the first one that is not above `least`.
    """
    worst = 1.0
    for e in range(m.counters[ELEMENT_SLOTS]):
        if m.edge[4 * e, ORIGIN] < 0:
            continue
        near = not len(active)
        for i in range(4):
            near = near or active[m.edge[4 * e + i, ORIGIN]]
        if near:
            worst = min(worst, element_sine(m, turning, gauge, e))
            if worst <= least:
                break
    return worst
