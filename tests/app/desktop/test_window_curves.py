"""Curves in the window: drawn as they are at every zoom, hovered, previewed and dragged along."""

from itertools import pairwise

import curved_meshes
import numpy as np
import pytest
from driving import WAIT, pixel
from qtpy.QtCore import QPoint, Qt
from qtpy.QtGui import QColor

from meshwright.document.vertex_drag import CORNER
from meshwright.graphics.theme import region_fills
from meshwright.graphics.viewport import Viewport

pytestmark = pytest.mark.needs("window")


def picture(window) -> np.ndarray:
    """(height, width, 3) the canvas as it is painted."""
    image = window.grab().toImage().convertToFormat(window.grab().toImage().Format.Format_RGB888)
    raw = np.frombuffer(bytes(image.constBits()), np.uint8)
    whole = raw.reshape(image.height(), image.bytesPerLine())[:, : 3 * image.width()]
    whole = whole.reshape(image.height(), image.width(), 3)
    corner = window.canvas.plotter.mapTo(window, QPoint(0, 0))
    width, height = window.canvas.viewport.size
    return whole[corner.y() : corner.y() + height, corner.x() : corner.x() + width].astype(int)


def near(colours: np.ndarray, name: str) -> np.ndarray:
    wanted = np.array(QColor(name).getRgb()[:3])
    return np.abs(colours - wanted).max(axis=-1) <= 8


def look_at(qtbot, window, centre, pixels) -> None:
    window.canvas.see(Viewport(tuple(centre), pixels, window.canvas.viewport.size))
    qtbot.wait(100)


@pytest.mark.parametrize("pixels", [150.0, 4e3, 1e6])
def test_the_boundary_of_a_disc_is_a_circle_at_every_zoom(qtbot, open_window, pixels):
    window = open_window(curved_meshes.disc())
    angle = 0.2  # away from the vertices and the middles of edges
    at = np.array([np.cos(angle), np.sin(angle)])
    look_at(qtbot, window, at if pixels > 1e3 else (0.0, 0.0), pixels)
    view = window.canvas.viewport
    seen = picture(window)
    dark = near(seen, window.theme.boundary)
    rows, columns = np.nonzero(dark)
    assert len(rows) > 100
    x = view.centre[0] + (columns + 0.5 - view.size[0] / 2) / pixels
    y = view.centre[1] - (rows + 0.5 - view.size[1] / 2) / pixels
    away = np.abs(np.hypot(x, y) - 1.0) * pixels
    discs = np.abs(np.arctan2(y, x) * 4 / np.pi % 2 - 1.0) * np.pi / 4 * pixels < 20.0
    assert away[~discs].max() < 1.3  # half the width of the line, and half a pixel
    for step, colour in ((-6.0, window.theme.fill), (6.0, window.theme.background)):
        for turn in np.linspace(-200.0, 200.0, 9) / max(pixels, 400.0):
            place = (1.0 + step / pixels) * np.array([np.cos(angle + turn), np.sin(angle + turn)])
            column, row = np.floor(view.to_screen(place)).astype(int).tolist()
            if 0 <= row < seen.shape[0] and 0 <= column < seen.shape[1]:
                assert near(seen[row, column], colour)


def test_the_view_fits_the_curves_and_regions_are_tinted(qtbot, open_window):
    window = open_window(curved_meshes.insert())
    qtbot.wait(100)
    top = window.canvas.viewport.to_screen(np.array([0.0, 2.0]))
    assert 20 < top[1] < 80
    seen = picture(window)
    fills = region_fills(window.theme, 2)
    for radius, fill in ((0.96, fills[1]), (1.06, fills[0]), (1.94, fills[0])):
        place = radius * np.array([np.cos(0.03), np.sin(0.03)])
        column, row = np.floor(window.canvas.viewport.to_screen(place)).astype(int).tolist()
        assert near(seen[row, column], fill)


