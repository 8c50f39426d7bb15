"""Leads the document to the result of a search: its operations become steps of the history."""

from __future__ import annotations

import time

import numpy as np

from meshwright.document.document import Document
from meshwright_core import HalfEdgeMesh, Operation
from meshwright_core.geometry.quality import inverted

SLICE = 0.02
"""Seconds of applying operations after which a frame is drawn."""
LONGEST = 0.2
"""The same, where the walk is behind its time."""


class ResultWalk:
    """Applies the operations of a result in slices, so that each slice can be drawn.

    As long as there is time, the vertices around each operation are smoothed. At the end the
    vertices get the positions that the search has judged the result by. Each operation is a step of
    the history by ``author``, and the positions are one.
    """

    def __init__(
        self,
        document: Document,
        author: str,
        operations: list[tuple[Operation, int]],
        held: np.ndarray | None,
        target: HalfEdgeMesh | None,
        shown: float = 2.0,
    ) -> None:
        """`held` (n,): vertices that keep their positions; `target`: the mesh that the operations
        lead to, with its positions; None: it is smoothed. shown: seconds that the way takes at
        most, unless the operations alone take longer.
        """
        self._shown = shown
        self._document, self._author = document, author
        self._operations, self._held, self._target = operations, held, target
        self._start = document.history.cursor
        self._inverted = len(inverted(document.need_mesh()))
        self._began = 0.0
        self.done = 0
        """Operations applied."""

    @property
    def total(self) -> int:
        """Number of operations."""
        return len(self._operations)

    @property
    def arrived(self) -> bool:
        """Whether all operations have been applied."""
        return self.done == self.total

    def advance(self) -> None:
        """Apply operations for a moment. Raises MeshError if one is refused."""
        now = time.monotonic()
        self._began = self._began or now
        with self._document.together():
            while not self.arrived:
                behind = self._behind()
                self._apply(smooth=not behind)
                if time.monotonic() - now > (LONGEST if behind else SLICE):
                    break

    def skip(self) -> None:
        """Apply all that is left at once. Raises MeshError if an operation is refused."""
        with self._document.together():
            while not self.arrived:
                self._apply(smooth=False)

    def settle(self) -> bool:
        """Place the vertices; False if that left more elements inverted than before the walk, and
        the document was taken back to where it began. Where vertices of a surface are not smoothed,
        the walk ends at the last state without such elements.
        """
        document = self._document
        mesh = document.need_mesh()
        if not self.total and self._target is None:
            return True
        if not (document.plane or document.smooth_surfaces):
            self._go_back_to_valid(mesh)
            return True
        with document.together():
            if not self._place(mesh):
                self._smooth(mesh)
            if len(inverted(mesh)) > self._inverted:
                self._smooth(mesh)
            if len(inverted(mesh)) > self._inverted:
                document.go_to(self._start)
                return False
        return True

    def stop_here(self) -> bool:
        """Stay at the present state, with the rest of the way as steps that can be redone; the
        outcome of :meth:`settle`.
        """
        here = self._document.history.cursor
        with self._document.together():
            self.skip()
            fine = self.settle()
            reached = self._document.history.cursor
            self._document.go_to(min(here, reached) if fine else self._start)
        return fine

    def _go_back_to_valid(self, mesh: HalfEdgeMesh) -> None:
        """End at the last state without more elements inverted than before the walk: vertices of a
        surface that is not smoothed stay where they are. The steps after it can be redone.
        """
        history = self._document.history
        with self._document.together():
            while history.cursor > self._start and len(inverted(mesh)) > self._inverted:
                self._document.go_to(history.cursor - 1)

    def _behind(self) -> bool:
        return self.done < self.total * (time.monotonic() - self._began) / (0.75 * self._shown)

    def _apply(self, smooth: bool) -> None:
        operation, halfedge = self._operations[self.done]
        self._document.submit(
            operation, halfedge, by=self._author, held=self._held, thorough=False, smooth=smooth
        )
        self.done += 1

    def _place(self, mesh: HalfEdgeMesh) -> bool:
        """Give the vertices the positions of the target; False if there is none that fits."""
        target = self._target
        if target is None or not np.array_equal(mesh.elements(), target.elements()):
            return False
        ids = mesh.vertices()
        moved = (mesh.points[ids] != target.points[ids]).any(axis=1)
        moved |= mesh.arrays.parameter[ids] != target.arrays.parameter[ids]
        ids = ids[moved]
        if len(ids):
            parameters = target.arrays.parameter[ids]
            self._document.move(ids, target.points[ids], self._author, parameters, "Positions")
        return True

    def _smooth(self, mesh: HalfEdgeMesh) -> None:
        if self._held is None:
            self._document.smooth(self._author)
        else:
            self._document.smooth(self._author, np.setdiff1d(mesh.vertices(), self._held))
