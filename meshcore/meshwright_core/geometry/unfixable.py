"""Unfixable elements: those that stay inverted for all positions of the movable vertices.

A single quad at a reflex corner of the outline, a boundary vertex of one element on a straight
side, a doublet: there a corner stays flat or folded wherever the movable vertices go.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry import movable_part
from meshwright_core.geometry.quality import TOLERANCE
from meshwright_core.geometry.movable_part import Region

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

PLACES = 20000
"""Combinations of points on sides beyond which a corner is not searched."""


def unfixable(mesh: HalfEdgeMesh) -> np.ndarray:
    """Ids, ascending, of the elements of `mesh` that are known to be unfixable."""
    region = movable_part.whole(mesh)
    return np.sort(region.element_ids[unfixable_corners(region).any(axis=1)])


def fixable(region: Region) -> np.ndarray:
    """(m,) bool: the inverted elements of the region that are not known to be unfixable."""
    bad = region.inverted_rows()
    if bad.any():
        bad &= ~unfixable_corners(region).any(axis=1)
    return bad


def unfixable_corners(region: Region) -> np.ndarray:
    """(m, k) bool: corners that stay folded wherever the movable vertices go.

    These are corners of doublets, and corners none of whose three vertices is free. There the
    determinant is affine in each of the three on each straight piece of its side, so that its
    maximum is taken at ends of pieces, in the order that the vertices have on a side. Of surfaces
    that are not plane none is known.
    """
    elements = region.elements
    k = elements.shape[1]
    found = np.zeros(elements.shape, bool)
    if region.frame is None:
        return found
    uses = np.bincount(elements.ravel(), minlength=len(region.vertices))
    if k == 4:
        found |= (region.free & (uses == 2))[elements]
    flat = region.points @ region.frame[:2].T
    bends = region.sides.points @ region.frame[:2].T
    tolerance = TOLERANCE * max(float(np.ptp(flat, axis=0).max()), 1e-300) ** 2
    bound = ~region.free[elements]
    bound &= np.roll(bound, 1, axis=1) & np.roll(bound, -1, axis=1)
    if k == 3:
        bound[:, 1:] = False
    rows, places = np.nonzero(bound)
    corners = np.stack([elements[rows, (places + turn) % k] for turn in (0, 1, k - 1)], axis=1)
    fixed = (region.seats.side[corners] < 0).all(axis=1)
    o, s, t = (flat[corners[:, i]] for i in range(3))
    found[rows, places] = fixed & (cross(s - o, t - o) <= tolerance)
    bulging = _bulging(region, bends)
    for at in np.flatnonzero(~fixed).tolist():
        turn = _largest_turn(region, corners[at], flat, bends, bulging)
        found[rows[at], places[at]] = turn <= tolerance
    return found


def _largest_turn(
    region: Region, corner: np.ndarray, flat: np.ndarray, bends: np.ndarray, bulging: np.ndarray
) -> float:
    """The largest determinant at a corner (vertex, next, previous), none of them free."""
    seats, sides = region.seats, region.sides
    own = seats.side[corner]
    if (own == own[0]).all() and not bulging[own[0]]:
        return -np.inf
    counts = np.where(own < 0, 1, sides.first[own + 1] - sides.first[own])
    if counts.prod() > PLACES:
        return np.inf
    places, arcs = [], []
    for i, v in enumerate(corner.tolist()):
        shape = [1, 1, 1]
        shape[i] = int(counts[i])
        rows = slice(sides.first[own[i]], sides.first[own[i] + 1])
        places.append((flat[v] if own[i] < 0 else bends[rows]).reshape(*shape, 2))
        arcs.append((np.zeros(1) if own[i] < 0 else sides.arc[rows]).reshape(shape))
    turns = cross(places[1] - places[0], places[2] - places[0])
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if own[i] >= 0 and own[i] == own[j] and not sides.closed[own[i]]:
            ahead = seats.parameter[corner[i]] - seats.parameter[corner[j]]
            turns = np.where((arcs[i] - arcs[j]) * ahead >= 0.0, turns, -np.inf)
    return float(turns.max())


def _bulging(region: Region, bends: np.ndarray) -> np.ndarray:
    """(s,) bool: sides that turn outwards somewhere, or wind around more than once.

    On the others any three vertices in order are flat or turn the wrong way.
    """
    first, closed = region.sides.first, region.sides.closed
    found = np.zeros(len(closed), bool)
    for side in range(len(found)):
        angles = turns(bends[first[side] : first[side + 1]], bool(closed[side]))
        found[side] = bool((angles > TOLERANCE).any()) or angles.sum() < -2.0 * np.pi - 1e-6
    return found


def turns(points: np.ndarray, closed: bool) -> np.ndarray:
    """Angles, positive outwards, by which a side turns at its points but the first."""
    steps = np.diff(points, axis=0)
    ahead = np.roll(steps, -1, axis=0) if closed else steps[1:]
    steps = steps[: len(ahead)]
    angles: np.ndarray = np.arctan2(cross(steps, ahead), (steps * ahead).sum(axis=1))
    return angles


def cross(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """(...,) determinants of plane vectors (..., 2)."""
    return p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]
