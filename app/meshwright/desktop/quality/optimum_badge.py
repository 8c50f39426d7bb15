"""The badge of the score panel at s = s*: what is in order, and in amber what is not."""

from __future__ import annotations

from collections.abc import Sequence

from qtpy.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout

from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import named
from meshwright.document.verdict import Finding
from meshwright.graphics.theme import GRID, Theme

PROOF = "s = s*: no connectivity is better under these desired degrees."
TITLE = "Optimal connectivity"
_LINES = 4
"""The most findings."""


class OptimumBadge(QFrame):
    """States that the connectivity is optimal, and what that does not say: the shape of the
    elements, inverted ones, and how far a vertex is from its desired degree.
    """

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self._theme = theme
        self.setObjectName("Optimal")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, GRID, 8, GRID)
        layout.setSpacing(1)
        head = QHBoxLayout()
        head.setSpacing(6)
        self._mark = QLabel()
        self.title = named(TITLE, "OptimalTitle")
        head.addWidget(self._mark)
        head.addWidget(self.title, 1)
        layout.addLayout(head)
        self.lines = [named("", "OptimalText") for _ in range(_LINES)]
        for line in self.lines:
            layout.addWidget(line)
        self.setToolTip(PROOF)
        self._findings: tuple[Finding, ...] = ()
        self.show_findings(())

    @property
    def warns(self) -> bool:
        """Whether something is not in order."""
        return not all(one.in_order for one in self._findings)

    def show_findings(self, findings: Sequence[Finding]) -> None:
        """Show what was measured; empty: nothing yet."""
        self._findings = tuple(findings)
        _paint(self, self.warns)
        _paint(self.title, self.warns)
        shown = self._findings or (Finding("\u2026", True),)
        for line, one in zip(self.lines, shown, strict=False):
            line.setText(one.text if one.in_order else f"\u26a0 {one.text}")
            _paint(line, not one.in_order)
        for number, line in enumerate(self.lines):
            line.setVisible(number < len(shown))
        said = "; ".join(line.text() for line in self.lines[: len(shown)])
        self.setAccessibleName(f"{TITLE}: {said}")
        self.set_theme(self._theme)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        name, colour = ("alert", theme.warning) if self.warns else ("check", theme.accent)
        self._mark.setPixmap(icons.pixmap(name, colour, 16, self.devicePixelRatioF()))


def _paint(widget: QFrame, warns: bool) -> None:
    """Use the style sheet's amber for what is not in order."""
    if widget.property("warns") != warns:
        widget.setProperty("warns", warns)
        widget.style().polish(widget)
