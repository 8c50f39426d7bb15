"""A vector environment: B episodes in parallel, in compiled code (self-play, section 4.2.2).

The meshes of the episodes lie in arrays with a leading axis of length B. Start meshes come from a
pool that is generated once; where an episode ends, the next one starts from a mesh of the pool.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from meshwright_agent.env.candidates import Rules, masks, permitted
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
    CURVE,
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
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.composite_curves import chained_curves
from meshwright_core.core.references import by_reference
from meshwright_core.core.score import normalised_return
from meshwright_core.domains.meshing import benchmark_mesh
from meshwright_core.domains.random_parts import part_mesh
from meshwright_core.mesh import HalfEdgeMesh

_ROOM = 2.5  # slots relative to the largest start mesh; operations that need more are masked
PART_CORNERS = (8, 30)
"""Least and largest number of corners of the random parts among start meshes."""
_OWN_FIELDS = MeshArrays._fields[:-2]
"""The arrays that each mesh has for itself; the last two hold the curves."""
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
    """Meshes as arrays with a leading axis, with spare slots and without a journal.

    Only the curves have no such axis: those of all meshes follow each other.
    """
    vertices = int(_ROOM * max(mesh.slots for mesh in meshes)) + 16
    elements = int(_ROOM * max(mesh.n_elements for mesh in meshes)) + 16
    fields: list[list[np.ndarray]] = [[] for _ in _OWN_FIELDS]
    curves = 0
    for mesh in meshes:
        room = enlarge(_trimmed(mesh.arrays), vertices, elements, 1, 1)
        room.counters[JOURNALLING] = 0
        room.vertex[room.vertex[:, CURVE] >= 0, CURVE] += curves
        curves += len(mesh.arrays.interface)
        for field, name in zip(fields, _OWN_FIELDS, strict=True):
            field.append(getattr(room, name))
    own = {name: np.stack(field) for name, field in zip(_OWN_FIELDS, fields, strict=True)}
    return MeshArrays(
        **own,
        curves=chained_curves([mesh.arrays.curves for mesh in meshes]),
        interface=np.concatenate([mesh.arrays.interface for mesh in meshes]),
    )


def _trimmed(arrays: MeshArrays) -> MeshArrays:
    """The same mesh in arrays without spare slots and without history."""
    slots, elements = int(arrays.counters[VERTEX_SLOTS]), int(arrays.counters[ELEMENT_SLOTS])
    k = int(arrays.counters[SIDES])
    empty = allocate(k, slots, elements, 1, 1)
    names = ("edge", "vertex", "points", "irregular", "element_mark", "parameter", "region")
    for name in names:
        getattr(empty, name)[:] = getattr(arrays, name)[: len(getattr(empty, name))]
    empty.counters[:11] = arrays.counters[:11]
    return empty


@by_reference
class Episodes(NamedTuple):
    """B episodes, and what is known of the P start meshes."""

    active: np.ndarray
    """(B,) bool: whether the episode goes on."""
    bounds: np.ndarray
    """(B, 2) int64: least and largest number of elements."""
    source: np.ndarray
    """(B,) int64: the start mesh."""
    steps: np.ndarray
    """(B,) int64: the steps so far."""
    limits: np.ndarray
    """(P,) int64: largest number of steps from each start mesh."""
    optima: np.ndarray
    """(P,) int64: s* of each start mesh."""
    useful: np.ndarray
    """(U,) int64: the start meshes that are not at their optimum."""


@by_reference
class ObservedArrays(NamedTuple):
    """The arrays of an :class:`Observation` while they are filled."""

    chosen: np.ndarray
    mask: np.ndarray
    changes: np.ndarray
    sizes: np.ndarray
    features: np.ndarray
    """(N, C) int8: the patches of all episodes, one after the other."""
    reads: np.ndarray
    """(N, k + 1) int16: likewise."""


@bare_kernel
def _within(rules, bounds):
    """The rules with bounds (2,) of the number of elements."""
    return Rules(rules.first, rules.operations, rules.cap, bounds[0], bounds[1], rules.extended)


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
        meshes.parameter[b],
        meshes.region[b],
        meshes.curves,
        meshes.interface,
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
        meshes.parameter[b, v] = pool.parameter[p, v]
    for e in range(pool.element_mark.shape[1]):
        meshes.element_mark[b, e] = pool.element_mark[p, e]
        meshes.region[b, e] = pool.region[p, e]
    for i in range(pool.counters.shape[1]):
        meshes.counters[b, i] = pool.counters[p, i]


@kernel
def _observe_all(meshes, episodes, rules, ranking, work, field, seen, rng):
    """Candidates, masks and patches of every active episode.

    Returns the numbers of rows of features and of reads.
    """
    chosen, mask, sizes, reads = seen.chosen, seen.mask, seen.sizes, work.reads
    rows = read_rows = 0
    for b in range(len(chosen)):
        sizes[b] = 0
        mask[b] = False
        chosen[b] = -1
        if not episodes.active[b]:
            continue
        m = member(meshes, b)
        own = _within(rules, episodes.bounds[b])
        choose_candidates(m, own, ranking, work, chosen[b], rng)
        if not masks(m, chosen[b], own, mask[b], seen.changes[b]):
            chosen[b] = -1
            continue
        look(m, chosen[b], sizes[b], work, field, seen.features[rows:])
        for i in range(sizes[b, 1]):
            for j in range(reads.shape[1]):
                seen.reads[read_rows + i, j] = reads[i, j]
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
def _random_steps(meshes, pool, episodes, rules, touched, cleaned, rounds, rng):
    """Apply `rounds` random permitted operations in each episode; returns how many were done."""
    done = 0
    k = meshes.counters[0, SIDES]
    source, steps, useful = episodes.source, episodes.steps, episodes.useful
    for _ in range(rounds):
        for b in range(len(source)):
            m = member(meshes, b)
            own = _within(rules, episodes.bounds[b])
            slots = m.counters[ELEMENT_SLOTS] * k
            for _ in range(_TRIES):
                h = int(rng.random() * slots)
                operation = rules.first + int(rng.random() * rules.operations)
                if m.edge[h, ORIGIN] >= 0 and permitted(m, operation, h, own):
                    transition(m, operation, h, rules.cap, touched, cleaned)
                    done += 1
                    break
            steps[b] += 1
            used_up = steps[b] >= episodes.limits[source[b]]
            if used_up or m.counters[SCORE] <= episodes.optima[source[b]]:
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
        self.optima = np.array([mesh.optimum for mesh in meshes])
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
        first = np.zeros(size, int)
        copies = {name: getattr(self.pool, name)[first].copy() for name in _OWN_FIELDS}
        self.meshes = self.pool._replace(**copies)
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

    def _episodes(self) -> Episodes:
        return Episodes(
            self.active, self._bounds[self.source], self.source, self.steps, self._limits,
            self.optima, self.useful,
        )  # fmt: skip

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
        seen = ObservedArrays(chosen, mask, changes, sizes, self._features, self._reads)
        rows, read_rows = _observe_all(
            self.meshes, self._episodes(), task.rules(0, 0), task.ranking, scratch.work,
            scratch.field, seen, self.rng,
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
        done = _random_steps(
            self.meshes, self.pool, self._episodes(), task.rules(0, 0), scratch.touched,
            scratch.cleaned, rounds, self.rng,
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
