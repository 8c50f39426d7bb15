"""Curves of drawings as polylines: arcs, Bezier curves and splines become pieces of an outline.

A curve is cut so that the polyline turns by about the same angle at each of its points, whatever
the size of the drawing: a circle becomes a regular polygon, and a straight stretch stays one edge.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwright_core.domains.domain import Flags, Points

CURVE_STEP = 15.0
"""Degrees by which a polyline that stands for a curve turns at each of its points, at most."""

_KINK = 30.0
"""Degrees between neighbours of a dense sample above which a curve has a corner there."""
_DENSE = 64
"""Samples of one span of a curve from which the points of its polyline are taken."""

Vector = NDArray[np.float64]
Affine = Callable[[Points], Points]


@dataclass(frozen=True)
class Piece:
    """A polyline that stands for one line or curve of a drawing.

    Attributes:
        points: (n, 2), n at least 2.
        corners: (n,) whether the curve itself turns sharply there; never at its two ends.
        leave: (2,) direction of the curve at its first point, of any length above 0.
        arrive: (2,) the same at its last point.
        curved: whether it stands for a curve, so that its directions are not exact.
    """

    points: Points
    corners: Flags
    leave: Vector
    arrive: Vector
    curved: bool

    @property
    def reversed(self) -> Piece:
        """The same, run through from its end to its start."""
        return Piece(self.points[::-1], self.corners[::-1], -self.arrive, -self.leave, self.curved)


def straight(points: ArrayLike, corner_angle: float) -> Piece | None:
    """Return a polyline (n, 2) of straight edges; None if it has no length.

    Its inner points are corners where it turns by more than `corner_angle` degrees.
    """
    line = without_repeats(np.asarray(points, dtype=np.float64))
    if len(line) < 2:
        return None
    steps = np.diff(line, axis=0)
    corners = np.zeros(len(line), dtype=bool)
    corners[1:-1] = _turns(steps) > corner_angle
    return Piece(line, corners, steps[0], steps[-1], False)


def arc(
    centre: ArrayLike,
    radius: float,
    start: float,
    sweep: float,
    step: float,
    place: Affine | None = None,
) -> Piece | None:
    """Return an arc of a circle; None if it has no length.

    Args:
        centre: (2,).
        radius: above 0.
        start: radians.
        sweep: radians, counter-clockwise; 2 pi or more is a whole circle.
        step: degrees by which the polyline may turn at a point.
        place: affine map to apply to the result, which makes an ellipse of it.
    """
    sweep = float(np.clip(sweep, -2 * np.pi, 2 * np.pi))
    count = max(2, int(np.ceil(abs(np.degrees(sweep)) / step - 1e-9)))
    if abs(sweep) >= 2 * np.pi - 1e-9:
        sweep = np.copysign(2 * np.pi, sweep)
        count = max(count, 8)
    angle = start + np.linspace(0.0, sweep, count + 1)
    unit = np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.asarray(centre, dtype=np.float64) + radius * unit
    if abs(sweep) == 2 * np.pi:
        points[-1] = points[0]
    ahead = np.sign(sweep) * np.column_stack([-unit[[0, -1], 1], unit[[0, -1], 0]])
    # directions as differences of places, so that one affine map serves both
    ends = points[[0, -1]] + radius * ahead
    if place is not None:
        points, ends = place(points), place(ends)
    leave, arrive = ends - points[[0, -1]]
    if not (leave.any() and arrive.any()):
        return None
    return Piece(points, np.zeros(len(points), dtype=bool), leave, arrive, True)


def bezier(control: ArrayLike, step: float) -> Piece | None:
    """Return a Bezier curve of its (3 or 4, 2) control points; None if it has no length."""
    points = np.asarray(control, dtype=np.float64)
    t = np.linspace(0.0, 1.0, _DENSE + 1)[:, None]
    level = [np.repeat(point[None], len(t), axis=0) for point in points]
    while len(level) > 1:
        level = [(1 - t) * one + t * other for one, other in itertools.pairwise(level)]
    return sampled(level[0], step)


def sampled(dense: Points, step: float) -> Piece | None:
    """Return a polyline through some points of a dense sample (n, 2) of a curve.

    It turns by about the same angle, at most `step` degrees, at each of its points; where the
    curve itself turns sharply there is a corner. None if the curve has no length.
    """
    line = without_repeats(dense)
    if len(line) < 2:
        return None
    steps = np.diff(line, axis=0)
    turn = _turns(steps)
    sharp = np.concatenate([[0], np.flatnonzero(turn > _KINK) + 1, [len(line) - 1]])
    chosen: list[int] = []
    for first, last in zip(sharp[:-1].tolist(), sharp[1:].tolist(), strict=True):
        along = np.concatenate([[0.0], np.cumsum(turn[first : last - 1]), [0.0]])
        along[-1] = along[-2]
        count = max(1 if along[-1] < step / 8 else 2, int(np.ceil(along[-1] / step)))
        wanted = along[-1] * (np.arange(count) + 0.5) / count
        inner = first + np.searchsorted(along, (wanted[1:] + wanted[:-1]) / 2)
        chosen += [first, *np.clip(inner, first + 1, last - 1).tolist()]
    index = np.unique([*chosen, len(line) - 1])
    corners = np.isin(index, sharp[1:-1])
    return Piece(line[index], corners, _end(steps), _end(steps[::-1]), True)


def spline(
    control: Points, knots: Vector, weights: Vector | None, degree: int, step: float
) -> Piece | None:
    """Return a B-spline, rational if it has weights; None if it has no length.

    Args:
        control: (n, 2) control points, n above `degree`.
        knots: (n + degree + 1,), not decreasing.
        weights: (n,) above 0, or None.
        degree: at least 1.
        step: degrees by which the polyline may turn at a point.
    """
    from scipy.interpolate import BSpline

    weight = np.ones(len(control)) if weights is None else weights
    curve = BSpline(knots, np.column_stack([control * weight[:, None], weight]), degree)
    spans = np.unique(knots[degree : len(control) + 1])
    share = np.arange(_DENSE) / _DENSE
    t = (spans[:-1, None] + np.diff(spans)[:, None] * share).ravel()
    # just before the end: there a basis of zeros would begin
    values = curve(np.append(t, np.nextafter(spans[-1], spans[0])))
    return sampled(values[:, :2] / values[:, 2:], step)


def through(points: Points, step: float) -> Piece | None:
    """Return a smooth curve through points (n, 2); a polyline where there are fewer than three."""
    from scipy.interpolate import CubicSpline

    line = without_repeats(points)
    if len(line) < 3:
        return straight(line, 0.0)
    t = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    closed = bool((points[0] == points[-1]).all())
    curve = CubicSpline(t, line, bc_type="periodic" if closed else "not-a-knot")
    share = np.arange(_DENSE) / _DENSE
    dense = (t[:-1, None] + np.diff(t)[:, None] * share).ravel()
    return sampled(curve(np.append(dense, t[-1])), step)


def without_repeats(points: Points) -> Points:
    """Return points (n, 2) without those that are the same as the one before."""
    keep = np.ones(len(points), dtype=bool)
    keep[1:] = (np.diff(points, axis=0) != 0).any(axis=1)
    return points[keep]


def _end(steps: Points) -> Vector:
    """Return the direction of a densely sampled curve where its first step begins.

    Steps have the direction that the curve has in their middle; go half a step back from there.
    """
    unit = steps[:2] / np.hypot(steps[:2, 0], steps[:2, 1])[:, None]
    direction: Vector = unit[0] if len(unit) < 2 else 1.5 * unit[0] - 0.5 * unit[1]
    return direction


def _turns(steps: Points) -> Vector:
    """Return by how many degrees each of (n, 2) steps turns from the one before, (n - 1,)."""
    before, after = steps[:-1], steps[1:]
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    return np.abs(np.degrees(np.arctan2(across, (before * after).sum(axis=1))))
