"""Charts of experiments, drawn by matplotlib in the colours of a theme.

A chart is an :class:`~meshwright.graphics.drawing.Inset` of a drawing, so that it can stand below
meshes and be written as SVG or PNG with them. matplotlib is imported when a chart is drawn; only
its figures and canvases are used, never pyplot. One point of matplotlib is one pixel of a drawing.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.graphics.drawing import Inset
from meshwright.graphics.theme import Theme

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FONT = "DejaVu Sans"
"""The font that matplotlib ships, and that drawings use for pixels; its digits are tabular."""
FONT_SIZE, TITLE_SIZE = 11.5, 12.5
LINE_STYLES = ("-", "--", ":", "-.")
"""One for each of several series, so that they differ in more than colour."""
POINTS_PER_INCH = 72.0

_COLOURS = tuple(field.name for field in fields(Theme) if field.name != "name")

DrawChart = Callable[["Figure", Theme], None]
"""Adds axes and curves to an empty figure, in the colours of the theme."""


def chart(
    draw: DrawChart, size: tuple[int, int], theme: Theme, at: tuple[float, float] = (0.0, 0.0)
) -> Inset:
    """The chart that ``draw`` makes in a figure of ``size`` pixels.

    Args:
        draw: called once for each SVG or PNG that is written.
        size: width and height in pixels.
        theme: its colours may be CSS expressions if only SVG is written.
        at: the upper left corner of the chart in its drawing, in pixels.
    """
    return Inset(
        at,
        size,
        svg=lambda: _svg(draw, size, theme),
        image=lambda scale: _image(draw, size, theme, scale),
    )


def add_axes(
    figure: Figure,
    theme: Theme,
    box: tuple[float, float, float, float],
    x_range: tuple[float, float],
    y_range: tuple[float, float],
    x_title: str = "",
    y_labels: bool = True,
    whole_y: bool = False,
) -> Axes:
    """Axes without a frame: a faint horizontal line at each round number of y, muted labels.

    Args:
        figure: of one or more such axes.
        theme: the colours of lines and labels.
        box: left, top, width and height in pixels from the upper left corner of the figure.
        x_range: the x values of the left and right edges; their labels are whole numbers.
        y_range: the y values of the lower and upper edges.
        x_title: what x is, below the right end of its labels.
        y_labels: whether the lines of y have labels.
        whole_y: whether y is labelled at whole numbers only.
    """
    from matplotlib.ticker import MaxNLocator

    left, top, width, height = box
    across, down = (float(side) for side in figure.get_size_inches() * POINTS_PER_INCH)
    axes = figure.add_axes(
        (left / across, 1.0 - (top + height) / down, width / across, height / down),
        xlim=x_range, ylim=y_range, facecolor="none",
    )  # fmt: skip
    axes.spines[:].set_visible(False)
    axes.tick_params(length=0.0, pad=8.0, labelsize=FONT_SIZE, labelcolor=theme.muted)
    axes.tick_params(axis="x", pad=9.0)
    axes.tick_params(axis="y", labelleft=y_labels)
    axes.grid(axis="y", color=theme.line, linewidth=1.0, clip_on=False)
    axes.set_axisbelow(True)
    most = max(int(width / 56.0), 2)
    for axis, count, whole in ((axes.xaxis, most, True), (axes.yaxis, 6, whole_y)):
        axis.set_major_locator(MaxNLocator(count, steps=[1, 2, 5, 10], integer=whole))
        axis.set_major_formatter(lambda value, _: short_number(value))
    if x_title:
        axes.set_xlabel(x_title, loc="right", color=theme.muted, fontsize=FONT_SIZE)
    return axes


def add_title(axes: Axes, theme: Theme, title: str) -> None:
    """A title in bold above the left end of the axes."""
    axes.set_title(
        title, loc="left", pad=11.5, color=theme.text, fontsize=TITLE_SIZE, fontweight="bold"
    )


def add_level(axes: Axes, theme: Theme, value: float, text: str) -> None:
    """A dashed horizontal line, with ``text`` at its right end: above it if there is room."""
    low, high = axes.get_ylim()
    above = value < high - 0.12 * (high - low)
    axes.axhline(
        value, color=theme.text, linewidth=1.0, linestyle=(0, (4.0, 4.0)), clip_on=False, zorder=3.0
    )
    axes.annotate(
        text, (1.0, value), xycoords=axes.get_yaxis_transform(), textcoords="offset points",
        xytext=(0.0, 5.0 if above else -5.0), va="bottom" if above else "top", ha="right",
        color=theme.text, fontsize=FONT_SIZE,
        bbox={"facecolor": theme.background, "edgecolor": "none", "pad": 2.0},
    )  # fmt: skip


def add_legend(figure: Figure, axes: Axes, theme: Theme, left: float, top: float) -> None:
    """The labelled lines of ``axes`` in one row that begins at this pixel of the figure."""
    across, down = (float(side) for side in figure.get_size_inches() * POINTS_PER_INCH)
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="upper left", bbox_to_anchor=(left / across, 1.0 - top / down),
        ncols=len(labels), frameon=False, borderpad=0.0, borderaxespad=0.0, handlelength=2.2,
        handletextpad=0.64, columnspacing=1.9, labelcolor=theme.text, fontsize=TITLE_SIZE,
    )  # fmt: skip


def series_style(theme: Theme, index: int) -> dict[str, Any]:
    """Colour and line style of one of several series; no colour here means a degree."""
    colours = theme.accent, theme.warning, theme.text, theme.muted
    return {
        "color": colours[index % len(colours)],
        "linestyle": LINE_STYLES[index % len(LINE_STYLES)],
        "linewidth": 2.2,
    }


def short_number(value: float) -> str:
    """The label of a tick: ``1.5M``, ``20k``, ``0.5``, with a true minus sign."""
    for unit, letter in ((1e6, "M"), (1e3, "k")):
        if abs(value) >= unit:
            return f"{value / unit:g}{letter}".replace("-", "\N{MINUS SIGN}")
    return f"{value:g}".replace("-", "\N{MINUS SIGN}")


@contextmanager
def _own_settings() -> Iterator[None]:
    """matplotlib's defaults for the time of a drawing, whatever settings a notebook has made."""
    from matplotlib import rc_context, rcParams, rcParamsDefault

    defaults: Any = rcParamsDefault  # mypy takes ten seconds for its keys, 300 literals
    with rc_context():
        rcParams.update({name: defaults[name] for name in defaults if name != "backend"})
        rcParams["font.family"] = [FONT]
        rcParams["lines.solid_capstyle"] = "round"
        rcParams["lines.solid_joinstyle"] = "round"
        rcParams["svg.fonttype"] = "none"
        rcParams["svg.hashsalt"] = "meshwright"
        yield


