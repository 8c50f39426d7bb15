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
from meshwright_agent.search.divided_layouts import (
    collapse_chords,
    drawn_divided,
    ways_down,
)
from meshwright_agent.search.guarded_coarsening import candidates
from meshwright_agent.search.leaps import leap
from meshwright_agent.search.search_worker import RolloutBatch, Worker
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
from meshwright_core.geometry.layout_positions import layout_bound, rails_of
from meshwright_core.geometry.local_positions import LocalEffort, local_effort, settle
from meshwright_core.geometry.shape_bound import corner_angles
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES, Operation, check, rewrite
from meshwright_core.operations.refusals import ALLOWED

TOGETHER, ELEMENTS_EACH = 2, 200
"""The most rollouts side by side, and elements of all of them together: on a large mesh one comes
further in the same time."""
STALLED = 40
"""Decisions without a lower s after which a rollout ends."""
TRIES = 6
"""Operations that are tried for one decision."""
FORGET = 12
"""Steps after which an operation that could not be drawn may be tried again."""
STUCK = 20
"""Decisions in a row without an operation that can be drawn after which a rollout ends."""
GOAL = 0.1
"""Sine of the worst corner up to which what an operation changes is raised: more takes most of the
time, and what can be drawn remains the same."""
FREE_WORK, MOST_FREE = 1500, 16
"""Free rollouts from a state between two rounds of guarded ones, in its elements and in number."""
COARSE = 120
"""Elements down to which these are coarsened first."""
FREE_DRAWN = ((4, 1), (1, 2))
"""How many of their results are given positions, with how many attempts; then again."""
LARGEST_STUCK = 250
"""Elements up to which the best state, where a round has not helped, is divided after leaps and
annealing."""
ANNEALED_DRAWN = 6
"""Results of annealing that are given positions."""
THIN_EVERY = 10
"""Decisions between two passes of :func:`thin_out`."""
THIN_LEAST = 0.1
"""Least sine of a corner around a strip that is collapsed."""
_LONGEST_PASS = 200
_SLICE = 20
"""Strips that are collapsed between two looks at the clock."""


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
        count: int = TOGETHER,
        max_steps: int | None = None,
        ceiling: int | None = None,
    ) -> None:
        """Begin at `mesh`."""
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
        self._local = local_effort(GOAL, thorough=False)
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
        weights = torch.softmax(logits, dim=1).numpy().astype(float) * possible
        for b in running:
            self._decide(b, observation.chosen[b], weights[b])
            batch.steps[b] += 1
            if batch.meshes.counters[b, SCORE] < self.found[b].score:
                self.found[b] = self._state(b)
                self._gained[b] = batch.steps[b]
            if batch.steps[b] % THIN_EVERY == 0:
                self._done[b] += self._thinned(member_of(batch.meshes, b))
            ended = self.found[b].score <= self._optimum or not possible[b].any()
            stalled = batch.steps[b] - self._gained[b] > STALLED or self._idle[b] > STUCK
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


