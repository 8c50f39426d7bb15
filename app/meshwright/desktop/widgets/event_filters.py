"""Event filters: keys that override shortcuts, tooltips that depend on the position.

They replace overridden ``event`` methods: after an exception in an overridden method such as
``paintEvent``, PySide 6.11 ends the process if ``event`` is overridden, too.
"""

from collections.abc import Callable, Collection

from qtpy.QtCore import QEvent, QObject, QPoint, Qt
from qtpy.QtGui import QHelpEvent, QKeyEvent
from qtpy.QtWidgets import QToolTip, QWidget


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
