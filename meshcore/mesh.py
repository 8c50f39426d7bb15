"""The half-edge mesh as a class: a thin skin over the arrays and the compiled kernels."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from meshcore import construct, journal, navigation, operations, refusals, validate
from meshcore.errors import MeshError, OperationRefused
from meshcore.halfedge import (
    BOUNDARY_EDGES,
    DEGREE,
    DELTA_SUM,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    FLAGS,
    GEOMETRIC,
    GROUPED,
    HALF,
    IRREGULAR,
    JOURNAL_TOP,
    LOCKED,
    NEW_COUNT,
    ORIGIN,
    SCORE,
    STEP,
    STEP_END,
    TOUCHED_COUNT,
    TRACE_IDS,
    TWIN,
    VERTEX_SLOTS,
    VERTICES,
    MeshArrays,
    enlarge,
)
from meshcore.operations import Operation
from meshcore.verdicts import Edit, Verdict

Outline = list[tuple[np.ndarray, np.ndarray]]

_KINDS = {3: "tri", 4: "quad"}
_GROUP = -1  # the operation code of a transaction's step


class HalfEdgeMesh:
    """A triangle or quad mesh, with exact undo, that lets one operation after another change it.

    Ids of vertices, elements and half-edges are plain ints, stable until :meth:`compact`; -1 is none.
    See :mod:`meshcore.halfedge` for the arrays behind it.
    """

    def __init__(self, arrays: MeshArrays, outline: Outline, degree_cap: int = 0) -> None:
        """For :meth:`from_elements` and :meth:`copy`; wraps arrays that obey the invariants."""
        self._arrays = arrays
        self.outline = outline
        """One (vertex ids (m,), points (m, 3)) per boundary loop, as the mesh was made: the sides on
        which boundary vertices slide."""
        self.degree_cap = degree_cap
        """The highest degree that an operation may bring about; 0 for no limit."""
        self.k: int = int(arrays.counters[10])
        self._codes = operations.CODES[self.k]

    @classmethod
    def from_elements(
        cls,
        points: np.ndarray | Sequence[Sequence[float]],
        elements: np.ndarray | Sequence[Sequence[int]],
        geometric: np.ndarray | Sequence[bool] | None = None,
        desired_degree: np.ndarray | Sequence[int] | None = None,
        corner_angle: float = construct.CORNER_ANGLE,
    ) -> HalfEdgeMesh:
        """A mesh from (n, 2|3) points and (m, 3|4) counter-clockwise elements.

        Vertex i of the input is vertex id i, element j is element id j; points of no element are dead
        ids. geometric: (n,) flags; by default the boundary vertices where the boundary turns by more
        than `corner_angle` degrees. desired_degree: (n,); by default equation 2 of the paper.
        Raises MeshError, saying where, for anything that is no oriented manifold mesh.
        """
        arrays = construct.build(
            np.asarray(points),
            np.asarray(elements),
            None if geometric is None else np.asarray(geometric),
            None if desired_degree is None else np.asarray(desired_degree),
            corner_angle,
        )
        mesh = cls(arrays, [])
        mesh.outline = [(loop, mesh.points[loop].copy()) for loop in mesh.boundary_loops()]
        return mesh

    # -- counts and score ------------------------------------------------------------------------

    @property
    def kind(self) -> str:
        """ "tri" or "quad"."""
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
        """s* = |sum of Delta|, which no operation changes and s never falls below (equation 6)."""
        return abs(int(self._arrays.counters[DELTA_SUM]))

    @property
    def irregular_count(self) -> int:
        """Vertices whose degree is not the desired one."""
        return int(self._arrays.counters[IRREGULAR])

    # -- whole arrays ----------------------------------------------------------------------------

    @property
    def arrays(self) -> MeshArrays:
        """The arrays themselves, for compiled code; they are replaced when the mesh outgrows them."""
        return self._arrays

    @property
    def slots(self) -> int:
        """Vertex ids ever used: one more than the largest, dead ones included."""
        return int(self._arrays.counters[VERTEX_SLOTS])

    @property
    def points(self) -> np.ndarray:
        """(slots, 3) float64 coordinates by vertex id, a writable view; ask again after an edit."""
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
        return construct.trace_loops(on_it, self._arrays.edge[ahead, ORIGIN].astype(np.int64))

    # -- walking ---------------------------------------------------------------------------------

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
        """The half-edges that leave v, counter-clockwise, on the boundary from its outgoing edge."""
        return navigation.outgoing(self._arrays, v)

    def neighbours(self, v: int) -> list[int]:
        """The vertices joined to v, counter-clockwise."""
        return navigation.neighbours(self._arrays, v)

    def halfedge(self, a: int, b: int) -> int:
        """The half-edge from vertex a to vertex b, -1 if there is none."""
        if not (0 <= a < self.slots and self._arrays.vertex[a, HALF] >= 0):
            return -1
        return next((h for h in self.outgoing(a) if self.target(h) == b), -1)

    # -- operations ------------------------------------------------------------------------------

    def check(self, operation: Operation | str, h: int) -> Verdict:
        """Whether the operation may be applied to half-edge h, and if not, why. No side effect."""
        code = self._codes.get(operation, -1)
        if code < 0:
            return Verdict(refusals.OTHER_KIND, self, Operation(operation), h)
        found = operations.check(self._arrays, code, h, self.degree_cap)
        return Verdict(found, self, Operation(operation), h)

    def allowed(self, h: int) -> dict[Operation, Verdict]:
        """The verdict on each operation of this kind of mesh at half-edge h."""
        return {Operation(name): self.check(name, h) for name in self._codes}

    def apply(self, operation: Operation | str, h: int) -> Edit:
        """Apply the operation to half-edge h: one undoable step (part of one in a transaction).

        Raises OperationRefused, and leaves every array as it was, where :meth:`check` says no.
        """
        code = self._codes.get(operation, -1)
        if code < 0:
            raise OperationRefused(self.check(operation, h).reason)
        done = operations.apply(self._arrays, code, h, self.degree_cap)
        while done[0] == refusals.NEED_ROOM:
            self._enlarge()
            done = operations.apply(self._arrays, code, h, self.degree_cap)
        if done[0] != refusals.ALLOWED:
            raise OperationRefused(
                f"{operation} at half-edge {h} is not allowed: {self.check(operation, h).reason}"
            )
        if done[3] > 6:
            trace = self._arrays.trace
            ids = tuple(trace[TRACE_IDS : TRACE_IDS + int(trace[TOUCHED_COUNT])].tolist())
            return Edit(operation, h, done[1], int(trace[NEW_COUNT]), ids)
        return Edit(operation, h, done[1], done[2], done[4 : 4 + done[3]])

    def clean_all(self) -> list[Edit]:
        """Delete every global line that may be deleted: one undoable step; [] for triangles."""
        edits: list[Edit] = []
        if self.k == 3:
            return edits
        with self.transaction():
            first, found_since = 0, 0
            while True:
                h = navigation.cleanable(self._arrays, first, self.degree_cap)
                if h < 0 and found_since < len(edits):
                    first, found_since = 0, len(edits)  # a deleted line may have freed another
                    continue
                if h < 0:
                    h = navigation.cleanable_ring(self._arrays, self.degree_cap)
                if h < 0:
                    break
                first = self.origin(h)
                edits.append(self.apply(Operation.CLEANUP, h))
        return edits

    def _enlarge(self) -> None:
        """Double whatever is too small for what the last check wanted."""
        arrays = self._arrays
        counters = arrays.counters
        wanted = arrays.trace[TRACE_IDS : TRACE_IDS + 3].tolist()

        def enough(capacity: int, needed: int) -> int:
            return max(2 * capacity, needed) if needed > capacity else capacity

        self._arrays = enlarge(
            arrays,
            enough(len(arrays.vertex), int(counters[VERTEX_SLOTS]) + wanted[0]),
            enough(len(arrays.element_mark), int(counters[ELEMENT_SLOTS]) + wanted[1]),
            enough(len(arrays.journal), int(counters[JOURNAL_TOP]) + wanted[2]),
            enough(len(arrays.steps), int(counters[STEP]) + 1),
        )

    def reserve(self, vertices: int, elements: int) -> None:
        """Make room for so many more vertices and elements at once, so that later edits need none."""
        counters = self._arrays.counters
        self._arrays = enlarge(
            self._arrays,
            int(counters[VERTEX_SLOTS]) + vertices,
            int(counters[ELEMENT_SLOTS]) + elements,
            0,
            0,
        )

    # -- other journalled changes ----------------------------------------------------------------

    def move(self, vertices: np.ndarray | Sequence[int], positions: np.ndarray) -> None:
        """Put live vertices (n,) at positions (n, 3); one undoable step, or part of one."""
        ids = np.ascontiguousarray(vertices, dtype=np.int64)
        places = np.ascontiguousarray(positions, dtype=float)
        if places.shape != (len(ids), 3):
            raise MeshError(f"positions must be ({len(ids)}, 3), not {places.shape}")
        if not np.isfinite(places).all():
            raise MeshError("a vertex cannot move to a place that is no number")
        for vertex in ids.tolist():
            self._require_live(vertex)
        self._make_room(3 * len(ids))
        navigation.move(self._arrays, ids, places)

    def set_desired(self, vertex: int, degree: int) -> None:
        """Set the desired degree of a vertex: one undoable step; s and s* follow."""
        self._require_live(vertex)
        if degree < 1:
            raise MeshError(f"the desired degree of vertex {vertex} must be positive, not {degree}")
        self._set_vertex(vertex, DESIRED, int(degree))

    def set_geometric(self, vertex: int, flag: bool = True) -> None:
        """Mark a vertex as part of the geometry, or no longer so: one undoable step."""
        self._set_flag(vertex, GEOMETRIC, flag)

    def set_locked(self, vertex: int, flag: bool = True) -> None:
        """Lock a vertex, so that it neither moves nor vanishes, or unlock it: one undoable step."""
        self._set_flag(vertex, LOCKED, flag)

    def _set_flag(self, vertex: int, bit: int, flag: bool) -> None:
        self._require_live(vertex)
        flags = int(self._arrays.vertex[vertex, FLAGS])
        self._set_vertex(vertex, FLAGS, flags | bit if flag else flags & ~bit)

    def _set_vertex(self, vertex: int, column: int, value: int) -> None:
        self._make_room(16)
        navigation.set_vertex(self._arrays, vertex, column, value)

    def _require_live(self, vertex: int) -> None:
        if not (0 <= vertex < self.slots and self._arrays.vertex[vertex, HALF] >= 0):
            raise MeshError(f"there is no vertex {vertex} in this mesh")

    def _make_room(self, entries: int) -> None:
        while not journal.has_room(self._arrays, self.k, 0, 0, entries):
            self._enlarge()

    # -- history ---------------------------------------------------------------------------------

    @property
    def steps(self) -> int:
        """Steps that can be undone."""
        return int(self._arrays.counters[STEP])

    @property
    def can_undo(self) -> bool:
        """Whether there is a step to undo."""
        return self.steps > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is an undone step to do again."""
        return bool(self._arrays.counters[STEP] < self._arrays.counters[STEP_END])

    def undo(self) -> bool:
        """Take back the last step, exact to the bit; False if there is none."""
        return self._history(journal.undo)

    def redo(self) -> bool:
        """Do the last undone step again, exact to the bit; False if there is none."""
        return self._history(journal.redo)

    def _history(self, kernel) -> bool:  # type: ignore[no-untyped-def]
        if self._arrays.counters[GROUPED]:
            raise MeshError("a transaction is open: undo and redo must wait for its end")
        return bool(kernel(self._arrays))

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """Make everything inside one undoable step; an exception rolls all of it back.

        Transactions within a transaction belong to the outermost one. One that changes nothing leaves
        no step.
        """
        if self._arrays.counters[GROUPED]:
            yield
            return
        self._make_room(0)
        journal.begin_step(self._arrays, _GROUP, -1)
        before = int(self._arrays.counters[JOURNAL_TOP])
        self._arrays.counters[GROUPED] = 1
        try:
            yield
        except BaseException:
            self._close_group()
            self.undo()
            self._arrays.counters[STEP_END] = self._arrays.counters[STEP]
            raise
        if int(self._arrays.counters[JOURNAL_TOP]) == before:
            self._arrays.counters[GROUPED] = 0
        else:
            self._close_group()

    def _close_group(self) -> None:
        self._arrays.counters[GROUPED] = 0
        journal.end_step(self._arrays)

    # -- whole mesh ------------------------------------------------------------------------------

    def copy(self) -> HalfEdgeMesh:
        """An independent mesh with the same ids and free slots, and no history."""
        copied = [array.copy() for array in self._arrays[:-2]]
        arrays = MeshArrays(
            *copied, np.zeros((1024, 2), np.int64), np.zeros_like(self._arrays.steps[:64])
        )
        for counter in (JOURNAL_TOP, STEP, STEP_END, GROUPED):
            arrays.counters[counter] = 0
        return HalfEdgeMesh(arrays, list(self.outline), self.degree_cap)

    def validate(self) -> None:
        """Check every invariant the slow way; raises MeshError that says what is broken and where."""
        validate.validate(self._arrays)

    def compact(self) -> tuple[np.ndarray, np.ndarray]:
        """Renumber vertices and elements without gaps; the history is gone.

        Returns the maps old id -> new id, -1 for dead ids, of vertices (slots,) and elements.
        """
        live, ids = self.vertices(), self.element_ids()
        vertex_map = np.full(self.slots, -1, np.int64)
        vertex_map[live] = np.arange(len(live))
        element_map = np.full(int(self._arrays.counters[ELEMENT_SLOTS]), -1, np.int64)
        element_map[ids] = np.arange(len(ids))
        rows = self._arrays.vertex[live]
        arrays = construct.build(
            self.points[live],
            vertex_map[self.elements()],
            (rows[:, FLAGS] & GEOMETRIC) > 0,
            rows[:, DESIRED],
        )
        arrays.vertex[: len(live), FLAGS] = rows[:, FLAGS]
        self._arrays = arrays
        self.outline = [
            (np.where(ids < len(vertex_map), vertex_map[np.minimum(ids, len(vertex_map) - 1)], -1), at)
            for ids, at in self.outline
        ]
        return vertex_map, element_map

    def __repr__(self) -> str:
        """Kind, size and score in one line."""
        return (
            f"<HalfEdgeMesh {self.kind}: {self.n_vertices} vertices, {self.n_elements} elements,"
            f" s = {self.score}, s* = {self.optimum}>"
        )
