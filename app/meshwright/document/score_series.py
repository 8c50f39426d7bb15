"""The score curve: s and s* of every state of a history, and the lines that draw them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import overload

import numpy as np

from meshwright.document.history import History, HistoryStep

FIRST_ROOM = 256
FAR = 4.0
"""A gap to the optimum of more than this many times the span of the curve is cut out."""


class ScoreSeries:
    """Scores s and optima s* of all states of a history, updated incrementally.

    State 0 is the start, state i the one after step i - 1; undone steps are included.
    """

    def __init__(self) -> None:
        self._values = np.zeros((FIRST_ROOM, 2), dtype=np.int64)
        self._count = 0
        self._last: HistoryStep | None = None

    @property
    def scores(self) -> np.ndarray:
        """(n,) s of each state; empty before the first :meth:`follow`."""
        return self._values[: self._count, 0]

    @property
    def optima(self) -> np.ndarray:
        """(n,) s* of each state."""
        return self._values[: self._count, 1]

    def follow(self, history: History) -> int:
        """Update from ``history``; returns the first state that may be new.

        Steps never change, and a step always follows the same steps: if the last known step is
        still in its place, so are all before it.
        """
        known = self._count - 1  # steps
        same = 0 < known <= len(history) and history[known - 1] is self._last
        first = known if same else 0
        rows = [history[i] for i in range(first, len(history))]
        self._count = len(history) + 1
        if self._count > len(self._values):
            longer = np.zeros((2 * self._count, 2), dtype=np.int64)
            longer[: len(self._values)] = self._values
            self._values = longer
        if rows:
            self._values[first + 1 : self._count] = [(row.after, row.optimum) for row in rows]
        if not same:
            self._values[0] = history.first
        self._last = history[len(history) - 1] if len(history) else None
        return first + 1 if same else 0


@dataclass(frozen=True)
class CurveFrame:
    """Maps states and scores to pixels of a rectangle in which a curve is drawn.

    In a ``broken`` frame the optimum lies far below ``low``, and is drawn at the lower edge.
    """

    left: float
    top: float
    width: float
    height: float
    states: int
    low: float
    high: float
    broken: bool = False

    @overload
    def x(self, state: float) -> float: ...
    @overload
    def x(self, state: np.ndarray) -> np.ndarray: ...
    def x(self, state: np.ndarray | float) -> np.ndarray | float:
        """x in pixels of a state, or of many."""
        return self.left + np.asarray(state) * (self.width / max(self.states - 1, 1))

    @overload
    def y(self, score: float) -> float: ...
    @overload
    def y(self, score: np.ndarray) -> np.ndarray: ...
    def y(self, score: np.ndarray | float) -> np.ndarray | float:
        """y in pixels of a score, or of many."""
        share = np.maximum(np.asarray(score) - self.low, 0.0) / max(self.high - self.low, 1e-9)
        return self.top + self.height * (1.0 - share)

    def state(self, x: float) -> int:
        """The state nearest to pixel ``x``."""
        steps = max(self.states - 1, 1)
        nearest = round((x - self.left) / max(self.width, 1e-9) * steps)
        return min(max(nearest, 0), max(self.states - 1, 0))


def frame(
    scores: np.ndarray, optima: np.ndarray, left: float, top: float, width: float, height: float
) -> CurveFrame:
    """The frame that holds all scores and optima (n,) in this rectangle.

    It is broken if the gap to the optimum is far larger than the range of the scores: otherwise
    the curve of a large mesh would look like a level line.
    """
    low = float(optima.min()) if len(optima) else 0.0
    high = max(float(scores.max()) if len(scores) else 1.0, low + 1.0)
    lowest = float(scores.min()) if len(scores) else low
    room = max(high - lowest, 4.0)
    broken = lowest - low > FAR * room
    if broken:
        low = lowest - 0.5 * room
    return CurveFrame(left, top, width, height, len(scores), low, high, broken)


def break_mark(into: CurveFrame, unit: float = 1.0) -> np.ndarray:
    """Two short slanted lines (2, 2, 2) at the left edge of a broken frame, over the optimum."""
    x, y = into.left, into.top + into.height - 7.0 * unit
    stroke = np.array([(-4.0, 2.0), (4.0, -2.0)]) * unit
    return np.stack([stroke + (x, y - 1.75 * unit), stroke + (x, y + 1.75 * unit)])


def steps(values: np.ndarray, into: CurveFrame) -> np.ndarray:
    """The values (n,) as a line of steps, (m, 2) pixels; m grows with the width, not with n.

    The line changes its height where a state is reached. With more states than pixels each column
    of pixels shows the lowest and the highest value in it.
    """
    count = len(values)
    if count == 0:
        return np.empty((0, 2))
    if count > 2 * into.width:
        column = np.floor(into.x(np.arange(count)) - into.left).astype(np.int64)
        begin = np.flatnonzero(np.diff(column, prepend=-1))
        low, high = np.minimum.reduceat(values, begin), np.maximum.reduceat(values, begin)
        rising = values[np.append(begin[1:], count) - 1] >= values[begin]
        shown = np.where(
            rising[:, None], np.column_stack([low, high]), np.column_stack([high, low])
        )
        x = np.repeat(into.left + column[begin] + 0.5, 2)
        return _without_stops(np.column_stack([x, into.y(shown.ravel())]))
    x, y = into.x(np.arange(count)), into.y(values)
    line = np.empty((2 * count - 1, 2))
    line[0::2, 0], line[0::2, 1] = x, y
    line[1::2, 0], line[1::2, 1] = x[1:], y[:-1]
    return _without_stops(line)


def _without_stops(line: np.ndarray) -> np.ndarray:
    """Without the points in the middle of a level stretch."""
    if len(line) < 3:
        return line
    level = line[1:, 1] == line[:-1, 1]
    needed = np.ones(len(line), dtype=bool)
    needed[1:-1] = ~(level[1:] & level[:-1])
    return line[needed]


def best_state(scores: np.ndarray, optima: np.ndarray) -> int:
    """The earliest state with the lowest score of those that share the last state's optimum."""
    if len(scores) == 0:
        return 0
    other = np.flatnonzero(optima != optima[-1])
    first = int(other[-1]) + 1 if len(other) else 0
    return first + int(np.argmin(scores[first:]))
