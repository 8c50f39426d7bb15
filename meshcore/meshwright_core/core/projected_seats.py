"""Seats of boundary vertices on given loops by projection, for meshes that were stored without.

Snapshots from before meshes had curves hold the polylines along which the boundary first ran, and
vertices that edits may have pulled off them.
"""

from __future__ import annotations

from bisect import bisect_left

import numpy as np
from scipy.optimize import linear_sum_assignment

from meshwright_core.core.arrays import CURVE, VERTEX_SLOTS, MeshArrays
from meshwright_core.core.composite_curves import nearest_parameters, place_all
from meshwright_core.core.mesh_boundary import MeshBoundary, Seats
from meshwright_core.errors import MeshError

_SAMPLE = 24
"""Vertices of a loop that are compared with each curve."""


def take_projected_seats(m: MeshArrays, loops: list[np.ndarray], boundary: MeshBoundary) -> None:
    """Seat the vertices of boundary `loops` on the curves nearest to them; not journalled."""
    slots = int(m.counters[VERTEX_SLOTS])
    curve, parameter = projected_seats(m.points[:slots], loops, boundary)
    m.vertex[:slots, CURVE] = curve
    m.parameter[:slots] = parameter


def projected_seats(points: np.ndarray, loops: list[np.ndarray], boundary: MeshBoundary) -> Seats:
    """The seats of the vertices with `points` (n, 3) on the boundary curves nearest to their loops.

    loops: vertex ids (m,) along each boundary loop. MeshError if there are more or fewer curves.
    """
    curves, count = boundary.loops, len(loops)
    if len(curves) != count:
        raise MeshError("its outline has more or fewer loops than its boundary")
    away = np.zeros((count, count))
    for i, loop in enumerate(loops):
        some = points[loop[:: max(1, len(loop) // _SAMPLE)]]
        for j, curve in enumerate(curves):
            away[i, j] = np.linalg.norm(some - _projected(boundary, curve, some)[1], axis=1).sum()
    seats = Seats(np.full(len(points), -1, np.int64), np.zeros(len(points)))
    for i, j in zip(*linear_sum_assignment(away), strict=True):
        loop, curve = loops[i], curves[j]
        t, there = _projected(boundary, curve, points[loop])
        surest = int(np.argmin(np.linalg.norm(points[loop] - there, axis=1)))
        length = float(boundary.lengths()[curve])
        seats.curve[loop] = curve
        seats.parameter[np.roll(loop, -surest)] = once_around(np.roll(t, -surest), length)
    return seats


def _projected(
    boundary: MeshBoundary, curve: int, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    goals = np.ascontiguousarray(points)
    t = nearest_parameters(boundary.curves, curve, goals)
    return t, place_all(boundary.curves, np.full(len(t), curve), t)


def once_around(t: np.ndarray, length: float) -> np.ndarray:
    """Parameters in [0, length) near `t` (n,) that increase once around a closed curve.

    The first stays; of the others as many as can. The rest is spaced evenly between those.
    """
    ahead = np.mod(t - t[0], length)
    # the longest increasing subsequence: the last value and place of the best one of each length
    values, places = [0.0], [0]
    before = np.full(len(t), -1)
    for i in range(1, len(t)):
        at = bisect_left(values, ahead[i])
        if at == 0:
            continue
        before[i] = places[at - 1]
        if at == len(values):
            values.append(float(ahead[i]))
            places.append(i)
        else:
            values[at], places[at] = float(ahead[i]), i
    kept = [places[-1]]
    while before[kept[-1]] >= 0:
        kept.append(int(before[kept[-1]]))
    kept.reverse()
    stops, heights = [*kept, len(t)], np.append(ahead[kept], length)
    around = t[0] + np.interp(np.arange(len(t)), stops, heights)
    turned = np.where(around >= length, around - length, around)
    exact = np.zeros(len(t), bool)
    exact[kept] = True
    placed: np.ndarray = np.where(exact & (t < length), t, turned)
    return placed
