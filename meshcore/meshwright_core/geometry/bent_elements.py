"""Quads with sides that bend, in the search for positions of a layout.

The corners of a quad alone do not show where it folds at a side that bends: there its Coons map
(:mod:`meshwright_core.geometry.coons`) is measured besides at the quarters of the four sides and in
the middle of the quad. With the points C and the tangents C' of a side's curve between t_a and t_b,
at t = t_a + w (t_b - t_a), what the map adds to that of the corners is

    d = C(t) - (1 - w) C(t_a) - w C(t_b),    d' = (t_b - t_a) C'(t) + C(t_a) - C(t_b),

so that the derivatives p and q of the map, linear in the corners, d and d', can be differentiated
by the corners and by the parameters of sliding vertices.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import (
    CURVE,
    END,
    LEFT,
    ORIGIN,
    START,
    along_curve,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.composite_curves import curve_length, place_on
from meshwright_core.core.curve_edges import edge_curve
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.coons import SAMPLES, Samples
from meshwright_core.geometry.turning import turning_between

PLACES = 5
"""Places on a side that matter: its ends and quarters."""
MIDDLES, COUNT = 5, 13
"""Samples of an element besides its corners: those in middles come first, then all."""
SLIGHT = np.radians(15.0)
"""Radians of turning of a side up to which the corners show enough of an element."""
_INSIDE = 1e-8
"""Share of a side by which its ends are looked up inside of it."""
_STEP = 1e-5
"""Step of the differences of tangents, relative to the length of the curve."""


def _samples() -> Samples:
    """Those of quads in the middles of the sides and of the quad, then at the other quarters of the
    sides; `node` is the quarter.
    """
    whole, last = SAMPLES[4], PLACES - 1
    quarters = whole.node // 2
    around = (quarters % last == 0).any(axis=1) | (quarters == last // 2).all(axis=1)
    rows = [row for row in np.flatnonzero(around) if row not in whole.at_corner]
    rows.sort(key=lambda row: bool((quarters[row] % 2).any()))
    return Samples(
        np.ascontiguousarray(whole.corners[rows]),
        quarters[rows],
        np.ascontiguousarray(whole.sides[rows]),
        whole.at_corner,
        whole.nearest[rows],
        whole.step,
    )


QUARTERS = _samples()


@by_reference
class BentElements(NamedTuple):
    """b quads with sides that bend."""

    samples: Samples
    used: np.ndarray
    """(1,) how many of the samples count: MIDDLES or COUNT."""
    vertices: np.ndarray
    """(b, 4) their vertices."""
    curve: np.ndarray
    """(b, 4) the curve of each side that bends, -1 for others."""
    ends: np.ndarray
    """(b, 4, 2) the variables of the parameters at both ends of such a side, -1 for one that
    stays."""
    base: np.ndarray
    """(b, 4, 2) the parameters of ends that stay, and what to add to the variables of others."""
    scale: np.ndarray
    """(b,) one over the area that the element should have while it is unfolded."""
    places: np.ndarray
    """(b, 4, PLACES, 6) at the ends and quarters of a side: C, C', C''."""
    vectors: np.ndarray
    """(b, COUNT, 4) p and q."""
    pulls: np.ndarray
    """(b, COUNT, 4) the derivatives of an objective by them."""
    by_corner: np.ndarray
    """(b, 4, 2) the derivatives by the positions of the corners."""


@bare_kernel
def _place_of(m, v, c, variable, x, at_end):
    """The variable of the parameter of v on curve c, -1 if it stays, and that parameter."""
    i = variable[v]
    if m.interface[c, LEFT] >= 0:
        if m.interface[c, END] == v and (at_end or m.interface[c, START] != v):
            return -1, curve_length(m.curves, c)
        if m.interface[c, START] == v:
            return -1, 0.0
    if i < 0 or m.vertex[v, CURVE] != c:
        return -1, m.parameter[v]
    return i, x[i]


@kernel
def find_bent(m, turning, variable, x, elements):
    """The quads among `elements` (l,) with a side that turns by more than :data:`SLIGHT`.

    Returns their rows in `elements`, and the fields from `vertices` to `base` of
    :class:`BentElements`.
    """
    count = len(elements)
    rows, vertices = np.zeros(count, np.int64), np.zeros((count, 4), np.int64)
    curve, ends = np.full((count, 4), -1), np.full((count, 4, 2), -1)
    base = np.zeros((count, 4, 2))
    found = 0
    for row in range(count):
        e = elements[row]
        bends = False
        for i in range(4):
            h = 4 * e + i
            curve[found, i] = -1
            if not along_curve(m, h, 4):
                continue
            c = edge_curve(m, h, 4)
            if c < 0:
                continue
            a, b = m.edge[h, ORIGIN], m.edge[4 * e + (i + 1) % 4, ORIGIN]
            backward = m.interface[c, LEFT] >= 0 and m.region[e] != m.interface[c, LEFT]
            if backward:
                a, b = b, a
            first, low = _place_of(m, a, c, variable, x, False)
            last, high = _place_of(m, b, c, variable, x, True)
            whole = curve_length(m.curves, c) if high <= low and m.curves.closed[c] else 0.0
            turn = turning_between(m.curves, turning, c, low, high + whole)
            curve[found, i] = c
            bends = bends or turn > SLIGHT
            for which in range(2):
                at_low = (which == 0) != backward
                ends[found, i, which] = first if at_low else last
                place = (low if first < 0 else 0.0) if at_low else whole
                base[found, i, which] = place + (0.0 if at_low or last >= 0 else high)
        if bends:
            rows[found] = row
            for i in range(4):
                vertices[found, i] = m.edge[4 * e + i, ORIGIN]
            found += 1
    return rows[:found], vertices[:found], curve[:found], ends[:found], base[:found]


