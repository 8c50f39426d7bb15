"""The canvas: the mesh on the screen, the camera, and the half-edge under the mouse."""

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QEvent, QObject, QPoint, QPointF, Qt, QTimer, Signal
from qtpy.QtGui import QResizeEvent
from qtpy.QtOpenGLWidgets import QOpenGLWidget
from qtpy.QtWidgets import QVBoxLayout, QWidget

from meshwright.desktop.canvas.gestures import Gesture
from meshwright.desktop.canvas.mesh_view import CanvasView, VtkView
from meshwright.desktop.canvas.mouse import MouseInput
from meshwright.desktop.canvas.overlay import Overlay
from meshwright.desktop.controller import Connections
from meshwright.document.document import Document
from meshwright.graphics.markers import Markers, label
from meshwright.graphics.picking import Picker
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import TrueEdges
from meshwright.graphics.viewport import Viewport
from meshwright.graphics.vtk_scene import CROWD

VERTEX_REACH = 12
"""Distance in pixels at which a vertex counts as under the mouse."""
QUICK = 5000
"""Up to this many elements the hovered half-edge is found again before the frame after a change."""


class Canvas(QWidget):
    """Shows ``document`` and follows the mouse; it never writes the mesh.

    The view draws nothing until :meth:`build`, which is called after the window has been shown,
    because the import of VTK takes longer than everything else. ``clicked(click)`` carries a
    :class:`~meshwright.desktop.canvas.mouse.Click`; ``hovered(at)`` the position of the mouse in
    pixels, None when it has left; ``escaped()``: Escape was pressed while no drag was under way;
    ``unused(event)``: a key without effect was pressed.
    ``drawn()`` follows every update of the mesh. :attr:`gesture_at` returns what a drag with the
    left button does; where it returns None the drag moves the camera.
    """

    clicked = Signal(object)
    hovered = Signal(object)
    escaped = Signal()
    unused = Signal(object)
    drawn = Signal()
    _refresh = Signal()

    def __init__(self, document: Document, theme: Theme) -> None:
        super().__init__()
        self.document = document
        self.viewport = Viewport()
        self.view = CanvasView(self)
        self.overlay = Overlay(self, theme)
        self._theme = theme
        self._edges: TrueEdges | None = None
        self._picker: Picker | None = None
        self._delta = np.empty(0, dtype=int)  # irregularities of the picker's mesh
        self._fills: np.ndarray | None = None
        self._edges_shown = True
        self._fitted = True
        self._covered = (0.0, 0.0)
        self._stale = False
        self._at: QPointF | None = None  # the position of the mouse
        self._pinned = -1  # the half-edge hovered by keyboard
        self.mouse = MouseInput(self)
        self.gesture_at: Callable[[QPointF, Qt.KeyboardModifier], Gesture | None]
        self.gesture_at = lambda at, modifiers: None
        self._frozen = False
        # a queued call runs before Qt paints other changes: one frame, not two
        self._refresh.connect(self._on_refresh, Qt.ConnectionType.QueuedConnection)
        self._point_again = QTimer(self)
        self._point_again.setSingleShot(True)
        self._point_again.setInterval(0)
        self._point_again.timeout.connect(self._on_point_again)
        self._layout = QVBoxLayout(self)
        self._layout.setContentsMargins(0, 0, 0, 0)
        # the first OpenGL widget in a window that is shown makes Qt replace the native window, and
        # clicks made until then are lost with it; a hidden one from the start prevents that
        self._surface = QOpenGLWidget(self)
        self._surface.hide()
        self._connections = Connections()
        self._connections.add(document.replaced, self._on_replaced)
        self._connections.add(document.changed, self._on_changed)
        self._connections.add(document.hover_changed, self._on_hover_changed)

    # Construction and release

    @property
    def built(self) -> bool:
        """Whether the mesh is drawn: :meth:`build` has been called and the canvas is open."""
        return self.view.built

    @property
    def plotter(self) -> QWidget:
        """The widget that receives mouse and key events: the plotter, before :meth:`build` the
        canvas.
        """
        return self.view.widget

    @property
    def markers(self) -> Markers | None:
        """The markers that are drawn; None without a mesh and before :meth:`build`."""
        return self.view.markers

    @property
    def edges(self) -> TrueEdges | None:
        """The true edges of the mesh in its present state, as fine as the view demands; None
        without a mesh.
        """
        mesh = self.document.mesh
        if self._edges is None and mesh is not None:
            self._edges = TrueEdges(mesh)
            self._edges.look(self.viewport)
        return self._edges

    def build(self) -> None:
        """Import VTK and show the mesh; needs a display and takes about a second."""
        self.view = VtkView(self, self._theme, self)
        self._layout.addWidget(self.plotter)
        self.plotter.show()  # at once, so that it can take the keyboard focus
        self.plotter.setAccessibleName("Mesh")
        self.overlay.raise_()
        self.overlay.setGeometry(self.rect())
        self.view.fill(None, None, self._fills)
        self.view.show_edges(self._edges_shown)
        self._on_replaced()

    def release(self) -> None:
        """Disconnect from the document and free VTK's resources; called when the window closes."""
        self._connections.close()
        self._point_again.stop()
        self.overlay.card.hide()
        self.view.close()
        self.view = CanvasView(self)

    def focus(self) -> None:
        """Give the canvas the keyboard focus."""
        self.plotter.setFocus()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.overlay.set_theme(theme)
        self.view.set_theme(theme, self.document.mesh, self.edges)
        self._look()

    def show_edges(self, shown: bool) -> None:
        """Draw the edges of the mesh; False where a layer of the overlay draws them instead."""
        self._edges_shown = shown
        self.view.show_edges(shown)
        self._look()

    def fill(self, fills: np.ndarray | None) -> None:
        """Fill the elements with these colours (n, 3) by id, uint8; None: the plain fill."""
        if fills is None and self._fills is None:
            return
        self._fills = fills
        if self.built and not self._stale:
            self.view.fill(self.document.mesh, self.edges, fills)
            self._look()
        else:
            self.view.fill(None, None, fills)  # seen with the next update

    # Camera

    def fit(self) -> None:
        """Fit the view to the mesh, and refit it when the canvas is resized."""
        self._fitted = True
        if self.edges is not None:
            self.viewport = self._fit_to(self.edges.points)
            self._look()

    def cover(self, width: float, height: float) -> None:
        """Tell how much of the lower right corner a legend covers, in pixels: where the mesh would
        lie below it, :meth:`fit` leaves it room. 0 for no legend.
        """
        if (width, height) != self._covered:
            self._covered = (width, height)
            if self._fitted:
                self.fit()

    def _fit_to(self, points: np.ndarray) -> Viewport:
        view = self.viewport.fitted(points)
        if len(points):
            lowest = view.to_screen(points).max(axis=0)
            if (lowest > np.array(view.size) - self._covered).all():
                view = view.fitted(points, below=self._covered[1])
        return view

    def see(self, viewport: Viewport) -> None:
        """Change the view; it is no longer refitted when the canvas is resized."""
        self._fitted = False
        self.viewport = viewport
        self._look()

    def _look(self) -> None:
        if not self.built:
            return
        mesh, view = self.document.mesh, self.view
        view.look(self.viewport)
        marks = view.markers
        if marks is not None and mesh is not None:
            at = self.viewport.to_screen(marks.places)
            seen = ((at > 0) & (at < self.viewport.size)).all(axis=1).sum() if len(at) else 0
            view.show_crowd(mesh, bool(seen > CROWD))
        edges = self.edges
        if mesh is not None and edges is not None and edges.look(self.viewport):
            view.update_edges(mesh, edges)
        marks = view.markers  # with their sizes, if they are no longer a crowd
        self.overlay.show_markers(marks, edges, self.viewport, view.crowd, view.outlined)
        self._show_hover()
        self.plotter.update()

    # Document

    def _on_replaced(self) -> None:
        self.mouse.cancel()
        self._pinned = -1
        self._edges = self._picker = None
        self._stale = False
        if self.built:
            self.view.show(self.document.mesh, self.edges)
            self.fit()
            self._look()

    def _on_changed(self) -> None:
        self.mouse.interrupt()
        self._edges = self._picker = None
        self.overlay.card.hide()
        if not self._stale:  # all changes in one turn of the event loop are drawn in one frame
            self._stale = True
            self._refresh.emit()

    def _on_refresh(self) -> None:
        mesh, edges = self.document.mesh, self.edges
        if not self._stale or not self.built or mesh is None or edges is None:
            return
        self._stale = False
        self.view.update(mesh, edges)
        if mesh.n_elements <= QUICK:
            self._on_point_again()
        else:
            self._point_again.start()  # after the frame: building the search tree takes longer
        self._look()
        self.drawn.emit()

    def _on_point_again(self) -> None:
        """Find the half-edge under the mouse again after a change of the mesh."""
        if self._frozen or self.mouse.dragging:
            return
        if self._at is not None:
            self.point_at(self._at)
        elif self._pinned >= 0:
            self.pin(self._pinned)

    # Hover

    @property
    def under_mouse(self) -> int:
        """The half-edge under the mouse, or the one pinned by keyboard, in the current mesh; -1 for
        none.
        """
        if self._at is None:
            mesh = self.document.mesh
            return self._pinned if mesh is not None and mesh.live(self._pinned) else -1
        return self._halfedge_at(self._at)

    @property
    def vertex_at_hand(self) -> int:
        """The vertex near the mouse, or else the end nearest to it of the half-edge under it; the
        origin of one pinned by keyboard; -1 for none.
        """
        mesh, halfedge = self.document.mesh, self.under_mouse
        if mesh is None:
            return -1
        if self._at is None:
            return mesh.origin(halfedge) if halfedge >= 0 else -1
        vertex = self.vertex_at(self._at)
        if vertex >= 0 or halfedge < 0:
            return vertex
        ends = [mesh.origin(halfedge), mesh.target(halfedge)]
        away = self.viewport.to_screen(mesh.points[ends]) - (self._at.x(), self._at.y())
        return ends[int(np.argmin((away**2).sum(axis=1)))]

    @property
    def by_keyboard(self) -> bool:
        """Whether the hovered half-edge has been chosen by keyboard."""
        return self._at is None and self.document.hover >= 0

    def pin(self, halfedge: int) -> None:
        """Hover ``halfedge`` until the mouse moves, for navigation by keyboard; -1 for none."""
        mesh = self.document.mesh
        self._at = None
        self._pinned = halfedge if mesh is not None and mesh.live(halfedge) else -1
        self.overlay.card.hide()
        self.document.hover = self._pinned
        self.hovered.emit(None)

    def freeze(self, frozen: bool) -> None:
        """Keep the hovered half-edge, whatever the mouse does, while a menu is open."""
        self._frozen = frozen
        if not frozen:
            self._at = None
            self.point_at(QPointF(self.mapFromGlobal(self.cursor().pos())), check=True)

    def refuse(self, reason: str) -> None:
        """Show a reason for refusal beside the mouse."""
        at = self._at.toPoint() if self._at is not None else self.rect().center()
        self.overlay.card.show(reason, at, warns=True, fades=True)

    def _pick(self) -> Picker | None:
        mesh = self.document.mesh
        if self._picker is None and mesh is not None:
            self._picker = Picker(mesh, self.edges)
            self._delta = mesh.irregularity()
        return self._picker

    def _halfedge_at(self, at: QPointF) -> int:
        picker = self._pick()
        return picker.halfedge(*self.viewport.to_plane(at.x(), at.y())) if picker else -1

    def vertex_at(self, at: QPointF) -> int:
        """The vertex near pixel ``at``, -1 for none."""
        picker = self._pick()
        if picker is None:
            return -1
        reach = VERTEX_REACH / self.viewport.pixels
        return picker.vertex(*self.viewport.to_plane(at.x(), at.y()), reach)

    def point_at(self, at: QPointF, check: bool = False) -> None:
        """Hover what is at pixel ``at``; with ``check`` nothing if that is outside the canvas."""
        if check and not self.rect().contains(at.toPoint()):
            self.leave()
            return
        self._at, self._pinned = at, -1
        self.document.hover = self._halfedge_at(at)
        self._show_vertex_card(at)
        self.hovered.emit(at)

    def leave(self) -> None:
        """Hover nothing; ignored while the hover is frozen."""
        if self._frozen:
            return
        self._at = None
        self.overlay.card.hide()
        if self._pinned < 0:
            self.document.hover = -1
            self.hovered.emit(None)

    def _show_vertex_card(self, at: QPointF) -> None:
        mesh = self.document.mesh
        vertex = self.vertex_at(at)
        if mesh is None or vertex < 0 or self._delta[vertex] == 0:
            if not self.overlay.card.warning:
                self.overlay.card.hide()
            return
        degree, desired = int(mesh.degree()[vertex]), int(mesh.desired()[vertex])
        x, y = self.viewport.to_screen(mesh.points[vertex]).tolist()
        text = f"Degree {degree}, desired {desired}:  \u0394 {label(degree - desired)}"
        self.overlay.card.show(text, QPoint(round(x), round(y)))

    def _on_hover_changed(self, halfedge: int) -> None:
        if not self._stale:
            self._show_hover()

    def _show_hover(self) -> None:
        mesh, edges, halfedge = self.document.mesh, self.edges, self.document.hover
        if mesh is None or edges is None or halfedge < 0 or not mesh.live(halfedge):
            self.overlay.show_hover(None, 0)
            return
        element, side = divmod(halfedge, mesh.k)
        sides = [self.viewport.to_screen(line) for line in edges.sides(element)]
        self.overlay.show_hover(sides, side)

    # Qt events

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Resize overlay and view."""
        super().resizeEvent(event)
        self.overlay.setGeometry(self.rect())
        self.viewport = self.viewport.resized(self.width(), self.height())
        if self._fitted:
            self.fit()
        self._look()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Handle the plotter's mouse and key events instead of VTK's 3-D interaction."""
        return self.mouse.handle(event)
