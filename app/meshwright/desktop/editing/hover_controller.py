"""The operations possible at the hovered half-edge, and the preview of the current one."""

from __future__ import annotations

import time

import numpy as np
from qtpy.QtCore import QTimer

from meshwright.assistant.assistant import Assistant
from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.ghost import GhostLayer
from meshwright.desktop.controller import Controller
from meshwright.desktop.editing.operations_panel import OperationsPanel
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.document.operation_preview import OperationOffer, best, choices, following, ghost
from meshwright.graphics.theme import Theme
from meshwright.signals import Signal
from meshwright_core import HalfEdgeMesh, Operation

GHOSTS = "editing/ghosts"
"""The setting that shows previews."""
LARGE = 5000
"""In meshes of more elements, previews of global operations wait until the mouse rests, to avoid
flicker.
"""
REST = 60
"""Milliseconds without a move after which the mouse rests."""
MEASURED_AFTER = 90
"""Milliseconds at a half-edge after which the change of shape of each operation is computed."""
PATIENCE = 0.03
"""Seconds that this may take at a time."""
FEW = 2000
"""The tag of a preview avoids irregular vertices only up to this many."""


class HoverController(Controller):
    """Determines the current operation, previews it, and owns the panel of operations.

    The current operation is, in this order: the one of the hovered row of a menu, the one chosen
    with T at this half-edge, the armed one, the best of the local ones (see
    :func:`meshwright.document.operation_preview.best`).
    """

    def __init__(
        self,
        document: Document,
        assistant: Assistant,
        canvas: Canvas,
        settings: Settings,
        readiness: Readiness,
        status: StatusBar,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._assistant, self._canvas = document, assistant, canvas
        self._settings, self._readiness, self._status = settings, readiness, status
        self.panel = OperationsPanel(document, theme)
        self.choices: tuple[OperationOffer, ...] = ()
        self.armed: Operation | None = None
        self.offered = Signal()
        """Emitted when the choices or the current operation have changed."""
        self._at = (-1, -1)  # revision and half-edge that the choices are of
        self._picked: Operation | None = None
        self._previewed: Operation | None = None
        self._shown: tuple[int, int, Operation | None] = (-1, -1, None)
        self.layer = GhostLayer(theme, canvas.font())
        self._rest = QTimer(canvas)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(self._draw_ghost)
        self._open = True
        self._suspended = False
        self._measured: tuple[tuple[int, int], dict[Operation, float | None]] = (self._at, {})
        self._measuring = QTimer(canvas)
        self._measuring.setSingleShot(True)
        self._measuring.setInterval(MEASURED_AFTER)
        self._measuring.timeout.connect(self._measure)
        overlay = canvas.overlay
        overlay.add(self.layer, below=overlay.markers)
        overlay.add(self.layer.numbers, below=overlay.card)
        canvas.hovered.connect(self.refresh)
        self._connections.add(document.hover_changed, self._on_hover_changed)
        self._connections.add(document.changed, self._on_changed)
        self._connections.add(document.replaced, self.disarm)
        self._connections.add(assistant.changed, self.refresh)
        self._connections.add(settings.changed, self._on_settings_changed)
        self._connections.add(readiness.changed, self.refresh)
        self.panel.chosen.connect(self.arm)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        super().set_theme(theme)
        self.panel.set_theme(theme)

    def close(self) -> None:
        """Disconnect, and stop the timers."""
        super().close()
        self._open = False
        self._measuring.stop()
        self._rest.stop()
        self.panel.release()

    def suspend(self, suspended: bool) -> None:
        """Offer no operations at the hovered half-edge while another view uses the mouse."""
        self._suspended = suspended
        if suspended:
            self.disarm()
        self._clear()
        self.refresh()

    # The current operation

    @property
    def ghosts(self) -> bool:
        """Whether operations are previewed."""
        return self._settings.flag(GHOSTS, True)

    def toggle_ghosts(self) -> None:
        """Switch the previews on or off."""
        self._settings.put(GHOSTS, not self.ghosts)

    @property
    def current(self) -> OperationOffer | None:
        """The current operation at the hovered half-edge; None if none is allowed."""
        wanted = self._previewed or self._picked or self.armed
        if wanted is None:
            return best(self.choices)
        return next((c for c in self.choices if c.operation == wanted and c.allowed), None)

    def arm(self, operation: Operation) -> None:
        """Apply this operation at every click from now on; arming the armed one disarms it."""
        self._set_armed(None if operation == self.armed else operation)

    def disarm(self) -> None:
        """Let clicks open the menu again."""
        self._set_armed(None)

    def put_down(self) -> bool:
        """Disarm; False if no operation is armed."""
        armed = self.armed is not None
        if armed:
            self.disarm()
        return armed

    def cycle(self, step: int) -> None:
        """Make the next operation that is allowed here the current one; the previous one for -1."""
        self.refresh()
        meant = self.current
        chosen = following(self.choices, meant.operation if meant else None, step)
        if chosen is None:
            self._status.show_message("Point at a half-edge first.")
        elif self.armed is not None:
            self._set_armed(chosen.operation)
        else:
            self._picked = chosen.operation
            self.refresh()

    def preview(self, operation: Operation | None) -> None:
        """Preview ``operation`` while its row in a menu is current; None ends this."""
        self._previewed = operation
        self.refresh()

    def _set_armed(self, operation: Operation | None) -> None:
        self.armed, self._picked = operation, None
        self.panel.arm(operation)
        self.refresh()

    # Following

    def refresh(self, *_: object) -> None:
        """Update choices and preview; returns at once if nothing has changed."""
        mesh = self._document.mesh
        halfedge = self._document.hover
        missing = mesh is None or halfedge < 0 or not mesh.live(halfedge)
        if mesh is None or missing or self._suspended or not self._readiness.editing:
            self._clear()
            return
        at = (self._document.revision, halfedge)
        if at != self._at:
            if halfedge != self._at[1]:
                self._picked = None
            self._at, self.choices = at, choices(mesh, halfedge, self._document.bar)
        meant = self.current
        operation = meant.operation if meant is not None else None
        if (*at, operation) != self._shown:
            self._shown = (*at, operation)
            self.panel.offer(self.choices, operation)
            if self._open:
                self._measuring.start()
            self._show_ghost(mesh, meant, halfedge)
            self.offered.emit()

    def _show_ghost(self, mesh: HalfEdgeMesh, meant: OperationOffer | None, halfedge: int) -> None:
        self._rest.stop()
        if meant is None or not self.ghosts or self._assistant.running:
            self.layer.show(None)
        elif not meant.info.is_local and mesh.n_elements > LARGE:
            self.layer.show(None)
            self._rest.start()
        else:
            self._draw_ghost()

    def _measure(self) -> None:
        """Show how each local operation would change the shape of the elements near it."""
        from meshwright.document.shape_change import shape_change  # imports scipy

        mesh, at = self._document.mesh, self._at
        if mesh is None or at[0] != self._document.revision or self._assistant.running:
            return
        if self._measured[0] != at:
            self._measured = (at, {})
        began, found = time.perf_counter(), self._measured[1]
        for offer in self.choices:
            if offer.allowed and offer.info.is_local and offer.operation not in found:
                found[offer.operation] = shape_change(
                    mesh, offer.operation, at[1], self._document.auto_smooth
                )
                if time.perf_counter() - began > PATIENCE:
                    self._measuring.start()
                    break
        self.panel.show_shapes({operation: by for operation, by in found.items() if by is not None})

    def _draw_ghost(self) -> None:
        """Show the preview of the current operation."""
        mesh, meant, halfedge = self._document.mesh, self.current, self._at[1]
        if mesh is None or meant is None or self._at[0] != self._document.revision:
            return
        seen = ghost(mesh, meant.operation, halfedge)
        marks = self._canvas.markers.places if self._canvas.markers is not None else None
        if marks is not None and len(marks) > FEW:
            marks = None
        self.layer.show(seen, meant.info.title, _corners(mesh, halfedge), marks)

    def _clear(self) -> None:
        self._at, self.choices, self._picked = (-1, -1), (), None
        if self._shown != (-1, -1, None):
            self._shown = (-1, -1, None)
            self.panel.offer((), None)
            self._measuring.stop()
            self._rest.stop()
            self.layer.show(None)
            self.offered.emit()

    def _on_hover_changed(self, halfedge: int) -> None:
        if halfedge < 0:
            self._clear()

    def _on_changed(self) -> None:
        self._rest.stop()  # the previewed operation is applied now, or outdated
        self.layer.show(None)
        self._shown = (-1, -1, None)

    def _on_settings_changed(self, key: str) -> None:
        if key == GHOSTS:
            self._shown = (-1, -1, None)
            self.refresh()


def _corners(mesh: HalfEdgeMesh, halfedge: int) -> np.ndarray:
    """(k, 2) the corners of a half-edge's element, from its origin on."""
    vertices = []
    for _ in range(mesh.k):
        vertices.append(mesh.origin(halfedge))
        halfedge = mesh.next(halfedge)
    corners: np.ndarray = mesh.points[vertices, :2]
    return corners
