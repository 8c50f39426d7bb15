"""One thread of the solver, which divides its time among three methods.

These are rollouts from the start, rollouts from the best state, and annealing from the best state.
The next turn goes to the method with the least time per improvement.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum
from typing import Protocol

import numpy as np
import torch

from meshwright_agent.env.task import Scratch, transition
from meshwright_agent.env.vector_env import Batch
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.policy.rollout import Runner
from meshwright_agent.search.annealing import SLICE, Annealer, Operations, with_room
from meshwright_agent.search.coarsening import replayed
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES, Operation

SIDE_BY_SIDE = 20_000
"""Elements up to which several rollouts are made at a time; all of them together have as many."""
FIRST, TOGETHER = 8, 32
"""Rollouts side by side on smaller meshes: at first, and later, when nothing was easy."""
KEPT = 16
"""States of equal score that are kept."""
_SHORTEST = 0.02  # seconds of a turn


@dataclass
class Candidate:
    """A state that was found."""

    operations: Operations
    score: int
    method: str
    """The method that found it: "rollouts", "annealing" or "none"."""


class Kind(Enum):
    """The methods among which a worker divides its time."""

    ROLLOUTS = "rollouts from the start"
    ANNEALING = "annealing from the best state"
    CONTINUE = "rollouts from the best state"


@dataclass
class Arm:
    """One of the alternatives that share a worker's time."""

    kind: Kind
    seconds: float = 0.0
    """Time spent on it."""
    finds: int = 0
    """How often it has found something better."""

    @property
    def cost(self) -> float:
        """Seconds for each find; the arm where it is least comes next."""
        return self.seconds / (1 + self.finds)


class Shared(Protocol):
    """The state that all workers of one search share."""

    mesh: HalfEdgeMesh
    policy: Policy
    max_steps: int | None
    thorough: bool
    """Whether rollouts go on after one of those side by side has reached s*."""
    annealing: bool
    score: int
    best: Candidate

    def offer(self, candidate: Candidate) -> None:
        """Add a state to the candidates if it is good enough."""

    def book(self, wanted: int) -> int:
        """Reserve up to `wanted` rollouts; returns how many may be started."""

    def count(self, rollouts: int) -> None:
        """Add to the number of rollouts done."""


class RolloutBatch:
    """What a worker needs to make rollouts from one state apart from a search; keeps what they
    reach.

    Args:
        mesh: the state, which is not changed.
        policy: for meshes of this kind.
        max_steps: length of a rollout, by default that of the policy's task.
        score: s that a rollout must reach to be kept.
    """

    thorough, annealing = True, False

    def __init__(
        self, mesh: HalfEdgeMesh, policy: Policy, max_steps: int | None, score: int
    ) -> None:
        self.mesh, self.policy, self.max_steps = mesh, policy, max_steps
        self.score, self.best = score, Candidate([], mesh.score, "none")
        self.found: list[Candidate] = []

    def offer(self, candidate: Candidate) -> None:
        """Keep it if it has the wanted s."""
        if candidate.score <= self.score:
            self.found.append(candidate)

    def book(self, wanted: int) -> int:
        """As many as are wanted."""
        return wanted

    def count(self, rollouts: int) -> None:
        """They are counted by the caller, if at all."""


