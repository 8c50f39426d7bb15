"""Quality of element shapes: corner angles, scaled Jacobians, inverted elements.

The sign of a corner is relative to a reference normal of its element. In a plane that is the normal
of the plane, to the side from which the outline turns counter-clockwise. On other surfaces it is
the mean of the vertex normals at the element's corners, a vertex normal being the sum of the vector
areas of the elements around: there an element is inverted when it turns against its neighbourhood,
and a quad also when it is not convex seen along its own normal.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry.outline import Outline

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

TOLERANCE = 1e-9
"""Sine of a corner's angle up to which the corner counts as flat."""


def unit(vectors: np.ndarray) -> np.ndarray:
    """`vectors` (..., 3) divided by their lengths; zero stays zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(lengths > 0.0, lengths, 1.0)


def vector_areas(points: np.ndarray, elements: np.ndarray) -> np.ndarray:
    """(m, 3) vector areas of elements (m, k): normal to the element, as long as its area."""
    p = points[elements]
    p = p - p[:, :1]
    return 0.5 * np.cross(p, np.roll(p, -1, axis=1)).sum(axis=1)


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


def corner_sines(points: np.ndarray, elements: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """(m, k) sine of the angle at each corner, negative where it turns clockwise.

    A corner with a side of no length has 0.
    """
    p = points[elements]
    forward = np.roll(p, -1, axis=1) - p
    backward = np.roll(p, 1, axis=1) - p
    area = np.einsum("ikj,ij->ik", np.cross(forward, backward), reference)
    lengths = np.linalg.norm(forward, axis=2) * np.linalg.norm(backward, axis=2)
    return area / np.where(lengths > 0.0, lengths, np.inf)


def _measured(mesh: HalfEdgeMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points, elements and reference normals of a mesh."""
    elements = mesh.elements()
    used = mesh.points if len(mesh.points) == mesh.n_vertices else mesh.points[mesh.vertices()]
    normal = Outline.of(mesh).normal(used)
    return mesh.points, elements, reference_normals(mesh.points, elements, normal)


def inverted(mesh: HalfEdgeMesh, tolerance: float = TOLERANCE) -> np.ndarray:
    """Ids, ascending, of the elements with a corner that is flat or turns the wrong way.

    A triangle is valid if it is positively oriented, a quad only if it is strictly convex; so a
    flat corner, as doublets have it, counts. `tolerance` is the sine up to which a corner is flat.
    """
    points, elements, reference = _measured(mesh)
    bad = corner_sines(points, elements, reference).min(axis=1) <= tolerance
    return np.sort(mesh.element_ids()[bad])


def scaled_jacobian(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) smallest sine of a corner of each element, in the order of `mesh.elements()`.

    1 for a rectangle and for an equilateral triangle (there divided by sin 60 degrees), 0 or less
    for inverted elements.
    """
    points, elements, reference = _measured(mesh)
    ideal = 1.0 if mesh.k == 4 else np.sqrt(0.75)
    return corner_sines(points, elements, reference).min(axis=1) / ideal


def angles(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m, k) corner angles in degrees, from 0 to 360; reflex corners have more than 180."""
    points, elements, reference = _measured(mesh)
    p = points[elements]
    forward = np.roll(p, -1, axis=1) - p
    backward = np.roll(p, 1, axis=1) - p
    sine = np.einsum("ikj,ij->ik", np.cross(forward, backward), reference)
    cosine = np.einsum("ikj,ikj->ik", forward, backward)
    return np.mod(np.degrees(np.arctan2(sine, cosine)), 360.0)


def min_angle(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) smallest corner angle of each element, degrees."""
    return angles(mesh).min(axis=1)


def max_angle(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) largest corner angle of each element, degrees."""
    return angles(mesh).max(axis=1)
