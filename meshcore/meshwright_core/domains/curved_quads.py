"""Shape of the quads that triangles with curved sides are cut into.

A triangle of corners a, b, c is cut through the middles of its sides and a centre. Each quad has
two curved sides at most: the halves of the triangle's sides at its corner. It is the image of the
unit square under its Coons map, which is looked at on a grid.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.composite_curves import place_all, tangents
from meshwright_core.domains.side_edges import STRAIGHT, SideEdges
from meshwright_core.domains.triangulation import triangle_areas

Points = NDArray[np.float64]
Ids = NDArray[np.int64]
Reals = NDArray[np.float64]

GRID = np.linspace(0.0, 1.0, 6)
"""Fractions along both directions at which the Jacobian of the Coons map is taken."""


class CurvedTriangles:
    """Triangles some of whose sides are edges of the domain's sides.

    Args:
        edges: cut so that every edge is a side of triangles.
        points: (n, 2) of all vertices, those of the edges first.
    """

    def __init__(self, edges: SideEdges, points: Points) -> None:
        self.points, self.edges = points, edges
        bent = np.flatnonzero(edges.turnings() > STRAIGHT)
        low, high = np.sort(edges.ends[bent], axis=1).T
        keys = low * len(points) + high
        order = np.argsort(keys)
        self._keys, self._bent = keys[order], bent[order]

    def side_edges(self, triangles: Ids) -> Ids:
        """(m, 3) the bent edge that each side is, from corner i to i + 1; -1 for straight ones."""
        start, end = triangles, np.roll(triangles, -1, axis=1)
        key = np.minimum(start, end) * len(self.points) + np.maximum(start, end)
        found = np.full(triangles.shape, -1)
        if len(self._keys):
            at = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
            found = np.where(self._keys[at] == key, self._bent[at], -1)
        return found

    def shapes(self, triangles: Ids) -> Reals:
        """(m,) the least scaled Jacobian of the three quads of each triangle (m, 3).

        1 for triangles without curved sides that are not upside down: their quads never are.
        """
        sides = self.side_edges(triangles)
        plain = (sides < 0).all(axis=1)
        found = np.where(triangle_areas(self.points, triangles) > 0.0, 1.0, -1.0)
        bent = np.flatnonzero(~plain)
        if len(bent):
            found[bent] = self._curved_shapes(triangles[bent], sides[bent])
        return found

    def _curved_shapes(self, triangles: Ids, sides: Ids) -> Reals:
        place, slope = self._halves(triangles, sides)
        middle = place[:, :, 0, -1]
        centre = middle.mean(axis=1)
        worst = np.full(len(triangles), np.inf)
        for corner in range(3):
            before = corner - 1
            # along the first half of this side, and backwards along the second half of the last
            first, first_slope = place[:, corner, 0], slope[:, corner, 0]
            last, last_slope = place[:, before, 1], slope[:, before, 1]
            quads = np.stack(
                [self.points[triangles[:, corner]], middle[:, corner], centre, middle[:, before]],
                axis=1,
            )
            worst = np.minimum(
                worst, _scaled_jacobians(quads, first, first_slope, last, last_slope)
            )
        return worst

    def corner_angles(self, triangles: Ids) -> Reals:
        """(m, 3) degrees between the sides of triangles (m, 3) at each corner, in (-180, 180]."""
        _, slope = self._halves(triangles, self.side_edges(triangles))
        ahead = slope[:, :, 0, 0]
        back = np.roll(slope[:, :, 1, 0], 1, axis=1)
        across = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
        along = (ahead * back).sum(axis=-1)
        angles: Reals = np.degrees(np.arctan2(across, along))
        # a hair over a straight angle
        return np.where(angles < -150.0, angles + 360.0, angles)

    def _halves(self, triangles: Ids, sides: Ids) -> tuple[Points, Points]:
        """Points (m, 3, 2, g, 2) of the halves of sides at GRID, from corners to middles, and the
        derivatives by GRID.
        """
        corners = self.points[triangles]
        ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2)
        middle = ends.mean(axis=2)
        way = middle[:, :, None] - ends
        place = ends[:, :, :, None] + GRID[:, None] * way[:, :, :, None]
        slope = np.broadcast_to(way[:, :, :, None], place.shape).copy()
        which = np.nonzero(sides >= 0)
        if len(which[0]):
            edge = sides[which]
            edges = self.edges
            backward = edges.ends[edge, 0] != triangles[which]
            low, high = edges.span[edge].T
            start, stop = np.where(backward, high, low), np.where(backward, low, high)
            for half, (a, b) in enumerate(((start, stop), (stop, start))):
                reach = 0.5 * (b - a)
                t = a[:, None] + reach[:, None] * GRID
                curve = np.repeat(edges.side[edge], len(GRID))
                # derivatives at ends from inside: there may be a corner
                inner = a[:, None] + reach[:, None] * np.clip(GRID, 1e-6, None)
                found = place_all(edges.curves, curve, t.ravel())[:, :2]
                step = tangents(edges.curves, curve, inner.ravel())[:, :2]
                place[which[0], which[1], half] = found.reshape(-1, len(GRID), 2)
                slope[which[0], which[1], half] = (
                    step.reshape(-1, len(GRID), 2) * reach[:, None, None]
                )
        return place, slope


def _scaled_jacobians(
    quads: Points, first: Points, first_slope: Points, last: Points, last_slope: Points
) -> Reals:
    """(m,) least J / (|S_u| |S_v|) on the grid of Coons maps.

    quads: (m, 4, 2); the side from corner 0 to 1 is `first` (m, g, 2) at GRID, that from corner 0
    to 3 is `last`; the other two are straight.
    """
    p0, p1, p2, p3 = (quads[:, i, None, None] for i in range(4))
    u, v = GRID[None, :, None, None], GRID[None, None, :, None]
    c, dc = first[:, :, None], first_slope[:, :, None]
    d, dd = last[:, None, :], last_slope[:, None, :]
    opposite = p3 + u * (p2 - p3)
    right = p1 + v * (p2 - p1)
    su = (1 - v) * dc + v * (p2 - p3) + right - d
    su = su - ((1 - v) * (p1 - p0) + v * (p2 - p3))
    sv = opposite - c + (1 - u) * dd + u * (p2 - p1)
    sv = sv - ((1 - u) * (p3 - p0) + u * (p2 - p1))
    jacobian = su[..., 0] * sv[..., 1] - su[..., 1] * sv[..., 0]
    size = np.linalg.norm(su, axis=-1) * np.linalg.norm(sv, axis=-1)
    found: Reals = (jacobian / np.maximum(size, 1e-300)).reshape(len(quads), -1).min(axis=1)
    return found
