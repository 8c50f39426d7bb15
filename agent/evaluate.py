"""How good a policy is: rollouts on unseen polygons, as in the paper's tables (section 5)."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch

from agent.batch import Batch, start_meshes
from agent.policies import Policy, load, shipped
from agent.ppo import decide
from meshcore.mesh import HalfEdgeMesh


@dataclass
class Rollouts:
    """What K rollouts on each of M meshes brought."""

    returns: np.ndarray
    """(M, K) normalised return, best state of each run."""
    gaps: np.ndarray
    """(M, K) s - s* at the best state."""
    operations: np.ndarray
    """(M, K) operations to the best state."""


def roll_out(
    policy: Policy,
    meshes: list[HalfEdgeMesh],
    rollouts: int,
    seed: int,
    progress: Callable[[int], None] | None = None,
) -> Rollouts:
    """Run the policy so often from each mesh, all meshes side by side. Every mesh must start above
    its optimum. `progress` is called with the number of rollouts done on all meshes.
    """
    rng = np.random.default_rng(seed)
    generator = torch.Generator().manual_seed(seed)
    shape = (len(meshes), rollouts)
    result = Rollouts(np.zeros(shape), np.zeros(shape, int), np.zeros(shape, int))
    for i in range(rollouts):
        batch = Batch(policy.task, meshes, len(meshes), rng, endless=False)
        while batch.active.any():
            observation = batch.observe()
            actions = decide(policy.network, observation, generator)[0]
            batch.step(observation, actions)
        result.gaps[:, i] = batch.best - batch.optima
        start_gaps = batch.start_scores - batch.optima
        result.returns[:, i] = 1.0 - result.gaps[:, i] / start_gaps
        result.operations[:, i] = batch.best_step
        if progress is not None:
            progress(i + 1)
    return result


def evaluate(
    kind: str,
    sides: tuple[int, int] = (10, 20),
    meshes: int = 100,
    rollouts: int = 10,
    seed: int = 0,
    policy: Policy | None = None,
    progress: Callable[[int], None] | None = None,
) -> dict[str, float | int]:
    """One row of the paper's tables on so many unseen polygons of the benchmark distribution.

    single: the first rollout on each mesh; best: the best of `rollouts`. Meshes that are at their
    optimum from the start are left out and counted. `operations_median`: operations to the best
    state of the best rollout, the shortest among equals.
    """
    began = time.perf_counter()
    chosen = policy if policy is not None else load(shipped(kind)[0])
    drawn = start_meshes(kind, sides, meshes, np.random.default_rng([seed, 1]))
    useful = [mesh for mesh in drawn if mesh.score > mesh.optimum]

    def on_rollout(done: int) -> None:
        if progress is not None:
            progress(done * meshes // rollouts)

    rolled = roll_out(chosen, useful, rollouts, seed, on_rollout)
    single, best = rolled.returns[:, 0], rolled.returns.max(axis=1)
    # among the best rollouts of a mesh the one with the fewest operations
    rank = rolled.gaps * (rolled.operations.max() + 1) + rolled.operations
    operations = np.take_along_axis(rolled.operations, rank.argmin(axis=1)[:, None], 1)
    return {
        "single_mean": float(single.mean()),
        "single_std": float(single.std()),
        "single_at_optimum": float((rolled.gaps[:, 0] == 0).mean()),
        "best_mean": float(best.mean()),
        "best_std": float(best.std()),
        "at_optimum": float((rolled.gaps.min(axis=1) == 0).mean()),
        "operations_median": float(np.median(operations)),
        "started_at_optimum": len(drawn) - len(useful),
        "seconds": time.perf_counter() - began,
    }
