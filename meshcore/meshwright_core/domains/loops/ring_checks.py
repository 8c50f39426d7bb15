"""Checks of the rings of a polygon: one sentence for each kind of bad polygon."""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from meshwright_core.core.time_limit import check_time
from meshwright_core.domains.loops.near_pairs import chunks_of_pairs, pairs_near
from meshwright_core.errors import MeshError, capitalised

Points = NDArray[np.float64]
Flags = NDArray[np.bool_]

_NEAR = 1e-10
"""Neighbouring points nearer than this share of the domain's size are one point twice."""

LARGEST = 1e100
"""Coordinates beyond this would overflow in areas and in-circle tests."""


def turning_angles(loop: Points) -> NDArray[np.float64]:
    """Return by how many degrees a closed polyline turns at each of its points, 0 to 180.

    Args:
        loop: (n, 2) points in order.
    """
    before = loop - np.roll(loop, 1, axis=0)
    after = np.roll(before, -1, axis=0)
    across = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    along = (before * after).sum(axis=1)
    return np.abs(np.degrees(np.arctan2(across, along)))


def signed_area(loop: Points) -> float:
    """Area inside a closed polyline (n, 2), positive if it runs counter-clockwise."""
    x, y = (loop - loop[0]).T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y))


def _place(point: ArrayLike) -> str:
    x, y = np.asarray(point, dtype=float)
    return f"({x:.6g}, {y:.6g})"


def checked_ring(ring: ArrayLike, what: str) -> Points:
    """One ring as a new (n, 2) array without a closing point; MeshError if it is invalid."""
    try:
        if np.iscomplexobj(ring):
            raise TypeError("complex numbers would lose their imaginary part")
        points = np.array(ring, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise MeshError(f"{capitalised(what)} is not a list of [x, y] pairs of numbers.") from error
    if points.size and (points.ndim != 2 or points.shape[1] != 2):
        raise MeshError(f"{capitalised(what)} is not a list of [x, y] pairs of numbers.")
    points = points.reshape(-1, 2)
    bad = np.flatnonzero(~(np.abs(points) < LARGEST).all(axis=1))
    if bad.size:
        raise MeshError(
            f"Point {bad[0]} of {what} is {_place(points[bad[0]])}, which is not a finite place."
        )
    if len(points) > 3 and (points[0] == points[-1]).all():
        points = points[:-1]
    if len(points) < 3:
        plural = "" if len(points) == 1 else "s"
        raise MeshError(
            f"{capitalised(what)} has {len(points)} point{plural}, but a polygon needs at least 3."
        )
    _refuse_repeats(points, what)
    return points


def _refuse_repeats(points: Points, what: str) -> None:
    _, first, inverse = np.unique(points, axis=0, return_index=True, return_inverse=True)
    again = np.flatnonzero(first[inverse.ravel()] != np.arange(len(points)))
    if again.size:
        j = int(again[0])
        i = int(first[inverse.ravel()[j]])
        raise MeshError(f"Points {i} and {j} of {what} are the same, {_place(points[j])}.")
    size = float(np.ptp(points, axis=0).max())
    if size < 1 / LARGEST:
        raise MeshError(f"{capitalised(what)} encloses no area: it is only {size:.3g} across.")
    steps = np.abs(np.roll(points, -1, axis=0) - points).max(axis=1)
    near = np.flatnonzero(steps < _NEAR * size)
    if near.size:
        i = int(near[0])
        raise MeshError(
            f"Points {i} and {(i + 1) % len(points)} of {what} are nearly the same, "
            f"{_place(points[i])}."
        )
    centred = (points - points.mean(axis=0)) / size
    if np.linalg.svd(centred, compute_uv=False)[1] < _NEAR:
        raise MeshError(f"{capitalised(what)} encloses no area: all its points lie on one line.")


def checked_flags(
    flags: ArrayLike | None, ring: ArrayLike, loop: Points, what: str
) -> Flags | None:
    """Corner flags of a ring, without that of a closing point; MeshError unless they fit."""
    if flags is None:
        return None
    values = np.array(flags)
    given = len(np.asarray(ring))
    if values.ndim != 1 or values.dtype != np.bool_ or len(values) not in (len(loop), given):
        raise MeshError(
            f"The corners of {what} must be {len(loop)} true or false, one for each point."
        )
    return values[: len(loop)]


def refuse_crossings(loops: list[Points], names: list[str]) -> None:
    """Raise MeshError if two edges meet anywhere but in the point that neighbours share."""
    starts = np.concatenate(loops)
    ends = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops])
    ring = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    index = np.concatenate([np.arange(len(loop)) for loop in loops])
    edges = shapely.linestrings(np.stack([starts, ends], axis=1))
    for one, other in chunks_of_pairs(edges, "intersects"):
        later = one < other
        one, other = one[later], other[later]
        order = np.lexsort((other, one))
        _refuse_meetings(edges, ends, (one[order], other[order]), (loops, ring, index), names)


def _refuse_meetings(
    edges: NDArray[np.object_],
    ends: Points,
    pairs: tuple[NDArray[np.int64], NDArray[np.int64]],
    place: tuple[list[Points], NDArray[np.int64], NDArray[np.int64]],
    names: list[str],
) -> None:
    """Raise MeshError for the first of the pairs of edges that meet elsewhere.

    place: all loops, and of each edge the loop that it is of and its number there.
    """
    loops, ring, index = place
    for number, (i, j) in enumerate(zip(pairs[0].tolist(), pairs[1].tolist(), strict=True)):
        if number % 1000 == 0:
            check_time()
        meeting = shapely.intersection(edges[i], edges[j])
        count = len(loops[ring[i]])
        neighbours = ring[i] == ring[j] and (index[j] - index[i]) % count in (1, count - 1)
        if neighbours and (meeting.geom_type == "Point" or meeting.is_empty):
            continue
        spots = shapely.get_coordinates(meeting)
        spot = _place(spots.mean(axis=0) if len(spots) else ends[i])
        edge_i, edge_j = (f"edge {index[e]}-{(index[e] + 1) % len(loops[ring[e]])}" for e in (i, j))
        if ring[i] == ring[j]:
            raise MeshError(
                f"{capitalised(names[ring[i]])} crosses or touches itself near {spot}: "
                f"{edge_i} meets {edge_j}."
            )
        raise MeshError(
            f"{capitalised(names[ring[j]])} crosses or touches {names[ring[i]]} near {spot}: "
            f"{edge_j} meets {edge_i}."
        )


def refuse_strays(loops: list[Points], names: list[str]) -> None:
    """Raise MeshError if a hole lies outside the outline or in another hole; no rings meet."""
    polygons = np.array([shapely.Polygon(loop) for loop in loops])
    spots = shapely.points(np.array([loop[0] for loop in loops]))
    shapely.prepare(polygons[0])
    outside = ~shapely.contains(polygons[0], spots)
    one, other = pairs_near(spots, "within", others=polygons)
    nested = (one != other) & (one > 0) & (other > 0)
    # of several around one, the first
    around = dict(sorted(zip(one[nested].tolist(), other[nested].tolist(), strict=True))[::-1])
    for i in sorted({*(np.flatnonzero(outside[1:]) + 1).tolist(), *around}):
        if not outside[i]:
            raise MeshError(
                f"{capitalised(names[i])} lies inside {names[around[i]]}: "
                f"its point 0 is {_place(loops[i][0])}."
            )
        inverted = " and around it" if polygons[i].contains(spots[0]) else ""
        raise MeshError(
            f"{capitalised(names[i])} lies outside the outline{inverted}: "
            f"its point 0 is {_place(loops[i][0])}."
        )
