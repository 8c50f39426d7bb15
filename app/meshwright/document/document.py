"""The document: the mesh that is edited, its history, and the events that views connect to.

Imports neither Qt nor torch nor the agent. One call that changes the mesh is one step of the
history.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from meshwright.document.history import YOU, History, HistoryStep
from meshwright.document.selection import Selection
from meshwright.document.storage import document_file, file_stamp, project_file
from meshwright.document.storage.document_state import DocumentState
from meshwright.document.timeline import NO_MESH as NO_MESH
from meshwright.document.timeline import UndoTimeline
from meshwright.signals import Signal
from meshwright_core import Edit, HalfEdgeMesh, MeshError, Operation, Verdict
from meshwright_core.analysis.submesh import temporarily_locked
from meshwright_core.core.construction import is_flat
from meshwright_core.core.grid_plan import GridPlan
from meshwright_core.core.names import clean
from meshwright_core.core.notebook_display import Bundle, bundle
from meshwright_core.core.score import normalised_return
from meshwright_core.history.packed_steps import Steps
from meshwright_core.operations.catalogue import CATALOGUE

Result = TypeVar("Result")

PLAN = "plan"
"""The action of steps that change what is wanted of a block grid."""
NAME = "name"
"""The action of steps that name sides or regions."""


def title_of(operation: Operation | str, kind: str) -> str:
    """The catalogue's title of an operation on meshes of ``kind``."""
    value = Operation(operation)
    for info in CATALOGUE:
        if info.operation == value and info.kind == kind:
            return info.title
    return value.value


