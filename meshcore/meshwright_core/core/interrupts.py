"""Holds Ctrl-C back while code runs that an exception must not leave half-way."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def interrupts_held() -> Iterator[None]:
    """Deliver a SIGINT that comes during the block when it has ended.

    LLVM calls back into Python while it links machine code; a KeyboardInterrupt there is lost
    together with the code that the callback was to return, and the process crashes at the first
    call of that code. Signals are delivered to the main thread only, so nothing is held in others,
    nor where the program has no handler in Python.
    """
    handler = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(handler):
        yield
        return
    came: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
        if came:
            signal.raise_signal(signal.SIGINT)
