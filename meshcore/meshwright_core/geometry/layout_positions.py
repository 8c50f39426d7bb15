"""Positions for a quad layout that a compiled search has just changed.

Everything happens on the arrays of the mesh, so that hundreds of layouts a second can be tried: the
variables are read off the connectivity, folded corners are unfolded, and the worst corner is raised
(:mod:`meshwright_core.geometry.worst_corner`) until it is as good as is asked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from meshwright_core.core.arrays import (
    CURVE,
    DEGREE,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    END,
    FLAGS,
    GEOMETRIC,
    HALF,
    LEFT,
    LOCKED,
    ORIGIN,
    START,
    TWIN,
    VERTEX_SLOTS,
    along_curve,
    following,
    on_boundary,
    preceding,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.composite_curves import curve_length, place_in_span
from meshwright_core.core.curve_edges import edge_curve
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.bent_elements import (
    COUNT,
    MIDDLES,
    PLACES,
    QUARTERS,
    BentElements,
    find_bent,
)
from meshwright_core.geometry.coons import Samples
from meshwright_core.geometry.element_sines import Gauge, gauge, worst_around
from meshwright_core.geometry.seats import beside
from meshwright_core.geometry.shape_bound import corner_angles
from meshwright_core.geometry.turning import (
    BENDS,
    CurveTurning,
    Turning,
    span_towards,
    turning_between,
)
from meshwright_core.geometry.worst_corner import (
    CHORD,
    FOLDED,
    HELD,
    SLIDING,
    LayoutProblem,
    climb,
    even_out,
    place_layout,
    unfold_layout,
    worst_sine,
)

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

POOR = 0.05
"""Worst sine below which the foldover-free energy is minimised first."""
SWEEPS = 40
"""Sweeps of averaging in the second attempt."""
ROUNDS, INNER, POLISH = 12, 30, 20
"""The most values of its regularisation, L-BFGS steps at each, and steps for shape after them."""
EVEN = 1.05
"""Unsigned over signed area of all elements beyond which they should have equal areas."""
_ASIDE = 1e-3
"""Share of a curve's length by which a direction is looked up: which side of a joint."""


@by_reference
class Effort(NamedTuple):
    """How far positions are improved."""

    goal: float
    """Worst corner sine at which to end; with 1 all elements are given better shapes after that."""
    iterations: int
    """L-BFGS steps of each stage of :func:`meshwright_core.geometry.worst_corner.climb`."""
    rounds: int
    """The most values of the regularisation while unfolding."""
    inner: int
    """L-BFGS steps at each of them."""
    polish: int
    """Steps for shape once nothing is folded."""


@by_reference
class Rails(NamedTuple):
    """What is known of the curves of a layout, whatever its connectivity."""

    turning: Turning
    """Of the curves."""
    angle: np.ndarray
    """(slots,) radians inside the domain at a geometric boundary vertex, 0 elsewhere."""
    samples: Samples
    """Where elements with sides that bend are measured besides their corners."""
    gauge: Gauge
    """For the measure of the result; rails are for one thread."""


def rails_of(mesh: HalfEdgeMesh, slots: int) -> Rails:
    """The rails of a mesh in the plane z = 0 and of all that operations make of it."""
    angle = np.zeros(slots)
    angle[: mesh.slots] = corner_angles(mesh)
    return Rails(CurveTurning.of(mesh), angle, QUARTERS, gauge())


@kernel
def layout_bound(m, angle):
    """An upper bound on the worst sine of a layout by its degrees alone: the quads at a vertex
    share 360 degrees inside, 180 on a side, `angle` (slots,) at a corner; the best is equally.
    """
    bound = 1.0
    for v in range(m.counters[VERTEX_SLOTS]):
        if m.vertex[v, HALF] < 0:
            continue
        geometric = m.vertex[v, FLAGS] & GEOMETRIC
        if m.vertex[v, DEGREE] == m.vertex[v, DESIRED] and not geometric:
            continue
        quads = m.vertex[v, DEGREE]
        whole = 2.0 * np.pi
        if on_boundary(m, v):
            quads -= 1
            whole = angle[v] if geometric else np.pi
            if whole <= 0.0:
                continue
        # a share beyond 180 degrees is folded
        share = whole / quads
        bound = min(bound, np.sin(share) if share < np.pi else 0.0)
    return bound


