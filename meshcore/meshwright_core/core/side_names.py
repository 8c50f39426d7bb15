"""Names of sides: which edges have them, and how others are given.

A *side edge* is an edge of the boundary or of an interface. Its name is that of the piece of its
curve that it lies in. Where the name changes there is a geometric vertex, so that every edge is of
one side.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import (
    ELEMENT_SLOTS,
    FLAGS,
    GEOMETRIC,
    ORIGIN,
    SIDES,
    TWIN,
    MeshArrays,
)
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.core.mesh_boundary import CurvePiece, MeshBoundary
from meshwright_core.core.names import groups, joined
from meshwright_core.errors import MeshError

_JOINT = 1e-9
"""Distance of two joints, relative to the length of their curve, below which they are one."""


class Names(NamedTuple):
    """The names of a mesh that is to be built."""

    regions: Sequence[str] = ()
    """The name of each region."""
    edges: np.ndarray = np.zeros((0, 2), np.int64)
    """(n, 2) vertex ids of the ends of named edges, in any direction."""
    sides: Sequence[str] = ()
    """The name of each edge."""
    tags: dict[tuple[int, str], int] | None = None
    """As :attr:`meshwright_core.core.mesh_boundary.MeshBoundary.tags`."""


class SideEdges(NamedTuple):
    """The edges on the boundary and on interfaces, each once."""

    halfedges: np.ndarray
    """(n,) on interfaces those of the region on the left of the curve."""
    curve: np.ndarray
    """(n,) the curve of each."""
    span: np.ndarray
    """(n, 2) the parameters of its ends there; on closed curves the second may exceed the
    length."""


class _Part(NamedTuple):
    """An interval of a curve, with the piece that it is of and the name that it is to have."""

    start: float
    stop: float
    piece: CurvePiece
    name: str


def side_edges(m: MeshArrays) -> SideEdges:
    """All side edges of a mesh, by their half-edges."""
    k = int(m.counters[SIDES])
    count = int(m.counters[ELEMENT_SLOTS]) * k
    live, twin = m.edge[:count, ORIGIN] >= 0, m.edge[:count, TWIN]
    region = m.region[: count // k].repeat(k)
    bounds = live & ((twin < 0) | (region != region[np.maximum(twin, 0)]))
    halfedges = np.flatnonzero(bounds)
    curve, span = edge_places(m, halfedges, k)
    # the other half-edge of an edge of an interface runs against the curve
    once = (curve >= 0) & (span[:, 1] > span[:, 0])
    return SideEdges(halfedges[once], curve[once].astype(np.int64), span[once])


def names_of(boundary: MeshBoundary, curve: np.ndarray, span: np.ndarray) -> list[str]:
    """The name of each edge, by its curve (n,) and parameters (n, 2) there."""
    found = [""] * len(curve)
    lengths = boundary.lengths() if boundary.count else np.zeros(0)
    middle = span.mean(axis=1)
    for number in np.unique(curve[curve >= 0]).tolist():
        pieces = boundary.pieces[number] if number < len(boundary.pieces) else ()
        if not any(piece.name for piece in pieces):
            continue
        rows = np.flatnonzero(curve == number)
        t = middle[rows]
        if boundary.curves.closed[number]:
            t = np.mod(t, lengths[number])
        stops = np.array([piece.stop for piece in pieces[:-1]])
        for row, place in zip(rows.tolist(), np.searchsorted(stops, t).tolist(), strict=True):
            found[row] = pieces[place].name
    return found


def with_side_names(
    boundary: MeshBoundary, curve: np.ndarray, span: np.ndarray, names: Sequence[str]
) -> MeshBoundary:
    """The same curves, and the given names on the given ranges of them.

    Args:
        boundary: the curves with the names so far, which stay elsewhere.
        curve: (n,) of the ranges.
        span: (n, 2) their parameters, ascending; on closed curves they may exceed the length.
        names: (n,) the name on each range, "" for none.
    """
    pieces = list(boundary.pieces) or [()] * boundary.count
    lengths = boundary.lengths()
    for number in np.unique(curve).tolist():
        length = float(lengths[number])
        rows = np.flatnonzero(curve == number).tolist()
        ranges = [(float(span[row, 0]), float(span[row, 1]), names[row]) for row in rows]
        old = pieces[number] or (CurvePiece(0.0, length, "polyline"),)
        pieces[number] = _renamed(old, ranges, length, bool(boundary.curves.closed[number]))
    return replace(boundary, pieces=tuple(pieces))


def _renamed(
    pieces: Sequence[CurvePiece],
    ranges: Iterable[tuple[float, float, str]],
    length: float,
    closed: bool,
) -> tuple[CurvePiece, ...]:
    """The pieces of a curve cut at the ends of the ranges, and named by them."""
    near = _JOINT * length
    within: list[tuple[float, float, str]] = []
    for low, high, name in ranges:
        if closed and low >= length - near:
            low, high = low - length, high - length
        if closed and high > length + near:
            within += [(low, length, name), (0.0, high - length, name)]
        else:
            within.append((max(low, 0.0), min(high, length), name))
    within.sort()
    stops = _merged_joints([piece.start for piece in pieces[1:]], within, length, near)
    middles = 0.5 * (stops[:-1] + stops[1:])
    lows = np.array([low for low, _, _ in within])
    piece_stops = np.array([piece.stop for piece in pieces[:-1]])
    parts: list[_Part] = []
    for start, stop, t in zip(
        stops[:-1].tolist(), stops[1:].tolist(), middles.tolist(), strict=True
    ):
        piece = pieces[int(np.searchsorted(piece_stops, t))]
        at = int(np.searchsorted(lows, t)) - 1
        named = at >= 0 and t <= within[at][1]
        name = within[at][2] if named else piece.name
        last = parts[-1] if parts else None
        if last is not None and last.piece is piece and last.name == name:
            parts[-1] = last._replace(stop=stop)
        else:
            parts.append(_Part(start, stop, piece, name))
    return tuple(
        replace(part.piece, start=part.start, stop=part.stop, name=part.name) for part in parts
    )


def _merged_joints(
    kept: Sequence[float], ranges: Sequence[tuple[float, float, str]], length: float, near: float
) -> np.ndarray:
    """Ends of pieces and of ranges, ascending from 0 to the length, none nearer than `near`.

    Where some are that near, an end of a piece stays.
    """
    exact = np.unique([0.0, *kept, length])
    more = np.unique([end for low, high, _ in ranges for end in (low, high)] or [0.0])
    at = np.clip(np.searchsorted(exact, more), 1, len(exact) - 1)
    apart = np.minimum(np.abs(more - exact[at - 1]), np.abs(exact[at] - more)) > near
    more = more[apart & (more > 0.0) & (more < length)]
    more = more[np.diff(more, prepend=-np.inf) > near]
    joints: np.ndarray = np.union1d(exact, more)
    return joints


def changes(m: MeshArrays, boundary: MeshBoundary) -> np.ndarray:
    """Ids, ascending, of the vertices where the name of a side changes.

    That is so where the edges of one curve at the vertex have two names.
    """
    if not any(piece.name for pieces in boundary.pieces for piece in pieces):
        return np.zeros(0, np.int64)
    k = int(m.counters[SIDES])
    edges = side_edges(m)
    number: dict[str, int] = {}
    named = np.array(
        [
            number.setdefault(name, len(number))
            for name in names_of(boundary, edges.curve, edges.span)
        ],
        np.int64,
    )
    ends = edges.halfedges - edges.halfedges % k + (edges.halfedges + 1) % k
    vertex = np.concatenate([m.edge[edges.halfedges, ORIGIN], m.edge[ends, ORIGIN]]).astype(
        np.int64
    )
    curve, named = np.tile(edges.curve, 2), np.tile(named, 2)
    order = np.lexsort((curve, vertex))
    vertex, curve, named = vertex[order], curve[order], named[order]
    differs = (vertex[1:] == vertex[:-1]) & (curve[1:] == curve[:-1]) & (named[1:] != named[:-1])
    return np.unique(vertex[1:][differs])


def give_names(m: MeshArrays, boundary: MeshBoundary, names: Names) -> MeshBoundary:
    """The boundary of a mesh just built, with names; where they change vertices become geometric.

    Edges of `names` that are no side edges are left out; an edge that is given twice has the last
    name.
    """
    found = dict(enumerate(boundary.region_names))
    found.update({i: name for i, name in enumerate(names.regions) if i in found})
    boundary = replace(
        boundary, region_names=tuple(found.values()), tags={**boundary.tags, **(names.tags or {})}
    )
    if len(names.edges):
        k = int(m.counters[SIDES])
        edges = side_edges(m)
        start = m.edge[edges.halfedges, ORIGIN].astype(np.int64)
        ahead = edges.halfedges - edges.halfedges % k + (edges.halfedges + 1) % k
        end = m.edge[ahead, ORIGIN].astype(np.int64)
        slots = len(m.vertex)
        key = np.minimum(start, end) * slots + np.maximum(start, end)
        wanted = np.sort(np.asarray(names.edges, np.int64), axis=1)
        row = {int(a) * slots + int(b): i for i, (a, b) in enumerate(wanted)}
        rows = [row.get(one, -1) for one in key.tolist()]
        there = np.array([i for i, one in enumerate(rows) if one >= 0], np.int64)
        given = [names.sides[one] for one in rows if one >= 0]
        boundary = with_side_names(boundary, edges.curve[there], edges.span[there], given)
    m.vertex[changes(m, boundary), FLAGS] |= GEOMETRIC
    return boundary


def renamed(boundary: MeshBoundary, old: str, new: str) -> MeshBoundary:
    """The boundary with the group `old` called `new`, gone where `new` is "".

    Raises MeshError if no side and no region is in the group.
    """

    def other(name: str) -> str:
        return joined(new if group == old else group for group in groups(name))

    everything = [piece.name for pieces in boundary.pieces for piece in pieces]
    if not any(old in groups(name) for name in (*everything, *boundary.region_names)):
        raise MeshError(f"there is no side and no region named {old!r}")
    pieces = tuple(
        tuple(replace(piece, name=other(piece.name)) for piece in some) for some in boundary.pieces
    )
    tags = {(d, new if name == old else name): tag for (d, name), tag in boundary.tags.items()}
    regions = tuple(other(name) for name in boundary.region_names)
    plan = boundary.plan.with_side_renamed(old, new)
    return replace(boundary, pieces=pieces, region_names=regions, tags=tags, plan=plan)
