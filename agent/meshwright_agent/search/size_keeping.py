"""Improving a mesh while its elements keep their size.

Quad meshes go by way of blocks: the domain is meshed coarsely, decomposed into blocks at s*, and
the chords of the blocks are divided to the sizes of the given mesh. Otherwise, or where that has
folds or worse corners than permitted, the mesh is changed in place: operations of a search that
does not coarsen, as many of them as fit. What fits is the same in both cases: no inverted element,
about as many elements, no worse a worst corner, nor a worst shape, than before or than the target.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any

import numpy as np

from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search import solver
from meshwright_agent.search.annealing import Operations
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.drawn_patches import improve_within, near
from meshwright_agent.search.layout_search import LAYOUTS, Preference
from meshwright_agent.search.patchwise import is_large
from meshwright_agent.search.solution import Solution
from meshwright_core.analysis.chord_counts import counts_for_total
from meshwright_core.analysis.element_division import chords, divided, wanted_pieces
from meshwright_core.domains.coarse_remesh import coarse_mesh, on_curves_of
from meshwright_core.domains.meshing import grid
from meshwright_core.errors import MeshError
from meshwright_core.geometry import smoothing
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.quality import inverted, scaled_jacobian
from meshwright_core.geometry.shape_bound import attainable_bound, shape_bound
from meshwright_core.geometry.size_field import SizeField
from meshwright_core.mesh import HalfEdgeMesh

MOST_OFF = 0.25
"""How far the number of elements may be off, relative to that of the given mesh."""
TWICE = 2.0
"""Factor by which the local size may be off."""
USUAL = 0.95
"""Share of the elements whose size must be within it for the first answer to do."""
ENOUGH = int(20 * USUAL)
SWEEPS = (4, 20)
"""Sweeps of smoothing after a division; the best mesh counts. More of them follow the sizes of the
given mesh less."""
LAYOUT_SHARE, HARD_SHARE = 0.7, 0.3
"""Share of the time for the search of blocks, of what dividing leaves of it; and where the coarse
mesh that it begins with is more irregular than the given one, so that there is more to do."""
DIVIDED, AFTER_SEARCH, SMOOTHED, UNITS_A_SWEEP = 15.0, 6.0, 20.0, 1.0
"""Time of some work, in units of the time to measure all elements once: dividing blocks with few
sweeps of smoothing; measuring what a search has found; smoothing and untangling; a sweep."""
FIRST_RUN, SMALL_RUN, ATTEMPTS, ROUNDS = 0.4, 0.6, 6, 4
"""Share of the time that is left for each run in place, for the first one on meshes that are not
large, the most of them after a search, and the most searches."""
FEW = 4
"""Bad elements that are untangled together."""
LOSS = 1e-6
"""Loss of the worst scaled Jacobian that is within rounding."""


@dataclass(frozen=True)
class Fit:
    """What an answer that keeps the size of a mesh must be like."""

    field: SizeField
    elements: int
    """Of the given mesh."""
    floor: float
    """Least worst scaled Jacobian."""
    shape_floor: float
    """Least worst shape, which sees the ratio of the sides."""
    valid: bool
    """Whether it must be without inverted elements, as the given mesh is."""

    @classmethod
    def of(cls, mesh: HalfEdgeMesh, preference: Preference) -> Fit:
        """For answers to `mesh`: the floors are its worst element, or the target if that is less.

        With s > s* the best that s* permits may be less than what the mesh has; it counts only
        up to the target then.
        """
        target = preference.aims(attainable_bound(mesh), shape_bound(mesh)).target
        worst = float(scaled_jacobian(mesh).min(initial=1.0))
        sound = not len(inverted(mesh))
        shape = float(element_shapes(mesh).min(initial=1.0))
        floors = min(worst, target), min(shape, target)
        return cls(SizeField(mesh), mesh.n_elements, *floors, sound)

    def faults(self, mesh: HalfEdgeMesh) -> tuple[str, ...]:
        """What is wrong with an answer, in words; nothing if it fits."""
        found = []
        bad, worst = len(inverted(mesh)), float(scaled_jacobian(mesh).min(initial=1.0))
        if bad and self.valid:
            found.append(f"{bad:,} elements would be inverted")
        if worst < self.floor - LOSS and (self.valid or worst <= 0.0):
            found.append(f"the worst scaled Jacobian would fall to {worst:.2f}")
        else:
            shape = float(element_shapes(mesh).min(initial=1.0))
            if shape < self.shape_floor - LOSS and (self.valid or shape <= 0.0):
                found.append(f"the worst shape would fall to {shape:.2f}")
        if abs(mesh.n_elements - self.elements) > max(MOST_OFF * self.elements, 1.0):
            found.append(f"there would be {mesh.n_elements:,} elements")
        return tuple(found)

    def bad(self, mesh: HalfEdgeMesh) -> np.ndarray:
        """Ids, ascending, of the elements that are inverted or worse than the floors."""
        worse = scaled_jacobian(mesh) < self.floor - LOSS
        worse |= element_shapes(mesh) < self.shape_floor - LOSS
        found: np.ndarray = np.union1d(inverted(mesh), mesh.element_ids()[worse])
        return found

    def sized(self, mesh: HalfEdgeMesh) -> float:
        """Share of the elements whose size is off by no more than the factor TWICE."""
        ratios = self.field.ratios(mesh)
        return float(((ratios <= TWICE) & (ratios >= 1.0 / TWICE)).mean())

    def rank(self, mesh: HalfEdgeMesh) -> tuple[int, int, int, float]:
        """Answers with a lower rank are better: fits; lower s; sizes; worst scaled Jacobian."""
        sizes = int(20.0 * min(self.sized(mesh), USUAL))
        worst = float(scaled_jacobian(mesh).min(initial=1.0))
        return len(self.faults(mesh)), mesh.score, -sizes, -worst


@dataclass
class Kept:
    """An answer that keeps the size of the given mesh."""

    mesh: HalfEdgeMesh
    operations: Operations
    """Those that lead to it in place; none if it came by way of blocks."""
    method: str
    """"blocks", "in place", "smoothing" or "none"."""
    blocks: Solution | None
    """The search for blocks, if there was one."""
    rollouts: int
    reason: str
    """Why the search ended, or what stands in the way of a lower s."""
    target: float
    """Worst scaled Jacobian that was aimed at."""


def keep_size(
    mesh: HalfEdgeMesh,
    policy: Policy,
    *,
    preference: Preference,
    by_blocks: bool = True,
    rollouts: int | None = None,
    seconds: float | None = None,
    max_steps: int | None = None,
    seed: int = 0,
    workers: int = 1,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Kept:
    """An improved mesh with elements of the same size as those of `mesh`, which is not changed.

    Where none fits, the answer is a copy of the mesh, and the reason says why.

    Args:
        mesh: the start.
        policy: for meshes of the same kind.
        preference: what counts besides s.
        by_blocks: whether quads may go by way of blocks; otherwise only operations change the mesh.
        rollouts: these and the others as for :func:`meshwright_agent.search.solver.solve`.
        seconds: time limit of all together.
        max_steps: of a rollout.
        seed: of the random choices.
        workers: number of threads.
        progress: called with (rollouts done, lowest s).
        cancelled: polled.
    """
    if seconds is not None:
        solver.prepare(policy)
        _prepare(mesh.kind)
    clock = _Clock(seconds, cancelled)
    fit = Fit.of(mesh, preference)
    clock.unit = clock.used
    common: dict[str, Any] = {
        "rollouts": rollouts, "max_steps": max_steps, "seed": seed, "workers": workers,
        "prefer": preference.prefer, "min_shape": preference.min_shape, "cancelled": cancelled,
    }  # fmt: skip
    search: Callable[..., Solution] = partial(solver.solve, **common)
    target = preference.aims(attainable_bound(mesh), shape_bound(mesh)).target
    best = Kept(mesh.copy(), [], "none", None, 0, "", target)
    rank = fit.rank(best.mesh)
    if mesh.score == mesh.optimum and fit.valid and -rank[3] >= target - LOSS:
        best.reason = "s = s* and the target shape are there already"
        return best
    done, obstacles, blocks = 0, list[str](), None
    if by_blocks and mesh.kind == "quad" and mesh.n_elements > 1:
        made, blocks = _by_blocks(mesh, policy, fit, clock, search)
        done += blocks.rollouts if blocks is not None else 0
        if made is not None:
            obstacles += fit.faults(made)
            if (other := fit.rank(made)) < rank:
                best, rank = replace(best, mesh=made, method="blocks"), other
    enough = best.method == "blocks" and best.mesh.score == mesh.optimum and -rank[2] >= ENOUGH
    made, operations, obstacle, ended = mesh, list[Any](), "", ""
    if not enough and fit.valid and not is_large(mesh) and not clock.over(AFTER_SEARCH):
        made, operations, obstacle = _patches_that_fit(mesh, policy, None, fit, clock, seed)
    for _ in range(1 if seconds is None else ROUNDS):
        if enough or made.score == mesh.optimum or clock.over(AFTER_SEARCH):
            break
        before, free = made.score, clock.left(AFTER_SEARCH)
        if free is not None:
            free *= FIRST_RUN if is_large(made) else SMALL_RUN
        found = search(made, policy, seconds=free, coarsen=False, progress=progress)
        done, ended = done + found.rollouts, found.reason if seconds is None else ""
        if is_large(made) or fit.valid:
            made, more, obstacle = _patches_that_fit(made, policy, found, fit, clock, seed)
        else:
            made, more, obstacle = _in_place(made, found, fit, clock)
        operations = operations + more
        if made.score == before:
            break
    obstacles += [obstacle] if obstacle else []
    if not enough and (other := fit.rank(made)) < rank:
        best = replace(best, mesh=made, operations=operations, method="in place", reason=ended)
    if best.method == "none" and not clock.over(SMOOTHED):
        smoothed = _smoothed(mesh)
        if fit.rank(smoothed) < rank:
            best = replace(best, mesh=smoothed, method="smoothing")
    lowest = best.mesh.score == mesh.optimum
    if obstacles and not lowest:
        best.reason = f"at a lower s {obstacles[0]}"
    best.rollouts, best.blocks = done, blocks
    early = not clock.over(AFTER_SEARCH + UNITS_A_SWEEP * SWEEPS[-1])
    best.reason = best.reason or _ended(seconds, clock.cancelled, lowest, early)
    return best


class _Clock:
    """The time of one search.

    Args:
        seconds: the limit; None for none.
        cancelled: polled.
    """

    def __init__(self, seconds: float | None, cancelled: Callable[[], bool] | None) -> None:
        self._began, self._seconds, self._cancelled = time.perf_counter(), seconds, cancelled
        self.unit = 0.0
        """Seconds that measuring all elements of the mesh takes on this machine as busy as it is:
        what the duration of work without a limit of its own is estimated by."""

    @property
    def used(self) -> float:
        """Seconds since the beginning."""
        return time.perf_counter() - self._began

    @property
    def cancelled(self) -> bool:
        """Whether the search was cancelled."""
        return self._cancelled is not None and self._cancelled()

    def left(self, units: float) -> float | None:
        """Seconds that are left if work of so many units is to follow; None: no limit."""
        if self._seconds is None:
            return None
        return max(0.02, self._seconds - self.used - units * self.unit)

    def over(self, units: float) -> bool:
        """Whether work of so many units cannot be begun any more."""
        late = self._seconds is not None and self.used + units * self.unit > self._seconds
        return late or self.cancelled


@cache
def _prepare(kind: str) -> None:
    """Compile what is called after the search, or load it."""
    mesh = grid(kind, 32)
    fit = Fit.of(mesh, Preference())
    assert fit.rank(_smoothed(mesh))
    if kind == "quad" and (coarse := coarse_mesh(mesh)) is not None:
        assert on_curves_of(mesh, divided_to_size(coarse, fit.field, 32.0)).n_elements


def _ended(seconds: float | None, cancelled: bool, lowest: bool, early: bool) -> str:
    if cancelled:
        return "cancelled"
    if lowest:
        return "at the optimum"
    if seconds is None:
        return "all rollouts are made"
    return "nothing better was found" if early else f"all {seconds:g} seconds are used"


def _smoothed(mesh: HalfEdgeMesh) -> HalfEdgeMesh:
    """A copy of the mesh at better positions."""
    other = mesh.copy()
    if len(inverted(other)):
        smoothing.relax(other)
    moved = smoothing.smooth(other)
    if len(moved[0]):
        other.move(*moved)
    return other


def _by_blocks(
    mesh: HalfEdgeMesh,
    policy: Policy,
    fit: Fit,
    clock: _Clock,
    search: Callable[..., Solution],
) -> tuple[HalfEdgeMesh | None, Solution | None]:
    """The blocks of the domain divided to size, if there are any, and the search for them."""
    start = coarse_mesh(mesh)
    if (start is None and mesh.n_elements > LAYOUTS) or clock.over(DIVIDED):
        return None, None
    begin = mesh if start is None else start
    left = clock.left(DIVIDED)
    share = LAYOUT_SHARE if begin.score <= mesh.score else HARD_SHARE
    found = search(begin, policy, seconds=None if left is None else share * left)
    layout = begin.copy()
    if not found.carry_out(layout) or (clock.cancelled and mesh.n_elements > LAYOUTS):
        return None, found
    if layout.score > mesh.score and fit.valid:
        return None, found
    best = None
    for total in _totals(fit.elements):
        if best is not None and clock.over(DIVIDED):
            break
        try:
            made = divided_to_size(layout, fit.field, total)
            if start is not None:
                made = on_curves_of(mesh, made)
        except MeshError:
            continue
        made = _placed(made, fit, clock)
        if best is None or fit.rank(made) < fit.rank(best):
            best = made
        if not fit.faults(best):
            break
    return best, found


def _totals(elements: int) -> tuple[float, ...]:
    """Numbers of elements to aim at, one after the other until the answer fits."""
    return (float(elements), 1.15 * elements, 0.87 * elements)


def divided_to_size(layout: HalfEdgeMesh, field: SizeField, total: float) -> HalfEdgeMesh:
    """The layout with its chords divided to the sizes of the field, into about `total` elements.

    Raises MeshError for triangles, or where there would be too many elements.
    """
    crossing = chords(layout)
    wanted = wanted_pieces(layout, field)
    sides = np.tile(crossing, (1, 2)).ravel()
    counts = counts_for_total(crossing, sides, wanted.ravel(), total)
    return divided(layout, counts, field)


def _placed(made: HalfEdgeMesh, fit: Fit, clock: _Clock) -> HalfEdgeMesh:
    """A divided mesh smoothed as far as is good for it."""
    best, rank = made, fit.rank(made)
    for sweeps in SWEEPS:
        if clock.over(UNITS_A_SWEEP * sweeps):
            break
        trial = made.copy()
        moved = smoothing.smooth(trial, iterations=sweeps)
        if len(moved[0]):
            trial.move(*moved)
        if len(inverted(trial)) and not clock.over(SMOOTHED):
            smoothing.relax(trial)
        if (other := fit.rank(trial)) < rank:
            best, rank = trial, other
    return best


def _patches_that_fit(
    mesh: HalfEdgeMesh, policy: Policy, found: Solution | None, fit: Fit, clock: _Clock, seed: int
) -> tuple[HalfEdgeMesh, Operations, str]:
    """The mesh after operations that fit, these, and what is wrong with others.

    Where what was found fits, the search goes on from there, patch by patch; where it has bad
    elements, the patches are improved again without those around them. found: to begin with; None
    for patches from the first on.
    """
    best, chosen, obstacle, last = mesh.copy(), list[Any](), "", ""
    barred = np.zeros(0, np.int64)

    def run(attempt: int, allowed: np.ndarray) -> tuple[HalfEdgeMesh, Operations]:
        left = clock.left(AFTER_SEARCH + UNITS_A_SWEEP * SWEEPS[-1])
        made = improve_within(
            best, policy, allowed, seconds=None if left is None else FIRST_RUN * left,
            seed=seed + attempt, cancelled=lambda: clock.cancelled,
        )  # fmt: skip
        return made.mesh.copy(), made.steps()

    if found is None:
        reached, more = run(ATTEMPTS, best.element_ids())
    else:
        reached, more = _reached(mesh, found), list(found.operations)
    for attempt in range(ATTEMPTS):
        _mend(reached, fit, clock)
        faults, bad = fit.faults(reached), fit.bad(reached)
        if faults:
            obstacle = last = faults[0]
            if not attempt and found is not None and not is_large(mesh):
                best, chosen, _ = _in_place(mesh, found, fit, clock)
            if not len(bad):
                break
            barred = np.union1d(barred, near(best, reached, bad))
        elif reached.score < best.score:
            best, last = reached, ""
            chosen, barred = chosen + more, np.zeros(0, np.int64)
        else:
            break
        allowed = np.setdiff1d(best.element_ids(), barred)
        late = clock.over(AFTER_SEARCH + UNITS_A_SWEEP * SWEEPS[-1])
        if best.score == best.optimum or not len(allowed) or late:
            break
        reached, more = run(attempt, allowed)
    return best, chosen, last or (obstacle if best.score == mesh.score else "")


def _reached(mesh: HalfEdgeMesh, found: Solution) -> HalfEdgeMesh:
    """A mesh after the operations of a solution, at its positions."""
    if found.reached is not None:
        return found.reached.copy()
    reached = mesh.copy()
    found.carry_out(reached)
    return reached


def _mend(mesh: HalfEdgeMesh, fit: Fit, clock: _Clock) -> None:
    """Smooth a mesh, where fewer elements are bad then, and untangle around those that are left."""
    if not fit.faults(mesh) or clock.over(UNITS_A_SWEEP * SWEEPS[-1]):
        return
    bad, smooth = fit.bad(mesh), mesh.copy()
    moved = smoothing.smooth(smooth, iterations=SWEEPS[-1])
    if len(moved[0]):
        smooth.move(*moved)
        if len(left := fit.bad(smooth)) < len(bad):
            mesh.move(*moved)
            bad = left
    for start in range(0, len(bad), FEW):
        if clock.over(AFTER_SEARCH):
            break
        corners = np.unique(mesh.corners(bad[start : start + FEW]))
        smoothing.relax(mesh, corners.tolist(), thorough=False)


def _in_place(
    mesh: HalfEdgeMesh, found: Solution, fit: Fit, clock: _Clock
) -> tuple[HalfEdgeMesh, Operations, str]:
    """The mesh after as many operations of a solution as fit, these, and what is wrong with the
    others.
    """
    reached = _reached(mesh, found)
    faults = fit.faults(reached)
    if not faults:
        return reached, found.operations, ""
    best, chosen = mesh.copy(), list[Any]()
    if clock.over(SMOOTHED):
        return best, chosen, faults[0]
    scores, work = [mesh.score], mesh.copy()
    for operation, h in found.operations:
        work.apply(operation, h)
        scores.append(work.score)
    lower = [i for i, score in enumerate(scores) if score < min(scores[:i], default=mesh.score)]
    fits, fails = -1, len(lower) - 1  # places in this list; the fewer operations, the rarer faults
    while fails - fits > 1 and not clock.over(SMOOTHED):
        place = (fits + fails) // 2
        part = replayed(mesh, found.operations[: lower[place]])
        smoothing.relax(part)
        if fit.faults(part):
            fails = place
        else:
            fits, best, chosen = place, part, found.operations[: lower[place]]
    return best, chosen, faults[0]
