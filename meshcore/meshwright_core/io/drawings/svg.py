"""SVG drawings: the visible shapes and paths as pieces of an outline, the y axis turned up.

Paths, rectangles (rounded too), circles, ellipses, lines, polylines and polygons, through groups,
nested drawings, `use` and transforms; lengths in the drawing's own units. A filled shape counts as
closed, as it looks. Text, pictures, definitions, clips and masks are not looked at, nor is what is
not drawn: hidden, or with neither fill nor stroke.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from meshwright_core.domains.domain import Points
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings import curves, svg_paths
from meshwright_core.io.drawings.curves import Piece
from meshwright_core.io.drawings.svg_paths import Subpath

Matrix = NDArray[np.float64]

_GROUPS = ("svg", "g", "a", "switch", "use")
_SHAPES = ("path", "rect", "circle", "ellipse", "line", "polyline", "polygon")
_UNITS = {"": 1.0, "px": 1.0, "mm": 96 / 25.4, "cm": 96 / 2.54, "in": 96.0, "pt": 4 / 3, "pc": 16.0}
_LENGTH = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-z%]*)\s*$")
_TRANSFORM = re.compile(r"\s*,?\s*(\w+)\s*\(([^()]*)\)")
_RULE = re.compile(r"\.([\w-]+)\s*(?:,[^{]*)?\{([^}]*)\}")
_DEPTH = 64
_MOST = 100_000
"""Elements at which reading stops; `use` within `use` multiplies."""


@dataclass(frozen=True)
class _Look:
    """What a group hands on: its transform, whether it is filled, stroked and shown."""

    matrix: Matrix
    filled: bool = True
    stroked: bool = False
    shown: bool = True


def read(content: bytes, corner_angle: float, step: float) -> list[Piece]:
    """Return the pieces of an SVG file.

    Args:
        content: of the file.
        corner_angle: degrees by which a polyline turns at a corner, at least.
        step: degrees by which a polyline that stands for a curve may turn at a point.

    Raises:
        MeshError: the file is not XML (with the place), or not SVG; a shape is damaged; there is
            nothing to trace.
    """
    try:
        root = ElementTree.fromstring(content)
    except ElementTree.ParseError as error:
        line, column = error.position
        what = _words(error)
        raise MeshError(f"line {line}, column {column + 1}: this is not XML ({what})") from error
    except (ValueError, LookupError) as error:
        raise MeshError("this is not XML") from error
    if _tag(root) != "svg":
        raise MeshError(f"it is XML but not SVG: it begins with <{_tag(root)[:20]}>")
    pieces = list(_Reader(root, corner_angle, step).pieces())
    if not pieces:
        raise MeshError("there are no shapes or paths to trace in it")
    return pieces


def _words(error: ElementTree.ParseError) -> str:
    """Return the message of the XML parser, without the place."""
    return str(error).split(":")[0]


class _Reader:
    """Walks the tree of elements."""

    def __init__(self, root: ElementTree.Element, corner_angle: float, step: float) -> None:
        self.root = root
        self.corner_angle = corner_angle
        self.step = step
        self.by_id = {e.get("id"): e for e in root.iter() if e.get("id")}
        sheets = " ".join(e.text or "" for e in root.iter() if _tag(e) == "style")
        self.rules = {name: _declarations(body) for name, body in _RULE.findall(sheets)}
        box = [
            float(n) for n in re.findall(r"[-+.\deE]+", root.get("viewBox", "")) if _is_number(n)
        ]
        self.size = (
            (box[2], box[3])
            if len(box) == 4
            else (_absolute(root.get("width")), _absolute(root.get("height")))
        )

    def pieces(self) -> Iterator[Piece]:
        """Yield the pieces of all that is drawn."""
        flipped = np.diag([1.0, -1.0, 1.0])
        pending = [(self.root, _Look(flipped), 0)]
        count = 0
        while pending:
            element, look, depth = pending.pop()
            count += 1
            if count > _MOST or depth > _DEPTH:
                raise MeshError("its groups are nested too deep, or too many")
            tag = _tag(element)
            if tag not in _GROUPS and tag not in _SHAPES:
                continue
            if (own := self._look(element, look)) is None:
                continue
            look = own
            if tag in _SHAPES:
                if look.shown and (look.filled or look.stroked):
                    yield from self._drawn(element, tag, look)
                continue
            if tag == "use":
                look, children = self._used(element, look)
            else:
                children = list(element)
                if tag == "svg" and element is not self.root:
                    look = replace(look, matrix=look.matrix @ self._shift(element))
            # last in, first out: keep the order of the file
            pending += [(child, look, depth + 1) for child in reversed(children)]

    def _used(
        self, element: ElementTree.Element, look: _Look
    ) -> tuple[_Look, list[ElementTree.Element]]:
        link = element.get("href") or element.get("{http://www.w3.org/1999/xlink}href") or ""
        target = self.by_id.get(link.removeprefix("#"))
        if target is None:
            raise MeshError(f"a <use> refers to {link[:40]!r}, which is not there")
        children = list(target) if _tag(target) == "symbol" else [target]
        return replace(look, matrix=look.matrix @ self._shift(element)), children

    def _shift(self, element: ElementTree.Element) -> Matrix:
        shift = np.eye(3)
        shift[:2, 2] = self._length(element, "x", 0), self._length(element, "y", 1)
        return shift

    def _look(self, element: ElementTree.Element, look: _Look) -> _Look | None:
        """Return the inherited and own style of the element; None if it is not displayed."""
        style: dict[str, str] = {}
        for name in element.get("class", "").split():
            style |= self.rules.get(name, {})
        style |= _declarations(element.get("style", ""))

        def attribute(name: str) -> str:
            return style.get(name, element.get(name, "")).strip().lower()

        if attribute("display") == "none":
            return None
        fill, stroke, visibility = attribute("fill"), attribute("stroke"), attribute("visibility")
        return _Look(
            look.matrix @ _matrix(element.get("transform", "")),
            look.filled if fill in ("", "inherit") else fill not in ("none", "transparent"),
            look.stroked if stroke in ("", "inherit") else stroke not in ("none", "transparent"),
            look.shown if visibility in ("", "inherit") else visibility == "visible",
        )

    def _drawn(self, element: ElementTree.Element, tag: str, look: _Look) -> Iterator[Piece]:
        if tag == "path":
            subpaths = svg_paths.parse(element.get("d", ""), self.step)
        else:
            subpaths = [getattr(self, f"_{tag}")(element)]
        for subpath in subpaths:
            pieces = list(subpath)
            if look.filled and pieces and tag != "line":
                first, last = pieces[0].points[0], pieces[-1].points[-1]
                closing = curves.straight([last, first], 0.0)
                pieces += [closing] if closing is not None else []
            for piece in pieces:
                yield _moved(piece, look.matrix)

    def _rect(self, element: ElementTree.Element) -> Subpath:
        x, y = self._length(element, "x", 0), self._length(element, "y", 1)
        width, height = self._length(element, "width", 0), self._length(element, "height", 1)
        if width <= 0 or height <= 0:
            return []
        names = [name for name in ("rx", "ry") if element.get(name) not in (None, "auto")]
        given = {name: self._length(element, name, "xy".index(name[1])) for name in names}
        rx = min(given.get("rx", given.get("ry", 0.0)), width / 2)
        ry = min(given.get("ry", given.get("rx", 0.0)), height / 2)
        if rx <= 0 or ry <= 0:
            box = [(x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y)]
            return self._line_through(np.array(box))
        right, low = x + width - rx, y + height - ry
        pieces: list[Piece | None] = []
        for i, centre in enumerate(
            [(right, y + ry), (right, low), (x + rx, low), (x + rx, y + ry)]
        ):
            pieces.append(self._round(centre, rx, ry, (i - 1) * math.pi / 2, math.pi / 2))
        arcs = [piece for piece in pieces if piece is not None]
        rounded = []
        for one, other in zip(arcs, [*arcs[1:], arcs[0]], strict=True):
            side = curves.straight([one.points[-1], other.points[0]], 0.0)
            rounded += [one] if side is None else [one, side]
        return rounded

    def _circle(self, element: ElementTree.Element) -> Subpath:
        radius = self._length(element, "r", 2)
        return self._whole(element, radius, radius)

    def _ellipse(self, element: ElementTree.Element) -> Subpath:
        return self._whole(element, self._length(element, "rx", 0), self._length(element, "ry", 1))

    def _whole(self, element: ElementTree.Element, rx: float, ry: float) -> Subpath:
        if rx <= 0 or ry <= 0:
            return []
        centre = (self._length(element, "cx", 0), self._length(element, "cy", 1))
        piece = self._round(centre, rx, ry, 0.0, 2 * math.pi)
        return [piece] if piece is not None else []

    def _round(
        self, centre: tuple[float, float], rx: float, ry: float, start: float, sweep: float
    ) -> Piece | None:
        return curves.arc(
            (0, 0), 1.0, start, sweep, self.step, lambda points: points * (rx, ry) + centre
        )

    def _line(self, element: ElementTree.Element) -> Subpath:
        ends = [
            [self._length(element, f"{axis}{i}", "xy".index(axis)) for axis in "xy"] for i in (1, 2)
        ]
        return self._line_through(np.array(ends))

    def _polyline(self, element: ElementTree.Element) -> Subpath:
        return self._line_through(self._points(element))

    def _polygon(self, element: ElementTree.Element) -> Subpath:
        points = self._points(element)
        return self._line_through(np.vstack([points, points[:1]]))

    def _line_through(self, points: Points) -> Subpath:
        piece = curves.straight(points, self.corner_angle)
        return [piece] if piece is not None else []

    def _points(self, element: ElementTree.Element) -> Points:
        words = element.get("points", "").replace(",", " ").split()
        if len(words) % 2 or not all(map(_is_number, words)):
            raise MeshError(f"the points of a <{_tag(element)}> are not pairs of numbers")
        return np.array([float(word) for word in words]).reshape(-1, 2)

    def _length(self, element: ElementTree.Element, name: str, axis: int) -> float:
        """Return a length; per cents of the drawing's width (axis 0), height (1) or mean (2)."""
        text = element.get(name, "0")
        match = _LENGTH.match(text)
        if match is None or match.group(2) not in (*_UNITS, "%"):
            raise MeshError(
                f"the {name} of a <{_tag(element)}> is {text[:20]!r}, which is no length"
            )
        value, unit = float(match.group(1)), match.group(2)
        if unit != "%":
            return value * _UNITS[unit]
        mean = math.hypot(*self.size) / math.sqrt(2)
        return value / 100 * (*self.size, mean)[axis]


