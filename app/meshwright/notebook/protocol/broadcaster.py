"""Sends changes of a document to all views of all widgets that show it."""

from __future__ import annotations

import logging
import time
from typing import Any, Protocol
from weakref import ReferenceType, ref

from meshwright.document.document import Document
from meshwright.notebook.protocol.agent_bridge import AgentBridge
from meshwright.notebook.protocol.document_status import DocumentStatus
from meshwright.notebook.protocol.mesh_sync import MeshSync, Packet
from meshwright.notebook.protocol.requests import Envelope, Request
from meshwright.notebook.thread_loop import ThreadLoop
from meshwright_core.operations.catalogue import of_kind

PACE = 0.02
"""Average seconds between two patches while a cell runs; changes in between are merged into the
next patch.
"""
BURST = 16
"""Changes that are sent at once nevertheless: a cell may sleep after the last of a few."""

_log = logging.getLogger(__name__)


class Port(Protocol):
    """What a session needs of a widget."""

    read_only: bool

    @property
    def model_id(self) -> str | None:
        """The id of the widget in the notebook."""
        ...

    @property
    def reachable(self) -> bool:
        """Whether the connection to the browser is open."""
        ...

    def post(self, packet: Packet) -> None:
        """Send a message to all views of the widget."""
        ...

    def show_score(self) -> None:
        """Update score and optimum after a change."""
        ...

    def keep(self, snapshot: dict[str, Any]) -> None:
        """Keep what a saved notebook shows while no kernel runs."""
        ...

    def close(self) -> None:
        """Release the widget: its connection was closed."""
        ...


