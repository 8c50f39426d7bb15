"""The fewest operations that lead from a mesh to a goal, by looking at every way.

Depth by depth, all sequences of the paper's operations (and collapses of boundary edges) are tried,
whatever they do to the score on the way. A state that has been met with as many operations left is
not looked at again; states count as the same if the same named vertices are joined, a vertex being
named after the operation that made it. The last operation is judged by its exact change of s. So
the answer for a depth is a proof, but for a clash of 64-bit sums.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright_core.core.arrays import (
    ELEMENT_SLOTS,
    ELEMENTS,
    IRREGULAR,
    NEW_COUNT,
    ORIGIN,
    SCORE,
    SIDES,
    TRACE_IDS,
    TWIN,
    following,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.history.journal import undo
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import (
    CLEANUP,
    FLIP_LEFT,
    FLIP_RIGHT,
    NAMES,
    QUAD_COLLAPSE,
    TRI_COLLAPSE,
    TRI_FLIP,
    Operation,
    check,
    needs_twin,
    rewrite,
    score_change,
)
from meshwright_core.operations.refusals import ALLOWED

Found = list[tuple[Operation, int]]

KEPT = 64
"""Shortest sequences that are kept, to choose one that can be drawn."""
DEEPEST = 12
PER_OPERATION = 4
"""Irregular vertices that one operation mends at most: a flip changes four degrees, a collapse
makes three vertices of four, all others change fewer.
"""
_ROOM = 64
"""Times the room of the mesh: no sequence that is looked at makes more."""
_EXHAUSTED, _FULL, _SPENT, _CRAMPED = 0, 1, 2, 3


@dataclass(frozen=True)
class Answer:
    """What a search has shown."""

    sequences: tuple[tuple[tuple[Operation, int], ...], ...]
    """Some of the shortest sequences; none where none was found."""
    proved: int
    """No sequence of so many operations reaches the goal."""
    nodes: int
    """States that were looked at."""


def fewest(
    mesh: HalfEdgeMesh,
    goal: int,
    most: int = 0,
    deepest: int = DEEPEST,
    nodes: int = 20_000_000,
    slots: int = 1 << 24,
) -> Answer:
    """The shortest ways from ``mesh``, which is not changed, to s <= ``goal``.

    ``most``: elements that the mesh may have then, 0 for any number. The search ends, without an
    answer, beyond ``deepest`` operations or ``nodes`` states; ``slots`` of 9 bytes
    remember states.
    """
    if mesh.score <= goal and (not most or mesh.n_elements <= most):
        return Answer(((),), 0, 0)
    seen = 0
    for depth in range(1, deepest + 1):
        search = _Search(mesh, goal, most, depth, slots)
        ended = search.run(nodes - seen)
        seen += search.nodes
        if search.sequences or ended == _SPENT:
            return Answer(search.sequences, depth - 1, seen)
    return Answer((), deepest, seen)


class _Search:
    """All sequences of one length."""

    def __init__(self, mesh: HalfEdgeMesh, goal: int, most: int, depth: int, slots: int) -> None:
        self._mesh, self._goal, self._most, self._depth = mesh, goal, most, depth
        self._slots = slots if depth > 2 else 1 << 12
        self.nodes = 0
        self.sequences: tuple[tuple[tuple[Operation, int], ...], ...] = ()

    def run(self, nodes: int) -> int:
        """Look at up to so many states; how it ended."""
        work = self._mesh.copy()
        room = _ROOM * (work.n_elements + 16)
        work.room_for(room, room)
        work._arrays = work.arrays._replace(
            journal=np.zeros((1 << 18, 2), np.int64),
        )
        ways = np.zeros((KEPT, self._depth, 2), np.int64)
        told = np.zeros(2, np.int64)
        width = len(work.arrays.trace)
        ended = int(
            _explore(
                work.arrays, _first_names(len(work.arrays.vertex)), self._depth, self._goal,
                self._most, nodes, np.zeros((self._depth + 1, 2), np.int64),
                np.zeros((self._depth + 1, width), np.int64),
                np.zeros((self._depth + 1, width), np.uint64),
                np.zeros(self._slots, np.uint64), np.zeros(self._slots, np.int8), ways, told,
            )
        )  # fmt: skip
        if ended == _CRAMPED:
            raise RuntimeError("the search has outgrown its room")
        self.nodes = int(told[1])
        self.sequences = tuple(
            tuple((NAMES[int(code)], int(h)) for code, h in way) for way in ways[: told[0]]
        )
        return ended


def _first_names(count: int) -> np.ndarray:
    """(count,) uint64 numbers without order, one for each vertex slot."""
    return np.random.default_rng(7).integers(1, 1 << 63, count).astype(np.uint64)


@bare_kernel
def _mixed(x, y):
    """One 64-bit number of two, in this order."""
    z = (x ^ (x >> np.uint64(29))) * np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(32))) + y * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(31))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(30))


@bare_kernel
def _state(m, names, k):
    """A sum over all half-edges of their named ends: the same for the same connectivity."""
    total = np.uint64(0)
    for h in range(k * m.counters[ELEMENT_SLOTS]):
        if m.edge[h, ORIGIN] >= 0:
            total += _mixed(names[m.edge[h, ORIGIN]], names[m.edge[following(h, k), ORIGIN]])
    return total


@bare_kernel
def _christen(m, names, base, ids, former):
    """Name the vertices that the last operation has made; returns how many there are."""
    made = m.trace[NEW_COUNT]
    for i in range(made):
        v = m.trace[TRACE_IDS + i]
        ids[i], former[i] = v, names[v]
        names[v] = _mixed(base, np.uint64(i + 1))
    return made


@bare_kernel
def _same_as_other(m, code, h, k):
    """Whether the operation does what it does on a half-edge that comes before this one."""
    twin = m.edge[h, TWIN]
    if code <= TRI_COLLAPSE or code == FLIP_LEFT or code == FLIP_RIGHT or code == CLEANUP:
        return 0 <= twin < h
    if code == QUAD_COLLAPSE:
        return h % 4 >= 2
    return False


@bare_kernel
def _base(m, names, code, h, k):
    """A name for what the operation makes; for triangles it is the same from both sides."""
    a, b = names[m.edge[h, ORIGIN]], names[m.edge[following(h, k), ORIGIN]]
    if k == 3 and a > b:
        a, b = b, a
    return _mixed(_mixed(a, b), np.uint64(code + 1))


@bare_kernel
def _met(keys, left, key, remaining):
    """Whether the state was met with as many operations left; it is remembered with these."""
    mask = np.uint64(len(keys) - 1)
    place = key & mask
    for _ in range(64):
        if keys[place] == key:
            if left[place] >= remaining:
                return True
            left[place] = remaining
            return False
        if keys[place] == np.uint64(0):
            keys[place] = key
            left[place] = remaining
            return False
        place = (place + np.uint64(1)) & mask
    return False


@bare_kernel
def _reached(m, goal, most):
    return m.counters[SCORE] <= goal and (most == 0 or m.counters[ELEMENTS] <= most)


@bare_kernel
def _promises(m, code, h, goal, most):
    """False if this operation cannot be the last one, allowed or not."""
    if code == CLEANUP:
        return most > 0 and m.counters[SCORE] <= goal
    if m.edge[h, TWIN] < 0 and needs_twin(code):
        return False
    return m.counters[SCORE] + score_change(m, code, h) <= goal


@bare_kernel
def _last(m, code, h, goal, most):
    """Whether this allowed operation reaches the goal; for those that :func:`_promises` says."""
    rewrite(m, code, h)
    reached = _reached(m, goal, most)
    undo(m)
    return reached


@bare_kernel
def _explore(
    m, names, depth, goal, most, nodes, stack, ids, former, keys, left, ways, told
):  # fmt: skip
    """Try all sequences of `depth` operations that no shorter one makes superfluous.

    stack (depth + 1, 2): the place in the list of candidates, and the number of vertices made;
    ids, former: of those vertices, their former names. told: sequences found, states looked at.
    """
    k = m.counters[SIDES]
    first, count = (TRI_FLIP, 3) if k == 3 else (FLIP_LEFT, 6)
    level = 0
    stack[0, 0] = 0
    while level >= 0:
        at = stack[level, 0]
        h, code = at // count, first + at % count
        if h >= k * m.counters[ELEMENT_SLOTS]:
            level -= 1
            if level >= 0:
                undo(m)
                for i in range(stack[level, 1] - 1, -1, -1):
                    names[ids[level, i]] = former[level, i]
            continue
        stack[level, 0] = at + 1
        if m.edge[h, ORIGIN] < 0 or _same_as_other(m, code, h, k):
            continue
        if level == depth - 1 and not _promises(m, code, h, goal, most):
            continue
        verdict = check(m, code, h, 0)
        if verdict != ALLOWED:
            if verdict == 99:
                return _CRAMPED
            continue
        ways[told[0], level, 0], ways[told[0], level, 1] = code, h
        if level == depth - 1:
            if _last(m, code, h, goal, most):
                for i in range(depth):
                    if told[0] + 1 < len(ways):
                        ways[told[0] + 1, i, 0] = ways[told[0], i, 0]
                        ways[told[0] + 1, i, 1] = ways[told[0], i, 1]
                told[0] += 1
                if told[0] == len(ways):
                    return _FULL
            continue
        base = _base(m, names, code, h, k)
        rewrite(m, code, h)
        made = _christen(m, names, base, ids[level], former[level])
        remaining = depth - 1 - level
        hopeless = m.counters[IRREGULAR] - goal > PER_OPERATION * remaining
        if hopeless or _met(keys, left, _state(m, names, k), remaining):
            undo(m)
            for i in range(made - 1, -1, -1):
                names[ids[level, i]] = former[level, i]
            continue
        told[1] += 1
        if told[1] > nodes:
            return _SPENT
        stack[level, 1] = made
        level += 1
        stack[level, 0] = 0
    return _EXHAUSTED
