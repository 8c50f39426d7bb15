"""The path language of SVG: its commands as lines, elliptical arcs and Bezier curves.

After the SVG 1.1 recommendation, section 8.3; arcs by its appendix F.6.
"""

from __future__ import annotations

import math
import re

import numpy as np

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import LARGEST, Points, polyline

_BLANK = re.compile(r"[\s,]*")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_TAKES = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
_TAKEN_UP = {"S": "CS", "T": "QT"}
"""The commands whose last control point a smooth one takes up."""


Subpath = list[Curve]
"""Pieces one after the other; a Z has become the one that leads back."""


class _Scanner:
    """Reads commands and numbers off the text of a path."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0
        self._skip()

    def done(self) -> bool:
        return self.at == len(self.text)

    def command(self, before: str) -> str:
        """Return the next command, or the one before again where numbers follow at once."""
        letter = self.text[self.at]
        if letter.upper() in _TAKES:
            self.at += 1
            self._skip()
            return letter
        if not before or before in "zZ":
            raise self._error("a command")
        return {"M": "L", "m": "l"}.get(before, before)

    def number(self) -> float:
        match = _NUMBER.match(self.text, self.at)
        if match is None:
            raise self._error("a number")
        self.at = match.end()
        self._skip()
        value = float(match.group())
        if not abs(value) < LARGEST:
            raise self._error("a number", match.group())
        return value

    def flag(self) -> float:
        """Return a flag of an arc, which needs no space after it."""
        letter = self.text[self.at : self.at + 1]
        if letter not in ("0", "1"):
            raise self._error("0 or 1")
        self.at += 1
        self._skip()
        return float(letter)

    def _skip(self) -> None:
        match = _BLANK.match(self.text, self.at)
        self.at = match.end() if match else self.at

    def _error(self, wanted: str, found: str = "") -> MeshError:
        found = (found or self.text[self.at :])[:12]
        shown = repr(found) if found else "its end"
        return MeshError(f"a path has {shown} where {wanted} was expected")


def parse(text: str) -> list[Subpath]:
    """Return the subpaths of the `d` of a path; straight runs are polylines.

    Raises:
        MeshError: the text is not in the language.
    """
    scanner = _Scanner(text)
    subpaths: list[Subpath] = []
    place = start = np.zeros(2)
    run = [place]  # of straight lines, which become one polyline
    control = None  # the last control point of the command before, for S and T
    before = ""
    while not scanner.done():
        command = scanner.command(before)
        if not before and command not in "Mm":
            raise MeshError(f"a path begins with {command!r}, not with M")
        name, offset = command.upper(), place if command.islower() else np.zeros(2)
        if name == "A":
            given = [scanner.flag() if i in (3, 4) else scanner.number() for i in range(7)]
        else:
            given = [scanner.number() for _ in range(_TAKES[name])]
        if name in "MZ":
            if name == "Z":
                run.append(start)
                place = start
            else:
                place = start = np.array(given) + offset
            _end(subpaths, run)
            subpaths.append([])
            run, control = [place], None
        elif (end := _straight(name, np.array(given), place, offset)) is not None:
            run.append(end)
            place, control = end, None
        else:
            taken = control if before.upper() in _TAKEN_UP.get(name, "") else None
            _end(subpaths, run)
            curve, place, control = _curved(name, np.array(given), place, offset, taken)
            if curve is not None:
                subpaths[-1].append(curve)
            run = [place]
        before = command
    _end(subpaths, run)
    return [subpath for subpath in subpaths if subpath]


def _end(subpaths: list[Subpath], run: list[Points]) -> None:
    """Add a run of straight lines to the last subpath."""
    curve = polyline(run) if len(run) > 1 else None
    if curve is not None:
        subpaths[-1].append(curve)


def _straight(name: str, given: Points, place: Points, offset: Points) -> Points | None:
    """Where a straight command ends; None if it is not straight."""
    if name == "L":
        return given + offset
    if name in "HV":
        axis = "HV".index(name)
        end = place.copy()
        end[axis] = given[0] + offset[axis]
        return end
    if name == "A" and not (given[0] and given[1]):
        return given[5:] + offset
    return None


def _curved(
    name: str, given: Points, place: Points, offset: Points, control: Points | None
) -> tuple[Curve | None, Points, Points | None]:
    """Return what a command draws from `place`, where it ends, and its last control point."""
    if name == "A":
        end = given[5:] + offset
        return _arc(place, end, given[:5]), end, None
    points = given.reshape(-1, 2) + offset
    end = points[-1]
    if name in "ST":
        mirrored = place if control is None else 2 * place - control
        points = np.vstack([mirrored, points])
    control = np.vstack([place, points])
    if (control == place).all():
        return None, end, points[-2]
    return Curve.bezier(control), end, points[-2]


def _arc(start: Points, end: Points, given: Points) -> Curve | None:
    """Return an elliptical arc from its ends: radii, rotation, large-arc and sweep flags."""
    rx, ry = abs(given[0]), abs(given[1])
    if (start == end).all():
        return None
    angle = math.radians(given[2])
    axes = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    # in the frame where the ellipse is the unit circle; radii too small are scaled up
    one, other = (axes @ point / (rx, ry) for point in (start, end))
    half = math.hypot(*(other - one)) / 2
    if half > 1:
        one, other, rx, ry = one / half, other / half, rx * half, ry * half
        half = 1.0
    side = 1.0 if given[3] != given[4] else -1.0
    across = np.array([-(other - one)[1], (other - one)[0]]) / (2 * half)
    centre = 0.5 * (one + other) + side * math.sqrt(max(0.0, 1 - half**2)) * across
    begin, stop = (math.atan2(*(point - centre)[::-1]) for point in (one, other))
    sweep = (stop - begin) % (2 * math.pi)
    if not given[4]:
        sweep -= 2 * math.pi
    if sweep == 0.0:
        return None
    if rx == ry:
        return Curve.arc_by_bulge(start, end, math.tan(sweep / 4))
    back = np.diag([rx, ry]) @ axes
    made = Curve.ellipse(centre @ back, back[0], back[1], begin, sweep)
    return made.moved_ends(start, end)
