"""The search behind the window's buttons, with the shipped policy and the real solver."""

from threading import Event

import numpy as np
import pytest

from meshwright.assistant import search_runner
from meshwright.assistant.outcome import shape_wanted
from meshwright.assistant.search_runner import PREFERENCES, Effort, SearchRunner, ShapeGoal
from meshwright_agent.policy.policy_files import load
from meshwright_agent.search import layout_search
from meshwright_agent.search.layout_search import Preference
from meshwright_agent.search.solution import Solution, judged
from meshwright_core import HalfEdgeMesh
from meshwright_core.domains import meshing
from meshwright_core.domains.domain import Domain
from meshwright_core.geometry.quality import scaled_jacobian


@pytest.fixture
def dented():
    """A grid of 3 x 3 quads, at s*, with an inner vertex close to a corner of the grid."""
    mesh = meshing.grid("quad", 9)
    inner = mesh.vertices()[~mesh.boundary()[mesh.vertices()]][:1]
    mesh.move(inner, 0.46 * mesh.points[mesh.vertices()].min(axis=0) + 0.54 * mesh.points[inner])
    return mesh


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
    # two rounds that win, then two without success; longer ones once layouts are searched, and
    # after one that has won nothing twice as long
    assert seconds == (3.0, 12.0, 12.0, 24.0)
    assert "nothing better was found" in runner.reason
    assert scores[0] > scores[1] > scores[2] == scores[3]
    for operation, halfedge in operations:
        start.apply(operation, halfedge)
    assert np.array_equal(start.elements(), runner.target.elements())


def test_complete_goes_on_at_the_optimum_until_the_shape_is_reached(dented, monkeypatch):
    """At s* from the first round on, the worst corner is raised a little in each round."""
    assert dented.score == dented.optimum
    aim = ShapeGoal.of(dented, Effort()).aim
    told, starts = [], []

    def one(self, start, seconds, done):
        starts.append(scaled_jacobian(start).min())
        found = judged(Solution([], 0, start.optimum, 0, aims=Preference().aims(1.0, 1.0)), start)
        share = 0.04  # of the way to the good positions
        here = start.points[found.vertices]
        found.positions = here + share * (found.positions - here)
        placed = start.copy()
        found.place(placed)
        found.worst_scaled_jacobian = float(scaled_jacobian(placed).min())
        found.operations = [("flip_left", 0)]  # counts as something done
        return found

    monkeypatch.setattr(SearchRunner, "_round", one)
    monkeypatch.setattr(Solution, "replay", lambda self, mesh: None)
    runner = SearchRunner(
        dented, None, 0, Effort(until_done=True), Event(), lambda *a: told.append(runner.shape)
    )
    runner.step()
    shapes = [goal.worst for goal in told]
    assert len(starts) > 2 and starts == sorted(starts) and shapes == sorted(shapes)
    assert shapes[-2] < aim <= shapes[-1] <= runner.shape.worst and runner.shape.reached
    assert runner.reason == ""


def test_the_solver_mends_a_bad_shape_at_the_optimum(dented):
    effort = Effort(seconds=0.5, until_done=True)
    before = ShapeGoal.of(dented, effort)
    runner = SearchRunner(dented.copy(), load("quad"), 0, effort, Event(), lambda *a: None)
    runner.step()
    assert not before.reached and runner.shape.reached
    assert runner.target.score == runner.target.optimum
    # where both are reached nothing is searched, unless fewer blocks are asked for
    again = SearchRunner(runner.target, None, 0, effort, Event(), print)
    assert again.step() == [] and "nothing better" in again.reason


@pytest.mark.parametrize(("delta", "count"), [(1, 1), (2, 2)])
def test_complete_looks_once_more_where_a_vertex_is_irregular_by_two(
    dented, monkeypatch, delta, count
):
    asked = []

    def one(self, start, seconds, done):
        self._rounds += 1
        asked.append(seconds)
        return judged(Solution([], 0, start.optimum, 0, aims=Preference().aims(1.0, 1.0)), start)

    monkeypatch.setattr(SearchRunner, "_round", one)
    monkeypatch.setattr(search_runner, "largest_delta", lambda mesh: delta)
    SearchRunner(dented, None, 0, Effort(until_done=True), Event(), lambda *a: None).step()
    assert len(asked) == count


@pytest.mark.parametrize(
    ("most", "prefer", "asked"),
    [
        (9, "balanced", [(3.0, "")]),
        (8, "balanced", [(3.0, ""), (3.0, "blocks"), (24.0, "")]),
        (8, "shape", [(3.0, ""), (24.0, "")]),
    ],
)
def test_complete_looks_once_more_where_many_blocks_are_left(
    dented, monkeypatch, most, prefer, asked
):
    rounds = []

    def one(self, start, seconds, done, prefer=""):
        self._rounds += 1
        rounds.append((seconds, prefer))
        return judged(Solution([], 0, start.optimum, 0, aims=Preference().aims(1.0, 1.0)), start)

    monkeypatch.setattr(SearchRunner, "_round", one)
    monkeypatch.setattr(search_runner, "MANY_BLOCKS", most)
    effort = Effort(until_done=True, prefer=prefer)
    SearchRunner(dented, None, 0, effort, Event(), lambda *a: None).step()
    assert rounds == asked


