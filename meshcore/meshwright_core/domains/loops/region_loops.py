"""The regions of a domain between loops of curves: checks, orientation, sides, interfaces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.curves.curve import Curve, polygon_area
from meshwright_core.domains.domain_json import chain_json
from meshwright_core.domains.loops.meetings import refuse_meetings
from meshwright_core.domains.loops.near_pairs import pairs_near
from meshwright_core.domains.loops.planar_graph import ANCHOR, PlanarGraph, Side
from meshwright_core.domains.loops.shared_pieces import cut_at_ends, merged
from meshwright_core.domains.loops.side_pieces import (
    Piece,
    closed_chain,
    extent,
    reversed_chain,
    sampled_chains,
    samples,
)
from meshwright_core.errors import MeshError, capitalised

Points = NDArray[np.float64]
Flags = NDArray[np.bool_]
Loops = Sequence[Sequence[Curve]]

PREVIEW_TURN = 4.0
"""Degrees by which the polylines for pictures and estimates turn at each point."""


@dataclass(frozen=True)
class DomainRegion:
    """A region of a domain.

    Attributes:
        name: "" if it has none.
        area: exact.
        loops: its own curves, the region on their left.
        inside: (2,) a point of it.
        holes: how many.
        corners: points where the boundary of the region turns, or interfaces of others end.
    """

    name: str
    area: float
    loops: tuple[tuple[Curve, ...], ...]
    inside: Points
    holes: int
    corners: int


@dataclass(frozen=True)
class Interface:
    """A chain of curves between two regions, `left` and `right` of it; with its pieces' names."""

    curves: tuple[Curve, ...]
    names: tuple[str, ...]
    left: int
    right: int
    closed: bool


