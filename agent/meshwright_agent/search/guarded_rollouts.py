"""Rollouts of a policy in which every state can be drawn.

A policy looks at degrees alone. On domains with holes and fillets most of its rollouts pass
through, or end at, connectivity that no positions can draw. Here each operation is tried on a copy
first: the quads around it are positioned
(:func:`meshwright_core.geometry.local_positions.settle`), and where some stay folded the operation
is struck from the mask and another one drawn. Between the decisions strips that are not needed are
collapsed under the same guard, which leaves room for what follows. So the mesh is valid at every
stage.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch

from meshwright_agent.env.task import Observation, transition
from meshwright_agent.env.vector_env import Batch, member
from meshwright_agent.policy.inference import tensors
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search.annealing import Operations, copy_mesh
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.guarded_coarsening import candidates
from meshwright_core.core.arrays import (
    ELEMENT_SLOTS,
    ELEMENTS,
    JOURNALLING,
    ORIGIN,
    SCORE,
    MeshArrays,
    copied,
)
from meshwright_core.core.compilation import kernel
from meshwright_core.geometry.layout_positions import rails_of
from meshwright_core.geometry.local_positions import LocalEffort, local_effort, settle
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES, Operation, check, rewrite
from meshwright_core.operations.refusals import ALLOWED

STALLED = 40
"""Decisions without a lower s after which a rollout ends, by default."""
TRIES = 6
"""Operations that are tried for one decision."""
FORGET = 12
"""Steps after which an operation that could not be drawn may be tried again."""
STUCK = 20
"""Decisions in a row without an operation that can be drawn after which a rollout ends."""
GOAL = 0.1
"""Sine of the worst corner up to which what an operation changes is raised: more takes most of the
time, and what can be drawn remains the same."""
TEMPERATURE = 1.2
"""By which the policy's logits are divided: rollouts that differ more reach s* on more parts."""
THIN_EVERY = 10
"""Decisions between two passes of :func:`thin_out`."""
THIN_LEAST = 0.1
"""Least sine of a corner around a strip that is collapsed."""
_LONGEST_PASS = 200


@kernel
def attempt(meshes, b, trial, rails, local, decision, scratch):
    """Apply decision (3,): operation, half-edge and cap, to mesh b if the result can be drawn.

    trial: arrays of the same sizes as one of the meshes; scratch: touched, cleaned and active.
    Returns the number of clean-ups that followed, -1 if it cannot be drawn; then mesh b is as
    before.
    """
    m = member(meshes, b)
    copy_mesh(m, trial)
    touched, cleaned, active = scratch
    count = transition(trial, decision[0], decision[1], decision[2], touched, cleaned)
    if settle(m, trial, rails, local, active) <= 0.0:
        return -1
    copy_mesh(trial, m)
    return count


@kernel
def thin_out(m, trial, rails, local, active, log, rng):
    """Collapse strips and delete lines of regular vertices of `m`, in place, where s does not rise
    and the result can be drawn, until there is none or `log` is full.

    trial: arrays of the same sizes; log (N, 2) int32 receives the operations. Returns their number.
    """
    found = np.zeros((8 * m.counters[ELEMENT_SLOTS], 2), np.int64)
    length = 0
    improved = True
    while improved:
        improved = False
        count = candidates(m, found)
        for i in range(count):
            j = i + int(rng.random() * (count - i))
            operation, h = found[j, 0], found[j, 1]
            found[j, 0], found[j, 1] = found[i, 0], found[i, 1]
            if length >= len(log):
                return length
            if m.edge[h, ORIGIN] < 0 or check(m, operation, h, 0) != ALLOWED:
                continue
            copy_mesh(m, trial)
            rewrite(trial, operation, h)
            if trial.counters[SCORE] > m.counters[SCORE]:
                continue
            if settle(m, trial, rails, local, active) <= 0.0:
                continue
            copy_mesh(trial, m)
            log[length, 0], log[length, 1] = operation, h
            length += 1
            improved = True
    return length


def thinning_effort() -> LocalEffort:
    """How hard positions are looked for where a strip is collapsed."""
    return local_effort(GOAL, THIN_LEAST, rounds=0, thorough=False)


@dataclass
class DrawnState:
    """A state without inverted elements, and how it is reached."""

    operations: Operations
    score: int
    elements: int
    arrays: MeshArrays
    """Connectivity and positions."""
    tries: int = 0
    """How often something was tried from it."""

    @classmethod
    def of(cls, operations: Operations, arrays: MeshArrays) -> DrawnState:
        """The state in `arrays`, which are kept."""
        score, elements = int(arrays.counters[SCORE]), int(arrays.counters[ELEMENTS])
        return cls(operations, score, elements, arrays)

    @property
    def rank(self) -> tuple[int, int]:
        """States with a lower rank are better: s, then elements."""
        return self.score, self.elements

    def mesh(self, start: HalfEdgeMesh) -> HalfEdgeMesh:
        """The state as a mesh with its positions; `start` is what the operations were found for."""
        reached = replayed(start, self.operations)
        ids = reached.vertices()
        reached.move(ids, self.arrays.points[ids], self.arrays.parameter[ids])
        return reached


def member_of(meshes: MeshArrays, b: int) -> MeshArrays:
    """Mesh b of stacked arrays, as views."""
    own = {name: getattr(meshes, name)[b] for name in MeshArrays._fields[:-2]}
    return meshes._replace(**own)


