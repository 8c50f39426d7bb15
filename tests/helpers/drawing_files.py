"""Drawings made by script, with the areas and numbers of holes that they have: as people draw them.

What they vary is what the drawings in trimesh's models/2D vary: versions of DXF, text and binary,
lines in any order, bulges, blocks, layers, paper space, splines, overlaps, doubles, stray lines.
"""

from __future__ import annotations

import io
import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import ezdxf
from ezdxf.document import Drawing


@dataclass(frozen=True)
class DrawingFile:
    """A file and what it holds: (area, holes) of each region, the largest one first."""

    name: str
    content: bytes
    regions: list[tuple[float, int]]


def saved(document: Drawing, binary: bool = False) -> bytes:
    """The content of a DXF file."""
    if binary:
        stream = io.BytesIO()
        document.write(stream, fmt="bin")
        return stream.getvalue()
    text = io.StringIO()
    document.write(text)
    return document.encode(text.getvalue())


def rounded(space: Any, x: float, y: float, w: float, h: float, r: float, **look: Any) -> float:
    """Draw a rectangle with fillets of radius r as lines and arcs in mixed order; its area."""
    space.add_line((x + r, y), (x + w - r, y), dxfattribs=look)
    space.add_line((x + r, y + h), (x + w - r, y + h), dxfattribs=look)
    space.add_arc((x + r, y + r), r, 180, 270, dxfattribs=look)
    space.add_arc((x + w - r, y + h - r), r, 0, 90, dxfattribs=look)
    space.add_line((x, y + h - r), (x, y + r), dxfattribs=look)
    space.add_line((x + w, y + r), (x + w, y + h - r), dxfattribs=look)
    space.add_arc((x + w - r, y + r), r, 270, 360, dxfattribs=look)
    space.add_arc((x + r, y + h - r), r, 90, 180, dxfattribs=look)
    return w * h - (4 - math.pi) * r * r


def slot(space: Any, x: float, y: float, length: float, r: float) -> float:
    """Draw a slot as one polyline with bulges; its area."""
    points = [(x, y, 0), (x + length, y, 1), (x + length, y + 2 * r, 0), (x, y + 2 * r, 1)]
    space.add_lwpolyline(points, format="xyb", close=True)
    return 2 * r * length + math.pi * r * r


