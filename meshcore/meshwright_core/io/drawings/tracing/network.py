"""Curves of a drawing as a network: ends joined, doubles dropped, split where one ends on another.

Straight lines are handled as arrays of their single edges, so that coastlines of many points, and
borders that two polygons share for a part of their way, cost little.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.components import components
from meshwright_core.core.time_limit import check_time
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.loops.near_pairs import pairs_near
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import MAX_POINTS, Points
from meshwright_core.io.drawings.tracing import measures

Ids = NDArray[np.int64]
Owners = tuple[int, ...]

_PAIRS = 5_000_000
"""Pairs of points within the tolerance beyond which a drawing is refused."""
_OPEN = 0.3
"""Share of a curve's length that its chord has at least where a similarity moves its ends."""
_COARSE = 5.0
"""Degrees of the samples by which curves near a point are found."""


@dataclass(frozen=True)
class Edge:
    """A curve between two nodes.

    Attributes:
        a, b: nodes at its start and its end; the same one for a closed curve.
        curve: which begins and ends exactly at the nodes.
        owners: the drawn curves that run there, by index; several where it is drawn twice.
    """

    a: int
    b: int
    curve: Curve
    owners: Owners

    @cached_property
    def dense(self) -> Points:
        """Points (n, 2) along the curve, for estimates."""
        return measures.samples(self.curve)


@dataclass
class Network:
    """Nodes and the edges between them.

    Attributes:
        nodes: (n, 2).
        edges: between them.
        hairs: how many curves were too short to stay.
        moved: how far the ends of curves were moved to meet, (m,).
    """

    nodes: Points
    edges: list[Edge]
    hairs: int = 0
    moved: Points = field(default_factory=lambda: np.zeros(0))

    def degrees(self) -> Ids:
        """(n,) ends of edges at each node."""
        ends = np.array([(edge.a, edge.b) for edge in self.edges], dtype=np.int64)
        return np.bincount(ends.ravel(), minlength=len(self.nodes))


def joined(curves: Sequence[Curve], owners: Sequence[Owners], tolerance: float) -> Network:
    """Return the network of curves.

    Ends that lie nearer than `tolerance` are one node, and so are points of different straight
    lines. A curve is split at nodes that lie on it. What lies within `tolerance` of another curve
    of the same ends is dropped, and its owners are added to those of the other.

    Raises:
        MeshError: more points than are read, or too many at one place.
    """
    straight = [i for i, curve in enumerate(curves) if curve.kind in ("line", "polyline")]
    curved = [i for i, curve in enumerate(curves) if curve.kind not in ("line", "polyline")]
    lines = [curves[i].data["points"] for i in straight]
    sizes = np.array([len(line) for line in lines], dtype=np.int64)
    rows = [*lines, *(np.array([curves[i].start, curves[i].end]) for i in curved)]
    points = np.concatenate(rows) + 0.0
    if len(points) > MAX_POINTS:
        raise MeshError(
            f"it has {len(points):,} points, and {MAX_POINTS:,} are the most that are read"
        )
    piece = np.repeat(np.arange(len(rows)), [len(row) for row in rows])
    is_end = np.zeros(len(points), dtype=bool)
    is_end[np.flatnonzero(np.diff(piece, prepend=-1))] = True
    is_end[np.flatnonzero(np.diff(piece, append=-1))] = True
    nodes, at = _clustered(points, piece, is_end, tolerance)
    first = np.concatenate([[0], np.cumsum(sizes)])
    inner = np.ones(int(first[-1]), dtype=bool)
    inner[first[1:] - 1] = False
    index = np.flatnonzero(inner)
    host = np.repeat(np.arange(len(straight)), sizes)[index]
    atoms = np.column_stack([at[index], at[index + 1]]).reshape(-1, 2)
    atoms, host = _split_atoms(atoms, host, nodes, tolerance)
    arcs, kept = _split_curves([curves[i] for i in curved], at[int(first[-1]) :].reshape(-1, 2),
                               nodes, tolerance)  # fmt: skip
    edges = _without_doubles(arcs, [owners[i] for i in curved], nodes, tolerance)
    drawn = [(curves[i], owners[i]) for i in straight]
    found = _chains(atoms, host, drawn, nodes, edges)
    hairs = len(straight) - len(np.unique(host)) + len(curved) - kept
    moved = np.hypot(*(nodes[at] - points).T)
    return Network(nodes, found + edges, hairs, moved[moved > 0.0])


