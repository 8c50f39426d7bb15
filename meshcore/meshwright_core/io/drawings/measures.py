"""Samples, areas and end directions of curves, in closed form where there is one.

A drawing of thousands of circles is traced by these; quadrature is left to splines.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from meshwright_core.curves.curve import Curve
from meshwright_core.io.drawings.drawn import Points

STEP = 2.0
"""Degrees that samples of a curve turn at each point."""


def axes(curve: Curve) -> tuple[Points, Points, Points]:
    """Centre and the two half diameters (2,) of an arc of a circle or an ellipse."""
    data = curve.data
    if curve.kind == "arc":
        radius = float(data["radius"])
        return data["centre"], np.array([radius, 0.0]), np.array([0.0, radius])
    return data["centre"], data["major"], data["minor"]


def samples(curve: Curve, step: float = STEP) -> Points:
    """Points (n, 2) along a curve, both ends among them; it turns by `step` degrees between."""
    if curve.kind == "line" or curve.kind == "polyline":
        points: Points = curve.data["points"]
        return points
    if curve.kind in ("arc", "ellipse"):
        centre, major, minor = axes(curve)
        sweep = float(curve.data["sweep"])
        count = max(2, math.ceil(abs(math.degrees(sweep)) / step - 1e-9))
        angle = curve.data["start"] + np.linspace(0.0, sweep, count + 1)
        found = centre + np.cos(angle)[:, None] * major + np.sin(angle)[:, None] * minor
        found[0], found[-1] = curve.start, curve.end
        return found
    return curve.sampled(step)


def area_about(curve: Curve, origin: Points) -> float:
    """Half the integral of x dy - y dx along a curve, with coordinates from `origin` (2,)."""
    if curve.kind == "line" or curve.kind == "polyline":
        x, y = (curve.data["points"] - origin).T
        return 0.5 * float(x[:-1] @ y[1:] - y[:-1] @ x[1:])
    if curve.kind in ("arc", "ellipse"):
        centre, major, minor = axes(curve)
        first, last = curve.start - origin, curve.end - origin
        middle = centre - origin
        across = float(major[0] * minor[1] - major[1] * minor[0])
        chord = last - first
        return 0.5 * float(
            across * curve.data["sweep"] + middle[0] * chord[1] - middle[1] * chord[0]
        )
    return curve.area_about(origin)


def end_directions(curve: Curve) -> tuple[Points, Points]:
    """Unit tangents (2,) at the start and at the end of a curve, in its own direction."""
    if curve.kind == "line" or curve.kind == "polyline":
        points = curve.data["points"]
        first, last = points[1] - points[0], points[-1] - points[-2]
    elif curve.kind in ("arc", "ellipse"):
        _, major, minor = axes(curve)
        sweep = float(curve.data["sweep"])
        side = math.copysign(1.0, sweep)
        start = float(curve.data["start"])
        first, last = (
            side * (math.cos(a) * minor - math.sin(a) * major) for a in (start, start + sweep)
        )
    else:
        first, last = curve.tangent(np.array([0.0, curve.length]))
    return first / np.hypot(*first), last / np.hypot(*last)


def near_ends(curve: Curve, way: float) -> tuple[Points, Points]:
    """The points (2,) that lie about `way` along the curve from its start and from its end."""
    if curve.kind == "polyline":
        # without the curve's arrays: a coastline has many spans
        points = curve.data["points"]
        return _along(points, way), _along(points[::-1], way)
    found = curve.point(np.array([way, curve.length - way]))
    return found[0], found[1]


def _along(points: Points, way: float) -> Points:
    step = points[1] - points[0]
    found: Points = points[0] + step * min(1.0, way / float(np.hypot(*step)))
    return found


def turn_angle(before: Points, after: Points) -> float:
    """Degrees, without sign, between two directions (2,)."""
    across = before[0] * after[1] - before[1] * after[0]
    return abs(math.degrees(math.atan2(across, before @ after)))


def inner_turns(curve: Curve) -> NDArray[np.float64]:
    """Degrees (k,) by which a curve turns at each of its kinks, ends not among them."""
    if curve.kind == "polyline":
        steps = np.diff(curve.data["points"], axis=0)
        before, after = steps[:-1], steps[1:]
        across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
        return np.abs(np.degrees(np.arctan2(across, (before * after).sum(axis=1))))
    if curve.kind != "spline" or not len(kinks := curve.kinks):
        return np.zeros(0)
    step = 1e-7 * curve.length
    before, after = curve.tangent(kinks - step), curve.tangent(kinks + step)
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.abs(np.degrees(np.arctan2(across, (before * after).sum(axis=1))))
