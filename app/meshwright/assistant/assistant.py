"""The assistant: a policy's runs on the document, and its hints.

Neither Qt nor torch is imported here; the first run brings torch in, on the worker's thread. The
worker (:mod:`meshwright.assistant.worker`) plays on a copy of the mesh; what it decides is applied
here, in the thread that owns the document.
"""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from meshwright.assistant.hints import Hinting
from meshwright.assistant.insight import Sight
from meshwright.assistant.policy_catalogue import label
from meshwright.assistant.progress import Progress
from meshwright.assistant.run import Decided, Question, Run, Runner, State
from meshwright.assistant.search_runner import Effort, SearchRunner
from meshwright.assistant.worker import Ask, Dispatch, Load, MakeRunner, MakeSearch, Worker
from meshwright.document.document import Document
from meshwright.signals import Signal
from meshwright_core import MeshError
from meshwright_core.analysis.submesh import enclose

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight, PolicyAction

APPLY_BUDGET = 0.02
"""Seconds of applying operations after which the window gets its turn."""
SLOWEST, FASTEST = 0.5, 60.0
"""Bounds of :attr:`Assistant.speed` in decisions per second."""

__all__ = ["FASTEST", "SLOWEST", "Assistant", "State"]


class Assistant:
    """Runs a policy on ``document``, and asks it for hints.

    ``dispatch(call)`` must call ``call()`` in the document's thread, soon and in order; the other
    parameters are those of :class:`meshwright.assistant.worker.Worker`.

    Events, emitted in the document's thread: ``changed()`` state, policy or progress differ;
    ``looked()`` :attr:`insight` is another; ``said(sentence)`` something a person wants to know;
    ``failed(sentence)`` a run broke off.
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
        self.said = Signal()
        self.failed = Signal()
        self._document = document
        self._dispatch = dispatch
        self._worker = Worker(self, dispatch, load, make_runner, make_search, ask)
        self._state = State.IDLE
        self._policy = self._chosen = ""
        self._speed = 4.0
        self._seed = 0
        self._loading = False
        self._watch = False
        self._look_due = False
        self._run: Run | None = None
        self._runner: Runner | None = None
        self._runner_at = -1
        self._applying = False
        self._sight = Sight(document)
        self.looked = self._sight.changed
        self.progress = Progress()
        self.hinting = Hinting(document, self._worker)
        document.changed.connect(self._on_document_changed)

    # What it is doing

    @property
    def state(self) -> State:
        """Idle, looking, stepping, playing, paused or searching."""
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
        """Whether :attr:`insight` follows the policy, and the person's edits."""
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
        """What the policy sees in the present state, and will do next; None if not known."""
        return self._sight.insight

    # What a person asks for

    def prepare(self) -> None:
        """Load the policy ahead of the first run."""
        if self._policy and not self._worker.has(self._policy):
            self._loading = True
            self._worker.prepare(self._policy)
            self.changed.emit()

    def choose(self, name: str) -> None:
        """Load a policy, and take it once it is there; if it cannot be had nothing else changes."""
        if self._worker.has(name):
            self.policy = name
            return
        self._chosen, self._loading = name, True
        self._worker.prepare(name)
        self.changed.emit()

    def hint(self, near: np.ndarray | None = None) -> None:
        """Ask the policy for its best few operations, near vertices (n,) if given.

        A run that plays is held; one that searches goes on, and nothing is asked.
        """
        if self._state is State.SEARCHING:
            return
        if self._run is not None:
            self._end(State.PAUSED if self._state is State.PLAYING else self._run.after)
        mesh = self._document.mesh
        if not self._can_work() or mesh is None:
            return
        self._loading = not self._worker.has(self._policy)
        self.hinting.ask(self._policy, near)
        self.changed.emit()

    def step(self) -> None:
        """Take one decision (an operation and the clean-ups that follow it)."""
        self._begin(State.STEPPING)

    def play(self, hurry: bool = False) -> None:
        """Decide at :attr:`speed`, or as fast as it can, until finished, paused or cancelled."""
        self._begin(State.PLAYING)
        if hurry and self._run is not None:
            self._run.speed = float("inf")
            self._run.wake.set()

    def pause(self) -> None:
        """Hold a played run; :meth:`play` goes on, :meth:`step` takes one decision more."""
        run = self._run
        if run is not None and run.state is State.PLAYING:
            self._end(State.PAUSED)
            self._tidy(run)

    def search(self, effort: Effort | None = None) -> None:
        """Look for the best state within `effort` and go there by the shortest way found."""
        self._begin(State.SEARCHING, effort or Effort())

    def stop(self) -> None:
        """End the run now; a search still does what it has found, unless asked once more."""
        run = self._run
        if run is not None and run.state is State.SEARCHING and not run.enough.is_set():
            run.enough.set()
            self.changed.emit()
            return
        self.cancel()
        if run is not None and run.state is State.PLAYING:
            self._tidy(run)

    @property
    def stopping(self) -> bool:
        """True once a search has been told to come to its end."""
        return self._run is not None and self._run.enough.is_set()

    def cancel(self) -> None:
        """End the run now; what has been applied stays."""
        if self._run is not None or self._state is State.PAUSED:
            self._end(State.IDLE)

    def close(self) -> None:
        """Cancel, and let the worker thread end. The assistant cannot run again."""
        self._document.changed.disconnect(self._on_document_changed)
        self._watch = False
        self.hinting.forget()
        if self._run is not None:
            self._end(State.IDLE)
        self._worker.close()

    # Beginning and ending

    def _can_work(self) -> bool:
        """Whether there is something to do, and somebody to do it; else it says so."""
        if self._document.mesh is None:
            self.said.emit("There is no mesh to work on.")
        elif not self._policy:
            self.said.emit("Choose a policy.")
        elif self._document.at_optimum:
            self.said.emit("Already at the optimum: nothing is left to improve.")
        else:
            return True
        return False

    def _begin(self, state: State, effort: Effort | None = None) -> None:
        if self._run is not None:
            if self._run.state is state:
                return
            # one run gives way to the next, its progress is kept
            looks = self._run.state is State.LOOKING
            self._end(self._run.after if looks else State.PAUSED)
        mesh = self._document.mesh
        if not self._can_work() or mesh is None:
            self._finish_state(State.IDLE)
            return
        try:
            held = self._held(effort)
        except MeshError as error:
            self._finish_state(State.IDLE)
            self.said.emit(str(error))
            return
        synced = self._runner is not None and self._runner_at == self._document.revision
        if self._runner is None or not synced or self._runner.finished or effort is not None:
            self._runner = None
            self._seed += 1
        run = Run(
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
            self.progress.begin(run, self._state is State.IDLE or effort is not None)
        self._run, self._state = run, state
        self._loading = not self._worker.has(self._policy)
        self._worker.begin(run)
        self.changed.emit()

    def _held(self, effort: Effort | None) -> np.ndarray | None:
        """The vertices that stay where they are, where only a region is worked on."""
        mesh = self._document.mesh
        if mesh is None or effort is None or effort.elements is None:
            return None
        return enclose(mesh, effort.elements).held

    def _end(self, state: State) -> None:
        run, self._run = self._run, None
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
        """Look again once the event loop has had its turn; many edits are one look."""
        if self._watch and not self._look_due:
            self._look_due = True
            self._dispatch(self._look)

    def _look(self) -> None:
        self._look_due = False
        ready = self._policy and not self._document.empty and not self._document.at_optimum
        if self._watch and ready and self._run is None and self._sight.last is None:
            self._begin(State.LOOKING)

    def _on_document_changed(self) -> None:
        self.hinting.forget()
        self._sight.see(None)
        if not self._applying:
            self.cancel()  # a person took over; the next run starts from what is there then
            self._runner_at = -1  # no runner knows of this edit, whenever its run has ended
            self._look_soon()

    # What the worker says (:class:`meshwright.assistant.worker.Listener`)

    def loaded(self, name: str) -> None:
        """A policy is there."""
        self._loading = False
        if self._run is not None:
            self._run.began = self._run.due = time.monotonic()  # loading is no work on the mesh
        if name == self._chosen:
            self._chosen = ""
            self.policy = name
        self.changed.emit()

    def broke(self, cause: Run | Question | None, sentence: str) -> None:
        """A run, a question, or the loading of a policy came to nothing."""
        if isinstance(cause, Run):
            if cause is not self._run:
                return
            self._end(State.IDLE)
            self._runner = None
        else:
            if isinstance(cause, Question) and not self.hinting.close(cause):
                return
            self._chosen = ""
            self._loading = False
            self.changed.emit()
        self.failed.emit(sentence)

    def looked_at(self, run: Run, insight: Insight | None) -> None:
        """What the policy sees before its first decision."""
        if run is not self._run:
            return
        if run.state is State.LOOKING:
            self._end(run.after)
        if self._watch:
            self._sight.see(insight)

    def progressed(self, run: Run, done: int, best: int) -> None:
        """So many rollouts are done, and this is the lowest s so far."""
        if run is self._run and self.progress.found(done, best):
            self.changed.emit()

    def answered(self, question: Question, choices: tuple[PolicyAction, ...]) -> None:
        """The policy's best few operations."""
        if not self.hinting.close(question):
            return
        self.hinting.show(choices)
        self.changed.emit()
        if not choices:
            self.said.emit("The policy finds no operation that it may do here.")

    def decided(self, run: Run, decided: Decided) -> None:
        """Submit what the worker decided; gives the event loop its turn in between."""
        if run is not self._run:
            return
        deadline = time.monotonic() + APPLY_BUDGET
        try:
            self._applying = True
            while decided.operations:
                operation, halfedge = decided.operations.pop(0)
                self._document.submit(
                    operation,
                    halfedge,
                    by=label(run.policy),
                    held=run.held,
                    thorough=run.state is State.STEPPING,  # the others are tidied up at the end
                )
                if decided.operations and time.monotonic() > deadline:
                    self._dispatch(partial(self.decided, run, decided))
                    return
        except MeshError as error:
            self.broke(run, f"The policy's operation was refused: {error}")
            return
        finally:
            self._applying = False
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

    def _finish(self, run: Run) -> None:
        document = self._document
        reason = run.runner.reason if run.runner is not None else ""
        self._end(State.IDLE)
        self._tidy(run)
        where = "" if run.held is None else "The region is finished: "
        if document.at_optimum:
            self.said.emit(f"At the optimum after {self.progress.counted}.")
        elif where:
            self.said.emit(f"{where}s {document.score}{'; ' + reason if reason else ''}.")
        else:
            self.said.emit(f"Finished at s {document.score}{': ' + reason if reason else ''}.")

    def _tidy(self, run: Run) -> None:
        """What smoothing around each operation has folded on the way, the whole unfolds."""
        from meshwright.document.position_repair import after_run

        if not run.decisions:
            return
        seen = self._sight.last
        self._applying = True
        try:
            after_run(self._document, label(run.policy), run.held, run.effort is not None)
        finally:
            self._applying = False
        self._runner_at = self._document.revision  # vertices have moved, no edge has
        self._sight.see(seen)
