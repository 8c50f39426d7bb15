"""New, open, save and recover."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import isfinite
from pathlib import Path
from typing import Any

from qtpy.QtCore import QPoint, Qt
from qtpy.QtWidgets import QApplication, QFileDialog, QWidget

from meshwright.assistant.assistant import Assistant
from meshwright.assistant.policy_catalogue import shipped
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.controller import Controller
from meshwright.desktop.files.drop_target import DropTarget
from meshwright.desktop.files.recent_menu import RecentMenu
from meshwright.desktop.files.save_question import QuestionDialog
from meshwright.desktop.files.unsaved_work import Guard, NoGuard, UnsavedWorkGuard, counted
from meshwright.desktop.widgets.action_set import ActionSet
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.document.storage.document_file import is_drawing
from meshwright.document.storage.project_file import ENDING, is_project
from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import FARTHEST, NEAREST
from meshwright.sources.resolve import resolve
from meshwright_core.errors import FileWarning, MeshError, MixedElementsError, sentence
from meshwright_core.io import formats, mesh_files

MESHES, PROJECTS, SHAPES = "Meshes", "Meshwright projects", "Shapes"
FLAT = 0.005
"""Distance of straight edges from their curves, as a fraction of the mesh's size, below which a
mesh file is written without a word.
"""
NEW_MESH = "new_mesh/state"
"""The setting that keeps what the dialog for new meshes showed last."""
USUAL = ".vtk"
"""The suffix of a mesh file whose name is typed without one."""


class FileController(Controller):
    """Makes, opens and saves meshes; errors are one sentence in the notice bar.

    ``guard`` decides whether the mesh may be dropped: see :meth:`watch`.
    """

    def __init__(
        self,
        document: Document,
        assistant: Assistant,
        canvas: Canvas,
        settings: Settings,
        actions: ActionSet,
        status: StatusBar,
        notice: NoticeBar,
        window: QWidget,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._assistant, self._canvas = document, assistant, canvas
        self._settings, self._status, self._notice = settings, status, notice
        self._window = window
        self.guard: Guard = NoGuard(window)
        self._agreed: set[tuple[Path | str, ...]] = set()
        self.dropping = DropTarget(window, self.open, theme)
        self.recent = RecentMenu(settings, self.open, window)
        actions["recent"].setMenu(self.recent)
        self._connections.add(document.saved_changed, self._on_saved_changed)
        self._on_saved_changed()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        super().set_theme(theme)
        self.dropping.set_theme(theme)

    def close(self) -> None:
        """Disconnect, and end autosave."""
        super().close()
        self.dropping.release()
        self.guard.release()

    def watch(self, folder: Path | None = None) -> None:
        """From now on save every step in ``folder`` (None: the user's own), and ask before unsaved
        work is dropped.
        """
        self.guard = UnsavedWorkGuard(
            self._document,
            self._settings,
            self._status,
            self._notice,
            self._window,
            self.save,
            self.save_as,
            self.show_all,
            folder,
        )

    def may_drop(self) -> bool:
        """Whether the mesh may be replaced or closed; asks the user where work is unsaved."""
        return self.guard.may_drop()

    def leave(self) -> None:
        """Close the window at once, without a question; unsaved work can be recovered."""
        self.guard.leave()

    def offer_lost(self) -> None:
        """Offer work that was not saved, if there is any."""
        self.guard.offer()

    def ask_for_lost(self) -> None:
        """Offer work that was not saved when the program ended unexpectedly."""
        self.guard.ask_for_lost()

    def _on_saved_changed(self) -> None:
        document = self._document
        name = document.name or "No mesh"
        only_history = document.modified and document.path and not document.mesh_modified
        note = ", history not saved" if only_history else ""
        self._window.setWindowTitle(f"{name}[*]{note} \u2013 Meshwright")
        self._window.setWindowModified(document.modified)

    # Another mesh

    def new(self, file: str = "") -> None:
        """Show the dialog for new meshes, on ``file`` if one is given."""
        if self.may_drop():
            self._new(file)

    def _new(self, file: str) -> None:
        from meshwright.desktop.files.new_mesh import NewMeshDialog

        state = self._settings.record(NEW_MESH)
        dialog = NewMeshDialog(self._document.kind, self._theme, self._window, file, state)
        accepted = dialog.exec()
        self._settings.put_record(NEW_MESH, dialog.state)  # also after Cancel: nothing is lost
        if accepted and dialog.made is not None:
            made = dialog.made
            with waiting():
                self._document.replace(made.mesh(), made.name, made.path or None)
            source = made.path or (dialog.file.chosen if dialog.page is dialog.file else "")
            if source:
                self._remember(Path(source))
        dialog.deleteLater()

    def make(self, shape: str, kind: str) -> None:
        """Mesh a gallery shape with elements of ``kind``."""
        from meshwright_core.domains import gallery, meshing

        try:
            mesh = meshing.mesh_domain(gallery.shape(shape), kind)
        except ValueError as error:
            self._notice.show_message(one_line(error))
        else:
            if self.may_drop():
                self._document.replace(mesh, shape)

    def choose(self) -> None:
        """Ask for a file and open it."""
        path = self._document.path
        folder = str(path.parent) if path else ""
        chosen, _ = QFileDialog.getOpenFileName(self._window, "Open", folder, to_open())
        if chosen:
            self.open(chosen)

    def open(self, path: str | Path) -> None:
        """Open a mesh file or a project. For a drawing the dialog for new meshes shows the shapes
        that were found in it, the settings and the mesh that they lead to.
        """
        place = Path(path).absolute()
        if not self.may_drop():
            return
        said: list[str] = []
        try:
            with waiting(), file_warnings(said):
                if is_drawing(place):
                    _refuse_unreadable(place)
                else:
                    self._document.open(place)
        except MixedElementsError as error:
            if not self._open_as_quads(place, one_line(error), said):
                return
        except (ValueError, OSError) as error:
            if not place.exists():
                self._forget(place)
            self._notice.show_message(one_line(error))
            return
        if is_drawing(place):
            self._new(str(place))
            return
        self._remember(place)
        self.show_all()
        if said:
            self._notice.show_message(" ".join(said))

    def _open_as_quads(self, place: Path, reason: str, said: list[str]) -> bool:
        """Offer to make quads of a file of triangles and quads; whether that was done."""
        answer = QuestionDialog(
            f"Make quads of all elements of {place.name}?",
            f"{reason} Triangles are joined in pairs; if some are left, every element is split. "
            "The file stays as it is.",
            (("", "Cancel"), ("quads", "Make quads")),
            parent=self._window,
        ).ask()
        if answer != "quads":
            return False
        try:
            with waiting(), file_warnings(said):
                self._document.open(place, to_quads=True)
        except (ValueError, OSError) as error:
            self._notice.show_message(one_line(error))
            return False
        return True

    def show_all(self) -> None:
        """Restore view and policy saved in a project; else fit the view to the mesh."""
        self._canvas.fit()
        kept = self._document.settings
        view = kept.get("view")
        if isinstance(view, list) and len(view) == 3 and all(map(_is_length, view)) and view[2] > 0:
            x, y, width = view
            seen = self._canvas.viewport
            pixels = min(max(seen.size[0] / width, NEAREST), FARTHEST)
            self._canvas.see(replace(seen, centre=(x, y), pixels=pixels))
        if kept.get("policy") in shipped(self._document.kind):
            self._assistant.policy = kept["policy"]

    def show_recent(self) -> None:
        """Open the menu of recent files in the middle of the window."""
        middle = self._window.mapToGlobal(self._window.rect().center())
        self.recent.popup(middle - QPoint(self.recent.sizeHint().width() // 2, 0))

    # Saving

    def save(self) -> bool:
        """Save the mesh to its file, or ask for one; returns whether it was saved.

        Where another window or program has changed the file meanwhile, asks what to do.
        """
        document = self._document
        if document.path is None:
            return self.save_as()
        if document.changed_on_disk:
            answer = self._ask_about_change(document.path)
            if answer == "save_as":
                return self.save_as()
            if answer == "reload":
                return self._reload(document.path)
            if answer != "overwrite":
                return False
        return self._save(None)

    def _ask_about_change(self, path: Path) -> str:
        there = path.exists()
        what = "changed" if there else "deleted or moved"
        reload = (("reload", "Reload"),) if there else ()
        return QuestionDialog(
            f"{path.name} was {what} by another program",
            "Another window or program has saved to it since it was opened or saved here."
            " Overwrite replaces what was saved there, Reload drops what was changed here."
            if there
            else "It is no longer where it was opened or saved.",
            (("cancel", "Cancel"), *reload, ("save_as", "Save as\u2026")),
            ("overwrite", "Overwrite" if there else "Save it there again"),
            self._window,
        ).ask()

    def _reload(self, path: Path) -> bool:
        """Read the file again; returns whether it could be read."""
        try:
            with waiting():
                self._document.open(path)
        except (ValueError, OSError) as error:
            self._notice.show_message(one_line(error))
            return False
        self.show_all()
        self._status.show_message(f"Reloaded {path.name}.")
        return True

    def save_as(self) -> bool:
        """Ask for a file and save mesh and history to a project, which is proposed, or the mesh
        alone to a mesh file.
        """
        document = self._document
        start = (document.path or Path(document.name or "mesh")).with_suffix(ENDING)
        path, kind = QFileDialog.getSaveFileName(
            self._window, "Save as", str(start), to_save(), to_save().split(";;")[0]
        )
        if path and not Path(path).suffix:
            path += USUAL if kind.startswith(MESHES) else ENDING
        return bool(path) and self._save(path)

    def _may_lose(self, path: str | None) -> str:
        """Ask whether to save to a file that holds less than the mesh, or than it held itself.

        Returns "save", "save_as" or "", for not at all; asked once for a file and what is lost.
        """
        document = self._document
        target = Path(path) if path is not None else document.path
        if target is None or document.mesh is None or is_project(target):
            return "save"
        try:
            lost = [*mesh_files.losses(target, document.mesh)]
        except MeshError:
            return "save"  # saving says why it cannot
        if path is None and document.mesh.left_out:
            held = ", ".join(document.mesh.left_out)
            lost.append(f"The file on the disk holds more: {held} would be gone.")
        if not lost or (target, *lost) in self._agreed:
            return "save"
        answer = QuestionDialog(
            f"Save to {target.name} all the same?",
            " ".join(lost),
            (("save", "Save all the same"), ("save_as", "Save as\u2026")),
            ("", "Cancel"),
            self._window,
        ).ask()
        if answer == "save":
            self._agreed.add((target, *lost))
        return answer

    def _save(self, path: str | None) -> bool:
        answer = self._may_lose(path)
        if answer != "save":
            return self.save_as() if answer == "save_as" else False
        viewport = self._canvas.viewport
        self._document.settings.update(
            policy=self._assistant.policy,
            view=[*viewport.centre, viewport.size[0] / viewport.pixels],
        )
        try:
            with waiting():
                written = self._document.save(path)
        except (ValueError, OSError) as error:
            self._notice.show_message(one_line(error))
            return False
        self._remember(written)
        lost = left_out(written) or unsaved_history(self._document, written)
        self._status.show_message(f"Saved {written.name}.{lost}")
        flattened = straightened(self._document, written)
        if flattened:
            self._notice.show_message(flattened)
        return True

    def _forget(self, path: Path) -> None:
        self._settings.recent = [one for one in self._settings.recent if one != str(path)]

    def _remember(self, path: Path) -> None:
        self._settings.recent = [str(path.absolute()), *self._settings.recent]


@contextmanager
def file_warnings(said: list[str]) -> Iterator[None]:
    """Add what a reader of files warns of to a list, a sentence each."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", FileWarning)
        yield
    said += [str(one.message) for one in caught if issubclass(one.category, FileWarning)]


