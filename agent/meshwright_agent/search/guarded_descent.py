"""How s* is reached on domains with curved sides: guarded rollouts, and what goes on from the best
of them.

Guarded rollouts (:mod:`meshwright_agent.search.guarded_rollouts`) are cheap, and most end a little
above s*, each in another state. With all strips cut in two there is room for more operations, so
that a rollout from there often goes on. Where s* is hard to reach, most often a leap
(:mod:`meshwright_agent.search.leaps`) leads there, from some states in every second try and from
others never, so that each new state is tried soon. Sometimes only a way down by annealing does, or
a free rollout, though little of what it reaches can be drawn before its strips are divided
(:mod:`meshwright_agent.search.divided_layouts`). What works differs from part to part, so all of it
takes turns.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search.annealing import Operations
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.divided_layouts import (
    collapse_chords,
    divide_chords,
    divisible,
    drawable,
    drawn_divided,
    ways_down,
)
from meshwright_agent.search.guarded_rollouts import (
    STALLED,
    DrawnState,
    GuardedRollouts,
    thin_out,
    thinning_effort,
)
from meshwright_agent.search.leaps import leap
from meshwright_agent.search.search_worker import RolloutBatch, Worker
from meshwright_core.core.arrays import JOURNALLING, copied
from meshwright_core.geometry.layout_positions import rails_of
from meshwright_core.geometry.shape_bound import corner_angles
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES

TOGETHER, ELEMENTS_EACH = 2, 200
"""The most guarded rollouts side by side, and elements of all of them together: on a large mesh one
comes further in the same time."""
ROUNDS, ROUNDS_LATER = 6, 4
"""Guarded rollouts from the start in the first turn, and in each later one."""
STALLED_LATER = 80
"""Decisions without a lower s after which a rollout ends from the second turn on: where s* is hard
to reach, more of the long ones do."""
CONTINUED_STATES = 4
"""States that are gone on from in each turn, as long as none leads on."""
SMALL, GROWTH = 100, 1.3
"""Elements of a state below which the first leap from it is made with its strips cut in two, the
second without, and so on; from a larger one it is the other way round. By how much a leap may
multiply them."""
KEPT, ABOVE = 40, 4
"""States that are kept, of the lowest s and up to `ABOVE` more."""
MOST_GATHERED = 12
"""States of the lowest s up to which further ones are looked for."""
FREE_WORK, MOST_FREE = 1500, 16
"""Free rollouts from a state in each turn, in its elements and in number."""
COARSE = 120
"""Elements down to which these are coarsened first."""
FREE_DRAWN = ((4, 1), (1, 2))
"""How many of their results are given positions, with how many attempts; then again."""
ANNEALED_EVERY = 2
"""Turns in which a state is annealed once."""
LARGEST_ANNEALED = 250
"""Elements up to which a state is annealed."""
ANNEALED_DRAWN = 6
"""Results of annealing that are given positions."""
_SLICE = 20
"""Strips that are collapsed between two looks at the clock."""


class GuardedDescent:
    """A descent to s* through states without inverted elements.

    Each turn makes guarded rollouts from the start, some of them with its strips cut in two; goes
    on from the states of low s that were tried least, by leaps, and at first by guarded rollouts
    too; anneals at times; and makes free rollouts from a state of the lowest s and from the start.

    Args:
        mesh: the start, without inverted elements; it is not changed.
        policy: for quad meshes.
        max_steps: length of a rollout, by default that of the policy's task.
        seed: of the random choices.

    Attributes:
        states: the best ones, those of the lowest s first, and of these the coarsest.
        rollouts: how many were made.
    """

    def __init__(
        self, mesh: HalfEdgeMesh, policy: Policy, max_steps: int | None, seed: int
    ) -> None:
        """Nothing is done yet."""
        self._mesh, self._policy, self._max_steps = mesh, policy, max_steps
        self._start = DrawnState.of([], mesh.arrays)
        # by the start of the descent: by those of its rounds the meshes would grow without end
        self._ceiling = policy.task.bounds(mesh.n_elements)[1]
        self._rng = np.random.default_rng(seed)
        self._stalled = STALLED
        self.states: list[DrawnState] = []
        self.rollouts = 0

    @property
    def score(self) -> int:
        """The lowest s."""
        return self.states[0].score if self.states else self._mesh.score

    @property
    def lowest(self) -> list[DrawnState]:
        """The states of the lowest s, the coarsest first."""
        return [state for state in self.states if state.score == self.score]

    def run(self, stop: Callable[[], bool], most: int | None = None) -> None:
        """Go on until s*, until `stop`, or for at most so many rollouts."""
        begun, optimum = self.rollouts, self._mesh.optimum
        divides = divisible(self._mesh.n_elements)
        together = max(1, min(TOGETHER, ELEMENTS_EACH // self._mesh.n_elements))

        def over() -> bool:
            return self.score <= optimum or stop()

        def granted(wanted: int) -> int:
            return wanted if most is None else min(wanted, most - (self.rollouts - begun))

        turn = 0
        while not over() and granted(1) > 0:
            self._stalled = STALLED if turn == 0 else STALLED_LATER
            rounds = (ROUNDS if turn == 0 else ROUNDS_LATER) // together
            for i in range(rounds):
                if not over() and (count := granted(together)) > 0:
                    divide = divides and i == 1 and turn % 2 == 0
                    self._round(self._start, count, stop, divide)
            turn += 1
            before, tried = self.score, 0
            while self.states and tried < CONTINUED_STATES and not over():
                self._go_on(self._least_tried(self.states), granted, stop)
                before, tried = self.score, 0 if self.score < before else tried + 1
            if self.states and turn % ANNEALED_EVERY == 0 and not over():
                self._anneal(stop)
            for begin in [*self._any_lowest(), self._start]:
                free = max(2, min(MOST_FREE, FREE_WORK // begin.elements))
                if not over() and (count := granted(free)) > 0:
                    self._free(begin, count, stop)

    def _any_lowest(self) -> list[DrawnState]:
        """One of the states of the lowest s, if there is any."""
        lowest = self.lowest
        return [lowest[int(self._rng.integers(len(lowest)))]] if lowest else []

    def _note(self, state: DrawnState) -> None:
        """Add a state to those found."""
        self.states = sorted([*self.states, state], key=lambda one: one.rank)
        self.states = [one for one in self.states if one.score <= self.score + ABOVE][:KEPT]

    def _begun(self, state: DrawnState, divide: bool) -> tuple[HalfEdgeMesh, Operations]:
        """The mesh of a state, its strips cut in two if `divide`, and the operations up to it."""
        mesh = state.mesh(self._mesh)
        return mesh, state.operations + (divide_chords(mesh) if divide else [])

    def _round(
        self, begin: DrawnState, count: int, stop: Callable[[], bool], divide: bool = False
    ) -> list[DrawnState]:
        """So many guarded rollouts from a state, or from what its strips cut in two make of it.

        Returns the states of lower s, which are noted.
        """
        mesh, before = self._begun(begin, divide)
        batch = GuardedRollouts(
            mesh, self._policy, self._rng, count, self._max_steps,
            max(self._ceiling, mesh.n_elements), self._stalled,
        )  # fmt: skip
        batch.run(stop)
        self.rollouts += count
        lower = [
            replace(state, operations=before + state.operations)
            for state in batch.found
            if state.score < begin.score
        ]
        for state in lower:
            self._note(state)
        return lower

    def _go_on(
        self, state: DrawnState, granted: Callable[[int], int], stop: Callable[[], bool]
    ) -> None:
        """A leap from a state, and at the first try guarded rollouts from it as it is and divided,
        until one of them leads on.
        """
        divides = divisible(state.elements)
        divide_first = state.elements < SMALL
        if self._leap(state, stop, divides and (state.tries % 2 == 1) == divide_first):
            return
        if state.tries > 1:
            return
        for divide in (False, True) if divides else (False,):
            if granted(1) <= 0 or stop() or self._round(state, 1, stop, divide):
                return

    def gather(self, stop: Callable[[], bool]) -> None:
        """Look for further states of the lowest s until `stop`, by guarded rollouts from the start
        and by what leads on from states above.
        """
        while self._start.score > self.score and len(self.lowest) < MOST_GATHERED and not stop():
            self._round(self._start, 1, stop)
            above = [state for state in self.states if state.score > self.score]
            if above and not stop():
                self._go_on(self._least_tried(above), lambda wanted: wanted, stop)

    def another(self, stop: Callable[[], bool]) -> DrawnState | None:
        """A further state of the lowest s, if a guarded rollout from the start reaches one."""
        reached = self._round(self._start, 1, stop)
        return next((state for state in reached if state.score == self.score), None)

    @staticmethod
    def _least_tried(states: list[DrawnState]) -> DrawnState:
        """The state from which something was tried least often, which is counted; a state of an s
        higher by two counts as tried once more. Of several the largest one has the most room.
        """
        state = min(states, key=lambda one: (one.score // 2 + one.tries, -one.elements))
        state.tries += 1
        return state

    def _leap(self, state: DrawnState, stop: Callable[[], bool], divide: bool) -> bool:
        """Leap from a state, or from what its strips cut in two make of it, to lower s; returns
        whether a leap was found.
        """
        mesh, before = self._begun(state, divide)
        ceiling = max(self._ceiling, int(GROWTH * mesh.n_elements))
        found = leap(mesh, self._policy, self._rng, stop, ceiling)
        if found is None:
            return False
        operations, arrays = found
        self._note(self._thinned(DrawnState.of(before + operations, arrays), stop))
        return True

    def _anneal(self, stop: Callable[[], bool]) -> None:
        """Anneal from a state, to s* or else to any lower s, and divide what that leads to."""
        small = [state for state in self.states if state.elements <= LARGEST_ANNEALED]
        if not small:
            return
        state = self._least_tried(small)
        before = state.mesh(self._mesh)
        for goal in sorted({self._mesh.optimum, state.score - 1}):
            ways = ways_down(before, goal, self._rng, stop)
            drawn = self._first_drawn(
                [(replayed(before, way), state.operations + way) for way in ways], ANNEALED_DRAWN,
                1, stop,
            )  # fmt: skip
            if drawn is not None:
                self._note(self._thinned(drawn, stop))
                return

    def _thinned(self, state: DrawnState, stop: Callable[[], bool]) -> DrawnState:
        """The state thinned out, if it has become larger than the start."""
        if state.elements <= self._mesh.n_elements:
            return state
        arrays, made = copied(state.arrays), list(state.operations)
        arrays.counters[JOURNALLING] = 0
        trial, rails = copied(arrays), rails_of(self._mesh, len(arrays.vertex))
        active = np.zeros(len(arrays.points), np.bool_)
        log = np.zeros((_SLICE, 2), np.int32)
        count = len(log)
        while count == len(log) and not stop():
            count = thin_out(arrays, trial, rails, thinning_effort(), active, log, self._rng)
            made += [(NAMES[code], h) for code, h in log[:count].tolist()]
        return DrawnState.of(made, arrays)

    def _first_drawn(
        self,
        reached: list[tuple[HalfEdgeMesh, Operations]],
        most: int,
        attempts: int,
        stop: Callable[[], bool],
    ) -> DrawnState | None:
        """The first of some states, with what leads to them, that can be drawn divided.

        Positions take long: of those whose degrees permit any at most so many are tried.
        """
        usable = partial(drawable, angle=corner_angles(self._mesh))
        for after, operations in [pair for pair in reached if usable(pair[0])][:most]:
            if stop():
                break
            collapses = collapse_chords(after, COARSE, self._rng, usable)
            divisions, drawn = drawn_divided(after, stop, attempts)
            if drawn:
                return DrawnState.of(operations + collapses + divisions, after.arrays)
        return None

    def _free(self, begin: DrawnState, count: int, stop: Callable[[], bool]) -> None:
        """So many free rollouts from a state. The first that is at s* and can be drawn becomes the
        best; the coarsest few are tried.
        """
        mesh = begin.mesh(self._mesh)
        batch = RolloutBatch(mesh, self._policy, self._max_steps, self._mesh.optimum)
        Worker(batch, int(self._rng.integers(1 << 31)), stop).roll(count)
        self.rollouts += count
        for most, attempts in FREE_DRAWN:
            reached = [
                (replayed(mesh, one.operations), begin.operations + one.operations)
                for one in batch.found
            ]
            reached.sort(key=lambda pair: pair[0].n_elements)
            drawn = self._first_drawn(reached, most, attempts, stop)
            if drawn is not None:
                self._note(self._thinned(drawn, stop))
                return
