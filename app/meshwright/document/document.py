"""The document: the mesh, its history and its events. Views and the assistant submit to it.

It knows neither Qt nor torch. One call that changes the mesh is one step of the mesh's journal and
one row of the history, so that both undo together.
"""

from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from meshwright.document.history import YOU, History
from meshwright.document.selection import Selection
from meshwright.document.storage import project_file
from meshwright.document.storage.document_state import Kept
from meshwright.document.timeline import NO_MESH as NO_MESH
from meshwright.document.timeline import Timeline
from meshwright_core import Edit, HalfEdgeMesh, MeshError, Operation, Verdict
from meshwright_core.analysis.submesh import temporarily_locked
from meshwright_core.core.notebook_display import Bundle
from meshwright_core.io import mesh_files
from meshwright_core.io.formats import SHAPES
from meshwright_core.operations.catalogue import CATALOGUE


def title_of(operation: Operation | str, kind: str) -> str:
    """The catalogue's title of an operation on meshes of ``kind``."""
    value = Operation(operation)
    for info in CATALOGUE:
        if info.operation == value and info.kind == kind:
            return info.title
    return value.value


class Document(Timeline):
    """A mesh being edited, or none yet.

    Events, all emitted in the caller's thread: ``replaced()`` another mesh is here;
    ``changed()`` connectivity, positions or flags changed; ``score_changed()``;
    ``history_changed()``; ``saved_changed()`` name, path or :attr:`modified` may differ;
    ``hover_changed(halfedge)``. Every ``replaced`` is followed by the others. Before the others,
    too, comes ``noted(event, number)``, for who keeps a record: ``"step"`` a row was appended,
    ``"go"`` the cursor is at that number now, ``"branch"`` that branch was taken, ``"saved"``.
    """

    _name: str
    _path: Path | None
    _saved: tuple[int, int]
    _passing: bool

    def __init__(
        self, mesh: HalfEdgeMesh | None = None, name: str = "", path: str | Path | None = None
    ) -> None:
        super().__init__()
        self.auto_smooth = True
        self.bar: Callable[[str], str] | None = None
        """Why a step is not offered here now, a sentence, or empty: of who plays on the mesh."""
        self.settings: dict[str, Any] = {}
        """What the views want to find again in a project: plain values that JSON can hold."""
        self._adopt(mesh, name, path)
        self.selection = Selection(self)

    # What is here

    @property
    def name(self) -> str:
        """What the window's title says."""
        return self._name

    @property
    def path(self) -> Path | None:
        """The file that *Save* writes, None if never saved."""
        return self._path

    @property
    def passing(self) -> bool:
        """True while nothing of it is worth keeping, as in a level; saving it ends that."""
        return self._passing

    @property
    def modified(self) -> bool:
        """True if the mesh differs from the file, or from the shape it began as.

        A project keeps the history too: there a step counts even when it has been undone. A mesh
        that is :attr:`passing` never counts as modified.
        """
        if self._passing:
            return False
        mark, given = self.saved_state
        keeps_all = self._path is not None and project_file.is_project(self._path)
        return mark != self._saved[0] or (keeps_all and given != self._saved[1])

    @property
    def saved_state(self) -> tuple[int, int]:
        """Two numbers that tell the present state from others: where it is, and all there is."""
        return self.history.mark, self.history.given[0]

    def keep(self) -> None:
        """A mesh that was passing is worth keeping from now on; as it is, it counts as saved."""
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
        """Put ``mesh`` in the place of the present one; the history starts again.

        ``passing``: nobody needs to be asked before it is dropped, and no step of it is kept.
        """
        self._adopt(mesh, name, path)
        self._passing = passing
        self.revision += 1
        self.replaced.emit()
        self._emit_all()

    def open(self, path: str | Path) -> None:
        """Read a mesh file or a project, or mesh the shape in a geometry file.

        On MeshError or OSError the document stays as it was. A shape gets elements of the kind
        that is here now, quads if there is none; its file is not where the mesh is saved.
        """
        path = Path(path)
        if project_file.is_project(path):
            self.adopt(project_file.read(path))
        elif path.suffix.lower() in SHAPES:
            self.replace(_meshed(path, self.kind or "quad"), path.stem)
        else:
            self.replace(mesh_files.read(path), path.stem, path)

    def adopt(self, kept: Kept) -> None:
        """Go on with what was kept: a mesh with its history, where it had come to."""
        self._adopt(kept.mesh, kept.name, kept.path)
        self.history, self._saved = kept.history, kept.saved
        self.settings = dict(kept.settings)
        self.revision += 1
        self.replaced.emit()
        self._emit_all()

    def kept(self) -> Kept:
        """What there is to keep of the document; its mesh goes on changing."""
        return Kept(
            self._need(), self.history, self._name, self._path, self._saved, dict(self.settings)
        )

    def save(self, path: str | Path | None = None) -> Path:
        """Write the mesh to ``path`` or where it came from; returns where it is now.

        A path that ends in ``.meshwright`` gets the whole history too.
        """
        target = Path(path) if path is not None else self._path
        if target is None:
            raise MeshError("This mesh has no file yet: choose a name with 'Save as'.")
        if project_file.is_project(target):
            project_file.write(target, self.kept())
        else:
            mesh_files.write(target, self._need())
        self._path, self._name, self._passing = target, target.stem, False
        self._saved = self.saved_state
        self.noted.emit("saved", 0)
        self.saved_changed.emit()
        return target

    def _repr_mimebundle_(self, include: object = None, exclude: object = None) -> Bundle:
        """A still picture at the end of a notebook's cell."""
        if self._mesh is None:
            return {"text/plain": NO_MESH}, {}
        from meshwright.graphics.export.mimebundle import (
            mimebundle,  # imported late: who shows no document needs none
        )

        data, metadata = mimebundle(self._mesh, self._name)
        return {"text/plain": repr(self._mesh), **data}, metadata

    def _adopt(self, mesh: HalfEdgeMesh | None, name: str, path: str | Path | None) -> None:
        self._mesh = mesh
        self._name = name
        self._path = Path(path) if path is not None else None
        self._hover = -1
        self.history = History(self.score, self.optimum)
        self._saved = (0, 0)
        self._passing = False
        self.settings = {}

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
    ) -> Edit:
        """Apply one operation and smooth around it, as one step; OperationRefused if refused.

        held (n,): vertices that count as locked meanwhile, and so stay where they are. Smoothing
        takes a few milliseconds at most unless ``thorough``, and may leave elements inverted then.
        """
        mesh = self._need()

        def work() -> Edit:
            with temporarily_locked(mesh, held) if held is not None else nullcontext():
                edit = mesh.apply(operation, halfedge)
                if self.auto_smooth:
                    _relax(mesh, edit.touched, thorough)
                return edit

        action = Operation(operation)
        return self._do(action.value, title_of(action, mesh.kind), halfedge, by, work)

    def clean_all(self, by: str = YOU) -> int:
        """Remove every cleanable global line of a quad mesh as one step; returns their number."""
        mesh = self._need()

        def work() -> int:
            edits = mesh.clean_all()
            if edits and self.auto_smooth:
                _relax(mesh, None)
            return len(edits)

        return self._do("clean_all", "Clean all", -1, by, work)

    def smooth(self, by: str = YOU, vertices: np.ndarray | None = None) -> None:
        """Smooth and untangle the whole mesh, or ``vertices`` (n,) alone, as one step."""
        mesh = self._need()
        if vertices is None:
            self._do("smooth", "Smooth", -1, by, lambda: _relax(mesh, None))
        else:
            chosen = vertices
            self._do("smooth", "Smooth here", -1, by, lambda: _tidy(mesh, chosen))

    def untangle(self, by: str = YOU) -> tuple[int, int]:
        """Mend inverted elements as one step; returns how many there were, and how many stay."""
        mesh = self._need()
        return self._do("untangle", "Untangle", -1, by, lambda: _mend(mesh))

    def move(self, vertices: np.ndarray, positions: np.ndarray, by: str = YOU) -> None:
        """Put ``vertices`` (n,) at ``positions`` (n, 3) as one step."""
        mesh = self._need()
        self._do("move", "Move", -1, by, lambda: mesh.move(vertices, positions))

    def set_desired(self, vertices: int | np.ndarray, degree: int) -> None:
        """Ask for another degree at one vertex or several (n,), as one step.

        s* and the normalised return start again.
        """
        mesh = self._need()
        now = mesh.desired()
        wanted = [v for v in _ids(vertices) if now[v] != degree]
        title = _counted("Desired degree", wanted)
        self._do("desired", title, -1, YOU, lambda: _each(wanted, mesh.set_desired, degree))

    def set_geometric(self, vertices: int | np.ndarray, flag: bool) -> None:
        """Mark one vertex or several (n,) as corners that stay, or no longer, as one step."""
        mesh = self._need()
        now = mesh.geometric()
        wanted = [v for v in _ids(vertices) if bool(now[v]) != flag]
        title = _counted("Make corner" if flag else "Free corner", wanted)
        self._do("geometric", title, -1, YOU, lambda: _each(wanted, mesh.set_geometric, flag))

    def set_locked(self, vertices: int | np.ndarray, flag: bool) -> None:
        """Lock one vertex or several (n,), or unlock them, as one step."""
        mesh = self._need()
        now = mesh.locked()
        wanted = [v for v in _ids(vertices) if bool(now[v]) != flag]
        title = _counted("Lock" if flag else "Unlock", wanted)
        self._do("locked", title, -1, YOU, lambda: _each(wanted, mesh.set_locked, flag))


