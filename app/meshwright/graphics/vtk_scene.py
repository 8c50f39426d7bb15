"""The mesh of the window as PyVista actors.

VTK draws elements and long outlines. The window draws markers and numbers over them by QPainter,
which is sharper; only if there are very many does VTK draw the discs too (:attr:`Scene.crowd`).
Elements with curved sides are polygons of many points, cut into triangles here because VTK would
fill concave ones beyond their rim; their edges are lines, and both follow the zoom.
Pictures and films do not use VTK: see :mod:`meshwright.graphics.mesh_figure`.
"""

from typing import Any

import numpy as np

from meshwright.graphics.markers import Markers, markers
from meshwright.graphics.theme import Theme, region_fills
from meshwright.graphics.true_edges import TrueEdges
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import TWIN

CLOSE_EDGES = 2.5
"""Pixels between the lines of coloured elements below which they are left out."""
FAR_EDGES, NEAR_EDGES = 2.0, 8.0
"""Pixels between lines below which they are as pale and thin as they get, and beyond which they are
as dark and thick.
"""
PALE = 0.35
"""The share of the colour of lines in that of the palest ones; the rest is that of the elements."""
DISC_SHARE = 0.6
"""Diameter of discs seen from far, in mean distances between them, at most."""
SAMPLE = 500
"""Number of edges whose lengths are looked at."""
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
        self._curved: tuple[Any, Any] | None = None  # fill and edges of elements with curved sides
        self._discs: dict[int, Any] = {}
        self._depth = 1.0
        self._tinted = False
        self.markers: Markers | None = None
        self.crowd = False
        self._edge = self._room = self._pixels = 1.0
        self.fills: np.ndarray | None = None
        """(n, 3) uint8 colours of elements by id, None for the plain fill or those of regions; seen
        at the next :meth:`update`.
        """
        self.edges_shown = True
        """Whether the edges are drawn, and not by the caller; seen at the next :meth:`look`."""
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

    def set_theme(self, theme: Theme, mesh: HalfEdgeMesh | None, edges: TrueEdges | None) -> None:
        """Change all colours."""
        self._theme = theme
        self._plotter.set_background(theme.background)
        self.show(mesh, edges)

    def show(self, mesh: HalfEdgeMesh | None, edges: TrueEdges | None) -> None:
        """Show another mesh with its edges, or none; all actors are replaced."""
        actors = (self._surface, self._outline, *(self._curved or ()), *self._discs.values())
        for actor in actors:
            if actor is not None:
                self._plotter.remove_actor(actor, render=False, reset_camera=False)
        self._surface = self._outline = self._curved = self.markers = None
        self._discs = {}
        if mesh is None or edges is None:
            return
        self.markers = markers(mesh)
        self._tinted = self._is_tinted(mesh)
        self._surface = self._add(
            self._straight(mesh, edges),
            show_edges=True,
            edge_color=self._theme.edge,
            line_width=self._width,
        )
        if edges:
            fill, lines = self._bent(mesh, edges)
            line = {"color": self._theme.edge, "line_width": self._width}
            self._curved = self._add(fill), self._add(lines, **line)
        if self._draws_outline(self.markers):
            self._outline = self._add(
                _outline(edges), color=self._theme.boundary, line_width=2.0 * self._width
            )
        self._measure(mesh)
        self._mark_crowd(mesh)

    def update(self, mesh: HalfEdgeMesh, edges: TrueEdges) -> None:
        """Update the actors to the present state of the mesh that is shown."""
        self.markers = markers(mesh, sized=not self.crowd)
        drawn = self.outlined, self._curved is not None, self._tinted
        wanted = self._draws_outline(self.markers), bool(edges), self._is_tinted(mesh)
        if self._surface is None or drawn != wanted:
            self.show(mesh, edges)
            return
        self._surface.mapper.dataset = self._straight(mesh, edges)
        self.update_edges(mesh, edges)
        self._mark_crowd(mesh)

    def update_edges(self, mesh: HalfEdgeMesh, edges: TrueEdges) -> None:
        """Update what follows the polylines of the edges, which have changed with the view."""
        if self._curved is not None:
            datasets = self._bent(mesh, edges)
            for actor, dataset in zip(self._curved, datasets, strict=True):
                actor.mapper.dataset = dataset
        if self._outline is not None:
            self._outline.mapper.dataset = _outline(edges)

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
        self._fit_to_distance(viewport.pixels)
        camera.is_set = True  # otherwise PyVista resets it to an oblique view at the first frame

    def _fit_to_distance(self, pixels: float) -> None:
        """Seen from far, discs shrink so that the mesh is seen between them, and lines become pale
        and thin: otherwise their colours would be all that is seen, in holes too. Lines between
        coloured elements go.
        """
        self._pixels = pixels
        room, edge = DISC_SHARE * self._room * pixels, self._edge * pixels
        for value, actor in self._discs.items():
            usual = 3.0 + 2.0 * abs(value)
            actor.GetProperty().SetPointSize(self._width * min(usual, max(1.0, room)))
        shown = self.edges_shown and (not self._tinted or edge >= CLOSE_EDGES)
        colour = _mixed(self._theme.fill, self._theme.edge, _nearness(edge, PALE))
        if self._surface is not None:
            look = self._surface.GetProperty()
            look.SetEdgeVisibility(shown)
            look.SetEdgeColor(*colour)
        if self._curved is not None:
            self._curved[1].SetVisibility(shown)
            self._curved[1].GetProperty().SetColor(*colour)
        if self._outline is not None:
            self._outline.GetProperty().SetLineWidth(self._width * (1.0 + _nearness(edge, 0.0)))

    def show_crowd(self, mesh: HalfEdgeMesh, crowd: bool) -> None:
        """Set whether VTK draws the discs of irregular vertices (``crowd``) or the caller."""
        if crowd != self.crowd:
            self.crowd = crowd
            if not crowd and self.markers is not None and not self.markers.sized:
                self.markers = markers(mesh)
            self._mark_crowd(mesh)

    def _measure(self, mesh: HalfEdgeMesh) -> None:
        heights = np.abs(mesh.points[mesh.vertices()])
        self._depth = float(heights.max()) if heights.size else 1.0
        if self._curved is not None:
            self._curved[1].SetPosition(0.0, 0.0, 1.2 * self._depth)
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
        self._edge = _usual_edge(mesh)
        self._room = self._edge * float(np.sqrt(mesh.n_vertices / max(len(vertices), 1)))
        self._fit_to_distance(self._pixels)

    def _add_discs(self, places: np.ndarray, value: int) -> Any:
        return self._add(
            _points(places),
            color=self._theme.plus if value > 0 else self._theme.minus,
            style="points",
            point_size=self._width * (3.0 + 2.0 * abs(value)),
            render_points_as_spheres=True,
        )

    def _add(self, dataset: Any, **look: Any) -> Any:
        """Add an actor; without ``color`` it is filled, in the colours of its regions if it has
        them.
        """
        if "color" not in look:
            tinted = _TINT in dataset.cell_data
            colours = {"scalars": _TINT, "rgb": True} if tinted else {"color": self._theme.fill}
            look = {**colours, **look}
        return self._plotter.add_mesh(
            dataset, **look, lighting=False, reset_camera=False, render=False, pickable=False
        )

    def _straight(self, mesh: HalfEdgeMesh, edges: TrueEdges) -> Any:
        """The elements without curved sides."""
        import pyvista

        elements = mesh.elements()
        rows = np.arange(len(elements))
        if edges:
            rows = np.flatnonzero(~np.isin(mesh.element_ids(), edges.elements))
            elements = elements[rows]
        surface = pyvista.PolyData.from_regular_faces(mesh.points, elements)
        self._tint(surface, mesh, rows)
        return surface

    def _bent(self, mesh: HalfEdgeMesh, edges: TrueEdges) -> tuple[Any, Any]:
        """The elements with curved sides: triangles that fill them, and their inner edges."""
        import pyvista

        points, first = edges.joined_outlines(edges.elements)
        faces = pyvista.PolyData(_flat(points), faces=_cells(np.diff(first)))
        self._tint(faces, mesh, np.searchsorted(mesh.element_ids(), edges.elements))
        halfedges = mesh.halfedges_of(edges.elements).ravel()
        inner = halfedges[mesh.arrays.edge[halfedges, TWIN] >= 0]
        points, first = edges.lines(inner)
        if not len(inner):  # an actor needs something to draw
            points, first = np.repeat(edges.points[:1], 2, axis=0), np.array([0, 2])
        lines = pyvista.PolyData(_flat(points), lines=_cells(np.diff(first)))
        return faces.triangulate(), lines

    def refill(self, mesh: HalfEdgeMesh, edges: TrueEdges) -> None:
        """Show other :attr:`fills` of the same state of the mesh."""
        if self._surface is None or self._tinted != self._is_tinted(mesh):
            self.show(mesh, edges)
            return
        self._surface.mapper.dataset = self._straight(mesh, edges)
        if self._curved is not None:
            self._curved[0].mapper.dataset = self._bent(mesh, edges)[0]

    def _is_tinted(self, mesh: HalfEdgeMesh) -> bool:
        return self.fills is not None or len(mesh.region_names) > 1

    def _tint(self, surface: Any, mesh: HalfEdgeMesh, rows: np.ndarray) -> None:
        """Colour cells, the elements ``rows`` of the mesh, by :attr:`fills`, or by their region if
        there are several.
        """
        if not self._is_tinted(mesh):
            return
        if self.fills is not None:
            ids = mesh.element_ids()[rows]
            known = ids < len(self.fills)
            tints = np.empty((len(rows), 3), np.uint8)
            tints[:] = tuple(bytes.fromhex(self._theme.fill[1:]))
            tints[known] = self.fills[ids[known]]
        else:
            fills = region_fills(self._theme, len(mesh.region_names))
            colours = np.array([tuple(bytes.fromhex(fill[1:])) for fill in fills], np.uint8)
            tints = colours[mesh.regions()[rows]]
        surface.cell_data[_TINT] = tints
        surface.set_active_scalars(_TINT, "cell")


