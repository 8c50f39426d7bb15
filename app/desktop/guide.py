"""Guidance: pages of help, and what shows a person around."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.desktop import actions, pages

if TYPE_CHECKING:
    from app.desktop.window import MainWindow


class Guide:
    """Help for one window."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window

    def connect(self) -> None:
        """Follow the window."""

    def release(self) -> None:
        """Close what is open."""

    def show_keys(self) -> None:
        """All keys, and what the mouse does."""
        pages.KeysDialog(actions.groups(self._window), self._window).exec()

    def show_about(self) -> None:
        """Version and licences."""
        pages.AboutDialog(self._window).exec()
