"""A domain: a part of the plane between curves, with its corners and its regions."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike

from meshwright_core.core.irregularity import (
    CORNER_ANGLE,
    desired_between,
    usual_desired_degree,
)
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain_json import CurvedContent, load_json, parsed
from meshwright_core.domains.loops.region_loops import DomainRegion, Interface, RegionLoops
from meshwright_core.domains.loops.ring_checks import (
    Flags,
    Points,
    checked_flags,
    checked_ring,
    refuse_crossings,
    refuse_strays,
    signed_area,
    turning_angles,
)
from meshwright_core.domains.loops.side_bound import bound_excess_of_sides
from meshwright_core.errors import MeshError

__all__ = ["CORNER_ANGLE", "Domain", "Flags", "Points", "load_json", "turning_angles"]


class Domain:
    """A part of the plane, checked, in one orientation: a polygon with holes, or between curves.

    Outlines run counter-clockwise and holes clockwise, so that the domain always lies on the left.
    Domains of curves are made by :meth:`from_curves` and :meth:`from_regions`; of those, `outline`,
    `holes` and `loops` are polylines close to the curves, for pictures and estimates. In a polygon
    curved sides are polylines whose inner points are not corners.

    Args:
        outline: (n, 2) points in order, either orientation; a last point that repeats the first
            one (a closed ring, as in GeoJSON) is dropped.
        holes: one (m, 2) array for each hole, in the same form.
        corners: (n,) flags, true where an outline point is a corner (a geometric vertex). Left
            out: every point where the boundary turns by more than `corner_angle`.
        hole_corners: the same for each hole; an entry may be None.
        name: what to call the domain in titles.
        corner_angle: degrees.

    Raises:
        MeshError: for a ring of fewer than three points, a coordinate that is not a finite
            number, a repeated point, rings that cross or touch themselves or each other, a ring
            without area, a hole outside the outline or inside another hole, flags that do not fit.

    Attributes:
        outline: (n, 2) float64, counter-clockwise, read-only; the largest one if there are several.
        holes: tuple of (m, 2) float64, clockwise, read-only.
        corners: (n,) bool, read-only.
        hole_corners: tuple of (m,) bool, read-only.
        loops: all outlines, then the holes.
        loop_corners: the corner flags of the loops.
        name: str.
        sides: the curves with their regions and geometric points; None for a polygon.
    """

    def __init__(
        self,
        outline: ArrayLike,
        holes: Sequence[ArrayLike] = (),
        corners: ArrayLike | None = None,
        hole_corners: Sequence[ArrayLike | None] | None = None,
        name: str = "",
        corner_angle: float = CORNER_ANGLE,
    ) -> None:
        """Check the rings and turn them the usual way round."""
        names = ["the outline", *(f"hole {i}" for i in range(len(holes)))]
        hole_flags = [None] * len(holes) if hole_corners is None else list(hole_corners)
        if len(hole_flags) != len(holes):
            raise MeshError(f"{len(hole_flags)} lists of hole corners for {len(holes)} holes.")
        given = [corners, *hole_flags]
        loops = [
            checked_ring(ring, what) for ring, what in zip([outline, *holes], names, strict=True)
        ]
        flags = [
            checked_flags(flag, ring, loop, what)
            for flag, ring, loop, what in zip(given, [outline, *holes], loops, names, strict=True)
        ]
        refuse_crossings(loops, names)
        for i, loop in enumerate(loops):
            if (signed_area(loop) > 0) != (i == 0):
                loops[i] = loop[::-1].copy()
                flag = flags[i]
                flags[i] = None if flag is None else flag[::-1].copy()
        refuse_strays(loops, names)
        marked = [
            turning_angles(loop) > corner_angle if flag is None else flag
            for loop, flag in zip(loops, flags, strict=True)
        ]
        self.sides: RegionLoops | None = None
        self._set(name, loops, marked, 1)

    def _set(self, name: str, loops: list[Points], corners: list[Flags], outlines: int) -> None:
        for array in (*loops, *corners):
            array.flags.writeable = False
        self.name = name
        self.outlines = outlines
        """How many of the loops are outlines: the components of the domain."""
        self.loops: tuple[Points, ...] = tuple(loops)
        self.loop_corners: tuple[Flags, ...] = tuple(corners)

    @classmethod
    def from_curves(
        cls,
        loops: Sequence[Sequence[Curve]],
        name: str = "",
        corner_angle: float = CORNER_ANGLE,
        names: Sequence[Sequence[str]] | None = None,
    ) -> Domain:
        """The domain between loops of curves.

        Args:
            loops: the curves of each loop end to end, in any orientation; gaps below 1e-6 of the
                size are closed. Loops inside an odd number of others are holes; the others are
                outlines, of which there may be several.
            name: what to call the domain in titles.
            corner_angle: degrees by which the tangent turns at a corner; between curved pieces at
                least 1.
            names: of the pieces of each loop.

        Raises:
            MeshError: a loop that is not closed or without area, loops that cross or touch, a
                coordinate that is not a finite number, names that do not fit.
        """
        all_names = None if names is None else [names]
        return cls._of(RegionLoops([("", loops)], corner_angle, all_names), name)

    @classmethod
    def from_regions(
        cls,
        regions: Sequence[tuple[str, Sequence[Sequence[Curve]]]],
        name: str = "",
        corner_angle: float = CORNER_ANGLE,
        names: Sequence[Sequence[Sequence[str]]] | None = None,
    ) -> Domain:
        """The domain of several regions, which may touch along their sides.

        Where the loops of two regions run along each other, within 1e-6 of the size, is an
        interface.

        Args:
            regions: the name and the loops of each region, as for :meth:`from_curves`.
            name: as there.
            corner_angle: as there.
            names: of the pieces of each loop of each region.

        Raises:
            MeshError: as there; regions that overlap, or touch only in a point.
        """
        return cls._of(RegionLoops(regions, corner_angle, names), name)

    @classmethod
    def _of(cls, sides: RegionLoops, name: str) -> Domain:
        domain = cls.__new__(cls)
        domain.sides = sides
        domain._set(name, sides.polylines, sides.flags, sides.outlines)
        return domain

    @classmethod
    def from_json(
        cls,
        source: str | os.PathLike[str] | Mapping[str, Any],
        corner_angle: float = CORNER_ANGLE,
    ) -> Domain:
        """Read a domain from a JSON file, or from what such a file holds.

        The form is ``{"outline": LOOP, "holes": [LOOP, ...]}``, either orientation, with optional
        ``"name"``. A loop is a list of the corners of a polygon, ``[[x, y], ...]``, or of pieces
        end to end (:mod:`meshwright_core.curves.curve_json`), each with an optional ``"name"``. A
        domain of several parts has ``"outlines": [LOOP, ...]``, one of several regions
        ``"regions": [{"name": ..., "outline": LOOP, "holes": [LOOP, ...]}, ...]``. Corners are
        where the boundary turns by more than `corner_angle` degrees, or by more than
        ``"corner_angle"`` if that is more; for polygons ``"corners"`` (a list of booleans, one for
        each outline point) and ``"hole_corners"`` (such a list, or null, for each hole) state them.

        Raises:
            MeshError: the file is missing or not JSON (with the line), or its content is no
                domain; the message begins with the file's name.
        """
        if isinstance(source, Mapping):
            return cls._from_content(source, corner_angle)
        path = Path(source)
        content = load_json(path)
        try:
            domain = cls._from_content(content, corner_angle)
        except MeshError as error:
            raise MeshError(f"{path}: {error}") from error
        domain.name = domain.name or path.stem
        return domain

    @classmethod
    def _from_content(cls, content: Any, corner_angle: float) -> Domain:
        found = parsed(content)
        if isinstance(found, CurvedContent):
            angle = max(corner_angle, found.corner_angle)
            sides = RegionLoops(found.regions, angle, found.names, found.labels)
            sides.refuse_other_roles(found.outlines)
            return cls._of(sides, found.name)
        return cls(
            found.outline, found.holes, found.corners, found.hole_corners, found.name, corner_angle
        )

    def to_json(self) -> dict[str, Any]:
        """Return the domain as a dictionary that ``json.dump`` writes and `from_json` reads."""
        content: dict[str, Any] = {"name": self.name} if self.name else {}
        if self.sides is not None:
            content.update(self.sides.to_json())
            return content
        content["outline"] = self.outline.tolist()
        content["holes"] = [hole.tolist() for hole in self.holes]
        content["corners"] = self.corners.tolist()
        content["hole_corners"] = [flags.tolist() for flags in self.hole_corners]
        return content

    def flattened(self, turn_degrees: float) -> Domain:
        """A polygon whose sides turn by so many degrees at each point, at most, in place of curves.

        Its corners are those of this domain.

        Raises:
            MeshError: it has several outlines or regions, or its polylines cross.
        """
        if self.sides is None:
            return self
        if self.outlines > 1 or self.interfaces:
            raise MeshError("A domain of several parts or regions is no polygon.")
        loops = self.sides.side_polylines(turn_degrees)
        points, corners = [row for row, _ in loops], [flags for _, flags in loops]
        return Domain(points[0], points[1:], corners[0], corners[1:], self.name)

    @property
    def curve_step(self) -> float | None:
        """Degrees that an edge of a mesh turns along a curve, at most; None: about 90, and less
        where the shape demands it.
        """
        return None if self.sides is None else self.sides.curve_step

    @curve_step.setter
    def curve_step(self, degrees: float | None) -> None:
        if degrees is not None and not degrees > 0.0:
            raise MeshError(f"Curves cannot turn by {degrees:g} degrees along an edge.")
        if self.sides is not None:
            self.sides.curve_step = degrees

    @property
    def outline(self) -> Points:
        """The largest outline."""
        return self.loops[0]

    @property
    def corners(self) -> Flags:
        """The corner flags of `outline`."""
        return self.loop_corners[0]

    @property
    def holes(self) -> tuple[Points, ...]:
        """The holes."""
        return self.loops[self.outlines :]

    @property
    def hole_corners(self) -> tuple[Flags, ...]:
        """The corner flags of the holes."""
        return self.loop_corners[self.outlines :]

    @property
    def has_curves(self) -> bool:
        """Whether a side bends otherwise than in corners."""
        if self.sides is not None:
            return self.sides.has_curves
        return not all(flags.all() for flags in self.loop_corners)

    @cached_property
    def boundary(self) -> tuple[tuple[Curve, ...], ...]:
        """The curves of the loops, the domain on their left."""
        if self.sides is not None:
            return self.sides.boundary
        return tuple(
            tuple(Curve.line(a, b) for a, b in zip(loop, np.roll(loop, -1, axis=0), strict=True))
            for loop in self.loops
        )

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The curves between two regions."""
        return () if self.sides is None else self.sides.interfaces

    @cached_property
    def regions(self) -> tuple[DomainRegion, ...]:
        """The regions; one for a domain that is not divided."""
        if self.sides is not None:
            return self.sides.regions
        spot = self.polygon.representative_point()
        corners = sum(int(flags.sum()) for flags in self.loop_corners)
        inside = np.array([spot.x, spot.y])
        return (DomainRegion("", self.area, self.boundary, inside, len(self.holes), corners),)

    @property
    def polygon(self) -> shapely.Polygon | shapely.MultiPolygon:
        """The domain between its polylines as a shapely polygon."""
        if self.outlines == 1:
            return shapely.Polygon(self.outline, self.holes)
        found = shapely.Polygon()
        # the larger ones first: an island lies in a hole
        for number in sorted(
            range(len(self.loops)), key=lambda i: -abs(signed_area(self.loops[i]))
        ):
            ring = shapely.Polygon(self.loops[number])
            found = found.union(ring) if number < self.outlines else found.difference(ring)
        return found

    @cached_property
    def area(self) -> float:
        """The area, exact also between curves."""
        if self.sides is not None:
            return sum(region.area for region in self.sides.regions)
        return float(sum(signed_area(loop) for loop in self.loops))

    def optimum(self, kind: str) -> int:
        """s* of every mesh of the domain whose geometric vertices are those of the domain.

        The degrees of a mesh of k-sided elements add up to 2 E. With Euler's formula, V - E + F =
        chi, and k F = 2 E - B, for B boundary edges, the sum of the irregularities is the sum of
        usual less desired degree over the geometric vertices, less 4 chi (quads) or 6 chi
        (triangles). Where several regions meet, s* may be larger than its absolute value
        (:mod:`meshwright_core.core.score_bound`).

        Args:
            kind: "tri" or "quad".
        """
        k = 3 if kind == "tri" else 4
        euler = 2 * self.outlines - len(self.loops)
        excess = 0
        for boundary, angles in self._angles_at_points():
            excess += usual_desired_degree(k, boundary) - desired_between(angles, k, boundary)
        total = excess - (6 if k == 3 else 4) * euler
        return abs(total) + (0 if self.sides is None else bound_excess_of_sides(self.sides, k))

    def _angles_at_points(self) -> list[tuple[bool, list[float]]]:
        """Whether each geometric point is on the boundary, and the angles of regions there."""
        if self.sides is not None:
            points = self.sides.graph.points.values()
            return [(point.boundary, [angle for _, angle in point.sectors]) for point in points]
        found = []
        for loop, flags in zip(self.loops, self.loop_corners, strict=True):
            come = loop - np.roll(loop, 1, axis=0)
            go = np.roll(come, -1, axis=0)
            across = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0]
            angles = 180.0 - np.degrees(np.arctan2(across, (come * go).sum(axis=1)))
            found += [(True, [angle]) for angle in angles[flags].tolist()]
        return found

    @cached_property
    def diameter(self) -> float:
        """The largest distance between two points of the outlines (of their polylines)."""
        outlines = np.concatenate(self.loops[: self.outlines])
        hull = shapely.get_coordinates(shapely.convex_hull(shapely.MultiPoint(outlines)))
        hull = hull[:-1][::-1] if len(hull) > 3 else hull
        # the farthest two lie on parallel lines around the hull, one of them along an edge:
        # opposite to it is the point where the edges begin to run back
        angle = np.unwrap(np.arctan2(*np.diff(hull, axis=0, append=hull[:1]).T[::-1]))
        opposite = np.searchsorted(np.append(angle, angle + 2 * np.pi), angle + np.pi)
        ends = np.arange(len(hull))[:, None, None] + np.arange(2)[None, :, None]
        others = opposite[:, None, None] + np.arange(-1, 2)[None, None, :]
        apart = hull[ends % len(hull)] - hull[others % len(hull)]
        return float(np.sqrt((apart**2).sum(-1).max()))

    def __repr__(self) -> str:
        """Name and size of the domain."""
        if self.sides is not None:
            pieces = " and ".join(f"{len(loop)}" for loop in self.boundary)
            return f"<Domain {self.name!r}, loops of {pieces} curves>"
        sizes = " and ".join(f"{len(loop)}" for loop in self.loops)
        return f"<Domain {self.name!r}, loops of {sizes} points>"
