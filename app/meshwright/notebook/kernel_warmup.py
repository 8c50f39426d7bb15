"""Compiles the kernels in the background while a widget is shown, once in a process.

The first compilation on a machine takes a minute or two and would block the notebook. Another
process compiles instead, and requests that need the kernels are refused with a sentence until then.
"""

from __future__ import annotations

import atexit
import logging
import subprocess
import sys
import threading
from collections.abc import Callable
from enum import StrEnum

from meshwright.assistant.worker import Dispatch

LEAVE_SECONDS = 5.0
"""Seconds that the end of the program waits for the thread, at most."""

_log = logging.getLogger(__name__)


class Stage(StrEnum):
    """What is being compiled: the operations, then what the agent needs."""

    EDITING = "meshwright_core.warm_up"
    AGENT = "meshwright_agent.warm_up"
    READY = ""


class Preparation:
    """State of the compilation in this process, with callbacks at every change.

    ``warm(stage)`` returns whether a stage is in the cache on disk, ``load()`` loads the kernels of
    the operations, ``command(stage)`` is the command that compiles in another process.
    """

    def __init__(
        self,
        warm: Callable[[Stage], bool] | None = None,
        load: Callable[[], None] | None = None,
        command: Callable[[Stage], list[str]] | None = None,
    ) -> None:
        self._warm, self._load = warm or _is_warm, load or _load
        self._command = command or _command
        self._stage: Stage | None = None
        self._waiting: list[Callable[[], None]] = []
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._leaving = False

    @property
    def compiling(self) -> Stage:
        """The stage in progress; READY also before :meth:`begin`."""
        return self._stage or Stage.READY

    def begin(self, dispatch: Dispatch, told: Callable[[], None]) -> None:
        """Start unless started; ``told()`` is dispatched after each change of :attr:`compiling`."""
        with self._lock:
            if self._stage is Stage.READY:
                return
            self._waiting.append(lambda: dispatch(told))
            if self._stage is not None:
                return
            self._stage = self._first()
        threading.Thread(target=self._work, name="preparing", daemon=True).start()

    def _first(self) -> Stage:
        stages = (Stage.EDITING, Stage.AGENT)
        return next((stage for stage in stages if not self._warm(stage)), Stage.READY)

    # On the thread

    def _work(self) -> None:
        thread = threading.current_thread()

        def leave() -> None:
            """Stop thread and process with the program."""
            self._leaving = True
            if self._process is not None:
                self._process.kill()
            thread.join(LEAVE_SECONDS)

        atexit.register(leave)
        try:
            if self._stage is Stage.EDITING:
                self._compile(Stage.EDITING)
            if not self._leaving:
                self._load()
            if not self._leaving and not self._warm(Stage.AGENT):
                self._reach(Stage.AGENT)
                self._compile(Stage.AGENT)
        except Exception as error:  # then the first use of each kernel compiles it
            _log.error("the compiled kernels could not be prepared", exc_info=error)
        finally:
            self._reach(Stage.READY)
            atexit.unregister(leave)

    def _compile(self, stage: Stage) -> None:
        self._process = subprocess.Popen(
            self._command(stage),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        if self._leaving:
            self._process.kill()
        code = self._process.wait()
        self._process = None
        if code and not self._leaving:
            _log.warning("%s ended with code %d: the first use will compile", stage, code)

    def _reach(self, stage: Stage) -> None:
        with self._lock:
            changed = self._stage is not stage
            self._stage = stage
            waiting = list(self._waiting)
            if stage is Stage.READY:
                self._waiting.clear()
        if changed and not self._leaving:
            for tell in waiting:
                tell()


WAITS: dict[Stage, str] = {
    Stage.EDITING: "Preparing the operations: some seconds, on this machine only once.",
    Stage.AGENT: "Preparing the agent: half a minute or so, on this machine only once.",
}
DONE: dict[Stage, str] = {
    Stage.AGENT: "The operations are ready.",
    Stage.READY: "Everything is ready.",
}


def _is_warm(stage: Stage) -> bool:
    if stage is Stage.EDITING:
        from meshwright_core.core.compilation import is_warm_on_disk
    else:
        from meshwright_agent.warm_up import is_warm_on_disk
    return is_warm_on_disk()


def _load() -> None:
    from meshwright_core.core import compilation

    compilation.warm()


def _command(stage: Stage) -> list[str]:
    return [sys.executable, "-m", str(stage)]


PREPARATION = Preparation()
"""The compilation of this process."""
