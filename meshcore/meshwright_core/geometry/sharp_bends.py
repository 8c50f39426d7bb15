"""Kinks of sides: where a boundary vertex of a single element can be without being flat."""

from __future__ import annotations

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.core.composite_curves import curve_length, place_in_span
from meshwright_core.geometry.movable_part import MovablePart
from meshwright_core.geometry.quality import TOLERANCE


@kernel
def _turns_to_left(curves, spans, previous, normal):
    """(n,) sines of the angles by which curves turn from spans `previous` to spans (n,)."""
    found, point, come, go = np.zeros(len(spans)), np.zeros(3), np.zeros(3), np.zeros(3)
    for i in range(len(spans)):
        place_in_span(curves, previous[i], 1.0, point, come)
        place_in_span(curves, spans[i], 0.0, point, go)
        length = np.sqrt(np.dot(come, come) * np.dot(go, go))
        across = 0.0
        for c in range(3):
            d, e = (c + 1) % 3, (c + 2) % 3
            across += normal[c] * (come[d] * go[e] - come[e] * go[d])
        found[i] = across / length if length > 0.0 else 0.0
    return found


def bends_between(part: MovablePart, curve: int, low: float, high: float) -> np.ndarray:
    """(b,) parameters between low and high at which a boundary curve turns to the outside, that is
    to the left; of interfaces those at which it turns to either side.
    """
    assert part.frame is not None
    curves = part.curves
    first, last = int(curves.first_span[curve]), int(curves.first_span[curve + 1])
    kinks = np.flatnonzero(part.turning.joint[first:last] > TOLERANCE) + first
    length = float(curve_length(curves, curve))
    starts = curves.start[kinks]
    rounds = [-length, 0.0, length] if curves.closed[curve] else [0.0]
    inside = [kinks[(starts + x > low) & (starts + x < high)] for x in rounds]
    shifted = [curves.start[rows] + x for rows, x in zip(inside, rounds, strict=True)]
    places = np.concatenate(shifted)
    spans = np.concatenate(inside)
    if not len(spans):
        return places
    previous = np.where(spans > first, spans - 1, last - 1)
    left = _turns_to_left(curves, spans, previous, np.ascontiguousarray(part.frame[2]))
    if not part.is_loop[curve]:
        left = np.abs(left)
    found: np.ndarray = np.sort(places[left > TOLERANCE])
    return found
