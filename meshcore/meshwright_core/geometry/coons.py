"""Elements with curved sides: their Coons maps, measured on a grid of samples.

A quad with sides E_0 ... E_3 is the image of the unit square under the transfinite map that agrees
with its sides (Coons 1967; Gordon and Hall 1973). With d_i = E_i - chord_i and the corners V_i

    X(u, v) = bilinear(V) + (1 - v) d_0(u) + u d_1(v) + v d_2(1 - u) + (1 - u) d_3(1 - v).

A triangle is the linear map of its corners plus, for each side from V_i to V_j,

    4 L_i L_j / (1 - (L_j - L_i)^2) d((1 + L_j - L_i) / 2)

in barycentric coordinates L, which is d on that side and zero on the others (Szabo and Babuska,
*Finite Element Analysis*, section 6.2).

Sampling: quads at the 5 x 5 points with u, v in {0, 1/4, 1/2, 3/4, 1}, triangles at the 15 points
whose coordinates are multiples of 1/4; corners included, where the derivatives are the tangents of
the sides. Both derivatives p, q of the map are linear in the corners and in d and d' at multiples
of 1/8 of each side; the coefficients are tables. An element is valid if det(p, q) > 0 at all
samples. `meshwright bench --suite coons` measures how often that misses a fold, and how deep;
between segments and arcs of circles `geometry/jacobian_bound.py` bounds det from below.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.core.composite_curves import Curves
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.edge_kernels import edge_offsets, place_on_edge
from meshwright_core.geometry.vectors import determinant, inner

NODES = 9
"""Places on a side where d and d' enter, at multiples of 1/8."""
_PARTS = 4


@by_reference
class Samples(NamedTuple):
    """Where the map of an element of k sides is measured, q samples, and its derivatives there."""

    corners: np.ndarray
    """(q, k, 2) coefficients of the corners in p and in q."""
    node: np.ndarray
    """(q, k) int64 the place on each side whose d and d' enter."""
    sides: np.ndarray
    """(q, k, 4) coefficients of d in p, d' in p, d in q, d' in q."""
    at_corner: np.ndarray
    """(k,) int64 the samples at the corners."""
    nearest: np.ndarray
    """(q,) int64 the corner that each sample is nearest to."""
    step: np.ndarray
    """(1,) int64 every how many places on a side there is one that matters."""


def _quad_samples() -> Samples:
    count = (_PARTS + 1) ** 2
    corners, sides = np.zeros((count, 4, 2)), np.zeros((count, 4, 4))
    node, nearest = np.zeros((count, 4), np.int64), np.zeros(count, np.int64)
    at_corner = np.zeros(4, np.int64)
    for i in range(_PARTS + 1):
        for j in range(_PARTS + 1):
            row, u, v = i * (_PARTS + 1) + j, i / _PARTS, j / _PARTS
            corners[row] = [[v - 1, u - 1], [1 - v, -u], [v, u], [-v, 1 - u]]
            node[row] = [2 * i, 2 * j, NODES - 1 - 2 * i, NODES - 1 - 2 * j]
            sides[row] = [[0, 1 - v, -1, 0], [1, 0, 0, u], [0, -v, 1, 0], [-1, 0, 0, u - 1]]
            nearest[row] = (0 if j <= 2 else 3) if i <= 2 else (1 if j <= 2 else 2)
            if i % _PARTS == 0 and j % _PARTS == 0:
                at_corner[nearest[row]] = row
    return Samples(corners, node, sides, at_corner, nearest, np.array([2]))


def _triangle_samples() -> Samples:
    places = [(i, j) for i in range(_PARTS + 1) for j in range(_PARTS + 1 - i)]
    count = len(places)
    corners, sides = np.zeros((count, 3, 2)), np.zeros((count, 3, 4))
    node, nearest = np.zeros((count, 3), np.int64), np.zeros(count, np.int64)
    at_corner = np.zeros(3, np.int64)
    slope = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    for row, (i, j) in enumerate(places):
        share = np.array([_PARTS - i - j, i, j]) / _PARTS
        nearest[row] = int(np.argmax(share))
        if share.max() == 1.0:
            a = nearest[row]
            b, c = (a + 1) % 3, (a + 2) % 3
            at_corner[a] = row
            corners[row, a], corners[row, b], corners[row, c] = [-1, -1], [1, 0], [0, 1]
            sides[row, a, 1], node[row, a] = 1.0, 0
            sides[row, c, 3], node[row, c] = -1.0, NODES - 1
            continue
        corners[row] = slope
        for a in range(3):
            b = (a + 1) % 3
            along = share[b] - share[a]
            room = 1.0 - along * along
            node[row, a] = round(_PARTS * (1.0 + along))
            weight = 4.0 * share[a] * share[b] / room
            turn = slope[b] - slope[a]
            rise = 4.0 * (slope[a] * share[b] + share[a] * slope[b]) / room
            rise = rise + weight * 2.0 * along / room * turn
            sides[row, a] = [rise[0], 0.5 * weight * turn[0], rise[1], 0.5 * weight * turn[1]]
    return Samples(corners, node, sides, at_corner, nearest, np.array([1]))


SAMPLES = {3: _triangle_samples(), 4: _quad_samples()}


@by_reference
class CurvedElements(NamedTuple):
    """The elements with sides that bend, among m elements of k sides; c of them, r such sides."""

    curves: Curves
    samples: Samples
    elements: np.ndarray
    """(m, k) vertices of all elements."""
    element: np.ndarray
    """(c,) the curved ones, rows of `elements`."""
    row: np.ndarray
    """(m,) the place of each element in `element`, -1 for those with straight sides."""
    sides: np.ndarray
    """(c, k) the number of each side that bends, -1 for straight ones."""
    curve: np.ndarray
    """(r,) the curve of each side."""
    base: np.ndarray
    """(r, 2) what to add to `parameter` of its ends for their parameters on the curve."""
    parameter: np.ndarray
    """(n,) parameters of the vertices that slide, 0 for others."""


