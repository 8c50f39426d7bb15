"""Improving a mesh while its elements keep their size.

Quad meshes go by way of blocks: the domain is meshed coarsely, decomposed into blocks at s*, and
the chords of the blocks are divided to the sizes of the given mesh. Otherwise, or where that has
folds or worse corners than permitted, the mesh is changed in place: operations of a search that
does not coarsen, as many of them as fit. What fits is the same in both cases: no inverted element,
about as many elements, no worse a worst corner than before or than the target.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search import solver
from meshwright_agent.search.annealing import Operations
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.layout_search import Preference
from meshwright_agent.search.solution import Solution
from meshwright_core.analysis.chord_counts import counts_for_total
from meshwright_core.analysis.element_division import chords, divided, wanted_pieces
from meshwright_core.domains.coarse_remesh import coarse_mesh, on_curves_of
from meshwright_core.errors import MeshError
from meshwright_core.geometry import smoothing
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
SWEEPS = (0, 4, 20)
"""Sweeps of smoothing after a division, the best of which counts; more of them follow the sizes of
the given mesh less."""
LAYOUT_SHARE = 0.6
"""Share of the time for the search of blocks, of what dividing and writing leave of it."""
SECONDS_EACH = 4e-5
"""Seconds that dividing, smoothing and measuring take for each element of the answer."""
PARTS = 12
"""The most states on the way to the end of a search that are tried as answers."""
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
    valid: bool
    """Whether it must be without inverted elements, as the given mesh is."""

    @classmethod
    def of(cls, mesh: HalfEdgeMesh, preference: Preference) -> Fit:
        """For answers to `mesh`: the floor is its own worst corner, or the target if that is less.

        With s > s* the best that s* permits may be less than what the mesh has; it counts only
        up to the target then.
        """
        target = preference.aims(attainable_bound(mesh), shape_bound(mesh)).target
        worst = float(scaled_jacobian(mesh).min(initial=1.0))
        sound = not len(inverted(mesh))
        return cls(SizeField(mesh), mesh.n_elements, min(worst, target), sound)

    def faults(self, mesh: HalfEdgeMesh) -> tuple[str, ...]:
        """What is wrong with an answer, in words; nothing if it fits."""
        found = []
        bad, worst = len(inverted(mesh)), float(scaled_jacobian(mesh).min(initial=1.0))
        if bad and self.valid:
            found.append(f"{bad:,} elements would be inverted")
        if worst < self.floor - LOSS and (self.valid or worst <= 0.0):
            found.append(f"the worst scaled Jacobian would fall to {worst:.2f}")
        if abs(mesh.n_elements - self.elements) > max(MOST_OFF * self.elements, 1.0):
            found.append(f"there would be {mesh.n_elements:,} elements")
        return tuple(found)

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
    began = time.perf_counter()
    fit = Fit.of(mesh, preference)

    def left() -> float | None:
        return None if seconds is None else max(0.0, seconds - (time.perf_counter() - began))

    common: dict[str, Any] = {
        "rollouts": rollouts, "max_steps": max_steps, "seed": seed, "workers": workers,
        "prefer": preference.prefer, "min_shape": preference.min_shape, "cancelled": cancelled,
    }  # fmt: skip
    target = preference.aims(attainable_bound(mesh), shape_bound(mesh)).target
    best = Kept(mesh.copy(), [], "none", None, 0, "", target)
    done, obstacles, blocks = 0, list[str](), None
    sound = fit.valid and float(scaled_jacobian(mesh).min(initial=1.0)) >= target - LOSS
    if mesh.score == mesh.optimum and sound:
        best.reason = "s = s* and the target shape are there already"
        return best
    reserve = SECONDS_EACH * mesh.n_elements
    if by_blocks and mesh.kind == "quad" and mesh.n_elements > 1:
        share = None if seconds is None else max(0.05, LAYOUT_SHARE * ((left() or 0.0) - reserve))
        made, blocks = _by_blocks(mesh, policy, fit, share, partial(solver.solve, **common), seed)
        done += blocks.rollouts if blocks is not None else 0
        if made is not None:
            obstacles += fit.faults(made)
            if fit.rank(made) < fit.rank(best.mesh):
                reason = "at the optimum" if made.score == made.optimum else ""
                best = Kept(made, [], "blocks", blocks, done, reason, target)
    over = cancelled is not None and cancelled()
    enough = best.method == "blocks" and best.mesh.score == mesh.optimum
    if not over and not (enough and fit.sized(best.mesh) >= USUAL) and left() != 0.0:
        free = left()
        share = None if free is None else max(0.05, free - 2.0 * reserve)
        found = solver.solve(
            mesh, policy, seconds=share, coarsen=False, progress=progress, **common
        )
        done += found.rollouts
        there = None if seconds is None else began + seconds
        made, operations, obstacle = _in_place(mesh, found, fit, there)
        obstacles += [obstacle] if obstacle else []
        if fit.rank(made) < fit.rank(best.mesh):
            best = Kept(made, operations, "in place", blocks, done, found.reason, target)
    if best.method == "none" and not over:
        smoothed = _smoothed(mesh)
        if fit.rank(smoothed) < fit.rank(best.mesh):
            best = replace(best, mesh=smoothed, method="smoothing")
    lowest = best.mesh.score == mesh.optimum
    if obstacles and not lowest:
        best.reason = f"at a lower s {obstacles[0]}"
    best.rollouts, best.blocks = done, blocks
    best.reason = best.reason or _ended(seconds, over, lowest)
    return best


def _ended(seconds: float | None, over: bool, lowest: bool) -> str:
    if over:
        return "cancelled"
    if lowest:
        return "at the optimum"
    return "all rollouts are made" if seconds is None else f"all {seconds:g} seconds are used"


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
    seconds: float | None,
    search: Callable[..., Solution],
    seed: int,
) -> tuple[HalfEdgeMesh | None, Solution | None]:
    """The blocks of the domain divided to size, if there are any, and the search for them."""
    start = coarse_mesh(mesh, 0)
    if start is None and mesh.n_elements > solver.LAYOUTS:
        return None, None
    begin = mesh if start is None else start
    found = search(begin, policy, seconds=seconds)
    layout = begin.copy()
    if not found.carry_out(layout):
        return None, found
    best = None
    for total in _totals(fit.elements):
        try:
            made = divided_to_size(layout, fit.field, total)
            if start is not None:
                made = on_curves_of(mesh, made)
        except MeshError:
            continue
        made = _placed(made, fit)
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


def _placed(made: HalfEdgeMesh, fit: Fit) -> HalfEdgeMesh:
    """A divided mesh smoothed as far as is good for it."""
    best = made
    for sweeps in SWEEPS:
        trial = made
        if sweeps:
            trial = made.copy()
            moved = smoothing.smooth(trial, iterations=sweeps)
            if len(moved[0]):
                trial.move(*moved)
            if len(inverted(trial)):
                smoothing.relax(trial)
        if fit.rank(trial) < fit.rank(best):
            best = trial
    return best


def _in_place(
    mesh: HalfEdgeMesh, found: Solution, fit: Fit, until: float | None
) -> tuple[HalfEdgeMesh, Operations, str]:
    """The mesh after as many operations of a solution as fit, these, and what is wrong with the
    others.
    """
    reached = mesh.copy()
    found.carry_out(reached)
    faults = fit.faults(reached)
    if not faults:
        return reached, found.operations, ""
    best, chosen = mesh.copy(), list[Any]()
    scores, work = [mesh.score], mesh.copy()
    for operation, h in found.operations:
        work.apply(operation, h)
        scores.append(work.score)
    lowest = np.unique(scores)[:: max(1, len(np.unique(scores)) // PARTS)]
    for score in lowest.tolist():
        if score >= best.score or (until is not None and time.perf_counter() > until):
            break
        length = scores.index(score)
        part = replayed(mesh, found.operations[:length])
        smoothing.relax(part)
        if not fit.faults(part):
            best, chosen = part, found.operations[:length]
    return best, chosen, faults[0]
