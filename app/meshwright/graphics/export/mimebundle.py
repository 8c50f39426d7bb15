"""The picture of a mesh as the result of a notebook cell.

It is found by the entry point ``meshwright.display`` (see
:mod:`meshwright_core.core.notebook_display`) and needs only numpy and Pillow.
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

PNG = "image/png"
"""The type of the still."""
SIZE = (480, 360)
"""Size of the picture on the page in pixels."""
SHARP = 2
"""Image pixels for each pixel of the page, for screens of high resolution."""
MOST_SHAPES = 300
"""For meshes of more elements than this a PNG is smaller than an SVG."""
UNIT = 0.8
"""Scale of lines and letters, larger than in proportion to the size, for legibility."""


def mimebundle(mesh: HalfEdgeMesh, name: str = "") -> Bundle:
    """HTML with a picture, its alternative text and a caption; no metadata."""
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
    """The picture as PNG, with its size and alternative text as metadata."""
    data = {PNG: b64encode(png(mesh)).decode("ascii")}
    return data, {PNG: {"width": SIZE[0], "height": SIZE[1], "alt": caption(mesh)}}


def caption(mesh: HalfEdgeMesh) -> str:
    """``24 quads, s 8, optimum 4``."""
    goal = "the optimum" if mesh.score == mesh.optimum else f"optimum {mesh.optimum:,}"
    return f"{elements(mesh)}, s {mesh.score:,}, {goal}"


def address(mesh: HalfEdgeMesh) -> str:
    """The picture as a ``data:`` URL: SVG for a small mesh, PNG for a large one."""
    if mesh.n_elements <= MOST_SHAPES:
        drawing = figure(mesh, FigureOptions(SIZE, score=False, unit=UNIT))
        return "data:image/svg+xml," + quote(svg(drawing), safe=" /:;=,.()-'!*?")
    return "data:image/png;base64," + b64encode(png(mesh)).decode("ascii")


def png(mesh: HalfEdgeMesh) -> bytes:
    """The picture as a PNG of :data:`SHARP` times its size, with a palette of 256 colours."""
    options = FigureOptions((SIZE[0] * SHARP, SIZE[1] * SHARP), score=False, unit=UNIT * SHARP)
    file = io.BytesIO()
    quantised(raster(figure(mesh, options), SHARP), options.palette).save(file, format="PNG")
    return file.getvalue()
