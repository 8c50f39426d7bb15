"""Traces domains: pieces of a drawing are joined to closed loops, and the loops nested."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.domains.domain import CORNER_ANGLE, Domain, Flags, Points
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.curves import Piece

MAX_POINTS = 100_000
"""Points in one drawing beyond which it is refused."""
MAX_LOOPS = 1_000

_GAP = 1e-5
"""Ends nearer than this share of the drawing's size are joined."""
_SMOOTH = 1.0
"""Degrees that two curves may turn where they meet without a corner: files round their numbers."""
_SAME = 1e-9
"""Points nearer than this share of the drawing's size are one point twice."""

Loop = tuple[Points, Flags]


def traced(pieces: Sequence[Piece], corner_angle: float = CORNER_ANGLE, name: str = "") -> Domain:
    """Return the domain whose boundary the pieces make, in any order and direction.

    The longest way round is the outline, the loops inside it are its holes. A point is a corner
    where a piece has one, and where pieces meet at an angle of more than `corner_angle` degrees
    (of more than 1 degree, if that is larger, where a curve is involved).

    Raises:
        MeshError: no pieces; a loop that is open; more than two lines that meet in a point; loops
            beside each other, or one inside a hole; too many points; and all that `Domain` refuses.
    """
    pieces = [piece for piece in pieces if len(piece.points) > 1]
    if not pieces:
        raise MeshError("there are no lines or curves in it")
    count = sum(len(piece.points) for piece in pieces)
    if count > MAX_POINTS:
        raise MeshError(f"it has {count:,} points, and {MAX_POINTS:,} are the most that are read")
    everything = np.concatenate([piece.points for piece in pieces])
    if not np.isfinite(everything).all():
        raise MeshError("a coordinate is not a finite number")
    size = float(np.ptp(everything, axis=0).max())
    found = [_loop(chain, corner_angle, size) for chain in _chains(pieces, _GAP * size)]
    loops = [loop for loop in found if loop is not None]
    if not loops:
        raise MeshError("there is no closed outline in it")
    outline, *holes = _nested(loops)
    return Domain(
        outline[0],
        [points for points, _ in holes],
        outline[1],
        [flags for _, flags in holes],
        name,
    )


