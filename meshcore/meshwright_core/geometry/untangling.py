"""Untangling: positions at which every element of a plane mesh is positively oriented.

The foldover-free energy (:mod:`meshwright_core.geometry.foldover_energy`) is minimised from the
present positions first
and, if elements stay inverted, from other starts. Corners that no position can unfold (a single
quad at a reflex corner of the outline, a boundary vertex of one element on a straight side, a
doublet) are left out of the energy, found beforehand, and their elements reported.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry import movable_part
from meshwright_core.geometry.foldover_energy import Problem, unfold
from meshwright_core.geometry.initial_guesses import hold_single_quads, starts
from meshwright_core.geometry.outline import Polylines
from meshwright_core.geometry.movable_part import Region
from meshwright_core.geometry.unfixable import unfixable_corners

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
POLISH = 60
"""Steps for shape once nothing is folded."""


@dataclass(frozen=True)
class Untangled:
    """What :func:`untangle` found; nothing is written to the mesh."""

    vertices: np.ndarray
    """(n,) ids of the vertices that have moved."""
    positions: np.ndarray
    """(n, 3) their new positions."""
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
    region = movable_part.chosen(mesh, vertices)
    starts, evaluations = untangle_region(region, polish, seed)
    moved, positions = region.changed(mesh)
    bad = region.inverted_rows()
    unfixable = bad & unfixable_corners(region).any(axis=1)
    return Untangled(
        vertices=moved,
        positions=positions,
        inverted=np.sort(region.element_ids[bad]),
        unfixable=np.sort(region.element_ids[unfixable]),
        starts=starts,
        evaluations=evaluations,
    )


def untangle_region(
    region: Region, polish: int = POLISH, seed: int = 0, tries: int = ALL
) -> tuple[int, int]:
    """Untangle `region` in place, from at most `tries` starts.

    Returns the number of starts and of energy evaluations.
    """
    if region.frame is None or not region.movable.any():
        return 0, 0
    region.settle()
    lost = unfixable_corners(region)
    best, present = _BestPositions(region, lost), _BestPositions(region, lost)
    tried = evaluations = 0
    for start in starts(region, np.random.default_rng(seed))[:tries]:
        if tried >= 3 and evaluations * region.elements.size > BUDGET:
            break
        present.restore(region)
        start(region)
        tried += 1
        evaluations += _run(hold_single_quads(region), lost, polish)
        best.keep_better(region)
        if best.done:
            break
    if not best.done:
        # leave out the corners that stay folded, so that they do not distort others
        best.restore(region)
        evaluations += _run(region, lost | region.folded(), polish)
        best.keep_better(region)
    best.restore(region)
    return tried, evaluations


class _BestPositions:
    """The best positions of a region so far."""

    def __init__(self, region: Region, unfixable: np.ndarray) -> None:
        self._unfixable = unfixable.any(axis=1)
        self._badness = self._measure(region)
        self._save(region)

    @property
    def done(self) -> bool:
        """Whether no element is inverted but the unfixable ones."""
        return self._badness[0] == 0

    def _measure(self, region: Region) -> tuple[int, int]:
        bad = region.inverted_rows()
        return int((bad & ~self._unfixable).sum()), int(bad.sum())

    def _save(self, region: Region) -> None:
        self._points, self._parameter = region.points.copy(), region.seats.parameter.copy()

    def keep_better(self, region: Region) -> None:
        """Remember the positions of `region` unless more elements are inverted there."""
        badness = self._measure(region)
        if badness <= self._badness:
            self._badness = badness
            self._save(region)

    def restore(self, region: Region) -> None:
        """Write the best positions to `region`."""
        region.points[:] = self._points
        region.seats.parameter[:] = self._parameter


def _run(region: Region, dropped: np.ndarray, polish: int) -> int:
    """Minimise the energy of all corners but the `dropped` ones, from the region's positions."""
    assert region.frame is not None
    axes = region.frame[:2]
    flat = region.points @ axes.T
    areas = _signed_areas(flat, region.elements)
    triangles = region.elements.shape[1] == 3
    # a unit square, and the equilateral triangle of side 1
    ideal = np.sqrt(0.1875) if triangles else 1.0
    targets = _target_areas(region.elements, areas) / ideal
    unit = float(np.sqrt(targets.mean()))
    centre = flat.mean(axis=0)
    problem, x = energy_problem(region, dropped, (flat - centre) / unit, centre, unit, targets)
    if not len(problem.corners) or not len(x):
        return 0
    _, evaluations = unfold(problem, x, UNFOLDING, ROUNDS, INNER, polish, SHAPING)
    free, slides = np.flatnonzero(region.free), np.flatnonzero(region.sliding)
    region.points[free] += (problem.points[free] * unit + centre - flat[free]) @ axes
    region.seats.parameter[slides] = x[problem.variable[slides]] * unit
    region.settle()
    return int(evaluations)


