"""The anytime solver: rollouts of a policy and annealing, then shortening and coarsening.

Better means lower s; at equal s fewer elements that stay inverted when the mesh is smoothed; then,
for quads, fewer elements; then fewer operations. s = s* proves that s cannot be lower (section
4.1). The result is a list of operations that can be applied to the given mesh.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any

import numpy as np

from meshwright_agent.env.task import Task
from meshwright_agent.env.vector_env import Batch
from meshwright_agent.policy.policy_files import Policy, require_kind
from meshwright_agent.search.annealing import Operations, anneal
from meshwright_agent.search.cleanup_removal import without_cleanups
from meshwright_agent.search.coarsening import PATIENCE, replayed, undrawable
from meshwright_agent.search.coarsening import coarsen as coarser
from meshwright_agent.search.patchwise import LARGE, improve_large, is_large
from meshwright_agent.search.search_worker import KEPT, SIDE_BY_SIDE, Candidate, Worker
from meshwright_agent.search.shortening import shorten as shorter
from meshwright_core.domains.meshing import benchmark_mesh
from meshwright_core.mesh import HalfEdgeMesh

POLISH = 0.15
"""Share of the time that is reserved for shortening."""
POLISHED = 0.5
"""Largest share of the time that shortening and coarsening may take."""
ALONE = 0.5
"""Most seconds for shortening, and for coarsening, if only a number of rollouts is given."""

PER_IRREGULAR = 50
"""Steps of a rollout per irregular vertex that is left on a large mesh after the patches."""


@dataclass
class Solution:
    """The best result of a search."""

    operations: Operations
    """Operations and their half-edges, to be applied in this order."""
    score: int
    optimum: int
    inverted: int
    """Elements that stay inverted or degenerate when the mesh is smoothed."""
    elements: int = 0
    rollouts: int = 0
    seconds: float = 0.0
    method: str = "none"
    """The method that found it: "rollouts", "annealing", "patches" (large meshes), or "none" if
    nothing better than the start was found."""
    coarse: bool = True
    """Whether fewer elements count as better."""

    @property
    def rank(self) -> tuple[int, int, int, int]:
        """Solutions with a lower rank are better."""
        elements = self.elements if self.coarse else 0
        return self.score, self.inverted, elements, len(self.operations)

    def replay(self, mesh: HalfEdgeMesh) -> None:
        """Apply the operations to `mesh`, the mesh that they were found for.

        Raises RuntimeError if the score reached is not :attr:`score`.
        """
        for operation, halfedge in self.operations:
            mesh.apply(operation, halfedge)
        if mesh.score != self.score:
            raise RuntimeError(f"the replay ends at s = {mesh.score}, the search at {self.score}")

    @property
    def perfect(self) -> bool:
        """Whether s = s*, so that it cannot be lower, without inverted elements."""
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

    A mesh with many irregular vertices is first improved patch by patch
    (:mod:`meshwright_agent.search.patchwise`); the remaining time is used for the whole mesh. Ends
    early at s* if no element stays inverted.

    Args:
        mesh: the start.
        policy: for meshes of the same kind, else PolicyError is raised.
        rollouts: number of rollouts, the best of which counts; 1 if `seconds` is not given either.
        seconds: time limit. Without `rollouts`, rollouts alternate with annealing.
        max_steps: length of a rollout, by default that of the policy's task.
        seed: of the random choices.
        workers: number of threads, each with a seed of its own.
        coarsen: whether to look for fewer elements at equal s (quads only).
        shorten: whether to leave out operations that are not needed.
        progress: called with (rollouts done, lowest s) after rollouts and whenever s falls, from
            the worker threads.
        cancelled: polled; the search ends with the best result so far when it is true.
    """
    require_kind(policy, mesh.kind)
    if seconds is not None:
        prepare(policy)  # so that loading the kernels takes none of the time
    if is_large(mesh):
        go_on = partial(solve, rollouts=rollouts, workers=workers, coarsen=coarsen, shorten=shorten)
        return _patch_by_patch(mesh, policy, seconds, max_steps, seed, progress, cancelled, go_on)
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


def _patch_by_patch(
    mesh: HalfEdgeMesh,
    policy: Policy,
    seconds: float | None,
    max_steps: int | None,
    seed: int,
    progress: Callable[[int, int], None] | None,
    cancelled: Callable[[], bool] | None,
    go_on: Callable[..., Solution],
) -> Solution:
    """Improve a large mesh patch by patch; with few irregular vertices left continue by `go_on`."""
    began = time.perf_counter()
    run = improve_large(
        mesh, policy, seconds=seconds, max_steps=max_steps, seed=seed, cancelled=cancelled,
        progress=None if progress is None else lambda _, score: progress(0, score),
    )  # fmt: skip
    reached, operations = run.mesh, run.steps()
    best = Solution(
        operations, run.score, run.optimum, undrawable(reached, []), reached.n_elements, 1,
        method="patches" if operations else "none",
    )  # fmt: skip
    left = None if seconds is None else max(0.0, seconds - (time.perf_counter() - began))
    if not is_large(reached) and left != 0.0 and not (cancelled is not None and cancelled()):
        if max_steps is None and reached.n_elements > LARGE:
            max_steps = PER_IRREGULAR * (reached.irregular_count + 1)
        rest = go_on(
            reached, policy, seconds=left, max_steps=max_steps, seed=seed, progress=progress,
            cancelled=cancelled,
        )  # fmt: skip
        if rest.operations:
            best = replace(rest, operations=operations + rest.operations, method="patches")
    best.seconds = time.perf_counter() - began
    return best


