"""The fewest operations from a mesh to a goal, by exhaustive iterative deepening.

For each length all sequences of the paper's operations, and of collapses of boundary edges, are
tried, whatever they do to s on the way. A state that was reached before with as many operations
left is skipped; two states are the same if the same named vertices are joined, where a vertex is
named after the operation that created it. The last operation is judged by its exact change of s.
The result for a length is a proof, except for collisions of 64-bit hashes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

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
from meshwright_core.core.references import by_reference
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

KEPT = 64
"""Largest number of shortest sequences that are returned, to choose one that can be drawn."""
DEEPEST = 12
"""Default for the largest number of operations."""
PER_OPERATION = 4
"""Largest decrease of the number of irregular vertices by one operation: a flip changes four
degrees, a collapse replaces four vertices by three, all others change fewer."""
_ROOM = 64
"""Slots reserved, relative to the size of the mesh: no sequence that is tried needs more."""
_EXHAUSTED, _FULL, _NODES_USED, _NO_SLOTS = 0, 1, 2, 3


@by_reference
class SearchLimits(NamedTuple):
    """What is searched for, and how long."""

    score: int
    """Largest s."""
    most: int
    """Largest number of elements, 0 for any."""
    nodes: int
    """Largest number of states to be visited."""


@by_reference
class OperationPath(NamedTuple):
    """The sequence of operations being tried, for each of D + 1 numbers of them."""

    place: np.ndarray
    """(D + 1, 2) int64: the place in the list of candidates, and the number of vertices made."""
    made: np.ndarray
    """(D + 1, N) int64: those vertices."""
    former: np.ndarray
    """(D + 1, N) uint64: their names before."""


@by_reference
class Visited(NamedTuple):
    """A hash table of the states that were reached."""

    keys: np.ndarray
    """(S,) uint64: hashes of states, 0 for none."""
    left: np.ndarray
    """(S,) int8: the largest number of operations left in that state."""


@dataclass(frozen=True)
class FewestResult:
    """The result of an exhaustive search."""

    sequences: tuple[tuple[tuple[Operation, int], ...], ...]
    """Some of the shortest sequences; empty if none was found."""
    proved: int
    """It is proved that no sequence of up to so many operations reaches the goal."""
    nodes: int
    """Number of states that were visited."""


def fewest(
    mesh: HalfEdgeMesh,
    goal: int,
    most: int = 0,
    deepest: int = DEEPEST,
    nodes: int = 20_000_000,
    slots: int = 1 << 24,
) -> FewestResult:
    """The shortest sequences of operations from ``mesh``, which is not changed, to s <= ``goal``.

    Args:
        mesh: the start.
        goal: s to be reached.
        most: largest number of elements at the goal, 0 for any.
        deepest: largest number of operations; beyond it the search ends without a result.
        nodes: largest number of states, likewise.
        slots: size of the table of visited states, a power of two; 9 bytes each.

    Raises RuntimeError if the reserved slots of the mesh do not suffice.
    """
    if mesh.score <= goal and (not most or mesh.n_elements <= most):
        return FewestResult(((),), 0, 0)
    seen = 0
    for depth in range(1, deepest + 1):
        search = _Search(mesh, goal, most, depth, slots)
        ended = search.run(nodes - seen)
        seen += search.nodes
        if search.sequences or ended == _NODES_USED:
            return FewestResult(search.sequences, depth - 1, seen)
    return FewestResult((), deepest, seen)


class _Search:
    """The search through all sequences of one length."""

    def __init__(self, mesh: HalfEdgeMesh, goal: int, most: int, depth: int, slots: int) -> None:
        self._mesh, self._goal, self._most, self._depth = mesh, goal, most, depth
        self._slots = slots if depth > 2 else 1 << 12
        self.nodes = 0
        self.sequences: tuple[tuple[tuple[Operation, int], ...], ...] = ()

    def run(self, nodes: int) -> int:
        """Visit up to `nodes` states; returns the code with which the kernel ended."""
        work = self._mesh.copy()
        room = _ROOM * (work.n_elements + 16)
        work.room_for(room, room)
        work._arrays = work.arrays._replace(
            journal=np.zeros((1 << 18, 2), np.int64),
        )
        ways = np.zeros((KEPT, self._depth, 2), np.int64)
        counts = np.zeros(2, np.int64)
        width = len(work.arrays.trace)
        ended = int(
            _explore(
                work.arrays, _first_names(len(work.arrays.vertex)), self._depth,
                SearchLimits(self._goal, self._most, nodes),
                OperationPath(
                    np.zeros((self._depth + 1, 2), np.int64),
                    np.zeros((self._depth + 1, width), np.int64),
                    np.zeros((self._depth + 1, width), np.uint64),
                ),
                Visited(np.zeros(self._slots, np.uint64), np.zeros(self._slots, np.int8)),
                ways, counts,
            )
        )  # fmt: skip
        if ended == _NO_SLOTS:
            raise RuntimeError("the search needs more slots than it has reserved")
        self.nodes = int(counts[1])
        self.sequences = tuple(
            tuple((NAMES[int(code)], int(h)) for code, h in way) for way in ways[: counts[0]]
        )
        return ended


def _first_names(count: int) -> np.ndarray:
    """(count,) uint64 random names, one for each vertex slot."""
    return np.random.default_rng(7).integers(1, 1 << 63, count).astype(np.uint64)


@bare_kernel
def _mixed(x, y):
    """A 64-bit hash of an ordered pair."""
    z = (x ^ (x >> np.uint64(29))) * np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(32))) + y * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(31))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(30))


@bare_kernel
def _state(m, names, k):
    """A hash of the connectivity: the sum over all half-edges of the hash of their ends' names."""
    total = np.uint64(0)
    for h in range(k * m.counters[ELEMENT_SLOTS]):
        if m.edge[h, ORIGIN] >= 0:
            total += _mixed(names[m.edge[h, ORIGIN]], names[m.edge[following(h, k), ORIGIN]])
    return total


