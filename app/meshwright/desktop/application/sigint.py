"""Ctrl-C in the terminal that the window was started from.

While Qt waits for events Python gets no turn to notice the signal. So the signal is written to a
socket that Qt listens to, and the window is closed as if by its button.
"""

import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from qtpy.QtCore import QSocketNotifier


@contextmanager
def on_interrupt(close: Callable[[], object]) -> Iterator[None]:
    """Call ``close`` when Ctrl-C comes while the block runs; raise KeyboardInterrupt after it.

    Outside the main thread, where Python takes no signals, this does nothing.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    writer, reader = socket.socketpair()
    writer.setblocking(False)
    reader.setblocking(False)
    notifier = QSocketNotifier(reader.fileno(), QSocketNotifier.Type.Read)

    def wake() -> None:
        reader.recv(64)
        if came:
            close()

    notifier.activated.connect(wake)
    handler = signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    wakeup = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
    try:
        yield
    finally:
        signal.set_wakeup_fd(wakeup)
        signal.signal(signal.SIGINT, handler)
        notifier.setEnabled(False)
        writer.close()
        reader.close()
    if came:
        raise KeyboardInterrupt
