"""Tour, command palette, shortcuts and About."""

from __future__ import annotations

from meshwright.desktop.application.settings import Settings
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.controller import Controller
from meshwright.desktop.help.command_palette import CommandPalette, PaletteEntry
from meshwright.desktop.help.shortcuts_dialog import ShortcutsDialog
from meshwright.desktop.help.tour import Tour, TourPlaces
from meshwright.desktop.widgets.action_set import ActionSet, key_text
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright_core.domains import gallery, meshing

SHAPE = "star"
"""The shape of the gallery that the tour loads if there is no mesh."""
PASSED_BY = "The tour is over; Help > Show the tour starts it again."


class HelpController(Controller):
    """Opens the tour, the command palette, the page of shortcuts and the About dialog."""

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        settings: Settings,
        actions: ActionSet,
        status: StatusBar,
        places: TourPlaces,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._settings = document, canvas, settings
        self._actions, self._status = actions, status
        self.places, self._window = places, places.window
        self._awaits_mesh = False
        self.tour: Tour | None = None
        """The tour while it is shown; likewise the palette and the page of shortcuts."""
        self.palette: CommandPalette | None = None
        self.keys: ShortcutsDialog | None = None
        self._connections.add(document.replaced, self._on_replaced)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        super().set_theme(theme)
        if self.tour is not None:
            self.tour.set_theme(theme)

    def close(self) -> None:
        """Disconnect, and close what is open."""
        super().close()
        if self.palette is not None:
            self.palette.dismiss()
        self.end_tour()
        if self.keys is not None:
            self.keys.close()

    # The tour

    def welcome(self) -> None:
        """Start the tour as soon as there is a mesh, unless it has been shown before."""
        if self._settings.toured:
            return
        if self._document.empty:
            self._awaits_mesh = True
        else:
            self.show_tour()

    def show_tour(self) -> None:
        """Start or restart the tour; without a mesh on one of the gallery."""
        self.end_tour()
        if self._document.empty:
            self._awaits_mesh = False
            self._document.replace(meshing.mesh_domain(gallery.shape(SHAPE), "quad"), SHAPE)
        self._awaits_mesh = False
        self._settings.toured = True
        self.tour = Tour(self._document, self.places, self._actions, self._theme)
        self.tour.passed_by.connect(self._on_tour_passed_by)
        self.tour.ended.connect(self._on_tour_ended)

    def end_tour(self) -> None:
        """End the tour, if it is shown."""
        if self.tour is not None:
            self.tour.end()

    def _on_tour_passed_by(self) -> None:
        self._status.show_message(PASSED_BY)

    def _on_tour_ended(self) -> None:
        self.tour = None

    def _on_replaced(self) -> None:
        if self._awaits_mesh and not self._document.empty:
            self.show_tour()

    # The palette

    def show_palette(self) -> None:
        """Open the palette, or close it."""
        if self.palette is not None:
            self.palette.dismiss()
            return
        self.palette = CommandPalette(self.entries(), self._theme, self._window)
        self.palette.chosen.connect(self._on_chosen)
        self.palette.closed.connect(self._on_palette_closed)
        self._canvas.freeze(True)  # an operation is for the half-edge hovered before
        self.palette.popup()

    def entries(self) -> list[PaletteEntry]:
        """The actions of all menus as rows of the palette, with their current state."""
        made = []
        for menu, members in self._actions.menus(self._document.kind):
            for entry in members:
                made.append(
                    PaletteEntry(
                        entry.id,
                        entry.title.rstrip("\u2026"),
                        menu,
                        key_text(entry.shortcuts[0]) if entry.shortcuts else "",
                        "" if self._actions[entry.id].isEnabled() else entry.requirement,
                        entry.tooltip,
                    )
                )
        return made

    def _on_chosen(self, action_id: str) -> None:
        self._actions[action_id].trigger()

    def _on_palette_closed(self) -> None:
        self.palette = None
        self._canvas.freeze(False)

    # Pages

    def show_keys(self) -> None:
        """Show the page of shortcuts and mouse gestures."""
        if self.keys is not None:
            self.keys.close()
        self.keys = ShortcutsDialog(self._actions.menus(self._document.kind), self._window)
        self.keys.finished.connect(self._on_keys_closed)
        self.keys.show()

    def _on_keys_closed(self, result: int) -> None:
        if self.keys is not None:
            self.keys.deleteLater()
            self.keys = None

    def show_about(self) -> None:
        """Show the About dialog."""
        from meshwright.desktop.help.about_dialog import (
            AboutDialog,  # looks through the installed packages
        )

        dialog = AboutDialog(self._window)
        dialog.exec()
        dialog.deleteLater()
