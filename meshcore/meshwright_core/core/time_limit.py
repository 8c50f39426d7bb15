"""A limit on the processor time of reading and meshing what a hostile file may hold.

Long computations call :func:`check_time` where they go around; it raises MeshError once the limit
of the innermost caller's outermost :func:`time_limit` has passed. Time is that of the calling
thread, so that a busy machine, or another thread, does not make a sound file fail.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from meshwright_core.errors import MeshError

SECONDS = 30.0
"""Seconds of processor time that reading a drawing, or meshing a domain, may take by default."""

_limit: ContextVar[tuple[float, float] | None] = ContextVar("time limit", default=None)
"""When the time of this thread is over, and the seconds that were allowed."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Let what runs inside take so many seconds of this thread's processor time at most.

    Where a limit holds already, that one stays: whoever started the whole decides.

    Raises:
        MeshError: by :func:`check_time`, once the time is over; `seconds` is not positive.
    """
    if not seconds > 0.0:
        raise MeshError(f"A time limit must be a positive number of seconds, not {seconds:g}.")
    if _limit.get() is not None:
        yield
        return
    token = _limit.set((time.thread_time() + seconds, seconds))
    try:
        yield
    finally:
        _limit.reset(token)


def check_time() -> None:
    """Raise MeshError if the time limit that holds here, if any, has passed."""
    limit = _limit.get()
    if limit is not None and time.thread_time() > limit[0]:
        refuse_longer()


def time_left() -> float:
    """Seconds until the limit that holds here; infinite without one."""
    limit = _limit.get()
    return math.inf if limit is None else max(0.0, limit[0] - time.thread_time())


def refuse_longer() -> None:
    """Raise the MeshError of the limit that holds here, or of the default one."""
    limit = _limit.get()
    seconds = SECONDS if limit is None else limit[1]
    raise MeshError(
        f"This takes more than {seconds:g} s of processor time: simplify what is drawn, ask for "
        "longer edges, or raise the time limit."
    )
