"""Kinks of sides: where a boundary vertex of a single element can be without being flat."""

from __future__ import annotations

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.core.composite_curves import Curves, curve_length, place_in_span
from meshwright_core.geometry.turning import Turning
from meshwright_core.geometry.vectors import inner

SHARP = 1e-9
"""Radians of turning at a joint above which it is a kink."""


@kernel
def _turns_to_left(curves, spans, previous, normal):
    """(n,) sines of the angles by which curves turn from spans `previous` to spans (n,)."""
    found, point, come, go = np.zeros(len(spans)), np.zeros(3), np.zeros(3), np.zeros(3)
    for i in range(len(spans)):
        place_in_span(curves, previous[i], 1.0, point, come)
        place_in_span(curves, spans[i], 0.0, point, go)
        length = np.sqrt(inner(come, come) * inner(go, go))
        across = 0.0
        for c in range(3):
            d, e = (c + 1) % 3, (c + 2) % 3
            across += normal[c] * (come[d] * go[e] - come[e] * go[d])
        found[i] = across / length if length > 0.0 else 0.0
    return found


def kinks_between(
    curves: Curves,
    turning: Turning,
    normal: np.ndarray,
    curve: int,
    low: float,
    high: float,
    both: bool = False,
) -> np.ndarray:
    """(b,) parameters, ascending, between low and high at which a curve has a kink to the left:
    on a boundary loop to the outside.

    Args:
        curves: the curves.
        turning: of these.
        normal: (3,) of the plane.
        curve: which of them.
        low: parameter, on a closed curve up to one round below 0.
        high: parameter, likewise up to one round above the length.
        both: kinks to either side, as on an interface.
    """
    first, last = int(curves.first_span[curve]), int(curves.first_span[curve + 1])
    kinks = np.flatnonzero(turning.joint[first:last] > SHARP) + first
    length = float(curve_length(curves, curve))
    starts = curves.start[kinks]
    rounds = [-length, 0.0, length] if curves.closed[curve] else [0.0]
    inside = [kinks[(starts + x > low) & (starts + x < high)] for x in rounds]
    shifted = [curves.start[rows] + x for rows, x in zip(inside, rounds, strict=True)]
    places, spans = np.concatenate(shifted), np.concatenate(inside)
    if not len(spans):
        return places
    if not both:
        previous = np.where(spans > first, spans - 1, last - 1)
        left = _turns_to_left(curves, spans, previous, np.ascontiguousarray(normal))
        places = places[left > SHARP]
    found: np.ndarray = np.sort(places)
    return found
