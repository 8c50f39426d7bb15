"""The film: the history as something to walk through, to play and to export."""

from __future__ import annotations

from typing import TYPE_CHECKING

from qtpy.QtCore import QTimer

from meshwright.desktop.history.export_controller import Exporting
from meshwright.desktop.history.history_panel import HistoryPanel
from meshwright.desktop.history.timeline import SPEEDS, Timeline
from meshwright.document import score_series
from meshwright.document.score_series import ScoreSeries
from meshwright.graphics.theme import Theme

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow

PAUSE = 100
"""Milliseconds after a change until list and curve follow: the mesh is drawn before."""
PREPARING = "Still preparing the operations: a moment, please."


class Film:
    """History list, timeline and export of one window."""

    panel: HistoryPanel
    timeline: Timeline
    exporting: Exporting

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        settings = window.settings
        self.lists = settings.flag("film/list", True)
        self.times = settings.flag("film/timeline", True)
        self._speed = settings.number("film/speed", 4)
        if self._speed not in SPEEDS:
            self._speed = 4
        self._wanted = 0
        self._ours = False  # a change of the history that this controller makes itself
        self._late = QTimer(window, singleShot=True, interval=PAUSE)
        self._late.timeout.connect(self._show)
        self._soon = QTimer(window, singleShot=True, interval=0)
        self._soon.timeout.connect(self._arrive)
        self._clock = QTimer(window)
        self._clock.timeout.connect(self._tick)

    def connect(self) -> None:
        """Take a place in the window, and follow the document."""
        window, theme = self._window, self._window.theme
        self.panel = HistoryPanel(theme)
        self.timeline = Timeline(window.actions_by_id, theme)
        self.exporting = Exporting(window)
        window.left.fill(self.panel)
        window.column.addWidget(self.exporting.bar)
        window.column.addWidget(self.timeline)
        for part in (self.panel, self.timeline.curve):
            part.asked.connect(self._on_asked)
            part.branch_asked.connect(self.take_branch)
        self.timeline.curve.walked.connect(self.walk)
        self.timeline.speed_chosen.connect(self._on_speed_chosen)
        self.timeline.show_speed(int(self._speed))
        window.document.history_changed.connect(self._on_history_changed)
        window.document.replaced.connect(self._on_replaced)
        self._on_replaced()

    def release(self) -> None:
        """Let go of the document, end what runs."""
        self._window.document.history_changed.disconnect(self._on_history_changed)
        self._window.document.replaced.disconnect(self._on_replaced)
        for timer in (self._late, self._soon, self._clock):
            timer.stop()
        self.exporting.close()

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        for part in (self.panel, self.timeline, self.exporting.bar):
            part.set_theme(theme)

    # Walking

    @property
    def playing(self) -> bool:
        """True while the recorded steps are played."""
        return bool(self._clock.isActive())

    def go_to(self, state: int) -> None:
        """Show a state of the history; a film that plays is held."""
        self.hold()
        self._go(state)

    def walk(self, steps: int) -> None:
        """Go so many steps forward, or back."""
        self.go_to(self._window.document.history.cursor + steps)

    def go_to_best(self) -> None:
        """Show the first state with the lowest score under the present desired degrees."""
        track = ScoreSeries()
        track.follow(self._window.document.history)
        self.go_to(score_series.best_state(track.scores, track.optima))

    def take_branch(self, index: int) -> None:
        """Go to the end of a branch; the steps that are left for it become a branch."""
        self.hold()
        if not self._is_ready():
            return
        document = self._window.document
        if index < len(document.history.branches):
            document.take_branch(index)
            self._window.say(f"On the branch: s {document.score:,}. The other way is kept.")

    def take_last_branch(self) -> None:
        """Take the branch that was left last."""
        branches = self._window.document.history.branches
        if branches:
            self.take_branch(max(range(len(branches)), key=lambda i: branches[i].made))

    def play_or_hold(self) -> None:
        """Play from here, or from the start where this is the end; or hold."""
        if self.playing:
            self.hold()
            return
        document = self._window.document
        if len(document.history) == 0 or not self._is_ready():
            return
        if not document.can_redo:
            self._go(0)
        self._clock.start(round(1000 / self._speed))
        self.timeline.show_playing(True)

    def hold(self) -> None:
        """Stop playing, here."""
        if self.playing:
            self._clock.stop()
            self.timeline.show_playing(False)

    def _tick(self) -> None:
        document = self._window.document
        self._go(document.history.cursor + 1)
        if not document.can_redo:
            self.hold()

    def _go(self, state: int) -> None:
        if not self._is_ready():
            return
        self._ours = True
        try:
            self._window.document.go_to(state)
        finally:
            self._ours = False

    def _is_ready(self) -> bool:
        if not self._window.ready:
            self._window.say(PREPARING)
        return bool(self._window.ready)

    def _on_asked(self, state: int) -> None:
        self.hold()
        self._wanted = state
        self._soon.start()  # a drag asks for more states than can be drawn: the last one counts

    def _arrive(self) -> None:
        self.go_to(self._wanted)
        if not self._late.isActive():
            self._show()  # nothing has changed: the curve must not stay where the mouse was

    def _on_speed_chosen(self, speed: int) -> None:
        self._speed = speed
        self._window.settings.put("film/speed", speed)
        if self.playing:
            self._clock.start(round(1000 / speed))

    # What is seen

    def show_list(self, shown: bool) -> None:
        """Show or hide the list."""
        self.lists = shown
        self._window.settings.put("film/list", shown)
        self._arrange()

    def show_timeline(self, shown: bool) -> None:
        """Show or hide the timeline."""
        self.times = shown
        self._window.settings.put("film/timeline", shown)
        self._arrange()

    def export(self) -> None:
        """Ask what to write, then write it in the background."""
        self.exporting.ask()

    def _arrange(self) -> None:
        empty = self._window.document.empty
        self.panel.setVisible(self.lists and not empty)
        self.timeline.setVisible(self.times and not empty)
        self._show()

    def _on_replaced(self) -> None:
        self.hold()
        self._arrange()

    def _on_history_changed(self) -> None:
        if not self._ours:
            self.hold()
        if not self._late.isActive():
            self._late.start()

    def _show(self) -> None:
        document = self._window.document
        self._late.stop()
        if self._soon.isActive():
            self._late.start()  # the line is where the mouse is, and the mesh will be there soon
            return
        if self.panel.isVisibleTo(self._window):
            self.panel.show_history(document.history, document.empty)
        if self.timeline.isVisibleTo(self._window):
            self.timeline.curve.show_history(document.history, document.empty)
            self.timeline.refresh()
