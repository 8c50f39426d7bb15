"""The base of the window's controllers, and signal connections that end together."""

from __future__ import annotations

from meshwright.graphics.theme import Theme
from meshwright.signals import Signal, Slot


class Connections:
    """Connections to signals of objects that may outlive the receiver."""

    def __init__(self) -> None:
        self._made: list[tuple[Signal, Slot]] = []

    def add(self, signal: Signal, slot: Slot) -> None:
        """Connect ``slot`` to ``signal`` until :meth:`close`."""
        signal.connect(slot)
        self._made.append((signal, slot))

    def close(self) -> None:
        """Disconnect all slots."""
        for signal, slot in self._made:
            signal.disconnect(slot)
        self._made.clear()


class Controller:
    """Connects one feature of the window to document, canvas and panels.

    A subclass receives what it needs as constructor arguments and connects there; it is complete
    when the constructor returns. The window keeps its controllers in one list, which it iterates
    to change the theme and to close them.
    """

    def __init__(self, theme: Theme) -> None:
        self._theme = theme
        self._connections = Connections()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme

    def close(self) -> None:
        """Disconnect, and end timers, threads and dialogs; called once, when the window closes."""
        self._connections.close()
