"""Undo and redo: keeps a mesh and its history at the same step."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from meshwright.document.history import History, HistoryStep
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.history.packed_steps import Steps

Result = TypeVar("Result")

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
            raise MeshError("A step of the record does not follow from the one before it.")
        self.history.append(
            step.action, step.title, step.halfedge, step.by, step.before, step.after, step.optimum,
            undone,
        )  # fmt: skip
        mesh.trim()

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
            raise
        if mesh.steps == steps:
            mesh.graft_redo(undone)
            return result, False
        self.history.append(action, title, halfedge, by, before, mesh.score, mesh.optimum, undone)
        mesh.trim()
        return result, True
