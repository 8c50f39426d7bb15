"""Rollouts that are followed only as far as the mesh can be drawn.

A policy looks at degrees alone. On domains with many holes and fillets most of its rollouts pass
through, or end at, connectivity that no positions can draw. Here the operations of each rollout are
replayed one by one with local smoothing, as in the editor, and the last state without inverted
elements that has a lower s becomes the start of the next rollouts. So s falls and the mesh is valid
at every stage.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search.annealing import Operations
from meshwright_agent.search.search_worker import Candidate, RolloutBatch, Worker
from meshwright_core.geometry import smoothing
from meshwright_core.geometry.quality import inverted
from meshwright_core.mesh import HalfEdgeMesh

TOGETHER = 4
"""Rollouts side by side."""
FOLLOWED = 3
"""Rollouts of one batch that are replayed, those of the lowest s."""
LOST = 12
"""Operations in a row with inverted elements after which a replay ends."""
PATIENCE = 12
"""Batches in a row without a lower s after which the descent ends."""


class ValidDescent:
    """The best valid state so far.

    Args:
        mesh: a start without inverted elements; it is not changed.
        policy: for meshes of this kind.
        max_steps: length of a rollout, by default that of the policy's task.
        seed: of the random choices.

    Attributes:
        mesh: the state reached, with its positions.
        operations: those that lead there.
    """

    def __init__(
        self, mesh: HalfEdgeMesh, policy: Policy, max_steps: int | None, seed: int
    ) -> None:
        """Begin at `mesh`."""
        self.mesh = mesh.copy()
        self.operations: Operations = []
        self._policy, self._max_steps = policy, max_steps
        self._rng = np.random.default_rng(seed)

    def run(self, stop: Callable[[], bool]) -> None:
        """Go on until s*, until `stop`, or until s has not fallen for long."""
        idle = 0
        while not stop() and self.mesh.score > self.mesh.optimum and idle < PATIENCE:
            idle = 0 if self._advance(stop) else idle + 1

    def _advance(self, stop: Callable[[], bool]) -> bool:
        """One batch of rollouts from here; whether a lower s was reached."""
        batch = RolloutBatch(self.mesh, self._policy, self._max_steps, self.mesh.score)
        Worker(batch, int(self._rng.integers(1 << 31)), stop).roll(TOGETHER)
        return self.follow(batch.found, stop)

    def follow(self, candidates: Sequence[Candidate], stop: Callable[[], bool]) -> bool:
        """Replay what rollouts from here have found; whether a lower s was reached.

        At most :data:`FOLLOWED` are replayed, those of the lowest s; none once `stop` is true and
        something was won.
        """
        in_order = sorted(candidates, key=lambda found: (found.score, len(found.operations)))
        reached, chosen = self.mesh, []
        for candidate in in_order[:FOLLOWED]:
            if stop() and reached is not self.mesh:
                break
            trial = self.mesh.copy()
            lost = 0
            for count, (operation, h) in enumerate(candidate.operations, 1):
                edit = trial.apply(operation, h)
                smoothing.relax(trial, edit.touched, thorough=False)
                lost = lost + 1 if len(inverted(trial)) else 0
                if lost > LOST:
                    break
                if not lost and trial.score < reached.score:
                    reached, chosen = trial.copy(), candidate.operations[:count]
        if reached is self.mesh:
            return False
        self.mesh, self.operations = reached, self.operations + chosen
        return True
