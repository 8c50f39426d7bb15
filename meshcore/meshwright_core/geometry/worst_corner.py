"""Max-min positions: raising the smallest corner sine of a plane quad mesh, compiled.

A corner is described by the directions of its two sides and the lengths of their chords. The
direction is that of the chord where the side is straight, and the tangent of the curve where it
bends. Elements with sides that bend have some samples besides
(:mod:`meshwright_core.geometry.bent_elements`), which count like corners. With the sine s and the
lengths P and Q of a corner, three functions are minimised by L-BFGS:

- to unfold, the foldover-free energy of Garanzha et al. (2021, see
  :mod:`meshwright_core.geometry.foldover_energy`) of det = P Q s and trace = P^2 + Q^2;
- to raise the worst corner, the soft minimum of all sines

      f = (1 / p) log sum exp(-p s) + w mean((P^2 + Q^2) / (2 P Q s))

  for growing p. The first term tends to minus the smallest sine; the second, small one is the mean
  of one over the corners' shapes: it is infinite for a folded corner, so that no step inverts an
  element, and keeps elements from shrinking, which a sine does not see. Sines are weighed by
  :func:`meshwright_core.geometry.element_sines.thinness` here;
- for the other elements, the same with sines beyond a level left out, and a larger w.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.composite_curves import Curves, curve_length, place_on
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.bent_elements import (
    BentElements,
    bent_sine,
    place_bent,
    pull_bent,
    set_pull,
)
from meshwright_core.geometry.element_sines import THIN, thinness
from meshwright_core.geometry.foldover_energy import (
    GAP_WEIGHT,
    MEMORY,
    SHARPEST,
    SUFFICIENT,
    _direction,
    chi,
)

SHARPNESS = (16.0, 64.0, 256.0)
"""Values of p, one after the other: the last one sees little but the worst corner."""
SHAPE_WEIGHT = 0.002
"""Weight w of the mean of one over the shapes."""
NO_LEVEL = 1e3
"""Level beyond which sines do not count, where all count."""
EVEN_WEIGHTS, GIVEN = (0.005, 0.02, 0.08), 0.02
"""Weights w once the worst corner is as good as it gets, and the share of its sine that may be
given for better shapes."""
TURN_WEIGHT = 0.5
"""Weight of the price on edges that turn by more than a radian."""
PRECISION = 1e-5
"""Gain of a step below which the ascent ends."""
FOLDED = 1e-6
"""Sine up to which a corner counts as folded here: far from 0 in the arithmetic that follows."""
UNFOLDING, SHAPING = 1.0, 0.1
"""Weights of equal areas in the foldover-free energy before and after the last corner unfolds."""
_STEP = 1e-5
"""Step of the differences of tangents, relative to the length of the curve."""
_TINY = 1e-150

# how the direction of a corner's side is found
CHORD, HELD, SLIDING = 0, 1, 2


@by_reference
class LayoutProblem(NamedTuple):
    """The variables and corners of a quad layout in the plane z = 0; n vertices, c corners."""

    points: np.ndarray
    """(n, 3) positions, written when variables are placed."""
    slope: np.ndarray
    """(n, 3) derivatives of the positions of sliding vertices by their parameters."""
    tangent: np.ndarray
    """(n, 4) unit tangents of their curves, and the derivatives of these."""
    variable: np.ndarray
    """(n,) a vertex's first variable, -1 when it stays."""
    seat: np.ndarray
    """(n,) the curve that a vertex slides on, -1 for none."""
    bends: np.ndarray
    """(n,) bool: whether a side at a sliding vertex bends."""
    corners: np.ndarray
    """(c, 3) the vertex of each corner, the next one and the previous one of its element."""
    kind: np.ndarray
    """(c, 2) CHORD, HELD or SLIDING, of the side to the next vertex and to the previous one."""
    ways: np.ndarray
    """(c, 4) the directions of both sides where HELD; where SLIDING 1 or -1 at [0] or [2], whether
    the side goes along its curve."""
    gaps: np.ndarray
    """(g, 3) variables of neighbours on a curve, -1 for one that stays, and the curve."""
    offsets: np.ndarray
    """(g, 3) what the gap has besides the difference of its variables; one over its target; the
    turning of its curve by length."""
    size: np.ndarray
    """(1,) the mean size of an element."""
    scale: np.ndarray
    """(c,) one over the area that the corner's element should have while it is unfolded."""
    bent: BentElements
    """Those with samples of their own besides the corners."""
    curves: Curves


