"""Search with a policy: run it again and again and keep the best (section 5, best of k).

Better is: the lower s; among equals fewer elements that cannot be drawn without folding; then fewer
operations. The answer is a list of operations that replays on the mesh it was found for.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from agent.policies import Policy
from agent.rollout import Runner, Step
from meshcore import smoothing
from meshcore.mesh import HalfEdgeMesh

_DRAWN = 20_000  # elements; larger meshes are not test-drawn between rollouts


@dataclass
class Solution:
    """The best that a search has found."""

    operations: Step
    """Operations and half-edges, to be applied in this order."""
    score: int
    optimum: int
    inverted: int
    """Elements that stay inverted, or degenerate, when the mesh is smoothed."""
    rollouts: int = 0
    seconds: float = 0.0

    @property
    def rank(self) -> tuple[int, int, int]:
        """Solutions with a lower rank are better."""
        return self.score, self.inverted, len(self.operations)

    @property
    def perfect(self) -> bool:
        """At the optimum, which is a proof that s cannot be lower, and drawn without a fold."""
        return self.score == self.optimum and self.inverted == 0


def improve(
    mesh: HalfEdgeMesh,
    policy: Policy,
    rollouts: int | None = 1,
    seconds: float | None = None,
    max_steps: int | None = None,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Solution:
    """The best state that rollouts of the policy reach from `mesh`, which is not changed.

    Stops after `rollouts` runs or `seconds` (None: no such limit; with neither, one run), when
    `cancelled()` says so, or at a solution that is perfect. `progress(done, best score)` is called
    after each run. Doing nothing is the solution to beat.
    """
    began = time.perf_counter()
    if rollouts is None and seconds is None:
        rollouts = 1
    best = Solution([], mesh.score, mesh.optimum, _inverted(mesh, []))
    done = 0
    while not best.perfect and (rollouts is None or done < rollouts):
        late = seconds is not None and time.perf_counter() - began > seconds
        if late or (cancelled is not None and cancelled()):
            break
        runner = Runner(mesh, policy, seed + 7919 * done, max_steps)
        operations, score = _run(runner, began, seconds, cancelled)
        done += 1
        if score <= best.score:
            found = Solution(operations, score, mesh.optimum, 0)
            if found.rank < best.rank:
                found.inverted = _inverted(mesh, operations)
                best = min(best, found, key=lambda solution: solution.rank)
        if progress is not None:
            progress(done, best.score)
    best.rollouts, best.seconds = done, time.perf_counter() - began
    return best


def _run(
    runner: Runner,
    began: float,
    seconds: float | None,
    cancelled: Callable[[], bool] | None,
) -> tuple[Step, int]:
    """Play to the end; the operations up to the best state, and its score."""
    operations: Step = []
    best, length = runner.score, 0
    while step := runner.step():
        operations += step
        if runner.score < best:
            best, length = runner.score, len(operations)
        late = seconds is not None and time.perf_counter() - began > seconds
        if late or (cancelled is not None and cancelled()):
            break
    return operations[:length], best


def _inverted(mesh: HalfEdgeMesh, operations: Step) -> int:
    """Elements that stay inverted when the operations are done and the mesh is smoothed."""
    if mesh.n_elements > _DRAWN:
        return 0
    drawn = mesh.copy()
    for operation, h in operations:
        drawn.apply(operation, h)
    return len(smoothing.relax(drawn))
