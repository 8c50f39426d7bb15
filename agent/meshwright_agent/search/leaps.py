"""Leaps: several operations of a policy at once, whose result can be drawn though the states
between may not be.

From a mesh without inverted elements some rollouts go on, unguarded, until s is lower. The shortest
of them are then positioned around all that they have changed; the first one that can be drawn is
taken, or the first one that can be drawn when it is divided
(:mod:`meshwright_agent.search.divided_layouts`). Where a guarded rollout
(:mod:`meshwright_agent.search.guarded_rollouts`) is stuck a leap often is not.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import islice

import numpy as np
import torch

from meshwright_agent.env.task import MOST_CLEANUPS, transition
from meshwright_agent.env.vector_env import Batch
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search.annealing import Operations, with_room
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.divided_layouts import drawable, drawn_divided
from meshwright_core.core.arrays import MeshArrays, copied
from meshwright_core.geometry.layout_positions import rails_of
from meshwright_core.geometry.local_positions import local_effort, settle
from meshwright_core.geometry.shape_bound import corner_angles
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES, Operation

TOGETHER = 16
"""Rollouts side by side."""
LONGEST = 60
"""The most decisions of a leap."""
TRIED = 5
"""Leaps that are positioned."""
DIVIDED = 3
"""Leaps that are divided where none can be drawn as it is."""
RINGS = 3
"""Rings of elements around what has changed whose vertices move too."""

Decisions = tuple[tuple[int, int], ...]


def leap(
    mesh: HalfEdgeMesh,
    policy: Policy,
    rng: np.random.Generator,
    stop: Callable[[], bool],
    ceiling: int | None = None,
) -> tuple[Operations, MeshArrays] | None:
    """Operations that lead to lower s, and the arrays there with valid positions; None if no leap
    of this round can be drawn.

    mesh: of quads, without inverted elements; not changed. ceiling: largest number of elements, by
    default that of the policy's task.
    """
    if ceiling is None:
        ceiling = policy.task.bounds(mesh.n_elements)[1]
    before = with_room(mesh, ceiling)
    rails, angle = rails_of(mesh, len(before.vertex)), corner_angles(mesh)
    local = local_effort(rings=RINGS, thorough=False)
    active = np.zeros(len(before.points), np.bool_)
    cleaned, touched = np.zeros(MOST_CLEANUPS, np.int64), np.zeros(16, np.int64)
    found: list[Operations] = []
    for decisions in _shortest(mesh, policy, rng, stop, ceiling):
        if stop():
            return None
        after = copied(before)
        operations: Operations = []
        for code, h in decisions:
            count = transition(after, code, h, policy.task.cap, touched, cleaned)
            operations.append((NAMES[code], h))
            operations += [(Operation.CLEANUP, line) for line in cleaned[:count].tolist()]
        if settle(before, after, rails, local, active) > 0.0:
            return operations, after
        found.append(operations)
    results = ((operations, replayed(mesh, operations)) for operations in found)
    usable = (pair for pair in results if drawable(pair[1], angle))
    for operations, reached in islice(usable, DIVIDED):
        divisions, drawn = drawn_divided(reached, stop, 1)
        if drawn:
            return operations + divisions, reached.arrays
    return None


def _shortest(
    mesh: HalfEdgeMesh,
    policy: Policy,
    rng: np.random.Generator,
    stop: Callable[[], bool],
    ceiling: int,
) -> list[Decisions]:
    """The decisions of rollouts until s is lower, each once, the shortest first."""
    task = policy.task
    bounds = task.bounds(mesh.n_elements)[0], ceiling
    batch = Batch(task, [mesh], TOGETHER, rng, endless=False, bounds=bounds)
    generator = torch.Generator().manual_seed(int(rng.integers(1 << 31)))
    rows = np.arange(TOGETHER)
    made: list[list[tuple[int, int]]] = [[] for _ in rows]
    found: set[Decisions] = set()
    for _ in range(LONGEST):
        if not batch.active.any() or stop():
            break
        observation = batch.observe()
        actions = decide(policy.network, observation, generator)[0]
        chosen = observation.chosen[rows, actions // task.operations].tolist()
        running = np.flatnonzero(batch.active & (actions >= 0)).tolist()
        for b in running:
            made[b].append((task.first_operation + int(actions[b]) % task.operations, chosen[b]))
        batch.step(observation, actions)
        for b in running:
            if batch.best[b] < mesh.score:
                found.add(tuple(made[b]))
                batch.active[b] = False
    return sorted(found, key=len)[:TRIED]
