"""The anytime solver: results can be replayed, are the best found, and arrive in time."""

from dataclasses import replace

import numpy as np
import pytest

from meshwright_agent.policy import policy_files
from meshwright_agent.policy.policy_files import PolicyError
from meshwright_agent.search import solver
from meshwright_agent.search.solution import judged
from meshwright_agent.search.solver import Solution, prepare, solve
from meshwright_core.curves.curve import Curve
from meshwright_core.domains import gallery
from meshwright_core.domains.domain import Domain
from meshwright_core.domains.meshing import benchmark_mesh, mesh_domain
from meshwright_core.geometry.edge_curves import element_areas
from meshwright_core.geometry.quality import scaled_jacobian
from meshwright_core.geometry.smoothing import relax


@pytest.fixture(scope="module", params=["tri", "quad"])
def policy(request):
    policy = policy_files.load(policy_files.shipped(request.param)[0])
    prepare(policy)
    return policy


def start(kind, sides=14, seed=0):
    return benchmark_mesh(kind, sides, np.random.default_rng(seed))


def replayed(mesh, solution):
    copy = mesh.copy()
    for operation, h in solution.operations:
        copy.apply(operation, h)
    copy.validate()
    return copy


@pytest.mark.slow
def test_a_solution_replays_to_its_score(policy):
    mesh = start(policy.kind)
    reported = []
    found = solve(mesh, policy, seconds=2.0, progress=lambda *values: reported.append(values))
    after = replayed(mesh, found)
    assert (after.score, after.n_elements) == (found.score, found.elements)
    assert found.score < mesh.score and found.optimum == mesh.optimum
    assert found.rollouts == reported[-1][0]
    assert [best for _, best in reported] == sorted((best for _, best in reported), reverse=True)


@pytest.mark.parametrize("workers", [1, 2])
def test_every_better_answer_is_reported_and_the_last_one_is_given(policy, workers):
    """The answer has the positions of the last report, or others that are about as good."""
    mesh, reported = start(policy.kind), []
    answer = solve(mesh, policy, rollouts=4, workers=workers, found=reported.append)
    assert [one.score for one in reported] == sorted((one.score for one in reported), reverse=True)
    for one in reported:
        reached = mesh.copy()
        assert one.carry_out(reached)
        assert (reached.score, reached.n_elements) == (one.score, one.elements)
        assert scaled_jacobian(reached).min() == pytest.approx(one.worst_scaled_jacobian)
        assert (
            reached.points[reached.vertices()] == one.reached.points[one.reached.vertices()]
        ).all()
    last = reported[-1]
    assert (last.score, last.elements) == (answer.score, answer.elements)
    assert answer.worst_scaled_jacobian >= last.worst_scaled_jacobian - 0.02


def test_answers_of_patches_are_reported(monkeypatch):
    mesh, reported = start("quad", 30), []
    monkeypatch.setattr(solver, "is_large", lambda mesh: mesh.score > 10)
    policy = policy_files.load("quad")
    answer = solve(mesh, policy, rollouts=2, found=reported.append)
    assert answer.method == "patches"
    assert mesh.score > reported[0].score >= reported[-1].score == answer.score


def test_best_of_k_plays_at_most_k_rollouts(policy):
    mesh = start(policy.kind, 20)
    found = solve(mesh, policy, rollouts=3, max_steps=5)
    assert found.rollouts == 3
    assert replayed(mesh, found).score == found.score <= mesh.score
    assert solve(mesh, policy, max_steps=5).rollouts == 1


@pytest.mark.parametrize("drawable", [3, 0])
def test_what_cannot_be_drawn_is_given_up_for_the_best_state_that_can(monkeypatch, drawable):
    """The answer is a part of the operations found, or the start, not an inverted mesh."""
    mesh, found = mesh_domain(gallery.shape("star"), "quad"), []

    def fails_late(solution, *more, **places):
        inverted = int(len(solution.operations) > drawable)
        found.append(replace(judged(solution, *more, **places), inverted=inverted))
        return found[-1]

    monkeypatch.setattr(solver, "judged", fails_late)
    answer = solve(mesh, policy_files.load("quad"), rollouts=1)
    assert any(one.inverted and one.score < mesh.score for one in found)
    assert answer.inverted == 0
    assert len(answer.operations) <= drawable
    assert replayed(mesh, answer).score == answer.score <= mesh.score


