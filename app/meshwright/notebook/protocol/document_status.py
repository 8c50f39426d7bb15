"""The document's numbers for the browser: scores, counts, position in the history, its curve."""

from __future__ import annotations

from typing import Any

import numpy as np

from meshwright.document.document import Document
from meshwright.document.score_series import ScoreSeries
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import ELEMENT_SLOTS, ORIGIN
from meshwright_core.geometry.planes import plane_normal
from meshwright_core.geometry.quality import Measure, inverted

BLOCKS_UP_TO = 20_000
"""Number of elements above which the blocks of a quad mesh are not counted after every step."""


class InvertedElements:
    """Counts the inverted elements incrementally, at the cost of the elements that changed."""

    def __init__(self) -> None:
        self._normal: np.ndarray | None = None
        self._inverted = np.zeros(0, dtype=bool)

    def __len__(self) -> int:
        return int(self._inverted.sum())

    def reset(self, mesh: HalfEdgeMesh) -> None:
        """Test all elements."""
        self._normal = plane_normal(mesh)
        self._inverted = np.zeros(_element_slots(mesh), dtype=bool)
        self._inverted[inverted(mesh)] = True

    def follow(self, mesh: HalfEdgeMesh, vertices: np.ndarray, halfedges: np.ndarray) -> None:
        """Test the elements at moved ``vertices`` and changed ``halfedges`` (ids) again."""
        slots = _element_slots(mesh)
        if self._normal is None or 4 * len(vertices) > mesh.n_vertices:
            self.reset(mesh)
            return
        corners = mesh.arrays.edge[: slots * mesh.k, ORIGIN].reshape(slots, mesh.k)
        moved = np.zeros(len(mesh.arrays.vertex), dtype=bool)
        moved[vertices[vertices < len(moved)]] = True
        look = moved[corners].any(axis=1)  # -1 of a dead element is filtered out below
        touched = halfedges // mesh.k
        look[touched[touched < slots]] = True
        found = np.zeros(slots, dtype=bool)
        kept = min(slots, len(self._inverted))
        found[:kept] = self._inverted[:kept]
        found[look] = False
        elements = np.flatnonzero(look & (corners[:, 0] >= 0))
        found[elements] = Measure(mesh, elements, self._normal).everything().inverted
        self._inverted = found


class DocumentStatus:
    """The numbers of one document that are sent with every state and patch, as ``head``."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._series = ScoreSeries()
        self.inverted = InvertedElements()

    def reset(self) -> None:
        """The document has another mesh."""
        if self._document.mesh is not None:
            self.inverted.reset(self._document.mesh)

    def full(self) -> dict[str, Any]:
        """All numbers, with the scores of all states."""
        self._series.follow(self._document.history)
        return self._values(0)

    def update(self) -> dict[str, Any]:
        """All numbers, with the scores of the states since the last call."""
        return self._values(self._series.follow(self._document.history))

    def _values(self, first: int) -> dict[str, Any]:
        document, mesh = self._document, self._document.mesh
        history = document.history
        return {
            "score": document.score,
            "optimum": document.optimum,
            "start": document.start_score,
            "best": document.best_score,
            "return": round(document.normalised_return, 6),
            "elements": mesh.n_elements if mesh is not None else 0,
            "vertices": mesh.n_vertices if mesh is not None else 0,
            "irregular": mesh.irregular_count if mesh is not None else 0,
            "inverted": len(self.inverted),
            "cursor": history.cursor,
            "length": len(history),
            "can_undo": document.can_undo,
            "can_redo": document.can_redo,
            "name": document.name,
            "kind": document.kind,
            "auto_smooth": document.auto_smooth,
            "at_optimum": document.at_optimum,
            "blocks": _blocks(mesh),
            "row": self._row(),
            "track": {
                "from": first,
                "scores": self._series.scores[first:].tolist(),
                "optima": self._series.optima[first:].tolist(),
                "titles": [
                    history[state - 1].title if state else "Start"
                    for state in range(first, len(history) + 1)
                ],
                "by": [
                    history[state - 1].by if state else ""
                    for state in range(first, len(history) + 1)
                ],
            },
        }

    def _row(self) -> dict[str, Any] | None:
        row = self._document.history.last
        if row is None:
            return None
        return {
            "number": self._document.history.cursor,
            "title": row.title,
            "by": row.by,
            "change": row.change,
            "halfedge": row.halfedge,
            "operation": row.action,
        }


def _element_slots(mesh: HalfEdgeMesh) -> int:
    return int(mesh.arrays.counters[ELEMENT_SLOTS])


def _blocks(mesh: HalfEdgeMesh | None) -> int | None:
    if mesh is None or mesh.k != 4 or mesh.n_elements > BLOCKS_UP_TO:
        return None
    # imported late: it imports scipy.sparse
    from meshwright_core.analysis.blocks import block_count

    return block_count(mesh)
