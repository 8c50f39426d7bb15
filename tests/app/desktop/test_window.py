"""The window, driven by real mouse and key events."""

import subprocess
import sys

import numpy as np
import pytest
from driving import WAIT, beside, find, pixel, point_at, press
from qtpy.QtCore import QPoint, Qt, QTimer
from qtpy.QtGui import QColor, QWheelEvent
from qtpy.QtWidgets import QApplication, QWidget

from meshwright.assistant.assistant import State
from meshwright.desktop.actions import registry
from meshwright.desktop.application.readiness import PREPARING
from meshwright.desktop.editing.edit_controller import POINT_FIRST
from meshwright.desktop.main_window.window import MainWindow
from meshwright.document.document import Document
from meshwright_core.operations.catalogue import of_kind


@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_hover_finds_every_half_edge(qtbot, open_window, kind, star, triangles):
    mesh = star if kind == "quad" else triangles
    window = open_window(mesh)
    for halfedge in range(0, mesh.k * mesh.n_elements, 7):
        point_at(qtbot, window, halfedge)
        assert str(mesh.origin(halfedge)) in window.status.halfedge
    qtbot.mouseMove(window.canvas.plotter, QPoint(3, 3))
    qtbot.waitUntil(lambda: window.document.hover == -1, timeout=WAIT)
    assert window.status.halfedge == ""


