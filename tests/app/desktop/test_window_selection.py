"""Selecting and dragging vertices, and their menus: by real mouse and keys."""

from itertools import pairwise

import numpy as np
import pytest
from driving import WAIT, beside, pixel, press
from qtpy.QtCore import QPoint, Qt
from qtpy.QtWidgets import QApplication

from meshwright.desktop.editing.vertex_menu import OUTDATED
from meshwright.document.vertex_drag import CORNER, LOCK
from meshwright_core import HalfEdgeMesh

NONE, SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
LASSO = SHIFT | Qt.KeyboardModifier.AltModifier


@pytest.fixture
def grid() -> HalfEdgeMesh:
    """Six by four unit quads; vertex i + 7 j at (i, j)."""
    points = np.array([(i, j) for j in range(5) for i in range(7)], float)
    corners = [i + 7 * j for j in range(4) for i in range(6)]
    return HalfEdgeMesh.from_elements(points, [(c, c + 1, c + 8, c + 7) for c in corners])


def drag(qtbot, window, *places, modifier=NONE, release=True):
    """Press at the first place (x, y) of the plane and drag through the others."""
    plotter = window.canvas.plotter
    pixels = [pixel(window, place) for place in places]
    qtbot.mouseMove(plotter, pixels[0])
    qtbot.mousePress(plotter, Qt.MouseButton.LeftButton, modifier, pixels[0])
    for before, after in pairwise(pixels):
        for share in (0.3, 0.6, 1.0):
            qtbot.mouseMove(plotter, before + (after - before) * share)
    if release:
        qtbot.mouseRelease(plotter, Qt.MouseButton.LeftButton, modifier, pixels[-1])


def shift_click(qtbot, window, vertex):
    at = pixel(window, window.document.mesh.points[vertex])
    qtbot.mouseClick(window.canvas.plotter, Qt.MouseButton.LeftButton, SHIFT, at)


def open_menu(qtbot, window, at):
    qtbot.mouseMove(window.canvas.plotter, at)
    qtbot.mouseClick(window.canvas.plotter, Qt.MouseButton.RightButton, pos=at)
    return QApplication.activePopupWidget()


def entry(menu, text):
    return next(action for action in menu.actions() if action.text().startswith(text))


def test_shift_click_adds_and_removes(qtbot, open_window, grid):
    window = open_window(grid)
    selection = window.document.selection
    for vertex in (8, 9, 15, 16):
        shift_click(qtbot, window, vertex)
    assert selection.vertices.tolist() == [8, 9, 15, 16]
    assert len(selection.elements) == 1
    assert window.selection_tools.layer.count == 4
    assert "4 vertices selected" in window.status.message
    shift_click(qtbot, window, 9)
    assert selection.vertices.tolist() == [8, 15, 16]
    assert window.editing.menu is None
    qtbot.mouseClick(window.canvas.plotter, Qt.MouseButton.LeftButton, pos=QPoint(4, 4))
    assert len(selection) == 0


def test_boxes_and_lassos_with_the_shift_key(qtbot, open_window, grid):
    window = open_window(grid)
    selection = window.document.selection
    drag(qtbot, window, (0.5, 0.5), (2.5, 2.5), modifier=SHIFT)
    assert selection.vertices.tolist() == [8, 9, 15, 16]
    drag(qtbot, window, (3.5, 0.5), (5.5, 1.5), modifier=SHIFT)
    assert selection.vertices.tolist() == [8, 9, 11, 12, 15, 16]
    selection.clear()
    drag(qtbot, window, (3.5, 3.4), (2.4, 1.5), (3.6, 1.5), modifier=LASSO)
    assert selection.vertices.tolist() == [17]
    assert window.selection_tools.band.outline == []
    assert window.document.history.cursor == 0


def test_the_tools_of_the_toolbar(qtbot, open_window, grid):
    window = open_window(grid)
    centre = window.canvas.viewport.centre
    press(qtbot, window, Qt.Key.Key_B)
    assert window.actions_by_id["tool.box"].isChecked()
    drag(qtbot, window, (0.5, 0.5), (1.5, 1.5))
    assert window.document.selection.vertices.tolist() == [8]
    drag(qtbot, window, (1.5, 0.5), (2.5, 1.5))
    assert window.document.selection.vertices.tolist() == [9]
    press(qtbot, window, Qt.Key.Key_B, SHIFT)
    drag(qtbot, window, (0.5, 0.5), (2.5, 0.5), (2.5, 1.5), (0.5, 1.5))
    assert window.document.selection.vertices.tolist() == [8, 9]
    assert window.canvas.viewport.centre == centre
    press(qtbot, window, Qt.Key.Key_Escape)
    assert window.selection_tools.tool == "edit"
    press(qtbot, window, Qt.Key.Key_Escape)
    assert len(window.document.selection) == 0


