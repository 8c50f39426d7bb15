"""The still picture that stands for a mesh at the end of a notebook's cell.

It is found by the entry point ``meshwright.display`` (see
:mod:`meshwright_core.core.notebook_display`), and it needs nothing but numpy and Pillow.
"""

from __future__ import annotations

import io
from base64 import b64encode
from html import escape
from urllib.parse import quote

from meshwright.graphics.drawing import raster, svg
from meshwright.graphics.export.video import quantised
from meshwright.graphics.mesh_figure import FigureOptions, elements, figure
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.notebook_display import Bundle

SIZE = (480, 360)
"""Pixels that the picture takes on the page."""
SHARP = 2
"""Pixels of a raster for one on the page: many screens have that many."""
MOST_SHAPES = 300
"""Elements beyond which a raster is smaller than vectors are."""
UNIT = 0.8
"""Of the picture's lines and letters: it is small, and they shall be read."""


def mimebundle(mesh: HalfEdgeMesh, name: str = "") -> Bundle:
    """HTML with a picture, its words for who cannot see it, and a caption; no metadata."""
    words = f"{name}: {caption(mesh)}" if name else caption(mesh)
    width, height = SIZE
    html = (
        '<figure style="display:inline-block;margin:4px 0;max-width:100%">'
        f'<img src="{address(mesh)}" width="{width}" height="{height}" alt="{escape(words)}" '
        'style="display:block;max-width:100%;height:auto;border-radius:8px">'
        f'<figcaption style="font-size:13px;margin:4px 2px 0">{escape(words)}</figcaption>'
        "</figure>"
    )
    return {"text/html": html}, {}


def still(mesh: HalfEdgeMesh) -> Bundle:
    """The picture for whoever shows images only: PNG, with its size and words as metadata."""
    data = {"image/png": b64encode(png(mesh)).decode("ascii")}
    return data, {"image/png": {"width": SIZE[0], "height": SIZE[1], "alt": caption(mesh)}}


def caption(mesh: HalfEdgeMesh) -> str:
    """``24 quads, s 8, optimum 4``."""
    goal = "the optimum" if mesh.score == mesh.optimum else f"optimum {mesh.optimum:,}"
    return f"{elements(mesh)}, s {mesh.score:,}, {goal}"


def address(mesh: HalfEdgeMesh) -> str:
    """The picture as a ``data:`` address: vectors of a small mesh, pixels of a large one."""
    if mesh.n_elements <= MOST_SHAPES:
        drawing = figure(mesh, FigureOptions(SIZE, score=False, unit=UNIT))
        return "data:image/svg+xml," + quote(svg(drawing), safe=" /:;=,.()-'!*?")
    return "data:image/png;base64," + b64encode(png(mesh)).decode("ascii")


def png(mesh: HalfEdgeMesh) -> bytes:
    """The picture as a PNG of :data:`SHARP` times its size, in the few colours that it has."""
    options = FigureOptions((SIZE[0] * SHARP, SIZE[1] * SHARP), score=False, unit=UNIT * SHARP)
    file = io.BytesIO()
    quantised(raster(figure(mesh, options), SHARP), options.palette).save(file, format="PNG")
    return file.getvalue()
