"""What the settings say about the whole window, applied to it now and whenever they change."""

from __future__ import annotations

from typing import TYPE_CHECKING

from qtpy.QtCore import Qt
from qtpy.QtGui import QGuiApplication

from meshwright.desktop.application.settings import SYSTEM

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


class Preferences:
    """Applies the window's settings: theme, colours, numbers, smoothing, place on the screen."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window

    def connect(self) -> None:
        """Apply what is kept, and follow settings and desktop."""
        self._window.settings.changed.connect(self._on_changed)
        QGuiApplication.styleHints().colorSchemeChanged.connect(self._on_scheme_changed)
        self._apply_look()
        self._apply_editing()
        self._apply_recent()

    def release(self) -> None:
        """Keep where the window is, and let go of the settings."""
        self._window.settings.changed.disconnect(self._on_changed)
        QGuiApplication.styleHints().colorSchemeChanged.disconnect(self._on_scheme_changed)
        if not self._window.isMinimized():
            self._window.settings.geometry = self._window.saveGeometry()

    @property
    def theme(self) -> str:
        """The theme to be used now: ``"light"`` or ``"dark"``."""
        chosen = self._window.settings.theme
        return system_theme() if chosen == SYSTEM else chosen

    def restore_place(self) -> None:
        """Put the window where it was when it was closed last, if that is known."""
        geometry = self._window.settings.geometry
        if not geometry.isEmpty():
            self._window.restoreGeometry(geometry)

    def toggle_theme(self) -> None:
        """The other theme; from then on the desktop's is not followed."""
        self._window.settings.theme = "light" if self.theme == "dark" else "dark"

    def toggle_auto_smooth(self) -> None:
        """Switch the smoothing after every operation on or off."""
        settings = self._window.settings
        settings.auto_smooth = not settings.auto_smooth
        self._window.say(
            "Operations are smoothed again."
            if settings.auto_smooth
            else "Operations no longer move the vertices around them."
        )

    def show(self) -> None:
        """Open the dialog."""
        from meshwright.desktop.application.preferences_dialog import PreferencesDialog

        dialog = PreferencesDialog(self._window.settings, self._window)
        dialog.exec()
        dialog.deleteLater()

    def _apply_look(self) -> None:
        self._window.set_theme(self.theme)
        self._window.canvas.overlay.markers.numbers = self._window.settings.numbers

    def _apply_editing(self) -> None:
        self._window.document.auto_smooth = self._window.settings.auto_smooth

    def _apply_recent(self) -> None:
        self._window.empty.show_recent(self._window.settings.recent)

    def _on_changed(self, key: str) -> None:
        if key.startswith("look/"):
            self._apply_look()
        elif key.startswith("editing/"):
            self._apply_editing()
        elif key.startswith("files/recent"):
            self._apply_recent()
        self._window.refresh()

    def _on_scheme_changed(self, scheme: Qt.ColorScheme) -> None:
        if self._window.settings.theme == SYSTEM:
            self._apply_look()


def system_theme() -> str:
    """The desktop's theme; light where it does not say."""
    dark = QGuiApplication.styleHints().colorScheme() == Qt.ColorScheme.Dark
    return "dark" if dark else "light"
