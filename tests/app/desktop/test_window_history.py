"""History list, timeline, playback and export, by real mouse and key events."""

import numpy as np
import pytest
from driving import WAIT, find, press
from qtpy.QtCore import QPoint, QPointF, Qt, QTimer
from qtpy.QtGui import QWheelEvent
from qtpy.QtWidgets import QApplication

from meshwright.assistant.assistant import State
from meshwright.document.document import Document

ALT, SHIFT = Qt.KeyboardModifier.AltModifier, Qt.KeyboardModifier.ShiftModifier
LEFT = Qt.MouseButton.LeftButton


def work(document: Document, greedy, longest: int, by: str = "you", bad_steps: int = 0) -> None:
    runner = greedy(document.mesh, bad_steps=bad_steps, longest=longest)
    while not runner.finished:
        for operation, halfedge in runner.step():
            document.submit(operation, halfedge, by)


@pytest.fixture
def walked(qtbot, open_window, star, greedy):
    """A window on the star with nine steps, three of them bad, by a policy called greedy."""
    window = open_window(star)
    work(window.document, greedy, 9, "greedy", bad_steps=3)
    settle(qtbot, window)
    return window


def settle(qtbot, window) -> None:
    """Wait until list and curve are up to date."""
    history = window.document.history
    qtbot.waitUntil(
        lambda: (
            window.playback.timeline.curve.cursor_state == history.cursor
            and window.playback.panel.model.rowCount() == len(history) + 1 + len(history.branches)
        ),
        timeout=WAIT,
    )


