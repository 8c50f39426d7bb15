"""The mesh of the window as PyVista actors.

VTK draws elements and long outlines. The window draws markers and numbers over them by QPainter,
which is sharper; only if there are very many does VTK draw the discs too (:attr:`Scene.crowd`).
Pictures and films do not use VTK: see :mod:`meshwright.graphics.mesh_figure`.
"""

from typing import Any

import numpy as np

from meshwright.graphics.markers import Markers, markers
from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh

CROWD = 1200
"""If more irregular vertices are visible, VTK draws their discs, without numbers."""
LONG = 4000
"""A boundary of more vertices is drawn by VTK even if the caller draws short ones."""
CLASSES = 4
"""VTK draws discs of one size for each |delta| up to this; larger |delta| share the last."""


class Scene:
    """The actors of one mesh in ``plotter`` (a ``pyvista.Plotter`` or a ``QtInteractor``).

    No method renders a frame; the caller does. ``width`` scales lines. VTK draws the boundary,
    except short ones if the caller draws ``short_outlines`` itself, which looks better;
    :attr:`outlined` is whether VTK draws the present one.
    """

    def __init__(
        self, plotter: Any, theme: Theme, width: float = 1.0, short_outlines: bool = False
    ) -> None:
        self._plotter = plotter
        self._theme = theme
        self._width = width
        self._short_outlines = short_outlines
        self._surface: Any = None
        self._outline: Any = None
        self._discs: dict[int, Any] = {}
        self._depth = 1.0
        self.markers: Markers | None = None
        self.crowd = False
        plotter.set_background(theme.background)
        plotter.enable_parallel_projection()

    @property
    def theme(self) -> Theme:
        """The colours in use."""
        return self._theme

    @property
    def outlined(self) -> bool:
        """True if VTK draws the boundary, False if the caller does."""
        return self._outline is not None

    def set_theme(self, theme: Theme, mesh: HalfEdgeMesh | None) -> None:
        """Change all colours."""
        self._theme = theme
        self._plotter.set_background(theme.background)
        self.show(mesh)

    def show(self, mesh: HalfEdgeMesh | None) -> None:
        """Show another mesh or none; all actors are replaced."""
        for actor in (self._surface, self._outline, *self._discs.values()):
            if actor is not None:
                self._plotter.remove_actor(actor, render=False, reset_camera=False)
        self._surface = self._outline = self.markers = None
        self._discs = {}
        if mesh is None:
            return
        self.markers = markers(mesh)
        self._surface = self._plotter.add_mesh(
            _surface(mesh),
            color=self._theme.fill,
            show_edges=True,
            edge_color=self._theme.edge,
            line_width=self._width,
            lighting=False,
            reset_camera=False,
            render=False,
            pickable=False,
        )
        if self._draws_outline(self.markers):
            self._outline = self._plotter.add_mesh(
                _outline(self.markers),
                color=self._theme.boundary,
                line_width=2.0 * self._width,
                lighting=False,
                reset_camera=False,
                render=False,
                pickable=False,
            )
        self._measure(mesh)
        self._mark_crowd(mesh)

    def update(self, mesh: HalfEdgeMesh) -> None:
        """Update the actors to the present state of the mesh that is shown."""
        self.markers = markers(mesh)
        if self._surface is None or self.outlined != self._draws_outline(self.markers):
            self.show(mesh)
            return
        self._surface.mapper.dataset = _surface(mesh)
        if self._outline is not None:
            self._outline.mapper.dataset = _outline(self.markers)
        self._mark_crowd(mesh)

    def look(self, viewport: Viewport) -> None:
        """Set the camera to the viewport."""
        camera = self._plotter.renderer.camera
        x, y = viewport.centre
        distance = 4.0 * self._depth + 1.0
        camera.SetViewUp(0.0, 1.0, 0.0)
        camera.SetFocalPoint(x, y, 0.0)
        camera.SetPosition(x, y, distance)
        camera.SetParallelScale(viewport.parallel_scale)
        camera.SetClippingRange(1e-3 * distance, 2.0 * distance)
        camera.is_set = True  # otherwise PyVista resets it to an oblique view at the first frame

    def show_crowd(self, mesh: HalfEdgeMesh, crowd: bool) -> None:
        """Set whether VTK draws the discs of irregular vertices (``crowd``) or the caller."""
        if crowd != self.crowd:
            self.crowd = crowd
            self._mark_crowd(mesh)

    def _measure(self, mesh: HalfEdgeMesh) -> None:
        heights = np.abs(mesh.points[mesh.vertices()])
        self._depth = float(heights.max()) if heights.size else 1.0
        if self._outline is not None:
            self._outline.SetPosition(0.0, 0.0, 1.5 * self._depth)

    def _draws_outline(self, marks: Markers) -> bool:
        length = sum(len(loop) for loop in marks.loops)
        return length > (LONG if self._short_outlines else 0)

    def _mark_crowd(self, mesh: HalfEdgeMesh) -> None:
        """Update the discs: one actor for each value of delta, kept for reuse."""
        size = vertices = np.zeros(0, int)
        if self.crowd and self.markers is not None:
            vertices = self.markers.vertices
            size = np.clip(self.markers.delta, -CLASSES, CLASSES)
        for value in {*np.unique(size).tolist(), *self._discs}:
            places = mesh.points[vertices[size == value]]
            places = places * (1.0, 1.0, 0.0) + (0.0, 0.0, 2.0 * self._depth)
            if value not in self._discs:
                self._discs[value] = self._add_discs(places, value)
            elif len(places) or self._discs[value].GetVisibility():
                self._discs[value].mapper.dataset = _points(places)
            self._discs[value].SetVisibility(len(places) > 0)

    def _add_discs(self, places: np.ndarray, value: int) -> Any:
        return self._plotter.add_mesh(
            _points(places),
            color=self._theme.plus if value > 0 else self._theme.minus,
            style="points",
            point_size=self._width * (3.0 + 2.0 * abs(value)),
            render_points_as_spheres=True,
            lighting=False,
            reset_camera=False,
            render=False,
            pickable=False,
        )


def _surface(mesh: HalfEdgeMesh) -> Any:
    import pyvista

    return pyvista.PolyData.from_regular_faces(mesh.points, mesh.elements())


def _points(places: np.ndarray) -> Any:
    import pyvista

    return pyvista.PolyData(places)


def _outline(marks: Markers) -> Any:
    import pyvista

    points = np.concatenate(marks.loops)
    cells, first = [], 0
    for loop in marks.loops:
        cells.append(np.concatenate(([len(loop)], np.arange(first, first + len(loop)))))
        first += len(loop)
    return pyvista.PolyData(
        np.column_stack((points, np.zeros(len(points)))), lines=np.concatenate(cells)
    )
