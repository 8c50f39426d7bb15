"""Small event filters: keys that are a widget's own, tooltips that depend on the place.

Filters rather than overridden ``event`` methods: where Qt calls back into Python through an
overridden one, PySide 6.11 answers an exception in, say, a ``paintEvent`` with the end of the
process.
"""

from collections.abc import Callable, Collection

from qtpy.QtCore import QEvent, QObject, QPoint, Qt
from qtpy.QtGui import QHelpEvent, QKeyEvent
from qtpy.QtWidgets import QToolTip, QWidget


class OwnKeys(QObject):
    """While ``widget`` has the focus these keys are its own, and no shortcuts of the window.

    ``keys`` count without modifiers; None stands for all keys, with any modifiers.
    """

    def __init__(self, widget: QWidget, keys: Collection[Qt.Key] | None = None) -> None:
        super().__init__(widget)
        self._keys = keys
        widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Claim the keys; everything else goes its way."""
        if not isinstance(event, QKeyEvent) or event.type() != QEvent.Type.ShortcutOverride:
            return False
        own = self._keys is None or (Qt.Key(event.key()) in self._keys and not event.modifiers())
        if own:
            event.accept()
        return own


class OwnTooltips(QObject):
    """``words(place)`` says what the tooltip of ``widget`` says at a place in it."""

    def __init__(self, widget: QWidget, words: Callable[[QPoint], str]) -> None:
        super().__init__(widget)
        self._widget, self._words = widget, words
        widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Show the words of the place."""
        if not isinstance(event, QHelpEvent) or event.type() != QEvent.Type.ToolTip:
            return False
        QToolTip.showText(event.globalPos(), self._words(event.pos()), self._widget)
        return True
