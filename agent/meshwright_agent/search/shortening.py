"""Shortening a list of operations without losing its result: loop removal, then delta debugging.

Leaving out an operation changes the ids of elements that later ones create, since slots are reused.
Every vertex is therefore given a unique name when it is created, and an operation is stored by the
names of the ends of its half-edge. In a replay it is applied to the half-edge between the vertices
with these names, and skipped if there is none. Clean-ups are entries like any other.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from meshwright_agent.env.task import Task
from meshwright_agent.search.annealing import Operations, copy_mesh, with_room
from meshwright_core.core.arrays import (
    DEGREE,
    ELEMENT_SLOTS,
    ELEMENTS,
    FLAGS,
    GEOMETRIC,
    HALF,
    NEW_COUNT,
    ORIGIN,
    SCORE,
    SIDES,
    TRACE_IDS,
    VERTEX_SLOTS,
    MeshArrays,
    copied,
    find,
    following,
    neighbour,
    turned,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.references import by_reference
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import CODES, NAMES, check, rewrite
from meshwright_core.operations.refusals import ALLOWED

SLICE = 20_000
"""Operations replayed between two checks of the time."""

COLOURINGS = 6
"""How far vertices see each other in :func:`layout_hash`, in edges."""

_NOWHERE = -1


@by_reference
class Names(NamedTuple):
    """The current names of the vertices."""

    vertex_of: np.ndarray
    """(names,) int32 vertex ids, -1 for none."""
    name_of: np.ndarray
    """(vertex slots,) int32 names, -1 for none."""


@by_reference
class ReplayLimits(NamedTuple):
    """What a replay must reach, and what it must keep to."""

    cap: int
    """Highest degree that an operation may produce, 0 for any."""
    floor: int
    """Least number of elements at each step."""
    score: int
    """Largest s at the end."""
    most: int
    """Largest number of elements at the end."""
    layout: int
    """:func:`layout_hash` at the end; 0 for any."""
    hashes: np.ndarray
    """(2, vertex slots) uint64: scratch for it."""


@by_reference
class Replayed(NamedTuple):
    """What a replay did with each of N entries."""

    kept: np.ndarray
    """(N,) bool: whether it was applied."""
    halfedges: np.ndarray
    """(N,) int64: to which half-edge."""


@by_reference
class Deletion(NamedTuple):
    """The entries from which chunks are deleted, with scratch for that."""

    entries: np.ndarray
    """(N, 5) int32, changed in place."""
    spare: np.ndarray
    """(N, 5) int32: scratch."""
    progress: np.ndarray
    """(2,) int64: the entry that comes next, and the number of entries."""


def nothing_replayed(count: int) -> Replayed:
    """The arrays for a replay of so many entries."""
    return Replayed(np.zeros(count, np.bool_), np.zeros(count, np.int64))


def first_names(slots: int, capacity: int, count: int) -> Names:
    """The names at the start, where each vertex is named by its id."""
    vertex_of, name_of = np.full(count, _NOWHERE, np.int32), np.full(capacity, _NOWHERE, np.int32)
    vertex_of[:slots] = name_of[:slots] = np.arange(slots)
    return Names(vertex_of, name_of)


@bare_kernel
def _name_created(m, names, first, count):
    """Name the vertices that the last operation created, at most `count`."""
    vertex_of, name_of = names.vertex_of, names.name_of
    made = m.trace[NEW_COUNT]
    for i in range(made):
        v = m.trace[TRACE_IDS + i]
        if name_of[v] >= 0 and vertex_of[name_of[v]] == v:
            vertex_of[name_of[v]] = -1
        if i < count:
            name_of[v] = first + i
            vertex_of[first + i] = v
        else:
            name_of[v] = -1
    for i in range(made, count):
        vertex_of[first + i] = -1


@kernel
def name_all(m, codes, halfedges, slots, cap, entries, states):
    """Replay operations (N,) and fill `entries` (N, 5): operation, names of the ends of its
    half-edge, first name and number of the vertices that it makes.

    states (N+1, 3) receives a hash of the connectivity, s and the number of elements before each
    and at the end. Returns the number of names, or -1 - i if operation i is not allowed. Vertices
    made before `slots` have their ids.
    """
    k = m.counters[SIDES]
    name_of = np.full(len(m.vertex), -1, np.int32)
    for v in range(slots):
        name_of[v] = v
    names = slots
    for i in range(len(codes) + 1):
        states[i, 0] = connectivity_hash(m, k, name_of)
        states[i, 1] = m.counters[SCORE]
        states[i, 2] = m.counters[ELEMENTS]
        if i == len(codes):
            break
        h = halfedges[i]
        if check(m, codes[i], h, cap) != ALLOWED:
            return -1 - i
        entries[i, 0] = codes[i]
        entries[i, 1] = name_of[m.edge[h, ORIGIN]]
        entries[i, 2] = name_of[m.edge[following(h, k), ORIGIN]]
        rewrite(m, codes[i], h)
        made = m.trace[NEW_COUNT]
        entries[i, 3], entries[i, 4] = names, made
        for j in range(made):
            name_of[m.trace[TRACE_IDS + j]] = names + j
        names += made
    return names


@bare_kernel
def connectivity_hash(m, k, name_of):
    """A hash of the set of edges by the names of their ends; equal for equal connectivity."""
    total = np.uint64(0)
    for h in range(k * m.counters[ELEMENT_SLOTS]):
        if m.edge[h, ORIGIN] >= 0:
            x = np.uint64(name_of[m.edge[h, ORIGIN]] + 1) * np.uint64(0x9E3779B97F4A7C15)
            y = np.uint64(name_of[m.edge[following(h, k), ORIGIN]] + 1)
            x = (x ^ (x >> np.uint64(29))) + y * np.uint64(0xBF58476D1CE4E5B9)
            x = (x ^ (x >> np.uint64(32))) * np.uint64(0x94D049BB133111EB)
            total += x ^ (x >> np.uint64(31))
    return np.int64(total)


@bare_kernel
def named_halfedge(m, k, entry, names):
    """The half-edge between the vertices named by an entry; -1 if there is none."""
    vertex_of, name_of = names.vertex_of, names.name_of
    a, b = vertex_of[entry[1]], vertex_of[entry[2]]
    if a < 0 or b < 0 or name_of[a] != entry[1] or name_of[b] != entry[2]:
        return -1
    if m.vertex[a, HALF] < 0 or m.vertex[b, HALF] < 0:
        return -1
    return find(m, a, b, k)


@bare_kernel
def _mixed(x):
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


@bare_kernel
def layout_hash(m, hashes):
    """A hash of the connectivity seen from the geometric vertices, whatever the ids of the others:
    equal for equal layouts, and hardly ever for others. Not 0. hashes (2, slots): scratch.

    Colours spread from neighbour to neighbour (Weisfeiler and Leman), so that each vertex comes to
    know the layout around it.
    """
    k = m.counters[SIDES]
    slots = m.counters[VERTEX_SLOTS]
    for v in range(slots):
        known = v + 2 if m.vertex[v, FLAGS] & GEOMETRIC else 1
        hashes[0, v] = _mixed(np.uint64(known))
    total = np.uint64(0)
    for spread in range(COLOURINGS):
        now, then = spread % 2, 1 - spread % 2
        total = np.uint64(0)
        for v in range(slots):
            if m.vertex[v, HALF] < 0:
                continue
            around = np.uint64(m.vertex[v, DEGREE])
            h = m.vertex[v, HALF]
            for _ in range(m.vertex[v, DEGREE]):
                around += _mixed(hashes[now, neighbour(m, h, k)])
                if h < 0:
                    break
                h = turned(m, h, k)
            hashes[then, v] = _mixed(hashes[now, v] * np.uint64(3) + around)
            total += hashes[then, v]
    return np.int64(total | np.uint64(1))


@bare_kernel
def _is_at(m, goal):
    if m.counters[SCORE] > goal.score or m.counters[ELEMENTS] > goal.most:
        return False
    return goal.layout == 0 or layout_hash(m, goal.hashes) == goal.layout


@bare_kernel
def replay(m, names, entries, start, stop, goal, done):
    """Replay entries start ... stop-1 as far as they are allowed, and until the goal is reached.

    done: receives what was applied. Returns how many entries were gone through, or -1 if the goal
    was not reached.
    """
    k = m.counters[SIDES]
    for i in range(start, stop):
        if _is_at(m, goal):
            return i
        done.kept[i] = False
        h = named_halfedge(m, k, entries[i], names)
        if h < 0 or check(m, entries[i, 0], h, goal.cap) != ALLOWED:
            continue
        done.kept[i] = True
        done.halfedges[i] = h
        rewrite(m, entries[i, 0], h)
        _name_created(m, names, entries[i, 3], entries[i, 4])
        if m.counters[ELEMENTS] < goal.floor:
            return -1
    return stop if _is_at(m, goal) else -1


@bare_kernel
def _copy(source, target):
    for i in range(len(source)):
        target[i] = source[i]


@kernel
def debug_pass(prefix, names, work, work_names, deletion, goal, done, chunk):
    """Try to delete chunk after chunk, until the end or until SLICE operations have been replayed.

    prefix: the mesh before the next entry, with its names; work, work_names, done: scratch. Returns
    True at the end.
    """
    entries, spare, progress = deletion.entries, deletion.spare, deletion.progress
    spent = 0
    while progress[0] < progress[1]:
        if spent > SLICE:
            return False
        at, total = progress[0], progress[1]
        copy_mesh(prefix, work)
        _copy(names.vertex_of, work_names.vertex_of)
        _copy(names.name_of, work_names.name_of)
        stop = replay(work, work_names, entries, min(at + chunk, total), total, goal, done)
        spent += total - at + 8
        if stop >= 0:
            left = at
            for i in range(min(at + chunk, total), stop):
                if done.kept[i]:
                    for column in range(5):
                        spare[left, column] = entries[i, column]
                    left += 1
            for i in range(at, left):
                for column in range(5):
                    entries[i, column] = spare[i, column]
            progress[1] = left
            continue
        end = min(at + chunk, total)
        # goal and bounds apply to the whole list, so they are switched off for this part
        free = ReplayLimits(goal.cap, 0, -1, 0, 0, goal.hashes)
        replay(prefix, names, entries, at, end, free, done)
        progress[0] = end
    return True


def without_loops(states: np.ndarray) -> np.ndarray:
    """Indices of the operations that remain when all loops through a former state are removed.

    states: (N+1,) connectivity hashes before each operation and at the end.
    """
    last = {state: i for i, state in enumerate(states.tolist())}
    kept = []
    at, end = 0, len(states) - 1
    hashes = states.tolist()
    while at < end:
        onward = last[hashes[at]]
        if onward > at:
            at = onward
            continue
        kept.append(at)
        at += 1
    return np.array(kept, np.int64)


def shorten(
    mesh: HalfEdgeMesh,
    operations: Operations,
    *,
    seconds: float | None = 0.3,
    slices: int | None = None,
    keep_layout: bool = False,
    cancelled: Callable[[], bool] | None = None,
) -> Operations:
    """The same result with fewer operations, where that is possible within `seconds`.

    slices: stop after so many slices of :data:`SLICE` operations replayed, which does not depend on
    how fast the machine is. keep_layout: the connectivity at the end stays as it is, but for ids.

    The returned list is never longer. Applied to `mesh`, which is not changed, it ends with s no
    higher and no more elements than `operations`, and at no step has fewer elements than the fewest
    of theirs. Raises ValueError if `operations` cannot be applied to `mesh`.
    """
    deadline = np.inf if seconds is None else time.perf_counter() + seconds
    asked = 0

    def time_is_up() -> bool:
        nonlocal asked
        asked += 1
        if slices is not None and asked > slices:
            return True
        return time.perf_counter() > deadline or (cancelled is not None and cancelled())

    if not operations:
        return []
    shortener = _Shortener(mesh, operations, keep_layout)
    shortener.cut_loops()
    shortener.debug(time_is_up)
    return shortener.result(operations)


class _Shortener:
    """A list of operations that is shortened in place, with the work arrays for that."""

    def __init__(self, mesh: HalfEdgeMesh, operations: Operations, keep_layout: bool) -> None:
        codes = CODES[mesh.k]
        self.codes = np.array([codes[operation] for operation, _ in operations], np.int32)
        self.halfedges = np.array([h for _, h in operations], np.int64)
        count, slots = len(operations), mesh.slots
        self.mesh, self.cap = mesh, Task(mesh.kind).cap
        self.start = with_room(mesh, 3 * mesh.n_elements)
        while True:
            self.entries = np.zeros((count, 5), np.int32)
            self.states = np.zeros((count + 1, 3), np.int64)
            work = self._copied()
            names = name_all(
                work, self.codes, self.halfedges, slots, self.cap, self.entries, self.states
            )
            if names >= 0:
                break
            self._relax_bounds(-1 - int(names), operations)
        self.names = int(names)
        hashes = np.zeros((2, len(work.vertex)), np.uint64)
        layout = int(layout_hash(work, hashes)) if keep_layout else 0
        self.goal = ReplayLimits(
            self.cap, int(self.states[:, 2].min()), int(self.states[-1, 1]),
            int(self.states[-1, 2]), layout, hashes,
        )  # fmt: skip

    def _relax_bounds(self, failed: int, operations: Operations) -> None:
        """After a refused operation: drop the degree cap, then reserve more slots."""
        if self.cap:
            self.cap = 0
        elif len(self.start.element_mark) < 64 * (self.mesh.n_elements + 100):
            self.start = with_room(self.mesh, 4 * len(self.start.element_mark))
        else:
            operation, h = operations[failed]
            raise ValueError(f"operation {failed}, {operation} at half-edge {h}, does not replay")

    def _copied(self) -> MeshArrays:
        return copied(self.start)

    def _replayed(self, entries: np.ndarray) -> tuple[int, Replayed]:
        """Where a replay reaches the goal, -1 for nowhere, and what it applied until there."""
        names = first_names(self.mesh.slots, len(self.start.vertex), self.names)
        done = nothing_replayed(len(entries))
        stop = int(replay(self._copied(), names, entries, 0, len(entries), self.goal, done))
        done.kept[max(stop, 0) :] = False
        return stop, done

    def cut_loops(self) -> None:
        """End at the first state that reaches the goal, and remove loops."""
        good = (self.states[:, 1] <= self.goal.score) & (self.states[:, 2] <= self.goal.most)
        end = len(good) - 1 if self.goal.layout else int(np.argmax(good))
        shorter = self.entries[:end][without_loops(self.states[: end + 1, 0])]
        stop, done = self._replayed(shorter)
        self.entries = shorter[done.kept] if stop >= 0 else self.entries[:end]

    def debug(self, time_is_up: Callable[[], bool]) -> None:
        """Delta debugging: delete chunks of decreasing size until none can be deleted."""
        while not time_is_up():
            before = len(self.entries)
            chunk = max(1, before // 2)
            while chunk and not time_is_up():
                self._delete(chunk, time_is_up)
                chunk //= 2
            if len(self.entries) == before:
                return

    def _delete(self, chunk: int, time_is_up: Callable[[], bool]) -> None:
        prefix, work = self._copied(), self._copied()
        names = first_names(self.mesh.slots, len(self.start.vertex), self.names)
        scratch = Names(*(array.copy() for array in names))
        total = len(self.entries)
        entries = self.entries.copy()
        deletion = Deletion(entries, np.zeros_like(entries), np.array([0, total]))
        done = nothing_replayed(total)
        ended = False
        while not ended and not time_is_up():
            ended = debug_pass(prefix, names, work, scratch, deletion, self.goal, done, chunk)
        self.entries = entries[: deletion.progress[1]]

    def result(self, operations: Operations) -> Operations:
        """The shortened operations with their half-edges, checked on a copy of the mesh."""
        stop, (kept, halfedges) = self._replayed(self.entries)
        if stop < 0 or int(kept.sum()) >= len(operations):
            return operations
        found = [
            (NAMES[code], h)
            for code, h in zip(
                self.entries[kept, 0].tolist(), halfedges[kept].tolist(), strict=True
            )
        ]
        checked = self.mesh.copy()
        for operation, h in found:
            checked.apply(operation, h)
        if checked.score > self.goal.score or checked.n_elements > self.goal.most:
            return operations
        return found
