"""All that is measured of a policy on the polygons of one row, and of its rivals there."""

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

Progress = Callable[[str, int], None]
"""Called as ``progress(what, meshes done)``."""


@dataclass(frozen=True)
class Wanted:
    """How much is to be measured."""

    meshes: int = 100
    rollouts: int = 10
    seed: int = 0
    baselines: bool = False
    """Whether methods that have learned nothing get the same time."""
    race: float | None = None
    """Seconds on each mesh for the solver and its rivals."""
    polish: float | None = None
    """Seconds on each mesh for making its solution short, and then coarse."""


@dataclass
class Assessment:
    """One row."""

    sides: tuple[int, int]
    numbers: dict[str, Any]
    """What is to be reported: plain values."""
    meshes: list[HalfEdgeMesh]
    """The polygons, without those that start at their optimum."""
    rolled: Rollouts
    times: dict[str, np.ndarray] = field(default_factory=dict)
    """Of the race: for each method the seconds until s*."""


def assess(
    policy: Policy, sides: tuple[int, int], wanted: Wanted, progress: Progress | None = None
) -> Assessment:
    """Measure one row. numbers: those of :func:`meshwright_agent.evaluation.rollouts.evaluate`, the
    paper's, and what else is wanted.
    """
    tell = progress or (lambda what, done: None)
    meshes = unseen(policy.kind, sides, wanted.meshes, wanted.seed)

    def on_rollout(done: int) -> None:
        tell("rollouts", done * wanted.meshes // wanted.rollouts)

    # what is compiled or loaded at the first use is not measured
    roll_out(policy, meshes[:1], 1, wanted.seed)
    began = time.perf_counter()
    rolled = roll_out(policy, meshes, wanted.rollouts, wanted.seed, on_rollout)
    seconds = time.perf_counter() - began
    numbers: dict[str, Any] = {
        "sides": list(sides),
        **summary(rolled),
        "started_at_optimum": wanted.meshes - len(meshes),
        "seconds": seconds,
        "seconds_per_mesh": seconds / len(meshes),
        "paper": _paper(policy.kind, sides),
    }
    found = Assessment(sides, numbers, meshes, rolled)
    if wanted.baselines:
        numbers["baselines"] = baselines(
            meshes, policy, numbers["seconds_per_mesh"], wanted.seed, tell
        )
    if wanted.race is not None:
        found.times = race(meshes, policy, wanted.race, wanted.seed, tell)
        numbers["race"] = {
            method: {
                f"{moment * wanted.race:g}": share_within(times, moment * wanted.race)
                for moment in MOMENTS
            }
            for method, times in found.times.items()
        }
    if wanted.polish is not None:
        numbers["polished"] = polished(policy, meshes, rolled, wanted.polish, wanted.seed, tell)
    return found


def _paper(kind: str, sides: tuple[int, int]) -> dict[str, float] | None:
    """The paper's numbers for this row, if it has it."""
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
    progress: Progress,
) -> dict[str, float]:
    """How short and how coarse the best rollouts become that end at s*.

    operations (all of them, and without clean-ups, which the paper's agent does not decide on) and
    elements relative to the start: after shortening for at most `seconds`; coarse: after coarsening
    for as long and shortening once more. NaN where no rollout reached s*.
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
    """Operations, those that are no clean-ups, and elements afterwards relative to the start."""
    decisions = sum(operation != Operation.CLEANUP for operation, _ in operations)
    return len(operations), decisions, replayed(mesh, operations).n_elements / mesh.n_elements
