"""Calls from worker threads into Qt's main thread."""

from collections.abc import Callable

from qtpy.QtCore import QObject, Qt, Signal, Slot


class Dispatcher(QObject):
    """Runs calls in the thread that constructed it, in order, from the event loop.

    The slot is a bound method because a lambda would run in the emitting thread.
    """

    _queued = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self._queued.connect(self._call, Qt.ConnectionType.QueuedConnection)

    def __call__(self, call: Callable[[], None]) -> None:
        """Queue ``call()``; returns at once, from any thread."""
        self._queued.emit(call)

    @Slot(object)
    def _call(self, call: Callable[[], None]) -> None:
        call()
