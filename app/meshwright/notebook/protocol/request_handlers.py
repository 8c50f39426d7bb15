"""One handler for each request that changes the document or the agent."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import UNSET

from meshwright.document.history import HistoryStep
from meshwright.notebook.protocol import blocks_messages, requests
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.operations.catalogue import of_kind

if TYPE_CHECKING:
    from meshwright.notebook.session import Session

Handler = Callable[["Session", Any], str]
"""Gets the session and the request; returns a sentence for the reader, or none. Raises MeshError
where the request is refused.
"""


def require_operation(kind: str, operation: str) -> None:
    """Raise MeshError unless meshes of ``kind`` have this operation."""
    if operation not in (str(info.operation) for info in of_kind(kind)):
        shown = operation if len(operation) <= 40 and operation.isprintable() else "of that name"
        raise MeshError(f"there is no operation '{shown}' for meshes of this kind")


def require_halfedge(mesh: HalfEdgeMesh, halfedge: int) -> None:
    """Raise MeshError unless the half-edge exists."""
    if not mesh.live(halfedge):
        raise MeshError(f"there is no half-edge {halfedge} in this mesh")


def _operate(session: Session, request: requests.Operate) -> str:
    document, mesh = session.document, session.mesh
    operation, halfedge, ends = request.operation, request.halfedge, request.ends
    require_operation(mesh.kind, operation)
    if not mesh.live(halfedge) or (mesh.origin(halfedge), mesh.target(halfedge)) != ends:
        raise MeshError("the mesh has changed here in the meantime: nothing was done")
    verdict = document.check(operation, halfedge)
    if not verdict:
        raise MeshError(verdict.reason)
    document.submit(operation, halfedge)
    return ""


def _undo(session: Session, request: requests.Undo) -> str:
    return _outcome("Undone", session.document.undo(), "There is nothing to undo.")


def _redo(session: Session, request: requests.Redo) -> str:
    return _outcome("Redone", session.document.redo(), "There is nothing to redo.")


def _go_to(session: Session, request: requests.GoTo) -> str:
    length = len(session.document.history)
    if request.cursor > length:
        raise MeshError(f"the history has {length} steps only")
    session.document.go_to(request.cursor)
    return ""


def _smooth(session: Session, request: requests.Smooth) -> str:
    before = session.document.revision
    session.document.smooth()
    return "Smoothed." if session.document.revision != before else "The mesh is smooth already."


def _untangle(session: Session, request: requests.Untangle) -> str:
    found, left = session.document.untangle()
    if not found:
        return "No element is inverted."
    return f"{found - left:,} of {found:,} inverted elements repaired."


def _clean_all(session: Session, request: requests.CleanAll) -> str:
    if session.mesh.kind != "quad":
        raise MeshError("only quad meshes have global lines")
    count = session.document.clean_all()
    if not count:
        return "No global line can be removed."
    return f"Removed {count:,} line{'' if count == 1 else 's'}."


def _auto_smooth(session: Session, request: requests.AutoSmooth) -> str:
    session.document.auto_smooth = request.on
    session.broadcaster.touch()
    return ""


def _desired(session: Session, request: requests.Desired) -> str:
    session.document.set_desired(_vertex(session, request.vertex), request.degree)
    return ""


def _lock(session: Session, request: requests.Lock) -> str:
    session.document.set_locked(_vertex(session, request.vertex), request.on)
    return ""


def _pin(session: Session, request: requests.Pin) -> str:
    session.document.set_pinned(_vertex(session, request.vertex), request.on)
    return ""


def _corner(session: Session, request: requests.Corner) -> str:
    session.document.set_geometric(_vertex(session, request.vertex), request.on)
    return ""


def _agent(session: Session, request: requests.Agent) -> str:
    prefer = "balanced" if request.prefer is UNSET else request.prefer
    session.agent.act(request.action, prefer, request.keep_size is True)
    return ""


def _speed(session: Session, request: requests.Speed) -> str:
    session.assistant.speed = request.value
    return ""


def _policy(session: Session, request: requests.ChoosePolicy) -> str:
    if request.name not in session.agent.policies:  # a browser must not open files
        raise MeshError("that policy is not one of those on offer")
    session.agent.choose(request.name)
    return ""


def _take_hint(session: Session, request: requests.TakeHint) -> str:
    session.agent.take(request.index)
    return ""


def _vertex(session: Session, vertex: int) -> np.ndarray:
    if vertex >= session.mesh.slots or not session.mesh.degree()[vertex]:
        raise MeshError(f"there is no vertex {vertex} in this mesh")
    return np.array([vertex])


def _outcome(done: str, row: HistoryStep | None, otherwise: str) -> str:
    return otherwise if row is None else f"{done}: {row.title}."


HANDLERS: dict[type[requests.Request], Handler] = {
    requests.Operate: _operate,
    requests.Undo: _undo,
    requests.Redo: _redo,
    requests.GoTo: _go_to,
    requests.Smooth: _smooth,
    requests.Untangle: _untangle,
    requests.CleanAll: _clean_all,
    requests.AutoSmooth: _auto_smooth,
    requests.Desired: _desired,
    requests.Lock: _lock,
    requests.Pin: _pin,
    requests.Corner: _corner,
    requests.Agent: _agent,
    requests.Speed: _speed,
    requests.ChoosePolicy: _policy,
    requests.TakeHint: _take_hint,
    requests.ShowBlocks: blocks_messages.show_blocks,
    requests.ChordCount: blocks_messages.set_chord_count,
    requests.ExportBlocks: blocks_messages.export_blocks,
}
"""By type of request; that of a level is added by the level bridge."""
