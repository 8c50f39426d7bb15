"""Finds the half-edge, element or vertex of a mesh at a point of the plane."""

import numpy as np

from meshwright.graphics.true_edges import TrueEdges
from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.polygons import contains

_NEAR = (8, 32, 128)


class Picker:
    """A search tree over the element centres of one state of a mesh; make a new one after edits.

    The elements with the nearest centres are candidates, and a point-in-polygon test decides. If
    none contains the point more candidates are tried, since elements may differ much in size.
    ``edges`` are the true edges of the same state, for elements with curved sides: a point between
    a curve and its chord belongs to the element on its side of the curve.
    """

    def __init__(self, mesh: HalfEdgeMesh, edges: TrueEdges | None = None) -> None:
        from scipy.spatial import cKDTree  # imported at the first hover, as it takes time

        self._mesh = mesh
        self._edges = edges or None  # of no use if all are straight
        self._elements = mesh.elements()
        self._ids = mesh.element_ids()
        self._corners = mesh.points[:, :2][self._elements]  # (m, k, 2)
        centres = self._corners.mean(axis=1)
        self._tree = cKDTree(centres, balanced_tree=False, compact_nodes=False)

    def element_row(self, x: float, y: float) -> int:
        """Row of ``mesh.elements()`` that contains (x, y), -1 if none does."""
        count = len(self._ids)
        for near in _NEAR:
            if count == 0:
                break
            rows = np.atleast_1d(self._tree.query((x, y), k=min(near, count))[1])
            inside = contains(self._corners[rows], x, y)
            self._correct(inside, rows, x, y)
            if inside.any():
                return int(rows[np.argmax(inside)])
            if near >= count:
                break
        return -1

    def _correct(self, inside: np.ndarray, rows: np.ndarray, x: float, y: float) -> None:
        """Decide again for those of the candidates that have curved sides."""
        if self._edges is None:
            return
        for at in np.flatnonzero(np.isin(self._ids[rows], self._edges.elements)).tolist():
            outline = self._edges.outline(int(self._ids[rows[at]]))
            inside[at] = bool(contains(outline, x, y))

    def halfedge(self, x: float, y: float) -> int:
        """The half-edge of the element at (x, y) whose edge is nearest, -1 outside the mesh."""
        row = self.element_row(x, y)
        if row < 0:
            return -1
        element = int(self._ids[row])
        if self._edges is not None and element in self._edges.elements:
            sides = self._edges.sides(element)
            away = [float(_distances(line[:-1], line[1:], x, y).min()) for line in sides]
        else:
            start = self._corners[row]
            away = _distances(start, np.roll(start, -1, axis=0), x, y).tolist()
        return self._mesh.k * element + int(np.argmin(away))

    def vertex(self, x: float, y: float, reach: float) -> int:
        """The vertex nearest to (x, y) within ``reach`` units of length, -1 if none is."""
        count = len(self._ids)
        if count == 0:
            return -1
        rows = np.atleast_1d(self._tree.query((x, y), k=min(_NEAR[1], count))[1])
        corners = self._corners[rows].reshape(-1, 2)
        squared = ((corners - (x, y)) ** 2).sum(axis=1)
        nearest = int(np.argmin(squared))
        if squared[nearest] > reach * reach:
            return -1
        return int(self._elements[rows].reshape(-1)[nearest])


def _distances(start: np.ndarray, end: np.ndarray, x: float, y: float) -> np.ndarray:
    """Distances from (x, y) to the segments ``start``-``end``, both (k, 2)."""
    along = end - start
    length = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(((np.array((x, y)) - start) * along).sum(axis=1) / length, 0.0, 1.0)
    foot = start + share[:, None] * along
    return np.hypot(foot[:, 0] - x, foot[:, 1] - y)
