"""Number fields: typing, and the wheel with and without focus."""

import pytest
from qtpy.QtCore import QPoint, QPointF, Qt
from qtpy.QtGui import QWheelEvent
from qtpy.QtWidgets import QApplication

from meshwright.desktop.main_window.startup import application
from meshwright.desktop.widgets.number_box import DecimalBox, IntegerBox


def turn(box) -> bool:
    """Turn the wheel one step up over ``box``; returns whether it accepted the event."""
    event = QWheelEvent(
        QPointF(5, 5),
        box.mapToGlobal(QPointF(5, 5)),
        QPoint(),
        QPoint(0, 120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(box, event)
    return event.isAccepted()


@pytest.mark.parametrize("kind", [IntegerBox, DecimalBox])
def test_wheel_changes_only_the_focused_field(qtbot, kind):
    application()
    box = kind()
    qtbot.addWidget(box)
    box.setRange(0, 10)
    box.setValue(4)
    box.show()
    box.clearFocus()
    assert not turn(box)
    assert box.value() == 4
    box.activateWindow()
    box.setFocus()
    qtbot.waitUntil(box.hasFocus)
    assert turn(box)
    assert box.value() == 5
    box.selectAll()
    qtbot.keyClicks(box, "7")
    assert box.value() == 7
