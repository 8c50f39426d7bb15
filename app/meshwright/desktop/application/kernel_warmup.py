"""Prepares the kernels behind the open window, and shows that in the status bar."""

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

COMPILING = "Compiling operations (first start only)\u2026"
LOADING = "Loading operations\u2026"
COMPILING_AGENT = "Compiling the agent (first start only): {done} of {total}\u2026"
PROGRESS_MILLISECONDS = 1000
"""Milliseconds between updates of the progress."""

MakePreparation = Callable[[Callable[[], None]], KernelPreparation]


def _preparation(load: Callable[[], None]) -> KernelPreparation:
    return KernelPreparation(load=load)


class KernelWarmup(Controller):
    """Updates ``readiness`` as the kernels are compiled and loaded.

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
            self._show_progress(compiling is Stage.AGENT)
        elif compiling is Stage.EDITING and not self._loading:
            self._status.show_preparation(COMPILING)
        else:
            self._status.show_preparation(LOADING)

    def _show_progress(self, compiling_agent: bool) -> None:
        if not compiling_agent:
            self._progress.stop()
            self._status.show_preparation("")
            return
        done, total = self._preparation.progress
        self._status.show_preparation(COMPILING_AGENT.format(done=done, total=total))
        if not self._progress.isActive():
            self._progress.start()

    def _fail(self, sentence: str) -> None:
        self._failed = True
        if not self._closed:
            self._status.show_preparation("")
            self._notice.show_message(sentence)
