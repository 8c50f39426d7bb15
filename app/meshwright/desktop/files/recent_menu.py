"""The menu of recent files."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from qtpy.QtWidgets import QMenu, QWidget

from meshwright.desktop.application.settings import Settings


class RecentMenu(QMenu):
    """Lists the recent files of ``settings`` when it opens; calls ``open_file(path)`` for the
    chosen one.
    """

    def __init__(
        self, settings: Settings, open_file: Callable[[str], object], parent: QWidget
    ) -> None:
        super().__init__(parent)
        self._settings = settings
        self._open = open_file
        self.setToolTipsVisible(True)
        self.aboutToShow.connect(self.fill)

    def fill(self) -> None:
        """List the files, the latest first, each with its folder."""
        self.clear()
        for number, path in enumerate(self._settings.recent, start=1):
            place = Path(path)
            key = f"&{number % 10}  " if number <= 10 else ""
            entry = self.addAction(f"{key}{_plain(place.name)}\t{_plain(short(place.parent))}")
            entry.setToolTip(path)
            entry.setEnabled(place.exists())
            entry.triggered.connect(partial(self._on_chosen, path))
        if self._settings.recent:
            self.addSeparator()
            self.addAction("Clear this list").triggered.connect(self._on_clear)

    def _on_chosen(self, path: str, checked: bool = False) -> None:
        self._open(path)

    def _on_clear(self, checked: bool = False) -> None:
        self._settings.recent = []


def short(folder: Path) -> str:
    """The folder with ``~`` for home, shortened in the middle if it is long."""
    text = str(folder)
    home = str(Path.home())
    if text == home or text.startswith(home + "/"):
        text = "~" + text[len(home) :]
    return text if len(text) <= 40 else f"{text[:16]}\u2026{text[-23:]}"


def _plain(text: str) -> str:
    """``text`` with mnemonic and tab characters escaped."""
    return text.replace("&", "&&").replace("\t", " ")
