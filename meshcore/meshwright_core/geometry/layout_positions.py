"""Positions for a quad layout that a compiled search has just changed.

Everything happens on the arrays of the mesh, so that thousands of layouts a second can be tried:
the variables are read off the connectivity, folded corners unfolded (the energy of
:mod:`meshwright_core.geometry.foldover_energy`), and the worst corner raised
(:mod:`meshwright_core.geometry.worst_corner`) until it is as good as is asked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from meshwright_core.core.arrays import (
    DEGREE,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    FLAGS,
    GEOMETRIC,
    HALF,
    LOCKED,
    ORIGIN,
    VERTEX_SLOTS,
    following,
    on_boundary,
)
from meshwright_core.core.compilation import kernel
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.foldover_energy import Problem, place, unfold
from meshwright_core.geometry.outline import Outline, Polylines, nearest_on
from meshwright_core.geometry.shape_bound import corner_angles
from meshwright_core.geometry.worst_corner import FOLDED, climb, even_out, worst_sine

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

POOR = 0.05
"""Worst sine below which the foldover-free energy is minimised first."""
UNFOLDING, SHAPING = 1.0, 0.1
"""Weights of equal areas in that energy before and after the last corner unfolds."""
SWEEPS = 40
"""Sweeps of averaging in the second attempt."""
ROUNDS, INNER, POLISH = 12, 30, 20
"""The most values of its regularisation, L-BFGS steps at each, and steps for shape after them."""


@by_reference
class Rails(NamedTuple):
    """The sides that the boundary vertices of a layout slide on."""

    sides: Polylines
    """In the plane, (p, 2) points."""
    side_of: np.ndarray
    """(slots,) the side that begins at a geometric vertex, -1 elsewhere."""
    angle: np.ndarray
    """(slots,) radians inside the domain at a geometric boundary vertex, 0 elsewhere."""


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


@kernel
def _place_inside(m, points, variable, x):
    """Fill `points` (n, 2), number the variables of free vertices inside; returns their count."""
    count = 0
    for v in range(len(points)):
        if m.vertex[v, HALF] < 0:
            continue
        points[v, 0], points[v, 1] = m.points[v, 0], m.points[v, 1]
        if m.vertex[v, FLAGS] & (GEOMETRIC | LOCKED) or on_boundary(m, v):
            continue
        variable[v] = count
        x[count], x[count + 1] = points[v, 0], points[v, 1]
        count += 2
    return count


@kernel
def _next_on_boundary(m, v):
    return m.edge[following(m.vertex[v, HALF], 4), ORIGIN]


@kernel
def _in_order(m, rails, g, along, even):
    """Write the arc lengths of the vertices after g on its side into `along`, spread evenly if
    `even`, or if those of their projections do not increase; returns their number.
    """
    s = rails.side_of[g]
    length = rails.sides.arc[rails.sides.first[s + 1] - 1]
    count, increasing, before = 0, True, 0.0
    v = _next_on_boundary(m, g)
    while not m.vertex[v, FLAGS] & GEOMETRIC and count < len(along):
        along[count], _ = nearest_on(rails.sides, s, m.points[v, :2])
        increasing = increasing and along[count] > before + 1e-9 * length
        before = along[count]
        count += 1
        v = _next_on_boundary(m, v)
    if even or not (increasing and before < length * (1.0 - 1e-9)):
        for i in range(count):
            along[i] = length * (i + 1) / (count + 1)
    return count


@kernel
def assemble(m, rails, even):
    """The arrays of a :class:`Problem` for the whole layout, its variables, and the mean size of
    an element. even: spread the vertices on sides.
    """
    n = m.counters[VERTEX_SLOTS]
    points, tangent = np.zeros((n, 2)), np.zeros((n, 2))
    variable, side = np.full(n, -1), np.full(n, -1)
    x, along = np.zeros(2 * n), np.zeros(n)
    gaps = np.zeros((2 * n, 2), np.int64)
    offset, gap_scale = np.zeros(2 * n), np.zeros(2 * n)
    count, gap_count = _place_inside(m, points, variable, x), 0
    for g in range(n):
        if rails.side_of[g] < 0 or m.vertex[g, HALF] < 0:
            continue
        s = rails.side_of[g]
        members = _in_order(m, rails, g, along, even)
        length = rails.sides.arc[rails.sides.first[s + 1] - 1]
        v, variable_before, fixed_before = g, -1, 0.0
        for i in range(members + 1):
            v = _next_on_boundary(m, v)
            at = along[i] if i < members else length
            free = i < members and not m.vertex[v, FLAGS] & LOCKED
            if free:
                variable[v], side[v], x[count] = count, s, at
            if free or variable_before >= 0:
                gaps[gap_count, 0] = variable_before
                gaps[gap_count, 1] = count if free else -1
                offset[gap_count] = (0.0 if free else at) - (
                    0.0 if variable_before >= 0 else fixed_before
                )
                gap_scale[gap_count] = (members + 1) / length
                gap_count += 1
            variable_before = count if free else -1
            fixed_before = at
            if free:
                count += 1
    corners = np.zeros((4 * m.counters[ELEMENTS], 3), np.int64)
    scale = np.zeros(len(corners))
    row, area = 0, 0.0
    for e in range(m.counters[ELEMENT_SLOTS]):
        if m.edge[4 * e, ORIGIN] < 0:
            continue
        for i in range(4):
            for j in range(3):
                corners[row, j] = m.edge[4 * e + (i + (0, 1, 3)[j]) % 4, ORIGIN]
            o, s = corners[row, 0], corners[row, 1]
            area += 0.5 * (points[o, 0] * points[s, 1] - points[o, 1] * points[s, 0])
            row += 1
    mean = abs(area) / max(1, m.counters[ELEMENTS]) + 1e-300
    for c in range(len(scale)):
        scale[c] = 1.0 / mean
    return (
        points, tangent, variable, side, corners, scale, gaps[:gap_count], offset[:gap_count],
        gap_scale[:gap_count], x[:count], np.sqrt(mean),
    )  # fmt: skip


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
            if i >= 0 and problem.side[v] < 0:
                for axis in range(2):
                    points[v, axis] = x[i + axis] = total[v, axis] / count[v]


@kernel
def _improve(problem, x, unit, goal, iterations, afresh):
    """Untangle where needed, then raise the worst corner; returns its sine."""
    place(problem, x)
    if afresh:
        _average(problem, x)
    worst = worst_sine(problem)
    if worst < POOR:
        unfold(problem, x, UNFOLDING, ROUNDS, INNER, POLISH, SHAPING)
        worst = worst_sine(problem)
    if FOLDED < worst < goal and len(x):
        worst = climb(problem, x, unit, goal, iterations)
        if goal >= 1.0:
            worst = even_out(problem, x, unit, iterations)
    return worst


@kernel
def _position(m, rails, goal, iterations, afresh):
    (
        points, tangent, variable, side, corners, scale, gaps, offset, gap_scale, x, unit,
    ) = assemble(m, rails, afresh)  # fmt: skip
    shape = np.array([1.0, 0.0, 1.0])
    problem = Problem(
        points, tangent, variable, side, rails.sides, corners, scale, shape, gaps, offset, gap_scale
    )
    worst = _improve(problem, x, unit, goal, iterations, afresh)
    # the problem only points to these arrays: their last use must come after its own
    used = len(tangent) + len(side) + len(corners) + len(scale) + len(shape) + len(gaps)
    used += len(offset) + len(gap_scale) + len(x)
    return (worst if used > 0 else 1.0), points, variable


@kernel
def position(m, rails, goal, iterations):
    """Give all movable vertices of the layout better positions, in place.

    Ends as soon as the worst corner sine reaches `goal`; with a goal of 1 all elements are given
    better shapes after that. Where corners stay folded a second attempt
    starts from evenly spread vertices. iterations: of each stage of :func:`climb`. Returns the
    worst corner sine; 0 or less if the layout stays folded.
    """
    worst, points, variable = _position(m, rails, goal, iterations, False)
    if worst <= FOLDED:
        other, others, _ = _position(m, rails, goal, iterations, True)
        if other > worst:
            worst, points = other, others
    for v in range(len(points)):
        if variable[v] >= 0:
            m.points[v, 0], m.points[v, 1] = points[v, 0], points[v, 1]
    return worst


def rails_of(mesh: HalfEdgeMesh, centre: np.ndarray, unit: float) -> Rails:
    """The sides of a plane mesh z = 0 in units of `unit` around `centre` (2,).

    Vertices of a loop without geometric vertices stay where they are.
    """
    outline, geometric = Outline.of(mesh), mesh.geometric()
    side_of = np.full(mesh.slots, -1, np.int64)
    pieces = []
    for loop in mesh.boundary_loops():
        corners = np.flatnonzero(geometric[loop])
        for a, b in zip(corners, np.append(corners[1:], corners[:1] + len(loop)), strict=True):
            chain = np.take(loop, np.arange(a, b + 1), mode="wrap")
            side_of[chain[0]] = len(pieces)
            pieces.append((outline.side(chain, mesh.points[chain], False)[:, :2] - centre) / unit)
    arcs = [
        np.append(0.0, np.cumsum(np.linalg.norm(np.diff(piece, axis=0), axis=1)))
        for piece in pieces
    ]
    sides = Polylines(
        points=np.ascontiguousarray(np.concatenate(pieces)) if pieces else np.zeros((0, 2)),
        arc=np.concatenate(arcs) if arcs else np.zeros(0),
        first=np.cumsum([0, *map(len, pieces)]).astype(np.int64),
        closed=np.zeros(len(pieces), np.bool_),
    )
    return Rails(sides, side_of, corner_angles(mesh))
