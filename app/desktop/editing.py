"""Editing by hand: operations at the mouse, their menu, and what concerns the whole mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

from qtpy.QtCore import QPoint, Qt

from app.desktop.operation_menu import OperationMenu
from app.desktop.vertex_menu import vertex_menu
from app.desktop.widgets import sentence
from app.history import YOU, Row
from app.markers import label
from meshcore import Operation
from meshcore.operations import of_kind

if TYPE_CHECKING:
    from app.desktop.window import MainWindow

PREPARING = "Still preparing the operations: a moment, please."
POINT_FIRST = "Point at a half-edge first, then press the key."


class Editing:
    """What a person's hand does in one window."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.menu: OperationMenu | None = None

    def connect(self) -> None:
        """Follow canvas and document."""
        self._window.canvas.halfedge_chosen.connect(self.offer)
        self._window.canvas.vertex_chosen.connect(self._offer_vertex)
        self._window.document.hover_changed.connect(self._on_hover_changed)

    def release(self) -> None:
        """Let go of the document, and close what is open."""
        if self.menu is not None:
            self.menu.close()
        self._window.document.hover_changed.disconnect(self._on_hover_changed)

    def operate(self, operation: Operation) -> None:
        """Do ``operation`` on the half-edge under the mouse, or say why not."""
        halfedge = self._window.canvas.under_mouse
        if halfedge < 0:
            self._window.say(POINT_FIRST)
        elif self._is_ready():
            self._submit(operation, halfedge)

    def offer(self, halfedge: int, where: QPoint) -> None:
        """Open the menu of operations of ``halfedge`` at ``where`` on the screen."""
        document = self._window.document
        mesh = document.mesh
        if mesh is None or not self._is_ready():
            return
        verdicts = document.allowed(halfedge)
        offers = [(info, verdicts[info.operation]) for info in of_kind(mesh.kind)]
        ends = f"{mesh.origin(halfedge)} \u2192 {mesh.target(halfedge)}"
        revision = document.revision
        self.menu = OperationMenu(f"Half-edge {ends}", offers, self._window)
        self.menu.chosen.connect(lambda operation: self._take(operation, halfedge, revision))
        self.menu.closed.connect(self._on_menu_closed)
        self._window.canvas.freeze(True)
        self.menu.popup(where)

    def _is_ready(self) -> bool:
        """True if operations can be done; else it says so."""
        if not self._window.ready:
            self._window.say(PREPARING)
            self._window.canvas.refuse(PREPARING)
        return self._window.ready

    def _take(self, operation: Operation, halfedge: int, revision: int) -> None:
        if revision == self._window.document.revision:  # an agent may have gone on behind the menu
            self._submit(operation, halfedge)

    def _submit(self, operation: Operation, halfedge: int) -> None:
        document = self._window.document
        verdict = document.check(operation, halfedge)
        if not verdict:
            self._window.say(sentence(verdict.reason))
            self._window.canvas.refuse(sentence(verdict.reason))
            return
        document.submit(operation, halfedge)
        self._window.say(told(document.history.last))

    def _on_menu_closed(self) -> None:
        self.menu = None
        self._window.canvas.freeze(False)

    def _offer_vertex(self, vertex: int, where: QPoint) -> None:
        menu = vertex_menu(self._window.document, vertex, self._window.ready, self._window)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(where)

    def _on_hover_changed(self, halfedge: int) -> None:
        mesh = self._window.document.mesh
        if mesh is None or halfedge < 0:
            self._window.pointed.setText("")
            return
        ends = f"{mesh.origin(halfedge)} \u2192 {mesh.target(halfedge)}"
        self._window.pointed.setText(f"Half-edge {halfedge}:  {ends}")

    def clean_all(self) -> None:
        """Remove all global lines that can be removed."""
        if not self._is_ready():
            return
        count = self._window.document.clean_all()
        lines = "1 line" if count == 1 else f"{count} lines"
        self._window.say(f"Removed {lines}." if count else "There is no line that can be removed.")

    def smooth(self) -> None:
        """Smooth the whole mesh."""
        if self._is_ready():
            self._window.document.smooth()
            self._window.say("Smoothed.")

    def undo(self) -> None:
        """Take back one step."""
        row = self._window.document.undo()
        if row is not None:
            self._window.say(f"Undone: {row.title}.")

    def redo(self) -> None:
        """Do one step again."""
        row = self._window.document.redo()
        if row is not None:
            self._window.say(f"Done again: {row.title}.")


def told(row: Row | None) -> str:
    """``Flip left: s 8 to 6 (-2)``, for the status line."""
    if row is None:
        return ""
    who = "" if row.by == YOU else f" by {row.by}"
    return f"{row.title}{who}:  s {row.before} \u2192 {row.after}  ({label(row.change)})"
