"""Search in a region of a mesh; the connectivity outside and the vertices on the rim do not change.

The region is extracted as a separate mesh in which the rim is locked and every vertex has the same
Delta as in the whole mesh, so that s of the region and of the mesh change by the same amount.
Operations that would leave the region are forbidden: global splits, whose cuts would continue
outside, and splits of edges on the rim.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch

from meshwright_agent.env.task import MOST_CLEANUPS, transition
from meshwright_agent.env.vector_env import Batch
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.policy_files import Policy, require_kind
from meshwright_agent.search.annealing import WEIGHTS, Annealer, Operations, with_room
from meshwright_agent.search.patch_extraction import MOST_TAKEN, cut_out, mask_rim
from meshwright_agent.search.patchwise import improve_large
from meshwright_agent.search.repair_queue import agenda
from meshwright_agent.search.shortening import shorten
from meshwright_agent.search.solver import prepare
from meshwright_core.analysis.submesh import enclose
from meshwright_core.core.arrays import (
    ELEMENT_SLOTS,
    FLAGS,
    FREE_ELEMENT,
    LOCKED,
    TWIN,
    MeshArrays,
    allocate,
)
from meshwright_core.core.mesh_boundary import MeshBoundary
from meshwright_core.geometry.smoothing import relax
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import CODES, NAMES, Operation

MANY = 128
"""Irregular vertices above which a region is first improved patch by patch."""
SIDE_BY_SIDE = 16
"""Rollouts in parallel."""
POLISH = 0.15
"""Share of the time that is reserved for shortening the operations."""
SHORTENING = 0.3
"""Time limit for shortening, in seconds, if only a number of rollouts is given."""
KEEP, GROW = 0.75, 1.5
"""Least and largest number of elements of a region, relative to its start: the rim fixes the size
of the elements along it, and much larger ones beside them cannot be drawn."""
FLAW = 2
"""Cost, in units of s, of an element that stays inverted when the region is smoothed."""
DRAWN = 4
"""Largest number of states of a round that are smoothed and tested for inverted elements."""


@dataclass
class RegionSolution:
    """The best result found for a region of a mesh."""

    operations: Operations
    """Operations and half-edges of the whole mesh, to be applied in this order while the vertices
    outside the region are held (:func:`meshwright_core.analysis.submesh.temporarily_locked`)."""
    score: int
    """s of the whole mesh after the operations."""
    optimum: int
    """Lower bound of s of the whole mesh if only the region changes."""
    rollouts: int = 0
    seconds: float = 0.0


def solve_within(
    mesh: HalfEdgeMesh,
    policy: Policy,
    elements: np.ndarray,
    *,
    rollouts: int | None = None,
    seconds: float | None = None,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> RegionSolution:
    """Improve `mesh`, which is not changed, by changing only `elements`.

    Better means lower s plus FLAW for each element that stays inverted when the region is smoothed,
    then fewer operations. Ends early when the lower bound is reached without inverted elements.

    Args:
        mesh: the whole mesh.
        policy: for meshes of the same kind, else PolicyError is raised.
        elements: (n,) ids; MeshError is raised if no vertex lies inside this region.
        rollouts: number of rollouts; SIDE_BY_SIDE if `seconds` is not given either.
        seconds: time limit. Without `rollouts`, rollouts alternate with annealing (quads only).
        seed: of the random choices.
        progress: called with (rollouts done, lowest s of the whole mesh) now and then.
        cancelled: polled; the search ends with the best result so far when it is true.
    """
    require_kind(policy, mesh.kind)
    prepare(policy)
    search = _Search(mesh, policy, elements, rollouts, seconds, seed, progress, cancelled)
    search.improve_patches()
    search.improve()
    return search.result()


class _Region:
    """A region as a separate mesh, and the ids of its elements in the whole mesh."""

    def __init__(self, mesh: HalfEdgeMesh, elements: np.ndarray) -> None:
        arrays, k, count = mesh.arrays, mesh.k, len(elements)
        scratch = agenda(len(arrays.vertex), len(arrays.element_mark))
        scratch.place[elements] = np.arange(1, count + 1)
        out = allocate(k, k * count, count, 1, 1)
        cut_out(arrays, scratch, k, elements, k == 4, out, np.zeros(k * count, np.int64))
        self.mesh, self.elements = HalfEdgeMesh(out, MeshBoundary()), elements

    def put_back(self, whole: HalfEdgeMesh, operations: Operations) -> Operations:
        """Apply operations of the region to `whole`, up to its lowest s.

        Stops where one is refused there or changes s by another amount. Returns the applied
        operations with the half-edges of the whole mesh.
        """
        region, k = self.mesh.copy(), whole.k
        place = dict(enumerate(self.elements.tolist()))
        trial = whole.copy()
        done: Operations = []
        best, kept = trial.score, 0
        for operation, h in operations:
            there = place[h // k] * k + h % k
            if not trial.check(operation, there):
                break
            new = zip(_next_slots(region.arrays, k), _next_slots(trial.arrays, k), strict=True)
            place.update(new)
            changed = trial.apply(operation, there).score_change
            if changed != region.apply(operation, h).score_change:
                break
            done.append((operation, there))
            if trial.score < best:
                best, kept = trial.score, len(done)
        for operation, h in done[:kept]:
            whole.apply(operation, h)
        return done[:kept]


def _next_slots(arrays: MeshArrays, k: int) -> list[int]:
    """The element slots that a local operation will take, in this order."""
    e, unused = int(arrays.counters[FREE_ELEMENT]), int(arrays.counters[ELEMENT_SLOTS])
    slots = []
    for _ in range(MOST_TAKEN):
        if e >= 0:
            slots.append(e)
            e = int(arrays.edge[e * k, TWIN])
        else:
            slots.append(unused)
            unused += 1
    return slots


class _Search:
    """The state of a search: the whole mesh, the region, the best result and the time."""

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        policy: Policy,
        elements: np.ndarray,
        rollouts: int | None,
        seconds: float | None,
        seed: int,
        progress: Callable[[int, int], None] | None,
        cancelled: Callable[[], bool] | None,
    ) -> None:
        self.began = time.perf_counter()
        self.policy, self.task, self.seed = policy, policy.task, seed
        self.seconds = seconds
        self.wanted = SIDE_BY_SIDE if rollouts is None and seconds is None else rollouts
        self.rng = np.random.default_rng(seed)
        self.generator = torch.Generator().manual_seed(seed)
        self._progress, self._cancelled = progress, cancelled
        enclosure = enclose(mesh, elements)
        self.mesh = mesh.copy()
        self.mesh.arrays.vertex[enclosure.held, FLAGS] |= LOCKED
        self.outside = np.setdiff1d(mesh.element_ids(), enclosure.elements, assume_unique=True)
        self._ends = self._outside_ends()
        self.operations: Operations = []
        self.region = _Region(self.mesh, enclosure.elements)
        self.optimum = mesh.score - self.region.mesh.score + self.region.mesh.optimum
        self.done = 0
        self.best: Operations = []
        self.best_score = self.region.mesh.score
        self.flaws = self._flaws_of([])
        size = self.region.mesh.n_elements
        floor = max(KEEP, self.task.element_floor)
        self.bounds = int(np.ceil(floor * size)), max(size + 8, int(GROW * size))

    def _outside_ends(self) -> np.ndarray:
        return self.mesh.corners(self.outside)

    def over(self, share: float = 1.0) -> bool:
        """Whether this share of the time has passed, or the search was cancelled."""
        if self._cancelled is not None and self._cancelled():
            return True
        return self.seconds is not None and self._seconds() > share * self.seconds

    def _seconds(self) -> float:
        return time.perf_counter() - self.began

    def _report(self) -> None:
        if self._progress is not None:
            gained = self.region.mesh.score - self.best_score
            self._progress(self.done, self.mesh.score - gained)

    def improve_patches(self) -> None:
        """If the region has many irregular vertices, improve it patch by patch first."""
        if self.region.mesh.irregular_count <= MANY:
            return
        run = improve_large(
            self.mesh, self.policy, seconds=None if self.seconds is None else 0.6 * self.seconds,
            seed=self.seed, cancelled=self._cancelled, within=self.region.elements, floor=KEEP,
            progress=None if self._progress is None else self._progress,
        )  # fmt: skip
        self.operations = run.steps()
        self.mesh = run.mesh
        here = np.setdiff1d(self.mesh.element_ids(), self.outside, assume_unique=True)
        self.region = _Region(self.mesh, here)
        self.best_score = self.region.mesh.score
        self.flaws = self._flaws_of([])

    def improve(self) -> None:
        """Rollouts, and annealing for quads, until the optimum or the limit of time or rollouts."""
        while not self._perfect and not self.over(1.0 - POLISH):
            left = SIDE_BY_SIDE if self.wanted is None else self.wanted - self.done
            if left <= 0:
                break
            began = self._seconds()
            self._roll(min(left, SIDE_BY_SIDE))
            if self.wanted is None and self.mesh.k == 4 and not self._perfect:
                self._anneal(self._seconds() + max(0.1, self._seconds() - began))

    @property
    def _perfect(self) -> bool:
        """Whether s is at its lower bound without inverted elements."""
        return self.best_score == self.region.mesh.optimum and self.flaws == 0

    def _roll(self, size: int) -> None:
        """Play `size` rollouts in parallel."""
        task, mesh = self.task, self.region.mesh
        if mesh.score == mesh.optimum:
            self.done += size
            return
        batch = Batch(task, [mesh] * size, size, self.rng, endless=False, bounds=self.bounds)
        operations, halfedges = [], []
        while (
            batch.active.any()
            and (batch.best == mesh.optimum).sum() < DRAWN
            and not self.over(1.0 - POLISH)
        ):
            seen = batch.observe()
            if task.kind == "quad":
                seen.mask[:, :, -1] = False  # a global split would continue beyond the rim
            else:
                mask_rim(batch.meshes, seen.chosen, seen.mask)
            actions = decide(self.policy.network, seen, self.generator)[0]
            rows = np.maximum(actions // task.operations, 0)
            operations.append(task.first_operation + actions % task.operations)
            halfedges.append(seen.chosen[np.arange(size), rows])
            batch.step(seen, actions)
        self.done += size
        for at in np.lexsort((batch.best_step, batch.best))[:DRAWN].tolist():
            if batch.best[at] > self._cost or self._perfect:
                break
            count = int(batch.best_step[at])
            codes = [int(row[at]) for row in operations[:count]]
            self._offer(self._with_cleanups(codes, [int(row[at]) for row in halfedges[:count]]))
        self._report()

    def _with_cleanups(self, codes: list[int], halfedges: list[int]) -> Operations:
        """The operations of a rollout with the automatic clean-ups."""
        arrays = with_room(self.region.mesh, 3 * self.region.mesh.n_elements)
        touched, cleaned = np.zeros(16, np.int64), np.zeros(MOST_CLEANUPS, np.int64)
        found: Operations = []
        for code, h in zip(codes, halfedges, strict=True):
            count = transition(arrays, code, h, self.task.cap, touched, cleaned)
            found.append((NAMES[code], h))
            found += [(Operation.CLEANUP, line) for line in cleaned[:count].tolist()]
        return found

    def _anneal(self, until: float) -> None:
        weights = list(WEIGHTS["quad"])
        weights[CODES[4][Operation.GLOBAL_SPLIT] - CODES[4][Operation.FLIP_LEFT]] = 0.0
        floor, ceiling = self.bounds
        annealer = Annealer(
            self.region.mesh, int(self.rng.integers(1 << 31)), weights=tuple(weights), floor=floor,
            ceiling=ceiling,
        )  # fmt: skip
        while not annealer.finished and self._seconds() < until and not self.over(1.0 - POLISH):
            annealer.run()
        self._offer(annealer.operations())

    def _offer(self, operations: Operations) -> None:
        """Keep the result of the operations if it is better than the best so far."""
        reached = self.region.mesh.copy()
        for operation, h in operations:
            reached.apply(operation, h)
        # automatic clean-ups may go below the least number of elements
        if reached.score <= self._cost and reached.n_elements >= self.bounds[0]:
            flaws = self._flaws_of(operations)
            cost = reached.score + FLAW * flaws
            if (cost, len(operations)) < (self._cost, len(self.best)):
                self.best, self.best_score, self.flaws = operations, reached.score, flaws
        self._report()

    @property
    def _cost(self) -> int:
        """The cost of the best state, which a better one must undercut."""
        return self.best_score + FLAW * self.flaws

    def _flaws_of(self, operations: Operations) -> int:
        """Inverted elements around the region when it is smoothed after the operations."""
        whole = self.mesh.copy()
        self.region.put_back(whole, operations)
        here = np.setdiff1d(whole.element_ids(), self.outside, assume_unique=True)
        vertices = np.unique(whole.corners(here))
        return len(relax(whole, vertices[~whole.locked()[vertices]]))

    def result(self) -> RegionSolution:
        """The best operations, shortened and applied to the whole mesh."""
        left = SHORTENING if self.seconds is None else self.seconds - self._seconds()
        found = shorten(
            self.region.mesh, self.best, seconds=max(0.0, left), cancelled=self._cancelled
        )
        if len(found) < len(self.best) and self._flaws_of(found) > self.flaws:
            found = self.best
        self.operations += self.region.put_back(self.mesh, found)
        if not np.array_equal(self._ends, self._outside_ends()):
            raise RuntimeError("a search within a region has changed elements outside")
        return RegionSolution(
            self.operations, self.mesh.score, self.optimum, self.done, self._seconds()
        )
