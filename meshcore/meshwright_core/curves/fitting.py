"""Curves fitted to polylines: arcs and segments, or splines between corners."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwright_core.curves.curve import Curve, without_repeats
from meshwright_core.errors import MeshError

Points = NDArray[np.float64]
Flags = NDArray[np.bool_]

CORNER = 30.0
"""Degrees by which a polyline turns at a corner between splines, by default."""
STEEPEST = 35.0
"""Degrees by which a polyline that stands for an arc turns at each point, at most: the corners of a
square lie on a circle too."""
_FEWEST = 4
"""Points that make an arc: three always lie on one."""
_WEIGHT = 1e3
"""Of the ends of a spline, relative to the points between them."""
_TRIALS = 40


def fit_arcs(points: ArrayLike, tolerance: float) -> list[Curve]:
    """Segments and arcs of circles along a polyline, each as long as possible.

    From each point on, the longest segment or arc is taken that keeps `tolerance` from all points
    that it replaces and ends in one of them. A polyline made of tangent arcs and segments gives
    these back, tangent to the accuracy of its points.

    Args:
        points: (n, 2); closed if the last one repeats the first one.
        tolerance: greatest distance of a point from the curves.

    Raises:
        MeshError: fewer than two different points, or a tolerance that is not positive.
    """
    line = _checked(points, tolerance)
    closed = len(line) > 3 and bool((line[0] == line[-1]).all())
    if closed:
        circle = _whole_circle(line, tolerance)
        if circle is not None:
            return [circle]
        # begin where a segment probably does
        first = int(np.argmax(np.hypot(*np.diff(line, axis=0).T)))
        line = np.vstack([line[first:-1], line[: first + 1]])
    turn = _turns(line)
    found: list[Curve] = []
    start = 0
    while start < len(line) - 1:
        straight = _longest(start, len(line), lambda i, j: _is_straight(line[i : j + 1], tolerance))
        bent = _longest(start, len(line), lambda i, j: _arc(line, turn, (i, j), tolerance)[0])
        if bent > straight and bent - start >= _FEWEST - 1:
            found.append(_arc(line, turn, (start, bent), tolerance)[1])
            start = bent
        else:
            found.append(Curve.line(line[start], line[straight]))
            start = straight
    return found


def fit_splines(points: ArrayLike, corners: ArrayLike | None, tolerance: float) -> list[Curve]:
    """Cubic splines along a polyline, from corner to corner, with few knots.

    Smoothing splines of Dierckx (SciPy's `splprep`) by least squares, with the largest smoothing
    that keeps the tolerance. Stretches that are straight become segments.

    Args:
        points: (n, 2); closed if the last one repeats the first one.
        corners: (n,) flags of the points where splines begin and end; None: where the polyline
            turns by more than 30 degrees. The ends of an open polyline always are.
        tolerance: greatest distance of a point from the curves.

    Raises:
        MeshError: as :func:`fit_arcs`; flags that do not fit.
    """
    given = np.array(points, np.float64).reshape(-1, 2)
    line = _checked(given, tolerance)
    if corners is None:
        marked = _corners(line)
    else:
        flags = np.asarray(corners, bool)
        if flags.shape != (len(given),):
            raise MeshError(f"The corners of {len(given)} points are as many flags.")
        kept = np.append(True, (np.diff(given, axis=0) != 0).any(axis=1))
        marked = flags[kept]
    closed = len(line) > 3 and bool((line[0] == line[-1]).all())
    if closed:
        inner = np.flatnonzero(marked[:-1])
        if not len(inner):
            return [_spline(line, tolerance, closed=True)]
        first = int(inner[0])
        line = np.vstack([line[first:-1], line[: first + 1]])
        marked = np.append(np.roll(marked[:-1], -first), True)
    marked[[0, -1]] = True
    stops = np.flatnonzero(marked).tolist()
    return [_spline(line[a : b + 1], tolerance, closed=False) for a, b in pairwise(stops)]


def _checked(points: ArrayLike, tolerance: float) -> Points:
    line = without_repeats(np.array(points, np.float64).reshape(-1, 2))
    if len(line) < 2 or not np.isfinite(line).all():
        raise MeshError("A curve can be fitted to two different points or more.")
    if not (tolerance > 0.0 and math.isfinite(tolerance)):
        raise MeshError(f"The tolerance of a fit must be a positive number, not {tolerance:g}.")
    return line


def _turns(line: Points) -> Points:
    """(n,) degrees by which a polyline turns at each point, positive to the left; 0 at its ends."""
    step = np.diff(line, axis=0)
    across = step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0]
    turn = np.degrees(np.arctan2(across, (step[:-1] * step[1:]).sum(axis=1)))
    return np.concatenate([[0.0], turn, [0.0]])


def _corners(line: Points) -> Flags:
    closed = bool((line[0] == line[-1]).all())
    if not closed:
        return np.abs(_turns(line)) > CORNER
    around = _turns(np.vstack([line[-2:-1], line, line[1:2]]))[1:-1]
    return np.abs(around) > CORNER


def _longest(start: int, count: int, fits: Callable[[int, int], bool]) -> int:
    """The last point up to which a piece from `start` on fits; two points always do."""
    good, step = start + 1, 1
    while good < count - 1 and fits(start, min(good + step, count - 1)):
        good = min(good + step, count - 1)
        step *= 2
    bad = min(good + step, count)
    while bad - good > 1:
        middle = (good + bad) // 2
        if fits(start, middle):
            good = middle
        else:
            bad = middle
    return good


def _is_straight(line: Points, tolerance: float) -> bool:
    """Whether points (n, 2) lie along their chord, in order."""
    way = line[-1] - line[0]
    length = float(np.hypot(*way))
    if length == 0.0:
        return False
    along = (line - line[0]) @ way / length
    across = (line - line[0]) @ np.array([-way[1], way[0]]) / length
    return bool(np.abs(across).max() <= tolerance and (np.diff(along) > 0.0).all())


def _arc(line: Points, turn: Points, ends: tuple[int, int], tolerance: float) -> tuple[bool, Curve]:
    """Whether the points between two of a polyline lie on an arc, and that arc.

    The circle through both ends whose centre, on the bisector, is best by least squares: points
    have x^2 + y^2 - 2 k y = h^2, with x along the chord of half length h, and the centre at k.
    """
    first, last = ends
    inside = line[first : last + 1]
    way = line[last] - line[first]
    half = 0.5 * float(np.hypot(*way))
    chord = (
        Curve.line((0.0, 0.0), (1.0, 0.0)) if half == 0.0 else Curve.line(line[first], line[last])
    )
    inner = turn[first + 1 : last]
    same_way = len(inner) and ((inner > 0.0).all() or (inner < 0.0).all())
    if half == 0.0 or not same_way or np.abs(inner).max() > STEEPEST:
        return last - first <= 2 and half > 0.0, chord
    unit = 0.5 * way / half
    local = inside - 0.5 * (line[first] + line[last])
    x, y = local @ unit, local @ np.array([-unit[1], unit[0]])
    k = float((y[1:-1] * (x**2 + y**2 - half**2)[1:-1]).sum() / (2.0 * (y[1:-1] ** 2).sum()))
    radius = math.hypot(half, k)
    off = np.abs(np.hypot(x, y - k) - radius)
    if off.max() > tolerance:
        return False, chord
    angle = np.unwrap(np.arctan2(y - k, x))
    sweep = float(angle[-1] - angle[0])
    steps = np.diff(angle) * math.copysign(1.0, sweep)
    if not (steps > 0.0).all() or abs(sweep) > 1.9 * math.pi:
        return False, chord
    return True, Curve.arc_by_bulge(line[first], line[last], math.tan(0.25 * sweep))


def _whole_circle(line: Points, tolerance: float) -> Curve | None:
    """The circle that all points of a closed polyline lie on, by least squares (Kasa, 1976)."""
    around = _turns(np.vstack([line[-2:-1], line, line[1:2]]))[1:-2]
    if not ((around > 0.0).all() or (around < 0.0).all()) or np.abs(around).max() > STEEPEST:
        return None
    middle = line[:-1].mean(axis=0)
    local = line[:-1] - middle
    matrix = np.column_stack([2.0 * local, np.ones(len(local))])
    (x, y, rest), *_ = np.linalg.lstsq(matrix, (local**2).sum(axis=1), rcond=None)
    centre = middle + [x, y]
    radius = math.sqrt(rest + x * x + y * y)
    if np.abs(np.hypot(*(line - centre).T) - radius).max() > tolerance:
        return None
    start = float(np.arctan2(*(line[0] - centre)[::-1]))
    return Curve.arc(centre, radius, start, math.copysign(2.0 * math.pi, float(around[0])))


def _spline(line: Points, tolerance: float, closed: bool) -> Curve:
    """One spline along points that have no corner between them."""
    from scipy.interpolate import splprep  # here: it takes a quarter of a second

    if not closed and _is_straight(line, tolerance):
        return Curve.line(line[0], line[-1])
    if len(line) <= 4:
        return Curve.through(line[:-1] if closed else line, closed)
    weights = np.ones(len(line))
    if not closed:
        weights[[0, -1]] = _WEIGHT
    # the sum of squares that splprep is given bounds the mean, not the greatest distance
    smoothing = len(line) * tolerance**2
    for _ in range(_TRIALS):
        (knots, control, degree), _t = splprep(line.T, w=weights, s=smoothing, per=int(closed))
        count = len(knots) - degree - 1
        curve = Curve.spline(np.column_stack(control)[:count], knots, degree)
        end = line[0] if not closed else curve.start
        curve = curve.moved_ends(end, end if closed else line[-1])
        if curve.project(line)[1].max() <= tolerance:
            return curve
        smoothing *= 0.5
    return Curve.through(line[:-1] if closed else line, closed)
