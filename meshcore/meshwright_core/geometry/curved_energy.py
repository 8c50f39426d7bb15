"""The foldover-free energy of elements with curved sides, summed over samples of their Coons maps.

The derivatives p, q of the map at a sample are linear in the element's corners and in d and d' of
its sides (:mod:`meshwright_core.geometry.coons`), so the energy of straight corners applies to them
as it is, and its gradient goes back through the same coefficients. Here d' is a difference of
fourth order of d at multiples of 1/8 of the side: no second derivatives of curves are needed, the
energy stays continuous where vertices slide over kinks of polylines, and on arcs of up to 90
degrees p and q differ by less than 0.02 degrees from the exact ones.

A side moves with the parameters of its ends: with t_j = t_a + w_j (t_b - t_a) the point at w_j
moves by (1 - w_j) of the tangent there as t_a increases, and by w_j of it as t_b does.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.core.composite_curves import place_on
from meshwright_core.geometry.coons import NODES

SLIGHT = np.radians(30.0)
"""Turning of sides up to which an element's energy is that of its corners alone."""


def _differences() -> np.ndarray:
    """(NODES, NODES) matrix of the derivative by w at multiples of 1/8: central differences of
    fourth order where there is room, else those of five points that are nearest.
    """
    last, matrix = NODES - 1, np.zeros((NODES, NODES))
    for i in range(NODES):
        first = min(max(i - 2, 0), last - 4)
        x = np.arange(first, first + 5) - i
        # weights that differentiate 1, x, ..., x^4 exactly
        powers = np.vander(x.astype(np.float64), 5, increasing=True).T
        matrix[i, first : first + 5] = last * np.linalg.solve(powers, [0.0, 1.0, 0.0, 0.0, 0.0])
    return matrix


DIFFERENCES = _differences()


@kernel
def corner_energy(shape, scale, eps, weight, px, py, qx, qy):
    """Energy and determinant of a corner with sides p, q, and the derivatives by px, py, qx, qy.

    `shape` (3,) and `scale` as in :class:`meshwright_core.geometry.foldover_energy.Problem`.
    """
    alpha, beta, delta = shape[0], shape[1], shape[2]
    trace = scale * (alpha * (px * px + py * py + qx * qx + qy * qy) - beta * (px * qx + py * qy))
    det = scale * delta * (px * qy - py * qx)
    root = np.sqrt(eps * eps + det * det)
    # the second form has no cancellation where det is negative
    chi = 0.5 * (det + root) if det > 0.0 else 0.5 * eps * eps / (root - det)
    numerator = trace + weight * (det * det + 1.0)
    by_trace = scale / chi
    by_det = scale * delta * (2.0 * weight * det - numerator / root) / chi
    return (
        numerator / chi,
        det,
        by_trace * (2.0 * alpha * px - beta * qx) + by_det * qy,
        by_trace * (2.0 * alpha * py - beta * qy) - by_det * qx,
        by_trace * (2.0 * alpha * qx - beta * px) - by_det * py,
        by_trace * (2.0 * alpha * qy - beta * py) + by_det * px,
    )


@kernel
def flat_place(problem, curve, t, flat, place, slope):
    """Write the point of a curve at t in the problem's plane and units, flat[0], and its derivative
    by the variable t / unit, flat[1]; `place` and `slope` (3,) are scratch.
    """
    place_on(problem.curves, curve, t, place, slope)
    for x in range(2):
        point = tangent = 0.0
        for y in range(3):
            point += problem.axes[x, y] * place[y]
            tangent += problem.axes[x, y] * slope[y]
        flat[0, x] = (point - problem.centre[x]) / problem.unit[0]
        flat[1, x] = tangent


@kernel
def _place_side(problem, c, i, d, slope, tangent):
    """Write d, d' and the tangents by t / unit, (NODES, 2) each, of side i of curved element c."""
    curved, points = problem.curved, problem.points
    e, r, k = curved.element[c], curved.sides[c, i], curved.elements.shape[1]
    a, b = curved.elements[e, i], curved.elements[e, (i + 1) % k]
    start = curved.base[r, 0] + curved.parameter[a]
    stop = curved.base[r, 1] + curved.parameter[b]
    flat, off, place, rise = np.zeros((2, 2)), np.zeros((2, 2)), np.zeros(3), np.zeros(3)
    for end in range(2):
        flat_place(problem, curved.curve[r], stop if end else start, flat, place, rise)
        for x in range(2):
            off[end, x] = points[b if end else a, x] - flat[0, x]
    for j in range(NODES):
        w = j / (NODES - 1.0)
        flat_place(problem, curved.curve[r], start + w * (stop - start), flat, place, rise)
        for x in range(2):
            chord = (1.0 - w) * points[a, x] + w * points[b, x]
            inside = 0 < j < NODES - 1
            d[j, x] = flat[0, x] + (1.0 - w) * off[0, x] + w * off[1, x] - chord if inside else 0.0
            tangent[j, x] = flat[1, x]
    for j in range(NODES):
        for x in range(2):
            slope[j, x] = 0.0
            for n in range(NODES):
                slope[j, x] += problem.differences[j, n] * d[n, x]


