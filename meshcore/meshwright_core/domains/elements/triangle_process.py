"""Runs Triangle in a process of its own, which ends when its time or memory is used up.

Triangle is native code that cannot be interrupted; on points that nearly coincide it may go around
for ever. Run as a script, this file reads arrays from its standard input and writes arrays to its
standard output, both as .npz; it imports nothing of the package, so that it starts fast.
"""

from __future__ import annotations

import contextlib
import io
import math
import os
import subprocess
import sys
from typing import Any

import numpy as np

_WALL = 4.0
"""Seconds of the clock for each second of processor time, on a busy machine."""
_BYTES = 4 << 30
"""Address space of the process."""
_COMMAND = [os.path.abspath(__file__)]
"""What Python runs in it."""


class TriangleStopped(Exception):
    """The process ended without a result: its time, or its memory, was used up."""


def triangulate(mesh: dict[str, Any], switches: str, seconds: float) -> dict[str, Any]:
    """The result of ``triangle.triangulate`` within so many seconds of processor time.

    Raises:
        TriangleStopped: there is none.
    """
    given = io.BytesIO()
    np.savez(given, switches=np.array(switches), seconds=np.array(seconds), **mesh)
    try:
        done = subprocess.run(
            [sys.executable, *_COMMAND],
            input=given.getvalue(),
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            timeout=_WALL * (seconds + 1.0),
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise TriangleStopped from error
    if done.returncode != 0:
        raise TriangleStopped
    with np.load(io.BytesIO(done.stdout)) as found:
        return dict(found)


def _limit(seconds: float) -> None:
    """Limit processor time and memory of this process, where the system can."""
    try:
        import resource
    except ImportError:  # Windows: the caller's clock ends it
        return
    most = math.ceil(seconds) + 1
    # systems may refuse a limit on addresses
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_CPU, (most, most + 1))
        resource.setrlimit(resource.RLIMIT_AS, (_BYTES, _BYTES))


def main() -> None:
    """Read the arrays, call Triangle, write the arrays."""
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    # what Triangle prints must not mix with the arrays
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    with np.load(io.BytesIO(sys.stdin.buffer.read())) as given:
        mesh = dict(given)
    switches, seconds = str(mesh.pop("switches")), float(mesh.pop("seconds"))
    import triangle

    _limit(seconds)
    found = triangle.triangulate(mesh, switches)
    result = io.BytesIO()
    arrays: dict[str, Any] = {name: np.asarray(value) for name, value in found.items()}
    np.savez(result, **arrays)
    answers.write(result.getvalue())
    answers.close()


if __name__ == "__main__":
    main()
