"""The agent panel: which policy, and how far it goes."""

from qtpy.QtCore import QSignalBlocker, Qt
from qtpy.QtGui import QAction
from qtpy.QtWidgets import QComboBox, QHBoxLayout, QPushButton, QSlider, QVBoxLayout, QWidget

from app.assistant import Assistant, State
from app.desktop import icons
from app.desktop.actions import ActionSet
from app.desktop.tables.agent import BEST_OF, SEARCHES
from app.desktop.widgets import named
from app.document import Document
from app.policy_files import shipped
from app.theme import GRID, Theme

NO_POLICY = {"tri": "No policy for triangle meshes", "quad": "No policy for quad meshes"}
SPEEDS = (0.5, 1, 2, 4, 6, 10, 15, 20, 30, 60)
"""What the slider offers, in decisions per second."""


_SEARCH = f"agent.search_{SEARCHES[0][0]}"


class AgentPanel(QWidget):
    """Follows the assistant; its buttons are the table's actions."""

    def __init__(
        self, document: Document, assistant: Assistant, actions: ActionSet, theme: Theme
    ) -> None:
        super().__init__()
        self._document = document
        self._assistant = assistant
        self._actions = actions
        self._theme = theme
        self.policy = QComboBox()
        self.policy.setToolTip("The policy that Step, Play and Complete follow")
        self.policy.currentIndexChanged.connect(self._on_policy_chosen)
        self.step = _button(actions["agent.step"], "Step")
        self.play = _button(actions["agent.play"], "Play")
        self.complete = _button(actions["agent.complete"], "Complete")
        self.complete.setObjectName("Primary")
        self.best_of = _button(actions["agent.best_of"], f"Best of {BEST_OF}")
        self.search = _button(actions[_SEARCH], f"Search {SEARCHES[0][0]} s")
        self.stop = _button(actions["agent.stop"], "Stop")
        self.speed = QSlider(Qt.Orientation.Horizontal)
        self.speed.setRange(0, len(SPEEDS) - 1)
        self.speed.setToolTip("Decisions per second of Play")
        self.speed.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.speed.valueChanged.connect(self._on_speed_moved)
        self.pace = named("", "Label")
        self.progress = named("", "Hint")
        self.progress.setWordWrap(True)
        self.progress.setMinimumHeight(18)
        self._arrange()
        document.replaced.connect(self._on_replaced)
        assistant.changed.connect(self._on_assistant_changed)
        self.speed.setValue(SPEEDS.index(4))
        self._on_replaced()

    def release(self) -> None:
        """Let go of document and assistant."""
        self._document.replaced.disconnect(self._on_replaced)
        self._assistant.changed.disconnect(self._on_assistant_changed)

    def set_theme(self, theme: Theme) -> None:
        """Draw the icons again."""
        self._theme = theme
        self._on_assistant_changed()

    def refresh(self) -> None:
        """Enable the buttons whose actions are enabled."""
        for button, name in (
            (self.step, "agent.step"),
            (self.play, "agent.play"),
            (self.complete, "agent.complete"),
            (self.best_of, "agent.best_of"),
            (self.search, _SEARCH),
            (self.stop, "agent.stop"),
        ):
            button.setEnabled(self._actions[name].isEnabled())

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(GRID)
        layout.addWidget(self.policy)
        for pair in (
            (self.step, self.play),
            (self.complete, self.stop),
            (self.best_of, self.search),
        ):
            line = QHBoxLayout()
            line.setSpacing(GRID)
            for button in pair:
                line.addWidget(button, 1)
            layout.addLayout(line)
        line = QHBoxLayout()
        line.setSpacing(GRID)
        line.addWidget(self.speed, 1)
        line.addWidget(self.pace)
        layout.addLayout(line)
        layout.addWidget(self.progress)

    def _on_replaced(self) -> None:
        """Another mesh: offer the policies of its kind."""
        kind = self._document.kind
        names = shipped(kind) if kind else []
        with QSignalBlocker(self.policy):
            self.policy.clear()
            for name in names:
                self.policy.addItem(name)
            if not names:
                self.policy.addItem("No policy yet" if not kind else NO_POLICY[kind])
            if self._assistant.policy in names:
                self.policy.setCurrentText(self._assistant.policy)
        self.policy.setEnabled(bool(names))
        if self._assistant.policy not in names:
            self._assistant.policy = names[0] if names else ""
        self._on_assistant_changed()

    def _on_policy_chosen(self, index: int) -> None:
        self._assistant.policy = self.policy.itemText(index)

    def _on_speed_moved(self, index: int) -> None:
        self._assistant.speed = SPEEDS[index]
        self.pace.setText(f"{SPEEDS[index]:g} per second")

    def _on_assistant_changed(self) -> None:
        state = self._assistant.state
        playing = state is State.PLAYING
        going_on = state is State.PAUSED and not playing
        self.step.setIcon(icons.icon("step", self._theme))
        self.play.setIcon(icons.icon("pause" if playing else "play", self._theme))
        self.play.setText("Pause" if playing else "Go on" if going_on else "Play")
        self.progress.setText(progress(self._assistant))
        self.refresh()


def progress(assistant: Assistant) -> str:
    """What the assistant is doing, in a few words."""
    count = assistant.progress.decisions
    decisions = f"{count} decision{'' if count == 1 else 's'}"
    if assistant.loading:
        return "Loading the policy\u2026"
    if assistant.state is State.PAUSED:
        return f"Paused after {decisions}"
    if assistant.state is State.SEARCHING:
        best = assistant.progress.best
        return "Searching\u2026" if best is None else f"Searching: s {best} is the best so far"
    if assistant.running:
        return f"{assistant.state.value.capitalize()}: {decisions}"
    return f"{decisions} taken" if count else "Ready" if assistant.policy else ""


def _button(action: QAction, text: str) -> QPushButton:
    """A button for ``action`` that leaves the keyboard to the canvas."""
    made = QPushButton(text)
    made.setToolTip(action.toolTip())
    made.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    made.clicked.connect(action.trigger)
    return made
