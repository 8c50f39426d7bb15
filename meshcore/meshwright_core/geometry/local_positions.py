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


@by_reference
class LocalEffort(NamedTuple):
    """How the surroundings of an operation are positioned."""

    effort: Effort
    rings: int
    """Rings of elements around the changed ones whose vertices move too."""
    least: float
    """Sine up to which a corner, or a sample of a curved element, counts as folded."""
    samples: Samples
    """Where elements with bending sides are measured."""


def local_effort(
    goal: float = 0.3,
    least: float = 0.015,
    *,
    iterations: int = 6,
    rounds: int = 3,
    inner: int = 8,
    rings: int = 2,
) -> LocalEffort:
    """Settings for :func:`settle`; see :class:`LocalEffort` and
    :class:`meshwright_core.geometry.layout_positions.Effort`.
    """
    return LocalEffort(Effort(goal, iterations, rounds, inner, 6), rings, least, SAMPLES[4])


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


@kernel
def worst_around(m, turning, samples, active, least):
    """The smallest sine of the quads with a vertex marked in `active` (empty: of all).

    At corners, and at the samples of quads with bending sides; 0 where a side turns by more than
    150 degrees. Ends at the first one that is not above `least`.
    """
    elements, sides = np.zeros((1, 4), np.int64), np.full((1, 4), -1)
    curve, base = np.zeros(4, np.int64), np.zeros((4, 2))
    zeros = np.zeros(len(m.points))
    first, row = np.zeros(1, np.int64), np.zeros(1, np.int64)
    curved = CurvedElements(m.curves, samples, elements, first, row, sides, curve, base, zeros)
    d, slope = np.zeros((4, NODES, 3)), np.zeros((4, NODES, 3))
    p, q, normal = np.zeros(3), np.zeros(3), np.zeros(3)
    normal[2] = 1.0
    worst = 1.0
    for e in range(m.counters[ELEMENT_SLOTS]):
        if m.edge[4 * e, ORIGIN] < 0:
            continue
        near = not len(active)
        for i in range(4):
            elements[0, i] = m.edge[4 * e + i, ORIGIN]
            near = near or active[elements[0, i]]
        if not near:
            continue
        bent = False
        for i in range(4):
            sides[0, i] = -1
            h = 4 * e + i
            if not along_curve(m, h, 4):
                continue
            c = edge_curve(m, h, 4)
            if c < 0:
                continue
            base[i, 0], base[i, 1] = edge_range(m, h, c, 4)
            low, high = min(base[i, 0], base[i, 1]), max(base[i, 0], base[i, 1])
            turn = turning_between(m.curves, turning, c, low, high)
            if turn <= BENDS:
                continue
            if turn > MOST_TURN:
                worst = 0.0
            curve[i], sides[0, i] = c, i
            bent = True
        if not bent:
            worst = min(worst, _straight_sine(m, e))
        else:
            place_sides(curved, m.points, 0, d, slope)
            for s in range(len(samples.nearest)):
                derivatives(curved, m.points, 0, s, d, slope, p, q)
                lengths = np.sqrt(np.dot(p, p) * np.dot(q, q))
                sine = determinant(p, q, normal) / lengths if lengths > 0.0 else 0.0
                worst = min(worst, sine)
        if worst <= least:
            break
    # the record only points to these arrays: their last use must come after its own
    used = len(elements) + len(sides) + len(curve) + len(base) + len(zeros) + len(first) + len(row)
    return worst if used > 0 else 1.0


@kernel
def settle(before, after, rails, local, active):
    """Position the vertices of `after` around where it differs from `before`, in place.

    active: (slots,) bool, overwritten. Returns the worst sine around there; 0 or less where the
    result is not valid, or the degrees alone forbid it.
    """
    if layout_bound(after, rails.angle) <= local.least:
        return 0.0
    mark_changed(before, after, local.rings, active)
    if position_some(after, rails, local.effort, active) <= local.least:
        return 0.0
    worst = worst_around(after, rails.turning, local.samples, active, local.least)
    return worst if worst > local.least else 0.0
