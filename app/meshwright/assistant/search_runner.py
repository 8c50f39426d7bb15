"""Adapts the solver to the runner interface: searches, then returns its operations.

Qt and torch are not imported here; the first step imports torch, on the assistant's thread.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from threading import Event
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.document.verdict import largest_delta
from meshwright_core import HalfEdgeMesh, Operation
from meshwright_core.core.arrays import FLAGS, LOCKED
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.element_sines import THIN
from meshwright_core.geometry.quality import inverted, scaled_jacobian

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight
    from meshwright_agent.search.solution import Solution

COMPLETE_SECONDS = 3.0
"""Time of a round of *Complete*; after one that has won nothing the next gets twice as much."""
LAYOUT_SECONDS = 12.0
"""The same from the second round on where layouts are searched for shape: with less time for each
round less comes of all together."""
SIZE_SECONDS = 10.0
"""Time of *Complete* where the elements keep their size."""
PATIENCE = 2
"""Rounds without success after which *Complete* ends."""
MANY_BLOCKS = 20
"""Quads beyond which *Complete* does not end with its first, short round."""
NOTHING_BETTER = "nothing better was found in {:.0f} s"
PREFERENCES = ("blocks", "balanced", "shape")
"""What counts at s*: few blocks, a good worst corner, or both."""
_SPREAD = 4
"""Where the sum of squares stands in the rank of a solution."""
NEAR = 1e-3
"""How far below the aim a shape may be and still count as reached."""


@dataclass(frozen=True)
class ShapeGoal:
    """The worst scaled Jacobian of a quad mesh, the one that a search aims at, and the worst
    element shape, by which a search sees long thin elements.
    """

    worst: float
    aim: float
    flattest: float = 1.0

    @property
    def weighed(self) -> float:
        """The worst element as searches weigh it
        (:mod:`meshwright_core.geometry.weighed_shapes`).
        """
        return min(self.worst, THIN * self.flattest)

    @property
    def corners_reached(self) -> bool:
        """Whether the corners alone reach the aim, up to rounding."""
        return self.worst >= self.aim - NEAR

    @property
    def reached(self) -> bool:
        """Whether the aim is reached, up to rounding."""
        return self.weighed >= self.aim - NEAR

    @classmethod
    def of(cls, mesh: HalfEdgeMesh, effort: Effort) -> ShapeGoal | None:
        """That of ``mesh``; None where a search only looks for a lower s.

        This is so for triangles, for surfaces in space, in a region, and for more quads than the
        solver searches for shape.
        """
        from meshwright_agent.search.layout_search import Preference
        from meshwright_agent.search.solver import has_layouts
        from meshwright_core.geometry.shape_bound import attainable_bound, shape_bound

        if effort.elements is not None or not (effort.keep_size or has_layouts(mesh)):
            return None
        aims = Preference(effort.prefer).aims(attainable_bound(mesh), shape_bound(mesh))
        worst, flattest = scaled_jacobian(mesh), element_shapes(mesh)
        return cls(float(worst.min(initial=1.0)), aims.target, float(flattest.min(initial=1.0)))


@dataclass(frozen=True)
class Effort:
    """Limits of a search: rollouts or seconds, and the region that may change."""

    rollouts: int | None = None
    seconds: float | None = COMPLETE_SECONDS
    elements: np.ndarray | None = field(default=None, compare=False)
    """(n,) ids of the only elements that may change; None: all."""
    coarsen: bool = True
    """Whether to continue for fewer elements (quads) once the score is at its lowest."""
    prefer: str = "balanced"
    """One of :data:`PREFERENCES`."""
    keep_size: bool = False
    """Whether the elements keep the size that they have; otherwise quads become blocks."""
    until_done: bool = False
    """Whether to search again, for longer, until s* and the wanted shape are reached or rounds have
    won nothing."""
    beyond: bool = False
    """Whether to search even where both are reached, for fewer blocks."""
    shown: float = 2.0
    """Seconds that going to the result takes at most, unless the operations alone take longer."""


class SearchRunner:
    """A :class:`meshwright.assistant.run.RunnerProtocol` whose one step is all operations that
    ``meshwright_agent.search.solver.solve`` has found.
    """

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        policy: Any,
        seed: int,
        effort: Effort,
        enough: Event,
        progress: Callable[[int, int], None],
    ) -> None:
        """`mesh` is the runner's own; `enough` ends the search early, with the best so far;
        `progress(done, best score)` is called during the search and when :attr:`shape` changes.
        """
        self._mesh, self._policy, self._seed, self._effort = mesh, policy, seed, effort
        self._enough, self._progress = enough, progress
        self._began = time.monotonic()
        self._rounds = 0
        self.finished = False
        """Whether the operations have been returned."""
        self.reason = ""
        self.shape: ShapeGoal | None = None
        """Shape of the best mesh found so far, and what is aimed at."""
        self.target: HalfEdgeMesh | None = None
        """The mesh that the operations lead to, with its positions; None where a region alone was
        searched."""

    def look(self) -> Insight | None:
        """None: a search has no insight to show."""
        return None

    def step(self) -> list[tuple[Operation, int]]:
        """All operations; runs the search."""
        if self.finished:
            return []
        self._began = time.monotonic()
        # a search also finds positions: it leaves what a person has put where it is
        pinned = self._mesh.pinned().nonzero()[0]
        self._mesh.arrays.vertex[pinned, FLAGS] |= LOCKED
        within = self._effort.elements
        if within is not None:
            found = self._search_within(within)
        elif self._effort.keep_size:
            found = self._search_in_size()
        else:
            found = self._search()
        if not found and not self.reason:
            self.reason = NOTHING_BETTER.format(self._seconds)
        self.finished = True
        return found

    @property
    def _seconds(self) -> float:
        return time.monotonic() - self._began

    def _search(self) -> list[tuple[Operation, int]]:
        """Rounds of the solver, each from the best state so far, until s* and the wanted shape are
        reached or nothing more is won.
        """
        effort, start = self._effort, self._mesh
        if self._is_done(start):
            return []
        operations: list[tuple[Operation, int]] = []
        before: list[tuple[Operation, int]] = []  # those that lead to the start of the round
        best: Solution | None = None
        seconds, done, lost = effort.seconds, 0, 0
        while True:
            found = self._round(start, seconds, done)
            done += found.rollouts
            won = best is None or _is_better(found, best)
            if won:
                operations = before + list(found.operations)
                best, self.target = found, start.copy()
                found.carry_out(self.target)
                self.shape = ShapeGoal.of(self.target, effort)
                self._progress(done, best.score)
            assert best is not None
            assert self.target is not None
            lost = 0 if won and found.operations else lost + 1
            if self._enough.is_set() or not effort.until_done or seconds is None:
                break
            if lost >= PATIENCE:
                break
            if self._is_done(self.target) and not self._deserves_more(best):
                break
            few = self._fewer(best, seconds, done)
            if few is not None:
                done += few.rollouts
                start, before = self._mesh.copy(), list(few.operations)
                few.carry_out(start)
            elif best.perfect and lost:  # others of the same s are found from the start
                start, before = self._mesh, []
            else:
                start, before = self.target, operations
            usual = effort.seconds or 0.0
            seconds = (usual if self.shape is None else max(usual, LAYOUT_SECONDS)) * 2.0**lost
        if operations:
            self._square_up(self.target)
        self._note_end(lost)
        return operations

    def _square_up(self, target: HalfEdgeMesh) -> None:
        """Square up the ends of lines in a result of few elements."""
        from meshwright.document.position_repair import square_up  # imports scipy

        if target.k == 4 and square_up(target):
            self.shape = ShapeGoal.of(target, self._effort)

    def _is_done(self, mesh: HalfEdgeMesh) -> bool:
        """Whether s = s*, nothing is inverted and the wanted shape is reached, and nothing beyond
        that is asked for.
        """
        if self._effort.beyond or mesh.score != mesh.optimum or len(inverted(mesh)):
            return False
        self.shape = ShapeGoal.of(mesh, self._effort)
        return self.shape is None or self.shape.reached

    def _deserves_more(self, best: Solution) -> bool:
        """Whether a second round often finds more than the first one has found: it has left
        vertices irregular by 2 or more, or many blocks, where the search aims at less.
        """
        assert self.target is not None
        uneven = best.aims.spread and largest_delta(self.target) > 1
        return self._rounds == 1 and (uneven or self._has_many(best))

    def _has_many(self, best: Solution) -> bool:
        """Whether s* is reached with many blocks."""
        assert self.target is not None
        searched = best.coarse and self.shape is not None and self.target.score == best.optimum
        return searched and self.target.n_elements > MANY_BLOCKS

    def _fewer(self, best: Solution, seconds: float, done: int) -> Solution | None:
        """After the first round, where it has left many blocks: a solution with less than half of
        them and any shape; None if there is none.

        Many blocks of one layout lie in spirals, which a search does not undo. It soon finds a good
        shape from few blocks of a bad one.
        """
        if self._rounds > 1 or self._effort.prefer != "balanced" or not self._has_many(best):
            return None
        few = self._round(self._mesh, seconds, done, "blocks")
        return few if few.perfect and 2 * few.elements < best.elements else None

    def _note_end(self, lost: int) -> None:
        """Say why a search in rounds has ended, where it was not stopped and more is wanted."""
        if lost >= PATIENCE and not self._enough.is_set():
            self.reason = NOTHING_BETTER.format(self._seconds)

    def _search_in_size(self) -> list[tuple[Operation, int]]:
        """One search in which the elements keep their size, by operations alone."""
        from meshwright_agent.search.improvement import Wishes, improve

        effort = self._effort
        found = improve(
            self._mesh,
            self._policy,
            Wishes(effort.prefer, keep_size=True, in_place=True),
            rollouts=effort.rollouts,
            seconds=SIZE_SECONDS if effort.until_done else effort.seconds,
            seed=self._seed,
            workers=_workers(),
            progress=self._progress,
            cancelled=self._enough.is_set,
        )
        self.target = found.mesh
        self.shape = ShapeGoal.of(found.mesh, effort)
        return list(found.operations)

    def _round(
        self, start: HalfEdgeMesh, seconds: float | None, done: int, prefer: str = ""
    ) -> Solution:
        from meshwright_agent.search.solver import solve

        self._rounds += 1
        return solve(
            start,
            self._policy,
            rollouts=self._effort.rollouts,
            seconds=seconds,
            seed=self._seed + 1009 * self._rounds,
            workers=_workers(),
            coarsen=self._effort.coarsen,
            prefer=prefer or self._effort.prefer,
            progress=lambda rollouts, best: self._progress(done + rollouts, best),
            cancelled=self._enough.is_set,
        )

    def _search_within(self, elements: np.ndarray) -> list[tuple[Operation, int]]:
        from meshwright_agent.search.region_search import solve_within

        found = solve_within(
            self._mesh,
            self._policy,
            elements,
            rollouts=self._effort.rollouts,
            seconds=self._effort.seconds,
            seed=self._seed,
            progress=self._progress,
            cancelled=self._enough.is_set,
        )
        if found.score == found.optimum:
            self.reason = "nothing lower is possible by changing this region alone"
        return list(found.operations)


def _is_better(found: Solution, best: Solution) -> bool:
    """Whether a solution is better: by its rank, except that half as many blocks, where there
    are many, count more than how evenly the irregularity is spread.
    """
    few, many = sorted((found.elements, best.elements))
    alike = found.coarse and best.coarse and found.rank[:_SPREAD] == best.rank[:_SPREAD]
    if alike and many > MANY_BLOCKS and many >= 2 * few:
        return found.elements == few
    return found.rank[:-1] < best.rank[:-1]


def _workers() -> int:
    """Threads of a search; one core is left for the window."""
    return max(1, (os.cpu_count() or 2) - 1)