def _clustered(
    points: Points, piece: Ids, is_end: NDArray[np.bool_], tolerance: float
) -> tuple[Points, Ids]:
    """Nodes (n, 2), and the node of each point: points nearer than the tolerance share one.

    Points within one curve are not joined, whatever their distance: a coastline may be finely
    drawn. A node lies at the first of its points.
    """
    unique, first, inverse = np.unique(points, axis=0, return_index=True, return_inverse=True)
    inverse = inverse.ravel()
    cell = np.floor((unique - unique.min(axis=0)) / tolerance).astype(np.int64)
    crowd = np.unique(cell, axis=0, return_counts=True)[1]
    if int((crowd**2).sum()) > 2 * _PAIRS:
        raise MeshError("too many of its points lie at one place")
    spots = shapely.points(unique)
    one, other = pairs_near(spots, "dwithin", tolerance)
    near = np.column_stack([one, other])[one < other]
    count = len(unique)
    low, high = np.full(count, len(points)), np.full(count, -1)
    np.minimum.at(low, inverse, piece)
    np.maximum.at(high, inverse, piece)
    end = np.zeros(count, dtype=bool)
    np.logical_or.at(end, inverse, is_end)
    i, j = near.T
    own = (low[i] == high[i]) & (low[j] == high[j]) & (low[i] == low[j]) & ~(end[i] & end[j])
    near = near[~own]
    number, label = components(near[:, 0], near[:, 1], count)
    leader = np.full(number, len(points))
    np.minimum.at(leader, label, first)
    return points[leader], label[inverse]


def _split_atoms(atoms: Ids, host: Ids, nodes: Points, tolerance: float) -> tuple[Ids, Ids]:
    """Split straight edges (m, 2) at the nodes that lie on them; those of no length go."""
    long = atoms[:, 0] != atoms[:, 1]
    atoms, host = atoms[long], host[long]
    if not len(atoms):
        return atoms, host
    lines = shapely.linestrings(nodes[atoms])
    atom, node = pairs_near(lines, "dwithin", tolerance, shapely.points(nodes))
    other = (atoms[atom] != node[:, None]).all(axis=1)
    atom, node = atom[other], node[other]
    start, way = nodes[atoms[atom, 0]], nodes[atoms[atom, 1]] - nodes[atoms[atom, 0]]
    size = np.hypot(*way.T)
    along = ((nodes[node] - start) * way).sum(axis=1) / size
    inside = (along > tolerance) & (along < size - tolerance)
    share = np.clip(along[inside] / size[inside], 0.0, 1.0 - 1e-12)
    atom, node = atom[inside], node[inside]
    begin = np.concatenate([atoms[:, 0], node])
    of = np.concatenate([np.arange(len(atoms)), atom])
    order = np.lexsort([np.concatenate([np.zeros(len(atoms)) - 1.0, share]), of])
    begin, of = begin[order], of[order]
    end = atoms[of, 1]
    same = of[1:] == of[:-1]
    end[:-1][same] = begin[1:][same]
    long = begin != end
    return np.column_stack([begin, end])[long], host[of[long]]


