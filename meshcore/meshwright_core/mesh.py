"""The half-edge mesh: operations, moves and flags of vertices, history."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from operator import index
from typing import Any

import numpy as np

from meshwright_core.core import (
    construction,
    conversions,
    curve_checks,
    notebook_display,
    side_names,
)
from meshwright_core.core.arrays import (
    CURVE,
    DESIRED,
    ELEMENT_SLOTS,
    FLAGS,
    GEOMETRIC,
    GROUPED,
    HALF,
    JOURNAL_TOP,
    LOCKED,
    NAMING,
    STEP,
    STEP_COLUMNS,
    STEP_END,
    TRACE_IDS,
    VERTEX_SLOTS,
    MeshArrays,
    copied,
    enlarge,
)
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.core.entry_points import entry
from meshwright_core.core.grid_plan import GridPlan
from meshwright_core.core.mesh_boundary import MeshBoundary, Seats
from meshwright_core.core.mesh_view import MeshView
from meshwright_core.core.names import clean
from meshwright_core.core.planes import Plane
from meshwright_core.core.projected_seats import take_projected_seats
from meshwright_core.core.score_bound import bound_excess_of
from meshwright_core.core.side_names import Names
from meshwright_core.core.vertex_flags import PINNED
from meshwright_core.errors import MeshError, OperationRefused
from meshwright_core.history import journal
from meshwright_core.history.packed_steps import Steps, last_done
from meshwright_core.history.step_archive import Archive, cut_undone
from meshwright_core.operations import catalogue, global_lines, refusals, vertex_edits
from meshwright_core.operations.catalogue import Operation
from meshwright_core.operations.verdicts import YES, Edit, Verdict

_GROUP = -1  # the operation code of a transaction's step


class HalfEdgeMesh(MeshView):
    """A triangle or quad mesh that is edited by operations, with exact undo and redo.

    Ids of vertices, elements and half-edges are plain ints, stable until :meth:`compact`; -1 is
    none. See :mod:`meshwright_core.core.arrays` for the arrays behind it.
    """

    def __init__(
        self,
        arrays: MeshArrays,
        boundary: MeshBoundary,
        degree_cap: int = 0,
        *,
        seats_recorded: bool = True,
    ) -> None:
        """For :meth:`from_elements` and :meth:`copy`; wraps arrays that obey the invariants.

        seats_recorded: false for a mesh whose history is from before meshes had curves.
        """
        super().__init__(arrays, boundary)
        self.seats_recorded = seats_recorded
        """Whether undo and redo restore where vertices lie on curves to the bit, too. Otherwise
        they seat the boundary vertices by projection."""
        self.degree_cap = degree_cap
        """The highest degree that an operation may produce; 0 for no limit."""
        self.edits = 0
        """Grows with every change, undo and redo: tells an owner of the mesh whether others have
        changed it."""
        self.lowest = 0
        """The fewest :attr:`steps` since the owner has set this; -1 after :meth:`compact`."""
        self.redo_lost = False
        """Whether an edit has dropped undone steps since the owner has set this."""
        self.left_out: tuple[str, ...] = ()
        """What the file that it was read from held and this mesh does not, such as fields."""
        self._codes = catalogue.CODES[self.k]
        self._archive = Archive()

    @classmethod
    def from_elements(
        cls,
        points: np.ndarray | Sequence[Sequence[float]],
        elements: np.ndarray | Sequence[Sequence[int]],
        geometric: np.ndarray | Sequence[bool] | None = None,
        desired_degree: np.ndarray | Sequence[int] | None = None,
        corner_angle: float = construction.CORNER_ANGLE,
        boundary: MeshBoundary | None = None,
        seats: tuple[np.ndarray, np.ndarray] | None = None,
        regions: np.ndarray | Sequence[int] | None = None,
        names: Names | None = None,
        plane: Plane | None = None,
    ) -> HalfEdgeMesh:
        """A mesh from (n, 2|3) points and (m, 3|4) counter-clockwise elements.

        Vertex i of the input is vertex id i, element j is element id j; points of no element are
        dead ids. Elements of a mesh in a plane z = const whose areas sum up to less than zero,
        which is clockwise as a whole, are turned: (a, b, c, d) becomes (a, d, c, b). Raises
        MeshError, with the place, unless it is an oriented manifold mesh.

        Args:
            points: (n, 2|3).
            elements: (m, 3|4).
            geometric: (n,) flags; by default the vertices where the boundary or an interface turns
                by more than `corner_angle` degrees. Where interfaces end all are geometric.
            desired_degree: (n,); by default equation 2 of the paper.
            corner_angle: in degrees.
            boundary: the curves that the boundary and the interfaces run along; by default
                polylines through their vertices.
            seats: with `boundary`: curve (n,) int, -1 for none, and parameter (n,) float of each
                vertex, as the invariants of :mod:`meshwright_core.core.arrays` have it; these
                vertices are moved to the points of the curves there.
            regions: (m,) region of each element, from 0; by default all are of one.
            names: of regions and sides. Vertices where the name of a side changes are geometric.
            plane: the plane in space whose coordinates the points are, if it is not z = 0.
        """
        placed = None
        if boundary is None:
            elements = construction.counter_clockwise(np.asarray(points), np.asarray(elements))
        else:
            if seats is None:
                raise MeshError("the seats of the vertices on the boundary's curves are missing")
            placed, points = curve_checks.seated(np.asarray(points), boundary, *seats)
        arrays, boundary = construction.build(
            np.asarray(points),
            np.asarray(elements),
            None if geometric is None else np.asarray(geometric),
            None if desired_degree is None else np.asarray(desired_degree),
            corner_angle,
            boundary,
            placed,
            None if regions is None else np.asarray(regions),
        )
        if placed is not None:
            curve_checks.require_seats(arrays, boundary)
        if names is not None:
            boundary = side_names.give_names(arrays, boundary, names)
        if plane is not None:
            boundary = replace(boundary, plane=plane)
        excess = bound_excess_of(arrays)
        if excess != boundary.bound_excess:
            boundary = replace(boundary, bound_excess=excess)
        return cls(arrays, boundary)

    def check(self, operation: Operation | str, h: int) -> Verdict:
        """Whether the operation may be applied to half-edge h, and if not, why. No side effect."""
        code = self._codes.get(operation, -1)
        if code < 0:
            return Verdict.refused(
                refusals.OTHER_KIND, self, Operation(operation), h, self.degree_cap
            )
        h = index(h)
        found = catalogue.check_once(self._arrays, code, h, self.degree_cap)
        if found == refusals.ALLOWED or found == refusals.NEED_ROOM:
            return YES
        return self._refused(found, operation, h)

    def _refused(self, code: int, operation: Operation | str, h: int) -> Verdict:
        return Verdict.refused(code, self, Operation(operation), h, self.degree_cap)

    def allowed(self, h: int) -> dict[Operation, Verdict]:
        """The verdict on each operation of this kind of mesh at half-edge h."""
        return {Operation(name): self.check(name, h) for name in self._codes}

    def apply(self, operation: Operation | str, h: int) -> Edit:
        """Apply the operation to half-edge h: one undoable step (part of one in a transaction).

        Raises OperationRefused, and leaves every array as it was, where :meth:`check` refuses it.
        """
        code = self._codes.get(operation, -1)
        if code < 0:
            raise OperationRefused(self.check(operation, h).reason)
        h = index(h)
        undone = self.can_redo
        done = catalogue.apply_once(self._arrays, code, h, self.degree_cap)
        while done.code == refusals.NEED_ROOM:
            self._enlarge()
            done = catalogue.apply_once(self._arrays, code, h, self.degree_cap)
        if done.code != refusals.ALLOWED:
            raise OperationRefused(
                f"{operation} at half-edge {h} is not allowed: {self.check(operation, h).reason}"
            )
        self._count_edit(undone)
        self._archive.replace_future()
        touched = done.touched[: done.touched_count]
        if done.touched_count > catalogue.FEW:
            trace = self._arrays.trace
            touched = tuple(trace[TRACE_IDS : TRACE_IDS + done.touched_count].tolist())
        return Edit(operation, h, done.score_change, done.new_count, touched)

    def clean_all(self) -> list[Edit]:
        """Delete every global line that may be deleted: one undoable step; [] for triangles."""
        edits: list[Edit] = []
        if self.k == 3:
            return edits
        with self.transaction():
            first, found_since = 0, 0
            while True:
                h = global_lines.cleanable(self._arrays, first, self.degree_cap)
                if h < 0 and found_since < len(edits):
                    first, found_since = 0, len(edits)  # a deleted line may have freed another
                    continue
                if h < 0:
                    h = global_lines.cleanable_ring(self._arrays, self.degree_cap)
                if h < 0:
                    break
                first = self.origin(h)
                edits.append(self.apply(Operation.CLEANUP, h))
        return edits

    def _enlarge(self) -> None:
        """Double the arrays that are too small for what the last check requested in the trace."""
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
        """Enlarge the arrays once by so many vertices and elements."""
        counters = self._arrays.counters
        self._arrays = enlarge(
            self._arrays,
            int(counters[VERTEX_SLOTS]) + vertices,
            int(counters[ELEMENT_SLOTS]) + elements,
            0,
            0,
        )

    def room_for(self, vertices: int, elements: int) -> None:
        """Enlarge the arrays to at least so many vertices and elements, dead ones included."""
        self._arrays = enlarge(self._arrays, vertices, elements, 0, 0)

    def move(
        self,
        vertices: np.ndarray | Sequence[int],
        positions: np.ndarray,
        parameters: np.ndarray | Sequence[float] | None = None,
    ) -> None:
        """Move live vertices (n,) to positions (n, 3): one undoable step, or part of one.

        parameters: (n,) the new parameters of those on curves, which must keep the order of the
        vertices there; others are ignored. By default a vertex gets that of its projection to the
        part of its curve between its neighbours, and a geometric one keeps its own. Positions are
        taken as they are, whether on the curve or not.
        """
        ids = np.ascontiguousarray(vertices, dtype=np.int64)
        places = np.ascontiguousarray(positions, dtype=float)
        if places.shape != (len(ids), 3):
            raise MeshError(f"positions must be ({len(ids)}, 3), not {places.shape}")
        if not np.isfinite(places).all():
            raise MeshError("a vertex cannot move to a position that is not finite")
        for vertex in ids.tolist():
            self._require_live(vertex)
        self._make_room(4 * len(ids))
        if parameters is None:
            vertex_edits.move(self._arrays, ids, places)
            return
        along = np.ascontiguousarray(parameters, dtype=float)
        if along.shape != ids.shape:
            raise MeshError(f"parameters must be ({len(ids)},), not {along.shape}")
        curves = self._arrays.vertex[ids, CURVE]
        lengths = np.append(self._boundary.lengths(), np.inf)[curves]
        if not ((along >= 0.0) & (along <= lengths))[curves >= 0].all():
            raise MeshError("a parameter lies beyond the ends of its curve")
        vertex_edits.move_along(self._arrays, ids, places, along)

    def set_desired(self, vertex: int, degree: int) -> None:
        """Set the desired degree of a vertex: one undoable step; s and s* are updated."""
        self._require_live(vertex)
        if degree < 1:
            raise MeshError(f"the desired degree of vertex {vertex} must be positive, not {degree}")
        if not self._boundary.interfaces:
            self._set_vertex(vertex, DESIRED, int(degree))
            return
        with self.transaction():
            self._set_vertex(vertex, DESIRED, int(degree))
            excess = bound_excess_of(self._arrays)
            if excess != self._boundary.bound_excess:
                self._name(replace(self._boundary, bound_excess=excess))

    def renew_bound(self) -> None:
        """Compute s* anew, for a mesh from a file that states none: no step of the history."""
        excess = bound_excess_of(self._arrays)
        self._namings[self.naming] = replace(self._boundary, bound_excess=excess)

    def set_geometric(self, vertex: int, flag: bool = True) -> None:
        """Mark a vertex as geometric, or remove the mark: one undoable step.

        Raises MeshError if it would be removed from a junction, where interfaces end.
        """
        if not flag and vertex in self.junctions():
            raise MeshError(f"vertex {vertex} must stay geometric: an interface ends there")
        if not flag and vertex in self.side_ends():
            raise MeshError(f"vertex {vertex} must stay geometric: a named side ends there")
        self._set_flag(vertex, GEOMETRIC, flag)

    def set_locked(self, vertex: int, flag: bool = True) -> None:
        """Lock a vertex, so that it neither moves nor vanishes, or unlock it: one undoable step."""
        self._set_flag(vertex, LOCKED, flag)

    def set_pinned(self, vertex: int, flag: bool = True) -> None:
        """Pin a vertex, so that smoothing does not move it, or free it: one undoable step.

        Unlike a locked vertex it may vanish in an operation.
        """
        self._set_flag(vertex, PINNED, flag)

    def name_sides(self, halfedges: np.ndarray | Sequence[int], name: str) -> None:
        """Name edges of the boundary or of interfaces, "" for none: one undoable step.

        The ends of the named sides become geometric. Several names are separated by semicolons.
        Raises MeshError for an edge within a region.
        """
        ids = np.unique(np.asarray(halfedges, dtype=np.int64))
        for h in ids.tolist():
            if not self.live(h):
                raise MeshError(f"there is no half-edge {h} in this mesh")
        curve, span = edge_places(self._arrays, ids, self.k)
        if (curve < 0).any():
            raise MeshError(
                f"half-edge {int(ids[np.argmax(curve < 0)])} lies within a region: names belong to "
                "the boundary and to interfaces"
            )
        names = [clean(name)] * len(ids)
        self._name(side_names.with_side_names(self._boundary, curve, np.sort(span, axis=1), names))

    def name_regions(self, regions: Sequence[int], name: str) -> None:
        """Name regions, by their numbers, "" for none: one undoable step."""
        names = list(self.region_names)
        for region in regions:
            if not 0 <= region < len(names):
                raise MeshError(f"there is no region {region}: this mesh has {len(names)}")
            names[region] = clean(name)
        self._name(replace(self._boundary, region_names=tuple(names)))

    def rename(self, old: str, new: str) -> None:
        """Rename a group of sides and regions wherever it occurs: one undoable step.

        Raises MeshError if nothing has the name.
        """
        self._name(side_names.renamed(self._boundary, old, clean(new)))

    def plan_grid(self, plan: GridPlan) -> None:
        """Set what is wanted of a block grid of this mesh: one undoable step, unless it is that
        already.
        """
        if plan != self.grid_plan:
            self._name(replace(self._boundary, plan=plan))

    def _name(self, boundary: MeshBoundary) -> None:
        """Put other names in force, as part of the history."""
        with self.transaction():
            self._make_room(16)
            number = max(self._namings) + 1
            self._namings[number] = boundary
            m = self._arrays
            top = int(m.counters[JOURNAL_TOP])
            place = NAMING * journal.WRITE_KINDS + journal.VERTEX_WRITE  # in row 0
            m.journal[top] = place, m.vertex[0, NAMING]
            m.counters[JOURNAL_TOP] = top + 1
            m.vertex[0, NAMING] = number
            for vertex in side_names.changes(self._arrays, boundary).tolist():
                if not self._arrays.vertex[vertex, FLAGS] & GEOMETRIC:
                    self.set_geometric(vertex)

    def take_names(self, other: HalfEdgeMesh) -> None:
        """Name sides and regions that have no name as the other mesh does: no step of the history.

        The other has the same ids of vertices and elements, as before its boundary was placed on
        curves.
        """
        own = self._boundary
        named = {(int(a), int(b)) for name, ends in self.sides().items() if name for a, b in ends}
        edges, sides = [], []
        for name, ends in other.sides().items():
            for a, b in ends.tolist():
                if name and not {(a, b), (b, a)} & named:
                    edges.append((a, b))
                    sides.append(name)
        regions = list(own.region_names)
        pairs = set(zip(self.regions().tolist(), other.regions().tolist(), strict=True))
        for mine, theirs in pairs:
            regions[mine] = regions[mine] or other.region_names[theirs]
        tags = {**other.boundary_info.tags, **own.tags}
        if edges or tuple(regions) != own.region_names:
            found = Names(regions, np.array(edges, np.int64).reshape(-1, 2), sides, tags)
            self._namings[self.naming] = side_names.give_names(self._arrays, own, found)

    def add_naming(self, number: int, boundary: MeshBoundary) -> None:
        """Names that a step of a history that is to be adopted puts in force."""
        self._namings[number] = boundary

    def _set_flag(self, vertex: int, bit: int, flag: bool) -> None:
        self._require_live(vertex)
        flags = int(self._arrays.vertex[vertex, FLAGS])
        self._set_vertex(vertex, FLAGS, flags | bit if flag else flags & ~bit)

    def _set_vertex(self, vertex: int, column: int, value: int) -> None:
        self._make_room(16)
        entry(vertex_edits.set_vertex, 3)(self._arrays, vertex, column, value)

    def _require_live(self, vertex: int) -> None:
        if not (0 <= vertex < self.slots and self._arrays.vertex[vertex, HALF] >= 0):
            raise MeshError(f"there is no vertex {vertex} in this mesh")

    def _make_room(self, entries: int) -> None:
        self._count_edit(self.can_redo)
        self._archive.replace_future()
        while not entry(journal.has_room, 4)(self._arrays, self.k, 0, 0, entries):
            self._enlarge()

    def _count_edit(self, undone: bool = False) -> None:
        """Note a change that others than the owner may have made; undone: it drops undone steps."""
        self.edits += 1
        self.redo_lost |= undone

    @property
    def steps(self) -> int:
        """Steps that can be undone."""
        return self._archive.done + int(self._arrays.counters[STEP])

    @property
    def can_undo(self) -> bool:
        """Whether there is a step to undo."""
        return self.steps > 0

    @property
    def undone_steps(self) -> int:
        """Undone steps that can be redone."""
        counters = self._arrays.counters
        return int(counters[STEP_END] - counters[STEP]) + self._archive.undone

    @property
    def in_transaction(self) -> bool:
        """Whether a :meth:`transaction` is open."""
        return bool(self._arrays.counters[GROUPED])

    @property
    def can_redo(self) -> bool:
        """Whether there is an undone step to redo."""
        counters = self._arrays.counters
        return bool(counters[STEP] < counters[STEP_END] or self._archive.future)

    def undo(self) -> bool:
        """Undo the last step, exact to the bit; False if there is none."""
        self._refuse_in_transaction()
        if self._archive.past and not self._arrays.counters[STEP]:
            self._arrays = self._archive.trimmed(self._archive.fetch_past(self._arrays))
        undone = bool(entry(journal.undo, 0)(self._arrays))
        self._count_edit()
        self.lowest = min(self.lowest, self.steps)
        self._project_seats()
        return undone

    def redo(self) -> bool:
        """Redo the last undone step, exact to the bit; False if there is none."""
        self._refuse_in_transaction()
        counters = self._arrays.counters
        if self._archive.future and counters[STEP] == counters[STEP_END]:
            self._arrays = self._archive.trimmed(self._archive.fetch_future(self._arrays))
        redone = bool(entry(journal.redo, 0)(self._arrays))
        self._count_edit()
        self._project_seats()
        return redone

    def _project_seats(self) -> None:
        if not self.seats_recorded:
            take_projected_seats(self._arrays, self.boundary_loops(), self._boundary)

    def _refuse_in_transaction(self) -> None:
        if self._arrays.counters[GROUPED]:
            raise MeshError("a transaction is open: undo and redo must wait for its end")

    def cut_redo(self) -> tuple[Steps, ...]:
        """Remove the undone steps from the history and return them, for :meth:`graft_redo`."""
        self._refuse_in_transaction()
        cut = (*cut_undone(self._arrays), *self._archive.future)
        self._archive.replace_future()
        return cut

    def graft_redo(self, undone: Sequence[Steps]) -> None:
        """Replace the steps that can be redone by `undone`.

        They must have been cut from this mesh, or a copy of it, in exactly its present state.
        """
        self.cut_redo()
        self._archive.replace_future(undone)

    def last_step(self) -> Steps:
        """The last done step in the form of :meth:`graft_redo` after an undo; MeshError if none."""
        if not self.steps:
            raise MeshError("there is no step in the history")
        if not self._arrays.counters[STEP]:
            self._arrays = self._archive.fetch_past(self._arrays)
        return last_done(self._arrays)

    def packed_steps(self) -> tuple[list[Steps], list[Steps]]:
        """All steps that can be undone, and all that can be redone; the mesh is not changed."""
        self._refuse_in_transaction()
        return self._archive.everything(self._arrays)

    def adopt_steps(self, done: Sequence[Steps], undone: Sequence[Steps]) -> None:
        """Replace the history by steps that were packed in exactly the present state."""
        self.cut_redo()
        counters = self._arrays.counters
        counters[STEP] = counters[STEP_END] = counters[JOURNAL_TOP] = 0
        self._archive = Archive(done, undone)

    def trim(self) -> None:
        """Pack the steps far from the present into a third of the memory; no step is lost."""
        self._refuse_in_transaction()
        self._arrays = self._archive.trimmed(self._arrays)

    @contextmanager
    def transaction(self) -> Iterator[None]:
        """Make all changes inside one undoable step; an exception rolls all of them back.

        Transactions within a transaction belong to the outermost one. One that changes nothing
        leaves no step. After one that is rolled back or changes nothing, redo works as before.
        """
        if self._arrays.counters[GROUPED]:
            yield
            return
        undone = self.cut_redo()
        self._make_room(0)
        entry(journal.begin_step, 2)(self._arrays, _GROUP, -1)
        before = int(self._arrays.counters[JOURNAL_TOP])
        self._arrays.counters[GROUPED] = 1
        try:
            yield
        except BaseException:
            self._close_group()
            self.undo()
            self.graft_redo(undone)
            raise
        if int(self._arrays.counters[JOURNAL_TOP]) == before:
            self._arrays.counters[GROUPED] = 0
            self.graft_redo(undone)
        else:
            self._close_group()

    def _close_group(self) -> None:
        self._arrays.counters[GROUPED] = 0
        entry(journal.end_step, 0)(self._arrays)

    def copy(self, history: bool = False) -> HalfEdgeMesh:
        """An independent mesh with the same ids and free slots; by default without a history."""
        arrays = copied(self._arrays)
        if history:
            self._refuse_in_transaction()
        else:
            arrays = arrays._replace(
                journal=np.zeros((1024, 2), np.int64), steps=np.zeros((64, STEP_COLUMNS), np.int64)
            )
            for counter in (JOURNAL_TOP, STEP, STEP_END, GROUPED):
                arrays.counters[counter] = 0
        recorded = self.seats_recorded or not history
        twin = HalfEdgeMesh(arrays, self._boundary, self.degree_cap, seats_recorded=recorded)
        twin.left_out = self.left_out
        if history:
            twin._archive = self._archive.copy()
            twin._namings = dict(self._namings)
        return twin

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
        arrays, boundary = construction.build(
            self.points[live],
            vertex_map[self.elements()],
            (rows[:, FLAGS] & GEOMETRIC) > 0,
            rows[:, DESIRED],
            boundary=self._boundary.renumbered(vertex_map),
            seats=Seats(rows[:, CURVE], self._arrays.parameter[live]),
            regions=self.regions(),
        )
        arrays.vertex[: len(live), FLAGS] = rows[:, FLAGS]
        self._arrays, self._archive = arrays, Archive()
        self._count_edit()
        self.lowest = -1
        self._take_boundary(boundary)
        self.seats_recorded = True
        return vertex_map, element_map

    def to_pyvista(self) -> Any:
        """A pyvista.PolyData, with data by point and element and names; MeshError without PyVista.

        This and the other conversions: :mod:`meshwright_core.io.objects.outgoing`.
        """
        return conversions.converted("pyvista", self)

    def to_trimesh(self) -> Any:
        """A trimesh.Trimesh, quads as two triangles each; MeshError without trimesh."""
        return conversions.converted("trimesh", self)

    def to_meshio(self) -> Any:
        """A meshio.Mesh, groups as its `cell_sets`; MeshError without meshio."""
        return conversions.converted("meshio", self)

    def to_shapely(self) -> Any:
        """Arrays of shapely's geometries, and data as arrays; MeshError without shapely."""
        return conversions.converted("shapely", self)

    def _repr_mimebundle_(
        self, include: object = None, exclude: object = None
    ) -> notebook_display.Bundle:
        """A still picture at the end of a notebook cell, where one can be drawn."""
        return notebook_display.bundle(self)
