"""The agent beside the person: what the window does about its runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from app.assistant import State

if TYPE_CHECKING:
    from app.desktop.window import MainWindow


class AgentControl:
    """Passes on what a person wants of the agent, and what the agent says."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window

    def connect(self) -> None:
        """Follow the assistant."""
        assistant = self._window.assistant
        assistant.changed.connect(self._window.refresh)
        assistant.said.connect(self._window.say)
        assistant.failed.connect(self._window.notice.tell)

    def release(self) -> None:
        """End what runs, and let go of the assistant."""
        assistant = self._window.assistant
        assistant.close()
        assistant.changed.disconnect(self._window.refresh)
        assistant.said.disconnect(self._window.say)
        assistant.failed.disconnect(self._window.notice.tell)

    def play_or_pause(self) -> None:
        """Pause a played run; else play."""
        if self._window.assistant.state is State.PLAYING:
            self._window.assistant.pause()
        else:
            self._window.assistant.play()
