"""Insights and hints agree with the decisions of the policy and do not change the episode."""

import numpy as np
import pytest

from meshwright_agent.env.candidates import gather
from meshwright_agent.env.local_patch import seen_vertex
from meshwright_agent.policy import policy_files
from meshwright_agent.policy.explanation import WEIGHED, field_of_view, hints, same_result
from meshwright_agent.policy.policy_files import PolicyError
from meshwright_agent.policy.rollout import Runner
from meshwright_core import Operation
from meshwright_core.domains import gallery, meshing
from meshwright_core.operations.catalogue import CODES, score_change


@pytest.fixture(params=policy_files.shipped())
def policy(request):
    return policy_files.load(request.param)


def star(kind):
    return meshing.mesh_domain(gallery.shape("star"), kind)


def test_looking_does_not_change_an_episode(policy):
    mesh = star(policy.kind)
    seen, blind = Runner(mesh, policy, 5), Runner(mesh, policy, 5)
    for _ in range(16):
        insight = seen.look()
        again = seen.look()
        assert (insight is None) == (again is None)
        assert insight is None or insight.wanted == again.wanted
        step = seen.step()
        assert step == blind.step()
        if insight is None:
            break
        assert step[0] == (insight.wanted.operation, insight.wanted.halfedge)
    assert seen.finished == blind.finished and seen.score == blind.score
    assert seen.look() is None or not seen.finished


def test_probabilities_sum_to_one_and_changes_are_exact(policy):
    runner = Runner(star(policy.kind), policy, 2)
    for _ in range(6):
        insight = runner.look()
        arrays, k = runner.mesh.arrays, runner.mesh.k
        assert insight.weights.sum() == pytest.approx(1.0, abs=1e-6)
        assert len(insight.weights) == len(insight.halfedges) == len(set(insight.halfedges))
        assert 0.98 < sum(choice.probability for choice in insight.choices) < 1.0 + 1e-6
        likely = [choice.probability for choice in insight.choices]
        assert likely == sorted(likely, reverse=True)
        results = {
            (c.operation, same_result(arrays, k, c.operation, c.halfedge)) for c in insight.choices
        }
        assert len(results) == len(insight.choices)
        for choice in insight.choices:
            assert runner.mesh.check(choice.operation, choice.halfedge)
            code = CODES[k][choice.operation]
            assert score_change(arrays, code, choice.halfedge) == choice.change
        runner.step()


def test_the_template_agrees_with_the_candidate_selection(policy):
    runner = Runner(star(policy.kind), policy, 2)
    insight, arrays, k = runner.look(), runner.mesh.arrays, runner.mesh.k
    source, turn = policy.task.template
    slots = np.zeros(len(source), np.int64)
    gather(arrays, insight.wanted.halfedge, k, source, turn, slots)
    assert insight.missing == (slots < 0).sum()
    expected = {seen_vertex(arrays, h, k) for h in slots.tolist() if h >= 0}
    assert set(insight.template[:, 0].tolist()) == expected
    for vertex, slot, ring in insight.template.tolist():
        assert seen_vertex(arrays, slots[slot], k) == vertex
        assert ring <= policy.task.levels and (ring == 0) == (slot < k)


def test_the_field_of_view_grows_with_the_blocks():
    mesh = meshing.grid("quad", 400)
    middle = 4 * 210
    for blocks, size in ((0, 1), (1, 2), (2, 5), (3, 8)):
        field = field_of_view(mesh.arrays, 4, blocks, middle)
        assert len(field) == size == len(set(field[:, 0].tolist()))
        assert field[0].tolist() == [middle // 4, 0]
        assert (np.diff(field[:, 1]) >= 0).all() and field[:, 1].max() <= blocks


def test_hints_are_reproducible_and_can_be_applied(policy):
    mesh = star(policy.kind)
    before = mesh.elements()
    given = hints(mesh, policy)
    assert given == hints(mesh, policy) and 1 <= len(given) <= 5
    assert np.array_equal(before, mesh.elements()) and mesh.steps == 0
    for hint in given:
        trial = mesh.copy()
        assert trial.apply(hint.operation, hint.halfedge).score_change == hint.change
    assert sum(hint.probability for hint in given) <= 1.0 + 1e-6


def test_hints_near_given_vertices_stay_near_them():
    mesh = meshing.mesh_domain(gallery.random_polygon(60, np.random.default_rng(3)), "quad")
    policy = policy_files.load("quad")
    vertex = int(np.flatnonzero(mesh.irregularity())[-1])
    (best, *_) = hints(mesh, policy, near=np.array([vertex]))
    around = {v for n in mesh.neighbours(vertex) for v in (n, *mesh.neighbours(n))}
    around |= {w for v in around for w in mesh.neighbours(v)}
    assert mesh.origin(best.halfedge) in around
    regular = np.flatnonzero((mesh.irregularity() == 0) & (mesh.degree() > 0))
    assert hints(mesh, policy, near=regular) == hints(mesh, policy)
    assert len(hints(mesh, policy, count=1000)) <= WEIGHED * policy.task.operations


def test_a_mesh_of_the_other_kind_is_refused(policy):
    other = star("tri" if policy.kind == "quad" else "quad")
    with pytest.raises(PolicyError, match="this policy is for"):
        hints(other, policy)


def test_no_hint_without_irregular_vertices():
    assert hints(meshing.grid("quad", 16), policy_files.load("quad")) == ()


def test_operations_have_the_same_result_at_equivalent_half_edges():
    mesh = meshing.grid("quad", 16)
    for h in range(4 * mesh.n_elements):
        for operation in (Operation.FLIP_LEFT, Operation.COLLAPSE, Operation.SPLIT):
            other = same_result(mesh.arrays, 4, operation, h)
            one, two = mesh.copy(), mesh.copy()
            if other == h or not mesh.check(operation, h):
                continue
            one.apply(operation, h)
            two.apply(operation, other)
            assert sorted(one.degree()) == sorted(two.degree())
