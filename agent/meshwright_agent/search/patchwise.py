"""Improving meshes of any size: disjoint patches around irregular vertices, decided in one batch.

First, greedy descent applies every operation that lowers s by itself. Then patches of about 128
elements are extracted around irregular vertices, 64 at a time, and the policy plays an episode on
each in parallel; the operations up to the best state of each patch are applied to the large mesh,
so s never rises. A patch without improvement is tried again later with more elements, and finally
given up. The time is therefore proportional to the number of irregular vertices, and the cost of a
decision does not depend on the size of the mesh.

Operations must stay inside their patch. Global splits, which would continue through others, and
clean-ups, which do not change s, are left to solvers of the whole mesh.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import torch

from meshwright_agent.env.candidates import LOOKED_AT, Rules
from meshwright_agent.env.task import Task
from meshwright_agent.env.vector_env import Batch
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.policy_files import Policy, require_kind
from meshwright_agent.search.patch_extraction import (
    MOST_TAKEN,
    Edits,
    cut_out,
    mask_rim,
    next_patch,
    put_back,
)
from meshwright_agent.search.repair_queue import (
    FILL,
    Agenda,
    agenda,
    descend,
    enlarged,
    enlist,
    settle,
)
from meshwright_core.core.arrays import (
    ELEMENT_SLOTS,
    IRREGULAR,
    JOURNALLING,
    STEP_COLUMNS,
    allocate,
)
from meshwright_core.core.mesh_boundary import MeshBoundary
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES, Operation

LARGE, MANY = 5_000, 500
"""Elements above which a mesh counts as large, and irregular vertices above which any mesh does."""
PATCHES = 64
"""Patches in a round."""
SMALLEST, LARGEST = 128, 512
"""Elements of a patch at the first visit, and at most; each visit without success doubles them."""
VISITS = 2
"""Visits without improvement after which an irregular vertex is given up."""
PATIENCE = 25
"""Decisions without improvement after which the episode on a patch ends."""
CANDIDATES = 12
"""Candidates of a decision on a patch; more make it slower, but not better."""
CEILING = 1.1
"""Largest number of elements of a patch, relative to its start."""
_FOUND = 1024  # largest number of elements of a patch, with those at pinched vertices
_LOOKS = 10_000  # vertices that the descent processes between two checks of the time
_ENTRIES = 100  # largest number of journal entries of a local operation
_SPARE = 4 * PATCHES * LARGEST  # free slots before the operations of a round are applied


@dataclass
class LargeRun:
    """The result of :func:`improve_large`."""

    mesh: HalfEdgeMesh
    """The result; without history."""
    operations: np.ndarray
    """(N,) codes of :mod:`meshwright_core.operations.catalogue`; they can be replayed in this order
    on the given mesh."""
    halfedges: np.ndarray
    """(N,) the half-edge of each."""
    score: int
    optimum: int
    start_score: int
    start_irregular: int
    """Irregular vertices at the start."""
    start_elements: int
    descent: int = 0
    """Number of operations of the descent; they come first."""
    decisions: int = 0
    """Number of decisions of the policy."""
    patches: int = 0
    """Number of patches on which the policy played."""
    seconds: float = 0.0
    reason: str = ""
    """Why the search ended, in words."""

    @property
    def irregular(self) -> int:
        """Irregular vertices that are left."""
        return self.mesh.irregular_count

    @property
    def removed(self) -> float:
        """Share of the irregular vertices that were removed."""
        return 1.0 - self.irregular / self.start_irregular if self.start_irregular else 0.0

    def steps(self) -> list[tuple[Operation, int]]:
        """The operations with their half-edges, in the format of the other searches."""
        pairs = zip(self.operations.tolist(), self.halfedges.tolist(), strict=True)
        return [(NAMES[code], h) for code, h in pairs]


def is_large(mesh: HalfEdgeMesh) -> bool:
    """Whether a mesh should first be improved patch by patch.

    Never if it has so few irregular vertices that each decision considers all of them.
    """
    return mesh.irregular_count > (LOOKED_AT if mesh.n_elements > LARGE else MANY)


def improve_large(
    mesh: HalfEdgeMesh,
    policy: Policy,
    *,
    seconds: float | None = None,
    max_steps: int | None = None,
    seed: int = 0,
    within: np.ndarray | None = None,
    floor: float = 0.0,
    progress: Callable[[int, int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> LargeRun:
    """Improve a mesh of any size, which is not changed; s of the result is never higher.

    Ends at the optimum, when all irregular vertices are removed or given up, after `seconds`, after
    `max_steps` decisions of the policy, or when `cancelled()` is true.

    Args:
        mesh: the start.
        policy: for meshes of the same kind, else PolicyError is raised.
        seconds: time limit.
        max_steps: largest number of decisions of the policy.
        seed: of the random choices.
        within: (N,) ids of the only elements that may change; the vertices on their rim must be
            locked.
        floor: least number of elements of each patch, relative to its start; that of the policy's
            task is used if it is larger.
        progress: called with (number of operations, s) after each round.
        cancelled: polled now and then.
    """
    require_kind(policy, mesh.kind)
    began = time.perf_counter()
    work = _Work(mesh, policy, seed, floor)
    if within is not None:
        work.confine(within)

    def stop() -> str:
        if work.mesh.score <= work.mesh.optimum:
            return "at the optimum"
        if cancelled is not None and cancelled():
            return "cancelled"
        if seconds is not None and time.perf_counter() - began > seconds:
            return f"all {seconds:g} seconds are used"
        if max_steps is not None and work.decisions >= max_steps:
            return f"all {max_steps} decisions are used"
        return ""

    reason = work.descend(stop) if within is None else stop()
    descent = work.count
    if progress is not None:
        progress(work.count, work.mesh.score)
    while not reason:
        if not work.play_round(stop):
            reason = "all irregular vertices are removed or given up"
        if progress is not None:
            progress(work.count, work.mesh.score)
        reason = stop() or reason
    operations, halfedges = work.done()
    return LargeRun(
        work.result(),
        operations,
        halfedges,
        work.mesh.score,
        mesh.optimum,
        mesh.score,
        mesh.irregular_count,
        mesh.n_elements,
        descent,
        work.decisions,
        work.patches,
        time.perf_counter() - began,
        reason,
    )


@dataclass
class _Patch:
    """One patch of a round."""

    elements: np.ndarray
    """(N,) ids in the large mesh."""
    vertices: np.ndarray
    """(M,) ids in the large mesh."""
    irregular: np.ndarray
    """Those of the vertices that were irregular."""
    mesh: HalfEdgeMesh

    @property
    def at_optimum(self) -> bool:
        """Whether nothing can be gained, since all Delta have the same sign (section 4.1)."""
        return self.mesh.score == self.mesh.optimum


@dataclass
class _Played:
    """The operations (T, B) and half-edges (T, B) of a round of B patches.

    counts (B,): how many of them lead each patch to its best state.
    """

    operations: list[np.ndarray] = field(default_factory=list)
    halfedges: list[np.ndarray] = field(default_factory=list)
    counts: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64))


class _Work:
    """The state of an improvement: a copy of the mesh, the agenda and the operations so far."""

    def __init__(self, mesh: HalfEdgeMesh, policy: Policy, seed: int, floor: float = 0.0) -> None:
        self.policy, self.task = policy, policy.task
        self._floor = max(floor, policy.task.element_floor)
        self.rng = np.random.default_rng(seed)
        self.generator = torch.Generator().manual_seed(seed)
        self.mesh = mesh.copy()
        self.mesh.arrays.counters[JOURNALLING] = 0
        self.cap = min(self.task.cap, mesh.degree_cap or self.task.cap)
        self.bounds = self.task.bounds(mesh.n_elements)
        self.agenda: Agenda = agenda(0, 0)
        self.decisions = self.patches = self.count = 0
        self._operations: list[np.ndarray] = []
        self._halfedges: list[np.ndarray] = []
        self._found = np.zeros(_FOUND, np.int64)
        self._ids = np.zeros(_FOUND * mesh.k, np.int64)
        self._slots = np.zeros((2, MOST_TAKEN), np.int64)
        self._journal = np.zeros((_ENTRIES * self._longest(), 2), np.int64)
        self._steps = np.zeros((self._longest() + 1, STEP_COLUMNS), np.int64)
        self._make_room()
        arrays = self.mesh.arrays
        enlist(self.agenda, self.rng.permutation(arrays.irregular[: self.mesh.irregular_count]))

    def _longest(self) -> int:
        """Largest number of steps on a patch."""
        return self.task.step_limit(_FOUND)

    @property
    def _local(self) -> tuple[int, int]:
        """Code of the first operation, and the number of local operations."""
        return self.task.first_operation, 3 if self.mesh.k == 3 else 4

    def _patch_task(self) -> Task:
        """The policy's task with the settings for patches."""
        candidates = min(CANDIDATES, self.task.candidates)
        return replace(
            self.task, candidates=candidates, element_floor=self._floor, element_ceiling=CEILING
        )

    def _make_room(self) -> None:
        """Reserve slots for a round of operations, and enlarge the agenda to the same size."""
        mesh = self.mesh
        slots = max(mesh.slots, int(mesh.arrays.counters[ELEMENT_SLOTS]))
        if min(len(mesh.arrays.vertex), len(mesh.arrays.element_mark)) < slots + _SPARE // 2:
            mesh.reserve(_SPARE + slots // 8, _SPARE + slots // 8)
        sizes = len(mesh.arrays.vertex), len(mesh.arrays.element_mark)
        if sizes != (len(self.agenda.queue), len(self.agenda.place)):
            self.agenda = enlarged(self.agenda, *sizes)

    def confine(self, elements: np.ndarray) -> None:
        """Restrict patches to `elements` (N,) by giving the other vertices to a patch -1.

        The descent does not respect patches and must not be used after this.
        """
        mesh = self.mesh
        outside = np.setdiff1d(mesh.vertices(), mesh.corners(elements))
        self.agenda.owner[outside] = -1

    def _note(self, operations: np.ndarray, halfedges: np.ndarray) -> None:
        self._operations.append(operations)
        self._halfedges.append(halfedges)
        self.count += len(operations)

    def done(self) -> tuple[np.ndarray, np.ndarray]:
        """All operations and half-edges so far."""
        empty = [np.zeros(0, np.int64)]
        return np.concatenate(self._operations or empty), np.concatenate(self._halfedges or empty)

    def result(self) -> HalfEdgeMesh:
        """The mesh in its current state, with its journal switched on again."""
        self.mesh.arrays.counters[JOURNALLING] = 1
        return self.mesh

    def descend(self, stop: Callable[[], str]) -> str:
        """Greedy descent; returns why it was stopped, empty if it was completed."""
        rules = Rules(*self._local, self.cap, *self.bounds, self.task.extended)
        buffers = np.zeros((2, _LOOKS), np.int64)
        reason = stop()
        while not reason and self.agenda.state[FILL] > 0:
            self._make_room()
            count = descend(self.mesh.arrays, self.agenda, rules, _LOOKS, buffers[0], buffers[1])
            self._note(buffers[0, :count].copy(), buffers[1, :count].copy())
            reason = stop()
        left = self.mesh.arrays.irregular[: self.mesh.irregular_count]
        if not reason:
            enlist(self.agenda, self.rng.permutation(left))
        return reason

    def play_round(self, stop: Callable[[], str]) -> bool:
        """Play one episode on up to PATCHES patches in parallel; False if there are none left."""
        self._make_room()
        patches, skipped = self._pick()
        if patches:
            self._put_back(patches, self._play([patch.mesh for patch in patches], stop))
        return bool(patches) or skipped > 0

    def _pick(self) -> tuple[list[_Patch], int]:
        """Patches for one round, and how many were skipped because they are at the optimum."""
        patches: list[_Patch] = []
        skipped = 0
        tries = int(self.agenda.state[FILL])
        while len(patches) < PATCHES:
            count, tries, _ = next_patch(
                self.mesh.arrays, self.agenda, SMALLEST, LARGEST, VISITS, len(patches) + 1, tries,
                self._found,
            )  # fmt: skip
            if count == 0:
                break
            patch = self._cut_out(self._found[:count].copy())
            if patch.at_optimum:
                skipped += 1
                self._settle(patch, patch.elements, False)
            else:
                patches.append(patch)
        return patches, skipped

    def _cut_out(self, elements: np.ndarray) -> _Patch:
        k = self.mesh.k
        out = allocate(k, len(elements) * k, len(elements), 1, 1)
        count = cut_out(self.mesh.arrays, self.agenda, k, elements, k == 4, out, self._ids)
        vertices = self._ids[:count].copy()
        irregular = vertices[out.irregular[: out.counters[IRREGULAR]]]
        return _Patch(elements, vertices, irregular, HalfEdgeMesh(out, MeshBoundary()))

    def _settle(self, patch: _Patch, elements: np.ndarray, better: bool) -> None:
        arrays, k = self.mesh.arrays, self.mesh.k
        settle(arrays, self.agenda, k, patch.vertices, elements, better, patch.irregular)

    def _play(self, meshes: list[HalfEdgeMesh], stop: Callable[[], str]) -> tuple[Batch, _Played]:
        """Play an episode on each patch, which ends early after PATIENCE steps without progress."""
        task = self._patch_task()
        batch = Batch(task, meshes, len(meshes), self.rng, endless=False)
        played = _Played()
        while batch.active.any() and not stop():
            seen = batch.observe()
            if task.kind == "quad":
                seen.mask[:, :, -1] = False  # a global split would continue beyond the rim
            else:
                mask_rim(batch.meshes, seen.chosen, seen.mask)
            actions = decide(self.policy.network, seen, self.generator)[0]
            self.decisions += int((actions >= 0).sum())
            rows = np.maximum(actions // task.operations, 0)
            played.operations.append(task.first_operation + actions % task.operations)
            played.halfedges.append(seen.chosen[np.arange(len(rows)), rows])
            batch.step(seen, actions)
            batch.active &= batch.steps - batch.best_step < PATIENCE
        played.counts = batch.best_step.astype(np.int64)
        self.patches += len(meshes)
        return batch, played

    def _put_back(self, patches: list[_Patch], played: tuple[Batch, _Played]) -> None:
        """Apply the operations up to the best state of each patch to the large mesh."""
        batch, record = played
        elements = np.full((len(patches), batch.pool.element_mark.shape[1]), -1, np.int64)
        for row, patch in zip(elements, patches, strict=True):
            row[: len(patch.elements)] = patch.elements
        total = int(record.counts.sum())
        if total:
            done = np.zeros((2, total), np.int64)
            arrays = self.mesh.arrays._replace(journal=self._journal, steps=self._steps)
            count = put_back(
                arrays, batch.pool, self.mesh.degree_cap, elements,
                Edits(np.array(record.operations), np.array(record.halfedges)), record.counts,
                self._slots, Edits(done[0], done[1]),
            )  # fmt: skip
            self._note(done[0, :count], done[1, :count])
        for row, patch, kept in zip(elements, patches, record.counts, strict=True):
            self._settle(patch, row, bool(kept))
