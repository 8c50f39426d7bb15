"""A stand-in for a browser: a port that records messages, and a replica that applies them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count
from typing import Any

import numpy as np

from meshwright.assistant.kernel_preparation import KernelPreparation, Stage
from meshwright.notebook.protocol.mesh_sync import CoordinateFrame, Packet, SlotArrays
from meshwright.notebook.session import Session
from meshwright_core import HalfEdgeMesh

TYPES = ("<f4", "i1", "u1", "<i4", "<i4", "<i4", "<i4", "<f8", "<i2")
"""Of a state's arrays: places, delta, flags, origin, twin; vertices on curves with curve and
parameter; regions of elements, none where all are 0."""
CURVE_TYPES = ("<f8", "<i4", "<f8", "<f8", "<i4", "u1", "<i4")
"""Of the curves after them."""
PATCH_TYPES = ("<i4", "<f4", "i1", "u1", *3 * ("<i4",), "<i4", "<i4", "<f8", "<i4", "<i2")
"""Of a patch's arrays: vertices with places, delta and flags; half-edges with origin and twin;
vertices with curve and parameter; elements with region."""


def whole_slots(content: dict[str, Any], arrays: Sequence[np.ndarray]) -> SlotArrays:
    """The slots that the arrays of a state message describe."""
    places, delta, flags, origin, twin, seated, curve, parameter, region = arrays[: len(TYPES)]
    curves, parameters = np.full(len(flags), -1, "<i4"), np.zeros(len(flags), "<f8")
    curves[seated], parameters[seated] = curve, parameter
    if not len(region):
        region = np.zeros(len(origin) // content["k"], "<i2")
    values = (places.reshape(-1, 2), delta, flags, origin, twin, curves, parameters, region)
    return SlotArrays(*(value.copy() for value in values))


def patched_slots(
    old: SlotArrays, content: dict[str, Any], arrays: Sequence[np.ndarray]
) -> SlotArrays:
    """The slots after a patch message with these arrays."""
    v, places, delta, flags, h, origin, twin, seats, curve, parameter, e, region = arrays
    vertices, halfedges = content["vertices"], content["halfedges"]
    k = len(old.origin) // len(old.region)

    def grown(before: np.ndarray, size: int, at: np.ndarray, value: np.ndarray, new: float) -> Any:
        after = np.full((size, *before.shape[1:]), new, before.dtype)
        after[: len(before)] = before
        after[at] = value
        return after

    return SlotArrays(  # new slots must be set by the patch where the last number is 99
        grown(old.places, vertices, v, places.reshape(-1, 2), 99),
        grown(old.delta, vertices, v, delta, 99),
        grown(old.flags, vertices, v, flags, 99),
        grown(old.origin, halfedges, h, origin, 99),
        grown(old.twin, halfedges, h, twin, 99),
        grown(old.curve, vertices, seats, curve, -1),
        grown(old.parameter, vertices, seats, parameter, 0),
        grown(old.region, halfedges // k, e, region, 0),
    )


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
        types = (*TYPES, *CURVE_TYPES)
        arrays = [np.frombuffer(b, t) for b, t in zip(packet.buffers, types, strict=True)]
        self.slots = whole_slots(packet.content, arrays)
        self.revision = packet.content["revision"]
        assert len(self.slots.flags) == packet.content["vertices"]
        assert len(self.slots.origin) == packet.content["halfedges"]

    def _patch(self, packet: Packet) -> None:
        arrays = [np.frombuffer(b, t) for b, t in zip(packet.buffers, PATCH_TYPES, strict=True)]
        assert packet.content["from"] == self.revision
        self.revision = packet.content["to"]
        self.slots = patched_slots(self.slots, packet.content, arrays)

    def shows(self, mesh: HalfEdgeMesh, frame: CoordinateFrame) -> bool:
        """Whether it equals this mesh, to the bit."""
        real = SlotArrays.of(mesh, frame, len(self.slots.flags), len(self.slots.origin))
        return real.buffers == self.slots.buffers


class Port:
    """Stands in for a widget: records messages, and applies them to a replica."""

    def __init__(self, session: Session, view: str = "v", read_only: bool = False) -> None:
        self.session, self.view, self.read_only = session, view, read_only
        self.reachable = True
        self.model_id = f"model of {view}"
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

    def keep(self, snapshot: dict[str, Any]) -> None:
        self.snapshot = snapshot

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
