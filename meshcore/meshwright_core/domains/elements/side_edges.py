"""The sides of a domain cut into edges, coarse where they bend little and nothing is near."""

from __future__ import annotations

from itertools import groupby, pairwise

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.composite_curves import place_all, tangents
from meshwright_core.domains.loops.region_loops import RegionLoops
from meshwright_core.domains.loops.side_curves import piece_starts, side_curves
from meshwright_core.errors import MeshError

Points = NDArray[np.float64]
Ids = NDArray[np.int64]
Reals = NDArray[np.float64]

TURN_OF_EDGE = 90.0
"""Degrees by which a side turns along an edge of a coarse start, about."""
_SPARE = 0.12
"""Share of an edge's turning by which a side may turn more before it gets an edge more."""
_EVEN = 1e-3
_INSIDE = 1e-9
"""Distance from the ends of spans, in lengths of the side, at which their tangents are taken."""
_SHARES = np.linspace(0.0, 1.0, 65)
_TABLED = 9
"""Places of a span that bends at which its direction is tabled."""
SAMPLES = np.linspace(0.0, 1.0, 17)
"""Fractions of an edge's parameters at which its shape is looked at."""
STRAIGHT = 1e-7
"""Radians of turning up to which an edge counts as straight."""

MAX_EDGES = 50_000
"""Edges along curves beyond which a request for short ones is refused."""


