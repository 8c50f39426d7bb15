"""Shapes of the gallery between true curves: parts as an engineer draws them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from meshwright_core.curves.curve import Curve
from meshwright_core.domains.airfoils import airfoil_curves
from meshwright_core.domains.domain import Domain

Place = tuple[float, float]

QUARTER, HALF, WHOLE = 0.5 * math.pi, math.pi, 2.0 * math.pi


def polygon(corners: Sequence[Place]) -> list[Curve]:
    """A closed loop of segments."""
    return [Curve.line(a, b) for a, b in pairwise([*corners, corners[0]])]


def box(x0: float, y0: float, x1: float, y1: float) -> list[Curve]:
    """A rectangle of four segments."""
    return polygon([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def circle(x: float, y: float, radius: float) -> list[Curve]:
    """A whole circle."""
    return [Curve.arc((x, y), radius, 0.0, WHOLE)]


def plate_with_round_hole() -> Domain:
    """A square plate with a round hole in its middle."""
    return Domain.from_curves([box(-0.7, -0.7, 0.7, 0.7), circle(0, 0, 0.28)])


def filleted_bracket() -> Domain:
    """An angle bracket with rounded ends, a fillet between its arms, and three bolt holes."""
    arc, line = Curve.arc, Curve.line
    outline = [
        line((0.15, 0), (1.65, 0)), arc((1.65, 0.15), 0.15, -QUARTER, QUARTER),
        line((1.8, 0.15), (1.8, 0.45)), arc((1.65, 0.45), 0.15, 0, QUARTER),
        line((1.65, 0.6), (0.825, 0.6)), arc((0.825, 0.825), 0.225, -QUARTER, -QUARTER),
        line((0.6, 0.825), (0.6, 1.35)), arc((0.45, 1.35), 0.15, 0, QUARTER),
        line((0.45, 1.5), (0.15, 1.5)), arc((0.15, 1.35), 0.15, QUARTER, QUARTER),
        line((0, 1.35), (0, 0.15)), arc((0.15, 0.15), 0.15, HALF, QUARTER),
    ]  # fmt: skip
    holes = [circle(x, y, 0.09) for x, y in ((0.3, 0.3), (1.425, 0.3), (0.3, 1.2))]
    return Domain.from_curves([outline, *holes])


def duct_bend() -> Domain:
    """A duct with a bend of 90 degrees between straight walls."""
    outline = [
        Curve.line((0, 0), (0.8, 0)), Curve.arc((0.8, 0.6), 0.6, -QUARTER, QUARTER),
        Curve.line((1.4, 0.6), (1.4, 1.4)), Curve.line((1.4, 1.4), (0.8, 1.4)),
        Curve.line((0.8, 1.4), (0.8, 0.75)), Curve.arc((0.65, 0.75), 0.15, 0, -QUARTER),
        Curve.line((0.65, 0.6), (0, 0.6)), Curve.line((0, 0.6), (0, 0)),
    ]  # fmt: skip
    return Domain.from_curves([outline])


def nozzle() -> Domain:
    """Half of a converging and diverging nozzle above its axis; its wall is a spline."""
    wall = Curve.through(
        [(2, 0.85), (1.6, 0.78), (1.2, 0.62), (0.9, 0.48), (0.65, 0.52), (0.35, 0.82), (0, 0.9)]
    )
    outline = [Curve.line((0, 0), (2, 0)), Curve.line((2, 0), (2, 0.85)), wall]
    return Domain.from_curves([[*outline, Curve.line((0, 0.9), (0, 0))]])


def pipe() -> Domain:
    """The cross-section of a thick pipe: a ring between two circles."""
    return Domain.from_curves([circle(0, 0, 0.9), circle(0, 0, 0.65)])


def airfoil_in_box() -> Domain:
    """The flow around a NACA 2412 airfoil, a spline with a sharp trailing edge."""
    wing = [curve.transformed([[1, 0, -0.5], [0, 1, 0]]) for curve in airfoil_curves("2412")]
    return Domain.from_curves([box(-1, -0.6, 1, 0.6), wing])


def two_materials() -> Domain:
    """Two rectangles of different materials side by side."""
    return Domain.from_regions(
        [("steel", [box(-0.9, -0.4, 0, 0.4)]), ("copper", [box(0, -0.4, 0.9, 0.4)])]
    )


def plate_with_insert() -> Domain:
    """A square plate with a round insert of another material."""
    plate = ("plate", [box(-0.7, -0.7, 0.7, 0.7), circle(0, 0, 0.3)])
    return Domain.from_regions([plate, ("insert", [circle(0, 0, 0.3)])])


def motor_segment() -> Domain:
    """An eighth of an electric motor: rotor, magnet and stator, with air beside the magnet."""

    def sector(inner: float, outer: float, start: float, sweep: float) -> list[Curve]:
        a, b = math.radians(start), math.radians(sweep)
        near = Curve.arc((0, 0), inner, a + b, -b)
        far = Curve.arc((0, 0), outer, a, b)
        return [far, Curve.line(far.end, near.start), near, Curve.line(near.end, far.start)]

    return Domain.from_regions(
        [
            ("rotor", [sector(0.6, 1.2, 45, 45)]),
            ("magnet", [sector(1.2, 1.4, 52, 31)]),
            ("stator", [sector(1.4, 2.2, 45, 45)]),
        ]
    )
