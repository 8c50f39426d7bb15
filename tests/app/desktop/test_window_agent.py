"""The agent in the window: hints, what it sees, regions, progress, policy files."""

import json

import numpy as np
import pytest
from driving import WAIT, point_at, press
from qtpy.QtCore import QPoint, Qt
from qtpy.QtWidgets import QFileDialog

from meshwright.assistant.assistant import State
from meshwright_core.geometry.movable_part import rings


def hinted(qtbot, window):
    press(qtbot, window, Qt.Key.Key_H)
    qtbot.waitUntil(lambda: len(window.hints.shown) > 0, timeout=WAIT)
    return window.hints.shown


def middle_of(box) -> QPoint:
    return box.center().toPoint()


def test_hints_are_shown_as_previews_badges_and_rows(qtbot, open_window, star):
    window = open_window(star)
    hints = hinted(qtbot, window)
    layer = window.hints.layer
    assert [hint.number for hint in layer.hints] == list(range(1, len(hints) + 1))
    changes = [choice.change for choice in window.assistant.hinting.hints]
    assert [hint.ghost.change for hint in hints] == changes
    boxes = layer.badges.boxes
    assert not any(a.intersects(b) for i, a in enumerate(boxes) for b in boxes[:i])
    assert all(window.canvas.rect().contains(box.toRect()) for box in boxes)
    rows = [row for row in window.agent_panel.hints.rows if row.isVisibleTo(window)]
    assert len(rows) == len(hints) and "1" in rows[0].accessibleName()
    assert window.document.history.cursor == 0
    press(qtbot, window, Qt.Key.Key_H)
    assert not window.hints.shown and not window.agent_panel.hints.isVisibleTo(window)


def test_key_applies_a_hint_and_requests_the_next(qtbot, open_window, star):
    window = open_window(star)
    second = hinted(qtbot, window)[1]
    press(qtbot, window, Qt.Key.Key_2)
    row = window.document.history.last
    assert (row.halfedge, row.change, row.by) == (second.ghost.halfedge, second.ghost.change, "you")
    qtbot.waitUntil(lambda: len(window.hints.shown) > 0, timeout=WAIT)
    press(qtbot, window, Qt.Key.Key_Escape)
    assert not window.hints.shown
    assert not window.actions_by_id["agent.take_1"].isEnabled()


def test_click_on_a_badge_applies_its_hint(qtbot, open_window, star):
    window = open_window(star)
    hints = hinted(qtbot, window)
    layer = window.hints.layer
    at = middle_of(layer.badges.boxes[2])
    qtbot.mouseMove(window.canvas.plotter, at + QPoint(1, 0))
    qtbot.mouseMove(window.canvas.plotter, at)
    assert layer.meant == 2
    qtbot.mouseClick(window.canvas.plotter, Qt.MouseButton.LeftButton, pos=at)
    assert window.document.history.last.halfedge == hints[2].ghost.halfedge
    assert window.editing.menu is None


def test_click_on_a_panel_row_applies_its_hint(qtbot, open_window, star):
    window = open_window(star)
    hints = hinted(qtbot, window)
    qtbot.mouseClick(window.agent_panel.hints.rows[1], Qt.MouseButton.LeftButton)
    assert window.document.history.last.halfedge == hints[1].ghost.halfedge


def test_hints_disappear_when_the_mesh_changes(qtbot, open_window, star):
    window = open_window(star)
    hinted(qtbot, window)
    before = [box.center() for box in window.hints.layer.badges.boxes]
    window.canvas.see(window.canvas.viewport.panned(30, 0))
    after = [box.center() for box in window.hints.layer.badges.boxes]
    assert before != after
    window.document.set_locked(0, True)
    assert not window.hints.shown and not window.hints.layer.hints


def test_watching_shows_each_decision_in_advance(qtbot, open_window, star):
    window = open_window(star)
    press(qtbot, window, Qt.Key.Key_W)
    field = window.agent.field
    qtbot.waitUntil(lambda: field.sight is not None, timeout=WAIT)
    assert window.agent_panel.watch.isChecked()
    assert any("rates" in line for line in field.sight.words)
    for count in (1, 2):
        wanted = window.assistant.insight.wanted
        press(qtbot, window, Qt.Key.Key_Period)
        qtbot.waitUntil(lambda n=count: window.document.history.cursor == n, timeout=WAIT)
        assert window.document.history.last.halfedge == wanted.halfedge
        qtbot.waitUntil(lambda: field.sight is not None, timeout=WAIT)
    assert window.grab().width() == window.width()  # paint it
    press(qtbot, window, Qt.Key.Key_W)
    assert field.sight is None and not window.agent_panel.watch.isChecked()


def test_region_button_needs_a_selection_and_searches_in_it(qtbot, open_window, star):
    window = open_window(star)
    button = window.agent_panel.region
    assert not button.isEnabled()
    inner = np.flatnonzero(~star.boundary() & (star.degree() > 0))
    window.document.selection.set(rings(star, inner[:1], 1))
    assert button.isEnabled()
    efforts = []
    window.assistant.search = efforts.append
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)
    elements = window.document.selection.elements
    assert np.array_equal(efforts[0].elements, elements) and len(elements)
    assert efforts[0].seconds == window.agent_panel.seconds


