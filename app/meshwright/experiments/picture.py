"""Pictures of experiments: files, and display in notebooks with a light or a dark theme."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from meshwright.graphics.drawing import (
    Area,
    Disc,
    Drawing,
    Inset,
    Line,
    Polygon,
    Segments,
    Shape,
    Text,
    raster,
    svg,
)
from meshwright.graphics.mesh_figure import FigureOptions
from meshwright.graphics.theme import DARK, LIGHT, THEMES, Theme
from meshwright_core import MeshError
from meshwright_core.io import atomic_write

CLASS = "meshwright-picture"
SMALLEST = 0.62
"""A picture is scaled down to this share of its size at most; narrower cells scroll it."""
_DARK_HOSTS = ('body[data-jp-theme-light="false"]', ".dark", ".dark-theme", ".vscode-dark")
_LIGHT_HOSTS = ('body[data-jp-theme-light="true"]', ".light", ".light-theme", ".vscode-light")


class Picture:
    """Base class of results with a picture: SVG and PNG files, and HTML for notebooks."""

    def drawing(self, theme: Theme = LIGHT) -> Drawing:
        """The picture in the colours of ``theme``."""
        raise NotImplementedError

    def to_svg(self, path: str | Path | None = None, theme: str = "light") -> str:
        """The picture as SVG; written to ``path`` if given, atomically."""
        text = svg(self.drawing(_named(theme)))
        if path is not None:
            with atomic_write.replacing(path) as temporary:
                temporary.write_text(text, encoding="utf-8")
        return text

    def to_png(
        self, path: str | Path | None = None, theme: str = "light", scale: float = 2.0
    ) -> bytes:
        """The picture as PNG with ``scale`` times its size in pixels; written to ``path`` if given.

        Raises MeshError for a scale outside 0.1 to 8.
        """
        from io import BytesIO

        drawn = self.drawing(_named(theme))
        if not 0.1 <= scale <= 8.0:
            raise MeshError(f"A picture is drawn at a scale from 0.1 to 8, not {scale}.")
        content = BytesIO()
        raster(scaled(drawn, scale), samples=2).save(content, format="PNG", optimize=True)
        if path is not None:
            with atomic_write.replacing(path) as temporary:
                temporary.write_bytes(content.getvalue())
        return content.getvalue()

    def _repr_html_(self) -> str:
        """The picture for notebooks; its colours follow the theme of the notebook."""
        drawn = self.drawing(LIVE)
        inner = svg(drawn).partition("?>\n")[2]
        least = round(SMALLEST * drawn.size[0])
        style = f"display:block;max-width:100%;min-width:{least}px;height:auto"
        inner = inner.replace("<svg ", f'<svg role="img" style="{style}" ', 1)
        return (
            f'{_style()}<div class="{CLASS}" style="overflow-x:auto"'
            f' aria-label="{escape(drawn.title)}">{inner}</div>'
        )


def _named(theme: str) -> Theme:
    if theme not in THEMES:
        raise MeshError(f"There is no theme {theme!r}; choose one of {', '.join(THEMES)}.")
    return THEMES[theme]


def _property(name: str) -> str:
    return f"--mw-{name.replace('_', '-')}"


def _live() -> Theme:
    """CSS variables in place of colours, with those of the light theme as default."""
    colours = {
        field.name: f"var({_property(field.name)},{getattr(LIGHT, field.name)})"
        for field in fields(Theme)
        if field.name != "name"
    }
    return Theme(name="light", **colours)


LIVE = _live()
"""The theme of a picture whose colours the page decides."""


def _values(theme: Theme) -> str:
    return ";".join(
        f"{_property(field.name)}:{getattr(theme, field.name)}"
        for field in fields(Theme)
        if field.name != "name"
    )


def _style() -> str:
    """Style sheet with the colours of light and dark pages, by their classes, or else by the
    setting of the browser.
    """
    hosts = [
        (",".join(f"{host} .{CLASS}" for host in names), _values(theme))
        for names, theme in ((_LIGHT_HOSTS, LIGHT), (_DARK_HOSTS, DARK))
    ]
    rules = "".join(f"{where}{{{values}}}" for where, values in hosts)
    preferred = f"@media(prefers-color-scheme:dark){{.{CLASS}{{{_values(DARK)}}}}}"
    return f"<style>.{CLASS}{{{_values(LIGHT)}}}{preferred}{rules}</style>"


@dataclass(frozen=True)
class ThemedFigureOptions(FigureOptions):
    """Options of a figure in the colours of any theme, for example one of CSS variables."""

    given: Theme = LIGHT

    @property
    def palette(self) -> Theme:
        """The colours themselves."""
        return self.given


def shifted(shape: Shape, x: float, y: float) -> Shape:
    """The shape moved by (x, y) pixels to the right and down."""
    return _moved(shape, 1.0, (x, y))


def scaled(drawing: Drawing, factor: float) -> Drawing:
    """The drawing enlarged by a factor, with its lines and letters."""
    width, height = drawing.size
    size = max(round(width * factor), 1), max(round(height * factor), 1)
    shapes = [_moved(shape, factor, (0.0, 0.0)) for shape in drawing.shapes]
    return Drawing(size, drawing.background, drawing.title, shapes)


def _moved(shape: Shape, factor: float, by: tuple[float, float]) -> Shape:
    def place(points: Any) -> np.ndarray:
        return np.asarray(points, dtype=float) * factor + by

    if isinstance(shape, Area):
        return replace(shape, loops=[place(loop) for loop in shape.loops])
    if isinstance(shape, Segments):
        ends = place(shape.ends) if len(shape.ends) else shape.ends
        return replace(shape, ends=ends, width=shape.width * factor, dash=shape.dash * factor)
    if isinstance(shape, Line):
        return replace(shape, points=place(shape.points), width=shape.width * factor)
    if isinstance(shape, Polygon):
        return replace(shape, points=place(shape.points))
    if isinstance(shape, Text):
        x, y = place(shape.at).tolist()
        return replace(shape, at=(x, y), size=shape.size * factor)
    if isinstance(shape, Inset):
        x, y = place(shape.at).tolist()
        return replace(shape, at=(x, y), scale=shape.scale * factor)
    x, y = place(shape.centre).tolist()
    if isinstance(shape, Disc):
        return replace(
            shape, centre=(x, y), radius=shape.radius * factor, width=shape.width * factor
        )
    return replace(shape, centre=(x, y), half=shape.half * factor)
