"""Getting the compiled kernels ready behind a widget, once in a program.

Where that was never done on this machine it takes half a minute or so, in which a notebook that
compiles by itself would say nothing and do nothing. So a process of its own compiles, and what a
browser asks for meanwhile is put off with a sentence.
"""

from __future__ import annotations

import atexit
import logging
import subprocess
import sys
import threading
from collections.abc import Callable
from enum import StrEnum

from app.worker import Dispatch

LEAVE_SECONDS = 5.0
"""Seconds that the end of the program waits for the thread, at most."""

_log = logging.getLogger(__name__)


class Stage(StrEnum):
    """What is being made ready: what a person can do, then what the agent needs."""

    EDITING = "meshcore.warm_up"
    AGENT = "agent.warm_up"
    READY = ""


class Preparation:
    """What is ready in this program, and who is told when more is.

    ``warm(stage)`` tells whether a stage was compiled on this machine before, ``load()`` loads what
    editing needs, ``run(module)`` compiles in another process.
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
        """What a person has to wait for now; READY also before anything was begun."""
        return self._stage or Stage.READY

    def begin(self, dispatch: Dispatch, told: Callable[[], None]) -> None:
        """Begin, or join; ``told()`` is dispatched each time :attr:`compiling` has changed."""
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
            """A thread in compiled code, and a process, must not outlive the program."""
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
        except Exception as error:  # a thread's boundary: each first use compiles for itself then
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
        from meshcore.compiled import is_warm_on_disk
    else:
        from agent.warm_up import is_warm_on_disk
    return is_warm_on_disk()


def _load() -> None:
    from meshcore import compiled

    compiled.warm()


def _command(stage: Stage) -> list[str]:
    return [sys.executable, "-m", str(stage)]


PREPARATION = Preparation()
"""Of this program."""
