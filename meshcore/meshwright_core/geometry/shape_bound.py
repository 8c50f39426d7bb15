"""The bound q* on the worst scaled Jacobian, from the geometry alone.

At a corner of angle theta with desired degree d*, d* - 1 elements meet if it is regular. Their
angles there add up to theta, so the smallest sine among them is at most sin(theta / (d* - 1)), by
equal shares: q* is the least of these over all corners, 1 where there is none. For sides that bend
theta is the angle between their tangents at the corner. Where regions meet, each sector counts as a
corner with its own share of elements.

What it assumes: straight or smooth element edges at the corner, and every corner regular. At
s = s* = 0 every vertex is regular, so no mesh at the optimum exceeds q*. At s* > 0 a mesh at the
optimum has s* irregularities of one sign somewhere. Where one sits at a corner whose angle lies
between two shares it may even be better there than q*; where it sits elsewhere its own vertex sets
a limit (inside a quad mesh sin 72 degrees with one edge too many, sin 60 degrees with one too few).
:func:`attainable_bound` takes both into account.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.core.curve_corners import sectors
from meshwright_core.geometry.planes import plane_normal

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

_MOST = 8
"""Irregularities at one corner that are considered."""


def corner_angles(mesh: HalfEdgeMesh) -> np.ndarray:
    """(slots,) radians inside the domain at each geometric boundary vertex, between tangents.

    0 for all other vertices, and for meshes that do not lie in a plane z = const.
    """
    angles = np.zeros(mesh.slots)
    vertex, angle, _ = _sectors(mesh)
    np.add.at(angles, vertex, angle)
    angles[~mesh.boundary()] = 0.0
    return angles


def _sectors(mesh: HalfEdgeMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertex (n,), radians (n,) and, if it is regular, elements (n,) of each sector at a geometric
    vertex.
    """
    empty = np.zeros(0, np.int64), np.zeros(0), np.zeros(0, np.int64)
    normal = plane_normal(mesh)
    if normal is None or abs(normal[2]) < 1.0:
        return empty
    found = sectors(mesh.arrays)
    geometric = mesh.geometric()[found.vertex]
    vertex, angle = found.vertex[geometric], found.angle[geometric]
    boundary = found.boundary[geometric]
    count = np.bincount(vertex, minlength=mesh.slots)[vertex]
    alpha = 60.0 if mesh.k == 3 else 90.0
    shares = np.maximum(1, np.floor(angle / alpha + 0.5 + 1e-9).astype(np.int64))
    # the user may have set another desired degree
    own = mesh.desired()[vertex] - boundary
    return vertex, np.radians(angle), np.where(count == 1, own, shares).astype(np.int64)


def _share(angle: np.ndarray, elements: np.ndarray, k: int) -> np.ndarray:
    """Scaled Jacobian where so many elements (n,) share an angle (n,) equally; 0 if one folds."""
    part = angle / np.maximum(elements, 1)
    sine = np.where((elements >= 1) & (part < np.pi), np.sin(part), 0.0)
    found: np.ndarray = np.minimum(sine / (1.0 if k == 4 else np.sqrt(0.75)), 1.0)
    return found


def shape_bound(mesh: HalfEdgeMesh) -> float:
    """q*: the largest worst scaled Jacobian that the corners permit where they are regular.

    1 for meshes that do not lie in a plane z = const.
    """
    _, angle, elements = _sectors(mesh)
    return float(min(1.0, _share(angle, elements, mesh.k).min(initial=1.0)))


def attainable_bound(mesh: HalfEdgeMesh) -> float:
    """The largest worst scaled Jacobian of any mesh of this domain with s = s*.

    Equal to q* where s* = 0. Otherwise s* irregularities of the sign of sum Delta are distributed:
    a corner takes as many as it needs, and the others sit inside or on a side, at best at the limit
    of an interior vertex.
    """
    excess = int(mesh.irregularity().sum())
    _, angle, elements = _sectors(mesh)
    if excess == 0:
        return float(min(1.0, _share(angle, elements, mesh.k).min(initial=1.0)))
    sign, count = (1 if excess > 0 else -1), abs(excess)
    regular = 4 if mesh.k == 4 else 6
    inside = float(_share(np.array([2 * np.pi]), np.array([regular + sign]), mesh.k)[0])
    steps = np.arange(min(count, _MOST) + 1)
    shapes = np.stack([_share(angle, elements + sign * i, mesh.k) for i in steps], axis=1)
    levels = np.unique(np.append(shapes.ravel(), (inside, 1.0)))[::-1]
    for level in levels.tolist():
        fine = shapes >= level - 1e-12
        if not fine.any(axis=1).all():
            continue
        fewest = int(fine.argmax(axis=1).sum())
        most = int((len(steps) - 1 - fine[:, ::-1].argmax(axis=1)).sum())
        if fewest <= count and (level <= inside or most >= count):
            return float(level)
    return 0.0