_TINT = "tint"


def _nearness(edge: float, least: float) -> float:
    """From ``least`` for lines ``edge`` pixels apart that are seen from far, to 1 from near by."""
    near = (edge - FAR_EDGES) / (NEAR_EDGES - FAR_EDGES)
    return least + (1.0 - least) * min(max(near, 0.0), 1.0)


def _mixed(ground: str, line: str, share: float) -> tuple[float, float, float]:
    """The colour between two, each written #rrggbb, as three numbers up to 1."""
    pairs = zip(bytes.fromhex(ground[1:]), bytes.fromhex(line[1:]), strict=True)
    red, green, blue = (((1.0 - share) * a + share * b) / 255.0 for a, b in pairs)
    return red, green, blue


def _usual_edge(mesh: HalfEdgeMesh) -> float:
    """The median length of some edges, spread over the mesh."""
    elements = mesh.elements()
    sample = elements[:: max(len(elements) // SAMPLE, 1), :2]
    ends = mesh.points[sample]
    return float(np.median(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)))


def _flat(points: np.ndarray) -> np.ndarray:
    return np.column_stack((points, np.zeros(len(points))))


def _cells(sizes: np.ndarray) -> np.ndarray:
    """VTK's cells of polygons or polylines of so many points each, which follow one another."""
    ends = np.cumsum(sizes)
    cells = np.insert(np.arange(ends[-1]), ends - sizes, sizes)
    return cells


def _points(places: np.ndarray) -> Any:
    import pyvista

    return pyvista.PolyData(places)


def _outline(edges: TrueEdges) -> Any:
    import pyvista

    loops = edges.loops()
    sizes = np.array([len(loop) for loop in loops])
    return pyvista.PolyData(_flat(np.concatenate(loops)), lines=_cells(sizes))
