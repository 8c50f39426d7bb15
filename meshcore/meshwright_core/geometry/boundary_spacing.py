"""Spacing of boundary vertices on curved sides, so that the polygon through them follows the side.

The energy of element shapes does not depend on the outline between two boundary vertices: by
itself it crowds them in one place, and elsewhere an edge cuts off a piece of a disc. So on a curved
side the vertices are spaced evenly, by a measure of one half arc length and one half turning, and
held there; on straight sides the energy places them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.geometry import movable_part
from meshwright_core.geometry.movable_part import Region
from meshwright_core.geometry.unfixable import turns

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

LEAST_TURN = np.radians(10.0)
"""A side that turns by less in all counts as straight."""
PIECE = np.radians(30.0)
"""Turning of a curved side that one edge may replace: a circle keeps twelve edges, if it had so
many."""


def _measure(region: Region, side: int) -> tuple[np.ndarray, np.ndarray] | None:
    """Arc lengths (p,) of a side's points and the measure (p,) up to each; None for straight sides.

    The turning at a point counts half for each of the two pieces that meet there. Closed sides are
    measured for three rounds, from one before to one after, since runs may pass their seam.
    """
    assert region.frame is not None
    sides = region.sides
    rows = slice(sides.first[side], sides.first[side + 1])
    closed = bool(sides.closed[side])
    arc = sides.arc[rows]
    lengths = np.diff(arc)
    angles = np.abs(turns(sides.points[rows] @ region.frame[:2].T, closed))
    if angles.sum() < LEAST_TURN:
        return None
    # angle i is the turning at the end of piece i
    turning = np.zeros(len(lengths))
    turning[: len(angles)] += 0.5 * angles
    following = np.roll(np.arange(len(lengths)), -1)[: len(angles)]
    turning[following] += 0.5 * angles
    pieces = lengths / lengths.sum() + turning / angles.sum()
    measure = np.concatenate([[0.0], np.cumsum(pieces)])
    if not closed:
        return arc, measure
    length, total = arc[-1], measure[-1]
    return (
        np.concatenate([arc[:-1] - length, arc[:-1], arc + length]),
        np.concatenate([measure[:-1] - total, measure[:-1], measure + total]),
    )


def bending(region: Region) -> list[int]:
    """The sliding vertices of a region, by local index, that lie on sides which bend."""
    if region.frame is None:
        return []
    sides = region.seats.side
    bent = {int(s) for s in np.unique(sides[sides >= 0]) if _measure(region, int(s)) is not None}
    return [int(i) for i in np.flatnonzero(region.sliding) if int(sides[i]) in bent]


def spread(region: Region) -> None:
    """Spread the sliding vertices of bending sides evenly, by :func:`_measure`, between those
    around them that stay.
    """
    for run in region.runs():
        found = _measure(region, int(region.seats.side[run.members[0]]))
        if found is None:
            continue
        arc, measure = found
        low, high = np.interp([run.low, run.high], arc, measure)
        even = np.linspace(low, high, len(run.members) + 2)[1:-1]
        region.seats.parameter[run.members] = np.interp(even, measure, arc) - run.shift
    region.settle()


def anchors(mesh: HalfEdgeMesh) -> np.ndarray:
    """Ids, ascending, of vertices that keep the shape of curved sides while they are not removed.

    About one for each :data:`PIECE` of turning, evenly by :func:`_measure`; all vertices of a side
    that has no more. A search that locks them cannot turn a disc into a square.
    """
    region = movable_part.whole(mesh)
    found: list[int] = []
    if region.frame is None:
        return np.array(found, np.int64)
    for side, closed in enumerate(region.sides.closed.tolist()):
        measured = _measure(region, side)
        members = np.flatnonzero(region.seats.side == side)
        if measured is None or not len(members):
            continue
        rows = slice(region.sides.first[side], region.sides.first[side + 1])
        flat = region.sides.points[rows] @ region.frame[:2].T
        pieces = int(np.ceil(np.abs(turns(flat, closed)).sum() / PIECE - 1e-6))
        at = np.interp(region.seats.parameter[members], *measured)
        start, stop = np.interp([0.0, region.sides.arc[rows][-1]], *measured)
        even = np.linspace(start, stop, pieces + 1)[:-1]
        if not closed:
            even = even[1:]
        if len(even) >= len(members):
            chosen = members
        else:
            away = np.abs(even[:, None] - at)
            if closed:
                away = np.minimum(away, np.abs(stop - start - away))
            chosen = members[np.unique(away.argmin(axis=1))]
        found += chosen.tolist()
    return np.sort(region.vertices[found]).astype(np.int64)
