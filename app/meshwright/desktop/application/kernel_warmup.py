"""Prepares the kernels behind the open window, and says how far that is."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from qtpy.QtCore import QTimer

from meshwright.assistant.kernel_preparation import KernelPreparation, Stage, load_kernels
from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.graphics.theme import Theme

LOADING = "Loading the operations\u2026"
COMPILING = "Preparing {what}, once after an update: {done} of {total} parts\u2026"
MINUTES = "One to four minutes in all."
"""How long compilation takes on two cores, said where there is room."""
COMPILED = {Stage.EDITING: "the operations", Stage.AGENT: "the search"}
UNUSABLE = "The compiled kernels cannot be used."
PROGRESS_MILLISECONDS = 1000
"""Milliseconds between updates of the progress."""

MakePreparation = Callable[[Callable[[], None]], KernelPreparation]


def _preparation(load: Callable[[], None]) -> KernelPreparation:
    return KernelPreparation(load=load)


class KernelWarmup(Controller):
    """Updates ``readiness``, and the status bar, as the kernels are compiled and loaded.

    ``prepare(load)`` makes the preparation, ``load()`` loads the kernels in its thread.
    """

    def __init__(
        self,
        readiness: Readiness,
        status: StatusBar,
        notice: NoticeBar,
        theme: Theme,
        prepare: MakePreparation = _preparation,
        load: Callable[[], None] = load_kernels,
    ) -> None:
        super().__init__(theme)
        self._readiness, self._status, self._notice = readiness, status, notice
        self._load_kernels = load
        self._dispatch = Dispatcher()
        self._preparation = prepare(self._load)
        self._progress = QTimer(status)
        self._progress.setInterval(PROGRESS_MILLISECONDS)
        self._progress.timeout.connect(self._update)
        self._loading = self._loaded = self._failed = self._closed = False

    def start(self) -> None:
        """Begin; returns at once. Does nothing once the window is closed."""
        if not self._closed:
            self._preparation.begin(self._dispatch, self._update)
            self._update()

    def close(self) -> None:
        """End compilation; loading that has begun is waited for."""
        super().close()
        self._closed = True
        self._progress.stop()
        self._preparation.stop()

    def _load(self) -> None:
        """Load the kernels; called in the thread."""
        self._loading = True
        self._dispatch(self._update)
        try:
            self._load_kernels()
        except Exception as error:  # a thread's boundary
            self._dispatch(partial(self._fail, f"The compiled kernels cannot be used: {error}"))
            raise
        self._loaded = True
        self._dispatch(self._update)

    def _update(self) -> None:
        if self._closed or self._failed:
            return
        compiling = self._preparation.compiling
        if self._loaded:
            self._readiness.editing = True
            self._readiness.agent = compiling is Stage.READY
            self._show_progress(compiling)
        elif compiling is Stage.EDITING and not self._loading:
            self._show_progress(compiling)
        else:
            self._show(LOADING)

    def _show_progress(self, stage: Stage) -> None:
        """Show how far the compilation is, now and once a second; of READY, that it is over."""
        if stage is Stage.READY:
            self._progress.stop()
            self._show("")
            return
        done, total = self._preparation.progress
        text = COMPILING.format(what=COMPILED[stage], done=done, total=total)
        self._show(text, done / total, MINUTES)
        if not self._progress.isActive():
            self._progress.start()

    def _show(self, text: str, share: float | None = None, more: str = "") -> None:
        self._status.show_preparation(text)
        self._readiness.show_progress(f"{text} {more}".rstrip(), share)

    def _fail(self, sentence: str) -> None:
        self._failed = True
        self._progress.stop()
        if not self._closed:
            self._show(UNUSABLE)
            self._notice.show_message(sentence)
