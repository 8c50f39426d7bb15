"""The agent panel: choice of policy, buttons for hints and runs, progress."""

from __future__ import annotations

from functools import partial

from qtpy.QtCore import QSignalBlocker, Qt, QTimer
from qtpy.QtGui import QAction
from qtpy.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QSlider,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from meshwright.assistant.assistant import Assistant, State
from meshwright.assistant.outcome import shape_wanted
from meshwright.assistant.policy_catalogue import kind_of, label, shipped
from meshwright.assistant.search_runner import PREFERENCES
from meshwright.desktop.agent.hint_list import HintList
from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.controller import Connections
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.action_set import ActionSet
from meshwright.desktop.widgets.basic import ShareBar, named
from meshwright.desktop.widgets.number_box import IntegerBox
from meshwright.document.document import Document
from meshwright.graphics.theme import GRID, Theme

NO_POLICY = {"tri": "No policy for triangle meshes", "quad": "No policy for quad meshes"}
SPEEDS = (0.5, 1, 2, 4, 6, 10, 15, 20, 30, 60)
"""Steps of the slider, in decisions per second."""
USUAL_SPEED, USUAL_ROLLOUTS, USUAL_SECONDS = 4, 10, 10
MOST_ROLLOUTS, MOST_SECONDS = 1000, 3600
PREFER = "agent/prefer"
"""The setting of what searches prefer at s*."""
PREFERRED = {"blocks": "few blocks", "balanced": "balanced", "shape": "good shape"}
KEEP_SIZE = "agent/keep-size"
"""The setting of whether searches keep the size of the elements."""
TICK = 100
"""Milliseconds between updates of the elapsed time during a run."""
FILES = "agent/files"
"""The setting with the paths of the user's policy files."""
MOST_FILES = 10


