"""Edits that leave the connectivity as it is: position, desired degree and flags of vertices."""

from __future__ import annotations

from meshwright_core.core.arrays import (
    CURVE,
    DEGREE,
    DESIRED,
    FLAGS,
    GEOMETRIC,
    HALF,
    SIDES,
    along_curve,
    turned,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.composite_curves import curve_length, nearest_between
from meshwright_core.core.curve_edges import edge_curve, edge_range
from meshwright_core.history.journal import (
    begin_step,
    end_step,
    put_parameter,
    put_point,
    put_vertex,
    set_degrees,
)

_APART = 1e-3
"""Least distance of a projected vertex from its neighbours, relative to the way between them."""


@kernel
def move(m, vertices, positions):
    """Write positions (n, 3) of vertices (n,) as one step.

    Those on curves get the parameter of their projection between their neighbours there, which are
    taken as they are when their turn comes; geometric ones keep theirs.
    """
    begin_step(m, -1, -1)
    k = m.counters[SIDES]
    for i in range(len(vertices)):
        v = vertices[i]
        there = positions[i]
        stays = True
        for axis in range(3):
            stays = stays and m.points[v, axis] == there[axis]
        put_point(m, v, there[0], there[1], there[2])
        if not stays and m.vertex[v, CURVE] >= 0 and m.vertex[v, FLAGS] & GEOMETRIC == 0:
            low, high = _room_on_curve(m, v, k)
            if low < high:
                margin = _APART * (high - low)
                t = _nearest_around(m, m.vertex[v, CURVE], there, low + margin, high - margin)
                if t != m.parameter[v]:
                    put_parameter(m, v, t)
    end_step(m)


@bare_kernel
def move_along(m, vertices, positions, parameters):
    """Write positions (n, 3) of vertices (n,), parameters (n,) of those on curves, as one step."""
    begin_step(m, -1, -1)
    for i in range(len(vertices)):
        v = vertices[i]
        put_point(m, v, positions[i, 0], positions[i, 1], positions[i, 2])
        if m.vertex[v, CURVE] >= 0 and m.parameter[v] != parameters[i]:
            put_parameter(m, v, parameters[i])
    end_step(m)


@bare_kernel
def _room_on_curve(m, v, k):
    """The parameters, before and after that of v, of its neighbours on its curve.

    On closed curves the first may be negative or the second beyond the length. Both 0 where v lies
    on no curve, or is an end of it.
    """
    c, here = m.vertex[v, CURVE], m.parameter[v]
    low, high, found = 0.0, 0.0, 0
    if c < 0 or c >= len(m.interface):
        return low, high
    h = m.vertex[v, HALF]
    for _ in range(m.vertex[v, DEGREE]):
        # beyond the last element at a boundary vertex: the half-edge that ends there
        g = h if h >= 0 else -1 - h
        if along_curve(m, g, k) and edge_curve(m, g, k) == c:
            first, last = edge_range(m, g, c, k)
            step = last - first if h >= 0 else first - last
            if step > 0.0:
                high = here + step
            else:
                low = here + step
            found += 1
        if h < 0:
            break
        h = turned(m, h, k)
    return (low, high) if found == 2 else (0.0, 0.0)


@kernel
def _nearest_around(m, c, goal, low, high):
    """The parameter in [low, high] of curve c nearest to `goal` (3,), in [0, length)."""
    length = curve_length(m.curves, c)
    if not m.curves.closed[c]:
        t, _ = nearest_between(m.curves, c, goal, max(low, 0.0), min(high, length))
        return t
    if low < 0.0:
        low, high = low + length, high + length
    elif low >= length:
        low, high = low - length, high - length
    t, distance = nearest_between(m.curves, c, goal, low, min(high, length))
    if high > length:
        u, other = nearest_between(m.curves, c, goal, 0.0, high - length)
        t = u if other < distance else t
    return t if t < length else 0.0


@bare_kernel
def set_vertex(m, v, column, value):
    """Write the desired degree or the flags of v as one step."""
    begin_step(m, -1, -1)
    if column == DESIRED:
        set_degrees(m, v, m.vertex[v, DEGREE], value)
    else:
        put_vertex(m, v, FLAGS, value)
    end_step(m)
