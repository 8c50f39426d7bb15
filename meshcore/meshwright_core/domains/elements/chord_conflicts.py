"""Finds edges of sides that are too long: whose chords would cut off a part of the domain."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.time_limit import check_time
from meshwright_core.domains.elements.side_edges import SAMPLES, STRAIGHT, SideEdges
from meshwright_core.domains.loops.near_pairs import pairs_near
from meshwright_core.errors import MeshError

Ids = NDArray[np.int64]

_ROUNDS = 60
_GROWTH, _FREE = 16, 50_000
"""Times that there may be more edges than before, and so many more, before it is given up."""
_CLEAR = 0.5
"""Room that an arc leaves to all other sides on both sides of it, in sagittas."""
_REST = 5
"""Samples at the beginning of an edge that may lie near the edge it begins at."""
_ANGLE_SHARE, _LEAST_ANGLE = 0.35, 25.0
"""A corner between chords has this share of its true angle, or as many degrees, at least."""


def settle(edges: SideEdges, settled: int = 0) -> None:
    """Cut edges until their chords enclose what the sides do; MeshError if that has no end.

    Afterwards no two vertices have two edges in common, the chords around each vertex are in the
    order of the sides there, and between a side and its chords there is no other side, nor near
    them. So the chords can be bent to the sides without meeting.

    Args:
        edges: of the sides; they are cut as needed.
        settled: the first so many edges have been settled before.
    """
    looked_at = settled
    most = _GROWTH * len(edges.side) + _FREE
    for _ in range(_ROUNDS):
        check_time()
        bad = _repeated(edges)
        if not len(bad):
            bad = np.union1d(_wrong_angles(edges), _hit_lenses(edges, looked_at))
            looked_at = len(edges.side) - len(bad)
        else:
            looked_at = min(looked_at, int(bad.min()))
        if not len(bad):
            return
        if len(edges.side) + len(bad) > most:
            break
        edges.cut(bad)
    raise MeshError("The sides of the domain come too near to each other to be meshed.")


def _repeated(edges: SideEdges) -> Ids:
    """Edges between the same two vertices, those that bend most, and edges of loops of two."""
    low, high = edges.ends.min(axis=1), edges.ends.max(axis=1)
    _, number, times = np.unique(
        low * len(edges.curve) + high, return_inverse=True, return_counts=True
    )
    twice = np.flatnonzero((times[number.ravel()] > 1) | (low == high))
    if not len(twice):
        return twice
    turn = edges.turnings
    order = twice[np.argsort(turn[twice], kind="stable")]
    # all but the straightest of each pair
    _, first = np.unique(number.ravel()[order], return_index=True)
    spared = order[first]
    spared = spared[low[spared] != high[spared]]
    return np.setdiff1d(twice, spared)


def _wrong_angles(edges: SideEdges) -> Ids:
    """Edges whose chord makes the angle at one of its ends too small."""
    points = edges.points
    chord = points[edges.ends[:, 1]] - points[edges.ends[:, 0]]
    direction = edges.directions()
    bent = edges.turnings > STRAIGHT
    # what leaves a vertex: edges forward, then backward
    vertex = np.concatenate([edges.ends[:, 0], edges.ends[:, 1]])
    away = np.concatenate([direction[:, 0], -direction[:, 1]])
    along = np.concatenate([chord, -chord])
    left, right = edges.left_right()
    region = np.concatenate([left, right])
    heading = np.degrees(np.arctan2(away[:, 1], away[:, 0])) % 360.0
    cross = away[:, 0] * along[:, 1] - away[:, 1] * along[:, 0]
    off = np.degrees(np.arctan2(cross, (away * along).sum(axis=1)))
    off[~np.concatenate([bent, bent])] = 0.0
    order = np.lexsort((heading, vertex))
    first = np.searchsorted(vertex[order], vertex[order])
    last = np.searchsorted(vertex[order], vertex[order], side="right") - 1
    place = np.arange(len(order))
    following = order[np.where(place == last, first, place + 1)]
    angle = (heading[following] - heading[order]) % 360.0
    between = angle + off[following] - off[order]
    inside = region[order] >= 0
    least = np.where(inside, np.minimum(_ANGLE_SHARE * angle, _LEAST_ANGLE), 1.0)
    least = np.where(angle < 1.0, np.minimum(least, 0.0), least)
    worse = np.where(np.abs(off[following]) > np.abs(off[order]), following, order)
    bad = worse[(between < least) & (np.abs(off[worse]) > 0.5)]
    return np.unique(bad % len(edges.side))


def _hit_lenses(edges: SideEdges, first: int) -> Ids:
    """Edges from `first` on between which and their chord, or near, another side runs.

    Cutting an edge does not move any side, so that those looked at before stay clear.
    """
    turn = edges.turnings
    bent = np.flatnonzero(turn > STRAIGHT)
    fresh = bent[bent >= first]
    if not len(fresh):
        return fresh
    shapes = edges.places(np.arange(len(edges.side)), SAMPLES)
    straight = np.setdiff1d(np.arange(len(edges.side)), bent)
    lines = np.empty(len(edges.side), object)
    lines[bent] = shapely.linestrings(shapes[bent])
    if len(straight):
        lines[straight] = shapely.linestrings(shapes[straight][:, [0, -1]])
    chords = shapes[fresh][:, :1] + SAMPLES[:, None] * (
        shapes[fresh][:, -1:] - shapes[fresh][:, :1]
    )
    sagitta = np.linalg.norm(shapes[fresh] - chords, axis=2).max(axis=1)
    lenses = shapely.buffer(
        shapely.convex_hull(lines[fresh]), _CLEAR * sagitta, quad_segs=2, join_style="mitre"
    )
    lens, line = pairs_near(lenses, "intersects", others=lines)
    shared = edges.ends[fresh[lens]][:, :, None] == edges.ends[line][:, None, :]
    joined = shared.any(axis=(1, 2))
    # a side that begins at an end of the edge must not come back to it
    own = fresh[lens] != line
    at_start = shared.any(axis=1)[:, 0]
    rest = np.where(at_start[:, None, None], shapes[line][:, _REST:], shapes[line][:, :-_REST])
    back = np.zeros(len(lens), bool)
    pairs = np.flatnonzero(joined & own)
    if len(pairs):
        hulls = shapely.convex_hull(lines[fresh[lens[pairs]]])
        back[pairs] = shapely.intersects(hulls, shapely.linestrings(rest[pairs]))
    returning = np.where(turn[fresh[lens[back]]] >= turn[line[back]], fresh[lens[back]], line[back])
    return np.union1d(fresh[lens[~joined]], returning)
