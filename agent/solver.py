"""The anytime solver: rollouts of a policy and annealing, then the answer made short and coarse.

Better is: the lower s; among equals fewer elements that cannot be drawn without folding; then fewer
elements (quads); then fewer operations. At s = s* nothing is left to prove. The answer is a list of
operations that replays on the mesh it was found for.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import torch

from agent.annealing import SLICE, Annealer, Operations, anneal, with_room
from agent.batch import Batch
from agent.coarsening import coarsen as coarser
from agent.coarsening import undrawable
from agent.policies import Policy, PolicyError
from agent.ppo import decide
from agent.rollout import Runner
from agent.shortening import shorten as shorter
from agent.task import Scratch, Task, transition
from meshcore.generate import benchmark_mesh
from meshcore.mesh import HalfEdgeMesh
from meshcore.operations import NAMES, Operation

LARGE = 20_000
"""Elements above which one rollout is made at a time."""
TOGETHER = 8
"""Rollouts side by side, on smaller meshes."""
POLISH = 0.15
"""Share of the time that is left for shortening where the optimum is not found."""
POLISHED = 0.5
"""Share of the time that shortening and coarsening may take at the optimum."""
ALONE = 0.5
"""Seconds of shortening, and of coarsening, where only a number of rollouts is asked for."""
_KEPT = 4
_SLICE_SECONDS = 0.02


@dataclass
class Solution:
    """The best that a search has found."""

    operations: Operations
    """Operations and half-edges, to be applied in this order."""
    score: int
    optimum: int
    inverted: int
    """Elements that stay inverted, or degenerate, when the mesh is smoothed."""
    elements: int = 0
    rollouts: int = 0
    seconds: float = 0.0
    method: str = "none"
    """What found it: "rollouts", "annealing", or "none" where nothing better was found."""
    coarse: bool = True
    """Whether fewer elements are better."""

    @property
    def rank(self) -> tuple[int, int, int, int]:
        """Solutions with a lower rank are better."""
        elements = self.elements if self.coarse else 0
        return self.score, self.inverted, elements, len(self.operations)

    @property
    def perfect(self) -> bool:
        """At the optimum, which is a proof that s cannot be lower, and drawn without a fold."""
        return self.score == self.optimum and self.inverted == 0


def solve(
    mesh: HalfEdgeMesh,
    policy: Policy,
    *,
    rollouts: int | None = None,
    seconds: float | None = None,
    max_steps: int | None = None,
    seed: int = 0,
    workers: int = 1,
    coarsen: bool = True,
    shorten: bool = True,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Solution:
    """The best state found from `mesh`, which is not changed.

    With `rollouts`, the best of so many runs of the policy, within `seconds` if given; with
    `seconds` alone, rollouts and annealing in turn; with neither, one rollout. max_steps: of a
    rollout, by default what the policy was trained with. workers: threads, with seeds of their own.
    coarsen: at equal s look for fewer elements (quads only). shorten: leave out operations that are
    not needed. Ends early, with a proof, at s*; `cancelled()` ends it at any time with the best so
    far. `progress(rollouts done, best s)` is called, from the worker threads, after rollouts and
    whenever s falls.

    Raises PolicyError if the policy is for the other kind of mesh.
    """
    if mesh.kind != policy.kind:
        raise PolicyError(
            f"{policy.name}: this policy is for {policy.kind} meshes, not {mesh.kind}"
        )
    prepare(policy)
    search = _Search(mesh, policy, rollouts, seconds, max_steps, seed, progress, cancelled)
    best = search.nothing(coarsen)
    again = False
    while True:
        if search.score > mesh.optimum or again:
            search.look(workers, past_optimum=again)
        candidates = search.shortened() if shorten else search.take()
        for candidate in candidates:
            found = search.finished(candidate, coarsen, shorten, best)
            best = min(best, found, key=lambda solution: solution.rank)
            if best.perfect or search.over(1.0):
                break
        again = True
        if best.perfect or seconds is None or search.over(1.0 - POLISH) or search.exhausted:
            break
    best.rollouts, best.seconds = search.done, time.perf_counter() - search.began
    return best


@cache
def _kernels(task: Task) -> None:
    mesh = benchmark_mesh(task.kind, 8, np.random.default_rng(0))
    operations = anneal(mesh, proposals=2000)[0]
    shorter(mesh, operations)
    coarser(mesh, proposals=500, seconds=None)
    batch = Batch(task, [mesh], 1, np.random.default_rng(0), endless=False)
    batch.step(batch.observe(), np.array([-1]))
    with_room(mesh, 0)


def prepare(policy: Policy) -> None:
    """Compile the kernels that a search needs, or load them, so that no search pays for it."""
    _kernels(policy.task)


@dataclass
class _Candidate:
    operations: Operations
    score: int
    method: str


class _Search:
    """What the workers share: the time, the best operations so far, and how many rollouts."""

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        policy: Policy,
        rollouts: int | None,
        seconds: float | None,
        max_steps: int | None,
        seed: int,
        progress: Callable[[int, int], None] | None,
        cancelled: Callable[[], bool] | None,
    ) -> None:
        self.began = time.perf_counter()
        self.mesh, self.policy, self.seed = mesh, policy, seed
        self.seconds, self.max_steps = seconds, max_steps
        self.annealing = rollouts is None and seconds is not None
        self.wanted = 1 if rollouts is None and seconds is None else rollouts
        self._progress, self._cancelled = progress, cancelled
        self._lock = threading.Lock()
        self.score, self.done, self._begun = mesh.score, 0, 0
        self.best = _Candidate([], mesh.score, "none")
        self._candidates: list[_Candidate] = []
        self._rounds = 0

    def nothing(self, coarse: bool) -> Solution:
        """Doing nothing: the solution to beat."""
        mesh = self.mesh
        self._candidates.append(self.best)
        return Solution(
            [], mesh.score, mesh.optimum, undrawable(mesh, []), mesh.n_elements,
            coarse=coarse and mesh.kind == "quad",
        )  # fmt: skip

    def over(self, share: float) -> bool:
        """Whether that share of the time is used up, or somebody said stop."""
        if self._cancelled is not None and self._cancelled():
            return True
        return self.seconds is not None and (
            time.perf_counter() - self.began > share * self.seconds
        )

    @property
    def exhausted(self) -> bool:
        """Whether all rollouts that were asked for are done."""
        return self.wanted is not None and self._begun >= self.wanted

    def offer(self, candidate: _Candidate) -> None:
        """A state that was found; the best few are kept, shortest first."""
        with self._lock:
            if candidate.score > self.score:
                return
            better = candidate.score < self.score
            if better:
                self._candidates.clear()
                self.score = candidate.score
            self._candidates.append(candidate)
            self._candidates.sort(key=lambda found: len(found.operations))
            del self._candidates[_KEPT:]
            if better:
                self.best = candidate
        if better:
            self.count(0)

    def take(self) -> list[_Candidate]:
        """The best states that have not been taken yet."""
        taken, self._candidates = self._candidates, []
        return taken

    def book(self, wanted: int) -> int:
        """How many of so many rollouts may be begun now."""
        with self._lock:
            granted = wanted if self.wanted is None else min(wanted, self.wanted - self._begun)
            self._begun += max(granted, 0)
        return max(granted, 0)

    def count(self, rollouts: int) -> None:
        """So many rollouts are done."""
        with self._lock:
            self.done += rollouts
            done, score = self.done, self.score
        if self._progress is not None:
            self._progress(done, score)

    def look(self, workers: int, past_optimum: bool) -> None:
        """Search until the optimum, the end of the time, or the last rollout.

        past_optimum: s* is reached, but no state there can be drawn: look for one more.
        """
        self._rounds += 1

        def stop() -> bool:
            goal = mesh.optimum
            found = bool(self._candidates) if past_optimum else self.score <= goal
            return found or self.over(1.0 - POLISH)

        mesh = self.mesh
        if workers <= 1:
            _Worker(self, self.seed + 104729 * self._rounds, stop).work()
            return
        with ThreadPoolExecutor(workers, thread_name_prefix="solver") as pool:
            futures = [
                pool.submit(_Worker(self, self.seed + 104729 * self._rounds + i, stop).work)
                for i in range(workers)
            ]
            for future in futures:
                future.result()

    def shortened(self) -> list[_Candidate]:
        """The best states not taken yet, with fewer operations where possible; shortest first."""
        found = []
        for left, candidate in enumerate(reversed(self.take()), 1):
            operations = shorter(
                self.mesh, candidate.operations, seconds=self._share(0.4 / left),
                cancelled=self._stopped,
            )  # fmt: skip
            found.append(replace(candidate, operations=operations))
        return sorted(found, key=lambda candidate: len(candidate.operations))

    def _stopped(self) -> bool:
        return self.over(1.0)

    def finished(
        self, candidate: _Candidate, coarsen: bool, shorten: bool, best: Solution
    ) -> Solution:
        """The candidate coarsened and shortened again, within its share of the time."""
        mesh, operations = self.mesh, candidate.operations
        if coarsen and mesh.kind == "quad" and mesh.n_elements <= LARGE:
            reached = _replayed(mesh, operations)
            added = coarser(
                reached, seconds=self._share(0.7), seed=self.seed + self.done,
                cancelled=self._stopped,
            )  # fmt: skip
            operations = operations + added
            if added and shorten:
                operations = shorter(
                    mesh, operations, seconds=self._share(1.0), cancelled=self._stopped
                )
        reached = _replayed(mesh, operations)
        return Solution(
            operations, reached.score, mesh.optimum, undrawable(mesh, operations),
            reached.n_elements, method=candidate.method, coarse=best.coarse,
        )  # fmt: skip

    def _share(self, share: float) -> float:
        """Seconds for a part of the polish: `share` of what is left for it."""
        if self.seconds is None:
            return ALONE
        left = self.seconds - (time.perf_counter() - self.began)
        return max(0.0, share * min(left, POLISHED * self.seconds))


class _Worker:
    """One thread's search."""

    def __init__(self, search: _Search, seed: int, stop: Callable[[], bool]) -> None:
        self._search, self._stop = search, stop
        self._mesh, self._policy = search.mesh, search.policy
        self._rng = np.random.default_rng(seed)
        self._generator = torch.Generator().manual_seed(seed)
        self._task = self._policy.task
        self._annealer: Annealer | None = None
        self._from = search.best

    def work(self) -> None:
        """Rollouts from the start, then in turn annealing and rollouts, equal in time."""
        search = self._search
        spent = {"rollouts": 0.0, "annealing": 0.0 if search.annealing else np.inf}
        while not self._stop():
            began = time.perf_counter()
            if spent["rollouts"] <= spent["annealing"]:
                granted = search.book(self._together())
                if not granted:
                    return
                self._roll(granted)
                spent["rollouts"] += time.perf_counter() - began
            else:
                self._anneal(max(spent["rollouts"] - spent["annealing"], _SLICE_SECONDS))
                spent["annealing"] += time.perf_counter() - began

    def _together(self) -> int:
        return max(1, min(TOGETHER, LARGE // max(self._mesh.n_elements, 1)))

    def _roll(self, count: int) -> None:
        if self._mesh.n_elements > LARGE:
            self._run_one()
        else:
            self._run_batch(count)
        self._search.count(count)

    def _run_one(self) -> None:
        """One rollout on a large mesh, decision by decision."""
        search = self._search
        runner = Runner(
            self._mesh, self._policy, int(self._rng.integers(1 << 31)), search.max_steps
        )
        operations: Operations = []
        best, length = runner.score, 0
        while not self._stop() and (step := runner.step()):
            operations += step
            if runner.score < best:
                best, length = runner.score, len(operations)
        search.offer(_Candidate(operations[:length], best, "rollouts"))

    def _run_batch(self, count: int) -> None:
        """Rollouts side by side; what leads to the best state of each is offered."""
        search, mesh = self._search, self._mesh
        if mesh.score == mesh.optimum:
            return
        task = self._task
        if search.max_steps is not None:
            task = replace(task, steps=search.max_steps / mesh.n_elements)
        batch = Batch(task, [mesh], count, self._rng, endless=False)
        codes, halfedges = [], []
        rows = np.arange(count)
        while batch.active.any() and not self._stop():
            observation = batch.observe()
            actions = decide(self._policy.network, observation, self._generator)[0]
            halfedges.append(observation.chosen[rows, actions // task.operations])
            codes.append(task.first_operation + actions % task.operations)
            batch.step(observation, actions)
            if self._search.wanted is None and (batch.best <= mesh.optimum).any():
                break
        best = int(batch.best.min())
        if best > search.score:
            return
        for b in np.flatnonzero(batch.best == best)[:_KEPT].tolist():
            length = int(batch.best_step[b])
            decisions = [(int(codes[t][b]), int(halfedges[t][b])) for t in range(length)]
            search.offer(_Candidate(self._with_cleanups(decisions), best, "rollouts"))

    def _with_cleanups(self, decisions: list[tuple[int, int]]) -> Operations:
        """Decisions and the clean-ups that follow each of them."""
        arrays = with_room(self._mesh, 3 * self._mesh.n_elements)
        scratch = Scratch(self._task, 0, 0)
        operations: Operations = []
        for code, h in decisions:
            count = transition(arrays, code, h, self._task.cap, scratch.touched, scratch.cleaned)
            operations.append((NAMES[code], h))
            operations += [(Operation.CLEANUP, line) for line in scratch.cleaned[:count].tolist()]
        return operations

    def _anneal(self, seconds: float) -> None:
        """Anneal for so long from the best state that anybody has found."""
        search = self._search
        deadline = time.perf_counter() + seconds
        optimum = self._mesh.optimum
        if self._annealer is None or optimum < search.best.score < self._from.score:
            self._from = search.best
            if self._from.score <= self._mesh.optimum:
                self._from = _Candidate([], self._mesh.score, "none")
            floor, ceiling = self._task.bounds(self._mesh.n_elements)
            start = _replayed(self._mesh, self._from.operations)
            self._annealer = Annealer(
                start, int(self._rng.integers(1 << 31)), extended=self._task.extended,
                floor=floor, ceiling=max(ceiling, start.n_elements + 8),
            )  # fmt: skip
        annealer = self._annealer
        while time.perf_counter() < deadline and not self._stop():
            annealer.run(SLICE)
            if annealer.best_score < search.score or annealer.finished:
                operations = self._from.operations + annealer.operations()
                found = _Candidate(operations, annealer.best_score, "annealing")
                search.offer(found)
                if annealer.finished:
                    self._annealer = None
                    return


def _replayed(mesh: HalfEdgeMesh, operations: Operations) -> HalfEdgeMesh:
    reached = mesh.copy()
    for operation, h in operations:
        reached.apply(operation, h)
    return reached
