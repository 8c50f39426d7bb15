"""A stand-in for a browser: a port that records messages, and a replica that applies them."""

from __future__ import annotations

from itertools import count
from typing import Any

import numpy as np

from meshwright.assistant.kernel_preparation import KernelPreparation, Stage
from meshwright.notebook.protocol.mesh_sync import CoordinateFrame, Packet, SlotArrays
from meshwright.notebook.session import Session
from meshwright_core import HalfEdgeMesh

TYPES = ("<f4", "i1", "u1", "<i4", "<i4")


class Replica:
    """The browser's copy of the mesh, built from messages only."""

    def __init__(self) -> None:
        self.revision = -1
        self.slots = SlotArrays.none()
        self.scores: list[int] = []

    def take(self, packet: Packet) -> None:
        kind = packet.content["type"]
        if kind == "state":
            self._state(packet)
        elif kind == "patch":
            self._patch(packet)
        if kind in ("state", "patch") and "head" in packet.content:
            track = packet.content["head"]["track"]
            self.scores[track["from"] :] = track["scores"]

    def _state(self, packet: Packet) -> None:
        arrays = [np.frombuffer(b, t) for b, t in zip(packet.buffers, TYPES, strict=True)]
        self.slots = SlotArrays(arrays[0].reshape(-1, 2).copy(), *(a.copy() for a in arrays[1:]))
        self.revision = packet.content["revision"]
        assert len(self.slots.flags) == packet.content["vertices"]
        assert len(self.slots.origin) == packet.content["halfedges"]

    def _patch(self, packet: Packet) -> None:
        types = ("<i4", "<f4", "i1", "u1", "<i4", "<i4", "<i4")
        v, places, delta, flags, h, origin, twin = (
            np.frombuffer(b, t) for b, t in zip(packet.buffers, types, strict=True)
        )
        assert packet.content["from"] == self.revision
        self.revision = packet.content["to"]
        old, new = self.slots, []
        sizes = [packet.content["vertices"]] * 3 + [packet.content["halfedges"]] * 2
        olds = (old.places, old.delta, old.flags, old.origin, old.twin)
        values = (places.reshape(-1, 2), delta, flags, origin, twin)
        for before, size, value, at in zip(olds, sizes, values, (v, v, v, h, h), strict=True):
            grown = np.full((size, *before.shape[1:]), 99, before.dtype)
            grown[: len(before)] = before
            grown[at] = value
            new.append(grown)
        self.slots = SlotArrays(*new)

    def shows(self, mesh: HalfEdgeMesh, frame: CoordinateFrame) -> bool:
        """Whether it equals this mesh, to the bit."""
        real = SlotArrays.of(mesh, frame, len(self.slots.flags), len(self.slots.origin))
        return real.buffers == self.slots.buffers


class Port:
    """Stands in for a widget: records messages, and applies them to a replica."""

    def __init__(self, session: Session, view: str = "v", read_only: bool = False) -> None:
        self.session, self.view, self.read_only = session, view, read_only
        self.reachable = True
        self.packets: list[Packet] = []
        self.replica = Replica()
        self.score = -1
        self._ids = count(1)
        session.join(self)

    def post(self, packet: Packet) -> None:
        self.packets.append(packet)
        addressee = packet.content.get("to")  # a patch, which all get, has its revision there
        if addressee == self.view or not isinstance(addressee, str):
            self.replica.take(packet)

    def show_score(self) -> None:
        self.score = self.session.document.score

    def close(self) -> None:
        self.session.leave(self)

    def ask(self, do: str, **fields: Any) -> list[dict[str, Any]]:
        """Send a request; returns the contents of the immediate answers."""
        before = len(self.packets)
        content = {"do": do, "id": next(self._ids), "view": self.view, **fields}
        self.session.receive(self, content, [])
        return [packet.content for packet in self.packets[before:]]

    def operate(self, operation: str, halfedge: int) -> list[dict[str, Any]]:
        mesh = self.session.mesh
        ends = [mesh.origin(halfedge), mesh.target(halfedge)]
        return self.ask("operate", operation=operation, halfedge=halfedge, ends=ends)

    def of(self, message: str) -> list[dict[str, Any]]:
        """The contents of all messages of one kind so far."""
        return [packet.content for packet in self.packets if packet.content["type"] == message]

    @property
    def sentence(self) -> str:
        """The last notice."""
        return str(self.of("notice")[-1]["sentence"])


def allowed(mesh: HalfEdgeMesh, names: tuple[str, ...] = ("flip_left", "flip")) -> tuple[str, int]:
    """The first allowed operation of ``names``, and its half-edge."""
    k = mesh.k
    for element in mesh.element_ids().tolist():
        for halfedge in range(k * element, k * element + k):
            for operation, verdict in mesh.allowed(halfedge).items():
                if verdict and operation in names:
                    return str(operation), halfedge
    raise AssertionError("nothing is allowed")


def script_agent(monkeypatch: Any, greedy: Any) -> None:
    """Replace policy and search of new assistants by a scripted runner, without torch.

    greedy: the class ``Greedy`` of the tests of the application.
    """

    def ask(mesh: HalfEdgeMesh, policy: str, near: Any) -> Any:
        seen = greedy(mesh).look()
        return () if seen is None else seen.choices[:5]

    monkeypatch.setattr("meshwright.notebook.kernel_warmup.PREPARATION", _ready())
    monkeypatch.setattr("meshwright.assistant.worker._load_policy", lambda name: name)
    monkeypatch.setattr(
        "meshwright.assistant.worker._make_runner", lambda mesh, policy, seed: greedy(mesh)
    )
    monkeypatch.setattr("meshwright.assistant.worker._ask_policy", ask)
    monkeypatch.setattr(
        "meshwright.assistant.search_runner.SearchRunner._search",
        lambda self: _all_of(greedy(self._mesh)),
    )


def _ready() -> KernelPreparation:
    """No compilation in another process: tests compile in their own."""
    preparation = KernelPreparation()
    preparation._stage = Stage.READY
    return preparation


def _all_of(runner: Any) -> list[Any]:
    found = []
    while not runner.finished:
        found += runner.step()
    return found