def energy_problem(
    region: Region,
    dropped: np.ndarray,
    points: np.ndarray,
    centre: np.ndarray,
    unit: float,
    targets: np.ndarray,
) -> tuple[Problem, np.ndarray]:
    """The arrays of the energy in units of `unit`, and the variables (v,) at `points` (n, 2)."""
    assert region.frame is not None
    elements, seats = region.elements, region.seats
    count = np.where(region.free, 2, np.where(region.sliding, 1, 0))
    variable = np.where(count > 0, np.cumsum(count) - count, -1)
    x = np.zeros(int(count.sum()))
    free, slides = np.flatnonzero(region.free), np.flatnonzero(region.sliding)
    x[variable[free]], x[variable[free] + 1] = points[free].T
    x[variable[slides]] = seats.parameter[slides] / unit

    k = elements.shape[1]
    triangles = k == 3
    turned = np.stack([elements, np.roll(elements, -1, 1), np.roll(elements, 1, 1)], axis=2)
    used = ~dropped
    if triangles:
        used = np.column_stack([used.all(axis=1), np.zeros((len(used), 2), bool)])
    # corners that nothing moves would only add a constant
    used = used & (variable[turned] >= 0).any(axis=2)
    scale = np.broadcast_to((unit * unit / targets)[:, None], (len(elements), k))

    gaps, offset, share = _gaps(region, variable)
    flat_sides = Polylines(
        points=np.ascontiguousarray((region.sides.points @ region.frame[:2].T - centre) / unit),
        arc=region.sides.arc / unit,
        first=region.sides.first,
        closed=region.sides.closed,
    )
    return Problem(
        points=np.ascontiguousarray(points),
        tangent=np.zeros_like(points),
        variable=variable,
        side=seats.side,
        sides=flat_sides,
        corners=np.ascontiguousarray(turned[used]),
        scale=np.ascontiguousarray(scale[used]),
        shape=np.array([4 / 3, 4 / 3, np.sqrt(4 / 3)] if triangles else [1.0, 0.0, 1.0]),
        gaps=gaps,
        offset=offset / unit,
        gap_scale=unit / share,
    ), x


def _gaps(region: Region, variable: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The gaps between neighbours on sides: variables (g, 2) at both ends, -1 for one that stays;
    what the gap has besides their difference (g,); the mean gap of the side (g,).
    """
    seats = region.seats
    pairs, offset, size, side = [], [], [], []
    for i in np.flatnonzero(region.sliding).tolist():
        before, after = int(seats.before[i]), int(seats.after[i])
        if before < 0:
            pairs.append((-1, variable[i]))
            offset.append(-seats.low[i])
            size.append(seats.parameter[i] - seats.low[i])
            side.append(seats.side[i])
        # a gap between two sliding vertices is counted at the first of them
        pairs.append((variable[i], variable[after] if after >= 0 else -1))
        offset.append(seats.high[i])
        end = seats.high[i] + (seats.parameter[after] if after >= 0 else 0.0)
        size.append(end - seats.parameter[i])
        side.append(seats.side[i])
    sides = np.array(side, np.int64)
    mean = np.bincount(sides, size) / np.maximum(np.bincount(sides), 1) if side else np.zeros(0)
    return np.array(pairs, np.int64).reshape(-1, 2), np.array(offset, float), mean[sides]


def _signed_areas(points: np.ndarray, elements: np.ndarray) -> np.ndarray:
    """(m,) signed areas of plane elements (m, k) at points (n, 2)."""
    p = points[elements] - points[elements[:, :1]]
    q = np.roll(p, -1, axis=1)
    area: np.ndarray = 0.5 * (p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]).sum(axis=1)
    return area


def _target_areas(elements: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """(m,) areas that elements should have: all the same, or smoothed ones where little is folded.

    The sum of the signed areas is that of the region, however tangled it is.
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
