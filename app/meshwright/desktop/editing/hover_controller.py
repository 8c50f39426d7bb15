"""Pointing: what operations would do at the half-edge under the mouse, and which one is meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtCore import QTimer

from meshwright.desktop.canvas.layers.ghost import GhostLayer
from meshwright.document.operation_preview import OperationOffer, best, choices, following, ghost
from meshwright_core import HalfEdgeMesh, Operation

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow

GHOSTS = "editing/ghosts"
"""The setting that shows ghosts."""
LARGE = 5000
"""In meshes of more elements ghosts from boundary to boundary wait until the mouse rests: they
would flicker.
"""
REST = 60
"""Milliseconds that count as rest."""
FEW = 2000
"""The tag of a ghost keeps off irregular vertices while there are no more than this."""


class Pointing:
    """The operation that is meant is, in this order: the one that a menu's row is pointed at, the
    one chosen with Tab at this half-edge, the armed one, the best of the local ones (see
    :func:`meshwright.document.operation_preview.best`).
    """

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.choices: tuple[OperationOffer, ...] = ()
        self.armed: Operation | None = None
        self._at = (-1, -1)  # revision and half-edge that the choices are of
        self._picked: Operation | None = None
        self._previewed: Operation | None = None
        self._shown: tuple[int, int, Operation | None] = (-1, -1, None)
        self.layer = GhostLayer(window.theme, window.font())
        self._rest = QTimer(window)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(self._draw_ghost)

    def connect(self) -> None:
        """Follow the mouse and the document."""
        window = self._window
        overlay = window.canvas.overlay
        overlay.add(self.layer, below=overlay.markers)
        overlay.add(self.layer.numbers, below=overlay.card)
        window.canvas.pointed.connect(self.refresh)
        window.document.hover_changed.connect(self._on_hover_changed)
        window.document.changed.connect(self._on_changed)
        window.document.replaced.connect(self.disarm)
        window.assistant.changed.connect(self.refresh)
        window.settings.changed.connect(self._on_settings_changed)
        window.operations_panel.chosen.connect(self.arm)

    def release(self) -> None:
        """Let go of the document."""
        window = self._window
        self._rest.stop()
        window.document.hover_changed.disconnect(self._on_hover_changed)
        window.document.changed.disconnect(self._on_changed)
        window.document.replaced.disconnect(self.disarm)
        window.assistant.changed.disconnect(self.refresh)
        window.settings.changed.disconnect(self._on_settings_changed)

    # Which one

    @property
    def ghosts(self) -> bool:
        """Whether ghosts are shown."""
        return self._window.settings.flag(GHOSTS, True)

    def toggle_ghosts(self) -> None:
        """Show ghosts, or none."""
        self._window.settings.put(GHOSTS, not self.ghosts)

    @property
    def current(self) -> OperationOffer | None:
        """The operation that is meant where one points, None where there is none allowed."""
        wanted = self._previewed or self._picked or self.armed
        if wanted is None:
            return best(self.choices)
        return next((c for c in self.choices if c.operation == wanted and c.allowed), None)

    def arm(self, operation: Operation) -> None:
        """From now on a click does this operation; the armed one again: a click opens the menu."""
        self._set_armed(None if operation == self.armed else operation)

    def disarm(self) -> None:
        """A click opens the menu again."""
        self._set_armed(None)

    def cycle(self, step: int) -> None:
        """Mean the next operation that is allowed here, or the one before for -1."""
        self.refresh()
        meant = self.current
        chosen = following(self.choices, meant.operation if meant else None, step)
        if chosen is None:
            self._window.say("Point at a half-edge first.")
        elif self.armed is not None:
            self._set_armed(chosen.operation)
        else:
            self._picked = chosen.operation
            self.refresh()

    def preview(self, operation: Operation | None) -> None:
        """Show the ghost of this one while a menu points at it; None: as before."""
        self._previewed = operation
        self.refresh()

    def _set_armed(self, operation: Operation | None) -> None:
        self.armed, self._picked = operation, None
        self._window.operations_panel.arm(operation)
        self.refresh()

    # Following

    def refresh(self, *_: object) -> None:
        """Show what is meant now; costs nothing where nothing has changed."""
        window, mesh = self._window, self._window.document.mesh
        halfedge = window.document.hover
        if mesh is None or not window.ready or halfedge < 0 or not mesh.live(halfedge):
            self._clear()
            return
        at = (window.document.revision, halfedge)
        if at != self._at:
            if halfedge != self._at[1]:
                self._picked = None
            self._at, self.choices = at, choices(mesh, halfedge, window.document.bar)
        meant = self.current
        operation = meant.operation if meant is not None else None
        if (*at, operation) != self._shown:
            self._shown = (*at, operation)
            window.operations_panel.offer(self.choices, operation)
            self._show_ghost(mesh, meant, halfedge)

    def _show_ghost(self, mesh: HalfEdgeMesh, meant: OperationOffer | None, halfedge: int) -> None:
        self._rest.stop()
        if meant is None or not self.ghosts or self._window.assistant.running:
            self.layer.show(None)
        elif not meant.info.is_local and mesh.n_elements > LARGE:
            self.layer.show(None)
            self._rest.start()
        else:
            self._draw_ghost()

    def _draw_ghost(self) -> None:
        """Show the ghost of what is meant now."""
        mesh, meant, halfedge = self._window.document.mesh, self.current, self._at[1]
        if mesh is None or meant is None or self._at[0] != self._window.document.revision:
            return
        seen = ghost(mesh, meant.operation, halfedge)
        scene = self._window.canvas.scene
        marks = scene.markers.places if scene is not None and scene.markers is not None else None
        if marks is not None and len(marks) > FEW:
            marks = None
        self.layer.show(seen, meant.info.title, _corners(mesh, halfedge), marks)

    def _clear(self) -> None:
        self._at, self.choices, self._picked = (-1, -1), (), None
        if self._shown != (-1, -1, None):
            self._shown = (-1, -1, None)
            self._window.operations_panel.offer((), None)
            self._rest.stop()
            self.layer.show(None)

    def _on_hover_changed(self, halfedge: int) -> None:
        if halfedge < 0:
            self._clear()

    def _on_changed(self) -> None:
        self._rest.stop()  # what was a ghost is there now, or can be no more
        self.layer.show(None)
        self._shown = (-1, -1, None)

    def _on_settings_changed(self, key: str) -> None:
        if key == GHOSTS:
            self._shown = (-1, -1, None)
            self.refresh()
            self._window.refresh()


def _corners(mesh: HalfEdgeMesh, halfedge: int) -> np.ndarray:
    """(k, 2) the corners of a half-edge's element, from its origin on."""
    vertices = []
    for _ in range(mesh.k):
        vertices.append(mesh.origin(halfedge))
        halfedge = mesh.next(halfedge)
    corners: np.ndarray = mesh.points[vertices, :2]
    return corners
