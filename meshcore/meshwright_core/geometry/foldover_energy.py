"""The foldover-free energy of a plane mesh and its minimiser, compiled.

Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov: "Foldover-free maps in 50 lines of code",
ACM Transactions on Graphics 40 (4), 2021. Every corner of an element gives a map from its ideal
corner (a square's, an equilateral triangle's) to the plane, with Jacobian J. Its energy

    f = (tr J'J + lambda (det J^2 + 1)) / chi(eps, det J),   chi = (det + sqrt(eps^2 + det^2)) / 2

is finite for folded corners as long as eps > 0; as eps falls to zero it turns into a barrier that
no corner crosses. Of elements with curved sides samples of their Coons maps take the place of
corners (:mod:`meshwright_core.geometry.curved_energy`). Vertices inside have two variables; those
that slide along a side have one, the parameter on its curve. The gaps between neighbours on a side
carry a barrier of their own, so that the order along a side holds at every step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.core.composite_curves import Curves
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.coons import CurvedElements
from meshwright_core.geometry.curved_energy import (
    corner_energy,
    curved_energy,
    flat_place,
    pull,
)

MEMORY = 10
"""Pairs that L-BFGS keeps."""
SUFFICIENT, CURVATURE = 1e-4, 0.9
"""Constants of the weak Wolfe conditions."""
SHARPEST = 1e-9
"""The smallest regularisation, at which the energy acts as a barrier."""
GAP_WEIGHT = 0.01
"""Weight of the gap barrier: enough to keep the order, too little to shape the mesh."""


@by_reference
class Problem(NamedTuple):
    """A mesh to untangle, in units of its mean element size."""

    points: np.ndarray
    """(n, 2) positions, written when variables are placed."""
    tangent: np.ndarray
    """(n, 2) derivatives of the positions of sliding vertices, written likewise."""
    variable: np.ndarray
    """(n,) a vertex's first variable, -1 when it stays. Those of sliding vertices are their
    parameters, divided by the unit."""
    seat: np.ndarray
    """(n,) the curve that a vertex slides on, -1 for none."""
    offset: np.ndarray
    """(n, 2) how far a sliding vertex would lie off its curve at parameter 0."""
    drift: np.ndarray
    """(n, 2) the change of that by its variable."""
    curves: Curves
    """In the coordinates of the mesh."""
    axes: np.ndarray
    """(2, 3) directions of the plane."""
    centre: np.ndarray
    """(2,) the origin in the plane."""
    unit: np.ndarray
    """(1,) unit of length."""
    corners: np.ndarray
    """(c, 3) the vertex of each straight corner, the next one and the previous one."""
    scale: np.ndarray
    """(c,) one over the squared target size of the corner's element."""
    shape: np.ndarray
    """(3,) alpha, beta, delta: tr J'J = alpha (|p|^2 + |q|^2) - beta p.q, det J = delta p x q."""
    gaps: np.ndarray
    """(g, 2) variables of neighbours on a side, -1 for one that stays."""
    offsets: np.ndarray
    """(g,) what the gap has besides the difference of its variables."""
    gap_scale: np.ndarray
    """(g,) one over the target of the gap."""
    curved: CurvedElements
    """The elements with curved sides; its parameters are written when variables are placed."""
    curved_scale: np.ndarray
    """(c,) as `scale`, by curved element."""
    active: np.ndarray
    """(c,) bool: curved elements that something moves."""
    slight: np.ndarray
    """(c,) bool: those whose sides turn so little that their corners alone are looked at."""
    dropped: np.ndarray
    """(c, k) bool: corners whose samples are left out."""
    differences: np.ndarray
    """(NODES, NODES) derivative by the place on a side."""


@kernel
def place(problem, x):
    """Write the positions that the variables `x` stand for."""
    flat, point, slope = np.zeros((2, 2)), np.zeros(3), np.zeros(3)
    for v in range(len(problem.variable)):
        i = problem.variable[v]
        if i < 0:
            continue
        if problem.seat[v] < 0:
            problem.points[v, 0] = x[i]
            problem.points[v, 1] = x[i + 1]
        else:
            t = x[i] * problem.unit[0]
            problem.curved.parameter[v] = t
            flat_place(problem, problem.seat[v], t, flat, point, slope)
            for c in range(2):
                drift = problem.drift[v, c]
                problem.points[v, c] = flat[0, c] + problem.offset[v, c] + x[i] * drift
                problem.tangent[v, c] = flat[1, c] + drift


@kernel
def energy(problem, x, gradient, eps, weight):
    """Energy, smallest determinant; `gradient` is overwritten. Infinite where a gap closes."""
    place(problem, x)
    for i in range(len(gradient)):
        gradient[i] = 0.0
    total = 0.0
    for i in range(len(problem.gaps)):
        a, b = problem.gaps[i, 0], problem.gaps[i, 1]
        gap = problem.offsets[i]
        if a >= 0:
            gap -= x[a]
        if b >= 0:
            gap += x[b]
        gap *= problem.gap_scale[i]
        if not gap > 0.0:
            return np.inf, -np.inf
        total += GAP_WEIGHT / gap
        slope = GAP_WEIGHT / (gap * gap) * problem.gap_scale[i]
        if a >= 0:
            gradient[a] += slope
        if b >= 0:
            gradient[b] -= slope
    smallest = np.inf
    points = problem.points
    for c in range(len(problem.corners)):
        o, s, t = problem.corners[c, 0], problem.corners[c, 1], problem.corners[c, 2]
        px, py = points[s, 0] - points[o, 0], points[s, 1] - points[o, 1]
        qx, qy = points[t, 0] - points[o, 0], points[t, 1] - points[o, 1]
        value, det, gpx, gpy, gqx, gqy = corner_energy(
            problem.shape, problem.scale[c], eps, weight, px, py, qx, qy
        )
        total += value
        smallest = min(smallest, det)
        pull(problem, gradient, s, gpx, gpy)
        pull(problem, gradient, t, gqx, gqy)
        pull(problem, gradient, o, -gpx - gqx, -gpy - gqy)
    if len(problem.curved.element):
        more, least = curved_energy(problem, gradient, eps, weight)
        total += more
        smallest = min(smallest, least)
    return total, smallest


