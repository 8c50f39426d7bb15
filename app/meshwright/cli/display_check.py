"""Checks whether a window can be opened on this machine.

Qt aborts the process if it cannot open its display, so a child process tries first.
"""

from __future__ import annotations

import os
import subprocess
import sys

TRY = "from qtpy.QtWidgets import QApplication; QApplication([])"

PATIENCE = 30.0
"""Time limit, in seconds, for the display to answer."""


class DisplayProbe:
    """A child process that opens Qt while this process continues.

    Without a display named in the environment no child is started. On Windows and macOS a display
    is assumed to exist.
    """

    def __init__(self) -> None:
        """Start the child."""
        self._child: subprocess.Popen[str] | None = None
        self._problem = ""
        if sys.platform in ("win32", "darwin"):
            return
        if not os.environ.get("DISPLAY") and not os.environ.get("WAYLAND_DISPLAY"):
            self._problem = "there is no display here (neither DISPLAY nor WAYLAND_DISPLAY is set)"
            return
        self._child = subprocess.Popen(
            [sys.executable, "-c", TRY],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )

    def problem(self) -> str:
        """Return why no window can be opened, or an empty text; waits for the child."""
        if self._child is None:
            return self._problem
        try:
            _, errors = self._child.communicate(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            self._child.kill()
            self._child.communicate()
            return f"the display did not answer within {PATIENCE:.0f} seconds"
        if self._child.returncode == 0:
            return ""
        lines = [line for line in errors.splitlines() if line.strip()]
        return "Qt cannot open the display" + (f" ({lines[0].strip()})" if lines else "")
