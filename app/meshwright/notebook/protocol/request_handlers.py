"""What is done for each word that a browser may say, beyond looking."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from meshwright.document.history import HistoryStep
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.operations.catalogue import of_kind

if TYPE_CHECKING:
    from meshwright.notebook.protocol.requests import Request
    from meshwright.notebook.session import Session

Deed = Callable[["Session", "Request"], str]


def require_operation(kind: str, operation: str) -> None:
    """Raise MeshError unless meshes of ``kind`` have this operation."""
    if operation not in (str(info.operation) for info in of_kind(kind)):
        shown = operation if len(operation) <= 40 and operation.isprintable() else "of that name"
        raise MeshError(f"there is no operation '{shown}' for meshes of this kind")


def require_halfedge(mesh: HalfEdgeMesh, halfedge: int) -> None:
    """Raise MeshError unless there is this half-edge."""
    if not mesh.live(halfedge):
        raise MeshError(f"there is no half-edge {halfedge} in this mesh")


def _operate(session: Session, request: Request) -> str:
    document, mesh = session.document, session.mesh
    operation, halfedge, ends = request["operation"], request["halfedge"], request["ends"]
    require_operation(mesh.kind, operation)
    if not mesh.live(halfedge) or (mesh.origin(halfedge), mesh.target(halfedge)) != ends:
        raise MeshError("the mesh has changed there meanwhile: nothing was done")
    verdict = document.check(operation, halfedge)
    if not verdict:
        raise MeshError(verdict.reason)
    document.submit(operation, halfedge)
    return ""


def _undo(session: Session, request: Request) -> str:
    return _told("Undone", session.document.undo(), "There is nothing to undo.")


def _redo(session: Session, request: Request) -> str:
    return _told("Done again", session.document.redo(), "There is nothing to redo.")


def _go_to(session: Session, request: Request) -> str:
    length = len(session.document.history)
    if request["cursor"] > length:
        raise MeshError(f"the history has {length} steps only")
    session.document.go_to(request["cursor"])
    return ""


def _smooth(session: Session, request: Request) -> str:
    before = session.document.revision
    session.document.smooth()
    return "Smoothed." if session.document.revision != before else "It is smooth already."


def _untangle(session: Session, request: Request) -> str:
    found, left = session.document.untangle()
    if not found:
        return "No element is inverted."
    return f"{found - left:,} of {found:,} inverted elements mended."


def _clean_all(session: Session, request: Request) -> str:
    if session.mesh.kind != "quad":
        raise MeshError("only quad meshes have global lines")
    count = session.document.clean_all()
    if not count:
        return "There is no line that can be removed."
    return f"Removed {count:,} line{'' if count == 1 else 's'}."


def _auto_smooth(session: Session, request: Request) -> str:
    session.document.auto_smooth = request["on"]
    session.telling.touch()
    return ""


def _desired(session: Session, request: Request) -> str:
    session.document.set_desired(_vertex(session, request), request["degree"])
    return ""


def _lock(session: Session, request: Request) -> str:
    session.document.set_locked(_vertex(session, request), request["on"])
    return ""


def _corner(session: Session, request: Request) -> str:
    session.document.set_geometric(_vertex(session, request), request["on"])
    return ""


def _agent(session: Session, request: Request) -> str:
    session.agent.act(request["action"])
    return ""


def _speed(session: Session, request: Request) -> str:
    session.assistant.speed = request["value"]
    return ""


def _policy(session: Session, request: Request) -> str:
    if request["name"] not in session.agent.policies:  # no file is opened for a browser
        raise MeshError("that policy is not one of those on offer")
    session.agent.choose(request["name"])
    return ""


def _take_hint(session: Session, request: Request) -> str:
    session.agent.take(request["index"])
    return ""


def _vertex(session: Session, request: Request) -> np.ndarray:
    vertex = request["vertex"]
    if vertex >= session.mesh.slots or not session.mesh.degree()[vertex]:
        raise MeshError(f"there is no vertex {vertex} in this mesh")
    return np.array([vertex])


def _told(done: str, row: HistoryStep | None, otherwise: str) -> str:
    return otherwise if row is None else f"{done}: {row.title}."


DEEDS: dict[str, Deed] = {
    "operate": _operate,
    "undo": _undo,
    "redo": _redo,
    "go_to": _go_to,
    "smooth": _smooth,
    "untangle": _untangle,
    "clean_all": _clean_all,
    "auto_smooth": _auto_smooth,
    "desired": _desired,
    "lock": _lock,
    "corner": _corner,
    "agent": _agent,
    "speed": _speed,
    "policy": _policy,
    "take_hint": _take_hint,
}
"""By word; `level` is added by who plays levels."""
