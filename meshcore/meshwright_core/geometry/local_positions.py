"""Positions around an operation that a compiled search has just applied to a copy of a mesh.

The elements that differ from the mesh before, and some rings around them, are unfolded and raised
(:mod:`meshwright_core.geometry.layout_positions`); what is around them stays. The result counts as
valid if no corner of these elements is nearly flat, and no sample of the Coons map of one with
bending sides is (:mod:`meshwright_core.geometry.coons`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import ELEMENT_SLOTS, ORIGIN, VERTEX_SLOTS
from meshwright_core.core.compilation import kernel
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.element_sines import worst_around
from meshwright_core.geometry.layout_positions import Effort, layout_bound, position_some

THOROUGH = 10, 30, 60, 10
"""Iterations, rounds, inner and polishing steps of the second attempt."""


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
    return LocalEffort(quick, second, rings, least)


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


@kernel
def _raised(m, rails, local, active, effort):
    """Position the active vertices; returns the smallest sine around, or 0 if it is too small."""
    if position_some(m, rails, effort, active) <= local.least:
        return 0.0
    worst = worst_around(m, rails.turning, rails.gauge, active, local.least)
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
    worst = _raised(after, rails, local, active, local.effort)
    if worst <= 0.0:
        _copy_places(after, places, True)
        # it may be valid where it was
        worst = worst_around(after, rails.turning, rails.gauge, active, local.least)
        if worst <= local.least:
            worst = 0.0
            if local.thorough.rounds > 0:
                worst = _raised(after, rails, local, active, local.thorough)
    return worst
