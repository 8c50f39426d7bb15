"""The search behind the window's buttons, with the shipped policy and the real solver."""

from threading import Event

from meshwright.assistant.search_runner import Effort, SearchRunner
from meshwright_agent.policy.policy_files import load


def _all_steps(runner):
    steps = []
    while not runner.finished:
        steps += runner.step()
    return steps


def test_steps_lead_to_the_result(star):
    received = []
    runner = SearchRunner(
        star.copy(),
        load("quad"),
        3,
        Effort(rollouts=2, seconds=None),
        Event(),
        lambda *a: received.append(a),
    )
    assert not runner.finished
    steps = _all_steps(runner)
    for operation, halfedge in steps:
        star.apply(operation, halfedge)
    assert star.score == star.optimum == 4
    assert received[-1][1] == 4
    assert runner.step() == [] and runner.reason == ""


def test_a_stopped_search_returns_at_once_with_a_reason(star):
    enough = Event()
    enough.set()
    runner = SearchRunner(star.copy(), load("quad"), 3, Effort(seconds=60.0), enough, print)
    assert _all_steps(runner) == []
    assert "nothing better was found" in runner.reason
