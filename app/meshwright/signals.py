"""Signals: functions connect to them and are called when they are emitted; no threads, no Qt."""

from collections.abc import Callable
from typing import Any

Slot = Callable[..., Any]


class Signal:
    """A list of slots, which :meth:`emit` calls in order, in the caller's thread."""

    def __init__(self) -> None:
        self._slots: list[Slot] = []

    def connect(self, slot: Slot) -> Slot:
        """Call ``slot`` at every later emit; returned so that it can be disconnected."""
        self._slots.append(slot)
        return slot

    def disconnect(self, slot: Slot) -> None:
        """Remove ``slot``; nothing happens if it is not connected."""
        if slot in self._slots:
            self._slots.remove(slot)

    def emit(self, *arguments: Any) -> None:
        """Call every slot; slots connected or removed during the call count from the next emit."""
        for slot in tuple(self._slots):
            slot(*arguments)
