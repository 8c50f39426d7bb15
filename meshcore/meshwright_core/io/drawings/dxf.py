"""DXF drawings (text form): the lines and curves of the model space as pieces of an outline.

Lines, polylines with arcs in them, arcs, circles, ellipses, splines, and blocks inserted at a
place. Text, dimensions, hatches and points are not looked at, nor is what the drawing hides:
layers that are off or frozen, invisible entities, paper space. Group codes after Autodesk's DXF
reference.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from meshwright_core.domains.domain import Points
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings import curves
from meshwright_core.io.drawings.curves import Affine, Piece

_BINARY = b"AutoCAD Binary DXF"
_DEPTH = 8
"""Blocks within blocks that are followed."""
_MOST = 100_000
"""Pieces at which reading stops; nested blocks multiply."""

_CURVES = ("LINE", "LWPOLYLINE", "POLYLINE", "ARC", "CIRCLE", "ELLIPSE", "SPLINE", "INSERT")
_SOLIDS = ("3DFACE", "3DSOLID", "BODY", "HELIX", "MESH", "MLINE", "REGION", "SOLID", "SURFACE")


@dataclass
class Entity:
    """One entity: its type, its (group code, value) pairs, the vertices of an old polyline."""

    type: str
    pairs: list[tuple[int, str]]
    line: int
    vertices: list[Entity] = field(default_factory=list)

    def text(self, code: int, default: str = "") -> str:
        """The first value of a group code."""
        return next((value for group, value in self.pairs if group == code), default)

    def number(self, code: int, default: float | None = None) -> float:
        """The first value of a group code as a number; MeshError if it is none, or missing."""
        text = self.text(code)
        if not text and default is not None:
            return default
        return self._number(text, code)

    def numbers(self, code: int) -> list[float]:
        """All values of a group code."""
        return [self._number(value, code) for group, value in self.pairs if group == code]

    def places(self, x: int, y: int) -> Points:
        """All points (n, 2) whose coordinates have these two group codes."""
        one, other = self.numbers(x), self.numbers(y)
        if len(one) != len(other):
            raise MeshError(
                f"line {self.line}: the {self.type} has {len(one)} x for {len(other)} y"
            )
        return np.array([one, other]).T.reshape(-1, 2)

    def place(self, x: int, y: int) -> Points:
        """The first such point (2,)."""
        return np.array([self.number(x), self.number(y)])

    def _number(self, text: str, code: int) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not abs(value) < 1e100:
            what = f"{text!r} is no number" if text else "a number is missing"
            raise MeshError(
                f"line {self.line}: in the {self.type} {what} (group code {code})"
            ) from None
        return value


def read(content: bytes, corner_angle: float, step: float) -> list[Piece]:
    """Return the pieces of a DXF file, in drawing units.

    Args:
        content: of the file.
        corner_angle: degrees by which a polyline turns at a corner, at least.
        step: degrees by which a polyline that stands for a curve may turn at a point.

    Raises:
        MeshError: the file is binary, cut off, or no DXF; an entity is damaged, or tilted in
            space; there is nothing to trace.
    """
    if content.startswith(_BINARY):
        raise MeshError("it is a binary DXF file: save it as text (ASCII) DXF")
    sections = _sections(content.decode("utf-8", errors="replace"))
    if "ENTITIES" not in sections:
        raise MeshError("it is not a DXF file, or cut off: it has no section ENTITIES")
    reader = _Reader(sections, corner_angle, step)
    pieces = list(reader.pieces(sections["ENTITIES"]))
    if not pieces:
        solids = sorted({e.type for e in sections["ENTITIES"]} & set(_SOLIDS))
        found = f", only {', '.join(solids)}" if solids else ""
        raise MeshError(f"there are no lines or curves to trace in it{found}")
    return pieces


def _sections(text: str) -> dict[str, list[Entity]]:
    """Return the entities of each section by the section's name."""
    sections: dict[str, list[Entity]] = {}
    members: list[Entity] | None = None
    for entity in _entities(text):
        if entity.type == "SECTION":
            members = sections.setdefault(entity.text(2).upper(), [])
        elif entity.type == "ENDSEC":
            members = None
        elif entity.type == "EOF":
            return sections
        elif members is None:
            raise MeshError(f"line {entity.line}: {entity.type[:20]!r} stands outside of a section")
        elif entity.type in ("VERTEX", "SEQEND") and members and members[-1].type == "POLYLINE":
            if entity.type == "VERTEX":
                members[-1].vertices.append(entity)
        else:
            members.append(entity)
    raise MeshError("it is cut off: the end of the file is not marked (EOF)")