def _split_curves(
    curves: list[Curve], ends: Ids, nodes: Points, tolerance: float
) -> tuple[list[tuple[int, Edge]], int]:
    """Parts of curves between the nodes that lie on them, with the curve of each.

    Returns also how many of the curves are longer than the tolerance.
    """
    if not curves:
        return [], 0
    dense = [measures.samples(curve, _COARSE) for curve in curves]
    owner = np.repeat(np.arange(len(curves)), [len(line) for line in dense])
    lines = shapely.linestrings(np.concatenate(dense), indices=owner)
    # an arc lies within chord / 2 * tan(turn / 4) of its chord
    sagitta = np.array([np.hypot(*np.diff(line, axis=0).T).max() for line in dense]) * 0.05
    near = pairs_near(lines, "dwithin", tolerance + sagitta, shapely.points(nodes))
    found: list[tuple[int, Edge]] = []
    kept = 0
    begin = np.searchsorted(near[0], np.arange(len(curves) + 1))
    for i, curve in enumerate(curves):
        check_time()
        a, b = ends[i].tolist()
        candidates = near[1][begin[i] : begin[i + 1]]
        candidates = candidates[(candidates != a) & (candidates != b)]
        if a == b and curve.length <= 4 * tolerance:
            continue
        kept += 1
        if not len(candidates):
            found.append((i, Edge(a, b, with_ends(curve, nodes[a], nodes[b]), ())))
            continue
        t, distance = curve.project(nodes[candidates])
        away = np.minimum(
            np.hypot(*(nodes[candidates] - nodes[a]).T), np.hypot(*(nodes[candidates] - nodes[b]).T)
        )
        on = (distance <= tolerance) & (away > tolerance) & (t > 0.0) & (t < curve.length)
        order = np.argsort(t[on], kind="stable")
        cuts, inner = t[on][order], candidates[on][order]
        apart = np.diff(cuts, prepend=0.0) > 0.0
        cuts, inner = cuts[apart], inner[apart]
        parts = curve.split(cuts) if len(cuts) else (curve,)
        stops = [a, *inner.tolist(), b]
        for part, low, high in zip(parts, stops[:-1], stops[1:], strict=True):
            found.append((i, Edge(low, high, with_ends(part, nodes[low], nodes[high]), ())))
    return found, kept


def with_ends(curve: Curve, start: Points, end: Points) -> Curve:
    """The curve with these ends, which lie near its own.

    Of polylines and splines the ends move, and of splines what is near to them; arcs stay arcs.
    """
    if (curve.start == start).all() and (curve.end == end).all():
        return curve
    if curve.kind == "polyline":
        points = curve.data["points"]
        return Curve.polyline(np.vstack([start, points[1:-1], end]))
    chord = float(np.hypot(*(curve.end - curve.start)))
    if curve.kind == "line" or chord > _OPEN * curve.length:
        return curve.moved_ends(start, end)
    # a similarity of the chord would change the size of a curve that all but closes
    if curve.kind in ("arc", "ellipse") and (start == end).all():
        return whole(curve).moved_ends(start, end)
    if curve.kind == "arc":
        return Curve.arc_through(start, curve.point(0.5 * curve.length), end)
    if curve.kind == "ellipse":
        curve = Curve.through(measures.samples(curve, 1.0))
    return _blended(curve, start, end)


def whole(curve: Curve) -> Curve:
    """The whole circle or ellipse of an arc, from the same start."""
    data = curve.data
    sweep = np.copysign(2.0 * np.pi, data["sweep"])
    if curve.kind == "arc":
        return Curve.arc(data["centre"], data["radius"], data["start"], sweep)
    return Curve.ellipse(data["centre"], data["major"], data["minor"], data["start"], sweep)


def _blended(curve: Curve, start: Points, end: Points) -> Curve:
    """A spline whose control points follow the moves of its ends, less with the distance."""
    shares = np.linspace(0.0, 1.0, len(curve.data["control"]))[:, None]
    moves = (1.0 - shares) * (start - curve.start) + shares * (end - curve.end)
    data = curve.data
    made = Curve.spline(data["control"] + moves, data["knots"], data["degree"], data["weights"])
    # exactly, for rounding; knots at the ends may not be clamped
    return (
        made.moved_ends(start, end) if not (start == end).all() else made.moved_ends(start, start)
    )


