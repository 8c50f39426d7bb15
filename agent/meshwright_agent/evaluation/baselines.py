"""The policy's solver and methods that have learned nothing, on the same meshes for the same time.

All have the same operations and the same bounds on the number of elements, those of the policy's
task, and one core.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from meshwright_agent.env.task import Task
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search.annealing import anneal, greedy, random_walk
from meshwright_agent.search.solver import solve
from meshwright_core.core.score import normalised_return
from meshwright_core.mesh import HalfEdgeMesh

BASELINES = ("greedy", "plateaus", "annealing", "random walk")
"""Strict descent, which takes no time to speak of; descent that may go sideways as many times in a
row as there are elements, again and again; simulated annealing; a walk at random."""
RACERS = ("policy", "annealing", "plateaus")
"""The methods of a race, the solver with the policy first."""
MOMENTS = (0.03, 0.1, 0.3, 1.0)
"""When a race is looked at, relative to its end."""

_WARM = 0.05


@dataclass
class Attempt:
    """What one method brought on one mesh."""

    score: int
    """The lowest s."""
    seconds: float
    """Until it stopped, at the optimum or when its time was up."""


def attempt(method: str, mesh: HalfEdgeMesh, policy: Policy, seconds: float, seed: int) -> Attempt:
    """One method at work on one mesh, at most so long, and no longer than until the optimum."""
    began = time.perf_counter()
    if method == "policy":
        return _solve(mesh, policy, seconds, seed)
    if method in ("greedy", "plateaus"):
        score = _descend(mesh, policy.task, seconds if method == "plateaus" else None, seed)
    else:
        floor, ceiling = policy.task.bounds(mesh.n_elements)
        search = {"annealing": anneal, "random walk": random_walk}[method]
        score = search(
            mesh, seconds=seconds, seed=seed, extended=policy.task.extended, floor=floor,
            ceiling=ceiling,
        )[1]  # fmt: skip
    return Attempt(score, time.perf_counter() - began)


def _solve(mesh: HalfEdgeMesh, policy: Policy, seconds: float, seed: int) -> Attempt:
    """The solver, stopped at the first state at the optimum."""
    began = time.perf_counter()
    reached: list[float] = []

    def on_progress(done: int, score: int) -> None:
        if score == mesh.optimum:
            reached.append(time.perf_counter() - began)

    found = solve(
        mesh, policy, seconds=seconds, seed=seed, coarsen=False, shorten=False,
        progress=on_progress, cancelled=lambda: bool(reached),
    )  # fmt: skip
    return Attempt(found.score, reached[0] if reached else found.seconds)


def _descend(mesh: HalfEdgeMesh, task: Task, seconds: float | None, seed: int) -> int:
    """The best of as many descents with sideways steps as there is time for; None: one strict
    descent.
    """
    end = time.perf_counter() + (seconds or 0.0)
    floor, ceiling = task.bounds(mesh.n_elements)
    best = mesh.score
    while True:
        found = greedy(
            mesh, seed=seed, plateau=mesh.n_elements if seconds else 0, extended=task.extended,
            floor=floor, ceiling=ceiling,
            cancelled=lambda: seconds is not None and time.perf_counter() > end,
        )  # fmt: skip
        best = min(best, found[1])
        if seconds is None or best == mesh.optimum or time.perf_counter() > end:
            return best
        seed += 7919


def baselines(
    meshes: Sequence[HalfEdgeMesh],
    policy: Policy,
    seconds: float,
    seed: int,
    progress: Callable[[str, int], None] | None = None,
) -> dict[str, dict[str, float]]:
    """For each of BASELINES mean and standard deviation of the normalised return, the share at s*
    and the mean seconds a mesh, at most `seconds`. Every mesh must start above its optimum.
    """
    rows = {}
    for method in BASELINES:
        found = _attempts(method, meshes, policy, seconds, seed, progress)
        scores = np.array([one.score for one in found])
        optima = np.array([mesh.optimum for mesh in meshes])
        returns = normalised_return(np.array([mesh.score for mesh in meshes]), scores, optima)
        rows[method.replace(" ", "_")] = {
            "mean": float(returns.mean()),
            "std": float(returns.std()),
            "at_optimum": float((scores == optima).mean()),
            "seconds": float(np.mean([one.seconds for one in found])),
        }
    return rows


def race(
    meshes: Sequence[HalfEdgeMesh],
    policy: Policy,
    seconds: float,
    seed: int,
    progress: Callable[[str, int], None] | None = None,
) -> dict[str, np.ndarray]:
    """For each of RACERS the seconds (M,) until s*, infinite where it was not reached in time."""
    times = {}
    for method in RACERS:
        found = _attempts(method, meshes, policy, seconds, seed, progress)
        times[method] = np.array(
            [
                one.seconds if one.score == mesh.optimum and one.seconds <= seconds else np.inf
                for mesh, one in zip(meshes, found, strict=True)
            ]
        )
    return times


def share_within(times: np.ndarray, seconds: float) -> float:
    """The share of meshes that a racer brought to s* within so many seconds."""
    return float((times <= seconds).mean())


def _attempts(
    method: str,
    meshes: Sequence[HalfEdgeMesh],
    policy: Policy,
    seconds: float,
    seed: int,
    progress: Callable[[str, int], None] | None,
) -> list[Attempt]:
    # what is compiled or loaded at the first use is not measured
    attempt(method, meshes[0], policy, _WARM, seed)
    found = []
    for i, mesh in enumerate(meshes):
        found.append(attempt(method, mesh, policy, seconds, seed + i))
        if progress is not None:
            progress(method, i + 1)
    return found
