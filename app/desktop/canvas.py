"""The canvas: the mesh on the screen, the camera over it, and what lies under the mouse."""

import numpy as np
from qtpy.QtCore import QEvent, QObject, QPoint, QPointF, Qt, QTimer, Signal
from qtpy.QtGui import QMouseEvent, QResizeEvent, QWheelEvent
from qtpy.QtWidgets import QVBoxLayout, QWidget

from app.desktop.overlay import Overlay
from app.document import Document
from app.markers import label
from app.picking import Picker
from app.scene import CROWD, Scene
from app.theme import Theme
from app.viewport import Viewport

DRAG = 4
"""Pixels that the mouse may move between press and release of a click."""
VERTEX_REACH = 12
"""Pixels around a vertex that count as on it."""
ZOOM_PER_STEP = 1.0015


class Canvas(QWidget):
    """Shows ``document`` and follows the mouse; it never writes the mesh.

    The plotter is made by :meth:`build`, after the window has been shown, because its import takes
    longer than all the rest. ``halfedge_chosen(halfedge, where)`` and ``vertex_chosen(vertex,
    where)`` carry a place on the screen for a menu; ``drawn()`` follows every frame.
    """

    halfedge_chosen = Signal(int, QPoint)
    vertex_chosen = Signal(int, QPoint)
    drawn = Signal()

    def __init__(self, document: Document, theme: Theme) -> None:
        super().__init__()
        self.document = document
        self.viewport = Viewport()
        self.scene: Scene | None = None
        self.plotter: QWidget | None = None
        self.overlay = Overlay(self, theme)
        self._theme = theme
        self._picker: Picker | None = None
        self._delta = np.empty(0, dtype=int)  # of the mesh that the picker was made for
        self._fitted = True
        self._stale = False
        self._mouse: QPointF | None = None
        self._pressed: QPointF | None = None
        self._panning = False
        self._frozen = False
        self._refresh = QTimer(self)
        self._refresh.setSingleShot(True)
        self._refresh.setInterval(0)
        self._refresh.timeout.connect(self._on_refresh)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        document.replaced.connect(self._on_replaced)
        document.changed.connect(self._on_changed)
        document.hover_changed.connect(self._on_hover_changed)

    # Making and ending

    def build(self) -> None:
        """Make the plotter; needs a display and takes about a second."""
        from pyvistaqt import QtInteractor

        # the default re-renders five times a second, and multisampling is dear in software
        self.plotter = QtInteractor(self, auto_update=False, multi_samples=0)
        self.plotter.setAcceptDrops(False)
        self.plotter.setMouseTracking(True)
        self.plotter.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.plotter.installEventFilter(self)
        self.layout().addWidget(self.plotter)
        self.plotter.show()  # at once, so that it can take the keyboard
        self.scene = Scene(self.plotter, self._theme, short_outlines=True)
        self.overlay.raise_()
        self.overlay.setGeometry(self.rect())
        self._on_replaced()

    def release(self) -> None:
        """Let go of VTK's resources and of the document; called when the window closes."""
        self.document.replaced.disconnect(self._on_replaced)
        self.document.changed.disconnect(self._on_changed)
        self.document.hover_changed.disconnect(self._on_hover_changed)
        self._refresh.stop()
        self.overlay.hide_card()
        if self.plotter is not None:
            self.plotter.removeEventFilter(self)
            self.plotter.close()
            self.plotter = self.scene = None

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        self._theme = theme
        self.overlay.set_theme(theme)
        if self.scene is not None:
            self.scene.set_theme(theme, self.document.mesh)
            self._look()

    # Camera

    def fit(self) -> None:
        """Show the whole mesh, and keep doing so while the window changes its size."""
        mesh = self.document.mesh
        self._fitted = True
        if mesh is not None:
            self._see(self.viewport.fitted(mesh.points[mesh.vertices()]))

    def _see(self, viewport: Viewport) -> None:
        self.viewport = viewport
        self._look()

    def _look(self) -> None:
        mesh = self.document.mesh
        if self.scene is None:
            return
        self.scene.look(self.viewport)
        marks = self.scene.markers
        if marks is not None and mesh is not None:
            at = self.viewport.to_screen(marks.places)
            seen = ((at > 0) & (at < self.viewport.size)).all(axis=1).sum() if len(at) else 0
            self.scene.show_crowd(mesh, bool(seen > CROWD))
        self.overlay.set_markers(marks, self.viewport, self.scene.crowd, self.scene.outlined)
        self._show_hover()
        self.plotter.update()

    # Document

    def _on_replaced(self) -> None:
        self._picker = None
        self._stale = False
        if self.scene is not None:
            self.scene.show(self.document.mesh)
            self.fit()
            self._look()

    def _on_changed(self) -> None:
        self._picker = None
        self._stale = True
        self.overlay.hide_card()
        self._refresh.start()  # many changes in one turn of the event loop are one frame

    def _on_refresh(self) -> None:
        mesh = self.document.mesh
        if not self._stale or self.scene is None or mesh is None:
            return
        self._stale = False
        self.scene.update(mesh)
        if self._mouse is not None and not self._frozen:
            self._point_at(self._mouse)
        self._look()
        self.drawn.emit()

    # Hover

    @property
    def under_mouse(self) -> int:
        """The half-edge under the mouse now, -1 for none; looks at the mesh as it is now."""
        if self._mouse is None:
            return -1
        return self._halfedge_at(self._mouse)

    def freeze(self, frozen: bool) -> None:
        """Keep the half-edge that is shown while a menu is open."""
        self._frozen = frozen
        if not frozen:
            self._mouse = None
            self._point_at(QPointF(self.mapFromGlobal(self.cursor().pos())), check=True)

    def refuse(self, reason: str) -> None:
        """Show beside the mouse why something is not allowed."""
        at = self._mouse.toPoint() if self._mouse is not None else self.rect().center()
        self.overlay.show_card(reason, at, warns=True, fades=True)

    def _pick(self) -> Picker | None:
        mesh = self.document.mesh
        if self._picker is None and mesh is not None:
            self._picker = Picker(mesh)
            self._delta = mesh.irregularity()
        return self._picker

    def _halfedge_at(self, at: QPointF) -> int:
        picker = self._pick()
        return picker.halfedge(*self.viewport.to_plane(at.x(), at.y())) if picker else -1

    def _vertex_at(self, at: QPointF) -> int:
        picker = self._pick()
        if picker is None:
            return -1
        reach = VERTEX_REACH / self.viewport.pixels
        return picker.vertex(*self.viewport.to_plane(at.x(), at.y()), reach)

    def _point_at(self, at: QPointF, check: bool = False) -> None:
        """The mouse is at ``at``; ``check`` that this is on the canvas at all."""
        if check and not self.rect().contains(at.toPoint()):
            self._leave()
            return
        self._mouse = at
        self.document.hover = self._halfedge_at(at)
        self._tell_vertex(at)

    def _leave(self) -> None:
        self._mouse = None
        self.document.hover = -1
        self.overlay.hide_card()

    def _tell_vertex(self, at: QPointF) -> None:
        mesh = self.document.mesh
        vertex = self._vertex_at(at)
        if mesh is None or vertex < 0 or self._delta[vertex] == 0:
            if not self.overlay.warning:
                self.overlay.hide_card()
            return
        degree, desired = int(mesh.degree()[vertex]), int(mesh.desired()[vertex])
        x, y = self.viewport.to_screen(mesh.points[vertex]).tolist()
        text = f"Degree {degree}, desired {desired}:  \u0394 {label(degree - desired)}"
        self.overlay.show_card(text, QPoint(round(x), round(y)))

    def _on_hover_changed(self, halfedge: int) -> None:
        if not self._stale:
            self._show_hover()

    def _show_hover(self) -> None:
        mesh, halfedge = self.document.mesh, self.document.hover
        if mesh is None or halfedge < 0 or not mesh.live(halfedge):
            self.overlay.set_hover(None, 0)
            return
        first = halfedge - halfedge % mesh.k
        corners = [mesh.origin(first + side) for side in range(mesh.k)]
        self.overlay.set_hover(
            self.viewport.to_screen(mesh.points[np.array(corners)]), halfedge % mesh.k
        )

    # Mouse

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Keep the overlay over the plotter, and the mesh in view."""
        super().resizeEvent(event)
        self.overlay.setGeometry(self.rect())
        self.viewport = self.viewport.resized(self.width(), self.height())
        if self._fitted:
            self.fit()
        self._look()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Take the plotter's mouse and keys: VTK's own 3-D interaction is not wanted."""
        kind = event.type()
        if kind == QEvent.Type.MouseMove:
            self._on_move(event)
        elif kind in (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick):
            self._on_press(event)
        elif kind == QEvent.Type.MouseButtonRelease:
            self._on_release(event)
        elif kind == QEvent.Type.Wheel:
            self._on_wheel(event)
        elif kind == QEvent.Type.Leave:
            if not self._frozen:
                self._leave()
        elif kind not in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease, QEvent.Type.Enter):
            return False
        return kind not in (QEvent.Type.Enter, QEvent.Type.Leave)

    def _on_move(self, event: QMouseEvent) -> None:
        at = event.position()
        if self._pressed is not None:
            step = at - self._pressed
            if self._panning or step.manhattanLength() > DRAG:
                self._panning = True
                self._fitted = False
                self._pressed = at
                self.plotter.setCursor(Qt.CursorShape.ClosedHandCursor)
                self._see(self.viewport.panned(step.x(), step.y()))
                return
        self._point_at(at)

    def _on_press(self, event: QMouseEvent) -> None:
        self.plotter.setFocus(Qt.FocusReason.MouseFocusReason)
        if event.button() != Qt.MouseButton.RightButton:
            self._pressed = event.position()
            self._panning = False

    def _on_release(self, event: QMouseEvent) -> None:
        panned, self._panning, self._pressed = self._panning, False, None
        self.plotter.unsetCursor()
        at = event.position()
        self._point_at(at)
        if panned or event.button() == Qt.MouseButton.MiddleButton:
            return
        where = self.plotter.mapToGlobal(at.toPoint())
        vertex = self._vertex_at(at) if event.button() == Qt.MouseButton.RightButton else -1
        if vertex >= 0:
            self.vertex_chosen.emit(vertex, where)
        elif self.document.hover >= 0:
            self.halfedge_chosen.emit(self.document.hover, where)

    def _on_wheel(self, event: QWheelEvent) -> None:
        at = event.position()
        self._fitted = False
        factor = ZOOM_PER_STEP ** event.angleDelta().y()
        self._see(self.viewport.zoomed(factor, at.x(), at.y()))
        self._point_at(at)
