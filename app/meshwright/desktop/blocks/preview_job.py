"""The fine grid of the Blocks view, computed in a thread after each change."""

from __future__ import annotations

import logging
import threading
from functools import partial

from qtpy.QtCore import QObject, Signal

from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.document.block_preview import GridPreview, PlannedBlocks, previews
from meshwright_core import MeshError

_log = logging.getLogger(__name__)


class PreviewJob(QObject):
    """``ready(GridPreview)`` first with the interpolated grid, then with the smoothed one.

    There is one thread at a time; another request waits for its end and replaces earlier ones.
    """

    ready = Signal(object)
    failed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._dispatch = Dispatcher()
        self._thread: threading.Thread | None = None
        self._stop = threading.Event()
        self._next: PlannedBlocks | None = None
        self._open = True

    @property
    def busy(self) -> bool:
        """Whether a preview is being computed."""
        return self._thread is not None

    def start(self, planned: PlannedBlocks) -> None:
        """Compute the preview of these blocks."""
        self._stop.set()
        self._next = planned
        if self._thread is None and self._open:
            self._begin()

    def stop(self) -> None:
        """Drop what is computed now."""
        self._stop.set()
        self._next = None

    def release(self) -> None:
        """Stop, and wait for the thread."""
        self._open = False
        self.stop()
        if self._thread is not None:
            self._thread.join()
            self._thread = None

    def _begin(self) -> None:
        planned, self._next = self._next, None
        self._stop = threading.Event()
        self._thread = threading.Thread(
            target=self._work, args=(planned, self._stop), name="block-preview", daemon=True
        )
        self._thread.start()

    def _work(self, planned: PlannedBlocks, stop: threading.Event) -> None:
        def show(found: GridPreview) -> None:
            self._dispatch(partial(self._show, found, stop))

        words = ""
        try:
            previews(planned, show, stop.is_set)
        except MeshError as error:
            words = str(error)
        except Exception as error:  # a thread's boundary
            _log.exception("a preview broke off")
            words = f"The fine grid cannot be shown: {type(error).__name__}: {error}"
        finally:
            self._dispatch(partial(self._finish, words, stop))

    def _show(self, found: GridPreview, stop: threading.Event) -> None:
        if self._open and not stop.is_set():
            self.ready.emit(found)

    def _finish(self, words: str, stop: threading.Event) -> None:
        if self._thread is None:
            return  # released in the meantime
        self._thread.join()
        self._thread = None
        if words and not stop.is_set():
            self.failed.emit(words)
        if self._next is not None and self._open:
            self._begin()
