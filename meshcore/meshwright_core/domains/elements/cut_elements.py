"""Shape of the quads that elements with curved sides are cut into.

A triangle or quad is cut through the middles of its sides and a centre. Each of the new quads has
two curved sides at most: the halves of the element's sides at its corner. Its shape is that of its
Coons map at the samples of :mod:`meshwright_core.geometry.coons`.
"""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.composite_curves import place_all
from meshwright_core.core.time_limit import check_time
from meshwright_core.domains.elements.side_edges import SAMPLES, STRAIGHT, SideEdges
from meshwright_core.domains.elements.triangulation import triangle_areas
from meshwright_core.geometry.coons import SAMPLES as COONS_SAMPLES
from meshwright_core.geometry.coons import CurvedElements, curved_corners
from meshwright_core.geometry.quality import straight_corners

Points = NDArray[np.float64]
Ids = NDArray[np.int64]
Reals = NDArray[np.float64]

_HALVINGS = 14
_TOUCH = 0.03
"""Share of a circle's radius that its distance from sampled sides may be short of it."""
_SURE = 1e-9
_UP = np.array([0.0, 0.0, 1.0])
_SEEN = 0.15
"""Sine of the angle at an end of an edge, from the edge to a point that sees it well."""


class CutElements:
    """Triangles and quads some of whose sides are edges of the domain's sides.

    Args:
        edges: cut so that every edge is a side of elements.
        points: (n, 2) of all vertices, those of the edges first.
    """

    def __init__(self, edges: SideEdges, points: Points) -> None:
        self.points, self.edges = points, edges
        bent = np.flatnonzero(edges.turnings > STRAIGHT)
        low, high = np.sort(edges.ends[bent], axis=1).T
        keys = low * len(points) + high
        order = np.argsort(keys)
        self._keys, self._bent = keys[order], bent[order]

    def side_edges(self, elements: Ids) -> Ids:
        """(m, k) the bent edge that each side is, from corner i to i + 1; -1 for straight ones."""
        start, end = elements, np.roll(elements, -1, axis=1)
        key = np.minimum(start, end) * len(self.points) + np.maximum(start, end)
        found = np.full(elements.shape, -1)
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
            found[bent] = self._cut_shapes(triangles[bent], sides[bent])
        return found

    def quad_shapes(self, quads: Ids) -> Reals:
        """(m,) the least scaled Jacobian of the four quads of each quad (m, 4)."""
        sides = self.side_edges(quads)
        bent = (sides >= 0).any(axis=1)
        found = self._plain_shapes(quads)
        if bent.any():
            found[bent] = self._cut_shapes(quads[bent], sides[bent])
        return found

    def _plain_shapes(self, quads: Ids) -> Reals:
        """The same for straight sides."""
        corners = self.points[quads]
        middles = 0.5 * (corners + np.roll(corners, -1, axis=1))
        centres = np.broadcast_to(middles.mean(axis=1)[:, None], corners.shape)
        parts = np.stack([corners, middles, centres, np.roll(middles, 1, axis=1)], axis=2)
        sines = straight_corners(parts.reshape(-1, 4, 2), _UP).sine
        found: Reals = sines.reshape(len(quads), 16).min(axis=1)
        return found

    def _cut_shapes(self, elements: Ids, sides: Ids) -> Reals:
        (count, k), n = elements.shape, len(self.points)
        middles = 0.5 * (self.points[elements] + self.points[np.roll(elements, -1, axis=1)])
        row, corner = np.nonzero(sides >= 0)
        edge = sides[row, corner]
        span = self._spans(elements[row, corner], edge)
        half = span.mean(axis=1)
        middles[row, corner] = place_all(self.edges.curves, self.edges.side[edge], half)[:, :2]
        points = np.concatenate([self.points, middles.reshape(-1, 2), middles.mean(axis=1)])
        # one quad at each corner: the middles of the sides from and to it, and the centre
        middle = n + np.arange(k * count).reshape(count, k)
        centre = np.broadcast_to(n + k * count + np.arange(count)[:, None], (count, k))
        quads = np.stack([elements, middle, centre, np.roll(middle, 1, axis=1)], axis=2)
        number = np.full((count, k, 4), -1)
        number[row, corner, 0] = np.arange(len(row))
        number[row, (corner + 1) % k, 3] = len(row) + np.arange(len(row))
        base = np.concatenate(
            [np.column_stack([span[:, 0], half]), np.column_stack([half, span[:, 1]])]
        )
        sines, _ = self._corners(
            points, quads.reshape(-1, 4), number.reshape(-1, 4), np.tile(edge, 2), base
        )
        found: Reals = sines.reshape(count, 4 * k).min(axis=1)
        return found

    def corner_angles(self, triangles: Ids) -> Reals:
        """(m, 3) degrees between the sides of triangles (m, 3) at each corner, in (-180, 180]."""
        sides = self.side_edges(triangles)
        row, corner = np.nonzero(sides >= 0)
        edge = sides[row, corner]
        number = np.full(sides.shape, -1)
        number[row, corner] = np.arange(len(row))
        span = self._spans(triangles[row, corner], edge)
        angles: Reals = np.degrees(self._corners(self.points, triangles, number, edge, span)[1])
        # a hair over a straight angle
        return np.where(angles < -150.0, angles + 360.0, angles)

    def free_places(self, triangles: Ids, corners: Ids, edges: Ids) -> tuple[Points, Reals]:
        """For an edge of each triangle, a point in the middle between it and what is opposite.

        That is the centre of the largest circle that touches the edge in its middle, from inside
        the triangle, and no other side of the domain.

        Args:
            triangles: (m, 3).
            corners: (m,) the corner at which that side of the triangle begins.
            edges: (m,) which edge it is; -1 for none.

        Returns:
            the points (m, 2) and the radii (m,) of the circles; 0 where an end of the edge does
            not see the point.
        """
        radius = np.zeros(len(triangles))
        rows = np.flatnonzero(edges >= 0)
        if not len(rows):
            return np.zeros((len(triangles), 2)), radius
        own = edges[rows]
        begin = triangles[rows, corners[rows]]
        places = self.edges.places(own, SAMPLES)
        backward = self.edges.ends[own, 0] != begin
        places[backward] = places[backward][:, ::-1]
        half = len(SAMPLES) // 2
        way = places[:, half + 1] - places[:, half - 1]
        normal = np.column_stack([-way[:, 1], way[:, 0]]) / np.linalg.norm(way, axis=1)[:, None]
        shapes = self.edges.places(np.arange(len(self.edges.side)), SAMPLES)
        tree = shapely.STRtree(shapely.linestrings(shapes))
        low = np.zeros(len(rows))
        high = np.full(len(rows), float(np.ptp(self.points, axis=0).max()))
        # points of sides rule out most of the larger circles: the corners of the triangle first,
        # then those of a side that has been found too near once
        on_sides = triangles[rows, :, None] < len(self.edges.curve)
        corner_points = np.where(on_sides, self.points[triangles[rows]], np.inf)
        known = np.full((len(rows), len(SAMPLES), 2), np.inf)
        known = np.concatenate([corner_points, known], axis=1)
        for _ in range(_HALVINGS):
            check_time()
            middle = 0.5 * (low + high)
            spots = places[:, half] + middle[:, None] * normal
            reach = (1.0 - _TOUCH) * middle
            away = np.hypot(*np.moveaxis(known - spots[:, None], 2, 0)).min(axis=1)
            clear = np.zeros(len(rows), bool)
            open_ = np.flatnonzero(away >= (1.0 - _SURE) * reach)
            (which, side), distance = tree.query_nearest(
                shapely.points(spots[open_]), return_distance=True, all_matches=False
            )
            known[open_[which], 3:] = shapes[side]
            clear[open_[which]] = distance >= reach[open_[which]]
            low, high = np.where(clear, middle, low), np.where(clear, high, middle)
        found = np.zeros((len(triangles), 2))
        found[rows] = places[:, half] + low[:, None] * normal
        # both ends see it if it is on the inner side of the tangents there
        seen = np.ones(len(rows), bool)
        for end, inner in ((0, 1), (-1, -2)):
            tangent = (places[:, inner] - places[:, end]) * (1.0 if end == 0 else -1.0)
            to = found[rows] - places[:, end]
            height = (tangent[:, 0] * to[:, 1] - tangent[:, 1] * to[:, 0]) / (
                np.linalg.norm(tangent, axis=1) * np.maximum(np.linalg.norm(to, axis=1), 1e-300)
            )
            seen &= height > _SEEN
        radius[rows] = np.where(seen, low, 0.0)
        return found, radius

    def _spans(self, begin: Ids, edge: Ids) -> Reals:
        """(r, 2) the parameters of edges (r,) from the vertices `begin` (r,) on."""
        span = self.edges.span[edge]
        backward = self.edges.ends[edge, 0] != begin
        return np.where(backward[:, None], span[:, ::-1], span)

    def _corners(
        self, points: Points, elements: Ids, sides: Ids, edge: Ids, span: Reals
    ) -> tuple[Reals, Reals]:
        """Sines and angles (m, k) as :func:`.geometry.coons.curved_corners` gives them.

        points (n, 2); elements (m, k); sides (m, k): rows of `edge` and `span`, -1 if straight.
        """
        rows = np.arange(len(elements))
        table = CurvedElements(
            curves=self.edges.curves,
            samples=COONS_SAMPLES[elements.shape[1]],
            elements=np.ascontiguousarray(elements, np.int64),
            element=rows,
            row=rows,
            sides=np.ascontiguousarray(sides, np.int64),
            curve=np.asarray(self.edges.side[edge], np.int64),
            base=np.ascontiguousarray(span, np.float64),
            parameter=np.zeros(len(points)),
        )
        flat = np.column_stack([points, np.zeros(len(points))])
        up = np.broadcast_to([0.0, 0.0, 1.0], (len(elements), 3)).copy()
        sines, angles = curved_corners(table, flat, up)
        return sines, angles
