"""The widget: a document in a notebook's cell."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from reprlib import repr as shortened
from typing import TYPE_CHECKING, Any

import anywidget
import traitlets

from meshwright.assistant.assistant import Assistant
from meshwright.assistant.search_runner import COMPLETE_SECONDS, Effort
from meshwright.document.document import Document
from meshwright.document.history import History, HistoryStep
from meshwright.notebook import bundle
from meshwright.notebook.arguments import (
    degree_of,
    operation_of,
    policy_of,
    positive,
    vertex_of,
    whole,
)
from meshwright.notebook.export.export_mixin import Exports
from meshwright.notebook.protocol.level_bridge import Playing
from meshwright.notebook.protocol.mesh_sync import Packet
from meshwright.notebook.session import Session
from meshwright.puzzles import level as levels
from meshwright.puzzles.level import Level
from meshwright.signals import Signal
from meshwright.sources import resolve
from meshwright_core import Edit, HalfEdgeMesh, MeshError, Operation, Verdict

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import PolicyAction
    from meshwright_core.domains.domain import Domain

LOWEST, HIGHEST = 160, 4000
"""Bounds of a widget's height in pixels."""


class MeshWidget(Exports, anywidget.AnyWidget):
    """A mesh in a cell that a person can edit, with the agent beside it.

    What is changed in the browser is changed here, and the other way round; several widgets on one
    document stay in step. Change the mesh through the widget, or its document: what
    ``widget.mesh.apply`` does is in no history, and no view hears of it.
    """

    # anywidget passes on only what the class has; the texts are made for each widget
    _esm = traitlets.Unicode().tag(sync=True)
    _css = traitlets.Unicode().tag(sync=True)
    height = traitlets.Int(464, min=LOWEST, max=HIGHEST).tag(sync=True)
    """Pixels of the canvas."""
    theme = traitlets.Enum(("auto", "light", "dark"), "auto").tag(sync=True)
    """The colours: those of the notebook, or always light, or always dark."""
    label = traitlets.Unicode("").tag(sync=True)
    """What the mesh is called, for the browser."""
    score = traitlets.Int(0, read_only=True).tag(sync=True)
    """s of the mesh now."""
    optimum = traitlets.Int(0, read_only=True).tag(sync=True)
    """s*, the lowest score that any connectivity can have."""
    seen = traitlets.Int(0).tag(sync=True)
    """Counts, in marimo, what a browser has brought about: marimo runs the cells that use a widget
    again when its page changes something, and a message alone does not count as that."""

    def __init__(
        self,
        source: HalfEdgeMesh | Document | MeshWidget | Domain | str | Path | None = None,
        *,
        kind: str | None = None,
        policy: str | Path | None = None,
        level: str | Level | None = None,
        height: int = 464,
        theme: str = "auto",
        name: str = "",
        read_only: bool = False,
    ) -> None:
        """Show ``source``; a document, or another widget's, is shared with whoever has it.

        Args:
            source: see :func:`meshwright.sources.resolve.document`; or another widget.
            kind: what a shape is meshed with, "tri" or "quad"; quads by default.
            policy: what the agent follows: a shipped policy, or a file; by default the first that
                is shipped for this kind of mesh.
            level: the name of a level to be played, in the place of a source.
            height: of the canvas, in pixels.
            theme: "auto" as the notebook, "light" or "dark".
            name: what the mesh is called.
            read_only: whether the browser may look only; Python may go on changing the mesh.

        Raises:
            MeshError: one sentence on what is wrong with the source or the policy.
            traitlets.TraitError: the height or the theme cannot be.
        """
        self._connected: list[tuple[Signal, Callable[..., None]]] = []
        self.read_only = bool(read_only)
        if level is not None and not (source is None and kind is None):
            raise MeshError("A level brings its own mesh: leave source and kind out.")
        wanted = levels.load(level) if isinstance(level, str) else level
        if not isinstance(wanted, Level | None):
            raise MeshError(f"A level must be the name of one, not {shortened(level)}.")
        shown = source.document if isinstance(source, MeshWidget) else source
        document = Document() if wanted is not None else resolve.document(shown, kind, name)
        session = self.session = Session.of(document)
        try:
            if wanted is not None:
                Playing.of(session).begin(wanted)
            if policy is not None:
                session.agent.choose(policy_of(policy))
            super().__init__(height=height, theme=theme, label=name or document.name)
        except BaseException:
            session.end_if_alone()  # nobody shows the document: nothing may stay on it
            raise
        session.join(self)
        self.show_score()

    @traitlets.default("_esm")
    def _module(self) -> str:
        return bundle.module()

    @traitlets.default("_css")
    def _style(self) -> str:
        return bundle.style()

    # What is here

    @property
    def document(self) -> Document:
        """What all views share: mesh, history, selection and their events."""
        return self.session.document

    @property
    def mesh(self) -> HalfEdgeMesh:
        """The mesh, live; change it by the widget's own methods. MeshError while there is none."""
        return self.session.mesh

    @property
    def history(self) -> History:
        """One row for every step."""
        return self.document.history

    @property
    def assistant(self) -> Assistant:
        """The agent's side, shared by all widgets on the document."""
        return self.session.assistant

    @property
    def at_optimum(self) -> bool:
        """True if s = s*."""
        return self.document.at_optimum

    @property
    def level(self) -> Level | None:
        """The level that is being played, None where none is."""
        return self.session.level

    @property
    def stars(self) -> int:
        """Stars for what is done in the level: 0 before the goal, and where none is played."""
        return Playing.of(self.session).play.stars if self.session.level is not None else 0

    # Changing the mesh

    def check(self, operation: Operation | str, halfedge: int) -> Verdict:
        """Whether an operation may be done at a half-edge: true, or false with a ``reason``."""
        action, at = operation_of(self.mesh, operation), whole(halfedge, "half-edge")
        return self._do(lambda: self.document.check(action, at))

    def apply(self, operation: Operation | str, halfedge: int) -> Edit:
        """Do an operation and smooth around it, as one step; OperationRefused if it is refused."""
        action, at = operation_of(self.mesh, operation), whole(halfedge, "half-edge")
        return self._do(lambda: self.document.submit(action, at))

    def undo(self) -> HistoryStep | None:
        """Take back the last step; returns its row, None if there is none."""
        return self._do(self.document.undo)

    def redo(self) -> HistoryStep | None:
        """Do again what was taken back last; returns its row, None if there is none."""
        return self._do(self.document.redo)

    def go_to(self, cursor: int) -> None:
        """Undo or redo until ``cursor`` steps are done; beyond either end it stops there."""
        step = whole(cursor, "step")
        self._do(lambda: self.document.go_to(step))

    def smooth(self) -> None:
        """Smooth and untangle the whole mesh, as one step."""
        self._do(self.document.smooth)

    def untangle(self) -> tuple[int, int]:
        """Mend inverted elements; returns how many there were, and how many stay."""
        return self._do(self.document.untangle)

    def clean_all(self) -> int:
        """Remove every global line of a quad mesh that can be removed; returns their number."""
        return self._do(self.document.clean_all)

    def set_desired(self, vertex: int, degree: int) -> None:
        """Ask for another degree at a vertex; s and s* follow."""
        self._do(lambda: self.document.set_desired(vertex_of(self.mesh, vertex), degree_of(degree)))

    def lock(self, vertex: int, flag: bool = True) -> None:
        """Lock a vertex, so that it neither moves nor vanishes, or unlock it."""
        self._do(lambda: self.document.set_locked(vertex_of(self.mesh, vertex), bool(flag)))

    def corner(self, vertex: int, flag: bool = True) -> None:
        """Make a vertex a corner, which stays where it is, or free it."""
        self._do(lambda: self.document.set_geometric(vertex_of(self.mesh, vertex), bool(flag)))

    # The agent

    def play(
        self, policy: str | Path | None = None, *, speed: float | None = None, wait: bool = False
    ) -> None:
        """Let the agent play, visibly, while the notebook goes on.

        Args:
            policy: another one from now on.
            speed: decisions per second from now on.
            wait: return only at the end of the run, which then goes as fast as it can.

        Raises:
            MeshError: the policy does not fit, or (where the call waits) the run broke off.
        """
        agent = self.session.agent
        rate = positive(speed, "speed") if speed is not None else None
        self._choose(policy)
        self._ask(lambda: agent.play(rate, hurry=wait), wait)

    def step(self, policy: str | Path | None = None, wait: bool = True) -> None:
        """One decision of the agent: an operation, and the clean-ups that follow it."""
        self._choose(policy)
        self._ask(self.assistant.step, wait)

    def pause(self) -> None:
        """Hold a run; :meth:`play` and :meth:`step` go on from there."""
        self._do(self.assistant.pause)

    def complete(self, seconds: float = COMPLETE_SECONDS, wait: bool = True) -> None:
        """Search for the best state within so many seconds, and go there."""
        effort = Effort(seconds=positive(seconds, "seconds"))
        self._ask(lambda: self.assistant.search(effort), wait)

    def hint(self, wait: bool = True) -> tuple[PolicyAction, ...]:
        """The policy's best few operations in the present state.

        Where the call does not wait: the hints that are known already.
        """
        self._ask(self.assistant.hint, wait)
        return self.assistant.hinting.hints

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until the agent is at rest; returns False if that took longer than ``timeout`` s.

        The browsers follow meanwhile.
        """
        return self.session.wait(timeout)

    def _choose(self, policy: str | Path | None) -> None:
        if policy is not None:
            self._do(lambda: self.session.agent.choose(policy_of(policy)))

    def _ask(self, begin: Callable[[], None], wait: bool) -> None:
        if wait:
            self.session.finish(begin)
        else:
            self._do(begin)

    # Events

    def on(self, event: str, callback: Callable[..., Any]) -> Callable[[], None]:
        """Call ``callback`` at every later ``event``; returns a function that ends this.

        Events are "changed", "history" (no arguments), "score" (s), "hover" (a half-edge or -1),
        "agent" (what it is doing, a word) and "level" (the level or None). What a callback raises
        goes to the log and, as a sentence, to the browser.
        """
        if not callable(callback):
            raise MeshError(f"A callback must be something to call, not {shortened(callback)}.")
        session, document = self.session, self.document
        events: dict[str, tuple[Signal, Callable[..., tuple[Any, ...]]]] = {
            "changed": (document.changed, lambda: ()),
            "score": (document.score_changed, lambda: (document.score,)),
            "history": (document.history_changed, lambda: ()),
            "hover": (document.hover_changed, lambda halfedge: (halfedge,)),
            "agent": (session.agent_changed, lambda: (str(session.assistant.state),)),
            "level": (session.level_changed, lambda level: (level,)),
        }
        if event not in events:
            raise MeshError(f"There is no event {event!r}; there are {', '.join(events)}.")
        signal, told = events[event]

        def slot(*arguments: Any) -> None:
            session.call_back(callback, *told(*arguments))

        entry = (signal, signal.connect(slot))
        self._connected.append(entry)

        def disconnect() -> None:
            signal.disconnect(slot)
            if entry in self._connected:
                self._connected.remove(entry)

        return disconnect

    # Its place in the notebook

    def close(self) -> None:
        """Take the views away. The agent's thread ends with the document's last widget."""
        session = self.__dict__.get("session")  # an __init__ that has failed leaves none
        if session is not None:
            for signal, slot in self._connected:
                signal.disconnect(slot)
            self._connected.clear()
            session.leave(self)
        super().close()

    @property
    def reachable(self) -> bool:
        """Whether there still is a way to the browser; marimo cuts it when a cell runs again."""
        return self.comm is not None and not getattr(self.comm, "_closed", False)

    def post(self, packet: Packet) -> None:
        """For the session: send a message to all views."""
        self.send(packet.content, packet.buffers)

    def __repr__(self) -> str:
        """The mesh in one line."""
        session = self.__dict__.get("session")
        mesh = session.document.mesh if session is not None else None
        return f"<{type(self).__name__} of {mesh!r}>" if mesh is not None else object.__repr__(self)

    def show_score(self) -> None:
        """For the session: the score, or the optimum, is another."""
        self.set_trait("score", self.document.score)
        self.set_trait("optimum", self.document.optimum)

    def set_state(self, sync_data: Any) -> None:
        """What a browser wants the traits to be is nothing to us: it asks by messages."""

    def _handle_msg(self, message: Any) -> None:
        """Whatever comes from the browser; never raises."""
        content = message.get("content") if isinstance(message, dict) else None
        data = content.get("data") if isinstance(content, dict) else None
        method = data.get("method") if isinstance(data, dict) else None
        if method == "request_state":
            self.send_state()
        elif method != "update":
            custom = isinstance(data, dict) and method == "custom"
            buffers = message.get("buffers") if custom else None
            self.session.receive(self, data.get("content") if custom else None, buffers)

    def _do(self, call: Callable[[], Any]) -> Any:
        """In the thread that owns the document."""
        return self.session.do(call)
