"""The assistant's worker: a thread on which policies are loaded, played and asked.

It never touches the document. What it finds is handed over by ``dispatch``, which makes the calls
in the document's thread; after a decision it waits until that has been applied, so that decisions
never pile up and a cancelled run leaves nothing behind.
"""

from __future__ import annotations

import atexit
import logging
import threading
import time
from collections.abc import Callable
from functools import partial
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from meshwright.assistant.run import Decided, Question, Run, Runner, State, Step
from meshwright.assistant.search_runner import Effort, SearchRunner
from meshwright_core import HalfEdgeMesh

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight, PolicyAction

LEAVE_SECONDS = 10.0
"""Seconds that the end of the program waits for the thread, at most."""
CATCH_UP = 0.2
"""Seconds by which a played decision may be late without putting off those after it."""
BATCH_SECONDS = 0.03
"""Seconds for which a search gathers its operations before it hands them over."""

Dispatch = Callable[[Callable[[], None]], None]
Load = Callable[[str], Any]
MakeRunner = Callable[[HalfEdgeMesh, Any, int], Runner]
MakeSearch = Callable[
    [HalfEdgeMesh, Any, int, Effort, threading.Event, Callable[[int, int], None]], Runner
]
Ask = Callable[[HalfEdgeMesh, Any, "np.ndarray | None"], "tuple[PolicyAction, ...]"]

_log = logging.getLogger(__name__)


class Listener(Protocol):
    """What the worker has to say; called in the document's thread."""

    def loaded(self, name: str) -> None:
        """A policy is there."""
        ...

    def broke(self, cause: Run | Question | None, sentence: str) -> None:
        """A run, a question, or the loading of a policy (None) came to nothing."""
        ...

    def looked_at(self, run: Run, insight: Insight | None) -> None:
        """What the policy sees before its first decision."""
        ...

    def decided(self, run: Run, decided: Decided) -> None:
        """Operations to apply; the worker waits until ``run.applied`` is set."""
        ...

    def progressed(self, run: Run, done: int, best: int) -> None:
        """So many rollouts are done, and this is the lowest s so far."""
        ...

    def answered(self, question: Question, choices: tuple[PolicyAction, ...]) -> None:
        """The policy's best few operations."""
        ...


