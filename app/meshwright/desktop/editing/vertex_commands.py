"""Commands on the vertices at hand: desired degree, corner, lock, pin."""

from __future__ import annotations

import numpy as np

from meshwright.desktop.application.readiness import PREPARING, Readiness
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.controller import Controller
from meshwright.desktop.levels.level_controller import LevelController
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.desktop.widgets.wording import plural
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright_core import HalfEdgeMesh

POINT_FIRST = "Point at a vertex first, or select some, then press the key."
IN_LEVEL = "Desired degrees, corners and locks belong to the level."


class VertexCommands(Controller):
    """Changes the selected vertices; without a selection the vertex under the mouse, or the one
    that the half-edge chosen by keyboard starts at.
    """

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        levels: LevelController,
        readiness: Readiness,
        status: StatusBar,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._levels = document, canvas, levels
        self._readiness, self._status = readiness, status

    def toggle_pinned(self) -> None:
        """Pin the vertices, or free them if all are pinned: smoothing does not move pinned ones."""
        found = self._at_hand()
        if found is not None:
            mesh, vertices = found
            on = not bool(mesh.pinned()[vertices].all())
            self._document.set_pinned(vertices, on)
            self._tell(vertices, "pinned" if on else "free to move when the mesh is smoothed")

    def toggle_locked(self) -> None:
        """Lock the vertices, or unlock them if all are locked."""
        found = self._at_hand(of_level=True)
        if found is not None:
            mesh, vertices = found
            on = not bool(mesh.locked()[vertices].all())
            self._document.set_locked(vertices, on)
            self._tell(vertices, "locked" if on else "unlocked")

    def toggle_corner(self) -> None:
        """Make the vertices corners, or free them if all are corners."""
        found = self._at_hand(of_level=True)
        if found is not None:
            mesh, vertices = found
            on = not bool(mesh.geometric()[vertices].all())
            self._document.set_geometric(vertices, on)
            self._tell(vertices, "a corner" if on else "no corner", "corners" if on else "")

    def set_desired(self, degree: int) -> None:
        """Set the desired degree of the vertices."""
        found = self._at_hand(of_level=True)
        if found is not None:
            _, vertices = found
            self._document.set_desired(vertices, degree)
            self._status.show_message(f"{_named(vertices)}: desired degree {degree}.")

    def _at_hand(self, of_level: bool = False) -> tuple[HalfEdgeMesh, np.ndarray] | None:
        """The mesh and the ids (n,) that a command is for; None, and a message, if there are none.

        of_level: what the command changes belongs to a level, if one is played.
        """
        document, mesh = self._document, self._document.mesh
        vertices = document.selection.vertices
        if mesh is not None and not len(vertices):
            vertex = self._canvas.vertex_at_hand
            vertices = np.array([vertex] if vertex >= 0 else [], np.int64)
        if mesh is None or not len(vertices):
            self._status.show_message(POINT_FIRST)
        elif of_level and self._levels.level is not None:
            self._status.show_message(IN_LEVEL)
        elif not self._readiness.editing:
            self._status.show_message(PREPARING)
        else:
            return mesh, vertices
        return None

    def _tell(self, vertices: np.ndarray, one: str, many: str = "") -> None:
        words = f"is {one}" if len(vertices) == 1 else f"are {many or one}"
        self._status.show_message(f"{_named(vertices)} {words}.")


def _named(vertices: np.ndarray) -> str:
    count = len(vertices)
    return f"Vertex {vertices[0]}" if count == 1 else plural(count, "vertex", "vertices")