def _chains(pieces: list[Piece], gap: float) -> list[list[Piece]]:
    """Return the pieces in closed rows, each turned to begin where the one before it ends."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    ends = np.array([piece.points[[0, -1]] for piece in pieces]).reshape(-1, 2)
    near = cKDTree(ends).query_pairs(gap, output_type="ndarray")
    links = coo_array((np.ones(len(near)), near.T), shape=(len(ends), len(ends)))
    node = connected_components(links, directed=False)[1].reshape(-1, 2)
    alive = _first_of_each(pieces, node, gap)
    closed = alive & (node[:, 0] == node[:, 1])
    rows = [[pieces[i]] for i in np.flatnonzero(closed) if _across(pieces[i]) > gap]
    at: dict[int, list[int]] = {}
    for i in np.flatnonzero(alive & ~closed).tolist():
        for end in node[i].tolist():
            at.setdefault(end, []).append(i)
    _refuse_loose_ends(at, node, ends.reshape(-1, 2, 2))
    left = alive & ~closed
    for first in np.flatnonzero(left).tolist():
        if left[first]:
            rows.append(_row(first, pieces, node, at, left))
    return rows


def _row(
    first: int,
    pieces: list[Piece],
    node: NDArray[np.int64],
    at: dict[int, list[int]],
    left: Flags,
) -> list[Piece]:
    row, i, end = [], first, int(node[first, 1])
    while True:
        left[i] = False
        row.append(pieces[i] if node[i, 1] == end else pieces[i].reversed)
        following = [j for j in at[end] if left[j]]
        if not following:
            return row
        i = following[0]
        end = int(node[i].sum() - end)


def _across(piece: Piece) -> float:
    return float(np.ptp(piece.points, axis=0).max())


def _first_of_each(pieces: list[Piece], node: NDArray[np.int64], gap: float) -> Flags:
    """Return flags that are false for pieces drawn twice, but for the first of them."""
    alive = np.ones(len(pieces), dtype=bool)
    seen: dict[tuple[int, int, int], list[Points]] = {}
    for i, piece in enumerate(pieces):
        low, high = sorted(node[i].tolist())
        points = piece.points if node[i, 0] == low else piece.points[::-1]
        others = seen.setdefault((low, high, len(points)), [])
        turned = points[::-1]
        if any(
            min(np.abs(points - other).max(), np.abs(turned - other).max()) <= gap
            for other in others
        ):
            alive[i] = False
        else:
            others.append(points)
    return alive


def _refuse_loose_ends(
    at: dict[int, list[int]], node: NDArray[np.int64], ends: NDArray[np.float64]
) -> None:
    for end, members in at.items():
        if len(members) == 2:
            continue
        i = members[0]
        x, y = ends[i, 0 if node[i, 0] == end else 1]
        if len(members) == 1:
            raise MeshError(
                f"the outline is open: a line ends at ({x:.6g}, {y:.6g}) and none continues there"
            )
        raise MeshError(
            f"{len(members)} lines meet at ({x:.6g}, {y:.6g}), so that it is not clear which "
            "is the outline"
        )


def _loop(chain: list[Piece], corner_angle: float, size: float) -> Loop | None:
    """Return a closed row as one ring and its corners; None if it has no extent."""
    points, flags = [], []
    for before, piece in zip([chain[-1], *chain[:-1]], chain, strict=True):
        turn = _angle(before.arrive, piece.leave)
        least = max(corner_angle, _SMOOTH) if before.curved or piece.curved else corner_angle
        points.append(piece.points[:-1])
        flags.append(np.concatenate([[turn > least], piece.corners[1:-1]]))
    ring, corners = np.concatenate(points), np.concatenate(flags)
    apart = np.abs(ring - np.roll(ring, 1, axis=0)).max(axis=1) > _SAME * size
    if apart.sum() < 3:
        return None
    # a point that goes hands its corner on to the one before it, which stays
    group = np.cumsum(apart) - 1  # -1, the last one, where the ring begins with a repeat
    kept = np.zeros(int(apart.sum()), dtype=bool)
    np.logical_or.at(kept, group, corners)
    return ring[apart], kept


def _angle(before: NDArray[np.float64], after: NDArray[np.float64]) -> float:
    across = before[0] * after[1] - before[1] * after[0]
    return abs(float(np.degrees(np.arctan2(across, before @ after))))


def _nested(loops: list[Loop]) -> list[Loop]:
    """Return the outline, then the holes; raise if there is not one outline."""
    if len(loops) > MAX_LOOPS:
        raise MeshError(
            f"it has {len(loops):,} loops, and {MAX_LOOPS:,} are the most that are read"
        )
    shapes = np.array([shapely.Polygon(points) for points, _ in loops])
    order = np.argsort([-_box_area(points) for points, _ in loops], kind="stable")
    shapely.prepare(shapes)
    first = shapely.points([points[0] for points, _ in loops])
    inside, _ = shapely.STRtree(shapes).query(first, predicate="within")
    depth = np.bincount(inside, minlength=len(loops))
    outer = int(order[0])
    beside = np.flatnonzero((depth == 0) & (np.arange(len(loops)) != outer))
    islands = np.flatnonzero(depth > 1)
    if len(islands):
        x, y = loops[int(islands[0])][0][0]
        raise MeshError(f"there is a separate outline inside a hole, at ({x:.6g}, {y:.6g})")
    rim = shapes[outer].boundary
    apart = [i for i in beside.tolist() if not shapes[i].boundary.intersects(rim)]
    if apart:
        x, y = loops[apart[0]][0][0]
        raise MeshError(
            f"there are {len(apart) + 1} separate outlines, one of them at ({x:.6g}, {y:.6g}); "
            "a mesh is made of one"
        )
    return [loops[outer], *(loop for i, loop in enumerate(loops) if i != outer)]


def _box_area(points: Points) -> float:
    return float(np.prod(np.ptp(points, axis=0)))
