"""The outline of a mesh: the polylines along which its boundary ran when it was made.

Compiled functions on polylines, and :class:`Outline`, which finds the piece of the outline between
two boundary vertices.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from meshwright_core.core.compilation import kernel
from meshwright_core.core.references import by_reference
from meshwright_core.errors import MeshError

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

STRAIGHT = 1e-12
"""Sine of a turn below which a point of the outline counts as lying on a straight line."""
FLAT = 1e-7
"""Distance from a plane, relative to the extent, below which points lie in it."""
NEAR = 1e-9
"""Distance, relative to the outline's extent, below which a point lies on the outline."""


@by_reference
class Polylines(NamedTuple):
    """Sides as flat arrays. Closed ones repeat their first point at the end."""

    points: np.ndarray
    """(p, 2 or 3) points of all sides, one side after the other."""
    arc: np.ndarray
    """(p,) arc length of each point from the start of its side."""
    first: np.ndarray
    """(s + 1,) index of the first point of each side."""
    closed: np.ndarray
    """(s,) whether the side is a whole loop without a geometric vertex."""


@kernel
def place_on(sides, side, t, point, tangent):
    """Write the point and the unit tangent at arc length `t`; beyond an open end: straight on."""
    low, high = sides.first[side], sides.first[side + 1] - 1
    arc, points = sides.arc, sides.points
    if sides.closed[side]:
        t -= np.floor(t / arc[high]) * arc[high]
    while high - low > 1:
        middle = (low + high) // 2
        if arc[middle] <= t:
            low = middle
        else:
            high = middle
    length = arc[high] - arc[low]
    share = (t - arc[low]) / length
    for c in range(points.shape[1]):
        tangent[c] = (points[high, c] - points[low, c]) / length
        # from the nearer end, so that both ends are met to the bit
        if share <= 0.5:
            point[c] = points[low, c] + share * (points[high, c] - points[low, c])
        else:
            point[c] = points[high, c] - (1.0 - share) * (points[high, c] - points[low, c])


@kernel
def nearest_on(sides, side, point):
    """Arc length of the point of the side that is nearest to `point`, and the squared distance."""
    best, where = np.inf, 0.0
    points, arc = sides.points, sides.arc
    for i in range(sides.first[side], sides.first[side + 1] - 1):
        along, square = 0.0, 0.0
        for c in range(points.shape[1]):
            d = points[i + 1, c] - points[i, c]
            along += d * (point[c] - points[i, c])
            square += d * d
        share = min(max(along / square, 0.0), 1.0) if square > 0.0 else 0.0
        distance = 0.0
        for c in range(points.shape[1]):
            d = point[c] - points[i, c] - share * (points[i + 1, c] - points[i, c])
            distance += d * d
        if distance < best:
            best = distance
            where = arc[i] + share * (arc[i + 1] - arc[i])
    return where, best


@kernel
def nearest_parameters(sides, side, points):
    """(n,) arc lengths on `side` of the projections of `points`."""
    t = np.zeros(len(points))
    for i in range(len(points)):
        t[i], _ = nearest_on(sides, side, points[i])
    return t


@kernel
def place_all(sides, side, parameters):
    """(n, 2 or 3) points at the arc lengths `parameters` (n,) of the sides `side` (n,)."""
    points = np.zeros((len(parameters), sides.points.shape[1]))
    tangent = np.zeros(sides.points.shape[1])
    for i in range(len(parameters)):
        place_on(sides, side[i], parameters[i], points[i], tangent)
    return points


def vector_area(loop: np.ndarray) -> np.ndarray:
    """(3,) vector area of a closed polygon (n, 3): positive along the normal it turns around."""
    p = loop - loop.mean(axis=0)
    area: np.ndarray = 0.5 * np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)
    return area


class _Loop:
    """One loop of the outline: its points, closed by the first, without those on straight lines."""

    def __init__(self, ids: np.ndarray, points: np.ndarray) -> None:
        self.ids = {int(v): i for i, v in enumerate(ids)}
        self.points = np.asarray(points, np.float64)
        closed = np.vstack([self.points, self.points[:1]])
        lengths = np.linalg.norm(np.diff(closed, axis=0), axis=1)
        self.arc = np.concatenate([[0.0], np.cumsum(lengths)])
        self.length = float(self.arc[-1])
        first = np.array([0, len(closed)])
        self.polyline = Polylines(closed, self.arc, first, np.array([True]))
        unit = np.diff(closed, axis=0) / np.maximum(lengths, 1e-300)[:, None]
        turn = np.linalg.norm(unit - np.roll(unit, 1, axis=0), axis=1)
        self.turning = np.flatnonzero(turn > STRAIGHT)
        self.area = vector_area(self.points)

    def between(self, start: float, stop: float) -> np.ndarray:
        """(p, 3) points where the loop turns, after arc length `start` and before `stop`."""
        arc = self.arc[self.turning]
        margin = NEAR * self.length
        if stop <= start + margin:
            stop += self.length
        rounds = np.concatenate([arc, arc + self.length])
        inside = (rounds > start + margin) & (rounds < stop - margin)
        return self.points[np.concatenate([self.turning, self.turning])[inside]]


