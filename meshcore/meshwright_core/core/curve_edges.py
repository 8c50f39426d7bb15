"""Where edges run along curves: the curve of an edge on the boundary or an interface, its range.

Only vertices store a curve. That of an edge follows from its ends: at least one lies between the
ends of the curve, or else both are its ends.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.core.arrays import (
    CURVE,
    END,
    LEFT,
    ORIGIN,
    RIGHT,
    START,
    TWIN,
    along_curve,
    following,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.composite_curves import curve_length


@bare_kernel
def _lies_within(m, v):
    """Whether the curve of v is an interface of which v is no end."""
    c = m.vertex[v, CURVE]
    if c < 0 or c >= len(m.interface) or m.interface[c, LEFT] < 0:
        return False
    return m.interface[c, START] != v and m.interface[c, END] != v


@bare_kernel
def edge_curve(m, h, k):
    """The curve of h, an edge :func:`along_curve`; -1 in arrays without curves, as of patches."""
    t = m.edge[h, TWIN]
    a, b = m.edge[h, ORIGIN], m.edge[following(h, k), ORIGIN]
    if t < 0:
        c = m.vertex[a, CURVE]
        return c if c < len(m.interface) else -1
    if _lies_within(m, a):
        return m.vertex[a, CURVE]
    if _lies_within(m, b):
        return m.vertex[b, CURVE]
    own, other = m.region[h // k], m.region[t // k]
    for c in range(len(m.interface)):
        left, right = m.interface[c, LEFT], m.interface[c, RIGHT]
        start, end = m.interface[c, START], m.interface[c, END]
        if left == own and right == other and start == a and end == b:
            return c
        if left == other and right == own and start == b and end == a:
            return c
    return -1


@bare_kernel
def edge_range(m, h, c, k):
    """The parameters on curve c of the ends of its half-edge h, first that of the origin.

    The first is the smaller one if the region left of the curve is on the left of h, as on the
    boundary. On a closed curve the larger one may be up to twice the length.
    """
    first, last = m.edge[h, ORIGIN], m.edge[following(h, k), ORIGIN]
    left = m.interface[c, LEFT]
    backward = left >= 0 and m.region[h // k] != left
    if backward:
        first, last = last, first
    low, high = m.parameter[first], m.parameter[last]
    length = curve_length(m.curves, c)
    if left >= 0 and m.interface[c, START] == first:
        low = 0.0
    if left >= 0 and m.interface[c, END] == last:
        high = length
    if high <= low and m.curves.closed[c]:
        high += length
    if backward:
        return high, low
    return low, high


@kernel
def edge_places(m, halfedges, k):
    """Curve (n,) of each of the live half-edges (n,), -1 for those on none, and range (n, 2)."""
    curve = np.full(len(halfedges), -1, np.int64)
    span = np.zeros((len(halfedges), 2))
    for i in range(len(halfedges)):
        h = halfedges[i]
        if along_curve(m, h, k):
            curve[i] = edge_curve(m, h, k)
            if curve[i] >= 0:
                span[i, 0], span[i, 1] = edge_range(m, h, curve[i], k)
    return curve, span
