"""SVG drawings: the visible shapes and paths as curves, the y axis turned up.

Paths, rectangles (rounded too), circles, ellipses, lines, polylines and polygons, through groups,
nested drawings with view boxes, symbols, `use` and transforms; in the user units of the drawing. A
filled shape counts as closed, as it looks. Texts and pictures are counted and left out;
definitions, clips and masks are not looked at, nor is what is not drawn: hidden, or with neither
fill nor stroke.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from xml.etree import ElementTree

import numpy as np

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings import svg_lengths, svg_paths
from meshwright_core.io.drawings.drawn import Drawing, Points, counted, polyline
from meshwright_core.io.drawings.svg_lengths import Matrix, Size, is_number, tag_of
from meshwright_core.io.drawings.svg_paths import Subpath
from meshwright_core.io.drawings.svg_styles import Styles

_GROUPS = ("svg", "g", "a", "switch", "use")
_SHAPES = ("path", "rect", "circle", "ellipse", "line", "polyline", "polygon")
_IGNORED = ("text", "image", "foreignObject")
_DEPTH = 64
_MOST = 100_000
"""Elements at which reading stops; `use` within `use` multiplies."""
_MADE_UP = re.compile(
    r"(?:path|rect|circle|ellipse|line|polyline|polygon|use|g|group|svg|layer|shape|object|id|_)"
    r"?[-_ ]*x?[\d_.\-]*",
    re.IGNORECASE,
)
"""Ids that programs make up."""
_LABEL = "{http://www.inkscape.org/namespaces/inkscape}label"
_LINK = "{http://www.w3.org/1999/xlink}href"


@dataclass(frozen=True)
class _Look:
    """What a group hands on: transform, size of its viewport, what is painted, its layer."""

    matrix: Matrix
    size: Size
    filled: bool = True
    stroked: bool = False
    shown: bool = True
    layer: str = ""


def read(content: bytes) -> Drawing:
    """Return what an SVG file draws.

    Raises:
        MeshError: the file is not XML (with the place), or not SVG; a shape is damaged; there is
            nothing to trace.
    """
    try:
        root = ElementTree.fromstring(content)
    except ElementTree.ParseError as error:
        line, column = error.position
        what = str(error).split(":")[0]
        raise MeshError(f"line {line}, column {column + 1}: this is not XML ({what})") from error
    except (ValueError, LookupError) as error:
        raise MeshError("this is not XML") from error
    except RecursionError as error:
        raise MeshError("its groups are nested too deep, or too many") from error
    if tag_of(root) != "svg":
        raise MeshError(f"it is XML but not SVG: it begins with <{tag_of(root)[:20]}>")
    try:
        reader = _Reader(root)
    except RecursionError as error:
        raise MeshError("its groups are nested too deep, or too many") from error
    reader.read()
    if not reader.drawing.curves:
        others = [counted(n, name) for name, n in sorted(reader.drawing.ignored.items())]
        found = f", only {', '.join(others)}" if others else ""
        raise MeshError(f"there are no shapes or paths to trace in it{found}")
    return reader.drawing


def says_something(name: str) -> bool:
    """Whether an id was given by a person, as far as one can see."""
    return bool(name) and _MADE_UP.fullmatch(name) is None


class _Reader:
    """Walks the tree of elements."""

    def __init__(self, root: ElementTree.Element) -> None:
        self.root = root
        self.drawing = Drawing()
        self.by_id = {e.get("id"): e for e in root.iter() if e.get("id")}
        self.styles = Styles(root)

    def read(self) -> None:
        """Add the curves of all that is drawn."""
        flipped = np.diag([1.0, -1.0, 1.0])
        box = svg_lengths.view_box(self.root)
        whole = (
            (box[2], box[3])
            if box
            else (_absolute(self.root, "width"), _absolute(self.root, "height"))
        )
        pending = [(self.root, _Look(flipped, whole), 0)]
        count = 0
        while pending:
            element, look, depth = pending.pop()
            count += 1
            if count > _MOST or depth > _DEPTH:
                raise MeshError("its groups are nested too deep, or too many")
            tag = tag_of(element)
            if tag in _IGNORED:
                self.drawing.ignored[tag] += 1
            if tag not in _GROUPS and tag not in _SHAPES:
                continue
            if (own := self._look(element, look)) is None:
                continue
            look = own
            if tag in _SHAPES:
                if look.shown and (look.filled or look.stroked):
                    self._draw(element, tag, look)
                continue
            if tag == "use":
                look, children = self._used(element, look)
            else:
                children = list(element)
                if tag == "svg" and element is not self.root:
                    look = self._nested(element, element, look)
                elif tag == "switch":
                    children = children[:1]
            # last in, first out: keep the order of the file
            pending += [(child, look, depth + 1) for child in reversed(children)]

    def _used(
        self, element: ElementTree.Element, look: _Look
    ) -> tuple[_Look, list[ElementTree.Element]]:
        link = element.get("href") or element.get(_LINK) or ""
        target = self.by_id.get(link.removeprefix("#"))
        if target is None:
            raise MeshError(f"a <use> refers to {link[:40]!r}, which is not there")
        if tag_of(target) not in ("symbol", "svg"):
            shifted = look.matrix @ self._shift(element, look)
            return replace(look, matrix=shifted), [target]
        own = self._look(target, look)
        if own is None:
            return look, []
        return self._nested(element, target, own), list(target)

    def _nested(
        self, element: ElementTree.Element, holder: ElementTree.Element, look: _Look
    ) -> _Look:
        """The look inside of a nested <svg>, or of a symbol that `element` uses."""
        sizes = []
        for axis, name in enumerate(("width", "height")):
            source = element if element.get(name) not in (None, "auto") else holder
            given = source.get(name) not in (None, "auto")
            sizes.append(
                svg_lengths.length(source, name, axis, look.size) if given else look.size[axis]
            )
        matrix = look.matrix @ self._shift(element, look)
        if holder is not element and tag_of(holder) == "svg":
            matrix = matrix @ self._shift(holder, look)
        inner, size = svg_lengths.viewport(holder, sizes[0], sizes[1])
        shown = look.shown and min(sizes) > 0
        return replace(look, matrix=matrix @ inner, size=size, shown=shown)

    def _shift(self, element: ElementTree.Element, look: _Look) -> Matrix:
        shift = np.eye(3)
        shift[0, 2] = svg_lengths.length(element, "x", 0, look.size)
        shift[1, 2] = svg_lengths.length(element, "y", 1, look.size)
        return shift

    def _look(self, element: ElementTree.Element, look: _Look) -> _Look | None:
        """Return the inherited and own style of the element; None if it is not displayed."""
        style = self.styles.of(element)
        if style.get("display") == "none":
            return None
        fill, stroke = style.get("fill", ""), style.get("stroke", "")
        visibility = style.get("visibility", "")
        layer = look.layer
        if tag_of(element) in ("g", "svg") and element is not self.root:
            names = (element.get(_LABEL, ""), element.get("id", ""))
            layer = next((name for name in names if says_something(name)), layer)
        return replace(
            look,
            matrix=look.matrix @ svg_lengths.transform(style.get("transform", "")),
            filled=look.filled if fill in ("", "inherit") else _paints(fill),
            stroked=look.stroked if stroke in ("", "inherit") else _paints(stroke),
            shown=look.shown if visibility in ("", "inherit") else visibility == "visible",
            layer=layer,
        )

    def _draw(self, element: ElementTree.Element, tag: str, look: _Look) -> None:
        if tag == "path":
            subpaths = svg_paths.parse(element.get("d", ""))
        else:
            subpaths = [getattr(self, f"_{tag}")(element, look.size)]
        names = (element.get(_LABEL, ""), element.get("id", ""))
        name = next((word for word in names if says_something(word)), "")
        if np.linalg.det(look.matrix) == 0.0:
            return
        for subpath in subpaths:
            pieces = list(subpath)
            if look.filled and pieces and tag != "line":
                closing = polyline([pieces[-1].end, pieces[0].start])
                pieces += [closing] if closing is not None else []
            for piece in pieces:
                self.drawing.add(piece.transformed(look.matrix[:2]), look.layer or name, name)

    def _rect(self, element: ElementTree.Element, size: Size) -> Subpath:
        x, y = (svg_lengths.length(element, name, i, size) for i, name in enumerate("xy"))
        width = svg_lengths.length(element, "width", 0, size)
        height = svg_lengths.length(element, "height", 1, size)
        if width <= 0 or height <= 0:
            return []
        given = {
            name: svg_lengths.length(element, name, i, size)
            for i, name in enumerate(("rx", "ry"))
            if element.get(name) not in (None, "auto")
        }
        rx = min(given.get("rx", given.get("ry", 0.0)), width / 2)
        ry = min(given.get("ry", given.get("rx", 0.0)), height / 2)
        right, low = x + width, y + height
        if rx <= 0 or ry <= 0:
            return _line_through([(x, y), (right, y), (right, low), (x, low), (x, y)])
        centres = [
            (right - rx, y + ry),
            (right - rx, low - ry),
            (x + rx, low - ry),
            (x + rx, y + ry),
        ]
        arcs = [
            _round(centre, rx, ry, (i - 1) * math.pi / 2, math.pi / 2)
            for i, centre in enumerate(centres)
        ]
        # the ends of the straight sides exactly, so that sides of no length go
        ends = [
            ((right - rx, y), (right, y + ry)), ((right, low - ry), (right - rx, low)),
            ((x + rx, low), (x, low - ry)), ((x, y + ry), (x + rx, y)),
        ]  # fmt: skip
        rounded = []
        for i, arc in enumerate(arcs):
            rounded.append(arc.moved_ends(*ends[i]))
            rounded += _line_through([ends[i][1], ends[(i + 1) % 4][0]])
        return rounded

    def _circle(self, element: ElementTree.Element, size: Size) -> Subpath:
        radius = svg_lengths.length(element, "r", 2, size)
        return self._whole(element, size, radius, radius)

    def _ellipse(self, element: ElementTree.Element, size: Size) -> Subpath:
        given = {
            name: svg_lengths.length(element, name, i, size)
            for i, name in enumerate(("rx", "ry"))
            if element.get(name) not in (None, "auto")
        }
        rx = given.get("rx", given.get("ry", 0.0))
        return self._whole(element, size, rx, given.get("ry", rx))

    def _whole(self, element: ElementTree.Element, size: Size, rx: float, ry: float) -> Subpath:
        if rx <= 0 or ry <= 0:
            return []
        centre = tuple(svg_lengths.length(element, f"c{n}", i, size) for i, n in enumerate("xy"))
        return [_round((centre[0], centre[1]), rx, ry, 0.0, 2 * math.pi)]

    def _line(self, element: ElementTree.Element, size: Size) -> Subpath:
        return _line_through(
            [
                [svg_lengths.length(element, f"{axis}{i}", "xy".index(axis), size) for axis in "xy"]
                for i in (1, 2)
            ]
        )

    def _polyline(self, element: ElementTree.Element, size: Size) -> Subpath:
        return _line_through(_points(element))

    def _polygon(self, element: ElementTree.Element, size: Size) -> Subpath:
        points = _points(element)
        return _line_through(np.vstack([points, points[:1]]))


def _paints(value: str) -> bool:
    return value not in ("none", "transparent")


def _round(centre: tuple[float, float], rx: float, ry: float, start: float, sweep: float) -> Curve:
    if rx == ry:
        return Curve.arc(centre, rx, start, sweep)
    return Curve.ellipse(centre, (rx, 0.0), (0.0, ry), start, sweep)


def _line_through(points: Points | list[tuple[float, float]] | list[list[float]]) -> Subpath:
    curve = polyline(points)
    return [curve] if curve is not None else []


def _points(element: ElementTree.Element) -> Points:
    words = element.get("points", "").replace(",", " ").split()
    if len(words) % 2 or not all(map(is_number, words)):
        raise MeshError(f"the points of a <{tag_of(element)}> are not pairs of numbers")
    return np.array([float(word) for word in words]).reshape(-1, 2)


def _absolute(element: ElementTree.Element, name: str) -> float:
    """The width or height of the whole drawing; 100 where it is not said in pixels."""
    text = element.get(name, "")
    if not text or "%" in text:
        return 100.0
    try:
        return svg_lengths.length(element, name, 0, (100.0, 100.0))
    except MeshError:
        return 100.0
