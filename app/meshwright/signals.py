"""A signal: views connect to it, the document emits it. Plain Python, one thread."""

from collections.abc import Callable
from typing import Any

Slot = Callable[..., Any]


class Signal:
    """An ordered list of slots that :meth:`emit` calls in turn, in the caller's thread."""

    def __init__(self) -> None:
        self._slots: list[Slot] = []

    def connect(self, slot: Slot) -> Slot:
        """Call ``slot`` at every later emit; returned so that it can be disconnected."""
        self._slots.append(slot)
        return slot

    def disconnect(self, slot: Slot) -> None:
        """Forget ``slot``; a slot that is not connected is no error."""
        if slot in self._slots:
            self._slots.remove(slot)

    def emit(self, *arguments: Any) -> None:
        """Call every slot; slots connected or disconnected meanwhile count from the next emit."""
        for slot in tuple(self._slots):
            slot(*arguments)
