"""A region: the part of a mesh whose vertices may move, as small plain arrays.

Smoothing and untangling work on regions only, so that the cost of either depends on the size of the
region and not on that of the mesh. Its elements are those that a movable vertex belongs to; the
other vertices of these elements stay where they are.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from meshwright_core.core.arrays import FLAGS, GEOMETRIC, HALF, LOCKED, TWIN
from meshwright_core.core.references import by_reference
from meshwright_core.errors import MeshError
from meshwright_core.geometry.outline import Outline, Polylines, place_all
from meshwright_core.geometry.quality import TOLERANCE, corner_sines, reference_normals
from meshwright_core.geometry.sides import Sides

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


ON_SIDE = 1e-13
"""Distance, relative to the region's size, below which a vertex counts as on its side."""


@by_reference
class Seats(NamedTuple):
    """Positions of the sliding vertices of a region on their sides, and the bounds of each."""

    side: np.ndarray
    """(n,) side of a sliding vertex, -1 for others."""
    parameter: np.ndarray
    """(n,) arc length of a sliding vertex."""
    before: np.ndarray
    """(n,) the sliding vertex before it on its side, -1 when that one stays."""
    after: np.ndarray
    """(n,) likewise after it."""
    low: np.ndarray
    """(n,) what to add to the arc length of `before` (to zero if it is -1): the lower bound."""
    high: np.ndarray
    """(n,) likewise for `after`: the upper bound."""


class SlidingRun(NamedTuple):
    """Sliding vertices that follow one another on a side."""

    members: np.ndarray
    """(r,) local indices."""
    shift: np.ndarray
    """(r,) what to add to the members' arc lengths to make them increase over a closed side's
    seam."""
    low: float
    """Arc length that all of them stay above."""
    high: float
    """Arc length that all of them stay below."""


