"""A tiny training: results, checkpoints, early stopping, and wrong configurations."""

import json
import signal
from types import SimpleNamespace

import numpy as np
import pytest
import torch

from meshwright_agent.evaluation.rollouts import evaluate
from meshwright_agent.policy.policy_files import load, shipped
from meshwright_agent.search.solver import solve
from meshwright_agent.training import checkpoint
from meshwright_agent.training.configuration import configuration_of
from meshwright_agent.training.tensorboard import Events
from meshwright_agent.training.trainer import (
    ConfigurationError,
    deferred_interrupt,
    read_configuration,
    shipped_configuration,
    train,
)
from meshwright_core.domains.meshing import benchmark_mesh

_TINY = {
    "sides": [8, 10],
    "pool": 12,
    "iterations": 3,
    "evaluate_every": 1,
    "evaluation_meshes": 4,
    "table_meshes": 0,
    "task": {"kind": "quad", "blocks": 2, "candidates": 8, "steps": 0.5},
    "architecture": {"width": 8, "embedding": 4},
    "ppo": {"environments": 8, "horizon": 6, "minibatch": 16, "lambda": 0.9},
}


def test_the_first_interrupt_is_noted_and_the_second_raises():
    before = signal.getsignal(signal.SIGINT)
    with deferred_interrupt() as interrupted:
        assert not interrupted()
        signal.raise_signal(signal.SIGINT)
        assert interrupted()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


@pytest.mark.slow
def test_an_interrupt_ends_the_update_and_leaves_checkpoint_and_policy(tmp_path, monkeypatch):
    monkeypatch.setattr(
        "meshwright_agent.training.trainer.evaluate",
        lambda *_: {"single_mean": 0.0, "seconds": 1.0},
    )
    folder = tmp_path / "runs" / "quad"
    with pytest.raises(KeyboardInterrupt):
        train(_TINY, folder, report=lambda done, *_: signal.raise_signal(signal.SIGINT))
    assert load(folder).name == "quad"
    done = []
    train(_TINY, folder, report=lambda i, *_: done.append(i))
    assert done == [2, 3]


@pytest.mark.slow
def test_a_training_can_be_stopped_and_resumed(tmp_path, monkeypatch):
    monkeypatch.setattr(
        "meshwright_agent.training.trainer.evaluate",
        lambda *_: {"single_mean": 0.0, "seconds": 1.0},
    )

    class Stop(Exception):
        pass

    def stop(done, total, numbers):
        assert total == 3
        assert "mean" in numbers
        if done == 2:
            raise Stop

    with pytest.raises(Stop):
        train(_TINY, tmp_path, report=stop)
    done = []
    found = train(_TINY, tmp_path, report=lambda i, *_: done.append(i))
    assert done == [3]
    assert found["iteration"] == 3
    assert len(found["curve"]) == 4
    assert load(tmp_path / "policy.safetensors").header["training"]["pool"] == 12
    assert json.loads((tmp_path / "curve.json").read_text()) == found["curve"]
    assert (tmp_path / "curve.png").stat().st_size > 5000
    with pytest.raises(ConfigurationError, match="another configuration"):
        train({**_TINY, "pool": 13}, tmp_path)


@pytest.mark.slow
def test_a_training_ends_early_and_its_best_policy_is_the_result(tmp_path, monkeypatch):
    means = iter([0.5, 0.8, 0.7, 0.8, 0.9])

    def rolled(*_):
        return SimpleNamespace(returns=np.array([[next(means)]]), gaps=np.array([[1]]))

    monkeypatch.setattr("meshwright_agent.training.trainer.roll_out", rolled)
    monkeypatch.setattr(
        "meshwright_agent.training.trainer.evaluate",
        lambda *_: {"single_mean": 0.0, "seconds": 1.0},
    )
    found = train({**_TINY, "iterations": 9, "patience": 2}, tmp_path)
    assert (found["iteration"], found["best_iteration"], found["best_return"]) == (3, 1, 0.8)
    parts, notes = checkpoint.unpack((tmp_path / "checkpoint.safetensors").read_bytes())
    assert notes["progress"]["waited"] == 2
    kept = load(tmp_path / "policy.safetensors").network.state_dict()
    assert all(torch.equal(kept[name], value) for name, value in parts["best"].items())
    assert any(not torch.equal(kept[name], value) for name, value in parts["network"].items())
    # resumed it is still at its end, and with another patience it continues
    assert train({**_TINY, "iterations": 9, "patience": 2}, tmp_path)["iteration"] == 3
    again = train({**_TINY, "iterations": 4, "patience": 3}, tmp_path)
    assert (again["iteration"], again["best_return"]) == (4, 0.9)


