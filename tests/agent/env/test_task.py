"""Action masks, exact changes of s, and episodes in a vector environment and alone."""

import numpy as np
import pytest
import torch

from meshwright_agent.env.candidates import Rules, permitted, template_plan
from meshwright_agent.env.task import Task
from meshwright_agent.env.vector_env import Batch, start_meshes
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.network import Architecture, PolicyNetwork
from meshwright_agent.policy.policy_files import Policy, PolicyError
from meshwright_agent.policy.rollout import Runner
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import CURVE, JOURNALLING, MeshArrays
from meshwright_core.domains.meshing import benchmark_mesh
from meshwright_core.operations.catalogue import NAMES, score_change


def _policy(kind, **settings):
    torch.manual_seed(1)
    return Policy(kind, PolicyNetwork(Task(kind, blocks=2, **settings), Architecture()))


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_score_change_is_exact(kind):
    rng = np.random.default_rng(5)
    task = Task(kind, extended=True)
    seen = set()
    for _ in range(6):
        mesh = benchmark_mesh(kind, 12, rng)
        for h in range(mesh.k * mesh.n_elements):
            rules = task.rules(0, 10**6)._replace(cap=0)
            for code in range(task.first_operation, task.first_operation + task.operations):
                if not permitted(mesh.arrays, code, h, rules):
                    continue
                expected = score_change(mesh.arrays, code, h)
                assert mesh.apply(NAMES[code], h).score_change == expected
                seen.add((code, expected))
                mesh.undo()
    assert len(seen) > 8


def test_the_element_floor_and_the_action_set_are_kept():
    mesh = benchmark_mesh("tri", 12, np.random.default_rng(0))
    n = mesh.n_elements
    boundary = [h for h in range(3 * n) if mesh.twin(h) < 0]
    free = Rules(first=0, operations=3, cap=0, floor=0, ceiling=10**6, extended=True)
    paper = free._replace(extended=False)
    kept, less = free._replace(floor=n), free._replace(floor=n - 2)
    assert not any(permitted(mesh.arrays, 2, h, paper) for h in boundary)
    assert not any(permitted(mesh.arrays, 2, h, kept) for h in range(3 * n))
    assert any(permitted(mesh.arrays, 2, h, less) for h in range(3 * n))


@pytest.mark.parametrize(("k", "levels", "size"), [(3, 1, 12), (4, 1, 20), (4, 2, 68)])
def test_template_sizes(k, levels, size):
    source, turn = template_plan(k, levels)
    assert len(source) == len(turn) == size


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("selection", ["shortlist", "template"])
def test_episodes_in_a_batch_leave_valid_meshes(kind, selection):
    rng = np.random.default_rng(2)
    policy = _policy(kind, selection=selection, extended=True)
    meshes = [m for m in start_meshes(kind, (8, 11), 4, rng) if m.score > m.optimum]
    batch = Batch(policy.task, meshes, len(meshes), rng, endless=False)
    generator = torch.Generator().manual_seed(0)
    while batch.active.any():
        observation = batch.observe()
        before = batch.scores
        outcome = batch.step(observation, decide(policy.network, observation, generator)[0])
        assert (before - batch.scores == outcome.rewards).all()
    assert (batch.best >= batch.optima).all()
    for b, mesh in enumerate(meshes):
        own = [array[b] for array in batch.meshes[:-2]]
        arrays = MeshArrays(*own, mesh.arrays.curves, mesh.arrays.interface)
        on_curve = arrays.vertex[:, CURVE] >= 0
        arrays.vertex[on_curve, CURVE] -= sum(len(other.arrays.interface) for other in meshes[:b])
        arrays.counters[JOURNALLING] = 0
        run = HalfEdgeMesh(arrays, mesh.boundary_info)
        run.validate()
        assert run.optimum == mesh.optimum and run.score == batch.scores[b]


def test_an_endless_batch_starts_new_episodes():
    rng = np.random.default_rng(2)
    policy = _policy("quad")
    batch = Batch(policy.task, start_meshes("quad", (8, 10), 5, rng), 8, rng)
    generator = torch.Generator().manual_seed(0)
    ended = 0
    for _ in range(60):
        observation = batch.observe()
        outcome = batch.step(observation, decide(policy.network, observation, generator)[0])
        ended += int(outcome.ended.sum())
        assert np.isfinite(outcome.returns[outcome.ended]).all()
    assert ended > 8 and batch.active.all()


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_an_episode_replays_on_its_mesh(kind):
    mesh = benchmark_mesh(kind, 9, np.random.default_rng(3))
    replayed = mesh.copy()
    runner = Runner(mesh, _policy(kind, extended=True), seed=4)
    scores = []
    while step := runner.step():
        for operation, h in step:
            replayed.apply(operation, h)
        scores.append(runner.score)
        assert replayed.score == runner.score
    assert (replayed.elements() == runner.mesh.elements()).all()
    assert runner.finished and runner.reason and runner.best_score == min(scores)
    replayed.validate()
    assert runner.step() == []
    again = Runner(mesh, _policy(kind, extended=True), seed=4)
    while again.step():
        continue
    assert (again.mesh.elements() == runner.mesh.elements()).all()


def test_a_policy_of_the_other_kind_is_refused():
    mesh = benchmark_mesh("tri", 9, np.random.default_rng(3))
    with pytest.raises(PolicyError, match="quad"):
        Runner(mesh, _policy("quad"), seed=0)
