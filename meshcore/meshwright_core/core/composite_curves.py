"""Composite curves as flat arrays: the sides of a mesh, exact at every point, and kernels on them.

A composite curve is a chain of *spans*, each a rational Bezier curve of any degree: segments have
degree 1, arcs of circles and ellipses degree 2, and a B-spline becomes one span for each interval
between its knots. So one evaluation serves all of them, without error beyond rounding (Piegl and
Tiller, *The NURBS Book*, sections 1.4 and 7.3).

The parameter t of a curve runs from 0 to its length. It is the arc length at the ends of the spans
and linear in the Bezier parameter in between; spans are short enough that it differs little from
the arc length everywhere.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.references import by_reference

_GAUSS_NODES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(24)
SHORTEST = 1e-12
"""Least extent of the parameter on a span of a polyline, relative to its length."""
_TRIALS = 8
"""Intervals of a curved span that are searched for the nearest point."""


@by_reference
class Curves(NamedTuple):
    """Composite curves; c control points, s spans, n curves."""

    control: np.ndarray
    """(c, 4) float64 homogeneous control points (w x, w y, w z, w), w > 0."""
    first_control: np.ndarray
    """(s + 1,) int64 the first control point of each span; a span of degree d has d + 1."""
    start: np.ndarray
    """(s,) float64 parameter at which each span begins, 0 for the first one of a curve."""
    stop: np.ndarray
    """(s,) float64 parameter at which each span ends."""
    first_span: np.ndarray
    """(n + 1,) int64 the first span of each curve."""
    closed: np.ndarray
    """(n,) bool whether a curve ends where it begins; t is then taken modulo the length."""


@bare_kernel
def curve_length(curves, curve):
    """The length of a curve, its largest parameter."""
    return curves.stop[curves.first_span[curve + 1] - 1]


@bare_kernel
def span_at(curves, curve, t):
    """The span of a curve at parameter t in [0, length], by bisection."""
    low, high = curves.first_span[curve], curves.first_span[curve + 1]
    while high - low > 1:
        middle = (low + high) // 2
        if curves.start[middle] <= t:
            low = middle
        else:
            high = middle
    return low


@bare_kernel
def place_in_span(curves, span, u, point, tangent):
    """Write the point at u in [0, 1] of a span, and the derivative by u; (2,) or (3,) each."""
    first = curves.first_control[span]
    degree = curves.first_control[span + 1] - first - 1
    control = curves.control
    size = len(point)
    if degree == 1:
        for c in range(size):
            step = control[first + 1, c] - control[first, c]
            tangent[c] = step
            # from the nearer end, so that both ends are met to the bit
            if u <= 0.5:
                point[c] = control[first, c] + u * step
            else:
                point[c] = control[first + 1, c] - (1.0 - u) * step
        return
    v = 1.0 - u
    weight = _bernstein(control, first, degree, u, v, 3)
    slope = _bernstein_slope(control, first, degree, u, v, 3)
    for c in range(size):
        value = _bernstein(control, first, degree, u, v, c) / weight
        point[c] = value
        tangent[c] = (_bernstein_slope(control, first, degree, u, v, c) - value * slope) / weight


@bare_kernel
def _bernstein(control, first, degree, u, v, c):
    """Coordinate c of the Bezier curve of control points first ... first + degree."""
    power, binomial = 1.0, 1.0
    total = control[first, c] * v
    for i in range(1, degree):
        power *= u
        binomial *= (degree - i + 1) / i
        total = (total + power * binomial * control[first + i, c]) * v
    return total + power * u * control[first + degree, c]


@bare_kernel
def _bernstein_slope(control, first, degree, u, v, c):
    """Its derivative by u."""
    if degree == 1:
        return control[first + 1, c] - control[first, c]
    last = degree - 1
    power, binomial = 1.0, 1.0
    total = (control[first + 1, c] - control[first, c]) * v
    for i in range(1, last):
        power *= u
        binomial *= (last - i + 1) / i
        step = control[first + i + 1, c] - control[first + i, c]
        total = (total + power * binomial * step) * v
    step = control[first + degree, c] - control[first + degree - 1, c]
    return degree * (total + power * u * step)


@bare_kernel
def place_on(curves, curve, t, point, tangent):
    """Write the point at t and the derivative by t; beyond an open end: straight on."""
    length = curve_length(curves, curve)
    if curves.closed[curve] and (t < 0.0 or t > length):
        t -= np.floor(t / length) * length
    inside = min(max(t, 0.0), length)
    span = span_at(curves, curve, inside)
    extent = curves.stop[span] - curves.start[span]
    place_in_span(curves, span, (inside - curves.start[span]) / extent, point, tangent)
    for c in range(len(point)):
        tangent[c] /= extent
        if inside != t:
            point[c] += (t - inside) * tangent[c]


@bare_kernel
def span_and_share(curves, curve, t):
    """The span of a curve at t, and the place u in [0, 1] there; t beyond an open end: the end."""
    length = curve_length(curves, curve)
    if curves.closed[curve] and (t < 0.0 or t > length):
        t -= np.floor(t / length) * length
    inside = min(max(t, 0.0), length)
    span = span_at(curves, curve, inside)
    return span, (inside - curves.start[span]) / (curves.stop[span] - curves.start[span])


@bare_kernel
def coordinate_in_span(curves, span, u, c):
    """Coordinate c of the point at u of a span: that of :func:`place_in_span` to the bit."""
    first = curves.first_control[span]
    degree = curves.first_control[span + 1] - first - 1
    control = curves.control
    if degree == 1:
        step = control[first + 1, c] - control[first, c]
        if u <= 0.5:
            return control[first, c] + u * step
        return control[first + 1, c] - (1.0 - u) * step
    v = 1.0 - u
    return _bernstein(control, first, degree, u, v, c) / _bernstein(control, first, degree, u, v, 3)


@kernel
def place_all(curves, curve, parameters):
    """(n, 3) points at the parameters (n,) of the curves `curve` (n,)."""
    points, tangent = np.zeros((len(parameters), 3)), np.zeros(3)
    for i in range(len(parameters)):
        place_on(curves, curve[i], parameters[i], points[i], tangent)
    return points


@kernel
def tangents(curves, curve, parameters):
    """(n, 3) derivatives by t at the parameters (n,) of the curves `curve` (n,)."""
    found, point = np.zeros((len(parameters), 3)), np.zeros(3)
    for i in range(len(parameters)):
        place_on(curves, curve[i], parameters[i], point, found[i])
    return found


@bare_kernel
def _box_distance(curves, span, point):
    """A lower bound of the squared distance of a point from a span: to the box of its control."""
    first, last = curves.first_control[span], curves.first_control[span + 1]
    total = 0.0
    for c in range(len(point)):
        low, high = np.inf, -np.inf
        for i in range(first, last):
            x = curves.control[i, c] / curves.control[i, 3]
            low, high = min(low, x), max(high, x)
        away = max(low - point[c], point[c] - high, 0.0)
        total += away * away
    return total


@kernel
def _nearest_in_span(curves, span, goal, bounds, place, slope):
    """The u in `bounds` (2,) where a span is nearest to `goal`, and the squared distance."""
    low, high = bounds[0], bounds[1]
    first = curves.first_control[span]
    if curves.first_control[span + 1] - first == 2:
        along, square = 0.0, 0.0
        for c in range(len(goal)):
            step = curves.control[first + 1, c] - curves.control[first, c]
            along += step * (goal[c] - curves.control[first, c])
            square += step * step
        u = min(max(along / square if square > 0.0 else low, low), high)
        return u, _distance(curves, span, u, goal, place, slope)
    best, found = np.inf, low
    for i in range(_TRIALS + 1):
        u = low + (high - low) * i / _TRIALS
        distance = _distance(curves, span, u, goal, place, slope)
        if distance < best:
            best, found = distance, u
    # the derivative of the squared distance changes its sign around the best of the trials
    left, right = (
        max(found - (high - low) / _TRIALS, low),
        min(found + (high - low) / _TRIALS, high),
    )
    for _ in range(60):
        middle = 0.5 * (left + right)
        if middle <= left or middle >= right:
            break
        _distance(curves, span, middle, goal, place, slope)
        along = 0.0
        for c in range(len(goal)):
            along += (place[c] - goal[c]) * slope[c]
        if along < 0.0:
            left = middle
        else:
            right = middle
    for u in (left, right):
        distance = _distance(curves, span, u, goal, place, slope)
        if distance < best:
            best, found = distance, u
    return found, best


@bare_kernel
def _distance(curves, span, u, goal, place, slope):
    place_in_span(curves, span, u, place, slope)
    total = 0.0
    for c in range(len(goal)):
        total += (place[c] - goal[c]) ** 2
    return total


@kernel
def nearest_between(curves, curve, goal, low, high):
    """The parameter in [low, high], 0 <= low <= high <= length, nearest to `goal` (2,) or (3,).

    Returns it and the squared distance.
    """
    best, where = np.inf, low
    place, slope, bounds = np.zeros(len(goal)), np.zeros(len(goal)), np.zeros(2)
    for span in range(span_at(curves, curve, low), curves.first_span[curve + 1]):
        start, stop = curves.start[span], curves.stop[span]
        if start > high:
            break
        if _box_distance(curves, span, goal) >= best:
            continue
        bounds[0] = max(0.0, (low - start) / (stop - start))
        bounds[1] = min(1.0, (high - start) / (stop - start))
        u, distance = _nearest_in_span(curves, span, goal, bounds, place, slope)
        if distance < best:
            best = distance
            where = min(max(start + u * (stop - start), low), high)
    return where, best


@kernel
def nearest_on(curves, curve, goal):
    """The parameter of the point of a curve nearest to `goal`, and the squared distance."""
    return nearest_between(curves, curve, goal, 0.0, curve_length(curves, curve))


@kernel
def nearest_parameters(curves, curve, points):
    """(n,) parameters on `curve` of the projections of `points` (n, 3)."""
    t = np.zeros(len(points))
    for i in range(len(points)):
        t[i], _ = nearest_on(curves, curve, points[i])
    return t


def no_curves() -> Curves:
    """Arrays of no curve at all."""
    return joined_curves([], [])


def joined_curves(chains: Sequence[Sequence[np.ndarray]], closed: Sequence[bool]) -> Curves:
    """Curves from chains of spans.

    Args:
        chains: for each curve its spans, each (d + 1, 4) homogeneous control points; each span
            begins exactly where the one before it ends.
        closed: whether each curve ends where it begins.
    """
    spans = [np.asarray(span, np.float64) for chain in chains for span in chain]
    counts = np.array([len(span) for span in spans], np.int64)
    lengths = np.array([span_length(span) for span in spans], np.float64)
    first = np.concatenate([[0], np.cumsum([len(chain) for chain in chains])]).astype(np.int64)
    start, stop = np.zeros(len(spans)), np.zeros(len(spans))
    for a, b in zip(first[:-1].tolist(), first[1:].tolist(), strict=True):
        stop[a:b] = np.cumsum(lengths[a:b])
        start[a + 1 : b] = stop[a : b - 1]
    return Curves(
        control=np.concatenate(spans) if spans else np.zeros((0, 4)),
        first_control=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        start=start,
        stop=stop,
        first_span=first,
        closed=np.array(closed, np.bool_).reshape(-1),
    )


def polyline_curves(polylines: Sequence[np.ndarray], closed: Sequence[bool]) -> Curves:
    """Curves from polylines (p, 3); a closed one does not repeat its first point.

    Where neighbouring points coincide, their span gets a tiny extent of the parameter.
    """
    control, counts, stops, starts = [np.zeros((0, 4))], [], [np.zeros(0)], [np.zeros(0)]
    for points, ring in zip(polylines, closed, strict=True):
        around = np.vstack([points, points[:1]]) if ring else np.asarray(points, np.float64)
        steps = np.linalg.norm(np.diff(around, axis=0), axis=1)
        total = float(steps.sum())
        # parameters increase even where points coincide
        steps = np.maximum(steps, SHORTEST * total if total > 0.0 else 1.0 / len(steps))
        arc = np.concatenate([[0.0], np.cumsum(steps)])
        ends = np.ones((len(around) - 1, 2, 4))
        ends[:, 0, :3], ends[:, 1, :3] = around[:-1], around[1:]
        control.append(ends.reshape(-1, 4))
        counts.append(len(around) - 1)
        starts.append(arc[:-1])
        stops.append(arc[1:])
    total = sum(counts)
    return Curves(
        control=np.concatenate(control),
        first_control=np.arange(0, 2 * total + 1, 2, dtype=np.int64),
        start=np.concatenate(starts),
        stop=np.concatenate(stops),
        first_span=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        closed=np.array(closed, np.bool_).reshape(-1),
    )


def chained_curves(parts: Sequence[Curves]) -> Curves:
    """All curves of `parts`, those of the first one first."""
    spans = np.cumsum([0, *(len(part.start) for part in parts)])
    controls = np.cumsum([0, *(len(part.control) for part in parts)])
    whole = [(np.zeros(1, np.int64), np.zeros(1, np.int64))]
    for part, span, control in zip(parts, spans, controls, strict=False):
        whole.append((part.first_control[1:] + control, part.first_span[1:] + span))
    return Curves(
        control=np.concatenate([np.zeros((0, 4)), *(part.control for part in parts)]),
        first_control=np.concatenate([ends for ends, _ in whole]),
        start=np.concatenate([np.zeros(0), *(part.start for part in parts)]),
        stop=np.concatenate([np.zeros(0), *(part.stop for part in parts)]),
        first_span=np.concatenate([ends for _, ends in whole]),
        closed=np.concatenate([np.zeros(0, np.bool_), *(part.closed for part in parts)]),
    )


def span_points(span: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) of a span (d + 1, 4) at u (n,), and derivatives by u (n, 3)."""
    value, slope = _de_casteljau(span, np.asarray(u, np.float64)[:, None])
    point = value[:, :3] / value[:, 3:]
    return point, (slope[:, :3] - point * slope[:, 3:]) / value[:, 3:]


def _de_casteljau(span: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    level = [np.broadcast_to(row, (len(u), 4)) for row in span]
    while len(level) > 2:
        level = [(1.0 - u) * a + u * b for a, b in pairwise(level)]
    value = (1.0 - u) * level[0] + u * level[1]
    return value, (len(span) - 1) * (level[1] - level[0])


def span_length(span: np.ndarray) -> float:
    """Arc length of a span (d + 1, 4), by Gauss-Legendre quadrature."""
    if len(span) == 2:
        return float(np.linalg.norm(span[1, :3] - span[0, :3]))
    _, slope = span_points(span, 0.5 * (_GAUSS_NODES + 1.0))
    return float(0.5 * _GAUSS_WEIGHTS @ np.linalg.norm(slope, axis=1))


def halves(span: np.ndarray, u: float = 0.5) -> tuple[np.ndarray, np.ndarray]:
    """The two spans that a span (d + 1, 4) consists of, before and after u."""
    rows = [np.asarray(span, np.float64)]
    while len(rows[-1]) > 1:
        rows.append((1.0 - u) * rows[-1][:-1] + u * rows[-1][1:])
    return np.array([row[0] for row in rows]), np.array([row[-1] for row in reversed(rows)])