def _entities(text: str) -> Iterator[Entity]:
    lines = text.splitlines()
    entity: Entity | None = None
    for i in range(0, len(lines), 2):
        head = lines[i].strip()
        if not head.lstrip("-").isdecimal():
            if not head and not any(line.strip() for line in lines[i:]):
                break
            shown = repr(head if len(head) <= 20 else head[:17] + "...")
            raise MeshError(f"line {i + 1}: {shown} stands where a DXF file has a group code")
        if i + 1 == len(lines):
            raise MeshError(f"it is cut off: a value is missing after line {i + 1}")
        code, value = int(head[:9]), lines[i + 1].strip()
        if code == 0:
            if entity is not None:
                yield entity
            entity = Entity(value.upper(), [], i + 1)
        elif entity is not None:
            entity.pairs.append((code, value))
    if entity is not None:
        yield entity


class _Reader:
    """Turns entities into pieces, with the blocks and the hidden layers of the drawing."""

    def __init__(self, sections: dict[str, list[Entity]], corner_angle: float, step: float) -> None:
        self.corner_angle = corner_angle
        self.step = step
        self.count = 0
        self.hidden = {
            entity.text(2).upper()
            for entity in sections.get("TABLES", [])
            if entity.type == "LAYER"
            and (entity.number(62, 7) < 0 or int(entity.number(70, 0)) & 1)
        }
        self.blocks: dict[str, tuple[Points, list[Entity]]] = {}
        members: list[Entity] = []
        for entity in sections.get("BLOCKS", []):
            if entity.type == "BLOCK":
                members = []
                base = np.array([entity.number(10, 0.0), entity.number(20, 0.0)])
                self.blocks[entity.text(2).upper()] = (base, members)
            else:
                members.append(entity)
        self.make: dict[str, Callable[[Entity], list[Piece | None]]] = {
            "LINE": self._line,
            "LWPOLYLINE": self._light,
            "POLYLINE": self._heavy,
            "ARC": self._arc,
            "CIRCLE": self._circle,
            "ELLIPSE": self._ellipse,
            "SPLINE": self._spline,
        }

    def pieces(self, entities: list[Entity], depth: int = 0) -> Iterator[Piece]:
        """Yield what the entities of the model space, or of a block, draw."""
        for entity in entities:
            if entity.type not in _CURVES or self._is_hidden(entity):
                continue
            if entity.type == "INSERT":
                yield from self._insert(entity, depth)
                continue
            for piece in self.make[entity.type](entity):
                if piece is not None:
                    self.count += 1
                    if self.count > _MOST:
                        raise MeshError(f"it has more than {_MOST:,} lines and curves")
                    yield piece

    def _is_hidden(self, entity: Entity) -> bool:
        paper, invisible = entity.number(67, 0), entity.number(60, 0)
        return bool(paper or invisible or entity.text(8, "0").upper() in self.hidden)

    def _insert(self, entity: Entity, depth: int) -> Iterator[Piece]:
        base, members = self.blocks.get(entity.text(2).upper(), (None, []))
        if base is None:
            raise MeshError(f"line {entity.line}: there is no block named {entity.text(2)[:40]!r}")
        if depth == _DEPTH:
            raise MeshError(f"line {entity.line}: blocks are nested more than {_DEPTH} deep")
        angle = math.radians(entity.number(50, 0.0))
        turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
        scale = np.diag([entity.number(41, 1.0), entity.number(42, 1.0)])
        where = entity.place(10, 20)
        mirror = _mirror(entity)
        columns, rows = (max(1, int(entity.number(code, 1))) for code in (70, 71))
        if columns * rows > _MOST:
            raise MeshError(f"it has more than {_MOST:,} lines and curves")
        for column in range(columns):
            for row in range(rows):
                shift = np.array([column * entity.number(44, 0.0), row * entity.number(45, 0.0)])

                def place(points: Points, shift: Points = shift) -> Points:
                    moved: Points = ((points - base) @ scale + shift) @ turn + where
                    return moved @ mirror

                for piece in self.pieces(members, depth + 1):
                    yield _moved(piece, place)

    def _line(self, entity: Entity) -> list[Piece | None]:
        ends = np.array([entity.place(10, 20), entity.place(11, 21)])
        return [curves.straight(ends, self.corner_angle)]

    def _light(self, entity: Entity) -> list[Piece | None]:
        bulges: list[float] = []
        for code, value in entity.pairs:
            # a bulge follows the point that it belongs to
            if code == 10:
                bulges.append(0.0)
            elif code == 42 and bulges:
                bulges[-1] = Entity(entity.type, [(42, value)], entity.line).number(42)
        mirror = _mirror(entity)
        closed = bool(int(entity.number(70, 0)) & 1)
        places = entity.places(10, 20) @ mirror
        return self._polyline(places, mirror[0, 0] * np.array(bulges), closed)

    def _heavy(self, entity: Entity) -> list[Piece | None]:
        flags = int(entity.number(70, 0))
        if flags & (16 | 64):
            raise MeshError(f"line {entity.line}: a polygon mesh in space cannot be traced")
        # 16: control points of a spline, whose own points are there too
        vertices = [v for v in entity.vertices if not int(v.number(70, 0)) & 16]
        if not vertices:
            return []
        mirror = _mirror(entity)
        places = np.array([v.place(10, 20) for v in vertices]) @ mirror
        bulges = mirror[0, 0] * np.array([v.number(42, 0.0) for v in vertices])
        return self._polyline(places, bulges, bool(flags & 1))

    def _polyline(self, points: Points, bulges: Points, closed: bool) -> list[Piece | None]:
        """Straight runs and arcs; a bulge is the tangent of a quarter of an arc's sweep."""
        if len(points) < 2:
            return []
        ends = np.roll(points, -1, axis=0)
        pieces: list[Piece | None] = []
        run = [points[0]]
        for i in range(len(points) if closed else len(points) - 1):
            if bulges[i] == 0 or (points[i] == ends[i]).all():
                run.append(ends[i])
                continue
            pieces.append(curves.straight(run, self.corner_angle))
            pieces.append(self._bulge(points[i], ends[i], float(bulges[i])))
            run = [ends[i]]
        pieces.append(curves.straight(run, self.corner_angle))
        return pieces

    def _bulge(self, start: Points, end: Points, bulge: float) -> Piece | None:
        sweep = 4 * math.atan(bulge)
        chord = end - start
        left = np.array([-chord[1], chord[0]])
        centre = 0.5 * (start + end) + left * (1 - bulge**2) / (4 * bulge)
        radius = math.hypot(*(start - centre))
        angle = math.atan2(*(start - centre)[::-1])
        return curves.arc(centre, radius, angle, sweep, self.step)

    def _circle(self, entity: Entity) -> list[Piece | None]:
        return [self._round(entity, 0.0, 2 * math.pi)]

    def _arc(self, entity: Entity) -> list[Piece | None]:
        start, stop = (math.radians(entity.number(code)) for code in (50, 51))
        return [self._round(entity, start, (stop - start) % (2 * math.pi) or 2 * math.pi)]

    def _round(self, entity: Entity, start: float, sweep: float) -> Piece | None:
        mirror = _mirror(entity)
        radius = entity.number(40)
        if radius <= 0:
            raise MeshError(f"line {entity.line}: the {entity.type} has the radius {radius:g}")
        return curves.arc(
            entity.place(10, 20), radius, start, sweep, self.step, lambda points: points @ mirror
        )

    def _ellipse(self, entity: Entity) -> list[Piece | None]:
        centre, major = entity.place(10, 20), entity.place(11, 21)
        side = 1.0 if _mirror(entity)[0, 0] > 0 else -1.0
        minor = side * entity.number(40) * np.array([-major[1], major[0]])
        if not (major.any() and minor.any()):
            raise MeshError(f"line {entity.line}: the ELLIPSE has no width")
        start, stop = entity.number(41, 0.0), entity.number(42, 2 * math.pi)
        sweep = (stop - start) % (2 * math.pi)
        sweep = 2 * math.pi if sweep < 1e-9 else sweep
        axes = np.array([major, minor])
        unit = (0.0, 0.0)
        return [curves.arc(unit, 1.0, start, sweep, self.step, lambda p: p @ axes + centre)]

    def _spline(self, entity: Entity) -> list[Piece | None]:
        control, fit = entity.places(10, 20), entity.places(11, 21)
        if len(control) == 0:
            return [curves.through(fit, self.step)]
        degree, knots = int(entity.number(71, 3)), np.array(entity.numbers(40))
        weights = np.array(entity.numbers(41)) if entity.numbers(41) else None
        fits = 1 <= degree < len(control) and len(knots) == len(control) + degree + 1
        fits = fits and bool((np.diff(knots) >= 0).all())
        fits = fits and knots[degree] < knots[len(control)]
        fits = fits and (weights is None or (len(weights) == len(control) and weights.min() > 0))
        if not fits:
            raise MeshError(f"line {entity.line}: the knots and points of the SPLINE do not fit")
        return [curves.spline(control, knots, weights, degree, self.step)]


def _mirror(entity: Entity) -> Points:
    """Return the (2, 2) map of an entity's own plane to the drawing; it may lie face down."""
    normal = [entity.number(210, 0.0), entity.number(220, 0.0), entity.number(230, 1.0)]
    if abs(normal[0]) > 1e-6 or abs(normal[1]) > 1e-6 or normal[2] == 0:
        raise MeshError(f"line {entity.line}: the {entity.type} does not lie in the plane")
    return np.diag([math.copysign(1.0, normal[2]), 1.0])


def _moved(piece: Piece, place: Affine) -> Piece:
    points = place(piece.points)
    leave = place(piece.points[:1] + piece.leave)[0] - points[0]
    arrive = place(piece.points[-1:] + piece.arrive)[0] - points[-1]
    return Piece(points, piece.corners, leave, arrive, piece.curved)
