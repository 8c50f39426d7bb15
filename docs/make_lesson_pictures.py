"""Makes the pictures of the lessons and puts them into the notebooks, as attachments.

    python docs/make_lesson_pictures.py              all of them
    python docs/make_lesson_pictures.py 01 03        only those of these lessons
    python docs/make_lesson_pictures.py --out FOLDER write PNG files, leave the notebooks alone

A notebook refers to a picture as ``attachment:NAME.png``; no others are made.
Pictures are drawn larger than they are shown, and made smaller: Markdown's image syntax, the only
one that survives nbconvert, has no width.
"""

import argparse
import base64
import io
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from make_pictures import gap, most_central, quads
from PIL import Image, ImageDraw

from meshwright.graphics.drawing import (
    Disc,
    Drawing,
    Line,
    Polygon,
    Segments,
    Text,
    raster,
    text_width,
)
from meshwright.graphics.export.filmstrip import side_by_side
from meshwright.graphics.mesh_figure import FigureOptions, edges, figure
from meshwright.graphics.theme import LIGHT
from meshwright.graphics.viewport import Viewport
from meshwright.teaching import patch
from meshwright.teaching.lessons import FOLDER
from meshwright_core import HalfEdgeMesh
from meshwright_core.domains import gallery
from meshwright_core.geometry import smoothing

ARROW, NUMBER, UNIT = 5.0, 24.0, 1.6
"""Width of arrows and height of letters in pixels; scale of lines."""

ROUND = 24
"""Radius of the corners of a picture in pixels."""
SHOWN = {
    "two-quads": 560,
    "turn": 300,
    "corners-of-star": 440,
    "triangle-operations": 520,
    "trap": 440,
    "hexagon": 600,
    "quad-operations": 520,
    "global-operations": 520,
    "blocks-of-an-l": 420,
    "what-it-sees": 760,
    "two-policies": 640,
}
"""Width of each picture in the notebook, in pixels."""
COLOURS = 63
"""Colours of a picture; the next index of its palette is transparent."""


def view_of(mesh: HalfEdgeMesh, size: tuple[int, int], margin: float = 56.0) -> Viewport:
    """The viewport that shows the whole mesh."""
    return Viewport(size=size).fitted(mesh.points[mesh.vertices()], margin)


def picture(mesh: HalfEdgeMesh, size: tuple[int, int], view: Viewport | None = None) -> Drawing:
    """The mesh with its irregular vertices, without text."""
    view = view or view_of(mesh, size)
    return figure(mesh, FigureOptions(size, score=False, unit=UNIT), viewport=view)


def arrow(
    drawing: Drawing,
    view: Viewport,
    mesh: HalfEdgeMesh,
    h: int,
    words: str = "",
    colour: str = LIGHT.arrow,
) -> None:
    """Draw the arrow of half-edge h on its side of the edge, with text beside it."""
    a, b = view.to_screen(mesh.points[[mesh.origin(h), mesh.target(h)]])
    length = float(np.hypot(*(b - a)))
    along = (b - a) / length
    inward = np.array([along[1], -along[0]])  # left of the direction, y pointing down
    aside = 0.07 * length * inward
    tail, tip = a + 0.16 * length * along + aside, b - 0.16 * length * along + aside
    neck = tip - 22.0 * along
    drawing.add(
        Line(np.array([tail, neck]), colour, ARROW),
        Polygon(np.array([tip, neck + 10.0 * inward, neck - 10.0 * inward]), colour),
    )
    if words:
        wide = text_width(words, NUMBER, bold=True) / 2.0
        x, y = (tail + tip) / 2.0 + (14.0 + max(12.0, wide * abs(float(inward[0])))) * inward
        drawing.add(Text(words, (float(x), float(y)), NUMBER, colour, "middle", True))


def vertex_number(
    drawing: Drawing, view: Viewport, mesh: HalfEdgeMesh, v: int, radius: float = 21.0
) -> None:
    """The id of a vertex in a pale disc."""
    x, y = view.to_screen(mesh.points[v]).tolist()
    drawing.add(
        Disc((x, y), radius + 2.0, LIGHT.boundary),
        Disc((x, y), radius, LIGHT.raised),
        Text(str(v), (x, y), 1.1 * radius, LIGHT.text, "middle"),
    )


def two_quads() -> Any:
    """Every half-edge of two quads, with its id."""
    mesh, size = quads(2, 1), (1120, 640)
    view = view_of(mesh, size, 72.0)
    drawing = picture(mesh, size, view)
    for h in range(8):
        arrow(drawing, view, mesh, h, str(h), LIGHT.plus if h in (1, 7) else LIGHT.arrow)
    for v in range(6):
        vertex_number(drawing, view, mesh, v)
    return raster(drawing)