class RegionLoops:
    """The loops of one or several regions, checked and joined.

    Args:
        regions: the name and the loops of each.
        corner_angle: degrees.
        names: of the pieces of each loop of each region.
        labels: what messages call each loop of each region.

    Raises:
        MeshError: as :meth:`meshwright_core.domains.domain.Domain.from_regions`.

    Attributes:
        curve_step: degrees that an edge of a mesh turns along a curve, at most; None: as it comes.
        graph: all sides, and the geometric points.
        size: diagonal of the box around everything.
        loop_sides: the boundary loops: outlines, the largest first, then holes.
        outlines: how many of them are outlines.
        polylines, flags: points along the boundary loops, and which of them are corners.
    """

    def __init__(
        self,
        regions: Sequence[tuple[str, Loops]],
        corner_angle: float = CORNER_ANGLE,
        names: Sequence[Sequence[Sequence[str]]] | None = None,
        labels: Sequence[Sequence[str]] | None = None,
    ) -> None:
        """Close, turn and join the loops."""
        if not regions or not any(len(loops) for _, loops in regions):
            raise MeshError("A domain needs at least one loop of curves.")
        self.corner_angle = corner_angle
        self.curve_step: float | None = None
        self.region_names = tuple(str(name) for name, _ in regions)
        self.size = extent([loop for _, loops in regions for loop in loops])
        self._labels: list[list[str]] = []
        self._depths: list[list[int]] = []
        pieces: list[Piece] = []
        for number, (name, loops) in enumerate(regions):
            own = None if names is None else names[number]
            called = (
                _labels(name, number, len(loops), len(regions))
                if labels is None
                else labels[number]
            )
            chains = self._chains(number, loops, own, called)
            pieces += [piece for chain in chains for piece in chain]
        if len(regions) > 1:
            pieces = cut_at_ends(pieces, self.size)
        pieces = merged(pieces, self.size)
        self.graph = PlanarGraph(pieces, corner_angle)
        parts = self.graph.pieces
        refuse_meetings(
            [piece.curve for piece in parts],
            [piece.label for piece in parts],
            self.graph.ends,
            self.size,
        )
        loop_sides = [side for side in self.graph.sides if side.boundary]
        areas = [polygon_area(side.curves) for side in loop_sides]
        order = sorted(
            range(len(areas)), key=lambda i: (areas[i] < 0.0, -areas[i] if areas[i] > 0.0 else 0.0)
        )
        self.outlines = sum(area > 0.0 for area in areas)
        self.loop_sides: tuple[Side, ...] = tuple(loop_sides[i] for i in order)
        self._interface_sides = tuple(side for side in self.graph.sides if not side.boundary)
        self.regions = tuple(self._region(number) for number in range(len(regions)))
        self._refuse_overlaps()
        lines = self.side_polylines(PREVIEW_TURN)
        self.polylines: list[Points] = [points for points, _ in lines]
        self.flags: list[Flags] = [flags for _, flags in lines]

    def _chains(
        self,
        region: int,
        loops: Loops,
        names: Sequence[Sequence[str]] | None,
        labels: Sequence[str],
    ) -> list[list[Piece]]:
        """Closed chains of the loops of a region, the region on their left."""
        if names is not None and len(names) != len(loops):
            raise MeshError(f"Names of {len(names)} loops for a domain of {len(loops)}.")
        chains = []
        for i, (loop, label) in enumerate(zip(loops, labels, strict=True)):
            own = [""] * len(loop) if names is None else names[i]
            chains.append(closed_chain(loop, own, label, self.size))
        depths = _depths([[piece.curve for piece in chain] for chain in chains])
        self._labels.append(list(labels))
        self._depths.append(depths)
        found = []
        for chain, depth in zip(chains, depths, strict=True):
            outline = polygon_area([piece.curve for piece in chain]) > 0.0
            turned = chain if outline == (depth % 2 == 0) else reversed_chain(chain)
            # -1 is on the other side now, whichever way the chain runs
            found.append([Piece(p.curve, p.name, p.label, region, -1) for p in turned])
        return found

    def refuse_other_roles(self, outlines: Sequence[int]) -> None:
        """Raise MeshError unless the first loops of each region are its outlines."""
        for count, depths, labels in zip(outlines, self._depths, self._labels, strict=True):
            for i, (depth, label) in enumerate(zip(depths, labels, strict=True)):
                if i < count and depth % 2:
                    raise MeshError(f"{capitalised(label)} lies inside another loop.")
                if i >= count and depth == 0:
                    raise MeshError(f"{capitalised(label)} lies outside the outline.")
                if i >= count and depth % 2 == 0:
                    raise MeshError(f"{capitalised(label)} lies inside another hole.")

    def _region_loops(self, number: int) -> list[list[Piece]]:
        """The pieces around a region, chained to loops with the region on the left."""
        onward: dict[int, list[tuple[int, Piece]]] = {}
        for piece, (start, end) in zip(self.graph.pieces, self.graph.ends.tolist(), strict=True):
            if piece.left == number:
                onward.setdefault(start, []).append((end, piece))
            elif piece.right == number:
                onward.setdefault(end, []).append((start, piece.reversed))
        loops = []
        for first in list(onward):
            while onward.get(first):
                chain, node = [], first
                while onward.get(node):
                    node, piece = onward[node].pop(0)
                    chain.append(piece)
                    if node == first:
                        break
                loops.append(chain)
        return loops

    def _region(self, number: int) -> DomainRegion:
        loops = self._region_loops(number)
        curves = [tuple(piece.curve for piece in loop) for loop in loops]
        areas = [polygon_area(loop) for loop in curves]
        order = sorted(range(len(areas)), key=lambda i: -areas[i])
        lines = sampled_chains([curves[i] for i in order])
        rings, outlines = _rings(lines), sum(area > 0.0 for area in areas)
        holes = rings[outlines:]
        # a point in the hole: those of its rim may lie on the outline
        within = shapely.point_on_surface(shapely.polygons(holes))
        inner = holes[shapely.contains(shapely.polygons(rings[0]), within)]
        spot = shapely.make_valid(shapely.polygons(rings[0], inner)).representative_point()
        corners = sum(
            1
            for point in self.graph.points.values()
            if point.kind != ANCHOR and any(region == number for region, _ in point.sectors)
        )
        return DomainRegion(
            self.region_names[number],
            float(sum(areas)),
            tuple(curves[i] for i in order),
            np.array([spot.x, spot.y]),
            len(areas) - outlines,
            corners,
        )

    def _refuse_overlaps(self) -> None:
        """Raise MeshError if a region lies in another one; no two curves cross."""
        if len(self.regions) < 2:
            return
        owner = [j for j, region in enumerate(self.regions) for _ in region.loops]
        lines = sampled_chains([loop for region in self.regions for loop in region.loops])
        rings = shapely.make_valid(shapely.polygons(_rings(lines)))
        spots = shapely.points([region.inside for region in self.regions])
        inner, outer = pairs_near(spots, "within", others=rings)
        around = Counter(zip(inner.tolist(), [owner[k] for k in outer.tolist()], strict=True))
        for (i, j), times in sorted(around.items()):
            if i != j and times % 2:
                names = [self.region_names[k] or f"region {k}" for k in (i, j)]
                x, y = self.regions[i].inside
                raise MeshError(
                    f"The regions overlap: {names[0]} lies in {names[1]} near ({x:.6g}, {y:.6g})."
                )

    def side_polylines(self, turn_degrees: float) -> list[tuple[Points, Flags]]:
        """Points (n, 2) along each boundary loop, and which of them are corners or junctions."""
        lines = iter(samples([c for side in self.loop_sides for c in side.curves], turn_degrees))
        found = []
        for side in self.loop_sides:
            rows = [next(lines)[:-1] for _ in side.pieces]
            flags = np.zeros(sum(map(len, rows)), bool)
            start = 0
            for row, node in zip(rows, side.nodes[:-1], strict=True):
                point = self.graph.points.get(node)
                flags[start] = point is not None and point.kind != ANCHOR
                start += len(row)
            found.append((np.concatenate(rows), flags))
        return found

    @property
    def boundary(self) -> tuple[tuple[Curve, ...], ...]:
        """The curves of the boundary loops."""
        return tuple(side.curves for side in self.loop_sides)

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The curves between regions."""
        return tuple(
            Interface(
                side.curves,
                tuple(piece.name for piece in side.pieces),
                side.pieces[0].left,
                side.pieces[0].right,
                side.closed,
            )
            for side in self._interface_sides
        )

    @property
    def all_sides(self) -> tuple[Side, ...]:
        """The boundary loops, then the interfaces, in the order in which a mesh numbers them."""
        return (*self.loop_sides, *self._interface_sides)

    @property
    def has_curves(self) -> bool:
        """Whether any side bends otherwise than in a corner."""
        return any(not piece.curve.straight for piece in self.graph.pieces)

    def to_json(self) -> dict[str, Any]:
        """The loops as :meth:`meshwright_core.domains.domain.Domain.from_json` reads them."""
        content: dict[str, Any] = {}
        if self.corner_angle != CORNER_ANGLE:
            content["corner_angle"] = self.corner_angle
        if len(self.region_names) == 1 and not self.region_names[0]:
            loops = [
                chain_json(side.curves, [piece.name for piece in side.pieces])
                for side in self.loop_sides
            ]
            content.update(_roles(loops, self.outlines))
            return content
        content["regions"] = []
        for number, name in enumerate(self.region_names):
            chains = sorted(
                self._region_loops(number),
                key=lambda chain: -polygon_area([piece.curve for piece in chain]),
            )
            outlines = len(chains) - self.regions[number].holes
            loops = [
                chain_json([piece.curve for piece in chain], [piece.name for piece in chain])
                for chain in chains
            ]
            content["regions"].append({"name": name, **_roles(loops, outlines)})
        return content


def _roles(loops: list[Any], outlines: int) -> dict[str, Any]:
    first = {"outline": loops[0]} if outlines == 1 else {"outlines": loops[:outlines]}
    return {**first, "holes": loops[outlines:]}


def _labels(name: str, region: int, count: int, regions: int) -> list[str]:
    of = f" of region {name or region}" if regions > 1 else ""
    if count == 1:
        return [f"the outline{of}"]
    return [f"loop {i}{of}" for i in range(count)]


def _rings(lines: Sequence[Points]) -> NDArray[np.object_]:
    """Linear rings through points (n, 2) each."""
    owner = np.repeat(np.arange(len(lines)), [len(line) for line in lines])
    found: NDArray[np.object_] = shapely.linearrings(np.concatenate(lines), indices=owner)
    return found


def _depths(loops: Sequence[Sequence[Curve]]) -> list[int]:
    """How many of the loops each loop lies in; no two of them cross."""
    if len(loops) == 1:
        return [0]
    lines = sampled_chains(loops, 2.0)
    polygons = shapely.make_valid(shapely.polygons(_rings(lines)))
    spots = shapely.points([line[0] for line in lines])
    inner, outer = pairs_near(spots, "within", others=polygons)
    depths = np.bincount(inner[inner != outer], minlength=len(loops))
    found: list[int] = depths.tolist()
    return found
