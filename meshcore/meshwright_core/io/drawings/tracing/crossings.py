"""Where curves cross each other, or themselves, away from their ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from meshwright_core.core.time_limit import check_time
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.loops.near_pairs import pairs_near
from meshwright_core.io.drawings.drawn import Points
from meshwright_core.io.drawings.tracing.network import Edge, Network, Owners, joined

_ROUNDS = 40
"""Projections from one curve to the other by which a crossing is found."""
_EXACT = 1e-9
"""Distance, as a share of the drawing's size, of two curves that meet."""
_NEAR = 0.02
"""Share of the shorter curve around a shared end in which a crossing is taken for that end."""
_PARALLEL = 1e-3
"""Sine of the angle of two tangents that are the same: files round their numbers."""
_MOST = 2_000
"""Crossings beyond which no more are looked for."""


@dataclass(frozen=True)
class Crossing:
    """Two edges by index, the same one twice if it crosses itself, and the place (2,).

    touches: whether they have the same tangent there, so that neither goes to the other's far side.
    """

    one: int
    other: int
    place: Points
    touches: bool = False


def crossings(
    edges: Sequence[Edge], nodes: Points, tolerance: float, size: float
) -> list[Crossing]:
    """Return where edges meet away from the nodes that they share."""
    if not edges:
        return []
    dense = [edge.dense for edge in edges]
    owner = np.repeat(np.arange(len(dense)), [len(line) for line in dense])
    lines = shapely.linestrings(np.concatenate(dense), indices=owner)
    one, other = pairs_near(lines, "intersects")
    later = one < other
    one, other = one[later], other[later]
    found: list[Crossing] = []
    for i, j in zip(one.tolist(), other.tolist(), strict=True):
        check_time()
        spots = shapely.intersection(lines[i], lines[j])
        shared = nodes[sorted({edges[i].a, edges[i].b} & {edges[j].a, edges[j].b})]
        near = max(10 * tolerance, _NEAR * min(edges[i].curve.length, edges[j].curve.length))
        for spot in shapely.get_coordinates(spots):
            if len(shared) and np.hypot(*(shared - spot).T).min() <= near:
                continue
            place = _met(edges[i].curve, edges[j].curve, spot, _EXACT * size)
            if place is None or (len(shared) and np.hypot(*(shared - place).T).min() <= near):
                continue
            touches = _parallel(edges[i].curve, edges[j].curve, place)
            found.append(Crossing(i, j, place, touches))
        if len(found) > _MOST:
            break
    for i in np.flatnonzero(~shapely.is_simple(lines)).tolist():
        found += [Crossing(i, i, place) for place in _with_itself(dense[i])]
    return found


def _met(one: Curve, other: Curve, spot: Points, near: float) -> Points | None:
    """The point near `spot` at which two curves meet; None if they pass each other."""
    if one.straight and other.straight:
        return spot
    place = spot
    for _ in range(_ROUNDS):
        t, _ = one.project(place)
        on_one = one.point(t)[0]
        s, distance = other.project(on_one)
        place = other.point(s)[0]
        if distance[0] <= near:
            return place
    return None


def _parallel(one: Curve, other: Curve, place: Points) -> bool:
    """Whether two curves that meet at a place have one tangent there."""
    (a, b), (c, d) = (curve.tangent(curve.project(place)[0])[0] for curve in (one, other))
    return abs(float(a * d - b * c)) < _PARALLEL


def _with_itself(line: Points) -> list[Points]:
    """Where a polyline meets itself."""
    parts = shapely.linestrings(np.stack([line[:-1], line[1:]], axis=1))
    one, other = pairs_near(parts, "intersects")
    closed = bool((line[0] == line[-1]).all())
    apart = other - one > 1
    if closed:
        apart &= other - one < len(parts) - 1
    spots = shapely.get_coordinates(shapely.intersection(parts[one[apart]], parts[other[apart]]))
    return list(spots[:10])


def split_at_crossings(network: Network, tolerance: float, size: float) -> Network:
    """Return the network with its edges split where they cross."""
    cuts: dict[int, list[Points]] = {}
    for crossing in crossings(network.edges, network.nodes, tolerance, size):
        cuts.setdefault(crossing.one, []).append(crossing.place)
        cuts.setdefault(crossing.other, []).append(crossing.place)
    curves: list[Curve] = []
    owners: list[Owners] = []
    for i, edge in enumerate(network.edges):
        parts: Sequence[Curve] = (edge.curve,)
        if i in cuts:
            t = np.unique(edge.curve.project(np.array(cuts[i]))[0])
            t = t[(t > tolerance) & (t < edge.curve.length - tolerance)]
            parts = edge.curve.split(t[np.diff(t, prepend=-1.0) > tolerance]) if len(t) else parts
        curves += parts
        owners += [edge.owners] * len(parts)
    return joined(curves, owners, tolerance)