@kernel
def place_sides(curved, points, c, d, slope):
    """Write d and d' (k, NODES, 3) of curved element c at the places that matter; exact."""
    k = curved.elements.shape[1]
    span, ends, offsets = np.zeros(2), np.zeros((2, 3)), np.zeros((2, 3))
    step = curved.samples.step[0]
    for i in range(k):
        r = curved.sides[c, i]
        if r < 0:
            continue
        a = curved.elements[curved.element[c], i]
        b = curved.elements[curved.element[c], (i + 1) % k]
        span[0] = curved.base[r, 0] + curved.parameter[a]
        span[1] = curved.base[r, 1] + curved.parameter[b]
        for x in range(3):
            ends[0, x], ends[1, x] = points[a, x], points[b, x]
        edge_offsets(curved.curves, curved.curve[r], span, ends, offsets)
        for j in range(0, NODES, step):
            w = j / (NODES - 1)
            place_on_edge(curved.curves, curved.curve[r], span, offsets, w, d[i, j], slope[i, j])
            for x in range(3):
                d[i, j, x] -= (1.0 - w) * ends[0, x] + w * ends[1, x]
                slope[i, j, x] -= ends[1, x] - ends[0, x]


@kernel
def derivatives(curved, points, c, s, d, slope, p, q):
    """Write the derivatives p and q (3,) of the map of curved element c at sample s."""
    samples = curved.samples
    k = curved.elements.shape[1]
    e = curved.element[c]
    for x in range(3):
        p[x] = q[x] = 0.0
    for i in range(k):
        v = curved.elements[e, i]
        for x in range(3):
            p[x] += samples.corners[s, i, 0] * points[v, x]
            q[x] += samples.corners[s, i, 1] * points[v, x]
        if curved.sides[c, i] < 0:
            continue
        j = samples.node[s, i]
        for x in range(3):
            p[x] += samples.sides[s, i, 0] * d[i, j, x] + samples.sides[s, i, 1] * slope[i, j, x]
            q[x] += samples.sides[s, i, 2] * d[i, j, x] + samples.sides[s, i, 3] * slope[i, j, x]


@kernel
def curved_shape(curved, points, c, normal):
    """Shape of curved element c from its worst sample: 1 for the ideal, 0 or less where folded.

    As of straight elements: 2 det / (|p|^2 + |q|^2) for quads, the mean ratio for triangles.
    """
    k = curved.elements.shape[1]
    d, slope = np.zeros((4, NODES, 3)), np.zeros((4, NODES, 3))
    p, q = np.zeros(3), np.zeros(3)
    place_sides(curved, points, c, d, slope)
    worst = np.inf
    for s in range(len(curved.samples.nearest)):
        derivatives(curved, points, c, s, d, slope, p, q)
        det = determinant(p, q, normal)
        squares = inner(p, p) + inner(q, q)
        if k == 3:
            det *= np.sqrt(3.0)
            squares = 2.0 * (squares - inner(p, q))
        worst = min(worst, 2.0 * det / squares if squares > 0.0 else 0.0)
    return worst


@kernel
def curved_corners(curved, points, reference):
    """Sines (c, k) and angles (c, k) of the curved elements.

    The sine at a corner is the smallest of the angle between p and q at the samples nearest to it,
    for triangles of any angle of the triangle that p and q span; the angle, in radians from -pi
    to pi, is that between the tangents of the sides. `reference` (m, 3): normals of all elements.
    """
    count, k = curved.sides.shape
    sines, angles = np.full((count, k), np.inf), np.zeros((count, k))
    d, slope = np.zeros((4, NODES, 3)), np.zeros((4, NODES, 3))
    p, q = np.zeros(3), np.zeros(3)
    samples = curved.samples
    for c in range(count):
        normal = reference[curved.element[c]]
        place_sides(curved, points, c, d, slope)
        for s in range(len(samples.nearest)):
            derivatives(curved, points, c, s, d, slope, p, q)
            det, along = determinant(p, q, normal), inner(p, q)
            pp, qq = inner(p, p), inner(q, q)
            corner = samples.nearest[s]
            if samples.at_corner[corner] == s:
                # at the second and fourth corner of a quad one of p and q points to the corner
                inwards = -along if k == 4 and corner % 2 else along
                angles[c, corner] = np.arctan2(det, inwards)
            elif k == 3:
                rr = pp + qq - 2.0 * along
                # the smallest angle lies between the two longest sides
                longest = max(pp, qq, rr)
                middle = pp + qq + rr - longest - min(pp, qq, rr)
                pp, qq = longest, middle
            lengths = np.sqrt(pp * qq)
            sine = det / lengths if lengths > 0.0 else 0.0
            sines[c, corner] = min(sines[c, corner], sine)
    return sines, angles


@kernel
def at_corners(curved, points, normal):
    """(c, k) sines of the angles between the tangents of the sides at the corners themselves."""
    count, k = curved.sides.shape
    sines = np.zeros((count, k))
    d, slope = np.zeros((4, NODES, 3)), np.zeros((4, NODES, 3))
    p, q = np.zeros(3), np.zeros(3)
    for c in range(count):
        place_sides(curved, points, c, d, slope)
        for i in range(k):
            derivatives(curved, points, c, curved.samples.at_corner[i], d, slope, p, q)
            lengths = np.sqrt(inner(p, p) * inner(q, q))
            sines[c, i] = determinant(p, q, normal) / lengths if lengths > 0.0 else 0.0
    return sines
