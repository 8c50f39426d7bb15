"""Levels in a notebook: what browsers are told of the play, and what they may ask of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from meshwright.assistant.assistant import Assistant
from meshwright.document.document import Document
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright.puzzles import level as levels
from meshwright.puzzles.agent_opponent import OpponentState
from meshwright.puzzles.level import Level
from meshwright.puzzles.play import LevelPlay
from meshwright_core import MeshError

if TYPE_CHECKING:
    from meshwright.notebook.protocol.requests import Request
    from meshwright.notebook.session import Session

BARRED = {"clean_all": "clean_all", "desired": "desired", "lock": "locked", "corner": "geometric"}
"""Words of a browser, and the steps that they bring about."""


class Playing:
    """Levels on the document of ``session``; the first one is begun by :meth:`begin`."""

    def __init__(self, session: Session) -> None:
        """For :meth:`of`."""
        self._session = session
        self._told: dict[str, Any] = {}
        self._stars: tuple[int, ...] = ()
        self._known: tuple[Level | None, bool] = (None, False)
        self.play = LevelPlay(session.document, session.assistant.hinting, self._rival)
        self.play.changed.connect(self._on_changed)
        session.words["level"] = self._do
        session.greetings.append(lambda: Packet(self._content(everything=True)))
        session.bars.append(self._bar)
        session.endings.append(self._end)

    @classmethod
    def of(cls, session: Session) -> Playing:
        """The levels of a session; new ones if none has been played there yet."""
        found = session.words.get("level")
        owner = getattr(found, "__self__", None)
        return owner if isinstance(owner, cls) else cls(session)

    def begin(self, level: str | Level) -> None:
        """Begin a level; MeshError if there is none of this name."""
        self.play.open(level)

    def _rival(self, document: Document) -> Assistant:
        return Assistant(document, self._session.loop)

    def _end(self) -> None:
        self.play.changed.disconnect(self._on_changed)
        self.play.release()

    # What browsers ask

    def _bar(self, request: Request) -> str:
        """Why something is not played in a level; empty if it is."""
        action = request["operation"] if request.do == "operate" else BARRED.get(request.do, "")
        return self.play.refusal(action)

    def _do(self, session: Session, request: Request) -> str:
        play, action = self.play, request["action"]
        if play.level is None:
            raise MeshError("No level is being played here.")
        if action == "open":
            play.open(request.fields.get("name", play.level.name))
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
        """Whether there is a way to show: the agent's, or that of a level it cannot play."""
        play = self.play
        done = play.rival is not None and play.rival.standing is OpponentState.DONE
        return done or (play.level is not None and bool(play.level.most))

    # What browsers are told

    def _on_changed(self) -> None:
        session, play = self._session, self.play
        session.level = play.level
        if play.notice:
            session.telling.notice("failed", play.notice)
            play.notice = ""
        content = self._content()
        if content != self._told:
            self._told = content
            session.telling.tell(Packet(content))
        known = (play.level, play.done)
        if known != self._known:
            self._known = known
            session.level_changed.emit(play.level)

    def _content(self, everything: bool = False) -> dict[str, Any]:
        """A message; the list of all levels is in it where it may be news."""
        progress, names = self.play.progress, levels.names()
        stars = tuple(progress.best(name).stars for name in names)
        content: dict[str, Any] = {"say": "level", "level": self._level()}
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
        """The agent's answer, or that it is thinking; None where it was not asked."""
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
