"""The lower bound s* of a mesh of several regions.

Of one region, s* is the absolute value of the sum of Delta (equation 3): irregularities of opposite
sign cancel wherever they are. Those of two regions only cancel where both regions meet, and there a
valid mesh leaves less choice. The bound here takes that into account; docs/lower_bound.md derives
it.

*Balance of a region.* The curves at a vertex divide its surroundings into sectors. Let n be the
number of elements in a sector and d its share of the desired degree, max(1, round(angle / alpha)).
By Euler's formula, and as k F = 2 E - B, the sum

    T = sum of Delta over the vertices inside + sum of (n - d) over the sectors

of a connected region is the same for all of its meshes: -4 chi (quads) or -6 chi (triangles), less
the sum of d - 2 or d - 3 over the sectors.

*What may cancel.* An element whose corner is 180 degrees wide or more is not valid. So n is larger
than angle / 180, and n - d is at least -slack, slack = d - 1 - floor(angle / 180). At a vertex of
several sectors Delta is the sum of their n - d. Vertices of one region alone, inside or on its
boundary, have |Delta| to pay for each unit of T; a vertex of several takes units of T from its
regions, any number of positive ones, and of negative ones as many as there is slack. What arrives
at it with both signs costs nothing.

*Bound.* So the smallest s is the sum of |T| over the regions less twice the largest flow from the
regions with T > 0 to those with T < 0, in the network whose arcs lead from each region to the
vertices at its sectors (without limit) and from these to the regions (as far as there is slack).
Vertices whose desired degree is not the sum of their shares begin or end flow by the difference.

A smooth interface leaves quads no slack (d = 2, and 2 are needed), and triangles one unit at each
of any number of vertices (d = 3): those of connected regions cancel freely. An interface that is a
polyline has, for quads, one unit at each of its kinks, on the side where it is convex, if they are
not corners anyway.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import (
    CURVE,
    DESIRED,
    ELEMENT_SLOTS,
    FLAGS,
    GEOMETRIC,
    HALF,
    LEFT,
    ORIGIN,
    SIDES,
    TWIN,
    VERTEX_SLOTS,
    MeshArrays,
)
from meshwright_core.core.components import components
from meshwright_core.core.composite_curves import Curves, tangents
from meshwright_core.core.curve_corners import sectors
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.core.irregularity import CORNER_ANGLE, desired_on_boundary

_UNLIMITED = 2**30
_NEAR_END = 1e-9
"""Share of a span from its end at which its direction is taken."""
_JOINT = 1e-9
"""Distance along a curve, relative to its length, below which two places are one."""


class SharedVertices(NamedTuple):
    """Vertices with several sectors, each of its own region or of one that comes to it twice."""

    surplus: np.ndarray
    """(n,) desired degree less the shares of the sectors, and less one on the boundary."""
    sector_vertex: np.ndarray
    """(s,) the number of the vertex, from 0, of each sector."""
    sector_region: np.ndarray
    """(s,) its region."""
    slack: np.ndarray
    """(s,) by how many elements it may fall below its share."""


class Passages(NamedTuple):
    """Where an interface lets units of T pass from one region to another, without a vertex that
    every mesh has.
    """

    giving: np.ndarray
    """(p,) the region that they leave."""
    taking: np.ndarray
    """(p,) the region that they come to."""
    most: np.ndarray
    """(p,) how many may pass."""


def shares(angle: np.ndarray, k: int) -> np.ndarray:
    """(n,) the desired number of elements in sectors of so many degrees."""
    return desired_on_boundary(angle, k) - 1


def slack_of(angle: np.ndarray, share: np.ndarray) -> np.ndarray:
    """(n,) by how many elements sectors may fall below their shares in a valid mesh.

    Angles that lack less than a corner's 0.01 degrees to 180 or 360 count as that.
    """
    needed = np.floor((angle + CORNER_ANGLE) / 180.0).astype(np.int64) + 1
    slack: np.ndarray = np.maximum(share - needed, 0)
    return slack


def bound_excess(balance: np.ndarray, shared: SharedVertices, passages: Passages) -> int:
    """s* less the absolute value of the sum of Delta.

    Args:
        balance: (r,) T of each region.
        shared: the vertices of several regions that every mesh has.
        passages: along the interfaces between.
    """
    supply = np.concatenate([balance, -shared.surplus]).astype(np.int64)
    positive, negative = int(supply[supply > 0].sum()), int(-supply[supply < 0].sum())
    if min(positive, negative) == 0:
        return 0
    return 2 * (min(positive, negative) - _largest_flow(supply, len(balance), shared, passages))


def _largest_flow(
    supply: np.ndarray, regions: int, shared: SharedVertices, passages: Passages
) -> int:
    """How much of the positive supplies of the nodes, regions before vertices, can reach the
    negative ones.
    """
    # imported here: it takes a third of a second, and few meshes have something to be cancelled
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import maximum_flow

    count = len(supply)
    source, sink = count, count + 1
    begins, ends = np.flatnonzero(supply > 0), np.flatnonzero(supply < 0)
    vertex = regions + shared.sector_vertex
    tail = [np.full(len(begins), source), ends, shared.sector_region, vertex, passages.giving]
    head = [begins, np.full(len(ends), sink), vertex, shared.sector_region, passages.taking]
    most = [
        supply[begins],
        -supply[ends],
        np.full(len(vertex), _UNLIMITED),
        shared.slack,
        np.minimum(passages.most, _UNLIMITED),
    ]
    # arcs of the same ends are added up, which 64 bits bear; no flow is larger than the supply
    arcs = coo_array(
        (np.concatenate(most), (np.concatenate(tail), np.concatenate(head))),
        shape=(count + 2, count + 2),
        dtype=np.int64,
    ).tocsr()
    arcs.data = np.minimum(arcs.data, _UNLIMITED).astype(np.int32)
    return int(maximum_flow(arcs.astype(np.int32), source, sink).flow_value)


class Kinks(NamedTuple):
    """The joints at which curves turn."""

    curve: np.ndarray
    """(n,) the curve."""
    parameter: np.ndarray
    """(n,) where on it; 0 for the joint that closes it."""
    turn: np.ndarray
    """(n,) degrees, positive to the left."""


def kinks(curves: Curves, numbers: np.ndarray) -> Kinks:
    """The joints of spans at which plane curves turn by more than 0.01 degrees.

    numbers: (n,) the curves that are looked at.
    """
    before, after = [], []
    for number in numbers.tolist():
        first, last = int(curves.first_span[number]), int(curves.first_span[number + 1])
        inner = np.arange(first, last - 1)
        closing = [last - 1] if curves.closed[number] else []
        before.append(np.append(inner, closing).astype(np.int64))
        after.append(np.append(inner + 1, [first] if closing else []).astype(np.int64))
    one = np.concatenate([np.zeros(0, np.int64), *before])
    other = np.concatenate([np.zeros(0, np.int64), *after])
    of_span = np.repeat(np.arange(len(curves.closed)), np.diff(curves.first_span))
    curve = of_span[one].astype(np.int64)
    length = curves.stop - curves.start
    come = tangents(curves, curve, curves.stop[one] - _NEAR_END * length[one])
    go = tangents(curves, curve, curves.start[other] + _NEAR_END * length[other])
    cross = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0]
    turn = np.degrees(np.arctan2(cross, (come[:, :2] * go[:, :2]).sum(axis=1)))
    bent = np.abs(turn) > CORNER_ANGLE
    return Kinks(curve[bent], curves.start[other][bent], turn[bent])


def without(found: Kinks, curves: Curves, curve: np.ndarray, parameter: np.ndarray) -> Kinks:
    """Kinks without those at the places `curve` (n,), `parameter` (n,), which have a vertex in
    every mesh.
    """
    kept = np.ones(len(found.curve), bool)
    for number in np.unique(found.curve).tolist():
        length = float(curves.stop[curves.first_span[number + 1] - 1])
        taken = np.append(parameter[curve == number], [np.inf])
        taken = np.sort(np.append(taken, taken[:-1] - length) if curves.closed[number] else taken)
        rows = np.flatnonzero(found.curve == number)
        t = found.parameter[rows]
        at = np.searchsorted(taken, t - _JOINT * length)
        kept[rows] = np.abs(taken[np.minimum(at, len(taken) - 1)] - t) > _JOINT * length
    return Kinks(*(column[kept] for column in found))


def passages_along(
    k: int, curve: np.ndarray, left: np.ndarray, right: np.ndarray, bends: Kinks
) -> Passages:
    """What interfaces let pass.

    Args:
        k: 3 or 4 sides of an element.
        curve: (n,) the curves of the interfaces.
        left: (n,) the region on the left of each.
        right: (n,) likewise.
        bends: the kinks of these curves at which no mesh needs a vertex.
    """
    if k == 3:  # 3 elements are desired and 2 needed at each of any number of vertices
        most = np.full(2 * len(curve), _UNLIMITED)
        return Passages(np.concatenate([left, right]), np.concatenate([right, left]), most)
    # 2 are desired; the side where the curve is convex needs 1 only
    size = int(curve.max(initial=-1)) + 1
    to_left = np.bincount(bends.curve[bends.turn > 0.0], minlength=size)[curve]
    to_right = np.bincount(bends.curve[bends.turn < 0.0], minlength=size)[curve]
    giving, taking = np.concatenate([right, left]), np.concatenate([left, right])
    return Passages(giving, taking, np.concatenate([to_left, to_right]))


def bound_excess_of(m: MeshArrays) -> int:
    """s* less the absolute value of the sum of Delta of a mesh; 0 of a mesh without interfaces.

    No operation changes it, nor does a vertex that is marked as geometric: only desired degrees
    that someone sets do. 0 too for a mesh that is not in a plane z = const, where sectors have no
    angles.
    """
    interfaces = np.flatnonzero(m.interface[:, LEFT] >= 0)
    slots, k = int(m.counters[VERTEX_SLOTS]), int(m.counters[SIDES])
    live = np.flatnonzero(m.vertex[:slots, HALF] >= 0)
    if not len(interfaces) or np.ptp(m.points[live, 2]) > 1e-12 * max(
        1.0, float(np.abs(m.points[live]).max())
    ):
        return 0
    halfedges = np.flatnonzero(m.edge[: int(m.counters[ELEMENT_SLOTS]) * k, ORIGIN] >= 0)
    twin = m.edge[halfedges, TWIN].astype(np.int64)
    region = m.region.astype(np.int64)
    inner = (twin >= 0) & (region[halfedges // k] == region[twin // k])
    count, part = components(halfedges[inner] // k, twin[inner] // k, len(region))

    desired = m.vertex[:, DESIRED].astype(np.int64)
    found = sectors(m)
    sectors_at = np.bincount(found.vertex, minlength=len(m.vertex))
    shared = sectors_at > 1
    share = np.full(len(found.vertex), 2 if k == 4 else 3)
    corner = (m.vertex[found.vertex, FLAGS] & GEOMETRIC) > 0
    share[corner] = shares(found.angle, k)[corner]
    alone = ~shared[found.vertex]
    share[alone] = desired[found.vertex[alone]] - 1

    free = live[sectors_at[live] == 0]
    balance = np.bincount(part[halfedges // k], minlength=count)
    of_sector = part[found.halfedge // k]
    balance = balance - np.bincount(of_sector, weights=share, minlength=count).astype(np.int64)
    inside = part[m.vertex[free, HALF].astype(np.int64) // k]
    balance -= np.bincount(inside, weights=desired[free], minlength=count).astype(np.int64)

    total = np.bincount(found.vertex, weights=share, minlength=len(desired)).astype(np.int64)
    edge = np.zeros(len(desired), np.int64)
    edge[found.vertex[found.boundary]] = 1
    surplus = desired - total - edge
    slack = slack_of(found.angle, share)
    # an interface that passes smoothly through a vertex is among the passages
    told = shared & (((m.vertex[:, FLAGS] & GEOMETRIC) > 0) | (surplus != 0))
    rows = told[found.vertex]
    number = np.cumsum(told) - 1
    vertices = SharedVertices(
        surplus[told], number[found.vertex[rows]], of_sector[rows], slack[rows]
    )
    constrained = halfedges[~inner & (twin >= 0)]
    return bound_excess(balance, vertices, _passages(m, part, constrained, np.flatnonzero(told)))


def _passages(
    m: MeshArrays, part: np.ndarray, constrained: np.ndarray, told: np.ndarray
) -> Passages:
    """What the interfaces of a mesh let pass between its parts.

    Args:
        m: the mesh.
        part: (elements,) of each element.
        constrained: the half-edges along interfaces.
        told: the vertices that are looked at for themselves.
    """
    k = int(m.counters[SIDES])
    curve, _ = edge_places(m, constrained, k)
    on_left = (curve >= 0) & (m.region[constrained // k] == m.interface[curve, LEFT])
    h = constrained[on_left]
    numbers, first = np.unique(curve[on_left], return_index=True)
    h = h[first]
    left, right = part[h // k], part[m.edge[h, TWIN].astype(np.int64) // k]
    bends = without(kinks(m.curves, numbers), m.curves, m.vertex[told, CURVE], m.parameter[told])
    return passages_along(k, numbers, left, right, bends)
