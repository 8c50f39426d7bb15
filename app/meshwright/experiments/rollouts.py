"""Rollouts of a policy from one mesh, with all their scores and operations."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from meshwright.assistant.torch_threads import one_thread
from meshwright_core import HalfEdgeMesh, MeshError, Operation
from meshwright_core.core.score import normalised_return

if TYPE_CHECKING:
    from meshwright_agent.env.task import Task
    from meshwright_agent.policy.policy_files import Policy

RolloutStep = tuple[tuple[Operation, int], ...]


@dataclass(frozen=True, eq=False)
class Rollout:
    """One rollout of a policy."""

    policy: str
    number: int
    """Index among the rollouts of its policy."""
    scores: np.ndarray
    """(T + 1,) int64: s at the start and after each decision."""
    steps: tuple[RolloutStep, ...]
    """For each of T decisions its operation and half-edge, followed by its clean-ups. They can be
    replayed on the mesh that the rollout started from."""
    optimum: int
    """s*, which no operation changes."""

    @property
    def start(self) -> int:
        """s at the start."""
        return int(self.scores[0])

    @property
    def best(self) -> int:
        """The lowest s of the rollout."""
        return int(self.scores.min())

    @property
    def last(self) -> int:
        """s at the end of the rollout."""
        return int(self.scores[-1])

    @property
    def decisions(self) -> int:
        """The number of decisions to the best state."""
        return int(self.scores.argmin())

    @property
    def normalised(self) -> float:
        """Normalised return (start - best) / (start - optimum); 1 is the optimum."""
        return normalised_return(self.start, self.best, self.optimum)

    def operations(self, decisions: int | None = None) -> list[tuple[Operation, int]]:
        """The operations of the first ``decisions`` decisions; None: up to the best state."""
        count = self.decisions if decisions is None else decisions
        return [one for step in self.steps[:count] for one in step]


def known_policy(name: object) -> Policy:
    """A shipped policy by its name, one from a file, or the loaded policy that is given.

    Raises MeshError if it cannot be loaded.
    """
    from meshwright_agent.policy.policy_files import Policy, PolicyError, load

    if isinstance(name, Policy):
        return name
    if not isinstance(name, str) and not hasattr(name, "__fspath__"):
        raise MeshError(f"A policy is named by text, not by {type(name).__name__}.")
    try:
        return load(name)
    except PolicyError as error:
        raise MeshError(str(error)) from None


def require_kind(policy: Policy, mesh: HalfEdgeMesh) -> None:
    """Raise MeshError for a policy that is for the other kind of mesh."""
    from meshwright_agent.policy import policy_files

    try:
        policy_files.require_kind(policy, mesh.kind)
    except policy_files.PolicyError as error:
        raise MeshError(f"{error}.") from None


def play(
    mesh: HalfEdgeMesh, policy: Policy, rollouts: int, steps: int | None, seed: int
) -> tuple[tuple[Rollout, ...], float]:
    """Several rollouts from the mesh, which is not changed, as one batch; and their seconds.

    steps: the most decisions in a rollout; None: as many as in the policy's training.
    """
    from meshwright_agent.evaluation.rollouts import roll_out

    if mesh.score > mesh.optimum:
        _warm_up(policy.task)
    began = time.perf_counter()
    if mesh.score == mesh.optimum:
        start = np.array([mesh.score], np.int64)
        rows = [Rollout(policy.name, k, start, (), mesh.optimum) for k in range(rollouts)]
        return tuple(rows), time.perf_counter() - began
    with one_thread():
        rolled = roll_out(_limited(policy, mesh, steps), [mesh] * rollouts, 1, seed)
    trace = rolled.traces[0]
    gaps, acted = trace.gaps, trace.codes >= 0
    lengths = acted.sum(axis=0)
    if steps is not None:
        lengths = np.minimum(lengths, steps)
    seconds = time.perf_counter() - began
    whole = replace(rolled, operations=lengths[:, None])
    runs = []
    for k, length in enumerate(lengths.tolist()):
        taken = whole.steps(policy.task, mesh, k, 0)
        scores = (gaps[: length + 1, k] + mesh.optimum).astype(np.int64)
        found = tuple(tuple(step) for step in taken)
        runs.append(Rollout(policy.name, k, scores, found, mesh.optimum))
    return tuple(runs), seconds


@cache
def _warm_up(task: Task) -> None:
    """Compile or load the kernels of an environment, so that this time is not measured."""
    from meshwright_agent.env.vector_env import Batch
    from meshwright_core.domains import gallery, meshing

    start = meshing.mesh_domain(gallery.shape("l-shape"), task.kind)
    batch = Batch(task, [start], 1, np.random.default_rng(0), endless=False)
    batch.step(batch.observe(), np.array([-1]))


def _limited(policy: Policy, mesh: HalfEdgeMesh, steps: int | None) -> Policy:
    """The policy with rollouts of at least ``steps`` decisions; the caller cuts them off."""
    from meshwright_agent.evaluation.rollouts import longer

    if steps is None:
        return policy
    wanted = (steps + 0.5) / mesh.n_elements
    return longer(policy, wanted / policy.task.steps)


def best_of(values: np.ndarray, k: int) -> tuple[float, float]:
    """Mean and standard deviation of the maximum of k of the values (n,), over all subsets of k.

    MeshError unless 1 <= k <= n.
    """
    n = len(values)
    if not 1 <= k <= n:
        raise MeshError(f"Of {n} rollouts the best of {k} cannot be had: k is from 1 to {n}.")
    ordered = np.sort(np.asarray(values, float))
    # the i-th smallest value is the maximum of C(i, k - 1) of the C(n, k) subsets
    weights = np.array([math.comb(i, k - 1) for i in range(n)], float) / math.comb(n, k)
    mean = float(weights @ ordered)
    variance = float(weights @ (ordered - mean) ** 2)
    return mean, math.sqrt(max(variance, 0.0))
