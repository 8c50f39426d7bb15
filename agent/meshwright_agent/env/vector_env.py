"""A vector environment: B episodes in parallel, in compiled code (self-play, section 4.2.2).

The meshes of the episodes lie in arrays with a leading axis of length B. Start meshes come from a
pool that is generated once; where an episode ends, the next one starts from a mesh of the pool.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright_agent.env.candidates import masks, permitted
from meshwright_agent.env.local_patch import LARGEST, Patches
from meshwright_agent.env.task import (
    Observation,
    Scratch,
    Task,
    choose_candidates,
    look,
    transition,
)
from meshwright_core.core.arrays import (
    DELTA_SUM,
    ELEMENT_SLOTS,
    ELEMENTS,
    JOURNALLING,
    ORIGIN,
    SCORE,
    SIDES,
    VERTEX_SLOTS,
    MeshArrays,
    allocate,
    enlarge,
)
from meshwright_core.core.compilation import kernel
from meshwright_core.core.score import normalised_return
from meshwright_core.domains.meshing import benchmark_mesh
from meshwright_core.domains.random_parts import part_mesh
from meshwright_core.mesh import HalfEdgeMesh

_ROOM = 2.5  # slots relative to the largest start mesh; operations that need more are masked
PART_CORNERS = (8, 30)
"""Least and largest number of corners of the random parts among start meshes."""
_TRIES = 64  # random half-edges that a random step draws before it does nothing


def start_meshes(
    kind: str,
    sides: tuple[int, int],
    count: int,
    rng: np.random.Generator,
    parts: float = 0.0,
) -> list[HalfEdgeMesh]:
    """`count` random start meshes (section 4.2.2).

    Meshes of random polygons whose number of sides is drawn from the closed range `sides`; with
    probability `parts` a random engineering part instead, half of these with holes.
    """
    meshes = []
    for i in range(count):
        corners = int(rng.integers(sides[0], sides[1] + 1))
        if parts and rng.random() < parts:
            corners = min(max(corners, PART_CORNERS[0]), PART_CORNERS[1])
            meshes.append(part_mesh(kind, corners, rng, holes=i % 2 == 0))
        else:
            meshes.append(benchmark_mesh(kind, corners, rng))
    return meshes


def stack(meshes: list[HalfEdgeMesh], task: Task) -> MeshArrays:
    """Meshes as arrays with a leading axis, with spare slots and without a journal."""
    vertices = int(_ROOM * max(mesh.slots for mesh in meshes)) + 16
    elements = int(_ROOM * max(mesh.n_elements for mesh in meshes)) + 16
    fields: list[list[np.ndarray]] = [[] for _ in MeshArrays._fields]
    for mesh in meshes:
        room = enlarge(_trimmed(mesh.arrays), vertices, elements, 1, 1)
        room.counters[JOURNALLING] = 0
        for field, array in zip(fields, room, strict=True):
            field.append(array)
    return MeshArrays(*(np.stack(field) for field in fields))


def _trimmed(arrays: MeshArrays) -> MeshArrays:
    """The same mesh in arrays without spare slots and without history."""
    slots, elements = int(arrays.counters[VERTEX_SLOTS]), int(arrays.counters[ELEMENT_SLOTS])
    k = int(arrays.counters[SIDES])
    empty = allocate(k, slots, elements, 1, 1)
    for name in ("edge", "vertex", "points", "irregular", "element_mark"):
        getattr(empty, name)[:] = getattr(arrays, name)[: len(getattr(empty, name))]
    empty.counters[:11] = arrays.counters[:11]
    return empty


@kernel
def member(meshes, b):
    """Mesh b of stacked arrays, as views; returning views needs reference counting."""
    return MeshArrays(
        meshes.edge[b],
        meshes.vertex[b],
        meshes.points[b],
        meshes.irregular[b],
        meshes.element_mark[b],
        meshes.trace[b],
        meshes.counters[b],
        meshes.journal[b],
        meshes.steps[b],
    )


@kernel
def _reset(meshes, pool, b, p):
    """Start run b afresh from mesh p of the pool."""
    # loops, because numba takes a second to compile an assignment of a whole array
    for h in range(pool.edge.shape[1]):
        for column in range(pool.edge.shape[2]):
            meshes.edge[b, h, column] = pool.edge[p, h, column]
    for v in range(pool.vertex.shape[1]):
        for column in range(pool.vertex.shape[2]):
            meshes.vertex[b, v, column] = pool.vertex[p, v, column]
        for axis in range(pool.points.shape[2]):
            meshes.points[b, v, axis] = pool.points[p, v, axis]
        meshes.irregular[b, v] = pool.irregular[p, v]
    for e in range(pool.element_mark.shape[1]):
        meshes.element_mark[b, e] = pool.element_mark[p, e]
    for i in range(pool.counters.shape[1]):
        meshes.counters[b, i] = pool.counters[p, i]


@kernel
def _observe_all(
    meshes, active, k, first, count, cap, floors, ceilings, extended, listed_up, noise, source,
    turn, rng, found, keys, slots, listed, reads, slot_of, field, chosen, mask, changes, sizes,
    features, all_reads,
):  # fmt: skip
    """Candidates, masks and patches of every active episode.

    Returns the numbers of rows of features and of reads.
    """
    rows = read_rows = 0
    for b in range(len(chosen)):
        sizes[b] = 0
        mask[b] = False
        chosen[b] = -1
        if not active[b]:
            continue
        m = member(meshes, b)
        choose_candidates(
            m, k, first, count, cap, floors[b], ceilings[b], extended, listed_up, noise, source,
            turn, rng, found, keys, slots, chosen[b],
        )  # fmt: skip
        if not masks(
            m, chosen[b], first, count, cap, floors[b], ceilings[b], extended, mask[b], changes[b]
        ):
            chosen[b] = -1
            continue
        look(m, chosen[b], k, sizes[b], listed, reads, slot_of, field, features[rows:])
        for i in range(sizes[b, 1]):
            for j in range(reads.shape[1]):
                all_reads[read_rows + i, j] = reads[i, j]
        rows += sizes[b, 0]
        read_rows += sizes[b, 1]
    return rows, read_rows


@kernel
def _act_all(meshes, first, actions, count, cap, chosen, touched, cleaned):
    """Apply action = candidate * count + operation to every episode; -1 does nothing."""
    for b in range(len(actions)):
        if actions[b] < 0:
            continue
        h = chosen[b, actions[b] // count]
        transition(member(meshes, b), first + actions[b] % count, h, cap, touched, cleaned)


@kernel
def _random_steps(
    meshes, pool, source, steps, limits, floors, ceilings, optima, first, count, cap, extended,
    touched, cleaned, useful, rounds, rng,
):  # fmt: skip
    """Apply `rounds` random permitted operations in each episode; returns how many were done."""
    done = 0
    k = meshes.counters[0, SIDES]
    for _ in range(rounds):
        for b in range(len(source)):
            m = member(meshes, b)
            slots = m.counters[ELEMENT_SLOTS] * k
            for _ in range(_TRIES):
                h = int(rng.random() * slots)
                operation = first + int(rng.random() * count)
                if m.edge[h, ORIGIN] >= 0 and permitted(
                    m, operation, h, cap, floors[b], ceilings[b], extended
                ):
                    transition(m, operation, h, cap, touched, cleaned)
                    done += 1
                    break
            steps[b] += 1
            if steps[b] >= limits[source[b]] or m.counters[SCORE] <= optima[source[b]]:
                source[b] = useful[int(rng.random() * len(useful))]
                steps[b] = 0
                _reset(meshes, pool, b, source[b])
    return done


@dataclass
class Outcome:
    """The result of one step of all episodes."""

    rewards: np.ndarray
    """(B,) s before less s after (equation 4)."""
    growth: np.ndarray
    """(B,) change of the number of elements."""
    ended: np.ndarray
    """(B,) bool: the optimum is reached, the steps are used up, or no operation was permitted. All
    three are terminations: the share of steps left is part of the state."""
    returns: np.ndarray
    """(B,) undiscounted normalised return of the best state, of the episodes that ended; NaN
    elsewhere."""


class Batch:
    """B episodes in parallel, each on a mesh of its own."""

    def __init__(
        self,
        task: Task,
        meshes: list[HalfEdgeMesh],
        size: int,
        rng: np.random.Generator,
        *,
        endless: bool = True,
        bounds: tuple[int, int] | None = None,
    ) -> None:
        """Start `size` episodes from `meshes`.

        endless: an episode that ends is followed by another from a mesh drawn at random. Otherwise
        episode b starts from mesh b and does not change any more once it has ended. bounds: least
        and largest number of elements in every episode; by default those of the task. Raises
        ValueError if all meshes are at their optimum.
        """
        self.task, self.rng, self.endless = task, rng, endless
        self.pool = stack(meshes, task)
        self.start_scores = self.pool.counters[:, SCORE].astype(int)
        self.optima = np.abs(self.pool.counters[:, DELTA_SUM]).astype(int)
        self.start_elements = self.pool.counters[:, ELEMENTS].astype(int)
        # an episode that starts at the optimum has no steps
        self.useful = np.flatnonzero(self.start_scores > self.optima)
        if not len(self.useful):
            raise ValueError("every start mesh is at its optimum already: nothing can be improved")
        self.source = np.zeros(size, int)
        self.steps = np.zeros(size, int)
        self.best = np.zeros(size, int)
        self.best_step = np.zeros(size, int)
        self.active = np.ones(size, np.bool_)
        self.scratch = Scratch(task, self.pool.edge.shape[1], self.pool.vertex.shape[1])
        self.meshes = MeshArrays(*(array[np.zeros(size, int)].copy() for array in self.pool))
        rows = min(LARGEST, self.pool.edge.shape[1])
        self._features = np.zeros((size * rows, task.channels), np.int8)
        self._reads = np.zeros((size * rows, task.k + 1), np.int16)
        limits = [task.step_limit(int(n)) for n in self.start_elements]
        own = [task.bounds(int(n)) if bounds is None else bounds for n in self.start_elements]
        self._limits, self._bounds = np.array(limits), np.array(own)
        for b in range(size):
            self._begin(b, int(rng.choice(self.useful)) if endless else b % len(meshes))

    def _begin(self, b: int, p: int) -> None:
        _reset(self.meshes, self.pool, b, p)
        self.source[b], self.steps[b], self.best_step[b] = p, 0, 0
        self.best[b] = self.start_scores[p]
        self.active[b] = self.best[b] > self.optima[p]

    @property
    def scores(self) -> np.ndarray:
        """(B,) current s of each episode."""
        return self.meshes.counters[:, SCORE].astype(int)

    @property
    def gaps(self) -> np.ndarray:
        """(B,) current s - s* of each episode."""
        return self.scores - self.optima[self.source]

    def observe(self) -> Observation:
        """Observe all episodes; for one that has ended the mask is all False."""
        task, scratch = self.task, self.scratch
        size = len(self.active)
        chosen = np.empty((size, task.rows), np.int64)
        mask = np.empty((size, task.rows, task.operations), np.bool_)
        changes = np.zeros((size, task.rows, task.operations), np.int8)
        sizes = np.empty((size, task.blocks + 1), np.int32)
        bounds = self._bounds[self.source]
        source, turn = task.template
        rows, read_rows = _observe_all(
            self.meshes, self.active, task.k, task.first_operation, task.operations, task.cap,
            np.ascontiguousarray(bounds[:, 0]), np.ascontiguousarray(bounds[:, 1]), task.extended,
            task.selection == "shortlist", task.noise, source, turn, self.rng, scratch.found,
            scratch.keys, scratch.slots, scratch.listed, scratch.reads, scratch.slot_of,
            scratch.field, chosen, mask, changes, sizes, self._features, self._reads,
        )  # fmt: skip
        left = 1.0 - self.steps / self._limits[self.source]
        growth = self.meshes.counters[:, ELEMENTS] / self.start_elements[self.source]
        state = np.column_stack([self.gaps / 10.0, left, growth]).astype(np.float32)
        patches = Patches(self._features[:rows].copy(), self._reads[:read_rows].copy(), sizes)
        return Observation(chosen, mask, changes, state, patches)

    def play_at_random(self, rounds: int) -> int:
        """Apply `rounds` random permitted operations in every episode; returns how many were done.

        For measuring speed: best states are not recorded.
        """
        task, scratch = self.task, self.scratch
        bounds = self._bounds[self.source]
        done = _random_steps(
            self.meshes, self.pool, self.source, self.steps, self._limits,
            np.ascontiguousarray(bounds[:, 0]), np.ascontiguousarray(bounds[:, 1]), self.optima,
            task.first_operation, task.operations, task.cap, task.extended, scratch.touched,
            scratch.cleaned, self.useful, rounds, self.rng,
        )  # fmt: skip
        return int(done)

    def step(self, observation: Observation, actions: np.ndarray) -> Outcome:
        """Apply one action (B,) int64 in every episode, -1 where no operation is permitted."""
        before, elements = self.scores, self.meshes.counters[:, ELEMENTS].copy()
        scratch, task = self.scratch, self.task
        _act_all(
            self.meshes, task.first_operation, actions, task.operations, task.cap,
            observation.chosen, scratch.touched, scratch.cleaned,
        )  # fmt: skip
        after, growth = self.scores, self.meshes.counters[:, ELEMENTS] - elements
        acted = actions >= 0
        self.steps += acted
        better = after < self.best
        self.best[better] = after[better]
        self.best_step[better] = self.steps[better]
        optima, starts = self.optima[self.source], self.start_scores[self.source]
        ended = self.active & (
            ~acted | (after <= optima) | (self.steps >= self._limits[self.source])
        )
        returns = np.full(len(actions), np.nan)
        returns[ended] = normalised_return(starts, self.best, optima)[ended]
        if self.endless:
            for b in np.flatnonzero(ended):
                self._begin(int(b), int(self.rng.choice(self.useful)))
        else:
            self.active &= ~ended
        return Outcome((before - after).astype(np.float32), growth, ended, returns)
