"""Untangling: positions at which every element of a plane mesh is positively oriented.

The foldover-free energy (:mod:`meshwright_core.geometry.foldover_energy`) is minimised from the
present positions first
and, if elements stay inverted, from other starts. Corners that no position can unfold (a single
quad at a reflex corner of the outline, a boundary vertex of one element on a straight side, a
doublet) are left out of the energy, found beforehand, and their elements reported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry import movable_part
from meshwright_core.geometry.coons import CurvedElements
from meshwright_core.geometry.curved_energy import DIFFERENCES, SLIGHT
from meshwright_core.geometry.edge_kernels import NODES, WEIGHTS, bulges
from meshwright_core.geometry.foldover_energy import Problem, unfold
from meshwright_core.geometry.initial_guesses import (
    as_they_are,
    hold_single_quads,
    spread,
    spread_and_embedded,
    starts,
)
from meshwright_core.geometry.movable_part import MovablePart
from meshwright_core.geometry.planes import vector_areas
from meshwright_core.geometry.turning import turnings
from meshwright_core.geometry.unfixable import fixable, unfixable_corners

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

UNFOLDING, SHAPING = 1.0, 0.1
"""Weights of equal areas against equal angles (lambda of the paper) before and after the last
corner is unfolded: equal areas keep room for what is folded, equal angles look better."""
ROUNDS, INNER = 100, 60
"""The most values of the regularisation, and the most L-BFGS steps at each."""
BUDGET = 4_000_000
"""Corners evaluated after which no random start is tried: some tenth of a second."""
ALL = 100
"""More than the number of starts: no limit."""
GLANCE, MANY, FEW = 15, 0.1, 0.01
"""An attempt with vertices held is given up if more than MANY of the elements are inverted after
GLANCE values of the regularisation, or more than FEW after all. Of 60 layouts none with more was
drawn in the end."""
POLISH = 60
"""Steps for shape once nothing is folded."""


@dataclass(frozen=True)
class Untangled:
    """What :func:`untangle` found; nothing is written to the mesh."""

    vertices: np.ndarray
    """(n,) ids of the vertices that have moved."""
    positions: np.ndarray
    """(n, 3) their new positions."""
    parameters: np.ndarray
    """(n,) the new parameters of those on curves."""
    inverted: np.ndarray
    """Ids, ascending, of the elements that stay inverted."""
    unfixable: np.ndarray
    """Ids, ascending, of the inverted elements that are known to be unfixable."""
    starts: int
    """How many starting positions were tried."""
    evaluations: int
    """How often the energy was computed."""


def untangle(
    mesh: HalfEdgeMesh,
    vertices: Iterable[int] | None = None,
    polish: int = POLISH,
    seed: int = 0,
) -> Untangled:
    """Find positions without inverted elements by moving `vertices` (None: all).

    Boundary vertices slide along their side in their order; geometric and locked vertices stay. The
    result has no more inverted elements than the present positions. A mesh that does not lie in a
    plane is left as it is.

    Args:
        mesh: the mesh; it is not changed.
        vertices: ids of the vertices that may move.
        polish: the most steps that improve shapes once nothing is inverted.
        seed: of the random starts that follow when all others fail.
    """
    part = movable_part.chosen(mesh, vertices)
    starts, evaluations = untangle_part(part, polish, seed)
    moved, positions, parameters = part.changed(mesh)
    bad = part.inverted_rows()
    unfixable = bad & unfixable_corners(part).any(axis=1)
    return Untangled(
        vertices=moved,
        positions=positions,
        parameters=parameters,
        inverted=np.sort(part.element_ids[bad]),
        unfixable=np.sort(part.element_ids[unfixable]),
        starts=starts,
        evaluations=evaluations,
    )


def untangle_part(
    part: MovablePart, polish: int = POLISH, seed: int = 0, tries: int = ALL
) -> tuple[int, int]:
    """Untangle `part` in place, from at most `tries` starts.

    Returns the number of starts and of energy evaluations.
    """
    if part.frame is None or not part.movable.any():
        return 0, 0
    part.settle()
    lost = unfixable_corners(part)
    best, present = _BestPositions(part, lost), _BestPositions(part, lost)
    tried = evaluations = 0
    for start in starts(part, np.random.default_rng(seed))[:tries]:
        if tried >= 3 and evaluations * part.elements.size > BUDGET:
            break
        present.restore(part)
        start(part)
        tried += 1
        evaluations += _run(hold_single_quads(part), lost, polish)
        best.keep_better(part)
        if best.done:
            break
    if not best.done:
        # leave out the corners that stay folded, so that they do not distort others
        best.restore(part)
        evaluations += _run(part, lost | part.folded(), polish)
        best.keep_better(part)
    best.restore(part)
    return tried, evaluations


def untangle_from_sides(
    part: MovablePart, stop: Callable[[], bool], attempts: int = ALL, polish: int = POLISH
) -> bool:
    """Untangle `part` in place where connectivity has changed much since it had good positions.

    Each attempt holds the vertices on sides first, so that they do not gather in few places while
    much is folded, and releases them only if something stays folded. Attempts begin at the present
    positions, with the vertices on sides spread evenly, and with the others at means besides. True
    if nothing is inverted but what no position can unfold.
    """
    if part.frame is None or not part.movable.any():
        return not fixable(part).any()
    part.settle()
    lost = unfixable_corners(part)
    best, present = _BestPositions(part, lost), _BestPositions(part, lost)
    for start in (as_they_are, spread, spread_and_embedded)[:attempts]:
        present.restore(part)
        start(part)
        held = hold_single_quads(part)
        held = held.holding(np.flatnonzero(held.sliding).tolist())
        for moving, rounds, hopeless in (
            (held, GLANCE, MANY),
            (held, ROUNDS, FEW),
            (part, ROUNDS, 0.0),
        ):
            if best.done or stop():
                break
            _run(moving, lost, polish, rounds)
            best.keep_better(part)
            if part.inverted_rows().mean() > hopeless:
                break
    best.restore(part)
    part.settle()
    return best.done


class _BestPositions:
    """The best positions of a movable part so far."""

    def __init__(self, part: MovablePart, unfixable: np.ndarray) -> None:
        self._unfixable = unfixable.any(axis=1)
        self._badness = self._measure(part)
        self._save(part)

    @property
    def done(self) -> bool:
        """Whether no element is inverted but the unfixable ones."""
        return self._badness[0] == 0

    def _measure(self, part: MovablePart) -> tuple[int, int]:
        bad = part.inverted_rows()
        return int((bad & ~self._unfixable).sum()), int(bad.sum())

    def _save(self, part: MovablePart) -> None:
        self._points, self._parameter = part.points.copy(), part.seats.parameter.copy()

    def keep_better(self, part: MovablePart) -> None:
        """Remember the positions of `part` unless more elements are inverted there."""
        badness = self._measure(part)
        if badness <= self._badness:
            self._badness = badness
            self._save(part)

    def restore(self, part: MovablePart) -> None:
        """Write the best positions to `part`."""
        part.points[:] = self._points
        part.seats.parameter[:] = self._parameter


def _run(part: MovablePart, dropped: np.ndarray, polish: int, rounds: int = ROUNDS) -> int:
    """Minimise the energy of all corners but the `dropped` ones, from the part's positions."""
    assert part.frame is not None
    axes = part.frame[:2]
    # a unit square, and the equilateral triangle of side 1
    ideal = np.sqrt(0.1875) if part.elements.shape[1] == 3 else 1.0
    targets = _target_areas(part.elements, _signed_areas(part)) / ideal
    unit = float(np.sqrt(targets.mean()))
    problem, x = energy_problem(part, dropped, unit, targets)
    if not len(x) or not (len(problem.corners) or problem.active.any()):
        return 0
    _, evaluations = unfold(problem, x, UNFOLDING, rounds, INNER, polish, SHAPING)
    free, slides = np.flatnonzero(part.free), np.flatnonzero(part.sliding)
    flat = part.points[free] @ axes.T
    part.points[free] += (problem.points[free] * unit + problem.centre - flat) @ axes
    part.seats.parameter[slides] = x[problem.variable[slides]] * unit
    part.settle()
    return int(evaluations)