@pytest.mark.slow
def test_events_hold_tagged_numbers_that_are_not_nan(tmp_path):
    events = Events(tmp_path, 0)
    for update in range(1, 6):
        events.write(update, {"entropy": 1.0, "mean": float("nan"), "unknown": 3.0})
    events.close()
    content = b"".join(path.read_bytes() for path in tmp_path.iterdir())
    assert content.count(b"loss/entropy") == 5
    assert b"evaluation/return" not in content
    assert b"unknown" not in content


@pytest.mark.parametrize("name", ["tri", "quad", "tri-paper", "quad-paper"])
def test_shipped_configurations_can_be_read(name):
    training = read_configuration(shipped_configuration(name))
    assert training.task.kind == name.split("-")[0]
    assert (training.task.selection == "template") == name.endswith("paper")


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"task": {"kind": "hex"}}, 'task.kind must be "tri" or "quad", not "hex"'),
        ({"task": {}}, 'the setting "task.kind" is missing'),
        (
            {"task": {"kind": "quad", "selecton": "x"}},
            'there is no setting "task.selecton"; did you mean "task.selection"?',
        ),
        ({"colour": 3}, 'there is no setting "colour"'),
        ({"sides": [2, 9]}, "sides[0] must be a whole number of at least 3, not 2"),
        ({"sides": [9, 8]}, "sides must hold the smaller number first, not 9, 8"),
        ({"sides": [8]}, "sides must be a list of 2 values, not [8]"),
        ({"device": "tpu"}, 'device must be "auto", "cpu" or "cuda", not "tpu"'),
        ({"patience": -1}, "patience must be a whole number of at least 0, not -1"),
        ({"pool": 12.5}, "pool must be a whole number, not 12.5"),
        ({"pool": True}, "pool must be a whole number, not true"),
        ({"ppo": 3}, "ppo must be a section of settings, not 3"),
        ({"ppo": {"horizon": "long"}}, 'ppo.horizon must be a whole number, not "long"'),
        ({"ppo": {"learning_rate": 0}}, "ppo.learning_rate must be a number above 0, not 0"),
        ({"ppo": {"lambda": 1.5}}, "ppo.lambda must be a number of at most 1, not 1.5"),
        ({"architecture": {"prior": 1}}, "architecture.prior must be true or false, not 1"),
    ],
)
def test_a_wrong_configuration_is_refused_by_a_sentence_with_its_key(change, sentence):
    with pytest.raises(ConfigurationError) as refused:
        read_configuration({**_TINY, **change})
    assert str(refused.value) == f"the configuration: {sentence}"


def test_a_wrong_configuration_file_is_named(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('pool = "many"\n[task]\nkind = "quad"')
    with pytest.raises(ConfigurationError, match=r"mine\.toml: pool must be a whole number"):
        read_configuration(path)


@pytest.mark.parametrize("name", shipped())
def test_configurations_in_policy_headers_can_be_read(name):
    header = load(name).header
    training = configuration_of(header["training"], name)
    assert training.to_dict() == {**header["training"], "sides": tuple(header["training"]["sides"])}


def test_a_checkpoint_names_lambda_by_its_field():
    saved = json.loads(json.dumps(read_configuration(_TINY).to_dict()))
    assert saved["ppo"]["lambda_"] == 0.9
    assert configuration_of(saved, "checkpoint") == read_configuration(_TINY)


def test_a_configuration_that_is_not_toml_is_refused(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("sides = [10,")
    with pytest.raises(ConfigurationError, match=r"mine\.toml"):
        read_configuration(path)


@pytest.mark.slow
def test_the_shipped_quad_policy_reaches_the_optimum():
    mesh = benchmark_mesh("quad", 12, np.random.default_rng(31))
    before = mesh.elements()
    progress = []
    solution = solve(mesh, load("quad"), rollouts=10, progress=lambda *now: progress.append(now))
    assert (mesh.elements() == before).all()
    for operation, h in solution.operations:
        mesh.apply(operation, h)
    assert mesh.score == solution.score == mesh.optimum
    assert progress[-1] == (solution.rollouts, solution.score)


def test_a_search_can_be_cancelled():
    mesh = benchmark_mesh("quad", 12, np.random.default_rng(31))
    solution = solve(mesh, load("quad"), rollouts=10, cancelled=lambda: True)
    assert solution.operations == []
    assert solution.score == mesh.score


@pytest.mark.slow
def test_evaluation_is_repeatable_and_beats_doing_nothing():
    rows = [evaluate("tri", (8, 10), 4, 2, seed=3) for _ in range(2)]
    for row in rows:
        row.pop("seconds")
    assert rows[0] == rows[1]
    assert 0.3 < rows[0]["single_mean"] <= rows[0]["best_mean"] <= 1.0
