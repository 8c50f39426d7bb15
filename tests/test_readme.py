"""README is true: pictures, commands, names and files that it mentions exist."""

import re
from pathlib import Path

import pytest

import meshwright
from meshwright.cli.commands import COMMANDS
from meshwright_core.operations.catalogue import CATALOGUE

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def test_every_picture_is_there():
    pictures = re.findall(r'(?:\]\(|src=")(docs/[^)"]+)', README)
    assert len(pictures) > len(CATALOGUE)
    assert [name for name in pictures if not (ROOT / name).is_file()] == []


@pytest.mark.parametrize("info", CATALOGUE, ids=lambda info: f"{info.kind}-{info.operation}")
def test_every_operation_has_its_row_and_picture(info):
    row = f"| `{info.operation}`<br>"
    picture = f"docs/images/operations/{info.kind}-{info.operation}.png"
    assert any(row in line and picture in line for line in README.splitlines())
    assert info.beyond_paper == any(
        picture in line and "beyond the paper" in line for line in README.splitlines()
    )


def test_ci_runs_the_test_command_word_for_word():
    (command,) = re.findall(r"^(\.venv/bin/pip install .* -m pytest.*)$", README, re.MULTILINE)
    install, run = command.split(" && ")
    ci = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert install.replace("install ", "install --quiet ") + " && " + run in ci


def test_commands_that_are_named_exist():
    named = set(re.findall(r"^meshwright ([a-z]+) ", README, re.MULTILINE))
    assert named - {"star", "part"} <= set(COMMANDS)
    assert {"mesh", "improve", "evaluate", "train"} <= named


def test_names_of_the_package_that_are_used_exist():
    assert set(re.findall(r"\bmw\.(\w+)", README)) <= set(meshwright.__all__)


def test_folders_and_files_that_are_named_exist():
    named = re.findall(r"`?\b((?:meshcore|agent|app|assets|tests|docs)/[\w./-]*\w)", README)
    assert [name for name in named if not (ROOT / name).exists()] == []


def test_licences_that_bind_are_named():
    assert "non-commercial" in README
    assert "LGPL" in README
