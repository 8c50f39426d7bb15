"""Adapts the solver to the runner interface: searches, then returns its operations one by one.

Qt and torch are not imported here; the first step imports torch, on the assistant's thread.
"""

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from threading import Event
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright_core import HalfEdgeMesh, Operation
from meshwright_core.core.arrays import FLAGS, LOCKED

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight

COMPLETE_SECONDS = 3.0
"""Time limit, in seconds, of the command *Complete*."""


@dataclass(frozen=True)
class Effort:
    """Limits of a search: rollouts or seconds, and the region that may change."""

    rollouts: int | None = None
    seconds: float | None = COMPLETE_SECONDS
    elements: np.ndarray | None = field(default=None, compare=False)
    """(n,) ids of the only elements that may change; None: all."""
    coarsen: bool = True
    """Whether to continue for fewer elements (quads) once the score is at its lowest."""


class SearchRunner:
    """A :class:`meshwright.assistant.run.RunnerProtocol` whose steps are the operations that
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
        self._left: list[tuple[Operation, int]] | None = None
        self.reason = ""

    @property
    def finished(self) -> bool:
        """Whether all operations have been returned."""
        return self._left is not None and not self._left

    def look(self) -> "Insight | None":
        """None: a search has no insight to show."""
        return None

    def step(self) -> list[tuple[Operation, int]]:
        """The next operation; the first call runs the search."""
        if self._left is None:
            self._left = self._search()
        return [self._left.pop(0)] if self._left else []

    def _search(self) -> list[tuple[Operation, int]]:
        # a search also finds positions: it leaves what a person has put where it is
        pinned = self._mesh.pinned().nonzero()[0]
        self._mesh.arrays.vertex[pinned, FLAGS] |= LOCKED
        if self._effort.elements is not None:
            return self._search_within(self._effort.elements)
        from meshwright_agent.search.solver import solve

        solution = solve(
            self._mesh,
            self._policy,
            rollouts=self._effort.rollouts,
            seconds=self._effort.seconds,
            seed=self._seed,
            workers=max(1, (os.cpu_count() or 2) - 1),
            coarsen=self._effort.coarsen,
            progress=self._progress,
            cancelled=self._enough.is_set,
        )
        if not solution.operations:
            self.reason = f"nothing better was found in {solution.seconds:.0f} s"
        return list(solution.operations)

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
        elif not found.operations:
            self.reason = f"nothing better was found in {found.seconds:.0f} s"
        return list(found.operations)
