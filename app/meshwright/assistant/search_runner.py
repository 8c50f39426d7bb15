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

from meshwright_core import HalfEdgeMesh, Operation
from meshwright_core.core.arrays import FLAGS, LOCKED

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight
    from meshwright_agent.search.solution import Solution

COMPLETE_SECONDS = 3.0
"""Time of a round of *Complete*; after one that has won nothing the next gets twice as much."""
SIZE_SECONDS = 10.0
"""Time of *Complete* where the elements keep their size."""
PATIENCE = 2
"""Rounds without success after which *Complete* ends."""
PREFERENCES = ("blocks", "balanced", "shape")
"""What counts at s*: few blocks, a good worst corner, or both."""


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
    """Whether to search again, for longer, until s* and the wanted shape are reached or a round has
    won nothing."""


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
        `progress(done, best score)` is called during the search.
        """
        self._mesh, self._policy, self._seed, self._effort = mesh, policy, seed, effort
        self._enough, self._progress = enough, progress
        self._began = time.monotonic()
        self._rounds = 0
        self.finished = False
        """Whether the operations have been returned."""
        self.reason = ""
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
            self.reason = f"nothing better was found in {self._seconds:.0f} s"
        self.finished = True
        return found

    @property
    def _seconds(self) -> float:
        return time.monotonic() - self._began

    def _search(self) -> list[tuple[Operation, int]]:
        """Rounds of the solver, each from the best state so far, as long as s can fall."""
        effort, start = self._effort, self._mesh
        operations: list[tuple[Operation, int]] = []
        before: list[tuple[Operation, int]] = []  # those that lead to the start of the round
        best: Solution | None = None
        seconds, done, lost = effort.seconds, 0, 0
        while True:
            found = self._round(start, seconds, done)
            done += found.rollouts
            won = best is None or found.rank[:-1] < best.rank[:-1]
            if won:
                operations = before + list(found.operations)
                best, self.target = found, start.copy()
                found.carry_out(self.target)
            assert best is not None
            assert self.target is not None
            lost = 0 if won and found.operations else lost + 1
            if self._enough.is_set() or not effort.until_done or seconds is None:
                break
            if _is_done(best) or lost >= PATIENCE:
                break
            if best.perfect:  # others of the same s are found from the start
                start, before = self._mesh, []
            else:
                start, before = self.target, operations
            seconds = (effort.seconds or 0.0) * 2.0**lost
        return operations

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
        return list(found.operations)

    def _round(self, start: HalfEdgeMesh, seconds: float | None, done: int) -> Solution:
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
            prefer=self._effort.prefer,
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


def _workers() -> int:
    """Threads of a search; one core is left for the window."""
    return max(1, (os.cpu_count() or 2) - 1)


def _is_done(best: Solution) -> bool:
    """Whether s = s*, nothing is inverted and the worst corner is as good as was asked for."""
    return best.perfect and best.worst_scaled_jacobian >= best.aims.target - 1e-3
