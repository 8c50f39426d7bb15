"""Loose ends of a drawing: gaps that are closed, ends that are drawn on to the next curve, hairs.

Only ends at which nothing continues are touched, so that what is closed stays as it was drawn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from meshwright_core.core.time_limit import check_time
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.loops.near_pairs import pairs_near
from meshwright_core.io.drawings.drawn import Points
from meshwright_core.io.drawings.tracing import measures
from meshwright_core.io.drawings.tracing.network import Edge, Network, joined, with_ends

_NEAREST = 6
"""Loose ends looked at around each."""


@dataclass(frozen=True)
class Repair:
    """One thing that was mended: what kind, where, and how wide or long it was."""

    kind: str
    place: Points
    size: float


def mended(network: Network, gap: float, tolerance: float) -> tuple[Network, list[Repair]]:
    """Close gaps of up to `gap` at loose ends, and drop loose pieces that are shorter.

    Two ends meet where straight lines cross when drawn on; a curve is moved to the end of a line,
    and two curves meet half-way. An end near another curve is drawn on, or back, to it.

    Returns:
        The network, and what was done.
    """
    loose = _loose_ends(network)
    if not loose or gap <= tolerance:
        return network, []
    curves = {i: edge.curve for i, edge in enumerate(network.edges)}
    repairs = _pair(network, loose, gap, curves)
    paired = {(i, end) for i, end, _ in repairs}
    others = [ends for ends in loose if ends not in paired]
    reached = _reach(network, others, gap, curves)
    told = [repair for _, _, repair in repairs if repair is not None] + reached
    if told:
        owners = [edge.owners for edge in network.edges]
        former = network
        network = joined([curves[i] for i in range(len(network.edges))], owners, tolerance)
        network.hairs += former.hairs
        network.moved = former.moved
    return _without_hairs(network, gap, told)


def _loose_ends(network: Network) -> list[tuple[int, int]]:
    """(edge, end) of all ends at which nothing continues; end 0 is the start, 1 the end."""
    degree = network.degrees()
    return [
        (i, end)
        for i, edge in enumerate(network.edges)
        for end in (0, 1)
        if degree[(edge.a, edge.b)[end]] == 1
    ]


def _pair(
    network: Network, loose: list[tuple[int, int]], gap: float, curves: dict[int, Curve]
) -> list[tuple[int, int, Repair | None]]:
    """Move pairs of loose ends together, each other's nearest; return the ends moved."""
    from scipy.spatial import cKDTree

    places = np.array([network.nodes[_node(network.edges[i], end)] for i, end in loose])
    tree = cKDTree(places)
    count = min(_NEAREST, len(loose))
    away, near = tree.query(places, k=count, distance_upper_bound=gap)
    away, near = away.reshape(len(loose), -1), near.reshape(len(loose), -1)
    best: dict[int, int] = {}
    for i in range(len(loose)):
        for distance, j in zip(away[i].tolist(), near[i].tolist(), strict=True):
            if j == i or j >= len(loose) or not np.isfinite(distance):
                continue
            shortest = min(network.edges[loose[k][0]].curve.length for k in (i, j))
            if distance <= (0.25 if loose[i][0] == loose[j][0] else 0.5) * shortest:
                best[i] = j
                break
    done: list[tuple[int, int, Repair | None]] = []
    for i, j in best.items():
        if i < j and best.get(j) == i:
            (one, end), (other, stop) = loose[i], loose[j]
            width = float(np.hypot(*(places[i] - places[j])))
            goal = _meeting(curves[one], end, curves[other], stop, width)
            if one == other:
                curves[one] = with_ends(curves[one], goal, goal)
            else:
                curves[one] = _moved(curves[one], end, goal)
                curves[other] = _moved(curves[other], stop, goal)
            repair = Repair("gap", 0.5 * (places[i] + places[j]), width)
            done += [(one, end, repair), (other, stop, None)]
    return done


def _node(edge: Edge, end: int) -> int:
    return (edge.a, edge.b)[end]