def _figure(draw: DrawChart, size: tuple[int, int], theme: Theme, scale: float = 1.0) -> Figure:
    from matplotlib.figure import Figure

    width, height = size
    figure = Figure(
        figsize=(width / POINTS_PER_INCH, height / POINTS_PER_INCH),
        dpi=POINTS_PER_INCH * scale,
        facecolor=theme.background,
    )
    draw(figure, theme)
    return figure


def _image(draw: DrawChart, size: tuple[int, int], theme: Theme, scale: float) -> Any:
    """A Pillow image in RGB with ``scale`` pixels for each pixel of ``size``."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image

    with _own_settings():
        canvas = FigureCanvasAgg(_figure(draw, size, theme, scale))
        canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")


def _svg(draw: DrawChart, size: tuple[int, int], theme: Theme) -> str:
    """SVG elements without the ``svg`` element around them; fonts are those of the drawing.

    matplotlib accepts numbers for colours and nothing else, but a theme may have CSS variables: the
    figure is drawn in one number for each colour of a theme, which are then replaced.
    """
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    placeholders = {name: f"#{i:06x}" for i, name in enumerate(_COLOURS, start=1)}
    values = {placeholders[name]: getattr(theme, name) for name in _COLOURS}
    file = io.StringIO()
    with _own_settings():
        canvas = FigureCanvasSVG(_figure(draw, size, Theme(name=theme.name, **placeholders)))
        canvas.print_svg(file, metadata={"Date": None})
    text = file.getvalue()
    # what comes before the first group are a header and a style for all elements of the page
    text = text[text.index("<g id=") : text.rindex("</svg>")]
    text = re.sub(r'<g id="[^"]*"', "<g", text).replace("xlink:href", "href")
    text = re.sub(r'font-family: [^;"]*(; )?', "", text)
    return re.sub(r"#0000[0-9a-f]{2}", lambda found: values[found[0]], text)