def test_a_finished_region_is_still_selected(qtbot, open_window, star):
    window = open_window(star, longest=2)
    window.document.selection.everything()
    press(qtbot, window, Qt.Key.Key_R, Qt.KeyboardModifier.ControlModifier)
    assert window.assistant.state is State.SEARCHING
    qtbot.waitUntil(lambda: not window.assistant.running, timeout=WAIT)
    assert window.document.history.cursor >= 2
    assert np.array_equal(window.document.selection.vertices, star.vertices())
    assert "The region is finished" in window.status.message


def test_numbers_of_the_panel_are_used_and_stored(qtbot, open_window, star):
    window = open_window(star)
    panel, efforts = window.agent_panel, []
    window.assistant.search = efforts.append
    panel.rollouts_box.setValue(25)
    panel.seconds_box.setValue(7)
    panel.speed.setValue(9)
    qtbot.mouseClick(panel.best_of, Qt.MouseButton.LeftButton)
    qtbot.mouseClick(panel.search, Qt.MouseButton.LeftButton)
    assert (efforts[0].rollouts, efforts[0].seconds) == (25, None)
    assert (efforts[1].rollouts, efforts[1].seconds) == (None, 7.0)
    again = open_window(star.copy())
    assert (again.agent_panel.rollouts, again.agent_panel.seconds) == (25, 7.0)
    assert again.assistant.speed == 60


def test_progress_runs_while_something_runs_and_stops_with_it(qtbot, open_window, star):
    window = open_window(star, longest=100, bad_steps=100)
    window.agent_panel.speed.setValue(9)
    press(qtbot, window, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: window.document.history.cursor >= 3, timeout=WAIT)
    assert window.agent_panel.progress.text().startswith("Playing: ")
    press(qtbot, window, Qt.Key.Key_Escape)
    assert window.assistant.state is State.IDLE
    kept = window.document.history.cursor
    assert "taken, best s" in window.agent_panel.progress.text()
    qtbot.wait(150)
    assert window.document.history.cursor == kept
    assert not window.agent_panel._clock.isActive()


def test_the_policy_is_loaded_once_nobody_has_done_anything_for_a_moment(
    qtbot, open_window, star, monkeypatch
):
    window = open_window(star)
    idle = window.agent._idle
    idle.setTimerType(Qt.TimerType.PreciseTimer)
    idle.setInterval(WAIT)
    asked, prepare = [], window.assistant.prepare
    monkeypatch.setattr(
        window.assistant, "prepare", lambda: (asked.append(window.assistant.policy), prepare())
    )
    window.agent.prepare_while_idle(window.readiness)
    for halfedge in (0, 8):  # each time the mouse moves on, the wait begins anew
        qtbot.wait(100)
        before = idle.remainingTime()
        point_at(qtbot, window, halfedge)
        assert idle.remainingTime() > before and not asked
    idle.setInterval(50)
    point_at(qtbot, window, 0)
    qtbot.waitUntil(lambda: asked == ["greedy"], timeout=WAIT)
    qtbot.waitUntil(lambda: not window.assistant.loading, timeout=WAIT)
    assert window.assistant._worker.has("greedy")
    assert window.assistant.state is State.IDLE and not window.document.history.cursor
    point_at(qtbot, window, 8)
    assert not idle.isActive() and len(asked) == 1


def policy_file(path, kind):
    text = json.dumps({"__metadata__": {"kind": kind}}).encode()
    path.write_bytes(len(text).to_bytes(8, "little") + text)
    return str(path)


def test_policy_file_is_loaded_and_remembered(qtbot, open_window, star, tmp_path, monkeypatch):
    path = policy_file(tmp_path / "mine.safetensors", "quad")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (path, ""))
    window = open_window(star)
    qtbot.mouseClick(window.agent_panel.more, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: window.assistant.policy == path, timeout=WAIT)
    assert window.agent_panel.policy.currentText() == "mine"
    press(qtbot, window, Qt.Key.Key_Period)
    qtbot.waitUntil(lambda: window.document.history.cursor == 1, timeout=WAIT)
    assert window.document.history.last.by == "mine"
    again = open_window(star.copy())
    assert again.agent_panel.policy.findText("mine") >= 0


@pytest.mark.parametrize("kind", ["tri", "", None])
def test_invalid_policy_file_is_reported_in_one_sentence(open_window, star, tmp_path, kind):
    window = open_window(star)
    path = tmp_path / "other.safetensors"
    if kind is not None:
        policy_file(path, kind)
    window.agent.open_policy(str(path))
    output = {"tri": "a policy for triangle meshes", "": "no policy file", None: "no such file"}
    assert output[kind] in window.notice.text
    assert window.assistant.policy == "greedy"
    assert window.agent_panel.policy.findText("other") < 0
