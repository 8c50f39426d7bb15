"""The timeline: a mesh and its history, which go back and forth together, and their events."""

from collections.abc import Callable
from typing import TypeVar

from meshwright.document.history import History, Row
from meshwright.signals import Signal
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.score import normalised_return
from meshwright_core.history.packed_steps import Steps

Result = TypeVar("Result")

NO_MESH = "There is no mesh yet: open a file or take a shape from the gallery."


class Timeline:
    """The half of :class:`meshwright.document.document.Document` that knows when, not what: every
    change of the mesh is one step of the mesh's journal and one row of the history.
    """

    history: History
    _mesh: HalfEdgeMesh | None
    _hover: int

    def __init__(self) -> None:
        """Without a mesh."""
        self.replaced = Signal()
        self.changed = Signal()
        self.score_changed = Signal()
        self.history_changed = Signal()
        self.saved_changed = Signal()
        self.hover_changed = Signal()
        self.noted = Signal()
        self.revision = 0
        self._mesh = None
        self._hover = -1
        self.history = History(0, 0)

    # What is here

    @property
    def mesh(self) -> HalfEdgeMesh | None:
        """The mesh, for reading only; None while the document is empty."""
        return self._mesh

    @property
    def empty(self) -> bool:
        """True while there is no mesh."""
        return self._mesh is None

    @property
    def kind(self) -> str:
        """``"tri"`` or ``"quad"``; empty string without a mesh."""
        return self._mesh.kind if self._mesh is not None else ""

    @property
    def hover(self) -> int:
        """The half-edge under the mouse, -1 for none."""
        return self._hover

    @hover.setter
    def hover(self, halfedge: int) -> None:
        if halfedge != self._hover:
            self._hover = halfedge
            self.hover_changed.emit(halfedge)

    # Scores

    @property
    def score(self) -> int:
        """s of the mesh now; 0 without a mesh."""
        return self._mesh.score if self._mesh is not None else 0

    @property
    def optimum(self) -> int:
        """s*, the lowest score that any connectivity can have; 0 without a mesh."""
        return self._mesh.optimum if self._mesh is not None else 0

    @property
    def start_score(self) -> int:
        """The score where this document began (or where desired degrees last changed)."""
        return self.history.start_score

    @property
    def best_score(self) -> int:
        """The lowest score on the way from the start to here."""
        return self.history.best_score

    @property
    def normalised_return(self) -> float:
        """(start - best) / (start - s*) so far, 1 when there was nothing to gain."""
        return normalised_return(self.start_score, self.best_score, self.optimum)

    @property
    def at_optimum(self) -> bool:
        """True if s = s*: no connectivity is better under these desired degrees."""
        return self._mesh is not None and self._mesh.score == self._mesh.optimum

    # Going back and forth

    @property
    def can_undo(self) -> bool:
        """True if there is a step to take back."""
        return self.history.can_undo

    @property
    def can_redo(self) -> bool:
        """True if a step has been taken back."""
        return self.history.can_redo

    def undo(self) -> Row | None:
        """Take back the last step; returns its row, None if there is none."""
        row = self.history.last
        self.go_to(self.history.cursor - 1)
        return row

    def redo(self) -> Row | None:
        """Do again what was taken back last; returns its row, None if there is none."""
        if not self.history.can_redo:
            return None
        self.go_to(self.history.cursor + 1)
        return self.history.last

    def go_to(self, cursor: int) -> None:
        """Undo or redo until ``cursor`` rows are done; beyond either end it stops there."""
        cursor = min(max(cursor, 0), len(self.history))
        if cursor == self.history.cursor:
            return
        self._walk(cursor)
        self._moved_on("go", cursor)

    def take_branch(self, index: int) -> None:
        """Go to the end of ``history.branches[index]``; the rows left for it become a branch."""
        mesh = self._need()
        if not 0 <= index < len(self.history.branches):
            raise MeshError(f"There is no branch {index} in this history.")
        self._walk(self.history.branches[index].at)
        mesh.graft_redo(self.history.take(index, mesh.cut_redo()))
        self._walk(len(self.history))
        self._moved_on("branch", index)

    def _walk(self, cursor: int) -> None:
        mesh = self._need()
        while self.history.cursor > cursor:
            mesh.undo()
            self.history.step_back()
        while self.history.cursor < cursor:
            mesh.redo()
            self.history.step_forward()

    def again(self, row: Row, steps: tuple[Steps, ...]) -> None:
        """Do a step that was done here once before, as its row and the mesh's record say.

        Raises MeshError, and leaves the document as it was, if it does not follow from here.
        """
        mesh = self._need()
        if [len(piece) for piece in steps] != [1]:
            raise MeshError("A record of a step must be one step.")
        before, undone = mesh.score, mesh.cut_redo()
        mesh.graft_redo(steps)
        mesh.redo()
        if (before, mesh.score, mesh.optimum) != (row.before, row.after, row.optimum):
            mesh.undo()
            mesh.graft_redo(undone)
            raise MeshError("A step of the record does not follow from the one before it.")
        self.history.append(
            row.action, row.title, row.halfedge, row.by, row.before, row.after, row.optimum, undone
        )
        mesh.trim()
        self._moved_on("step", self.history.cursor)

    # Inside

    def _need(self) -> HalfEdgeMesh:
        if self._mesh is None:
            raise MeshError(NO_MESH)
        return self._mesh

    def _do(
        self, action: str, title: str, halfedge: int, by: str, work: Callable[[], Result]
    ) -> Result:
        mesh = self._need()
        steps, before = mesh.steps, mesh.score
        undone = mesh.cut_redo()
        try:
            with mesh.transaction():
                result = work()
        except BaseException:
            mesh.graft_redo(undone)
            raise
        if mesh.steps == steps:
            mesh.graft_redo(undone)
            return result  # nothing to do was nothing done: no row, no event
        self.history.append(action, title, halfedge, by, before, mesh.score, mesh.optimum, undone)
        mesh.trim()
        self._moved_on("step", self.history.cursor)
        return result

    def _moved_on(self, event: str, number: int) -> None:
        self.revision += 1
        mesh = self._need()
        self.noted.emit(event, number)
        if self._hover >= 0 and not mesh.live(self._hover):
            self.hover = -1
        self._emit_all()

    def _emit_all(self) -> None:
        self.changed.emit()
        self.score_changed.emit()
        self.history_changed.emit()
        self.saved_changed.emit()
