"""The wheel carries the three packages and every file that travels with the program."""

import re
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from meshwright.notebook import bundle

ROOT = Path(__file__).parents[1]
ROOTS = ("meshcore", "agent", "app", "assets")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> zipfile.ZipFile:
    folder = tmp_path_factory.mktemp("dist")
    done = subprocess.run(
        [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", folder, ROOT],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (path,) = folder.glob("*.whl")
    with zipfile.ZipFile(path) as archive:
        yield archive


def source_files() -> set[str]:
    """Everything in the packages that git would keep, by its path in the wheel."""
    names = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *ROOTS],
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
    ).stdout.split("\n")
    return {name.partition("/")[2] for name in names if name and (ROOT / name).is_file()}


def test_wheel_carries_every_file_of_the_packages(wheel):
    carried = {name for name in wheel.namelist() if ".dist-info/" not in name}
    assert carried == source_files()


def test_wheel_carries_a_policy_of_each_kind(wheel):
    policies = [name for name in wheel.namelist() if name.endswith(".safetensors")]
    assert any("tri" in name for name in policies)
    assert any("quad" in name for name in policies)


def test_wheel_carries_the_widget_and_the_lessons(wheel):
    carried = set(wheel.namelist())
    for name in (*bundle.SCRIPTS, *bundle.STYLES):
        assert f"meshwright/notebook/front/{name}" in carried
    lessons = [
        name for name in carried if re.fullmatch(r"meshwright_assets/lessons/[^/]+\.ipynb", name)
    ]
    assert len(lessons) >= 6


def test_wheel_carries_command_and_licence(wheel):
    (info,) = {name.split("/")[0] for name in wheel.namelist() if ".dist-info/" in name}
    assert "meshwright = meshwright.cli:main" in wheel.read(f"{info}/entry_points.txt").decode()
    assert f"{info}/licenses/LICENSE" in wheel.namelist()