def energy_problem(
    part: MovablePart, dropped: np.ndarray, unit: float, targets: np.ndarray
) -> tuple[Problem, np.ndarray]:
    """The arrays of the energy in units of `unit`, and the variables (v,) at the present positions.

    Args:
        part: what moves.
        dropped: (m, k) corners that are left out.
        unit: of length.
        targets: (m,) areas that the elements should have, of triangles times 16/sqrt(27).
    """
    assert part.frame is not None
    axes, seats, curved = np.ascontiguousarray(part.frame[:2]), part.seats, part.curved
    flat = part.points @ axes.T
    centre = flat.mean(axis=0)
    points = (flat - centre) / unit
    count = np.where(part.free, 2, np.where(part.sliding, 1, 0))
    variable = np.where(count > 0, np.cumsum(count) - count, -1)
    x = np.zeros(int(count.sum()))
    free, slides = np.flatnonzero(part.free), np.flatnonzero(part.sliding)
    x[variable[free]], x[variable[free] + 1] = points[free].T
    x[variable[slides]] = seats.parameter[slides] / unit

    corners, rows = _straight_corners(part, dropped, variable)
    scale = unit * unit / targets
    gaps, offsets, share = _gaps(part, variable)
    triangles = part.elements.shape[1] == 3
    return Problem(
        points=np.ascontiguousarray(points),
        tangent=np.zeros_like(points),
        variable=variable,
        seat=seats.curve,
        offset=seats.offset @ axes.T / unit,
        drift=seats.slope @ axes.T,
        curves=part.curves,
        axes=axes,
        centre=centre,
        unit=np.array([unit]),
        corners=corners,
        scale=np.ascontiguousarray(scale[rows]),
        shape=np.array([4 / 3, 4 / 3, np.sqrt(4 / 3)] if triangles else [1.0, 0.0, 1.0]),
        gaps=gaps,
        offsets=offsets / unit,
        gap_scale=unit / share,
        curved=curved._replace(parameter=seats.parameter.copy()),
        curved_scale=np.ascontiguousarray(scale[curved.element]),
        active=(variable[part.elements[curved.element]] >= 0).any(axis=1),
        slight=_side_turning(part, curved) <= SLIGHT,
        dropped=np.ascontiguousarray(dropped[curved.element]),
        differences=DIFFERENCES,
    ), x


