"""Rollouts, baselines for the same time, and figures of them."""

import numpy as np
import pytest

from meshwright_agent.evaluation import figures, paper_results, rollout_strip
from meshwright_agent.evaluation.baselines import BASELINES, RACERS, attempt, share_within
from meshwright_agent.evaluation.rollouts import NothingToDo, longer, roll_out, unseen
from meshwright_agent.evaluation.table_row import RowSettings, assess
from meshwright_agent.policy.policy_files import load
from meshwright_core.mesh import HalfEdgeMesh


@pytest.fixture(scope="module")
def policy():
    return load("quad")


@pytest.fixture(scope="module")
def meshes():
    return unseen("quad", (8, 9), 2, seed=4)


@pytest.fixture(scope="module")
def rolled(policy, meshes):
    return roll_out(policy, meshes, 2, seed=4)


def test_steps_replay_to_the_best_state(policy, meshes, rolled):
    for i, mesh in enumerate(meshes):
        for k in range(2):
            steps = rolled.steps(policy.task, mesh, i, k)
            assert len(steps) == rolled.operations[i, k]
            replayed = mesh.copy()
            for operation, h in [one for step in steps for one in step]:
                replayed.apply(operation, h)
            assert replayed.score - replayed.optimum == rolled.gaps[i, k]
            assert replayed.n_elements / mesh.n_elements == rolled.elements[i, k]


def test_traces_contain_the_start_and_the_best_state(meshes, rolled):
    for k, trace in enumerate(rolled.traces):
        assert trace.gaps[0].tolist() == [mesh.score - mesh.optimum for mesh in meshes]
        assert trace.gaps.min(axis=0).tolist() == rolled.gaps[:, k].tolist()
        assert len(trace.gaps) == len(trace.codes) + 1 == len(trace.halfedges) + 1


def test_longer_episodes_share_the_network(policy):
    twice = longer(policy, 2.0)
    assert twice.task.step_limit(40) == 2 * policy.task.step_limit(40)
    assert twice.network.head is policy.network.head


def test_polygons_that_start_at_the_optimum_are_refused(monkeypatch):
    square = HalfEdgeMesh.from_elements([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2, 3]])
    monkeypatch.setattr("meshwright_agent.evaluation.rollouts.start_meshes", lambda *_: [square])
    with pytest.raises(NothingToDo, match="at its optimum"):
        unseen("quad", (4, 4), 1, seed=0)


@pytest.mark.parametrize("method", sorted({*BASELINES, *RACERS}))
@pytest.mark.slow
def test_every_baseline_ends_between_optimum_and_start(method, policy, meshes):
    mesh = meshes[0]
    before = mesh.score
    found = attempt(method, mesh, policy, 20.0 if method == "policy" else 0.05, seed=1)
    assert mesh.optimum <= found.score <= mesh.score == before
    assert found.seconds > 0
    if method == "policy":
        assert found.score == mesh.optimum


def test_share_within_counts_only_times_below_the_limit():
    times = np.array([0.1, 0.5, np.inf, 2.0])
    assert [share_within(times, seconds) for seconds in (0.1, 1.0, 5.0)] == [0.25, 0.5, 0.75]


@pytest.mark.slow
def test_a_row_and_its_figures(policy, tmp_path):
    wanted = RowSettings(2, 2, seed=4, race=0.05, polish=0.05)
    found = assess(policy, (8, 9), wanted)
    polished = found.numbers["polished"]
    assert polished["coarse_elements_mean"] <= polished["elements_mean"] + 1e-9
    assert set(found.numbers["race"]) == set(RACERS)
    assert found.numbers["paper"] is None
    curve = policy.header["progress"]["curve"]
    mesh = found.meshes[0]
    steps = found.rolled.steps(policy.task, mesh, 0, int(found.rolled.best()[0]))
    figures.learning_curve(curve, "quad", "Quads", tmp_path / "learning.png")
    figures.returns_by_steps([("8-9 sides", found.rolled, 0.98)], "quad", tmp_path / "steps.png")
    figures.shares_by_seconds([("8-9 sides", found.times)], 0.05, "quad", tmp_path / "race.png")
    rollout_strip.rollout_strip(mesh, steps, tmp_path / "strip.svg")
    for name in ("learning.png", "steps.png", "race.png", "strip.svg"):
        assert (tmp_path / name).stat().st_size > 10_000


def test_rows_of_the_paper():
    assert [row.best.mean for row in paper_results.ROWS["tri"]] == [
        0.83,
        0.87,
        0.83,
        0.78,
        0.75,
        0.86,
    ]
    assert [row.best.mean for row in paper_results.ROWS["quad"]] == [0.98, 0.97, 0.94, 0.91, 0.992]
    assert (paper_results.single("tri"), paper_results.single("quad")) == (0.81, 0.95)
    assert paper_results.row("tri", (10, 21)) is None
