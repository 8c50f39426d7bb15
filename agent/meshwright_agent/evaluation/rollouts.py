"""Rollouts of a policy on unseen polygons and their statistics, as in the tables of section 5."""

from __future__ import annotations

import copy
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import torch

from meshwright_agent.env.task import MOST_CLEANUPS, Task, transition
from meshwright_agent.env.vector_env import Batch, start_meshes
from meshwright_agent.evaluation import paper_results
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.policy_files import Policy, load, shipped
from meshwright_agent.policy.rollout import PolicyStep
from meshwright_core.core.arrays import ELEMENTS, JOURNALLING
from meshwright_core.core.score import normalised_return
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES, Operation


class NothingToDo(ValueError):
    """All start meshes are at their optimum already, so that there is nothing to evaluate."""


@dataclass
class Trace:
    """One rollout on each of M meshes, step by step."""

    gaps: np.ndarray
    """(T + 1, M) s - s* at the start and after each step; constant once an episode has ended."""
    codes: np.ndarray
    """(T, M) int8: code of the operation of each step, -1 after the end of the episode."""
    halfedges: np.ndarray
    """(T, M) int64: half-edge of each step, -1 after the end of the episode."""


@dataclass
class Rollouts:
    """The results of K rollouts on each of M meshes."""

    returns: np.ndarray
    """(M, K) undiscounted normalised return (equation 6) of the best state of each rollout."""
    gaps: np.ndarray
    """(M, K) s - s* at the best state."""
    operations: np.ndarray
    """(M, K) number of operations to the best state."""
    elements: np.ndarray
    """(M, K) elements at the best state, relative to the start."""
    traces: list[Trace]
    """K traces of M meshes each."""

    def best(self) -> np.ndarray:
        """(M,) index of the best rollout on each mesh, of equals that with fewest operations."""
        rank = self.gaps * (self.operations.max(initial=0) + 1) + self.operations
        numbers: np.ndarray = rank.argmin(axis=1)
        return numbers

    def steps(self, task: Task, mesh: HalfEdgeMesh, i: int, k: int) -> list[PolicyStep]:
        """The steps of rollout k on mesh i up to its best state.

        mesh: the start mesh, which is not changed; the operations can be replayed on it.
        """
        played = mesh.copy()
        played.arrays.counters[JOURNALLING] = 0
        played.reserve(3 * mesh.slots + 64, 3 * mesh.n_elements + 64)
        touched, cleaned = np.zeros(16, np.int64), np.zeros(MOST_CLEANUPS, np.int64)
        trace, steps = self.traces[k], []
        for t in range(int(self.operations[i, k])):
            code, h = int(trace.codes[t, i]), int(trace.halfedges[t, i])
            count = transition(played.arrays, code, h, task.cap, touched, cleaned)
            lines = cleaned[:count].tolist()
            steps.append([(NAMES[code], h), *((Operation.CLEANUP, line) for line in lines)])
        return steps


def roll_out(
    policy: Policy,
    meshes: list[HalfEdgeMesh],
    rollouts: int,
    seed: int,
    progress: Callable[[int], None] | None = None,
) -> Rollouts:
    """Play `rollouts` episodes from each mesh, all meshes in parallel.

    Every mesh must start above its optimum. `progress(rollouts done on all meshes)` is called after
    each round.
    """
    rng = np.random.default_rng(seed)
    generator = torch.Generator().manual_seed(seed)
    shape = (len(meshes), rollouts)
    result = Rollouts(
        np.zeros(shape), np.zeros(shape, int), np.zeros(shape, int), np.zeros(shape), []
    )
    for i in range(rollouts):
        batch = Batch(policy.task, meshes, len(meshes), rng, endless=False)
        elements, trace = _play(batch, policy, generator)
        result.gaps[:, i] = batch.best - batch.optima
        result.returns[:, i] = normalised_return(batch.start_scores, batch.best, batch.optima)
        result.operations[:, i] = batch.best_step
        result.elements[:, i] = elements / batch.start_elements
        result.traces.append(trace)
        if progress is not None:
            progress(i + 1)
    return result