def test_key_applies_an_operation_and_ctrl_z_undoes_it(qtbot, open_window, star):
    window = open_window(star)
    elements = star.elements()
    halfedge = find(star, "flip_left")
    point_at(qtbot, window, halfedge)
    press(qtbot, window, Qt.Key.Key_F)
    assert [row.action for row in window.document.history] == ["flip_left"]
    assert not np.array_equal(star.elements(), elements)
    assert window.status.message.startswith("Flip left:  s 12")
    assert window.isWindowModified()
    press(qtbot, window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert np.array_equal(star.elements(), elements)
    assert not window.document.can_undo
    assert not window.document.mesh_modified
    assert window.isWindowModified()  # closing would lose the step that can be redone
    press(
        qtbot,
        window,
        Qt.Key.Key_Z,
        Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier,
    )
    assert window.document.history.cursor == 1


def test_every_operation_of_a_kind_has_its_own_key():
    for kind in ("tri", "quad"):
        shortcuts = [
            keys
            for action in registry.ACTIONS
            for keys in action.shortcuts
            if not action.id.startswith({"tri": "quad.", "quad": "tri."}[kind])
        ]
        assert len(set(shortcuts)) == len(shortcuts)
    assert len({action.id for action in registry.ACTIONS}) == len(registry.ACTIONS)
    used = {name for group in registry.TOOLBAR for name in group}
    assert used <= {action.id for action in registry.ACTIONS if action.icon}
    assert {action.menu for action in registry.ACTIONS} <= set(registry.MENUS)


def test_a_refused_key_shows_the_reason(qtbot, open_window, star):
    window = open_window(star)
    halfedge = find(star, "flip_left", allowed=False)
    point_at(qtbot, window, halfedge)
    press(qtbot, window, Qt.Key.Key_F)
    reason = star.check("flip_left", halfedge).reason
    assert window.status.message.lower() == f"{reason.lower()}."
    assert window.canvas.overlay.card.text == window.status.message
    assert window.document.history.cursor == 0


def test_operation_key_without_a_half_edge_shows_a_message(qtbot, open_window, star):
    window = open_window(star)
    qtbot.mouseMove(window.canvas.plotter, QPoint(4, 4))
    press(qtbot, window, Qt.Key.Key_F)
    assert window.status.message == POINT_FIRST


def test_click_opens_the_menu_with_reasons(qtbot, open_window, star):
    window = open_window(star)
    boundary = next(h for h in range(star.k * star.n_elements) if star.twin(h) < 0)
    point_at(qtbot, window, boundary)
    qtbot.mouseClick(window.canvas.plotter, Qt.MouseButton.LeftButton, pos=beside(window, boundary))
    menu = window.editing.menu
    assert menu.isVisible()
    assert [row.info for row in menu.rows] == list(of_kind("quad"))
    for row in menu.rows:
        verdict = star.check(row.info.operation, boundary)
        assert row.allowed == bool(verdict)
        assert row.reason == verdict.reason
    refused = next(row for row in menu.rows if not row.allowed)
    qtbot.mouseClick(refused, Qt.MouseButton.LeftButton)
    assert menu.isVisible()
    assert window.document.history.cursor == 0
    allowed = next(row for row in menu.rows if row.allowed)
    qtbot.mouseClick(allowed, Qt.MouseButton.LeftButton)
    assert window.document.history.last.action == allowed.info.operation.value
    assert window.editing.menu is None


def test_the_menu_by_keyboard(qtbot, open_window, star):
    window = open_window(star)
    halfedge = find(star, "flip_left")
    for key in (Qt.Key.Key_R, Qt.Key.Key_Return):
        point_at(qtbot, window, halfedge)
        qtbot.mouseClick(
            window.canvas.plotter, Qt.MouseButton.LeftButton, pos=beside(window, halfedge)
        )
        menu, cursor = window.editing.menu, window.document.history.cursor
        if key == Qt.Key.Key_Return:
            qtbot.keyClick(menu, Qt.Key.Key_Down)
        qtbot.keyClick(menu, key)
        assert window.document.history.cursor == cursor + 1
        window.document.undo()
        qtbot.waitUntil(lambda: not window.editing.menu, timeout=WAIT)


def test_hover_over_an_irregular_vertex_shows_its_degree(qtbot, open_window, star):
    window = open_window(star)
    vertex = int(np.flatnonzero(star.irregularity() == 2)[0])
    qtbot.mouseMove(window.canvas.plotter, pixel(window, star.points[vertex]) + QPoint(2, 2))
    qtbot.waitUntil(lambda: "Degree" in window.canvas.overlay.card.text, timeout=WAIT)
    assert window.canvas.overlay.card.text.endswith("+2")


def test_wheel_zooms_at_the_mouse_drag_pans_and_home_fits(qtbot, open_window, star):
    window = open_window(star)
    canvas = window.canvas
    fitted = canvas.viewport
    at = QPoint(200, 150)
    plane = canvas.viewport.to_plane(200, 150)
    event = QWheelEvent(
        at.toPointF(),
        canvas.plotter.mapToGlobal(at).toPointF(),
        QPoint(),
        QPoint(0, 240),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(canvas.plotter, event)
    assert canvas.viewport.pixels > fitted.pixels
    assert np.allclose(canvas.viewport.to_plane(200, 150), plane)
    centre = canvas.viewport.centre
    qtbot.mousePress(canvas.plotter, Qt.MouseButton.LeftButton, pos=at)
    for step in range(1, 5):
        qtbot.mouseMove(canvas.plotter, at + QPoint(10 * step, 0))
    qtbot.mouseRelease(canvas.plotter, Qt.MouseButton.LeftButton, pos=at + QPoint(40, 0))
    assert canvas.viewport.centre[0] == pytest.approx(centre[0] - 40 / canvas.viewport.pixels)
    assert window.editing.menu is None
    press(qtbot, window, Qt.Key.Key_Home)
    assert canvas.viewport == fitted


def test_step_play_pause_complete(qtbot, open_window, star):
    window = open_window(star)
    panel, document = window.agent_panel, window.document
    qtbot.mouseClick(panel.step, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: document.history.cursor == 1, timeout=WAIT)
    panel.speed.setValue(panel.speed.maximum())
    press(qtbot, window, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: document.history.cursor >= 3, timeout=WAIT)
    press(qtbot, window, Qt.Key.Key_Space)
    assert window.assistant.state in (State.PAUSED, State.IDLE)
    kept = document.history.cursor
    assert kept >= 3
    qtbot.mouseClick(panel.complete, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not window.assistant.running, timeout=WAIT)
    assert document.at_optimum
    assert window.quality.score.optimal.isVisible()
    assert window.quality.score.gained.text == "1.00"
    assert "optimum" in window.status.message
    star.validate()


def test_escape_stops_and_an_edit_takes_over(qtbot, open_window, star):
    window = open_window(star, bad_steps=500, longest=500)
    window.assistant.speed = 30
    press(qtbot, window, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: window.document.history.cursor >= 2, timeout=WAIT)
    press(qtbot, window, Qt.Key.Key_Escape)
    assert window.assistant.state is State.IDLE
    press(qtbot, window, Qt.Key.Key_Space)
    cursor = window.document.history.cursor
    qtbot.waitUntil(lambda: window.document.history.cursor > cursor, timeout=WAIT)
    press(qtbot, window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert window.assistant.state is State.IDLE
    assert window.document.can_redo


def test_window_closes_during_a_run(qtbot, open_window, star):
    window = open_window(star, bad_steps=500, longest=500)
    window.assistant.play()
    qtbot.waitUntil(lambda: window.document.history.cursor >= 1, timeout=WAIT)
    assert window.assistant.running
    window.close()
    assert not window.assistant.running


def test_operations_show_a_message_until_kernels_are_ready(qtbot, open_window, star, monkeypatch):
    monkeypatch.setattr(
        "meshwright.desktop.application.kernel_warmup.KernelWarmup.start", lambda self: None
    )
    window = open_window(star, ready=False)
    halfedge = find(star, "flip_left")
    point_at(qtbot, window, halfedge)
    press(qtbot, window, Qt.Key.Key_F)
    assert window.status.message == PREPARING
    assert not window.agent_panel.step.isEnabled()
    window.readiness.editing = True
    assert not window.agent_panel.step.isEnabled()
    window.readiness.agent = True
    assert window.agent_panel.step.isEnabled()
    press(qtbot, window, Qt.Key.Key_F)
    assert window.document.history.cursor == 1


def test_kernels_are_loaded_after_the_window_opens(qtbot, open_window, star):
    window = open_window(star, ready=False)
    qtbot.waitUntil(lambda: window.readiness.editing, timeout=60_000)
    assert window.status.preparation == ""


def test_invalid_file_is_reported_in_one_sentence(qtbot, open_window, star, tmp_path):
    window = open_window(star)
    broken = tmp_path / "broken.vtk"
    broken.write_text("this is no mesh")
    for path in (broken, tmp_path / "missing.vtk"):
        window.files.open(path)
        text = window.notice.text
        assert path.name in text
        assert "Traceback" not in text
        assert "\n" not in text
    assert window.document.mesh is star
    qtbot.mouseClick(window.notice._close, Qt.MouseButton.LeftButton)
    assert window.notice.text == ""


def test_empty_state_and_a_shape_from_the_gallery(qtbot, open_window):
    window = open_window()
    assert window.pages.currentWidget() is window.empty
    assert not window.agent_panel.step.isEnabled()
    dialog_seen = []

    def choose():
        dialog = QApplication.activeModalWidget()
        dialog_seen.append(dialog.gallery.shapes.count())
        dialog.options.kind.buttons["tri"].click()
        dialog.accept()

    QTimer.singleShot(300, choose)
    press_on = window.empty.findChildren(QWidget, "Primary")[0]
    qtbot.mouseClick(press_on, Qt.MouseButton.LeftButton)
    assert dialog_seen[0] >= 15
    assert window.document.kind == "tri"
    assert window.pages.currentWidget() is window.canvas


def test_desired_degree_from_the_menu_of_a_vertex(qtbot, open_window, star):
    window = open_window(star)
    vertex = int(np.flatnonzero(star.irregularity() == -1)[0])
    where = pixel(window, star.points[vertex]) + QPoint(2, 1)
    qtbot.mouseMove(window.canvas.plotter, where)
    qtbot.mouseClick(window.canvas.plotter, Qt.MouseButton.RightButton, pos=where)
    menu = QApplication.activePopupWidget()
    assert str(vertex) in menu.actions()[0].text()
    degrees = menu.actions()[2].menu()
    next(a for a in degrees.actions() if a.text() == "3").trigger()
    menu.close()
    assert star.irregularity()[vertex] == 0
    assert window.document.history.last.title == "Desired degree"


def test_themes(qtbot, open_window, star):
    window = open_window(star)
    colours = []
    for _ in range(2):
        image = window.grab().toImage()
        colours.append(image.pixelColor(5, image.height() - 200).lightness())
        press(qtbot, window, Qt.Key.Key_T, Qt.KeyboardModifier.ControlModifier)
    assert colours[0] > 200
    assert colours[1] < 60
    assert window.theme.name == "light"


def test_the_mesh_is_drawn(qtbot, open_window, star):
    window = open_window(star)

    def is_painted(point, wanted):
        place = window.canvas.plotter.mapTo(window, point)
        seen, named = window.grab().toImage().pixelColor(place), QColor(wanted)
        pairs = zip(seen.getRgb(), named.getRgb(), strict=True)
        return max(abs(a - b) for a, b in pairs) <= 8  # a screen may have 16 bits

    plus = int(np.flatnonzero(star.irregularity() == 2)[0])
    spot = pixel(window, star.points[plus]) + QPoint(-9, 5)
    inside = pixel(window, star.points[star.elements()[0]].mean(axis=0))
    qtbot.waitUntil(lambda: is_painted(QPoint(6, 6), window.theme.background), timeout=WAIT)
    qtbot.waitUntil(lambda: is_painted(inside, window.theme.fill), timeout=WAIT)
    assert is_painted(spot, window.theme.plus)


def test_qt_calls_keep_the_reference_count_of_none(qtbot):
    """A release of PySide6 lost one reference of None per call and died after some thousands."""
    code = (
        "from PySide6.QtWidgets import QApplication, QWidget\n"
        "app = QApplication(['', '-platform', 'offscreen']); w = QWidget()\n"
        "[w.update() for _ in range(100000)]\n"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0


@pytest.mark.usefixtures("_application")
def test_native_window_stays_the_same_when_the_canvas_is_built(qtbot):
    """Clicks on a native window that Qt replaces are lost."""
    window = MainWindow(Document(), ready=True)
    qtbot.addWidget(window)
    window.show()
    assert not window.canvas.built
    shown = int(window.winId())
    with qtbot.waitSignal(window.opened, timeout=WAIT):
        pass
    assert int(window.winId()) == shown
    window.close()