def _meshed(path: Path, kind: str) -> HalfEdgeMesh:
    """Mesh the shape in a file; imported late, for few documents begin so."""
    from meshwright_core.domains import meshing
    from meshwright_core.io import drawings

    return meshing.mesh_domain(drawings.read_domain(path), kind)


def _relax(mesh: HalfEdgeMesh, around: tuple[int, ...] | None, thorough: bool = True) -> None:
    """Smooth near ``around`` (vertex ids) or everywhere; imported late, for it pulls in scipy."""
    from meshwright_core.geometry.smoothing import relax

    relax(mesh, around, thorough)


def _tidy(mesh: HalfEdgeMesh, vertices: np.ndarray) -> None:
    """As :func:`_relax` for exactly these vertices; imported late, too."""
    from meshwright.document.position_repair import tidy

    tidy(mesh, vertices)


def _mend(mesh: HalfEdgeMesh) -> tuple[int, int]:
    """Untangle what is inverted; imported late, too."""
    from meshwright.document.position_repair import mend

    return mend(mesh)


def _ids(vertices: int | np.ndarray) -> list[int]:
    return [int(v) for v in np.atleast_1d(np.asarray(vertices)).tolist()]


def _counted(title: str, vertices: list[int]) -> str:
    """``Lock``, or ``Lock, 12 vertices``."""
    return title if len(vertices) < 2 else f"{title}, {len(vertices):,} vertices"


def _each(vertices: list[int], change: Callable[[int, Any], None], value: int | bool) -> None:
    for vertex in vertices:
        change(vertex, value)
