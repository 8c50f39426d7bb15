"""Applies the settings to the window, at the start and when they change."""

from __future__ import annotations

from collections.abc import Callable

from qtpy.QtCore import Qt
from qtpy.QtGui import QGuiApplication
from qtpy.QtWidgets import QWidget

from meshwright.desktop.application.settings import SYSTEM, Settings
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme


class PreferencesController(Controller):
    """Applies the settings: theme, colours, numbers, smoothing, position of ``window``.

    ``set_window_theme(name)`` changes the theme of the whole window.
    """

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        settings: Settings,
        status: StatusBar,
        window: QWidget,
        set_window_theme: Callable[[str], None],
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._settings = document, canvas, settings
        self._status, self._window = status, window
        self._set_window_theme = set_window_theme
        self._connections.add(settings.changed, self._on_changed)
        QGuiApplication.styleHints().colorSchemeChanged.connect(self._on_scheme_changed)
        self._show_numbers()
        self._apply_editing()

    def close(self) -> None:
        """Save the position of the window, and disconnect."""
        super().close()
        QGuiApplication.styleHints().colorSchemeChanged.disconnect(self._on_scheme_changed)
        if not self._window.isMinimized():
            self._settings.geometry = self._window.saveGeometry()

    def restore_place(self) -> None:
        """Restore the position at which the window was closed last, if it is known."""
        geometry = self._settings.geometry
        if not geometry.isEmpty():
            self._window.restoreGeometry(geometry)

    def toggle_theme(self) -> None:
        """Switch between light and dark; the desktop's theme is no longer followed."""
        self._settings.theme = "light" if theme_name(self._settings) == "dark" else "dark"

    def toggle_auto_smooth(self) -> None:
        """Switch the smoothing after every operation on or off."""
        settings = self._settings
        settings.auto_smooth = not settings.auto_smooth
        self._status.show_message(
            "Vertices are smoothed after every operation."
            if settings.auto_smooth
            else "Vertices are no longer smoothed after operations."
        )

    def show(self) -> None:
        """Open the preferences dialog."""
        from meshwright.desktop.application.preferences_dialog import PreferencesDialog

        dialog = PreferencesDialog(self._settings, self._window)
        dialog.exec()
        dialog.deleteLater()

    def _apply_look(self) -> None:
        self._set_window_theme(theme_name(self._settings))
        self._show_numbers()

    def _show_numbers(self) -> None:
        self._canvas.overlay.markers.numbers = self._settings.numbers

    def _apply_editing(self) -> None:
        self._document.auto_smooth = self._settings.auto_smooth

    def _on_changed(self, key: str) -> None:
        if key.startswith("look/"):
            self._apply_look()
        elif key.startswith("editing/"):
            self._apply_editing()

    def _on_scheme_changed(self, scheme: Qt.ColorScheme) -> None:
        if self._settings.theme == SYSTEM:
            self._apply_look()


def theme_name(settings: Settings) -> str:
    """``"light"`` or ``"dark"``: the theme chosen in ``settings``, or else the desktop's."""
    return system_theme() if settings.theme == SYSTEM else settings.theme


def system_theme() -> str:
    """The desktop's theme; light where it is unknown."""
    dark = QGuiApplication.styleHints().colorScheme() == Qt.ColorScheme.Dark
    return "dark" if dark else "light"
