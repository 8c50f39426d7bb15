"""Quality of element shapes: corner angles, scaled Jacobians, inverted elements.

Straight elements are measured at their corners, which is exact. Those with sides that bend are
measured on a grid of samples of their Coons map (:mod:`meshwright_core.geometry.coons`).

The sign of a corner is relative to a reference normal of its element. In a plane that is the normal
of the plane, to the side from which the boundary turns counter-clockwise. On other surfaces it is
the mean of the vertex normals at the element's corners, a vertex normal being the sum of the vector
areas of the elements around: there an element is inverted when it turns against its neighbourhood,
and a quad also when it is not convex seen along its own normal; all sides count as straight.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.geometry.coons import curved_corners
from meshwright_core.geometry.curved_elements import curved_elements
from meshwright_core.geometry.planes import plane_normal, unit, vector_areas
from meshwright_core.geometry.vectors import determinant

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

TOLERANCE = 1e-9
"""Sine of a corner's angle up to which the corner counts as flat."""


def reference_normals(
    points: np.ndarray, elements: np.ndarray, normal: np.ndarray | None = None
) -> np.ndarray:
    """(m, 3) the unit vectors that the corners of each element are measured against.

    Args:
        points: (n, 3).
        elements: (m, k) rows of `points`.
        normal: (3,) unit normal of the plane of all elements, or None when there is none.
    """
    if normal is not None:
        return np.broadcast_to(normal, (len(elements), 3)).copy()
    own = vector_areas(points, elements)
    at_vertex = np.zeros((len(points), 3))
    for corner in range(elements.shape[1]):
        np.add.at(at_vertex, elements[:, corner], own)
    around = unit(at_vertex)[elements].sum(axis=1)
    facing = np.where(np.einsum("ij,ij->i", own, around) < 0.0, -1.0, 1.0)
    return unit(own * facing[:, None])


class Corners(NamedTuple):
    """What :func:`measure` finds."""

    sine: np.ndarray
    """(m, k) sine of the angle at each corner, negative where it turns clockwise; of curved
    elements the smallest at the samples nearest to the corner. 0 at a side of no length."""
    angle: np.ndarray
    """(m, k) radians from -pi to pi, negative where the corner is reflex or folded over; of curved
    elements between the tangents of their sides."""

    @property
    def inverted(self) -> np.ndarray:
        """(m,) bool: a corner is flat or turns the wrong way."""
        found: np.ndarray = self.sine.min(axis=1, initial=np.inf) <= TOLERANCE
        return found


def straight_corners(p: np.ndarray, reference: np.ndarray) -> Corners:
    """The corners of straight elements at p (m, k, 3), against a normal (3,) or (m, 3)."""
    forward = np.roll(p, -1, axis=1) - p
    backward = np.roll(p, 1, axis=1) - p
    if reference.ndim == 1 and not reference[:2].any():
        area = forward[..., 0] * backward[..., 1] - forward[..., 1] * backward[..., 0]
        area *= reference[2]
    else:
        across = np.cross(forward, backward)
        area = np.einsum("ikj,ij->ik", across, np.broadcast_to(reference, (len(p), 3)))
    along = np.einsum("ikj,ikj->ik", forward, backward)
    lengths = np.sqrt(np.einsum("ikj,ikj->ik", forward, forward))
    lengths = lengths * np.roll(lengths, 1, axis=1)
    lengths[lengths == 0.0] = np.inf
    return Corners(area / lengths, np.arctan2(area, along))


@kernel
def corner_sines(points, elements, reference):
    """(m, k) sine of the angle at each corner of straight elements, as in :class:`Corners`."""
    count, k = elements.shape
    sines = np.zeros((count, k))
    p, q = np.zeros(3), np.zeros(3)
    for e in range(count):
        for i in range(k):
            o, s, t = elements[e, i], elements[e, (i + 1) % k], elements[e, (i + k - 1) % k]
            pp = qq = 0.0
            for c in range(3):
                p[c], q[c] = points[s, c] - points[o, c], points[t, c] - points[o, c]
                pp += p[c] * p[c]
                qq += q[c] * q[c]
            lengths = np.sqrt(pp) * np.sqrt(qq)
            if lengths > 0.0:
                sines[e, i] = determinant(p, q, reference[e]) / lengths
    return sines


class Measure:
    """Measures elements of a mesh, also in parts.

    Args:
        mesh: the mesh; later edits of it are not seen.
        ids: (m,) elements to measure, ascending; None: all.
        normal: (3,) that of the mesh's plane, if the caller knows it.
    """

    def __init__(
        self,
        mesh: HalfEdgeMesh,
        ids: np.ndarray | None = None,
        normal: np.ndarray | None = None,
    ) -> None:
        self._points = mesh.points
        if ids is None:
            self.ids, self._elements = mesh.element_ids(), mesh.elements()
            halfedges = None
        else:
            self.ids, self._elements = ids, mesh.corners(ids)
            halfedges = mesh.halfedges_of(ids).ravel()
        found = plane_normal(mesh) if normal is None else normal
        self._reference = found
        self._curved = None
        if found is None:
            self._reference = reference_normals(self._points, self._elements)
            return
        curved = curved_elements(mesh, self.ids, self._elements, halfedges)
        if len(curved.element):
            self._curved = curved.element
            normals = reference_normals(self._points, self._elements, found)
            self._corners = curved_corners(curved, self._points, normals)

    def of(self, part: slice) -> Corners:
        """The corners of the elements `part`, a slice of them without a step."""
        assert self._reference is not None
        reference = self._reference if self._reference.ndim == 1 else self._reference[part]
        corners = straight_corners(self._points[self._elements[part]], reference)
        if self._curved is not None:
            start, stop, _ = part.indices(len(self.ids))
            first, last = np.searchsorted(self._curved, [start, stop])
            rows = self._curved[first:last] - start
            corners.sine[rows] = self._corners[0][first:last]
            corners.angle[rows] = self._corners[1][first:last]
        return corners

    def everything(self) -> Corners:
        """The corners of all elements."""
        return self.of(slice(0, len(self.ids)))


def inverted(mesh: HalfEdgeMesh, ids: np.ndarray | None = None) -> np.ndarray:
    """Ids, ascending, of the elements with a corner that is flat or turns the wrong way.

    A triangle is valid if it is positively oriented, a quad only if it is strictly convex, so a
    flat corner, as doublets have it, counts. With curved sides the Jacobian of the element's Coons
    map must be positive at all samples (:mod:`meshwright_core.geometry.coons`).

    ids: (m,), ascending, those to test; None: all.
    """
    measure = Measure(mesh, ids)
    found: np.ndarray = measure.ids[measure.everything().inverted]
    return found


def scaled_jacobian(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) smallest sine of a corner of each element, in the order of `mesh.elements()`; with
    curved sides the smallest over the samples.

    1 for a rectangle and for an equilateral triangle (there divided by sin 60 degrees), 0 or less
    for inverted elements.
    """
    ideal = 1.0 if mesh.k == 4 else np.sqrt(0.75)
    smallest: np.ndarray = Measure(mesh).everything().sine.min(axis=1) / ideal
    return smallest


def angles(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m, k) corner angles in degrees, from 0 to 360; reflex corners have more than 180. With
    curved sides those between their tangents.
    """
    return np.mod(np.degrees(Measure(mesh).everything().angle), 360.0)


def min_angle(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) smallest corner angle of each element, degrees."""
    return angles(mesh).min(axis=1)


def max_angle(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) largest corner angle of each element, degrees."""
    return angles(mesh).max(axis=1)