@bare_kernel
def _parameter(m, v, c, ahead):
    """The parameter on curve c of v, an end of an edge along it; `ahead`: the end it leads to."""
    if m.interface[c, LEFT] >= 0:
        start, end = m.interface[c, START] == v, m.interface[c, END] == v
        if end and (ahead or not start):
            return curve_length(m.curves, c)
        if start:
            return 0.0
    return m.parameter[v]


@kernel
def _number(m, points, variable, seat, x, active):
    """Fill `points`, number the variables of all vertices that may move; returns their count.

    active: bool by vertex, whether it may move; all may if it is empty.
    """
    count = 0
    for v in range(len(points)):
        if m.vertex[v, HALF] < 0:
            continue
        for c in range(3):
            points[v, c] = m.points[v, c]
        if m.vertex[v, FLAGS] & (GEOMETRIC | LOCKED) or (len(active) and not active[v]):
            continue
        variable[v] = count
        if m.vertex[v, CURVE] >= 0:
            seat[v] = m.vertex[v, CURVE]
            x[count] = m.parameter[v]
            count += 1
        else:
            x[count], x[count + 1] = points[v, 0], points[v, 1]
            count += 2
    return count


@kernel
def _find_gaps(m, turning, variable, gaps, offsets):
    """The gaps between neighbours on curves of which at least one slides; returns their number."""
    count = 0
    for v in range(len(variable)):
        if variable[v] < 0 or m.vertex[v, CURVE] < 0:
            continue
        c = m.vertex[v, CURVE]
        length = curve_length(m.curves, c)
        for ahead in range(2):
            u = beside(m, v, c, ahead == 1, 4)
            if u < 0 or (ahead == 0 and variable[u] >= 0):
                continue
            low, high = (v, u) if ahead else (u, v)
            a, b = _parameter(m, low, c, False), _parameter(m, high, c, True)
            turn = length if b <= a and m.curves.closed[c] else 0.0
            gaps[count, 0], gaps[count, 1], gaps[count, 2] = variable[low], variable[high], c
            offsets[count, 0] = turn
            if variable[low] < 0:
                offsets[count, 0] -= a
            if variable[high] < 0:
                offsets[count, 0] += b
            gap = max(b + turn - a, 1e-3 * length)
            offsets[count, 1] = 1.0 / gap
            offsets[count, 2] = turning_between(m.curves, turning, c, a, a + gap) / gap
            count += 1
    return count


@kernel
def _spread(m, variable, x):
    """Spread the sliding vertices of each side evenly between those that stay; those of a closed
    curve without any evenly all around.
    """
    done = np.zeros(len(variable), np.bool_)
    for closed in range(2):
        for g in range(len(variable)):
            if m.vertex[g, HALF] < 0 or m.vertex[g, CURVE] < 0:
                continue
            if (variable[g] >= 0) != (closed == 1) or done[g]:
                continue
            c = m.vertex[g, CURVE]
            length = curve_length(m.curves, c)
            members, v = 0, g
            for _ in range(len(variable)):
                v = beside(m, v, c, True, 4)
                if v < 0 or v == g or variable[v] < 0:
                    break
                members += 1
            if members == 0 or v < 0:
                continue
            start, stop = _parameter(m, g, c, False), _parameter(m, v, c, True)
            if v == g:
                start, stop = m.parameter[g], m.parameter[g] + length
            elif stop <= start and m.curves.closed[c]:
                stop += length
            v = g
            for i in range(members):
                v = beside(m, v, c, True, 4)
                done[v] = True
                t = start + (stop - start) * (i + 1) / (members + 1)
                x[variable[v]] = t - length if t >= length and m.curves.closed[c] else t


@bare_kernel
def _bent(m, rails, h, c, a, b):
    """Whether the edge of half-edge h along curve c bends between its parameters."""
    low, high = min(a, b), max(a, b)
    if m.curves.closed[c] and m.edge[h, TWIN] < 0 and b <= a:
        low, high = a, b + curve_length(m.curves, c)
    return turning_between(m.curves, rails.turning, c, low, high) > BENDS


