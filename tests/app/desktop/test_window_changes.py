"""What a step has changed is marked; quality beside each operation; menus in groups; the tour."""

import numpy as np
import pytest
from driving import WAIT, beside, find, point_at, press
from qtpy.QtCore import QPoint, Qt

from meshwright.assistant.assistant import State
from meshwright.desktop.actions import registry
from meshwright.desktop.help.tour import STEPS
from meshwright.document.shape_change import shape_change
from meshwright.graphics.picking import Picker
from meshwright_core.geometry import quality

NONE = Qt.KeyboardModifier.NoModifier


def test_step_marks_the_edges_that_it_has_changed(qtbot, open_window, star):
    window = open_window(star)
    layer = window.changes.layer
    press(qtbot, window, Qt.Key.Key_Period)
    qtbot.waitUntil(lambda: window.document.history.cursor == 1, timeout=WAIT)
    qtbot.waitUntil(lambda: len(layer.added) > 0, timeout=WAIT)
    ends = layer.added.reshape(-1, 2)
    places = star.points[star.vertices(), :2]
    assert all(np.isclose(places, end).all(axis=1).any() for end in ends)
    press(qtbot, window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: not len(layer.added) and not len(layer.removed), timeout=WAIT)


def test_an_own_edit_is_not_marked_but_shown_under_the_mouse_in_the_history(
    qtbot, open_window, star
):
    window = open_window(star)
    point_at(qtbot, window, find(star, "flip_left"))
    press(qtbot, window, Qt.Key.Key_F)
    layer, table = window.changes.layer, window.playback.panel.list
    qtbot.waitUntil(lambda: table.model().rowCount() == 2, timeout=WAIT)
    assert not len(layer.added)
    line = table.visualRect(table.model().index(1, 0)).center()
    qtbot.mouseMove(table.viewport(), line - QPoint(3, 0))
    qtbot.mouseMove(table.viewport(), line)
    qtbot.waitUntil(lambda: len(layer.added) == 1 and len(layer.removed) == 1, timeout=WAIT)


@pytest.mark.parametrize("operation", ["flip_left", "split", "collapse"])
def test_change_of_shape_is_what_the_operation_then_does(star, operation):
    from meshwright.document.document import Document

    before = star.elements().copy(), star.points.copy(), star.steps
    halfedge = find(star, operation)
    told = shape_change(star, operation, halfedge)
    assert np.array_equal(star.elements(), before[0]) and star.steps == before[2]
    assert np.array_equal(star.points, before[1])
    document = Document(star.copy())
    edit = document.submit(operation, halfedge, thorough=False)
    there = [v for v in edit.touched if v < len(before[1]) and star.degree()[v] > 0]
    assert -2.0 <= told <= 2.0 and there
    whole = quality.scaled_jacobian(document.mesh).min() - quality.scaled_jacobian(star).min()
    assert told <= whole + 1e-9 or told >= 0 or whole >= 0


def test_rows_show_the_change_of_shape_once_the_mouse_rests(qtbot, open_window, star):
    window = open_window(star)
    halfedge = find(star, "flip_left")
    point_at(qtbot, window, halfedge)
    row = next(row for row in window.hover.panel.rows if row.info.operation.value == "flip_left")
    qtbot.waitUntil(lambda: row.shape != "", timeout=WAIT)
    told = shape_change(star, row.info.operation, halfedge)
    assert row.shape[-3:] == f"{abs(told):.2f}"[-3:]
    assert window.document.history.cursor == 0 and not window.document.can_redo


def test_menus_have_groups(open_window, star):
    window = open_window(star)
    known = {action.id for action in registry.ACTIONS}
    assert known >= registry.DIVIDERS
    for menu in window.menuBar().actions():
        entries = menu.menu().actions()
        assert not entries[0].isSeparator() and not entries[-1].isSeparator()
        if len(entries) > 6:
            assert any(entry.isSeparator() for entry in entries), menu.text()


def test_the_preference_is_kept_and_passed_to_the_search(qtbot, open_window, star):
    window = open_window(star)
    panel, efforts = window.agent_panel, []
    window.assistant.search = efforts.append
    assert panel.preference == "balanced"
    panel.prefer.setFocus()
    qtbot.keyClick(panel.prefer, Qt.Key.Key_Right)
    assert panel.preferred.text() == "Good shape"
    qtbot.mouseClick(panel.complete, Qt.MouseButton.LeftButton)
    assert efforts[0].prefer == "shape" and efforts[0].until_done
    assert open_window(star.copy()).agent_panel.preference == "shape"


def test_keep_the_size_is_switched_by_mouse_and_keys_kept_and_passed_on(qtbot, open_window, star):
    window = open_window(star)
    panel, efforts = window.agent_panel, []
    window.assistant.search = efforts.append

    def switched() -> bool:
        qtbot.mouseClick(panel.complete, Qt.MouseButton.LeftButton)
        qtbot.mouseClick(panel.search, Qt.MouseButton.LeftButton)
        first, second = efforts[-2:]
        assert first.keep_size == second.keep_size == panel.keep_size.isChecked()
        return first.keep_size

    assert not switched()
    qtbot.mouseClick(panel.keep_size, Qt.MouseButton.LeftButton, pos=QPoint(8, 8))
    assert switched()
    assert open_window(star.copy()).agent_panel.keep_size.isChecked()
    window.activateWindow()
    qtbot.waitUntil(window.isActiveWindow, timeout=WAIT)
    panel.keep_size.setFocus()
    qtbot.keyClick(panel.keep_size, Qt.Key.Key_Space)
    assert not switched()


