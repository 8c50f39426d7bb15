"""The quality panel: histogram of a quality measure, and the worst element."""

import math

from qtpy.QtCore import Qt, Signal
from qtpy.QtWidgets import QButtonGroup, QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from meshwright.desktop.application.settings import Settings
from meshwright.desktop.quality.histogram import Histogram
from meshwright.desktop.quality.quality_job import QualityMonitor
from meshwright.desktop.widgets.basic import ValueLink
from meshwright.document.quality_summary import QualitySummary, Spread
from meshwright.graphics.theme import Theme

JACOBIAN, ANGLE = "jacobian", "angle"
_MEASURES = (
    (JACOBIAN, "Jacobian", "Scaled Jacobian: 1 for a square or an equilateral triangle", ""),
    (ANGLE, "Angle", "Smallest angle of each element", "\u00b0"),
)
_KEY = "quality/measure"


class QualityPanel(QWidget):
    """Shows what ``monitor`` has measured. ``worst_chosen(element)`` when the worst is clicked."""

    worst_chosen = Signal(int)

    def __init__(self, monitor: QualityMonitor, settings: Settings, theme: Theme) -> None:
        super().__init__()
        self._monitor = monitor
        self._settings = settings
        self.histogram = Histogram(theme)
        self.worst = ValueLink("Worst element", "The lowest value; click to go to the element")
        self.measures = QWidget()  # placed beside the heading
        self.switches: dict[str, QPushButton] = {}
        self._group = QButtonGroup(self)
        for name, word, tooltip, _ in _MEASURES:
            switch = QPushButton(word)
            switch.setObjectName("Chip")
            switch.setCheckable(True)
            switch.setToolTip(tooltip)
            switch.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            self.switches[name] = switch
            self._group.addButton(switch)
        self._arrange()
        self.switches[settings.choice(_KEY, (JACOBIAN, ANGLE))].setChecked(True)
        self._group.buttonClicked.connect(self._on_switched)
        self.worst.clicked.connect(self._on_worst_clicked)
        monitor.aged.connect(self.show_measured)
        monitor.measured.connect(self.show_measured)
        self.show_measured()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self.histogram.set_theme(theme)

    @property
    def measure(self) -> str:
        """``"jacobian"`` or ``"angle"``."""
        return next(name for name, switch in self.switches.items() if switch.isChecked())

    def show_measured(self) -> None:
        """Show the latest measurement, pale while it is stale."""
        summary = self._monitor.summary
        self.histogram.stale = self._monitor.stale
        if summary is None:
            self.histogram.show_spread(None)
            self.worst.show_value("\u2013")
            return
        unit = self._unit()
        spread = self._spread(summary)
        self.histogram.show_spread(spread, len(summary.inverted), unit)
        if self._monitor.stale:
            self.worst.show_value("\u2026")
        elif math.isnan(spread.worst):
            self.worst.show_value("\u2013")
        else:
            value = f"{spread.worst:.1f}{unit}" if unit else f"{spread.worst:.2f}"
            self.worst.show_value(value.replace("-", "\u2212"), leads=True)

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        line = QHBoxLayout(self.measures)
        line.setContentsMargins(0, 0, 0, 0)
        line.setSpacing(2)
        for switch in self.switches.values():
            line.addWidget(switch)
        layout.addWidget(self.histogram)
        layout.addWidget(self.worst)

    def _unit(self) -> str:
        return next(unit for name, *_, unit in _MEASURES if name == self.measure)

    def _spread(self, summary: QualitySummary) -> Spread:
        return summary.jacobian if self.measure == JACOBIAN else summary.angle

    def _on_switched(self) -> None:
        self._settings.put(_KEY, self.measure)
        self.show_measured()

    def _on_worst_clicked(self) -> None:
        if self._monitor.summary is not None:
            self.worst_chosen.emit(self._spread(self._monitor.summary).worst_element)
