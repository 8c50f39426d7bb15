"""The thread on which policies are loaded and run.

It never accesses the document. Results are passed to a listener by ``dispatch``, which makes the
calls in the document's thread. After each decision the thread waits until the decision has been
applied, so that decisions do not queue up and a cancelled run leaves none behind.
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

from meshwright.assistant.run import (
    AgentRun,
    Decision,
    DecisionStep,
    HintRequest,
    RunnerProtocol,
    State,
)
from meshwright.assistant.search_runner import Effort, SearchRunner
from meshwright_core import HalfEdgeMesh

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight, PolicyAction

LEAVE_SECONDS = 10.0
"""Time limit, in seconds, for which the exiting program waits for the thread."""
CATCH_UP = 0.2
"""Seconds by which a played decision may be late without delaying later ones."""
BREATH = 0.004
"""Seconds between two slices of operations, for the document's thread to draw and take input."""

Dispatch = Callable[[Callable[[], None]], None]
Load = Callable[[str], Any]
MakeRunner = Callable[[HalfEdgeMesh, Any, int], RunnerProtocol]
MakeSearch = Callable[
    [HalfEdgeMesh, Any, int, Effort, threading.Event, Callable[[int, int], None]], RunnerProtocol
]
Ask = Callable[[HalfEdgeMesh, Any, "np.ndarray | None"], "tuple[PolicyAction, ...]"]

_log = logging.getLogger(__name__)


class Listener(Protocol):
    """Receives the results of the worker, in the document's thread."""

    def loaded(self, name: str) -> None:
        """A policy has been loaded."""
        ...

    def broke(self, cause: AgentRun | HintRequest | None, sentence: str) -> None:
        """A run, a request, or the loading of a policy (None) has failed."""
        ...

    def looked_at(self, run: AgentRun, insight: Insight | None) -> None:
        """What the policy sees before its first decision."""
        ...

    def decided(self, run: AgentRun, decided: Decision) -> None:
        """Operations to apply; the worker waits until ``run.applied`` is set, and calls again as
        long as some are left.
        """
        ...

    def progressed(self, run: AgentRun, done: int, best: int) -> None:
        """A search has done ``done`` rollouts, and its lowest score is ``best``."""
        ...

    def answered(self, question: HintRequest, choices: tuple[PolicyAction, ...]) -> None:
        """A request for hints has been answered with the policy's best operations."""
        ...