def _tray(space: Any) -> list[tuple[float, int]]:
    area = rounded(space, 0, 0, 17, 10, 0.5)
    for i in range(22):
        space.add_circle((1.5 + 1.4 * (i % 11), 3 + 4 * (i // 11)), 0.1)
    area -= 22 * math.pi * 0.01 + slot(space, 5, 4.5, 4, 0.25)
    return [(area, 23)]


def _several(space: Any) -> list[tuple[float, int]]:
    found = []
    for i in range(6):
        area = rounded(space, 30 * i, 0, 20 + i, 10, 1 + 0.2 * i)
        for j in range(i):
            space.add_circle((30 * i + 3 + 3 * j, 5), 1)
        found.append((area - i * math.pi, i))
    return sorted(found, reverse=True)


def _rings(space: Any) -> list[tuple[float, int]]:
    for i in range(5):
        space.add_circle((0, 0), 10 - 2 * i)
    pi = math.pi
    return [(pi * (100 - 64), 1), (pi * (36 - 16), 1), (pi * 4, 0)]


def _gear(space: Any) -> list[tuple[float, int]]:
    points = []
    for i in range(400):
        a = 2 * math.pi * i / 400
        r = 2 + 0.2 * math.cos(20 * a)
        points.append((r * math.cos(a), r * math.sin(a)))
    space.add_lwpolyline(points, close=True)
    space.add_circle((0, 0), 0.5)
    pairs = zip(points, points[1:] + points[:1], strict=True)
    area = 0.5 * sum(x * w - y * z for (x, y), (z, w) in pairs)
    return [(area - math.pi * 0.25, 1)]


def _text(space: Any) -> list[tuple[float, int]]:
    area = rounded(space, 0, 0, 60, 30, 4)
    space.add_text("Plate 7", dxfattribs={"height": 2}).set_placement((5, 5))
    space.add_mtext("Material: steel")
    space.add_point((3, 3))
    space.add_linear_dim(base=(0, -5), p1=(0, 0), p2=(60, 0)).render()
    space.add_line((-10, 15), (70, 15))
    space.add_line((30, -10), (30, 40))
    return [(area, 0)]


def _overlaps(space: Any) -> list[tuple[float, int]]:
    space.add_line((1, 0), (2, 0))
    space.add_line((2, 0), (2, 4))
    space.add_line((2, 4), (0, 4))
    space.add_line((0, 4), (0, 0))
    space.add_line((0, 0), (1.1, 0))
    return [(8, 0)]


def _doubles(space: Any) -> list[tuple[float, int]]:
    area = rounded(space, 0, 0, 60, 30, 4)
    rounded(space, 0, 0, 60, 30, 4)
    space.add_circle((20, 15), 5)
    space.add_arc((20, 15), 5, 200, 100)
    space.add_arc((20, 15), 5, 0, 250)
    return [(area - 25 * math.pi, 1)]


def _shuffled(space: Any) -> list[tuple[float, int]]:
    random_state = random.Random(3)
    corners = [(0, 0), (40, 0), (40, 10), (25, 10), (25, 30), (40, 30), (40, 40), (0, 40)]
    lines = list(zip(corners, corners[1:] + corners[:1], strict=True))
    random_state.shuffle(lines)
    for a, b in lines:
        first, last = (a, b) if random_state.random() < 0.5 else (b, a)
        space.add_line(first, last)
    return [(1600 - 300, 0)]


def _spline(space: Any) -> list[tuple[float, int]]:
    w = math.sqrt(0.5)
    control = [(5, 0), (5, 5), (0, 5), (-5, 5), (-5, 0), (-5, -5), (0, -5), (5, -5), (5, 0)]
    knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]
    space.add_rational_spline(control, [1, w, 1, w, 1, w, 1, w, 1], degree=2, knots=knots)
    space.add_ellipse((0, 0), major_axis=(2, 1), ratio=0.5)
    return [(25 * math.pi - math.pi * 5 * 0.5, 1)]


def _half(space: Any) -> list[tuple[float, int]]:
    space.add_arc((0, 0), 10, 0, 180)
    space.add_line((-10, 0), (10, 0))
    space.add_line((100, 100), (101, 103))
    return [(50 * math.pi, 0)]


def _blocks(space: Any) -> list[tuple[float, int]]:
    block = space.doc.blocks.new("Lug", base_point=(1, 1))
    block.add_lwpolyline([(1, 1), (5, 1), (5, 3), (1, 3)], close=True)
    block.add_circle((2, 2), 0.5)
    nested = space.doc.blocks.new("Pair")
    nested.add_blockref("Lug", (0, 0))
    nested.add_blockref("Lug", (0, 10), dxfattribs={"xscale": -1})
    space.add_blockref("Pair", (100, 0), dxfattribs={"rotation": 30})
    space.add_blockref("Lug", (0, 0), dxfattribs={"xscale": 2, "yscale": 3})
    grid = {"column_count": 2, "row_count": 2, "column_spacing": 9, "row_spacing": 9}
    space.add_blockref("Lug", (0, 50), dxfattribs=grid)
    one = 8 - math.pi / 4
    return [(6 * one, 1)] + 6 * [(one, 1)]


def _hatch(space: Any) -> list[tuple[float, int]]:
    hatch = space.add_hatch()
    hatch.paths.add_polyline_path([(0, 0, 0), (6, 0, 1), (6, 4, 0), (0, 4, 0)], is_closed=True)
    edges = hatch.paths.add_edge_path()
    edges.add_arc((2, 2), 1, 0, 360)
    return [(24 + 2 * math.pi - math.pi, 1)]


def _mirrored(space: Any) -> list[tuple[float, int]]:
    down = {"extrusion": (0, 0, -1)}
    points = [(0, 0, 0), (4, 0, 1), (4, 2, 0), (0, 2, 0)]
    space.add_lwpolyline(points, format="xyb", close=True, dxfattribs=down)
    space.add_arc((2, 1), 0.5, 0, 90, dxfattribs=down)
    space.add_line((-2, 1), (-2.5, 1))
    space.add_line((-2, 1), (-2, 1.5))
    return [(8 + math.pi / 2 - math.pi / 16, 1)]


def _heavy(space: Any) -> list[tuple[float, int]]:
    polyline = space.add_polyline2d([(0, 0), (40, 0), (40, 20), (0, 20)])
    polyline.close()
    ring = space.add_polyline2d([(10, 10), (20, 10)])
    ring.close()
    for vertex in ring.vertices:
        vertex.dxf.bulge = 1
    return [(800 - 25 * math.pi, 1)]


def _two(space: Any) -> list[tuple[float, int]]:
    space.add_lwpolyline([(0, 0), (50, 0), (50, 40), (0, 40)], close=True)
    space.add_lwpolyline([(50, 0), (90, 0), (90, 40), (50, 40)], close=True)
    return [(2000, 0), (1600, 0)]


def _divided(space: Any) -> list[tuple[float, int]]:
    space.add_circle((0, 0), 10)
    space.add_line((-10, 0), (10, 0))
    space.add_arc((0, 0), 4, 0, 180)
    inner = 8 * math.pi
    return [(50 * math.pi, 0), (50 * math.pi - inner, 0), (inner, 0)]


DRAWN: list[tuple[str, Callable[[Any], list[tuple[float, int]]], str, bool]] = [
    ("tray", _tray, "R2010", False),
    ("tray_binary", _tray, "R2013", True),
    ("tray_r12", _several, "R12", False),
    ("several", _several, "R2000", False),
    ("rings", _rings, "R2004", False),
    ("gear", _gear, "R2000", False),
    ("gear_binary", _gear, "R2000", True),
    ("text", _text, "R2010", False),
    ("overlaps", _overlaps, "R12", False),
    ("doubles", _doubles, "R2007", False),
    ("shuffled", _shuffled, "R12", False),
    ("spline", _spline, "R2000", False),
    ("spline_binary", _spline, "R2018", True),
    ("half", _half, "R2010", False),
    ("blocks", _blocks, "R2010", False),
    ("blocks_binary", _blocks, "R2007", True),
    ("hatch", _hatch, "R2010", False),
    ("mirrored", _mirrored, "R2010", False),
    ("heavy", _heavy, "R12", False),
    ("two", _two, "R2010", False),
    ("divided", _divided, "R2010", False),
]
SVG = [
    ("plate", '<path d="M0 0H60V40H0z"/><circle cx="20" cy="20" r="5"/>',
     [(2400 - 25 * math.pi, 1)]),
    ("rounded", '<rect width="40" height="20" rx="3"/><rect x="50" width="9" height="9"/>',
     [(800 - (4 - math.pi) * 9, 0), (81, 0)]),
    ("outlined", '<g fill="none" stroke="red"><path d="M0 0H10A5 5 0 0 1 10 10H0"/>'
     '<path d="M0 10V0"/></g><text>no</text>', [(100 + 12.5 * math.pi, 0)]),
    ("used", '<defs><g id="lug"><rect width="8" height="4"/><circle cx="2" cy="2" r="1"/></g>'
     '</defs>'
     '<use href="#lug"/><use href="#lug" transform="translate(20 0) rotate(30) scale(2)"/>',
     [(128 - 4 * math.pi, 1), (32 - math.pi, 1)]),
]  # fmt: skip


def drawing_files() -> list[DrawingFile]:
    """All drawings."""
    found = []
    for name, draw, version, binary in DRAWN:
        document = ezdxf.new(version, setup=True)
        regions = draw(document.modelspace())
        found.append(DrawingFile(f"{name}.dxf", saved(document, binary), regions))
    document = ezdxf.new("R2010")
    regions = _tray(document.layout("Layout1"))
    found.append(DrawingFile("paper.dxf", saved(document), regions))
    document = ezdxf.new("R2000")
    regions = _gear(document.modelspace())
    # as a writer leaves it out: no markers of subclasses, no end of file
    lines = saved(document).decode().replace("\r", "").split("\n")
    pairs = [lines[i : i + 2] for i in range(0, len(lines) - 1, 2)]
    plain = [word for pair in pairs for word in pair if pair[0].strip() != "100"]
    plain = plain[: len(plain) - 2]
    found.append(DrawingFile("unmarked.dxf", "\n".join(plain).encode(), regions))
    for name, body, regions in SVG:
        text = f'<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>'
        found.append(DrawingFile(f"{name}.svg", text.encode(), regions))
    return found
