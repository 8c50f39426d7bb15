"""Edits by the user: operations on the hovered half-edge, their menu, edits of the whole mesh."""

from __future__ import annotations

from qtpy.QtCore import QPoint, Qt
from qtpy.QtWidgets import QWidget

from meshwright.desktop.application.readiness import PREPARING, Readiness
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.mouse import Click
from meshwright.desktop.controller import Controller
from meshwright.desktop.editing.hover_controller import HoverController
from meshwright.desktop.editing.operation_menu import OperationMenu
from meshwright.desktop.levels.level_controller import LevelController
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.desktop.widgets.wording import halfedge_words, plural, step_message
from meshwright.document.document import Document
from meshwright.document.operation_preview import choices
from meshwright.graphics.theme import Theme
from meshwright_core import Operation
from meshwright_core.errors import sentence

POINT_FIRST = "Point at a half-edge first, then press the key."


class EditController(Controller):
    """Applies operations to the half-edge under the mouse, and edits the whole mesh."""

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        hover: HoverController,
        levels: LevelController,
        readiness: Readiness,
        status: StatusBar,
        parent: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._hover = document, canvas, hover
        self._levels, self._readiness, self._status = levels, readiness, status
        self._parent = parent
        self.menu: OperationMenu | None = None
        """The menu of operations while it is open."""
        self._connections.add(document.hover_changed, self._on_hover_changed)

    def close(self) -> None:
        """Disconnect, and close the menu."""
        super().close()
        if self.menu is not None:
            self.menu.close()

    # Clicks

    def click_armed(self, click: Click) -> bool:
        """Apply the armed operation to the clicked half-edge; False if none is armed."""
        armed = self._hover.armed
        if armed is None or click.button != Qt.MouseButton.LeftButton or click.halfedge < 0:
            return False
        if self.is_ready():
            self.submit(armed, click.halfedge)
        return True

    def click_menu(self, click: Click) -> bool:
        """Open the menu of the clicked half-edge; False if there is none."""
        if click.halfedge < 0:
            return False
        self.offer(click.halfedge, click.where)
        return True

    # Operations

    def operate(self, operation: Operation) -> None:
        """Apply ``operation`` to the half-edge under the mouse, or show why that is impossible."""
        halfedge = self._canvas.under_mouse
        if halfedge < 0:
            self._status.show_message(POINT_FIRST)
        elif self.is_ready():
            self.submit(operation, halfedge)

    def operate_current(self) -> None:
        """Apply the operation that is previewed."""
        halfedge = self._canvas.under_mouse
        if halfedge < 0:
            self._status.show_message(POINT_FIRST)
        elif self.is_ready():
            self._hover.refresh()
            meant = self._hover.current
            if meant is None:
                self._status.show_message("No operation is allowed here.")
            else:
                self.submit(meant.operation, halfedge)

    def offer(self, halfedge: int, where: QPoint) -> None:
        """Open the menu of operations of ``halfedge`` at the point ``where`` of the screen."""
        document = self._document
        mesh = document.mesh
        if mesh is None or not self.is_ready():
            return
        ends = f"{mesh.origin(halfedge)} \u2192 {mesh.target(halfedge)}"
        revision = document.revision
        offers = choices(mesh, halfedge, document.bar)
        self.menu = OperationMenu(f"Half-edge {ends}", offers, self._theme, self._parent)
        self.menu.chosen.connect(lambda operation: self._take(operation, halfedge, revision))
        self.menu.hovered.connect(self._hover.preview)
        self.menu.closed.connect(self._on_menu_closed)
        self._canvas.freeze(True)
        self.menu.popup(where)

    def is_ready(self) -> bool:
        """Whether operations can be applied; if not, a message is shown."""
        if not self._readiness.editing:
            self._status.show_message(PREPARING)
            self._canvas.refuse(PREPARING)
        return self._readiness.editing

    def _take(self, operation: Operation, halfedge: int, revision: int) -> None:
        # the agent may have changed the mesh while the menu was open
        if revision == self._document.revision:
            self.submit(operation, halfedge)

    def submit(self, operation: Operation, halfedge: int) -> None:
        """Apply an operation, or show why it is refused."""
        document = self._document
        if self._levels.refuses(operation):
            return
        verdict = document.check(operation, halfedge)
        if not verdict:
            self._status.show_message(sentence(verdict.reason))
            self._canvas.refuse(sentence(verdict.reason))
            return
        document.submit(operation, halfedge)
        self._status.show_message(step_message(document.history.last))

    def _on_menu_closed(self) -> None:
        self.menu = None
        self._hover.preview(None)
        self._canvas.freeze(False)

    def _on_hover_changed(self, halfedge: int) -> None:
        mesh = self._document.mesh
        if mesh is None or halfedge < 0:
            self._status.show_halfedge("")
            return
        self._status.show_halfedge(halfedge_words(mesh, halfedge))

    def clean_all(self) -> None:
        """Remove all global lines that can be removed."""
        if not self.is_ready() or self._levels.refuses("clean_all"):
            return
        count = self._document.clean_all()
        removed = f"Removed {plural(count, 'line')}."
        self._status.show_message(removed if count else "No line can be removed.")

    def smooth(self) -> None:
        """Smooth the whole mesh."""
        if self.is_ready():
            self._document.smooth()
            lost = "" if self._document.plane else " It is not held to the shape of its surface."
            self._status.show_message(f"Mesh smoothed.{lost}")

    def smooth_here(self) -> None:
        """Smooth the selected vertices only."""
        vertices = self._document.selection.vertices
        if not len(vertices):
            self._status.show_message("Select vertices first: Shift+click, or Shift+drag a box.")
        elif self.is_ready():
            self._document.smooth(vertices=vertices)
            self._status.show_message(f"Smoothed {plural(len(vertices), 'vertex', 'vertices')}.")

    def untangle(self) -> None:
        """Repair inverted elements, and show how many there were."""
        if not self.is_ready():
            return
        found, left = self._document.untangle()
        if not found:
            self._status.show_message("No element is inverted.")
        elif not left:
            self._status.show_message(f"Repaired {plural(found, 'inverted element')}.")
        else:
            self._status.show_message(
                f"{left:,} of {plural(found, 'inverted element')} could not be repaired: "
                "no valid positions of the free vertices were found."
            )

    def undo(self) -> None:
        """Undo one step."""
        row = self._document.undo()
        if row is not None:
            self._status.show_message(f"Undone: {row.title}.")

    def redo(self) -> None:
        """Redo one step."""
        row = self._document.redo()
        if row is not None:
            self._status.show_message(f"Redone: {row.title}.")
