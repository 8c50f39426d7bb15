"""Simulated annealing in compiled code, and two simpler searches: greedy descent and random walk.

A proposal is an operation of the agent's action set near an irregular vertex. Its exact change of s
is computed before it is applied, so a rejected proposal is cheap. The Metropolis rule accepts by
the energy s + price * elements at a temperature that falls geometrically over a sweep; each sweep
starts from the best state so far. Accepted operations are logged, so that the operations that lead
to the best state can be replayed on the given mesh.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from meshwright_agent.env.candidates import Rules, permitted
from meshwright_agent.env.task import MOST_CLEANUPS, Task, transition
from meshwright_core.core.arrays import (
    DEGREE,
    ELEMENT_SLOTS,
    ELEMENTS,
    HALF,
    IRREGULAR,
    JOURNALLING,
    ORIGIN,
    SCORE,
    SIDES,
    TWIN,
    VERTEX_SLOTS,
    MeshArrays,
    copied,
    turned,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.references import by_reference
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import (
    CHORD_COLLAPSE,
    CLEANUP,
    GLOBAL_SPLIT,
    NAMES,
    Operation,
    growth,
    needs_twin,
    rewrite,
    score_change,
)
from meshwright_core.operations.chord_collapse import check_chord_collapse
from meshwright_core.operations.refusals import ALLOWED

Operations = list[tuple[Operation, int]]

TEMPERATURES = {"tri": (0.35, 0.35), "quad": (0.4, 0.3)}
"""Temperature at the start and the end of a sweep; at higher ones triangles do not converge."""
SWEEP = 500
"""Proposals in a sweep, relative to the number of elements."""
PRICE = {"tri": 0.6, "quad": 0.0}
"""Price of an element, in units of s; without it triangle meshes grow, with more defects."""
SPLIT_PRICE = 1.0
"""Price of a global split, in units of s."""
WEIGHTS = {"tri": (0.5, 0.25, 0.25, 0.0, 0.0, 0.0), "quad": (0.3, 0.3, 0.15, 0.15, 0.1, 0.0)}
"""Probability of proposing each operation; the last is the collapse of a chord of quads."""
ANYWHERE = 0.02
"""Share of proposals at a half-edge drawn from the whole mesh."""
SLICE = 20_000
"""Proposals between two checks of the time."""

_SPARE = 900  # slots for the longest global split beyond the largest allowed mesh
_LOG = 1 << 14
_LONGEST_LOG = 1 << 23
# entries of the integer state that the kernels share
LENGTH, BEST_LENGTH, BEST_SCORE, BEST_ELEMENTS, PROPOSALS, APPLIED, SAVED_AT, SWEEP_AT = range(8)
# return codes of a slice
USED_UP, AT_GOAL, SHORT = 0, 1, 2


@by_reference
class Schedule(NamedTuple):
    """How proposals are drawn and accepted."""

    hot: float
    """Temperature at the start of a sweep."""
    cold: float
    """Temperature at its end."""
    sweep: float
    """Proposals in a sweep."""
    price: float
    """Of an element, in units of s."""
    split_price: float
    """Of a global split, in units of s."""
    weights: np.ndarray
    """(6,) float64: probability of proposing each operation."""
    anywhere: float
    """Share of proposals at a half-edge drawn from the whole mesh."""
    fewer: bool
    """Among equal s prefer fewer elements, and stop at each state that is better than the best."""
    goal: int
    """s at which to stop."""


@by_reference
class Log(NamedTuple):
    """What was done, with scratch for the clean-ups."""

    operations: np.ndarray
    """(N, 2) int32: operations and half-edges from the start to the current state."""
    state: np.ndarray
    """(8,) int64, indexed by LENGTH, BEST_LENGTH, ..."""
    touched: np.ndarray
    cleaned: np.ndarray


@bare_kernel
def copy_mesh(source, target):
    """Copy `source` into `target`, whose arrays have the same sizes; the journal is not copied."""
    k = source.counters[SIDES]
    for h in range(k * max(source.counters[ELEMENT_SLOTS], target.counters[ELEMENT_SLOTS])):
        target.edge[h, 0] = source.edge[h, 0]
        target.edge[h, 1] = source.edge[h, 1]
    for v in range(max(source.counters[VERTEX_SLOTS], target.counters[VERTEX_SLOTS])):
        for column in range(7):
            target.vertex[v, column] = source.vertex[v, column]
        for axis in range(3):
            target.points[v, axis] = source.points[v, axis]
        target.parameter[v] = source.parameter[v]
    for e in range(max(source.counters[ELEMENT_SLOTS], target.counters[ELEMENT_SLOTS])):
        target.region[e] = source.region[e]
    for i in range(source.counters[IRREGULAR]):
        target.irregular[i] = source.irregular[i]
    for i in range(len(source.counters)):
        target.counters[i] = source.counters[i]


@bare_kernel
def propose(m, k, anywhere, rng):
    """A random half-edge of an element at a random irregular vertex, or of a neighbour of it.

    With probability `anywhere` a half-edge drawn from all slots; -1 if that slot is unused.
    """
    total = m.counters[IRREGULAR]
    if total == 0 or rng.random() < anywhere:
        h = int(rng.random() * m.counters[ELEMENT_SLOTS] * k)
        return h if m.edge[h, ORIGIN] >= 0 else -1
    v = m.irregular[int(rng.random() * total)]
    h = m.vertex[v, HALF]
    for _ in range(int(rng.random() * m.vertex[v, DEGREE])):
        onward = turned(m, h, k)
        if onward < 0:
            break
        h = onward
    turn = int(rng.random() * 2 * k)
    if turn >= k:
        turn -= k
        across = m.edge[h - h % k + (h + 1) % k, TWIN]
        if across >= 0:
            h = across
    return h - h % k + (h + turn) % k


@bare_kernel
def draw_operation(weights, rng):
    """An index drawn with the probabilities `weights` (N,), which sum to one."""
    r = rng.random()
    for i in range(len(weights)):
        r -= weights[i]
        if r < 0.0:
            return i
    return 0


@bare_kernel
def save_best(m, best, state):
    """Record the current state as the best one."""
    state[BEST_SCORE] = m.counters[SCORE]
    state[BEST_ELEMENTS] = m.counters[ELEMENTS]
    state[BEST_LENGTH] = state[LENGTH]
    state[SAVED_AT] = state[APPLIED]
    copy_mesh(m, best)


@bare_kernel
def is_better(m, state, fewer):
    """Whether the current state beats the best: lower s or, with `fewer`, fewer elements."""
    score = m.counters[SCORE]
    if score != state[BEST_SCORE]:
        return score < state[BEST_SCORE]
    return fewer and m.counters[ELEMENTS] < state[BEST_ELEMENTS]


@bare_kernel
def restart(m, best, state):
    """Return to the best state and begin a new sweep."""
    copy_mesh(best, m)
    state[LENGTH] = state[BEST_LENGTH]
    state[SWEEP_AT] = 0


@kernel
def anneal_slice(m, best, done, proposals, schedule, rules, rng):
    """At most so many proposals; returns USED_UP, AT_GOAL, or SHORT if the log `done` is full.

    With `schedule.fewer` it returns AT_GOAL at the first state that is better than the best.
    """
    k = m.counters[SIDES]
    log, state, cleaned = done.operations, done.state, done.cleaned
    hot, cold, sweep, fewer = schedule.hot, schedule.cold, schedule.sweep, schedule.fewer
    temperature = hot
    for at in range(proposals):
        if at % 64 == 0:
            if state[SWEEP_AT] >= sweep:
                if not fewer and is_better(m, state, fewer):
                    save_best(m, best, state)
                restart(m, best, state)
            if state[LENGTH] + 64 * (MOST_CLEANUPS + 1) > len(log):
                return SHORT
            temperature = hot * (cold / hot) ** (state[SWEEP_AT] / sweep)
            state[SWEEP_AT] += 64
            state[PROPOSALS] += 64
        h = propose(m, k, schedule.anywhere, rng)
        if h < 0:
            continue
        operation = rules.first + draw_operation(schedule.weights, rng)
        if operation > GLOBAL_SPLIT:
            operation = CHORD_COLLAPSE
        if m.edge[h, TWIN] < 0 and needs_twin(operation):
            continue
        cleanups = 0
        if operation == CHORD_COLLAPSE:
            # it merges pairs of vertices and adds their Delta, so s never rises
            if m.counters[ELEMENTS] <= rules.floor:
                continue
            if check_chord_collapse(m, h, rules.cap) != ALLOWED:
                continue
            rewrite(m, CHORD_COLLAPSE, h)
        else:
            change = score_change(m, operation, h) + schedule.price * growth(m, operation, h)
            if operation == GLOBAL_SPLIT:
                change += schedule.split_price
            if change > 0.0 and rng.random() >= np.exp(-change / temperature):
                continue
            if not permitted(m, operation, h, rules):
                continue
            cleanups = transition(m, operation, h, rules.cap, done.touched, cleaned)
        length = state[LENGTH]
        log[length, 0], log[length, 1] = operation, h
        for i in range(cleanups):
            log[length + 1 + i, 0], log[length + 1 + i, 1] = CLEANUP, cleaned[i]
        state[LENGTH] = length + 1 + cleanups
        state[APPLIED] += 1
        if not is_better(m, state, fewer):
            continue
        # copying takes time proportional to the mesh: on large ones it waits for more progress
        due = 64 * (state[APPLIED] - state[SAVED_AT]) >= m.counters[ELEMENTS] - 256
        if due or fewer or m.counters[SCORE] <= schedule.goal:
            save_best(m, best, state)
            if fewer or m.counters[SCORE] <= schedule.goal:
                return AT_GOAL
    return USED_UP


@kernel
def descent_step(m, plateau, rules, touched, cleaned, rng):
    """The best operation on the whole mesh, ties broken at random: (operation, half-edge, number of
    clean-ups), or -1 for the operation if none lowers s (plateau: or leaves it).
    """
    k = m.counters[SIDES]
    best, tied, chosen, at = 1 if plateau else 0, 0, -1, -1
    for h in range(k * m.counters[ELEMENT_SLOTS]):
        if m.edge[h, ORIGIN] < 0:
            continue
        for operation in range(rules.first, rules.first + rules.operations):
            if m.edge[h, TWIN] < 0 and needs_twin(operation):
                continue
            change = score_change(m, operation, h)
            if change > best or (change == best and tied == 0):
                continue
            if not permitted(m, operation, h, rules):
                continue
            tied = 1 if change < best else tied + 1
            if change < best or rng.random() * tied < 1.0:
                best, chosen, at = change, operation, h
    if chosen < 0:
        return -1, -1, 0
    return chosen, at, transition(m, chosen, at, rules.cap, touched, cleaned)


class Annealer:
    """Simulated annealing that can be run in slices, with the best state available after each."""

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        seed: int,
        *,
        extended: bool = True,
        floor: int | None = None,
        ceiling: int | None = None,
        temperatures: tuple[float, float] | None = None,
        sweep: float = SWEEP,
        price: float | None = None,
        split_price: float = SPLIT_PRICE,
        weights: tuple[float, ...] | None = None,
        anywhere: float = ANYWHERE,
        fewer: bool = False,
        goal: int | None = None,
    ) -> None:
        """Start from a copy of `mesh`.

        Args:
            mesh: the start.
            seed: of the random choices.
            extended: whether boundary edges of triangle meshes may be collapsed.
            floor: least number of elements; by default for triangles that of the start, else 1.
            ceiling: largest number of elements; by default twice that of the start.
            temperatures: at the start and the end of a sweep; by default TEMPERATURES.
            sweep: proposals in a sweep, relative to the number of elements.
            price: of an element, in units of s; by default PRICE.
            split_price: of a global split, in units of s.
            weights: (6,) how often each operation is proposed; by default WEIGHTS.
            anywhere: share of proposals at a half-edge drawn from the whole mesh.
            fewer: prefer fewer elements among states of equal s, and stop a slice at each
                improvement.
            goal: s at which to stop, by default s*.
        """
        kind, size = mesh.kind, mesh.n_elements
        task = Task(kind)
        self.floor = (size if kind == "tri" else 1) if floor is None else floor
        self.ceiling = max(2 * size, size + 8) if ceiling is None else ceiling
        self.goal = mesh.optimum if goal is None else goal
        shares = np.array(WEIGHTS[kind] if weights is None else weights, np.float64)
        hot, cold = TEMPERATURES[kind] if temperatures is None else temperatures
        self._schedule = Schedule(
            float(hot), float(cold), max(64.0, float(sweep * size)),
            float(PRICE[kind] if price is None else price), float(split_price),
            shares / shares.sum(), float(anywhere), fewer, self.goal,
        )  # fmt: skip
        self.fewer = fewer
        self._rules = task.rules(self.floor, self.ceiling)._replace(extended=extended)
        self._touched, self._cleaned = np.zeros(16, np.int64), np.zeros(MOST_CLEANUPS, np.int64)
        self.rng = np.random.default_rng(seed)
        self.state = np.zeros(8, np.int64)
        self.log = np.zeros((_LOG, 2), np.int32)
        self.arrays = with_room(mesh, self.ceiling)
        self.best = copied(self.arrays)
        self.state[BEST_SCORE], self.state[BEST_ELEMENTS] = mesh.score, size

    @property
    def rules(self) -> Rules:
        """The rules for its operations, with the present floor and ceiling."""
        return self._rules._replace(floor=self.floor, ceiling=self.ceiling)

    @property
    def best_score(self) -> int:
        """s of the best state."""
        return int(self.state[BEST_SCORE])

    @property
    def best_elements(self) -> int:
        """Elements of the best state."""
        return int(self.state[BEST_ELEMENTS])

    @property
    def finished(self) -> bool:
        """Whether the goal is reached."""
        return self.best_score <= self.goal

    def operations(self) -> Operations:
        """The operations that lead from the start to the best state."""
        rows = self.log[: self.state[BEST_LENGTH]].tolist()
        return [(NAMES[code], h) for code, h in rows]

    def run(self, proposals: int = SLICE) -> bool:
        """Make `proposals` more; True if it stopped early.

        That is at the goal or, with `fewer`, at an improvement.
        """
        ended = anneal_slice(
            self.arrays, self.best, Log(self.log, self.state, self._touched, self._cleaned),
            proposals, self._schedule._replace(fewer=self.fewer, goal=self.goal), self.rules,
            self.rng,
        )  # fmt: skip
        if ended == SHORT:
            self._lengthen()
        elif not self.fewer and is_better(self.arrays, self.state, False):
            save_best(self.arrays, self.best, self.state)
        return bool(ended == AT_GOAL)

    def restart(self) -> None:
        """Begin a new sweep from the best state."""
        restart(self.arrays, self.best, self.state)

    def _lengthen(self) -> None:
        """Double the log or, at its largest size, return to the best state, which shortens it."""
        if len(self.log) < _LONGEST_LOG:
            self.log = np.concatenate([self.log, np.zeros_like(self.log)])
        else:
            self.restart()


def with_room(mesh: HalfEdgeMesh, elements: int) -> MeshArrays:
    """The arrays of a copy without journal and with slots for so many elements."""
    copied = mesh.copy()
    copied.arrays.counters[JOURNALLING] = 0
    more = max(elements - mesh.n_elements, 0) + _SPARE
    copied.reserve(more, more)
    return copied.arrays


def anneal(
    mesh: HalfEdgeMesh,
    *,
    seconds: float | None = None,
    proposals: int | None = None,
    seed: int = 0,
    cancelled: Callable[[], bool] | None = None,
    **settings: object,
) -> tuple[Operations, int]:
    """Simulated annealing from `mesh`, which is not changed; stops early at the goal.

    Ends after `seconds` or `proposals`, by default after one second, or when `cancelled()` is true.
    settings: keyword arguments of :class:`Annealer`. Returns the operations to the best state, and
    its s.
    """
    began = time.perf_counter()
    if seconds is None and proposals is None:
        seconds = 1.0
    annealer = Annealer(mesh, seed, **settings)  # type: ignore[arg-type]
    left = proposals if proposals is not None else 1 << 62
    while left > 0 and not annealer.finished:
        if seconds is not None and time.perf_counter() - began > seconds:
            break
        if cancelled is not None and cancelled():
            break
        annealer.run(min(left, SLICE))
        left -= SLICE
    return annealer.operations(), annealer.best_score


def random_walk(
    mesh: HalfEdgeMesh,
    *,
    seconds: float | None = None,
    proposals: int | None = None,
    seed: int = 0,
    cancelled: Callable[[], bool] | None = None,
    **settings: object,
) -> tuple[Operations, int]:
    """A random walk of permitted operations; arguments and result as in :func:`anneal`."""
    return anneal(
        mesh, seconds=seconds, proposals=proposals, seed=seed, cancelled=cancelled,
        temperatures=(1e9, 1e9), anywhere=1.0, price=0.0, split_price=0.0, **settings,
    )  # fmt: skip


def greedy(
    mesh: HalfEdgeMesh,
    *,
    seed: int = 0,
    plateau: int = 0,
    extended: bool = True,
    floor: int | None = None,
    ceiling: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> tuple[Operations, int]:
    """Steepest descent: repeatedly the operation that lowers s most.

    plateau: how many operations in a row may leave s unchanged. Returns the operations to the best
    state, and its s. The other arguments are those of :class:`Annealer`.
    """
    limits = Annealer(mesh, seed, extended=extended, floor=floor, ceiling=ceiling)
    arrays = limits.arrays
    touched, cleaned = np.zeros(16, np.int64), np.zeros(MOST_CLEANUPS, np.int64)
    done: Operations = []
    length, best, idle = 0, mesh.score, 0
    while best > mesh.optimum and idle <= plateau and not (cancelled is not None and cancelled()):
        code, h, cleanups = descent_step(
            arrays, idle < plateau, limits.rules, touched, cleaned, limits.rng
        )
        if code < 0:
            break
        done.append((NAMES[code], h))
        done += [(Operation.CLEANUP, line) for line in cleaned[:cleanups].tolist()]
        idle += 1
        if int(arrays.counters[SCORE]) < best:
            best, length, idle = int(arrays.counters[SCORE]), len(done), 0
    return done[:length], best
