"""The progress of a film below the notebook cell that makes it."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from meshwright.graphics.export.video import ReportProgress

PATIENCE = 0.5
"""Seconds after which the progress is shown: a short film shows none."""
PACE = 0.2
"""Seconds between two updates."""


@contextmanager
def shown_progress() -> Iterator[ReportProgress | None]:
    """A function to report frames to, ``report(done, total)``; None outside IPython.

    The line vanishes at the end of the block, also after an interrupt.
    """
    ipython = sys.modules.get("IPython")
    if ipython is None or ipython.get_ipython() is None:
        yield None
        return
    from IPython.display import display

    began = last = time.monotonic()
    handle: Any = None

    def report(done: int, total: int) -> None:
        nonlocal handle, last
        now = time.monotonic()
        if now - began < PATIENCE or now - last < PACE:
            return
        last = now
        line = _Line(f"Film: frame {done:,} of {total:,}; interrupt the kernel to stop.")
        if handle is None:
            handle = display(line, display_id=True)
        else:
            handle.update(line)

    try:
        yield report
    finally:
        if handle is not None:
            handle.update(_Line(""))


class _Line:
    """A line of plain text as the result of a cell."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return self._text
