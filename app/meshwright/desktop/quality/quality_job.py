"""Measures quality in the background: after a pause, in a thread, on a copy of the mesh."""

import threading
import time
from functools import partial

from qtpy.QtCore import QObject, QTimer, Signal

from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.controller import Connections
from meshwright.document.document import Document
from meshwright.document.element_quality import ElementQuality
from meshwright.document.quality_summary import QualitySummary, summarise
from meshwright_core import HalfEdgeMesh

PAUSE = 120
"""Milliseconds between a change and the measurement; further changes do not delay it."""
LATE = 400
"""Milliseconds after a change until old values are marked as stale; avoids flicker during
playback.
"""


class QualityMonitor(QObject):
    """Measures the quality of the mesh of ``document`` after changes.

    ``measured()`` when :attr:`summary` is new or None; ``aged()`` when it has become stale. A
    change only starts a timer; the mesh is copied when that has elapsed. There is one thread at a
    time; a change cancels it.
    """

    aged = Signal()
    measured = Signal()

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self.summary: QualitySummary | None = None
        self.fresh = False
        """Whether :attr:`summary` is that of the current mesh."""
        self.stale = True
        """Whether :attr:`summary` has been out of date for a while."""
        self._quality = ElementQuality()  # used by the thread while there is one
        self._dispatch = Dispatcher()
        self._thread: threading.Thread | None = None
        self._cancel = threading.Event()
        self._pause = QTimer(self)
        self._pause.setSingleShot(True)
        self._pause.setInterval(PAUSE)
        self._pause.timeout.connect(self._on_pause)
        self._late = QTimer(self)
        self._late.setSingleShot(True)
        self._late.setInterval(LATE)
        self._late.timeout.connect(self._on_late)
        self._connections = Connections()
        self._connections.add(document.replaced, self._on_replaced)
        self._connections.add(document.changed, self._on_changed)
        self._on_replaced()

    def release(self) -> None:
        """Disconnect from the document and end the thread."""
        self._connections.close()
        self._pause.stop()
        self._late.stop()
        self._cancel.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None

    def _on_replaced(self) -> None:
        self.summary, self.stale = None, True
        self._on_changed()
        self.measured.emit()

    def _on_changed(self) -> None:
        self._cancel.set()
        self.fresh = False
        if self._document.empty:
            self._pause.stop()
            self._late.stop()
            return
        for timer in (self._pause, self._late):
            if not timer.isActive():
                timer.start()

    def _on_late(self) -> None:
        self.stale = True
        self.aged.emit()

    def _on_pause(self) -> None:
        mesh = self._document.mesh
        if self._thread is not None or mesh is None:
            return  # _finish of the cancelled thread starts the next one
        self._cancel = threading.Event()
        self._thread = threading.Thread(
            target=self._measure, args=(mesh.copy(), self._cancel), name="quality", daemon=True
        )
        self._thread.start()

    def _measure(self, mesh: HalfEdgeMesh, cancel: threading.Event) -> None:
        summary = None
        try:
            summary = summarise(mesh, partial(_give_way, cancel), self._quality)
        finally:
            self._dispatch(partial(self._finish, summary, cancel))

    def _finish(self, summary: QualitySummary | None, cancel: threading.Event) -> None:
        if self._thread is None:
            return  # released in the meantime
        self._thread.join()
        self._thread = None
        if cancel.is_set():
            if not self._document.empty and not self._pause.isActive():
                self._pause.start()
        elif summary is not None:
            self.summary, self.fresh, self.stale = summary, True, False
            self._late.stop()
            self.measured.emit()


def _give_way(cancel: threading.Event) -> bool:
    """Whether to stop; releases the interpreter for the window between two parts of the work."""
    time.sleep(0.001)
    return cancel.is_set()
