"""The assistant: runs of a policy on the document, step by step, played, or to the end.

Neither Qt nor torch is imported here; the first run brings torch in, on the worker thread. The
worker works on a copy of the mesh and never touches the document: what it decides is handed to
``dispatch``, which calls it in the document's thread. The worker then waits until the decision has
been applied, so that decisions never pile up and a cancelled run leaves nothing behind.
"""

import logging
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from enum import StrEnum
from functools import partial
from typing import Any, Protocol

from app.document import Document
from app.searching import Effort, SearchRunner
from app.signals import Signal
from meshcore import HalfEdgeMesh, MeshError, Operation

APPLY_BUDGET = 0.02
"""Seconds of applying operations after which the window gets its turn."""
BATCH_SECONDS = 0.03
"""Seconds for which a search gathers its operations before it hands them over."""
SLOWEST, FASTEST = 0.5, 60.0
"""Bounds of :attr:`Assistant.speed` in decisions per second."""

Step = list[tuple[Operation, int]]
Dispatch = Callable[[Callable[[], None]], None]
Search = Callable[
    [HalfEdgeMesh, Any, int, Effort, threading.Event, Callable[[int, int], None]], "Runner"
]

_log = logging.getLogger(__name__)


class Runner(Protocol):
    """What the assistant needs of ``agent.rollout.Runner``."""

    @property
    def finished(self) -> bool:
        """True once there is nothing more to decide."""
        ...

    @property
    def reason(self) -> str:
        """Why it is finished, in words; empty before."""
        ...

    def step(self) -> Step:
        """The next operation and the clean-ups that follow it; empty when finished."""
        ...


class State(StrEnum):
    """What the assistant is doing."""

    IDLE = "idle"
    STEPPING = "stepping"
    PLAYING = "playing"
    PAUSED = "paused"
    SEARCHING = "searching"


@dataclass
class _Run:
    """One run: shared by the document's thread and the worker; ``lock`` guards the flags."""

    state: State
    policy: str
    seed: int
    mesh: HalfEdgeMesh | None
    first: int
    effort: Effort | None = None
    runner: Runner | None = None
    in_step: bool = False
    decisions: int = 0
    lock: threading.Lock = field(default_factory=threading.Lock)
    stop: threading.Event = field(default_factory=threading.Event)
    applied: threading.Event = field(default_factory=threading.Event)
    wake: threading.Event = field(default_factory=threading.Event)
    enough: threading.Event = field(default_factory=threading.Event)

    def end(self) -> bool:
        """Stop the worker; True if the runner stands exactly where the document stands."""
        with self.lock:
            self.stop.set()
            in_step = self.in_step
        self.applied.set()
        self.wake.set()
        self.enough.set()
        return not in_step and self.runner is not None


