"""Undo and redo: keeps a mesh and its history at the same step."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from meshwright.document.history import YOU, History, HistoryStep
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.history.packed_steps import Steps

Result = TypeVar("Result")

FOREIGN, FOREIGN_TITLE = "python", "Edit in Python"
"""Action and title of steps that were made on the mesh itself, beside the document."""

NO_MESH = "There is no mesh yet: open a file or take a shape from the gallery."


class UndoTimeline:
    """A mesh with its history: each change is one step of the mesh's journal and one step of the
    history, so that both are undone together.

    Attributes:
        mesh: the mesh, None while there is none.
        history: the steps, with a cursor between those that are done and those that are undone.
    """

    def __init__(self, mesh: HalfEdgeMesh | None = None, history: History | None = None) -> None:
        """`history` must belong to the mesh; None begins a new one."""
        self.mesh = mesh
        if history is None:
            history = History(mesh.score, mesh.optimum) if mesh is not None else History(0, 0)
        self.history = history
        self._base = mesh.steps - history.cursor if mesh is not None else 0
        self._seen = 0
        self._note()

    def _note(self) -> None:
        """The mesh is as the history has it."""
        mesh = self.mesh
        if mesh is not None:
            self._seen, mesh.lowest, mesh.redo_lost = mesh.edits, mesh.steps, False

    @property
    def behind(self) -> bool:
        """Whether the mesh may have been changed by others than this object."""
        mesh = self.mesh
        return mesh is not None and mesh.edits != self._seen and not mesh.in_transaction

    def catch_up(self) -> bool:
        """Record as steps what others have changed; returns whether they have changed anything.

        Steps that they have undone, and what can no longer be redone, leave the history. It starts
        anew where they have gone back before its start, or renumbered the mesh.
        """
        mesh, history = self.need_mesh(), self.history
        lowest, now = mesh.lowest - self._base, mesh.steps - self._base
        undone = len(history) - now
        same = lowest == now and not mesh.redo_lost and mesh.undone_steps == undone
        if lowest < 0:
            serial, made = history.given  # a new number: it counts as modified
            self.history = History.of(mesh.score, mesh.optimum, [], 0, (), serial + 1, made)
            self._base = mesh.steps
        elif same and now == history.cursor:
            self._note()
            return False
        elif same:  # steps were undone: they can be redone
            while history.cursor > now:
                history.step_back()
        else:
            mesh.cut_redo()
            history.rewind(lowest)
            for before, after, optimum in self._scores(now - lowest):
                history.append(FOREIGN, FOREIGN_TITLE, -1, YOU, before, after, optimum)
        self._note()
        return True

    def _scores(self, count: int) -> list[tuple[int, int, int]]:
        """s before, s after and s* after each of the last ``count`` steps."""
        mesh = self.need_mesh()
        found = []
        for _ in range(count):
            after = mesh.score, mesh.optimum
            mesh.undo()
            found.append((mesh.score, *after))
        for _ in range(count):
            mesh.redo()
        return found[::-1]

    def need_mesh(self) -> HalfEdgeMesh:
        """The mesh; raises MeshError if there is none."""
        if self.mesh is None:
            raise MeshError(NO_MESH)
        return self.mesh

    def go_to(self, cursor: int) -> None:
        """Undo or redo until ``cursor`` steps are done, with 0 <= cursor <= len(history)."""
        mesh = self.need_mesh()
        while self.history.cursor > cursor:
            mesh.undo()
            self.history.step_back()
        while self.history.cursor < cursor:
            mesh.redo()
            self.history.step_forward()
        self._note()

    def take_branch(self, index: int) -> None:
        """Go to the end of ``history.branches[index]``; the steps left for it become a branch.

        Raises MeshError if there is no such branch.
        """
        mesh = self.need_mesh()
        if not 0 <= index < len(self.history.branches):
            raise MeshError(f"There is no branch {index} in this history.")
        self.go_to(self.history.branches[index].at)
        mesh.graft_redo(self.history.take(index, mesh.cut_redo()))
        self.go_to(len(self.history))

    def replay(self, step: HistoryStep, steps: tuple[Steps, ...]) -> None:
        """Do a recorded step: ``step`` describes it, ``steps`` are the mesh's own record of it.

        Raises MeshError, and leaves everything as it was, if the step does not follow from the
        present state.
        """
        mesh = self.need_mesh()
        if [len(piece) for piece in steps] != [1]:
            raise MeshError("A record of a step must be one step.")
        before, undone = mesh.score, mesh.cut_redo()
        mesh.graft_redo(steps)
        mesh.redo()
        if (before, mesh.score, mesh.optimum) != (step.before, step.after, step.optimum):
            mesh.undo()
            mesh.graft_redo(undone)
            self._note()
            raise MeshError("A step of the record does not follow from the one before it.")
        self.history.append(
            step.action, step.title, step.halfedge, step.by, step.before, step.after, step.optimum,
            undone,
        )  # fmt: skip
        mesh.trim()
        self._note()

    def do(
        self, action: str, title: str, halfedge: int, by: str, work: Callable[[], Result]
    ) -> tuple[Result, bool]:
        """Run ``work``, which changes the mesh, as one step.

        Returns its result, and whether the mesh has changed: if not, no step is recorded. If
        ``work`` raises, mesh and history are as before.
        """
        mesh = self.need_mesh()
        steps, before = mesh.steps, mesh.score
        undone = mesh.cut_redo()
        try:
            with mesh.transaction():
                result = work()
        except BaseException:
            mesh.graft_redo(undone)
            self._note()
            raise
        if mesh.steps == steps:
            mesh.graft_redo(undone)
            self._note()
            return result, False
        self.history.append(action, title, halfedge, by, before, mesh.score, mesh.optimum, undone)
        mesh.trim()
        self._note()
        return result, True
