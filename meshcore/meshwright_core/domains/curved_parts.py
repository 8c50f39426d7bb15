"""Random parts with curved sides, and airfoils in boxes: a suite for meshing and solving.

A part begins as an outline of :mod:`.random_parts`. Its corners become fillets (arcs tangent to
both sides) or scoops (arcs around the corner, cut out), and some of its sides elliptic arcs or
splines. Round holes go where there is room for them. A change that brings two sides too near to
each other, or makes a corner too sharp, is not made.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.curves.curve import Curve
from meshwright_core.domains.airfoils import airfoil_curves
from meshwright_core.domains.curved_shapes import box, circle
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.loops.side_pieces import end_directions, samples, turn_between
from meshwright_core.domains.random_parts import random_part

Points = NDArray[np.float64]

PARTS, AIRFOILS = 24, 10
"""How many there are in the suite."""
CORNERS = (6, 30)
MOST_HOLES = 8
CLEAR = 0.3
"""Room between two sides that do not meet, in least sides of the outline, at least."""
SHARPEST = 25.0
"""Degrees of the sharpest corner, inside or outside."""

_FILLETS, _SCOOPS, _ELLIPSES, _SPLINES = 0.5, 0.2, 0.12, 0.12  # shares of corners, of sides
_ATTEMPTS = 60  # places for a hole
_TURN = 10.0


def curved_suite(seed: int) -> list[Domain]:
    """24 parts and ten airfoils; each depends on the seed and on its number alone."""
    parts = [curved_part(np.random.default_rng([seed, 0, i]), f"part {i}") for i in range(PARTS)]
    return parts + [
        random_airfoil(np.random.default_rng([seed, 1, i]), f"airfoil {i}") for i in range(AIRFOILS)
    ]


def curved_part(rng: np.random.Generator, name: str = "") -> Domain:
    """Draw a part.

    Args:
        rng: the only source of randomness.
        name: of the domain.
    """
    count = int(rng.integers(CORNERS[0], CORNERS[1] + 1))
    corners = random_part(count, rng, holes=False).outline
    sides = np.roll(corners, -1, axis=0) - corners
    unit = float(np.hypot(*sides.T).min())
    outline = _Outline(corners, unit)
    for i in rng.permutation(count).tolist():
        choice, heights = rng.random(), rng.uniform(-1.0, 1.0, 3)
        if choice < _ELLIPSES:
            outline.try_side(i, "ellipse", heights)
        elif choice < _ELLIPSES + _SPLINES:
            outline.try_side(i, "spline", heights)
    for i in rng.permutation(count).tolist():
        choice, size = rng.random(), rng.uniform(0.5, 1.0)
        if choice < _FILLETS:
            outline.try_corner(i, "fillet", size)
        elif choice < _FILLETS + _SCOOPS:
            outline.try_corner(i, "scoop", size)
    curves = outline.curves()
    holes = _holes(curves, unit, int(rng.integers(0, MOST_HOLES + 1)), rng)
    return Domain.from_curves([curves, *holes], name=name)


def random_airfoil(rng: np.random.Generator, name: str = "") -> Domain:
    """Draw a NACA four-digit airfoil, its trailing edge sharp or blunt, turned in a box.

    Args:
        rng: the only source of randomness.
        name: of the domain; the code of the airfoil is added.
    """
    camber = int(rng.integers(0, 7))
    place = int(rng.integers(2, 7)) if camber else 0
    code = f"{camber}{place}{int(rng.integers(8, 22)):02d}"
    blunt = bool(rng.random() < 0.5)
    angle = math.radians(float(rng.uniform(-12.0, 12.0)))
    cosine, sine = math.cos(angle), math.sin(angle)
    turn = [[cosine, sine, -0.3 * cosine], [-sine, cosine, 0.3 * sine]]
    wing = [curve.transformed(turn) for curve in airfoil_curves(code, blunt)]
    ahead, behind, above = rng.uniform((0.8, 1.2, 0.7), (2.5, 4.0, 2.5)).tolist()
    title = f"{name} NACA {code}{' blunt' if blunt else ''}".strip()
    return Domain.from_curves([box(-ahead, -above, behind, above), wing], name=title)


class _Outline:
    """Sides and corners of a polygon, some of which are curves."""

    def __init__(self, corners: Points, unit: float) -> None:
        self._corners, self._unit = corners, unit
        self._at: dict[int, Curve] = {}
        self._along: dict[int, Curve] = {}

    def curves(self) -> list[Curve]:
        """The closed loop of its curves."""
        found: list[Curve] = []
        count = len(self._corners)
        for i in range(count):
            start, end = self._ends(i)
            found.append(self._along.get(i, Curve.line(start, end)))
            if (i + 1) % count in self._at:
                found.append(self._at[(i + 1) % count])
        return found

    def _ends(self, side: int) -> tuple[Points, Points]:
        """Where the side from a corner to the next one begins and ends."""
        following = (side + 1) % len(self._corners)
        start = self._at[side].end if side in self._at else self._corners[side]
        end = self._at[following].start if following in self._at else self._corners[following]
        return start, end

    def try_corner(self, corner: int, way: str, size: float) -> None:
        """Put an arc in the place of a corner of two straight sides, if it fits; size 0 to 1."""
        if corner in self._along or (corner - 1) % len(self._corners) in self._along:
            return
        here = self._corners[corner]
        before = self._corners[corner - 1] - here
        after = self._corners[(corner + 1) % len(self._corners)] - here
        lengths = [float(np.hypot(*before)), float(np.hypot(*after))]
        reach = 0.42 * size * min(lengths)
        start, end = here + reach * before / lengths[0], here + reach * after / lengths[1]
        turn = math.radians(turn_between(-before, after))
        if way == "fillet":
            self._at[corner] = Curve.arc_by_bulge(start, end, math.tan(0.25 * turn))
        elif turn > 0.0:  # from side to side around the corner, clockwise
            self._at[corner] = Curve.arc_by_bulge(start, end, -math.tan(0.25 * (math.pi - turn)))
        else:
            return
        if not self._fine():
            del self._at[corner]

    def try_side(self, side: int, way: str, heights: Points) -> None:
        """Put a curve in the place of a side, if it fits; heights (3,) from -1 to 1."""
        start, end = self._ends(side)
        along = end - start
        length = float(np.hypot(*along))
        if length < 1.2 * self._unit:
            return
        normal = np.array([along[1], -along[0]])
        if way == "ellipse":
            # the part of an ellipse that lies more than half of a half axis beyond its middle
            height = math.copysign(0.1 + 0.25 * abs(heights[0]), heights[0])
            major, minor = along / math.sqrt(3.0), 2.0 * height * normal
            centre = 0.5 * (start + end) - 0.5 * minor
            first = math.radians(150.0)
            curve = Curve.ellipse(centre, major, minor, first, -math.radians(120.0))
            curve = curve.moved_ends(start, end)
        else:
            shares = np.linspace(0.0, 1.0, 5)[:, None]
            off = 0.14 * np.concatenate([[0.0], heights, [0.0]])[:, None]
            curve = Curve.through(start + shares * along + off * normal)
        self._along[side] = curve
        if not self._fine():
            del self._along[side]

    def _fine(self) -> bool:
        """Whether no two sides come too near to each other, and no corner is too sharp."""
        curves = self.curves()
        ends = list(end_directions(curves))
        for i, (come, go) in enumerate(zip(ends, [*ends[1:], ends[0]], strict=True)):
            turn = abs(turn_between(come[1], go[0]))
            if turn > 180.0 - SHARPEST:
                return False
            if curves[i].length < 0.1 * self._unit:
                return False
        rows = samples(curves, _TURN)
        ring = shapely.Polygon(np.concatenate([row[:-1] for row in rows]))
        if not ring.is_valid:
            return False
        lines = np.array([shapely.LineString(row) for row in rows], object)
        apart = shapely.distance(lines[:, None], lines[None, :])
        # the sides of a short piece are near to each other at its ends
        lengths = np.array([curve.length for curve in curves])
        before = np.cumsum(lengths) - lengths
        ahead = (before[None, :] - (before + lengths)[:, None]) % lengths.sum()
        between = np.minimum(ahead, ahead.T)
        i, j = np.indices(apart.shape)
        far = ~np.isin((j - i) % len(curves), (0, 1, len(curves) - 1))
        least = np.minimum(CLEAR * self._unit, 0.5 * between)
        return bool((apart >= least)[far].all())


def _holes(
    outline: Sequence[Curve], unit: float, count: int, rng: np.random.Generator
) -> list[list[Curve]]:
    """Round holes, up to `count`, clear of the outline and of each other."""
    ring = np.concatenate([row[:-1] for row in samples(outline, _TURN)])
    part = shapely.Polygon(ring)
    low, high = ring.min(axis=0), ring.max(axis=0)
    holes: list[list[Curve]] = []
    for _ in range(_ATTEMPTS):
        if len(holes) == count:
            break
        place, radius = rng.uniform(low, high), unit * float(rng.uniform(0.25, 1.2))
        room = radius + max(CLEAR * unit, 0.3 * radius)
        disc = shapely.Point(place).buffer(room)
        if part.contains(disc):
            holes.append(circle(float(place[0]), float(place[1]), radius))
            part = part.difference(shapely.Point(place).buffer(radius))
    return holes
