"""Closing the window by Ctrl-C in the terminal.

While Qt waits for events, Python does not run and cannot handle the signal. Therefore the signal is
written to a socket that Qt monitors, and the window is closed from there.
"""

import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from qtpy.QtCore import QSocketNotifier


@contextmanager
def on_interrupt(close: Callable[[], object]) -> Iterator[None]:
    """Call ``close`` on Ctrl-C while the block runs, and raise KeyboardInterrupt after it.

    Does nothing outside the main thread, where Python handles no signals.
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
