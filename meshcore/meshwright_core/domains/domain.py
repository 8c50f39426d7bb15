"""A domain: the outline of a polygon, its holes, and which of their points are corners."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from meshwright_core.errors import MeshError, capitalised

Points = NDArray[np.float64]
Flags = NDArray[np.bool_]

CORNER_ANGLE = 0.01
"""Degrees by which the boundary must turn at a point before it counts as a corner."""

_NEAR = 1e-10
"""Neighbouring points nearer than this share of the domain's size are one point twice."""

_LARGEST = 1e100
"""Coordinates beyond this would overflow in areas and in-circle tests."""


class Domain:
    """A polygon with holes, checked, in one orientation.

    The outline runs counter-clockwise and the holes clockwise, so that the domain always lies on
    the left. Curved sides are polylines whose inner points are not corners.

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
        outline: (n, 2) float64, counter-clockwise, read-only.
        holes: tuple of (m, 2) float64, clockwise, read-only.
        corners: (n,) bool, read-only.
        hole_corners: tuple of (m,) bool, read-only.
        name: str.
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
        loops = [_ring(ring, what) for ring, what in zip([outline, *holes], names, strict=True)]
        flags = [
            _flags(flag, ring, loop, what)
            for flag, ring, loop, what in zip(given, [outline, *holes], loops, names, strict=True)
        ]
        _refuse_crossings(loops, names)
        for i, loop in enumerate(loops):
            if (_signed_area(loop) > 0) != (i == 0):
                loops[i] = loop[::-1].copy()
                flag = flags[i]
                flags[i] = None if flag is None else flag[::-1].copy()
        _refuse_strays(loops, names)
        marked = [
            turning_angles(loop) > corner_angle if flag is None else flag
            for loop, flag in zip(loops, flags, strict=True)
        ]
        for array in (*loops, *marked):
            array.flags.writeable = False
        self.name = name
        self.outline: Points = loops[0]
        self.holes: tuple[Points, ...] = tuple(loops[1:])
        self.corners: Flags = marked[0]
        self.hole_corners: tuple[Flags, ...] = tuple(marked[1:])

    @classmethod
    def from_json(
        cls,
        source: str | os.PathLike[str] | Mapping[str, Any],
        corner_angle: float = CORNER_ANGLE,
    ) -> Domain:
        """Read a domain from a JSON file, or from what such a file holds.

        The form is ``{"outline": [[x, y], ...], "holes": [[[x, y], ...], ...]}``, either
        orientation, with optional ``"name"``, ``"corners"`` (a list of booleans, one for each
        outline point) and ``"hole_corners"`` (such a list, or null, for each hole). Where they are
        left out, corners are where the boundary turns by more than `corner_angle` degrees.

        Raises:
            MeshError: the file is missing or not JSON (with the line), or its content is no
                domain; the message begins with the file's name.
        """
        if isinstance(source, Mapping):
            return _from_mapping(source, corner_angle)
        path = Path(source)
        content = load_json(path)
        try:
            domain = _from_mapping(content, corner_angle)
        except MeshError as error:
            raise MeshError(f"{path}: {error}") from error
        domain.name = domain.name or path.stem
        return domain

    def to_json(self) -> dict[str, Any]:
        """Return the domain as a dictionary that ``json.dump`` writes and `from_json` reads."""
        content: dict[str, Any] = {"name": self.name} if self.name else {}
        content["outline"] = self.outline.tolist()
        content["holes"] = [hole.tolist() for hole in self.holes]
        content["corners"] = self.corners.tolist()
        content["hole_corners"] = [flags.tolist() for flags in self.hole_corners]
        return content

    @property
    def loops(self) -> tuple[Points, ...]:
        """The outline, then the holes."""
        return (self.outline, *self.holes)

    @property
    def loop_corners(self) -> tuple[Flags, ...]:
        """The corner flags of the outline, then those of the holes."""
        return (self.corners, *self.hole_corners)

    @property
    def polygon(self) -> shapely.Polygon:
        """The domain as a shapely polygon."""
        return shapely.Polygon(self.outline, self.holes)

    @property
    def area(self) -> float:
        """The area of the outline less that of the holes."""
        return float(sum(_signed_area(loop) for loop in self.loops))

    @property
    def diameter(self) -> float:
        """The largest distance between two points of the outline."""
        hull = shapely.get_coordinates(shapely.convex_hull(shapely.MultiPoint(self.outline)))
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
        sizes = " and ".join(f"{len(loop)}" for loop in self.loops)
        return f"<Domain {self.name!r}, loops of {sizes} points>"


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


def _signed_area(loop: Points) -> float:
    x, y = (loop - loop[0]).T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y))


def _place(point: ArrayLike) -> str:
    x, y = np.asarray(point, dtype=float)
    return f"({x:.6g}, {y:.6g})"


def _ring(ring: ArrayLike, what: str) -> Points:
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
    bad = np.flatnonzero(~(np.abs(points) < _LARGEST).all(axis=1))
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
    if size < 1 / _LARGEST:
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


def _flags(flags: ArrayLike | None, ring: ArrayLike, loop: Points, what: str) -> Flags | None:
    if flags is None:
        return None
    values = np.array(flags)
    given = len(np.asarray(ring))
    if values.ndim != 1 or values.dtype != np.bool_ or len(values) not in (len(loop), given):
        raise MeshError(
            f"The corners of {what} must be {len(loop)} true or false, one for each point."
        )
    return values[: len(loop)]


def _refuse_crossings(loops: list[Points], names: list[str]) -> None:
    """Raise MeshError if two edges meet anywhere but in the point that neighbours share."""
    starts = np.concatenate(loops)
    ends = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops])
    ring = np.repeat(np.arange(len(loops)), [len(loop) for loop in loops])
    index = np.concatenate([np.arange(len(loop)) for loop in loops])
    edges = shapely.linestrings(np.stack([starts, ends], axis=1))
    one, other = shapely.STRtree(edges).query(edges, predicate="intersects")
    later = one < other
    one, other = one[later], other[later]
    order = np.lexsort((other, one))
    for i, j in zip(one[order].tolist(), other[order].tolist(), strict=True):
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


def _refuse_strays(loops: list[Points], names: list[str]) -> None:
    """Raise MeshError if a hole lies outside the outline or in another hole; no rings meet."""
    polygons = [shapely.Polygon(loop) for loop in loops]
    for i in range(1, len(loops)):
        spot = shapely.Point(loops[i][0])
        if not polygons[0].contains(spot):
            inverted = " and around it" if polygons[i].contains(shapely.Point(loops[0][0])) else ""
            raise MeshError(
                f"{capitalised(names[i])} lies outside the outline{inverted}: "
                f"its point 0 is {_place(loops[i][0])}."
            )
        for j in range(1, len(loops)):
            if i != j and polygons[j].contains(spot):
                raise MeshError(
                    f"{capitalised(names[i])} lies inside {names[j]}: "
                    f"its point 0 is {_place(loops[i][0])}."
                )


def load_json(path: Path) -> Any:
    """Return what a JSON file holds; MeshError that begins with the path if there is none."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except FileNotFoundError as error:
        raise MeshError(f"{path}: there is no such file.") from error
    except IsADirectoryError as error:
        raise MeshError(f"{path}: this is a folder, not a file.") from error
    except UnicodeDecodeError as error:
        raise MeshError(f"{path}: this is not a text file.") from error
    except (OSError, ValueError) as error:
        raise MeshError(f"{path}: cannot be read ({_reason(error)}).") from error
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        if not text.strip():
            raise MeshError(f"{path}: the file is empty.") from error
        place = f"line {error.lineno}, column {error.colno}"
        raise MeshError(f"{path}, {place}: this is not JSON ({error.msg}).") from error
    except (RecursionError, ValueError) as error:
        raise MeshError(f"{path}: this JSON is too deep or its numbers too long.") from error


