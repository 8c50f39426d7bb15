"""Guarded coarsening: fewer blocks at the same s, while the worst corner stays good.

A candidate is the collapse of a strip or the deletion of a line of regular vertices. It is applied
to a copy, rejected at once where the degrees alone forbid a good shape, then positioned
(:mod:`meshwright_core.geometry.layout_positions`) and kept if the layout is better in this order:
nothing inverted; lower s; worst corner sine, up to a target; smaller sum of the squared
irregularities; fewer elements. Sines are weighed so that long thin elements count as bad ones
(:func:`meshwright_core.geometry.element_sines.thinness`). Where the worst element is not good
enough, a strip through it may also be cut in two. A layout is changed in larger steps by a
*kick*: some random operations, followed by annealing until s is as low as before. All of it is
compiled; every operation is logged.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from meshwright_agent.env.candidates import permitted
from meshwright_agent.env.task import MOST_CLEANUPS, Task, transition
from meshwright_agent.search.annealing import (
    WEIGHTS,
    Operations,
    copy_mesh,
    draw_operation,
    propose,
    with_room,
)
from meshwright_core.core.arrays import (
    DEGREE,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    FLAGS,
    GEOMETRIC,
    HALF,
    IRREGULAR,
    LOCKED,
    ORIGIN,
    SCORE,
    SIDES,
    TWIN,
    VERTEX_SLOTS,
    MeshArrays,
    copied,
    following,
    opposite,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.references import by_reference
from meshwright_core.geometry.element_sines import element_sine, worst_around
from meshwright_core.geometry.layout_positions import POOR, layout_bound, position, rails_of
from meshwright_core.geometry.local_positions import LocalEffort, local_effort, settle
from meshwright_core.geometry.turning import has_bends
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import (
    CHORD_COLLAPSE,
    CLEANUP,
    CODES,
    DIVIDE_CHORD,
    GLOBAL_SPLIT,
    NAMES,
    check,
    needs_twin,
    rewrite,
    score_change,
)
from meshwright_core.operations.chord_collapse import chord_start
from meshwright_core.operations.global_lines import is_ring, line_start
from meshwright_core.operations.refusals import ALLOWED

ALIKE = 2e-3
"""Difference of worst sines below which two layouts count as equally good."""
RINGS = 3
"""Rings of elements around a change that are positioned with it where sides bend."""
STEPS = 25
"""Steps of each stage of the max-min positions of a candidate."""
ROUGH, FINE = 0.5, 0.25
"""Temperature of the first operations of a kick, and of the annealing back to low s."""
SCATTER = 0.3
"""Share of the random operations of a kick that are proposed anywhere."""
NEARBY = 60
"""Proposals near where a kick is to begin."""
SPLIT_PRICE = 0.5
"""Price of a global split in a kick, in units of s."""
SLICE = 2000
"""Elements positioned between two looks at the clock: some tens of milliseconds."""
_LOG = 1 << 12

# entries of the state that the kernels share
LENGTH, EVALUATED, ACCEPTED = 0, 1, 2
# how far a pass over the candidates has come, and how many are positioned in a call
COUNT, NEXT, GAINED, MOST = 0, 1, 2, 3


@by_reference
class Aims(NamedTuple):
    """What makes a layout good."""

    target: float
    """Worst corner sine that counts before the number of elements."""
    comfort: float
    """Worst corner sine, at least the target, up to which more is worth more elements."""
    price: float
    """How much more: a difference d of the worst sine counts as a factor exp(price d) in
    :func:`cost`."""
    spread: bool
    """Whether the sum of the squared irregularities counts before the number of elements."""


@by_reference
class Guard(NamedTuple):
    """What a layout must keep to."""

    aims: Aims
    cap: int
    """Highest degree that an operation may produce."""
    floor: int
    """Least number of elements."""
    angle: np.ndarray
    """(slots,) inner angles, as in :class:`meshwright_core.geometry.layout_positions.Rails`."""
    bends: bool
    """Whether sides bend: positions take long there, so a change is positioned locally first."""
    local: LocalEffort
    """How."""


@by_reference
class Record(NamedTuple):
    """What was done to a layout."""

    operations: np.ndarray
    """(N, 2) int32: operations and half-edges."""
    state: np.ndarray
    """(4,) int64, indexed by LENGTH, EVALUATED and ACCEPTED."""
    touched: np.ndarray
    """Scratch of the transitions, as is the next."""
    cleaned: np.ndarray


@bare_kernel
def squares(m):
    """Sum of the squared irregularities."""
    total = 0
    for i in range(m.counters[IRREGULAR]):
        v = m.irregular[i]
        delta = m.vertex[v, DEGREE] - m.vertex[v, DESIRED]
        total += delta * delta
    return total


@bare_kernel
def cost(worst, elements, aims):
    """Elements, weighed against the worst sine: see :class:`Aims`.

    Without the first two, so that to double very few is worth less than to double many; 1 and 2
    count as a quarter and a half.
    """
    return max(elements - 2.0, 0.25 * elements) * np.exp(-aims.price * min(worst, aims.comfort))


@bare_kernel
def is_better(first, second, aims):
    """Whether the first of two (s, worst sine, sum of squares, elements) is the better layout.

    One without inverted elements always is better than one with them.
    """
    if (first[1] > 0.0) != (second[1] > 0.0):
        return first[1] > 0.0
    if first[0] != second[0]:
        return first[0] < second[0]
    a, b = min(first[1], aims.target), min(second[1], aims.target)
    if abs(a - b) > ALIKE:
        return a > b
    if aims.spread and first[2] != second[2]:
        return first[2] < second[2]
    return cost(first[1], first[3], aims) < (1.0 - ALIKE) * cost(second[1], second[3], aims)


@kernel
def candidates(m, found):
    """Write the operations (code, half-edge) that may coarsen the layout into `found` (N, 2): one
    for each strip, and one for each line of regular vertices. Returns their number.
    """
    slots = 4 * m.counters[ELEMENT_SLOTS]
    seen, ring = np.zeros(slots, np.uint8), np.zeros(slots, np.uint8)
    count = 0
    for h in range(slots):
        if m.edge[h, ORIGIN] < 0:
            continue
        if not seen[h]:
            found[count, 0], found[count, 1] = CHORD_COLLAPSE, h
            count += 1
            start = chord_start(m, h)
            entry = start
            for _ in range(2 * m.counters[ELEMENTS]):
                seen[entry] = seen[opposite(entry)] = 1
                entry = m.edge[opposite(entry), TWIN]
                if entry < 0 or entry == start:
                    break
        if m.edge[h, TWIN] >= 0 and (line_start(m, h) == h or is_ring(m, h, ring, 0)):
            found[count, 0], found[count, 1] = CLEANUP, h
            count += 1
    return count


@bare_kernel
def _log(record, operation, h):
    length = record.state[LENGTH]
    record.operations[length, 0], record.operations[length, 1] = operation, h
    record.state[LENGTH] = length + 1


@kernel
def _try_operation(m, trial, rails, guard, record, key, operation, h):
    """Apply an operation to `m` if that makes the layout better; returns whether it did.

    trial: arrays of the same size; key (4,): s, worst sine, squares, elements of `m`, kept up to
    date.
    """
    other, state = np.zeros(4), record.state
    copy_mesh(m, trial)
    rewrite(trial, operation, h)
    other[0], other[1] = trial.counters[SCORE], layout_bound(trial, guard.angle)
    other[2] = squares(trial)
    other[3] = trial.counters[ELEMENTS]
    if not is_better(other, key, guard.aims):
        return False
    state[EVALUATED] += 1
    if guard.bends:
        active = np.zeros(len(m.points), np.bool_)
        if settle(m, trial, rails, guard.local, active) <= 0.0:
            return False
    if guard.bends and key[1] < POOR:
        # all of it would be unfolded at each try
        every = np.zeros(0, np.bool_)
        other[1] = max(0.0, worst_around(trial, rails.turning, rails.gauge, every, 0.0))
    else:
        other[1] = max(0.0, position(trial, rails, guard.aims.comfort, STEPS))
    if not is_better(other, key, guard.aims):
        return False
    copy_mesh(trial, m)
    _log(record, operation, h)
    for c in range(4):
        key[c] = other[c]
    state[ACCEPTED] += 1
    return True


@kernel
def coarsen_layout(m, trial, rails, guard, record, key, course, rng):
    """Coarsen `m` in place by candidates in random order until none is accepted, or as many as
    `course` has in MOST were positioned. trial, key: as in :func:`_try_operation`; course: where it
    goes on, kept from call to call. Returns whether it came to an end.
    """
    found, at = course
    state = record.state
    stop = state[EVALUATED] + at[MOST]
    while True:
        if at[NEXT] >= at[COUNT]:
            if at[COUNT] >= 0 and not at[GAINED]:
                return True
            at[COUNT], at[NEXT], at[GAINED] = candidates(m, found), 0, 0
        for i in range(at[NEXT], at[COUNT]):
            if state[LENGTH] + 2 > len(record.operations) or state[EVALUATED] >= stop:
                return False
            j = i + int(rng.random() * (at[COUNT] - i))
            operation, h = found[j, 0], found[j, 1]
            found[j, 0], found[j, 1] = found[i, 0], found[i, 1]
            at[NEXT] = i + 1
            if m.edge[h, ORIGIN] < 0 or m.counters[ELEMENTS] <= guard.floor:
                continue
            if check(m, operation, h, guard.cap) != ALLOWED:
                continue
            if _try_operation(m, trial, rails, guard, record, key, operation, h):
                at[GAINED] = 1


@kernel
def divide_strip(m, trial, rails, guard, record, key, h):
    """Cut the strip of half-edge h in two, in place, if that makes the layout better.

    The other arguments are those of :func:`coarsen_layout`. Returns whether it did.
    """
    if check(m, DIVIDE_CHORD, h, guard.cap) != ALLOWED:
        return False
    if record.state[LENGTH] + 2 > len(record.operations):
        return False
    return _try_operation(m, trial, rails, guard, record, key, DIVIDE_CHORD, h)


@by_reference
class Kick(NamedTuple):
    """How a layout is changed by a kick."""

    jumps: int
    """Random operations before the annealing."""
    proposals: int
    """The most proposals, of both together."""
    rough: float
    """Temperature of the random operations."""
    fine: float
    """Temperature of the annealing."""
    score: int
    """s to come back to."""
    bound: float
    """Worst corner sine that the degrees have to permit, see
    :func:`meshwright_core.geometry.layout_positions.layout_bound`."""
    weights: np.ndarray
    """(5,) probability of proposing each operation."""
    angle: np.ndarray
    """(slots,) inner angles at corners."""
    start: int
    """Half-edge near which the operations begin; -1: anywhere."""
    scatter: float
    """Share of the random operations that are proposed anywhere."""


@bare_kernel
def _wander(m, h, rng):
    """A half-edge a few elements away from h."""
    for _ in range(4):
        h = h - h % 4 + int(4.0 * rng.random())
        if m.edge[h, TWIN] < 0 or rng.random() < 0.4:
            break
        h = m.edge[h, TWIN]
    return h


@kernel
def worst_element(m, rails):
    """The element with the smallest weighed sine, of its corners and where a side bends of its
    samples; -1 if there is none.
    """
    worst, where = np.inf, -1
    for e in range(m.counters[ELEMENT_SLOTS]):
        if m.edge[4 * e, ORIGIN] < 0:
            continue
        sine = element_sine(m, rails.turning, rails.gauge, e)
        if sine < worst:
            worst, where = sine, e
    return where


@kernel
def kick(m, record, plan, rules, rng):
    """Random operations, then annealing until s and the degrees are as good as `plan` wants.

    Returns whether they are, within so many proposals.
    """
    k = m.counters[SIDES]
    done, looked, tries = 0, -1, 0
    for _ in range(plan.proposals):
        if done >= plan.jumps and done > looked and m.counters[SCORE] <= plan.score:
            if layout_bound(m, plan.angle) >= plan.bound:
                return True
            looked = done
        if record.state[LENGTH] + MOST_CLEANUPS + 1 > len(record.operations):
            return False
        rough = done < plan.jumps
        if done == 0 and plan.start >= 0 and tries < NEARBY:
            h = _wander(m, plan.start, rng)
            tries += 1
        else:
            h = propose(m, k, plan.scatter if rough else 0.05, rng)
        if h < 0:
            continue
        operation = rules.first + draw_operation(plan.weights, rng)
        if m.edge[h, TWIN] < 0 and needs_twin(operation):
            continue
        price = score_change(m, operation, h)
        if operation == GLOBAL_SPLIT:
            price += SPLIT_PRICE
        temperature = plan.rough if rough else plan.fine
        if price > 0.0 and rng.random() >= np.exp(-price / temperature):
            continue
        if not permitted(m, operation, h, rules):
            continue
        cleanups = transition(m, operation, h, rules.cap, record.touched, record.cleaned)
        _log(record, operation, h)
        for i in range(cleanups):
            _log(record, CLEANUP, record.cleaned[i])
        done += 1
    return False


@kernel
def replay(m, operations):
    """Apply operations (N, 2) to `m`; returns how many were allowed before the first that was
    not.
    """
    for i in range(len(operations)):
        if check(m, operations[i, 0], operations[i, 1], 0) != ALLOWED:
            return i
        rewrite(m, operations[i, 0], operations[i, 1])
    return len(operations)


@dataclass
class Layout:
    """A layout in the search."""

    arrays: MeshArrays
    """Connectivity and positions."""
    key: np.ndarray
    """(4,) s, worst corner sine up to what counts (0: folded), sum of squares, elements."""
    record: Record
    """How it is reached from the start."""
    finest: bool = False
    """Whether it is known that no strip at the worst element cut in two makes it better."""

    def copy(self) -> Layout:
        """An independent copy."""
        return Layout(
            copied(self.arrays),
            self.key.copy(),
            self.record._replace(
                operations=self.record.operations.copy(), state=self.record.state.copy()
            ),
        )

    def operations(self) -> Operations:
        """The operations that lead from the start to it."""
        done = self.record.operations[: self.record.state[LENGTH]].tolist()
        return [(NAMES[code], h) for code, h in done]


class Coarsener:
    """Layouts of one plane quad mesh, made from operations on it, coarsened and kicked.

    Args:
        mesh: the start; not changed.
        aims: what makes a layout good.
        seed: of all random choices.
        floor: least number of elements.
        ceiling: largest number of elements; by default twice that of the start.
        room: elements that given layouts may have on the way, if that is more.
    """

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        aims: Aims,
        seed: int = 0,
        floor: int = 1,
        ceiling: int | None = None,
        room: int = 0,
    ) -> None:
        """Prepare the arrays that all layouts are copied from."""
        task = Task("quad")
        size = mesh.n_elements
        ceiling = max(2 * size, size + 8) if ceiling is None else ceiling
        self.rng = np.random.default_rng(seed)
        self.start = with_room(mesh, max(ceiling, room))
        self.rails = rails_of(mesh, len(self.start.vertex))
        self.aims = aims
        self.bends = has_bends(mesh)
        self._local = local_effort(rings=RINGS, thorough=False)
        self.guard = Guard(aims, task.cap, floor, self.rails.angle, self.bends, self._local)
        self._rules = task.rules(floor, ceiling)
        self._weights = np.array(WEIGHTS["quad"][:5])
        self._weights /= self._weights.sum()
        self._spare = copied(self.start)

    def layout(
        self, operations: Operations, steps: int = STEPS, placed: HalfEdgeMesh | None = None
    ) -> Layout:
        """The layout that operations lead to, with positions.

        steps: of each stage of the max-min positions. placed: the same state of the mesh, with
        positions to begin with. Raises ValueError if the operations do not
        replay on the start.
        """
        codes = np.array([(CODES[4][name], h) for name, h in operations], np.int32).reshape(-1, 2)
        arrays = copied(self.start)
        if replay(arrays, codes) < len(codes):
            raise ValueError("the operations do not replay on the start")
        log = np.zeros((max(_LOG, 2 * len(codes)), 2), np.int32)
        log[: len(codes)] = codes
        state = np.zeros(4, np.int64)
        state[LENGTH] = len(codes)
        record = Record(log, state, np.zeros(16, np.int64), np.zeros(MOST_CLEANUPS, np.int64))
        layout = Layout(arrays, np.zeros(4), record)
        if placed is not None:
            self.place(layout, placed)
        self.judge(layout, steps)
        return layout

    def place(self, layout: Layout, placed: HalfEdgeMesh) -> None:
        """Move the vertices of a layout to their positions in the same state of the mesh."""
        live = placed.vertices()
        layout.arrays.points[live] = placed.points[live]
        layout.arrays.parameter[live] = placed.arrays.parameter[live]

    def judge(self, layout: Layout, steps: int = STEPS) -> None:
        """Position the vertices of a layout and update its key."""
        m = layout.arrays
        worst = position(m, self.rails, self.aims.comfort, steps)
        layout.key[:] = (m.counters[SCORE], max(0.0, worst), squares(m), m.counters[ELEMENTS])

    def positions(self, layout: Layout) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Ids (n,) of the vertices that may move, their places (n, 3), and parameters (n,)."""
        m = layout.arrays
        rows = m.vertex[: m.counters[VERTEX_SLOTS]]
        free = (rows[:, HALF] >= 0) & ((rows[:, FLAGS] & (GEOMETRIC | LOCKED)) == 0)
        ids = np.flatnonzero(free).astype(np.int64)
        return ids, m.points[ids].copy(), m.parameter[ids].copy()

    def coarsen(
        self, layout: Layout, stop: Callable[[], bool] | None = None, aims: Aims | None = None
    ) -> None:
        """Coarsen in place until no candidate is accepted, or `stop`.

        aims: in place of its own.
        """
        guard = self.guard if aims is None else self.guard._replace(aims=aims)
        found = np.zeros((2 * len(layout.arrays.edge), 2), np.int64)
        course = found, np.array([-1, 0, 0, 0])
        while stop is None or not stop():
            course[1][MOST] = max(1, SLICE // int(layout.key[3]))
            ended = coarsen_layout(
                layout.arrays, self._spare, self.rails, guard, layout.record, layout.key, course,
                self.rng,
            )  # fmt: skip
            if ended or not self._has_room(layout):
                break

    def kicked(
        self,
        layout: Layout,
        jumps: int,
        score: int,
        bound: float,
        proposals: int,
        at_worst: bool = False,
    ) -> Layout | None:
        """A copy after a kick of so many random operations, positioned; None where s does not come
        down to `score`, with degrees that permit a worst sine of `bound`, by so many `proposals`,
        or, where sides bend, something stays folded around what has changed.

        at_worst: the operations begin near the worst element.
        """
        other = layout.copy()
        plan = Kick(
            jumps, proposals, ROUGH, FINE, score, float(bound), self._weights,
            self.rails.angle, 4 * worst_element(other.arrays, self.rails) if at_worst else -1,
            SCATTER,
        )  # fmt: skip
        if not kick(other.arrays, other.record, plan, self._rules, self.rng):
            return None
        if self.bends and layout.key[1] > 0.0:
            active = np.zeros(len(other.arrays.points), np.bool_)
            if settle(layout.arrays, other.arrays, self.rails, self._local, active) <= 0.0:
                return None
        self.judge(other)
        return other

    def divided(self, layout: Layout, stop: Callable[[], bool]) -> bool:
        """Cut in two, in place, a strip through the worst element or beside it; returns whether one
        was found that makes the layout better, before `stop`.
        """
        m = layout.arrays
        e = int(worst_element(m, self.rails))
        sides = [4 * e + i for i in range(4)]
        beside = [following(int(m.edge[h, TWIN]), 4) for h in sides if m.edge[h, TWIN] >= 0]
        for h in [
            *self.rng.permutation(sides[:2]).tolist(),
            *self.rng.permutation(beside).tolist(),
        ]:
            if stop():
                break
            if divide_strip(
                m, self._spare, self.rails, self.guard, layout.record, layout.key, h
            ):  # fmt: skip
                return True
        return False

    def _has_room(self, layout: Layout) -> bool:
        """Whether the log of a layout is not full."""
        return int(layout.record.state[LENGTH]) + 2 <= len(layout.record.operations)

    def better(self, first: Layout, second: Layout) -> bool:
        """Whether the first is the better layout."""
        return bool(is_better(first.key, second.key, self.aims))
