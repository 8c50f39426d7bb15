"""The document's numbers for the browser: scores, counts, position in the history, its curve."""

from __future__ import annotations

from typing import Any

import numpy as np

from meshwright.document.document import Document
from meshwright.document.element_quality import ElementQuality
from meshwright.document.quality_summary import decimal, shape_words
from meshwright.document.score_series import ScoreSeries
from meshwright.document.verdict import findings
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.side_names import side_edges
from meshwright_core.geometry.edge_curves import ends_of
from meshwright_core.geometry.shape_bound import shape_bound

BLOCKS_UP_TO = 20_000
"""Number of elements above which the blocks of a quad mesh are not counted after every step."""
MOST_CURVED = 2000
"""The browser measures straight elements itself; values of at most so many curved ones are sent."""


class DocumentStatus:
    """The numbers of one document that are sent with every state and patch, as ``head``."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._series = ScoreSeries()
        self._quality = ElementQuality()
        self._bound: tuple[object, float] = None, 1.0  # what it depends on, and q*

    def reset(self) -> None:
        """The document has another mesh."""
        self._quality = ElementQuality()

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
            **self._measures(mesh),
            "cursor": history.cursor,
            "length": len(history),
            "can_undo": document.can_undo,
            "can_redo": document.can_redo,
            "name": document.name,
            "kind": document.kind,
            "auto_smooth": document.auto_smooth,
            "at_optimum": document.at_optimum,
            "blocks": _blocks(mesh),
            "sides": _sides(mesh),
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

    def _measures(self, mesh: HalfEdgeMesh | None) -> dict[str, Any]:
        """Inverted elements, worst elements and the bound on shape."""
        if mesh is None:
            return {
                "inverted": 0, "inverted_curved": [], "shape": None, "findings": [], "curved": [],
            }  # fmt: skip
        quality = self._quality
        quality.follow(mesh)
        inverted, curved = quality.inverted, quality.curved(mesh)
        rows = curved if len(curved) <= MOST_CURVED else curved[:0]
        values = np.column_stack([rows, quality.jacobian[rows], quality.shape[rows]])
        return {
            "inverted": len(inverted),
            "inverted_curved": np.intersect1d(inverted, curved).tolist(),
            **self._shape(mesh),
            "curved": [[int(e), *pair] for e, *pair in values.round(3).tolist()],
        }

    def _shape(self, mesh: HalfEdgeMesh) -> dict[str, Any]:
        """Worst elements by both measures, the bound q*, and what is in order."""
        quality, ids = self._quality, self._quality.ids
        if not len(ids):
            return {"shape": None, "findings": []}
        worst = int(ids[np.argmin(quality.jacobian[ids])])
        flattest = int(ids[np.argmin(quality.shape[ids])])
        lowest, bound = float(quality.jacobian[worst]), self._shape_bound(mesh)
        thinnest = float(quality.shape[flattest])
        said = findings(mesh, lowest, thinnest, bound, len(quality.inverted))
        return {
            "shape": {
                "words": shape_words(lowest, bound),
                "flattest": decimal(thinnest),
                "worst_scaled_jacobian": round(lowest, 4),
                "shape_bound": round(bound, 4),
                "worst_shape": round(thinnest, 4),
                "elements": [worst, flattest],
            },
            "findings": [[one.text, one.in_order] for one in said],
        }

    def _shape_bound(self, mesh: HalfEdgeMesh) -> float:
        """q*, computed again only after corners or their desired degrees have changed."""
        corners = np.flatnonzero(mesh.geometric() & (mesh.degree() > 0))
        key = (corners.tobytes(), mesh.desired()[corners].tobytes(), mesh.points[corners].tobytes())
        if key != self._bound[0]:
            self._bound = key, shape_bound(mesh)
        return self._bound[1]

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


def _sides(mesh: HalfEdgeMesh | None) -> list[list[Any]]:
    """Name and half-edges of each named side, in the order in which the window colours them."""
    if mesh is None:
        return []
    named = {name: ends for name, ends in mesh.sides().items() if name}
    if not named:
        return []
    halfedges = side_edges(mesh.arrays).halfedges
    ends = ends_of(mesh, halfedges)
    of = dict(zip(map(tuple, ends.tolist()), halfedges.tolist(), strict=True))
    return [[name, [of[a, b] for a, b in edges.tolist()]] for name, edges in sorted(named.items())]


def _blocks(mesh: HalfEdgeMesh | None) -> int | None:
    if mesh is None or mesh.k != 4 or mesh.n_elements > BLOCKS_UP_TO:
        return None
    # imported late: it imports scipy.sparse
    from meshwright_core.analysis.blocks import block_count

    return block_count(mesh)