def turn() -> Any:
    """Four half-edges that leave a vertex, and the step from one to the next."""
    mesh, size = quads(2, 2), (720, 640)
    view = view_of(mesh, size, 48.0)
    drawing = picture(mesh, size, view)
    h = mesh.halfedge(4, 5)
    before = mesh.prev(h)
    arrow(drawing, view, mesh, h, "h")
    arrow(drawing, view, mesh, before, "prev", LIGHT.muted)
    arrow(drawing, view, mesh, mesh.twin(before), "twin", LIGHT.plus)
    vertex_number(drawing, view, mesh, 4)
    return raster(drawing)


def corners_of_star() -> Any:
    """The outline of the star; at each corner the exact and the rounded desired degree."""
    domain, size = gallery.shape("star"), (960, 800)
    outline = np.asarray(domain.outline, dtype=float)
    view = Viewport(size=size).fitted(outline, 112.0)
    drawing = Drawing(size, LIGHT.background, "the corners of a star")
    seen = view.to_screen(outline)
    drawing.add(Polygon(seen, LIGHT.fill), Line(np.vstack([seen, seen[:1]]), LIGHT.boundary, 4.0))
    middle = seen.mean(axis=0)
    for i, here in enumerate(seen):
        come, go = outline[i] - outline[i - 1], outline[(i + 1) % len(outline)] - outline[i]
        turned = np.degrees(np.arctan2(come[0] * go[1] - come[1] * go[0], come @ go))
        exact = (180.0 - turned) / 90.0 + 1.0
        desired = max(int(np.floor(exact + 0.5)), 2)
        out = (here - middle) / np.linalg.norm(here - middle)
        aside = 54.0 + 34.0 * abs(float(out[0]))
        x, y = (here + aside * out).tolist()
        drawing.add(
            Disc(tuple(here.tolist()), 8.0, LIGHT.boundary),
            Text(f"{exact:.1f} \u2192 {desired}", (x, y), 26.0, LIGHT.text, "middle", True),
        )
    return raster(drawing)


def before_after(mesh: HalfEdgeMesh, operation: str, h: int, size: tuple[int, int]) -> Any:
    """A patch with an arrow, and the patch after the operation."""
    view = view_of(mesh, size, 28.0)
    first = picture(mesh, size, view)
    arrow(first, view, mesh, h)
    changed = mesh.copy()
    changed.apply(operation, h)
    smoothing.relax(changed)
    return side_by_side([raster(first), gap(size[1]), raster(picture(changed, size, view))])