class PolicyWorker:
    """Loads and runs policies on one thread, which starts with the first task.

    ``load(name)`` returns a policy, ``make_runner(mesh, policy, seed)`` a runner that works on its
    own copy, ``ask(mesh, policy, near)`` the policy's best operations. ``make_search`` takes the
    arguments of :class:`meshwright.assistant.search_runner.SearchRunner`. All are called on the
    thread.
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
        self._run: AgentRun | None = None

    # In the document's thread

    def has(self, name: str) -> bool:
        """Whether a policy is loaded."""
        return name in self._policies

    def prepare(self, name: str) -> None:
        """Load a policy."""
        self._submit(partial(self._policy_of, name), None)

    def begin(self, run: AgentRun) -> None:
        """Work on a run until it is over or stopped."""
        self._run = run
        self._submit(partial(self._work, run), run)

    def answer(self, question: HintRequest) -> None:
        """Request hints."""
        self._submit(partial(self._answer, question), question)

    def close(self) -> None:
        """End the thread, without waiting for it; tasks that have not started are dropped."""
        self._closed.set()
        self._tasks.put(None)

    def _submit(self, task: Callable[[], Any], cause: AgentRun | HintRequest | None) -> None:
        if self._thread is None:
            # a daemon thread: an exiting program must not wait for decisions to be applied
            self._thread = threading.Thread(target=self._serve, name="assistant", daemon=True)
            self._thread.start()
            atexit.register(self._leave)
        self._tasks.put(partial(self._guarded, task, cause))

    def _leave(self) -> None:
        """Stop the thread at exit: compiled code must not run after the interpreter has ended."""
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

    def _guarded(self, task: Callable[[], Any], cause: AgentRun | HintRequest | None) -> None:
        try:
            task()
        except Exception as error:  # the outermost frame of the thread: every error is reported
            self._dispatch(partial(self._listener.broke, cause, _sentence(error)))

    def _policy_of(self, name: str) -> Any:
        if name not in self._policies:
            self._policies[name] = self._load(name)
            self._dispatch(partial(self._listener.loaded, name))
        return self._policies[name]

    def _answer(self, question: HintRequest) -> None:
        policy = self._policy_of(question.policy)
        choices = self._ask(question.mesh, policy, question.near)
        if question.runner is None:
            question.runner = self._make_runner(question.mesh.copy(), policy, question.seed)
        insight = question.runner.look()
        if insight is not None:
            first = question.next_step = insight.wanted
            others = (one for one in choices if not _alike(question.mesh, one, first))
            choices = (first, *others)[: max(len(choices), 1)]
        self._dispatch(partial(self._listener.answered, question, choices))

    def _work(self, run: AgentRun) -> None:
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

    def _runner_of(self, run: AgentRun, mesh: HalfEdgeMesh, policy: Any) -> RunnerProtocol:
        if run.effort is None:
            return self._make_runner(mesh, policy, run.seed)

        def progress(done: int, best: int) -> None:
            self._dispatch(partial(self._listener.progressed, run, done, best))

        return self._make_search(mesh, policy, run.seed, run.effort, run.enough, progress)

    def _decide(self, run: AgentRun, runner: RunnerProtocol) -> bool:
        """Take one decision, or all of a search, and wait until applied; False when over."""
        with run.lock:
            if run.stop.is_set():
                return False
            run.in_step = True
            run.applied.clear()
        operations: DecisionStep = []
        decisions = 0
        while not runner.finished and not run.stop.is_set():
            step = runner.step()
            operations += step
            decisions += bool(step)
            if run.effort is None:
                break
        finished = runner.finished
        insight = runner.look() if run.watch and not finished else None
        decided = Decision(operations, decisions, finished, insight)
        while True:
            run.applied.clear()
            if run.stop.is_set():
                return False
            self._dispatch(partial(self._listener.decided, run, decided))
            run.applied.wait()
            if not decided.operations or run.stop.is_set():
                break
            time.sleep(BREATH)  # a queue that is never empty would keep input and frames waiting
        self._wait(run)
        return not run.stop.is_set() and not finished

    def _wait(self, run: AgentRun) -> None:
        """While playing, wait until it is time for the next decision.

        Decisions are due at equal intervals. After a late decision the following ones catch up,
        unless it was more than CATCH_UP late.
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


def _alike(mesh: HalfEdgeMesh, one: PolicyAction, other: PolicyAction) -> bool:
    """Whether two actions do the same, perhaps named by two half-edges."""
    if one.operation != other.operation:
        return False
    h = one.halfedge
    same = {h}
    if mesh.k == 3 or one.operation.value in ("flip_left", "flip_right"):
        same.add(mesh.twin(h))
    elif one.operation.value == "collapse":
        same.add(h - h % 4 + (h + 2) % 4)  # the diagonal from its other end
    return other.halfedge in same


def _sentence(error: Exception) -> str:
    if isinstance(error, (ValueError, OSError)):
        return str(error)
    _log.error("the policy run broke off", exc_info=error)
    return f"The policy run broke off ({type(error).__name__}: {error})."


def _load_policy(name: str) -> Any:
    from meshwright_agent.policy import policy_files

    policy_files.decide_on_one_thread()
    return policy_files.load(name)


def _make_runner(mesh: HalfEdgeMesh, policy: Any, seed: int) -> RunnerProtocol:
    from meshwright_agent.policy.rollout import Runner as PolicyRunner

    return PolicyRunner(mesh, policy, seed)


def _ask_policy(
    mesh: HalfEdgeMesh, policy: Any, near: np.ndarray | None
) -> tuple[PolicyAction, ...]:
    from meshwright_agent.policy.explanation import hints

    return hints(mesh, policy, near=near)
