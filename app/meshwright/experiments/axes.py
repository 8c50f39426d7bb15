"""Axes: numbers against numbers, drawn with the shapes of :mod:`meshwright.graphics.drawing`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshwright.graphics.drawing import Drawing, Line, Polygon, Segments, Text, text_width
from meshwright.graphics.theme import Theme

LETTERS = 11.5
"""Pixels of the letters at the axes."""
DASHES = (0.0, 7.0, 2.5, 12.0)
"""Of the lines of several series: each has one of its own, so that colour is not the only sign."""


@dataclass(frozen=True)
class Axes:
    """A rectangle in pixels, and the numbers at its edges."""

    left: float
    top: float
    width: float
    height: float
    x_range: tuple[float, float]
    y_range: tuple[float, float]

    def x(self, values: np.ndarray | float) -> np.ndarray:
        """Pixels from the left."""
        low, high = self.x_range
        return self.left + (np.asarray(values, float) - low) * (self.width / max(high - low, 1e-12))

    def y(self, values: np.ndarray | float) -> np.ndarray:
        """Pixels from the top."""
        low, high = self.y_range
        share = (np.asarray(values, float) - low) / max(high - low, 1e-12)
        return self.top + self.height * (1.0 - share)

    def places(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """(n, 2) pixels of points."""
        return np.column_stack([self.x(x), self.y(y)])

    def frame(
        self, drawing: Drawing, theme: Theme, x_title: str = "", whole: bool = True,
        labels: bool = True, whole_y: bool = False,
    ) -> None:  # fmt: skip
        """Faint lines at round numbers of y, the numbers, and the title of x.

        whole, whole_y: the numbers at x, at y are whole ones. labels: write those at y too.
        """
        right, bottom = self.left + self.width, self.top + self.height
        for value in ticks(*self.y_range, 6, whole_y):
            y = float(self.y(value))
            line = np.array([[[self.left, y], [right, y]]])
            drawing.add(Segments(line, theme.line, 1.0))
            if labels:
                at = (self.left - 8.0, y)
                drawing.add(Text(written(value), at, LETTERS, theme.muted, "right"))
        room = max(int(self.width / 56.0), 2)
        for value in ticks(*self.x_range, room, whole):
            at = (float(self.x(value)), bottom + 14.0)
            drawing.add(Text(written(value), at, LETTERS, theme.muted, "middle"))
        if x_title:
            drawing.add(Text(x_title, (right, bottom + 32.0), LETTERS, theme.muted, "right"))

    def line(
        self, drawing: Drawing, x: np.ndarray, y: np.ndarray, colour: str, width: float = 2.0,
        dash: float = 0.0,
    ) -> None:  # fmt: skip
        """A line through points; where y is no number there is a gap."""
        known = np.isfinite(y) & np.isfinite(x)
        edges = np.flatnonzero(np.diff(known.astype(int), prepend=0, append=0))
        for begin, end in edges.reshape(-1, 2).tolist():
            points = self.places(x[begin:end], y[begin:end])
            if dash:
                drawing.add(Segments(dashes(points, dash), colour, width))
            else:
                drawing.add(Line(points, colour, width))

    def steps(self, drawing: Drawing, scores: np.ndarray, colour: str, width: float = 2.0) -> None:
        """Whole numbers that change from one x = 0, 1, 2, ... to the next."""
        x = np.repeat(np.arange(len(scores)), 2)[1:]
        y = np.repeat(scores, 2)[:-1]
        drawing.add(Line(self.places(x, y), colour, width))

    def band(
        self, drawing: Drawing, x: np.ndarray, low: np.ndarray, high: np.ndarray, colour: str
    ) -> None:
        """What lies between two lines, cut off at the edges."""
        known = np.isfinite(low) & np.isfinite(high)
        if known.sum() < 2:
            return
        low, high = np.clip(low[known], *self.y_range), np.clip(high[known], *self.y_range)
        there = self.places(x[known], high)
        back = self.places(x[known], low)[::-1]
        drawing.add(Polygon(np.concatenate([there, back]), colour))

    def level(
        self, drawing: Drawing, value: float, colour: str, text: str = "", dash: float = 4.0
    ) -> None:
        """A dashed line across, with a word at its right end on a ground of its own."""
        y, right = float(self.y(value)), self.left + self.width
        drawing.add(Segments(np.array([[[self.left, y], [right, y]]]), colour, 1.0, dash))
        if text:
            above = y - 10.0 if y > self.top + 16.0 else y + 10.0
            width = text_width(text, LETTERS) + 8.0
            box = np.array([[-width, -8.0], [0.0, -8.0], [0.0, 8.0], [-width, 8.0]])
            drawing.add(
                Polygon(box + (right + 4.0, above), drawing.background),
                Text(text, (right, above), LETTERS, colour, "right"),
            )


def ticks(low: float, high: float, most: int, whole: bool = False) -> list[float]:
    """Round numbers from low to high, at most about so many."""
    span = max(high - low, 1e-12)
    step = 10.0 ** np.floor(np.log10(span / max(most, 1)))
    step = next((step * times for times in (1, 2, 5) if span / (step * times) <= most), step * 10)
    if whole:
        step = max(round(step), 1)
    first = np.ceil(low / step - 1e-9)
    last = np.floor(high / step + 1e-9)
    return [float(round(i * step, 10)) + 0.0 for i in np.arange(first, last + 1)]


def written(value: float) -> str:
    """A number at an axis, as short as it can be."""
    if abs(value) >= 1e3:
        return f"{value / 1e3:,g}k" if abs(value) < 1e6 else f"{value / 1e6:,g}M"
    return f"{value:g}".replace("-", "\N{MINUS SIGN}")


def dashes(points: np.ndarray, dash: float) -> np.ndarray:
    """Dashes (n, 2, 2) along a line through points (m, 2), as long as the gaps between them."""
    steps = np.hypot(*np.diff(points, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    begins = np.arange(0.0, along[-1], 2.0 * dash)
    made = []
    for begin in begins.tolist():
        end = min(begin + dash, float(along[-1]))
        inner = along[(along > begin) & (along < end)]
        at = np.concatenate([[begin], inner, [end]])
        bent = np.column_stack([np.interp(at, along, points[:, i]) for i in (0, 1)])
        made += [bent[i : i + 2] for i in range(len(bent) - 1)]
    return np.array(made).reshape(-1, 2, 2)


def series_colours(theme: Theme) -> tuple[str, ...]:
    """Colours of several series, none of which means more or fewer degrees."""
    return theme.accent, theme.warning, theme.text, theme.muted


def legend(drawing: Drawing, theme: Theme, names: Sequence[str], left: float, y: float) -> None:
    """The names of the series in a row, each behind a piece of its line."""
    colours = series_colours(theme)
    x = left
    for i, name in enumerate(names):
        piece = np.array([[x, y], [x + 26.0, y]])
        colour, dash = colours[i % len(colours)], DASHES[i % len(DASHES)]
        ends = dashes(piece, dash) if dash else piece[None]
        drawing.add(Segments(ends, colour, 2.2))
        drawing.add(Text(name, (x + 34.0, y), 12.5, theme.text))
        x += 34.0 + text_width(name, 12.5) + 24.0
