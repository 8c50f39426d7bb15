"""One row of the paper's tables: the policy and, on request, the baselines and the solver."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from meshwright_agent.evaluation import paper_results
from meshwright_agent.evaluation.baselines import MOMENTS, baselines, race, share_within
from meshwright_agent.evaluation.rollouts import Rollouts, roll_out, summary, unseen
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search.coarsening import coarsen, replayed
from meshwright_agent.search.shortening import shorten
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import Operation

ProgressCallback = Callable[[str, int], None]
"""Called as ``progress(what is measured, meshes done)``."""


@dataclass(frozen=True)
class RowSettings:
    """What is measured for a row."""

    meshes: int = 100
    rollouts: int = 10
    seed: int = 0
    baselines: bool = False
    """Whether the baselines without learning are run too, for the time of the rollouts."""
    race: float | None = None
    """Time limit in seconds per mesh for comparing the time to the optimum; None: not compared."""
    polish: float | None = None
    """Seconds per mesh for shortening the best rollout, and for coarsening it; None: not done."""


@dataclass
class RowResult:
    """The measurements of one row."""

    sides: tuple[int, int]
    numbers: dict[str, Any]
    """The statistics, as plain values."""
    meshes: list[HalfEdgeMesh]
    """The start meshes, without those that start at their optimum."""
    rolled: Rollouts
    times: dict[str, np.ndarray] = field(default_factory=dict)
    """For each method of the time comparison the seconds (M,) until s*."""


def assess(
    policy: Policy,
    sides: tuple[int, int],
    settings: RowSettings,
    progress: ProgressCallback | None = None,
) -> RowResult:
    """Measure one row for polygons with so many sides (a closed range).

    The numbers are those of :func:`meshwright_agent.evaluation.rollouts.evaluate`, the paper's, and
    those that `settings` requires.
    """
    report = progress or (lambda what, done: None)
    meshes = unseen(policy.kind, sides, settings.meshes, settings.seed)

    def on_rollout(done: int) -> None:
        report("rollouts", done * settings.meshes // settings.rollouts)

    # the first call loads or compiles kernels, which must not be measured
    roll_out(policy, meshes[:1], 1, settings.seed)
    began = time.perf_counter()
    rolled = roll_out(policy, meshes, settings.rollouts, settings.seed, on_rollout)
    seconds = time.perf_counter() - began
    numbers: dict[str, Any] = {
        "sides": list(sides),
        **summary(rolled),
        "started_at_optimum": settings.meshes - len(meshes),
        "seconds": seconds,
        "seconds_per_mesh": seconds / len(meshes),
        "paper": _paper(policy.kind, sides),
    }
    found = RowResult(sides, numbers, meshes, rolled)
    if settings.baselines:
        numbers["baselines"] = baselines(
            meshes, policy, numbers["seconds_per_mesh"], settings.seed, report
        )
    if settings.race is not None:
        found.times = race(meshes, policy, settings.race, settings.seed, report)
        numbers["race"] = {
            method: {
                f"{moment * settings.race:g}": share_within(times, moment * settings.race)
                for moment in MOMENTS
            }
            for method, times in found.times.items()
        }
    if settings.polish is not None:
        numbers["polished"] = polished(
            policy, meshes, rolled, settings.polish, settings.seed, report
        )
    return found


def _paper(kind: str, sides: tuple[int, int]) -> dict[str, float] | None:
    """The paper's numbers for this row, None if it has no such row."""
    row = paper_results.row(kind, sides)
    if row is None:
        return None
    found = {"best_mean": row.best.mean, "best_std": row.best.deviation}
    if row.single is not None:
        found |= {"single_mean": row.single.mean, "single_std": row.single.deviation}
    return found


def polished(
    policy: Policy,
    meshes: list[HalfEdgeMesh],
    rolled: Rollouts,
    seconds: float,
    seed: int,
    progress: ProgressCallback,
) -> dict[str, float]:
    """Operations and elements of the best rollouts that reach s*, shortened and coarsened.

    Medians of `operations` and of `decisions`, which leave out the automatic clean-ups, and the
    mean of `elements` relative to the start: after shortening for at most `seconds`, and, with the
    prefix `coarse_`, after coarsening for as long and shortening again. NaN where no rollout
    reached s*.
    """
    rows = []
    best = rolled.best()
    for i, mesh in enumerate(meshes):
        if rolled.gaps[i, best[i]] > 0:
            continue
        steps = rolled.steps(policy.task, mesh, i, int(best[i]))
        short = shorten(mesh, [one for step in steps for one in step], seconds=seconds)
        ended = replayed(mesh, short)
        added = coarsen(ended, seconds=seconds, seed=seed + i)
        coarse = shorten(mesh, short + added, seconds=seconds) if added else short
        rows.append([*_measured(mesh, short), *_measured(mesh, coarse)])
        progress("polish", i + 1)
    table = np.array(rows, float).reshape(-1, 6)
    names = ("operations", "decisions", "elements")
    found: dict[str, float] = {"meshes": len(rows)}
    for column, name in enumerate([*names, *(f"coarse_{name}" for name in names)]):
        mean = name.endswith("elements")
        values = table[:, column] if rows else np.array([np.nan])
        found[f"{name}_{'mean' if mean else 'median'}"] = float(
            values.mean() if mean else np.median(values)
        )
    return found


def _measured(mesh: HalfEdgeMesh, operations: list[Any]) -> tuple[int, int, float]:
    """Number of operations, of those that are not clean-ups, and elements relative to the start."""
    decisions = sum(operation != Operation.CLEANUP for operation, _ in operations)
    return len(operations), decisions, replayed(mesh, operations).n_elements / mesh.n_elements
