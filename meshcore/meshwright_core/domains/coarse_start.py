"""Triangulations with few triangles between curved sides, for coarse starts of quad meshes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.domains import chord_conflicts
from meshwright_core.domains.curved_quads import CurvedTriangles
from meshwright_core.domains.labelled_triangles import edge_keys, neighbours, regions_of
from meshwright_core.domains.side_edges import SideEdges
from meshwright_core.domains.sided_elements import SidedElements
from meshwright_core.domains.triangulation import Bounds, triangle_areas, triangulated

Points = NDArray[np.float64]
Ids = NDArray[np.int64]
Reals = NDArray[np.float64]

GOOD = 0.01
"""Scaled Jacobian that the quads of a triangle with curved sides should have at least."""
_ROUNDS = 12
_SWEEPS = 8
_FLAT = 165.0
"""Degrees of a corner of a triangle beyond which it needs an edge through it."""
_BEND = np.radians(20.0)
"""An edge that turns by less is not cut for the sake of a triangle's shape."""


def coarse(edges: SideEdges, size: float, seed: int) -> SidedElements:
    """Triangles on the coarse edges of sides, without a point inside where none is needed.

    Edges are flipped, points inserted and edges of sides cut while a triangle has an inverted quad.
    What is best of all that is tried has the fewest bad triangles, then the fewest triangles.

    Args:
        edges: of the sides; they are cut as needed.
        size: diameter of the domain.
        seed: as for :func:`.triangulation.triangulated`.
    """
    inner = np.empty((0, 2))
    best: tuple[int, int] | None = None
    for _ in range(_ROUNDS):
        chord_conflicts.settle(edges)
        points, triangles, regions = _triangulation(edges, inner, size, seed)
        shape = CurvedTriangles(edges, points)
        walls = edge_keys(edges.ends, len(points))
        quality = _flipped(shape, triangles, walls)
        bad = quality < GOOD
        rank = (int(bad.sum()), len(triangles))
        if best is None or rank < best:
            best = rank
            found = SidedElements.of(edges, points, triangles, regions)
        if not bad.any():
            break
        inner = np.vstack([inner, _remedy(shape, triangles, walls, quality)])
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


def _flipped(shape: CurvedTriangles, triangles: Ids, walls: Ids) -> Reals:
    """Flip edges of bad triangles, in place, where that helps; the shapes of all triangles."""
    quality = shape.shapes(triangles)
    count = len(shape.points)
    for _ in range(_SWEEPS):
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


def _remedy(shape: CurvedTriangles, triangles: Ids, walls: Ids, quality: Reals) -> Points:
    """Points to insert for bad triangles; cuts edges that bend most where no point would help."""
    edges = shape.edges
    sides = shape.side_edges(triangles)
    turn = np.append(edges.turnings(), 0.0)[sides]
    keys = np.stack(
        [
            edge_keys(
                np.stack([triangles[:, i], triangles[:, (i + 1) % 3]], axis=1), len(shape.points)
            )
            for i in range(3)
        ],
        axis=1,
    )
    wall = np.isin(keys, walls)
    points: list[Points] = []
    cuts: set[int] = set()
    done: set[int] = set()
    for t in np.argsort(quality, kind="stable").tolist():
        if quality[t] >= GOOD:
            break
        corners = triangles[t]
        angles = shape.corner_angles(triangles[t : t + 1])[0]
        flat = int(np.argmax(angles))
        if angles[flat] <= _FLAT and turn[t].max() > _BEND:
            cuts.add(int(sides[t, int(np.argmax(turn[t]))]))
            continue
        if any(int(v) in done for v in corners):
            continue  # the triangles around a new point are looked at again first
        done.update(int(v) for v in corners)
        opposite = (flat + 1) % 3
        inside = not wall[t, opposite] and angles[flat] > _FLAT
        ends = corners[[opposite, (opposite + 1) % 3]] if inside else corners
        points.append(shape.points[ends].mean(axis=0))
    if cuts:
        edges.cut(np.array(sorted(cuts)))
    return np.array(points).reshape(-1, 2)
