"""Checks that the vertices of a mesh lie on its curves as invariants 9 to 11 of the arrays say.

Whole arrays are checked, and no index is used before it is known to be in range, so that arrays
from files may hold anything.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.core.arrays import (
    CURVE,
    ELEMENT_SLOTS,
    END,
    FLAGS,
    GEOMETRIC,
    HALF,
    LEFT,
    ORIGIN,
    RIGHT,
    SIDES,
    START,
    TWIN,
    VERTEX_SLOTS,
    MeshArrays,
)
from meshwright_core.core.composite_curves import place_all
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.core.mesh_boundary import MeshBoundary, Seats
from meshwright_core.errors import MeshError

_ROUND = 1e-9
"""Error of the sum of the edges' ranges around a curve, relative to its length."""


def _require(condition: bool | np.bool_, sentence: str) -> None:
    if not condition:
        raise MeshError(sentence)


def seated(
    points: np.ndarray, boundary: MeshBoundary, curve: np.ndarray, parameter: np.ndarray
) -> tuple[Seats, np.ndarray]:
    """Seats of vertices, and their points (n, 3), those on curves at their exact places.

    Raises MeshError if a seat is on no curve of the boundary, or beyond its ends.
    """
    points = np.asarray(points, np.float64)
    _require(points.ndim == 2 and points.shape[1] in (2, 3), "points must be (n, 2) or (n, 3)")
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    curve = np.asarray(curve)
    parameter = np.asarray(parameter, np.float64)
    fits = curve.shape == parameter.shape == (len(points),)
    _require(fits, "seats must hold a curve and a parameter for each point")
    _require(np.issubdtype(curve.dtype, np.integer), "the curves of seats must be whole numbers")
    curve = curve.astype(np.int64)
    _require_known(curve, boundary.count)
    there = np.flatnonzero(curve >= 0)
    curves, t = curve[there], parameter[there].copy()
    length = boundary.lengths()[curves]
    _require((t >= 0.0).all() and (t <= length).all(), "a seat lies beyond the ends of its curve")
    t[boundary.curves.closed[curves] & (t == length)] = 0.0
    at = np.zeros(len(points))
    at[there] = t
    moved = points.copy()
    moved[there] = place_all(boundary.curves, curves, t)
    return Seats(curve, at), moved


def _require_known(curve: np.ndarray, count: int) -> None:
    known = ((curve >= -1) & (curve < count)).all()
    _require(known, "a vertex lies on a curve that does not exist")


