"""What browsers are told of a document: the same to all views of all widgets on it."""

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
"""Seconds between two patches, on average, while a cell works; what comes sooner travels with the
next one.
"""
BURST = 16
"""Changes that are sent at once all the same: a cell may sleep after the last of a few."""

_log = logging.getLogger(__name__)


class Port(Protocol):
    """A widget, as its session sees it."""

    read_only: bool

    @property
    def reachable(self) -> bool:
        """Whether there still is a way to the browser."""
        ...

    def post(self, packet: Packet) -> None:
        """Send a message to all views of the widget."""
        ...

    def show_score(self) -> None:
        """The score, or the optimum, is another."""
        ...

    def close(self) -> None:
        """There is no way to the browser any more, and will be none."""
        ...


class Broadcaster:
    """Keeps what the browsers know up with the document.

    Nothing is compared or sent before the first view has come.
    """

    def __init__(self, document: Document, agent: AgentBridge, loop: ThreadLoop) -> None:
        self.mesh_sync, self.status = MeshSync(), DocumentStatus(document)
        self._document, self._agent, self._loop = document, agent, loop
        self._ports: list[ReferenceType[Port]] = []
        self._followed = False
        self._fresh = self._dirty = self._agent_dirty = self._due = False
        self._asked: list[Request] = []
        self._credit, self._credited = float(BURST), time.monotonic()
        self._told, self._shown = document.revision, document.mesh

    # To whom

    @property
    def ports(self) -> list[Port]:
        """The widgets that still have a way to the browser."""
        found = [port for port in (known() for known in self._ports) if port is not None]
        return [port for port in found if port.reachable]

    @property
    def lost(self) -> list[Port]:
        """The widgets whose way to the browser was cut."""
        found = [port for port in (known() for known in self._ports) if port is not None]
        return [port for port in found if not port.reachable]

    @property
    def alone(self) -> bool:
        """Whether no widget is left."""
        return not any(known() is not None for known in self._ports)

    def add(self, port: Port) -> None:
        """Tell this widget, too."""
        self._ports.append(ref(port))

    def remove(self, port: Port) -> None:
        """Do not tell this widget any more; those that are collected go with it."""
        self._ports = [known for known in self._ports if known() not in (port, None)]

    # What has changed

    def follow(self) -> None:
        """The document says that it has changed; of a mesh that is new all has been told."""
        if self._told != self._document.revision:
            self.touch()

    def touch(self) -> None:
        """The mesh has changed, or what goes with it."""
        self._dirty = True
        self._soon()

    def touch_agent(self) -> None:
        """The agent has changed."""
        self._agent_dirty = True
        self._soon()

    def start_over(self) -> None:
        """Another mesh is here; what else differs comes right after."""
        self._fresh = self._agent_dirty = True

    def hold(self, request: Request) -> None:
        """Send nothing before :meth:`release`: what a request brings about is one message."""
        self._asked.append(request)

    def release(self) -> None:
        """The last request held is done: send what it has brought about."""
        request = self._asked.pop()
        if not self._asked:
            self.flush(request)

    def _soon(self) -> None:
        """Send at once, or a moment later if much happens."""
        if not self._followed or self._asked:
            return
        now = time.monotonic()
        self._credit = min(BURST, self._credit + (now - self._credited) / PACE)
        self._credited = now
        if not self._loop.running or self._credit >= 1:
            self._credit -= 1
            self.flush()
        elif not self._due:
            self._due = True
            self._loop(self.catch_up)

    def catch_up(self) -> None:
        """Send what has changed; whoever works now may have a few changes sent at once again."""
        self.flush()
        self._credit = float(BURST)

    def flush(self, request: Request | None = None) -> None:
        """Send what has changed since the last time. Never raises."""
        self._due = False
        if not self._followed:
            return
        try:
            self._send_news(request)
        except Exception as error:  # whoever changed the mesh is not to blame
            _log.error("browsers could not be told of a change", exc_info=error)

    def _send_news(self, request: Request | None) -> None:
        agent, self._agent_dirty = self._agent_dirty, False
        dirty, self._dirty = self._dirty or self._told != self._document.revision, False
        self._told = self._document.revision
        if self._fresh or self._shown is not self._document.mesh:
            self._take_all()
            self._send_states(request)
        elif dirty:
            self._send_patch(request)
        if agent:
            self.tell(self._agent.packet())

    def _send_patch(self, request: Request | None) -> None:
        mesh = self._document.mesh
        packet = self.mesh_sync.patch(mesh)
        if mesh is not None:
            self.status.inverted.follow(mesh, self.mesh_sync.moved, self.mesh_sync.turned)
        if packet.content["type"] == "state":
            self._send_states(request)
            return
        packet.content["head"] = self.status.news()
        for port in self.ports:
            self.post(port, packet, request, to_all=True)

    def _send_states(self, request: Request | None) -> None:
        for port in self.ports:
            self.post(port, self._state(port), request, to_all=True)

    def _take_all(self) -> None:
        self._fresh = self._dirty = False
        self._told, self._shown = self._document.revision, self._document.mesh
        self.mesh_sync.reset(self._shown)
        self.status.reset()

    # Messages

    def greet(self, port: Port, request: Request) -> None:
        """A view has come. The others catch up first, so that all know the same."""
        if self._followed:
            self.flush()
        else:
            self._take_all()
            self._followed = True
        self.post(port, self._state(port), request)
        self.post(port, self._agent.packet(), request)

    def tell(self, packet: Packet) -> None:
        """Send a message to all views of all widgets."""
        for port in self.ports:
            self.post(port, packet)

    def notice(self, tone: str, words: str) -> None:
        """Tell all views a sentence; ``tone`` is "refused", "info" or "failed"."""
        self.tell(_notice(tone, words))

    def answer(self, port: Port, request: Envelope | None, tone: str, words: str) -> None:
        """Tell the view that asked a sentence."""
        self.post(port, _notice(tone, words), request)

    def post(
        self, port: Port, packet: Packet, request: Envelope | None = None, to_all: bool = False
    ) -> None:
        """Send a message, addressed to the view that asked unless all are meant. Never raises."""
        content = dict(packet.content)
        if request is not None:
            content["reply"] = request.id
            content["asked" if to_all else "to"] = request.view
        try:
            port.post(Packet(content, packet.buffers))
        except Exception as error:  # one broken way must not keep the others waiting
            _log.error("a message to the browser was lost", exc_info=error)

    def _state(self, port: Port) -> Packet:
        packet = self.mesh_sync.state()
        packet.content |= {
            "head": self.status.whole(),
            "catalogue": _catalogue(self._document.kind),
            "read_only": port.read_only,
        }
        return packet


def _notice(tone: str, words: str) -> Packet:
    return Packet({"type": "notice", "tone": tone, "sentence": words})


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
