"""Loops of curves that tests of domains share."""

from __future__ import annotations

import math
from itertools import pairwise

from meshwright_core.curves.curve import Curve

TURN = 2 * math.pi


def ring(*points: tuple[float, float]) -> list[Curve]:
    """A closed polygon of segments."""
    return [Curve.line(a, b) for a, b in pairwise([*points, points[0]])]


def circle(
    x: float, y: float, radius: float, start: float = 0.0, sweep: float = TURN
) -> list[Curve]:
    """A whole circle, or an arc."""
    return [Curve.arc((x, y), radius, start, sweep)]


def turned(loop: list[Curve]) -> list[Curve]:
    """A loop, run through the other way."""
    return [curve.reversed for curve in reversed(loop)]


SQUARE = ring((0, 0), (100, 0), (100, 100), (0, 100))
PLATE = [SQUARE, circle(50, 50, 20)]
# a bar with one rounded end
BAR = [
    Curve.line((0, 0), (60, 0)),
    Curve.arc((60, 20), 20, -0.5 * math.pi, math.pi),
    Curve.line((60, 40), (0, 40)),
    Curve.line((0, 40), (0, 0)),
]


def two_materials() -> list[tuple[str, list[list[Curve]]]]:
    """Two rectangles that share a side."""
    left = ring((0, 0), (50, 0), (50, 40), (0, 40))
    right = ring((50, 0), (100, 0), (100, 40), (50, 40))
    return [("steel", [left]), ("copper", [right])]


def lens(degrees: float) -> list[Curve]:
    """Two arcs that meet at this angle at both ends."""
    upper = Curve.arc_by_bulge((1, 0), (-1, 0), math.tan(math.radians(degrees) / 4))
    lower = upper.transformed([[1, 0, 0], [0, -1, 0]])
    return [upper, lower.reversed]