class Worker:
    """One thread's search."""

    def __init__(self, search: Shared, seed: int, stop: Callable[[], bool]) -> None:
        self._search, self._stop = search, stop
        self._mesh, self._policy = search.mesh, search.policy
        self._task = self._policy.task
        self._bounds = self._task.bounds(self._mesh.n_elements)
        self._rng = np.random.default_rng(seed)
        self._generator = torch.Generator().manual_seed(seed)
        self._annealer: Annealer | None = None
        self._from = search.best
        self._arms = [Arm(Kind.ROLLOUTS)]
        self._opening = True
        """Whether only rollouts from the start have been made."""

    def work(self) -> None:
        """Rollouts from the start first; then always the arm with the lowest cost per find."""
        search = self._search
        while not self._stop():
            arm = min(self._arms, key=lambda arm: arm.cost)
            began, before = time.perf_counter(), search.score
            if arm.kind is Kind.ANNEALING:
                most = max(arm.seconds for arm in self._arms)
                self._anneal(max(min(most, 0.5), _SHORTEST))
            else:
                granted = search.book(self._together())
                if not granted:
                    return
                going_on = arm.kind is Kind.CONTINUE and search.best.score > self._mesh.optimum
                self._roll(granted, search.best.operations if going_on else [])
            arm.seconds += time.perf_counter() - began
            if not self._opening:
                arm.finds += search.score < before
            elif search.annealing:
                # the three arms start with equal statistics
                self._opening = False
                self._arms = [Arm(kind) for kind in Kind]

    def roll(self, count: int) -> None:
        """So many rollouts from the start; what they reach is offered."""
        self._roll(count, [])

    def _together(self) -> int:
        most = FIRST if self._opening else TOGETHER
        return max(1, min(most, SIDE_BY_SIDE // max(self._mesh.n_elements, 1)))

    def _roll(self, count: int, before: Operations) -> None:
        if self._mesh.n_elements > SIDE_BY_SIDE:
            self._run_one(before)
        else:
            self._run_batch(count, before)
        self._search.count(count)

    def _run_one(self, before: Operations) -> None:
        """One rollout on a large mesh, decision by decision."""
        search = self._search
        start = replayed(self._mesh, before)
        seed = int(self._rng.integers(1 << 31))
        runner = Runner(start, self._policy, seed, search.max_steps)
        operations: Operations = []
        best, length = runner.score, 0
        while not self._stop() and (step := runner.step()):
            operations += step
            if runner.score < best:
                best, length = runner.score, len(operations)
        if not before or best < start.score:
            search.offer(Candidate(before + operations[:length], best, "rollouts"))

    def _run_batch(self, count: int, before: Operations) -> None:
        """Rollouts side by side from where `before` leads to; what leads to the best state of each
        is offered.
        """
        search, start = self._search, replayed(self._mesh, before)
        if start.score <= start.optimum:
            return
        task = self._task
        if search.max_steps is not None:
            task = replace(task, steps=search.max_steps / start.n_elements)
        batch = Batch(task, [start], count, self._rng, endless=False, bounds=self._bounds)
        codes, halfedges = [], []
        rows = np.arange(count)
        while batch.active.any() and not self._stop():
            observation = batch.observe()
            actions = decide(self._policy.network, observation, self._generator)[0]
            halfedges.append(observation.chosen[rows, actions // task.operations])
            codes.append(task.first_operation + actions % task.operations)
            batch.step(observation, actions)
            if not search.thorough and (batch.best <= start.optimum).any():
                break
        best = int(batch.best.min())
        if best > search.score or (before and best == start.score):
            return
        for b in np.flatnonzero(batch.best == best).tolist():
            length = int(batch.best_step[b])
            decisions = [(int(codes[t][b]), int(halfedges[t][b])) for t in range(length)]
            operations = before + self._with_cleanups(start, decisions)
            search.offer(Candidate(operations, best, "rollouts"))

    def _with_cleanups(self, start: HalfEdgeMesh, decisions: list[tuple[int, int]]) -> Operations:
        """Decisions and the clean-ups that follow each of them."""
        arrays = with_room(start, 3 * start.n_elements)
        scratch = Scratch(self._task, 0, 0)
        operations: Operations = []
        for code, h in decisions:
            count = transition(arrays, code, h, self._task.cap, scratch.touched, scratch.cleaned)
            operations.append((NAMES[code], h))
            operations += [(Operation.CLEANUP, line) for line in scratch.cleaned[:count].tolist()]
        return operations

    def _anneal(self, seconds: float) -> None:
        """Anneal for `seconds` from the best state of all threads."""
        search = self._search
        deadline = time.perf_counter() + seconds
        optimum = self._mesh.optimum
        if self._annealer is None or optimum < search.best.score < self._from.score:
            self._from = search.best
            if self._from.score <= self._mesh.optimum:
                self._from = Candidate([], self._mesh.score, "none")
            floor, ceiling = self._bounds
            start = replayed(self._mesh, self._from.operations)
            self._annealer = Annealer(
                start, int(self._rng.integers(1 << 31)), extended=self._task.extended,
                floor=floor, ceiling=max(ceiling, start.n_elements + 8),
            )  # fmt: skip
        annealer = self._annealer
        while time.perf_counter() < deadline and not self._stop():
            annealer.run(SLICE)
            if annealer.best_score < search.score or annealer.finished:
                operations = self._from.operations + annealer.operations()
                found = Candidate(operations, annealer.best_score, "annealing")
                search.offer(found)
                if annealer.finished:
                    self._annealer = None
                    return