@kernel
def _direction(gradient, steps, changes, rho, count, newest, direction):
    """Two-loop recursion of L-BFGS: `direction` = -H gradient."""
    # loops in place of whole-array expressions, which take numba a second each to compile
    memory, n = len(steps), len(direction)
    alphas = np.zeros(memory)
    for c in range(n):
        direction[c] = -gradient[c]
    for j in range(count):
        i = (newest - j) % memory
        alphas[i] = rho[i] * np.dot(steps[i], direction)
        for c in range(n):
            direction[c] -= alphas[i] * changes[i, c]
    if count:
        scale = 1.0 / (rho[newest] * np.dot(changes[newest], changes[newest]))
        for c in range(n):
            direction[c] *= scale
    for j in range(count - 1, -1, -1):
        i = (newest - j) % memory
        share = alphas[i] - rho[i] * np.dot(changes[i], direction)
        for c in range(n):
            direction[c] += share * steps[i, c]


@kernel
def descend(problem, x, eps, weight, iterations, precision):
    """Minimise over `x` in place by L-BFGS at a fixed `eps`.

    The line search is Lewis and Overton's bisection for the weak Wolfe conditions, which
    converges on functions with kinks, as sides that are polylines give. Ends after `iterations`
    steps or when one gains less than `precision` of the energy. Returns energy, smallest
    determinant and evaluations.
    """
    n = len(x)
    gradient, trial, slope = np.zeros(n), np.zeros(n), np.zeros(n)
    direction = np.zeros(n)
    steps, changes = np.zeros((MEMORY, n)), np.zeros((MEMORY, n))
    rho = np.zeros(MEMORY)
    count, newest, evaluations = 0, -1, 1
    value, smallest = energy(problem, x, gradient, eps, weight)
    for _ in range(iterations):
        _direction(gradient, steps, changes, rho, count, newest, direction)
        descent = np.dot(gradient, direction)
        if not descent < 0.0:
            break
        # without curvature a first step moves no vertex by more than a tenth of an element
        farthest = 0.0
        for c in range(n):
            farthest = max(farthest, abs(direction[c]))
        step = 1.0 if count else 0.1 / (1e-300 + farthest)
        low, high = 0.0, np.inf
        found, found_smallest = np.inf, -np.inf
        for _ in range(40):
            for c in range(n):
                trial[c] = x[c] + step * direction[c]
            found, found_smallest = energy(problem, trial, slope, eps, weight)
            evaluations += 1
            if not found <= value + SUFFICIENT * step * descent:
                high = step
            elif np.dot(slope, direction) < CURVATURE * descent:
                low = step
            else:
                break
            step = 0.5 * (low + high) if high < np.inf else 2.0 * step
        if not found < value:
            break
        newest = (newest + 1) % MEMORY
        for c in range(n):
            steps[newest, c] = trial[c] - x[c]
            changes[newest, c] = slope[c] - gradient[c]
        curvature = np.dot(steps[newest], changes[newest])
        if curvature > 1e-14 * np.dot(changes[newest], changes[newest]):
            rho[newest] = 1.0 / curvature
            count = min(count + 1, MEMORY)
        else:
            count, newest = 0, -1
        gain = value - found
        for c in range(n):
            x[c], gradient[c] = trial[c], slope[c]
        value, smallest = found, found_smallest
        if gain <= precision * value:
            break
    return value, smallest, evaluations


@kernel
def chi(eps, det):
    """The regularised determinant, positive: tends to max(det, 0) as eps tends to 0."""
    root = np.sqrt(eps * eps + det * det)
    return 0.5 * (det + root) if det > 0.0 else 0.5 * eps * eps / (root - det)


@kernel
def unfold(problem, x, weight, rounds, inner, polish, polish_weight):
    """Untangle over `x` in place; then `polish` steps for shape if no corner is left folded.

    The regularisation falls by the rule of the paper (section 3.1, its algorithm 1), which makes
    the smallest determinant positive after finitely many rounds if each round lowers the energy
    enough. Returns the smallest determinant and the number of energy evaluations.
    """
    gradient = np.zeros(len(x))
    value, smallest = energy(problem, x, gradient, 1.0, weight)
    evaluations = 1
    eps = 1.0 if smallest <= 1e-3 else SHARPEST
    for _ in range(rounds):
        if eps <= SHARPEST:
            break
        before, _ = energy(problem, x, gradient, eps, weight)
        value, smallest, used = descend(problem, x, eps, weight, inner, 1e-5)
        evaluations += used + 1
        sigma = max(1.0 - value / before, 0.1)
        goal = (1.0 - sigma) * chi(eps, smallest)
        eps = 2.0 * np.sqrt(goal * (goal - smallest)) if smallest < goal else SHARPEST
        eps = max(eps, SHARPEST)
    if smallest > 0.0:
        value, smallest, used = descend(problem, x, SHARPEST, polish_weight, polish, 1e-6)
        evaluations += used
    place(problem, x)
    return smallest, evaluations
