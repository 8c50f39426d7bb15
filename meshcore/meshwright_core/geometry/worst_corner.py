"""Max-min positions: raising the smallest corner sine of a plane quad mesh, compiled.

Untangling ends where nothing is folded; what a mesh is then judged by is its worst corner. Here
the soft minimum of all corner sines s_c,

    f = (1 / p) log sum exp(-p s_c) + w mean((|a|^2 + |b|^2) / (2 det)),

is minimised by L-BFGS for growing p. The first term tends to minus the smallest sine; the second,
small one is the mean of one over the corners' shapes: it is infinite for a folded corner, so that
no step inverts an element, and keeps elements from shrinking, which a sine does not see. The
variables are those of :mod:`meshwright_core.geometry.foldover_energy`: two for a vertex inside, the
place on its side for one that slides.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.geometry.foldover_energy import (
    MEMORY,
    SUFFICIENT,
    _direction,
    _pull,
    place,
)

SHARPNESS = (16.0, 64.0, 256.0)
"""Values of p, one after the other: the last one sees little but the worst corner."""
SHAPE_WEIGHT = 0.002
"""Weight w of the mean of one over the shapes."""
NO_LEVEL = 1e3
"""Level beyond which sines do not count, where all count."""
EVEN_WEIGHTS, GIVEN = (0.005, 0.02, 0.08), 0.02
"""Weights w once the worst corner is as good as it gets, and the share of its sine that may be given
for better shapes."""
PRECISION = 1e-5
"""Gain of a step below which the ascent ends."""
FOLDED = 1e-6
"""Sine up to which a corner counts as folded here: far from 0 in the arithmetic that follows."""


@kernel
def corner_sine(points, o, s, t):
    """Sine of the angle from s to t at o, positive counter-clockwise; 0 where a side has no
    length.
    """
    px, py = points[s, 0] - points[o, 0], points[s, 1] - points[o, 1]
    qx, qy = points[t, 0] - points[o, 0], points[t, 1] - points[o, 1]
    square = (px * px + py * py) * (qx * qx + qy * qy)
    return (px * qy - py * qx) / np.sqrt(square) if square > 0.0 else 0.0


@kernel
def worst_sine(problem):
    """The smallest corner sine at the present points; 1 if there are no corners."""
    worst = 1.0
    for c in range(len(problem.corners)):
        corner = problem.corners[c]
        worst = min(worst, corner_sine(problem.points, corner[0], corner[1], corner[2]))
    return worst


@kernel
def soft_worst(problem, x, gradient, sines, aim):
    """The objective f and the smallest sine; `gradient` is overwritten. sines (c,): scratch;
    aim (3,): p, w, and a level beyond which sines do not count.

    Infinite where a corner folds or a gap on a side closes.
    """
    place(problem, x)
    for i in range(len(gradient)):
        gradient[i] = 0.0
    for i in range(len(problem.gaps)):
        a, b = problem.gaps[i, 0], problem.gaps[i, 1]
        gap = problem.offset[i]
        if a >= 0:
            gap -= x[a]
        if b >= 0:
            gap += x[b]
        if not gap > 0.0:
            return np.inf, -1.0
    points, corners = problem.points, problem.corners
    worst = 1.0
    for c in range(len(corners)):
        sine = corner_sine(points, corners[c, 0], corners[c, 1], corners[c, 2])
        if not sine > FOLDED:
            return np.inf, sine
        sines[c] = sine
        worst = min(worst, sine)
    sharpness, weight = aim[0], aim[1]
    total = np.exp(sharpness * min(worst - aim[2], 2.0))
    for c in range(len(corners)):
        sines[c] = np.exp(sharpness * (worst - sines[c]))
        total += sines[c]
    value = np.log(total) / sharpness - worst
    share = weight / len(corners)
    for c in range(len(corners)):
        o, s, t = corners[c, 0], corners[c, 1], corners[c, 2]
        px, py = points[s, 0] - points[o, 0], points[s, 1] - points[o, 1]
        qx, qy = points[t, 0] - points[o, 0], points[t, 1] - points[o, 1]
        pp, qq, det = px * px + py * py, qx * qx + qy * qy, px * qy - py * qx
        value += share * 0.5 * (pp + qq) / det
        by_det = -share * 0.5 * (pp + qq) / (det * det)
        by_p = by_q = share / det
        pull = sines[c] / total
        if pull > 1e-12:
            lengths = np.sqrt(pp * qq)
            by_det -= pull / lengths
            sine = det / lengths
            by_p += pull * sine / pp
            by_q += pull * sine / qq
        gpx, gpy = by_p * px + by_det * qy, by_p * py - by_det * qx
        gqx, gqy = by_q * qx - by_det * py, by_q * qy + by_det * px
        _pull(problem, gradient, s, gpx, gpy)
        _pull(problem, gradient, t, gqx, gqy)
        _pull(problem, gradient, o, -gpx - gqx, -gpy - gqy)
    return value, worst


@kernel
def _ascend(problem, x, aim, unit, goal, iterations):
    """L-BFGS on :func:`soft_worst` over `x` in place, until the smallest sine is `goal`.

    Ends at the positions with the largest smallest sine if the aim has no level, else at the last
    ones. Returns the smallest sine there.
    """
    n = len(x)
    gradient, trial, slope = np.zeros(n), np.zeros(n), np.zeros(n)
    direction, best_x = np.zeros(n), x.copy()
    steps, changes = np.zeros((MEMORY, n)), np.zeros((MEMORY, n))
    rho, sines = np.zeros(MEMORY), np.zeros(len(problem.corners))
    count, newest = 0, -1
    value, worst = soft_worst(problem, x, gradient, sines, aim)
    best = worst
    for _ in range(iterations):
        if best >= goal or not value < np.inf:
            break
        _direction(gradient, steps, changes, rho, count, newest, direction)
        descent = np.dot(gradient, direction)
        if not descent < 0.0:
            break
        farthest = 0.0
        for c in range(n):
            farthest = max(farthest, abs(direction[c]))
        step = min(1.0, 0.5 * unit / farthest) if count else 0.05 * unit / farthest
        found, worst = np.inf, -1.0
        for _ in range(20):
            for c in range(n):
                trial[c] = x[c] + step * direction[c]
            found, worst = soft_worst(problem, trial, slope, sines, aim)
            if found <= value + SUFFICIENT * step * descent:
                break
            step *= 0.4
        if not found < value:
            break
        into = (newest + 1) % MEMORY
        for c in range(n):
            steps[into, c] = trial[c] - x[c]
            changes[into, c] = slope[c] - gradient[c]
        curvature = np.dot(steps[into], changes[into])
        if curvature > 1e-12 * np.dot(changes[into], changes[into]):
            newest = into
            rho[newest] = 1.0 / curvature
            count = min(count + 1, MEMORY)
        gain = value - found
        for c in range(n):
            x[c], gradient[c] = trial[c], slope[c]
        value = found
        if worst > best or aim[2] < NO_LEVEL:
            best = worst
            for c in range(n):
                best_x[c] = x[c]
        if gain <= PRECISION:
            break
    for c in range(n):
        x[c] = best_x[c]
    return best


@kernel
def climb(problem, x, unit, goal, iterations):
    """Raise the worst corner over `x` in place, from positions without folded corners.

    Ends early when the worst corner reaches `goal`. unit: the size of an element, which scales the
    first step; iterations: the most for each value of p. Returns the smallest sine, never below
    that of the start.
    """
    best = worst_sine(problem)
    aim = np.array([0.0, SHAPE_WEIGHT, NO_LEVEL])
    for stage in range(len(SHARPNESS)):
        if best >= goal:
            break
        aim[0] = SHARPNESS[stage]
        best = _ascend(problem, x, aim, unit, goal, iterations)
    place(problem, x)
    return best


@kernel
def even_out(problem, x, unit, iterations):
    """Better shapes for all elements over `x` in place, after :func:`climb`, at the cost of at most
    :data:`GIVEN` of the worst corner's sine, which is returned.
    """
    before = best = worst_sine(problem)
    kept = x.copy()
    aim = np.array([SHARPNESS[len(SHARPNESS) - 1], 0.0, before * (1.0 - 0.5 * GIVEN)])
    for stage in range(len(EVEN_WEIGHTS)):
        aim[1] = EVEN_WEIGHTS[stage]
        found = _ascend(problem, x, aim, unit, np.inf, iterations)
        if found < before * (1.0 - GIVEN):
            for c in range(len(x)):
                x[c] = kept[c]
            break
        best = found
        for c in range(len(x)):
            kept[c] = x[c]
    place(problem, x)
    return best
