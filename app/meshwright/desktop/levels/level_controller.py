"""Levels: chosen in a dialog, played on the document, shown in a bar."""

from __future__ import annotations

from collections.abc import Callable

from qtpy.QtWidgets import QWidget

from meshwright.assistant.assistant import Assistant
from meshwright.desktop.application.main_thread import Dispatcher
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.controller import Controller
from meshwright.desktop.files.file_controller import FileController
from meshwright.desktop.history.playback_controller import PlaybackController
from meshwright.desktop.levels.level_bar import LevelBar
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright.puzzles import level as levels
from meshwright.puzzles.agent_opponent import OpponentState
from meshwright.puzzles.level import Level
from meshwright.puzzles.play import LevelPlay
from meshwright_core import MeshError


class LevelController(Controller):
    """Plays levels on the document: ``play`` is the state of the game, ``bar`` shows it."""

    def __init__(
        self,
        document: Document,
        assistant: Assistant,
        canvas: Canvas,
        files: FileController,
        playback: PlaybackController,
        status: StatusBar,
        notice: NoticeBar,
        parent: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._canvas, self._files, self._playback = canvas, files, playback
        self._status, self._notice, self._parent = status, notice, parent
        self.make_rival = _assistant
        self.play = LevelPlay(
            document, assistant.hinting, lambda document: self.make_rival(document)
        )
        self.bar = LevelBar(self.play, theme)
        self.bar.action_requested.connect(self._on_action_requested)
        self._connections.add(self.play.changed, self._on_changed)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        super().set_theme(theme)
        self.bar.set_theme(theme)

    def close(self) -> None:
        """Disconnect, and end the agent's run on the level."""
        super().close()
        self.play.release()

    @property
    def level(self) -> Level | None:
        """The level that is being played."""
        return self.play.level

    # Commands

    def choose(self) -> None:
        """Show the dialog of levels, and start the chosen one."""
        from meshwright.desktop.levels.level_dialog import LevelDialog

        try:
            dialog = LevelDialog(self.play.progress, self._theme, self._parent)
        except MeshError as error:
            self._notice.show_message(str(error))
            return
        chosen = dialog.chosen if dialog.exec() else None
        dialog.deleteLater()
        if chosen is not None:
            self.open(chosen)

    def open(self, level: str | Level) -> None:
        """Start a level, unless the user keeps the current mesh."""
        if self._files.may_drop():
            self._try(lambda: self.play.open(level))
            self._canvas.fit()

    def again(self) -> None:
        """Restart the level."""
        self._try(self.play.again)

    def next(self) -> None:
        """Start the next level."""
        self._try(self.play.next)
        self._canvas.fit()

    def answer(self) -> None:
        """Let the agent solve the level; once it has, show its solution."""
        play = self.play
        asked = play.rival is not None and play.rival.standing is OpponentState.DONE
        if asked or (play.level is not None and play.level.most):
            self.show_way()
        else:
            self._try(play.ask_agent)

    def show_way(self) -> None:
        """Restart the level with a solution as steps to redo, and play them."""
        try:
            message = self.play.show_answer()
        except MeshError as error:
            self._notice.show_message(str(error))
            return
        self._status.show_message(message)
        self._playback.play_or_hold()

    def leave(self) -> None:
        """Leave the level and keep the mesh."""
        self.play.leave()

    def refuses(self, action: str) -> bool:
        """Whether the level forbids an action; if so, the reason is shown."""
        why = self.play.refusal(action)
        if why:
            self._status.show_message(why)
            self._canvas.refuse(why)
        return bool(why)

    def _try(self, call: Callable[[], object]) -> None:
        try:
            call()
        except MeshError as error:
            self._notice.show_message(str(error))

    # Following the game

    def _on_action_requested(self, action: str) -> None:
        requests = {
            "again": self.again,
            "answer": self.answer,
            "next": self.next,
            "leave": self.leave,
        }
        requests[action]()
        self._canvas.focus()

    def _on_changed(self) -> None:
        self.bar.refresh()
        if self.play.notice:
            self._notice.show_message(self.play.notice)
            self.play.notice = ""


def _assistant(document: Document) -> Assistant:
    """An assistant on another document."""
    return Assistant(document, Dispatcher())


def is_last(level: Level | None) -> bool:
    """Whether there is no level after this one."""
    return level is None or levels.after(level.name) is None
