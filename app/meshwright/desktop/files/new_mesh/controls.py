"""Controls of the dialog for new meshes."""

from __future__ import annotations

import math
from collections.abc import Sequence

from qtpy.QtCore import QSignalBlocker, Qt, Signal
from qtpy.QtWidgets import (
    QButtonGroup,
    QCheckBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.widgets.basic import named, segment
from meshwright.desktop.widgets.number_box import DecimalBox
from meshwright.graphics.theme import GRID

_SMALLEST, _LARGEST = 1e-9, 1e9
"""Lower and upper bound of lengths that can be typed."""
STEPS = 200
"""Number of positions of a slider."""


class SegmentedButtons(QWidget):
    """Buttons side by side of which one is checked. ``changed(key)`` when another one is."""

    changed = Signal(str)

    def __init__(self, choices: Sequence[tuple[str, str]], name: str, chosen: str = "") -> None:
        super().__init__()
        self.setAccessibleName(name)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self.buttons: dict[str, QPushButton] = {}
        self._group = QButtonGroup(self)
        for key, title in choices:
            button = segment(title)
            button.setAccessibleName(f"{name}: {title}")
            button.clicked.connect(self._on_clicked)
            self._group.addButton(button)
            self.buttons[key] = button
            layout.addWidget(button)
        layout.addStretch(1)
        self.buttons[chosen or choices[0][0]].setChecked(True)

    @property
    def key(self) -> str:
        """The key of the checked button."""
        return next(key for key, button in self.buttons.items() if button.isChecked())

    @key.setter
    def key(self, key: str) -> None:
        self.buttons[key].setChecked(True)

    def _on_clicked(self) -> None:
        self.changed.emit(self.key)


class OptionalNumber(QWidget):
    """An optional number: a check box, a slider, and a field to type in.

    ``value`` is None while the box is unchecked. ``changed()``. A ``geometric`` slider has a
    logarithmic scale, from the largest value at the left to the smallest at the right.
    """

    changed = Signal()

    def __init__(
        self,
        title: str,
        automatic: str,
        low: float,
        high: float,
        value: float,
        decimals: int,
        unit: str = "",
        geometric: bool = False,
    ) -> None:
        super().__init__()
        self._low, self._high, self._geometric = low, high, geometric
        self._automatic = automatic
        self.tick = QCheckBox(title)
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.slider.setRange(0, STEPS)
        self.slider.setAccessibleName(f"{title}, slider")
        self.field = DecimalBox()
        self.field.setDecimals(decimals)
        self.field.setRange(low, high)
        self.field.setValue(value)
        self.field.setSuffix(unit)
        self.field.setFixedWidth(11 * GRID)
        self.field.setAccessibleName(title)
        self.field.setKeyboardTracking(False)
        self.field.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.words = named(automatic, "Hint")
        head, line = QHBoxLayout(), QHBoxLayout()
        head.addWidget(self.tick)
        head.addStretch(1)
        head.addWidget(self.words)
        line.setSpacing(12)
        line.addWidget(self.slider, 1)
        line.addWidget(self.field)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addLayout(head)
        layout.addLayout(line)
        self.tick.toggled.connect(self._on_toggled)
        self.slider.valueChanged.connect(self._on_slid)
        self.field.valueChanged.connect(self._on_typed)
        self._place_slider()
        self._on_toggled(False)

    @property
    def value(self) -> float | None:
        """The number, None while the box is unchecked."""
        return float(self.field.value()) if self.tick.isChecked() else None

    @value.setter
    def value(self, number: float | None) -> None:
        self.tick.setChecked(number is not None)
        if number is not None:
            if self._geometric:
                self.field.setDecimals(9)
                self.field.setRange(_SMALLEST, _LARGEST)
            self.field.setValue(number)

    def set_range(self, low: float, high: float, value: float) -> None:
        """Set the bounds of the slider, and a default that replaces a value outside of them."""
        self._low, self._high = low, high
        decimals = max(0, 3 - math.floor(math.log10(high)))
        inside = self.tick.isChecked() and low <= self.field.value() <= high
        with QSignalBlocker(self.field):
            self.field.setDecimals(min(decimals, 9))
            self.field.setRange(_SMALLEST, _LARGEST)
            self.field.setSingleStep(10.0 ** math.floor(math.log10(high) - 1.0))
            if not inside:
                self.field.setValue(value)
        self._place_slider()
        if self.tick.isChecked() and not inside:
            self.changed.emit()

    def _share(self, value: float) -> float:
        if self._geometric:
            return math.log(self._high / max(value, self._low)) / math.log(self._high / self._low)
        return (value - self._low) / (self._high - self._low)

    def _place_slider(self) -> None:
        with QSignalBlocker(self.slider):
            self.slider.setValue(round(STEPS * self._share(self.field.value())))

    def _on_toggled(self, on: bool) -> None:
        self.slider.setEnabled(on)
        self.field.setEnabled(on)
        self.words.setText("" if on else self._automatic)
        self.changed.emit()

    def _on_slid(self, step: int) -> None:
        share = step / STEPS
        if self._geometric:
            value = self._high * (self._low / self._high) ** share
        else:
            value = self._low + share * (self._high - self._low)
        with QSignalBlocker(self.field):
            self.field.setValue(value)
        self.changed.emit()

    def _on_typed(self) -> None:
        self._place_slider()
        self.changed.emit()


def heading(text: str) -> QLabel:
    """A title above a group of controls."""
    return named(text, "Heading")


def column(*parts: QWidget, gap: int = GRID) -> QVBoxLayout:
    """Widgets one under the other, without margins."""
    layout = QVBoxLayout()
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setSpacing(gap)
    for part in parts:
        layout.addWidget(part)
    return layout
