"""``import meshwright`` works beside files with common names, and README's example runs."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow

README = Path(__file__).parents[2] / "README.md"


@pytest.fixture
def folder(tmp_path):
    """A folder with modules of common names that must not be imported."""
    for name in ("app", "agent", "assets", "meshcore"):
        (tmp_path / f"{name}.py").write_text(f"raise ImportError('{name}.py was imported')\n")
    return tmp_path


def run(code: str, folder: Path) -> str:
    """What the code prints; it runs with the folder first on the import path."""
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, timeout=170
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_readme_example_in_python(folder):
    (code,) = (
        block
        for block in re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.S)
        if "mw.solve(" in block
    )
    assert len([line for line in code.splitlines() if line]) <= 10
    lines = run(code, folder).splitlines()
    before, after, optimum, _ = map(int, lines[-1].split())
    assert before > after >= optimum
    assert (folder / "star.vtk").stat().st_size > 0
