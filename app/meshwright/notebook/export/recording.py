"""Recordings: all states of a document's history as messages that the browser replays alone."""

from __future__ import annotations

from base64 import b64encode
from typing import Any

from meshwright.document.document import NO_MESH, Document
from meshwright.document.history import History
from meshwright.document.storage.document_state import DocumentState
from meshwright.notebook.protocol.document_status import DocumentStatus
from meshwright.notebook.protocol.mesh_sync import MeshSync, Packet
from meshwright_core import MeshError

VERSION = 1


def record(document: Document) -> dict[str, Any]:
    """The recording of ``document`` as values that JSON can hold; the document is not changed.

    ``start`` is the number of the present state; ``state`` the message of state 0; ``steps`` one
    message for each further state, whose ``head`` holds changed values only; ``track`` the scores
    of all states. Raises MeshError where the document has no mesh.
    """
    shadow = _copied(document)
    shadow.go_to(0)
    mesh, mesh_sync, status = shadow.mesh, MeshSync(), DocumentStatus(shadow)
    if mesh is None:
        raise MeshError(NO_MESH)
    mesh_sync.reset(mesh)
    status.reset()
    values = status.full()
    track = values.pop("track")
    first = mesh_sync.state()
    first.content |= {"head": values, "catalogue": [], "read_only": True}
    steps = []
    for state in range(1, len(shadow.history) + 1):
        shadow.go_to(state)
        packet = mesh_sync.patch(mesh)
        before, values = values, status.update()
        del values["track"]  # the recording holds all of it once
        packet.content["head"] = {
            name: value for name, value in values.items() if value != before[name]
        }
        steps.append(_message(packet))
    return {
        "version": VERSION,
        "start": document.history.cursor,
        "track": track,
        "state": _message(first),
        "steps": steps,
    }


def _copied(document: Document) -> Document:
    """An independent document with a copy of the mesh and the same history."""
    state, known = document.state(), document.history
    history = History.of(*known.first, list(known), known.cursor, serial=known.given[0])
    copied = Document()
    copied.adopt(DocumentState(state.mesh.copy(history=True), history, state.name))
    return copied


def _message(packet: Packet) -> dict[str, Any]:
    """The message with its arrays joined in Base64; ``sizes`` are their lengths in bytes."""
    return {
        "content": packet.content,
        "sizes": [len(buffer) for buffer in packet.buffers],
        "arrays": b64encode(b"".join(packet.buffers)).decode("ascii"),
    }
