"""Plays levels on a document: counts operations, awards stars, and lets the agent solve a level.

Imports neither Qt nor torch: window and notebook share it.
"""

from __future__ import annotations

from dataclasses import dataclass

from meshwright.assistant.hints import Hinting
from meshwright.document.document import Document
from meshwright.document.history import YOU, History
from meshwright.puzzles import level as levels
from meshwright.puzzles.agent_opponent import AgentOpponent, MakeAssistant, OpponentState
from meshwright.puzzles.known_solution import KnownSolution
from meshwright.puzzles.level import Level
from meshwright.puzzles.progress import LevelProgress
from meshwright.signals import Signal
from meshwright_core import HalfEdgeMesh, MeshError, Operation

STRIP, RING = Operation.CHORD_COLLAPSE.value, Operation.INSERT_RING.value
DIVISION = Operation.DIVIDE_CHORD.value
COUNTED = frozenset(operation.value for operation in Operation)
FREE = frozenset(("smooth", "untangle", "move"))
"""Steps that only move vertices; they are not counted."""
BARRED = {
    STRIP: "Collapse strip goes beyond the paper's operations and is not allowed in levels",
    RING: "Insert ring goes beyond the paper's operations and is not allowed in levels",
    DIVISION: "Divide strip goes beyond the paper's operations and is not allowed in levels",
    "clean_all": "Clean all deletes several lines at once: in a level they are deleted one by one",
    "desired": "A level keeps its desired degrees",
    "geometric": "A level keeps its corners",
    "locked": "In a level nothing is locked",
}
"""Steps that are not allowed in levels, with the reason."""
NAMES = {1: "one star", 2: "two stars", 3: "three stars"}
OFF_THE_WAY = "The hints are the policy's here; undo to where they lead to par."
SLACK = 2
"""Operations beyond par that always still win two stars."""


@dataclass(frozen=True)
class StepSummary:
    """Summary of the steps from the start of a history to its cursor."""

    used: int = 0
    """Number of operations."""
    helped: bool = False
    """Whether some of them are the agent's."""
    barred: str = ""
    """The first step that is not allowed in levels; empty if there is none."""


def tally(history: History) -> StepSummary:
    """Summarise the steps that are done."""
    used, helped, barred = 0, False, ""
    for index in range(history.cursor):
        row = history[index]
        used += row.action in COUNTED
        helped = helped or (row.by != YOU and row.action not in FREE)
        if row.action not in FREE and (row.action in BARRED or row.action not in COUNTED):
            barred = barred or row.action
    return StepSummary(used, helped, barred)


