"""The sides of a domain cut into edges, coarse where they bend little and nothing is near."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.composite_curves import Curves, joined_curves, place_all, tangents
from meshwright_core.domains.region_loops import RegionLoops

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
SAMPLES = np.linspace(0.0, 1.0, 17)
"""Fractions of an edge's parameters at which its shape is looked at."""
STRAIGHT = 1e-7
"""Radians of turning up to which an edge counts as straight."""


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
    """

    def __init__(self, sides: RegionLoops) -> None:
        """The edges that a coarse start has where nothing else is near."""
        self.sides = sides
        every = sides.all_sides
        chains = [[span for piece in side.pieces for span in piece.curve.spans] for side in every]
        self.curves: Curves = joined_curves(chains, [side.closed for side in every])
        self.starts = [self._piece_starts(number) for number in range(len(every))]
        self._tables = [self._turning_table(number) for number in range(len(every))]
        self.curve, self.parameter, self.node = (np.zeros(0, int), np.zeros(0), np.zeros(0, int))
        self.side, self.ends = np.zeros(0, int), np.zeros((0, 2), int)
        self.span = np.zeros((0, 2))
        self._known: dict[int, int] = {}
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

    # Measures of the sides

    def _piece_starts(self, number: int) -> list[float]:
        """Parameters where the pieces of a side begin, and its length."""
        counts = [len(piece.curve.spans) for piece in self.sides.all_sides[number].pieces]
        spans = self.curves.first_span[number] + np.cumsum([0, *counts])
        starts: list[float] = self.curves.start[spans[:-1]].tolist()
        return [*starts, float(self.curves.stop[spans[-1] - 1])]

    def _turning_table(self, number: int) -> tuple[Reals, Reals]:
        """Parameters, and the turning in radians up to there."""
        spans = slice(self.curves.first_span[number], self.curves.first_span[number + 1])
        start, stop = self.curves.start[spans], self.curves.stop[spans]
        bent = np.diff(self.curves.first_control)[spans] > 2
        # a little inside of the spans, whose tangents may differ where they meet
        margin = _INSIDE * stop[-1]
        t = np.concatenate(
            [
                np.clip(np.linspace(a, b, 9 if bends else 2), a + margin, b - margin)
                for a, b, bends in zip(start, stop, bent, strict=True)
            ]
        )
        way = tangents(self.curves, np.full(len(t), number), t)
        angle = np.arctan2(way[:, 1], way[:, 0])
        turn = np.abs(np.angle(np.exp(1j * np.diff(angle))))
        turn[turn < 1e-9] = 0.0
        total = np.concatenate([[0.0], np.cumsum(turn)])
        length = stop[-1]
        if self.curves.closed[number]:  # twice around, for edges across its start
            t, total = np.append(t, t + length), np.append(total, total + total[-1])
        return t, total

    def turning(self, side: int, low: float, high: float) -> float:
        """Radians by which a side turns between two parameters, low < high, ends excluded."""
        t, total = self._tables[side]
        margin = 2.0 * _INSIDE * self.starts[side][-1]
        return float(np.interp(high - margin, t, total) - np.interp(low + margin, t, total))

    def turnings(self) -> Reals:
        """(e,) radians by which each edge turns."""
        return np.array(
            [
                self.turning(side, low, high)
                for side, (low, high) in zip(self.side.tolist(), self.span.tolist(), strict=True)
            ]
        )

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
        number = len(self.curve)
        length = self.starts[curve][-1]
        if self.curves.closed[curve] and t >= length:
            t -= length
        self.curve = np.append(self.curve, curve)
        self.parameter = np.append(self.parameter, t)
        self.node = np.append(self.node, node)
        if node >= 0:
            self._known[node] = number
        return number

    def _divided(
        self, side: int, span: tuple[float, float], ends: tuple[int, int]
    ) -> list[tuple[int, float, float, int, int]]:
        """Edges along a stretch between geometric points, or around a whole loop."""
        turn = np.degrees(self.turning(side, *span))
        count = max(1, int(np.ceil(turn / TURN_OF_EDGE - _SPARE)))
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
        if not rows:
            return
        table = list(zip(*rows, strict=True))
        self.side = np.append(self.side, np.array(table[0], int))
        self.span = np.vstack([self.span, np.column_stack(table[1:3])])
        self.ends = np.vstack([self.ends, np.column_stack(table[3:5]).astype(int)])

    def cut(self, edges: Ids, counts: Ids | None = None) -> None:
        """Cut edges in two, or in so many, alike in turning and length."""
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
        left, right = np.empty(len(self.side), int), np.empty(len(self.side), int)
        for number, side in enumerate(self.sides.all_sides):
            own = np.flatnonzero(self.side == number)
            middle = self.span[own].mean(axis=1) % self.starts[number][-1]
            piece = np.searchsorted(self.starts[number], middle, side="right") - 1
            piece = np.clip(piece, 0, len(side.pieces) - 1)
            left[own] = np.array([p.left for p in side.pieces])[piece]
            right[own] = np.array([p.right for p in side.pieces])[piece]
        return left, right