class Broadcaster:
    """Keeps the browsers' copies of the document up to date.

    Nothing is compared or sent before the first view has connected.
    """

    def __init__(self, document: Document, agent: AgentBridge, loop: ThreadLoop) -> None:
        self.mesh_sync, self.status = MeshSync(), DocumentStatus(document)
        self._document, self._agent, self._loop = document, agent, loop
        self._ports: list[ReferenceType[Port]] = []
        self._connected = False
        self._mesh_replaced = self._changed = self._agent_changed = self._scheduled = False
        self._held: list[Request] = []
        self._credit, self._credited = float(BURST), time.monotonic()
        self._sent_revision, self._sent_mesh = document.revision, document.mesh

    # Widgets

    @property
    def ports(self) -> list[Port]:
        """The widgets with an open connection."""
        found = [port for port in (known() for known in self._ports) if port is not None]
        return [port for port in found if port.reachable]

    @property
    def lost(self) -> list[Port]:
        """The widgets whose connection was closed."""
        found = [port for port in (known() for known in self._ports) if port is not None]
        return [port for port in found if not port.reachable]

    @property
    def alone(self) -> bool:
        """Whether no widget is left."""
        return not any(known() is not None for known in self._ports)

    def add(self, port: Port) -> None:
        """Send to this widget from now on."""
        self._ports.append(ref(port))

    def remove(self, port: Port) -> None:
        """Stop sending to this widget, and forget those that were garbage-collected."""
        self._ports = [known for known in self._ports if known() not in (port, None)]

    # Changes

    def follow(self) -> None:
        """After a change of the document; a new mesh has been sent as a whole already."""
        if self._sent_revision != self._document.revision:
            self.touch()

    def touch(self) -> None:
        """Mark mesh and status as changed."""
        self._changed = True
        self._schedule()

    def touch_agent(self) -> None:
        """Mark the agent's state as changed."""
        self._agent_changed = True
        self._schedule()

    def start_over(self) -> None:
        """The document has another mesh: the next message is a whole state."""
        self._mesh_replaced = self._agent_changed = True

    def hold(self, request: Request) -> None:
        """Send nothing before :meth:`release`: the changes of one request are one message."""
        self._held.append(request)

    def release(self) -> None:
        """End of the last held request: send its changes."""
        request = self._held.pop()
        if not self._held:
            self.flush(request)

    def _schedule(self) -> None:
        """Send at once, or a moment later where changes are frequent."""
        if not self._connected or self._held:
            return
        now = time.monotonic()
        self._credit = min(BURST, self._credit + (now - self._credited) / PACE)
        self._credited = now
        if not self._loop.running or self._credit >= 1:
            self._credit -= 1
            self.flush()
        elif not self._scheduled:
            self._scheduled = True
            self._loop(self.catch_up)

    def catch_up(self) -> None:
        """Send what has changed, and allow a burst of changes again."""
        self.flush()
        self._credit = float(BURST)

    def flush(self, request: Request | None = None) -> None:
        """Send what has changed since the last message. Never raises."""
        self._scheduled = False
        if not self._connected:
            return
        try:
            self._send_changes(request)
        except Exception as error:  # must not reach the code that changed the mesh
            _log.error("a change could not be sent to the browsers", exc_info=error)

    def _send_changes(self, request: Request | None) -> None:
        agent, self._agent_changed = self._agent_changed, False
        newer = self._sent_revision != self._document.revision
        dirty, self._changed = self._changed or newer, False
        self._sent_revision = self._document.revision
        if self._mesh_replaced or self._sent_mesh is not self._document.mesh:
            self._restart()
            self._send_states(request)
        elif dirty:
            self._send_patch(request)
        if agent:
            self.send_to_all(self._agent.packet())

    def _send_patch(self, request: Request | None) -> None:
        mesh = self._document.mesh
        packet = self.mesh_sync.patch(mesh)
        if packet.content["type"] == "state":
            self._send_states(request)
            return
        packet.content["head"] = self.status.update()
        for port in self.ports:
            self.post(port, packet, request, to_all=True)

    def _send_states(self, request: Request | None) -> None:
        for port in self.ports:
            self.post(port, self._state(port), request, to_all=True)

    def _restart(self) -> None:
        self._mesh_replaced = self._changed = False
        self._sent_revision, self._sent_mesh = self._document.revision, self._document.mesh
        self.mesh_sync.reset(self._sent_mesh)
        self.status.reset()

    # Messages

    def send_state(self, port: Port, request: Request) -> None:
        """Send the whole state to a new view; the others are brought up to date first."""
        if self._connected:
            self.flush()
        else:
            self._restart()
            self._connected = True
        self.post(port, self._state(port), request)
        self.post(port, self._agent.packet(), request)

    def send_to_all(self, packet: Packet) -> None:
        """Send a message to all views of all widgets."""
        for port in self.ports:
            self.post(port, packet)

    def notice(self, tone: str, sentence: str) -> None:
        """Show a sentence in all views; ``tone`` is "refused", "info" or "failed"."""
        self.send_to_all(_notice(tone, sentence))

    def answer(self, port: Port, request: Envelope | None, tone: str, sentence: str) -> None:
        """Show a sentence in the view that sent ``request``."""
        self.post(port, _notice(tone, sentence), request)

    def post(
        self, port: Port, packet: Packet, request: Envelope | None = None, to_all: bool = False
    ) -> None:
        """Send a message, to the view that sent ``request`` or to all. Never raises."""
        content = dict(packet.content)
        if request is not None:
            content["reply"] = request.id
            content["asked" if to_all else "to"] = request.view
        try:
            port.post(Packet(content, packet.buffers))
        except Exception as error:  # one broken connection must not stop the others
            _log.error("a message to the browser was lost", exc_info=error)

    def _state(self, port: Port) -> Packet:
        packet = self.mesh_sync.state()
        packet.content |= {
            "head": self.status.full(),
            "catalogue": _catalogue(self._document.kind),
            "read_only": port.read_only,
        }
        return packet


def _notice(tone: str, sentence: str) -> Packet:
    return Packet({"type": "notice", "tone": tone, "sentence": sentence})


def _catalogue(kind: str) -> list[dict[str, Any]]:
    return [
        {
            "operation": str(info.operation),
            "title": info.title,
            "key": info.key,
            "summary": info.summary,
            "beyond": info.beyond_paper,
        }
        for info in (of_kind(kind) if kind else ())
    ]
