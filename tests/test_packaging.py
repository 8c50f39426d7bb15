"""The wheel holds the four packages and nothing else, and their names clash with no other's."""

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[1]
PACKAGES = {
    "meshwright_core": "meshcore",
    "meshwright_agent": "agent",
    "meshwright": "app",
    "meshwright_assets": "assets",
}


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
    folders = [f"{folder}/{package}" for package, folder in PACKAGES.items()]
    names = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *folders],
        capture_output=True,
        text=True,
        check=True,
        cwd=ROOT,
    ).stdout.split("\n")
    return {name.partition("/")[2] for name in names if name and (ROOT / name).is_file()}


def test_wheel_holds_every_file_of_the_four_packages_and_nothing_else(wheel):
    carried = {name for name in wheel.namelist() if ".dist-info/" not in name}
    assert carried == source_files()
    assert {name.partition("/")[0] for name in carried} == set(PACKAGES)
    assert {f"{package}/py.typed" for package in PACKAGES} <= carried


def test_wheel_holds_command_and_licence(wheel):
    (info,) = {name.split("/")[0] for name in wheel.namelist() if ".dist-info/" in name}
    assert (
        "meshwright = meshwright.__main__:main" in wheel.read(f"{info}/entry_points.txt").decode()
    )
    assert f"{info}/licenses/LICENSE" in wheel.namelist()


def test_files_of_common_names_beside_the_caller_are_not_imported():
    check = ROOT / ".ci" / "shadowed_names.py"
    done = subprocess.run([sys.executable, check, sys.executable], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
