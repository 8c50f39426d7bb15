"""Coarsening quad meshes at the same s, towards the coarsest block decomposition.

Simulated annealing with a price on elements; its operations include the collapse of chords, which
never raises s. A state is better if s is lower; at equal s if it has fewer flaws, that is obstacles
to drawing it and elements that stay inverted when it is smoothed; without flaws if it has fewer
elements.
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
from meshwright_core.core.arrays import ELEMENT_SLOTS, ELEMENTS, copied
from meshwright_core.geometry import smoothing
from meshwright_core.geometry.quality import inverted
from meshwright_core.mesh import HalfEdgeMesh

DRAWN = 20_000
"""Elements up to which a mesh is smoothed to count inverted elements; larger ones take seconds."""
TEMPERATURES = (0.5, 0.25)
"""At the start and the end of a sweep, see :mod:`meshwright_agent.search.annealing`."""
PRICE = 0.4
"""Price of an element, in units of s."""
WEIGHTS = (0.27, 0.27, 0.12, 0.24, 0.04, 0.06)
"""Probability of proposing each operation; the last is the collapse of a chord."""
APART = 512
"""Proposals after a rejected state before the next one is tested: close states are alike."""
AFRESH = 0.2
"""Probability of starting a new sweep with another least number of elements after a state."""
SWEEP = 300
"""Proposals in a sweep, relative to the number of elements."""
UNTANGLED = 2_000
"""Elements up to which a mesh is untangled for it too; that may take ten seconds for 5,000."""
OBSTACLE = DRAWN
"""Flaws of a mesh with obstacles, which are more than elements can be inverted."""
PATIENCE = 1000
"""Sweeps without an improvement after which :func:`coarsen` may end early. Over 40 random meshes of
4 to 85 elements, 1 found something better within 0.6 s after 400 such sweeps."""


def undrawable(mesh: HalfEdgeMesh, operations: Operations) -> int:
    """Number of elements that stay inverted when the mesh after the operations is smoothed.

    0 for meshes with more than DRAWN elements, which are not tested.
    """
    if mesh.n_elements > DRAWN:
        return 0
    return _folded(replayed(mesh, operations))


def _folded(mesh: HalfEdgeMesh) -> int:
    """Number of elements that stay inverted when a mesh is smoothed, which it is."""
    if mesh.n_elements <= UNTANGLED:
        return len(smoothing.relax(mesh))
    moved = smoothing.smooth(mesh)
    if len(moved[0]):
        mesh.move(*moved)
    return len(inverted(mesh))


def replayed(mesh: HalfEdgeMesh, operations: Operations) -> HalfEdgeMesh:
    """A copy of the mesh with the operations applied."""
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
    patience: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Operations:
    """Operations that lead from a quad mesh to a coarser one with s no higher and no more flaws.

    `mesh` is not changed. Returns [] for triangles, and if nothing better is found. Stops after
    `seconds` or `proposals`, or after `patience` sweeps without an improvement (None: no such
    limit). floor: least number of elements.
    """
    began = time.perf_counter()
    if mesh.kind != "quad":
        return []
    coarser = _Coarser(mesh, seed, floor)
    left = proposals if proposals is not None else 1 << 62
    while left > 0:
        if seconds is not None and time.perf_counter() - began > seconds:
            break
        if patience is not None and coarser.idle > patience * SWEEP * mesh.n_elements:
            break
        if cancelled is not None and cancelled():
            break
        before = coarser.proposals
        coarser.advance(min(left, SLICE))
        left -= coarser.proposals - before
    return coarser.operations


class _Coarser:
    """An annealer whose improvements are accepted only after they have been tested for flaws."""

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
        """Elements inverted after smoothing; of a mesh with obstacles these, all of them worse.

        What has obstacles is not smoothed: with curved sides that is in vain for a second or so.
        """
        if self._mesh.n_elements > DRAWN:
            return 0
        reached = replayed(self._mesh, operations)
        obstacles = self._obstacles.count(reached)
        return OBSTACLE + obstacles if obstacles else _folded(reached)

    def _keep(self) -> None:
        self._kept = copied(self._annealer.best)
        if self._flaws:
            # with flaws, any state with s as low may be better
            self._annealer.state[BEST_ELEMENTS] = self._annealer.ceiling + 1
        self._kept_state = self._annealer.state.copy()

    @property
    def idle(self) -> int:
        """Number of proposals since the last improvement."""
        return self.proposals - int(self._kept_state[PROPOSALS])

    @property
    def proposals(self) -> int:
        """Number of proposals so far."""
        return int(self._annealer.state[PROPOSALS])

    def advance(self, proposals: int) -> None:
        """Make up to `proposals` proposals, stopping at a coarser state, and test that."""
        found = self._annealer.run(proposals)
        if found and not self._accept():
            self._reset_best()
            # the next states are much like the rejected one: continue without testing them
            self._annealer.fewer = False
            self._annealer.run(APART)
            self._annealer.fewer = True
        if not found or self._annealer.rng.random() < AFRESH:
            # the coarsest states often have flaws, so the floor of a sweep is random
            most = max(self._floor + 1, int(self._kept.counters[ELEMENTS]))
            if self._flaws:
                # it may be too coarse already, as the start of a round part often is
                most = self._annealer.ceiling + 1
            self._annealer.floor = int(self._annealer.rng.integers(self._floor, most))
            self._annealer.restart()

    def _accept(self) -> bool:
        """Accept the annealer's best state if it is new and no worse than the one kept."""
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

    def _reset_best(self) -> None:
        """Reset the annealer's best state to the one kept; the sweep continues where it is."""
        copy_mesh(self._kept, self._annealer.best)
        for row in (BEST_LENGTH, BEST_SCORE, BEST_ELEMENTS):
            self._annealer.state[row] = self._kept_state[row]
