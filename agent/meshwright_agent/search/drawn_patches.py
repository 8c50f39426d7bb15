"""Patch-wise improvement of a large mesh that can be drawn at every moment.

The time is divided into slices of :func:`meshwright_agent.search.patchwise.improve_large`. After
each of them the changed vertices are smoothed. Where an element stays inverted, the operations are
taken back to a state without one, the elements around it are left as they are from then on, and the
next slice is shorter.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search.annealing import Operations
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.patchwise import LargeRun, improve_large
from meshwright_agent.search.solution import unfold_changed
from meshwright_core.analysis.submesh import temporarily_locked
from meshwright_core.geometry.quality import inverted
from meshwright_core.geometry.size_field import element_sizes
from meshwright_core.mesh import HalfEdgeMesh

BARRED = 4.0
"""Distance from a bad element, in sizes of elements, within which nothing is changed next time."""
HALVINGS = 3
"""How often the operations of a slice are halved to find those that can be drawn."""
SHORTEST = 0.1
"""Seconds that a slice has at least."""
OVERHEAD = 2.0
"""How many times as long as the smoothing after it a slice should be."""
UNITS = 25.0
"""Time of smoothing a whole mesh, in units of the time to find the inverted elements."""
MOST = 10_000
"""The most slices."""
FRUITLESS = 6
"""Slices one after the other without a lower s after which the search ends."""


@dataclass
class DrawnRun:
    """The result of :func:`improve_drawn`."""

    mesh: HalfEdgeMesh
    """The result, with positions."""
    operations: Operations = field(default_factory=list)
    """Operations that lead to it from the given mesh."""
    reason: str = ""
    """Why the search ended, in words; empty where that was the time."""


def improve_drawn(
    mesh: HalfEdgeMesh,
    policy: Policy,
    *,
    slice_seconds: float | None,
    left: Callable[[], float],
    max_steps: int | None = None,
    seed: int = 0,
    progress: Callable[[int], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> DrawnRun:
    """Improve a mesh without inverted elements, which is not changed; the result has none either.

    Args:
        mesh: the start.
        policy: for meshes of the same kind.
        slice_seconds: time of a slice; None: a slice ends where nothing more is found.
        left: seconds that are left for slices and for smoothing after them.
        max_steps: largest number of decisions of the policy.
        seed: of the random choices.
        progress: called with s.
        cancelled: polled; ends a slice.
    """
    best = DrawnRun(mesh.copy())
    barred = np.zeros(0, np.int64)
    steps, fruitless = max_steps, 0
    began = time.perf_counter()
    inverted(mesh)
    smoothing = UNITS * (time.perf_counter() - began)

    def late() -> bool:
        return left() <= 0.0

    for number in range(MOST):
        seconds = slice_seconds
        if seconds is not None:
            seconds = min(max(seconds, OVERHEAD * smoothing), left() - smoothing)
        if late() or best.mesh.score == mesh.optimum or fruitless == FRUITLESS:
            break
        if seconds is not None and seconds < SHORTEST:
            break
        start = best.mesh
        allowed = np.setdiff1d(start.element_ids(), barred)
        run = improve_within(
            start, policy, allowed, seconds=seconds, max_steps=steps, seed=seed + number,
            cancelled=cancelled,
        )  # fmt: skip
        if seconds is None or run.seconds < 0.9 * seconds:
            best.reason = run.reason
        if not len(run.operations):
            break
        began = time.perf_counter()
        drawn, operations, bad = _drawn_part(start, run.steps(), run.mesh.copy(), late)
        if len(bad):
            barred = np.union1d(barred, bad)
            if slice_seconds is not None:
                slice_seconds = max(SHORTEST, slice_seconds / 2.0)
        else:
            smoothing = time.perf_counter() - began
        fruitless = 0 if drawn.score < start.score else fruitless + 1
        if drawn.score < start.score:
            best.mesh, best.operations = drawn, best.operations + operations
            barred = barred[np.isin(barred, drawn.element_ids())]
        if progress is not None:
            progress(best.mesh.score)
        if steps is not None and (steps := steps - run.decisions) <= 0:
            break
    return best


def improve_within(
    mesh: HalfEdgeMesh,
    policy: Policy,
    allowed: np.ndarray,
    *,
    seconds: float | None,
    seed: int,
    max_steps: int | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> LargeRun:
    """:func:`meshwright_agent.search.patchwise.improve_large` where only the elements `allowed`
    (n,) may change.

    Its mesh is replayed from the operations, so that the slots of what is new, also later, are
    those of a replay of all operations from the first on.
    """
    trial = mesh.copy()
    rim, within = np.zeros(0, np.int64), None
    if len(allowed) < mesh.n_elements:
        barred = np.setdiff1d(mesh.element_ids(), allowed)
        rim, within = np.intersect1d(mesh.corners(allowed), mesh.corners(barred)), allowed
    with temporarily_locked(trial, rim):
        run = improve_large(
            trial, policy, seconds=seconds, max_steps=max_steps, seed=seed, within=within,
            cancelled=cancelled,
        )  # fmt: skip
    return replace(run, mesh=replayed(mesh, run.steps()))


def near(mesh: HalfEdgeMesh, reached: HalfEdgeMesh, bad: np.ndarray) -> np.ndarray:
    """Ids of the elements of a mesh near the elements `bad` of what has become of it."""
    from scipy.spatial import cKDTree  # here: it takes a quarter of a second

    centres = reached.points[reached.corners(bad)].mean(axis=1)
    own = mesh.points[mesh.elements()].mean(axis=1)
    away, _ = cKDTree(centres).query(own)
    found: np.ndarray = mesh.element_ids()[away < BARRED * element_sizes(mesh)]
    return found


def _drawn_part(
    mesh: HalfEdgeMesh, operations: Operations, reached: HalfEdgeMesh, late: Callable[[], bool]
) -> tuple[HalfEdgeMesh, Operations, np.ndarray]:
    """Where as many of the operations lead, from the first on, as leave no element inverted; these;
    and the elements of `mesh` near those that all of them leave inverted.

    reached: where all of them lead to; it gets other positions.
    """
    unfold_changed(mesh, reached, late)
    folded = inverted(reached)
    if not len(folded):
        return reached, operations, folded
    bad = near(mesh, reached, folded)
    low, high, best = 0, len(operations), mesh
    for _ in range(HALVINGS):
        if high - low < 2 or late():
            break
        middle = (low + high) // 2
        trial = replayed(mesh, operations[:middle])
        unfold_changed(mesh, trial, late)
        if len(inverted(trial)):
            high = middle
        else:
            low, best = middle, trial
    return best, operations[:low], bad
