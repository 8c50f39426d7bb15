"""Number fields, combo boxes and sliders: typing, the wheel, Return and Escape."""

import pytest
from driving import WAIT, press
from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtGui import QWheelEvent
from qtpy.QtTest import QTest
from qtpy.QtWidgets import QApplication, QScrollArea

from meshwright.desktop.main_window.startup import application
from meshwright.desktop.widgets.number_box import DecimalBox, IntegerBox


def turn(widget) -> bool:
    """Send ``widget`` one step of the wheel; returns whether it has used it."""
    event = QWheelEvent(
        QPointF(5, 5),
        widget.mapToGlobal(QPointF(5, 5)),
        QPoint(),
        QPoint(0, 120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(widget, event)
    return event.isAccepted()


def turn_at(window, widget, steps) -> None:
    """Turn the wheel with the mouse over ``widget``."""
    place = widget.mapTo(window, widget.rect().center())
    QTest.wheelEvent(window.windowHandle(), QPointF(place), QPoint(0, 120 * steps))


@pytest.mark.parametrize("kind", [IntegerBox, DecimalBox])
def test_the_wheel_never_changes_a_number(qtbot, kind):
    application()
    box = kind()
    qtbot.addWidget(box)
    box.setRange(0, 10)
    box.setValue(4)
    box.show()
    box.activateWindow()
    box.setFocus()
    qtbot.waitUntil(box.hasFocus)
    assert not turn(box)
    assert box.value() == 4
    box.selectAll()
    qtbot.keyClicks(box, "7")
    assert box.value() == 7


def test_the_wheel_over_the_panel_scrolls_it(qtbot, open_window, star):
    window = open_window(star)
    window.resize(900, 600)
    panel = window.agent_panel
    area = window.sidebar.findChild(QScrollArea)
    bar = area.verticalScrollBar()
    qtbot.waitUntil(lambda: bar.maximum() > 100, timeout=WAIT)
    read = {
        panel.policy: panel.policy.currentIndex,
        panel.speed: panel.speed.value,
        panel.prefer: panel.prefer.value,
        panel.rollouts_box: panel.rollouts_box.value,
        panel.seconds_box: panel.seconds_box.value,
    }
    panel.policy.addItem("another")
    for control, value in read.items():
        control.setFocus()
        area.ensureWidgetVisible(control)
        for steps in (-1, 1):
            before, at = value(), bar.value()
            turn_at(window, control, steps)
            assert value() == before
            assert bar.value() != at
    timeline = window.playback.timeline.speed
    before = timeline.currentIndex()
    for steps in (-1, 1):
        turn_at(window, timeline, steps)
    assert timeline.currentIndex() == before


@pytest.mark.parametrize("key", [Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Escape])
@pytest.mark.parametrize("name", ["rollouts_box", "seconds_box"])
def test_return_and_escape_give_the_focus_back(qtbot, open_window, star, name, key):
    window = open_window(star)
    box = getattr(window.agent_panel, name)
    before = box.value()
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, "9")
    qtbot.keyClick(box, key)
    assert window.canvas.plotter.hasFocus()
    assert box.value() == (before if key == Qt.Key.Key_Escape else 9)
    assert box.text() == f"{box.value()}{box.suffix()}"


def test_escape_gives_the_focus_back_from_sliders_boxes_and_buttons(qtbot, open_window, star):
    window = open_window(star)
    panel = window.agent_panel
    for control in (panel.policy, panel.speed, panel.prefer, panel.complete, panel.watch):
        control.setFocus()
        assert control.hasFocus()
        qtbot.keyClick(control, Qt.Key.Key_Escape)
        assert window.canvas.plotter.hasFocus()


def test_a_key_without_effect_says_why(qtbot, open_window, star):
    window = open_window(star)
    shift, control = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier
    for key, modifier, words in (
        (Qt.Key.Key_Z, control, "Undo: There is nothing to undo."),
        (Qt.Key.Key_3, Qt.KeyboardModifier.NoModifier, "No hints are shown"),
        (Qt.Key.Key_R, control, "Needs a selected region"),
        (Qt.Key.Key_J, Qt.KeyboardModifier.NoModifier, "J has no function here; F1 lists"),
        (Qt.Key.Key_J, shift, "Shift+J has no function here"),
        (Qt.Key.Key_F, Qt.KeyboardModifier.NoModifier, "Point at a half-edge first"),
    ):
        window.status.show_message("")
        press(qtbot, window, key, modifier)
        assert words in window.status.message
    window.status.show_message("before")
    press(qtbot, window, Qt.Key.Key_Shift)
    assert window.status.message == "before"


def test_a_key_pressed_in_a_panel_says_where_it_works(qtbot, open_window, triangles):
    window = open_window(triangles)
    window.agent_panel.watch.setFocus()
    qtbot.keyClick(window.agent_panel.watch, Qt.Key.Key_Up)  # moves between the controls
    window.agent_panel.watch.setFocus()
    qtbot.keyClick(window.agent_panel.watch, Qt.Key.Key_Return)
    assert window.status.message.startswith("Apply previewed operation works while the mesh has")
    qtbot.keyClick(window.agent_panel.watch, Qt.Key.Key_X)
    assert window.status.message == "Clean up line: Needs a quad mesh."