def test_complete_goes_on_from_few_blocks_where_many_are_left(dented, monkeypatch):
    """The second round starts with the result of a search for few blocks, and its operations lead
    from the mesh that was given to the end of that round.
    """
    monkeypatch.setattr(search_runner, "MANY_BLOCKS", 8)
    mesh, starts = dented, []
    given = mesh.copy()

    def without_lines(start, times):
        """A solution that removes lines of the grid, one after the other."""
        here, operations = start.copy(), []
        for _ in range(times):
            halfedge = next(h for h in range(4 * start.n_elements) if _removable(here, h))
            here.apply("cleanup", halfedge)
            operations.append(("cleanup", halfedge))
        aims = Preference().aims(1.0, 1.0)
        return judged(Solution(operations, 0, start.optimum, 0, aims=aims, coarse=True), start)

    def one(self, start, seconds, done, prefer=""):
        self._rounds += 1
        starts.append(start.n_elements)
        return without_lines(start, (0, 2, 1)[len(starts) - 1])

    monkeypatch.setattr(SearchRunner, "_round", one)
    runner = SearchRunner(mesh, None, 0, Effort(until_done=True), Event(), lambda *a: None)
    for operation, halfedge in runner.step():
        given.apply(operation, halfedge)
    assert starts == [9, 9, 3]
    assert given.n_elements == runner.target.n_elements == 2


def _removable(mesh, halfedge):
    return mesh.live(halfedge) and bool(mesh.check("cleanup", halfedge))


def test_half_of_many_blocks_count_more_than_an_even_spread():
    aims = Preference().aims(1.0, 1.0)

    def found(elements, sum_delta2, worst=0.7):
        return Solution(
            [], 0, 12, 12, sum_delta2=sum_delta2, elements=elements, coarse=True, aims=aims,
            worst_scaled_jacobian=worst, worst_shape=1.0,
        )  # fmt: skip

    better = search_runner._is_better
    assert better(found(11, 14), found(60, 12)) and not better(found(60, 12), found(11, 14))
    assert better(found(40, 12), found(60, 14)) and not better(found(40, 14), found(60, 12))
    assert better(found(18, 12), found(9, 14)) and not better(found(9, 14), found(18, 12))
    assert not better(found(11, 14, worst=0.2), found(60, 12))


def test_long_thin_elements_are_not_the_wanted_shape():
    points = [(0, 0), (1, 0), (1, 0.01), (0, 0.01)]
    goal = ShapeGoal.of(HalfEdgeMesh.from_elements(points, [(0, 1, 2, 3)]), Effort())
    assert goal.worst == pytest.approx(1.0)
    assert not goal.reached
    assert shape_wanted(goal) == "long thin elements of shape .02"


def test_a_shape_is_wanted_of_plane_quads_that_are_not_too_many(star):
    assert ShapeGoal.of(star, Effort()).aim == ShapeGoal.of(star, Effort(keep_size=True)).aim
    assert ShapeGoal.of(star, Effort(prefer="blocks")).aim < ShapeGoal.of(star, Effort()).aim
    assert ShapeGoal.of(star, Effort(elements=star.element_ids()[:3])) is None
    triangles = meshing.grid("tri", 18)
    assert ShapeGoal.of(triangles, Effort()) is None
    assert ShapeGoal.of(meshing.grid("quad", 900), Effort()) is None
    star.points[star.vertices()[0], 2] = 0.1
    assert ShapeGoal.of(star, Effort()) is None


def test_the_words_of_preferences_are_those_of_the_solver():
    assert set(PREFERENCES) == set(layout_search.PREFERENCES)


def test_blocks_of_a_bracket_are_rectangles():
    outline = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 3), (0, 3)]
    mesh = meshing.mesh_domain(Domain(outline), "quad")
    start = mesh.copy()
    effort = Effort(seconds=0.5, until_done=True)
    runner = SearchRunner(mesh, load("quad"), 0, effort, Event(), lambda *a: None)
    for operation, halfedge in runner.step():
        start.apply(operation, halfedge)
    target = runner.target
    assert np.array_equal(start.elements(), target.elements())
    assert target.score == 0 and target.n_elements == 3
    assert scaled_jacobian(target).min() == pytest.approx(1.0, abs=1e-12)
    assert runner.shape.worst == scaled_jacobian(target).min()
    ends = target.points[target.boundary() & ~target.geometric() & (target.degree() > 0), :2]
    assert sorted(ends.tolist()) == [[0.0, 1.0], [1.0, 0.0]]