@kernel
def place_layout(problem, x):
    """Write the positions that the variables `x` stand for, and tangents of bending sides."""
    other, ahead, back = np.zeros(3), np.zeros(3), np.zeros(3)
    for v in range(len(problem.variable)):
        i = problem.variable[v]
        if i < 0:
            continue
        if problem.seat[v] < 0:
            problem.points[v, 0], problem.points[v, 1] = x[i], x[i + 1]
            continue
        curve = problem.seat[v]
        place_on(problem.curves, curve, x[i], problem.points[v], problem.slope[v])
        if not problem.bends[v]:
            continue
        step = _STEP * curve_length(problem.curves, curve)
        place_on(problem.curves, curve, x[i] + step, other, ahead)
        place_on(problem.curves, curve, x[i] - step, other, back)
        here, there = np.hypot(ahead[0], ahead[1]), np.hypot(back[0], back[1])
        size = np.hypot(problem.slope[v, 0], problem.slope[v, 1])
        for c in range(2):
            problem.tangent[v, c] = problem.slope[v, c] / size
            problem.tangent[v, c + 2] = (ahead[c] / here - back[c] / there) / (2.0 * step)
    place_bent(problem.bent, problem.curves, problem.points, x)


@bare_kernel
def _side(problem, c, which):
    """Direction and chord length of a side of corner c: 0 to the next vertex, 1 to the previous."""
    points = problem.points
    o, s = problem.corners[c, 0], problem.corners[c, 1 + which]
    dx, dy = points[s, 0] - points[o, 0], points[s, 1] - points[o, 1]
    length = max(np.sqrt(dx * dx + dy * dy), _TINY)
    kind = problem.kind[c, which]
    if kind == CHORD:
        return dx / length, dy / length, length
    if kind == HELD:
        return problem.ways[c, 2 * which], problem.ways[c, 2 * which + 1], length
    way = problem.ways[c, 2 * which]
    return way * problem.tangent[o, 0], way * problem.tangent[o, 1], length


@bare_kernel
def _pull(problem, gradient, v, gx, gy):
    """Add the derivative (gx, gy) by the position of v to that by its variables."""
    i = problem.variable[v]
    if i < 0:
        return
    if problem.seat[v] < 0:
        gradient[i] += gx
        gradient[i + 1] += gy
    else:
        gradient[i] += gx * problem.slope[v, 0] + gy * problem.slope[v, 1]


@bare_kernel
def _pull_side(problem, gradient, c, which, by_length, by_way_x, by_way_y):
    """Add the derivatives by the length and the direction of a side to those by the variables."""
    points = problem.points
    o, s = problem.corners[c, 0], problem.corners[c, 1 + which]
    dx, dy = points[s, 0] - points[o, 0], points[s, 1] - points[o, 1]
    length = max(np.sqrt(dx * dx + dy * dy), _TINY)
    ux, uy = dx / length, dy / length
    gx, gy = by_length * ux, by_length * uy
    kind = problem.kind[c, which]
    if kind == CHORD:
        # the direction changes across itself only
        along = by_way_x * ux + by_way_y * uy
        gx += (by_way_x - along * ux) / length
        gy += (by_way_y - along * uy) / length
    elif kind == SLIDING and problem.variable[o] >= 0:
        way = problem.ways[c, 2 * which]
        gradient[problem.variable[o]] += way * (
            by_way_x * problem.tangent[o, 2] + by_way_y * problem.tangent[o, 3]
        )
    _pull(problem, gradient, s, gx, gy)
    _pull(problem, gradient, o, -gx, -gy)


@kernel
def terms(problem):
    """How many sines there are, of corners and of samples."""
    return len(problem.corners) + problem.bent.used[0] * len(problem.bent.vertices)