class SideEdges:
    """Vertices on the sides and edges between them; both are only ever added, or cut in two.

    Attributes:
        curves: the sides as composite curves, in the order of `RegionLoops.all_sides`.
        curve, parameter: (n,) seat of each vertex; of a junction that on the boundary.
        node: (n,) number of the geometric point that it is, -1 for none.
        side: (e,) the curve of each edge.
        span: (e, 2) the parameters of its ends, ascending; the last one of a loop may be its
            length.
        ends: (e, 2) its vertices.
        turnings: (e,) radians by which it turns.
    """

    def __init__(self, sides: RegionLoops) -> None:
        """The edges that a coarse start has where nothing else is near."""
        self.sides = sides
        every = sides.all_sides
        self.curves = side_curves(sides)
        self.starts = [piece_starts(self.curves, i, side) for i, side in enumerate(every)]
        self._tables = self._turning_tables()
        self._refuse_too_many()
        self.curve, self.parameter, self.node = (np.zeros(0, int), np.zeros(0), np.zeros(0, int))
        self.side, self.ends = np.zeros(0, int), np.zeros((0, 2), int)
        self.span, self.turnings = np.zeros((0, 2)), np.zeros(0)
        self._known: dict[int, int] = {}
        self._fresh: list[tuple[int, float, int]] = []
        rows: list[tuple[int, float, float, int, int]] = []
        for number, side in enumerate(every):
            at = [
                (t, self._vertex(number, t, node))
                for t, node in zip(self.starts[number][:-1], side.nodes[:-1], strict=True)
                if node in sides.graph.points
            ]
            length = self.starts[number][-1]
            if not side.closed:
                at.append((length, self._vertex(number, length, side.nodes[-1])))
            else:
                at = at or [(0.0, self._vertex(number, 0.0, -1))]
                at.append((length + at[0][0], at[0][1]))
            for (low, first), (high, last) in pairwise(at):
                rows += self._divided(number, (low, high), (first, last))
        self._append(rows)

    def _refuse_too_many(self) -> None:
        """Raise MeshError if the turning allowed to an edge needs more edges than are made."""
        step = self.sides.curve_step
        if step is None:
            return
        needed = sum(float(total[-1]) for _, total in self._tables) / np.radians(step)
        if needed > MAX_EDGES:
            raise MeshError(
                f"Edges that turn by {step:g} degrees at most would be about {needed:.2g} along "
                f"the curves; no more than {MAX_EDGES:,} are made."
            )

    # Measures of the sides

    def _turning_tables(self) -> list[tuple[Reals, Reals]]:
        """Of each side: parameters, and the turning in radians up to there."""
        curves = self.curves
        start, stop, first = curves.start, curves.stop, curves.first_span
        lengths = stop[first[1:] - 1]
        side = np.repeat(np.arange(len(lengths)), np.diff(first))
        # a little inside of the spans, whose tangents may differ where they meet
        margin = _INSIDE * lengths[side]
        counts = np.where(np.diff(curves.first_control) > 2, _TABLED, 2)
        row = np.repeat(np.arange(len(counts)), counts)
        place = np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts)
        share = place / (counts - 1)[row]
        t = np.where(share < 1.0, start[row] + share * (stop - start)[row], stop[row])
        t = np.clip(t, (start + margin)[row], (stop - margin)[row])
        way = tangents(curves, side[row], t)
        turn = np.abs(np.angle(np.exp(1j * np.diff(np.arctan2(way[:, 1], way[:, 0])))))
        turn[turn < 1e-9] = 0.0
        tables = []
        stops = np.concatenate([[0], np.cumsum(counts)])[first]
        for number, (low, high) in enumerate(pairwise(stops.tolist())):
            own, total = t[low:high], np.concatenate([[0.0], np.cumsum(turn[low : high - 1])])
            if curves.closed[number]:  # twice around, for edges across its start
                own = np.append(own, own + lengths[number])
                total = np.append(total, total + total[-1])
            tables.append((own, total))
        return tables

    def turning(self, side: int, low: float, high: float) -> float:
        """Radians by which a side turns between two parameters, low < high, ends excluded."""
        return float(self._turnings(side, np.array([[low, high]]))[0])

    def _turnings(self, side: int, spans: Reals) -> Reals:
        """(n,) radians by which a side turns in each of the spans (n, 2)."""
        t, total = self._tables[side]
        margin = 2.0 * _INSIDE * self.starts[side][-1]
        found = np.interp(spans + np.array([margin, -margin]), t, total)
        turns: Reals = found[:, 1] - found[:, 0]
        return turns

    def _cuts(self, side: int, low: float, high: float, count: int) -> list[float]:
        """Parameters that cut a stretch of a side in `count` parts, alike in turning and length."""
        t, total = self._tables[side]
        inner = low + _SHARES * (high - low)
        margin = 2.0 * _INSIDE * self.starts[side][-1]
        inner = np.clip(inner, low + margin, high - margin)
        turn = np.interp(inner, t, total) - np.interp(low + margin, t, total)
        measure = _SHARES + (turn / turn[-1] if turn[-1] > 1e-6 else 0.0)
        shares = np.arange(1, count) / count
        found = np.interp(shares * measure[-1], measure, _SHARES)
        found = np.where(np.abs(found - shares) < _EVEN, shares, found)
        cuts: list[float] = (low + found * (high - low)).tolist()
        return cuts

    # Vertices and edges

    def _vertex(self, curve: int, t: float, node: int) -> int:
        """The vertex of a geometric point, or a new one."""
        if node >= 0 and node in self._known:
            return self._known[node]
        number = len(self.curve) + len(self._fresh)
        length = self.starts[curve][-1]
        if self.curves.closed[curve] and t >= length:
            t -= length
        self._fresh.append((curve, t, node))
        if node >= 0:
            self._known[node] = number
        return number

    def _divided(
        self, side: int, span: tuple[float, float], ends: tuple[int, int]
    ) -> list[tuple[int, float, float, int, int]]:
        """Edges along a stretch between geometric points, or around a whole loop."""
        turn = np.degrees(self.turning(side, *span))
        step = self.sides.curve_step
        share = turn / TURN_OF_EDGE - _SPARE if step is None else turn / step - 1e-9
        count = max(1, int(np.ceil(share)))
        if ends[0] == ends[1]:
            count = max(count, 3)
        return self._row(side, span, ends, self._cuts(side, *span, count))

    def _row(
        self, side: int, span: tuple[float, float], ends: tuple[int, int], cuts: list[float]
    ) -> list[tuple[int, float, float, int, int]]:
        inner = [self._vertex(side, t, -1) for t in cuts]
        stops, vertices = [span[0], *cuts, span[1]], [ends[0], *inner, ends[1]]
        return [
            (side, low, high, first, last)
            for (low, high), (first, last) in zip(pairwise(stops), pairwise(vertices), strict=True)
        ]

    def _append(self, rows: list[tuple[int, float, float, int, int]]) -> None:
        """Append edges, and the vertices that were made for them."""
        if not rows:
            return
        if self._fresh:
            curve, parameter, node = zip(*self._fresh, strict=True)
            self.curve = np.append(self.curve, np.array(curve, int))
            self.parameter = np.append(self.parameter, parameter)
            self.node = np.append(self.node, np.array(node, int))
            self._fresh.clear()  # a copy shares the list: emptied, not replaced
        table = list(zip(*rows, strict=True))
        self.side = np.append(self.side, np.array(table[0], int))
        self.span = np.vstack([self.span, np.column_stack(table[1:3])])
        self.ends = np.vstack([self.ends, np.column_stack(table[3:5]).astype(int)])
        turns = [
            self._turnings(side, np.array([row[1:3] for row in group]))
            for side, group in groupby(rows, key=lambda row: row[0])
        ]
        self.turnings = np.append(self.turnings, np.concatenate(turns))

    def cut(self, edges: Ids, counts: Ids | None = None) -> None:
        """Cut edges in two, or in so many, alike in turning and length; new ones come last."""
        numbers = np.full(len(edges), 2) if counts is None else counts
        rows = []
        for edge, count in zip(edges.tolist(), numbers.tolist(), strict=True):
            low, high = self.span[edge].tolist()
            side = int(self.side[edge])
            first, last = self.ends[edge].tolist()
            cuts = self._cuts(side, low, high, count)
            rows += self._row(side, (low, high), (first, last), cuts)
        kept = np.ones(len(self.side), bool)
        kept[edges] = False
        self.side, self.span, self.ends = self.side[kept], self.span[kept], self.ends[kept]
        self.turnings = self.turnings[kept]
        self._append(rows)

    # Places

    @property
    def points(self) -> Points:
        """(n, 2) positions of the vertices."""
        return place_all(self.curves, self.curve, self.parameter)[:, :2]

    def places(self, edges: Ids, shares: Reals) -> Points:
        """(len(edges), len(shares), 2) points of edges at fractions of their parameters."""
        low, high = self.span[edges].T
        t = low[:, None] + (high - low)[:, None] * shares
        side = np.repeat(self.side[edges], len(shares))
        found = place_all(self.curves, side, t.ravel())[:, :2]
        return found.reshape(len(edges), len(shares), 2)

    def directions(self) -> Points:
        """(e, 2, 2) unit tangents of each edge at its start and end."""
        low, high = self.span.T
        step = 1e-6 * (high - low)
        t = np.column_stack([low + step, high - step]).ravel()
        way = tangents(self.curves, np.repeat(self.side, 2), t)[:, :2].reshape(-1, 2, 2)
        unit: Points = way / np.linalg.norm(way, axis=2, keepdims=True)
        return unit

    def left_right(self) -> tuple[Ids, Ids]:
        """(e,) the regions on the left and on the right of each edge; -1 outside."""
        every = self.sides.all_sides
        counts = [len(side.pieces) for side in every]
        first = np.cumsum([0, *counts])
        # sides laid end to end, so that one search finds the pieces of all edges
        shift = np.cumsum([0.0, *(starts[-1] for starts in self.starts)])
        begin = np.concatenate(
            [np.array(starts[:-1]) + shift[i] for i, starts in enumerate(self.starts)]
        )
        length = np.diff(shift)[self.side]
        middle = self.span.mean(axis=1) % length + shift[self.side]
        piece = np.searchsorted(begin, middle, side="right") - 1
        piece = np.clip(piece, first[self.side], first[self.side + 1] - 1)
        left = np.array([piece.left for side in every for piece in side.pieces])
        right = np.array([piece.right for side in every for piece in side.pieces])
        return left[piece], right[piece]