class Assistant:
    """Runs a policy on ``document``.

    ``dispatch(call)`` must call ``call()`` in the document's thread, soon and in order.
    ``load(name)`` returns a policy, ``make_runner(mesh, policy, seed)`` a :class:`Runner` that
    works on its own copy, ``make_search`` one as :class:`app.searching.SearchRunner` is; all are
    called on the worker thread.

    Events, emitted in the document's thread: ``changed()`` state, policy or progress differ;
    ``said(sentence)`` something a person wants to know; ``failed(sentence)`` the run broke off.
    """

    def __init__(
        self,
        document: Document,
        dispatch: Dispatch,
        load: Callable[[str], Any] | None = None,
        make_runner: Callable[[HalfEdgeMesh, Any, int], Runner] | None = None,
        make_search: Search = SearchRunner,
    ) -> None:
        self.changed = Signal()
        self.said = Signal()
        self.failed = Signal()
        self._document = document
        self._dispatch = dispatch
        self._load = load or _load_policy
        self._make_runner = make_runner or _make_runner
        self._make_search = make_search
        self._best_so_far: int | None = None
        self._state = State.IDLE
        self._policy = ""
        self._speed = 4.0
        self._seed = 0
        self._policies: dict[str, Any] = {}
        self._loading = False
        self._run: _Run | None = None
        self._runner: Runner | None = None
        self._runner_at = -1
        self._applying = False
        self._decisions = 0
        self._pool: ThreadPoolExecutor | None = None
        document.changed.connect(self._on_document_changed)

    # What it is doing

    @property
    def state(self) -> State:
        """Idle, stepping, playing, paused or searching."""
        return self._state

    @property
    def running(self) -> bool:
        """True while a run is under way; a paused one is not."""
        return self._run is not None

    @property
    def loading(self) -> bool:
        """True while the policy is being loaded (the first time that takes seconds)."""
        return self._loading

    @property
    def decisions(self) -> int:
        """Decisions applied since the run began; a paused run that goes on counts on."""
        return self._decisions

    @property
    def policy(self) -> str:
        """Name (or file) of the policy; empty while none is chosen."""
        return self._policy

    @policy.setter
    def policy(self, name: str) -> None:
        if name != self._policy:
            self.cancel()
            self._policy = name
            self._runner = None
            self.changed.emit()

    @property
    def speed(self) -> float:
        """Decisions per second of :meth:`play`."""
        return self._speed

    @speed.setter
    def speed(self, value: float) -> None:
        self._speed = min(max(value, SLOWEST), FASTEST)
        if self._run is not None:
            self._run.wake.set()
        self.changed.emit()

    # What a person asks for

    def prepare(self) -> None:
        """Load the policy ahead of the first run."""
        if self._policy and self._policy not in self._policies:
            self._loading = True
            self._worker().submit(self._prepare, self._policy)
            self.changed.emit()

    def step(self) -> None:
        """Take one decision (an operation and the clean-ups that follow it)."""
        self._begin(State.STEPPING)

    def play(self) -> None:
        """Take decisions at :attr:`speed` until finished, paused or cancelled."""
        self._begin(State.PLAYING)

    def pause(self) -> None:
        """Hold a played run; :meth:`play` goes on, :meth:`step` takes one decision more."""
        if self._state is State.PLAYING:
            self._end(State.PAUSED)

    def search(self, effort: Effort | None = None) -> None:
        """Look for the best state within `effort` and go there by the shortest way found."""
        self._begin(State.SEARCHING, effort or Effort())

    @property
    def best_so_far(self) -> int | None:
        """The lowest s that the search under way has found; None before, and without a search."""
        return self._best_so_far

    def stop(self) -> None:
        """End the run now; a search still does what it has found, unless asked once more."""
        run = self._run
        if run is not None and run.state is State.SEARCHING and not run.enough.is_set():
            run.enough.set()
        else:
            self.cancel()

    def cancel(self) -> None:
        """End the run now; what has been applied stays."""
        if self._run is not None or self._state is State.PAUSED:
            self._end(State.IDLE)

    def close(self) -> None:
        """Cancel, and let the worker thread end. The assistant cannot run again."""
        self._document.changed.disconnect(self._on_document_changed)
        if self._run is not None:
            self._end(State.IDLE)
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)

    # The document's thread

    def _begin(self, state: State, effort: Effort | None = None) -> None:
        mesh = self._document.mesh
        if self._run is not None:
            if self._run.state is state:
                return
            self._end(State.PAUSED)  # one run gives way to the next, its progress is kept
        if mesh is None or not self._policy:
            self.said.emit("There is no mesh to work on." if mesh is None else "Choose a policy.")
            return
        if self._document.at_optimum:
            self._finish_state(State.IDLE)
            self.said.emit("Already at the optimum: nothing is left to improve.")
            return
        if self._state is State.IDLE:
            self._decisions = 0
        synced = self._runner is not None and self._runner_at == self._document.revision
        if self._runner is None or not synced or self._runner.finished or effort is not None:
            self._runner = None
            self._seed += 1
        self._best_so_far = None
        run = _Run(
            state=state,
            policy=self._policy,
            seed=self._seed,
            mesh=mesh.copy() if self._runner is None else None,
            first=self._document.history.cursor,
            effort=effort,
            runner=self._runner,
        )
        self._run, self._state = run, state
        self._loading = self._policy not in self._policies
        self._worker().submit(self._work, run)
        self.changed.emit()

    def _apply(self, run: _Run, operations: Step, finished: bool, decisions: int) -> None:
        """Submit what the worker decided; gives the event loop its turn in between."""
        if run is not self._run:
            return
        deadline = time.monotonic() + APPLY_BUDGET
        try:
            self._applying = True
            while operations:
                operation, halfedge = operations.pop(0)
                self._document.submit(operation, halfedge, by=run.policy)
                if operations and time.monotonic() > deadline:
                    self._dispatch(partial(self._apply, run, operations, finished, decisions))
                    return
        except MeshError as error:
            self._break_off(run, f"The policy's operation was refused: {error}")
            return
        finally:
            self._applying = False
        self._decisions += decisions
        run.decisions += decisions
        with run.lock:
            run.in_step = False
        if finished:
            self._finish(run)
        elif run.state is State.STEPPING:
            self._end(State.PAUSED)
        else:
            run.applied.set()
            self.changed.emit()

    def _finish(self, run: _Run) -> None:
        document = self._document
        reason = run.runner.reason if run.runner is not None else ""
        self._end(State.IDLE)
        if run.effort is not None and run.decisions:
            # what smoothing around each operation has folded on the way, the whole unfolds
            document.smooth(by=run.policy)
        if document.at_optimum:
            self.said.emit(f"At the optimum after {_count(self._decisions, 'decision')}.")
        else:
            self.said.emit(f"Finished at s {document.score}{': ' + reason if reason else ''}.")

    def _end(self, state: State) -> None:
        run, self._run = self._run, None
        if run is not None:
            exact = run.end()
            self._runner = run.runner if exact and run.effort is None else None
            self._runner_at = self._document.revision
        self._loading = False
        self._finish_state(state)

    def _finish_state(self, state: State) -> None:
        self._state = state
        self.changed.emit()

    def _break_off(self, run: _Run | None, sentence: str) -> None:
        if run is not self._run:
            return
        self._end(State.IDLE)
        self._runner = None
        self.failed.emit(sentence)

    def _on_progress(self, run: _Run, best: int) -> None:
        if run is self._run and best != self._best_so_far:
            self._best_so_far = best
            self.changed.emit()

    def _loaded(self, name: str, policy: Any) -> None:
        self._policies[name] = policy
        self._loading = False
        self.changed.emit()

    def _on_document_changed(self) -> None:
        if not self._applying:
            self.cancel()  # a person took over; the next run starts from what is there then

    def _worker(self) -> ThreadPoolExecutor:
        if self._pool is None:
            self._pool = ThreadPoolExecutor(max_workers=1, thread_name_prefix="assistant")
        return self._pool

    # The worker thread

    def _prepare(self, name: str) -> None:
        try:
            self._policy_of(name)
        except Exception as error:  # a thread's boundary: whatever broke is told to the person
            self._dispatch(partial(self._break_off, None, _sentence(error)))

    def _policy_of(self, name: str) -> Any:
        if name not in self._policies:
            policy = self._load(name)
            self._policies[name] = policy
            self._dispatch(partial(self._loaded, name, policy))
        return self._policies[name]

    def _work(self, run: _Run) -> None:
        try:
            policy = self._policy_of(run.policy)
            if run.mesh is not None:
                run.runner = self._runner_of(run, run.mesh, policy)
                run.mesh = None
            while run.runner is not None and self._decide(run, run.runner):
                pass
        except Exception as error:  # a thread's boundary: whatever broke is told to the person
            self._dispatch(partial(self._break_off, run, _sentence(error)))

    def _runner_of(self, run: _Run, mesh: HalfEdgeMesh, policy: Any) -> Runner:
        if run.effort is None:
            return self._make_runner(mesh, policy, run.seed)

        def progress(done: int, best: int) -> None:
            self._dispatch(partial(self._on_progress, run, best))

        return self._make_search(mesh, policy, run.seed, run.effort, run.enough, progress)

    def _decide(self, run: _Run, runner: Runner) -> bool:
        """Take one decision, or a batch of them, and wait until applied; False when over."""
        begun = time.monotonic()
        with run.lock:
            if run.stop.is_set():
                return False
            run.in_step = True
            run.applied.clear()
        operations: Step = []
        decisions = 0
        while not runner.finished and not run.stop.is_set():
            step = runner.step()
            operations += step
            decisions += bool(step)
            if run.state is not State.SEARCHING or time.monotonic() - begun > BATCH_SECONDS:
                break
        self._dispatch(partial(self._apply, run, operations, runner.finished, decisions))
        run.applied.wait()
        while run.state is State.PLAYING and not run.stop.is_set():
            run.wake.clear()  # set again when the speed changes or the run ends
            if run.stop.is_set():
                break
            left = begun + 1.0 / self._speed - time.monotonic()
            if left <= 0 or not run.wake.wait(left):
                break
        return not run.stop.is_set() and not runner.finished


def _sentence(error: Exception) -> str:
    if isinstance(error, (ValueError, OSError)):
        return str(error)
    _log.error("the policy run broke off", exc_info=error)
    return f"The policy run broke off ({type(error).__name__}: {error})."


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _load_policy(name: str) -> Any:
    from agent import policies

    policies.decide_on_one_thread()
    return policies.load(name)


def _make_runner(mesh: HalfEdgeMesh, policy: Any, seed: int) -> Runner:
    from agent.rollout import Runner as PolicyRunner

    return PolicyRunner(mesh, policy, seed)
