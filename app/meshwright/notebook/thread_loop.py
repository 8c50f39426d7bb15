"""Calls into the thread that owns a document, from any thread.

Notebooks run their cells in a thread with an asyncio event loop, which is blocked while a cell
runs. Calls wait in one queue. The event loop processes it when it runs;
:meth:`ThreadLoop.pump` processes it in the meantime, and where there is no event loop at all.
Messages from a browser may arrive in another thread (JupyterLab uses a subshell); the decisions of
a policy always do.
"""

from __future__ import annotations

import asyncio
import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from typing import TypeVar

Result = TypeVar("Result")
Call = Callable[[], None]

PATIENCE = 60.0
"""Seconds that another thread waits for a call of :meth:`ThreadLoop.do`."""
_NAP = 0.05

_log = logging.getLogger(__name__)


class ThreadLoop:
    """The thread that made it owns the document; calling the object queues a call into it."""

    def __init__(self, failed: Callable[[Exception], None] | None = None) -> None:
        """``failed(error)`` is told, in the owner's thread, what a queued call has raised; the
        traceback goes to the log.
        """
        self._owner = threading.current_thread()
        self._calls: deque[Call] = deque()
        self._news = threading.Condition()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._failed = failed
        self.find()

    @property
    def here(self) -> bool:
        """Whether this is the owner's thread; one that has ended leaves its place to this one."""
        if not self._owner.is_alive():
            self._owner = threading.current_thread()
        return threading.current_thread() is self._owner

    @property
    def running(self) -> bool:
        """Whether there is an event loop that will come to the queue by itself."""
        self.find()
        return self._loop is not None

    def find(self) -> None:
        """Look, in the owner's thread, which event loop runs there now."""
        if self.here:
            before = self._loop
            try:
                self._loop = asyncio.get_running_loop()
            except RuntimeError:
                self._loop = None
            if self._loop not in (before, None) and self._calls:
                self._loop.call_soon(self.drain)  # what no loop was there for

    def __call__(self, call: Call) -> None:
        """Have ``call()`` called soon, in order; returns at once, from any thread."""
        with self._news:
            self._calls.append(call)
            self._news.notify_all()
        loop = self._loop
        if loop is not None:
            try:
                loop.call_soon_threadsafe(self._turn)
            except RuntimeError:  # that loop is closed: the queue waits for the next one
                self._loop = None

    def do(self, call: Callable[[], Result]) -> Result:
        """The result of ``call()``, called in the owner's thread; what it raises is raised here."""
        if self.here:
            return call()
        answer: Future[Result] = Future()

        def work() -> None:
            if answer.set_running_or_notify_cancel():
                try:
                    answer.set_result(call())
                except BaseException as error:  # goes on in the thread that asked
                    answer.set_exception(error)

        self(work)
        try:
            return answer.result(PATIENCE)
        except TimeoutError:
            if answer.done():
                raise
            answer.cancel()
            raise TimeoutError(
                f"The notebook has been busy with another cell for {PATIENCE:.0f} s: nothing done."
            ) from None

    def drain(self) -> None:
        """Make all calls that are waiting now, in the owner's thread."""
        for _ in range(len(self._calls)):
            self._turn()

    def pump(self, until: Callable[[], bool], timeout: float | None = None) -> bool:
        """Make calls, and wait for more, until ``until()``; returns whether it came to that.

        In another thread it only waits.
        """
        end = None if timeout is None else time.monotonic() + timeout
        while not until():
            left = _NAP if end is None else min(_NAP, end - time.monotonic())
            if left <= 0:
                return False
            with self._news:
                if not (self._calls and self.here):
                    self._news.wait(left)
            if self.here:
                self._turn()
        return True

    def _turn(self) -> None:
        """Make the next call, if there is one left: a pump may have been quicker."""
        with self._news:
            if not self._calls:
                return
            call = self._calls.popleft()
        try:
            call()
        except Exception as error:  # whoever queued it has gone on: the log and a person are told
            _log.error("a queued call broke off", exc_info=error)
            if self._failed is not None:
                self._failed(error)
