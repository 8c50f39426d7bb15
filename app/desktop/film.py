"""The film: the history as something to walk through, to play and to export."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.desktop.window import MainWindow


class Film:
    """History list, timeline and export of one window."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window

    def connect(self) -> None:
        """Follow the document."""

    def release(self) -> None:
        """Let go of the document."""
