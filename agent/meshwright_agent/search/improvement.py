"""What is asked of an improved mesh besides a low s, and the mesh that is made so.

Three forms of answers: the blocks that a search finds; the same with chords divided until every
element has a wanted shape; and a mesh whose elements keep the size that they had.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search import solver
from meshwright_agent.search.annealing import Operations
from meshwright_agent.search.guarded_coarsening import ALIKE
from meshwright_agent.search.layout_search import Preference
from meshwright_agent.search.size_keeping import keep_size
from meshwright_agent.search.solution import Solution
from meshwright_agent.search.solver import Found
from meshwright_core.analysis.element_division import divided, divisions
from meshwright_core.errors import MeshError
from meshwright_core.geometry import smoothing
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.quality import inverted

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

EXCESS = (1.0, 1.1, 1.25, 1.5, 2.0)
"""What the wanted shape is multiplied by, one after the other, until it is reached: divisions are
found as if elements were parallelograms."""
SKEWEST = 0.97
"""The largest shape that chords are divided for."""
DIVIDING = 0.1
"""Share of the time that is kept for dividing chords and smoothing what comes of it."""
OTHERS = 8
"""The last answers of the search that are divided, too: often one that was found just before takes
far fewer elements."""


@dataclass(frozen=True)
class Wishes:
    """What an answer should be like."""

    prefer: str = "balanced"
    """"blocks", "balanced" or "shape", see :class:`.layout_search.Preference`."""
    min_shape: float | None = None
    """Worst scaled Jacobian beyond which more does not count."""
    elements_shape: float | None = None
    """Shape that every element shall have after chords were divided; None: none are divided."""
    keep_size: bool = False
    """Whether the elements keep the size that they have; otherwise quads become blocks."""
    in_place: bool = False
    """Whether only operations may lead to the answer, as for films and histories."""

    def __post_init__(self) -> None:
        """Raise ValueError, one sentence, for what cannot be asked."""
        self.preference  # noqa: B018 (raises ValueError)
        if self.elements_shape is not None and not 0.0 < self.elements_shape < 1.0:
            raise ValueError(
                f"elements_shape must lie between 0 and 1, not {self.elements_shape:g}"
            )
        if self.elements_shape is not None and self.keep_size:
            raise ValueError("elements that are divided for shape cannot keep their size")

    @property
    def preference(self) -> Preference:
        """That of the search."""
        return Preference(self.prefer, self.min_shape)


@dataclass
class Improved:
    """An improved mesh, and how it was found."""

    mesh: HalfEdgeMesh
    operations: Operations
    """Operations that lead from the start to the mesh, or to its blocks where `divided`; none where
    the mesh came by way of blocks of the domain."""
    start_valid: bool
    """Whether the start had no inverted element."""
    method: str
    divided: bool
    """Whether chords were divided after the operations."""
    size_kept: bool
    rollouts: int
    seconds: float
    reason: str
    """Why the search ended, or what stands in the way of the optimum, in words."""
    target: float
    """Worst scaled Jacobian that was aimed at."""


def improve(
    mesh: HalfEdgeMesh,
    policy: Policy,
    wishes: Wishes,
    *,
    rollouts: int | None = None,
    seconds: float | None = None,
    max_steps: int | None = None,
    seed: int = 0,
    workers: int = 1,
    progress: Callable[[int, int], None] | None = None,
    found: Found | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Improved:
    """The improved mesh; `mesh` is not changed.

    A mesh without inverted elements never becomes one with them. Arguments as for
    :func:`meshwright_agent.search.solver.solve`; `found` is not called where elements keep their
    size, and before any are divided.
    """
    if seconds is not None:
        solver.prepare(policy)
    began = time.perf_counter()
    valid = not len(inverted(mesh))
    if wishes.keep_size:
        kept = keep_size(
            mesh, policy, preference=wishes.preference, by_blocks=not wishes.in_place,
            rollouts=rollouts, seconds=seconds, max_steps=max_steps, seed=seed, workers=workers,
            progress=progress, cancelled=cancelled,
        )  # fmt: skip
        return Improved(
            kept.mesh, kept.operations, valid, kept.method, False, True, kept.rollouts,
            time.perf_counter() - began, kept.reason, kept.target,
        )  # fmt: skip
    dividing = wishes.elements_shape is not None and mesh.kind == "quad"
    searching = seconds if seconds is None or not dividing else (1.0 - DIVIDING) * seconds
    answers: list[Solution] = []

    def note(answer: Solution) -> None:
        if dividing:
            answers.append(answer)
            del answers[:-OTHERS]
        if found is not None:
            found(answer)

    best = solver.solve(
        mesh, policy, rollouts=rollouts, seconds=searching, max_steps=max_steps, seed=seed,
        workers=workers, prefer=wishes.prefer, min_shape=wishes.min_shape, progress=progress,
        found=note, cancelled=cancelled,
    )  # fmt: skip
    reached = mesh.copy()
    if not best.carry_out(reached):
        relaxed = reached.copy()
        smoothing.relax(relaxed)
        if len(inverted(relaxed)) <= len(inverted(reached)):
            reached = relaxed
    chosen, answer, fault = best, reached, ""
    if dividing and wishes.elements_shape is not None:
        others = [
            (one, one.reached) for one in reversed(answers)
            if one.score == best.score and not one.inverted and one.reached is not None
        ]  # fmt: skip
        chosen, answer, fault = _divided_for(
            [(best, reached), *others], wishes.elements_shape,
            lambda: seconds is not None and time.perf_counter() - began > seconds,
        )  # fmt: skip
    return Improved(
        answer, list(chosen.operations), valid, best.method,
        answer.n_elements > chosen.elements, False, best.rollouts,
        time.perf_counter() - began, best.reason + fault, best.aims.target,
    )  # fmt: skip


def _divided_for(
    answers: list[tuple[Solution, HalfEdgeMesh]], least: float, over: Callable[[], bool]
) -> tuple[Solution, HalfEdgeMesh, str]:
    """The answer that is best after dividing, its mesh then, and what is wrong with it, in words.

    answers: with their meshes, the best first, whose worst corner, up to the target, no other falls
    short of. Better is what has elements of shape `least`; then fewer elements. over: whether no
    more of them shall be tried.
    """
    first, blocks = answers[0]
    if len(inverted(blocks)):
        return first, blocks, "; blocks with inverted elements are not divided"
    worst = min(first.worst_scaled_jacobian, first.aims.target)
    best, mesh, shape = first, *_divided(blocks, least)
    for answer, other in answers[1:]:
        if over():
            break
        if answer.worst_scaled_jacobian < worst - ALIKE:
            continue
        trial, reached = _divided(other, least)
        rank, usual = (
            (-min(reached, least), trial.n_elements),
            (-min(shape, least), mesh.n_elements),
        )
        if rank < usual:
            best, mesh, shape = answer, trial, reached
    if shape < least:
        return best, mesh, f"; dividing does not raise the worst shape beyond {shape:.2f}"
    return best, mesh, ""


def _divided(blocks: HalfEdgeMesh, least: float) -> tuple[HalfEdgeMesh, float]:
    """The blocks divided until every element has a shape of `least`, or as far as their skewness
    permits, and the worst shape; the blocks themselves where no division is needed or possible.
    """
    best, shape, pieces = blocks, float(element_shapes(blocks).min(initial=1.0)), None
    for excess in EXCESS:
        if shape >= least:
            break
        try:
            count = divisions(blocks, min(excess * least, SKEWEST))
        except MeshError:
            break
        if pieces is not None and (count == pieces).all():
            continue
        pieces = count
        for trial in _positions(divided(blocks, pieces)):
            worst = float(element_shapes(trial).min(initial=1.0))
            if worst > shape + 1e-9:
                best, shape = trial, worst
    return best, shape


def _positions(mesh: HalfEdgeMesh) -> list[HalfEdgeMesh]:
    """A divided mesh as it is, and smoothed."""
    smooth = mesh.copy()
    moved = smoothing.smooth(smooth)
    if len(moved[0]):
        smooth.move(*moved)
    kept: list[HalfEdgeMesh] = [one for one in (mesh, smooth) if not len(inverted(one))]
    return kept
