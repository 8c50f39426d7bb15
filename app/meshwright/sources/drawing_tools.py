"""The tools that draw a sketch: lines, arcs, rectangles, circles, and a measuring tool.

Each tool takes places one after the other (:meth:`Pencil.click`), which come from the mouse or from
dimensions that are typed (:meth:`Pencil.place_of`). Imports no Qt.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from meshwright.sources.arc_edges import (
    Place,
    bulge_of_radius,
    bulge_through,
    circle_of,
    points_of,
)
from meshwright.sources.polygon_sketch import Sketch
from meshwright_core.errors import MeshError

LINE, ARC, RECTANGLE, CIRCLE, MEASURE = "line", "arc", "rectangle", "circle", "measure"
BEGUN = "Close {what} first: click its first corner, or press Return."
HOLE_FIRST = "All loops are closed: click an edge to insert a corner, or press Add hole."
_NUMBER = r"[-+\u2212]?(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:[eE][-+]?\d+)?"
_TWO = re.compile(rf"\s*({_NUMBER})\s*(?:[;x\u00d7]|\s)\s*({_NUMBER})\s*$")
_POLAR = re.compile(rf"\s*({_NUMBER})\s*<\s*({_NUMBER})\s*\u00b0?\s*$")
_ONE = re.compile(rf"\s*({_NUMBER})\s*$")
_HINTS = {
    LINE: "Type a length, \u201clength<angle\u201d or \u201c\u0394x \u0394y\u201d, then Return.",
    ARC: "Type a length, \u201clength<angle\u201d or \u201c\u0394x \u0394y\u201d, then Return.",
    RECTANGLE: "Type \u201cwidth height\u201d, then Return.",
    CIRCLE: "Type a radius, then Return.",
}


@dataclass(frozen=True)
class Draft:
    """What the next click would add: polylines, and its dimensions as text."""

    lines: tuple[tuple[Place, ...], ...] = ()
    text: str = ""


class Pencil:
    """The current tool on ``sketch``, and the places that it has been given so far.

    The tools take: *line* a corner; *arc* its end, then a point on it; *rectangle* two opposite
    corners; *circle* the centre, then a point on it; *measure* two points.
    """

    def __init__(self, sketch: Sketch) -> None:
        self.sketch = sketch
        self._tool = LINE
        self._places: list[Place] = []

    @property
    def tool(self) -> str:
        """The name of the tool."""
        return self._tool

    @tool.setter
    def tool(self, name: str) -> None:
        self._tool = name
        self._places.clear()

    @property
    def places(self) -> tuple[Place, ...]:
        """The places that the tool has been given for what it draws next."""
        return tuple(self._places)

    @property
    def begun(self) -> bool:
        """Whether the tool waits for a further place."""
        return bool(self._places)

    @property
    def moves_corners(self) -> bool:
        """Whether a press on a corner moves it, instead of giving its place to the tool."""
        return self._tool == LINE or (self._tool == ARC and not self.sketch.open)

    def cancel(self) -> bool:
        """Forget the places that the tool was given; False if there are none."""
        begun = self.begun
        self._places.clear()
        return begun

    @property
    def start(self) -> Place | None:
        """Where that begins which is drawn next: the last corner, or the first place."""
        if self._tool in (LINE, ARC):
            row = self.sketch.loops[-1].corners
            return row[-1] if row and self.sketch.open else None
        return self._places[0] if self._places else None

    # Places

    def click(self, place: Place) -> str:
        """Give the tool a place; returns why it could not be used, or an empty text."""
        if self._tool in (LINE, ARC):
            return self._on_path(place)
        if self._tool == MEASURE:
            if len(self._places) == 2:
                self._places.clear()
            self._places.append(place)
            return ""
        if self.sketch.open and self.sketch.loops[-1].corners:
            what = "the outline" if len(self.sketch.loops) == 1 else "the hole"
            return BEGUN.format(what=what)
        if not self._places:
            self._places.append(place)
            return ""
        made = self._loop(self._places[0], place)
        if made is None:
            return "Nothing is drawn between two equal points."
        self._places.clear()
        self.sketch.add_loop(*made)
        return ""

    def _on_path(self, place: Place) -> str:
        sketch = self.sketch
        if not sketch.open:
            return HOLE_FIRST
        row = sketch.loops[-1].corners
        if self._tool == LINE or not row:
            if not (row and place == row[0] and sketch.close()):
                sketch.add(place)
        elif not self._places:
            if place == row[-1]:
                return "An arc ends at another point than it begins."
            self._places.append(place)
        else:
            end = self._places.pop()
            bulge = bulge_through(row[-1], place, end)
            if end != row[0] or not sketch.close(bulge):
                sketch.add(end, bulge)
        return ""

    def _loop(self, start: Place, place: Place) -> tuple[list[Place], list[float]] | None:
        """Corners and bulges of the rectangle or circle."""
        (x, y), (a, b) = start, place
        if self._tool == RECTANGLE:
            return ([(x, y), (a, y), (a, b), (x, b)], []) if x != a and y != b else None
        radius = math.dist(start, place)
        return ([(x - radius, y), (x + radius, y)], [1.0, 1.0]) if radius > 0.0 else None

    # What is shown

    def bulge_to(self, place: Place) -> float:
        """The bulge of the edge that a click at ``place`` would add."""
        row = self.sketch.loops[-1].corners
        if self._tool == ARC and self._places and row:
            return bulge_through(row[-1], place, self._places[0])
        return 0.0

    def end_at(self, place: Place) -> Place:
        """Where the edge would end that a click at ``place`` would add."""
        return self._places[0] if self._tool == ARC and self._places else place

    def draft(self, place: Place) -> Draft:
        """What a click at ``place`` would add."""
        start = self.start
        if self._tool == MEASURE:
            if len(self._places) == 2:
                start, place = self._places
            return Draft() if start is None else Draft(((start, place),), span(start, place))
        if start is None:
            return Draft()
        if self._tool in (LINE, ARC):
            end, bulge = self.end_at(place), self.bulge_to(place)
            line = tuple(points_of(start, end, bulge))
            if not bulge:
                return Draft((line,), polar(start, end))
            return Draft((line,), f"R {short(circle_of(start, end, bulge)[1])}")
        made = self._loop(start, place)
        if made is None:
            return Draft()
        corners, bulges = made
        if self._tool == RECTANGLE:
            size = f"{short(abs(place[0] - start[0]))} \u00d7 {short(abs(place[1] - start[1]))}"
            return Draft(((*corners, corners[0]),), size)
        left, right = corners
        rim = points_of(left, right, bulges[0])[:-1] + points_of(right, left, bulges[1])
        radius = math.dist(start, place)
        return Draft((tuple(rim), (start, place)), f"R {short(radius)}")

    # Typed dimensions

    @property
    def hint(self) -> str:
        """What can be typed now, in a sentence; empty if nothing."""
        if self._tool == MEASURE:
            return ""
        if self.start is None:
            return "Type \u201cx y\u201d, then Return."
        if self._tool == ARC and self._places:
            return "Type the radius, then Return."
        return _HINTS[self._tool]

    def place_of(self, text: str, mouse: Place | None) -> Place:
        """The place that typed dimensions mean, which :meth:`click` then takes.

        Args:
            text: one number, two separated by a space, ``;`` or ``x``, or ``length<angle`` in
                degrees; decimal point or comma.
            mouse: where the mouse is; a length alone goes that way.

        Raises:
            MeshError: the text is nothing that the tool can use now.
        """
        start, hint = self.start, self.hint
        two, one, turned = _TWO.match(text), _ONE.match(text), _POLAR.match(text)
        if self._tool == MEASURE:
            raise MeshError("The measuring tool takes no dimensions.")
        if start is None:
            if two is None:
                raise MeshError(f"{text.strip()!r} is no point. {hint}")
            return _number(two[1]), _number(two[2])
        if self._tool == ARC and self._places:
            if one is None:
                raise MeshError(f"{text.strip()!r} is no radius. {hint}")
            return self._on_arc(start, self._places[0], _number(one[1]), mouse)
        if self._tool == CIRCLE:
            radius = _number(one[1]) if one else 0.0
            if radius <= 0.0:
                raise MeshError(f"{text.strip()!r} is no radius. {hint}")
            return start[0] + radius, start[1]
        if turned is not None and self._tool != RECTANGLE:
            length, angle = _number(turned[1]), math.radians(_number(turned[2]))
            return _tidy(start[0] + length * math.cos(angle), start[1] + length * math.sin(angle))
        if two is not None:
            return self._by_steps(start, _number(two[1]), _number(two[2]), mouse)
        if one is None or self._tool == RECTANGLE:
            raise MeshError(f"{text.strip()!r} cannot be read. {hint}")
        if mouse is None or mouse == start:
            raise MeshError("Move the mouse the way that the edge shall go, or type an angle, too.")
        share = _number(one[1]) / math.dist(start, mouse)
        x, y = mouse[0] - start[0], mouse[1] - start[1]
        return _tidy(start[0] + share * x, start[1] + share * y)

    def _by_steps(self, start: Place, x: float, y: float, mouse: Place | None) -> Place:
        if self._tool == RECTANGLE and mouse is not None:  # towards the mouse
            x = math.copysign(x, mouse[0] - start[0])
            y = math.copysign(y, mouse[1] - start[1])
        return _tidy(start[0] + x, start[1] + y)

    def _on_arc(self, a: Place, b: Place, radius: float, mouse: Place | None) -> Place:
        """The middle of the arc of this radius on the side of the mouse."""
        beside = mouse or a
        bent = bulge_through(a, beside, b)
        try:
            bulge = bulge_of_radius(a, b, radius, bent < 0.0, abs(bent) > 1.0)
        except ValueError as error:
            raise MeshError(f"No arc: {error}.") from error
        points = points_of(a, b, bulge)
        return points[len(points) // 2]


def polar(a: Place, b: Place) -> str:
    """Length and direction from a to b: ``1.5 < 30°``."""
    angle = math.degrees(math.atan2(b[1] - a[1], b[0] - a[0])) + 0.0
    return f"{short(math.dist(a, b))} < {short(angle)}\u00b0"


def span(a: Place, b: Place) -> str:
    """Distance from a to b, its components and its direction."""
    steps = f"\u0394x {short(b[0] - a[0])}, \u0394y {short(b[1] - a[1])}"
    return f"{polar(a, b)}   {steps}"


def short(number: float) -> str:
    """A number in at most five digits."""
    return f"{number + 0.0:.5g}".replace("-", "\u2212")


def _number(text: str) -> float:
    return float(text.replace("\u2212", "-").replace(",", "."))


def _tidy(x: float, y: float) -> Place:
    """The place to 12 digits, so that 0.1 + 0.2 is 0.3."""
    return float(f"{x:.12g}") + 0.0, float(f"{y:.12g}") + 0.0
