"""Getting the compiled kernels ready behind the open window."""

import sys
import threading
from functools import partial

from qtpy.QtCore import QObject, QProcess, Signal

from app.desktop.dispatch import Dispatcher
from meshcore import compiled

FIRST_START = "Preparing (first start only)\u2026"
EVERY_START = "Preparing\u2026"


class Warmup(QObject):
    """Compiles the kernels in a process of their own where that was never done, then loads them.

    Compiling holds the interpreter for minutes, which a thread would pass on to the window.
    ``ready()`` comes once; ``noted(text)`` with what is being done; ``failed(sentence)`` if the
    kernels cannot be made.
    """

    ready = Signal()
    noted = Signal(str)
    failed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.done = False
        self._dispatch = Dispatcher()
        self._process: QProcess | None = None
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Begin; returns at once."""
        if compiled.is_warm_on_disk():
            self._load()
            return
        self.noted.emit(FIRST_START)
        self._process = QProcess(self)
        self._process.finished.connect(self._on_compiled)
        self._process.errorOccurred.connect(self._on_error)
        self._process.start(sys.executable, ["-m", "meshcore.warm_up"])

    def stop(self) -> None:
        """End what is under way; loading that has begun is waited for."""
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
        self._load()  # also after a failed process: loading then compiles here, or says why not

    def _on_error(self, error: QProcess.ProcessError) -> None:
        if error == QProcess.ProcessError.FailedToStart:
            self._on_compiled(1, QProcess.ExitStatus.CrashExit)

    def _load(self) -> None:
        self.noted.emit(EVERY_START)
        self._thread = threading.Thread(target=self._warm, name="warmup", daemon=True)
        self._thread.start()

    def _warm(self) -> None:
        try:
            compiled.warm()
        except Exception as error:  # a thread's boundary: the window tells the person
            self._dispatch(partial(self._fail, f"The compiled kernels cannot be used: {error}"))
        else:
            self._dispatch(self._finish)

    def _finish(self) -> None:
        self.done = True
        self.ready.emit()

    def _fail(self, sentence: str) -> None:
        self.failed.emit(sentence)