def stacked(rows: list[Any], between: int = 8) -> Any:
    """Pictures one below the other."""
    width, height = max(row.width for row in rows), sum(row.height for row in rows)
    image = Image.new("RGB", (width, height + between * (len(rows) - 1)), LIGHT.background)
    y = 0
    for row in rows:
        image.paste(row, ((width - row.width) // 2, y))
        y += row.height + between
    return image


def titled(image: Any, words: str) -> Any:
    """A picture with a caption above it."""
    head = Drawing((image.width, 56), LIGHT.background)
    head.add(Text(words, (28.0, 32.0), 26.0, LIGHT.text, "left", True))
    return stacked([raster(head), image], 0)


def triangle_operations() -> Any:
    """Flip, split and collapse, before and after."""
    mesh = patch("hexagon")
    rows = [
        titled(before_after(mesh, name, most_central(mesh, name), (480, 340)), name)
        for name in ("flip", "split", "collapse")
    ]
    return stacked(rows)


def hexagon_of_two_quads() -> Any:
    """The three ways to cut a hexagon into two quads."""
    angles = np.radians(60.0 * np.arange(6) + 30.0)
    points = np.column_stack([1.2 * np.cos(angles), np.sin(angles)])
    size, panels = (400, 360), []
    for first in (1, 2, 0):
        a, b = first, first + 3
        cells = [[(a + i) % 6 for i in range(4)], [(b + i) % 6 for i in range(4)]]
        geometric = np.zeros(6, dtype=bool)
        mesh = HalfEdgeMesh.from_elements(
            points, np.array(cells), geometric=geometric, desired_degree=np.full(6, 2)
        )
        view = view_of(mesh, size, 40.0)
        drawing = Drawing(size, LIGHT.background)
        seen = view.to_screen(points)
        drawing.add(
            Polygon(seen, LIGHT.fill),
            Segments(seen[[[a, b]]], LIGHT.arrow, 6.0),
            Line(np.vstack([seen, seen[:2]]), LIGHT.boundary, 4.0),
        )
        panels.append(raster(drawing))
    arrow_between = gap(size[1])
    return side_by_side([panels[0], arrow_between, panels[1], arrow_between, panels[2]])


def trap_with_numbers() -> Any:
    """A hexagon with a triangle that is no element, and the numbers of its vertices."""
    mesh, size = patch("trap"), (880, 720)
    view = view_of(mesh, size, 56.0)
    drawing = Drawing(size, LIGHT.background, "a hexagon of triangles with a trap")
    rim = view.to_screen(mesh.points[mesh.boundary_loops()[0]])
    drawing.add(
        Polygon(rim, LIGHT.fill),
        Polygon(view.to_screen(mesh.points[[9, 10, 14]]), LIGHT.accent_soft),
        Segments(view.to_screen(mesh.points[edges(mesh)]), LIGHT.edge, 2.0),
        Line(np.vstack([rim, rim[:1]]), LIGHT.boundary, 4.0),
        Line(view.to_screen(mesh.points[[9, 10, 14, 9]]), LIGHT.arrow, 4.0),
    )
    for v in (0, 1, 9, 10, 14, 19, 20):
        vertex_number(drawing, view, mesh, v, 17.0)
    return raster(drawing)


def quad_operations() -> Any:
    """A vertex split and the inverse collapse."""
    mesh = quads(4, 3)
    rows = [
        titled(before_after(mesh, name, most_central(mesh, name), (480, 380)), name)
        for name in ("split", "collapse")
    ]
    return stacked(rows)


def global_operations() -> Any:
    """A global split and a clean-up."""
    split, clean = quads(4, 3), quads(4, 3)
    rows = [
        titled(
            before_after(split, "global_split", most_central(split, "global_split"), (480, 380)),
            "global split",
        ),
        titled(
            before_after(clean, "cleanup", most_central(clean, "cleanup"), (480, 380)), "clean-up"
        ),
    ]
    return stacked(rows)


PICTURES: dict[str, Callable[[], Any]] = {
    "two-quads": two_quads,
    "turn": turn,
    "corners-of-star": corners_of_star,
    "triangle-operations": triangle_operations,
    "trap": trap_with_numbers,
    "hexagon": hexagon_of_two_quads,
    "quad-operations": quad_operations,
    "global-operations": global_operations,
}


def png(image: Any) -> bytes:
    """The picture as a PNG with rounded corners and few colours."""
    few = image.convert("RGB").quantize(COLOURS, method=Image.Quantize.MEDIANCUT, dither=0)
    few.putpalette([*(few.getpalette() or [])[: 3 * COLOURS], 255, 255, 255])
    outside = Image.new("1", image.size, 1)
    ImageDraw.Draw(outside).rounded_rectangle(
        (0, 0, image.width - 1, image.height - 1), ROUND, fill=0
    )
    few.paste(COLOURS, (0, 0, *image.size), outside)
    stream = io.BytesIO()
    few.save(stream, format="PNG", optimize=True, transparency=COLOURS)
    return stream.getvalue()


def shrunk(data: bytes, width: int) -> bytes:
    """A PNG at a smaller width."""
    large = Image.open(io.BytesIO(data)).convert("RGBA")
    size = width, round(large.height * width / large.width)
    small = large.resize(size, Image.Resampling.LANCZOS)
    stream = io.BytesIO()
    small.quantize(128, method=Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(
        stream, format="PNG", optimize=True
    )
    return stream.getvalue()


def put_into(path: Path) -> list[str]:
    """Make the pictures that a notebook refers to and attach them; returns their names."""
    import nbformat

    notebook = nbformat.read(path, as_version=4)
    made = []
    for cell in notebook.cells:
        for name in re.findall(r"attachment:([\w-]+)\.png", cell.source):
            if name in PICTURES:
                data = base64.b64encode(shrunk(png(PICTURES[name]()), SHOWN[name])).decode()
                cell.setdefault("attachments", {})[f"{name}.png"] = {"image/png": data}
                made.append(name)
    if made:
        nbformat.write(notebook, path)
    return made


def main() -> None:
    """Make the pictures of the lessons that are named, or of all."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("lessons", nargs="*", metavar="NUMBER")
    parser.add_argument("--out", type=Path, help="write PNG files here instead")
    arguments = parser.parse_args()
    if arguments.out is not None:
        arguments.out.mkdir(parents=True, exist_ok=True)
        for name, make in PICTURES.items():
            (arguments.out / f"{name}.png").write_bytes(png(make()))
        return
    for path in sorted(FOLDER.glob("*.ipynb")):
        if not arguments.lessons or path.name.startswith(tuple(arguments.lessons)):
            made = put_into(path)
            sys.stdout.write(f"{path.name}: {', '.join(made) or 'none'}\n")


if __name__ == "__main__":
    main()
