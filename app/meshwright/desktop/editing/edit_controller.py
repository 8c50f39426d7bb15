"""Editing by hand: operations at the mouse, their menu, and what concerns the whole mesh."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from qtpy.QtCore import QPoint, Qt

from meshwright.desktop.canvas.mouse import Click
from meshwright.desktop.editing.operation_menu import OperationMenu
from meshwright.desktop.widgets.basic import sentence
from meshwright.document.history import YOU, HistoryStep
from meshwright.document.operation_preview import choices
from meshwright.graphics.markers import label
from meshwright_core import Operation

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow

PREPARING = "Still preparing the operations: a moment, please."
POINT_FIRST = "Point at a half-edge first, then press the key."


class Editing:
    """What a person's hand does in one window."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.menu: OperationMenu | None = None
        self.takers: list[Callable[[Click], bool]] = []
        """Asked first, in order, whether they have a use for a click on the canvas."""

    def connect(self) -> None:
        """Follow canvas and document."""
        self._window.canvas.clicked.connect(self._on_clicked)
        self._window.canvas.escaped.connect(self._on_escaped)
        self._window.document.hover_changed.connect(self._on_hover_changed)

    def release(self) -> None:
        """Let go of the document, and close what is open."""
        if self.menu is not None:
            self.menu.close()
        self._window.document.hover_changed.disconnect(self._on_hover_changed)

    # The mouse

    def _on_clicked(self, click: Click) -> None:
        """The first that has a use for the click takes it."""
        window = self._window
        takers = (*self.takers, window.selecting.take, self._take_armed, window.lines.take)
        if not any(take(click) for take in takers) and click.halfedge >= 0:
            self.offer(click.halfedge, click.where)

    def _take_armed(self, click: Click) -> bool:
        """Do the armed operation where a click says."""
        armed = self._window.pointing.armed
        if armed is None or click.button != Qt.MouseButton.LeftButton or click.halfedge < 0:
            return False
        if self.is_ready():
            self.submit(armed, click.halfedge)
        return True

    def _on_escaped(self) -> None:
        """Put down what is in hand, one thing at a time."""
        window = self._window
        if window.pointing.armed is not None:
            window.pointing.disarm()
        elif not window.selecting.put_down():
            window.canvas.pin(-1)

    # Operations

    def operate(self, operation: Operation) -> None:
        """Do ``operation`` on the half-edge under the mouse, or say why not."""
        halfedge = self._window.canvas.under_mouse
        if halfedge < 0:
            self._window.say(POINT_FIRST)
        elif self.is_ready():
            self.submit(operation, halfedge)

    def operate_current(self) -> None:
        """Do the operation whose ghost is shown."""
        halfedge = self._window.canvas.under_mouse
        if halfedge < 0:
            self._window.say(POINT_FIRST)
        elif self.is_ready():
            self._window.pointing.refresh()
            meant = self._window.pointing.current
            if meant is None:
                self._window.say("No operation is allowed here.")
            else:
                self.submit(meant.operation, halfedge)

    def offer(self, halfedge: int, where: QPoint) -> None:
        """Open the menu of operations of ``halfedge`` at ``where`` on the screen."""
        document = self._window.document
        mesh = document.mesh
        if mesh is None or not self.is_ready():
            return
        ends = f"{mesh.origin(halfedge)} \u2192 {mesh.target(halfedge)}"
        revision = document.revision
        offers = choices(mesh, halfedge, document.bar)
        self.menu = OperationMenu(f"Half-edge {ends}", offers, self._window.theme, self._window)
        self.menu.chosen.connect(lambda operation: self._take(operation, halfedge, revision))
        self.menu.pointed.connect(self._window.pointing.preview)
        self.menu.closed.connect(self._on_menu_closed)
        self._window.canvas.freeze(True)
        self.menu.popup(where)

    def is_ready(self) -> bool:
        """True if operations can be done; else it says so."""
        if not self._window.ready:
            self._window.say(PREPARING)
            self._window.canvas.refuse(PREPARING)
        return self._window.ready

    def _take(self, operation: Operation, halfedge: int, revision: int) -> None:
        if revision == self._window.document.revision:  # an agent may have gone on behind the menu
            self.submit(operation, halfedge)

    def submit(self, operation: Operation, halfedge: int) -> None:
        """Do an operation, or say why it is refused."""
        document = self._window.document
        if self._window.levels.refuses(operation):
            return
        verdict = document.check(operation, halfedge)
        if not verdict:
            self._window.say(sentence(verdict.reason))
            self._window.canvas.refuse(sentence(verdict.reason))
            return
        document.submit(operation, halfedge)
        self._window.say(told(document.history.last))

    def _on_menu_closed(self) -> None:
        self.menu = None
        self._window.pointing.preview(None)
        self._window.canvas.freeze(False)

    def _on_hover_changed(self, halfedge: int) -> None:
        mesh = self._window.document.mesh
        if mesh is None or halfedge < 0:
            self._window.pointed.setText("")
            return
        ends = f"{mesh.origin(halfedge)} \u2192 {mesh.target(halfedge)}"
        self._window.pointed.setText(f"Half-edge {halfedge}:  {ends}")

    def clean_all(self) -> None:
        """Remove all global lines that can be removed."""
        if not self.is_ready() or self._window.levels.refuses("clean_all"):
            return
        count = self._window.document.clean_all()
        removed = f"Removed {plural(count, 'line')}."
        self._window.say(removed if count else "There is no line that can be removed.")

    def smooth(self) -> None:
        """Smooth the whole mesh."""
        if self.is_ready():
            self._window.document.smooth()
            self._window.say("Smoothed.")

    def smooth_here(self) -> None:
        """Smooth the selected vertices, and no others."""
        vertices = self._window.document.selection.vertices
        if not len(vertices):
            self._window.say("Select vertices first: Shift+click, or Shift+drag a box.")
        elif self.is_ready():
            self._window.document.smooth(vertices=vertices)
            self._window.say(f"Smoothed {plural(len(vertices), 'vertex', 'vertices')}.")

    def untangle(self) -> None:
        """Mend the inverted elements, and say how many there were."""
        if not self.is_ready():
            return
        found, left = self._window.document.untangle()
        if not found:
            self._window.say("No element is inverted.")
        elif not left:
            self._window.say(
                f"Untangled: {plural(found, 'element')} was inverted, none is now."
                if found == 1
                else f"Untangled: {found:,} elements were inverted, none is now."
            )
        else:
            self._window.say(
                f"{left:,} of {plural(found, 'element')} stay inverted: "
                "no position of the free vertices was found that mends them."
            )

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


def plural(count: int, one: str, many: str = "") -> str:
    """``1 element``, ``1,200 elements``."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"


def told(row: HistoryStep | None) -> str:
    """``Flip left: s 8 to 6 (-2)``, for the status line."""
    if row is None:
        return ""
    who = "" if row.by == YOU else f" by {row.by}"
    return f"{row.title}{who}:  s {row.before} \u2192 {row.after}  ({label(row.change)})"
