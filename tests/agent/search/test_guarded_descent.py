"""Descents to s*: every state found can be drawn, and the same seed finds the same."""

import pytest

from meshwright_agent.policy import policy_files
from meshwright_agent.search.divided_layouts import divide_chords
from meshwright_agent.search.guarded_descent import KEPT, GuardedDescent
from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.quality import inverted


@pytest.fixture(scope="module")
def policy():
    return policy_files.load(policy_files.shipped("quad")[0])


@pytest.fixture(scope="module", params=["airfoil-in-box", "filleted-bracket"])
def start(request):
    return mesh_domain(gallery.shape(request.param), "quad")


def test_the_start_is_not_changed(start, policy):
    before = start.points.copy(), start.score, start.n_elements
    GuardedDescent(start, policy, 12, 3).run(lambda: False, 4)
    assert (start.points == before[0]).all()
    assert (start.score, start.n_elements) == before[1:]


def test_rounds_with_the_same_seed_find_the_same(start, policy):
    descents = [GuardedDescent(start, policy, 12, 5) for _ in range(2)]
    for descent in descents:
        descent.run(lambda: False, 6)
    first, second = descents
    assert first.score == second.score < start.score
    assert [state.operations for state in first.states] == [
        state.operations for state in second.states
    ]
    assert (first.states[0].arrays.points == second.states[0].arrays.points).all()


def test_a_descent_ends_when_it_is_stopped(start, policy):
    descent = GuardedDescent(start, policy, None, 0)
    descent.run(lambda: True)
    assert not descent.states
    assert descent.score == start.score


def test_more_states_of_the_lowest_s_are_gathered(start, policy):
    descent = GuardedDescent(start, policy, None, 2)
    descent.run(lambda: False, 2)
    score, known, looks = descent.score, descent.states[0], iter(range(6))
    descent.gather(lambda: next(looks, None) is None)
    assert descent.rollouts > 2
    assert descent.score <= score
    assert len(descent.states) <= KEPT
    assert known in descent.states or descent.states[0].rank < known.rank
    assert descent.lowest == [state for state in descent.states if state.score == descent.score]
    for state in descent.states:
        reached = state.mesh(start)
        reached.validate()
        assert not len(inverted(reached))


def test_rollouts_from_divided_states_are_drawn(start, policy):
    divisions = divide_chords(start.copy())
    descent = GuardedDescent(start, policy, None, 4)
    descent._round(descent._start, 2, lambda: False, divide=True)
    assert descent.states
    for state in descent.states:
        assert state.operations[: len(divisions)] == divisions
        assert not len(inverted(state.mesh(start)))
