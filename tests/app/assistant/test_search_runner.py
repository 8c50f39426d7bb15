"""The search behind the window's buttons, with the shipped policy and the real solver."""

from threading import Event

from meshwright.assistant.search_runner import Effort, SearchRunner
from meshwright_agent.policy.policy_files import load


def _all_steps(runner):
    steps = []
    while not runner.finished:
        steps += runner.step()
    return steps


def test_its_steps_lead_to_what_it_found(star):
    told = []
    runner = SearchRunner(
        star.copy(),
        load("quad"),
        3,
        Effort(rollouts=2, seconds=None),
        Event(),
        lambda *a: told.append(a),
    )
    assert not runner.finished
    steps = _all_steps(runner)
    for operation, halfedge in steps:
        star.apply(operation, halfedge)
    assert star.score == star.optimum == 4
    assert told[-1][1] == 4
    assert runner.step() == [] and runner.reason == ""


def test_told_that_it_is_enough_it_comes_back_at_once_and_says_why(star):
    enough = Event()
    enough.set()
    runner = SearchRunner(star.copy(), load("quad"), 3, Effort(seconds=60.0), enough, print)
    assert _all_steps(runner) == []
    assert "nothing better was found" in runner.reason