def _without_doubles(
    parts: list[tuple[int, Edge]], owners: list[Owners], nodes: Points, tolerance: float
) -> list[Edge]:
    """Curved edges without those that run along another one; the first one gets their owners."""
    groups: dict[tuple[int, int], list[int]] = {}
    curves: list[Curve] = []
    ends: list[tuple[int, int]] = []
    owned: list[Owners] = []
    for i, edge in parts:
        check_time()
        key = (min(edge.a, edge.b), max(edge.a, edge.b))
        group = groups.setdefault(key, [])
        for j in group:
            if same_way(curves[j], edge.curve, 2 * tolerance):
                owned[j] = owned[j] + owners[i]
                break
        else:
            group.append(len(curves))
            curves.append(edge.curve)
            ends.append((edge.a, edge.b))
            owned.append(owners[i])
    return [
        Edge(a, b, curve, tuple(dict.fromkeys(own)))
        for (a, b), curve, own in zip(ends, curves, owned, strict=True)
    ]


def same_way(one: Curve, other: Curve, tolerance: float) -> bool:
    """Whether two curves of the same ends run within the tolerance of each other."""
    if abs(one.length - other.length) > 0.1 * one.length + 10 * tolerance:
        return False
    inner = one.point(one.length * np.array([0.5, 0.25, 0.75, 0.125, 0.875]))
    return bool((other.project(inner)[1] <= tolerance).all())


def _chains(
    atoms: Ids,
    host: Ids,
    drawn: list[tuple[Curve, Owners]],
    nodes: Points,
    curved: list[Edge],
) -> list[Edge]:
    """Straight edges without doubles, joined again to the lines that they were drawn as."""
    if not len(atoms):
        return []
    low, high = atoms.min(axis=1), atoms.max(axis=1)
    _, first, inverse = np.unique(low * len(nodes) + high, return_index=True, return_inverse=True)
    copies = np.bincount(inverse)
    # which lines share an edge: neighbours along a line must agree in it
    shared: dict[int, Owners] = {}
    for i in np.flatnonzero(copies[inverse] > 1).tolist():
        key = int(inverse[i])
        shared[key] = shared.get(key, ()) + drawn[host[i]][1]
    signature: dict[Owners, int] = {}
    sign = np.full(len(first), -1)
    for key, own in shared.items():
        shared[key] = own = tuple(dict.fromkeys(own))
        sign[key] = signature.setdefault(own, len(signature))
    ends = atoms[first].ravel().tolist()
    ends += [end for edge in curved for end in (edge.a, edge.b)]
    degree = np.bincount(ends, minlength=len(nodes))
    leads = np.zeros(len(atoms), dtype=bool)
    leads[first] = True
    row = np.flatnonzero(leads)
    joint = atoms[row[:-1], 1]
    goes_on = (np.diff(row) == 1) & (host[row[1:]] == host[row[:-1]])
    goes_on &= (atoms[row[1:], 0] == joint) & (degree[joint] == 2)
    goes_on &= sign[inverse[row[1:]]] == sign[inverse[row[:-1]]]
    stops = np.concatenate([[0], np.flatnonzero(~goes_on) + 1, [len(row)]])
    edges = []
    for begin, stop in zip(stops[:-1].tolist(), stops[1:].tolist(), strict=True):
        run = row[begin:stop]
        way = np.append(atoms[run, 0], atoms[run[-1], 1])
        line = nodes[way]
        curve, own = drawn[host[run[0]]]
        own = shared.get(int(inverse[run[0]]), own)
        same = line.shape == curve.data["points"].shape and (line == curve.data["points"]).all()
        made = curve if same else Curve.polyline(line)
        edges.append(Edge(int(way[0]), int(way[-1]), made, own))
    return edges
