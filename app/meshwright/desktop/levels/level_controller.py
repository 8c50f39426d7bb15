"""Levels in the window: chosen in a dialog, played on the document, told of in a bar."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from meshwright.assistant.assistant import Assistant
from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.levels.level_bar import LevelBar
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright.puzzles import level as levels
from meshwright.puzzles.agent_opponent import OpponentState
from meshwright.puzzles.level import Level
from meshwright.puzzles.play import LevelPlay
from meshwright_core import MeshError

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


class Levels:
    """The levels of one window; ``play`` is what is played."""

    bar: LevelBar

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.make_rival = _assistant
        self.play = LevelPlay(
            window.document, window.assistant.hinting, lambda document: self.make_rival(document)
        )

    def connect(self) -> None:
        """Take a place over canvas and panels, and follow the play."""
        window = self._window
        self.bar = LevelBar(self.play, window.theme)
        window.head.insertWidget(0, self.bar)
        self.bar.asked.connect(self._on_asked)
        self.play.changed.connect(self._on_changed)

    def release(self) -> None:
        """Let go of the document, end the agent's answer."""
        self.play.changed.disconnect(self._on_changed)
        self.play.release()

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        self.bar.set_theme(theme)

    @property
    def level(self) -> Level | None:
        """The level that is being played."""
        return self.play.level

    # What a person asks for

    def choose(self) -> None:
        """Show all levels, and play the one that is chosen."""
        from meshwright.desktop.levels.level_dialog import LevelDialog

        window = self._window
        try:
            dialog = LevelDialog(self.play.progress, window.theme, window)
        except MeshError as error:
            window.notice.tell(str(error))
            return
        chosen = dialog.chosen if dialog.exec() else None
        dialog.deleteLater()
        if chosen is not None:
            self.open(chosen)

    def open(self, level: str | Level) -> None:
        """Play a level, unless the mesh that is here must not be dropped."""
        window = self._window
        if window.files.may_drop():
            self._try(lambda: self.play.open(level))
            window.canvas.fit()

    def again(self) -> None:
        """Begin the level again."""
        self._try(self.play.again)

    def next(self) -> None:
        """Go on to the next level."""
        self._try(self.play.next)
        self._window.canvas.fit()

    def answer(self) -> None:
        """Ask the agent; once it has answered show its way."""
        play = self.play
        asked = play.rival is not None and play.rival.standing is OpponentState.DONE
        if asked or (play.level is not None and play.level.most):
            self.show_way()
        else:
            self._try(play.ask_agent)

    def show_way(self) -> None:
        """Begin again with the way ahead, and play it."""
        try:
            said = self.play.show_answer()
        except MeshError as error:
            self._window.notice.tell(str(error))
            return
        self._window.say(said)
        self._window.film.play_or_hold()

    def leave(self) -> None:
        """Go on without the level."""
        self.play.leave()

    def refuses(self, action: str) -> bool:
        """Whether a step is not played in the level; if so it says why."""
        why = self.play.refusal(action)
        if why:
            self._window.say(why)
            self._window.canvas.refuse(why)
        return bool(why)

    def _try(self, call: Callable[[], object]) -> None:
        try:
            call()
        except MeshError as error:
            self._window.notice.tell(str(error))

    # What the play says

    def _on_asked(self, action: str) -> None:
        asked = {
            "again": self.again,
            "answer": self.answer,
            "next": self.next,
            "leave": self.leave,
        }
        asked[action]()
        if self._window.canvas.plotter is not None:
            self._window.canvas.plotter.setFocus()

    def _on_changed(self) -> None:
        self.bar.refresh()
        self._window.actions_by_id.refresh()
        if self.play.notice:
            self._window.notice.tell(self.play.notice)
            self.play.notice = ""


def _assistant(document: Document) -> Assistant:
    """The agent on a mesh of its own."""
    return Assistant(document, Dispatcher())


def is_last(level: Level | None) -> bool:
    """Whether there is no level after this one."""
    return level is None or levels.after(level.name) is None
