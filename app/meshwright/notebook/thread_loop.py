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

TIMEOUT = 60.0
"""Seconds after which a call of :meth:`ThreadLoop.do` from another thread times out."""
_POLL = 0.05

_log = logging.getLogger(__name__)


class ThreadLoop:
    """Queue of calls into the owner's thread, which is the thread that created the object."""

    def __init__(self, failed: Callable[[Exception], None] | None = None) -> None:
        """``failed(error)`` is called in the owner's thread with what a queued call has raised; the
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
        """Whether this is the owner's thread; if that has ended, this thread becomes the owner."""
        if not self._owner.is_alive():
            self._owner = threading.current_thread()
        return threading.current_thread() is self._owner

    @property
    def running(self) -> bool:
        """Whether an event loop processes the queue."""
        self.find()
        return self._loop is not None

    def find(self) -> None:
        """Update the event loop, if called in the owner's thread."""
        if self.here:
            before = self._loop
            try:
                self._loop = asyncio.get_running_loop()
            except RuntimeError:
                self._loop = None
            if self._loop not in (before, None) and self._calls:
                self._loop.call_soon(self.drain)  # calls that were queued without a loop

    def __call__(self, call: Call) -> None:
        """Queue ``call()``; returns at once, from any thread. Calls run in order."""
        with self._news:
            self._calls.append(call)
            self._news.notify_all()
        loop = self._loop
        if loop is not None:
            try:
                loop.call_soon_threadsafe(self._turn)
            except RuntimeError:  # that loop is closed: the calls wait for the next one
                self._loop = None

    def later(self, seconds: float, call: Call) -> bool:
        """Queue ``call()`` in ``seconds``; False without an event loop, or in another thread."""
        if not self.running or not self.here or self._loop is None:
            return False
        self._loop.call_later(seconds, self, call)
        return True

    def do(self, call: Callable[[], Result]) -> Result:
        """The result of ``call()``, called in the owner's thread; what it raises is raised here."""
        if self.here:
            return call()
        answer: Future[Result] = Future()

        def work() -> None:
            if answer.set_running_or_notify_cancel():
                try:
                    answer.set_result(call())
                except BaseException as error:  # raised again in the calling thread
                    answer.set_exception(error)

        self(work)
        try:
            return answer.result(TIMEOUT)
        except TimeoutError:
            if answer.done():
                raise
            answer.cancel()
            raise TimeoutError(
                f"Nothing was done: another cell has kept the notebook busy for {TIMEOUT:.0f} s."
            ) from None

    def drain(self) -> None:
        """Run all calls that are queued now, in the owner's thread."""
        for _ in range(len(self._calls)):
            self._turn()

    def pump(self, until: Callable[[], bool], timeout: float | None = None) -> bool:
        """Run queued calls until ``until()`` is true; returns False at the timeout (s).

        In another thread it only waits.
        """
        end = None if timeout is None else time.monotonic() + timeout
        while not until():
            left = _POLL if end is None else min(_POLL, end - time.monotonic())
            if left <= 0:
                return False
            with self._news:
                if not (self._calls and self.here):
                    self._news.wait(left)
            if self.here:
                self._turn()
        return True

    def _turn(self) -> None:
        """Run the next call, unless a pump has run it already."""
        with self._news:
            if not self._calls:
                return
            call = self._calls.popleft()
        try:
            call()
        except Exception as error:  # its caller has returned: log it and show it
            _log.error("a queued call failed", exc_info=error)
            if self._failed is not None:
                self._failed(error)