class Outline:
    """The shape of a mesh: look-ups in `mesh.outline`, prepared once for each mesh.

    `area` is the vector area (3,) of the outline: along the normal of a plane mesh, to the side
    from which its elements turn counter-clockwise. `extent` is the diagonal of its bounding box.
    """

    _known: ClassVar[WeakKeyDictionary[HalfEdgeMesh, Outline]] = WeakKeyDictionary()

    def __init__(self, loops: list[tuple[np.ndarray, np.ndarray]]) -> None:
        self.source = loops
        self.loops = [_Loop(ids, points) for ids, points in loops]
        self.area = np.zeros(3)
        self.extent = 0.0
        if self.loops:
            everything = np.vstack([loop.points for loop in self.loops])
            self.extent = float(np.linalg.norm(np.ptp(everything, axis=0)))
            for loop in self.loops:
                self.area += loop.area

    @classmethod
    def of(cls, mesh: HalfEdgeMesh) -> Outline:
        """The outline of `mesh`; kept as long as the mesh lives and its ids are the same."""
        outline = cls._known.get(mesh)
        if outline is None or outline.source is not mesh.outline:
            outline = cls._known[mesh] = cls(mesh.outline)
        return outline

    def normal(self, points: np.ndarray, own: np.ndarray | None = None) -> np.ndarray | None:
        """(3,) unit normal of the plane that all `points` (n, 3) lie in, or None.

        It points to the side from which the outline turns counter-clockwise; without an outline in
        this plane along `own` (3,), the sum of the elements' vector areas.
        """
        if not len(points):
            return None
        if not points[:, 2].any() and self.area[2] > 0.0:
            return np.array([0.0, 0.0, 1.0])
        size = float(np.linalg.norm(np.ptp(points, axis=0)))
        for area in (self.area, own):
            length = 0.0 if area is None else float(np.linalg.norm(area))
            if area is None or length <= 1e-12 * size * size:
                continue
            normal: np.ndarray = area / length
            if np.ptp(points @ normal) <= FLAT * size:
                return normal
        return None

    def find(self, vertex: int, point: np.ndarray) -> tuple[int, float]:
        """The loop and the arc length at which a geometric vertex cuts the outline.

        A vertex that lies on the outline cuts it where it lies. One that was dragged off it still
        stands for its own point of the outline; any other one cuts it at its projection.
        """
        for number, loop in enumerate(self.loops):
            i = loop.ids.get(vertex)
            if i is not None and np.array_equal(loop.points[i], point):
                return number, float(loop.arc[i])
        number, t, distance = self.nearest(point)
        if distance > NEAR * self.extent:
            for other, loop in enumerate(self.loops):
                if vertex in loop.ids:
                    return other, float(loop.arc[loop.ids[vertex]])
        return number, t

    def nearest(self, point: np.ndarray) -> tuple[int, float, float]:
        """The loop, arc length and distance of the nearest point of the outline."""
        found = [nearest_on(loop.polyline, 0, point) for loop in self.loops]
        number = int(np.argmin([square for _, square in found]))
        return number, float(found[number][0]), float(np.sqrt(found[number][1]))

    def _around(self, points: np.ndarray) -> _Loop:
        """The loop that a boundary without geometric vertices runs on.

        The one that its vertices lie on; if edits have pulled them off them all, the nearest of
        those that turn the same way, the outer boundary or holes. (Ids are no evidence here: those
        of deleted vertices are used again.)
        """
        sample = points[:: max(1, len(points) // 8)]
        off = [max(nearest_on(loop.polyline, 0, p)[1] for p in sample) for loop in self.loops]
        if min(off) <= (1e-3 * self.extent) ** 2:
            return self.loops[int(np.argmin(off))]
        turning = vector_area(points)
        alike = [loop for loop in self.loops if loop.area @ turning > 0.0] or self.loops
        centre = points.mean(axis=0)
        away = [float(np.linalg.norm(loop.points.mean(axis=0) - centre)) for loop in alike]
        return alike[int(np.argmin(away))]

    def side(self, chain: np.ndarray, points: np.ndarray, closed: bool) -> np.ndarray:
        """(p, 3) polyline of the side whose boundary vertices are `chain`, at `points` (n, 3)."""
        if not self.loops:
            raise MeshError("The mesh has a boundary but no outline to slide on.")
        if closed:
            loop = self._around(points)
            corners = loop.points[loop.turning]
            return np.vstack([corners, corners[:1]])
        number, start = self.find(int(chain[0]), points[0])
        _, stop = self.find(int(chain[-1]), points[-1])
        return np.vstack([points[:1], self.loops[number].between(start, stop), points[-1:]])
