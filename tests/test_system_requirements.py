"""Where a display, a browser or Qt's libraries are missing, tests are skipped, with the reason."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="a display is always there"),
]


def run_tests(path: Path, *names: str, **environment: str) -> str:
    """Run tests without a display, with ``path`` for PATH; returns what pytest printed."""
    kept = {name: os.environ[name] for name in os.environ if "DISPLAY" not in name}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider", *names],
        env={**kept, "PATH": str(path), **environment},
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_without_display_and_browser_widgets_run_and_windows_are_skipped(tmp_path):
    printed = run_tests(
        tmp_path,
        "tests/app/desktop/test_number_box.py",
        "tests/app/desktop/test_real_events.py",
        "tests/app/notebook/test_marimo.py",
    )
    assert "needs a display or Xvfb: apt-get install xvfb" in printed
    assert "needs Chromium: apt-get install chromium" in printed
    assert "2 passed" in printed


def test_without_libraries_of_qt_its_tests_are_skipped(tmp_path):
    reason = "libEGL.so.1: cannot open shared object file"
    (tmp_path / "PySide6.py").write_text(f"raise ImportError({reason!r})\n")
    printed = run_tests(
        tmp_path,
        "tests/app/desktop/test_number_box.py",
        "tests/app/graphics/test_theme.py",
        PYTHONPATH=str(tmp_path),
    )
    assert f"needs the libraries that Qt loads ({reason}): apt-get install libegl1" in printed
    assert "passed" in printed
