"""Previews, changes of s, armed operations and navigation, by real mouse and keys."""

import numpy as np
import pytest
from driving import WAIT, beside, find, pixel, point_at, press
from qtpy.QtCore import QPoint, Qt

from meshwright.desktop.editing import hover_controller
from meshwright.document.operation_preview import best, choices
from meshwright_core import HalfEdgeMesh


def click_at(qtbot, window, halfedge, button=Qt.MouseButton.LeftButton):
    point_at(qtbot, window, halfedge)
    qtbot.mouseClick(window.canvas.plotter, button, pos=beside(window, halfedge))


def row_of(window, operation):
    return next(r for r in window.hover.panel.rows if r.info.operation == operation)


@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_hover_shows_what_each_operation_would_change(qtbot, open_window, kind, star, triangles):
    mesh = star if kind == "quad" else triangles
    window = open_window(mesh)
    halfedge = find(mesh, "collapse")
    before = mesh.elements()
    point_at(qtbot, window, halfedge)
    for choice in choices(mesh, halfedge):
        row = row_of(window, choice.operation)
        assert row.allowed == choice.allowed
        if choice.allowed:
            edit = mesh.apply(choice.operation, halfedge)
            mesh.undo()
            assert row.change in (f"+{edit.score_change}", f"\u2212{-edit.score_change}", "0")
        else:
            assert choice.verdict.reason in row.toolTip()
    ghost = window.hover.layer.ghost
    assert ghost.operation == best(choices(mesh, halfedge)).operation
    assert window.hover.layer.numbers.text.startswith(window.hover.current.info.title)
    assert np.array_equal(mesh.elements(), before)
    assert not window.document.can_undo
    qtbot.mouseMove(window.canvas.plotter, QPoint(3, 3))
    qtbot.waitUntil(lambda: window.hover.layer.ghost is None, timeout=WAIT)
    assert {row.change for row in window.hover.panel.rows} == {""}


def test_key_t_cycles_allowed_operations_and_return_applies_one(qtbot, open_window, star):
    window = open_window(star)
    halfedge = next(h for h in range(96) if sum(c.allowed for c in choices(star, h)) > 3)
    point_at(qtbot, window, halfedge)
    met = [window.hover.layer.ghost.operation]
    for _ in range(2):
        press(qtbot, window, Qt.Key.Key_T)
        met.append(window.hover.layer.ghost.operation)
    assert len(set(met)) == 3
    press(qtbot, window, Qt.Key.Key_T, Qt.KeyboardModifier.ShiftModifier)
    assert window.hover.layer.ghost.operation == met[1]
    change = window.hover.layer.ghost.change
    press(qtbot, window, Qt.Key.Key_Return)
    row = window.document.history.last
    assert (row.action, row.change, row.halfedge) == (met[1].value, change, halfedge)


def test_choice_by_key_is_for_one_half_edge_only(qtbot, open_window, star):
    window = open_window(star)
    first = find(star, "collapse")
    second = next(h for h in range(first + 1, 96) if best(choices(star, h)))
    point_at(qtbot, window, first)
    press(qtbot, window, Qt.Key.Key_T)
    point_at(qtbot, window, second)
    meant = window.hover.current.operation
    assert meant == best(choices(star, second)).operation


def test_click_applies_the_armed_operation(qtbot, open_window, star):
    window = open_window(star)
    row = row_of(window, "split")
    qtbot.mouseClick(row, Qt.MouseButton.LeftButton)
    assert row.isChecked()
    halfedge = find(star, "split")
    click_at(qtbot, window, halfedge)
    assert window.editing.menu is None
    assert [r.action for r in window.document.history] == ["split"]
    refusing = find(star, "split", allowed=False)
    click_at(qtbot, window, refusing)
    assert window.editing.menu is None
    assert window.document.history.cursor == 1
    assert window.canvas.overlay.card.warning
    qtbot.mouseClick(row, Qt.MouseButton.LeftButton)
    assert not row.isChecked()
    click_at(qtbot, window, find(star, "flip_left"))
    assert window.editing.menu is not None
    window.editing.menu.close()


def test_escape_disarms_the_operation(qtbot, open_window, star):
    window = open_window(star)
    qtbot.mouseClick(row_of(window, "collapse"), Qt.MouseButton.LeftButton)
    press(qtbot, window, Qt.Key.Key_Escape)
    assert window.hover.armed is None
    assert not any(row.isChecked() for row in window.hover.panel.rows)


def test_menu_row_previews_its_operation(qtbot, open_window, star):
    window = open_window(star)
    halfedge = find(star, "collapse")
    click_at(qtbot, window, halfedge)
    menu = window.editing.menu
    for row in menu.rows:
        choice = next(c for c in choices(star, halfedge) if c.operation == row.info.operation)
        assert bool(row.change) == choice.allowed
        qtbot.mouseMove(row, QPoint(20, 8))
        row.enterEvent(None)
        ghost = window.hover.layer.ghost
        assert (ghost is not None and ghost.operation == row.info.operation) or not row.allowed
    menu.close()
    assert window.document.history.cursor == 0


def test_preview_of_a_global_split_reaches_the_boundary(qtbot, open_window, star):
    window = open_window(star)
    halfedge = find(star, "global_split")
    point_at(qtbot, window, halfedge)
    qtbot.mouseClick(row_of(window, "global_split"), Qt.MouseButton.LeftButton)
    point_at(qtbot, window, halfedge)
    seen = {tuple(np.round(p, 9)) for p in window.hover.layer.ghost.added.reshape(-1, 2)}
    edit = window.document.mesh.apply("global_split", halfedge)
    ends = {tuple(np.round(star.points[v, :2], 9)) for v in edit.new_vertices}
    star.undo()
    assert ends <= seen


