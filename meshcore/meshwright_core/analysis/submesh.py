"""An enclosure: a part of a mesh that may change while the elements outside stay as they are.

Its rim, the vertices that it shares with elements outside, does not move either, so that elements
outside keep their corners and positions. Only the number of edges that reach the rim from inside
may change.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from meshwright_core.core.arrays import ELEMENT_SLOTS, FLAGS, LOCKED, ORIGIN, TWIN
from meshwright_core.errors import MeshError

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


class Enclosure(NamedTuple):
    """A part of one mesh in one state."""

    elements: np.ndarray
    """(n,) ids, ascending, of its elements; none of its vertices is pinched."""
    free: np.ndarray
    """(f,) ids, ascending, of the vertices all of whose elements lie in it."""
    held: np.ndarray
    """(m,) ids, ascending, of all other live vertices of the mesh: the rim, and what is outside."""


def enclose(mesh: HalfEdgeMesh, elements: np.ndarray) -> Enclosure:
    """The enclosure of `elements` (n,), ids of live ones.

    Where they meet in a single vertex only, one group is kept there, that of the largest connected
    part, so that the enclosure is a manifold mesh. Raises MeshError if it has no free vertex.
    """
    inside = np.zeros(int(mesh.arrays.counters[ELEMENT_SLOTS]), bool)
    inside[elements] = True
    while len(pinched := _pinched(mesh, inside)):
        size = _sizes(mesh, inside)
        for vertex in pinched.tolist():
            groups = _groups(mesh, inside, vertex)
            groups.sort(key=lambda group: (size[group[0]], len(group)))
            for group in groups[:-1]:
                inside[group] = False
    kept = np.flatnonzero(inside)
    corner = np.zeros(mesh.slots, bool)
    live = mesh.vertices()
    corner[live] = True
    outer = mesh.element_ids()
    outer = outer[~inside[outer]]
    corner[mesh.corners(outer)] = False
    free = np.flatnonzero(corner)
    if not len(free):
        raise MeshError(
            "No vertex lies inside this region: select at least one with all elements around it."
        )
    return Enclosure(kept, free, live[~corner[live]])


def _pinched(mesh: HalfEdgeMesh, inside: np.ndarray) -> np.ndarray:
    """The vertices at which the elements `inside` (slots,) form more than one group."""
    k, edge = mesh.k, mesh.arrays.edge
    halfedges = mesh.halfedges_of(np.flatnonzero(inside)).ravel()
    twins = edge[halfedges, TWIN]
    rim = (twins < 0) | ~inside[np.maximum(twins, 0) // k]
    # each group that is not the whole star of a vertex has one half-edge of the rim that leaves it
    leaving = np.bincount(edge[halfedges[rim], ORIGIN], minlength=1)
    return np.flatnonzero(leaving > 1)


def _sizes(mesh: HalfEdgeMesh, inside: np.ndarray) -> dict[int, int]:
    """For each element `inside` the size of its part, connected over edges."""
    k, edge = mesh.k, mesh.arrays.edge
    size: dict[int, int] = {}
    for seed in np.flatnonzero(inside).tolist():
        if seed in size:
            continue
        part, size[seed] = [seed], 0
        for element in part:
            for twin in edge[k * element : k * element + k, TWIN].tolist():
                if twin >= 0 and inside[twin // k] and twin // k not in size:
                    size[twin // k] = 0
                    part.append(twin // k)
        size.update(dict.fromkeys(part, len(part)))
    return size


def _groups(mesh: HalfEdgeMesh, inside: np.ndarray, vertex: int) -> list[list[int]]:
    """The elements `inside` at a vertex, those together that are joined by edges at it."""
    elements = [h // mesh.k for h in mesh.outgoing(vertex)]
    groups: list[list[int]] = []
    joined = False
    for element in elements:
        if inside[element] and joined:
            groups[-1].append(element)
        elif inside[element]:
            groups.append([element])
        joined = bool(inside[element])
    closed = not mesh.is_boundary(vertex)
    if closed and len(groups) > 1 and inside[elements[0]] and inside[elements[-1]]:
        groups[0] = groups.pop() + groups[0]
    return groups


@contextmanager
def temporarily_locked(mesh: HalfEdgeMesh, vertices: np.ndarray) -> Iterator[None]:
    """Lock `vertices` (n,) inside a with block, so that operations and smoothing keep them.

    These locks are not journalled: no undo restores them. All of them are removed at the end, also
    after an exception; vertices that were locked before stay locked.
    """
    flags = mesh.arrays.vertex[vertices, FLAGS]
    ours = vertices[(flags & LOCKED) == 0]
    mesh.arrays.vertex[ours, FLAGS] |= LOCKED
    try:
        yield
    finally:
        mesh.arrays.vertex[ours, FLAGS] &= ~LOCKED
