"""The selection: a set of vertices of the document's mesh, and the region that they span."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from meshwright.signals import Signal
from meshwright_core.core.arrays import HALF
from meshwright_core.geometry.movable_part import elements_at, rings

if TYPE_CHECKING:
    from meshwright.document.document import Document

_NONE = np.zeros(0, np.int64)


class Selection:
    """The selected vertices; ``changed()`` is emitted when they change.

    A deleted vertex leaves the selection; replacing the mesh empties it.
    """

    def __init__(self, document: Document) -> None:
        self.changed = Signal()
        self._document = document
        self._vertices = _NONE
        self._elements: np.ndarray | None = None
        document.replaced.connect(self.clear)
        document.changed.connect(self._on_changed)

    def __len__(self) -> int:
        return len(self._vertices)

    def __contains__(self, vertex: int) -> bool:
        at = int(np.searchsorted(self._vertices, vertex))
        return at < len(self._vertices) and int(self._vertices[at]) == vertex

    @property
    def vertices(self) -> np.ndarray:
        """(n,) ids of the selected vertices, ascending."""
        return self._vertices

    @property
    def elements(self) -> np.ndarray:
        """(m,) ids, ascending, of the elements all of whose corners are selected: the region."""
        if self._elements is None:
            self._elements = self._spanned()
        return self._elements

    @property
    def free(self) -> np.ndarray:
        """(f,) ids of the selected vertices all of whose elements lie in the region."""
        mesh = self._document.mesh
        if mesh is None or not len(self.elements):
            return _NONE
        inside = np.zeros(mesh.slots, bool)
        inside[self._vertices] = True
        around = elements_at(mesh, self._vertices)
        outer = around[~np.isin(around, self.elements)]
        inside[mesh.corners(outer)] = False
        return np.flatnonzero(inside)

    # Selecting

    def set(self, vertices: np.ndarray | Sequence[int]) -> None:
        """Select these vertices and no others; ids without a vertex are left out."""
        ids = self._living(np.unique(np.asarray(vertices, np.int64)))
        if not np.array_equal(ids, self._vertices):
            self._vertices, self._elements = ids, None
            self.changed.emit()

    def clear(self) -> None:
        """Select nothing."""
        self.set(_NONE)

    def toggle(self, vertex: int) -> None:
        """Add a vertex to the selection, or remove it if it is selected."""
        self.set(np.setxor1d(self._vertices, [vertex]))

    def add(self, vertices: np.ndarray) -> None:
        """Select these vertices too."""
        self.set(np.union1d(self._vertices, vertices))

    def everything(self) -> None:
        """Select all vertices."""
        mesh = self._document.mesh
        self.set(mesh.vertices() if mesh is not None else _NONE)

    def invert(self) -> None:
        """Select what is not selected."""
        mesh = self._document.mesh
        if mesh is not None:
            self.set(np.setdiff1d(mesh.vertices(), self._vertices, assume_unique=True))

    def irregular(self) -> None:
        """Select all irregular vertices."""
        mesh = self._document.mesh
        self.set(np.flatnonzero(mesh.irregularity()) if mesh is not None else _NONE)

    def of_degree(self, degree: int) -> None:
        """Select all vertices with so many edges."""
        mesh = self._document.mesh
        self.set(np.flatnonzero(mesh.degree() == degree) if mesh is not None else _NONE)

    def grow(self) -> None:
        """Select the corners of all elements at selected vertices too."""
        mesh = self._document.mesh
        if mesh is not None and len(self._vertices):
            self.set(rings(mesh, self._vertices, 1))

    def shrink(self) -> None:
        """Remove the vertices that have a neighbour outside the selection."""
        mesh = self._document.mesh
        if mesh is not None and len(self._vertices):
            around = elements_at(mesh, self._vertices)
            corners = np.unique(mesh.corners(around))
            outside = np.setdiff1d(corners, self._vertices, assume_unique=True)
            if len(outside):
                near = np.unique(mesh.corners(elements_at(mesh, outside)))
                self.set(np.setdiff1d(self._vertices, near, assume_unique=True))

    # Inside

    def _living(self, ids: np.ndarray) -> np.ndarray:
        mesh = self._document.mesh
        if mesh is None or not len(ids):
            return _NONE
        ids = ids[(ids >= 0) & (ids < mesh.slots)]
        return ids[mesh.arrays.vertex[ids, HALF] >= 0]

    def _spanned(self) -> np.ndarray:
        mesh = self._document.mesh
        if mesh is None or len(self._vertices) < mesh.k:
            return _NONE
        chosen = np.zeros(mesh.slots, bool)
        chosen[self._vertices] = True
        around = elements_at(mesh, self._vertices)
        corners = mesh.corners(around)
        return around[chosen[corners].all(axis=1)]

    def _on_changed(self) -> None:
        if len(self._vertices):
            self._elements = None
            living = self._living(self._vertices)
            if len(living) != len(self._vertices):
                self._vertices = living
                self.changed.emit()


def in_box(points: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(n,) which of the points (n, 2) lie in the box with these two opposite corners (2,)."""
    low, high = np.minimum(first, second), np.maximum(first, second)
    inside: np.ndarray = ((points >= low) & (points <= high)).all(axis=1)
    return inside
