"""Finds curves that cross or touch each other anywhere but in their common ends."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.time_limit import check_time
from meshwright_core.curves.curve import Curve
from meshwright_core.curves.many_curves import points_at
from meshwright_core.domains.loops.near_pairs import pairs_near
from meshwright_core.domains.loops.side_pieces import sample_parameters
from meshwright_core.errors import MeshError, capitalised

Points = NDArray[np.float64]

TOUCH = 1e-8
"""Distance, relative to the size of the domain, below which two curves touch."""
_TURN = 15.0
_SUBDIVISIONS = 16
_DEEPEST = 12


def refuse_meetings(
    curves: Sequence[Curve], labels: Sequence[str], ends: NDArray[np.int64], size: float
) -> None:
    """Raise MeshError if two curves meet anywhere but in an end that they share.

    Polylines along the curves are compared first. Where two of their edges come as near as the
    curves may deviate from them, the distance of the curves themselves is found: curves may cross
    where their chords do not, and the other way round.

    Args:
        curves: no one has a corner inside.
        labels: what messages call the loop that each belongs to.
        ends: (n, 2) number of the point in which each begins and ends.
        size: of the domain.
    """
    edges = _Edges(curves, ends)
    lines = shapely.linestrings(edges.points)
    reach = 4.0 * edges.sagitta + TOUCH * size
    one, other = pairs_near(lines, "dwithin", reach)
    pairs = np.unique(np.sort(np.column_stack([one, other])[one != other], axis=1), axis=0)
    a, b = pairs.T
    neighbours = (edges.curve[a] == edges.curve[b]) & (b - a == 1)
    corner = (edges.nodes[a][:, :, None] == edges.nodes[b][:, None, :]) & (
        edges.nodes[a][:, :, None] >= 0
    )
    joined = corner.any(axis=(1, 2)) & ~neighbours
    for i, j in zip(a[joined].tolist(), b[joined].tolist(), strict=True):
        check_time()
        spot = _overlap(edges, i, j)
        if spot is not None:
            _refuse(labels, edges, (i, j), spot)
    apart = ~neighbours & ~joined
    for i, j in zip(a[apart].tolist(), b[apart].tolist(), strict=True):
        check_time()
        distance, spot = _distance(curves, edges, (i, j), size)
        if distance <= TOUCH * size:
            _refuse(labels, edges, (i, j), spot)


class _Edges:
    """Edges of the polylines along the curves."""

    def __init__(self, curves: Sequence[Curve], ends: NDArray[np.int64]) -> None:
        points, spans, owner, nodes, sagitta = [], [], [], [], []
        at = [sample_parameters(curve, _TURN) for curve in curves]
        places = points_at(curves, at)
        for number, (curve, t, place) in enumerate(zip(curves, at, places, strict=True)):
            points.append(np.stack([place[:-1], place[1:]], axis=1))
            spans.append(np.column_stack([t[:-1], t[1:]]))
            owner.append(np.full(len(t) - 1, number))
            touched = np.full((len(t) - 1, 2), -1)
            touched[0, 0], touched[-1, 1] = ends[number]
            nodes.append(touched)
            straight = curve.kind in ("line", "polyline")
            sagitta.append(np.zeros(len(t) - 1) if straight else _sagitta(curve, t, place))
        self.points = np.concatenate(points)
        self.spans = np.concatenate(spans)
        self.curve = np.concatenate(owner)
        self.nodes = np.concatenate(nodes)
        self.sagitta = np.concatenate(sagitta)


def _sagitta(curve: Curve, t: NDArray[np.float64], place: Points) -> NDArray[np.float64]:
    """(n - 1,) distance of the curve from the chords between parameters t (n,), about."""
    found = np.zeros(len(t) - 1)
    if curve.kind == "arc":
        angle = 0.5 * abs(curve.data["sweep"]) / len(found)
        return found + 1.1 * curve.data["radius"] * (1.0 - np.cos(angle))
    for share in (0.25, 0.5, 0.75):
        between = curve.point(t[:-1] + share * np.diff(t))
        off = between - (place[:-1] + share * np.diff(place, axis=0))
        found = np.maximum(found, np.hypot(*off.T))
    return found


def _overlap(edges: _Edges, i: int, j: int) -> Points | None:
    """A common point of two edges of straight pieces that share an end, other than that end."""
    if edges.sagitta[i] > 0.0 or edges.sagitta[j] > 0.0:
        return None
    common = shapely.intersection(*shapely.linestrings(edges.points[[i, j]]))
    if common.geom_type in ("Point", "MultiPoint") or common.is_empty:
        return None
    found: Points = shapely.get_coordinates(common).mean(axis=0)
    return found


def _distance(
    curves: Sequence[Curve], edges: _Edges, pair: tuple[int, int], size: float
) -> tuple[float, Points]:
    """Least distance of the stretches of two curves along two edges, and where it is."""
    both = [curves[edges.curve[e]] for e in pair]
    spans = [edges.spans[e] for e in pair]
    for _ in range(_DEEPEST):
        t = [np.linspace(low, high, _SUBDIVISIONS + 1) for low, high in spans]
        places = [curve.point(at) for curve, at in zip(both, t, strict=True)]
        lines = [shapely.linestrings(np.stack([p[:-1], p[1:]], axis=1)) for p in places]
        apart = shapely.distance(lines[0][:, None], lines[1][None, :])
        nearest = divmod(int(np.argmin(apart)), apart.shape[1])
        way = shapely.shortest_line(lines[0][nearest[0]], lines[1][nearest[1]])
        spot: Points = shapely.get_coordinates(way).mean(axis=0)
        lengths = [float(np.hypot(*np.diff(p, axis=0).T).max()) for p in places]
        if max(lengths) < 1e-3 * TOUCH * size or all(c.kind == "line" for c in both):
            break
        spans = [
            (at[max(k - 1, 0)], at[min(k + 2, _SUBDIVISIONS)])
            for at, k in zip(t, nearest, strict=True)
        ]
    return float(apart.min()), spot


def _refuse(labels: Sequence[str], edges: _Edges, pair: tuple[int, int], spot: Points) -> None:
    one, other = (labels[edges.curve[e]] for e in pair)
    place = f"({spot[0]:.6g}, {spot[1]:.6g})"
    if one == other:
        raise MeshError(f"{capitalised(one)} crosses or touches itself near {place}.")
    raise MeshError(f"{capitalised(other)} crosses or touches {one} near {place}.")
