"""Runs a policy on the document and shows its hints.

Qt and torch are not imported here; the first run imports torch, on the worker's thread. The worker
(:mod:`meshwright.assistant.worker`) works on a copy of the mesh; its decisions are applied here, in
the thread that owns the document.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from meshwright.assistant.hints import Hinting
from meshwright.assistant.insight import InsightStore
from meshwright.assistant.outcome import nothing_left, result_of
from meshwright.assistant.policy_catalogue import label
from meshwright.assistant.progress import RunProgress
from meshwright.assistant.result_walk import ResultWalk
from meshwright.assistant.run import AgentRun, Decision, HintRequest, RunnerProtocol, State
from meshwright.assistant.search_runner import Effort, SearchRunner
from meshwright.assistant.worker import Ask, Dispatch, Load, MakeRunner, MakeSearch, PolicyWorker
from meshwright.document.document import Document
from meshwright.signals import Signal
from meshwright_core import MeshError
from meshwright_core.analysis.submesh import enclose

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight, PolicyAction

SLOWEST, FASTEST = 0.5, 60.0
"""Bounds of :attr:`Assistant.speed` in decisions per second."""

__all__ = ["FASTEST", "SLOWEST", "Assistant", "State"]


class Assistant:
    """Runs a policy on ``document``, and requests hints from it.

    ``dispatch(call)`` must call ``call()`` in the document's thread, soon and in order; the other
    parameters are those of :class:`meshwright.assistant.worker.PolicyWorker`.

    Events, emitted in the document's thread: ``changed()`` state, policy or progress changed;
    ``insight_changed()`` :attr:`insight` changed; ``message(sentence)`` a message to show;
    ``failed(sentence)`` a run has failed.
    """

    def __init__(
        self,
        document: Document,
        dispatch: Dispatch,
        load: Load | None = None,
        make_runner: MakeRunner | None = None,
        make_search: MakeSearch = SearchRunner,
        ask: Ask | None = None,
    ) -> None:
        self.changed = Signal()
        self.message = Signal()
        self.failed = Signal()
        self._document = document
        self._dispatch = dispatch
        self._worker = PolicyWorker(self, dispatch, load, make_runner, make_search, ask)
        self._state = State.IDLE
        self._policy = self._chosen = ""
        self._speed = 4.0
        self._seed = 0
        self._loading = False
        self._watch = False
        self._look_due = False
        self._run: AgentRun | None = None
        self._runner: RunnerProtocol | None = None
        self._runner_at = -1
        self._applying = False
        self._walk: ResultWalk | None = None
        self.outcome = ""
        """What the last run came to, in a sentence, as long as nothing has changed since."""
        self.unfinished = False
        """Whether that was a search that may go on: above s*, or below the wanted shape."""
        self._sight = InsightStore(document)
        self.insight_changed = self._sight.changed
        self.progress = RunProgress()
        self.hinting = Hinting(document, self._worker)
        document.replaced.connect(self._on_document_replaced)
        document.changed.connect(self._on_document_changed)

    # State

    @property
    def state(self) -> State:
        """Idle, looking, stepping, playing, paused, searching, or going to a search's result."""
        return self._state

    @property
    def running(self) -> bool:
        """True during a run; a paused run does not count."""
        return self._run is not None

    @property
    def loading(self) -> bool:
        """True while a policy is being loaded, which takes seconds the first time."""
        return self._loading

    @property
    def policy(self) -> str:
        """Name (or file) of the policy; empty while none is chosen."""
        return self._policy

    @policy.setter
    def policy(self, name: str) -> None:
        if name != self._policy:
            self.cancel()
            self.hinting.forget()
            self._policy, self._chosen, self._runner = name, "", None
            self._sight.see(None)
            self.changed.emit()
            self._look_soon()

    @property
    def speed(self) -> float:
        """Decisions per second of :meth:`play`."""
        return self._speed

    @speed.setter
    def speed(self, value: float) -> None:
        self._speed = min(max(value, SLOWEST), FASTEST)
        if self._run is not None:
            self._run.speed = self._speed
            self._run.wake.set()
        self.changed.emit()

    @property
    def watch(self) -> bool:
        """Whether :attr:`insight` is kept up to date during runs and after edits."""
        return self._watch

    @watch.setter
    def watch(self, watch: bool) -> None:
        if watch == self._watch:
            return
        self._watch = watch
        if self._run is not None:
            self._run.watch = watch
        if watch:
            self._look_soon()
        else:
            self._sight.see(None)
        self.changed.emit()

    @property
    def insight(self) -> Insight | None:
        """The policy's view of the present state and its next step; None if not known."""
        return self._sight.insight

    # Commands

    def prepare(self) -> None:
        """Load the policy ahead of the first run."""
        if self._policy and not self._worker.has(self._policy):
            self._loading = True
            self._worker.prepare(self._policy)
            self.changed.emit()

    def choose(self, name: str) -> None:
        """Load a policy and switch to it once it is loaded; nothing changes if loading fails."""
        if self._worker.has(name):
            self.policy = name
            return
        self._chosen, self._loading = name, True
        self._worker.prepare(name)
        self.changed.emit()

    def hint(self, near: np.ndarray | None = None) -> None:
        """Request the policy's best operations, near vertices (n,) if given.

        Pauses a run that plays; during a search the request is ignored.
        """
        if self._state in (State.SEARCHING, State.GOING):
            return
        if self._run is not None:
            self._end(State.PAUSED if self._state is State.PLAYING else self._run.after)
        mesh = self._document.mesh
        if not self._can_work(None) or mesh is None:
            return
        self._loading = not self._worker.has(self._policy)
        runner = self._runner
        if runner is None or self._runner_at != self._document.revision or runner.finished:
            self._seed += 1
            runner = None
        self.hinting.ask(self._policy, near, self._seed, runner)
        self.changed.emit()

    def step(self) -> None:
        """Take one decision (an operation and the clean-ups that follow it)."""
        self._begin(State.STEPPING)

    def play(self, hurry: bool = False) -> None:
        """Decide at :attr:`speed`, or as fast as possible, until finished, paused or cancelled."""
        self._begin(State.PLAYING)
        if hurry and self._run is not None:
            self._run.speed = float("inf")
            self._run.wake.set()

    def pause(self) -> None:
        """Pause a run; :meth:`play` continues it, :meth:`step` takes one more decision."""
        run = self._run
        if run is not None and run.state is State.PLAYING:
            self._end(State.PAUSED)
            self._tidy(run)

    def search(self, effort: Effort | None = None) -> None:
        """Search for the best state within `effort` and apply the operations that lead there; by
        default until s* and the wanted shape are reached or nothing more is won.
        """
        self._begin(State.SEARCHING, effort or Effort(until_done=True))

    def skip(self) -> None:
        """On the way to a search's result: go there at once."""
        run, walk = self._run, self._walk
        if run is not None and walk is not None:
            self._walked(run, walk.skip)
            self._arrive(run, walk)

    def stop(self) -> None:
        """End the run now. A search still applies its result, unless this is called again; on the
        way there it ends where it is, and the rest can be redone.
        """
        run, walk = self._run, self._walk
        if run is not None and walk is not None:
            way = walk.done, walk.total
            self._applying = True
            try:
                walk.stop_here()
            except MeshError as error:
                self.broke(run, f"The policy's operation was refused: {error}")
                return
            finally:
                self._applying = False
            self._end(State.IDLE)
            self._set_outcome(
                f"Stopped after {way[0]:,} of {way[1]:,} operations: the rest is in the history."
            )
            self.message.emit(self.outcome)
            self.changed.emit()
            return
        if run is not None and run.state is State.SEARCHING and not run.enough.is_set():
            run.enough.set()
            self.changed.emit()
            return
        self.cancel()
        if run is not None and run.state is State.PLAYING:
            self._tidy(run)

    @property
    def stopping(self) -> bool:
        """True once a search has been requested to end early."""
        return self._run is not None and self._run.enough.is_set()

    def cancel(self) -> None:
        """End the run now; what has been applied stays."""
        if self._run is not None or self._state is State.PAUSED:
            self._end(State.IDLE)

    def close(self) -> None:
        """Cancel, and end the worker thread. The assistant cannot run again."""
        self._document.replaced.disconnect(self._on_document_replaced)
        self._document.changed.disconnect(self._on_document_changed)
        self._watch = False
        self.hinting.forget()
        if self._run is not None:
            self._end(State.IDLE)
        self._worker.close()

    # Start and end of runs

    def _can_work(self, effort: Effort | None) -> bool:
        """Whether there are a mesh that can improve and a policy; emits a message if not.

        At the optimum a search (``effort``) can still improve the shape.
        """
        mesh = self._document.mesh
        if mesh is None:
            sentence = "There is no mesh to work on."
        elif not self._policy:
            sentence = "Choose a policy."
        else:
            sentence = nothing_left(mesh, effort)
        if sentence:
            self.message.emit(sentence)
        return not sentence

    def _begin(self, state: State, effort: Effort | None = None) -> None:
        if self._run is not None:
            if self._run.state is state:
                return
            # the new run replaces this one and keeps its progress
            looks = self._run.state is State.LOOKING
            self._end(self._run.after if looks else State.PAUSED)
        mesh = self._document.mesh
        if not self._can_work(effort) or mesh is None:
            self._finish_state(State.IDLE)
            return
        try:
            held = self._held(effort)
        except MeshError as error:
            self._finish_state(State.IDLE)
            self.message.emit(str(error))
            return
        synced = self._runner is not None and self._runner_at == self._document.revision
        if self._runner is None or not synced or self._runner.finished or effort is not None:
            self._runner = None
            self._seed += 1
        run = AgentRun(
            state=state,
            policy=self._policy,
            seed=self._seed,
            mesh=mesh.copy() if self._runner is None else None,
            speed=self._speed,
            watch=self._watch and effort is None,
            runner=self._runner,
            effort=effort,
            held=held,
            after=self._state,
        )
        if state is not State.LOOKING:
            afresh = self._state is State.IDLE or effort is not None
            self.progress.begin(run, afresh, self._document.score, self._document.optimum)
            self._set_outcome("")
        self._run, self._state = run, state
        self._loading = not self._worker.has(self._policy)
        self._worker.begin(run)
        self.changed.emit()

    def _held(self, effort: Effort | None) -> np.ndarray | None:
        """The vertices that keep their positions when only a region may change."""
        mesh = self._document.mesh
        if mesh is None or effort is None or effort.elements is None:
            return None
        return enclose(mesh, effort.elements).held

    def _end(self, state: State) -> None:
        run, self._run = self._run, None
        self._walk = None
        if run is not None:
            exact = run.end()
            self._runner = run.runner if exact and run.effort is None else None
            self._runner_at = self._document.revision
            self.progress.end()
        self._loading = False
        self._finish_state(state)

    def _finish_state(self, state: State) -> None:
        self._state = state
        self.changed.emit()

    def _look_soon(self) -> None:
        """Compute the insight once the event loop has run; several edits share one."""
        if self._watch and not self._look_due:
            self._look_due = True
            self._dispatch(self._look)

    def _look(self) -> None:
        self._look_due = False
        ready = self._policy and not self._document.empty and not self._document.at_optimum
        if self._watch and ready and self._run is None and self._sight.last is None:
            self._begin(State.LOOKING)

    def _on_document_replaced(self) -> None:
        """Counts of runs on another mesh are out of date; ``changed`` of the document follows."""
        self.progress.forget()

    def _on_document_changed(self) -> None:
        self.hinting.forget()
        self._sight.see(None)
        if not self._applying:
            outdated = bool(self.outcome)
            self._set_outcome("")
            self.cancel()  # the user has edited: the next run starts from the new state
            self._runner_at = -1  # the runner has not seen this edit and cannot be reused
            if outdated:
                self.changed.emit()
            self._look_soon()

    # Results of the worker (:class:`meshwright.assistant.worker.Listener`)

    def loaded(self, name: str) -> None:
        """A policy has been loaded."""
        self._loading = False
        if self._run is not None:
            self._run.began = self._run.due = time.monotonic()  # do not count the time of loading
        if name == self._chosen:
            self._chosen = ""
            self.policy = name
        self.changed.emit()

    def broke(self, cause: AgentRun | HintRequest | None, sentence: str) -> None:
        """A run, a request, or the loading of a policy has failed."""
        if isinstance(cause, AgentRun):
            if cause is not self._run:
                return
            self._end(State.IDLE)
            self._runner = None
        else:
            if isinstance(cause, HintRequest) and not self.hinting.close(cause):
                return
            self._chosen = ""
            self._loading = False
            self.changed.emit()
        self.failed.emit(sentence)

    def looked_at(self, run: AgentRun, insight: Insight | None) -> None:
        """The policy's view before its first decision."""
        if run is not self._run:
            return
        if run.state is State.LOOKING:
            self._end(run.after)
        if self._watch:
            self._sight.see(insight)

    def progressed(self, run: AgentRun, done: int, best: int) -> None:
        """A search has done ``done`` rollouts, and its lowest score is ``best``."""
        if run is self._run and self.progress.found(done, best, getattr(run.runner, "shape", None)):
            self.changed.emit()

    def answered(self, question: HintRequest, choices: tuple[PolicyAction, ...]) -> None:
        """A request for hints has been answered."""
        if not self.hinting.close(question):
            return
        if self._run is None and question.runner is not None:
            self._runner, self._runner_at = question.runner, question.revision
        self.hinting.show(choices, question.next_step)
        self.changed.emit()
        if not choices:
            self.message.emit("The policy finds no allowed operation here.")

    def decided(self, run: AgentRun, decided: Decision) -> None:
        """Apply the worker's decision; that of a search in slices."""
        if run is not self._run:
            return
        if run.effort is not None:
            self._go(run, decided)
            return
        try:
            self._applying = True
            with self._document.together():
                for operation, halfedge in decided.operations:
                    self._document.submit(
                        operation,
                        halfedge,
                        by=label(run.policy),
                        held=run.held,
                        thorough=run.state is State.STEPPING,  # a played run is smoothed at its end
                    )
        except MeshError as error:
            self.broke(run, f"The policy's operation was refused: {error}")
            return
        finally:
            self._applying = False
        decided.operations.clear()
        run.decisions += decided.decisions
        self.progress.done(decided.decisions, self._document.score)
        with run.lock:
            run.in_step = False
        if decided.finished:
            self._finish(run)
        elif run.state is State.STEPPING:
            self._end(State.PAUSED)
        if self._watch and not decided.finished:
            self._sight.see(decided.insight)
        if run is self._run:
            run.applied.set()
            self.changed.emit()

    def _go(self, run: AgentRun, decided: Decision) -> None:
        """Apply a slice of a search's result."""
        walk = self._walk
        if walk is None:
            target = getattr(run.runner, "target", None)  # of a SearchRunner
            operations = list(decided.operations)
            shown = run.effort.shown if run.effort is not None else 0.0
            author = label(run.policy)
            walk = ResultWalk(self._document, author, operations, run.held, target, shown)
            self._walk, self._state = walk, State.GOING
            with run.lock:
                run.in_step = False
        self._walked(run, walk.advance)
        if run is not self._run:
            return
        if walk.arrived:
            decided.operations.clear()
            self._arrive(run, walk)
        run.applied.set()
        self.changed.emit()

    def _walked(self, run: AgentRun, go: Callable[[], None]) -> None:
        """Call ``go``, which applies operations of a search's result."""
        walk = self._walk
        assert walk is not None
        self._applying = True
        try:
            go()
        except MeshError as error:
            self.broke(run, f"The policy's operation was refused: {error}")
        finally:
            self._applying = False
        run.decisions = self.progress.decisions = walk.done
        self.progress.way = walk.done, walk.total

    def _arrive(self, run: AgentRun, walk: ResultWalk) -> None:
        """All operations of a search's result have been applied: place the vertices."""
        if run is not self._run:
            return
        self._applying = True
        try:
            fine = walk.settle()
        finally:
            self._applying = False
        stopped = run.enough.is_set()
        self._end(State.IDLE)
        self._runner_at = -1
        self._set_outcome(*result_of(self._document, run, self.progress.counted, fine, stopped))
        self.message.emit(self.outcome)
        self.changed.emit()

    def _set_outcome(self, sentence: str, unfinished: bool = False) -> None:
        self.outcome, self.unfinished = sentence, unfinished

    def _finish(self, run: AgentRun) -> None:
        """The end of a run that is no search."""
        document = self._document
        reason = run.runner.reason if run.runner is not None else ""
        self._end(State.IDLE)
        self._tidy(run)
        if document.at_optimum:
            self._set_outcome(f"At the optimum after {self.progress.counted}.")
        else:
            self._set_outcome(f"Finished at s {document.score}{': ' + reason if reason else ''}.")
        self.message.emit(self.outcome)

    def _tidy(self, run: AgentRun) -> None:
        """Untangle what the operations of the run have left inverted."""
        from meshwright.assistant.run_cleanup import clean_up

        if not run.decisions:
            return
        seen = self._sight.last
        self._applying = True
        try:
            clean_up(self._document, label(run.policy))
        finally:
            self._applying = False
        self._runner_at = self._document.revision  # only positions have changed
        self._sight.see(seen)
