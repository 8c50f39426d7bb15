"""The search behind the window's buttons, with the shipped policy and the real solver."""

from threading import Event

import numpy as np

from meshwright.assistant.search_runner import PREFERENCES, Effort, SearchRunner
from meshwright_agent.policy.policy_files import load
from meshwright_agent.search import layout_search
from meshwright_agent.search.solution import Solution, judged


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


def rounds(monkeypatch, mesh, wins, greedy):
    """Run *Complete* where the first ``wins`` rounds of the solver lower the score, as little as
    they can, and the others find nothing; returns the runner and, for each round, the score at its
    start, its seconds and the number of operations found.
    """
    asked = []

    def one(self, start, seconds, done):
        run, operations = greedy(start), []
        while len(asked) < wins and run.mesh.score == start.score:
            operations += run.step()
        asked.append((start.score, seconds, len(operations)))
        return judged(Solution(operations, 0, start.optimum, 0), start)

    monkeypatch.setattr(SearchRunner, "_round", one)
    runner = SearchRunner(mesh, None, 0, Effort(until_done=True), Event(), print)
    return runner, asked


def test_complete_goes_on_from_the_best_state_until_nothing_is_won(star, monkeypatch, greedy):
    start = star.copy()
    runner, asked = rounds(monkeypatch, star, 2, greedy)
    operations = runner.step()
    scores, seconds, found = zip(*asked, strict=True)
    assert runner.finished and len(operations) == sum(found)
    # two rounds that win, then two without success, the second with twice the time
    assert seconds == (3.0, 3.0, 3.0, 6.0)
    assert scores[0] > scores[1] > scores[2] == scores[3]
    for operation, halfedge in operations:
        start.apply(operation, halfedge)
    assert np.array_equal(start.elements(), runner.target.elements())


def test_the_words_of_preferences_are_those_of_the_solver():
    assert set(PREFERENCES) == set(layout_search.PREFERENCES)
