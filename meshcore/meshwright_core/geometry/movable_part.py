"""A movable part: the part of a mesh whose vertices may move, as small plain arrays.

Smoothing and untangling work on movable parts only, so that the cost of either depends on the size
of the part and not on that of the mesh. Its elements are those that a movable vertex belongs to;
the other vertices of these elements stay where they are.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from meshwright_core.core.arrays import CURVE, FLAGS, HALF, TWIN
from meshwright_core.core.composite_curves import Curves, place_all
from meshwright_core.core.vertex_flags import UNMOVED
from meshwright_core.errors import MeshError
from meshwright_core.geometry.coons import CurvedElements, curved_corners
from meshwright_core.geometry.curved_elements import table
from meshwright_core.geometry.edge_curves import ends_of
from meshwright_core.geometry.edge_parts import EdgeParts
from meshwright_core.geometry.planes import plane_normal
from meshwright_core.geometry.quality import TOLERANCE, corner_sines, reference_normals
from meshwright_core.geometry.seats import Seats, find_seats, home_places, no_seats, place_seats
from meshwright_core.geometry.sharp_bends import kinks_between
from meshwright_core.geometry.turning import BENDS, CurveTurning, Turning, turnings

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


ON_SIDE = 1e-13
"""Distance, relative to the part's size, below which a vertex counts as on its side."""


class SlidingRun(NamedTuple):
    """Sliding vertices that follow one another on a side."""

    members: np.ndarray
    """(r,) local indices."""
    shift: np.ndarray
    """(r,) what to add to the members' parameters to make them increase over a closed side's
    seam."""
    low: float
    """Parameter that all of them stay above."""
    high: float
    """Parameter that all of them stay below."""


