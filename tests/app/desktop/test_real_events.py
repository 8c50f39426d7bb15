"""The program started from the command line, driven by X events (xdotool)."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from meshwright.document.storage import autosave_log, recovery

PATIENCE = 90.0

pytestmark = [pytest.mark.needs("window", "xdotool"), pytest.mark.slow]


class Program:
    """Start ``meshwright`` in a process, with settings and state in ``home``."""

    def __init__(self, home: Path, *words: str) -> None:
        self.environment = {
            **os.environ,
            "XDG_CONFIG_HOME": str(home / "config"),
            "MESHWRIGHT_STATE_DIR": str(home / "state"),
        }
        self.process = subprocess.Popen(
            [sys.executable, "-m", "meshwright", *words], env=self.environment, cwd=home
        )

    def xdotool(self, *words: str) -> str:
        """The output of xdotool; empty if it finds nothing."""
        done = subprocess.run(
            ["xdotool", *words], env=self.environment, capture_output=True, text=True, timeout=30
        )
        return done.stdout.strip()

    def window(self, title: str) -> str:
        """Wait for the X window with this title."""

        def found() -> str:
            ids = self.xdotool("search", "--onlyvisible", "--name", title).split()
            return ids[-1] if ids else ""

        return until(found)

    def kill(self) -> None:
        """Kill the process."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()


def until(condition):
    """Poll until the result is not empty."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        answer = condition()
        if answer:
            return answer
        time.sleep(0.1)
    pytest.fail("the program did not get there")


def steps(state: Path) -> int:
    """Number of steps in the autosave file."""
    written = [list(autosave_log.records(path)) for path in (state / "autosave").glob("*.journal")]
    return max((len(records) for records in written), default=0)


def test_work_edited_by_keys_is_recovered_after_a_crash(tmp_path):
    state = tmp_path / "state"
    program = Program(tmp_path, "star")
    try:
        places = [(x, y) for y in range(250, 600, 35) for x in range(330, 880, 55)]

        def edited() -> bool:
            x, y = places[edited.turn % len(places)]
            edited.turn += 1
            window = program.window("^star")  # Qt recreates the X window with the canvas
            program.xdotool("windowfocus", window)
            program.xdotool("mousemove", "--window", window, str(x), str(y), "key", "f")
            return steps(state) >= 2

        edited.turn = 0
        until(edited)
    finally:
        program.kill()
    done = steps(state)
    found = recovery.lost(state / "autosave")
    assert len(found) == 1 and found[0].name == "star"
    kept = found[0].read()
    kept.mesh.validate()
    assert len(kept.history) == found[0].now["steps"] == done
    found[0].release()

    program = Program(tmp_path)
    try:
        dialog = program.window("^Recover work")
        program.xdotool("windowfocus", dialog, "key", "Return")
        program.window("^star")
    finally:
        program.kill()
