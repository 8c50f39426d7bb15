"""Search among quad layouts of equal s for good shapes with few blocks.

A pool of layouts, made by coarsening what rollouts have found under a guard
(:mod:`meshwright_agent.search.guarded_coarsening`), is improved by local search: one of them is
kicked, coarsened again, and takes the place of its parent unless it is worse. What is better, and
by how much the shape counts, follows from :class:`Preference`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from meshwright_agent.search.annealing import Operations
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.guarded_coarsening import EVALUATED, Aims, Coarsener, Layout
from meshwright_core.geometry.shape_bound import attainable_bound, shape_bound
from meshwright_core.geometry.smoothing import relax
from meshwright_core.geometry.weighed_shapes import weighed_worst
from meshwright_core.mesh import HalfEdgeMesh

LAYOUTS = 800
"""Elements up to which the layouts of a mesh are searched; positioning more takes too long."""
PREFERENCES = ("blocks", "balanced", "shape")
USABLE = 0.5
"""Worst scaled Jacobian that a balanced answer has before the number of blocks counts..."""
CLOSE, COMFORT = 0.9, 0.85
"""... or this share of the best that is attainable; and the share of the larger of that and q* up
to which more is worth more blocks."""
PRICE = 7.0
"""Each tenth of the bound is worth exp(0.7) in
:func:`meshwright_agent.search.guarded_coarsening.cost`, about twice the blocks. With a little more
a round hole in a square would get eight blocks, not its ring of four."""
LEAST = 0.05
"""The least target: a corner below it is as good as folded."""
SLACK = 3e-3
"""How far below the bound a target stays: maximising comes close to it, not to the last digit."""
POOL = 3
"""Layouts that are kicked in turn."""
FIRST = 0.6
"""Probability of kicking the best of them; each next one with the same share of the rest."""
JUMPS = 7
"""The most random operations of a kick."""
AT_WORST = 0.7
"""Probability that a kick of a layout below the target begins near its worst corner."""
POOR, MANY = 0.32, 50
"""Worst sine up to which, and elements from which, strips at the worst element are cut in two where
sides bend: smaller layouts are better helped by kicks, as long as they help."""
DIVISIONS = 0.2
"""Probability of doing so instead of a kick."""
WORTH = 0.9
"""Share of the worst sine of a layout below the target that a kick has to leave: what is worse is
seldom made good by coarsening, which takes most of the time."""
PROPOSALS = 200
"""The most proposals of a kick, relative to the number of elements."""
STALE, STALE_ABOVE, STALE_BENT = 400, 50, 120
"""Kicks without an improvement after which other starts are asked for: below the target; where s*
is not reached and all sides are straight, so that many layouts can be drawn; where sides bend."""
PATIENCE = 4000
"""Kicks without an improvement after which the search gives up, once the target is reached."""


@dataclass(frozen=True)
class Preference:
    """What counts besides s."""

    prefer: str = "balanced"
    """"blocks": as few as possible, whatever their shape, but none inverted; "shape": the best
    worst corner, whatever the number; "balanced": a good worst corner, then few blocks."""
    min_shape: float | None = None
    """Worst scaled Jacobian beyond which more does not count, in place of that of `prefer`."""
    price: float = PRICE
    """How much a better worst corner is worth in blocks, see :data:`PRICE`."""

    def __post_init__(self) -> None:
        """Raise ValueError for an unknown word, or a shape beyond 0 to 1."""
        if self.prefer not in PREFERENCES:
            raise ValueError(f'prefer must be one of {PREFERENCES}, not "{self.prefer}"')
        if self.min_shape is not None and not 0.0 <= self.min_shape <= 1.0:
            raise ValueError(f"min_shape must lie between 0 and 1, not {self.min_shape}")

    def aims(self, attainable: float, bound: float) -> Aims:
        """What is aimed at where `attainable` is the best worst scaled Jacobian, `bound` is q*."""
        most = max(attainable - SLACK, LEAST)
        if self.min_shape is not None:
            target = comfort = max(min(self.min_shape, most), LEAST)
        elif self.prefer == "balanced":
            target = max(min(USABLE, CLOSE * attainable), LEAST)
            comfort = max(min(COMFORT * max(attainable, bound), most), target)
        else:
            target = comfort = LEAST if self.prefer == "blocks" else most
        price = self.price / max(bound, LEAST) if self.prefer == "balanced" else 0.0
        return Aims(target, comfort, price, self.prefer != "blocks")


def has_layouts(mesh: HalfEdgeMesh) -> bool:
    """Whether the layouts of a mesh are searched: quads in the plane z = 0, not too many."""
    plane = mesh.kind == "quad" and not mesh.points[mesh.vertices(), 2].any()
    return plane and mesh.n_elements <= LAYOUTS


FEW = Aims(0.1, 0.1, 0.0, False)
"""Aims for few blocks, whatever their shape."""


class LayoutSearch:
    """The pool of one thread.

    Args:
        mesh: the start, plane, of quads.
        preference: what counts.
        seed: of all random choices.
        floor: least number of elements.
        room: elements that added layouts may have, if that is more than twice those of the start.
        found: called with each layout that is better than all before it.
    """

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        preference: Preference,
        seed: int = 0,
        floor: int = 1,
        room: int = 0,
        found: Callable[[Layout], None] | None = None,
    ) -> None:
        """Prepare the arrays; the pool is empty."""
        self._mesh, self.optimum, self._found = mesh, mesh.optimum, found
        self.aims = preference.aims(attainable_bound(mesh), shape_bound(mesh))
        self.coarsener = Coarsener(mesh, self.aims, seed, floor, room=room)
        self.pool: list[Layout] = []
        self.best: Layout | None = None
        self.kicks = self.idle = self._served = 0
        self.layouts = self.evaluated = 0
        """What kicks have led to, and moves of coarsening whose positions were found."""

    @property
    def goal_reached(self) -> bool:
        """Whether the best layout has the target shape, at s*."""
        best = self.best
        return best is not None and best.key[1] >= self.aims.target and best.key[0] <= self.optimum

    @property
    def exhausted(self) -> bool:
        """Whether the target is reached and nothing better was found for long."""
        return self.idle >= PATIENCE and self.goal_reached

    @property
    def needs_layouts(self) -> bool:
        """Whether other starts are called for, as nothing has come of kicks lately."""
        return not self.goal_reached and self._stale > self._served

    @property
    def _stale(self) -> int:
        """How often other starts should have been asked for since the best layout was found."""
        if self.coarsener.bends:
            return self.idle // STALE_BENT
        low = self.best is not None and self.best.key[0] <= self.optimum
        return self.idle // (STALE if low else STALE_ABOVE)

    def valid_at(self, score: int) -> bool:
        """Whether the best layout has no inverted element and this s."""
        return self.best is not None and self.best.key[1] > 0.0 and self.best.key[0] <= score

    def add(
        self,
        operations: Operations,
        coarsen: bool,
        stop: Callable[[], bool],
        placed: HalfEdgeMesh | None = None,
        unfold: bool = True,
    ) -> None:
        """Add the layout that operations lead to, coarsened unless `stop` comes first.

        placed: the same state of the mesh, with valid positions. unfold: whether it is smoothed and
        untangled where it is folded and no positions are given, which may take seconds.
        """
        self._served = self._stale
        layout = self.coarsener.layout(operations, placed=placed)
        if not layout.key[1] and placed is None and unfold and not (self.pool and stop()):
            reached = replayed(self._mesh, operations)
            if not len(relax(reached)):
                placed = reached
                self.coarsener.place(layout, placed)
                self.coarsener.judge(layout)
        if not layout.key[1] and placed is not None:
            # raising the corners has folded a quad along a curve: keep what is valid
            self.coarsener.place(layout, placed)
            layout.key[1] = max(weighed_worst(placed), 1e-3)
        if not (coarsen and layout.key[1]):
            self._insert(layout)
            return
        if self.coarsener.bends:
            # below the target nothing is coarsened that has good corners, but positions take long
            # where sides bend: a layout of few blocks is improved much faster
            few = layout.copy()
            self._coarsen(few, stop, FEW)
            kept = few.copy()
            self.coarsener.judge(few)
            if few.key[1] < kept.key[1]:
                # raising the corners has folded a quad along a curve
                few = kept
            self._insert(few)
            divided = few.copy()
            if self._divide(divided, stop):
                self._coarsen(divided, stop)
                self._insert(divided)
                if not self._is_poor(divided):
                    return
        self._coarsen(layout, stop)
        self._insert(layout)

    def _insert(self, layout: Layout) -> None:
        """Put a layout into the pool, the best first."""
        self._note(layout)
        place = 0
        while place < len(self.pool) and not self.coarsener.better(layout, self.pool[place]):
            place += 1
        self.pool.insert(place, layout)
        del self.pool[POOL:]

    def _note(self, layout: Layout) -> None:
        if self.best is None or self.coarsener.better(layout, self.best):
            self.best, self.idle, self._served = layout, 0, 0
            if self._found is not None:
                self._found(layout)

    def _coarsen(self, layout: Layout, stop: Callable[[], bool], aims: Aims | None = None) -> None:
        before = int(layout.record.state[EVALUATED])
        self.coarsener.coarsen(layout, stop, aims)
        self.evaluated += int(layout.record.state[EVALUATED]) - before

    def _divide(self, layout: Layout, stop: Callable[[], bool]) -> bool:
        """Cut strips at its worst elements in two, in place, as long as the layout is poor and that
        helps; returns whether one was.
        """
        before = int(layout.record.state[EVALUATED])
        divided = False
        while self._is_poor(layout) and layout.key[3] < LAYOUTS and not stop():
            if not self.coarsener.divided(layout, stop):
                break
            divided = True
        self.evaluated += int(layout.record.state[EVALUATED]) - before
        return divided

    def _finer(self, parent: Layout, stop: Callable[[], bool]) -> Layout | None:
        """A divided copy; None where no division helps, which is kept in mind."""
        child = parent.copy()
        if self._divide(child, stop):
            return child
        parent.finest = not stop()
        return None

    def _is_poor(self, layout: Layout) -> bool:
        """Whether the layout, without inverted elements, is to be improved by dividing strips."""
        if not self.coarsener.bends or layout.key[1] >= min(POOR, self.aims.target):
            return False
        return bool(layout.key[1] > 0.0) and (layout.key[3] >= MANY or self.idle >= STALE_BENT)

    def kick(self, stop: Callable[[], bool]) -> None:
        """Kick one layout of the pool and coarsen it; it stays unless it is worse."""
        rng, coarsener = self.coarsener.rng, self.coarsener
        i = min(int(rng.geometric(FIRST)) - 1, len(self.pool) - 1)
        parent = self.pool[i]
        jumps = 1 + int(rng.integers(JUMPS))
        # degrees that forbid the target are not worth positioning, unless nothing better is known
        comfort = self.aims.comfort
        bound = comfort if rng.random() < 0.5 else min(self.aims.target, float(parent.key[1]))
        self.kicks += 1
        self.idle += 1
        score = int(parent.key[0])
        if score > self.optimum and rng.random() < 0.7:
            score = self.optimum
        at_worst = parent.key[1] < comfort and rng.random() < AT_WORST
        if self._is_poor(parent) and not parent.finest and rng.random() < DIVISIONS:
            child = self._finer(parent, stop)
        else:
            child = coarsener.kicked(
                parent, jumps, score, bound, PROPOSALS * int(parent.key[3]), at_worst
            )
        if child is None:
            return
        self.layouts += 1
        if parent.key[1] < self.aims.target and child.key[1] < WORTH * parent.key[1]:
            return
        self._coarsen(child, stop)
        if not coarsener.better(parent, child):
            self.pool[i] = child
            self._note(child)

    def run(self, stop: Callable[[], bool], kicks: int | None = None) -> None:
        """Kick until `stop`, for so many `kicks`, or until nothing has come of it for long."""
        last = None if kicks is None else self.kicks + kicks
        while self.pool and not stop() and (last is None or self.kicks < last):
            if self.exhausted:
                break
            self.kick(stop)
