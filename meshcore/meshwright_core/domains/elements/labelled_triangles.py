"""Triangulations between the sides of a domain, with the region of each triangle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.components import components
from meshwright_core.errors import MeshError

Points = NDArray[np.float64]
Ids = NDArray[np.int64]


def edge_keys(ends: Ids, count: int) -> Ids:
    """(e,) one number for each pair (e, 2) of vertices below `count`, whatever their order."""
    low, high = np.sort(ends, axis=1).T
    found: Ids = low * count + high
    return found


def neighbours(triangles: Ids, count: int) -> tuple[Ids, Ids, Ids]:
    """Two half-edges 3 t + i of each inner edge, and the key of the edge; `count` vertices."""
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    keys = edge_keys(ends, count)
    order = np.argsort(keys, kind="stable")
    twice = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    return order[twice], order[twice + 1], keys[order][twice]


def regions_of(triangles: Ids, count: int, segments: Ids, left: Ids, right: Ids) -> Ids:
    """(m,) the region of each triangle, -1 outside.

    Args:
        triangles: (m, 3) that have all segments among their sides.
        count: how many vertices there are.
        segments: (s, 2).
        left: (s,) the region on the left of each, from its first vertex to its second one.
        right: (s,) the region on its right; -1 for outside.

    Raises:
        MeshError: triangles that are not separated by segments have two regions.
    """
    m = len(triangles)
    one, other, keys = neighbours(triangles, count)
    walls = np.sort(edge_keys(segments, count))
    place = np.minimum(np.searchsorted(walls, keys), len(walls) - 1)
    open_edge = walls[place] != keys
    _, part = components(one[open_edge] // 3, other[open_edge] // 3, m)
    # directed edges of triangles against directed segments
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    directed = np.concatenate([segments[:, 0] * count + segments[:, 1],
                               segments[:, 1] * count + segments[:, 0]])  # fmt: skip
    label = np.concatenate([left, right])
    order = np.argsort(directed)
    key = start * count + end
    place = np.minimum(np.searchsorted(directed[order], key), len(order) - 1)
    found = directed[order][place] == key
    own, parts = label[order][place[found]], part[np.flatnonzero(found) // 3]
    highest = np.full(part.max() + 1, -2)
    lowest = np.full(part.max() + 1, np.iinfo(np.int64).max)
    np.maximum.at(highest, parts, own)
    np.minimum.at(lowest, parts, own)
    if (highest != lowest).any():
        raise MeshError("The sides of the domain come too near to each other to be meshed.")
    regions: Ids = highest[part]
    return regions


def seeds(points: Points, triangles: Ids, regions: Ids, segments: Ids) -> Points:
    """(h, 2) a point in each part of the outside that triangles cover."""
    outside = np.flatnonzero(regions < 0)
    if not len(outside):
        return np.empty((0, 2))
    one, other, keys = neighbours(triangles[outside], len(points))
    free = ~np.isin(keys, edge_keys(segments, len(points)))
    _, part = components(one[free] // 3, other[free] // 3, len(outside))
    _, first = np.unique(part, return_index=True)
    centres: Points = points[triangles[outside[first]]].mean(axis=1)
    return centres
