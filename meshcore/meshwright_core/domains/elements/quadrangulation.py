"""Quads out of triangles: Catmull-Clark splits, pairing, and the removal of doublets.

All on plain arrays: points (n, 2 or 3), elements (m, 3 or 4) counter-clockwise, flags (n,).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.time_limit import check_time
from meshwright_core.domains.domain import Flags, Points

Elements = NDArray[np.int64]
Reals = NDArray[np.float64]

_EXACT_PAIRING = 600
"""Triangles up to which the best pairing is sought; more are paired greedily."""


def catmull_clark(
    points: Points, blocks: Sequence[Elements], geometric: Flags
) -> tuple[Points, Elements, Flags]:
    """Cut every element of k sides into k quads, through edge midpoints and the centre.

    The old points keep their numbers, then come the edges' midpoints, then the elements' centres
    (V + E + F points; k quads for each element). New points are not geometric.

    Args:
        points: (n, d).
        blocks: element arrays of one width each, that share edges; triangles and quads mix.
        geometric: (n,).
    """
    pairs, quads = split_elements(len(points), blocks)
    middles = 0.5 * (points[pairs[:, 0]] + points[pairs[:, 1]])
    centres = [points[block].mean(axis=1) for block in blocks]
    everything = np.concatenate([points, middles, *centres])
    flags = np.zeros(len(everything), dtype=bool)
    flags[: len(points)] = geometric
    return everything, quads, flags


def split_elements(count: int, blocks: Sequence[Elements]) -> tuple[Elements, Elements]:
    """The connectivity of :func:`catmull_clark`, for elements on `count` points.

    Returns:
        the ends (e, 2) of the edges whose midpoints are the points from `count` on, the lower one
        first; and the quads, k for each element, that at its corner i the i-th of them.
    """
    ends = np.concatenate([_sides(block).reshape(-1, 2) for block in blocks])
    low, high = ends.min(axis=1), ends.max(axis=1)
    keys, edge = np.unique(low * count + high, return_inverse=True)
    edge = count + edge.ravel()
    quads = []
    first, centre = 0, count + len(keys)
    for block in blocks:
        m, k = block.shape
        following = edge[first : first + m * k].reshape(m, k)
        hub = np.repeat(centre + np.arange(m), k).reshape(m, k)
        quads.append(np.stack([block, following, hub, np.roll(following, 1, axis=1)], axis=2))
        first += m * k
        centre += m
    pairs = np.column_stack([keys // count, keys % count])
    return pairs, np.concatenate([quad.reshape(-1, 4) for quad in quads])


def pair(
    points: Points, triangles: Elements, qualities: Callable[[Elements], Reals] | None = None
) -> tuple[Elements, Elements]:
    """Join neighbouring triangles in pairs to quads.

    As many pairs as possible, and among those matchings one of greatest total quality. Meshes of
    more than 600 triangles are paired greedily, best pair first.

    Args:
        points: (n, 2).
        triangles: (m, 3).
        qualities: gives those (m,) of quads (m, 4), not positive where there shall be none. By
            default 1 less the largest deviation from a right angle, in right angles: quads are
            convex.

    Returns:
        the quads (p, 4), and the triangles that stay alone (m - 2 p, 3).
    """
    one, other, quads = _candidates(points, triangles)
    quality = _squareness(points[quads]) if qualities is None else qualities(quads)
    good = quality > 1e-6
    one, other, quads, quality = one[good], other[good], quads[good], quality[good]
    if len(triangles) <= _EXACT_PAIRING:
        chosen = _best_matching(one, other, quality)
    else:
        chosen = _greedy_matching(one, other, quality, len(triangles))
    alone = np.ones(len(triangles), dtype=bool)
    alone[one[chosen]] = False
    alone[other[chosen]] = False
    return quads[chosen], triangles[alone]


def without_doublets(
    points: Points, quads: Elements, geometric: Flags
) -> tuple[Points, Elements, Flags]:
    """Remove interior vertices of degree 2 by merging their two quads, until there are none.

    Each merge: V-1, E-2, F-1. Points that are no longer used are dropped and the rest renumbered
    in order.
    """
    merged, _ = merged_doublets(quads, np.zeros(len(points), bool))
    used = np.zeros(len(points), dtype=bool)
    used[merged] = True
    new = np.cumsum(used) - 1
    return points[used], new[merged], geometric[used]


def merged_doublets(quads: Elements, kept: Flags) -> tuple[Elements, Elements]:
    """The quads of :func:`without_doublets` on the old points, and their rows among the old ones.

    kept: (n,) vertices that stay even if they have two quads.
    """
    quads = quads.copy()
    rows = np.arange(len(quads))
    while True:
        check_time()
        doublet = _first_doublets(quads, len(kept))
        doublet = doublet[~kept[doublet]]
        if len(doublet) == 0:
            break
        touched = np.zeros(len(quads), dtype=bool)
        dead = np.zeros(len(quads), dtype=bool)
        where = np.flatnonzero(np.isin(quads, doublet).any(axis=1))
        for vertex in doublet:
            e, f = (int(q) for q in where[(quads[where] == vertex).any(axis=1)])
            if touched[e] or touched[f]:
                continue
            touched[[e, f]] = True
            a = np.roll(quads[e], -int(np.flatnonzero(quads[e] == vertex)[0]))
            b = np.roll(quads[f], -int(np.flatnonzero(quads[f] == vertex)[0]))
            quads[e] = [a[1], a[2], a[3], b[2]]
            dead[f] = True
        quads, rows = quads[~dead], rows[~dead]
    return quads, rows


def _sides(elements: Elements) -> Elements:
    """Return (m, k, 2): the ends of each side, in order."""
    return np.stack([elements, np.roll(elements, -1, axis=1)], axis=2)


def _candidates(points: Points, triangles: Elements) -> tuple[Elements, Elements, Elements]:
    """Return for each inner edge its two triangles and the quad that they make together."""
    n = len(points)
    ends = _sides(triangles).reshape(-1, 2)
    order = np.argsort(ends.min(axis=1) * n + ends.max(axis=1), kind="stable")
    key = (ends.min(axis=1) * n + ends.max(axis=1))[order]
    twice = np.flatnonzero(key[1:] == key[:-1])
    h, g = order[twice], order[twice + 1]
    apex = np.roll(triangles, -2, axis=1).ravel()
    quads = np.column_stack([ends[h, 0], apex[g], ends[h, 1], apex[h]])
    return h // 3, g // 3, quads


def _squareness(corners: Points) -> Reals:
    """Return 1 - max |angle - 90| / 90 for (m, 4, 2) corners; not positive unless convex."""
    before = corners - np.roll(corners, 1, axis=1)
    after = np.roll(before, -1, axis=1)
    across = before[..., 0] * after[..., 1] - before[..., 1] * after[..., 0]
    along = (before * after).sum(axis=2)
    turn = np.degrees(np.arctan2(across, along))
    return 1 - np.abs(turn - 90).max(axis=1) / 90


def _best_matching(one: Elements, other: Elements, quality: Reals) -> Elements:
    import networkx

    graph = networkx.Graph()
    pairs = zip(one.tolist(), other.tolist(), quality.tolist(), strict=True)
    for i, (a, b, weight) in enumerate(pairs):
        graph.add_edge(a, b, weight=weight, index=i)
    matching = networkx.max_weight_matching(graph, maxcardinality=True)
    return np.array(sorted(graph.edges[pair]["index"] for pair in matching), dtype=np.int64)


def _greedy_matching(one: Elements, other: Elements, quality: Reals, count: int) -> Elements:
    taken = np.zeros(count, dtype=bool)
    chosen = []
    for i in np.argsort(-quality, kind="stable"):
        if not (taken[one[i]] or taken[other[i]]):
            taken[one[i]] = taken[other[i]] = True
            chosen.append(i)
    return np.array(sorted(chosen), dtype=np.int64)


def _first_doublets(quads: Elements, count: int) -> Elements:
    """Return the interior vertices with two quads."""
    ends = _sides(quads).reshape(-1, 2)
    keys, times = np.unique(ends.min(axis=1) * count + ends.max(axis=1), return_counts=True)
    rim = np.zeros(count, dtype=bool)
    rim[keys[times == 1] // count] = True
    rim[keys[times == 1] % count] = True
    elements = np.bincount(quads.ravel(), minlength=count)
    return np.flatnonzero((elements == 2) & ~rim)