@contextmanager
def waiting() -> Iterator[None]:
    """Show the wait cursor while the block runs."""
    QApplication.setOverrideCursor(Qt.CursorShape.WaitCursor)
    try:
        yield
    finally:
        QApplication.restoreOverrideCursor()


def to_open() -> str:
    """The filters of the Open dialog."""
    groups = {
        MESHES: mesh_files.endings(),
        PROJECTS: (ENDING,),
        SHAPES: (*formats.SHAPES, formats.DAT),
    }
    return _filters({"All supported files": sum(groups.values(), ()), **groups})


def to_save() -> str:
    """The filters of the Save dialog."""
    return _filters({PROJECTS: (ENDING,), MESHES: mesh_files.endings(written=True)})


def _filters(groups: dict[str, tuple[str, ...]]) -> str:
    named = [f"{name} ({' '.join(f'*{end}' for end in ends)})" for name, ends in groups.items()]
    return ";;".join(named)


def left_out(path: Path) -> str:
    """What this mesh format does not store, as a sentence; empty if it stores everything."""
    if is_project(path) or formats.of(path).data:
        return ""
    title = formats.of(path).title
    return f" {title} files store no corners, desired degrees or history; projects do."


def straightened(document: Document, path: Path) -> str:
    """That the straight edges of the file just written lie far from the curves, as a sentence;
    empty if they do not, and for projects, which keep the curves.
    """
    if is_project(path) or document.mesh is None:
        return ""
    from meshwright_core.geometry.chord_distances import largest_chord_distance

    away = largest_chord_distance(document.mesh)
    if away < FLAT:
        return ""
    finer = "a finer mesh comes" if document.mesh.k == 3 else "the cells of Export blocks come"
    return (
        f"{path.name} has straight edges: they lie up to {100 * away:.2g} % of the mesh's size off"
        f" the curves. A project keeps the curves; {finer} closer to them."
    )


def unsaved_history(document: Document, path: Path) -> str:
    """That the history is not in the file just written, as a sentence; empty if it is."""
    if not document.modified:
        return ""
    return f" {formats.of(path).title} files store no history ({counted(document)}); projects do."


def _refuse_unreadable(drawing: Path) -> None:
    """MeshError if a drawing cannot be read, or if there is no shape in it."""
    from meshwright_core.io import drawings

    if not drawings.read_regions(drawing).regions:
        resolve(drawing)  # a domain, which is read without a search for its regions


def _is_length(value: Any) -> bool:
    return isinstance(value, int | float) and isfinite(value) and abs(value) < FARTHEST


def one_line(error: Exception) -> str:
    """The error as one sentence."""
    if isinstance(error, OSError) and error.strerror:
        name = Path(error.filename).name if error.filename else "The file"
        return f"{name}: {error.strerror}."
    return sentence(" ".join(str(error).split()))
