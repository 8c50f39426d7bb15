"""Compiles and loads the kernels in the background, for the window and the notebook.

Compiling holds the interpreter for seconds on end, so it is done in another process, whose cache
this one then loads.
"""

from __future__ import annotations

import atexit
import logging
import subprocess
import sys
import threading
from collections.abc import Callable
from enum import StrEnum
from functools import partial

from meshwright.assistant.worker import Dispatch

LEAVE_SECONDS = 5.0
"""Seconds that the end of the program waits for the thread, at most."""

_log = logging.getLogger(__name__)


class Stage(StrEnum):
    """What is being compiled, as the module that compiles it: first the kernels of the editor, then
    those of the agent.
    """

    EDITING = "meshwright_core.warm_up"
    AGENT = "meshwright_agent.warm_up"
    READY = ""


class KernelPreparation:
    """The stages of one preparation, which runs once, in a thread.

    ``warm(stage)`` returns whether a stage was compiled on this machine before, ``load()`` loads
    the kernels of the editor, ``command(stage)`` is the command that compiles a stage. A stage
    whose process fails is compiled by its first use.
    """

    def __init__(
        self,
        warm: Callable[[Stage], bool] | None = None,
        load: Callable[[], None] | None = None,
        command: Callable[[Stage], list[str]] | None = None,
    ) -> None:
        self._warm, self._load = warm or is_warm, load or load_kernels
        self._command = command or _command
        self._stage: Stage | None = None
        self._listeners: list[Callable[[], None]] = []
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._stopped = False

    @property
    def compiling(self) -> Stage:
        """The stage that is being compiled; READY when none is, also before :meth:`begin`."""
        return self._stage or Stage.READY

    @property
    def progress(self) -> tuple[int, int]:
        """How many kernels of both stages are compiled, and how many there are."""
        from meshwright_agent.warm_up import progress

        return progress()

    def begin(self, dispatch: Dispatch, changed: Callable[[], None]) -> None:
        """Begin, or join a preparation that has begun; returns at once.

        ``changed()`` is dispatched each time :attr:`compiling` has changed.
        """
        with self._lock:
            if self._stage is Stage.READY or self._stopped:
                return
            self._listeners.append(lambda: dispatch(partial(self._notify, changed)))
            if self._stage is not None:
                return
            stages = (Stage.EDITING, Stage.AGENT)
            self._stage = next((stage for stage in stages if not self._warm(stage)), Stage.READY)
            self._thread = threading.Thread(
                target=self._work, name="kernel-preparation", daemon=True
            )
            self._thread.start()

    def stop(self, seconds: float | None = None) -> None:
        """Kill the compiling process, and wait for the thread: at most ``seconds``, None: for ever.

        Nothing is dispatched any more.
        """
        with self._lock:
            self._stopped = True
            if self._process is not None:
                self._process.kill()
        if self._thread is not None:
            self._thread.join(seconds)

    def _notify(self, changed: Callable[[], None]) -> None:
        if not self._stopped:
            changed()

    # On the thread

    def _work(self) -> None:
        leave = partial(self.stop, LEAVE_SECONDS)  # the program must not end under compiled code
        atexit.register(leave)
        try:
            if self._stage is Stage.EDITING:
                self._compile(Stage.EDITING)
            if not self._stopped:
                self._load()
            if not self._stopped and not self._warm(Stage.AGENT):
                self._reach(Stage.AGENT)
                self._compile(Stage.AGENT)
        except Exception as error:  # a thread's boundary: first uses compile what they need
            _log.error("the compiled kernels could not be prepared", exc_info=error)
        finally:
            self._reach(Stage.READY)
            atexit.unregister(leave)

    def _compile(self, stage: Stage) -> None:
        with self._lock:
            if self._stopped:
                return
            self._process = subprocess.Popen(
                self._command(stage),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
            )
        code = self._process.wait()
        self._process = None
        if code and not self._stopped:
            _log.warning("%s ended with code %d: the first use will compile", stage, code)

    def _reach(self, stage: Stage) -> None:
        with self._lock:
            changed = self._stage is not stage
            self._stage = stage
            listeners = list(self._listeners)
            if stage is Stage.READY:
                self._listeners.clear()
        if changed and not self._stopped:
            for notify in listeners:
                notify()


def is_warm(stage: Stage) -> bool:
    """Whether a stage was compiled on this machine before, by these very sources."""
    if stage is Stage.EDITING:
        from meshwright_core.warm_up import is_warm_on_disk
    else:
        from meshwright_agent.warm_up import is_warm_on_disk
    return is_warm_on_disk()


def load_kernels() -> None:
    """Load the kernels of the editor from the cache; compiles those that are missing."""
    from meshwright_core import warm_up

    warm_up.warm()


def _command(stage: Stage) -> list[str]:
    return [sys.executable, "-m", str(stage)]
