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
    on_boundary,
    turned,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.irregularity import usual_desired
from meshwright_core.history.journal import put_edge
from meshwright_core.operations.refusals import ALLOWED, LOSER_DESIRED, LOSER_LOCKED, TWO_GEOMETRIC


@bare_kernel
def _rank(m, v, k):
    boundary = on_boundary(m, v)
    rank = 8 if m.vertex[v, FLAGS] & GEOMETRIC else 0
    rank += 4 if boundary else 0
    rank += 2 if m.vertex[v, FLAGS] & LOCKED else 0
    return rank + (1 if m.vertex[v, DESIRED] != usual_desired(k, boundary) else 0)


@bare_kernel
def survivor(m, a, b, k):
    """The one of a and b that stays: geometric before boundary before locked before a vertex with a
    desired degree of its own; a when they are alike.
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
def hand_over(m, loser, winner, k):
    """Give every half-edge that leaves `loser` the origin `winner`."""
    h = m.vertex[loser, HALF]
    for _ in range(m.vertex[loser, DEGREE]):
        put_edge(m, h, ORIGIN, winner)
        h = turned(m, h, k)
        if h < 0:
            return