def test_hover_picks_the_side_of_the_true_curve_and_names_the_region(qtbot, open_window):
    window = open_window(curved_meshes.insert())
    plotter = window.canvas.plotter

    def region_at(radius) -> int:
        at = pixel(window, radius * np.array([np.cos(0.02), np.sin(0.02)]))
        qtbot.mouseMove(plotter, at + QPoint(2, 0))
        qtbot.mouseMove(plotter, at)
        hover = window.document.hover
        return -1 if hover < 0 else int(window.document.mesh.arrays.region[hover // 4])

    qtbot.waitUntil(lambda: region_at(0.95) == 1, timeout=WAIT)
    assert window.status.halfedge.endswith("region insert")
    assert region_at(1.05) == 0
    assert window.status.halfedge.endswith("region plate")
    assert region_at(1.95) == 0
    assert region_at(2.05) == -1


def test_the_arrow_follows_the_curve(qtbot, open_window):
    mesh = curved_meshes.ring()
    window = open_window(mesh)
    at = pixel(window, 1.95 * np.array([np.cos(0.1), np.sin(0.1)]))
    qtbot.mouseMove(window.canvas.plotter, at)
    qtbot.waitUntil(lambda: window.document.hover >= 0, timeout=WAIT)
    assert mesh.twin(window.document.hover) < 0
    line = window.canvas.overlay.arrow.line
    assert len(line) > 10
    plane = np.array([window.canvas.viewport.to_plane(x, y) for x, y in line.tolist()])
    radii = np.hypot(*plane.T)
    assert (radii < 2.0).all() and (radii > 1.8).all()


def test_a_preview_shows_new_vertices_on_the_curve(qtbot, open_window):
    mesh = curved_meshes.ring()
    window = open_window(mesh)
    halfedge = 0  # along the spoke at 45 degrees, in the element to the left of it
    at = pixel(window, 1.5 * np.array([np.cos(0.85), np.sin(0.85)]))
    assert mesh.check("global_split", halfedge)
    qtbot.mouseMove(window.canvas.plotter, at + QPoint(1, 0))
    qtbot.mouseMove(window.canvas.plotter, at)
    qtbot.waitUntil(lambda: window.document.hover == halfedge, timeout=WAIT)
    for _ in range(10):
        ghost = window.hover.layer.ghost
        if ghost is not None and ghost.operation == "global_split":
            break
        qtbot.keyClick(window.canvas.plotter, Qt.Key.Key_T)
    assert ghost is not None
    assert ghost.operation == "global_split"
    assert np.abs(np.hypot(*ghost.fresh.T) - 2.0).max() < 1e-14
    assert (len(ghost.added), len(ghost.removed)) == (2, 1)
    picture(window)  # paints it


def drag(qtbot, window, *places, release=True) -> None:
    plotter = window.canvas.plotter
    pixels = [pixel(window, place) for place in places]
    qtbot.mouseMove(plotter, pixels[0])
    qtbot.mousePress(plotter, Qt.MouseButton.LeftButton, pos=pixels[0])
    for before, after in pairwise(pixels):
        for share in (0.3, 0.6, 1.0):
            qtbot.mouseMove(plotter, before + (after - before) * share)
    if release:
        qtbot.mouseRelease(plotter, Qt.MouseButton.LeftButton, pos=pixels[-1])


def test_a_boundary_vertex_is_dragged_along_the_circle_and_back(qtbot, open_window):
    mesh = curved_meshes.disc()
    window = open_window(mesh)
    points, parameters = mesh.points.copy(), mesh.parameters()
    drag(qtbot, window, mesh.points[4, :2], (0.9, 0.6), (1.3, 0.5), release=False)
    (place,) = window.selection_tools.rubber.places
    assert abs(np.hypot(*place) - 1.0) < 1e-14
    picture(window)  # paints it
    qtbot.mouseRelease(
        window.canvas.plotter, Qt.MouseButton.LeftButton, pos=pixel(window, (1.3, 0.5))
    )
    assert abs(np.hypot(*mesh.points[4, :2]) - 1.0) < 1e-14
    assert np.arctan2(*mesh.points[4, 1::-1]) == pytest.approx(np.arctan2(0.5, 1.3), abs=0.02)
    assert mesh.off_curve().max() < 1e-14
    assert mesh.parameter_of(4) != parameters[4]
    mesh.validate()
    window.document.undo()
    assert (mesh.points == points).all() and (mesh.parameters() == parameters).all()


def test_an_interface_vertex_slides_along_it_and_an_anchor_stays(qtbot, open_window):
    mesh = curved_meshes.insert()
    window = open_window(mesh)
    drag(qtbot, window, mesh.points[4, :2], (0.9, 0.5), (1.0, 0.4))
    assert window.document.can_undo
    assert abs(np.hypot(*mesh.points[4, :2]) - 1.0) < 1e-14
    mesh.validate()
    plate = curved_meshes.plate()
    window = open_window(plate)
    drag(qtbot, window, plate.points[0, :2], plate.points[0, :2] + (0.3, 0.3))
    assert window.status.message == CORNER
