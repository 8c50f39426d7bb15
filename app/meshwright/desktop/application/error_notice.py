"""Shows errors that nothing has handled in the notice bar, not on stderr alone."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from types import TracebackType

from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright_core.errors import sentence

Hook = Callable[[type[BaseException], BaseException, TracebackType | None], object]


class ErrorNotice(Controller):
    """From :meth:`watch` on, an exception in a slot, an event or a thread becomes a sentence in the
    notice bar. The hooks that were there before are called too: the traceback goes to stderr.
    """

    def __init__(self, document: Document, notice: NoticeBar, theme: Theme) -> None:
        super().__init__(theme)
        self._document, self._notice = document, notice
        self._dispatch = Dispatcher()
        self._before: Hook | None = None
        self._threads_before = threading.excepthook
        self._hook, self._thread_hook = self._on_error, self._on_thread_error

    def watch(self) -> None:
        """Show errors until :meth:`close`."""
        if self._before is None:
            self._before, sys.excepthook = sys.excepthook, self._hook
            self._threads_before, threading.excepthook = threading.excepthook, self._thread_hook

    def close(self) -> None:
        """Put back the hooks that were there before."""
        super().close()
        if self._before is not None:
            if sys.excepthook is self._hook:
                sys.excepthook = self._before
            if threading.excepthook is self._thread_hook:
                threading.excepthook = self._threads_before
            self._before = None

    def _on_error(
        self, kind: type[BaseException], error: BaseException, trace: TracebackType | None
    ) -> None:
        before = self._before or sys.__excepthook__
        before(kind, error, trace)
        if isinstance(error, Exception):
            self._show(error)

    def _on_thread_error(self, given: threading.ExceptHookArgs) -> None:
        self._threads_before(given)
        error = given.exc_value
        if isinstance(error, Exception):
            self._dispatch(lambda: self._show(error))

    def _show(self, error: Exception) -> None:
        if self._before is None:
            return  # closed since
        words = " ".join(str(error).split()) or type(error).__name__
        kept = "" if self._document.empty else " The mesh and its history are kept."
        self._notice.show_message(f"Something went wrong: {sentence(words)}{kept}")