@dataclass
class Region:
    """Arrays of a region; n vertices, m elements of k sides, all by local index."""

    vertices: np.ndarray
    """(n,) ids, ascending."""
    points: np.ndarray
    """(n, 3) positions, a copy."""
    elements: np.ndarray
    """(m, k) local vertex indices, counter-clockwise."""
    element_ids: np.ndarray
    """(m,) ids of the elements."""
    movable: np.ndarray
    """(n,) bool: neither geometric nor locked, and among the requested vertices."""
    sides: Polylines
    seats: Seats
    frame: np.ndarray | None
    """(3, 3) rows: two directions of the plane and its normal; None for a region not in a plane."""

    @property
    def free(self) -> np.ndarray:
        """(n,) bool: the movable vertices that are bound to no side."""
        return self.movable & (self.seats.side < 0)

    @property
    def sliding(self) -> np.ndarray:
        """(n,) bool: the movable vertices that slide on a side."""
        return self.seats.side >= 0

    def settle(self) -> None:
        """Move the sliding vertices to the points at their arc lengths, unless they are there."""
        rows = np.flatnonzero(self.sliding)
        if not len(rows):
            return
        there = place_all(self.sides, self.seats.side[rows], self.seats.parameter[rows])
        size = np.ptp(self.points, axis=0).max()
        away = np.abs(there - self.points[rows]).max(axis=1) > ON_SIDE * size
        self.points[rows[away]] = there[away]

    def fork(self) -> Region:
        """The same region with a copy of the positions."""
        seats = self.seats._replace(parameter=self.seats.parameter.copy())
        return replace(self, points=self.points.copy(), seats=seats)

    def adopt(self, other: Region) -> None:
        """Take over the positions of a fork."""
        self.points[:] = other.points
        self.seats.parameter[:] = other.seats.parameter

    def holding(self, members: list[int]) -> Region:
        """The same region, on the same positions, in which the sliding `members` stay."""
        seats = Seats(*(array.copy() for array in self.seats))
        seats = seats._replace(parameter=self.seats.parameter)
        movable = self.movable.copy()
        for i in members:
            before, after = int(seats.before[i]), int(seats.after[i])
            if before >= 0:
                seats.high[before] += seats.parameter[i]
                seats.after[before] = -1
            if after >= 0:
                seats.low[after] += seats.parameter[i]
                seats.before[after] = -1
            movable[i], seats.side[i] = False, -1
        return replace(self, movable=movable, seats=seats)

    def runs(self) -> list[SlidingRun]:
        """The sliding vertices as runs of neighbours, each with the arc lengths that bound it.

        Of a closed side all of whose vertices slide one is left out, and bounds the others.
        """
        seats, found = self.seats, []
        for i in np.flatnonzero(self.sliding).tolist():
            before = int(seats.before[i])
            # the seam of a closed side is where a lower bound is one round back
            if before >= 0 and not (seats.low[i] < 0.0 and self._encircles(i)):
                continue
            run, shift = [i], [0.0]
            while 0 <= (after := int(seats.after[run[-1]])) != i:
                shift.append(shift[-1] + float(seats.high[run[-1]]))
                run.append(after)
            low, high = float(seats.low[i]), float(seats.high[run[-1]]) + shift[-1]
            if before >= 0:
                low = float(seats.parameter[i])
                run, shift, high = run[1:], shift[1:], high + low
            found.append(SlidingRun(np.array(run, np.int64), np.array(shift), low, high))
        return found

    def _encircles(self, i: int) -> bool:
        """Whether all vertices of the closed side of i slide."""
        v = int(self.seats.after[i])
        while v >= 0 and v != i:
            v = int(self.seats.after[v])
        return v == i

    def references(self) -> np.ndarray:
        """(m, 3) normals that the corners of the elements are measured against."""
        normal = None if self.frame is None else self.frame[2]
        return reference_normals(self.points, self.elements, normal)

    def folded(self) -> np.ndarray:
        """(m, k) bool: the corners that are flat or turn the wrong way."""
        return corner_sines(self.points, self.elements, self.references()) <= TOLERANCE

    def inverted_rows(self) -> np.ndarray:
        """(m,) bool: the elements with a folded corner."""
        rows: np.ndarray = np.any(self.folded(), axis=1)
        return rows

    def inverted(self) -> np.ndarray:
        """Ids, ascending, of the inverted elements."""
        return np.sort(self.element_ids[self.inverted_rows()])

    def changed(self, mesh: HalfEdgeMesh) -> tuple[np.ndarray, np.ndarray]:
        """Ids (n,) and positions (n, 3) of the movable vertices that lie elsewhere in `mesh`."""
        moved = (self.points != mesh.points[self.vertices]).any(axis=1) & self.movable
        return self.vertices[moved], self.points[moved]


def chosen(mesh: HalfEdgeMesh, vertices: Iterable[int] | None) -> Region:
    """The region in which `vertices` may move; None: all."""
    return whole(mesh) if vertices is None else around(mesh, live(mesh, vertices))


def live(mesh: HalfEdgeMesh, vertices: Iterable[int]) -> np.ndarray:
    """`vertices` as an ascending array (n,); MeshError unless all are live vertices of `mesh`."""
    ids = np.unique(np.fromiter(vertices, np.int64))
    known = (ids >= 0) & (ids < len(mesh.points))
    known[known] = mesh.arrays.vertex[ids[known], HALF] >= 0
    if not known.all():
        raise MeshError(f"Vertex {ids[~known][0]} is not in the mesh.")
    return ids


def whole(mesh: HalfEdgeMesh) -> Region:
    """The region of all vertices of `mesh`."""
    return _region(mesh, mesh.elements(), mesh.element_ids(), None)


def around(mesh: HalfEdgeMesh, vertices: np.ndarray) -> Region:
    """The region in which `vertices` (n,) may move, in time proportional to its size."""
    wanted = np.unique(np.asarray(vertices, np.int64))
    ids = elements_at(mesh, wanted)
    return _region(mesh, mesh.corners(ids), ids, wanted)


