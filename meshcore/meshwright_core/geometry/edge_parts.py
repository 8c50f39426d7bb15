"""Edges as parts of curves: their points, tangents, areas, and polylines for drawing and picking.

:mod:`meshwright_core.geometry.edge_curves` finds those of a mesh. An :class:`EdgeParts` needs no
mesh, so that it can stand for the edges that an operation would add, or those at a vertex that is
being dragged, as well. Its polylines are as fine as a view demands: the tolerance holds inside a
box, a wider one outside of it, so that the number of points depends little on the zoom.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from meshwright_core.core.arrays import ORIGIN, MeshArrays
from meshwright_core.core.composite_curves import Curves, place_all
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.geometry.edge_kernels import NODES, WEIGHTS, bulges, end_tangents
from meshwright_core.geometry.turning import Turning, turnings

_INNER = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
"""Where a segment of a polyline is compared with the edge, as fractions of it."""
_COARSE = 0.005
"""Accuracy of the box around edges, relative to the longest of them."""
_LEVELS = 40
"""The most times that a segment is halved; beyond it, its ends are equal in floating point."""


@dataclass(frozen=True)
class EdgeParts:
    """n edges, each straight or along a curve, where it follows the curve between its ends.

    Where the ends lie off the curve, the edge is off it by the interpolated difference.
    """

    curves: Curves
    curve: np.ndarray
    """(n,) int64 the curve of each edge, -1 for straight ones."""
    span: np.ndarray
    """(n, 2) the parameters of its ends; the first one may be the larger."""
    ends: np.ndarray
    """(n, 2, 3) the positions of its ends."""

    @classmethod
    def of(cls, m: MeshArrays, halfedges: np.ndarray, k: int) -> EdgeParts:
        """The true edges of half-edges (n,), each from its origin to its target."""
        halfedges = np.asarray(halfedges, np.int64)
        curve, span = edge_places(m, halfedges, k)
        last = halfedges % k == k - 1
        following = np.where(last, halfedges - (k - 1), halfedges + 1)
        ends = m.points[m.edge[np.column_stack([halfedges, following]), ORIGIN]]
        return cls(m.curves, curve, span, ends.reshape(-1, 2, 3))

    def __len__(self) -> int:
        return len(self.curve)

    def take(self, rows: np.ndarray) -> EdgeParts:
        """Some of the edges, by index or mask."""
        return EdgeParts(self.curves, self.curve[rows], self.span[rows], self.ends[rows])

    def turning(self, table: Turning) -> np.ndarray:
        """(n,) radians by which each edge turns in all; `table` is that of the curves."""
        found: np.ndarray = turnings(self.curves, table, self.curve, self.span)
        return found

    def tangents(self) -> np.ndarray:
        """(n, 2, 3) derivatives of the edges at both ends; all must lie on curves."""
        found: np.ndarray = end_tangents(self.curves, self.curve, self.span, self.ends)
        return found

    def bulges(self) -> np.ndarray:
        """(n, 3) vector areas between the edges and their chords; all must lie on curves."""
        found: np.ndarray = bulges(self.curves, self.curve, self.span, self.ends, NODES, WEIGHTS)
        return found

    @cached_property
    def _offsets(self) -> np.ndarray:
        """(n, 2, 3) the ends less the points of the curve there; 0 for straight edges."""
        off = np.zeros_like(self.ends)
        on = np.flatnonzero(self.curve >= 0)
        if len(on):
            there = place_all(self.curves, np.repeat(self.curve[on], 2), self.span[on].ravel())
            off[on] = self.ends[on] - there.reshape(-1, 2, 3)
        return off

    def points(self, rows: np.ndarray, fractions: np.ndarray) -> np.ndarray:
        """(p, 3) the points of edges `rows` (p,) at `fractions` (p,) of their parameter ranges."""
        w = fractions[:, None]
        on = self.curve[rows] >= 0
        first, second = self.ends[rows, 0], self.ends[rows, 1]
        found: np.ndarray = (1.0 - w) * first + w * second
        if on.any():
            low, high = self.span[rows[on], 0], self.span[rows[on], 1]
            f, extent = fractions[on], high - low
            # from the nearer end, so that both half-edges of an edge agree
            t = np.where(f <= 0.5, low + f * extent, high - (1.0 - f) * extent)
            off = self._offsets[rows[on]]
            found[on] = place_all(self.curves, self.curve[rows[on]], t)
            found[on] += (1.0 - w[on]) * off[:, 0] + w[on] * off[:, 1]
        # both ends to the bit, so that the sides of an element meet
        found[fractions == 0.0] = first[fractions == 0.0]
        found[fractions == 1.0] = second[fractions == 1.0]
        return found

    @property
    def box(self) -> np.ndarray:
        """(2, 3) lower and upper corner of a box around the edges; zeros if there are none."""
        if not len(self):
            return np.zeros((2, 3))
        size = float(np.linalg.norm(self.ends[:, 1] - self.ends[:, 0], axis=1).max())
        points, _ = self.polylines(max(_COARSE * size, 1e-300))
        return np.stack([points.min(axis=0), points.max(axis=0)])

    def polylines(
        self, tolerance: float, box: np.ndarray | None = None, outside: float = np.inf
    ) -> tuple[np.ndarray, np.ndarray]:
        """The edges as polylines: points (p, 3), and the first of each edge (n + 1,).

        Args:
            tolerance: the largest distance of a polyline from its edge.
            box: (2, 2) lower and upper corner of what is in view; None for everything.
            outside: the tolerance outside of the box.
        """
        if (self.curve < 0).all():
            return self.ends.reshape(-1, 3), 2 * np.arange(len(self) + 1)
        rows, low, high = self._pieces()
        kept: list[tuple[np.ndarray, np.ndarray]] = []
        for _ in range(_LEVELS):
            if not len(rows):
                break
            w = low[:, None] + _INNER * (high - low)[:, None]
            at = self.points(np.repeat(rows, len(_INNER)), w.ravel()).reshape(-1, len(_INNER), 3)
            away = np.max([_distances(at[:, i], at[:, 0], at[:, -1]) for i in (1, 2, 3)], axis=0)
            split = away > tolerance
            if box is not None:
                slack = 2.0 * away[:, None]
                seen = (at[..., :2].max(axis=1) + slack >= box[0]).all(axis=1)
                seen &= (at[..., :2].min(axis=1) - slack <= box[1]).all(axis=1)
                split &= seen | (away > outside)
            kept.append((rows[~split], low[~split]))
            rows, low, high = rows[split], low[split], high[split]
            middle = 0.5 * (low + high)
            rows = np.repeat(rows, 2)
            low, high = _interleaved(low, middle), _interleaved(middle, high)
        kept.append((rows, low))
        kept.append((np.arange(len(self)), np.ones(len(self))))
        row, w = (np.concatenate(parts) for parts in zip(*kept, strict=True))
        order = np.lexsort((w, row))
        first = np.concatenate([[0], np.cumsum(np.bincount(row, minlength=len(self)))])
        return self.points(row[order], w[order]), first

    def _pieces(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Row (p,) and range of fractions (p,), (p,) of every part of an edge inside one span."""
        on = np.flatnonzero(self.curve >= 0)
        curve, span = self.curve[on], self.span[on]
        low, high = span.min(axis=1), span.max(axis=1)
        breaks, base = _breaks(self.curves)
        near = 1e-12 * (high - low)  # a break at an end is none
        start = np.searchsorted(breaks, base[curve] + low + near, "right")
        count = np.maximum(np.searchsorted(breaks, base[curve] + high - near, "left") - start, 0)
        owner = np.repeat(np.arange(len(on)), count)
        step = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
        t = breaks[start[owner] + step] - base[curve[owner]]
        extent = span[owner, 1] - span[owner, 0]
        inner = np.clip((t - span[owner, 0]) / np.where(extent == 0.0, 1.0, extent), 0.0, 1.0)
        rows = np.concatenate([np.arange(len(self)), on[owner]])
        begin = np.concatenate([np.zeros(len(self)), inner])
        order = np.lexsort((begin, rows))
        rows, begin = rows[order], begin[order]
        last = np.append(rows[1:] != rows[:-1], True)[: len(rows)]
        end = np.where(last, 1.0, np.append(begin[1:], 1.0)[: len(rows)])
        return rows, begin, end