@bare_kernel
def _forward(m, h, c):
    """Whether half-edge h runs along its curve c."""
    return m.interface[c, LEFT] < 0 or m.region[h // 4] == m.interface[c, LEFT]


@kernel
def _find_ways(m, rails, variable, bends, h, kind, ways):
    """Fill kind (2,) and ways (4,) of the corner at the origin of half-edge h."""
    place, slope = np.zeros(3), np.zeros(3)
    for which in range(2):
        g = h if which == 0 else preceding(h, 4)
        kind[which] = CHORD
        if not along_curve(m, g, 4):
            continue
        c = edge_curve(m, g, 4)
        if c < 0:
            continue
        a, b = m.edge[g, ORIGIN], m.edge[following(g, 4), ORIGIN]
        forward = _forward(m, g, c)
        start, stop = _parameter(m, a, c, not forward), _parameter(m, b, c, forward)
        if not _bent(m, rails, g, c, start, stop):
            continue
        # away from the corner: along the curve or against it
        away = forward == (which == 0)
        o = a if which == 0 else b
        if variable[o] >= 0:
            kind[which], ways[2 * which] = SLIDING, 1.0 if away else -1.0
            bends[o] = True
            continue
        t = start if which == 0 else stop
        aside = _ASIDE * curve_length(m.curves, c)
        span, u = span_towards(m.curves, c, t, t + aside if away else t - aside)
        place_in_span(m.curves, span, u, place, slope)
        size = np.hypot(slope[0], slope[1])
        if not size > 0.0:
            continue
        kind[which] = HELD
        for i in range(2):
            ways[2 * which + i] = (slope[i] if away else -slope[i]) / size


@kernel
def _average(problem, x):
    """Move the free vertices to the means of their neighbours, by sweeps over all of them."""
    points, corners = problem.points, problem.corners
    n = len(points)
    total, count = np.zeros((n, 2)), np.zeros(n)
    for c in range(len(corners)):
        count[corners[c, 0]] += 1.0
        count[corners[c, 1]] += 1.0
    for _ in range(SWEEPS):
        for v in range(n):
            total[v, 0] = total[v, 1] = 0.0
        for c in range(len(corners)):
            a, b = corners[c, 0], corners[c, 1]
            for axis in range(2):
                total[a, axis] += points[b, axis]
                total[b, axis] += points[a, axis]
        for v in range(n):
            i = problem.variable[v]
            if i >= 0 and problem.seat[v] < 0:
                for axis in range(2):
                    points[v, axis] = x[i + axis] = total[v, axis] / count[v]


@kernel
def _improve(problem, x, effort, afresh):
    """Untangle where needed, then raise the worst corner; returns its sine."""
    used = problem.bent.used
    used[0] = COUNT
    place_layout(problem, x)
    if afresh:
        _average(problem, x)
    worst = worst_sine(problem)
    if worst < POOR:
        used[0] = MIDDLES
        place_layout(problem, x)
        worst = worst_sine(problem)
        if worst < POOR:
            worst = unfold_layout(problem, x, effort.rounds, effort.inner, effort.polish)
        if worst > FOLDED and len(problem.bent.vertices):
            # with all samples from the start more stays folded
            climb(problem, x, effort.goal, effort.iterations)
            used[0] = COUNT
            place_layout(problem, x)
            worst = worst_sine(problem)
            if worst < POOR:
                worst = unfold_layout(problem, x, effort.rounds, effort.inner, effort.polish)
    if FOLDED < worst < effort.goal and len(x):
        worst = climb(problem, x, effort.goal, effort.iterations)
        if effort.goal >= 1.0:
            worst = even_out(problem, x, effort.iterations)
    return worst


@kernel
def _seams(m, x, gaps, offsets, count):
    """Let the first `count` gaps follow from the values of the variables."""
    for i in range(count):
        a, b, c = gaps[i, 0], gaps[i, 1], gaps[i, 2]
        if not m.curves.closed[c]:
            continue
        length = curve_length(m.curves, c)
        gap = offsets[i, 0] - (x[a] if a >= 0 else 0.0) + (x[b] if b >= 0 else 0.0)
        if gap <= 0.0:
            offsets[i, 0] += length
        elif gap > length:
            offsets[i, 0] -= length
        gap = offsets[i, 0] - (x[a] if a >= 0 else 0.0) + (x[b] if b >= 0 else 0.0)
        offsets[i, 1] = 1.0 / max(gap, 1e-3 * length)


@bare_kernel
def _any_moves(m, h, variable):
    """Whether a vertex of the element of half-edge h may move."""
    e, largest = h - h % 4, -1
    for i in range(4):
        largest = max(largest, variable[m.edge[e + i, ORIGIN]])
    return largest >= 0


@kernel
def _scale_by_targets(corners, scale, vertices):
    """Replace `scale` (c,), a fourth of each element's signed area by its corners, by one over the
    area that the element should have.

    The areas are smoothed where little is folded, else all are the same, as in
    :mod:`meshwright_core.geometry.untangling`.
    """
    elements = len(corners) // 4
    areas, sums, counts = np.zeros(elements), np.zeros(vertices), np.zeros(vertices)
    total = unsigned = 0.0
    for e in range(elements):
        for i in range(4 * e, 4 * e + 4):
            areas[e] += scale[i]
            counts[corners[i, 0]] += 1.0
        total += areas[e]
        unsigned += abs(areas[e])
    mean = max(abs(total), 1e-3 * unsigned) / max(elements, 1) + 1e-300
    alike = unsigned > EVEN * abs(total)
    for e in range(elements):
        areas[e] = mean if alike else max(abs(areas[e]), 1e-3 * mean)
    for _ in range(0 if alike else 3):
        for v in range(vertices):
            sums[v] = 0.0
        for c in range(len(corners)):
            sums[corners[c, 0]] += areas[c // 4]
        for e in range(elements):
            areas[e] = 0.0
            for i in range(4 * e, 4 * e + 4):
                areas[e] += 0.25 * sums[corners[i, 0]] / counts[corners[i, 0]]
    whole = 0.0
    for e in range(elements):
        whole += areas[e]
    for c in range(len(corners)):
        scale[c] = whole / (areas[c // 4] * mean * elements)


@kernel
def assemble(m, rails, afresh, active):
    """The arrays of a :class:`LayoutProblem` in their order, but for `bent` and the curves, its
    variables, and the ids of its elements.

    afresh: the vertices on curves are spread evenly. active: bool by vertex, whether it may move,
    empty for all; corners of elements that stay are left out.
    """
    n = m.counters[VERTEX_SLOTS]
    points, slope, tangent = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 4))
    variable, seat, bends = np.full(n, -1), np.full(n, -1), np.zeros(n, np.bool_)
    gaps, offsets = np.zeros((2 * n, 3), np.int64), np.zeros((2 * n, 3))
    values = np.zeros(2 * n)
    x = values[: _number(m, points, variable, seat, values, active)]
    gap_count = _find_gaps(m, rails.turning, variable, gaps, offsets)
    if afresh:
        _spread(m, variable, x)
        # the order on closed curves has changed where a seam was passed
        _seams(m, x, gaps, offsets, gap_count)
    total = 4 * m.counters[ELEMENTS]
    corners, kind = np.zeros((total, 3), np.int64), np.zeros((total, 2), np.int64)
    ways, scale = np.zeros((total, 4)), np.zeros(total)
    elements = np.zeros(m.counters[ELEMENTS], np.int64)
    row, area = 0, 0.0
    for h in range(4 * m.counters[ELEMENT_SLOTS]):
        if m.edge[h, ORIGIN] < 0 or (len(active) and not _any_moves(m, h, variable)):
            continue
        o, s = m.edge[h, ORIGIN], m.edge[following(h, 4), ORIGIN]
        corners[row, 0], corners[row, 1] = o, s
        corners[row, 2] = m.edge[preceding(h, 4), ORIGIN]
        _find_ways(m, rails, variable, bends, h, kind[row], ways[row])
        part = 0.5 * (points[o, 0] * points[s, 1] - points[o, 1] * points[s, 0])
        area += part
        scale[row], elements[row // 4] = part, h // 4
        row += 1
    size = np.zeros(1)
    size[0] = np.sqrt(abs(area) / max(1, row // 4) + 1e-300)
    _scale_by_targets(corners[:row], scale[:row], n)
    return (
        points, slope, tangent, variable, seat, bends, corners[:row], kind[:row], ways[:row],
        gaps[:gap_count], offsets[:gap_count], size, scale[:row], x, elements[: row // 4],
    )  # fmt: skip


@kernel
def _position(m, rails, effort, afresh, active):
    """The worst sine at new positions, these (n, 3), the numbers (n,) and values of variables."""
    (
        points, slope, tangent, variable, seat, bends, corners, kind, ways, gaps, offsets, size,
        scale, x, elements,
    ) = assemble(m, rails, afresh, active)  # fmt: skip
    rows, corner, curve, ends, base = find_bent(m, rails.turning, variable, x, elements)
    count = len(rows)
    scales, places = np.zeros(count), np.zeros((count, 4, PLACES, 6))
    vectors = np.zeros((count, COUNT, 4))
    pulls, by_corner = np.zeros((count, COUNT, 4)), np.zeros((count, 4, 2))
    used = np.zeros(1, np.int64)
    for b in range(count):
        scales[b] = scale[4 * rows[b]]
    bent = BentElements(
        rails.samples, used, corner, curve, ends, base, scales, places, vectors, pulls, by_corner
    )
    problem = LayoutProblem(
        points, slope, tangent, variable, seat, bends, corners, kind, ways, gaps, offsets, size,
        scale, bent, m.curves,
    )  # fmt: skip
    worst = _improve(problem, x, effort, afresh)
    # the problem only points to these arrays: their last use must come after its own
    last = used[0] + len(slope) + len(tangent) + len(seat) + len(bends) + len(corners) + len(kind)
    last += len(ways) + len(gaps) + len(offsets) + len(size) + len(scale)
    last += len(corner) + len(curve) + len(ends) + len(base) + len(scales) + len(places)
    last += len(vectors) + len(pulls) + len(by_corner)
    return (worst if last > 0 else 1.0), points, variable, x


@kernel
def _write_back(m, points, variable, x):
    """Move the vertices of `m` to `points` (n, 3), those on curves to the parameters in `x`."""
    for v in range(len(points)):
        if variable[v] < 0:
            continue
        for c in range(3):
            m.points[v, c] = points[v, c]
        if m.vertex[v, CURVE] >= 0:
            t, c = x[variable[v]], m.vertex[v, CURVE]
            length = curve_length(m.curves, c)
            if m.curves.closed[c]:
                t -= np.floor(t / length) * length
            m.parameter[v] = min(max(t, 0.0), length)
            if m.curves.closed[c] and m.parameter[v] >= length:
                m.parameter[v] = 0.0


@kernel
def position_some(m, rails, effort, active):
    """Give the vertices marked in `active` better positions, in place.

    Returns the worst corner sine of the elements at these vertices, 0 or less if one stays folded.
    """
    worst, points, variable, x = _position(m, rails, effort, False, active)
    _write_back(m, points, variable, x)
    return worst


@kernel
def position(m, rails, goal, iterations):
    """Give all movable vertices of the layout better positions, in place.

    Ends as soon as the worst corner sine reaches `goal`; with a goal of 1 all elements are given
    better shapes after that. Where corners stay folded a second attempt starts from evenly spread
    vertices. iterations: of each stage of :func:`climb`. Returns the worst sine of corners and of
    samples of elements with sides that bend; 0 or less if the layout stays folded.
    """
    effort = Effort(goal, iterations, ROUNDS, INNER, POLISH)
    every = np.zeros(0, np.bool_)
    worst, points, variable, x = _position(m, rails, effort, False, every)
    if worst <= FOLDED:
        other, others, _, other_x = _position(m, rails, effort, True, every)
        if other > worst:
            worst, points, x = other, others, other_x
    _write_back(m, points, variable, x)
    if worst <= 0.0:
        return worst
    return min(worst, max(0.0, worst_around(m, rails.turning, rails.gauge, every, 0.0)))
