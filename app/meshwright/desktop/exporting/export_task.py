"""The base of the controllers that write a file in a thread, with a bar and *Cancel*."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from functools import partial
from pathlib import Path

from qtpy.QtWidgets import QFileDialog, QWidget

from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.controller import Controller
from meshwright.desktop.exporting.export_bar import ExportBar
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright_core.errors import MeshError, sentence

_log = logging.getLogger(__name__)
WAIT = 10.0
"""Seconds that a closing window waits for the thread, at most."""


class ExportCancelled(Exception):
    """Raised in the thread when the export was cancelled."""


class ExportTask(Controller):
    """Writes one file at a time in a thread, and says in the end what has become of it."""

    def __init__(
        self,
        document: Document,
        status: StatusBar,
        notice: NoticeBar,
        parent: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document = document
        self._status, self._notice, self._parent = status, notice, parent
        self._dispatch = Dispatcher()
        self._thread: threading.Thread | None = None
        self._stop = threading.Event()
        self.bar = ExportBar()
        self.bar.cancelled.connect(self.cancel)

    @property
    def running(self) -> bool:
        """True while a file is written."""
        return self._thread is not None

    def cancel(self) -> None:
        """Cancel the export: the file is written whole or not at all."""
        self._stop.set()
        if self.running:
            self.bar.show_stage("Cancelling\u2026")

    def close(self) -> None:
        """Cancel, and wait for what is being done."""
        super().close()
        self._stop.set()
        if self._thread is not None:
            self._thread.join(WAIT)
            self._thread = None

    def _refused(self) -> bool:
        """Whether another export is running; says so."""
        if self.running:
            self._status.show_message("An export is already running: wait, or cancel it.")
        return self.running

    def _ask_path(self, title: str, name: str, ending: str) -> str:
        """Ask for a file with this ending, "" for any, in the document's folder; "" for none."""
        path = self._document.path
        shown = f"{ending[1:].upper()} (*{ending})" if ending else name
        place = str((path.parent if path else Path()) / name)
        chosen, _ = QFileDialog.getSaveFileName(self._parent, title, place, shown)
        if chosen and not chosen.lower().endswith(ending):
            chosen += ending
        return str(chosen)

    def _start(self, path: str, work: Callable[[], tuple[str, bool]]) -> None:
        """Do `work` in the thread.

        It calls :meth:`_give_way` between its parts, and returns a sentence and whether that is to
        be noticed; MeshError is said likewise.
        """
        self._stop.clear()
        self._thread = threading.Thread(
            target=self._run, args=(Path(path).name, work), name="export", daemon=True
        )
        self._thread.start()

    def _run(self, name: str, work: Callable[[], tuple[str, bool]]) -> None:
        """In the thread: do the work, and report through the dispatcher."""
        try:
            words, failed = work()
        except ExportCancelled:
            words, failed = f"Cancelled: {name} was not written.", False
        except MeshError as error:
            words, failed = sentence(str(error)), True
        except Exception as error:  # a thread's boundary: the bar must disappear in any case
            _log.exception("an export broke off")
            words, failed = f"{name} was not written: {type(error).__name__}: {error}", True
        self._dispatch(partial(self._finish, words, failed))

    def _give_way(self) -> None:
        """In the thread: end it if the export was cancelled."""
        if self._stop.is_set():
            raise ExportCancelled

    def _report(self, show: Callable[[], None]) -> None:
        """In the thread: show something in the bar, unless the export was cancelled."""
        self._dispatch(partial(self._on_report, show))

    def _on_report(self, show: Callable[[], None]) -> None:
        if self.running and not self._stop.is_set():
            show()

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