class AgentPanel(QWidget):
    """Shows the state of ``assistant``, and that of ``readiness`` until policies can run; its
    buttons trigger ``actions``.
    """

    def __init__(
        self,
        document: Document,
        assistant: Assistant,
        readiness: Readiness,
        settings: Settings,
        actions: ActionSet,
        theme: Theme,
    ) -> None:
        super().__init__()
        self._document = document
        self._assistant, self._readiness = assistant, readiness
        self._actions = actions
        self._settings = settings
        self._theme = theme
        self._files = settings.texts(FILES)
        # whether it was playing, and the theme, when the icons were drawn
        self._drawn: tuple[bool, Theme] | None = None
        self._make_policy()
        self._make_buttons()
        self._make_progress()
        self._arrange()
        self._connections = Connections()
        self._connections.add(document.replaced, self._on_replaced)
        self._connections.add(assistant.changed, self._on_assistant_changed)
        self._connections.add(readiness.changed, self._on_tick)
        self._connections.add(readiness.progressed, self._on_tick)
        self._on_replaced()

    def release(self) -> None:
        """Disconnect from document and assistant."""
        self._clock.stop()
        self._connections.close()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.bar.set_theme(theme)
        self.hints.set_theme(theme)
        self._on_assistant_changed()

    @property
    def rollouts(self) -> int:
        """Number of runs of *Best of*."""
        return int(self.rollouts_box.value())

    @property
    def preference(self) -> str:
        """What searches prefer at s*: "blocks", "balanced" or "shape"."""
        return PREFERENCES[self.prefer.value()]

    @property
    def seconds(self) -> float:
        """Time limit of *Search* in seconds."""
        return float(self.seconds_box.value())

    def offer(self, path: str, kind: str) -> None:
        """Add a policy file for meshes of ``kind`` to the list, also in later sessions."""
        self._files = [path, *(one for one in self._files if one != path)][:MOST_FILES]
        self._settings.put(FILES, self._files)
        if kind == self._document.kind:
            self._fill()

    # Construction

    def _make_policy(self) -> None:
        self.policy = QComboBox()
        self.policy.setToolTip("The policy that hints and runs follow")
        self.policy.setAccessibleName("Policy")
        self.policy.setSizeAdjustPolicy(
            QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        self.policy.currentIndexChanged.connect(self._on_policy_chosen)
        self.more = self._button("agent.policy", "\u2026")
        self.more.setFixedWidth(36)

    def _make_buttons(self) -> None:
        self.hint = self._button("agent.hint", "Hint")
        self.step = self._button("agent.step", "Step")
        self.play = self._button("agent.play", "Play")
        self.complete = self._button("agent.complete", "Complete")
        self.complete.setObjectName("Primary")
        self.stop = self._button("agent.stop", "Stop")
        self.skip = self._button("agent.skip", "Skip")
        self.best_of = self._button("agent.best_of", "Best of")
        self.search = self._button("agent.search", "Search")
        self.region = self._button("agent.region", "Finish only this region")
        self.rollouts_box = self._number("agent/rollouts", MOST_ROLLOUTS, USUAL_ROLLOUTS, " runs")
        self.rollouts_box.setAccessibleName("Runs of Best of")
        self.rollouts_box.setToolTip("Number of runs of Best of")
        self.seconds_box = self._number("agent/seconds", MOST_SECONDS, USUAL_SECONDS, " s")
        self.seconds_box.setAccessibleName("Seconds of Search")
        self.seconds_box.setToolTip("Time limit of Search and of Finish only this region")
        self._make_preference()
        self.watch = QCheckBox("Show what the policy sees")
        self.watch.setToolTip(self._actions["agent.watch"].toolTip())
        self.watch.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.watch.clicked.connect(self._actions["agent.watch"].trigger)
        self._follow(self.watch, "agent.watch")
        self.speed = QSlider(Qt.Orientation.Horizontal)
        self.speed.setRange(0, len(SPEEDS) - 1)
        self.speed.setToolTip("Decisions per second of Play")
        self.speed.setAccessibleName("Speed")
        self.speed.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.pace = named("", "Label")
        usual = self._settings.number("agent/speed", USUAL_SPEED)
        self.speed.setValue(min(range(len(SPEEDS)), key=lambda i: abs(SPEEDS[i] - usual)))
        self._set_speed(self.speed.value())
        self.speed.valueChanged.connect(self._on_speed_moved)

    def _make_preference(self) -> None:
        self.prefer = QSlider(Qt.Orientation.Horizontal)
        self.prefer.setRange(0, len(PREFERENCES) - 1)
        self.prefer.setPageStep(1)
        self.prefer.setTickPosition(QSlider.TickPosition.NoTicks)
        self.prefer.setToolTip(
            "What searches aim at once s is at its optimum: few blocks, or corners as good as the"
            " outline permits"
        )
        self.prefer.setAccessibleName("Blocks or shape")
        self.prefer.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.preferred = named("", "Label")
        self.keep_size = QCheckBox("Keep the size of the elements")
        self.keep_size.setToolTip(
            "Searches keep the size of the elements; otherwise they look for few, large blocks"
        )
        self.keep_size.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.keep_size.setChecked(self._settings.flag(KEEP_SIZE, False))
        self.keep_size.toggled.connect(partial(self._settings.put, KEEP_SIZE))
        self.prefer.setValue(PREFERENCES.index(self._settings.choice(PREFER, _PREFERRED_FIRST)))
        self.prefer.valueChanged.connect(self._on_preferred)
        self._show_preference()

    def _show_preference(self) -> None:
        self.preferred.setText(PREFERRED[self.preference].capitalize())
        self.prefer.setAccessibleDescription(PREFERRED[self.preference])

    def _on_preferred(self, index: int) -> None:
        self._settings.put(PREFER, self.preference)
        self._show_preference()

    def _make_progress(self) -> None:
        self.bar = ShareBar(self._theme)
        self.bar.hide()
        self.progress = named("", "Hint")
        self.progress.setWordWrap(True)
        self.progress.setMinimumHeight(18)
        self.hints = HintList(self._theme)
        self._clock = QTimer(self)
        self._clock.setInterval(TICK)
        self._clock.timeout.connect(self._on_tick)

    def _button(self, name: str, text: str) -> QPushButton:
        """A button for an action; a click leaves the keyboard focus with the canvas."""
        action: QAction = self._actions[name]
        made = QPushButton(text)
        made.setToolTip(action.toolTip())
        made.setAccessibleName(action.text())
        made.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        made.clicked.connect(action.trigger)
        self._follow(made, name)
        return made

    def _follow(self, widget: QWidget, name: str) -> None:
        """Enable ``widget`` while the action is enabled."""
        widget.setEnabled(self._actions[name].isEnabled())
        self._actions[name].enabledChanged.connect(widget.setEnabled)

    def _number(self, key: str, most: int, usual: int, unit: str) -> QSpinBox:
        made = IntegerBox()
        made.setRange(1, most)
        made.setSuffix(unit)
        made.setValue(round(min(max(self._settings.number(key, usual), 1), most)))
        made.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        made.setKeyboardTracking(False)
        made.valueChanged.connect(partial(self._settings.put, key))
        return made

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(GRID)
        layout.addLayout(_line((self.policy, 1), (self.more, 0)))
        layout.addLayout(_line((self.complete, 1), (self.stop, 1)))
        self.preferred.setMinimumWidth(self.preferred.fontMetrics().horizontalAdvance("Good shape"))
        layout.addLayout(_line((self.prefer, 1), (self.preferred, 0)))
        layout.addWidget(self.keep_size)
        layout.addWidget(self.bar)
        layout.addLayout(_line((self.progress, 1), (self.skip, 0)))
        layout.addLayout(_line((self.hint, 1), (self.step, 1), (self.play, 1)))
        layout.addWidget(self.hints)
        layout.addLayout(_line((self.speed, 1), (self.pace, 0)))
        layout.addWidget(self.watch)
        grid = QGridLayout()
        grid.setSpacing(GRID)
        for row, (button, box) in enumerate(
            ((self.best_of, self.rollouts_box), (self.search, self.seconds_box))
        ):
            grid.addWidget(button, row, 0)
            grid.addWidget(box, row, 1)
        grid.setColumnStretch(0, 1)
        grid.setColumnStretch(1, 1)
        layout.addLayout(grid)
        layout.addWidget(self.region)

    # Following

    def _on_replaced(self) -> None:
        """List the policies for the kind of the new mesh."""
        names = self._fill()
        if self._assistant.policy not in names:
            self._assistant.policy = names[0] if names else ""
        self._on_assistant_changed()

    def _fill(self) -> list[str]:
        """Fill the box with the policies for the kind of the mesh, and return their names."""
        kind = self._document.kind
        names = shipped(kind) if kind else []
        names += [path for path in self._files if kind and _is_for(path, kind)]
        with QSignalBlocker(self.policy):
            self.policy.clear()
            for name in names:
                self.policy.addItem(label(name), name)
                if label(name) != name:
                    self.policy.setItemData(
                        self.policy.count() - 1, name, Qt.ItemDataRole.ToolTipRole
                    )
            if not names:
                self.policy.addItem("No policy" if not kind else NO_POLICY[kind])
        self.policy.setEnabled(bool(names))
        self._select()
        return names

    def _select(self) -> None:
        """Show the policy in use."""
        at = self.policy.findData(self._assistant.policy)
        if at >= 0 and at != self.policy.currentIndex():
            with QSignalBlocker(self.policy):
                self.policy.setCurrentIndex(at)

    def _on_policy_chosen(self, index: int) -> None:
        name = self.policy.itemData(index)
        if name:
            self._assistant.choose(name)
            self._select()  # the chosen policy is in use only once it is loaded

    def _on_speed_moved(self, index: int) -> None:
        self._set_speed(index)
        self._settings.put("agent/speed", SPEEDS[index])

    def _set_speed(self, index: int) -> None:
        self._assistant.speed = SPEEDS[index]
        self.pace.setText(f"{SPEEDS[index]:g} per second")

    def _on_assistant_changed(self) -> None:
        assistant = self._assistant
        playing = assistant.state is State.PLAYING
        self.play.setText(
            "Pause" if playing else "Resume" if assistant.state is State.PAUSED else "Play"
        )
        if self._drawn != (playing, self._theme):
            self._drawn = (playing, self._theme)
            self.step.setIcon(icons.icon("step", self._theme))
            self.play.setIcon(icons.icon("pause" if playing else "play", self._theme))
        self.stop.setText("Stop now" if assistant.stopping else "Stop")
        self.skip.setVisible(assistant.state is State.GOING)
        self.complete.setText("Go on" if assistant.unfinished else "Complete")
        self.watch.setChecked(assistant.watch)
        self._select()
        if assistant.running != self._clock.isActive():
            if assistant.running:
                self._clock.start()
            else:
                self._clock.stop()
        self._on_tick()

    def _on_tick(self) -> None:
        ready = self._readiness.agent
        share = self._assistant.progress.share if ready else self._readiness.share
        self.bar.setVisible(share is not None)
        self.bar.share = share or 0.0
        text = activity(self._assistant) if ready else self._readiness.preparing
        if text != self.progress.text():
            self.progress.setText(text)


_PREFERRED_FIRST = ("balanced", *(one for one in PREFERENCES if one != "balanced"))


def activity(assistant: Assistant) -> str:
    """The state of the assistant in a few words."""
    progress = assistant.progress
    decisions = progress.counted
    best = "" if progress.best is None else f", best s {progress.best:,}"
    if assistant.loading:
        return "Loading the policy\u2026"
    if assistant.hinting.asking:
        return "Computing hints\u2026"
    if progress.way is not None:
        return "Going there: {:,} of {:,}".format(*progress.way)
    if assistant.stopping:
        return f"Stopping{best}"
    if assistant.state is State.SEARCHING:
        effort = progress.effort
        done = (
            f", {progress.rollouts} of {effort.rollouts} runs" if effort and effort.rollouts else ""
        )
        above = f", {progress.gap:,} above the optimum" if (progress.gap or 0) > 0 else ""
        shape = f", {shape_wanted(progress.shape)}" if progress.shape else ""
        return f"Searching: {progress.elapsed:.1f} s{done}{best}{above}{shape}"
    if assistant.state is State.PAUSED:
        return f"Paused after {decisions}{best}"
    if assistant.state is State.PLAYING:
        return f"Playing: {decisions}, {progress.elapsed:.0f} s{best}"
    if assistant.outcome:
        return assistant.outcome
    return f"{decisions} taken{best}" if progress.decisions else "Ready" if assistant.policy else ""


def _is_for(path: str, kind: str) -> bool:
    """Whether the file still exists and holds a policy for this kind of mesh."""
    try:
        return kind_of(path) == kind
    except (ValueError, OSError):
        return False


def _line(*members: tuple[QWidget, int]) -> QHBoxLayout:
    line = QHBoxLayout()
    line.setSpacing(GRID)
    for member, stretch in members:
        line.addWidget(member, stretch)
    return line
