"""Export of videos and images: dialog, writing thread, progress bar."""

from __future__ import annotations

import logging
import threading
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from qtpy.QtWidgets import QFileDialog, QWidget

from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.export_bar import ExportBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.colouring import COLOUR_BY, MEASURES
from meshwright.graphics.export.export_job import ExportOptions, write_export
from meshwright.graphics.theme import Theme
from meshwright_core.errors import MeshError

if TYPE_CHECKING:
    from meshwright.graphics.export.film import Film


_log = logging.getLogger(__name__)


class ExportCancelled(Exception):
    """Raised in the thread when the export was cancelled."""


class ExportController(Controller):
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
        super().__init__(theme)
        self._document, self._settings = document, settings
        self._status, self._notice, self._parent = status, notice, parent
        self._dispatch = Dispatcher()
        self._thread: threading.Thread | None = None
        self._stop = threading.Event()
        self._order = ExportOptions()
        self.bar = ExportBar()
        self.bar.cancelled.connect(self.cancel)

    @property
    def running(self) -> bool:
        """True while a file is written."""
        return self._thread is not None

    def ask(self) -> None:
        """Show the dialog, ask for a file, and start."""
        from meshwright.desktop.history.export_dialog import ExportDialog
        from meshwright.graphics.export.film import Film

        if self.running:
            self._status.show_message("An export is already running: wait, or cancel it.")
            return
        document = self._document
        film = Film(document)
        colours = self._settings.colours
        measure = self._settings.choice(COLOUR_BY, ("", *MEASURES))  # as in the view
        order = replace(self._order, theme=self._theme.name, colours=colours, measure=measure)
        dialog = ExportDialog(film, order, self._parent)
        accepted = bool(dialog.exec())
        self._order = dialog.order
        dialog.deleteLater()
        if not accepted:
            return
        path = self._ask_path(self._order)
        if path:
            self.start(film, self._order, path)

    def _ask_path(self, order: ExportOptions) -> str:
        document = self._document
        folder = document.path.parent if document.path else Path()
        name = folder / f"{document.name or 'mesh'}{order.ending}"
        kind = order.ending[1:].upper()
        path, _ = QFileDialog.getSaveFileName(
            self._parent, f"Export as {kind}", str(name), f"{kind} (*{order.ending})"
        )
        if path and not path.lower().endswith(order.ending):
            path += order.ending
        return str(path)

    def start(self, film: Film, order: ExportOptions, path: str) -> None:
        """Write ``order`` to ``path`` in the background; a message is shown at the end."""
        self._stop.clear()
        self.bar.show_progress(Path(path).name, 0, 1)
        self._thread = threading.Thread(
            target=self._work, args=(film, order, path), name="film-export", daemon=True
        )
        self._thread.start()

    def cancel(self) -> None:
        """Cancel the export; the incomplete file is removed."""
        self._stop.set()

    def close(self) -> None:
        """Cancel, and wait for the frame that is being drawn."""
        super().close()
        self.cancel()
        if self._thread is not None:
            self._thread.join(10.0)
            self._thread = None

    def _work(self, film: Film, order: ExportOptions, path: str) -> None:
        """Write the file; runs in the thread and reports through the dispatcher."""
        name = Path(path).name

        def progress(done: int, total: int) -> None:
            if self._stop.is_set():
                raise ExportCancelled
            self._dispatch(partial(self._on_progress, name, done, total))

        try:
            frames = write_export(film, order, path, progress)
        except ExportCancelled:
            self._dispatch(partial(self._finish, f"Cancelled: {name} was not written.", False))
        except MeshError as error:
            self._dispatch(partial(self._finish, str(error), True))
        except Exception as error:  # a thread boundary: the bar must disappear in any case
            _log.exception("an export broke off")
            words = f"{name} was not written: {type(error).__name__}: {error}"
            self._dispatch(partial(self._finish, words, True))
        else:
            size = Path(path).stat().st_size / 1e6
            count = f"{frames:,} frames, " if frames > 1 else ""
            words = f"Written: {name} ({count}{size:.1f} MB)."
            self._dispatch(partial(self._finish, words, False))

    def _on_progress(self, name: str, done: int, total: int) -> None:
        if self.running and not self._stop.is_set():
            self.bar.show_progress(name, done, total)

    def _finish(self, words: str, failed: bool) -> None:
        if self._thread is None:
            return  # the window has closed
        self._thread.join()
        self._thread = None
        self.bar.hide()
        if failed:
            self._notice.show_message(words)
        else:
            self._status.show_message(words)
