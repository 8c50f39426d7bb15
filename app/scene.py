"""The scene: a mesh as PyVista actors, and pictures of it without a window.

VTK draws the elements and the outline. Markers and numbers are drawn over it, by the window with
QPainter and by :func:`picture` with Pillow, so that they are crisp; only where there are very many
of them does VTK draw the discs too (:attr:`Scene.crowd`).
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from app.markers import READABLE, Markers, label, markers
from app.theme import Theme, theme
from app.viewport import Viewport
from meshcore import HalfEdgeMesh

CROWD = 1200
"""With more visible irregular vertices than this VTK draws their discs, without numbers."""
LONG = 4000
"""A boundary of more vertices than this is VTK's to draw, also where the caller could."""
CLASSES = 4
"""Discs of VTK come in one size for each |delta| from 1 to here; larger ones share the last."""
SAMPLES = 2
"""Pictures are drawn this many times larger and scaled down, for smooth lines."""
OFF_SCREEN = "vtkEGLRenderWindow"
_NOWHERE = np.zeros((0, 3))


class Scene:
    """The actors of one mesh in ``plotter`` (a ``pyvista.Plotter`` or a ``QtInteractor``).

    Nothing here renders: the caller does, when it wants a frame. ``width`` scales lines. The
    boundary is VTK's unless the caller says that it draws ``short_outlines`` itself, which looks
    better; :attr:`outlined` tells whose it is.
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
        """Show another mesh, or none: all actors are made anew."""
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
        """Show the present state of the mesh that is shown already."""
        self.markers = markers(mesh)
        if self._surface is None or self.outlined != self._draws_outline(self.markers):
            self.show(mesh)
            return
        self._surface.mapper.dataset = _surface(mesh)
        if self._outline is not None:
            self._outline.mapper.dataset = _outline(self.markers)
        self._mark_crowd(mesh)

    def look(self, viewport: Viewport) -> None:
        """Point the camera so that the plane is seen as ``viewport`` says."""
        camera = self._plotter.renderer.camera
        x, y = viewport.centre
        distance = 4.0 * self._depth + 1.0
        camera.SetViewUp(0.0, 1.0, 0.0)
        camera.SetFocalPoint(x, y, 0.0)
        camera.SetPosition(x, y, distance)
        camera.SetParallelScale(viewport.parallel_scale)
        camera.SetClippingRange(1e-3 * distance, 2.0 * distance)
        camera.is_set = True  # else PyVista turns it to an oblique view at the first frame

    def show_crowd(self, mesh: HalfEdgeMesh, crowd: bool) -> None:
        """Let VTK draw the discs of irregular vertices (``crowd``), or the caller."""
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
        """One actor of discs for each sign and size of delta; an actor once made is kept."""
        size = np.zeros(0, int)
        if self.crowd and self.markers is not None:
            size = np.clip(self.markers.delta, -CLASSES, CLASSES)
        for value in {*np.unique(size).tolist(), *self._discs}:
            places = mesh.points[self.markers.vertices[size == value]] if len(size) else _NOWHERE
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


def picture(
    mesh: HalfEdgeMesh,
    path: str | Path,
    size: tuple[int, int] = (1200, 900),
    theme: str = "light",
    score: bool = True,
) -> Path:
    """Write a PNG (or what the ending says) of ``mesh`` with ``size`` in pixels.

    No display is needed. ``score`` writes s, the optimum and the number of elements into it.
    Raises OSError where the file cannot be written, ValueError for an unknown theme or ending.
    """
    path = Path(path)
    image(mesh, size, theme, score).save(path)
    return path


def image(
    mesh: HalfEdgeMesh,
    size: tuple[int, int] = (1200, 900),
    theme_name: str = "light",
    score: bool = True,
    viewport: Viewport | None = None,
) -> Any:
    """The picture of ``mesh`` as a Pillow image; ``viewport`` as fitted if None."""
    from PIL import Image

    colours = theme(theme_name)
    large = (size[0] * SAMPLES, size[1] * SAMPLES)
    if viewport is None:
        margin = 0.06 * min(size)
        viewport = Viewport(size=size).fitted(mesh.points[mesh.vertices()], margin)
    viewport = Viewport(viewport.centre, viewport.pixels * SAMPLES, large)
    with _off_screen():
        import pyvista

        plotter = pyvista.Plotter(off_screen=True, window_size=list(large))
        try:
            scene = Scene(plotter, colours, width=SAMPLES * size[1] / 900.0 + 0.2)
            scene.show(mesh)
            scene.look(viewport)
            drawn = Image.fromarray(np.asarray(plotter.screenshot(return_img=True)))
        finally:
            plotter.close()
    _draw_markers(drawn, scene.markers, viewport, colours, SAMPLES * size[1] / 900.0)
    drawn = drawn.resize(size, Image.Resampling.LANCZOS)
    if score:
        _draw_score(drawn, mesh, colours)
    return drawn


def summary(mesh: HalfEdgeMesh) -> str:
    """``s 8, optimum 5, 24 quads``."""
    noun = "quad" if mesh.k == 4 else "triangle"
    plural = "" if mesh.n_elements == 1 else "s"
    return f"s {mesh.score}, optimum {mesh.optimum}, {mesh.n_elements:,} {noun}{plural}"


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


def _draw_markers(
    image: Any, marks: Markers | None, viewport: Viewport, colours: Theme, scale: float
) -> None:
    from PIL import ImageDraw

    if marks is None:
        return
    draw = ImageDraw.Draw(image)
    half = 3.5 * scale
    for x, y in viewport.to_screen(marks.corner_places):
        draw.rectangle((x - half, y - half, x + half, y + half), fill=colours.corner)
    # radii are meant for a screen of 900 pixels' height: larger pictures get larger discs
    small = Viewport(viewport.centre, viewport.pixels / scale, viewport.size)
    radii = marks.radii(small) * scale
    places = viewport.to_screen(marks.places)
    for (x, y), delta, r, corner in zip(places, marks.delta, radii, marks.corners, strict=True):
        colour = colours.plus if delta > 0 else colours.minus
        if corner:
            draw.rectangle((x - r, y - r, x + r, y + r), fill=colours.corner)
        rim = r + 1.2 * scale
        draw.ellipse((x - rim, y - rim, x + rim, y + rim), fill=colours.background)
        draw.ellipse((x - r, y - r, x + r, y + r), fill=colour)
        if r >= READABLE * scale:
            font = _font(1.15 * r)
            draw.text((x, y), label(int(delta)), colours.marker_text, font, anchor="mm")
    ring = 10.0 * scale
    for x, y in viewport.to_screen(marks.locked_places):
        box = (x - ring, y - ring, x + ring, y + ring)
        draw.ellipse(box, outline=colours.boundary, width=max(1, round(1.5 * scale)))


def _draw_score(image: Any, mesh: HalfEdgeMesh, colours: Theme) -> None:
    from PIL import ImageDraw

    draw = ImageDraw.Draw(image)
    size = max(11.0, image.height / 52.0)
    at = (size, image.height - size)
    text = summary(mesh)
    draw.text(at, text, colours.muted, _font(size), anchor="ls")
    if mesh.score == mesh.optimum:
        width = draw.textlength(text, font=_font(size))
        draw.text(
            (at[0] + width, at[1]), ", at the optimum", colours.accent, _font(size), anchor="ls"
        )


def _font(size: float) -> Any:
    import matplotlib
    from PIL import ImageFont

    fonts = Path(matplotlib.get_data_path()) / "fonts" / "ttf"
    return ImageFont.truetype(str(fonts / "DejaVuSans.ttf"), size)


@contextmanager
def _off_screen() -> Iterator[None]:
    """Have VTK draw without a display; a window opened afterwards is not affected."""
    name = "VTK_DEFAULT_OPENGL_WINDOW"
    if sys.platform != "linux" or name in os.environ:
        yield
        return
    os.environ[name] = OFF_SCREEN
    try:
        yield
    finally:
        del os.environ[name]
