"""The level bar over the canvas: goal, operations used, and stars."""

from __future__ import annotations

from qtpy.QtCore import Qt, Signal
from qtpy.QtGui import QResizeEvent
from qtpy.QtWidgets import QFrame, QHBoxLayout, QPushButton, QToolButton, QVBoxLayout, QWidget

from meshwright.desktop.levels.star_rating import StarRating
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import named, tabular
from meshwright.graphics.theme import GRID, Theme
from meshwright.puzzles import level as levels
from meshwright.puzzles.agent_opponent import OpponentState
from meshwright.puzzles.play import LevelPlay

WIDE = 1120
"""Width in pixels from which two lines of text are enough; otherwise there are three."""


class LevelFigure(QWidget):
    """A name and a number."""

    def __init__(self, title: str, tooltip: str) -> None:
        super().__init__()
        line = QHBoxLayout(self)
        line.setContentsMargins(0, 0, 0, 0)
        line.setSpacing(6)
        self._title = title
        self._value = named("", "LevelValue")
        self._value.setFont(tabular(self._value.font()))
        line.addWidget(named(title, "Label"))
        line.addWidget(self._value)
        self.setToolTip(tooltip)

    @property
    def text(self) -> str:
        """The number as text."""
        return str(self._value.text())

    def show_value(self, text: str) -> None:
        """Show another number."""
        self._value.setText(text)
        self._value.ensurePolished()
        self._value.setMinimumWidth(0)  # else the size hint is that of the widest text so far
        self._value.setMinimumWidth(self._value.sizeHint().width())
        self.setAccessibleName(f"{self._title}: {text}")


class LevelBar(QFrame):
    """Shows a :class:`LevelPlay`; ``action_requested(action)`` when a button is clicked: "again",
    "answer", "next" or "leave".
    """

    action_requested = Signal(str)

    def __init__(self, play: LevelPlay, theme: Theme) -> None:
        super().__init__()
        self._play = play
        self.setObjectName("LevelBar")
        column = QVBoxLayout(self)
        column.setContentsMargins(2 * GRID, GRID, GRID, 12)
        column.setSpacing(GRID // 2)
        column.addLayout(self._make_head(theme))
        column.addLayout(self._make_body())
        self.set_theme(theme)
        self.hide()

    def _make_head(self, theme: Theme) -> QHBoxLayout:
        self.title = named("", "LevelTitle")
        self.place = named("", "Hint")
        self.stars = StarRating(theme, 18)
        self.goal = LevelFigure("Goal", "The score to reach: the lowest that is possible")
        self.par = LevelFigure("Par", "The fewest operations known")
        self.used = LevelFigure("You", "Your operations since the start; Undo takes them back")
        self.agent = LevelFigure("Agent", "Operations of the agent on a copy of the level")
        self.leave = QToolButton()
        self.leave.setToolTip("Leave the level and keep the mesh")
        self.leave.setAccessibleName("Leave the level")
        self.leave.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.leave.clicked.connect(lambda checked=False: self.action_requested.emit("leave"))
        line = QHBoxLayout()
        line.setSpacing(GRID)
        for part in (self.title, self.place, self.stars):
            line.addWidget(part)
        line.addStretch(1)
        for figure in (self.goal, self.par, self.used, self.agent):
            line.addWidget(figure)
            line.addSpacing(GRID)
        line.addWidget(self.leave)
        return line

    def _make_body(self) -> QHBoxLayout:
        self.text = named("", "LevelText")
        self.text.setWordWrap(True)
        self.text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.again = self._button("Restart", "again", "Restart the level")
        self.answer = self._button("Ask the agent", "answer", "")
        self.next = self._button("Next", "next", "Start the next level")
        line = QHBoxLayout()
        line.setContentsMargins(0, 0, GRID, 0)
        line.setSpacing(GRID)
        line.addWidget(self.text, 1)
        line.addSpacing(2 * GRID)
        for button in (self.again, self.answer, self.next):
            line.addWidget(button)
        return line

    def _button(self, title: str, action: str, tooltip: str) -> QPushButton:
        made = QPushButton(title)
        made.setToolTip(tooltip)
        made.clicked.connect(lambda checked=False: self.action_requested.emit(action))
        return made

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self.stars.set_theme(theme)
        self.leave.setIcon(icons.icon("close", theme))

    def refresh(self) -> None:
        """Update the bar from the state of the game."""
        play, level = self._play, self._play.level
        self.setVisible(level is not None)
        if level is None:
            return
        self.title.setText(play.headline or level.title)
        self.place.setText(f"{level.number} of {len(levels.names())}")
        self.text.setText(play.remark or level.text)
        self.goal.show_value(level.aim)
        self.par.show_value(str(level.par))
        self.par.setToolTip(
            "Proven minimum: all shorter sequences were tried"
            if level.proved
            else "The fewest operations known; fewer may be possible"
        )
        self.used.show_value(str(play.used))
        self.stars.count = play.stars if play.done else play.best
        self._refresh_agent()
        self._refresh_looks(level.name)
        self._keep_height()

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Adapt the number of lines to the width."""
        super().resizeEvent(event)
        self._keep_height()

    def _keep_height(self) -> None:
        """Keep the height the same in all states, so that the mesh does not move."""
        lines = 2 if self.width() > WIDE else 3
        self.text.setFixedHeight(lines * self.text.fontMetrics().lineSpacing())

    def _refresh_agent(self) -> None:
        play, rival = self._play, self._play.rival
        level = play.level
        standing = rival.standing if rival is not None else None
        self.agent.setVisible(rival is not None)
        if rival is not None and standing is OpponentState.ASKED:
            self.agent.show_value("\u2026")
        elif rival is not None:
            reached = level is not None and rival.score <= level.goal
            shown = str(len(rival.operations)) if standing is OpponentState.DONE else "\u2013"
            self.agent.show_value(shown if reached else f"{shown} (s {rival.score})")
        solved = standing is OpponentState.DONE or (level is not None and bool(level.most))
        self.answer.setText("Show a solution" if solved else "Ask the agent")
        self.answer.setEnabled(standing is not OpponentState.ASKED)
        self.answer.setToolTip(
            "Restart with this solution: Redo steps through it"
            if solved
            else "Let the agent solve a copy of this level, and compare"
        )

    def _refresh_looks(self, name: str) -> None:
        """Update the colours, which depend on whether the level is won."""
        won = self._play.done and self._play.stars > 0
        last = levels.after(name) is None
        self.next.setEnabled(not last)
        self.next.setObjectName("Primary" if won and not last else "")
        self.setProperty("won", won)
        self.text.setProperty("tone", "won" if won else "warns" if self._play.remark else "")
        for part in (self, self.next, self.text, self.title):
            part.style().unpolish(part)
            part.style().polish(part)
