"""Coarser quad meshes at the same s: towards the coarsest block decomposition.

Annealing with a price on elements and with the collapse of strips, which never raises s, among the
operations. A state counts as better only if s is no higher than at the start, and if it can be
drawn at least as well: it has no more obstacles, nor, smoothed, more inverted elements. Where a
mesh cannot be drawn, states that can be come first, however many elements they have, and it grows
no coarser before.
"""

from __future__ import annotations

import time
from collections.abc import Callable

from meshwright_agent.search.annealing import (
    BEST_ELEMENTS,
    BEST_LENGTH,
    BEST_SCORE,
    PROPOSALS,
    SLICE,
    Annealer,
    Operations,
    copy_mesh,
)
from meshwright_core.analysis.drawability import Obstacles
from meshwright_core.core.arrays import ELEMENT_SLOTS, ELEMENTS, MeshArrays
from meshwright_core.geometry import smoothing
from meshwright_core.mesh import HalfEdgeMesh

DRAWN = 20_000
"""Elements above which no mesh is drawn between two operations: it would take seconds."""
TEMPERATURES = (0.5, 0.25)
"""Of a sweep, see :mod:`meshwright_agent.search.annealing`."""
PRICE = 0.4
"""Of an element, in units of s."""
WEIGHTS = (0.27, 0.27, 0.12, 0.24, 0.04, 0.06)
"""How often each operation is proposed; the last is the collapse of a strip."""
APART = 512
"""Proposals between a state that was rejected and the next that is looked at."""
AFRESH = 0.2
"""Probability that a state that was found is followed by a new sweep, down to another floor."""
SWEEP = 300
"""Proposals of a sweep, relative to the number of elements."""


def undrawable(mesh: HalfEdgeMesh, operations: Operations) -> int:
    """Elements that stay inverted when the operations are done and the mesh is smoothed; 0 is said
    of meshes too large to be drawn.
    """
    if mesh.n_elements > DRAWN:
        return 0
    return len(smoothing.relax(replayed(mesh, operations)))


def replayed(mesh: HalfEdgeMesh, operations: Operations) -> HalfEdgeMesh:
    """A copy of the mesh on which the operations are done."""
    reached = mesh.copy()
    for operation, h in operations:
        reached.apply(operation, h)
    return reached


def coarsen(
    mesh: HalfEdgeMesh,
    *,
    seconds: float | None = 1.0,
    proposals: int | None = None,
    seed: int = 0,
    floor: int = 1,
    cancelled: Callable[[], bool] | None = None,
) -> Operations:
    """Operations from a quad mesh, which is not changed, to one with s no higher that is drawn
    better, or as well with fewer elements; none for triangles, and where nothing is found.

    Stops after `seconds` or `proposals` (None: no such limit). floor: elements to be left at least.
    """
    began = time.perf_counter()
    if mesh.kind != "quad":
        return []
    coarser = _Coarser(mesh, seed, floor)
    left = proposals if proposals is not None else 1 << 62
    while left > 0:
        if seconds is not None and time.perf_counter() - began > seconds:
            break
        if cancelled is not None and cancelled():
            break
        before = coarser.proposals
        coarser.look(min(left, SLICE))
        left -= coarser.proposals - before
    return coarser.operations


class _Coarser:
    """One coarsening: an annealer whose discoveries are test-drawn before they count."""

    def __init__(self, mesh: HalfEdgeMesh, seed: int, floor: int) -> None:
        self._mesh, self._floor = mesh, floor
        self._annealer = Annealer(
            mesh, seed, floor=floor, temperatures=TEMPERATURES, sweep=SWEEP, price=PRICE,
            split_price=4.0 * PRICE, weights=WEIGHTS, fewer=True, goal=-1,
        )  # fmt: skip
        self._obstacles = Obstacles(mesh)
        self._flaws = self._flaws_of([])
        self._seen: set[bytes] = set()
        self.operations: Operations = []
        self._keep()

    def _flaws_of(self, operations: Operations) -> int:
        """Obstacles, and elements that stay inverted; not drawn if the former are too many."""
        if self._mesh.n_elements > DRAWN:
            return 0
        reached = replayed(self._mesh, operations)
        obstacles = self._obstacles.count(reached)
        if operations and obstacles > self._flaws:
            return obstacles
        return obstacles + len(smoothing.relax(reached))

    def _keep(self) -> None:
        self._kept = MeshArrays(*(array.copy() for array in self._annealer.best))
        if self._flaws:
            # any state with s as low is worth a look
            self._annealer.state[BEST_ELEMENTS] = self._annealer.ceiling + 1
        self._kept_state = self._annealer.state.copy()

    @property
    def proposals(self) -> int:
        """How many have been made."""
        return int(self._annealer.state[PROPOSALS])

    def look(self, proposals: int) -> None:
        """Make so many proposals, or fewer if something coarser comes up; draw that."""
        found = self._annealer.run(proposals)
        if found and not self._accept():
            self._go_back()
            # on from there for a while without a look: what comes next is much the same
            self._annealer.fewer = False
            self._annealer.run(APART)
            self._annealer.fewer = True
        if not found or self._annealer.rng.random() < AFRESH:
            # not always as far as it goes: the coarsest states can often not be drawn
            most = max(self._floor + 1, int(self._kept.counters[ELEMENTS]))
            self._annealer.floor = int(self._annealer.rng.integers(self._floor, most))
            self._annealer.restart()

    def _accept(self) -> bool:
        """Whether the state just found is new, and drawn as well as the one kept."""
        best = self._annealer.best
        slots = 4 * int(best.counters[ELEMENT_SLOTS])
        key = best.edge[:slots, 0].tobytes()
        if key in self._seen:
            return False
        self._seen.add(key)
        found = self._annealer.operations()
        flaws = self._flaws_of(found)
        if self._annealer.best_score == self._kept_state[BEST_SCORE]:
            fewer = self._annealer.best_elements < self._kept.counters[ELEMENTS]
            if flaws > self._flaws or (flaws == self._flaws and (flaws or not fewer)):
                return False
        self._flaws, self.operations = flaws, found
        self._keep()
        return True

    def _go_back(self) -> None:
        """Let the state kept be the best again; the sweep goes on from where it is."""
        copy_mesh(self._kept, self._annealer.best)
        for row in (BEST_LENGTH, BEST_SCORE, BEST_ELEMENTS):
            self._annealer.state[row] = self._kept_state[row]