def spare(level: Level) -> int:
    """The most operations that still win two stars."""
    return level.par + max(SLACK, level.par // 3)


def stars(level: Level, used: int, hinted: bool = False) -> int:
    """Stars for reaching the goal with ``used`` operations and without the agent's."""
    if used > spare(level):
        return 1
    return 2 if used > level.par or hinted else 3


class LevelPlay:
    """Plays levels on ``document``; ``progress`` stores the results.

    ``make_rival`` makes an assistant for another document, on which the agent solves the level.
    Events: ``changed()`` any attribute changed; ``won(stars)`` the goal was reached without the
    agent's operations.
    """

    def __init__(
        self,
        document: Document,
        hinting: Hinting,
        make_rival: MakeAssistant,
        progress: LevelProgress | None = None,
    ) -> None:
        self.changed = Signal()
        self.won = Signal()
        self.level: Level | None = None
        self.tally = StepSummary()
        self.done = False
        """Whether the goal is reached by allowed steps."""
        self.hinted = False
        """Whether a hint was requested since the start."""
        self.rival: AgentOpponent | None = None
        self.notice = ""
        """An error in storing the results, as one sentence."""
        self.progress = progress or LevelProgress()
        self._document, self._hinting, self._make_rival = document, hinting, make_rival
        self._showing = False
        self._known: KnownSolution | None = None
        document.bar = self.refusal
        hinting.guide = self._lead
        document.replaced.connect(self._on_replaced)
        document.history_changed.connect(self._on_history_changed)
        hinting.changed.connect(self._on_hints_changed)

    def release(self) -> None:
        """Disconnect from the document, and cancel the agent's search."""
        self._document.bar = self._hinting.guide = None
        self._document.replaced.disconnect(self._on_replaced)
        self._document.history_changed.disconnect(self._on_history_changed)
        self._hinting.changed.disconnect(self._on_hints_changed)
        self._drop_rival()

    # Commands

    def open(self, name: str | Level) -> Level:
        """Begin a level; MeshError if there is none of this name."""
        level = levels.load(name) if isinstance(name, str) else name
        if self.level != level:
            self._drop_rival()
        self._begin(level)
        return level

    def again(self) -> None:
        """Begin the level again."""
        self._begin(self._need())

    def next(self) -> Level:
        """Begin the level after this one; MeshError after the last."""
        name = levels.after(self._need().name)
        if name is None:
            raise MeshError("This is the last level.")
        return self.open(name)

    def leave(self) -> None:
        """Stop playing and keep the mesh as it is."""
        if self.level is not None:
            self._drop_rival()
            self.level, self.done, self.hinted = None, False, False
            self._document.keep()
            self.changed.emit()

    def refusal(self, action: str) -> str:
        """Why a step is not allowed now, as a sentence; empty if it is."""
        if self.level is None or self._showing:
            return ""
        return f"{BARRED[action]}." if action in BARRED else ""

    def ask_agent(self) -> None:
        """Let the agent solve the level on a copy of its mesh."""
        level = self._need()
        if level.most:
            raise MeshError("The agent minimises the score only: look at a solution instead.")
        if self.rival is None or self.rival.standing is OpponentState.FAILED:
            self._drop_rival()
            self.rival = AgentOpponent(level, self._make_rival)
            self.rival.changed.connect(self.changed.emit)
            self.changed.emit()

    def show_answer(self) -> str:
        """Begin again with the agent's solution, or the best known one, ready to be redone step by
        step; returns a message on how to.
        """
        level = self._need()
        rival = self.rival
        answered = rival is not None and rival.standing is OpponentState.DONE
        by = rival.name if rival is not None and answered else "the best known"
        self._begin(level)
        self._showing = True
        try:
            if rival is not None and answered:
                for operation, halfedge in rival.operations:
                    self._document.submit(operation, halfedge, by=by)
            else:
                for operation, (a, b) in level.solution:
                    halfedge = levels.halfedge_of(_mesh_of(self._document), a, b)
                    self._document.submit(operation, halfedge, by=by)
            self._document.go_to(0)
        finally:
            self._showing = False
        self._follow()
        count = len(self._document.history)
        return f"The solution is ready: {_plural(count)}; Redo does one at a time."

    # Results

    @property
    def used(self) -> int:
        """Operations done so far."""
        return self.tally.used

    @property
    def stars(self) -> int:
        """Stars for the present state; 0 if the goal is not reached, or with the agent's help."""
        if self.level is None or not self.done or self.tally.helped:
            return 0
        return stars(self.level, self.used, self.hinted)

    @property
    def best(self) -> int:
        """The most stars ever won in this level."""
        return self.progress.best(self.level.name).stars if self.level is not None else 0

    @property
    def headline(self) -> str:
        """Headline once the goal is reached; empty before."""
        level = self.level
        if level is None or not self.done:
            return ""
        if self.tally.helped:
            return "At the goal, with help"
        if self.used < level.par:
            return "Better than the best known"
        if self.used == level.par:
            return "Proven minimum" if level.proved else "Equal to the best known"
        return "At the goal" if level.most else "At the optimum"

    @property
    def remark(self) -> str:
        """Explanation of the stars, as a sentence; empty if there is none."""
        level = self.level
        if level is None:
            return ""
        if self.tally.barred:
            why = BARRED.get(self.tally.barred, "This step is not allowed in levels")
            return f"{why}. Undo it, or restart."
        if self.tally.helped:
            return "The agent's operations win no stars. Undo them, or restart."
        if self.done:
            return self._verdict(level)
        if not self.hinted:
            return ""
        most = "With a hint there are two stars at most."
        return most if self.leads else f"{most} {OFF_THE_WAY}"

    @property
    def leads(self) -> bool:
        """Whether the mesh is on the way of the known solution, so that hints follow it."""
        mesh = self._document.mesh
        return mesh is not None and self._lead(mesh) is not None

    def _lead(self, mesh: HalfEdgeMesh) -> tuple[Operation, int] | None:
        """The next operation of the known solution."""
        if self.level is None or self._known is None:
            return None
        return self._known.next(mesh)

    def _verdict(self, level: Level) -> str:
        won = f"{_plural(self.used)}, par {level.par}: {NAMES[self.stars]}"
        if self.stars == 3:
            return f"{won}."
        if self.used <= level.par:
            return f"{won}, because of the hint."
        if self.stars == 1:
            return f"{won}. Two for at most {spare(level)}."
        return f"{won}. Three for {level.par}."

    # Inside

    def _need(self) -> Level:
        if self.level is None:
            raise MeshError("No level is being played: choose one first.")
        return self.level

    def _begin(self, level: Level) -> None:
        if self.level != level:
            self._known = KnownSolution(level)
        self.level = level
        self.done = self.hinted = False
        self.tally = StepSummary()
        self._document.replace(level.mesh(), level.title, passing=True)

    def _drop_rival(self) -> None:
        rival, self.rival = self.rival, None
        if rival is not None:
            rival.changed.disconnect(self.changed.emit)
            rival.close()

    def _on_replaced(self) -> None:
        if self.level is not None and not self._document.passing:
            self.leave()  # another mesh was opened
        else:
            self._follow()

    def _on_hints_changed(self) -> None:
        if self.level is not None and self._hinting.hints and not self.hinted:
            self.hinted = True
            self.changed.emit()

    def _on_history_changed(self) -> None:
        if not self._showing:
            self._follow()

    def _follow(self) -> None:
        level, mesh = self.level, self._document.mesh
        if level is None or mesh is None:
            return
        before, self.tally = self.done, tally(self._document.history)
        self.done = level.reached(mesh) and not self.tally.barred
        if self.done and self.stars:
            self._note(level)
        self.changed.emit()
        if self.done and not before and self.stars:
            self.won.emit(self.stars)

    def _note(self, level: Level) -> None:
        """Store the result; an error does not end the game."""
        try:
            self.progress.note(level.name, self.stars, self.used)
        except MeshError as error:
            self.notice = str(error)


def _mesh_of(document: Document) -> HalfEdgeMesh:
    """The document's mesh; MeshError if there is none."""
    if document.mesh is None:
        raise MeshError("No level is being played: choose one first.")
    return document.mesh


def _plural(count: int) -> str:
    return f"{count} operation{'' if count == 1 else 's'}"
