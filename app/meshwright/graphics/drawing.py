"""Drawings: lists of shapes that are written as PNG by Pillow or as SVG.

The first shape is at the bottom. Coordinates are pixels from the upper left corner; colours are six
hexadecimal digits after ``#``, or for SVG any CSS colour.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

import numpy as np

SAMPLES = 4
"""Images are drawn at this many times their size and scaled down, for smooth lines."""
FAMILIES = "'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', sans-serif"
MIDDLE = 0.36
"""Distance from the middle of a line of text down to its baseline, relative to the font size."""

_ANCHORS = {"left": ("l", "start"), "middle": ("m", "middle"), "right": ("r", "end")}


@dataclass(frozen=True)
class Area:
    """The area inside an odd number of closed loops, each (m, 2)."""

    loops: Sequence[np.ndarray]
    colour: str


@dataclass(frozen=True)
class Segments:
    """Separate lines, (n, 2, 2); ``dash`` is the length of dashes and gaps, 0 for none."""

    ends: np.ndarray
    colour: str
    width: float
    dash: float = 0.0


@dataclass(frozen=True)
class Line:
    """One line through points (m, 2)."""

    points: np.ndarray
    colour: str
    width: float


@dataclass(frozen=True)
class Polygon:
    """One filled polygon (m, 2)."""

    points: np.ndarray
    colour: str


@dataclass(frozen=True)
class Disc:
    """A disc, or with ``width`` a ring, around ``centre``."""

    centre: tuple[float, float]
    radius: float
    colour: str
    width: float = 0.0


@dataclass(frozen=True)
class Square:
    """A filled square with ``half`` its side around ``centre``."""

    centre: tuple[float, float]
    half: float
    colour: str


@dataclass(frozen=True)
class Text:
    """One line of text, vertically centred at ``at``; ``anchor`` is the end that is there."""

    text: str
    at: tuple[float, float]
    size: float
    colour: str
    anchor: str = "left"
    bold: bool = False


@dataclass(frozen=True)
class Inset:
    """A part that another library draws: ``size`` pixels with the upper left corner ``at``.

    ``svg()`` returns SVG elements in pixels of the inset; ``image(scale)`` returns a Pillow image
    with ``scale`` pixels for each of them. ``scale`` enlarges both.
    """

    at: tuple[float, float]
    size: tuple[int, int]
    svg: Callable[[], str]
    image: Callable[[float], Any]
    scale: float = 1.0


Shape = Area | Segments | Line | Polygon | Disc | Square | Text | Inset


@dataclass
class Drawing:
    """Shapes on a background; ``title`` describes the picture in words."""

    size: tuple[int, int]
    background: str
    title: str = ""
    shapes: list[Shape] = field(default_factory=list)

    def add(self, *shapes: Shape) -> None:
        """Add ``shapes`` on top."""
        self.shapes.extend(shapes)


def text_width(text: str, size: float, bold: bool = False) -> float:
    """Width of ``text`` in pixels in a PNG; in SVG it may differ by a few per cent."""
    return float(_font(size, bold).getlength(text))


def hatching(corners: np.ndarray, gap: float) -> np.ndarray:
    """Slanted lines (n, 2, 2) inside a polygon (m, 2), ``gap`` pixels from one to the next."""
    along, across = np.array([1.0, -1.0]) / np.sqrt(2.0), np.array([1.0, 1.0]) / np.sqrt(2.0)
    depth, ahead = corners @ across, np.roll(corners, -1, axis=0) @ across
    lines = []
    for level in np.arange(np.ceil(depth.min() / gap), np.floor(depth.max() / gap) + 1) * gap:
        cut = (depth <= level) != (ahead <= level)
        share = ((level - depth[cut]) / (ahead[cut] - depth[cut]))[:, None]
        places = corners[cut] + share * (np.roll(corners, -1, axis=0)[cut] - corners[cut])
        places = places[np.argsort(places @ along)]
        lines += [places[i : i + 2] for i in range(0, len(places) - 1, 2)]
    return np.array(lines).reshape(-1, 2, 2)


# Pixels


def raster(drawing: Drawing, samples: int = SAMPLES) -> Any:
    """The drawing as a Pillow image in RGB of ``drawing.size``."""
    from PIL import Image, ImageDraw

    width, height = drawing.size
    image = Image.new("RGB", (width * samples, height * samples), drawing.background)
    painter = ImageDraw.Draw(image)
    for shape in drawing.shapes:
        _paint(image, painter, shape, samples)
    return image.reduce(samples) if samples > 1 else image


def _paint(image: Any, painter: Any, shape: Shape, scale: int) -> None:
    if isinstance(shape, Segments):
        ends = _dashed(shape.ends, shape.dash) if shape.dash else shape.ends
        width = max(1, round(shape.width * scale))
        for row in (np.asarray(ends).reshape(-1, 4) * scale).tolist():
            painter.line(row, fill=shape.colour, width=width)
    elif isinstance(shape, Line):
        points = (np.asarray(shape.points) * scale).ravel().tolist()
        if len(points) > 2:
            width = max(1, round(shape.width * scale))
            painter.line(points, fill=shape.colour, width=width, joint="curve")
    elif isinstance(shape, Polygon):
        painter.polygon((np.asarray(shape.points) * scale).ravel().tolist(), fill=shape.colour)
    elif isinstance(shape, Disc):
        (x, y), r = shape.centre, shape.radius * scale
        box = (x * scale - r, y * scale - r, x * scale + r, y * scale + r)
        if shape.width:
            line = max(1, round(shape.width * scale))
            painter.ellipse(box, outline=shape.colour, width=line)
        else:
            painter.ellipse(box, fill=shape.colour)
    elif isinstance(shape, Square):
        (x, y), r = shape.centre, shape.half * scale
        painter.rectangle(
            (x * scale - r, y * scale - r, x * scale + r, y * scale + r), fill=shape.colour
        )
    elif isinstance(shape, Text):
        at = (shape.at[0] * scale, (shape.at[1] + MIDDLE * shape.size) * scale)
        font = _font(shape.size * scale, shape.bold)
        anchor = _ANCHORS[shape.anchor][0] + "s"
        painter.text(at, shape.text, fill=shape.colour, font=font, anchor=anchor)
    elif isinstance(shape, Inset):
        x, y = shape.at
        image.paste(shape.image(scale * shape.scale), (round(x * scale), round(y * scale)))
    else:
        _fill(image, painter, shape, scale)


def _fill(image: Any, painter: Any, area: Area, scale: int) -> None:
    from PIL import Image, ImageDraw

    loops = [np.asarray(loop) * scale for loop in area.loops if len(loop) > 2]
    if len(loops) == 1:
        painter.polygon(loops[0].ravel().tolist(), fill=area.colour)
        return
    inside = np.zeros((image.height, image.width), dtype=bool)
    for loop in loops:
        low = np.clip(np.floor(loop.min(axis=0)), 0, image.size).astype(int)
        high = np.clip(np.ceil(loop.max(axis=0)) + 1, 0, image.size).astype(int)
        if (high <= low).any():
            continue
        part = Image.new("1", tuple((high - low).tolist()))
        ImageDraw.Draw(part).polygon((loop - low).ravel().tolist(), fill=1)
        inside[low[1] : high[1], low[0] : high[0]] ^= np.asarray(part)
    image.paste(area.colour, (0, 0, *image.size), Image.fromarray(inside))


def _dashed(ends: np.ndarray, dash: float) -> np.ndarray:
    """The dashes (m, 2, 2) of segments (n, 2, 2)."""
    made = []
    for a, b in np.asarray(ends, dtype=float):
        length = float(np.hypot(*(b - a)))
        count = max(1, round(length / (2.0 * dash)))
        begin = (np.arange(count) + 0.25) / count
        both = np.column_stack([begin, begin + 0.5 / count])
        made.append(a + both[:, :, None] * (b - a))
    return np.concatenate(made) if made else np.empty((0, 2, 2))


def _font(size: float, bold: bool = False) -> Any:
    import matplotlib
    from PIL import ImageFont

    fonts = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(str(fonts / name), size)


# Vectors


def svg(drawing: Drawing) -> str:
    """The drawing as an SVG file of ``drawing.size`` in pixels."""
    width, height = drawing.size
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" font-family="{FAMILIES}">',
        f"<title>{escape(drawing.title)}</title>",
        f'<rect width="{width}" height="{height}" fill="{drawing.background}"/>',
    ]
    lines += [_element(shape) for shape in drawing.shapes]
    return "\n".join([*lines, "</svg>", ""])


def _element(shape: Shape) -> str:
    if isinstance(shape, Area):
        path = "".join(_path(loop, closed=True) for loop in shape.loops)
        return f'<path d="{path}" fill="{shape.colour}" fill-rule="evenodd"/>'
    if isinstance(shape, Segments):
        path = "".join(_path(ends) for ends in shape.ends)
        dash = f' stroke-dasharray="{_number(shape.dash)}"' if shape.dash else ""
        return f'<path d="{path}" {_stroke(shape.colour, shape.width)}{dash}/>'
    if isinstance(shape, Line):
        return f'<path d="{_path(shape.points)}" {_stroke(shape.colour, shape.width)}/>'
    if isinstance(shape, Polygon):
        return f'<path d="{_path(shape.points, closed=True)}" fill="{shape.colour}"/>'
    if isinstance(shape, Disc):
        place = f'cx="{_number(shape.centre[0])}" cy="{_number(shape.centre[1])}"'
        if shape.width:  # Pillow draws a ring inside its radius, SVG on both sides of it
            radius = _number(shape.radius - shape.width / 2.0)
            return f'<circle {place} r="{radius}" {_stroke(shape.colour, shape.width)}/>'
        return f'<circle {place} r="{_number(shape.radius)}" fill="{shape.colour}"/>'
    if isinstance(shape, Square):
        x, y = _number(shape.centre[0] - shape.half), _number(shape.centre[1] - shape.half)
        side = _number(2.0 * shape.half)
        return f'<rect x="{x}" y="{y}" width="{side}" height="{side}" fill="{shape.colour}"/>'
    if isinstance(shape, Inset):
        place = f"translate({_number(shape.at[0])},{_number(shape.at[1])})"
        size = f" scale({_number(shape.scale)})" if shape.scale != 1.0 else ""
        return f'<g transform="{place}{size}" stroke-linejoin="round">{shape.svg()}</g>'
    x, y = _number(shape.at[0]), _number(shape.at[1] + MIDDLE * shape.size)
    weight = ' font-weight="bold"' if shape.bold else ""
    return (
        f'<text x="{x}" y="{y}" font-size="{_number(shape.size)}" fill="{shape.colour}" '
        f'text-anchor="{_ANCHORS[shape.anchor][1]}"{weight}>{escape(shape.text)}</text>'
    )


def _stroke(colour: str, width: float) -> str:
    return (
        f'fill="none" stroke="{colour}" stroke-width="{_number(width)}" '
        'stroke-linecap="round" stroke-linejoin="round"'
    )


def _path(points: np.ndarray, closed: bool = False) -> str:
    places = "L".join(f"{_number(x)},{_number(y)}" for x, y in np.asarray(points).tolist())
    return f"M{places}Z" if closed else f"M{places}"


def _number(value: float) -> str:
    """Two decimals at most, as short as they can be written."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text in ("", "-0") else text
