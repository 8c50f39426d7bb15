"""Positions around an operation that a compiled search has just applied to a copy of a mesh.

The elements that differ from the mesh before, and some rings around them, are unfolded and raised
(:mod:`meshwright_core.geometry.layout_positions`); what is around them stays. The result counts as
valid if no corner of these elements is nearly flat, and no sample of the Coons map of one with
bending sides is (:mod:`meshwright_core.geometry.coons`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import (
    ELEMENT_SLOTS,
    ORIGIN,
    VERTEX_SLOTS,
    along_curve,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.curve_edges import edge_curve, edge_range
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.coons import (
    NODES,
    SAMPLES,
    CurvedElements,
    Samples,
    derivatives,
    determinant,
    place_sides,
)
from meshwright_core.geometry.layout_positions import (
    MOST_TURN,
    Effort,
    layout_bound,
    position_some,
)
from meshwright_core.geometry.turning import BENDS, turning_between

THOROUGH = 10, 30, 60, 10
"""Iterations, rounds, inner and polishing steps of the second attempt."""


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


@by_reference
class LocalEffort(NamedTuple):
    """How the surroundings of an operation are positioned."""

    effort: Effort
    """Of the first attempt."""
    thorough: Effort
    """Of the second attempt, where the first one leaves something folded; none without rounds."""
    rings: int
    """Rings of elements around the changed ones whose vertices move too."""
    least: float
    """Sine up to which a corner, or a sample of a curved element, counts as folded."""
    gauge: Gauge


def local_effort(
    goal: float = 0.3,
    least: float = 0.015,
    *,
    iterations: int = 6,
    rounds: int = 3,
    inner: int = 8,
    rings: int = 2,
    thorough: bool = True,
) -> LocalEffort:
    """Settings for :func:`settle`; see :class:`LocalEffort` and
    :class:`meshwright_core.geometry.layout_positions.Effort`.
    """
    quick = Effort(goal, iterations, rounds, inner, 6)
    second = Effort(goal, *THOROUGH) if thorough else Effort(goal, 0, 0, 0, 0)
    return LocalEffort(quick, second, rings, least, gauge())


@kernel
def mark_changed(before, after, rings, active):
    """Mark in `active` (slots,) bool the vertices of the quads of `after` that `before` does not
    have, and of so many rings of quads around them. Returns the number of changed quads.
    """
    slots = after.counters[ELEMENT_SLOTS]
    old = before.counters[ELEMENT_SLOTS]
    count = 0
    for v in range(len(active)):
        active[v] = False
    for e in range(slots):
        if after.edge[4 * e, ORIGIN] < 0:
            continue
        same = e < old
        if same:
            for i in range(4):
                if after.edge[4 * e + i, ORIGIN] != before.edge[4 * e + i, ORIGIN]:
                    same = False
                    break
        if not same:
            count += 1
            for i in range(4):
                active[after.edge[4 * e + i, ORIGIN]] = True
    inside = np.zeros(slots, np.bool_)
    for _ in range(rings):
        for e in range(slots):
            inside[e] = False
            if after.edge[4 * e, ORIGIN] < 0:
                continue
            for i in range(4):
                if active[after.edge[4 * e + i, ORIGIN]]:
                    inside[e] = True
        for e in range(slots):
            if inside[e]:
                for i in range(4):
                    active[after.edge[4 * e + i, ORIGIN]] = True
    return count


@bare_kernel
def _straight_sine(m, e):
    """The smallest corner sine of quad e by its chords."""
    worst = 1.0
    for i in range(4):
        o, s = m.edge[4 * e + i, ORIGIN], m.edge[4 * e + (i + 1) % 4, ORIGIN]
        t = m.edge[4 * e + (i + 3) % 4, ORIGIN]
        px, py = m.points[s, 0] - m.points[o, 0], m.points[s, 1] - m.points[o, 1]
        qx, qy = m.points[t, 0] - m.points[o, 0], m.points[t, 1] - m.points[o, 1]
        lengths = np.sqrt((px * px + py * py) * (qx * qx + qy * qy))
        worst = min(worst, (px * qy - py * qx) / lengths if lengths > 0.0 else 0.0)
    return worst


@bare_kernel
def element_sine(m, turning, gauge, e):
    """The smallest sine of quad e, at its corners and at the samples if a side bends.

    0 where a side turns by more than :data:`.layout_positions.MOST_TURN`.
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
        lengths = np.sqrt(np.dot(p, p) * np.dot(q, q))
        worst = min(worst, determinant(p, q, normal) / lengths if lengths > 0.0 else 0.0)
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


@kernel
def _raised(m, rails, local, active, effort):
    """Position the active vertices; returns the smallest sine around, or 0 if it is too small."""
    if position_some(m, rails, effort, active) <= local.least:
        return 0.0
    worst = worst_around(m, rails.turning, local.gauge, active, local.least)
    return worst if worst > local.least else 0.0


@kernel
def _copy_places(m, places, back):
    """Copy positions and parameters into `places` (n, 4), or `back`."""
    for v in range(len(places)):
        for c in range(3):
            if back:
                m.points[v, c] = places[v, c]
            else:
                places[v, c] = m.points[v, c]
        if back:
            m.parameter[v] = places[v, 3]
        else:
            places[v, 3] = m.parameter[v]


@kernel
def settle(before, after, rails, local, active):
    """Position the vertices of `after` around where it differs from `before`, in place.

    active: (slots,) bool, overwritten. Returns the worst sine around there; 0 or less where the
    result is not valid, or the degrees alone forbid it.
    """
    if layout_bound(after, rails.angle) <= local.least:
        return 0.0
    mark_changed(before, after, local.rings, active)
    places = np.zeros((after.counters[VERTEX_SLOTS], 4))
    _copy_places(after, places, False)
    first = worst_around(after, rails.turning, local.gauge, active, local.least)
    worst = _raised(after, rails, local, active, local.effort)
    if worst <= 0.0:
        _copy_places(after, places, True)
        worst = first if first > local.least else 0.0
        if first <= local.least and local.thorough.rounds > 0:
            worst = _raised(after, rails, local, active, local.thorough)
    return worst