class Worker:
    """One thread, begun when it is first needed.

    ``load(name)`` returns a policy, ``make_runner(mesh, policy, seed)`` a runner that works on its
    own copy, ``make_search`` one as :class:`meshwright.assistant.search_runner.SearchRunner` is,
    ``ask(mesh, policy, near)`` the policy's best few operations; all are called on the thread.
    """

    def __init__(
        self,
        listener: Listener,
        dispatch: Dispatch,
        load: Load | None = None,
        make_runner: MakeRunner | None = None,
        make_search: MakeSearch = SearchRunner,
        ask: Ask | None = None,
    ) -> None:
        self._listener, self._dispatch = listener, dispatch
        self._load = load or _load_policy
        self._make_runner = make_runner or _make_runner
        self._make_search = make_search
        self._ask = ask or _ask_policy
        self._policies: dict[str, Any] = {}
        self._tasks: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._thread: threading.Thread | None = None
        self._closed = threading.Event()
        self._run: Run | None = None

    # In the document's thread

    def has(self, name: str) -> bool:
        """Whether a policy is loaded."""
        return name in self._policies

    def prepare(self, name: str) -> None:
        """Load a policy."""
        self._submit(partial(self._policy_of, name), None)

    def begin(self, run: Run) -> None:
        """Work on a run until it is over or stopped."""
        self._run = run
        self._submit(partial(self._work, run), run)

    def answer(self, question: Question) -> None:
        """Answer a question."""
        self._submit(partial(self._answer, question), question)

    def close(self) -> None:
        """Let the thread end, without waiting for it; what has not been begun is left undone."""
        self._closed.set()
        self._tasks.put(None)

    def _submit(self, task: Callable[[], Any], cause: Run | Question | None) -> None:
        if self._thread is None:
            # a daemon: a program that breaks off does not wait for decisions that nobody applies
            self._thread = threading.Thread(target=self._serve, name="assistant", daemon=True)
            self._thread.start()
            atexit.register(self._leave)
        self._tasks.put(partial(self._guarded, task, cause))

    def _leave(self) -> None:
        """The program ends: a thread in compiled code must not outlive the interpreter."""
        self.close()
        if self._run is not None:
            self._run.end()
        if self._thread is not None:
            self._thread.join(LEAVE_SECONDS)

    # On the thread

    def _serve(self) -> None:
        while (task := self._tasks.get()) is not None and not self._closed.is_set():
            task()
        atexit.unregister(self._leave)

    def _guarded(self, task: Callable[[], Any], cause: Run | Question | None) -> None:
        try:
            task()
        except Exception as error:  # a thread's boundary: whatever broke is told to the person
            self._dispatch(partial(self._listener.broke, cause, _sentence(error)))

    def _policy_of(self, name: str) -> Any:
        if name not in self._policies:
            self._policies[name] = self._load(name)
            self._dispatch(partial(self._listener.loaded, name))
        return self._policies[name]

    def _answer(self, question: Question) -> None:
        policy = self._policy_of(question.policy)
        choices = self._ask(question.mesh, policy, question.near)
        self._dispatch(partial(self._listener.answered, question, choices))

    def _work(self, run: Run) -> None:
        if run.stop.is_set():
            return
        policy = self._policy_of(run.policy)
        if run.mesh is not None:
            run.runner = self._runner_of(run, run.mesh, policy)
            run.mesh = None
        runner = run.runner
        if runner is None or run.stop.is_set():
            return
        if run.state is State.LOOKING or (run.watch and run.state is State.PLAYING):
            self._dispatch(partial(self._listener.looked_at, run, runner.look()))
            self._wait(run)
        while run.state is not State.LOOKING and self._decide(run, runner):
            pass

    def _runner_of(self, run: Run, mesh: HalfEdgeMesh, policy: Any) -> Runner:
        if run.effort is None:
            return self._make_runner(mesh, policy, run.seed)

        def progress(done: int, best: int) -> None:
            self._dispatch(partial(self._listener.progressed, run, done, best))

        return self._make_search(mesh, policy, run.seed, run.effort, run.enough, progress)

    def _decide(self, run: Run, runner: Runner) -> bool:
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
        finished = runner.finished
        insight = runner.look() if run.watch and not finished else None
        decided = Decided(operations, decisions, finished, insight)
        self._dispatch(partial(self._listener.decided, run, decided))
        run.applied.wait()
        self._wait(run)
        return not run.stop.is_set() and not finished

    def _wait(self, run: Run) -> None:
        """While playing, wait until it is time for the next decision.

        Decisions are due at equal distances. Those after one that comes late catch up, unless it
        is so late that they would come all at once.
        """
        before, now = run.due, time.monotonic()
        while run.state is State.PLAYING and not run.stop.is_set():
            run.wake.clear()  # set again when the speed changes or the run ends
            if run.stop.is_set():
                break
            run.due = max(before + 1.0 / run.speed, now - CATCH_UP)
            left = run.due - time.monotonic()
            if left <= 0 or not run.wake.wait(left):
                break


def _sentence(error: Exception) -> str:
    if isinstance(error, (ValueError, OSError)):
        return str(error)
    _log.error("the policy run broke off", exc_info=error)
    return f"The policy run broke off ({type(error).__name__}: {error})."


def _load_policy(name: str) -> Any:
    from meshwright_agent.policy import policy_files

    policy_files.decide_on_one_thread()
    return policy_files.load(name)


def _make_runner(mesh: HalfEdgeMesh, policy: Any, seed: int) -> Runner:
    from meshwright_agent.policy.rollout import Runner as PolicyRunner

    return PolicyRunner(mesh, policy, seed)


def _ask_policy(
    mesh: HalfEdgeMesh, policy: Any, near: np.ndarray | None
) -> tuple[PolicyAction, ...]:
    from meshwright_agent.policy.explanation import hints

    return hints(mesh, policy, near=near)
