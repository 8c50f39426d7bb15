"""Well-known text, with curves: geometries of ISO 19125 and SQL/MM, and PostGIS's EWKT.

shapely reads straight geometries only, so this is a parser of its own. Arcs stay arcs. Z and M are
left out. A file may hold several geometries, one after the other.
"""

from __future__ import annotations

import re

import numpy as np

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import (
    LARGEST,
    Drawing,
    DrawnArea,
    Points,
    polyline,
)

_TOKEN = re.compile(r"\s*(?:([(),;])|([A-Za-z_]+)|([^\s(),;]+))")
_SRID = re.compile(r"\s*SRID\s*=\s*-?\d+\s*;", re.IGNORECASE)
_CURVES = ("LINESTRING", "CIRCULARSTRING", "COMPOUNDCURVE", "LINEARRING")
_SURFACES = ("POLYGON", "CURVEPOLYGON", "TRIANGLE")
_MANY = {
    "MULTILINESTRING": "LINESTRING",
    "MULTICURVE": "LINESTRING",
    "MULTIPOLYGON": "POLYGON",
    "MULTISURFACE": "POLYGON",
    "POLYHEDRALSURFACE": "POLYGON",
    "TIN": "TRIANGLE",
    "GEOMETRYCOLLECTION": "",
    "MULTIPOINT": "POINT",
}
"""Collections, and what a member without a name is."""
_DEPTH = 32

Chain = list[Curve]


def read(content: bytes) -> Drawing:
    """Return what a file of well-known text holds.

    Raises:
        MeshError: it is not text, or not sound WKT, with what was found where.
    """
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise MeshError("this is not a text file") from error
    parser = _Parser(text)
    while not parser.done():
        parser.geometry("", 0)
    parser.drawing.areas = parser.areas or None
    return parser.drawing


class _Parser:
    """Reads geometries off a text, one token after the other."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self.drawing = Drawing()
        self.areas: list[DrawnArea] = []
        self.skip_prefix()

    def skip_prefix(self) -> None:
        match = _SRID.match(self.text, self.at)
        if match:
            self.at = match.end()

    def done(self) -> bool:
        """Whether nothing but blanks and semicolons is left."""
        while self.peek() == ";":
            self.take()
        self.skip_prefix()
        return not self.text[self.at :].strip()

    def peek(self) -> str:
        match = _TOKEN.match(self.text, self.at)
        return match.group(match.lastindex or 0) if match else ""

    def take(self) -> str:
        match = _TOKEN.match(self.text, self.at)
        if match is None:
            return ""
        self.at = match.end()
        return match.group(match.lastindex or 0)

    def expect(self, wanted: str) -> str:
        if self.peek() not in wanted.split():
            raise self.error(" or ".join(repr(word) for word in wanted.split()))
        return self.take()

    def error(self, wanted: str) -> MeshError:
        found = self.peek()[:20]
        shown = repr(found) if found else "its end"
        return MeshError(f"it is not sound WKT: {shown} stands where {wanted} was expected")

    def kind(self, implied: str) -> str:
        """Take the name of a geometry, and Z, M or ZM after it."""
        word = self.peek().upper()
        if word == "(" and implied:
            return implied
        base = re.sub(r"(?:ZM|Z|M)$", "", word) if word not in _ALL else word
        if base not in _ALL:
            raise self.error("the name of a geometry")
        self.take()
        if self.peek().upper() in ("Z", "M", "ZM"):
            self.take()
        return base

    def empty(self) -> bool:
        if self.peek().upper() == "EMPTY":
            self.take()
            return True
        return False

    def geometry(self, implied: str, depth: int) -> None:
        """Add one geometry, or one member of a collection, to the drawing."""
        if depth > _DEPTH:
            raise MeshError("it is not sound WKT: collections are nested too deep")
        if implied and self.empty():
            return
        kind = self.kind(implied)
        if self.empty():
            return
        if kind in _MANY:
            self.expect("(")
            if kind == "MULTIPOINT":
                self.skip()
                return
            self.geometry(_MANY[kind], depth + 1)
            while self.expect(", )") == ",":
                self.geometry(_MANY[kind], depth + 1)
        elif kind in _SURFACES:
            self.surface()
        elif kind == "POINT":
            self.expect("(")
            self.skip()
        else:
            for curve in self.chain(kind):
                self.drawing.add(curve)

    def skip(self) -> None:
        """Skip to the parenthesis that closes, and count a point."""
        level = 1
        while level:
            token = self.take()
            if not token:
                raise self.error("')'")
            level += {"(": 1, ")": -1}.get(token, 0)
        self.drawing.ignored["POINT"] += 1

    def surface(self) -> None:
        rings = []
        self.expect("(")
        while True:
            if not self.empty():
                chain = self.chain(self.kind("LINESTRING"))
                if chain and (chain[0].start != chain[-1].end).any():
                    raise MeshError("it is not sound WKT: a ring of a polygon is not closed")
                for curve in chain:
                    self.drawing.add(curve)
                if chain:
                    rings.append(tuple(chain))
            if self.expect(", )") == ")":
                break
        if rings:
            self.areas.append(DrawnArea(tuple(rings)))

    def chain(self, kind: str) -> Chain:
        """Read the curves of a string of points, or of a compound curve."""
        if kind not in _CURVES:
            raise MeshError(f"it is not sound WKT: a {kind} cannot be a part of a boundary")
        if self.empty():
            return []
        if kind == "COMPOUNDCURVE":
            parts: Chain = []
            self.expect("(")
            while True:
                parts += self.chain(self.kind("LINESTRING"))
                if self.expect(", )") == ")":
                    return parts
        points = self.points()
        if kind == "CIRCULARSTRING":
            return _arcs(points)
        curve = polyline(points)
        return [curve] if curve is not None else []

    def points(self) -> Points:
        self.expect("(")
        rows: list[tuple[float, float]] = []
        while True:
            numbers = []
            while self.peek() not in (",", ")", ""):
                token = self.take()
                numbers.append(self.number(token))
            if len(numbers) < 2:
                raise self.error("a coordinate")
            rows.append((numbers[0], numbers[1]))
            if self.expect(", )") == ")":
                return np.array(rows)

    def number(self, token: str) -> float:
        try:
            value = float(token)
        except ValueError:
            value = np.nan
        if not abs(value) < LARGEST:
            raise MeshError(
                f"it is not sound WKT: {token[:20]!r} stands where a number was expected"
            )
        return value


_ALL = {*_CURVES, *_SURFACES, *_MANY, "POINT"}


def _arcs(points: Points) -> Chain:
    """Arcs through each three points; an arc back to its start is a whole circle."""
    if len(points) < 3 or len(points) % 2 == 0:
        raise MeshError(
            f"it is not sound WKT: a CIRCULARSTRING of {len(points)} points; it has 3, 5, 7 ..."
        )
    found: Chain = []
    for i in range(0, len(points) - 2, 2):
        a, middle, b = points[i : i + 3]
        if (a == b).all() and (a == middle).all():
            continue
        found.append(Curve.arc_through(a, middle, b))
    return found
