"""A recording: all states of a document's history as messages that need no Python any more."""

from __future__ import annotations

from base64 import b64encode
from typing import Any

from meshwright.document.document import Document
from meshwright.document.history import History
from meshwright.document.storage.document_state import DocumentState
from meshwright.notebook.protocol.document_status import Head
from meshwright.notebook.protocol.mesh_sync import Mirror, Packet

VERSION = 1


def record(document: Document) -> dict[str, Any]:
    """The film of ``document`` as plain values that JSON can hold; the document is not touched.

    ``start`` is the state in which the document is now; ``state`` the message of state 0; ``steps``
    one message for each further state, with only what is new in its head; ``track`` the scores of
    all. Raises MeshError where the document has no mesh.
    """
    shadow = _copied(document)
    shadow.go_to(0)
    mesh, mirror, head = shadow.mesh, Mirror(), Head(shadow)
    mirror.reset(mesh)
    head.reset()
    told = head.whole()
    track = told.pop("track")
    first = mirror.state()
    first.content |= {"head": told, "catalogue": [], "read_only": True}
    steps = []
    for state in range(1, len(shadow.history) + 1):
        shadow.go_to(state)
        packet = mirror.patch(mesh)
        head.folded.follow(mesh, mirror.moved, mirror.turned)
        before, told = told, head.news()
        del told["track"]  # all of it is there from the beginning
        packet.content["head"] = {
            name: value for name, value in told.items() if value != before[name]
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
    """A document of the same mesh and history that may go back and forth on its own."""
    kept, known = document.state(), document.history
    history = History.of(*known.first, list(known), known.cursor, serial=known.given[0])
    copied = Document()
    copied.adopt(DocumentState(kept.mesh.copy(history=True), history, kept.name))
    return copied


def _message(packet: Packet) -> dict[str, Any]:
    """The message with its arrays in one text; ``sizes`` are their bytes."""
    return {
        "content": packet.content,
        "sizes": [len(buffer) for buffer in packet.buffers],
        "arrays": b64encode(b"".join(packet.buffers)).decode("ascii"),
    }
