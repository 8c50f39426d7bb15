"""Triangulations with few triangles between curved sides, for coarse starts of quad meshes."""

from __future__ import annotations

import math
from copy import copy
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.time_limit import check_time
from meshwright_core.domains.elements import chord_conflicts
from meshwright_core.domains.elements.cut_elements import CutElements
from meshwright_core.domains.elements.labelled_triangles import edge_keys, neighbours, regions_of
from meshwright_core.domains.elements.side_edges import SideEdges
from meshwright_core.domains.elements.sided_elements import SidedElements
from meshwright_core.domains.elements.triangulation import Bounds, triangle_areas, triangulated
from meshwright_core.domains.loops.near_pairs import pairs_near

Points = NDArray[np.float64]
Ids = NDArray[np.int64]
Reals = NDArray[np.float64]

GOOD = 0.01
"""Scaled Jacobian that the quads of a triangle with curved sides should have at least."""
PAIRED = 0.2
"""Scaled Jacobian of the quads of a pair of triangles, at least."""
_ROUNDS, _MOST_ROUNDS = 10, 20
_PATIENCE = 4
"""Rounds without a better result after which there are no more than usual."""
_SWEEPS = 8
_MANY_BAD = 1 << 60
_MANY = 400
"""Edges of sides beyond which the second way is not tried where the first one is good."""
_FLAT = 165.0
"""Degrees of a corner of a triangle beyond which it needs an edge through it."""
_APART = 0.7
"""Distance between two new points, in their distances from the sides, at least."""
_TAKEN = 1e-6
"""Distance from a vertex, in its distance from the sides, up to which a new point is that vertex.
"""
_BEND = np.radians(2.0)
"""An edge that turns by less is not cut for the sake of a triangle's shape."""


_SHARP = 0.03
"""Sine of the angle at the tip of a sliver, at most."""
_BLUNT = 0.06
"""That sine at the far end of a part of an edge that is cut because of slivers, about."""
_SLIVER_ROUNDS = 2
"""Rounds in which edges are cut for the sake of slivers."""
_NO_CUTS = (np.empty(0, int), np.empty(0, int))


class CoarseTriangles(NamedTuple):
    """Triangles on the edges of sides and on further points."""

    edges: SideEdges
    points: Points
    triangles: Ids
    regions: Ids

    def elements(self) -> SidedElements:
        """With the places of the vertices on the sides."""
        return SidedElements.of(*self)


def coarse_quads(edges: SideEdges, size: float, seed: int) -> SidedElements:
    """The triangles of :func:`coarse`, joined in pairs where these are well shaped; each pair is
    cut into four quads, and each triangle that stays alone into three.

    Pairs make fewer quads, and more regular vertices. Arguments as there.
    """
    found = coarse(edges, size, seed)
    shape = CutElements(found.edges, found.points)

    def qualities(quads: Ids) -> Reals:
        return shape.quad_shapes(quads) - PAIRED

    elements = found.elements()
    return elements.catmull_clark(*elements.paired(qualities)).without_doublets()


def coarse(edges: SideEdges, size: float, seed: int) -> CoarseTriangles:
    """Triangles on the coarse edges of sides, without a point inside where none is needed.

    Edges are flipped, points inserted and edges of sides cut while a triangle has an inverted quad,
    in two ways: with points where that helps, and with cuts there. What is best of all that is
    tried has the fewest bad triangles, then the fewest triangles. A long edge of a side beside
    which there are many small things is cut too: triangles from its ends would be slivers.

    Args:
        edges: of the sides; they are cut as needed.
        size: diameter of the domain.
        seed: as for :func:`.triangulation.triangulated`.
    """
    best = (_MANY_BAD, 0)
    for insert in (True, False):
        trial, inner, settled = copy(edges), np.empty((0, 2)), 0
        better = 0
        for turn in range(_MOST_ROUNDS):
            if turn >= max(_ROUNDS, better + _PATIENCE):
                break
            check_time()
            chord_conflicts.settle(trial, settled)
            settled = len(trial.side)
            points, triangles, regions = _triangulation(trial, inner, size, seed)
            shape = CutElements(trial, points)
            walls = edge_keys(trial.ends, len(points))
            quality = _flipped(shape, triangles, walls)
            at_slivers, counts = _NO_CUTS
            if turn < _SLIVER_ROUNDS:
                at_slivers, counts = _cuts_at_slivers(trial, points, triangles, walls)
            bad = int((quality < GOOD).sum()) + len(at_slivers)
            if (bad, len(triangles)) < best:
                best, better = (bad, len(triangles)), turn
                found = CoarseTriangles(copy(trial), points, triangles.copy(), regions)
            if not bad or (best[0] == 0 and len(triangles) > best[1]):
                break
            more, cuts = _remedy(shape, triangles, walls, quality, insert)
            inner = np.vstack([inner, more])
            cuts = np.setdiff1d(cuts, at_slivers)
            if len(cuts) or len(at_slivers):
                settled -= len(cuts) + len(at_slivers)
                twice = np.full(len(cuts), 2)
                trial.cut(np.append(cuts, at_slivers), np.append(twice, counts))
        unchanged = len(found.points) == len(edges.curve)
        if best[0] == 0 and (unchanged or len(edges.side) > _MANY):
            break
    return found