def _reason(error: Exception) -> str:
    text = (error.strerror if isinstance(error, OSError) else None) or str(error)
    return text[:1].lower() + text[1:].strip().rstrip(".")


def _from_mapping(content: Any, corner_angle: float) -> Domain:
    if not isinstance(content, Mapping):
        raise MeshError('A domain is a JSON object with an "outline".')
    if "outline" not in content:
        raise MeshError('The domain has no "outline".')
    outline = _pairs(content["outline"], "the outline")
    holes = content.get("holes")
    holes = [] if holes is None else holes
    if not isinstance(holes, Sequence) or isinstance(holes, str):
        raise MeshError('"holes" is not a list of holes.')
    rings = [_pairs(hole, f"hole {i}") for i, hole in enumerate(holes)]
    hole_corners = content.get("hole_corners")
    if hole_corners is not None and (
        not isinstance(hole_corners, Sequence) or isinstance(hole_corners, str)
    ):
        raise MeshError('"hole_corners" is not a list with one entry for each hole.')
    name = content.get("name", "")
    if not isinstance(name, str):
        raise MeshError('"name" is not a text.')
    return Domain(outline, rings, content.get("corners"), hole_corners, name, corner_angle)


def _pairs(ring: Any, what: str) -> list[list[float]]:
    """Return a JSON list of [x, y] pairs as floats, or raise MeshError with the wrong entry."""
    if isinstance(ring, np.ndarray):
        ring = ring.tolist()
    if not isinstance(ring, Sequence) or isinstance(ring, str):
        raise MeshError(f"{capitalised(what)} is not a list of [x, y] pairs.")
    pairs = []
    for i, pair in enumerate(ring):
        numbers = isinstance(pair, Sequence) and len(pair) == 2 and all(map(_is_number, pair))
        if not numbers:
            shown = repr(pair)
            shown = shown if len(shown) <= 40 else shown[:37] + "..."
            raise MeshError(f"Point {i} of {what} is not a pair of numbers: {shown}.")
        try:
            pairs.append([float(pair[0]), float(pair[1])])
        except OverflowError as error:
            raise MeshError(f"Point {i} of {what} has a number that is too large.") from error
    return pairs


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
