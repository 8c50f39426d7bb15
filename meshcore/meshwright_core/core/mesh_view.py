"""Read-only view of a half-edge mesh: counts, score, arrays, traversal."""

from __future__ import annotations

import numpy as np

from meshwright_core.core import circulators, construction, side_names, validation
from meshwright_core.core.arrays import (
    BOUNDARY_EDGES,
    CURVE,
    DEGREE,
    DELTA_SUM,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    FLAGS,
    GEOMETRIC,
    HALF,
    IRREGULAR,
    LOCKED,
    NAMING,
    ORIGIN,
    SCORE,
    SIDES,
    TWIN,
    VERTEX_SLOTS,
    VERTICES,
    MeshArrays,
    corners_of,
    halfedges_of,
)
from meshwright_core.core.composite_curves import place_all
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.core.grid_plan import GridPlan
from meshwright_core.core.mesh_boundary import Interface, MeshBoundary
from meshwright_core.core.planes import Plane
from meshwright_core.core.vertex_flags import PINNED

_KINDS = {3: "tri", 4: "quad"}


class MeshView:
    """The read-only methods of :class:`meshwright_core.mesh.HalfEdgeMesh`.

    Ids of vertices, elements and half-edges are plain ints; -1 is none. See
    :mod:`meshwright_core.core.arrays` for the arrays behind it.
    """

    def __init__(self, arrays: MeshArrays, boundary: MeshBoundary) -> None:
        """Wraps arrays that obey the invariants."""
        self._arrays = arrays
        self._take_boundary(boundary)
        self.k: int = int(arrays.counters[SIDES])
        """Sides of an element, 3 or 4."""

    def _take_boundary(self, boundary: MeshBoundary) -> None:
        self._namings = {int(self._arrays.vertex[0, NAMING]): boundary}

    @property
    def _boundary(self) -> MeshBoundary:
        return self._namings[int(self._arrays.vertex[0, NAMING])]

    @property
    def plane(self) -> Plane | None:
        """The plane in space whose coordinates those of the mesh are; None for space itself."""
        return self._boundary.plane

    def points_in_space(self) -> np.ndarray:
        """(slots, 3) the coordinates of all vertices in space, where the mesh's own are those of
        a plane.
        """
        plane = self._boundary.plane
        return self.points.copy() if plane is None else plane.in_space(self.points)

    @property
    def boundary_info(self) -> MeshBoundary:
        """The curves that boundary and interfaces run along, and the names of regions."""
        return self._boundary

    @property
    def grid_plan(self) -> GridPlan:
        """What is wanted of a block grid of this mesh, a part of its history."""
        return self._boundary.plan

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """The curves between two regions."""
        return self._boundary.interfaces

    def junctions(self) -> set[int]:
        """The vertices where interfaces start or end; they are geometric."""
        return {v for one in self.interfaces for v in (one.start, one.end) if v >= 0}

    @property
    def region_names(self) -> tuple[str, ...]:
        """The name of each region, "" where it has none."""
        return self._boundary.region_names

    def regions(self) -> np.ndarray:
        """(m,) the region of each live element, in the order of :meth:`element_ids`."""
        return self._arrays.region[self.element_ids()]

    @property
    def namings(self) -> dict[int, MeshBoundary]:
        """All names that this mesh has had, with its curves, by their number in the history."""
        return dict(self._namings)

    @property
    def naming(self) -> int:
        """The number of the names in force, a key of :attr:`namings`."""
        return int(self._arrays.vertex[0, NAMING])

    def sides(self) -> dict[str, np.ndarray]:
        """The edges (n, 2) of each side by its name, as vertex ids; those without name under "".

        Sides are on the boundary, where the mesh is on the left of an edge, and on interfaces.
        """
        edges = side_names.side_edges(self._arrays)
        origin = self._arrays.edge[:, ORIGIN].astype(np.int64)
        ahead = edges.halfedges - edges.halfedges % self.k + (edges.halfedges + 1) % self.k
        ends = np.stack([origin[edges.halfedges], origin[ahead]], axis=1)
        names = side_names.names_of(self._boundary, edges.curve, edges.span)
        rows: dict[str, list[int]] = {}
        for row, name in enumerate(names):
            rows.setdefault(name, []).append(row)
        return {name: ends[some] for name, some in rows.items()}

    def side_ends(self) -> set[int]:
        """The vertices where the name of a side changes; they are geometric."""
        return set(side_names.changes(self._arrays, self._boundary).tolist())

    def side_of(self, h: int) -> str:
        """The name of the side that half-edge h lies on, "" for none."""
        curve, span = edge_places(self._arrays, np.array([h]), self.k)
        return side_names.names_of(self._boundary, curve, span)[0]

    def curve_ids(self) -> np.ndarray:
        """(slots,) the curve that each vertex lies on, -1 for none."""
        return self._arrays.vertex[: self.slots, CURVE].copy()

    def parameters(self) -> np.ndarray:
        """(slots,) the parameter of each vertex on its curve, 0 for those on none."""
        return self._arrays.parameter[: self.slots].copy()

    def curve_of(self, v: int) -> int:
        """The curve that vertex v lies on, -1 for none."""
        return int(self._arrays.vertex[v, CURVE])

    def parameter_of(self, v: int) -> float:
        """The parameter of vertex v on its curve, 0 if it lies on none."""
        return float(self._arrays.parameter[v])

    def off_curve(self) -> np.ndarray:
        """(slots,) distance of each vertex from its own point of its curve; 0 for others.

        Within rounding 0 unless someone moved the vertex off.
        """
        curve = self.curve_ids()
        there = np.flatnonzero(curve >= 0)
        off = np.zeros(self.slots)
        t = self._arrays.parameter[there]
        there_points = place_all(self._arrays.curves, curve[there].astype(np.int64), t)
        off[there] = np.linalg.norm(self.points[there] - there_points, axis=1)
        return off

    @property
    def kind(self) -> str:
        """The kind of its elements, "tri" or "quad"."""
        return _KINDS[self.k]

    @property
    def n_vertices(self) -> int:
        """Live vertices."""
        return int(self._arrays.counters[VERTICES])

    @property
    def n_elements(self) -> int:
        """Live elements."""
        return int(self._arrays.counters[ELEMENTS])

    @property
    def n_edges(self) -> int:
        """Edges, each counted once."""
        counters = self._arrays.counters
        return int(self.k * counters[ELEMENTS] + counters[BOUNDARY_EDGES]) // 2

    @property
    def euler(self) -> int:
        """Euler characteristic V - E + F: 1 for a disc, one less for each hole."""
        return self.n_vertices - self.n_edges + self.n_elements

    @property
    def score(self) -> int:
        """s, the sum of |Delta| over all vertices (equation 1)."""
        return int(self._arrays.counters[SCORE])

    @property
    def optimum(self) -> int:
        """s*, which no operation changes and s of no valid mesh falls below.

        |sum of Delta| (equation 6), and more where the irregularities of two regions cannot cancel
        (:mod:`meshwright_core.core.score_bound`).
        """
        return abs(int(self._arrays.counters[DELTA_SUM])) + self._boundary.bound_excess

    @property
    def irregular_count(self) -> int:
        """Vertices whose degree is not the desired one."""
        return int(self._arrays.counters[IRREGULAR])

    @property
    def arrays(self) -> MeshArrays:
        """The arrays themselves, for compiled code; they are replaced when the mesh outgrows
        them.
        """
        return self._arrays

    @property
    def slots(self) -> int:
        """Vertex ids ever used: one more than the largest, dead ones included."""
        return int(self._arrays.counters[VERTEX_SLOTS])

    @property
    def points(self) -> np.ndarray:
        """(slots, 3) float64 coordinates by vertex id, writable, valid until the next edit."""
        return self._arrays.points[: self.slots]

    def element_ids(self) -> np.ndarray:
        """(m,) ids of the live elements, ascending."""
        slots = int(self._arrays.counters[ELEMENT_SLOTS])
        return np.flatnonzero(self._arrays.edge[: slots * self.k : self.k, ORIGIN] >= 0)

    def elements(self) -> np.ndarray:
        """(m, k) int64 vertex ids of the live elements, counter-clockwise."""
        slots = int(self._arrays.counters[ELEMENT_SLOTS])
        rows = self._arrays.edge[: slots * self.k, ORIGIN].reshape(slots, self.k)
        if slots != self.n_elements:
            rows = rows[rows[:, 0] >= 0]
        return rows.astype(np.int64)

    def corners(self, elements: np.ndarray) -> np.ndarray:
        """(m, k) int64 vertex ids of the given live elements (m,), counter-clockwise."""
        return corners_of(self._arrays, elements)

    def halfedges_of(self, elements: np.ndarray) -> np.ndarray:
        """(m, k) half-edges of elements (m,), counter-clockwise."""
        return halfedges_of(elements, self.k)

    def vertices(self) -> np.ndarray:
        """(n,) ids of the live vertices, ascending."""
        return np.flatnonzero(self._arrays.vertex[: self.slots, HALF] >= 0)

    def degree(self) -> np.ndarray:
        """(slots,) number of edges at each vertex; 0 for dead ids."""
        return self._arrays.vertex[: self.slots, DEGREE].copy()

    def desired(self) -> np.ndarray:
        """(slots,) desired degree; 0 for dead ids."""
        return self._arrays.vertex[: self.slots, DESIRED].copy()

    def irregularity(self) -> np.ndarray:
        """(slots,) Delta = degree - desired degree by vertex id; 0 for dead ids."""
        rows = self._arrays.vertex[: self.slots]
        return rows[:, DEGREE] - rows[:, DESIRED]

    def geometric(self) -> np.ndarray:
        """(slots,) whether a vertex is part of the geometry: it neither moves nor vanishes."""
        return (self._arrays.vertex[: self.slots, FLAGS] & GEOMETRIC) > 0

    def pinned(self) -> np.ndarray:
        """(slots,) whether the user has put a vertex where it is: smoothing does not move it."""
        return (self._arrays.vertex[: self.slots, FLAGS] & PINNED) > 0

    def locked(self) -> np.ndarray:
        """(slots,) whether the user has locked a vertex: it neither moves nor vanishes."""
        return (self._arrays.vertex[: self.slots, FLAGS] & LOCKED) > 0

    def boundary(self) -> np.ndarray:
        """(slots,) whether a vertex lies on the boundary; False for dead ids."""
        half = self._arrays.vertex[: self.slots, HALF]
        return (half >= 0) & (self._arrays.edge[np.maximum(half, 0), TWIN] < 0)

    def boundary_loops(self) -> list[np.ndarray]:
        """Vertex ids along each boundary loop, the domain on the left."""
        on_it = np.flatnonzero(self.boundary())
        half = self._arrays.vertex[on_it, HALF].astype(np.int64)
        ahead = half + 1 - self.k * ((half + 1) % self.k == 0)
        return construction.trace_loops(on_it, self._arrays.edge[ahead, ORIGIN].astype(np.int64))

    def live(self, h: int) -> bool:
        """Whether h is the id of a half-edge of a live element."""
        return 0 <= h < len(self._arrays.edge) and bool(self._arrays.edge[h, ORIGIN] >= 0)

    def next(self, h: int) -> int:
        """The next half-edge of the element."""
        return h + 1 if (h + 1) % self.k else h + 1 - self.k

    def prev(self, h: int) -> int:
        """The previous half-edge of the element."""
        return h - 1 if h % self.k else h + self.k - 1

    def twin(self, h: int) -> int:
        """The half-edge on the other side, -1 on the boundary."""
        return int(self._arrays.edge[h, TWIN])

    def origin(self, h: int) -> int:
        """The vertex where h starts."""
        return int(self._arrays.edge[h, ORIGIN])

    def target(self, h: int) -> int:
        """The vertex where h ends."""
        return int(self._arrays.edge[self.next(h), ORIGIN])

    def element_of(self, h: int) -> int:
        """The element that owns h."""
        return h // self.k

    def is_boundary(self, v: int) -> bool:
        """Whether the live vertex v lies on the boundary."""
        return bool(self._arrays.edge[self._arrays.vertex[v, HALF], TWIN] < 0)

    def outgoing(self, v: int) -> list[int]:
        """The half-edges that leave v, counter-clockwise, on the boundary from its outgoing
        edge.
        """
        return circulators.outgoing(self._arrays, v)

    def neighbours(self, v: int) -> list[int]:
        """The vertices joined to v, counter-clockwise."""
        return circulators.neighbours(self._arrays, v)

    def halfedge(self, a: int, b: int) -> int:
        """The half-edge from vertex a to vertex b, -1 if there is none."""
        if not (0 <= a < self.slots and self._arrays.vertex[a, HALF] >= 0):
            return -1
        return next((h for h in self.outgoing(a) if self.target(h) == b), -1)

    def joins(self, a: int, b: int) -> bool:
        """Whether an edge joins vertices a and b."""
        return self.halfedge(a, b) >= 0 or self.halfedge(b, a) >= 0

    def validate(self) -> None:
        """Check every invariant exhaustively; MeshError names the broken one and its place."""
        validation.validate(self._arrays, self._boundary)

    def __repr__(self) -> str:
        """Kind, size and score in one line."""
        return (
            f"<{type(self).__name__} {self.kind}: {self.n_vertices} vertices, {self.n_elements}"
            f" elements, s = {self.score}, s* = {self.optimum}>"
        )
