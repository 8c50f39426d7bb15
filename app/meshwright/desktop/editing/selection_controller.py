"""Selecting and dragging vertices: mouse tools, layers of the selection, context menus."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QPointF, Qt
from qtpy.QtWidgets import QWidget

from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.gestures import Band, Gesture, MoveVertices, RefusedDrag
from meshwright.desktop.canvas.layers.selection import RADIUS, RegionLayer, SelectionLayer
from meshwright.desktop.canvas.layers.selection_band import BandLayer
from meshwright.desktop.canvas.layers.vertex_drag import RubberLayer
from meshwright.desktop.canvas.mouse import Click
from meshwright.desktop.controller import Controller
from meshwright.desktop.editing.vertex_menu import VertexMenus
from meshwright.desktop.levels.level_controller import LevelController
from meshwright.desktop.widgets.action_set import ActionSet
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.desktop.widgets.wording import plural
from meshwright.document.document import Document
from meshwright.document.vertex_drag import Drag, refusal
from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import Viewport
from meshwright.signals import Signal
from meshwright_core.core.arrays import FLAGS, LOCKED
from meshwright_core.geometry.polygons import points_inside

LOCK_RADIUS = 17.0
"""Radius in pixels of the ring around a locked vertex that is selected."""
EDIT, BOX, LASSO = "edit", "box", "lasso"
REACH = 10.0
"""Distance in pixels at which a drag grabs a vertex."""
SHARE = 0.3
"""A drag grabs a vertex only within this fraction of its shortest edge,"""
LEAST_REACH = 4.0
"""or within so many pixels: short edges are among those that one wants to mend by hand."""
ROOM = 16.0
"""A drag pans if half of the edges of the vertex are shorter than this in pixels."""


class SelectionController(Controller):
    """Selects and moves vertices with the mouse.

    ``tool`` is one of EDIT, BOX and LASSO; ``tool_changed()`` when it is another one.
    """

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        levels: LevelController,
        readiness: Readiness,
        actions: ActionSet,
        status: StatusBar,
        parent: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self.tool_changed = Signal()
        self._document, self._canvas = document, canvas
        self._readiness, self._status = readiness, status
        self.menus = VertexMenus(document, levels, readiness, actions, status, parent)
        self.tool = EDIT
        self.layer = SelectionLayer(theme)
        self.region = RegionLayer(theme)
        self.band = BandLayer(theme)
        self.rubber = RubberLayer(theme)
        overlay = canvas.overlay
        overlay.add(self.region, below=overlay.markers)
        overlay.add(self.rubber, below=overlay.markers)
        overlay.add(self.layer, below=overlay.arrow)
        overlay.add(self.rubber.top, below=overlay.card)
        overlay.add(self.band, below=overlay.card)
        canvas.gesture_at = self._gesture_at
        self._connections.add(document.selection.changed, self._on_selected)
        self._connections.add(document.changed, self._on_changed)

    # Tools

    def use(self, tool: str) -> None:
        """Switch to a tool."""
        self.tool = tool
        self._status.show_message(
            {
                EDIT: "Click a half-edge for its operations; drag vertices.",
                BOX: "Drag a box around vertices; Shift adds, Ctrl removes.",
                LASSO: "Draw around vertices; Shift adds, Ctrl removes.",
            }[tool]
        )
        self.tool_changed.emit()

    def put_down(self) -> bool:
        """Switch to the edit tool, or else clear the selection; False if there was nothing
        to do.
        """
        if self.tool != EDIT:
            self.use(EDIT)
        elif len(self._document.selection):
            self._document.selection.clear()
        else:
            return False
        return True

    # Clicks

    def click(self, click: Click) -> bool:
        """Handle a click that selects, or opens a vertex menu; False for any other."""
        if click.button == Qt.MouseButton.RightButton:
            return self._open_menu(click)
        selection = self._document.selection
        if click.shift:
            if click.vertex >= 0:
                selection.toggle(click.vertex)
            return True
        if self.tool != EDIT:
            selection.set([click.vertex] if click.vertex >= 0 else [])
            return True
        if click.halfedge < 0 and len(selection):
            selection.clear()
            return True
        return False

    def _open_menu(self, click: Click) -> bool:
        selection, mesh = self._document.selection, self._document.mesh
        if mesh is None:
            return False
        region = click.halfedge >= 0 and click.halfedge // mesh.k in selection.elements
        if len(selection) > 1 and (click.vertex in selection or (click.vertex < 0 and region)):
            menu = self.menus.of_selection()
        elif click.vertex >= 0:
            menu = self.menus.of_vertex(click.vertex)
        else:
            return False
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(click.where)
        return True

    # Drags

    def _gesture_at(self, at: QPointF, modifiers: Qt.KeyboardModifier) -> Gesture | None:
        if self._document.mesh is None:
            return None
        shift = bool(modifiers & Qt.KeyboardModifier.ShiftModifier)
        alt = bool(modifiers & Qt.KeyboardModifier.AltModifier)
        control = bool(modifiers & Qt.KeyboardModifier.ControlModifier)
        if shift or self.tool != EDIT:
            lasso = self.tool == LASSO or alt

            def choose(outline: np.ndarray) -> None:
                self._choose(outline, shift, control)

            return Band(self.band, at, lasso, choose)
        return self._grab(at)

    def _grab(self, at: QPointF) -> Gesture | None:
        """The drag of the vertex at ``at``; None if there is none, or if most of its
        edges are too short.
        """
        canvas, mesh = self._canvas, self._document.mesh
        vertex = canvas.vertex_at(at)
        if mesh is None or vertex < 0 or not self._readiness.editing:
            return None
        place = mesh.points[vertex]
        x, y = canvas.viewport.to_screen(place).tolist()
        around = mesh.points[mesh.neighbours(vertex)] - place
        lengths = np.hypot(around[:, 0], around[:, 1]) * canvas.viewport.pixels
        away = float(np.hypot(x - at.x(), y - at.y()))
        reach = min(REACH, max(LEAST_REACH, SHARE * float(lengths.min())))
        if np.median(lengths) < ROOM or away > reach:
            return None
        reason = refusal(mesh, vertex)
        if reason:
            return RefusedDrag(lambda: self._refuse(reason))
        selection = self._document.selection
        together = selection.vertices.tolist() if vertex in selection else [vertex]
        drag = Drag(mesh, together, vertex)
        return MoveVertices(canvas, self.rubber, at, QPointF(x, y), drag, self._on_dragged)

    def _refuse(self, reason: str) -> None:
        self._status.show_message(reason)
        self._canvas.refuse(reason)

    def _on_dragged(self, drag: Drag) -> None:
        if not drag.moved:
            return
        folded = len(drag.folded)
        self._document.move(drag.vertices, drag.places, parameters=drag.parameters, pin=True)
        count = len(drag.vertices)
        moved = f"Moved and pinned {plural(count, 'vertex', 'vertices')}; P frees"
        moved += " it." if count == 1 else " them."
        if folded:
            verb = "is" if folded == 1 else "are"
            moved += f" {plural(folded, 'element')} {verb} inverted now; Untangle repairs this."
        self._status.show_message(moved)

    def _choose(self, outline: np.ndarray, add: bool, remove: bool) -> None:
        """Select the vertices inside ``outline`` (n, 2), in pixels."""
        mesh, selection = self._document.mesh, self._document.selection
        if mesh is None:
            return
        vertices = mesh.vertices()
        at = self._canvas.viewport.to_screen(mesh.points[vertices])
        inside = vertices[points_inside(at, outline)]
        if remove:
            selection.set(np.setdiff1d(selection.vertices, inside))
        elif add:
            selection.add(inside)
        else:
            selection.set(inside)

    # Following

    def _on_selected(self) -> None:
        self._show()
        selection = self._document.selection
        count, elements = len(selection), len(selection.elements)
        if count:
            self._status.show_message(
                f"{plural(count, 'vertex', 'vertices')} selected"
                + (f", around {plural(elements, 'element')}." if elements else ".")
            )
        else:
            self._status.show_message("Nothing is selected.")

    def _on_changed(self) -> None:
        if len(self._document.selection):
            self._show()

    def _show(self) -> None:
        mesh, selection = self._document.mesh, self._document.selection
        if mesh is None:
            self.region.show(np.zeros((0, 4, 2)), np.zeros(0, np.int64), None)
            self.layer.show(np.zeros((0, 2)), self._radii)
            return
        points = mesh.points[:, :2]
        elements = selection.elements
        self.region.show(points[mesh.corners(elements)], elements, self._canvas.edges)
        self.layer.show(points[selection.vertices], self._radii)

    def _radii(self, viewport: Viewport) -> np.ndarray:
        """(n,) radii of the rings around the selected vertices, which enclose their discs."""
        vertices = self._document.selection.vertices
        radii = np.full(len(vertices), RADIUS)
        marks = self._canvas.markers
        if marks is not None and len(marks.vertices):
            places = np.minimum(np.searchsorted(marks.vertices, vertices), len(marks.vertices) - 1)
            marked = marks.vertices[places] == vertices
            radii[marked] = marks.radii(viewport)[places[marked]] + 3.5
        mesh = self._document.mesh
        if mesh is not None:  # outside the ring of locked vertices
            locked = (mesh.arrays.vertex[vertices, FLAGS] & LOCKED) > 0
            radii[locked] = np.maximum(radii[locked], LOCK_RADIUS)
        return radii