def elements_at(mesh: HalfEdgeMesh, vertices: np.ndarray) -> np.ndarray:
    """Ids, ascending, of the elements that any of the live `vertices` belongs to."""
    edge, k = mesh.arrays.edge, mesh.k
    half = mesh.arrays.vertex[vertices, HALF].astype(np.int64)
    first = half.copy()
    found = []
    while len(half):
        found.append(half // k)
        back = np.where(half % k == 0, half + k - 1, half - 1)
        turned = edge[back, TWIN].astype(np.int64)
        more = (turned >= 0) & (turned != first)
        half, first = turned[more], first[more]
    return np.unique(np.concatenate(found)) if found else np.zeros(0, np.int64)


def rings(mesh: HalfEdgeMesh, vertices: np.ndarray, count: int) -> np.ndarray:
    """Ids, ascending, of `vertices` and of all within `count` elements of them."""
    reached = np.unique(np.asarray(vertices, np.int64))
    for _ in range(count):
        reached = np.unique(mesh.corners(elements_at(mesh, reached)))
    return reached


def _region(
    mesh: HalfEdgeMesh, corners: np.ndarray, ids: np.ndarray, wanted: np.ndarray | None
) -> Region:
    vertices, local = np.unique(corners, return_inverse=True)
    elements = local.reshape(corners.shape).astype(np.int64)
    rows = mesh.arrays.vertex[vertices]
    fixed = (rows[:, FLAGS] & (GEOMETRIC | LOCKED)) != 0
    movable = ~fixed
    if wanted is not None:
        movable &= np.isin(vertices, wanted)
    on_boundary = mesh.arrays.edge[rows[:, HALF], TWIN] < 0
    slide = np.flatnonzero(movable & on_boundary)
    sides = Sides(mesh, None if wanted is None else vertices[slide])
    points = np.ascontiguousarray(mesh.points[vertices])
    return Region(
        vertices=vertices.astype(np.int64),
        points=points,
        elements=elements,
        element_ids=np.asarray(ids, np.int64),
        movable=movable,
        sides=sides.polylines,
        seats=_seats(sides, vertices, slide),
        frame=_frame(points, elements, Outline.of(mesh)),
    )


def _seats(sides: Sides, vertices: np.ndarray, slide: np.ndarray) -> Seats:
    n = len(vertices)
    seats = Seats(
        side=np.full(n, -1, np.int64),
        parameter=np.zeros(n),
        before=np.full(n, -1, np.int64),
        after=np.full(n, -1, np.int64),
        low=np.zeros(n),
        high=np.zeros(n),
    )
    local = {int(vertices[i]): int(i) for i in slide}
    for number, chain in enumerate(sides.chains):
        members = np.array([local.get(v, -1) for v in chain.tolist()], np.int64)
        places = np.flatnonzero(members >= 0)
        if not len(places):
            continue
        t = sides.parameters(number)
        count, length = len(chain), sides.length(number)
        for place in places.tolist():
            i = members[place]
            seats.side[i], seats.parameter[i] = number, t[place]
            for step, neighbour, bound in (
                (-1, seats.before, seats.low),
                (1, seats.after, seats.high),
            ):
                turns, other = divmod(place + step, count)
                neighbour[i] = members[other]
                bound[i] = turns * length + (0.0 if members[other] >= 0 else t[other])
    return seats


def _frame(points: np.ndarray, elements: np.ndarray, outline: Outline) -> np.ndarray | None:
    """(3, 3) two directions and the normal of the region's plane, or None."""
    p = points[elements]
    own = np.cross(p, np.roll(p, -1, axis=1)).sum(axis=(0, 1))
    normal = outline.normal(points, own)
    if normal is None:
        return None
    if normal[2] == 1.0:
        return np.eye(3)
    first = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first), normal])