def test_complete_score_and_shape_are_in_sight_at_880_pixels(qtbot, open_window, star):
    window = open_window(star)
    window.resize(1100, 880)
    qtbot.waitUntil(lambda: window.height() == 880, timeout=WAIT)
    for part in (
        window.agent_panel.complete,
        window.agent_panel.prefer,
        window.quality.score.score,
        window.quality.score.shape,
    ):
        low = part.mapTo(window, QPoint(0, part.height())).y()
        assert not part.visibleRegion().isEmpty() and low < 850


def test_a_result_is_gone_to_with_a_bar_and_skipped_by_a_click(
    qtbot, open_window, star, monkeypatch
):
    from meshwright.assistant import result_walk

    monkeypatch.setattr(result_walk, "SLICE", -1.0)
    monkeypatch.setattr(result_walk, "LONGEST", -1.0)
    window = open_window(star)
    panel = window.agent_panel
    assert not panel.skip.isVisible()
    qtbot.mouseClick(panel.complete, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: window.assistant.state is State.GOING, timeout=WAIT)
    assert panel.progress.text().startswith("Going there: ") and panel.bar.isVisible()
    qtbot.mouseClick(panel.skip, Qt.MouseButton.LeftButton)
    assert window.assistant.state is State.IDLE and window.document.at_optimum
    assert not panel.skip.isVisible()


def test_taking_over_on_the_way_to_a_result_keeps_the_hover(qtbot, open_window, star, monkeypatch):
    from meshwright.assistant import result_walk

    monkeypatch.setattr(result_walk, "SLICE", -1.0)
    monkeypatch.setattr(result_walk, "LONGEST", -1.0)
    window = open_window(star)
    document, canvas = window.document, window.canvas
    halfedge = find(star, "flip_left")
    point_at(qtbot, window, halfedge)
    mouse = beside(window, halfedge)

    def hovered() -> bool:
        edges = Picker(star, canvas.edges)
        return document.hover == edges.halfedge(*canvas.viewport.to_plane(mouse.x(), mouse.y()))

    press(qtbot, window, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: window.assistant.state is State.GOING, timeout=WAIT)
    qtbot.waitUntil(lambda: document.history.cursor >= 1, timeout=WAIT)
    before = document.hover
    assert before >= 0 and not document.at_optimum
    press(qtbot, window, Qt.Key.Key_F)
    assert window.assistant.state is State.IDLE
    assert document.history.last.by == "you" and document.history.last.halfedge == before
    qtbot.waitUntil(hovered, timeout=WAIT)
    assert document.hover >= 0
    qtbot.waitUntil(lambda: any(row.change for row in window.hover.panel.rows), timeout=WAIT)


def test_the_panel_asks_to_go_on(qtbot, open_window, star):
    window = open_window(star, longest=1)
    panel = window.agent_panel
    qtbot.mouseClick(panel.complete, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not window.assistant.running, timeout=WAIT)
    assert "above the optimum: go on?" in panel.progress.text()
    assert panel.complete.text() == "Go on"
    press(qtbot, window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert panel.complete.text() == "Complete"


def test_the_badge_warns_of_what_is_not_in_order(qtbot, open_window, strip):
    window = open_window(strip)
    badge = window.quality.score.optimal
    qtbot.waitUntil(lambda: window.quality.monitor.fresh, timeout=WAIT)
    assert not badge.warns and badge.isVisible()
    assert "of at most" in badge.lines[0].text()
    assert badge.lines[1].text() == "Nothing inverted"
    assert badge.lines[2].text() == "Largest |\u0394| 0"
    side = np.flatnonzero(strip.boundary() & ~strip.geometric() & (strip.degree() > 0))[:1]
    window.document.move(side, strip.points[side] + (1.5, 0.0, 0.0))
    qtbot.waitUntil(lambda: window.quality.monitor.fresh, timeout=WAIT)
    assert badge.warns
    assert badge.lines[0].text().startswith("\u26a0") and "inverted" in badge.lines[1].text()


def test_the_tour_loads_a_shape_and_covers_nothing_that_it_points_at(qtbot, open_window):
    window = open_window()
    window.actions_by_id["tour"].trigger()
    assert window.document.name == "star" and window.help.tour is not None
    for size in ((880, 560), (1280, 800)):
        window.resize(*size)
        qtbot.waitUntil(lambda s=size: (window.width(), window.height()) == s, timeout=WAIT)
        window.help.show_tour()
        for number, step in enumerate(STEPS):
            assert window.help.tour.at == number
            target = step.target(window.help.places)
            callout = window.help.tour.callout
            assert target is not None and not callout.geometry().intersects(target), step.heading
            qtbot.mouseClick(callout.next, Qt.MouseButton.LeftButton)
        assert window.help.tour is None