def _breaks(curves: Curves) -> tuple[np.ndarray, np.ndarray]:
    """Parameters where spans begin, of closed curves up to twice their length, in one ascending
    array: those of curve c are raised by the second result [c].
    """
    spans = np.diff(curves.first_span)
    if not len(spans):
        return np.zeros(0), np.zeros(0)
    length = curves.stop[curves.first_span[1:] - 1]
    base = np.concatenate([[0.0], np.cumsum(3.0 * length)[:-1]])
    owner = np.repeat(np.arange(len(spans)), spans)
    again = curves.closed[owner]
    first = curves.start + base[owner]
    return np.sort(np.concatenate([first, (first + length[owner])[again]])), base


def segments(points: np.ndarray, first: np.ndarray) -> np.ndarray:
    """(n, 2, d) the segments of polylines, given as by :meth:`EdgeParts.polylines`, in order."""
    begins = np.delete(np.arange(len(points)), first[1:] - 1)
    return np.stack([points[begins], points[begins + 1]], axis=1)


def without_last(points: np.ndarray, first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Polylines, given as by :meth:`EdgeParts.polylines`, without the last point of each."""
    return np.delete(points, first[1:] - 1, axis=0), first - np.arange(len(first))


def _interleaved(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.column_stack([one, other]).ravel()


def _distances(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """(n,) distances of points (n, 3) from segments, all (n, 3)."""
    along = end - start
    squared = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", points - start, along) / np.where(squared == 0.0, 1.0, squared)
    foot = start + np.clip(share, 0.0, 1.0)[:, None] * along
    away: np.ndarray = np.linalg.norm(points - foot, axis=1)
    return away
