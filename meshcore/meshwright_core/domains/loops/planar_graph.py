"""The sides of a domain as a planar graph: boundary loops, interfaces, and the points between them.

A *side* is a chain of curves that a mesh stores as one composite curve: a boundary loop, or the
interface of two regions between two junctions. Its geometric points are *corners* (the tangent
turns), *anchors* (smooth joints of a straight piece and a curved one, or of two with different
names) and *junctions* (more than two pieces meet).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from meshwright_core.curves.curve import Curve
from meshwright_core.domains.loops.side_pieces import (
    Piece,
    angle_at_corner,
    cut_at_corners,
    end_directions,
    is_smooth_piece,
    turn_between,
)
from meshwright_core.errors import MeshError

Points = NDArray[np.float64]

CORNER, ANCHOR, JUNCTION = "corner", "anchor", "junction"
_TIE = 1e-4
"""Degrees below which two directions at a point are told apart by where their curves go."""


@dataclass(frozen=True)
class Side:
    """A composite curve of the domain.

    Attributes:
        pieces: end to end; of a boundary loop the domain is on the left.
        closed: whether it has no ends: all boundary loops, and interfaces without junction.
        nodes: (n + 1,) the points of the graph where the pieces begin, and where the last one ends.
    """

    pieces: tuple[Piece, ...]
    closed: bool
    nodes: tuple[int, ...]

    @property
    def boundary(self) -> bool:
        """Whether it is a boundary loop."""
        return self.pieces[0].right < 0

    @property
    def curves(self) -> tuple[Curve, ...]:
        """The curves of its pieces."""
        return tuple(piece.curve for piece in self.pieces)


@dataclass(frozen=True)
class GeometricPoint:
    """A point that is a vertex of every mesh.

    Attributes:
        place: (2,).
        kind: "corner", "anchor" or "junction".
        sectors: region and angle in degrees between each two pieces, without the outside.
        boundary: whether it lies on the boundary.
    """

    place: Points
    kind: str
    sectors: tuple[tuple[int, float], ...]
    boundary: bool


class PlanarGraph:
    """Sides and geometric points of a domain.

    Args:
        pieces: with exact ends, the region on the left; interfaces occur once.
        corner_angle: degrees by which the boundary turns at a corner.

    Attributes:
        sides: boundary loops, then interfaces.
        points: the geometric points, by their number among `Side.nodes`.
        places: (n, 2) of all nodes, geometric or not.
    """

    def __init__(self, pieces: Sequence[Piece], corner_angle: float) -> None:
        self.pieces = [part for piece in pieces for part in cut_at_corners(piece, corner_angle)]
        ends = np.array([[piece.curve.start, piece.curve.end] for piece in self.pieces])
        self.places, number = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
        self.ends: NDArray[np.int64] = number.reshape(-1, 2)
        # the pieces that leave each node, as (piece, whether it ends there)
        self._leaving: list[list[tuple[int, bool]]] = [[] for _ in self.places]
        for i, (start, end) in enumerate(self.ends.tolist()):
            self._leaving[start].append((i, False))
            self._leaving[end].append((i, True))
        self._directions = end_directions([piece.curve for piece in self.pieces])
        self.points: dict[int, GeometricPoint] = {}
        for node in range(len(self.places)):
            point = self._point(node, corner_angle)
            if point is not None:
                self.points[node] = point
        self.sides = (*self._loops(), *self._interfaces())

    # Geometric points

    def _away(self, leaving: tuple[int, bool]) -> Points:
        piece, ends_here = leaving
        directions: Points = self._directions[piece]
        return -directions[1] if ends_here else directions[0]

    def _left(self, leaving: tuple[int, bool]) -> int:
        piece = self.pieces[leaving[0]]
        return piece.right if leaving[1] else piece.left

    def _ahead(self, leaving: tuple[int, bool], node: int) -> Points:
        """Direction to a point a little further on."""
        curve = self.pieces[leaving[0]].curve
        t = 0.02 * curve.length
        way: Points = curve.point(curve.length - t if leaving[1] else t) - self.places[node]
        return way

    def _angle(self, one: tuple[int, bool], other: tuple[int, bool], node: int) -> float:
        """Degrees from one piece to another one counter-clockwise, in [0, 360]."""
        angle = turn_between(self._away(one), self._away(other)) % 360.0
        if _TIE < angle < 360.0 - _TIE:
            return angle
        way = turn_between(self._ahead(one, node), self._ahead(other, node))
        return 0.0 if way > 0.0 else 360.0

    def _point(self, node: int, corner_angle: float) -> GeometricPoint | None:
        leaving = self._leaving[node]
        first = leaving[0]
        around = sorted(
            ((self._angle(first, other, node), other) for other in leaving[1:]),
            key=lambda pair: pair[0],
        )
        order = [first, *(other for _, other in around)]
        at = [0.0, *(angle for angle, _ in around), 360.0]
        sectors = tuple((self._left(piece), at[i + 1] - at[i]) for i, piece in enumerate(order))
        outside = [i for i, (region, _) in enumerate(sectors) if region < 0]
        if len(outside) > 1:
            x, y = self.places[node]
            raise MeshError(f"Parts of the domain touch only in the point ({x:.6g}, {y:.6g}).")
        kind = self._kind(node, corner_angle)
        if kind is None:
            return None
        inside = tuple(sector for sector in sectors if sector[0] >= 0)
        return GeometricPoint(self.places[node], kind, inside, bool(outside))

    def _kind(self, node: int, corner_angle: float) -> str | None:
        leaving = self._leaving[node]
        if len(leaving) != 2:
            return JUNCTION
        one, other = (self.pieces[piece].curve for piece, _ in leaving)
        turn = abs(turn_between(-self._away(leaving[0]), self._away(leaving[1])))
        if turn > angle_at_corner(one, other, corner_angle):
            return CORNER
        straight = [curve.straight for curve in (one, other)]
        if any(straight) and (is_smooth_piece(one) or is_smooth_piece(other)):
            return ANCHOR
        # the edges on both sides of a change of names are to have one each
        return ANCHOR if len({self.pieces[piece].name for piece, _ in leaving}) > 1 else None

    # Sides

    def _loops(self) -> list[Side]:
        """Boundary loops, each begun at its first geometric point."""
        onward = {
            start: i for i, (start, _) in enumerate(self.ends.tolist()) if self.pieces[i].right < 0
        }
        loops = []
        for first in sorted(onward, key=lambda node: (node not in self.points, onward[node])):
            chain, node = [], first
            while node in onward:
                chain.append((onward.pop(node), False))
                node = int(self.ends[chain[-1][0], 1])
            if chain:
                loops.append((min(chain), self._side(chain, True)))
        return [side for _, side in sorted(loops, key=lambda pair: pair[0])]

    def _interfaces(self) -> list[Side]:
        """Chains of pieces between two regions, from junction to junction or closed."""
        pending = {i for i, piece in enumerate(self.pieces) if piece.right >= 0}
        sides = []
        # junctions first: a chain must not begin in its middle; then geometric points
        order = sorted(
            range(len(self.places)),
            key=lambda node: (len(self._leaving[node]) == 2, node not in self.points),
        )
        for first in order:
            for leaving in self._leaving[first]:
                chain, node = [], first
                while leaving[0] in pending:
                    pending.discard(leaving[0])
                    chain.append(leaving)
                    piece, backward = leaving
                    node = int(self.ends[piece, 0 if backward else 1])
                    if len(self._leaving[node]) != 2:
                        break
                    arrival = (piece, not backward)
                    leaving = next(way for way in self._leaving[node] if way != arrival)
                if chain:
                    closed = node == first and len(self._leaving[node]) == 2
                    sides.append(self._side(chain, closed))
        return sides

    def _side(self, chain: Sequence[tuple[int, bool]], closed: bool) -> Side:
        """A side of pieces that lie end to end, each with whether it is run through backwards."""
        pieces, nodes = [], []
        for number, backward in chain:
            piece = self.pieces[number]
            pieces.append(piece.reversed if backward else piece)
            nodes.append(int(self.ends[number, 1 if backward else 0]))
        last, backward = chain[-1]
        nodes.append(int(self.ends[last, 0 if backward else 1]))
        if not -1 < pieces[0].left < pieces[0].right and pieces[0].right >= 0:
            pieces = [piece.reversed for piece in reversed(pieces)]
            nodes.reverse()
        return Side(tuple(pieces), closed, tuple(nodes))
