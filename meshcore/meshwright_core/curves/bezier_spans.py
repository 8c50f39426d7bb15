"""Rational Bezier spans of arcs and B-splines.

A span is a (d + 1, 4) array of homogeneous control points (w x, w y, w z, w) with w > 0; curves of
drawings lie in the plane z = 0.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.composite_curves import halves, span_points

Array = NDArray[np.float64]

_GAUSS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(24)
_NODES, _WEIGHTS = 0.5 * (_GAUSS + 1.0), 0.5 * _GAUSS_WEIGHTS

WIDEST = math.radians(45.0)
"""Sweep of one span of an arc, at most: its speed then varies by less than 4 percent."""
_EVEN = 1.5
"""Ratio of the largest to the smallest speed in a span beyond which it is halved."""
_DEEPEST = 6
"""How often a span is halved at most: the speed vanishes at a cusp."""
_FIFTHS = np.linspace(0.0, 1.0, 5)


def homogeneous(points: Array, weights: Array | None = None) -> Array:
    """(n, 4) homogeneous control points of plane points (n, 2)."""
    found = np.zeros((len(points), 4))
    found[:, :2] = points
    found[:, 3] = 1.0
    return found if weights is None else found * np.asarray(weights)[:, None]


def segment(a: Array, b: Array) -> Array:
    """(2, 4) the straight span from a (2,) to b (2,)."""
    return homogeneous(np.array([a, b], np.float64))


def arc_span(a: Array, b: Array, sweep: float) -> Array:
    """(3, 4) the arc from a (2,) to b (2,) that turns by `sweep` radians, |sweep| < pi.

    The middle control point is where the tangents of the ends meet, with weight cos(sweep / 2)
    (The NURBS Book, section 7.3). Exact also for arcs that are all but straight.
    """
    chord = b - a
    normal = np.array([chord[1], -chord[0]])
    middle = 0.5 * (a + b) + 0.5 * math.tan(0.5 * sweep) * normal
    return homogeneous(np.array([a, middle, b]), np.array([1.0, math.cos(0.5 * sweep), 1.0]))


def bulge_spans(a: Array, b: Array, bulge: float) -> list[Array]:
    """The arc from a to b whose apex lies `bulge` half chords to the right of the chord.

    bulge: the tangent of a quarter of the sweep, positive where the arc turns to the left.
    """
    sweep = 4.0 * math.atan(bulge)
    if abs(sweep) <= WIDEST * (1.0 + 1e-12):
        return [arc_span(a, b, sweep)]
    chord = b - a
    apex = 0.5 * (a + b) + 0.5 * bulge * np.array([chord[1], -chord[0]])
    half = math.tan(0.5 * math.atan(bulge))
    return [*bulge_spans(a, apex, half), *bulge_spans(apex, b, half)]


def circle_spans(centre: Array, radius: float, start: float, sweep: float) -> list[Array]:
    """An arc of a circle; angles in radians, `sweep` signed and at most a whole turn."""
    count = max(1, math.ceil(abs(sweep) / WIDEST - 1e-9))
    angle = start + np.linspace(0.0, sweep, count + 1)
    points = centre + radius * np.column_stack([np.cos(angle), np.sin(angle)])
    if abs(sweep) == 2.0 * math.pi:
        points[-1] = points[0]
    # arc_span for all at once
    half = 0.5 * sweep / count
    a, b = points[:-1], points[1:]
    chord = b - a
    normal = np.column_stack([chord[:, 1], -chord[:, 0]])
    spans = np.zeros((count, 3, 4))
    spans[:, 0, :2], spans[:, 2, :2] = a, b
    spans[:, 1, :2] = (0.5 * (a + b) + 0.5 * math.tan(half) * normal) * math.cos(half)
    spans[:, :, 3] = 1.0, math.cos(half), 1.0
    return list(spans)


def spline_spans(control: Array, knots: Array, degree: int) -> list[Array]:
    """The Bezier spans of a B-spline between its inner knots.

    Args:
        control: (n, 4) homogeneous control points.
        knots: (n + degree + 1,), not decreasing.
        degree: at least 1.

    A control point of a span is the blossom of the interval's polynomial at its two ends (Ramshaw,
    *Blossoms are polar forms*, 1989), computed by de Boor's algorithm for all intervals at once.
    """
    inner = np.arange(degree, len(control))
    inner = inner[knots[inner + 1] > knots[inner]]
    low, high = knots[inner], knots[inner + 1]
    rows = []
    for last in range(degree + 1):  # the last arguments of the blossom are the upper end
        level = np.stack([control[inner - degree + j] for j in range(degree + 1)])
        for r in range(1, degree + 1):
            at = high if r > degree - last else low
            for j in range(degree, r - 1, -1):
                left, right = knots[inner - degree + j], knots[inner + 1 + j - r]
                share = ((at - left) / (right - left))[:, None]
                level[j] = (1.0 - share) * level[j - 1] + share * level[j]
        rows.append(level[degree].copy())
    spans = np.stack(rows, axis=1)
    for before, after in pairwise(spans):
        # without a gap where the curve is continuous: the same number from both sides
        if np.abs(before[-1] - after[0]).max() <= 1e-12 * np.abs(before[-1]).max():
            after[0] = before[-1]
    return list(spans)


def span_lengths(spans: Sequence[Array]) -> Array:
    """Arc length of each span, by Gauss-Legendre quadrature of order 24; all at once."""
    lengths = np.zeros(len(spans))
    degrees = np.array([len(span) - 1 for span in spans])
    for degree in np.unique(degrees).tolist():
        index = np.flatnonzero(degrees == degree)
        control = np.stack([spans[i] for i in index.tolist()])
        if degree == 1:
            ends = control[:, :, :3] / control[:, :, 3:]
            lengths[index] = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
            continue
        basis, slopes = _bernstein(degree)
        value, slope = basis @ control, slopes @ control
        point = value[:, :, :3] / value[:, :, 3:]
        speed = (slope[:, :, :3] - point * slope[:, :, 3:]) / value[:, :, 3:]
        lengths[index] = np.linalg.norm(speed, axis=2) @ _WEIGHTS
    return lengths


@cache
def _bernstein(degree: int) -> tuple[Array, Array]:
    """(24, degree + 1) Bernstein polynomials at the nodes of the quadrature, and derivatives."""
    u = _NODES[:, None]
    i = np.arange(degree + 1)
    basis = _binomials(degree, i) * u**i * (1.0 - u) ** (degree - i)
    i = np.arange(degree)
    lower = _binomials(degree - 1, i) * u**i * (1.0 - u) ** (degree - 1 - i)
    slopes = np.zeros_like(basis)
    slopes[:, 1:] += degree * lower
    slopes[:, :-1] -= degree * lower
    return basis, slopes


def _binomials(n: int, k: NDArray[np.int64]) -> Array:
    """Binomial coefficients."""
    return np.array([float(math.comb(n, i)) for i in k.tolist()])


def evened(spans: list[Array]) -> list[Array]:
    """The same curve in spans short enough that the speed is nearly constant in each."""
    found: list[Array] = []
    pending = [(span, 0) for span in reversed(spans)]
    while pending:
        span, depth = pending.pop()
        if len(span) > 2 and depth < _DEEPEST:
            speed = np.linalg.norm(span_points(span, _FIFTHS)[1], axis=1)
            if speed.max() > _EVEN * speed.min():
                first, second = halves(span)
                pending += [(second, depth + 1), (first, depth + 1)]
                continue
        found.append(span)
    return found
