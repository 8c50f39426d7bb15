"""The list of hints in the agent panel: number, operation, probability, change of s."""

from __future__ import annotations

from functools import partial

from qtpy.QtCore import QEvent, QObject, Qt, Signal
from qtpy.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from meshwright.desktop.canvas.layers.ghost import change_colour
from meshwright.desktop.canvas.layers.hints import Hint
from meshwright.desktop.widgets.basic import named, tabular
from meshwright.graphics.markers import label
from meshwright.graphics.theme import GRID, Theme

MOST = 5


class HintRow(QPushButton):
    """One hint; a click applies it."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("HintRow")
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.number = named("", "Key")
        self.number.setFixedSize(22, 20)
        self.number.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.title = QLabel()
        self.chance = named("", "Label")
        self.change = named("", "Value")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(GRID, 0, GRID, 0)
        layout.setSpacing(GRID)
        layout.addWidget(self.number)
        layout.addWidget(self.title, 1)
        for part, width in ((self.chance, 44), (self.change, 24)):
            part.setFont(tabular(part.font()))
            part.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            part.setMinimumWidth(width)
            layout.addWidget(part)
        for part in (self.number, self.title, self.chance, self.change):
            part.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFixedHeight(30)

    def show_hint(self, hint: Hint, theme: Theme) -> None:
        """Show this hint."""
        change = label(hint.ghost.change)
        self.number.setText(str(hint.number))
        self.title.setText(f"{hint.title}, next step" if hint.is_next else hint.title)
        self.chance.setText(hint.chance)
        self.change.setText(change)
        self.change.setStyleSheet(f"color: {change_colour(hint.ghost.change, theme)};")
        step = "; Step applies this one" if hint.is_next else ""
        self.setToolTip(f"Apply: s changes by {change}  ({hint.number}){step}")
        self.setAccessibleName(f"Hint {hint.number}: {hint.title}, {hint.chance}, s {change}{step}")


class HintList(QWidget):
    """Rows of hints. ``taken(index)``: one was clicked; ``hovered(index)``: the mouse or the
    keyboard focus is on one.
    """

    taken = Signal(int)
    hovered = Signal(int)

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self._theme = theme
        self._hints: tuple[Hint, ...] = ()
        self.rows = [HintRow() for _ in range(MOST)]
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        for index, row in enumerate(self.rows):
            row.clicked.connect(partial(self._on_clicked, index))
            row.installEventFilter(self)
            layout.addWidget(row)
        self.hide()

    def show_hints(self, hints: tuple[Hint, ...]) -> None:
        """Show ``hints``; an empty tuple hides the list."""
        self._hints = hints[:MOST]
        for index, row in enumerate(self.rows):
            row.setVisible(index < len(self._hints))
            if index < len(self._hints):
                row.show_hint(self._hints[index], self._theme)
        self.setVisible(bool(self._hints))

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.show_hints(self._hints)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Report the row under the mouse, or with the focus."""
        if isinstance(watched, HintRow) and event.type() in (
            QEvent.Type.Enter,
            QEvent.Type.FocusIn,
        ):
            self.hovered.emit(self.rows.index(watched))
        return False

    def _on_clicked(self, index: int, checked: bool = False) -> None:
        self.taken.emit(index)
