"""Merging two vertices: which one survives, and when the other one may be deleted."""

from __future__ import annotations

from meshwright_core.core.arrays import (
    DEGREE,
    DESIRED,
    FLAGS,
    GEOMETRIC,
    HALF,
    LOCKED,
    ORIGIN,
    TWIN,
    along_curve,
    constrained,
    on_boundary,
    on_curve,
    turned,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.irregularity import usual_desired
from meshwright_core.history.journal import put_edge
from meshwright_core.operations.refusals import (
    ALLOWED,
    BOTH_ON_BOUNDARY,
    BOTH_ON_CURVE,
    GEOMETRIC_INSIDE,
    INTERFACE_GONE,
    INTERFACE_PULLED,
    LOSER_DESIRED,
    LOSER_LOCKED,
    NO_ELEMENT_LEFT,
    TWO_GEOMETRIC,
)


@bare_kernel
def _rank(m, v, k):
    rank = 8 if m.vertex[v, FLAGS] & GEOMETRIC else 0
    rank += 4 if on_curve(m, v) else 0
    rank += 2 if m.vertex[v, FLAGS] & LOCKED else 0
    return rank + (1 if m.vertex[v, DESIRED] != usual_desired(k, on_boundary(m, v)) else 0)


@bare_kernel
def survivor(m, a, b, k):
    """The one of a and b that stays: geometric before one on a curve before locked before a vertex
    with a desired degree of its own; a when they are alike.
    """
    return b if _rank(m, b, k) > _rank(m, a, k) else a


@bare_kernel
def check_loser(m, loser, desired):
    """Whether `loser` may be deleted: not geometric, not locked, of the desired degree `desired`.

    The last condition keeps the sum of Delta, and so the optimum s*, unchanged.
    """
    if m.vertex[loser, FLAGS] & GEOMETRIC:
        return TWO_GEOMETRIC
    if m.vertex[loser, FLAGS] & LOCKED:
        return LOSER_LOCKED
    if m.vertex[loser, DESIRED] != desired:
        return LOSER_DESIRED
    return ALLOWED


@bare_kernel
def check_pair(m, h, a, b, loser, k):
    """Whether the curves let a and b merge across an element or along the interior edge h.

    h: the half-edge that joins them, -1 for none. Two vertices on curves merge only along an edge
    of an interface; one on a curve does not leave it.
    """
    if on_boundary(m, a) and on_boundary(m, b):
        return BOTH_ON_BOUNDARY
    if h >= 0 and constrained(m, h, k):
        return ALLOWED
    if on_curve(m, a) and on_curve(m, b):
        return BOTH_ON_CURVE
    if on_boundary(m, loser):
        return GEOMETRIC_INSIDE
    return INTERFACE_PULLED if on_curve(m, loser) else ALLOWED


@bare_kernel
def check_sides(m, n, p, k):
    """Whether two sides of an element may become one edge: not if both lie on curves."""
    if m.edge[n, TWIN] < 0 and m.edge[p, TWIN] < 0:
        return NO_ELEMENT_LEFT
    if along_curve(m, n, k) and along_curve(m, p, k):
        return INTERFACE_GONE
    return ALLOWED


@bare_kernel
def hand_over(m, loser, winner, k):
    """Give every half-edge that leaves `loser` the origin `winner`."""
    h = m.vertex[loser, HALF]
    for _ in range(m.vertex[loser, DEGREE]):
        put_edge(m, h, ORIGIN, winner)
        h = turned(m, h, k)
        if h < 0:
            return
