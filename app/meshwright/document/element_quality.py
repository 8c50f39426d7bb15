"""Measures of every element of a mesh, measured again only where the mesh has changed.

The window and the notebook share it: after an edit of a large mesh a few elements are measured, and
the comparison with the state before takes milliseconds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import ELEMENT_SLOTS, ORIGIN
from meshwright_core.geometry.edge_curves import bent_edges
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.planes import plane_normal
from meshwright_core.geometry.quality import TOLERANCE, Measure

CHUNK = 1 << 12
"""Elements measured at a time; the work can be cancelled in between."""


@dataclass
class _State:
    """The mesh that the values belong to."""

    curves: object
    """Shared by all copies of a mesh."""
    points: np.ndarray
    parameter: np.ndarray
    corners: np.ndarray
    normal: np.ndarray


class ElementQuality:
    """Per element slot (a row is the id of an element) the scaled Jacobian, the smallest angle in
    degrees and the shape; nan where there is no element.

    After :meth:`follow` they are those of the mesh that was passed.
    """

    def __init__(self) -> None:
        self.jacobian = np.zeros(0)
        self.angle = np.zeros(0)
        self.shape = np.zeros(0)
        self.measured = 0
        """Elements that the last :meth:`follow` has measured."""
        self._state: _State | None = None

    @property
    def ids(self) -> np.ndarray:
        """(m,) ids of the elements, ascending."""
        return np.flatnonzero(~np.isnan(self.jacobian))

    @property
    def inverted(self) -> np.ndarray:
        """Ids of the inverted elements, ascending."""
        found: np.ndarray = np.flatnonzero(self.jacobian <= TOLERANCE)
        return found

    @staticmethod
    def curved(mesh: HalfEdgeMesh) -> np.ndarray:
        """Ids, ascending, of the elements of ``mesh`` with a side that is not straight."""
        found: np.ndarray = np.unique(bent_edges(mesh)[0] // mesh.k)
        return found

    def follow(self, mesh: HalfEdgeMesh, cancelled: Callable[[], bool] = lambda: False) -> bool:
        """Measure what differs from the mesh of the last call; False, and nothing changed, once
        ``cancelled()``.
        """
        slots = int(mesh.arrays.counters[ELEMENT_SLOTS])
        corners = mesh.arrays.edge[: slots * mesh.k, ORIGIN].reshape(slots, mesh.k)
        points = mesh.points
        parameter = mesh.arrays.parameter[: len(points)]
        before = self._state
        ids, normal = mesh.element_ids(), None
        if before is not None and before.curves is mesh.arrays.curves:
            changed = self._changed(before, points, parameter, corners)
            if changed is not None:
                ids, normal = changed, before.normal
        values = np.full((3, slots), np.nan)
        if normal is None:
            normal = plane_normal(mesh)
        else:
            kept = min(slots, len(self.jacobian))
            values[:, :kept] = [row[:kept] for row in (self.jacobian, self.angle, self.shape)]
            values[:, corners[:, 0] < 0] = np.nan
        if not self._measure(mesh, ids, normal, values, cancelled):
            return False
        self.jacobian, self.angle, self.shape = values
        self.measured, self._state = len(ids), None
        if normal is not None:  # on other surfaces the normals of neighbours matter, too
            self._state = _State(
                mesh.arrays.curves, points.copy(), parameter.copy(), corners.copy(), normal
            )
        return True

    def forget(self) -> None:
        """Measure everything at the next call."""
        self._state = None

    def _changed(
        self, before: _State, points: np.ndarray, parameter: np.ndarray, corners: np.ndarray
    ) -> np.ndarray | None:
        """Ids of the elements that differ; None where all may."""
        if corners.shape[1] != before.corners.shape[1]:
            return None
        shared = min(len(points), len(before.points))
        moved = np.ones(len(points), bool)
        moved[:shared] = (points[:shared] != before.points[:shared]).any(axis=1)
        moved[:shared] |= parameter[:shared] != before.parameter[:shared]
        look = moved[corners].any(axis=1)
        shared = min(len(corners), len(before.corners))
        look[:shared] |= (corners[:shared] != before.corners[:shared]).any(axis=1)
        look[shared:] = True
        if moved.any() and (before.normal[:2].any() or points[moved, 2].any()):
            return None  # perhaps out of its plane
        found: np.ndarray = np.flatnonzero(look & (corners[:, 0] >= 0))
        return found

    def _measure(
        self,
        mesh: HalfEdgeMesh,
        ids: np.ndarray,
        normal: np.ndarray | None,
        values: np.ndarray,
        cancelled: Callable[[], bool],
    ) -> bool:
        jacobian, angle, shape = values
        whole = len(ids) == mesh.n_elements
        measure = Measure(mesh, None if whole else ids, normal)
        ideal = 1.0 if mesh.k == 4 else np.sqrt(0.75)
        for first in range(0, len(ids), CHUNK):
            if cancelled():
                return False
            corners = measure.of(slice(first, first + CHUNK))
            part = ids[first : first + CHUNK]
            jacobian[part] = corners.sine.min(axis=1) / ideal
            angle[part] = np.degrees(corners.angle).min(axis=1)
        if cancelled():
            return False
        shape[mesh.element_ids()] = element_shapes(mesh)  # quick enough to be done for all
        return True
