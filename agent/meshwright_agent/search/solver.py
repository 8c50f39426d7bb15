"""The anytime solver: rollouts of a policy and annealing, then layouts of good shape.

Better means, in this order: no inverted elements; lower s; a better worst corner, up to a target;
a smaller sum of squared irregularities; for quads, fewer elements; fewer operations. s = s* proves
that s cannot be lower (section 4.1). The result is a list of operations that can be applied to the
given mesh, and positions for the vertices after them.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial

import numpy as np

from meshwright_agent.env.task import Task
from meshwright_agent.env.vector_env import Batch
from meshwright_agent.policy.policy_files import Policy, require_kind
from meshwright_agent.search.annealing import anneal
from meshwright_agent.search.cleanup_removal import without_cleanups
from meshwright_agent.search.coarsening import coarsen as coarser
from meshwright_agent.search.coarsening import replayed, undrawable
from meshwright_agent.search.divided_layouts import FINEST, drawable
from meshwright_agent.search.drawn_patches import improve_drawn
from meshwright_agent.search.guarded_coarsening import Coarsener, Layout
from meshwright_agent.search.guarded_descent import GuardedDescent
from meshwright_agent.search.guarded_rollouts import THIN_EVERY
from meshwright_agent.search.layout_matching import matched_vertices
from meshwright_agent.search.layout_search import PRICE, LayoutSearch, Preference, has_layouts
from meshwright_agent.search.patchwise import LARGE, improve_large, is_large
from meshwright_agent.search.search_worker import (
    KEPT,
    SIDE_BY_SIDE,
    Candidate,
    RolloutBatch,
    Worker,
)
from meshwright_agent.search.shortening import shorten as shorter
from meshwright_agent.search.solution import Solution, judged
from meshwright_core.domains.gallery import shape
from meshwright_core.domains.meshing import benchmark_mesh, mesh_domain
from meshwright_core.geometry import smoothing
from meshwright_core.geometry.quality import inverted, scaled_jacobian
from meshwright_core.geometry.shape_bound import corner_angles
from meshwright_core.geometry.turning import has_bends
from meshwright_core.mesh import HalfEdgeMesh

POLISH = 0.15
"""Share of the time that is reserved for shortening."""
FINISH = 0.08
"""Share of the time that is reserved for it after a search among layouts, which are small."""
POLISHED = 0.5
"""Largest share of the time that shortening and coarsening may take."""
OPENING = 0.5
"""Share of the time after which a search for s* gives way to one among the layouts found."""
SLICES, PROPOSALS_EACH = 60, 3000
"""Slices of shortening, and proposals of coarsening relative to the number of elements, if only a
number of rollouts is given."""
KICKS_EACH = 40
"""Layouts tried for each rollout, likewise."""
SHORTENED = 4
"""States that are shortened."""
FIRST_ROLLOUTS = 8
"""Rollouts that are added when the search among layouts makes no progress."""
TRIED = 24
"""States on the way to one that cannot be drawn that are tried in its place."""

COARSEST = 0.5
"""Share of the time for the polish that coarsening without regard to shape takes where nothing
that rollouts found at s* can be drawn."""
DESCENT = 0.9
"""Share of the time after which no more guarded rollouts are made."""
DRAWN, ADDED = 2, 0.25
"""States found by guarded rollouts whose layouts are searched, at least; more are added up to this
share of the time."""
GATHERED, GATHERED_LARGE = 0.15, 0.4
"""Share of the time in which more of them are looked for once there is one at s*; and if none has
at most `COARSE_ENOUGH` elements."""
COARSE_ENOUGH = 200
PATCHING, SMOOTHING = 0.75, 0.9
"""Shares of the time after which no more patches are improved, and none smoothed, on a large
mesh: what follows takes the longer the more was done."""
PATCH_SLICE = 0.15
"""Share of the time after which the patches improved so far are smoothed."""
PER_IRREGULAR = 50
"""Steps of a rollout per irregular vertex that is left on a large mesh after the patches."""

Found = Callable[[Solution], None]
"""Called with an answer, its mesh in `reached`."""


def solve(
    mesh: HalfEdgeMesh,
    policy: Policy,
    *,
    rollouts: int | None = None,
    seconds: float | None = None,
    max_steps: int | None = None,
    seed: int = 0,
    workers: int = 1,
    coarsen: bool = True,
    shorten: bool = True,
    prefer: str = "balanced",
    min_shape: float | None = None,
    price: float = PRICE,
    progress: Callable[[int, int], None] | None = None,
    found: Found | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Solution:
    """The best state found from `mesh`, which is not changed.

    A mesh with many irregular vertices is first improved patch by patch
    (:mod:`meshwright_agent.search.patchwise`); the remaining time is used for the whole mesh. Plane
    quad meshes of up to :data:`.layout_search.LAYOUTS` elements are then searched for layouts of
    good shape with few blocks (:mod:`meshwright_agent.search.layout_search`). Ends early where
    nothing more can be won. A mesh without inverted elements never becomes one with them. With a
    number of rollouts and no time limit the result depends on the arguments alone, not on the
    machine or its load.

    Args:
        mesh: the start.
        policy: for meshes of the same kind, else PolicyError is raised.
        rollouts: number of rollouts, the best of which counts; 1 if `seconds` is not given either.
            Where nothing that they reach can be drawn, as many guarded ones are made besides.
        seconds: time limit. Without `rollouts`, rollouts alternate with annealing.
        max_steps: length of a rollout, by default that of the policy's task.
        seed: of the random choices.
        workers: number of threads, each with a seed of its own.
        coarsen: whether to look for fewer elements at equal s (quads only).
        shorten: whether to leave out operations that are not needed.
        prefer: "blocks", "balanced" or "shape", see
            :class:`meshwright_agent.search.layout_search.Preference`.
        min_shape: worst scaled Jacobian beyond which more does not count, in place of that of
            `prefer`.
        price: of a better worst corner, in blocks, see
            :class:`meshwright_agent.search.layout_search.Preference`.
        progress: called with (rollouts done, lowest s) after rollouts and whenever s falls, from
            the worker threads.
        found: called, likewise, for each state that is better than all before it and would be the
            answer if the search ended there.
        cancelled: polled; the search ends with the best result so far when it is true.
    """
    require_kind(policy, mesh.kind)
    preference = Preference(prefer, min_shape, price)
    if seconds is not None:
        prepare(policy)  # so that loading compiled code takes none of the time
    if is_large(mesh):
        go_on = partial(
            solve, rollouts=rollouts, workers=workers, coarsen=coarsen, shorten=shorten,
            prefer=prefer, min_shape=min_shape, price=price, found=found,
        )  # fmt: skip
        return _patch_by_patch(
            mesh, policy, seconds, max_steps, seed, progress, found, cancelled, go_on
        )
    search = _Search(mesh, policy, rollouts, seconds, max_steps, seed, progress, found, cancelled)
    best = search.nothing(coarsen)
    if has_layouts(mesh):
        answer = _search_layouts(search, preference, workers, coarsen, shorten)
    else:
        answer = _search_states(search, best, workers, coarsen, shorten)
    best = min(best, answer, key=lambda solution: solution.rank)
    if answer.inverted and not best.operations:
        # what was found cannot be drawn: as much of it as can be
        best = min(best, _valid_part(search, answer), key=lambda solution: solution.rank)
    best.rollouts, best.seconds = search.done, time.perf_counter() - search.began
    best.reason = best.reason or search.reason(best)
    return best


def _search_layouts(
    search: _Search, preference: Preference, workers: int, coarsen: bool, shorten: bool
) -> Solution:
    """Rollouts until s* is reached, then a search among layouts of the lowest s.

    Where sides bend, guarded rollouts come first
    (:mod:`meshwright_agent.search.guarded_rollouts`), and others only if these find nothing; where
    all are straight, guarded ones are made if nothing that they reach can be drawn.
    """
    mesh, timed = search.mesh, search.timed
    search.thorough = True
    start, bends = mesh, has_bends(mesh)
    startable = not len(inverted(mesh))
    if bends and not startable:
        start = mesh.copy()
        startable = not len(smoothing.relax(start))
    workers = max(1, workers)
    descents = [
        GuardedDescent(start, search.policy, search.max_steps, search.seed + 101 * i)
        for i in range(workers if startable and search.score > mesh.optimum else 0)
    ]
    if bends:
        share = None if search.wanted is None else search.book(search.wanted) / workers
        side_by_side(len(descents), lambda i: _descend(search, descents[i], share))
        if timed and any(descent.score == mesh.optimum for descent in descents):
            side_by_side(len(descents), lambda i: _gather(search, descents[i]))
    drawn = min((descent.score for descent in descents), default=mesh.score)
    if search.score > mesh.optimum and drawn == mesh.score:
        search.look(workers, share=OPENING)
    # without free rollouts the start is the only candidate
    candidates = search.take() if drawn == mesh.score else []
    total = 0 if not coarsen else None if timed else KICKS_EACH * search.wanted_rollouts
    room = FINEST if descents else 0
    seekers = [
        LayoutSearch(
            mesh, preference, search.seed + 7919 * i, room=room,
            found=lambda layout: search.report_layout(layout, seekers[0].coarsener),
        ) for i in range(workers)
    ]  # fmt: skip

    def stop() -> bool:
        return search.over(1.0 - FINISH)

    def run(i: int) -> None:
        seeker = seekers[i]
        for number, state in enumerate(descents[i].lowest if descents else []):
            enough = number >= DRAWN and search.over(ADDED)
            if state.score == drawn and not (seeker.pool and (enough or stop())):
                seeker.add(state.operations, coarsen, stop, state.mesh(mesh))
        # every thread has all candidates where there are few, and its share of them otherwise
        mine = candidates if len(candidates) < 2 * workers else candidates[i::workers]
        for candidate in mine:
            if seeker.pool and stop():
                break
            seeker.add(candidate.operations, coarsen, stop, unfold=not startable)
        if startable and not seeker.valid_at(mesh.optimum) and mine:
            _add_coarsest(search, seeker, mine[0], coarsen, stop)
        if descents and not bends and not seeker.valid_at(search.score):
            _descend(search, descents[i], search.wanted)
            for state in descents[i].lowest[:DRAWN]:
                seeker.add(state.operations, coarsen, stop, state.mesh(mesh))
        if not seeker.pool:
            seeker.add([], coarsen, stop)
        while not stop():
            seeker.run(stop, 100 if total is None else total // len(seekers))
            if total is not None or not coarsen or seeker.exhausted:
                break
            if seeker.needs_layouts and bends and descents:
                further = descents[i].another(stop)
                if further is not None and further.score == drawn:
                    seeker.add(further.operations, coarsen, stop, further.mesh(mesh))
            elif seeker.needs_layouts and search.annealing:
                for candidate in search.more_rollouts(search.seed + 31 * seeker.kicks + 7919 * i):
                    seeker.add(candidate.operations, coarsen, stop)

    side_by_side(workers, run)
    first = seekers[0].coarsener
    layout = seekers[0].best
    for seeker in seekers[1:]:
        if seeker.best is not None and (layout is None or first.better(seeker.best, layout)):
            layout = seeker.best
    assert layout is not None
    operations = layout.operations()
    search.finished_early = all(seeker.exhausted for seeker in seekers) and coarsen
    if shorten:
        operations = shorter(
            mesh, operations, seconds=search.share(0.4), slices=None if timed else SLICES,
            keep_layout=True, cancelled=search.stopped,
        )  # fmt: skip
    method = candidates[0].method if candidates else "rollouts"
    if any(seeker.kicks for seeker in seekers):
        method = "layouts"
    answer = Solution(
        operations, mesh.score, mesh.optimum, 0, coarse=coarsen,
        method=method if operations else "none", aims=first.aims,
    )  # fmt: skip
    return _placed(answer, mesh, layout)


def _placed(answer: Solution, mesh: HalfEdgeMesh, layout: Layout) -> Solution:
    """The answer, whose operations lead to `layout`, with positions that begin at those of it.

    Positions found afresh are often worse, or folded. Where the vertices cannot be matched, since
    no corner has the same id, the better one of the two counts: the answer with positions found
    afresh, or the operations of the layout itself.
    """
    reached = replayed(mesh, answer.operations)
    matched = matched_vertices(layout.arrays, reached.arrays)
    if matched is not None:
        own, ids = matched
        placed = reached.copy()
        placed.move(ids, layout.arrays.points[own], layout.arrays.parameter[own])
        return judged(answer, mesh, placed=placed.arrays, reached=reached)
    found = judged(answer, mesh)
    if layout.key[1]:
        longer = replace(answer, operations=layout.operations())
        found = min(found, judged(longer, mesh, placed=layout.arrays), key=lambda one: one.rank)
    return found


def side_by_side(count: int, run: Callable[[int], None]) -> None:
    """Call `run` with 0 ... count - 1, in as many threads."""
    if count == 1:
        run(0)
    elif count:
        with ThreadPoolExecutor(count, thread_name_prefix="layouts") as pool:
            list(pool.map(run, range(count)))


def _descend(search: _Search, descent: GuardedDescent, most: float | None) -> None:
    """At most so many guarded rollouts of one thread, until s* or the end of their share of the
    time.
    """
    before = descent.rollouts
    descent.run(lambda: search.over(DESCENT), None if most is None else math.ceil(most))
    search.count(descent.rollouts - before)


def _gather(search: _Search, descent: GuardedDescent) -> None:
    """Look for further states of the lowest s: longer where all are large, since such layouts stay
    large and take long to improve.
    """

    def enough() -> bool:
        small = descent.lowest[0].elements <= COARSE_ENOUGH
        return search.over(GATHERED if small else GATHERED_LARGE)

    descent.gather(enough)


def _add_coarsest(
    search: _Search,
    seeker: LayoutSearch,
    candidate: Candidate,
    coarsen: bool,
    stop: Callable[[], bool],
) -> None:
    """Add what coarsening without regard to shape makes of a candidate, if that can be drawn.

    With few elements around a hole there is less that can fold than in a rollout's result.
    """
    reached = replayed(search.mesh, candidate.operations)
    proposals = None if search.timed else PROPOSALS_EACH * reached.n_elements
    operations = candidate.operations + coarser(
        reached, seconds=search.share(COARSEST), proposals=proposals, seed=search.seed,
        cancelled=stop,
    )  # fmt: skip
    placed = replayed(search.mesh, operations)
    if not len(smoothing.relax(placed)):
        seeker.add(operations, coarsen, stop, placed)


def _search_states(
    search: _Search, best: Solution, workers: int, coarsen: bool, shorten: bool
) -> Solution:
    """Rollouts and annealing for lower s, then shortening and, for quads, coarsening."""
    mesh, found, again = search.mesh, best, False
    while True:
        if search.score > mesh.optimum or again:
            search.look(workers, past_optimum=again)
        candidates = search.shortened() if shorten else search.take()
        for candidate in candidates:
            one = search.finished(candidate, coarsen, shorten, best)
            if found is best or one.rank < found.rank:
                found = one
                if one.rank < best.rank:
                    search.report(one)
            if found.perfect or search.over(1.0):
                break
        again = True
        if found.perfect or not search.timed or search.over(1.0 - POLISH) or search.exhausted:
            return found


def _valid_part(search: _Search, found: Solution) -> Solution:
    """The first operations of `found`, as many as leave the lowest s without inverted elements.

    Of the states on the way those with the lowest s are tried first, at most :data:`TRIED` and as
    long as there is time.
    """
    mesh, work = search.mesh, search.mesh.copy()
    states = [(mesh.score, 0)]
    for i, (operation, h) in enumerate(found.operations):
        work.apply(operation, h)
        states.append((work.score, i + 1))
    states.sort(key=lambda state: (state[0], -state[1]))
    best = replace(found, operations=[])
    for _, length in states[:: max(1, len(states) // TRIED)]:
        part = judged(replace(found, operations=found.operations[:length]), mesh, search.stopped)
        if not part.inverted:
            obstacle = f"at s = {found.score} {found.inverted} elements would stay inverted"
            return replace(part, reason=obstacle)
        if search.over(1.0):
            break
    return judged(best, mesh, search.stopped)


def _patch_by_patch(
    mesh: HalfEdgeMesh,
    policy: Policy,
    seconds: float | None,
    max_steps: int | None,
    seed: int,
    progress: Callable[[int, int], None] | None,
    found: Found | None,
    cancelled: Callable[[], bool] | None,
    go_on: Callable[..., Solution],
) -> Solution:
    """Improve a large mesh patch by patch; with few irregular vertices left continue by `go_on`."""
    began = time.perf_counter()

    def past(share: float) -> bool:
        over = seconds is not None and time.perf_counter() - began > share * seconds
        return over or (cancelled is not None and cancelled())

    def left() -> float:
        if cancelled is not None and cancelled():
            return 0.0
        used = time.perf_counter() - began
        return math.inf if seconds is None else PATCHING * seconds - used

    if len(inverted(mesh)):
        run = improve_large(
            mesh, policy, seconds=None if seconds is None else PATCHING * seconds,
            max_steps=max_steps, seed=seed, cancelled=cancelled,
            progress=None if progress is None else lambda _, score: progress(0, score),
        )  # fmt: skip
        operations, why, placed = run.steps(), run.reason, run.mesh
    else:
        drawn = improve_drawn(
            mesh, policy, slice_seconds=None if seconds is None else PATCH_SLICE * seconds,
            left=left, max_steps=max_steps, seed=seed, cancelled=cancelled,
            progress=None if progress is None else lambda score: progress(0, score),
        )  # fmt: skip
        operations, why, placed = drawn.operations, drawn.reason, drawn.mesh
        why = why or f"all {seconds or 0:g} seconds are used"
    reached = replayed(mesh, operations)
    if seconds is not None and past(PATCHING):
        why = f"all {seconds:g} seconds are used"
    best = judged(
        Solution(
            operations, reached.score, mesh.optimum, 0, rollouts=1,
            method="patches" if operations else "none", reason=why,
        ),
        mesh, lambda: past(SMOOTHING), placed=placed.arrays, reached=reached.copy(),
    )  # fmt: skip
    if found is not None:
        found(best)
    remaining = None if seconds is None else seconds - (time.perf_counter() - began)
    over = (remaining is not None and remaining <= 0.0) or (cancelled is not None and cancelled())
    if not is_large(reached) and not over:
        if max_steps is None and reached.n_elements > LARGE:
            max_steps = PER_IRREGULAR * (reached.irregular_count + 1)
        rest = go_on(
            reached, policy, seconds=remaining, max_steps=max_steps, seed=seed, progress=progress,
            cancelled=cancelled,
        )  # fmt: skip
        if rest.operations:
            rest = replace(rest, operations=operations + rest.operations, method="patches")
            best = min(best, rest, key=lambda solution: solution.rank)
    best.seconds = time.perf_counter() - began
    return best


_prepared: set[Task] = set()
"""Tasks of policies whose compiled code is loaded."""


def _warm_up(policy: Policy) -> None:
    task = policy.task
    mesh = benchmark_mesh(task.kind, 8, np.random.default_rng(0))
    operations = anneal(mesh, proposals=2000)[0]
    shorter(mesh, operations, keep_layout=True)
    coarser(mesh, proposals=500, seconds=None)
    if task.kind == "quad":
        seeker = LayoutSearch(mesh, Preference("shape"))
        seeker.add(operations, True, lambda: False)
        seeker.run(lambda: False, 8)
        found = Solution(seeker.pool[0].operations(), 0, 0, 0, coarse=True)
        assert judged(found, mesh).rank
        GuardedDescent(mesh, policy, 2 * THIN_EVERY, 0).run(lambda: False, 2)
        _warm_up_curves()
    batch = Batch(task, [mesh], 1, np.random.default_rng(0), endless=False)
    batch.step(batch.observe(), np.array([-1]))


def _warm_up_curves() -> None:
    """Kick and judge layouts whose sides bend; all else is the same as for straight sides."""
    plate = mesh_domain(shape("plate-with-round-hole"), "quad")
    drawable(plate, corner_angles(plate))
    seeker = LayoutSearch(plate, Preference())
    seeker.add([], True, lambda: False)
    seeker.run(lambda: False, 16)
    seeker.coarsener.divided(seeker.pool[0].copy(), lambda: False)
    assert not judged(Solution([], 0, 0, 0), plate).inverted


def prepare(policy: Policy) -> None:
    """Compile what a search needs, or load it, so that no search pays for it."""
    if policy.task not in _prepared:
        _warm_up(policy)
        _prepared.add(policy.task)


class _Search:
    """The state shared by all workers: time, best operations so far, number of rollouts."""

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        policy: Policy,
        rollouts: int | None,
        seconds: float | None,
        max_steps: int | None,
        seed: int,
        progress: Callable[[int, int], None] | None,
        found: Found | None,
        cancelled: Callable[[], bool] | None,
    ) -> None:
        self.began = time.perf_counter()
        self.mesh, self.policy, self.seed = mesh, policy, seed
        self.seconds, self.max_steps = seconds, max_steps
        self.annealing = rollouts is None and seconds is not None
        self.wanted = 1 if rollouts is None and seconds is None else rollouts
        self._progress, self._found, self._cancelled = progress, found, cancelled
        self._lock = threading.Lock()
        self._layout: Layout | None = None
        self.score, self.done, self._begun = mesh.score, 0, 0
        self.best = Candidate([], mesh.score, "none")
        self._candidates: list[Candidate] = []
        self._rounds = 0
        self.finished_early = False
        self.thorough = rollouts is not None

    def nothing(self, coarse: bool) -> Solution:
        """Doing nothing: the solution to beat."""
        mesh = self.mesh
        self._candidates.append(self.best)
        start = Solution([], mesh.score, mesh.optimum, 0, coarse=coarse and mesh.kind == "quad")
        return judged(start, mesh, self.stopped)

    def over(self, share: float) -> bool:
        """Whether that share of the time is used up, or the search was cancelled."""
        if self._cancelled is not None and self._cancelled():
            return True
        return self.seconds is not None and (
            time.perf_counter() - self.began > share * self.seconds
        )

    @property
    def exhausted(self) -> bool:
        """Whether the given number of rollouts has been started."""
        return self.wanted is not None and self._begun >= self.wanted

    def offer(self, candidate: Candidate) -> None:
        """Add a state to the candidates; the best few are kept, shortest first."""
        with self._lock:
            if candidate.score > self.score:
                return
            better = candidate.score < self.score
            if better:
                self._candidates.clear()
                self.score = candidate.score
            self._candidates.append(candidate)
            self._candidates.sort(key=lambda found: len(found.operations))
            del self._candidates[KEPT:]
            if better:
                self.best = candidate
        if better:
            self.count(0)

    def take(self) -> list[Candidate]:
        """Remove and return the candidates."""
        taken, self._candidates = self._candidates, []
        return taken

    def book(self, wanted: int) -> int:
        """Reserve up to `wanted` rollouts; returns how many may be started."""
        with self._lock:
            granted = wanted if self.wanted is None else min(wanted, self.wanted - self._begun)
            self._begun += max(granted, 0)
        return max(granted, 0)

    def count(self, rollouts: int) -> None:
        """Add to the number of rollouts done and report progress."""
        with self._lock:
            self.done += rollouts
            done, score = self.done, self.score
        if self._progress is not None:
            self._progress(done, score)

    def report(self, best: Solution) -> None:
        """Report an answer that is better than all before it."""
        if self._found is not None:
            self._found(best)

    def report_layout(self, layout: Layout, coarsener: Coarsener) -> None:
        """Report the best layout of a thread if it is better than those of all threads before."""
        if self._found is None:
            return
        with self._lock:
            if self._layout is not None and not coarsener.better(layout, self._layout):
                return
            self._layout = layout
            operations, (ids, *places) = layout.operations(), coarsener.positions(layout)
            reached = replayed(self.mesh, operations)
            reached.move(ids, *places)
            best = Solution(
                operations, reached.score, reached.optimum, len(inverted(reached)),
                elements=reached.n_elements, method="layouts", aims=coarsener.aims,
                worst_scaled_jacobian=float(scaled_jacobian(reached).min(initial=1.0)),
                vertices=ids, positions=places[0], parameters=places[1], reached=reached,
            )  # fmt: skip
            self._found(best)

    def look(self, workers: int, past_optimum: bool = False, share: float = 1.0 - POLISH) -> None:
        """Search until the optimum, the end of that share of the time, or the last rollout.

        past_optimum: s* is reached, but no state there can be drawn: look for one more. Without a
        time limit the rollouts are made one batch after another, each with a seed of its own, so
        that the result does not depend on the threads.
        """
        self._rounds += 1

        def stop() -> bool:
            goal = mesh.optimum
            found = bool(self._candidates) if past_optimum else self.score <= goal
            return (found and self.timed) or self.over(share)

        mesh = self.mesh
        if not self.timed:
            workers = 1
        if workers <= 1:
            Worker(self, self.seed + 104729 * self._rounds, stop).work()
            return
        with ThreadPoolExecutor(workers, thread_name_prefix="solver") as pool:
            futures = [
                pool.submit(Worker(self, self.seed + 104729 * self._rounds + i, stop).work)
                for i in range(workers)
            ]
            for future in futures:
                future.result()

    def more_rollouts(self, seed: int) -> list[Candidate]:
        """Some more rollouts from the start; those that reach the lowest s known."""
        batch = RolloutBatch(self.mesh, self.policy, self.max_steps, self.score)
        Worker(batch, seed, self.stopped).roll(FIRST_ROLLOUTS)
        self.count(FIRST_ROLLOUTS)
        return batch.found

    @property
    def timed(self) -> bool:
        """Whether there is a time limit."""
        return self.seconds is not None

    @property
    def wanted_rollouts(self) -> int:
        """The number of rollouts that was asked for, at least 1."""
        return max(1, self.wanted or 1)

    def reason(self, best: Solution) -> str:
        """Why the search ended with `best`."""
        if self._cancelled is not None and self._cancelled():
            return "cancelled"
        if self.finished_early:
            return "nothing better was found for long"
        if self.seconds is not None and self.over(1.0 - POLISH):
            return f"all {self.seconds:g} seconds are used"
        return "at the optimum" if best.perfect else "all rollouts are made"

    def shortened(self) -> list[Candidate]:
        """The best states not taken yet, with fewer operations where possible; shortest first."""
        found = []
        for left, candidate in enumerate(reversed(self.take()[:SHORTENED]), 1):
            operations = shorter(
                self.mesh, candidate.operations, seconds=self.share(0.4 / left),
                slices=None if self.timed else SLICES, cancelled=self.stopped,
            )  # fmt: skip
            found.append(replace(candidate, operations=operations))
        return sorted(found, key=lambda candidate: len(candidate.operations))

    def stopped(self) -> bool:
        """Whether the time is up, or the search was cancelled."""
        return self.over(1.0)

    def finished(
        self, candidate: Candidate, coarsen: bool, shorten: bool, best: Solution
    ) -> Solution:
        """The candidate coarsened and shortened again, within its share of the time."""
        mesh, operations = self.mesh, candidate.operations
        if mesh.kind == "quad" and (folded := undrawable(mesh, operations)):
            finer = without_cleanups(mesh, operations)
            if undrawable(mesh, finer) < folded:
                operations = finer
        if coarsen and mesh.kind == "quad" and mesh.n_elements <= SIDE_BY_SIDE:
            added = coarser(
                replayed(mesh, operations), seconds=self.share(0.7), seed=self.seed + self.done,
                proposals=None if self.timed else PROPOSALS_EACH * mesh.n_elements,
                cancelled=self.stopped,
            )  # fmt: skip
            operations = operations + added
            if added and shorten:
                operations = shorter(
                    mesh, operations, seconds=self.share(1.0),
                    slices=None if self.timed else SLICES, cancelled=self.stopped,
                )  # fmt: skip
        one = Solution(
            operations, mesh.score, mesh.optimum, 0, method=candidate.method, coarse=best.coarse
        )
        return judged(one, mesh, self.stopped)

    def share(self, share: float) -> float | None:
        """Seconds for a part of the polish: `share` of what is left for it; None: no limit."""
        if self.seconds is None:
            return None
        left = self.seconds - (time.perf_counter() - self.began)
        return max(0.0, share * min(left, POLISHED * self.seconds))