@bare_kernel
def _end(bent, b, i, which, x):
    """The parameter at an end of a side."""
    variable = bent.ends[b, i, which]
    return bent.base[b, i, which] + (x[variable] if variable >= 0 else 0.0)


@kernel
def place_bent(bent, curves, points, x):
    """Update the places and vectors for variables `x` and the points (n, 3) of the vertices."""
    ahead, back, other = np.zeros(2), np.zeros(2), np.zeros(2)
    samples = bent.samples
    for b in range(len(bent.vertices)):
        for i in range(4):
            curve = bent.curve[b, i]
            if curve < 0:
                continue
            start, stop = _end(bent, b, i, 0, x), _end(bent, b, i, 1, x)
            step = _STEP * curve_length(curves, curve)
            for j in range(PLACES):
                # at a corner of the curve the tangent of this side counts, not that of the next
                w = min(max(0.25 * j, _INSIDE), 1.0 - _INSIDE)
                t = start + w * (stop - start)
                place = bent.places[b, i, j]
                place_on(curves, curve, t, place[:2], place[2:4])
                place_on(curves, curve, t + step, other, ahead)
                place_on(curves, curve, t - step, other, back)
                for c in range(2):
                    place[4 + c] = (ahead[c] - back[c]) / (2.0 * step)
        for s in range(bent.used[0]):
            vector = bent.vectors[b, s]
            for c in range(4):
                vector[c] = 0.0
            for i in range(4):
                v = bent.vertices[b, i]
                for c in range(2):
                    vector[c] += samples.corners[s, i, 0] * points[v, c]
                    vector[2 + c] += samples.corners[s, i, 1] * points[v, c]
                if bent.curve[b, i] < 0:
                    continue
                j = samples.node[s, i]
                w = 0.25 * j
                across = _end(bent, b, i, 1, x) - _end(bent, b, i, 0, x)
                places, factor = bent.places[b, i], samples.sides[s, i]
                for c in range(2):
                    d = places[j, c] - (1.0 - w) * places[0, c] - w * places[4, c]
                    slope = across * places[j, 2 + c] + places[0, c] - places[4, c]
                    vector[c] += factor[0] * d + factor[1] * slope
                    vector[2 + c] += factor[2] * d + factor[3] * slope


@bare_kernel
def bent_sine(bent, b, s):
    """The sine between p and q of a sample, and their lengths."""
    p, q = bent.vectors[b, s, :2], bent.vectors[b, s, 2:]
    first = np.sqrt(p[0] * p[0] + p[1] * p[1]) + 1e-150
    second = np.sqrt(q[0] * q[0] + q[1] * q[1]) + 1e-150
    return (p[0] * q[1] - p[1] * q[0]) / (first * second), first, second


@bare_kernel
def set_pull(bent, b, s, by_first, by_second, by_sine):
    """Set the pulls of a sample from the derivatives by the lengths of p and q and by the sine."""
    sine, first, second = bent_sine(bent, b, s)
    px, py = bent.vectors[b, s, 0] / first, bent.vectors[b, s, 1] / first
    qx, qy = bent.vectors[b, s, 2] / second, bent.vectors[b, s, 3] / second
    # the sine changes with the directions only
    bent.pulls[b, s, 0] = by_first * px + by_sine * (qy - sine * px) / first
    bent.pulls[b, s, 1] = by_first * py + by_sine * (-qx - sine * py) / first
    bent.pulls[b, s, 2] = by_second * qx + by_sine * (-py - sine * qx) / second
    bent.pulls[b, s, 3] = by_second * qy + by_sine * (px - sine * qy) / second


@kernel
def pull_bent(bent, x, gradient):
    """Write what the pulls come to by the positions of the corners into `by_corner`, and add to
    `gradient` what they come to by the parameters of the ends of sides.
    """
    samples = bent.samples
    for b in range(len(bent.vertices)):
        for i in range(4):
            bent.by_corner[b, i, 0] = bent.by_corner[b, i, 1] = 0.0
        for s in range(bent.used[0]):
            pull = bent.pulls[b, s]
            for i in range(4):
                for c in range(2):
                    bent.by_corner[b, i, c] += samples.corners[s, i, 0] * pull[c]
                    bent.by_corner[b, i, c] += samples.corners[s, i, 1] * pull[2 + c]
                if bent.curve[b, i] < 0:
                    continue
                j = samples.node[s, i]
                w = 0.25 * j
                across = _end(bent, b, i, 1, x) - _end(bent, b, i, 0, x)
                places, factor = bent.places[b, i], samples.sides[s, i]
                at_start = at_stop = 0.0
                for c in range(2):
                    by_d = factor[0] * pull[c] + factor[2] * pull[2 + c]
                    by_slope = factor[1] * pull[c] + factor[3] * pull[2 + c]
                    here, bend = places[j, 2 + c], across * places[j, 4 + c]
                    start, stop = places[0, 2 + c], places[4, 2 + c]
                    at_start += by_d * (1.0 - w) * (here - start)
                    at_start += by_slope * ((1.0 - w) * bend - here + start)
                    at_stop += by_d * w * (here - stop) + by_slope * (w * bend + here - stop)
                if bent.ends[b, i, 0] >= 0:
                    gradient[bent.ends[b, i, 0]] += at_start
                if bent.ends[b, i, 1] >= 0:
                    gradient[bent.ends[b, i, 1]] += at_stop