class GuardedRollouts:
    """Rollouts side by side from one mesh.

    Args:
        mesh: the start, of quads in the plane z = 0, without inverted elements, not at s*; it is
            not changed.
        policy: for quad meshes.
        rng: of the random choices.
        count: rollouts side by side.
        max_steps: length of a rollout, by default that of the policy's task.
        ceiling: largest number of elements, by default that of the policy's task.
        stalled: decisions without a lower s after which a rollout ends.

    Attributes:
        found: the best state of each rollout.
        tried: operations that were tried.
        failed: those of them that could not be drawn.
    """

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        policy: Policy,
        rng: np.random.Generator,
        count: int = 1,
        max_steps: int | None = None,
        ceiling: int | None = None,
        stalled: int = STALLED,
    ) -> None:
        """Begin at `mesh`."""
        self._stalled = stalled
        task = policy.task
        self._network, self._task, self._rng = policy.network, task, rng
        floor, own = task.bounds(mesh.n_elements)
        bounds = floor, own if ceiling is None else ceiling
        batch = Batch(task, [mesh], count, rng, endless=False, bounds=bounds)
        batch.meshes.counters[:, JOURNALLING] = 0
        self._batch = batch
        self._steps = task.step_limit(mesh.n_elements) if max_steps is None else max_steps
        self._optimum = mesh.optimum
        self._rails = rails_of(mesh, batch.meshes.vertex.shape[1])
        self._local = local_effort(GOAL, iterations=4, rounds=2, inner=6, rings=1, thorough=False)
        self._thin = thinning_effort()
        self._trial = copied(member_of(batch.meshes, 0))
        active = np.zeros(len(self._trial.points), np.bool_)
        self._scratch = batch.scratch.touched, batch.scratch.cleaned, active
        self._log = np.zeros((_LONGEST_PASS, 2), np.int32)
        self._done: list[Operations] = [[] for _ in range(count)]
        self._blocked: list[dict[tuple[int, int], int]] = [{} for _ in range(count)]
        self._idle, self._gained = np.zeros(count, int), np.zeros(count, int)
        self.found = [self._state(b) for b in range(count)]
        self.tried = self.failed = 0

    @property
    def best(self) -> DrawnState:
        """The best state of all rollouts."""
        return min(self.found, key=lambda state: state.rank)

    def run(self, stop: Callable[[], bool]) -> None:
        """Go on until one has reached s*, all have ended, or `stop`; then thin out what was found.

        What has the lowest s alone is thinned out.
        """
        active = self._batch.active
        while active.any() and not stop() and self.best.score > self._optimum:
            self._step()
        lowest = self.best.score
        for b, state in enumerate(self.found):
            if state.score == lowest:
                state.operations += self._thinned(state.arrays)
                state.elements = int(state.arrays.counters[ELEMENTS])
                self.found[b] = state

    def _state(self, b: int) -> DrawnState:
        return DrawnState.of(list(self._done[b]), copied(member_of(self._batch.meshes, b)))

    def _step(self) -> None:
        """One decision of each rollout."""
        batch = self._batch
        observation = batch.observe()
        running = np.flatnonzero(batch.active).tolist()
        for b in running:
            self._strike(observation, b)
        with torch.no_grad():
            logits, _ = self._network(*tensors(observation))
        possible = observation.mask.reshape(len(logits), -1)
        weights = torch.softmax(logits / TEMPERATURE, dim=1).numpy().astype(float) * possible
        for b in running:
            self._decide(b, observation.chosen[b], weights[b])
            batch.steps[b] += 1
            if batch.meshes.counters[b, SCORE] < self.found[b].score:
                self.found[b] = self._state(b)
                self._gained[b] = batch.steps[b]
            if batch.steps[b] % THIN_EVERY == 0:
                self._done[b] += self._thinned(member_of(batch.meshes, b))
            ended = self.found[b].score <= self._optimum or not possible[b].any()
            stalled = batch.steps[b] - self._gained[b] > self._stalled or self._idle[b] > STUCK
            if ended or stalled or batch.steps[b] >= self._steps:
                batch.active[b] = False

    def _thinned(self, arrays: MeshArrays) -> Operations:
        """Thin out a mesh in place; returns the operations."""
        count = thin_out(
            arrays, self._trial, self._rails, self._thin, self._scratch[2], self._log, self._rng
        )
        return [(NAMES[code], h) for code, h in self._log[:count].tolist()]

    def _strike(self, observation: Observation, b: int) -> None:
        """Remove from the mask of rollout b what could not be drawn lately."""
        blocked, now = self._blocked[b], int(self._batch.steps[b])
        for key in [key for key, until in blocked.items() if until <= now]:
            del blocked[key]
        rows = {int(h): row for row, h in enumerate(observation.chosen[b]) if h >= 0}
        for kind, h in blocked:
            if h in rows:
                observation.mask[b, rows[h], kind] = False

    def _decide(self, b: int, chosen: np.ndarray, weights: np.ndarray) -> None:
        """One decision of rollout b by the probabilities `weights`, which need not sum to one."""
        task = self._task
        for _ in range(TRIES):
            total = weights.sum()
            if not total > 0.0:
                break
            place = np.searchsorted(np.cumsum(weights), self._rng.random() * total, side="right")
            action = min(int(place), len(weights) - 1)
            h, kind = int(chosen[action // task.operations]), action % task.operations
            code = task.first_operation + kind
            self.tried += 1
            count = attempt(
                self._batch.meshes, b, self._trial, self._rails, self._local,
                np.array([code, h, task.cap]), self._scratch,
            )  # fmt: skip
            if count >= 0:
                lines = self._scratch[1][:count].tolist()
                self._done[b].append((NAMES[code], h))
                self._done[b] += [(Operation.CLEANUP, line) for line in lines]
                self._idle[b] = 0
                return
            self.failed += 1
            weights[action] = 0.0
            self._blocked[b][kind, h] = int(self._batch.steps[b]) + FORGET
        self._idle[b] += 1
