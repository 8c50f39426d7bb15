"""The timeline under the canvas: playback buttons and the score curve."""

from qtpy.QtCore import QSignalBlocker, QSize, Qt, Signal
from qtpy.QtWidgets import QComboBox, QFrame, QHBoxLayout, QToolButton, QVBoxLayout

from meshwright.desktop.history.score_curve import HEIGHT, ScoreCurve
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.action_set import ActionSet
from meshwright.graphics.theme import GRID, Theme

SPEEDS = (1, 2, 4, 8, 15, 30, 60)
"""Playback speeds in steps per second."""
BUTTONS = (
    ("history.first", "first"),
    ("history.back", "back"),
    ("history.play", "play"),
    ("history.forward", "forward"),
    ("history.last", "last"),
)


class TimelineBar(QFrame):
    """Buttons, speed and curve; ``speed_chosen(steps per second)``."""

    speed_chosen = Signal(int)

    def __init__(self, actions: ActionSet, theme: Theme) -> None:
        super().__init__()
        self.setObjectName("Timeline")
        self.setFixedHeight(HEIGHT)
        self._actions = actions
        self._theme = theme
        self._playing = False
        self.curve = ScoreCurve(theme)
        self.buttons: dict[str, QToolButton] = {}
        self.speed = QComboBox()
        self.speed.setToolTip("Playback speed")
        self.speed.setAccessibleName("Playback speed")
        self.speed.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        for speed in SPEEDS:
            self.speed.addItem(f"{speed} step{'' if speed == 1 else 's'} / s", speed)
        self.speed.currentIndexChanged.connect(self._on_speed_chosen)
        self._arrange()
        self.set_theme(theme)

    def _arrange(self) -> None:
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        column = QVBoxLayout()
        column.setContentsMargins(GRID, GRID, 0, GRID)
        column.setSpacing(GRID // 2)
        line = QHBoxLayout()
        line.setSpacing(0)
        for action_id, _ in BUTTONS:
            line.addWidget(self._button(action_id))
        column.addLayout(line)
        below = QHBoxLayout()
        below.setSpacing(GRID // 2)
        below.addWidget(self.speed, 1)
        below.addWidget(self._button("history.export"))
        column.addLayout(below)
        layout.addLayout(column)
        layout.addWidget(self.curve, 1)

    def _button(self, action_id: str) -> QToolButton:
        action = self._actions[action_id]
        made = QToolButton()
        made.setObjectName("Walk")
        made.setIconSize(QSize(16, 16))
        made.setToolTip(action.toolTip())
        made.setAccessibleName(action.text())
        made.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        made.setAutoRepeat(action_id in ("history.back", "history.forward"))
        made.clicked.connect(action.trigger)
        made.setEnabled(action.isEnabled())
        action.enabledChanged.connect(made.setEnabled)
        self.buttons[action_id] = made
        return made

    def set_theme(self, theme: Theme) -> None:
        """Draw curve and icons in other colours."""
        self._theme = theme
        self.curve.set_theme(theme)
        for action_id, name in (*BUTTONS, ("history.export", "film")):
            self.buttons[action_id].setIcon(icons.icon(name, theme))
        self.show_playing(self._playing)

    def show_playing(self, playing: bool) -> None:
        """Show the pause icon while playing, else the play icon."""
        self._playing = playing
        icon = icons.icon("pause" if playing else "play", self._theme)
        self.buttons["history.play"].setIcon(icon)

    def show_speed(self, speed: int) -> None:
        """Select a speed."""
        with QSignalBlocker(self.speed):
            self.speed.setCurrentIndex(SPEEDS.index(speed))

    def _on_speed_chosen(self, index: int) -> None:
        self.speed_chosen.emit(SPEEDS[index])