def test_a_search_ends_at_its_time_limit(policy):
    mesh = start(policy.kind, 40)
    found = solve(mesh, policy, seconds=2.0)
    assert replayed(mesh, found).score == found.score < mesh.score


def test_a_cancelled_search_returns_the_best_so_far(policy):
    mesh = start(policy.kind, 40)
    asked = []
    found = solve(mesh, policy, seconds=600.0, cancelled=lambda: asked.append(0) or len(asked) > 50)
    assert len(asked) < 500  # it stops soon after it was cancelled
    assert replayed(mesh, found).score == found.score


@pytest.mark.slow
def test_workers_share_their_results(policy):
    mesh = start(policy.kind, 20)
    found = solve(mesh, policy, seconds=1.0, workers=2)
    assert replayed(mesh, found).score == found.score < mesh.score


def test_a_mesh_at_its_optimum_needs_no_operations(policy):
    mesh = start(policy.kind)
    for operation, h in solve(mesh, policy, rollouts=10).operations:
        mesh.apply(operation, h)
    assert mesh.score == mesh.optimum
    assert solve(mesh, policy, seconds=1.0, coarsen=False).operations == []


@pytest.mark.slow
def test_quads_are_coarsened_only_on_request():
    policy = policy_files.load("quad")
    mesh = start("quad", 20)
    fine = solve(mesh, policy, rollouts=6, coarsen=False)
    coarse = solve(mesh, policy, rollouts=6)
    assert fine.score == coarse.score == mesh.optimum
    assert coarse.elements < fine.elements


def test_the_order_of_solutions_is_validity_s_flaws_elements_operations():
    def rank(score, inverted, elements, length):
        return Solution([("flip", 0)] * length, score, 0, inverted, elements).rank

    ranks = [rank(1, 0, 9, 9), rank(1, 0, 9, 10), rank(1, 0, 10, 1), rank(2, 0, 1, 1)]
    ranks += [rank(1, 1, 1, 1), rank(1, 2, 1, 1)]
    assert ranks == sorted(ranks)


def test_a_policy_of_the_other_kind_is_refused(policy):
    with pytest.raises(PolicyError, match="is for"):
        solve(start("quad" if policy.kind == "tri" else "tri"), policy)


def test_a_disc_stays_a_disc(policy):
    mesh = mesh_domain(gallery.shape("disc"), policy.kind)
    found = solve(mesh, policy, rollouts=1)
    after = replayed(mesh, found)
    assert after.score == found.score < mesh.score
    assert element_areas(after).sum() == pytest.approx(element_areas(mesh).sum(), rel=1e-12)


def test_half_a_disc_is_drawn_at_the_optimum():
    # the first states at s* have two or three quads, too few for a valid one
    disc = Domain.from_curves([[Curve.arc((0, 0), 10, 0, np.pi), Curve.line((-10, 0), (10, 0))]])
    mesh = mesh_domain(disc, "quad")
    policy = policy_files.load(policy_files.shipped("quad")[0])
    found = solve(mesh, policy, seconds=4.0)
    assert found.perfect and found.optimum == 2
    after = replayed(mesh, found)
    assert len(relax(after)) == 0 and after.score == 2


@pytest.mark.parametrize("policy", ["quad"], indirect=True)
def test_a_round_hole_in_a_square_gets_its_ring_of_four(policy):
    mesh = mesh_domain(gallery.shape("plate-with-round-hole"), "quad")
    found = solve(mesh, policy, rollouts=4, seed=1)
    assert (found.score, found.elements, found.inverted) == (mesh.optimum, 4, 0)
    assert found.worst_scaled_jacobian == pytest.approx(np.sqrt(0.5), abs=1e-3)