@kernel
def curved_energy(problem, gradient, eps, weight):
    """Energy and smallest determinant of the curved elements; adds to `gradient`."""
    curved, samples, points = problem.curved, problem.curved.samples, problem.points
    k = curved.elements.shape[1]
    d, slope, tangent = np.zeros((4, NODES, 2)), np.zeros((4, NODES, 2)), np.zeros((4, NODES, 2))
    by_d, by_slope, by_corner = np.zeros((4, NODES, 2)), np.zeros((4, NODES, 2)), np.zeros((4, 2))
    p, q = np.zeros(2), np.zeros(2)
    total, smallest = 0.0, np.inf
    for c in range(len(curved.element)):
        if not problem.active[c]:
            continue
        e = curved.element[c]
        count = len(samples.nearest)
        share = (1.0 if k == 3 else 4.0) / count
        if problem.slight[c]:
            count, share = k, 1.0 if k == 4 else 1.0 / 3.0
        for i in range(k):
            if curved.sides[c, i] >= 0:
                _place_side(problem, c, i, d[i], slope[i], tangent[i])
        by_d[:] = 0.0
        by_slope[:] = 0.0
        by_corner[:] = 0.0
        for number in range(count):
            s = samples.at_corner[number] if problem.slight[c] else number
            if problem.dropped[c, samples.nearest[s]]:
                continue
            for x in range(2):
                p[x] = q[x] = 0.0
                for i in range(k):
                    at = points[curved.elements[e, i], x]
                    p[x] += samples.corners[s, i, 0] * at
                    q[x] += samples.corners[s, i, 1] * at
                    if curved.sides[c, i] >= 0:
                        j, factor = samples.node[s, i], samples.sides[s, i]
                        p[x] += factor[0] * d[i, j, x] + factor[1] * slope[i, j, x]
                        q[x] += factor[2] * d[i, j, x] + factor[3] * slope[i, j, x]
            value, det, gpx, gpy, gqx, gqy = corner_energy(
                problem.shape, problem.curved_scale[c], eps, weight, p[0], p[1], q[0], q[1]
            )
            total += share * value
            smallest = min(smallest, det)
            for x in range(2):
                gp, gq = share * (gpy if x else gpx), share * (gqy if x else gqx)
                for i in range(k):
                    by_corner[i, x] += samples.corners[s, i, 0] * gp + samples.corners[s, i, 1] * gq
                    if curved.sides[c, i] >= 0:
                        j, factor = samples.node[s, i], samples.sides[s, i]
                        by_d[i, j, x] += factor[0] * gp + factor[2] * gq
                        by_slope[i, j, x] += factor[1] * gp + factor[3] * gq
        for i in range(k):
            if curved.sides[c, i] >= 0:
                _pull_side(problem, gradient, c, i, by_d[i], by_slope[i], tangent[i], by_corner)
        for i in range(k):
            pull(problem, gradient, curved.elements[e, i], by_corner[i, 0], by_corner[i, 1])
    return total, smallest


@kernel
def _pull_side(problem, gradient, c, i, by_d, by_slope, tangent, by_corner):
    """Add the derivatives by d and d' of a side to those by its ends and by their parameters."""
    curved = problem.curved
    e, k = curved.element[c], curved.elements.shape[1]
    after = (i + 1) % k
    a, b = problem.variable[curved.elements[e, i]], problem.variable[curved.elements[e, after]]
    for j in range(1, NODES - 1):
        w = j / (NODES - 1.0)
        for x in range(2):
            total = by_d[j, x]
            for n in range(NODES):
                total += problem.differences[n, j] * by_slope[n, x]
            by_corner[i, x] -= (1.0 - w) * total
            by_corner[after, x] -= w * total
            if a >= 0:
                drift = problem.drift[curved.elements[e, i], x]
                gradient[a] += (1.0 - w) * total * (tangent[j, x] + drift)
            if b >= 0:
                drift = problem.drift[curved.elements[e, after], x]
                gradient[b] += w * total * (tangent[j, x] + drift)


@kernel
def pull(problem, gradient, v, gx, gy):
    """Add the derivative (gx, gy) by the position of v to that by its variables."""
    i = problem.variable[v]
    if i < 0:
        return
    if problem.seat[v] < 0:
        gradient[i] += gx
        gradient[i + 1] += gy
    else:
        gradient[i] += gx * problem.tangent[v, 0] + gy * problem.tangent[v, 1]
