"""Event filters: keys that override shortcuts, tooltips that depend on the position, and a wheel
that scrolls panels but changes no value in them.

They replace overridden ``event`` methods: after an exception in an overridden method such as
``paintEvent``, PySide 6.11 ends the process if ``event`` is overridden, too.
"""

from collections.abc import Callable, Collection

from qtpy.QtCore import QEvent, QObject, QPoint, Qt
from qtpy.QtGui import QHelpEvent, QKeyEvent
from qtpy.QtWidgets import (
    QAbstractButton,
    QAbstractSlider,
    QAbstractSpinBox,
    QComboBox,
    QDoubleSpinBox,
    QScrollBar,
    QSpinBox,
    QToolTip,
    QWidget,
)

MENU_KEYS = frozenset(
    {
        *map(Qt.Key, range(Qt.Key.Key_A.value, Qt.Key.Key_Z.value + 1)),
        *(Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Up, Qt.Key.Key_Down),
        *(Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space, Qt.Key.Key_Escape),
    }
)
"""What a menu bar with the keyboard focus understands."""
_LEAVING = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Escape)


class OwnKeys(QObject):
    """Sends ``keys`` to ``widget``, not to shortcuts of the window, while it has the focus.

    The keys apply without modifiers; None stands for all keys with any modifiers.
    """

    def __init__(self, widget: QWidget, keys: Collection[Qt.Key] | None = None) -> None:
        super().__init__(widget)
        self._keys = keys
        widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Accept the shortcut override for the keys."""
        if not isinstance(event, QKeyEvent) or event.type() != QEvent.Type.ShortcutOverride:
            return False
        own = self._keys is None or (Qt.Key(event.key()) in self._keys and not event.modifiers())
        if own:
            event.accept()
        return own


class OwnTooltips(QObject):
    """Shows ``words(place)`` as the tooltip of ``widget`` at a place in it."""

    def __init__(self, widget: QWidget, words: Callable[[QPoint], str]) -> None:
        super().__init__(widget)
        self._widget, self._words = widget, words
        widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Show the tooltip."""
        if not isinstance(event, QHelpEvent) or event.type() != QEvent.Type.ToolTip:
            return False
        QToolTip.showText(event.globalPos(), self._words(event.pos()), self._widget)
        return True


class PanelInput(QObject):
    """Wheel and keys in the combo boxes, sliders, number boxes and buttons of ``root``.

    The wheel never changes their values: the page below them scrolls. Space presses a button, and
    Home and End move a slider, even where they are shortcuts of the window. With ``leave``, Return
    and Escape in the others call it, which gives the keyboard focus back; Escape also restores the
    value that a number box had when it received the focus.
    """

    def __init__(self, root: QWidget, leave: Callable[[], None] | None = None) -> None:
        super().__init__(root)
        self._leave = leave
        self._value = 0.0
        self._others = [
            OwnKeys(button, (Qt.Key.Key_Space,)) for button in root.findChildren(QAbstractButton)
        ]
        for kind in (QComboBox, QAbstractSlider, QAbstractSpinBox):
            for control in root.findChildren(kind):
                if isinstance(control, QScrollBar):
                    continue
                control.installEventFilter(self)
                if isinstance(control, QAbstractSlider):
                    self._others.append(OwnKeys(control, (Qt.Key.Key_Home, Qt.Key.Key_End)))
                elif isinstance(control, QComboBox):
                    self._others.append(OwnKeys(control, (Qt.Key.Key_Space,)))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Pass the wheel on to the parent; leave the control at Return and Escape."""
        kind = event.type()
        if kind == QEvent.Type.Wheel:
            event.ignore()
            return True
        if kind == QEvent.Type.FocusIn and isinstance(watched, QSpinBox | QDoubleSpinBox):
            self._value = watched.value()
        if self._leave is None or not isinstance(event, QKeyEvent) or event.key() not in _LEAVING:
            return False
        if kind == QEvent.Type.ShortcutOverride:
            event.accept()  # Escape is a shortcut of the window
            return True
        if kind != QEvent.Type.KeyPress:
            return False
        if isinstance(watched, QSpinBox | QDoubleSpinBox):
            if event.key() == Qt.Key.Key_Escape:
                if isinstance(watched, QSpinBox):
                    watched.setValue(round(self._value))
                else:
                    watched.setValue(self._value)
            else:
                watched.interpretText()
        self._leave()
        return True