@bare_kernel
def _name_created(m, names, base, ids, former):
    """Name the vertices that the last operation created; returns their number."""
    made = m.trace[NEW_COUNT]
    for i in range(made):
        v = m.trace[TRACE_IDS + i]
        ids[i], former[i] = v, names[v]
        names[v] = _mixed(base, np.uint64(i + 1))
    return made


@bare_kernel
def _same_as_other(m, code, h, k):
    """Whether the operation has the same result at a half-edge with a lower number."""
    twin = m.edge[h, TWIN]
    if code <= TRI_COLLAPSE or code == FLIP_LEFT or code == FLIP_RIGHT or code == CLEANUP:
        return 0 <= twin < h
    if code == QUAD_COLLAPSE:
        return h % 4 >= 2
    return False


@bare_kernel
def _base(m, names, code, h, k):
    """A name for the result of the operation; for triangles it is the same at the twin."""
    a, b = names[m.edge[h, ORIGIN]], names[m.edge[following(h, k), ORIGIN]]
    if k == 3 and a > b:
        a, b = b, a
    return _mixed(_mixed(a, b), np.uint64(code + 1))


@bare_kernel
def _met(visited, key, remaining):
    """Whether the state was reached before with as many operations left; if not, it is recorded."""
    keys, left = visited.keys, visited.left
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
def _reached(m, goal):
    fits = goal.most == 0 or m.counters[ELEMENTS] <= goal.most
    return m.counters[SCORE] <= goal.score and fits


@bare_kernel
def _can_be_last(m, code, h, goal):
    """False if the goal is out of reach with this as the last operation, allowed or not."""
    if code == CLEANUP:
        return goal.most > 0 and m.counters[SCORE] <= goal.score
    if m.edge[h, TWIN] < 0 and needs_twin(code):
        return False
    return m.counters[SCORE] + score_change(m, code, h) <= goal.score


@bare_kernel
def _last(m, code, h, goal):
    """Whether this operation, which must be allowed, leads to the goal."""
    rewrite(m, code, h)
    reached = _reached(m, goal)
    undo(m)
    return reached


@bare_kernel
def _explore(m, names, depth, goal, path, visited, ways, counts):
    """Try all sequences of `depth` operations, skipping states that were reached before.

    names: of the vertices; ways (W, depth, 2): receives the sequences found; counts (2,): receives
    the number of sequences found and of states visited. Returns why it ended.
    """
    place, made_ids, former = path.place, path.made, path.former
    k = m.counters[SIDES]
    first, count = (TRI_FLIP, 3) if k == 3 else (FLIP_LEFT, 6)
    level = 0
    place[0, 0] = 0
    while level >= 0:
        at = place[level, 0]
        h, code = at // count, first + at % count
        if h >= k * m.counters[ELEMENT_SLOTS]:
            level -= 1
            if level >= 0:
                undo(m)
                for i in range(place[level, 1] - 1, -1, -1):
                    names[made_ids[level, i]] = former[level, i]
            continue
        place[level, 0] = at + 1
        if m.edge[h, ORIGIN] < 0 or _same_as_other(m, code, h, k):
            continue
        if level == depth - 1 and not _can_be_last(m, code, h, goal):
            continue
        verdict = check(m, code, h, 0)
        if verdict != ALLOWED:
            if verdict == 99:
                return _NO_SLOTS
            continue
        ways[counts[0], level, 0], ways[counts[0], level, 1] = code, h
        if level == depth - 1:
            if _last(m, code, h, goal):
                for i in range(depth):
                    if counts[0] + 1 < len(ways):
                        ways[counts[0] + 1, i, 0] = ways[counts[0], i, 0]
                        ways[counts[0] + 1, i, 1] = ways[counts[0], i, 1]
                counts[0] += 1
                if counts[0] == len(ways):
                    return _FULL
            continue
        base = _base(m, names, code, h, k)
        rewrite(m, code, h)
        made = _name_created(m, names, base, made_ids[level], former[level])
        remaining = depth - 1 - level
        unreachable = m.counters[IRREGULAR] - goal.score > PER_OPERATION * remaining
        if unreachable or _met(visited, _state(m, names, k), remaining):
            undo(m)
            for i in range(made - 1, -1, -1):
                names[made_ids[level, i]] = former[level, i]
            continue
        counts[1] += 1
        if counts[1] > goal.nodes:
            return _NODES_USED
        place[level, 1] = made
        level += 1
        place[level, 0] = 0
    return _EXHAUSTED
