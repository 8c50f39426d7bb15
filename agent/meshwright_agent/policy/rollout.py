"""One episode of a policy on one mesh, step by step, for editors and searches."""

from __future__ import annotations

import numpy as np
import torch

from meshwright_agent.env.candidates import LONGEST_CUT
from meshwright_agent.env.task import Observation, Scratch, observe, transition
from meshwright_agent.policy.explanation import insight
from meshwright_agent.policy.explanation_types import Insight
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.policy_files import Policy, require_kind
from meshwright_core.core.arrays import ELEMENT_SLOTS, JOURNALLING
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES, Operation

PolicyStep = list[tuple[Operation, int]]
"""An operation and the clean-ups that follow it, each with its half-edge."""

_SPARE = 4 * LONGEST_CUT + 64  # slots that the longest global split may take


class Runner:
    """Runs a policy on a copy of a mesh; the steps can be replayed on the mesh itself."""

    def __init__(
        self, mesh: HalfEdgeMesh, policy: Policy, seed: int, max_steps: int | None = None
    ) -> None:
        """Start an episode from `mesh`.

        seed: of all random choices. max_steps: length of the episode, by default that of the
        policy's task. Raises PolicyError if the policy is for the other kind of mesh.
        """
        require_kind(policy, mesh.kind)
        self.mesh = mesh.copy()
        self.mesh.arrays.counters[JOURNALLING] = 0
        self.policy, self._task = policy, policy.task
        self.steps = 0
        self.max_steps = self._task.step_limit(mesh.n_elements) if max_steps is None else max_steps
        self._bounds = self._task.bounds(mesh.n_elements)
        self._rng = np.random.default_rng(seed)
        self._generator = torch.Generator().manual_seed(seed)
        self._scratch = Scratch(self._task, 0, 0)
        self.best_score = mesh.score
        self.reason = ""
        """Why the episode has ended, in words; empty before."""
        self.last: Observation | None = None
        """The observation of the last decision."""
        self._next: tuple[Observation, int] | None = None

    @property
    def score(self) -> int:
        """Current s."""
        return self.mesh.score

    @property
    def finished(self) -> bool:
        """Whether the episode has ended."""
        return bool(self.reason)

    def look(self) -> Insight | None:
        """The basis of the next decision, without applying it; None when finished.

        The decision is kept for :meth:`step`, so calling this does not change the episode.
        """
        if self._next is None:
            self._next = self._decide()
        return None if self._next is None else insight(self.mesh.arrays, self.policy, *self._next)

    def step(self) -> PolicyStep:
        """Sample and apply the next operation and the clean-ups that follow; [] at the end."""
        decision = self._next or self._decide()
        self._next = None
        if decision is None:
            return []
        seen, action = decision
        task, scratch = self._task, self._scratch
        h = int(seen.chosen[0, action // task.operations])
        code = task.first_operation + action % task.operations
        arrays = self.mesh.arrays
        count = transition(arrays, code, h, task.cap, scratch.touched, scratch.cleaned)
        self.steps += 1
        self.best_score = min(self.best_score, self.mesh.score)
        cleaned = scratch.cleaned[:count].tolist()
        self._ended()
        return [(NAMES[code], h)] + [(Operation.CLEANUP, line) for line in cleaned]

    def _decide(self) -> tuple[Observation, int] | None:
        """The next observation and the sampled action; None at the end."""
        if self._ended():
            return None
        self._make_room()
        seen = observe(self.mesh.arrays, self._task, self._bounds, self._rng, self._scratch)
        self.last = seen
        if seen is None:
            self.reason = "no operation of the policy is permitted here"
            return None
        seen.state[0] = (
            (self.mesh.score - self.mesh.optimum) / 10.0,
            1.0 - self.steps / max(self.max_steps, 1),
            1.0,
        )
        return seen, int(decide(self.policy.network, seen, self._generator)[0][0])

    def _ended(self) -> bool:
        if not self.reason and self.mesh.score <= self.mesh.optimum:
            self.reason = "at the optimum"
        if not self.reason and self.steps >= self.max_steps:
            self.reason = f"all {self.max_steps} steps are used"
        return self.finished

    def _make_room(self) -> None:
        """Reserve slots for the largest operation, which would be refused without them."""
        arrays = self.mesh.arrays
        if self.mesh.slots + _SPARE > len(arrays.vertex) or (
            len(self.mesh.arrays.element_mark) < int(arrays.counters[ELEMENT_SLOTS]) + _SPARE
        ):
            size = self.mesh.n_elements
            self.mesh.reserve(2 * _SPARE + size // 4, 2 * _SPARE + size // 4)
        arrays = self.mesh.arrays
        if len(self._scratch.work.slot_of) < len(arrays.edge):
            self._scratch = Scratch(self._task, len(arrays.edge), len(arrays.vertex))
