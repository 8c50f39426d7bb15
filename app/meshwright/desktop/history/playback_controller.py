"""Navigation, playback and export of the history."""

from __future__ import annotations

from qtpy.QtCore import QTimer
from qtpy.QtWidgets import QWidget

from meshwright.desktop.application.readiness import PREPARING, Readiness
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.controller import Controller
from meshwright.desktop.history.export_controller import ExportController
from meshwright.desktop.history.history_panel import HistoryPanel
from meshwright.desktop.history.timeline import SPEEDS, TimelineBar
from meshwright.desktop.widgets.action_set import ActionSet
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document import score_series
from meshwright.document.document import Document
from meshwright.document.score_series import ScoreSeries
from meshwright.graphics.theme import Theme

PAUSE = 100
"""Milliseconds between a change and the update of list and curve, which follow the mesh."""


class PlaybackController(Controller):
    """Moves through the history; owns the history list, the timeline and the export."""

    def __init__(
        self,
        document: Document,
        settings: Settings,
        readiness: Readiness,
        actions: ActionSet,
        status: StatusBar,
        notice: NoticeBar,
        parent: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._settings = document, settings
        self._readiness, self._status, self._parent = readiness, status, parent
        self.lists = settings.flag("film/list", True)
        self.times = settings.flag("film/timeline", True)
        self._speed = settings.number("film/speed", 4)
        if self._speed not in SPEEDS:
            self._speed = 4
        self._wanted = 0
        self._ours = False  # whether this controller is changing the history itself
        self.moving = False
        """Whether the last change of the document was a move through the history."""
        self._late = QTimer(parent, singleShot=True, interval=PAUSE)
        self._late.timeout.connect(self._show)
        self._soon = QTimer(parent, singleShot=True, interval=0)
        self._soon.timeout.connect(self._arrive)
        self._clock = QTimer(parent)
        self._clock.timeout.connect(self._tick)
        self.panel = HistoryPanel(theme)
        self.timeline = TimelineBar(actions, theme)
        self.exporting = ExportController(document, settings, status, notice, parent, theme)
        for widget in (self.panel, self.timeline):
            widget.setParent(parent)  # else they would be windows of their own when they are shown
        for part in (self.panel, self.timeline.curve):
            part.state_requested.connect(self._on_state_requested)
            part.branch_requested.connect(self.take_branch)
        self.timeline.curve.step_requested.connect(self.walk)
        self.timeline.speed_chosen.connect(self._on_speed_chosen)
        self.timeline.show_speed(int(self._speed))
        self._connections.add(document.history_changed, self._on_history_changed)
        self._connections.add(document.replaced, self._on_replaced)
        self._on_replaced()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        super().set_theme(theme)
        for part in (self.panel, self.timeline, self.exporting):
            part.set_theme(theme)

    def close(self) -> None:
        """Disconnect, stop playing, and cancel an export."""
        super().close()
        for timer in (self._late, self._soon, self._clock):
            timer.stop()
        self.exporting.close()

    # Navigation

    @property
    def playing(self) -> bool:
        """True while the recorded steps are played."""
        return self._clock.isActive()

    def go_to(self, state: int) -> None:
        """Go to a state of the history; stops playback."""
        self.hold()
        self._go(state)

    def walk(self, steps: int) -> None:
        """Go forward by a number of steps; back if it is negative."""
        self.go_to(self._document.history.cursor + steps)

    def go_to_best(self) -> None:
        """Go to the first state with the lowest score under the current desired degrees."""
        track = ScoreSeries()
        track.follow(self._document.history)
        self.go_to(score_series.best_state(track.scores, track.optima))

    def take_branch(self, index: int) -> None:
        """Switch to the end of a branch; the steps that are left become a branch."""
        self.hold()
        if not self._is_ready():
            return
        document = self._document
        if index < len(document.history.branches):
            document.take_branch(index)
            self._status.show_message(
                f"Switched to the branch: s {document.score:,}. The steps left are now a branch."
            )

    def take_last_branch(self) -> None:
        """Switch to the branch that was left last."""
        branches = self._document.history.branches
        if branches:
            self.take_branch(max(range(len(branches)), key=lambda i: branches[i].made))

    def play_or_hold(self) -> None:
        """Play from here, or from the start if this is the end; or pause."""
        if self.playing:
            self.hold()
            return
        document = self._document
        if len(document.history) == 0 or not self._is_ready():
            return
        if not document.can_redo:
            self._go(0)
        self._clock.start(round(1000 / self._speed))
        self.timeline.show_playing(True)

    def hold(self) -> None:
        """Pause playback."""
        if self.playing:
            self._clock.stop()
            self.timeline.show_playing(False)

    def _tick(self) -> None:
        document = self._document
        self._go(document.history.cursor + 1)
        if not document.can_redo:
            self.hold()

    def _go(self, state: int) -> None:
        if not self._is_ready():
            return
        self._ours = self.moving = True
        try:
            self._document.go_to(state)
        finally:
            self._ours = False

    def _is_ready(self) -> bool:
        if not self._readiness.editing:
            self._status.show_message(PREPARING)
        return self._readiness.editing

    def _on_state_requested(self, state: int) -> None:
        self.hold()
        self._wanted = state
        self._soon.start()  # a drag requests more states than can be drawn: the last counts

    def _arrive(self) -> None:
        self.go_to(self._wanted)
        if not self._late.isActive():
            self._show()  # the state is unchanged: the cursor of the curve must return to it

    def _on_speed_chosen(self, speed: int) -> None:
        self._speed = speed
        self._settings.put("film/speed", speed)
        if self.playing:
            self._clock.start(round(1000 / speed))

    # Visibility

    def show_list(self, shown: bool) -> None:
        """Show or hide the list."""
        self.lists = shown
        self._settings.put("film/list", shown)
        self._arrange()

    def show_timeline(self, shown: bool) -> None:
        """Show or hide the timeline."""
        self.times = shown
        self._settings.put("film/timeline", shown)
        self._arrange()

    def export(self) -> None:
        """Ask what to export, then write it in the background."""
        self.exporting.ask()

    def _arrange(self) -> None:
        empty = self._document.empty
        self.panel.setVisible(self.lists and not empty)
        self.timeline.setVisible(self.times and not empty)
        self._show()

    def _on_replaced(self) -> None:
        self.hold()
        self._arrange()

    def _on_history_changed(self) -> None:
        if not self._ours:
            self.moving = False
            self.hold()
        if not self._late.isActive():
            self._late.start()

    def _show(self) -> None:
        document = self._document
        self._late.stop()
        if self._soon.isActive():
            self._late.start()  # the cursor is at the mouse already, and the mesh follows soon
            return
        if self.panel.isVisibleTo(self._parent):
            self.panel.show_history(document.history, document.empty)
        if self.timeline.isVisibleTo(self._parent):
            self.timeline.curve.show_history(document.history, document.empty)
