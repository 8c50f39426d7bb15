"""Selecting and dragging vertices: the tools of the mouse, the selection's layer and its menu."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtCore import QPointF, Qt

from meshwright.desktop.canvas.gestures import Band, Gesture, MoveVertices, Refused
from meshwright.desktop.canvas.layers.selection import RADIUS, RegionLayer, SelectionLayer
from meshwright.desktop.canvas.layers.selection_band import BandLayer
from meshwright.desktop.canvas.layers.vertex_drag import RubberLayer
from meshwright.desktop.canvas.mouse import Click
from meshwright.desktop.editing.edit_controller import plural
from meshwright.desktop.editing.vertex_menu import selection_menu, vertex_menu
from meshwright.document.vertex_drag import Drag, refusal
from meshwright_core.core.arrays import FLAGS, LOCKED
from meshwright_core.geometry.polygons import points_inside

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow
    from meshwright.graphics.viewport import Viewport

LOCK_RADIUS = 17.0
"""Pixels of the ring around a selected vertex that is locked."""
EDIT, BOX, LASSO = "edit", "box", "lasso"
REACH = 10.0
"""Pixels around a vertex where a drag takes hold of it."""
SHARE = 0.3
"""A drag takes hold of a vertex within this share of its shortest edge only."""
ROOM = 16.0
"""Vertices are dragged where their shortest edge is longer than this in pixels; else one pans."""


class Selecting:
    """What the mouse does with vertices. ``tool`` is one of EDIT, BOX and LASSO."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.tool = EDIT
        self.layer = SelectionLayer(window.theme)
        self.region = RegionLayer(window.theme)
        self.band = BandLayer(window.theme)
        self.rubber = RubberLayer(window.theme)

    def connect(self) -> None:
        """Follow mouse, selection and document."""
        window = self._window
        overlay = window.canvas.overlay
        overlay.add(self.region, below=overlay.markers)
        overlay.add(self.rubber, below=overlay.markers)
        overlay.add(self.layer, below=overlay.arrow)
        overlay.add(self.rubber.top, below=overlay.card)
        overlay.add(self.band, below=overlay.card)
        window.canvas.gesture_at = self._gesture_at
        window.document.selection.changed.connect(self._on_selected)
        window.document.changed.connect(self._on_changed)

    def release(self) -> None:
        """Let go of the document."""
        self._window.document.selection.changed.disconnect(self._on_selected)
        self._window.document.changed.disconnect(self._on_changed)

    # Tools

    def use(self, tool: str) -> None:
        """Take a tool in hand."""
        self.tool = tool
        self._window.say(
            {
                EDIT: "Click a half-edge for its operations; drag vertices.",
                BOX: "Drag a box around vertices; Shift adds, Ctrl takes out.",
                LASSO: "Draw around vertices; Shift adds, Ctrl takes out.",
            }[tool]
        )
        self._window.refresh()

    def put_down(self) -> bool:
        """Back to editing, or else empty the selection; False if there was nothing to do."""
        if self.tool != EDIT:
            self.use(EDIT)
        elif len(self._window.document.selection):
            self._window.document.selection.clear()
        else:
            return False
        return True

    # Clicks

    def take(self, click: Click) -> bool:
        """Use a click on the canvas; False if it is not for selecting."""
        if click.button == Qt.MouseButton.RightButton:
            return self._open_menu(click)
        selection = self._window.document.selection
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
        window = self._window
        selection, mesh = window.document.selection, window.document.mesh
        if mesh is None:
            return False
        region = click.halfedge >= 0 and click.halfedge // mesh.k in selection.elements
        if len(selection) > 1 and (click.vertex in selection or (click.vertex < 0 and region)):
            menu = selection_menu(window)
        elif click.vertex >= 0:
            menu = vertex_menu(window, click.vertex)
        else:
            return False
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(click.where)
        return True

    # Drags

    def _gesture_at(self, at: QPointF, modifiers: Qt.KeyboardModifier) -> Gesture | None:
        if self._window.document.mesh is None:
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
        """Take hold of the vertex at ``at``; None where there is none, or no room to see it."""
        window = self._window
        canvas, mesh = window.canvas, window.document.mesh
        vertex = canvas.vertex_at(at)
        if mesh is None or vertex < 0 or not window.ready:
            return None
        place = mesh.points[vertex]
        x, y = canvas.viewport.to_screen(place).tolist()
        around = mesh.points[mesh.neighbours(vertex)] - place
        shortest = float(np.hypot(around[:, 0], around[:, 1]).min()) * canvas.viewport.pixels
        away = float(np.hypot(x - at.x(), y - at.y()))
        if shortest < ROOM or away > min(REACH, SHARE * shortest):
            return None
        reason = refusal(mesh, vertex)
        if reason:
            return Refused(lambda: self._refuse(reason))
        selection = window.document.selection
        together = selection.vertices if vertex in selection else [vertex]
        drag = Drag(mesh, together, vertex)
        return MoveVertices(canvas, self.rubber, at, QPointF(x, y), drag, self._on_dragged)

    def _refuse(self, reason: str) -> None:
        self._window.say(reason)
        self._window.canvas.refuse(reason)

    def _on_dragged(self, drag: Drag) -> None:
        if not drag.moved:
            return
        window, folded = self._window, len(drag.folded)
        window.document.move(drag.vertices, drag.places)
        moved = f"Moved {plural(len(drag.vertices), 'vertex', 'vertices')}."
        if folded:
            verb = "is" if folded == 1 else "are"
            moved += f" {plural(folded, 'element')} {verb} inverted now; Untangle mends that."
        window.say(moved)

    def _choose(self, outline: np.ndarray, add: bool, remove: bool) -> None:
        """Select the vertices inside ``outline`` (n, 2), in pixels."""
        mesh, selection = self._window.document.mesh, self._window.document.selection
        if mesh is None:
            return
        vertices = mesh.vertices()
        at = self._window.canvas.viewport.to_screen(mesh.points[vertices])
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
        selection = self._window.document.selection
        count, elements = len(selection), len(selection.elements)
        if count:
            self._window.say(
                f"{plural(count, 'vertex', 'vertices')} selected"
                + (f", around {plural(elements, 'element')}." if elements else ".")
            )
        else:
            self._window.say("Nothing is selected.")
        self._window.refresh()

    def _on_changed(self) -> None:
        if len(self._window.document.selection):
            self._show()

    def _show(self) -> None:
        mesh, selection = self._window.document.mesh, self._window.document.selection
        if mesh is None:
            self.region.show(np.zeros((0, 4, 2)))
            self.layer.show(np.zeros((0, 2)), self._radii)
            return
        points = mesh.points[:, :2]
        self.region.show(points[mesh.corners(selection.elements)])
        self.layer.show(points[selection.vertices], self._radii)

    def _radii(self, viewport: Viewport) -> np.ndarray:
        """(n,) radii of the rings around the selected vertices: outside of the discs there are."""
        vertices = self._window.document.selection.vertices
        radii = np.full(len(vertices), RADIUS)
        scene = self._window.canvas.scene
        marks = scene.markers if scene is not None else None
        if marks is not None and len(marks.vertices):
            places = np.minimum(np.searchsorted(marks.vertices, vertices), len(marks.vertices) - 1)
            marked = marks.vertices[places] == vertices
            radii[marked] = marks.radii(viewport)[places[marked]] + 3.5
        mesh = self._window.document.mesh
        if mesh is not None:  # locked ones have a ring already
            locked = (mesh.arrays.vertex[vertices, FLAGS] & LOCKED) > 0
            radii[locked] = np.maximum(radii[locked], LOCK_RADIUS)
        return radii
