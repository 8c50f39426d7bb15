"""The known solution of a level: which operation follows in the present state."""

from __future__ import annotations

import numpy as np

from meshwright.puzzles.level import Level, halfedge_of
from meshwright_core import HalfEdgeMesh, Operation


class KnownSolution:
    """The states on the way of a level's solution, recognised by their elements."""

    def __init__(self, level: Level) -> None:
        mesh = level.mesh()
        self._next: dict[bytes, tuple[Operation, tuple[int, int]]] = {}
        for operation, (a, b) in level.solution:
            self._next[_key(mesh)] = operation, (a, b)
            mesh.apply(operation, halfedge_of(mesh, a, b))

    def next(self, mesh: HalfEdgeMesh) -> tuple[Operation, int] | None:
        """The operation of the solution and its half-edge; None in a state that is not on the way,
        and at the goal.
        """
        found = self._next.get(_key(mesh))
        if found is None:
            return None
        operation, (a, b) = found
        return operation, halfedge_of(mesh, a, b)


def _key(mesh: HalfEdgeMesh) -> bytes:
    """The elements of a mesh, whatever their ids and first vertices are."""
    elements = mesh.elements()
    first = elements.argmin(axis=1)
    turned = (first[:, None] + np.arange(elements.shape[1])) % elements.shape[1]
    rows = np.take_along_axis(elements, turned, axis=1)
    return np.ascontiguousarray(rows[np.lexsort(rows.T)]).tobytes()