def test_previews_can_be_switched_off(qtbot, open_window, star):
    window = open_window(star)
    point_at(qtbot, window, find(star, "collapse"))
    assert window.hover.layer.ghost is not None
    press(qtbot, window, Qt.Key.Key_G, Qt.KeyboardModifier.ControlModifier)
    assert window.hover.layer.ghost is None
    assert row_of(window, "collapse").change
    press(qtbot, window, Qt.Key.Key_G, Qt.KeyboardModifier.ControlModifier)
    assert window.hover.layer.ghost is not None


def test_global_preview_in_a_large_mesh_waits_for_a_resting_mouse(
    qtbot, open_window, monkeypatch, grid
):
    monkeypatch.setattr(hover_controller, "LARGE", 4)
    window = open_window(grid)
    window.hover.arm("cleanup")
    point_at(qtbot, window, grid.halfedge(8, 15))
    assert window.hover.layer.ghost is None
    qtbot.waitUntil(lambda: window.hover.layer.ghost is not None, timeout=WAIT)
    assert window.hover.layer.ghost.operation == "cleanup"


@pytest.fixture
def grid() -> HalfEdgeMesh:
    """Six by four unit quads; vertex i + 7 j at (i, j)."""
    points = np.array([(i, j) for j in range(5) for i in range(7)], float)
    corners = [i + 7 * j for j in range(4) for i in range(6)]
    return HalfEdgeMesh.from_elements(points, [(c, c + 1, c + 8, c + 7) for c in corners])


def test_click_removes_a_highlighted_line(qtbot, open_window, grid):
    window = open_window(grid)
    press(qtbot, window, Qt.Key.Key_L)
    assert window.lines.layer.count == 8
    halfedge = grid.halfedge(10, 17)
    middle = pixel(window, grid.points[[10, 17]].mean(axis=0)) - QPoint(2, 0)
    qtbot.mouseMove(window.canvas.plotter, middle + QPoint(20, 0))
    qtbot.mouseMove(window.canvas.plotter, middle)
    qtbot.waitUntil(lambda: window.document.hover in (halfedge, grid.twin(halfedge)), timeout=WAIT)
    assert window.lines.layer.current >= 0
    qtbot.mouseClick(window.canvas.plotter, Qt.MouseButton.LeftButton, pos=middle)
    assert window.document.history.last.action == "cleanup"
    assert grid.n_elements == 20
    qtbot.waitUntil(lambda: window.lines.layer.count == 7, timeout=WAIT)
    qtbot.mouseMove(window.canvas.plotter, QPoint(3, 3))
    press(qtbot, window, Qt.Key.Key_L, Qt.KeyboardModifier.ControlModifier)
    assert grid.n_elements == 1
    qtbot.waitUntil(lambda: window.lines.layer.count == 0, timeout=WAIT)
    press(qtbot, window, Qt.Key.Key_L)
    assert not window.lines.shown


def test_keys_move_the_view(qtbot, open_window, star):
    window = open_window(star)
    canvas = window.canvas
    x, y = canvas.viewport.centre
    press(qtbot, window, Qt.Key.Key_Right)
    press(qtbot, window, Qt.Key.Key_Up)
    assert canvas.viewport.centre[0] > x and canvas.viewport.centre[1] > y
    press(qtbot, window, Qt.Key.Key_Left)
    press(qtbot, window, Qt.Key.Key_Down)
    assert canvas.viewport.centre == pytest.approx((x, y))
    pixels = canvas.viewport.pixels
    press(qtbot, window, Qt.Key.Key_Plus)
    assert canvas.viewport.pixels == pytest.approx(1.25 * pixels)
    press(qtbot, window, Qt.Key.Key_Minus)
    assert canvas.viewport.pixels == pytest.approx(pixels)


def test_key_cycles_through_irregular_vertices(qtbot, open_window, star):
    window = open_window(star)
    irregular = set(np.flatnonzero(star.irregularity()).tolist())
    met = []
    for _ in range(len(irregular)):
        press(qtbot, window, Qt.Key.Key_N)
        met.append(star.origin(window.document.hover))
        at = window.canvas.viewport.to_screen(star.points[met[-1]])
        assert np.all(at > 0) and np.all(at < window.canvas.viewport.size)
    assert set(met) == irregular
    press(qtbot, window, Qt.Key.Key_N, Qt.KeyboardModifier.ShiftModifier)
    assert star.origin(window.document.hover) == met[-2]
    assert window.hover.layer.ghost is not None


def test_the_mesh_is_edited_without_a_mouse(qtbot, open_window, star):
    window = open_window(star)
    press(qtbot, window, Qt.Key.Key_N)
    first = window.document.hover
    press(qtbot, window, Qt.Key.Key_E)
    assert star.origin(window.document.hover) == star.origin(first)
    assert window.document.hover != first
    press(qtbot, window, Qt.Key.Key_E, Qt.KeyboardModifier.ShiftModifier)
    press(qtbot, window, Qt.Key.Key_D)
    assert window.document.hover == star.next(first)
    while star.twin(window.document.hover) < 0:
        press(qtbot, window, Qt.Key.Key_D)
    pointed = window.document.hover
    press(qtbot, window, Qt.Key.Key_Q)
    assert window.document.hover == star.twin(pointed)
    cursor = window.document.history.cursor
    press(qtbot, window, Qt.Key.Key_Return)
    assert window.document.history.cursor == cursor + 1