def _end(curve: Curve, end: int) -> tuple[Points, Points]:
    """Place and direction, outwards, of the start (0) or end (1) of a curve."""
    first, last = measures.end_directions(curve)
    return (curve.end, last) if end else (curve.start, -first)


def _moved(curve: Curve, end: int, goal: Points) -> Curve:
    return with_ends(curve, curve.start if end else goal, goal if end else curve.end)


def _meeting(one: Curve, end: int, other: Curve, stop: int, width: float) -> Points:
    """Where two loose ends are to meet."""
    straight = [curve.kind in ("line", "polyline") for curve in (one, other)]
    (p, u), (q, v) = _end(one, end), _end(other, stop)
    if all(straight):
        across = u[0] * v[1] - u[1] * v[0]
        if abs(across) > 1e-3:
            offset = q - p
            along = (offset[0] * v[1] - offset[1] * v[0]) / across
            cross: Points = p + along * u
            if max(np.hypot(*(cross - p)), np.hypot(*(cross - q))) <= 3 * width:
                return cross
    if straight[0] != straight[1]:
        return p if straight[0] else q
    middle: Points = 0.5 * (p + q)
    return middle


def _reach(
    network: Network, loose: list[tuple[int, int]], gap: float, curves: dict[int, Curve]
) -> list[Repair]:
    """Draw loose ends on, or back, to a curve that runs by within the gap."""
    if not loose:
        return []
    dense = [measures.samples(edge.curve, 5.0) for edge in network.edges]
    owner = np.repeat(np.arange(len(dense)), [len(line) for line in dense])
    lines = shapely.linestrings(np.concatenate(dense), indices=owner)
    bend = max(float(np.hypot(*np.diff(line, axis=0).T).max()) for line in dense) * 0.05
    places = np.array([network.nodes[_node(network.edges[i], end)] for i, end in loose])
    which, near = pairs_near(shapely.points(places), "dwithin", gap + bend, lines)
    begin = np.searchsorted(which, np.arange(len(loose) + 1))
    repairs = []
    for k, (i, end) in enumerate(loose):
        check_time()
        best, target = gap, None
        for j in near[begin[k] : begin[k + 1]].tolist():
            if j == i:
                continue
            _, distance = network.edges[j].curve.project(places[k])
            if distance[0] <= best:
                best, target = float(distance[0]), j
        if target is None or best > 0.5 * curves[i].length:
            continue
        goal = _foot(curves[i], end, network.edges[target].curve, best)
        repairs.append(Repair("reach", places[k], best))
        curves[i] = _moved(curves[i], end, goal)
    return repairs


def _foot(curve: Curve, end: int, target: Curve, width: float) -> Points:
    """The point of `target` that a loose end of a curve is drawn to: straight on, if it can."""
    place, ahead = _end(curve, end)
    t, _ = target.project(place)
    foot = target.point(t)[0]
    if curve.kind in ("line", "polyline"):
        # a few steps of Newton: cross the line with the tangent at the foot
        for _ in range(4):
            slope = target.tangent(t)[0]
            across = ahead[0] * slope[1] - ahead[1] * slope[0]
            if abs(across) < 0.1:
                break
            offset = foot - place
            along = (offset[0] * slope[1] - offset[1] * slope[0]) / across
            if abs(along) > 5 * width:
                break
            t, _ = target.project(place + along * ahead)
            foot = target.point(t)[0]
    ends = np.array([target.start, target.end])
    away = np.hypot(*(ends - foot).T)
    nearest = int(away.argmin())
    found: Points = ends[nearest] if away[nearest] <= width else foot
    return found


def _without_hairs(
    network: Network, gap: float, repairs: list[Repair]
) -> tuple[Network, list[Repair]]:
    """Drop loose pieces that are shorter than the gap."""
    loose = {i for i, _ in _loose_ends(network)}
    short = {i for i in loose if network.edges[i].curve.length <= gap}
    for i in sorted(short):
        curve = network.edges[i].curve
        repairs.append(Repair("hair", 0.5 * (curve.start + curve.end), curve.length))
    edges = [edge for i, edge in enumerate(network.edges) if i not in short]
    return Network(network.nodes, edges, network.hairs, network.moved), repairs