def test_select_by_degree_and_irregularity(qtbot, open_window, star):
    window = open_window(star)
    selection = window.document.selection
    window.actions_by_id["select.irregular"].trigger()
    assert selection.vertices.tolist() == np.flatnonzero(star.irregularity()).tolist()
    window.actions_by_id["select.degree_5"].trigger()
    assert selection.vertices.tolist() == np.flatnonzero(star.degree() == 5).tolist()
    press(qtbot, window, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    assert len(selection) == star.n_vertices
    assert window.actions_by_id["select.none"].isEnabled()
    press(qtbot, window, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier | SHIFT)
    assert len(selection) == 0
    assert not window.actions_by_id["select.none"].isEnabled()


def test_a_vertex_is_dragged_and_the_drag_undone(qtbot, open_window, grid):
    window = open_window(grid)
    centre = window.canvas.viewport.centre
    drag(qtbot, window, (2, 2), (2.2, 2.3), (2.4, 2.4), release=False)
    assert len(window.selection_tools.rubber.places) == 1
    assert grid.points[16].tolist() == [2.0, 2.0, 0.0]
    at = pixel(window, (2.4, 2.4))
    qtbot.mouseRelease(window.canvas.plotter, Qt.MouseButton.LeftButton, pos=at)
    assert grid.points[16, :2] == pytest.approx([2.4, 2.4], abs=0.02)
    assert [row.action for row in window.document.history] == ["move"]
    assert window.canvas.viewport.centre == centre
    window.document.undo()
    assert grid.points[16].tolist() == [2.0, 2.0, 0.0]


def test_boundary_vertices_stay_on_their_side(qtbot, open_window, grid):
    window = open_window(grid)
    drag(qtbot, window, (2, 0), (2.3, 0.8))
    assert grid.points[2, 1] == 0.0
    assert grid.points[2, 0] == pytest.approx(2.3, abs=0.02)


def test_a_vertex_beside_one_short_edge_is_dragged_and_dense_ones_pan(qtbot, open_window, grid):
    points = grid.points.copy()
    points[1, 0] = 0.1  # about eight pixels from the corner
    mesh = HalfEdgeMesh.from_elements(points, grid.elements())
    window = open_window(mesh)
    centre = window.canvas.viewport.centre
    drag(qtbot, window, (0.1, 0), (0.6, 0))
    assert mesh.points[1, 0] == pytest.approx(0.6, abs=0.02)
    assert window.canvas.viewport.centre == centre
    window.canvas.see(window.canvas.viewport.zoomed(0.1, 0, 0))
    drag(qtbot, window, (2, 2), (4, 4))
    assert len(window.document.history) == 1
    assert window.canvas.viewport.centre != centre


def test_dragging_fixed_vertices_shows_a_reason(qtbot, open_window, grid):
    window = open_window(grid)
    before = grid.points.copy()
    drag(qtbot, window, (0, 0), (0.3, 0.3))
    assert window.canvas.overlay.card.text == window.status.message == CORNER
    window.document.set_locked(16, True)
    qtbot.wait(50)
    drag(qtbot, window, (2, 2), (2.3, 2.3))
    assert window.status.message == LOCK
    assert np.array_equal(grid.points, before)


def test_inverted_elements_are_hatched_during_and_after_a_drag(qtbot, open_window, grid):
    window = open_window(grid)
    drag(qtbot, window, (2, 2), (3.4, 3.4), release=False)
    assert window.selection_tools.rubber.folded > 0
    qtbot.mouseRelease(
        window.canvas.plotter, Qt.MouseButton.LeftButton, pos=pixel(window, (3.4, 3.4))
    )
    assert "inverted" in window.status.message
    qtbot.waitUntil(lambda: window.inverted.layer.count > 0, timeout=WAIT)
    press(qtbot, window, Qt.Key.Key_U, Qt.KeyboardModifier.ControlModifier)
    assert window.status.message.startswith("Repaired")
    qtbot.waitUntil(lambda: window.inverted.layer.count == 0, timeout=WAIT)
    press(qtbot, window, Qt.Key.Key_U, Qt.KeyboardModifier.ControlModifier)
    assert window.status.message == "No element is inverted."


def test_escape_cancels_a_drag(qtbot, open_window, grid):
    window = open_window(grid)
    drag(qtbot, window, (2, 2), (2.4, 2.4), release=False)
    press(qtbot, window, Qt.Key.Key_Escape)
    qtbot.mouseRelease(
        window.canvas.plotter, Qt.MouseButton.LeftButton, pos=pixel(window, (2.4, 2.4))
    )
    assert window.document.history.cursor == 0
    assert len(window.selection_tools.rubber.places) == 0
    assert window.editing.menu is None


def test_an_edit_by_the_agent_cancels_a_drag(qtbot, open_window, grid):
    window = open_window(grid)
    drag(qtbot, window, (2, 2), (2.4, 2.4), release=False)
    window.document.submit("collapse", grid.halfedge(16, 17), "greedy")
    assert not window.canvas.mouse.dragging
    assert len(window.selection_tools.rubber.places) == 0
    qtbot.mouseRelease(
        window.canvas.plotter, Qt.MouseButton.LeftButton, pos=pixel(window, (2.4, 2.4))
    )
    assert window.document.history.cursor == 1


def test_a_selection_is_dragged_as_one(qtbot, open_window, grid):
    window = open_window(grid)
    window.document.selection.set([15, 16])
    drag(qtbot, window, (2, 2), (2.2, 2.2))
    assert grid.points[15, :2] == pytest.approx([1.2, 2.2], abs=0.02)
    assert window.document.history.cursor == 1


def test_the_menu_of_a_whole_selection(qtbot, open_window, grid):
    window = open_window(grid)
    window.document.selection.set([8, 9, 15, 16])
    menu = open_menu(qtbot, window, pixel(window, (1, 1)) + QPoint(1, 1))
    assert menu.actions()[0].text().startswith("4 vertices")
    entry(menu, "Locked").trigger()
    menu.close()
    assert np.flatnonzero(grid.locked()).tolist() == [8, 9, 15, 16]
    assert [row.title for row in window.document.history] == ["Lock, 4 vertices"]
    inside = beside(window, grid.halfedge(8, 9))
    menu = open_menu(qtbot, window, inside)  # anywhere in the region
    degrees = entry(menu, "Desired degree").menu()
    entry(degrees, "5").trigger()
    menu.close()
    assert grid.desired()[[8, 9, 15, 16]].tolist() == [5] * 4
    menu = open_menu(qtbot, window, inside)
    assert entry(menu, "Locked").isChecked()
    assert entry(menu, "Finish only this region").isEnabled() == (
        window.actions_by_id["agent.region"].isEnabled()
    )
    menu.close()


def test_menu_of_an_outdated_mesh_changes_nothing(qtbot, open_window, grid):
    window = open_window(grid)
    menu = open_menu(qtbot, window, pixel(window, grid.points[16]) + QPoint(1, 1))
    window.document.submit("collapse", grid.halfedge(9, 16), "greedy")
    window.document.submit("collapse", grid.halfedge(17, 24), "greedy")
    for text in ("Smooth here", "Locked", "Corner"):
        entry(menu, text).trigger()
        assert window.status.message == OUTDATED
    menu.close()
    assert window.document.history.cursor == 2


def test_the_menu_of_one_vertex_smooths_and_selects(qtbot, open_window, grid):
    window = open_window(grid)
    window.document.move(np.array([16]), np.array([[2.4, 2.3, 0.0]]))
    qtbot.wait(50)
    menu = open_menu(qtbot, window, pixel(window, grid.points[16]) + QPoint(1, 1))
    entry(menu, "Smooth here").trigger()
    menu.close()
    assert grid.points[16, :2] == pytest.approx([2.0, 2.0], abs=0.02)
    menu = open_menu(qtbot, window, pixel(window, grid.points[16]) + QPoint(1, 1))
    entry(menu, "Add to selection").trigger()
    menu.close()
    assert 16 in window.document.selection


def test_drag_over_small_elements_pans(qtbot, open_window, grid):
    window = open_window(grid)
    for _ in range(12):
        press(qtbot, window, Qt.Key.Key_Minus)
    centre = window.canvas.viewport.centre
    start = pixel(window, (2, 2))
    qtbot.mousePress(window.canvas.plotter, Qt.MouseButton.LeftButton, pos=start)
    for step in (8, 16, 30):
        qtbot.mouseMove(window.canvas.plotter, start + QPoint(step, 0))
    qtbot.mouseRelease(window.canvas.plotter, Qt.MouseButton.LeftButton, pos=start + QPoint(30, 0))
    assert window.canvas.viewport.centre != centre
    assert window.document.history.cursor == 0
