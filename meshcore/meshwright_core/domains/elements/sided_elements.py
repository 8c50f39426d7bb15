"""Triangles and quads between the sides of a domain, and the mesh that they make."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.composite_curves import Curves, place_all
from meshwright_core.core.irregularity import desired_between, usual_desired_degree
from meshwright_core.domains.elements import quadrangulation
from meshwright_core.domains.elements.labelled_triangles import edge_keys
from meshwright_core.domains.elements.side_edges import SideEdges
from meshwright_core.domains.loops.region_loops import RegionLoops
from meshwright_core.domains.loops.side_curves import mesh_boundary
from meshwright_core.mesh import HalfEdgeMesh

Points = NDArray[np.float64]
Ids = NDArray[np.int64]
Reals = NDArray[np.float64]


@dataclass(frozen=True)
class SidedElements:
    """Elements with the places of their vertices on the sides.

    Attributes:
        points: (n, 2).
        elements: (m, 3 or 4), counter-clockwise.
        regions: (m,).
        curve: (n,) side on which each vertex lies, -1 for none.
        parameter: (n,) where.
        node: (n,) the geometric point that each is, -1 for none.
        curves: the sides.
        side: (e,) the side of each edge of the elements that lies on one.
        span: (e, 2) the parameters of its ends, ascending.
        ends: (e, 2) its vertices.
    """

    points: Points
    elements: Ids
    regions: Ids
    curve: Ids
    parameter: Reals
    node: Ids
    curves: Curves
    side: Ids
    span: Reals
    ends: Ids

    @classmethod
    def of(cls, edges: SideEdges, points: Points, triangles: Ids, regions: Ids) -> SidedElements:
        """Triangles on the vertices of `edges` and further points."""
        more = len(points) - len(edges.curve)
        return cls(
            points, triangles, regions,
            np.append(edges.curve, np.full(more, -1)),
            np.append(edges.parameter, np.zeros(more)),
            np.append(edges.node, np.full(more, -1)),
            edges.curves, edges.side, edges.span, edges.ends,
        )  # fmt: skip

    def with_elements(self, elements: Ids, regions: Ids) -> SidedElements:
        """Other elements on the same vertices; those that no element has are dropped."""
        used = np.zeros(len(self.points), bool)
        used[elements] = True
        new = np.cumsum(used) - 1
        return SidedElements(
            self.points[used], new[elements], regions, self.curve[used], self.parameter[used],
            self.node[used], self.curves, self.side, self.span, new[self.ends],
        )  # fmt: skip

    def catmull_clark(self, blocks: Sequence[Ids], regions: Sequence[Ids]) -> SidedElements:
        """The elements of `blocks` cut into quads; midpoints of edges on sides lie on the curve.

        The centre of an element with such sides is the mean of the midpoints around it.
        """
        n = len(self.points)
        pairs, quads = quadrangulation.split_elements(n, blocks)
        middles = 0.5 * (self.points[pairs[:, 0]] + self.points[pairs[:, 1]])
        keys = pairs[:, 0] * n + pairs[:, 1]
        at = np.searchsorted(keys, edge_keys(self.ends, n))
        length = self.curves.stop[self.curves.first_span[1:] - 1][self.side]
        closed = self.curves.closed[self.side]
        t = self.span.mean(axis=1)
        t = np.where(closed & (t >= length), t - length, t)
        middles[at] = place_all(self.curves, self.side, t)[:, :2]
        curve, parameter = np.full(len(pairs), -1), np.zeros(len(pairs))
        curve[at], parameter[at] = self.side, t
        centres = []
        first = 0
        for block in blocks:
            m, k = block.shape
            own = quads[first : first + m * k, 1].reshape(m, k) - n
            first += m * k
            centre = self.points[block].mean(axis=1)
            beside = (curve[own] >= 0).any(axis=1)
            centre[beside] = middles[own[beside]].mean(axis=1)
            centres.append(centre)
        more = sum(len(block) for block in blocks)
        every = np.concatenate(
            [np.repeat(r, b.shape[1]) for r, b in zip(regions, blocks, strict=True)]
        )
        halves = 0.5 * self.span.sum(axis=1)
        return SidedElements(
            np.concatenate([self.points, middles, *centres]),
            quads,
            every,
            np.concatenate([self.curve, curve, np.full(more, -1)]),
            np.concatenate([self.parameter, parameter, np.zeros(more)]),
            np.concatenate([self.node, np.full(len(pairs) + more, -1)]),
            self.curves,
            np.tile(self.side, 2),
            np.concatenate(
                [
                    np.column_stack([self.span[:, 0], halves]),
                    np.column_stack([halves, self.span[:, 1]]),
                ]
            ),
            np.concatenate(
                [
                    np.column_stack([self.ends[:, 0], n + at]),
                    np.column_stack([n + at, self.ends[:, 1]]),
                ]
            ),
        )

    def paired(
        self, qualities: Callable[[Ids], Reals] | None = None
    ) -> tuple[list[Ids], list[Ids]]:
        """Quads of pairs of triangles of one region, and triangles left over, with regions.

        qualities: of quads, as for :func:`.quadrangulation.pair`.
        """
        quads, alone = [np.empty((0, 4), int)], [np.empty((0, 3), int)]
        labels: list[list[Ids]] = [[np.empty(0, int)], [np.empty(0, int)]]
        for region in np.unique(self.regions):
            own = self.elements[self.regions == region]
            pairs, rest = quadrangulation.pair(self.points, own, qualities)
            quads.append(pairs)
            alone.append(rest)
            labels[0].append(np.full(len(pairs), region))
            labels[1].append(np.full(len(rest), region))
        return [np.concatenate(quads), np.concatenate(alone)], [np.concatenate(x) for x in labels]

    def without_doublets(self) -> SidedElements:
        """Without interior vertices of two quads, those on interfaces excepted."""
        quads, rows = quadrangulation.merged_doublets(self.elements, self.curve >= 0)
        return self.with_elements(quads, self.regions[rows])

    def mesh(self, sides: RegionLoops) -> HalfEdgeMesh:
        """The half-edge mesh, its vertices on the curves of the domain."""
        vertex_at = {node: v for v, node in enumerate(self.node.tolist()) if node >= 0}
        return HalfEdgeMesh.from_elements(
            self.points,
            self.elements,
            self.node >= 0,
            self._desired(sides),
            boundary=mesh_boundary(sides, self.curves, vertex_at),
            seats=(self.curve, self.parameter),
            regions=self.regions,
        )

    def _desired(self, sides: RegionLoops) -> Ids:
        k = self.elements.shape[1]
        loops = len(sides.loop_sides)
        usual = [usual_desired_degree(k, boundary) for boundary in (False, True)]
        on_boundary = (self.curve >= 0) & (self.curve < loops)
        desired = np.where(on_boundary, usual[1], usual[0])
        for vertex in np.flatnonzero(self.node >= 0).tolist():
            point = sides.graph.points[int(self.node[vertex])]
            angles = [angle for _, angle in point.sectors]
            desired[vertex] = desired_between(angles, k, point.boundary)
        return desired
