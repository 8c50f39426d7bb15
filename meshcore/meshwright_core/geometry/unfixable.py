"""Unfixable elements: those that stay inverted for all positions of the movable vertices.

A single quad at a reflex corner of the domain, a boundary vertex of one element on a straight or
smooth side, a doublet: there a corner stays flat or folded wherever the movable vertices go.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry import movable_part
from meshwright_core.geometry.coons import at_corners
from meshwright_core.geometry.movable_part import MovablePart
from meshwright_core.geometry.quality import TOLERANCE
from meshwright_core.geometry.turning import BENDS, turnings

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


def unfixable(mesh: HalfEdgeMesh) -> np.ndarray:
    """Ids, ascending, of the elements of `mesh` that are known to be unfixable."""
    part = movable_part.whole(mesh)
    return np.sort(part.element_ids[unfixable_corners(part).any(axis=1)])


def fixable(part: MovablePart) -> np.ndarray:
    """(m,) bool: the inverted elements of the part that are not known to be unfixable."""
    bad = part.inverted_rows()
    if bad.any():
        bad &= ~unfixable_corners(part).any(axis=1)
    return bad


def unfixable_corners(part: MovablePart) -> np.ndarray:
    """(m, k) bool: corners that stay folded wherever the movable vertices go.

    These are corners of doublets, and corners none of whose three vertices is free, in two cases.
    Where both sides are straight whatever slides, the determinant is affine in the place of each of
    the three, so that its maximum is taken at ends of what they can reach, in the order that the
    vertices have on a side. Where both sides run along curves, it is that of their tangents: known
    at a vertex that stays, and flat at one that slides, unless it can reach a kink to the outside.
    Of surfaces that are not plane none is known.
    """
    elements = part.elements
    k = elements.shape[1]
    found = np.zeros(elements.shape, bool)
    if part.frame is None:
        return found
    uses = np.bincount(elements.ravel(), minlength=len(part.vertices))
    if k == 4:
        found |= (part.free & (uses == 2))[elements]
    bound = ~part.free[elements]
    bound &= np.roll(bound, 1, axis=1) & np.roll(bound, -1, axis=1)
    sides = np.zeros(elements.shape, bool)
    sides[part.curved.element] = part.curved.sides >= 0
    both = sides & np.roll(sides, 1, axis=1)
    found |= _straight(part, bound & ~sides & ~np.roll(sides, 1, axis=1))
    found |= _along_curves(part, both)
    return found


def _straight(part: MovablePart, asked: np.ndarray) -> np.ndarray:
    """(m, k) bool: the folded ones of the corners `asked`, whose sides are straight."""
    assert part.frame is not None
    elements, seats = part.elements, part.seats
    k = elements.shape[1]
    found = np.zeros(elements.shape, bool)
    if k == 3:
        # the corners of a straight triangle all have one determinant
        asked = asked.all(axis=1)[:, None] & (np.arange(3) == 0)
    rows, places = np.nonzero(asked)
    if not len(rows):
        return found
    # where each vertex may be: at two ends of its reach, or where it stays
    low = part.points.copy()
    high = low.copy()
    slides = np.flatnonzero(seats.curve >= 0)
    known = np.ones(len(low), bool)
    for end, there in ((0, low), (1, high)):
        there[slides] = part.placed(slides, seats.reach[slides, end])
    spans = seats.reach[slides]
    known[slides] = turnings(part.curves, part.turning, seats.curve[slides], spans) <= BENDS
    ends = np.stack([low, high], axis=1) @ part.frame[:2].T
    corners = np.stack([elements[rows, (places + turn) % k] for turn in (0, 1, k - 1)], axis=1)
    tolerance = TOLERANCE * max(float(np.ptp(part.points, axis=0).max()), 1e-300) ** 2
    largest = np.full(len(rows), -np.inf)
    for choice in np.ndindex(2, 2, 2):
        o, s, t = (ends[corners[:, i], choice[i]] for i in range(3))
        possible = np.ones(len(rows), bool)
        for i, j in ((0, 1), (0, 2), (1, 2)):
            a, b = corners[:, i], corners[:, j]
            same = (seats.curve[a] >= 0) & (seats.curve[a] == seats.curve[b])
            same &= (seats.reach[a] == seats.reach[b]).all(axis=1)
            ahead = seats.parameter[a] - seats.parameter[b]
            possible &= ~same | ((choice[i] - choice[j]) * ahead >= 0.0)
        largest = np.where(possible, np.maximum(largest, cross(s - o, t - o)), largest)
    found[rows, places] = (largest <= tolerance) & known[corners].all(axis=1)
    return found


def _along_curves(part: MovablePart, asked: np.ndarray) -> np.ndarray:
    """(m, k) bool: the folded ones of the corners `asked`, both of whose sides lie on curves."""
    assert part.frame is not None
    found = np.zeros(asked.shape, bool)
    rows, places = np.nonzero(asked)
    if not len(rows):
        return found
    vertices = part.elements[rows, places]
    slides = part.seats.curve[vertices] >= 0
    sines = np.zeros(asked.shape)
    sines[part.curved.element] = at_corners(part.curved, part.points, part.frame[2])
    found[rows, places] = ~slides & (sines[rows, places] <= TOLERANCE)
    for i in np.flatnonzero(slides).tolist():
        v = int(vertices[i])
        curve, (low, high) = int(part.seats.curve[v]), part.seats.reach[v]
        outwards = part.bends(curve, float(low), float(high))
        found[rows[i], places[i]] = not len(outwards)
    return found


def cross(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """(...,) determinants of plane vectors (..., 2)."""
    return p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]