def require_seats(m: MeshArrays, boundary: MeshBoundary) -> None:
    """Raise MeshError unless invariants 9 to 11 hold; the other ones must."""
    k, slots = int(m.counters[SIDES]), int(m.counters[VERTEX_SLOTS])
    live = m.vertex[:slots, HALF] >= 0
    curve, t = m.vertex[:slots, CURVE].astype(np.int64), m.parameter[:slots]
    _require_known(curve, boundary.count)
    _require((curve[~live] == -1).all(), "a dead vertex lies on a curve")
    free = curve < 0
    _require((t[free] == 0.0).all(), "a vertex on no curve has a parameter")
    lengths = boundary.lengths()
    on_it = np.flatnonzero(~free)
    good = (t[on_it] >= 0.0) & (t[on_it] <= lengths[curve[on_it]])
    good &= ~(boundary.curves.closed[curve[on_it]] & (t[on_it] == lengths[curve[on_it]]))
    _require(good.all(), "a parameter lies beyond the ends of its curve")
    _check_interfaces(m, boundary, slots)

    halfedges = np.flatnonzero(m.edge[: int(m.counters[ELEMENT_SLOTS]) * k, ORIGIN] >= 0)
    twin = m.edge[halfedges, TWIN].astype(np.int64)
    region = m.region.astype(np.int64)
    _require((region[halfedges // k] >= 0).all(), "a region is negative")
    named = len(boundary.region_names)
    _require((region[halfedges // k] < named).all(), "an element has a region that does not exist")
    along = (twin < 0) | (region[halfedges // k] != region[twin // k])
    halfedges, twin = halfedges[along], twin[along]
    origin = m.edge[halfedges, ORIGIN].astype(np.int64)
    target = m.edge[halfedges - halfedges % k + (halfedges + 1) % k, ORIGIN].astype(np.int64)
    touched = np.zeros(slots, bool)
    touched[origin] = touched[target] = True
    _require((touched == ~free).all(), "a vertex on a curve has no edge on one, or the reverse")
    _check_loops(m, boundary, origin[twin < 0], target[twin < 0])
    _check_chains(m, boundary, halfedges, twin)


def _check_interfaces(m: MeshArrays, boundary: MeshBoundary, slots: int) -> None:
    """The table of interfaces is that of the boundary, and their ends are geometric vertices."""
    table = m.interface.astype(np.int64)
    _require(np.array_equal(table, boundary.table()), "the interfaces are not those of the mesh")
    loop = np.zeros(boundary.count, bool)
    loop[list(boundary.loops)] = True
    _require((loop == (table[:, LEFT] < 0)).all(), "a curve is no boundary loop and no interface")
    closed = boundary.curves.closed
    _require(closed[loop].all(), "a boundary loop is not closed")
    inner = table[~loop]
    _require((inner[:, LEFT] != inner[:, RIGHT]).all(), "an interface has one region on both sides")
    _require((inner[:, RIGHT] >= 0).all(), "an interface lacks a region")
    ends = inner[:, (START, END)]
    whole = (ends < 0).all(axis=1)
    _require((whole | (ends >= 0).all(axis=1)).all(), "an interface lacks an end")
    _require(closed[~loop][whole].all(), "an interface without ends is not closed")
    straight = inner[~whole]
    turned = straight[:, (RIGHT, LEFT, END, START)]
    both = np.concatenate([straight, turned])
    _require(
        len(np.unique(both, axis=0)) == len(both),
        "two interfaces of the same regions join the same two vertices",
    )
    ends = ends[~whole]
    _require((ends < slots).all(), "an interface ends at a vertex that does not exist")
    rows = m.vertex[ends.ravel()]
    good = (rows[:, HALF] >= 0) & (rows[:, CURVE] >= 0) & ((rows[:, FLAGS] & GEOMETRIC) > 0)
    _require(good.all(), "an interface ends at a vertex that is no junction")


def _check_loops(m: MeshArrays, boundary: MeshBoundary, start: np.ndarray, end: np.ndarray) -> None:
    """Invariant 10, for boundary edges from `start` to `end`."""
    curve = m.vertex[start, CURVE].astype(np.int64)
    _require((curve == m.vertex[end, CURVE]).all(), "a boundary edge joins two curves")
    _require((m.interface[curve, LEFT] < 0).all(), "a boundary vertex lies on an interface")
    lengths = boundary.lengths()
    steps = m.parameter[end] - m.parameter[start]
    steps = np.where(steps > 0.0, steps, steps + lengths[curve])
    around = np.bincount(curve, weights=steps, minlength=boundary.count)
    loops = list(boundary.loops)
    off = np.abs(around[loops] - lengths[loops])
    _require(
        (off <= _ROUND * lengths[loops]).all(),
        "the vertices of a boundary loop do not follow each other along its curve",
    )


def _check_chains(
    m: MeshArrays, boundary: MeshBoundary, halfedges: np.ndarray, twin: np.ndarray
) -> None:
    """Invariant 11, for half-edges along curves with these twins."""
    k = int(m.counters[SIDES])
    inside = twin >= 0
    halfedges, twin = halfedges[inside], twin[inside]
    if not len(halfedges) and not boundary.interfaces:
        return
    curve, span = edge_places(m, halfedges, k)
    _require((curve >= 0).all(), "an edge between two regions lies on no curve")
    table = m.interface.astype(np.int64)[curve]
    own, other = m.region[halfedges // k], m.region[twin // k]
    forward = own == table[:, LEFT]
    right = np.where(forward, table[:, RIGHT], table[:, LEFT])
    _require(
        ((forward | (own == table[:, RIGHT])) & (other == right)).all(),
        "an edge between two regions lies on the interface of others",
    )
    steps = span[forward, 1] - span[forward, 0]
    _require((steps > 0.0).all(), "the vertices of an interface are out of order")
    lengths = boundary.lengths()
    along = np.bincount(curve[forward], weights=steps, minlength=boundary.count)
    inner = [one.curve for one in boundary.interfaces]
    off = np.abs(along[inner] - lengths[inner])
    _require(
        (off <= _ROUND * lengths[inner]).all(),
        "the vertices of an interface do not follow each other along its curve",
    )
    origin = m.edge[halfedges, ORIGIN].astype(np.int64)
    met = np.bincount(origin, minlength=len(m.vertex))
    outer = m.interface[np.maximum(m.vertex[origin, CURVE], 0), LEFT] < 0
    ends = (table[:, START] == origin) | (table[:, END] == origin)
    own_curve = m.vertex[origin, CURVE] == curve
    _require(
        (ends | ((met[origin] == 2) & own_curve & ~outer)).all(),
        "an interface passes through a junction, or leaves its curve",
    )
