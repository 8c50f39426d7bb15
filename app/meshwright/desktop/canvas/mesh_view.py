"""The view of the mesh by VTK, and the empty view before VTK is imported."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QObject, Qt
from qtpy.QtWidgets import QWidget

from meshwright.graphics.markers import Markers
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import TrueEdges
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh


class CanvasView:
    """The empty view, used before VTK is imported. ``widget`` receives mouse and key events."""

    built = False
    """Whether the mesh is drawn."""

    def __init__(self, widget: QWidget) -> None:
        self.widget = widget

    @property
    def markers(self) -> Markers | None:
        """Irregular vertices, corners, locks and boundary of the mesh; None without a mesh."""
        return None

    @property
    def crowd(self) -> bool:
        """Whether the view draws the discs of irregular vertices, because there are many."""
        return False

    @property
    def outlined(self) -> bool:
        """Whether the view draws the boundary."""
        return True

    def set_theme(self, theme: Theme, mesh: HalfEdgeMesh | None, edges: TrueEdges | None) -> None:
        """Draw in the colours of ``theme``."""

    def show(self, mesh: HalfEdgeMesh | None, edges: TrueEdges | None) -> None:
        """Show another mesh, with its edges."""

    def update(self, mesh: HalfEdgeMesh, edges: TrueEdges) -> None:
        """Show the same mesh after a change."""

    def update_edges(self, mesh: HalfEdgeMesh, edges: TrueEdges) -> None:
        """Draw curved edges by other polylines."""

    def fill(
        self, mesh: HalfEdgeMesh | None, edges: TrueEdges | None, fills: np.ndarray | None
    ) -> None:
        """Fill the elements with these colours (n, 3) by id, uint8; None: the plain fill."""

    def show_edges(self, shown: bool) -> None:
        """Draw the edges, or leave them to the overlay; seen at the next :meth:`look`."""

    def look(self, viewport: Viewport) -> None:
        """Move the camera."""

    def show_crowd(self, mesh: HalfEdgeMesh, crowd: bool) -> None:
        """Draw the discs of irregular vertices, or leave them to the overlay."""

    def close(self) -> None:
        """Free the resources of VTK."""


class VtkView(CanvasView):
    """A plotter inside ``canvas``, complete when the constructor returns.

    The constructor imports VTK, needs a display and takes about a second. ``input_filter``
    receives the events of the plotter's widget.
    """

    built = True

    def __init__(self, canvas: QWidget, theme: Theme, input_filter: QObject) -> None:
        from pyvistaqt import QtInteractor

        from meshwright.graphics.vtk_scene import Scene

        # by default it renders five times a second; multisampling is slow in software
        self._plotter = QtInteractor(canvas, auto_update=False, multi_samples=0)
        super().__init__(self._plotter)
        self._filter = input_filter
        self._plotter.setAcceptDrops(False)  # dropped files are opened through the document
        self._plotter.setMouseTracking(True)
        self._plotter.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._plotter.installEventFilter(input_filter)
        ratio = canvas.devicePixelRatioF()  # VTK counts physical pixels
        self._scene = Scene(self._plotter, theme, width=ratio, short_outlines=True)

    @property
    def markers(self) -> Markers | None:
        """Irregular vertices, corners, locks and boundary of the mesh; None without a mesh."""
        return self._scene.markers

    @property
    def crowd(self) -> bool:
        """Whether VTK draws the discs of irregular vertices, because there are many."""
        return self._scene.crowd

    @property
    def outlined(self) -> bool:
        """Whether VTK draws the boundary."""
        return self._scene.outlined

    def set_theme(self, theme: Theme, mesh: HalfEdgeMesh | None, edges: TrueEdges | None) -> None:
        """Draw in the colours of ``theme``."""
        self._scene.set_theme(theme, mesh, edges)

    def show(self, mesh: HalfEdgeMesh | None, edges: TrueEdges | None) -> None:
        """Show another mesh, with its edges."""
        self._scene.show(mesh, edges)

    def update(self, mesh: HalfEdgeMesh, edges: TrueEdges) -> None:
        """Show the same mesh after a change."""
        self._scene.update(mesh, edges)

    def update_edges(self, mesh: HalfEdgeMesh, edges: TrueEdges) -> None:
        """Draw curved edges by other polylines."""
        self._scene.update_edges(mesh, edges)

    def fill(
        self, mesh: HalfEdgeMesh | None, edges: TrueEdges | None, fills: np.ndarray | None
    ) -> None:
        """Fill the elements with these colours (n, 3) by id, uint8; None: the plain fill."""
        self._scene.fills = fills
        if mesh is not None and edges is not None:
            self._scene.refill(mesh, edges)

    def show_edges(self, shown: bool) -> None:
        """Draw the edges, or leave them to the overlay; seen at the next :meth:`look`."""
        self._scene.edges_shown = shown

    def look(self, viewport: Viewport) -> None:
        """Move the camera."""
        self._scene.look(viewport)

    def show_crowd(self, mesh: HalfEdgeMesh, crowd: bool) -> None:
        """Draw the discs of irregular vertices, or leave them to the overlay."""
        self._scene.show_crowd(mesh, crowd)

    def close(self) -> None:
        """Free the resources of VTK."""
        self._plotter.removeEventFilter(self._filter)
        self._plotter.close()