def on_curve(window, state: int) -> QPoint:
    curve = window.playback.timeline.curve
    curve.grab()  # the frame of a curve is known once it has been painted
    return QPoint(round(float(curve._frame.x(state))), curve.height() // 2)


def on_list(window, place: int) -> QPoint:
    panel = window.playback.panel
    index = panel.model.index(place)
    panel.list.scrollTo(index)
    return panel.list.visualRect(index).center()


def test_a_click_on_a_line_goes_there_and_back(qtbot, walked):
    window, document = walked, walked.document
    panel = window.playback.panel
    scores = [document.history.first[0], *(row.after for row in document.history)]
    points = {len(document.history): document.mesh.points.copy()}
    for state in (3, 0, 7, len(document.history)):
        qtbot.mouseClick(panel.list.viewport(), LEFT, pos=on_list(window, state))
        qtbot.waitUntil(lambda state=state: document.history.cursor == state, timeout=WAIT)
        assert document.score == scores[state]
        settle(qtbot, window)
        assert panel.count.text() == (f"{state} of {len(document.history)}")
        seen = points.setdefault(state, document.mesh.points.copy())
        assert np.array_equal(document.mesh.points, seen)
    panel.list.setFocus()
    qtbot.keyClick(panel.list, Qt.Key.Key_Up)
    qtbot.keyClick(panel.list, Qt.Key.Key_Up)
    qtbot.keyClick(panel.list, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: document.history.cursor == len(document.history) - 2, timeout=WAIT)


def test_list_lines_state_title_author_and_change(walked):
    model = walked.playback.panel.model
    words = [model.data(model.index(place)) for place in range(model.rowCount())]
    assert words[0] == "Start, s 12"
    row = walked.document.history[0]
    assert words[1].startswith(f"Step 1: {row.title} by greedy, +")
    assert words[1].endswith(f"s {row.after}")


def test_scrubbing_by_the_mouse(qtbot, walked):
    window, document = walked, walked.document
    curve = window.playback.timeline.curve
    qtbot.mousePress(curve, LEFT, pos=on_curve(window, 6))
    qtbot.waitUntil(lambda: document.history.cursor == 6, timeout=WAIT)
    for state in (5, 4, 2, 1):
        qtbot.mouseMove(curve, on_curve(window, state))
    qtbot.mouseRelease(curve, LEFT, pos=on_curve(window, 1))
    qtbot.waitUntil(lambda: document.history.cursor == 1, timeout=WAIT)
    document.mesh.validate()
    settle(qtbot, window)
    builds = curve.builds
    for state in range(len(document.history)):
        qtbot.mouseMove(curve, on_curve(window, state))
        assert curve.hovered == state
    assert curve.builds == builds  # hovering paints nothing but the mark
    assert document.history.cursor == 1


def test_wheel_and_keys_on_the_curve(qtbot, walked):
    window, document = walked, walked.document
    curve, last = window.playback.timeline.curve, len(document.history)
    curve.setFocus()
    for key, wanted in (
        (Qt.Key.Key_Home, 0),
        (Qt.Key.Key_Right, 1),
        (Qt.Key.Key_End, last),
        (Qt.Key.Key_Left, last - 1),
        (Qt.Key.Key_PageDown, last),
    ):
        qtbot.keyClick(curve, key)
        qtbot.waitUntil(lambda wanted=wanted: document.history.cursor == wanted, timeout=WAIT)
    event = QWheelEvent(
        QPointF(100, 40),
        curve.mapToGlobal(QPoint(100, 40)).toPointF(),
        QPoint(),
        QPoint(0, 120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(curve, event)
    qtbot.waitUntil(lambda: document.history.cursor == last - 1, timeout=WAIT)


def test_history_keys_work_on_the_canvas(qtbot, walked):
    window, document = walked, walked.document
    last = len(document.history)
    best = min(range(1, last + 1), key=lambda state: (document.history[state - 1].after, state))
    for key, modifier, wanted in (
        (Qt.Key.Key_Left, ALT, last - 1),
        (Qt.Key.Key_BracketLeft, Qt.KeyboardModifier.NoModifier, last - 2),
        (Qt.Key.Key_Home, ALT, 0),
        (Qt.Key.Key_BracketRight, Qt.KeyboardModifier.NoModifier, 1),
        (Qt.Key.Key_End, ALT, last),
        (Qt.Key.Key_Up, ALT, best),
    ):
        press(qtbot, window, key, modifier)
        assert document.history.cursor == wanted


def test_playback_follows_the_speed_and_can_be_paused(qtbot, walked):
    window, document, film = walked, walked.document, walked.playback
    film.timeline.speed.setCurrentIndex(film.timeline.speed.count() - 1)
    assert window.settings.number("film/speed", 0) == 60
    qtbot.mouseClick(film.timeline.buttons["history.play"], LEFT)
    assert film.playing
    assert document.history.cursor <= 1  # it was at its end, so playback restarts
    qtbot.waitUntil(lambda: not film.playing, timeout=WAIT)
    assert document.history.cursor == len(document.history)
    film.timeline.speed.setCurrentIndex(0)
    press(qtbot, window, Qt.Key.Key_Space, SHIFT)
    assert film.playing
    press(qtbot, window, Qt.Key.Key_Space, SHIFT)
    assert not film.playing
    press(qtbot, window, Qt.Key.Key_Space, SHIFT)
    press(qtbot, window, Qt.Key.Key_Y, Qt.KeyboardModifier.ControlModifier)
    assert not film.playing  # a step by the user stops playback
    assert window.assistant.state is State.IDLE


def test_branches_are_listed_and_can_be_switched_to(qtbot, walked, greedy):
    window, document, film = walked, walked.document, walked.playback
    former = [row.serial for row in document.history]
    end = document.mesh.points.tobytes()
    document.go_to(4)
    document.submit("split", find(document.mesh, "split"))
    assert len(document.history.branches) == 1
    settle(qtbot, window)
    assert film.panel.model.line(5).branch == 0
    assert "Branch: 5 steps" in film.panel.model.data(film.panel.model.index(5))
    qtbot.mouseClick(film.panel.list.viewport(), LEFT, pos=on_list(window, 5))
    assert [row.serial for row in document.history] == former
    assert document.mesh.points.tobytes() == end
    settle(qtbot, window)
    curve = film.timeline.curve
    fork = on_curve(window, document.history.branches[0].at)
    fork.setY(curve.height() - 25)
    qtbot.mouseMove(curve, fork)
    qtbot.mouseClick(curve, LEFT, pos=fork)
    assert document.history.last.action == "split"
    settle(qtbot, window)
    press(qtbot, window, Qt.Key.Key_Down, ALT)
    assert [row.serial for row in document.history] == former
    document.mesh.validate()


def test_hidden_list_and_timeline_are_remembered(qtbot, walked):
    window, film = walked, walked.playback
    height = window.canvas.height()
    press(qtbot, window, Qt.Key.Key_F3)
    press(qtbot, window, Qt.Key.Key_F4)
    assert not film.panel.isVisible()
    assert not film.timeline.isVisible()
    qtbot.waitUntil(lambda: window.canvas.height() > height, timeout=WAIT)
    assert not window.settings.flag("film/list", True)
    assert not window.actions_by_id["history.list"].isChecked()
    window.document.undo()
    press(qtbot, window, Qt.Key.Key_F3)
    press(qtbot, window, Qt.Key.Key_F4)
    settle(qtbot, window)
    assert window.actions_by_id["history.list"].isChecked()


def test_history_of_a_new_mesh_replaces_the_list(qtbot, walked, triangles):
    window, film = walked, walked.playback
    window.document.replace(triangles, "triangles")
    settle(qtbot, window)
    assert film.panel.model.rowCount() == 1
    assert film.panel.count.text() == ""
    assert not film.timeline.buttons["history.play"].isEnabled()
    window.document.replace(None)
    assert not film.panel.isVisible()
    assert not film.timeline.isVisible()


def test_hovered_state_that_disappears_is_no_longer_marked(qtbot, walked, triangles):
    window = walked
    curve = window.playback.timeline.curve
    qtbot.mouseMove(curve, on_curve(window, 3))
    qtbot.mouseMove(curve, on_curve(window, 4))
    qtbot.waitUntil(lambda: curve.hovered == 4, timeout=WAIT)
    window.document.replace(triangles, "triangles")
    settle(qtbot, window)
    assert curve.hovered < len(curve._track.scores)
    curve.grab()  # an error while painting would end the process


def test_mouse_that_moves_before_a_shorter_history_is_painted(qtbot, walked, triangles):
    window = walked
    curve = window.playback.timeline.curve
    end = QPoint(curve.width() - 4, curve.height() // 2)
    window.document.replace(triangles, "triangles")
    qtbot.mouseMove(curve, end - QPoint(9, 0))
    curve.hovered = 6  # of the frame that was painted last
    curve.grab()
    assert curve.hovered < len(curve._track.scores)


def test_ten_thousand_steps_are_listed_and_hovered_cheaply(qtbot, open_window, star):
    window = open_window(star)
    document, film = window.document, window.playback
    vertices = np.array([star.vertices()[-1]])
    place = star.points[vertices].copy()
    with document.together():
        for step in range(10_000):
            document.move(vertices, place + (1e-6 * (step + 1), 0.0, 0.0))
    settle(qtbot, window)
    curve = film.timeline.curve
    curve.grab()
    builds = curve.builds
    for x in range(80, curve.width() - 40, 40):
        qtbot.mouseMove(curve, QPoint(x, 40))
    assert curve.builds == builds
    document.undo()
    settle(qtbot, window)
    assert curve.builds == builds  # only the cursor has moved
    qtbot.mouseClick(film.panel.list.viewport(), LEFT, pos=on_list(window, 9_998))
    qtbot.waitUntil(lambda: document.history.cursor == 9_998, timeout=WAIT)


def ask(qtbot, window, choose, monkeypatch, path) -> None:
    """Open the export dialog by its key, call ``choose(dialog)``, and enter ``path``."""
    monkeypatch.setattr(
        "meshwright.desktop.exporting.export_task.QFileDialog.getSaveFileName",
        lambda *arguments: (str(path), ""),
    )

    def answer():
        dialog = QApplication.activeModalWidget()
        choose(dialog)
        qtbot.mouseClick(dialog.export, LEFT)

    window.activateWindow()  # the previous dialog deleted it
    qtbot.waitUntil(window.isActiveWindow, timeout=WAIT)
    QTimer.singleShot(200, answer)
    press(qtbot, window, Qt.Key.Key_E, Qt.KeyboardModifier.ControlModifier)


@pytest.mark.parametrize("number", range(4))
def test_export_writes_the_chosen_format(qtbot, walked, monkeypatch, tmp_path, number):
    window = walked
    chosen = []

    def choose(dialog):
        qtbot.mouseClick(list(dialog.formats.values())[number], LEFT)
        dialog.size_box.setCurrentIndex(0)
        dialog.seconds.setValue(0.1)
        assert dialog.preview.pixmap().width() > 100
        chosen.append(dialog.order)

    ask(qtbot, window, choose, monkeypatch, tmp_path / "star")
    path = tmp_path / f"star{chosen[0].ending}"
    qtbot.waitUntil(lambda: not window.playback.exporting.running, timeout=WAIT)
    assert path.stat().st_size > 1000
    assert window.status.message.startswith(f"Written: {path.name}")
    assert not window.playback.exporting.bar.isVisible()
    assert chosen[0].size == (640, 480)
    if chosen[0].moving:
        assert f"{len(window.document.history) + 1} frames" in window.status.message


def test_export_can_be_cancelled_and_reports_errors(qtbot, walked, monkeypatch, tmp_path):
    window, exporting = walked, walked.playback.exporting
    choose = lambda dialog: None  # noqa: E731
    ask(qtbot, window, choose, monkeypatch, tmp_path / "star.gif")
    qtbot.mouseClick(exporting.bar.cancel, LEFT)
    qtbot.waitUntil(lambda: not exporting.running, timeout=WAIT)
    assert window.status.message == "Cancelled: star.gif was not written."
    assert list(tmp_path.iterdir()) == []
    ask(qtbot, window, choose, monkeypatch, tmp_path / "none" / "star.gif")
    qtbot.waitUntil(lambda: not exporting.running, timeout=WAIT)
    assert "does not exist" in window.notice.text, window.status.message
    ask(qtbot, window, choose, monkeypatch, tmp_path / "late.gif")
    window.close()
    assert not exporting.running
    assert list(tmp_path.iterdir()) == []
