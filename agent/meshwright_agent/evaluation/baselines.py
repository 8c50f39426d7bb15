"""Baselines without learning, compared with the policy's solver on the same meshes.

All methods use the operations and the bounds on the number of elements of the policy's task, the
same time, and one core.
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
"""Greedy descent, once; greedy descent with plateau moves, restarted until the time is up;
simulated annealing; a random walk."""
RACERS = ("policy", "annealing", "plateaus")
"""The methods whose time to the optimum is compared; "policy" is the solver with the policy."""
MOMENTS = (0.03, 0.1, 0.3, 1.0)
"""Times at which the share of solved meshes is reported, relative to the time limit."""

_WARM = 0.05  # seconds of a first attempt, which loads or compiles kernels and is not measured


@dataclass
class Attempt:
    """The result of one method on one mesh."""

    score: int
    """The lowest s."""
    seconds: float
    """Until it stopped, at the optimum or at the time limit."""


def attempt(method: str, mesh: HalfEdgeMesh, policy: Policy, seconds: float, seed: int) -> Attempt:
    """Run one method on one mesh until the optimum, for at most `seconds`.

    method: one of BASELINES or RACERS.
    """
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
    """Run the solver until the optimum, without shortening or coarsening the result."""
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
    """The lowest s of repeated greedy descents with plateau moves within `seconds`.

    With None, of a single descent without plateau moves. A descent makes at most as many plateau
    moves in a row as the mesh has elements.
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
    """Run each of BASELINES on each mesh for at most `seconds`.

    Returns for each method the mean and standard deviation of the normalised return (equation 6),
    the share of meshes at s*, and the mean seconds per mesh. Every mesh must start above s*.
    `progress(method, meshes done)` is called after each mesh.
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
    """The time to the optimum: for each of RACERS the seconds (M,) until s*, at most `seconds`.

    Infinite where s* was not reached in time.
    """
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
    """The share of meshes on which a method reached s* within so many seconds."""
    return float((times <= seconds).mean())


def _attempts(
    method: str,
    meshes: Sequence[HalfEdgeMesh],
    policy: Policy,
    seconds: float,
    seed: int,
    progress: Callable[[str, int], None] | None,
) -> list[Attempt]:
    attempt(method, meshes[0], policy, _WARM, seed)
    found = []
    for i, mesh in enumerate(meshes):
        found.append(attempt(method, mesh, policy, seconds, seed + i))
        if progress is not None:
            progress(method, i + 1)
    return found
