"""Learning curves are read as they were written; damaged and other files are refused."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from meshwright.experiments import learning_curves
from meshwright.experiments.training_log import updates
from meshwright_agent.training.configuration import configuration_of
from meshwright_agent.training.tensorboard import available
from meshwright_agent.training.trainer import CHECKPOINT, EVENTS, Trainer
from meshwright_core import MeshError

TINY = {
    "sides": [5, 6],
    "pool": 4,
    "iterations": 3,
    "evaluation_meshes": 4,
    "task": {"kind": "quad", "blocks": 1, "channels": 2},
    "architecture": {"width": 8, "embedding": 4, "prior": False},
    "ppo": {"environments": 4, "horizon": 4, "minibatch": 16},
}


@pytest.fixture(scope="module")
def trained(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Trainer, list[dict]]:
    """A training of three updates as it is on the disk while it runs."""
    from meshwright_agent.training.tensorboard import Events

    folder = tmp_path_factory.mktemp("trainings") / "tiny"
    trainer = Trainer(configuration_of(TINY, "tiny"), folder)
    events, recorded = Events(folder / EVENTS, 0), []
    trainer.measure()
    for update in range(1, 4):
        recorded.append(trainer.improve() | trainer.measure())
        events.write(update, recorded[-1])
    events.close()
    trainer.save()
    return folder, trainer, recorded


def test_running_training_is_read_from_its_checkpoint(trained) -> None:
    folder, trainer, _ = trained
    curves = learning_curves(folder)
    training = curves["tiny"]
    for name, values in training.points.items():
        assert values.tolist() == [point[name] for point in trainer.progress.curve]
    assert len(curves.rows) == 4 and curves.rows[0]["training"] == "tiny"
    assert learning_curves(folder / CHECKPOINT).rows == curves.rows
    assert training.series("mean")[0].tolist() == training.points["decisions"].tolist()


def test_curve_files_and_policies_are_read(trained, tmp_path: Path) -> None:
    folder, trainer, _ = trained
    (tmp_path / "curve.json").write_text(json.dumps(trainer.progress.curve))
    assert learning_curves(tmp_path, names=["tiny"]).rows == learning_curves(folder).rows
    both = learning_curves("quad", "quad-paper")
    assert [one.name for one in both.trainings] == ["quad", "quad-paper"]
    assert both["quad"].points["mean"][-1] > 0.99
    assert both.to_svg().count("<text") > 10


@pytest.mark.skipif(not available(), reason="events are written by an optional package")
def test_quantities_of_updates_are_read_from_events(trained) -> None:
    folder, _, recorded = trained
    curves = learning_curves(folder)
    for name in ("entropy", "policy", "value", "decisions"):
        steps, values = updates(folder)[name]
        assert steps.tolist() == [1, 2, 3]
        assert values == pytest.approx([numbers[name] for numbers in recorded], rel=1e-6)
    plotted = curves.plot("entropy", "decisions_per_second")
    assert "updates" in plotted.to_svg() and curves.quantities == ("mean", "at_optimum")
    with pytest.raises(MeshError, match="has no 'speed'"):
        curves.plot("speed")


def test_damaged_and_other_files_are_refused_in_one_sentence(trained, tmp_path: Path) -> None:
    folder = trained[0]
    whole = (folder / CHECKPOINT).read_bytes()
    for i, content in enumerate(
        (b"", whole[:4], whole[:100], whole[: len(whole) // 2], whole[:-1], b"\xff" * 64)
    ):
        damaged = tmp_path / f"{i}.safetensors"
        damaged.write_bytes(content)
        with pytest.raises(MeshError, match="no learning curve") as caught:
            learning_curves(damaged)
        assert "\n" not in str(caught.value)
    for text in ("", "{", "3", "[1]", '[{"mean": 1}]', '{"a": []}', "[" * 5000):
        (tmp_path / "curve.json").write_text(text)
        with pytest.raises(MeshError, match="no learning curve"):
            learning_curves(tmp_path / "curve.json")
    (tmp_path / "curve.json").write_text("[]")
    with pytest.raises(MeshError, match="not been evaluated"):
        learning_curves(tmp_path / "curve.json")


@pytest.mark.skipif(not available(), reason="events are written by an optional package")
def test_damaged_events_are_refused(trained, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(trained[0], copy)
    (path,) = (copy / EVENTS).iterdir()
    content = path.read_bytes()
    generator = np.random.default_rng(0)
    path.write_bytes(content[: len(content) // 2 + 3])
    with pytest.raises(MeshError, match="events"):
        learning_curves(copy)
    for _ in range(60):  # any content is either read or refused in one sentence
        noise = bytearray(content)
        for at in generator.integers(0, len(noise), 5).tolist():
            noise[at] = int(generator.integers(0, 256))
        path.write_bytes(bytes(noise))
        try:
            learning_curves(copy)
        except MeshError as error:
            assert "\n" not in str(error)


def test_wrong_arguments_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MeshError, match="nothing to read"):
        learning_curves()
    with pytest.raises(MeshError, match="no such file"):
        learning_curves(tmp_path / "none")
    with pytest.raises(MeshError, match="holds no training"):
        learning_curves(tmp_path)
    with pytest.raises(MeshError, match="named by text"):
        learning_curves(3)  # type: ignore[arg-type]
    with pytest.raises(MeshError, match="1 trainings, but 2 names"):
        learning_curves("quad", names=["a", "b"])
    with pytest.raises(MeshError, match="up to 4 trainings"):
        learning_curves(*["quad"] * 5).to_svg()
    with pytest.raises(MeshError, match="no training 'x'"):
        learning_curves("quad")["x"]