class Document:
    """A mesh being edited, or none yet.

    Events, all emitted in the caller's thread: ``replaced()`` the document holds another mesh;
    ``changed()`` connectivity, positions or flags changed; ``score_changed()``;
    ``history_changed()``; ``saved_changed()`` name, path or :attr:`modified` may differ;
    ``hover_changed(halfedge)``. Every ``replaced`` is followed by the others. Before the others
    comes ``recorded(event, number)``, for autosave: ``"step"`` a step was appended to the history,
    ``"go"`` the cursor moved to that number, ``"branch"`` that branch was taken, ``"python"`` the
    mesh itself was changed, ``"saved"``.
    """

    def __init__(
        self, mesh: HalfEdgeMesh | None = None, name: str = "", path: str | Path | None = None
    ) -> None:
        self.replaced = Signal()
        self.changed = Signal()
        self.score_changed = Signal()
        self.history_changed = Signal()
        self.saved_changed = Signal()
        self.hover_changed = Signal()
        self.recorded = Signal()
        self.revision = 0
        """Grows with every change of the mesh."""
        self.auto_smooth = True
        """Whether the vertices around an operation are smoothed, on plane meshes."""
        self.smooth_surfaces = False
        """Whether they are so on surfaces that are not plane, which lose their shape by it."""
        self.bar: Callable[[str], str] | None = None
        """Returns why an operation is not offered now, as a sentence, or an empty text; set while
        a level is played."""
        self.settings: dict[str, Any] = {}
        """What the views store in a project: plain values that JSON can hold."""
        self._timeline = UndoTimeline(mesh)
        self._plane: bool | None = None
        self._name = name
        self._path = Path(path) if path is not None else None
        self._hover = -1
        self._saved = (0, 0)
        self._stamp = file_stamp.of(self._path)
        self._passing = False
        self._together = 0
        self._unannounced = False
        self.selection = Selection(self)

    # What it holds

    @property
    def mesh(self) -> HalfEdgeMesh | None:
        """The mesh, for reading only; None while the document is empty."""
        return self._timeline.mesh

    @property
    def history(self) -> History:
        """The steps that were done and undone."""
        return self._timeline.history

    @property
    def empty(self) -> bool:
        """True while there is no mesh."""
        return self.mesh is None

    @property
    def kind(self) -> str:
        """``"tri"`` or ``"quad"``; empty string without a mesh."""
        return self.mesh.kind if self.mesh is not None else ""

    @property
    def hover(self) -> int:
        """The half-edge under the mouse, -1 for none."""
        return self._hover

    @hover.setter
    def hover(self, halfedge: int) -> None:
        if halfedge != self._hover:
            self._hover = halfedge
            self.hover_changed.emit(halfedge)

    # Scores

    @property
    def score(self) -> int:
        """s of the mesh now; 0 without a mesh."""
        return self.mesh.score if self.mesh is not None else 0

    @property
    def optimum(self) -> int:
        """s*, the lowest score that any connectivity can have; 0 without a mesh."""
        return self.mesh.optimum if self.mesh is not None else 0

    @property
    def start_score(self) -> int:
        """The score where this document began (or where desired degrees last changed)."""
        return self.history.start_score

    @property
    def best_score(self) -> int:
        """The lowest score on the way from the start to here."""
        return self.history.best_score

    @property
    def normalised_return(self) -> float:
        """(start - best) / (start - s*) so far, 1 when there was nothing to gain."""
        return normalised_return(self.start_score, self.best_score, self.optimum)

    @property
    def at_optimum(self) -> bool:
        """True if s = s*: no connectivity is better under these desired degrees."""
        return self.mesh is not None and self.mesh.score == self.mesh.optimum

    # Where it is saved

    @property
    def name(self) -> str:
        """The name in the window's title."""
        return self._name

    @property
    def path(self) -> Path | None:
        """The file that *Save* writes, None if there is none yet."""
        return self._path

    @property
    def passing(self) -> bool:
        """True while changes need not be saved, as in a level; saving ends that."""
        return self._passing

    @property
    def modified(self) -> bool:
        """True if closing would lose anything: the mesh, or steps and branches of the history.

        Only projects store the history: after saving to a mesh file it still counts, and so do
        steps that were undone. A document that is :attr:`passing` never counts as modified.
        """
        return not self._passing and self.saved_state != self._saved

    @property
    def mesh_modified(self) -> bool:
        """True if the mesh itself differs from its file, or from the state it began in."""
        return not self._passing and self.history.mark != self._saved[0]

    @property
    def changed_on_disk(self) -> bool:
        """True if the file at :attr:`path` is not as it was when this document last read or wrote
        it: another window or program has saved to it, or deleted it.
        """
        return self._path is not None and file_stamp.of(self._path) != self._stamp

    @property
    def saved_state(self) -> tuple[int, int]:
        """Serials of the last step done and of the last step made: identify the present state."""
        return self.history.mark, self.history.given[0]

    def keep(self) -> None:
        """End :attr:`passing`; the present state counts as saved."""
        if self._passing:
            self._passing, self._saved = False, self.saved_state
            self.saved_changed.emit()

    # Another mesh

    def replace(
        self,
        mesh: HalfEdgeMesh | None,
        name: str = "",
        path: str | Path | None = None,
        passing: bool = False,
    ) -> None:
        """Replace the mesh; the history starts again.

        passing: changes need not be saved, and autosave does not record them.
        """
        self._take(UndoTimeline(mesh), name, path)
        self._passing = passing
        self._announce_replacement()

    def open(self, path: str | Path, to_quads: bool = False) -> None:
        """Read a mesh file or a project, or mesh the shape in a drawing.

        to_quads: make quads of the triangles of a mesh file; it is then not where the mesh is
            saved.

        A shape gets elements of the present kind, quads if there is no mesh; its file is not where
        the mesh is saved. On MeshError or OSError the document stays as it was.
        """
        self.adopt(document_file.read_meshed(path, self.kind or "quad", to_quads))

    def adopt(self, state: DocumentState) -> None:
        """Continue from a stored state: a mesh with its history, at the cursor it had."""
        self._take(UndoTimeline(state.mesh, state.history), state.name, state.path)
        self._saved = state.saved
        if state.stamp is not None:
            self._stamp = state.stamp
        self.settings = dict(state.settings)
        self._announce_replacement()

    def state(self) -> DocumentState:
        """All that is stored of the document; the mesh in it is the document's own, not a copy."""
        return DocumentState(
            self._need(),
            self.history,
            self._name,
            self._path,
            self._saved,
            dict(self.settings),
            self._stamp,
        )

    def save(self, path: str | Path | None = None) -> Path:
        """Write the mesh to ``path`` or where it came from; returns where it is now.

        A path that ends in ``.meshwright`` gets the whole history too. What another program has
        written there is overwritten: see :attr:`changed_on_disk`.
        """
        target = Path(path) if path is not None else self._path
        if target is None:
            raise MeshError("This mesh has no file yet: choose a name with 'Save as'.")
        document_file.write(target, self.state())
        self._path, self._name, self._passing = target, target.stem, False
        self._stamp = file_stamp.of(target)
        mark, given = self.saved_state
        self._saved = mark, given if project_file.is_project(target) else self._saved[1]
        self.recorded.emit("saved", 0)
        self.saved_changed.emit()
        return target

    def _repr_mimebundle_(self, include: object = None, exclude: object = None) -> Bundle:
        """A picture of the mesh at the end of a notebook's cell."""
        if self.mesh is None:
            return {"text/plain": NO_MESH}, {}
        return bundle(self.mesh, self._name)

    def _take(self, timeline: UndoTimeline, name: str, path: str | Path | None) -> None:
        self._timeline = timeline
        self._plane = None
        self._name = name
        self._path = Path(path) if path is not None else None
        self._hover = -1
        self._saved = (0, 0)
        self._stamp = file_stamp.of(self._path)
        self._passing = False
        self.settings = {}

    def _announce_replacement(self) -> None:
        self.revision += 1
        self.replaced.emit()
        self._emit_all()

    # Undo and redo

    @property
    def can_undo(self) -> bool:
        """True if there is a step to take back."""
        return self.history.can_undo

    @property
    def can_redo(self) -> bool:
        """True if a step has been taken back."""
        return self.history.can_redo

    def undo(self) -> HistoryStep | None:
        """Take back the last step; returns it, None if there is none."""
        self.catch_up()
        step = self.history.last
        self.go_to(self.history.cursor - 1)
        return step

    def redo(self) -> HistoryStep | None:
        """Do again what was taken back last; returns that step, None if there is none."""
        self.catch_up()
        if not self.history.can_redo:
            return None
        self.go_to(self.history.cursor + 1)
        return self.history.last

    def go_to(self, cursor: int) -> None:
        """Undo or redo until ``cursor`` steps are done; beyond either end it stops there."""
        self.catch_up()
        cursor = min(max(cursor, 0), len(self.history))
        if cursor != self.history.cursor:
            self._timeline.go_to(cursor)
            self._announce("go", cursor)

    def take_branch(self, index: int) -> None:
        """Go to the end of ``history.branches[index]``; the steps left for it become a branch."""
        self.catch_up()
        self._timeline.take_branch(index)
        self._announce("branch", index)

    def replay(self, step: HistoryStep, steps: tuple[Steps, ...]) -> None:
        """Do a recorded step: ``step`` describes it, ``steps`` are the mesh's own record of it.

        Raises MeshError, and leaves the document as it was, if it does not follow from here.
        """
        self._timeline.replay(step, steps)
        self._announce("step", self.history.cursor)

    def catch_up(self) -> bool:
        """Record what was changed on the mesh itself, as by ``document.mesh.apply(...)``; returns
        whether it was. Every call that needs the mesh does this first.

        Each such step becomes a step of the history, "Edit in Python". Steps that were undone there
        count as undone here; undone steps that it has dropped leave the history.
        """
        if not self._timeline.behind or not self._timeline.catch_up():
            return False
        self._announce("python", self.history.cursor)
        return True

    @contextmanager
    def together(self) -> Iterator[None]:
        """Emit the events of all changes inside once, at the end, but ``recorded`` with each."""
        self._together += 1
        try:
            yield
        finally:
            self._together -= 1
            if not self._together and self._unannounced:
                self._unannounced = False
                self._emit_changed()

    def need_mesh(self) -> HalfEdgeMesh:
        """The mesh, for reading only; MeshError without one."""
        return self._timeline.need_mesh()

    def _need(self) -> HalfEdgeMesh:
        mesh = self._timeline.need_mesh()
        self.catch_up()
        return mesh

    def _do(
        self, action: str, title: str, halfedge: int, by: str, work: Callable[[], Result]
    ) -> Result:
        mesh = self._timeline.need_mesh()

        def whole() -> Result:
            result = work()
            # ids of vertices that are gone are used again, and must not bring back old wishes
            mesh.plan_grid(mesh.grid_plan.kept(mesh.joins))
            return result

        result, changed = self._timeline.do(action, title, halfedge, by, whole)
        if changed:
            self._announce("step", self.history.cursor)
        return result

    def _announce(self, event: str, number: int) -> None:
        self.revision += 1
        self.recorded.emit(event, number)
        if self._together:
            self._unannounced = True
        else:
            self._emit_changed()

    def _emit_changed(self) -> None:
        if self._hover >= 0 and not self._need().live(self._hover):
            self.hover = -1
        self._emit_all()

    def _emit_all(self) -> None:
        self.changed.emit()
        self.score_changed.emit()
        self.history_changed.emit()
        self.saved_changed.emit()

    # Changing the mesh

    def check(self, operation: Operation | str, halfedge: int) -> Verdict:
        """The mesh's verdict: allowed, or the reason in words."""
        return self._need().check(operation, halfedge)

    def allowed(self, halfedge: int) -> dict[Operation, Verdict]:
        """A verdict for every operation of the mesh's kind at one half-edge."""
        return self._need().allowed(halfedge)

    def submit(
        self,
        operation: Operation | str,
        halfedge: int,
        by: str = YOU,
        held: np.ndarray | None = None,
        thorough: bool = True,
        smooth: bool = True,
    ) -> Edit:
        """Apply one operation and smooth around it, as one step; OperationRefused if refused.

        held (n,): vertices that are locked during the step, and so keep their positions. Smoothing
        takes a few milliseconds at most unless ``thorough``, and may leave elements inverted then;
        without ``smooth`` there is none.
        """
        mesh = self._need()

        def work() -> Edit:
            with temporarily_locked(mesh, held) if held is not None else nullcontext():
                edit = mesh.apply(operation, halfedge)
                if self.smooths and smooth:
                    _relax(mesh, edit.touched, thorough)
                return edit

        action = Operation(operation)
        return self._do(action.value, title_of(action, mesh.kind), halfedge, by, work)

    def clean_all(self, by: str = YOU) -> int:
        """Remove every cleanable global line of a quad mesh as one step; returns their number."""
        from meshwright.document.position_repair import smooth_all  # imports scipy

        mesh = self._need()

        def work() -> int:
            edits = mesh.clean_all()
            if edits and self.smooths:
                smooth_all(mesh)
            return len(edits)

        return self._do("clean_all", "Clean all", -1, by, work)

    @property
    def plane(self) -> bool:
        """Whether the mesh lies in a plane; true without a mesh."""
        if self._plane is None:
            mesh = self.mesh
            self._plane = mesh is None or is_flat(mesh.points[mesh.vertices()])
        return self._plane

    @property
    def smooths(self) -> bool:
        """Whether the vertices around an operation are smoothed on this mesh."""
        return self.auto_smooth and (self.plane or self.smooth_surfaces)

    def smooth(self, by: str = YOU, vertices: np.ndarray | None = None) -> None:
        """Smooth and untangle the whole mesh, or ``vertices`` (n,) alone, as one step.

        Few quads in the plane that would become badly shaped get the positions whose worst element
        is best.
        """
        from meshwright.document.position_repair import smooth_all, tidy  # imports scipy

        mesh = self._need()
        if vertices is None:
            self._do("smooth", "Smooth", -1, by, lambda: smooth_all(mesh))
        else:
            chosen = vertices
            self._do("smooth", "Smooth here", -1, by, lambda: tidy(mesh, chosen))

    def untangle(self, by: str = YOU) -> tuple[int, int]:
        """Untangle inverted elements as one step; returns their number before and after."""
        from meshwright.document.position_repair import repair  # imports scipy

        mesh = self._need()
        return self._do("untangle", "Untangle", -1, by, lambda: repair(mesh))

    def move(
        self,
        vertices: np.ndarray,
        positions: np.ndarray,
        by: str = YOU,
        parameters: np.ndarray | None = None,
        title: str = "Move",
        pin: bool = False,
    ) -> None:
        """Put ``vertices`` (n,) at ``positions`` (n, 3) as one step; ``parameters`` (n,) as in
        :meth:`HalfEdgeMesh.move`. ``pin``: they are pinned there in the same step.
        """
        mesh = self._need()
        free = [v for v in _ids(vertices) if pin and not mesh.pinned()[v]]

        def work() -> None:
            mesh.move(vertices, positions, parameters)
            _each(free, mesh.set_pinned, True)

        self._do("move", title, -1, by, work)

    def set_desired(self, vertices: int | np.ndarray, degree: int) -> None:
        """Set the desired degree of one vertex or several (n,), as one step.

        s* changes, and the normalised return starts again.
        """
        mesh = self._need()
        now = mesh.desired()
        wanted = [v for v in _ids(vertices) if now[v] != degree]
        title = _counted("Desired degree", wanted)
        self._do("desired", title, -1, YOU, lambda: _each(wanted, mesh.set_desired, degree))

    def set_geometric(self, vertices: int | np.ndarray, flag: bool) -> None:
        """Set or clear the corner flag of one vertex or several (n,), as one step.

        Junctions of interfaces, and the ends of named sides, keep it.
        """
        mesh = self._need()
        now = mesh.geometric()
        kept = mesh.junctions() | mesh.side_ends()
        wanted = [v for v in _ids(vertices) if bool(now[v]) != flag and v not in kept]
        title = _counted("Make corner" if flag else "Free corner", wanted)
        self._do("geometric", title, -1, YOU, lambda: _each(wanted, mesh.set_geometric, flag))

    def set_pinned(self, vertices: int | np.ndarray, flag: bool) -> None:
        """Pin one vertex or several (n,), so that smoothing keeps them in place, or free them, as
        one step.
        """
        mesh = self._need()
        now = mesh.pinned()
        wanted = [v for v in _ids(vertices) if bool(now[v]) != flag]
        title = _counted("Pin" if flag else "Free pinned vertex", wanted)
        self._do("pinned", title, -1, YOU, lambda: _each(wanted, mesh.set_pinned, flag))

    def name_sides(self, halfedges: np.ndarray, name: str) -> None:
        """Name edges (n,) of the boundary or of interfaces, "" for none, as one step."""
        mesh = self._need()
        title = f"Name sides {shown}" if (shown := clean(name)) else "Sides without name"
        self._do(NAME, title, -1, YOU, lambda: mesh.name_sides(halfedges, name))

    def name_regions(self, regions: Sequence[int], name: str) -> None:
        """Name regions, "" for none, as one step."""
        mesh = self._need()
        title = f"Name regions {shown}" if (shown := clean(name)) else "Regions without name"
        self._do(NAME, title, -1, YOU, lambda: mesh.name_regions(regions, name))

    def rename(self, old: str, new: str) -> None:
        """Rename a group of sides and regions wherever it occurs, as one step."""
        mesh = self._need()
        title = f"Rename {old} {shown}" if (shown := clean(new)) else f"Remove name {old}"
        self._do(NAME, title, -1, YOU, lambda: mesh.rename(old, new))

    def plan_grid(self, plan: GridPlan, title: str) -> None:
        """Set what is wanted of a block grid, as one step; none if it is that already."""
        mesh = self._need()
        self._do(PLAN, title, -1, YOU, lambda: mesh.plan_grid(plan))

    def set_locked(self, vertices: int | np.ndarray, flag: bool) -> None:
        """Lock one vertex or several (n,), or unlock them, as one step."""
        mesh = self._need()
        now = mesh.locked()
        wanted = [v for v in _ids(vertices) if bool(now[v]) != flag]
        title = _counted("Lock" if flag else "Unlock", wanted)
        self._do("locked", title, -1, YOU, lambda: _each(wanted, mesh.set_locked, flag))


def _relax(mesh: HalfEdgeMesh, around: tuple[int, ...], thorough: bool) -> None:
    """Smooth near ``around`` (vertex ids)."""
    from meshwright.document.position_repair import relax_around  # imports scipy

    relax_around(mesh, around, thorough)


def _ids(vertices: int | np.ndarray) -> list[int]:
    return [int(v) for v in np.atleast_1d(np.asarray(vertices)).tolist()]


def _counted(title: str, vertices: list[int]) -> str:
    """``Lock``, or ``Lock, 12 vertices``."""
    return title if len(vertices) < 2 else f"{title}, {len(vertices):,} vertices"


def _each(vertices: list[int], change: Callable[[int, Any], None], value: int | bool) -> None:
    for vertex in vertices:
        change(vertex, value)
