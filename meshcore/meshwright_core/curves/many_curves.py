"""Evaluates many curves in one call: drawings hold thousands of circles."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.composite_curves import Curves, place_all, tangents
from meshwright_core.curves.curve import Curve

Array = NDArray[np.float64]


def flattened(curves: Sequence[Curve]) -> Curves:
    """Curves as arrays for compiled kernels, in their order."""
    spans = [span for curve in curves for span in curve.spans]
    stops = [curve.stops for curve in curves]
    return Curves(
        control=np.concatenate(spans),
        first_control=np.cumsum([0, *map(len, spans)]),
        start=np.concatenate([stop[:-1] for stop in stops]),
        stop=np.concatenate([stop[1:] for stop in stops]),
        first_span=np.cumsum([0, *(len(curve.spans) for curve in curves)]),
        closed=np.array([curve.closed for curve in curves], np.bool_),
    )


def points_at(curves: Sequence[Curve], parameters: Sequence[Array]) -> list[Array]:
    """Points (n, 2) of each curve at its parameters (n,): as :meth:`.Curve.point`, to the bit."""
    if not len(curves):
        return []
    counts = [len(t) for t in parameters]
    which = np.repeat(np.arange(len(curves)), counts)
    places = place_all(flattened(curves), which, np.concatenate(parameters))[:, :2]
    return [places[low:high] for low, high in pairwise(np.cumsum([0, *counts]).tolist())]


def end_tangents(curves: Sequence[Curve]) -> Array:
    """(n, 2, 2) unit tangents of n curves at start and end; not finite where control points meet
    there.
    """
    if not len(curves):
        return np.zeros((0, 2, 2))
    t = np.array([(0.0, curve.length) for curve in curves])
    which = np.repeat(np.arange(len(curves)), 2)
    way = tangents(flattened(curves), which, t.ravel())[:, :2]
    with np.errstate(invalid="ignore"):
        unit: Array = way / np.linalg.norm(way, axis=1, keepdims=True)
    return unit.reshape(-1, 2, 2)