def _play(batch: Batch, policy: Policy, generator: torch.Generator) -> tuple[np.ndarray, Trace]:
    """Play all episodes to their end.

    Returns the elements (M,) at the best states, and the trace.
    """
    task = policy.task
    elements = batch.start_elements.copy()
    gaps, codes, halfedges = [batch.gaps], [], []
    while batch.active.any():
        observation = batch.observe()
        actions = decide(policy.network, observation, generator)[0]
        best = batch.best.copy()
        batch.step(observation, actions)
        better = batch.best < best
        elements[better] = batch.meshes.counters[better, ELEMENTS]
        row, operation = np.divmod(actions, task.operations)
        acted = actions >= 0
        picked = observation.chosen[np.arange(len(actions)), np.where(acted, row, 0)]
        gaps.append(batch.gaps)
        codes.append(np.where(acted, task.first_operation + operation, -1).astype(np.int8))
        halfedges.append(np.where(acted, picked, -1))
    shape = (0, len(elements))
    trace = Trace(
        np.array(gaps),
        np.array(codes, np.int8).reshape(-1, shape[1]),
        np.array(halfedges, np.int64).reshape(-1, shape[1]),
    )
    return elements, trace


def unseen(kind: str, sides: tuple[int, int], meshes: int, seed: int) -> list[HalfEdgeMesh]:
    """Meshes of random polygons that training has not used, without those that start at s*.

    meshes: how many are drawn. Raises NothingToDo if none is left.
    """
    drawn = start_meshes(kind, sides, meshes, np.random.default_rng([seed, 1]))
    useful = [mesh for mesh in drawn if mesh.score > mesh.optimum]
    if not useful:
        raise NothingToDo("every polygon that was drawn starts at its optimum")
    return useful


def longer(policy: Policy, factor: float) -> Policy:
    """The same policy with episodes that are `factor` times as long."""
    if factor == 1.0:
        return policy
    network = copy.copy(policy.network)
    network.task = replace(policy.task, steps=factor * policy.task.steps)
    return Policy(policy.name, network, policy.header)


def evaluate(
    kind: str,
    sides: tuple[int, int] = (10, 20),
    meshes: int = 100,
    rollouts: int = 10,
    seed: int = 0,
    policy: Policy | None = None,
    progress: Callable[[int], None] | None = None,
) -> dict[str, float | int]:
    """One row of the paper's tables (section 5): statistics over `meshes` unseen random polygons.

    `single_*`: of the first rollout on each mesh; `best_*`: of the best of `rollouts`. Meshes that
    start at their optimum are left out and counted in `started_at_optimum`. `operations_median`:
    operations to the best state of the best rollout, the shortest among equals; `elements_mean`:
    elements there, relative to the start.
    """
    began = time.perf_counter()
    chosen = policy if policy is not None else load(shipped(kind)[0])
    useful = unseen(kind, sides, meshes, seed)

    def on_rollout(done: int) -> None:
        if progress is not None:
            progress(done * meshes // rollouts)

    rolled = roll_out(chosen, useful, rollouts, seed, on_rollout)
    return summary(rolled) | {
        "started_at_optimum": meshes - len(useful),
        "seconds": time.perf_counter() - began,
    }


def summary(rolled: Rollouts) -> dict[str, float | int]:
    """The statistics of a row; see :func:`evaluate`."""
    single, best = rolled.returns[:, 0], rolled.returns.max(axis=1)
    chosen = (np.arange(len(best)), rolled.best())
    return {
        "single_mean": float(single.mean()),
        "single_std": float(single.std()),
        "single_at_optimum": float((rolled.gaps[:, 0] <= 0).mean()),
        "best_mean": float(best.mean()),
        "best_std": float(best.std()),
        "at_optimum": float((rolled.gaps.min(axis=1) <= 0).mean()),
        "operations_median": float(np.median(rolled.operations[chosen])),
        "elements_mean": float(rolled.elements[chosen].mean()),
    }


def paper_table(
    kind: str, meshes: int, rollouts: int, seed: int, policy: Policy
) -> list[dict[str, Any]]:
    """Evaluate the policy on every row that the paper reports for this kind."""
    return [
        {"sides": list(row.sides), **evaluate(kind, row.sides, meshes, rollouts, seed, policy)}
        for row in paper_results.ROWS[kind]
    ]
