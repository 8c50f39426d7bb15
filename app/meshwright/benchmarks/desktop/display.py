"""Provides a display for measuring windows: the existing one, or a virtual one."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def display(size: str = "1920x1200") -> Iterator[dict[str, str]]:
    """Yield the environment of a process that may open windows.

    Raises RuntimeError where there is neither a display nor Xvfb to make one.
    """
    environment = dict(os.environ)
    if environment.get("DISPLAY") or sys.platform != "linux":
        environment.setdefault("DISPLAY", "")
        yield environment
        return
    if shutil.which("Xvfb") is None:
        raise RuntimeError("The desktop cannot be measured: there is no display and no Xvfb.")
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{size}x24"]
    server = subprocess.Popen(command, pass_fds=(write,), stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as pipe:
            environment["DISPLAY"] = ":" + pipe.readline().strip()
        yield environment
    finally:
        server.terminate()
        server.wait()
