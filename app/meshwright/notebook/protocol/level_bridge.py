"""Levels in a notebook: connects the play of a level with the browsers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec import UNSET

from meshwright.assistant.assistant import Assistant
from meshwright.document.document import Document
from meshwright.notebook.protocol import requests
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright.puzzles import level as levels
from meshwright.puzzles.agent_opponent import OpponentState
from meshwright.puzzles.level import Level
from meshwright.puzzles.play import LevelPlay
from meshwright_core import MeshError

if TYPE_CHECKING:
    from meshwright.notebook.session import Session

ACTIONS: dict[type[requests.Request], str] = {
    requests.CleanAll: "clean_all",
    requests.Desired: "desired",
    requests.Lock: "locked",
    requests.Corner: "geometric",
}
"""Requests that a level may refuse, and the actions of the history that they cause."""


class LevelBridge:
    """Handles requests about levels and sends their state; :meth:`begin` starts a level."""

    def __init__(self, session: Session) -> None:
        """Use :meth:`of`, which returns the existing bridge of a session."""
        self._session = session
        self._sent: dict[str, Any] = {}
        self._stars: tuple[int, ...] = ()
        self._known: tuple[Level | None, bool] = (None, False)
        self.play = LevelPlay(session.document, session.assistant.hinting, self._rival)
        self.play.changed.connect(self._on_changed)
        session.handlers[requests.ChangeLevel] = self._do
        session.welcome_messages.append(lambda: Packet(self._content(everything=True)))
        session.guards.append(self._refusal)
        session.on_end.append(self._end)

    @classmethod
    def of(cls, session: Session) -> LevelBridge:
        """The level bridge of a session; created if none has been played there yet."""
        found = session.handlers.get(requests.ChangeLevel)
        owner = getattr(found, "__self__", None)
        return owner if isinstance(owner, cls) else cls(session)

    def begin(self, level: str | Level) -> None:
        """Start a level; MeshError if there is none of this name."""
        self.play.open(level)

    def _rival(self, document: Document) -> Assistant:
        return Assistant(document, self._session.loop)

    def _end(self) -> None:
        self.play.changed.disconnect(self._on_changed)
        self.play.release()

    # Requests

    def _refusal(self, request: requests.Request) -> str:
        """Why the level refuses a request; empty if it does not."""
        if isinstance(request, requests.Operate):
            return self.play.refusal(request.operation)
        return self.play.refusal(ACTIONS.get(type(request), ""))

    def _do(self, session: Session, request: requests.ChangeLevel) -> str:
        play, action = self.play, request.action
        if play.level is None:
            raise MeshError("No level is being played here.")
        if action == "open":
            play.open(play.level.name if request.name is UNSET else request.name)
        elif action == "again":
            play.again()
        elif action == "next":
            play.next()
        elif self._answered:
            return play.show_answer()
        else:
            play.ask_agent()
        return ""

    @property
    def _answered(self) -> bool:
        """Whether there is a solution to show: the agent's, or that of a level it cannot play."""
        play = self.play
        done = play.rival is not None and play.rival.standing is OpponentState.DONE
        return done or (play.level is not None and bool(play.level.most))

    # Messages

    def _on_changed(self) -> None:
        session, play = self._session, self.play
        session.level = play.level
        if play.notice:
            session.broadcaster.notice("failed", play.notice)
            play.notice = ""
        content = self._content()
        if content != self._sent:
            self._sent = content
            session.broadcaster.send_to_all(Packet(content))
        known = (play.level, play.done)
        if known != self._known:
            self._known = known
            session.level_changed.emit(play.level)

    def _content(self, everything: bool = False) -> dict[str, Any]:
        """The message; it holds the list of all levels where that may have changed."""
        progress, names = self.play.progress, levels.names()
        stars = tuple(progress.best(name).stars for name in names)
        content: dict[str, Any] = {"type": "level", "level": self._level()}
        if everything or stars != self._stars:
            content["all"] = [
                {"name": level.name, "title": level.title, "stars": won}
                for level, won in zip(levels.all(), stars, strict=True)
            ]
        if not everything:
            self._stars = stars
        return content

    def _level(self) -> dict[str, Any] | None:
        play, level = self.play, self.play.level
        if level is None:
            return None
        return {
            "name": level.name,
            "number": level.number,
            "count": len(levels.names()),
            "title": level.title,
            "text": level.text,
            "goal": level.goal,
            "aim": level.aim,
            "par": level.par,
            "proved": level.proved,
            "used": play.used,
            "stars": play.stars,
            "best_stars": play.best,
            "helped": play.tally.helped,
            "hinted": play.hinted,
            "done": play.done,
            "headline": play.headline,
            "remark": play.remark,
            "next": levels.after(level.name),
            "rival": self._agent(level),
            "answered": self._answered,
        }

    def _agent(self, level: Level) -> dict[str, Any] | None:
        """State of the agent's solution; None where none was requested."""
        rival = self.play.rival
        if rival is None:
            return None
        return {
            "standing": rival.standing.value,
            "used": len(rival.operations),
            "score": rival.score,
            "reached": rival.standing is OpponentState.DONE and rival.score <= level.goal,
            "reason": rival.reason,
        }
