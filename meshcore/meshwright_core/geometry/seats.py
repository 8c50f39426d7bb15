"""Seats: the places on curves of the vertices that slide, and what bounds them.

A *side* is the piece of a boundary loop or of an interface between two geometric vertices, or all
of a closed curve without any. Vertices slide along their side between their neighbours on it. Where
the ends of a side have been dragged off the curve, the whole side follows: its point at t is

    C(t) + (1 - w) (a - C(t_a)) + w (b - C(t_b)),    w = (t - t_a) / (t_b - t_a)

for ends a and b; with both ends on the curve exactly C(t).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import (
    CURVE,
    DEGREE,
    END,
    FLAGS,
    GEOMETRIC,
    HALF,
    LEFT,
    START,
    VERTICES,
    along_curve,
    neighbour,
    turned,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.composite_curves import curve_length, place_on
from meshwright_core.core.curve_edges import edge_curve
from meshwright_core.core.references import by_reference

ON_CURVE = 1e-12
"""Distance from a curve, relative to its length, up to which the end of a side lies on it."""


@by_reference
class Seats(NamedTuple):
    """Places of the sliding vertices among n vertices on their curves, and the bounds of each."""

    curve: np.ndarray
    """(n,) the curve of a sliding vertex, -1 for others."""
    parameter: np.ndarray
    """(n,) t of a sliding vertex, 0 for others. Along a closed curve it goes on increasing beyond
    the length, so that all vertices of a side are in order."""
    before: np.ndarray
    """(n,) the sliding vertex before it on its side, -1 when that one stays."""
    after: np.ndarray
    """(n,) likewise after it."""
    low: np.ndarray
    """(n,) what to add to the parameter of `before` (to zero if it is -1): the lower bound."""
    high: np.ndarray
    """(n,) likewise for `after`: the upper bound."""
    reach: np.ndarray
    """(n, 2) the parameters of the vertices that stay before and after it."""
    offset: np.ndarray
    """(n, 3) of its side: how far the point at t = 0 would lie off the curve."""
    slope: np.ndarray
    """(n, 3) the change of that by t."""


def no_seats(n: int) -> Seats:
    """Seats of n vertices none of which slides."""
    return Seats(
        curve=np.full(n, -1, np.int64),
        parameter=np.zeros(n),
        before=np.full(n, -1, np.int64),
        after=np.full(n, -1, np.int64),
        low=np.zeros(n),
        high=np.zeros(n),
        reach=np.zeros((n, 2)),
        offset=np.zeros((n, 3)),
        slope=np.zeros((n, 3)),
    )


@bare_kernel
def place_seat(curves, seats, v, point, tangent):
    """Write the point (3,) of the sliding vertex v and the derivative by its parameter."""
    t = seats.parameter[v]
    place_on(curves, seats.curve[v], t, point, tangent)
    for c in range(3):
        point[c] += seats.offset[v, c] + t * seats.slope[v, c]
        tangent[c] += seats.slope[v, c]


@kernel
def place_seats(curves, seats, vertices):
    """(n, 3) points of sliding vertices (n,)."""
    points, tangent = np.zeros((len(vertices), 3)), np.zeros(3)
    for i in range(len(vertices)):
        place_seat(curves, seats, vertices[i], points[i], tangent)
    return points


@kernel
def home_places(curves, seats, vertices, parameters):
    """(n, 3) points of sliding vertices (n,) of these parameters (n,) within their curves."""
    points, tangent = np.zeros((len(vertices), 3)), np.zeros(3)
    for i in range(len(vertices)):
        v = vertices[i]
        place_on(curves, seats.curve[v], parameters[i], points[i], tangent)
        for c in range(3):
            points[i, c] += seats.offset[v, c] + seats.parameter[v] * seats.slope[v, c]
    return points


@bare_kernel
def beside(m, v, c, ahead, k):
    """The vertex next to v along the curve c, in its direction if `ahead`, else against it.

    -1 where the curve ends.
    """
    left = m.interface[c, LEFT]
    h = m.vertex[v, HALF]
    for _ in range(m.vertex[v, DEGREE]):
        # beyond the last element at a boundary vertex: the half-edge that ends there
        g = h if h >= 0 else -1 - h
        if along_curve(m, g, k) and edge_curve(m, g, k) == c:
            forward = h >= 0 if left < 0 else (m.region[g // k] == left) == (h >= 0)
            if forward == ahead:
                return neighbour(m, h, k)
        if h < 0:
            break
        h = turned(m, h, k)
    return -1


@kernel
def side_chain(m, v, k):
    """The vertices of the side of v, a vertex on a curve that is not geometric, their parameters,
    which increase, and whether the side is all of a closed curve, none of them geometric.
    """
    c = m.vertex[v, CURVE]
    start = v
    for _ in range(m.counters[VERTICES]):
        back = beside(m, start, c, False, k)
        if back < 0:
            break
        start = back
        if start == v or m.vertex[start, FLAGS] & GEOMETRIC:
            break
    whole = start == v and not m.vertex[v, FLAGS] & GEOMETRIC
    count, end = 1, start
    for _ in range(m.counters[VERTICES]):
        end = beside(m, end, c, True, k)
        if end < 0 or (whole and end == start):
            break
        count += 1
        if end == start or m.vertex[end, FLAGS] & GEOMETRIC:
            break
    chain, t = np.empty(count, np.int64), np.empty(count)
    length = curve_length(m.curves, c)
    here = start
    for i in range(count):
        chain[i], t[i] = here, m.parameter[here]
        if m.interface[c, LEFT] >= 0:
            if m.interface[c, START] == here and i == 0:
                t[i] = 0.0
            elif m.interface[c, END] == here:
                t[i] = length
        if i and t[i] <= t[i - 1] and m.curves.closed[c]:
            t[i] += length
        here = beside(m, here, c, True, k)
    return chain, t, whole


@bare_kernel
def _place(vertices, v):
    """The index of v in `vertices` (n,), which ascend, or -1."""
    low, high = 0, len(vertices)
    while low < high:
        middle = (low + high) // 2
        if vertices[middle] < v:
            low = middle + 1
        else:
            high = middle
    return low if low < len(vertices) and vertices[low] == v else -1


@kernel
def find_seats(m, vertices, slides, seats, k):
    """Fill the seats of `vertices` (n,), ascending ids, of which `slides` (n,) may slide.

    Takes time in proportion to the sides on which these lie.
    """
    place, tangent = np.zeros(3), np.zeros(3)
    off = np.zeros((2, 3))
    for first in range(len(vertices)):
        if not slides[first] or seats.curve[first] >= 0:
            continue
        chain, t, whole = side_chain(m, vertices[first], k)
        count = len(chain)
        curve = m.vertex[vertices[first], CURVE]
        length = curve_length(m.curves, curve)
        span = t[count - 1] - t[0]
        off[:] = 0.0
        for end in range(0 if whole else 2):
            i = end * (count - 1)
            place_on(m.curves, curve, t[i], place, tangent)
            away = 0.0
            for c in range(3):
                off[end, c] = m.points[chain[i], c] - place[c]
                away = max(away, abs(off[end, c]))
            if away <= ON_CURVE * length:
                off[end] = 0.0
        members = np.empty(count, np.int64)
        held = -1
        for i in range(count):
            j = _place(vertices, chain[i])
            inside = whole or (i > 0 and i < count - 1)
            members[i] = j if j >= 0 and slides[j] and inside else -1
            if members[i] < 0 and held < 0:
                held = i
        for i in range(count):
            j = members[i]
            if j < 0:
                continue
            seats.curve[j], seats.parameter[j] = curve, t[i]
            for c in range(3):
                if not whole:
                    seats.slope[j, c] = (off[1, c] - off[0, c]) / span
                    seats.offset[j, c] = off[0, c] - t[0] * seats.slope[j, c]
            back = i - 1 if i > 0 else count - 1
            ahead = i + 1 if i < count - 1 else 0
            seats.before[j], seats.after[j] = members[back], members[ahead]
            seats.low[j] = (0.0 if i > 0 else -length) + (0.0 if members[back] >= 0 else t[back])
            seats.high[j] = (0.0 if i < count - 1 else length) + (
                0.0 if members[ahead] >= 0 else t[ahead]
            )
        # reach: from the last one that stays to the next, around a closed side
        if held < 0:
            for i in range(count):
                seats.reach[members[i], 0], seats.reach[members[i], 1] = t[0], t[0] + length
            continue
        last = count if whole else count - 1
        low = t[held]
        for step in range(1, last):
            i, shift = (held + step) % count, (held + step) // count * length
            if members[i] >= 0:
                seats.reach[members[i], 0] = low - shift
            else:
                low = t[i] + shift
        high = t[held] + length if whole else t[last]
        for step in range(last - 1, 0, -1):
            i, shift = (held + step) % count, (held + step) // count * length
            if members[i] >= 0:
                seats.reach[members[i], 1] = high - shift
            else:
                high = t[i] + shift
