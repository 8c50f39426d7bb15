"""``meshwright levels`` and ``meshwright play``."""

import json

import pytest

from meshwright import cli, desktop
from meshwright.cli import display_check
from meshwright.puzzles import level as levels
from meshwright.puzzles.progress import LevelProgress


@pytest.fixture(autouse=True)
def _own_stars(monkeypatch, tmp_path):
    monkeypatch.setenv("MESHWRIGHT_STATE_DIR", str(tmp_path))


@pytest.fixture
def opened(monkeypatch):
    """The levels that the window was opened on."""
    found = []
    monkeypatch.setattr(display_check.DisplayProbe, "problem", lambda self: "")
    monkeypatch.setattr(desktop, "run", lambda level: found.append(level.name) or 0)
    return found


def test_levels_are_listed_with_their_stars(capsys):
    LevelProgress().note("two-turns", 2, 3)
    assert cli.main(["levels"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == len(levels.names())
    assert lines[0].endswith("One flip: 24 triangles, par 1")
    assert lines[3].endswith("par 2, ** in 3")


def test_levels_as_json(capsys):
    assert cli.main(["levels", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["levels"]
    assert [row["name"] for row in rows] == list(levels.names())
    star = rows[-1]
    assert (star["goal"], star["par"], star["proved"], star["stars"]) == (4, 4, True, 0)


def test_play_opens_the_window_on_a_level(capsys, opened):
    assert cli.main(["play", "star"]) == 0
    assert cli.main(["play"]) == 0
    LevelProgress().note("one-flip", 1, 4)
    assert cli.main(["play", "--json"]) == 0
    assert opened == ["star", "one-flip", "quarter-turn"]
    assert json.loads(capsys.readouterr().out)["level"] == "quarter-turn"


def test_an_unknown_level_is_refused_in_one_line(capsys, opened):
    assert cli.main(["play", "two-flip"]) == 2
    output = capsys.readouterr().err
    assert "did you mean two-flips" in output
    assert output.count("\n") == 1
    assert opened == []


def test_play_without_a_display_is_refused(capsys, monkeypatch):
    monkeypatch.setattr(display_check.DisplayProbe, "problem", lambda self: "There is no display")
    assert cli.main(["play"]) == 2
    assert "notebook" in capsys.readouterr().err
