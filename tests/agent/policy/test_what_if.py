"""An outlook equals the policy's own decision among the same candidates."""

import numpy as np
import pytest

from meshwright_agent.policy import policy_files
from meshwright_agent.policy.policy_files import PolicyError
from meshwright_agent.policy.rollout import Runner
from meshwright_agent.policy.what_if import candidates, outlook, template_slots
from meshwright_core.domains import gallery, meshing
from meshwright_core.operations.catalogue import CODES, score_change


@pytest.fixture(params=["quad", "quad-paper", "tri", "tri-paper"])
def policy(request):
    return policy_files.load(request.param)


def star(kind):
    return meshing.mesh_domain(gallery.shape("star"), kind)


def test_an_outlook_agrees_with_the_next_decision(policy):
    runner = Runner(star(policy.kind), policy, 3)
    insight = runner.look()
    seen = outlook(runner.mesh, policy, insight.halfedges)
    assert seen.probabilities.sum(axis=1) == pytest.approx(insight.weights, abs=1e-5)
    assert seen.value == pytest.approx(insight.value, abs=1e-5)


def test_only_permitted_operations_have_probability_and_changes_are_exact(policy):
    mesh = star(policy.kind)
    seen = outlook(mesh, policy, candidates(mesh, policy))
    assert seen.probabilities.sum() == pytest.approx(1.0)
    assert (seen.probabilities[~seen.permitted] == 0).all()
    operations = list(CODES[mesh.k].values())[: seen.permitted.shape[1]]
    for i, j in np.argwhere(seen.permitted):
        change = score_change(mesh.arrays, operations[j], int(seen.halfedges[i]))
        assert seen.changes[i, j] == change


def test_candidates_contain_the_given_half_edge_once(policy):
    mesh = star(policy.kind)
    for h in range(0, mesh.k * mesh.n_elements, 5):
        found = candidates(mesh, policy, h)
        assert (found == h).sum() == 1 and len(np.unique(found)) == len(found)
        assert template_slots(mesh.arrays, policy.task, h)[0] == h


def test_an_outlook_changes_nothing_and_accepts_forbidden_half_edges(policy):
    mesh = star(policy.kind)
    before = mesh.points.copy(), mesh.elements()
    boundary = np.flatnonzero(mesh.arrays.edge[: mesh.k * mesh.n_elements, 1] < 0)[:1]
    seen = outlook(mesh, policy, boundary)
    assert seen.probabilities.shape == (1, policy.task.operations)
    assert np.array_equal(before[0], mesh.points) and np.array_equal(before[1], mesh.elements())


def test_wrong_arguments_are_refused(policy):
    with pytest.raises(PolicyError, match="this policy is for"):
        outlook(star("tri" if policy.kind == "quad" else "quad"), policy, np.array([0]))
    for h in (-1, 10**6):
        with pytest.raises(PolicyError, match="no half-edge"):
            outlook(star(policy.kind), policy, np.array([h]))