@cache
def _warm_up(task: Task) -> None:
    mesh = benchmark_mesh(task.kind, 8, np.random.default_rng(0))
    operations = anneal(mesh, proposals=2000)[0]
    shorter(mesh, operations)
    coarser(mesh, proposals=500, seconds=None)
    batch = Batch(task, [mesh], 1, np.random.default_rng(0), endless=False)
    batch.step(batch.observe(), np.array([-1]))


def prepare(policy: Policy) -> None:
    """Compile what a search needs, or load it, so that no search pays for it."""
    _warm_up(policy.task)


class _Search:
    """The state shared by all workers: time, best operations so far, number of rollouts."""

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
        self.best = Candidate([], mesh.score, "none")
        self._candidates: list[Candidate] = []
        self._rounds = 0
        self._undrawable: dict[tuple[Any, ...], int] = {}

    def nothing(self, coarse: bool) -> Solution:
        """Doing nothing: the solution to beat."""
        mesh = self.mesh
        self._candidates.append(self.best)
        return Solution(
            [], mesh.score, mesh.optimum, undrawable(mesh, []), mesh.n_elements,
            coarse=coarse and mesh.kind == "quad",
        )  # fmt: skip

    def over(self, share: float) -> bool:
        """Whether that share of the time is used up, or the search was cancelled."""
        if self._cancelled is not None and self._cancelled():
            return True
        return self.seconds is not None and (
            time.perf_counter() - self.began > share * self.seconds
        )

    @property
    def exhausted(self) -> bool:
        """Whether the given number of rollouts has been started."""
        return self.wanted is not None and self._begun >= self.wanted

    def offer(self, candidate: Candidate) -> None:
        """Add a state to the candidates; the best few are kept, shortest first."""
        with self._lock:
            if candidate.score > self.score:
                return
            better = candidate.score < self.score
            if better:
                self._candidates.clear()
                self.score = candidate.score
            self._candidates.append(candidate)
            self._candidates.sort(key=lambda found: len(found.operations))
            del self._candidates[KEPT:]
            if better:
                self.best = candidate
        if better:
            self.count(0)

    def take(self) -> list[Candidate]:
        """Remove and return the candidates."""
        taken, self._candidates = self._candidates, []
        return taken

    def book(self, wanted: int) -> int:
        """Reserve up to `wanted` rollouts; returns how many may be started."""
        with self._lock:
            granted = wanted if self.wanted is None else min(wanted, self.wanted - self._begun)
            self._begun += max(granted, 0)
        return max(granted, 0)

    def count(self, rollouts: int) -> None:
        """Add to the number of rollouts done and report progress."""
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
            Worker(self, self.seed + 104729 * self._rounds, stop).work()
            return
        with ThreadPoolExecutor(workers, thread_name_prefix="solver") as pool:
            futures = [
                pool.submit(Worker(self, self.seed + 104729 * self._rounds + i, stop).work)
                for i in range(workers)
            ]
            for future in futures:
                future.result()

    def shortened(self) -> list[Candidate]:
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
        self, candidate: Candidate, coarsen: bool, shorten: bool, best: Solution
    ) -> Solution:
        """The candidate coarsened and shortened again, within its share of the time."""
        mesh, operations = self.mesh, candidate.operations
        if mesh.kind == "quad" and (inverted := self._inverted(operations)):
            finer = without_cleanups(mesh, operations)
            if self._inverted(finer) < inverted:
                operations = finer
        if coarsen and mesh.kind == "quad" and mesh.n_elements <= SIDE_BY_SIDE:
            reached = replayed(mesh, operations)
            added = coarser(
                reached, seconds=self._share(0.7), seed=self.seed + self.done,
                patience=PATIENCE if self.seconds is None else None, cancelled=self._stopped,
            )  # fmt: skip
            if added and self._inverted(operations + added) <= self._inverted(operations):
                operations = operations + added
                if shorten:
                    operations = self._shorter(operations)
        reached = replayed(mesh, operations)
        return Solution(
            operations, reached.score, mesh.optimum, self._inverted(operations),
            reached.n_elements, method=candidate.method, coarse=best.coarse,
        )  # fmt: skip

    def _shorter(self, operations: Operations) -> Operations:
        """Fewer operations, unless they lead to another mesh in which more stays inverted."""
        fewer = shorter(self.mesh, operations, seconds=self._share(1.0), cancelled=self._stopped)
        return fewer if self._inverted(fewer) <= self._inverted(operations) else operations

    def _inverted(self, operations: Operations) -> int:
        """`undrawable` after the operations, computed once: it can take a second."""
        key = tuple(operations)
        if key not in self._undrawable:
            self._undrawable[key] = undrawable(self.mesh, operations)
        return self._undrawable[key]

    def _share(self, share: float) -> float:
        """Seconds for a part of the polish: `share` of what is left for it."""
        if self.seconds is None:
            return ALONE
        left = self.seconds - (time.perf_counter() - self.began)
        return max(0.0, share * min(left, POLISHED * self.seconds))
