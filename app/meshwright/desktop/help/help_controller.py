"""Guidance: the tour, the palette, the page of keys, and what this program is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshwright.desktop.actions import registry
from meshwright.desktop.actions.action import key_text, needs
from meshwright.desktop.help.command_palette import Entry, Palette
from meshwright.desktop.help.shortcuts_dialog import KeysDialog
from meshwright.desktop.help.tour import Tour
from meshwright.graphics.theme import Theme

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


class Guide:
    """Help for one window."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self._awaits_mesh = False
        self.tour: Tour | None = None
        self.palette: Palette | None = None
        self.keys: KeysDialog | None = None

    def connect(self) -> None:
        """Follow the document."""
        self._window.document.replaced.connect(self._on_replaced)

    def release(self) -> None:
        """Close what is open."""
        self._window.document.replaced.disconnect(self._on_replaced)
        if self.palette is not None:
            self.palette.dismiss()
        self.end_tour()
        if self.keys is not None:
            self.keys.close()

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        if self.tour is not None:
            self.tour.set_theme(theme)

    # The tour

    def welcome(self) -> None:
        """Show whoever has not seen it the tour, as soon as there is a mesh to show it on."""
        if self._window.settings.toured:
            return
        if self._window.document.empty:
            self._awaits_mesh = True
        else:
            self.show_tour()

    def show_tour(self) -> None:
        """Begin the tour, again if it is under way; without a mesh, once there is one."""
        self.end_tour()
        if self._window.document.empty:
            self._awaits_mesh = True
            self._window.say("The tour begins with the first mesh: make one, or open a file.")
            return
        self._awaits_mesh = False
        self._window.settings.toured = True
        self.tour = Tour(self._window)
        self.tour.ended.connect(self._on_tour_ended)

    def end_tour(self) -> None:
        """Take the tour away, if it is there."""
        if self.tour is not None:
            self.tour.end()

    def _on_tour_ended(self) -> None:
        self.tour = None

    def _on_replaced(self) -> None:
        if self._awaits_mesh and not self._window.document.empty:
            self.show_tour()

    # The palette

    def show_palette(self) -> None:
        """Open the palette, or close it."""
        if self.palette is not None:
            self.palette.dismiss()
            return
        window = self._window
        self.palette = Palette(self.entries(), window.theme, window)
        self.palette.chosen.connect(self._on_chosen)
        self.palette.closed.connect(self._on_palette_closed)
        window.canvas.freeze(True)  # an operation is meant for the half-edge pointed at before
        self.palette.popup()

    def entries(self) -> list[Entry]:
        """All actions of the menus as rows of the palette, as possible as they are now."""
        made = []
        for menu, members in registry.groups(self._window):
            for action in members:
                possible = action.enabled(self._window)
                made.append(
                    Entry(
                        action.id,
                        action.title.rstrip("\u2026"),
                        menu,
                        key_text(action.shortcuts[0]) if action.shortcuts else "",
                        "" if possible else needs(action),
                        action.tooltip,
                    )
                )
        return made

    def _on_chosen(self, action_id: str) -> None:
        self._window.actions_by_id[action_id].trigger()

    def _on_palette_closed(self) -> None:
        self.palette = None
        self._window.canvas.freeze(False)

    # Pages

    def show_keys(self) -> None:
        """All keys, and what the mouse does, beside the window."""
        if self.keys is not None:
            self.keys.close()
        self.keys = KeysDialog(registry.groups(self._window), self._window)
        self.keys.finished.connect(self._on_keys_closed)
        self.keys.show()

    def _on_keys_closed(self, result: int) -> None:
        if self.keys is not None:
            self.keys.deleteLater()
            self.keys = None

    def show_about(self) -> None:
        """Version and licences."""
        from meshwright.desktop.help.about_dialog import (
            AboutDialog,  # looks through the installed packages
        )

        dialog = AboutDialog(self._window)
        dialog.exec()
        dialog.deleteLater()