def _straight_corners(
    part: MovablePart, dropped: np.ndarray, variable: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Vertex, next and previous one of each corner in the energy of straight elements (c, 3), and
    the rows (c,) of their elements.
    """
    elements = part.elements
    turned = np.stack([elements, np.roll(elements, -1, 1), np.roll(elements, 1, 1)], axis=2)
    used = ~dropped & (part.curved.row < 0)[:, None]
    if elements.shape[1] == 3:
        used = np.column_stack([used.all(axis=1), np.zeros((len(used), 2), bool)])
    # corners that nothing moves would only add a constant
    used = used & (variable[turned] >= 0).any(axis=2)
    return np.ascontiguousarray(turned[used]), np.nonzero(used)[0]


def _spans(curved: CurvedElements) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (r, 2) at the ends of the curved sides, and their parameters (r, 2)."""
    rows, places = np.nonzero(curved.sides >= 0)
    elements, order = curved.elements[curved.element[rows]], curved.sides[rows, places]
    ends = np.zeros((len(curved.curve), 2), np.int64)
    at = np.arange(len(rows))
    ends[order, 0] = elements[at, places]
    ends[order, 1] = elements[at, (places + 1) % elements.shape[1]]
    return ends, curved.base + curved.parameter[ends]


def _side_turning(part: MovablePart, curved: CurvedElements) -> np.ndarray:
    """(c,) the largest turning of a side of each curved element."""
    _, spans = _spans(curved)
    turned = np.append(turnings(part.curves, part.turning, curved.curve, spans), 0.0)
    found: np.ndarray = turned[curved.sides].max(axis=1, initial=0.0)
    return found


def _signed_areas(part: MovablePart) -> np.ndarray:
    """(m,) signed areas of the elements of a plane part, with their curved sides."""
    assert part.frame is not None
    areas = vector_areas(part.points, part.elements)
    curved = part.curved
    if len(curved.element):
        ends, spans = _spans(curved)
        more = bulges(part.curves, curved.curve, spans, part.points[ends], NODES, WEIGHTS)
        more = np.vstack([more, np.zeros(3)])
        areas[curved.element] += more[curved.sides].sum(axis=1)
    signed: np.ndarray = areas @ part.frame[2]
    return signed


def _gaps(part: MovablePart, variable: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The gaps between neighbours on sides: variables (g, 2) at both ends, -1 for one that stays;
    what the gap has besides their difference (g,); the mean gap on the curve (g,).
    """
    seats = part.seats
    i = np.flatnonzero(part.sliding)
    before, after = seats.before[i], seats.after[i]
    ends = np.where(after >= 0, seats.parameter[after], 0.0) + seats.high[i]
    # a gap between two sliding vertices is counted at the first of them
    first = i[before < 0]
    pairs = np.concatenate(
        [
            np.column_stack([np.full(len(first), -1), variable[first]]),
            np.column_stack([variable[i], np.where(after >= 0, variable[after], -1)]),
        ]
    ).astype(np.int64)
    offsets = np.concatenate([-seats.low[first], seats.high[i]])
    size = np.concatenate([seats.parameter[first] - seats.low[first], ends - seats.parameter[i]])
    curve = seats.curve[np.concatenate([first, i])]
    total, number = np.bincount(curve, size), np.bincount(curve)
    return pairs, offsets, (total / np.maximum(number, 1))[curve]


def _target_areas(elements: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """(m,) areas that elements should have: all the same, or smoothed ones where little is folded.

    The sum of the signed areas is that of the part, however tangled it is.
    """
    total, unsigned = abs(areas.sum()), np.abs(areas).sum()
    mean = max(total, 1e-3 * unsigned, 1e-300) / len(areas)
    if unsigned > 1.05 * total:
        return np.full(len(areas), mean)
    corners = elements.ravel()
    count = np.maximum(np.bincount(corners), 1)
    smoothed = np.maximum(np.abs(areas), 1e-3 * mean)
    for _ in range(3):
        at_vertex = np.bincount(corners, np.repeat(smoothed, elements.shape[1])) / count
        smoothed = at_vertex[elements].mean(axis=1)
    return smoothed * (mean / smoothed.mean())
