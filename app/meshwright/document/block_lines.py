"""Lines of block edges: the straight line through an edge, sliding it and making it straight.

Neither changes the connectivity. Both return what :meth:`HalfEdgeMesh.move` takes, or raise
MeshError, one sentence, where the line cannot be moved so.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.arrays import CURVE, FLAGS, GEOMETRIC, LOCKED
from meshwright_core.geometry.edge_parts import EdgeParts

FARTHEST = 0.95
"""Fraction of the way to the next line that a line may slide."""


class Line(NamedTuple):
    """A line of edges that goes straight on through regular vertices."""

    halfedges: list[int]
    """In order, each ending where the next one starts."""
    closed: bool


class Move(NamedTuple):
    """New places of vertices."""

    vertices: np.ndarray
    """(n,) ids."""
    positions: np.ndarray
    """(n, 3)."""
    parameters: np.ndarray
    """(n,) of those on curves."""


def line_through(mesh: HalfEdgeMesh, halfedge: int) -> Line:
    """The line of a half-edge inside a quad mesh, from end to end; of a boundary edge itself
    alone.
    """
    if mesh.twin(halfedge) < 0:
        return Line([halfedge], False)
    ahead = _walk(mesh, halfedge)
    if len(ahead) > 1 and ahead[-1] == halfedge:
        return Line(ahead[:-1], True)
    back = _walk(mesh, mesh.twin(halfedge))
    return Line([mesh.twin(h) for h in reversed(back[1:])] + ahead, False)


def _walk(mesh: HalfEdgeMesh, halfedge: int) -> list[int]:
    """Half-edges from this one straight on; ends with the first one again where it closes."""
    found = [halfedge]
    for _ in range(4 * mesh.n_elements):
        vertex = mesh.target(found[-1])
        if mesh.is_boundary(vertex) or len(mesh.outgoing(vertex)) != 4:
            break
        found.append(mesh.next(mesh.twin(mesh.next(found[-1]))))
        if found[-1] == halfedge:
            break
    return found


def slid(mesh: HalfEdgeMesh, halfedge: int, share: float) -> Move:
    """The line through a half-edge moved by a share, -1 to 1, of the way to the line on its left,
    or for a negative one on its right. Ends at irregular vertices and corners stay.
    """
    line = line_through(mesh, halfedge)
    if mesh.twin(halfedge) < 0:
        raise MeshError("This line is the boundary, and cannot slide.")
    share = float(np.clip(share, -FARTHEST, FARTHEST))
    across = [_across(mesh, h, share > 0.0, False) for h in line.halfedges]
    vertices = [mesh.origin(h) for h in line.halfedges]
    if not line.closed:
        across.append(_across(mesh, line.halfedges[-1], share > 0.0, True))
        vertices.append(mesh.target(line.halfedges[-1]))
    ids, crossing = np.array(vertices), np.array([h for h, _ in across])
    forward = np.array([ahead for _, ahead in across])
    parts = EdgeParts.of(mesh.arrays, crossing, 4)
    rows = mesh.arrays.vertex[ids]
    free = (rows[:, FLAGS] & (GEOMETRIC | LOCKED)) == 0
    inner = rows[:, CURVE] < 0
    if (~inner[1:-1] & (parts.curve[1:-1] < 0)).any():
        raise MeshError("This line runs along an interface, and cannot slide.")
    free &= inner | (parts.curve >= 0)
    if not line.closed:
        for place in (0, -1):
            degree = len(mesh.neighbours(int(ids[place])))
            free[place] &= degree == (3 if mesh.is_boundary(int(ids[place])) else 4)
    w = np.where(forward, abs(share), 1.0 - abs(share))
    places = parts.points(np.arange(len(ids)), w)
    parameters = mesh.parameters()[ids].copy()
    on = np.flatnonzero(~inner & (parts.curve >= 0))
    along = parts.span[on, 0] + w[on] * (parts.span[on, 1] - parts.span[on, 0])
    lengths = mesh.boundary_info.lengths()[parts.curve[on]]
    closed = mesh.boundary_info.curves.closed[parts.curve[on]]
    parameters[on] = np.where(closed, np.mod(along, lengths), along)
    return _moving(Move(ids[free], places[free], parameters[free]), "slide")


def _across(mesh: HalfEdgeMesh, halfedge: int, left: bool, end: bool) -> tuple[int, bool]:
    """The half-edge that crosses a line at the origin of one of its half-edges, or at its end, on
    one side, and whether it leaves the line.
    """
    if left:
        return (mesh.next(halfedge), True) if end else (mesh.prev(halfedge), False)
    twin = mesh.twin(halfedge)
    return (mesh.prev(twin), False) if end else (mesh.next(twin), True)


def straightened(mesh: HalfEdgeMesh, halfedge: int) -> Move:
    """The line through a half-edge straight between the vertices on it that cannot move: its ends,
    those on curves, and locked ones; its vertices keep their shares of the length.
    """
    line = line_through(mesh, halfedge)
    if mesh.twin(halfedge) < 0:
        raise MeshError("This line is the boundary, and keeps its shape.")
    if line.closed:
        raise MeshError("This line is closed: it has no ends between which it could be straight.")
    ids = np.array([mesh.origin(h) for h in line.halfedges] + [mesh.target(line.halfedges[-1])])
    rows = mesh.arrays.vertex[ids]
    stays = (rows[:, CURVE] >= 0) | ((rows[:, FLAGS] & (GEOMETRIC | LOCKED)) > 0)
    stays[[0, -1]] = True
    at = mesh.points[ids].copy()
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(at, axis=0), axis=1))])
    stops = np.flatnonzero(stays)
    places = np.column_stack([np.interp(arc, arc[stops], at[stops, c]) for c in range(3)])
    size = float(np.ptp(at, axis=0).max())
    moving = ~stays & (np.linalg.norm(places - at, axis=1) > 1e-12 * size)
    if not moving.any():
        raise MeshError("This line is straight already, or none of its vertices can move.")
    return Move(ids[moving], places[moving], mesh.parameters()[ids[moving]])


def _moving(move: Move, what: str) -> Move:
    if not len(move.vertices):
        raise MeshError(f"This line cannot {what}: none of its vertices can move.")
    return move