def _moved(piece: Piece, matrix: Matrix) -> Piece:
    turn = matrix[:2, :2].T
    points = piece.points @ turn + matrix[:2, 2]
    return Piece(points, piece.corners, piece.leave @ turn, piece.arrive @ turn, piece.curved)


def _matrix(text: str) -> Matrix:
    """Return the (3, 3) matrix of a list of transforms."""
    result = np.eye(3)
    at = 0
    for match in _TRANSFORM.finditer(text):
        if text[at : match.start()].strip():
            break
        at = match.end()
        words = match.group(2).replace(",", " ").split()
        if not all(map(_is_number, words)):
            raise MeshError(f"the transform {match.group()[:40].strip()!r} has no numbers")
        result = result @ _single(match.group(1), [float(word) for word in words])
    if text[at:].strip():
        raise MeshError(f"the transform {text[:40]!r} is not understood")
    return result


def _single(name: str, values: list[float]) -> Matrix:
    count = len(values)
    made = np.eye(3)
    if name == "matrix" and count == 6:
        made[:2] = np.array(values).reshape(3, 2).T
    elif name == "translate" and count in (1, 2):
        made[:2, 2] = (*values, 0.0)[:2]
    elif name == "scale" and count in (1, 2):
        made[:2, :2] = np.diag([values[0], values[-1]])
    elif name == "rotate" and count in (1, 3):
        angle = math.radians(values[0])
        made[:2, :2] = [[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]]
        centre = np.array(values[1:] or (0.0, 0.0))
        made[:2, 2] = centre - made[:2, :2] @ centre
    elif name == "skewX" and count == 1:
        made[0, 1] = math.tan(math.radians(values[0]))
    elif name == "skewY" and count == 1:
        made[1, 0] = math.tan(math.radians(values[0]))
    else:
        raise MeshError(f"the transform {name}({', '.join(f'{v:g}' for v in values)}) is not known")
    return made


def _declarations(text: str) -> dict[str, str]:
    pairs = (part.split(":", 1) for part in text.split(";") if ":" in part)
    return {name.strip().lower(): value.replace("!important", "") for name, value in pairs}


def _tag(element: ElementTree.Element) -> str:
    return str(element.tag).rpartition("}")[2] if isinstance(element.tag, str) else ""


def _is_number(text: str) -> bool:
    try:
        return abs(float(text)) < 1e100
    except ValueError:
        return False


def _absolute(text: str | None) -> float:
    match = _LENGTH.match(text or "")
    if match is None or match.group(2) not in _UNITS:
        return 100.0
    return float(match.group(1)) * _UNITS[match.group(2)]