@dataclass
class MovablePart:
    """Arrays of a movable part; n vertices, m elements of k sides, all by local index."""

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
    curves: Curves
    """Those of the mesh."""
    turning: Turning
    """Of these curves."""
    is_loop: np.ndarray
    """(n,) bool: which of the curves are boundary loops; the others are interfaces."""
    seats: Seats
    curved: CurvedElements
    """The elements with sides that bend, or may do so where their ends can slide. It reads the
    parameters of `seats`."""
    home: np.ndarray
    """(n,) the parameters of `seats` at which the vertices are in the mesh."""
    frame: np.ndarray | None
    """(3, 3) rows: two directions of the plane and its normal; None for a part not in a plane."""

    @property
    def free(self) -> np.ndarray:
        """(n,) bool: the movable vertices that are bound to no side."""
        return self.movable & (self.seats.curve < 0)

    @property
    def sliding(self) -> np.ndarray:
        """(n,) bool: the movable vertices that slide on a side."""
        return self.seats.curve >= 0

    def settle(self) -> None:
        """Move the sliding vertices to the points of their parameters, unless they are there."""
        rows = np.flatnonzero(self.sliding)
        if not len(rows):
            return
        there = place_seats(self.curves, self.seats, rows)
        size = np.ptp(self.points, axis=0).max()
        away = np.abs(there - self.points[rows]).max(axis=1) > ON_SIDE * size
        self.points[rows[away]] = there[away]

    def placed(self, members: np.ndarray, parameters: np.ndarray) -> np.ndarray:
        """(n, 3) points of the sides of the sliding `members` (n,) at other parameters (n,)."""
        seats = self.seats
        points = place_all(self.curves, seats.curve[members], parameters)
        offset: np.ndarray = (
            points + seats.offset[members] + parameters[:, None] * seats.slope[members]
        )
        return offset

    def bends(self, curve: int, low: float, high: float) -> np.ndarray:
        """(b,) parameters between low and high at which a boundary loop has a kink to the outside,
        an interface one to either side.
        """
        assert self.frame is not None
        both = not self.is_loop[curve]
        return kinks_between(self.curves, self.turning, self.frame[2], curve, low, high, both)

    def fork(self) -> MovablePart:
        """The same part with a copy of the positions."""
        seats = self.seats._replace(parameter=self.seats.parameter.copy())
        curved = self.curved._replace(parameter=seats.parameter)
        return replace(self, points=self.points.copy(), seats=seats, curved=curved)

    def holding(self, members: list[int]) -> MovablePart:
        """The same part, on the same positions, in which the sliding `members` stay."""
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
            movable[i], seats.curve[i] = False, -1
        return replace(self, movable=movable, seats=seats)

    def runs(self) -> list[SlidingRun]:
        """The sliding vertices as runs of neighbours, each with the parameters that bound it.

        Of a closed side all of whose vertices slide one is left out, and bounds the others.
        """
        seats, found = self.seats, []
        for i in np.flatnonzero(self.sliding).tolist():
            before = int(seats.before[i])
            # the seam of a closed side is where a lower bound is one round back
            if before >= 0 and not (seats.low[i] < 0.0 and self.encircles(i)):
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

    def encircles(self, i: int) -> bool:
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
        """(m, k) bool: the corners that are flat or turn the wrong way; of curved elements those
        with a sample near them that does.
        """
        reference = self.references()
        sines = corner_sines(self.points, self.elements, reference)
        if len(self.curved.element):
            sines[self.curved.element], _ = curved_corners(self.curved, self.points, reference)
        found: np.ndarray = sines <= TOLERANCE
        return found

    def inverted_rows(self) -> np.ndarray:
        """(m,) bool: the elements with a folded corner."""
        rows: np.ndarray = np.any(self.folded(), axis=1)
        return rows

    def inverted(self) -> np.ndarray:
        """Ids, ascending, of the inverted elements."""
        return np.sort(self.element_ids[self.inverted_rows()])

    def changed(self, mesh: HalfEdgeMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Ids (n,), positions (n, 3) and parameters (n,) of the movable vertices that lie elsewhere
        in `mesh`, as :meth:`HalfEdgeMesh.move` takes them.

        The positions of sliding vertices are those of their parameters to the bit.
        """
        moved = (self.points != mesh.points[self.vertices]).any(axis=1) & self.movable
        rows = np.flatnonzero(moved)
        vertices, positions = self.vertices[rows], self.points[rows]
        parameters = self.parameters(mesh)[rows]
        slid = np.flatnonzero(self.seats.curve[rows] >= 0)
        if len(slid):
            there = home_places(self.curves, self.seats, rows[slid], parameters[slid])
            positions[slid] = there
        return vertices, positions, parameters

    def parameters(self, mesh: HalfEdgeMesh) -> np.ndarray:
        """(n,) the parameters of all vertices in [0, length) of their curves; those that have not
        slid keep theirs in `mesh`.
        """
        found = mesh.arrays.parameter[self.vertices]
        slid = np.flatnonzero(self.sliding & (self.seats.parameter != self.home))
        if len(slid):
            t, curve = self.seats.parameter[slid], self.seats.curve[slid]
            length = mesh.boundary_info.lengths()[curve]
            t = np.where(self.curves.closed[curve], np.mod(t, length), np.clip(t, 0.0, length))
            found[slid] = np.where(t < length, t, 0.0)
        return found


def chosen(mesh: HalfEdgeMesh, vertices: Iterable[int] | None) -> MovablePart:
    """The part in which `vertices` may move; None: all."""
    return whole(mesh) if vertices is None else around(mesh, live(mesh, vertices))


def live(mesh: HalfEdgeMesh, vertices: Iterable[int]) -> np.ndarray:
    """`vertices` as an ascending array (n,); MeshError unless all are live vertices of `mesh`."""
    ids = np.unique(np.fromiter(vertices, np.int64))
    known = (ids >= 0) & (ids < len(mesh.points))
    known[known] = mesh.arrays.vertex[ids[known], HALF] >= 0
    if not known.all():
        raise MeshError(f"Vertex {ids[~known][0]} is not in the mesh.")
    return ids


def whole(mesh: HalfEdgeMesh) -> MovablePart:
    """The part of all vertices of `mesh`."""
    return _part(mesh, mesh.elements(), mesh.element_ids(), None)


def around(mesh: HalfEdgeMesh, vertices: np.ndarray) -> MovablePart:
    """The part in which `vertices` (n,) may move, in time proportional to its size."""
    wanted = np.unique(np.asarray(vertices, np.int64))
    ids = elements_at(mesh, wanted)
    return _part(mesh, mesh.corners(ids), ids, wanted)


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


def _part(
    mesh: HalfEdgeMesh, corners: np.ndarray, ids: np.ndarray, wanted: np.ndarray | None
) -> MovablePart:
    vertices, local = np.unique(corners, return_inverse=True)
    elements = local.reshape(corners.shape).astype(np.int64)
    rows = mesh.arrays.vertex[vertices]
    movable = (rows[:, FLAGS] & UNMOVED) == 0
    if wanted is not None:
        movable &= np.isin(vertices, wanted)
    seats = no_seats(len(vertices))
    curves = mesh.boundary_info.curves
    slides = movable & (rows[:, CURVE] >= 0)
    if slides.any():
        find_seats(mesh.arrays, vertices, slides, seats, mesh.k)
    points = np.ascontiguousarray(mesh.points[vertices])
    frame = _frame(mesh, points, elements)
    ids = np.asarray(ids, np.int64)
    return MovablePart(
        vertices=vertices.astype(np.int64),
        points=points,
        elements=elements,
        element_ids=ids,
        movable=movable,
        curves=curves,
        turning=CurveTurning.of(mesh),
        is_loop=np.isin(np.arange(mesh.boundary_info.count), mesh.boundary_info.loops),
        seats=seats,
        curved=_curved(mesh, ids, elements, vertices, seats, flat=frame is not None),
        home=seats.parameter.copy(),
        frame=frame,
    )


def _curved(
    mesh: HalfEdgeMesh,
    ids: np.ndarray,
    elements: np.ndarray,
    vertices: np.ndarray,
    seats: Seats,
    flat: bool,
) -> CurvedElements:
    """The elements with sides that bend for some places of their ends."""
    halfedges = mesh.halfedges_of(ids).ravel() if flat else np.zeros(0, np.int64)
    parts = EdgeParts.of(mesh.arrays, halfedges, mesh.k)
    rows = np.flatnonzero(parts.curve >= 0)
    halfedges, parts = halfedges[rows], parts.take(rows)
    ends = np.searchsorted(vertices, ends_of(mesh, halfedges))
    slides = seats.curve[ends] >= 0
    forward = parts.span[:, 0] < parts.span[:, 1]
    # sliding ends have their parameters in the seats, up to whole turns
    parts = replace(parts, span=parts.span - np.where(slides, seats.parameter[ends], 0.0))
    reach = parts.span[..., None] + np.where(slides[..., None], seats.reach[ends], 0.0)
    window = np.where(
        forward[:, None],
        np.column_stack([reach[:, 0, 0], reach[:, 1, 1]]),
        np.column_stack([reach[:, 1, 0], reach[:, 0, 1]]),
    )
    length = mesh.boundary_info.lengths()[parts.curve]
    window[:, 1] = np.minimum(window[:, 1], window[:, 0] + length)
    turning = turnings(parts.curves, CurveTurning.of(mesh), parts.curve, window)
    rows = np.flatnonzero(turning > BENDS)
    return table(mesh, ids, elements, halfedges[rows], parts.take(rows), seats.parameter)


def _frame(mesh: HalfEdgeMesh, points: np.ndarray, elements: np.ndarray) -> np.ndarray | None:
    """(3, 3) two directions and the normal of the part's plane, or None."""
    p = points[elements]
    own = np.cross(p, np.roll(p, -1, axis=1)).sum(axis=(0, 1))
    normal = plane_normal(mesh, points, own)
    if normal is None:
        return None
    if normal[2] == 1.0:
        return np.eye(3)
    first = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first), normal])