@bare_kernel
def _term(problem, c):
    """The sine of term c, first those at corners, then those at samples, and the lengths P, Q."""
    corners, used = len(problem.corners), problem.bent.used[0]
    if c >= corners:
        return bent_sine(problem.bent, (c - corners) // used, (c - corners) % used)
    px, py, p = _side(problem, c, 0)
    qx, qy, q = _side(problem, c, 1)
    return px * qy - py * qx, p, q


@kernel
def worst_sine(problem):
    """The smallest weighed sine at the present points, of corners and of samples of bent elements;
    1 if there are none.
    """
    worst = 1.0
    for c in range(terms(problem)):
        sine, p, q = _term(problem, c)
        worst = min(worst, thinness(p, q) * sine)
    return worst


@bare_kernel
def _pull_samples(problem, x, gradient):
    """Add what the pulls of bent elements come to."""
    bent = problem.bent
    pull_bent(bent, x, gradient)
    for b in range(len(bent.vertices)):
        for i in range(4):
            _pull(
                problem, gradient, bent.vertices[b, i], bent.by_corner[b, i, 0],
                bent.by_corner[b, i, 1],
            )  # fmt: skip


@kernel
def _gap_energy(problem, x, gradient, weight):
    """Barrier between neighbours on curves, infinite where a gap closes, and a price on edges that
    turn far.
    """
    total = 0.0
    for i in range(len(problem.gaps)):
        a, b = problem.gaps[i, 0], problem.gaps[i, 1]
        gap = problem.offsets[i, 0]
        if a >= 0:
            gap -= x[a]
        if b >= 0:
            gap += x[b]
        gap *= problem.offsets[i, 1]
        if not gap > 0.0:
            return np.inf
        total += weight / gap
        slope = weight / (gap * gap) * problem.offsets[i, 1]
        far = 0.5 * gap / problem.offsets[i, 1] * problem.offsets[i, 2]
        if far > 0.5:
            price = TURN_WEIGHT * (far - 0.5) ** 3
            total += price
            slope -= 3.0 * price / (far - 0.5) * 0.5 * problem.offsets[i, 2]
        if a >= 0:
            gradient[a] += slope
        if b >= 0:
            gradient[b] -= slope
    return total


@kernel
def _back(problem, gradient, c, by_p, by_q, by_sine):
    """Add the derivatives by P, Q and the sine of corner c to those by the variables."""
    px, py, _ = _side(problem, c, 0)
    qx, qy, _ = _side(problem, c, 1)
    _pull_side(problem, gradient, c, 0, by_p, by_sine * qy, -by_sine * qx)
    _pull_side(problem, gradient, c, 1, by_q, -by_sine * py, by_sine * px)


@kernel
def _soft_worst(problem, x, gradient, sines, aim):
    """The objective f of the positions, see the module; infinite where a corner folds."""
    corners, bent, used = len(problem.corners), problem.bent, problem.bent.used[0]
    worst, count = 1.0, len(sines)
    for c in range(count):
        sine, p, q = _term(problem, c)
        sines[c] = thinness(p, q) * sine
        if not sines[c] > FOLDED:
            return np.inf, sines[c]
        worst = min(worst, sines[c])
    sharpness, weight = aim[0], aim[1]
    total = np.exp(sharpness * min(worst - aim[2], 2.0))
    for c in range(count):
        total += np.exp(sharpness * (worst - sines[c]))
    value = np.log(total) / sharpness - worst
    share = 0.5 * weight / count
    for c in range(count):
        sine, p, q = _term(problem, c)
        ratio = p / q
        shape = ratio + 1.0 / ratio
        value += share * shape / sine
        by_weighed = -np.exp(sharpness * (worst - sines[c])) / total
        by_sine = -share * shape / (sine * sine)
        by_shape = share / sine
        if shape > 2.0 * THIN:
            by_sine += by_weighed * 2.0 * THIN / shape
            by_shape -= by_weighed * sines[c] / shape
        else:
            by_sine += by_weighed
        by_ratio = by_shape * (1.0 - 1.0 / (ratio * ratio))
        if c < corners:
            _back(problem, gradient, c, by_ratio / q, -by_ratio * ratio / q, by_sine)
        else:
            set_pull(
                bent, (c - corners) // used, (c - corners) % used, by_ratio / q,
                -by_ratio * ratio / q, by_sine,
            )  # fmt: skip
    _pull_samples(problem, x, gradient)
    return value, worst


@kernel
def _foldover(problem, x, gradient, aim):
    """The foldover-free energy of the positions; aim: [3] epsilon, [1] the weight lambda."""
    eps, weight = aim[3], aim[1]
    corners, bent, used = len(problem.corners), problem.bent, problem.bent.used[0]
    total, smallest = 0.0, np.inf
    for c in range(terms(problem)):
        b, s = (c - corners) // used, (c - corners) % used
        sine, p, q = _term(problem, c)
        scale = problem.scale[c] if c < corners else bent.scale[b]
        det, trace = scale * p * q * sine, scale * (p * p + q * q)
        smallest = min(smallest, det)
        root = np.sqrt(eps * eps + det * det)
        regular = chi(eps, det)
        numerator = trace + weight * (det * det + 1.0)
        total += numerator / regular
        by_det = (2.0 * weight * det - numerator / root) / regular * scale
        by_trace = 2.0 * scale / regular
        by_p, by_q = by_trace * p + by_det * q * sine, by_trace * q + by_det * p * sine
        if c < corners:
            _back(problem, gradient, c, by_p, by_q, by_det * p * q)
        else:
            set_pull(bent, b, s, by_p, by_q, by_det * p * q)
    _pull_samples(problem, x, gradient)
    return total, smallest


@kernel
def _objective(problem, x, gradient, sines, aim):
    """Value, and the smallest sine or, where aim[3] > 0, determinant; `gradient` is overwritten."""
    place_layout(problem, x)
    for i in range(len(gradient)):
        gradient[i] = 0.0
    barrier = _gap_energy(problem, x, gradient, GAP_WEIGHT if aim[3] > 0.0 else 1e-2 * aim[1])
    if not barrier < np.inf:
        return np.inf, -np.inf
    if aim[3] > 0.0:
        value, smallest = _foldover(problem, x, gradient, aim)
        return value + barrier, smallest
    value, smallest = _soft_worst(problem, x, gradient, sines, aim)
    return value + barrier, smallest


@kernel
def minimise(problem, x, aim, goal, iterations):
    """L-BFGS on one of the functions over `x` in place, until the smallest sine is `goal`.

    aim: p, w, level, epsilon; epsilon > 0 chooses the foldover-free energy. Without level and
    epsilon it ends at the positions with the largest smallest sine, else at the last ones. Returns
    the value at the end, and the smallest sine or determinant.
    """
    n, unit = len(x), problem.size[0]
    gradient, trial, slope = np.zeros(n), np.zeros(n), np.zeros(n)
    direction, best_x = np.zeros(n), x.copy()
    steps, changes = np.zeros((MEMORY, n)), np.zeros((MEMORY, n))
    rho, sines = np.zeros(MEMORY), np.zeros(terms(problem))
    count, newest = 0, -1
    keeps_best = aim[3] <= 0.0 and aim[2] >= NO_LEVEL
    value, best = _objective(problem, x, gradient, sines, aim)
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
            found, worst = _objective(problem, trial, slope, sines, aim)
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
        if worst > best or not keeps_best:
            best = worst
            for c in range(n):
                best_x[c] = x[c]
        if gain <= PRECISION * max(1.0, abs(value)):
            break
    for c in range(n):
        x[c] = best_x[c]
    return value, best


@kernel
def unfold_layout(problem, x, rounds, inner, polish):
    """Untangle over `x` in place by the foldover-free energy; then `polish` steps for shape.

    The regularisation falls by the rule of the paper (section 3.1). Returns the smallest sine.
    """
    aim = np.array([0.0, UNFOLDING, NO_LEVEL, 1.0])
    gradient, sines = np.zeros(len(x)), np.zeros(terms(problem))
    _, smallest = _objective(problem, x, gradient, sines, aim)
    # the less is folded the sharper it begins, so that what is valid stays so
    aim[3] = SHARPEST if smallest > 1e-3 else min(1.0, 0.01 - 4.0 * min(smallest, 0.0))
    value, smallest = _objective(problem, x, gradient, sines, aim)
    for _ in range(rounds):
        if aim[3] <= SHARPEST or not value < np.inf:
            break
        before, _ = _objective(problem, x, gradient, sines, aim)
        value, smallest = minimise(problem, x, aim, np.inf, inner)
        sigma = max(1.0 - value / before, 0.1)
        goal = (1.0 - sigma) * chi(aim[3], smallest)
        aim[3] = 2.0 * np.sqrt(goal * (goal - smallest)) if smallest < goal else SHARPEST
        aim[3] = max(aim[3], SHARPEST)
    if smallest > 0.0:
        aim[1], aim[3] = SHAPING, SHARPEST
        minimise(problem, x, aim, np.inf, polish)
    place_layout(problem, x)
    return worst_sine(problem)


@kernel
def climb(problem, x, goal, iterations):
    """Raise the worst corner over `x` in place, from positions without folded corners.

    Ends early when the worst corner reaches `goal`. iterations: the most for each value of p.
    Returns the smallest sine, never below that of the start.
    """
    best = worst_sine(problem)
    aim = np.array([0.0, SHAPE_WEIGHT, NO_LEVEL, 0.0])
    for stage in range(len(SHARPNESS)):
        if best >= goal:
            break
        aim[0] = SHARPNESS[stage]
        _, best = minimise(problem, x, aim, goal, iterations)
    place_layout(problem, x)
    return best


@kernel
def even_out(problem, x, iterations):
    """Better shapes for all elements over `x` in place, after :func:`climb`, at the cost of at most
    :data:`GIVEN` of the worst corner's sine, which is returned.
    """
    before = best = worst_sine(problem)
    kept = x.copy()
    level = before * (1.0 - 0.5 * GIVEN)
    aim = np.array([SHARPNESS[len(SHARPNESS) - 1], 0.0, level, 0.0])
    for stage in range(len(EVEN_WEIGHTS)):
        aim[1] = EVEN_WEIGHTS[stage]
        _, found = minimise(problem, x, aim, np.inf, iterations)
        if found < before * (1.0 - GIVEN):
            for c in range(len(x)):
                x[c] = kept[c]
            break
        best = found
        for c in range(len(x)):
            kept[c] = x[c]
    place_layout(problem, x)
    return best
