"""The lower bound s* of a domain of several regions, from its sides alone."""

from __future__ import annotations

import numpy as np

from meshwright_core.core.score_bound import (
    SharedVertices,
    bound_excess,
    kinks,
    passages_along,
    shares,
    slack_of,
    without,
)
from meshwright_core.domains.loops.region_loops import RegionLoops
from meshwright_core.domains.loops.side_curves import piece_starts, side_curves


def bound_excess_of_sides(sides: RegionLoops, k: int) -> int:
    """s* less the absolute value of the sum of Delta; 0 without interfaces.

    See :mod:`meshwright_core.core.score_bound`. k: 3 or 4 sides of an element.
    """
    first = len(sides.loop_sides)
    interfaces = sides.all_sides[first:]
    if not interfaces:
        return 0
    points = sides.graph.points
    rows = [
        (number, region, angle)
        for number, point in enumerate(points.values())
        for region, angle in point.sectors
    ]
    vertex, region, angle = (
        (np.array(column) for column in zip(*rows, strict=True))
        if rows
        else (np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0))
    )
    share = shares(angle, k)
    balance = np.array([-(4 if k == 4 else 6) * (1 - one.holes) for one in sides.regions])
    np.subtract.at(balance, region, share - (2 if k == 4 else 3))

    several = np.bincount(vertex, minlength=len(points)) > 1
    kept = several[vertex]
    shared = SharedVertices(
        np.zeros(int(several.sum()), np.int64),
        (np.cumsum(several) - 1)[vertex[kept]],
        region[kept],
        slack_of(angle, share)[kept],
    )
    curves = side_curves(sides)
    numbers = first + np.arange(len(interfaces))
    places = [
        (number, t)
        for number, side in zip(numbers.tolist(), interfaces, strict=True)
        for node, t in zip(side.nodes, piece_starts(curves, number, side), strict=True)
        if node in points
    ]
    at = np.array(places, np.float64).reshape(-1, 2)
    bends = without(kinks(curves, numbers), curves, at[:, 0].astype(np.int64), at[:, 1])
    left = np.array([side.pieces[0].left for side in interfaces])
    right = np.array([side.pieces[0].right for side in interfaces])
    return bound_excess(balance, shared, passages_along(k, numbers, left, right, bends))