class GuardedDescent:
    """Rounds of guarded rollouts, from the start and from the best state in turn.

    Between them leaps from the best state (:mod:`meshwright_agent.search.leaps`), free rollouts
    from the start and the best state, and, where a round has not brought s down, ways down from the
    best state by annealing. Little of what these reach can be drawn before its strips are divided
    (:mod:`meshwright_agent.search.divided_layouts`).

    Args:
        mesh: the start, without inverted elements; it is not changed.
        policy: for quad meshes.
        max_steps: length of a rollout, by default that of the policy's task.
        seed: of the random choices.

    Attributes:
        states: those of the lowest s, the best first.
        rollouts: how many were made.
    """

    def __init__(
        self, mesh: HalfEdgeMesh, policy: Policy, max_steps: int | None, seed: int
    ) -> None:
        """Nothing is done yet."""
        self._mesh, self._policy, self._max_steps = mesh, policy, max_steps
        # by the start of the descent: by those of its rounds the meshes would grow without end
        self._ceiling = policy.task.bounds(mesh.n_elements)[1]
        self._rng = np.random.default_rng(seed)
        self.states: list[DrawnState] = []
        self.rollouts = self._rounds = 0

    @property
    def score(self) -> int:
        """The lowest s."""
        return self.states[0].score if self.states else self._mesh.score

    @property
    def elements(self) -> int:
        """Of the best state."""
        return self.states[0].elements if self.states else self._mesh.n_elements

    def run(self, stop: Callable[[], bool], most: int | None = None) -> None:
        """Go on until s*, until `stop`, or for at most so many rollouts."""
        begun, optimum = self.rollouts, self._mesh.optimum
        together = max(1, min(TOGETHER, ELEMENTS_EACH // self._mesh.n_elements))

        def granted(wanted: int) -> int:
            return wanted if most is None else min(wanted, most - (self.rollouts - begun))

        while self.score > optimum and not stop() and (count := granted(together)) > 0:
            before = self.score
            self._round(count, stop)
            small = self.elements <= LARGEST_STUCK
            stuck = small and self._rounds > 1 and self.score == before
            while self.states and self.score > optimum and not stop():
                if not (self._leap(stop, stuck) or (stuck and self._anneal(stop))):
                    break
            if self.score <= optimum or stop():
                break
            free = FREE_WORK // max(self._mesh.n_elements, self.elements)
            if (count := granted(max(2, min(MOST_FREE, free)))) > 0:
                self._free(count, stop)

    def _leap(self, stop: Callable[[], bool], divide: bool) -> bool:
        """Leap from the best state; returns whether that has led to lower s.

        divide: whether what cannot be drawn as it is is divided.
        """
        best = self.states[0]
        found = leap(best.mesh(self._mesh), self._policy, self._rng, stop, self._ceiling, divide)
        if found is None:
            return False
        operations, arrays = found
        self.states = [self._thinned(DrawnState.of(best.operations + operations, arrays), stop)]
        return True

    def _anneal(self, stop: Callable[[], bool]) -> bool:
        """Anneal from the best state, to s* or else to any lower s, and divide what that leads to;
        returns whether something could be drawn.
        """
        best = self.states[0]
        before = best.mesh(self._mesh)
        for goal in sorted({self._mesh.optimum, best.score - 1}):
            ways = ways_down(before, goal, self._rng, stop)
            drawn = self._first_drawn(
                [(replayed(before, way), best.operations + way) for way in ways], ANNEALED_DRAWN, 1,
                stop,
            )  # fmt: skip
            if drawn is not None:
                self.states = [self._thinned(drawn, stop)]
                return True
        return False

    def _thinned(self, state: DrawnState, stop: Callable[[], bool]) -> DrawnState:
        """The state thinned out, if it has become larger than the start."""
        if state.elements <= self._mesh.n_elements:
            return state
        arrays, made = copied(state.arrays), list(state.operations)
        arrays.counters[JOURNALLING] = 0
        trial, rails = copied(arrays), rails_of(self._mesh, len(arrays.vertex))
        active = np.zeros(len(arrays.points), np.bool_)
        log = np.zeros((_SLICE, 2), np.int32)
        count = len(log)
        while count == len(log) and not stop():
            count = thin_out(arrays, trial, rails, thinning_effort(), active, log, self._rng)
            made += [(NAMES[code], h) for code, h in log[:count].tolist()]
        return DrawnState.of(made, arrays)

    def _first_drawn(
        self,
        reached: list[tuple[HalfEdgeMesh, Operations]],
        most: int,
        attempts: int,
        stop: Callable[[], bool],
    ) -> DrawnState | None:
        """The first of some states, with what leads to them, that can be drawn divided.

        Positions take long: of those whose degrees permit any at most so many are tried.
        """
        angle = corner_angles(self._mesh)  # no vertex that operations add is a corner

        def usable(mesh: HalfEdgeMesh) -> bool:
            return bool(layout_bound(mesh.arrays, angle) > THIN_LEAST)

        for after, operations in [pair for pair in reached if usable(pair[0])][:most]:
            if stop():
                break
            collapses = collapse_chords(after, COARSE, self._rng, usable)
            divisions, drawn = drawn_divided(after, stop, attempts)
            if drawn:
                return DrawnState.of(operations + collapses + divisions, after.arrays)
        return None

    def _free(self, count: int, stop: Callable[[], bool]) -> None:
        """So many free rollouts from the start and from the best state, first from what has fewer
        elements. The first that is at s* and can be drawn becomes the best; the coarsest few are
        tried.
        """
        begun = [(state.operations, state.mesh(self._mesh)) for state in self.states[:1]]
        begun.append(([], self._mesh))
        for before, mesh in sorted(begun, key=lambda pair: pair[1].n_elements):
            if stop():
                return
            batch = RolloutBatch(mesh, self._policy, self._max_steps, self._mesh.optimum)
            Worker(batch, int(self._rng.integers(1 << 31)), stop).roll(count)
            self.rollouts += count
            for most, attempts in FREE_DRAWN:
                reached = [
                    (replayed(mesh, one.operations), before + one.operations) for one in batch.found
                ]
                reached.sort(key=lambda pair: pair[0].n_elements)
                drawn = self._first_drawn(reached, most, attempts, stop)
                if drawn is not None:
                    self.states = [self._thinned(drawn, stop)]
                    return

    def _round(self, count: int, stop: Callable[[], bool]) -> None:
        """So many rollouts from the start or from the best state, in turn."""
        before: Operations = []
        start = self._mesh
        if self.states and self._rounds % 2:
            before, start = self.states[0].operations, self.states[0].mesh(self._mesh)
        batch = GuardedRollouts(
            start, self._policy, self._rng, count, self._max_steps, self._ceiling
        )
        batch.run(stop)
        self._rounds += 1
        self.rollouts += count
        for state in batch.found:
            if state.score < start.score:
                state.operations = before + state.operations
                self.states.append(state)
        self.states.sort(key=lambda state: state.rank)
        self.states = [state for state in self.states if state.score == self.score]