def _triangulation(
    edges: SideEdges, inner: Points, size: float, seed: int
) -> tuple[Points, Ids, Ids]:
    """Points, triangles and their regions between the edges, with the points `inner` (p, 2)."""
    given = np.vstack([edges.points, inner])
    found = triangulated(given, edges.ends, np.empty((0, 2)), size, Bounds(), seed)
    left, right = edges.left_right()
    regions = regions_of(found.triangles, len(given), edges.ends, left, right)
    own = regions >= 0
    return found.points, found.triangles[own], regions[own]


def _flipped(shape: CutElements, triangles: Ids, walls: Ids) -> Reals:
    """Flip edges of bad triangles, in place, where that helps; the shapes of all triangles."""
    quality = shape.shapes(triangles)
    count = len(shape.points)
    for _ in range(_SWEEPS):
        check_time()
        bad = quality < GOOD
        if not bad.any():
            break
        one, other, keys = neighbours(triangles, count)
        free = ~np.isin(keys, walls) & (bad[one // 3] | bad[other // 3])
        one, other = one[free], other[free]
        if not len(one):
            break
        apex = np.roll(triangles, -2, axis=1).ravel()
        a, b = triangles.ravel()[one], np.roll(triangles, -1, axis=1).ravel()[one]
        c, d = apex[one], apex[other]
        new = np.stack([np.stack([c, a, d], axis=1), np.stack([d, b, c], axis=1)], axis=1)
        areas = triangle_areas(shape.points, new.reshape(-1, 3)).reshape(-1, 2)
        after = shape.shapes(new.reshape(-1, 3)).reshape(-1, 2)
        after[areas <= 0.0] = -2.0
        before = np.stack([quality[one // 3], quality[other // 3]], axis=1)
        gain = (before < GOOD).sum(axis=1) - (after < GOOD).sum(axis=1)
        gain = gain + np.minimum(after.min(axis=1) - before.min(axis=1), 0.9)
        touched = np.zeros(len(triangles), bool)
        done = False
        for i in np.argsort(-gain, kind="stable").tolist():
            pair = [int(one[i]) // 3, int(other[i]) // 3]
            if gain[i] <= 1e-3 or after[i].min() <= before[i].min():
                continue
            if touched[pair].any():
                continue
            touched[pair] = done = True
            triangles[pair] = new[i]
            quality[pair] = after[i]
        if not done:
            break
    return quality


def _cuts_at_slivers(
    edges: SideEdges, points: Points, triangles: Ids, walls: Ids
) -> tuple[Ids, Ids]:
    """Edges of sides to cut, and in how many parts, where slivers fan out from an end of theirs.

    Such a sliver has no edge of a side but its shortest one: a thin triangle along a wall is as
    thin as the domain there.
    """
    corners = points[triangles]
    sides = np.roll(corners, -1, axis=1) - corners
    lengths = np.hypot(sides[..., 0], sides[..., 1])
    rows = np.arange(len(triangles))
    short = np.argmin(lengths, axis=1)
    one, other = (short + 1) % 3, (short + 2) % 3
    a, b = sides[rows, one], sides[rows, other]
    sine = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    thin = sine < _SHARP * lengths[rows, one] * lengths[rows, other]
    for side in (one, other):
        ends = np.column_stack([triangles[rows, side], triangles[rows, (side + 1) % 3]])
        thin &= ~np.isin(edge_keys(ends, len(points)), walls)
    if not thin.any():
        return _NO_CUTS
    leaving: dict[int, list[int]] = {}
    for edge, both in enumerate(edges.ends.tolist()):
        for vertex in both:
            leaving.setdefault(vertex, []).append(edge)
    reaches: dict[int, list[float]] = {}
    for row in np.flatnonzero(thin).tolist():
        tip = int(triangles[row, other[row]])
        way = 0.5 * (corners[row, short[row]] + corners[row, one[row]]) - points[tip]
        for edge in leaving.get(tip, []):
            # from the tip along the edge; the sine falls with the square of the distance
            along = points[edges.ends[edge].sum() - tip] - points[tip]
            length = float(np.hypot(*along))
            height = abs(float(along[0] * way[1] - along[1] * way[0])) / length
            # beside the edge, and not beyond its other end
            if height < float(along @ way) / length < length:
                base = float(lengths[row, short[row]])
                reaches.setdefault(edge, []).append(math.sqrt(height * base / _BLUNT) / length)
    cuts = []
    for edge, found in reaches.items():
        count = min(len(found) + 1.0, 1.0 / max(float(np.median(found)), 1e-9))
        cuts.append((edge, max(2, math.ceil(count))))
    table = np.array(cuts, int).reshape(-1, 2)
    return table[:, 0], table[:, 1]


def _remedy(
    shape: CutElements, triangles: Ids, walls: Ids, quality: Reals, insert: bool
) -> tuple[Points, Ids]:
    """Points to insert for bad triangles, and edges of sides to cut.

    A triangle with a straight angle needs an edge there: a point on its opposite side. Where a side
    bends into a triangle, and hides one end of it from the third corner, either it is cut, or a
    point is inserted where both ends see it, far from all sides; where that point is a vertex
    already, and has not helped, it is cut.

    insert: whether to insert points rather than cut, where both would do.
    """
    edges = shape.edges
    bad = np.flatnonzero(quality < GOOD)
    bad = bad[np.argsort(quality[bad], kind="stable")]
    corners = triangles[bad]
    sides = shape.side_edges(corners)
    turn = np.append(edges.turnings, 0.0)[sides]
    angles = shape.corner_angles(corners)
    flat = angles.max(axis=1) > _FLAT
    bends = np.argmax(turn, axis=1)
    bent = turn.max(axis=1) > _BEND
    rows = np.arange(len(bad))
    spots, clear = np.zeros((len(bad), 2)), np.zeros(len(bad))
    if insert:
        wanted = np.where(~flat & bent, sides[rows, bends], -1)
        spots, clear = shape.free_places(corners, bends, wanted)
        clear[_distances(spots, shape.points) <= _TAKEN * clear] = 0.0
    points: list[Points] = []
    cuts: set[int] = set()
    done: set[int] = set()
    near = _near(spots, _APART * clear)
    chosen, covered = np.zeros(len(bad), bool), np.zeros(len(bad), bool)
    for i in rows.tolist():
        if not flat[i] and bent[i]:
            if clear[i] <= 0.0:
                cuts.add(int(sides[i, bends[i]]))
            elif not covered[i] and not chosen[near[i]].any():
                points.append(spots[i])
                chosen[i] = True
                covered[near[i]] = True
            continue
        if any(int(v) in done for v in corners[i]):
            continue  # the triangles around a new point are looked at again first
        done.update(int(v) for v in corners[i])
        start = (int(np.argmax(angles[i])) + 1) % 3
        ends = corners[i][[start, (start + 1) % 3]]
        on_wall = np.isin(edge_keys(ends[None], len(shape.points)), walls)[0]
        points.append(shape.points[ends if flat[i] and not on_wall else corners[i]].mean(axis=0))
    return _new_points(points, shape.points), np.array(sorted(cuts), int)


def _new_points(points: list[Points], known: Points) -> Points:
    """The points as rows (n, 2), each once, without those that are among `known` already: the
    vertex of a flat triangle may lie in the middle of the side opposite.
    """
    grain = 1e-9 * np.ptp(known, axis=0).max()
    rows = np.array(points).reshape(-1, 2)
    first = np.unique(np.round(rows / grain), axis=0, return_index=True)[1]
    rows = rows[np.sort(first)]
    return rows[_distances(rows, known) > grain] if len(rows) else rows


def _near(points: Points, distances: Reals) -> list[Ids]:
    """Which of the points (n, 2) lie within the distance (n,) of each."""
    places = shapely.points(points)
    one, other = pairs_near(places, "dwithin", distances)
    order = np.argsort(one, kind="stable")
    return np.split(other[order], np.searchsorted(one[order], np.arange(1, len(points))))


def _distances(points: Points, others: Points) -> Reals:
    """(n,) the distance of each of the points (n, 2) from the nearest of the others."""
    tree = shapely.STRtree(shapely.points(others))
    found = tree.query_nearest(shapely.points(points), return_distance=True, all_matches=False)
    return found[1]
