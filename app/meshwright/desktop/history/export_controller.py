"""Export of videos and images: dialog, writing thread, progress bar."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from qtpy.QtWidgets import QWidget

from meshwright.desktop.application.settings import Settings
from meshwright.desktop.exporting.export_task import ExportTask
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.colouring import COLOUR_BY, MEASURES
from meshwright.graphics.export.export_job import ExportOptions, write_export
from meshwright.graphics.theme import Theme

if TYPE_CHECKING:
    from meshwright.graphics.export.film import Film


class ExportController(ExportTask):
    """Opens the export dialog and writes the file in a thread, one at a time."""

    def __init__(
        self,
        document: Document,
        settings: Settings,
        status: StatusBar,
        notice: NoticeBar,
        parent: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(document, status, notice, parent, theme)
        self._settings = settings
        self._order = ExportOptions()

    def ask(self) -> None:
        """Show the dialog, ask for a file, and start."""
        from meshwright.desktop.history.export_dialog import ExportDialog
        from meshwright.graphics.export.film import Film

        if self._refused():
            return
        document = self._document
        film = Film(document)
        colours = self._settings.colours
        measure = self._settings.choice(COLOUR_BY, ("", *MEASURES))  # as in the view
        order = replace(self._order, theme=self._theme.name, colours=colours, measure=measure)
        dialog = ExportDialog(film, order, self._parent, document.hover)
        accepted = bool(dialog.exec())
        self._order = dialog.order
        dialog.deleteLater()
        if not accepted:
            return
        ending = self._order.ending
        title, name = f"Export as {ending[1:].upper()}", f"{document.name or 'mesh'}{ending}"
        path = self._ask_path(title, name, ending)
        if path:
            self.start(film, self._order, path)

    def start(self, film: Film, order: ExportOptions, path: str) -> None:
        """Write ``order`` to ``path`` in the background; a message is shown at the end."""
        self.bar.show_progress(Path(path).name, 0, 1)
        self._start(path, partial(self._write, film, order, path))

    def _write(self, film: Film, order: ExportOptions, path: str) -> tuple[str, bool]:
        """Write the file, in the thread."""
        name = Path(path).name

        def progress(done: int, total: int) -> None:
            self._give_way()
            self._report(partial(self.bar.show_progress, name, done, total))

        frames = write_export(film, order, path, progress)
        size = Path(path).stat().st_size / 1e6
        count = f"{frames:,} frames, " if frames > 1 else ""
        return f"Written: {name} ({count}{size:.1f} MB).", False
