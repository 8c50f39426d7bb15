"""Fields for whole and decimal numbers."""

from qtpy.QtGui import QWheelEvent
from qtpy.QtWidgets import QDoubleSpinBox, QSpinBox

_INSET = 6
"""Pixels between frame and text; style sheets cannot set them for these fields."""


class IntegerBox(QSpinBox):
    """A whole number. The wheel never changes it: it scrolls the page that the field is on."""

    def __init__(self) -> None:
        super().__init__()
        self.lineEdit().setTextMargins(_INSET, 0, 0, 0)

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802
        """Let the page scroll."""
        event.ignore()


class DecimalBox(QDoubleSpinBox):
    """A number with decimals; the wheel as in :class:`IntegerBox`."""

    def __init__(self) -> None:
        super().__init__()
        self.lineEdit().setTextMargins(_INSET, 0, 0, 0)

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802
        """Let the page scroll."""
        event.ignore()
