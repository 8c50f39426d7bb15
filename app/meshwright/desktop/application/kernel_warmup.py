"""Getting the compiled kernels ready behind the open window."""

import sys
import threading
from collections.abc import Callable
from functools import partial

from qtpy.QtCore import QObject, QProcess, QTimer, Signal

from meshwright.desktop.application.main_thread import Dispatcher
from meshwright_core.core import compilation

FIRST_START = "Preparing (first start only)\u2026"
EVERY_START = "Preparing\u2026"
AGENT_FIRST = "Preparing the agent (first start only)\u2026"
AGENT_PROGRESS = "Preparing the agent (first start only): {done} of {total}\u2026"
PROGRESS_MILLISECONDS = 1000


class Warmup(QObject):
    """Compiles the kernels in a process of their own where that was never done, then loads them.

    Compiling holds the interpreter for seconds on end, which a thread would pass on to the window.
    ``ready()`` comes once, when a person can edit, ``agent_ready()`` when the agent can run;
    ``noted(text)`` with what is being done; ``failed(sentence)`` if the kernels cannot be made.
    """

    ready = Signal()
    agent_ready = Signal()
    noted = Signal(str)
    failed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.done = False
        self._dispatch = Dispatcher()
        self._process: QProcess | None = None
        self._then: Callable[[], None] = self._load
        self._thread: threading.Thread | None = None
        self._stopped = False
        self._progress = QTimer(self)
        self._progress.setInterval(PROGRESS_MILLISECONDS)
        self._progress.timeout.connect(self._note_progress)
        self.agent_ready.connect(self._progress.stop)

    def start(self) -> None:
        """Begin; returns at once."""
        if self._stopped:
            return
        if compilation.is_warm_on_disk():
            self._load()
            return
        self.noted.emit(FIRST_START)
        self._run("meshwright_core.warm_up", self._load)

    def _run(self, module: str, then: Callable[[], None]) -> None:
        """Run a module in a process of its own; what comes then also comes after a failure, and
        compiles here, or says why not.
        """
        self._process, self._then = QProcess(self), then
        self._process.finished.connect(self._on_compiled)
        self._process.errorOccurred.connect(self._on_error)
        self._process.start(sys.executable, ["-m", module])

    def stop(self) -> None:
        """End what is under way; loading that has begun is waited for.

        What a thread has reported by then is not told any more: the window may be gone.
        """
        self._stopped = True
        self._progress.stop()
        if self._process is not None:
            self._process.finished.disconnect(self._on_compiled)
            self._process.errorOccurred.disconnect(self._on_error)
            self._process.kill()
            self._process.waitForFinished()
            self._process = None
        if self._thread is not None:
            self._thread.join()
            self._thread = None

    def _on_compiled(self, code: int, status: QProcess.ExitStatus) -> None:
        self._process = None
        self._then()

    def _on_error(self, error: QProcess.ProcessError) -> None:
        if error == QProcess.ProcessError.FailedToStart:
            self._on_compiled(1, QProcess.ExitStatus.CrashExit)

    def _load(self) -> None:
        self.noted.emit(EVERY_START)
        self._thread = threading.Thread(target=self._warm, name="warmup", daemon=True)
        self._thread.start()

    def _warm(self) -> None:
        try:
            compilation.warm()
        except Exception as error:  # a thread's boundary: the window tells the person
            self._dispatch(partial(self._fail, f"The compiled kernels cannot be used: {error}"))
        else:
            self._dispatch(self._finish)

    def _finish(self) -> None:
        if self._stopped:
            return
        self.done = True
        self.ready.emit()
        if agent_is_warm():
            self.agent_ready.emit()
        else:
            self.noted.emit(AGENT_FIRST)
            self._run("meshwright_agent.warm_up", self.agent_ready.emit)
            self._progress.start()

    def _note_progress(self) -> None:
        from meshwright_agent.warm_up import progress

        done, total = progress()
        self.noted.emit(AGENT_PROGRESS.format(done=done, total=total))

    def _fail(self, sentence: str) -> None:
        if not self._stopped:
            self.failed.emit(sentence)


def agent_is_warm() -> bool:
    """Whether the agent's kernels were compiled before; the agent is not imported sooner."""
    from meshwright_agent.warm_up import is_warm_on_disk

    return is_warm_on_disk()
