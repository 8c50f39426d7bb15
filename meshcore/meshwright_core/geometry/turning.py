"""How much curves turn: where an edge along a curve really bends, and by what angle in all.

Most edges on the boundary of a mesh are straight, and are treated as such. Which are is looked up
in sums that are computed once for the curves of a mesh.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.composite_curves import Curves, curve_length, place_in_span, span_at
from meshwright_core.core.references import by_reference

if TYPE_CHECKING:
    from meshwright_core.core.mesh_boundary import MeshBoundary
    from meshwright_core.mesh import HalfEdgeMesh

BENDS = 1e-7
"""Radians of turning above which an edge counts as bent."""
NEAR = 1e-11
"""Distance of parameters, relative to a curve's length, below which they are the same."""
_PIECES = 16
"""Pieces of a span between whose tangents its turning is measured."""


@by_reference
class Turning(NamedTuple):
    """Absolute turning of curves, in radians; s spans, n curves."""

    before: np.ndarray
    """(s,) from the start of the curve up to the start of each span, the joint there included; the
    joint at the start of a closed curve is left out."""
    inside: np.ndarray
    """(s,) within each span."""
    joint: np.ndarray
    """(s,) at the joint where each span begins; 0 at the start of an open curve."""


@kernel
def _turning_inside(curves, inside, joint):
    """Fill the turning within spans and at joints (s,)."""
    point, last, slope = np.zeros(3), np.zeros(3), np.zeros(3)
    for curve in range(len(curves.closed)):
        first, end = curves.first_span[curve], curves.first_span[curve + 1]
        known = curves.closed[curve]
        if known:
            place_in_span(curves, end - 1, 1.0, point, last)
        for span in range(first, end):
            place_in_span(curves, span, 0.0, point, slope)
            joint[span] = angle_between(last, slope) if known else 0.0
            known = True
            degree = curves.first_control[span + 1] - curves.first_control[span] - 1
            pieces = _PIECES if degree > 1 else 1
            for i in range(1, pieces + 1):
                for c in range(3):
                    last[c] = slope[c]
                place_in_span(curves, span, i / pieces, point, slope)
                inside[span] += angle_between(last, slope)
            for c in range(3):
                last[c] = slope[c]


@bare_kernel
def angle_between(p, q):
    """The angle between two vectors (3,), from 0 to pi; 0 if one of them is zero."""
    x = p[1] * q[2] - p[2] * q[1]
    y = p[2] * q[0] - p[0] * q[2]
    z = p[0] * q[1] - p[1] * q[0]
    return np.arctan2(np.sqrt(x * x + y * y + z * z), p[0] * q[0] + p[1] * q[1] + p[2] * q[2])


@bare_kernel
def span_towards(curves, curve, t, other):
    """The span at t of a curve, at a joint the one towards the parameter `other`; and u there.

    t may be beyond the ends of a closed curve.
    """
    length = curve_length(curves, curve)
    closed = curves.closed[curve]
    inside = t
    if closed and (t < 0.0 or t > length):
        inside -= np.floor(t / length) * length
    inside = min(max(inside, 0.0), length)
    first, last = curves.first_span[curve], curves.first_span[curve + 1] - 1
    span = span_at(curves, curve, inside)
    near = NEAR * length
    if other > t and curves.stop[span] - inside <= near and (closed or span < last):
        return (span + 1 if span < last else first), 0.0
    if other < t and inside - curves.start[span] <= near and (closed or span > first):
        return (span - 1 if span > first else last), 1.0
    return span, (inside - curves.start[span]) / (curves.stop[span] - curves.start[span])


@bare_kernel
def turning_between(curves, turning, curve, low, high):
    """The absolute turning of a curve strictly between low <= high; of a whole closed curve also
    that at the joint where it closes.

    On closed curves high - low may be up to the length; both may be beyond the ends.
    """
    if not high > low:
        return 0.0
    if curves.closed[curve] and high - low >= (1.0 - NEAR) * curve_length(curves, curve):
        first, last = curves.first_span[curve], curves.first_span[curve + 1] - 1
        return turning.joint[first] + turning.before[last] + turning.inside[last]
    a, u = span_towards(curves, curve, low, high)
    b, v = span_towards(curves, curve, high, low)
    start = turning.before[a] + u * turning.inside[a]
    stop = turning.before[b] + v * turning.inside[b]
    if curves.closed[curve] and (b < a or (b == a and v < u)):
        first, last = curves.first_span[curve], curves.first_span[curve + 1] - 1
        stop += turning.joint[first] + turning.before[last] + turning.inside[last]
    return max(stop - start, 0.0)


@kernel
def turnings(curves, turning, curve, span):
    """(n,) turning of `curve` (n,) between the parameters `span` (n, 2), in either order."""
    found = np.zeros(len(curve))
    for i in range(len(curve)):
        if curve[i] >= 0:
            low, high = min(span[i, 0], span[i, 1]), max(span[i, 0], span[i, 1])
            found[i] = turning_between(curves, turning, curve[i], low, high)
    return found


def turning_of(curves: Curves) -> Turning:
    """The turning of all of these curves."""
    spans = len(curves.start)
    inside, joint, before = np.zeros(spans), np.zeros(spans), np.zeros(spans)
    _turning_inside(curves, inside, joint)
    for first, end in zip(curves.first_span[:-1], curves.first_span[1:], strict=True):
        steps = inside[first : end - 1] + joint[first + 1 : end]
        before[first + 1 : end] = np.cumsum(steps)
    return Turning(before, inside, joint)


class CurveTurning:
    """Keeps the turning of the curves of meshes as long as these live."""

    _known: ClassVar[WeakKeyDictionary[MeshBoundary, Turning]] = WeakKeyDictionary()

    @classmethod
    def of(cls, mesh: HalfEdgeMesh) -> Turning:
        """The turning of the curves of `mesh`."""
        boundary = mesh.boundary_info
        found = cls._known.get(boundary)
        if found is None:
            found = cls._known[boundary] = turning_of(boundary.curves)
        return found


def has_bends(mesh: HalfEdgeMesh) -> bool:
    """Whether a curve of the boundary or an interface bends between its joints."""
    return bool((CurveTurning.of(mesh).inside > BENDS).any())
