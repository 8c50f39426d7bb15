"""``meshwright evaluate``: tables, figures, notes in policy files; how a training shows itself."""

import io
import json
import shutil

import pytest

from meshwright import cli
from meshwright.assistant.policy_catalogue import ENDING
from meshwright.cli import training_progress
from meshwright.experiments import evaluation_table
from meshwright_agent.evaluation import paper_results
from meshwright_agent.policy import policy_files
from meshwright_agent.training import trainer


@pytest.fixture
def small_table(monkeypatch):
    rows = (
        paper_results.PaperRow((6, 7), paper_results.ReturnStatistics(0.98, 0.03)),
        paper_results.PaperRow((8, 8), *_TWO),
    )
    monkeypatch.setitem(paper_results.ROWS, "quad", rows)


_TWO = (paper_results.ReturnStatistics(0.992, 0.02), paper_results.ReturnStatistics(0.95, 0.05))


TINY = """
sides = [8, 8]
pool = 4
iterations = 1
evaluate_every = 1
evaluation_meshes = 1
table_meshes = 1

[task]
kind = "quad"
blocks = 2
candidates = 8
steps = 0.5

[architecture]
width = 8
embedding = 4

[ppo]
environments = 2
horizon = 3
minibatch = 6
"""


@pytest.mark.slow
@pytest.mark.parametrize(("more", "tables"), [((), 1), (("--no-table",), 0)])
def test_a_training_can_leave_out_the_table(more, tables, tmp_path, monkeypatch, capfd):
    asked = []
    monkeypatch.setattr(trainer, "paper_table", lambda *given: asked.append(given) or [])
    monkeypatch.setattr(
        trainer,
        "evaluate",
        lambda *_: {"single_mean": 0.0, "best_mean": 0.0, "at_optimum": 0.0, "seconds": 1.0},
    )
    (tmp_path / "tiny.toml").write_text(TINY)
    folder = tmp_path / "runs" / "quad"  # is made
    words = ["train", "--kind", "quad", "--config", str(tmp_path / "tiny.toml")]
    assert cli.main([*words, "-o", str(folder), *more, "--json"]) == 0
    assert len(asked) == tables
    assert json.loads(capfd.readouterr().out)["iteration"] == 1
    assert ("table" in policy_files.load(folder).header) == bool(tables)


@pytest.mark.slow
def test_a_table_with_everything(small_table, tmp_path, capfd):
    words = ["evaluate", "--kind", "quad", "--table", "--meshes", "2", "--rollouts", "2"]
    more = ["--baselines", "--race", "0.05", "--shorten", "0.05", "--figure", str(tmp_path / "f")]
    assert cli.main([*words, *more, "--json"]) == 0
    output = capfd.readouterr()
    assert output.err == ""
    found = json.loads(output.out)
    assert [row["sides"] for row in found["rows"]] == [[6, 7], [8, 8]]
    assert found["rows"][1]["paper"]["single_mean"] == 0.95
    for row in found["rows"]:
        assert set(row["baselines"]) == {"greedy", "plateaus", "annealing", "random_walk"}
        assert set(row["race"]) == {"policy", "annealing", "plateaus"}
        assert row["polished"]["meshes"] <= 2
    names = {path.name for path in (tmp_path / "f").iterdir()}
    drawn = ("learning", "returns", "seconds", "rollout-10", "rollout-20")
    assert names == {f"quad-{name}.png" for name in drawn}
    text = evaluation_table.all_rows("quad", "quad", found, found["rows"])
    for word in ("0.992 ± 0.02", "0.98 ± 0.03", "random walk", "solutions at s*", "0.05 s"):
        assert word.lower() in text.lower()


def test_a_table_can_be_noted_in_the_policy(small_table, tmp_path, capfd):
    path = tmp_path / f"mine{ENDING}"
    shutil.copy(policy_files._shipped_folder() / f"quad{ENDING}", path)
    words = ["evaluate", "--kind", "quad", "--meshes", "1", "--rollouts", "1", "--note"]
    assert cli.main([*words, "--table", "--policy", str(path)]) == 0
    assert "best of 1" in capfd.readouterr().out
    policy = policy_files.load(path)
    assert [row["sides"] for row in policy.header["table"]] == [[6, 7], [8, 8]]
    assert policy.header["progress"]["curve"]
    assert cli.main([*words, "--table"]) == 2
    assert "--policy" in capfd.readouterr().err
    assert cli.main([*words, "--policy", str(path)]) == 2
    assert "goes with --table" in capfd.readouterr().err


def test_a_grid_is_aligned():
    lines = evaluation_table.grid(["a", "long"], [["first", "1"], ["b", "22"]]).splitlines()
    assert lines == ["a      long", "-----------", "first     1", "b        22"]


def test_a_log_gets_a_line_for_each_evaluation():
    stream = io.StringIO()
    with training_progress.shown(stream, 3) as display:
        display.update(1, 3, {"decisions": 2048.0, "decisions_per_second": 1000.0, "entropy": 1.25})
        evaluated = {"mean": 0.9, "at_optimum": 0.5, "played": float("nan")}
        display.update(2, 3, {"decisions": 4096.0, **evaluated})
        display.update(3, 3, {"decisions": 6144.0})
        display.finish()
    head, first, last = stream.getvalue().splitlines()
    assert head.split()[:2] == ["update", "decisions"]
    assert first.split()[:6] == ["2/3", "4,096", "-", "-", "0.900", "50%"]
    assert last.split()[0] == "3/3"
    assert "0.900" in last
    assert len({len(head), len(first), len(last)}) == 1


def test_a_clock_counts_hours_only_when_there_are_some():
    assert [training_progress.clock(x) for x in (5.2, 65, 3725)] == ["0:05", "1:05", "1:02:05"]
