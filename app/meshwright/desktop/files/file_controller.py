"""Meshes that come and go: what the window does about files and shapes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from qtpy.QtCore import QPoint, Qt, QTimer
from qtpy.QtWidgets import QApplication, QFileDialog

from meshwright.assistant.policy_catalogue import shipped
from meshwright.desktop.files.drop_target import Dropping
from meshwright.desktop.files.recent_menu import RecentMenu
from meshwright.desktop.files.unsaved_work import Guard
from meshwright.desktop.widgets.basic import sentence
from meshwright.document.storage.project_file import ENDING, is_project
from meshwright.graphics.viewport import FARTHEST, NEAREST
from meshwright_core.io import formats, mesh_files

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow

MESHES, PROJECTS, SHAPES = "Meshes", "Meshwright projects", "Shapes"
USUAL = ".vtk"
"""The ending of a mesh file whose name is typed without one."""


class Files:
    """New, open and save for one window; what goes wrong is one sentence in its notice bar."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.dropping: Dropping | None = None
        self.recent: RecentMenu | None = None
        self.guard: Guard | None = None

    def connect(self) -> None:
        """Follow the document; take files that are dropped."""
        window = self._window
        window.document.saved_changed.connect(self._on_saved_changed)
        window.opened.connect(self._on_opened)
        self.dropping = Dropping(window, self.open)
        self.recent = RecentMenu(window.settings, self.open, window)
        window.actions_by_id["recent"].setMenu(self.recent)
        self._on_saved_changed()

    def release(self) -> None:
        """Let go of the document."""
        self._window.document.saved_changed.disconnect(self._on_saved_changed)
        if self.dropping is not None:
            self.dropping.release()
        if self.guard is not None:
            self.guard.release()

    def watch(self, folder: Path | None = None) -> None:
        """From now on keep every step, and ask before unsaved work is dropped; what was lost when a
        process died is offered once the window is there.
        """
        self.guard = Guard(self._window, folder)
        self._window.opened.connect(self._on_watched_opened)

    def may_drop(self) -> bool:
        """Whether the mesh may give way to another one, or to nothing."""
        return self.guard is None or self.guard.may_drop()

    def leave(self) -> None:
        """Close the window at once, without a question; nothing is lost by that."""
        if self.guard is not None:
            self.guard.leave()
        else:
            self._window.close()

    def ask_for_lost(self) -> None:
        """Offer work that was lost when a process died."""
        if self.guard is not None:
            self.guard.ask_for_lost()

    def _on_opened(self) -> None:
        # it would read dropped files on its own, past the document
        self._window.canvas.plotter.setAcceptDrops(False)

    def _on_watched_opened(self) -> None:
        if self.guard is not None:
            QTimer.singleShot(0, self.guard.offer)  # what else begins with the window goes first

    def _on_saved_changed(self) -> None:
        document = self._window.document
        self._window.setWindowTitle(f"{document.name or 'No mesh'}[*] \u2013 Meshwright")
        self._window.setWindowModified(document.modified)

    # Another mesh

    def new(self, file: str = "") -> None:
        """Ask for a shape and how it is meshed, beginning with ``file`` if one is given."""
        from meshwright.desktop.files.new_mesh import NewMeshDialog

        window = self._window
        if not self.may_drop():
            return
        dialog = NewMeshDialog(window.document.kind, window.theme, window, file)
        if dialog.exec() and dialog.made is not None:
            made = dialog.made
            with waiting():
                window.document.replace(made.mesh(), made.name, made.path or None)
            if made.path:
                self._remember(Path(made.path))
        dialog.deleteLater()

    def make(self, shape: str, kind: str) -> None:
        """Mesh a gallery shape with elements of ``kind``."""
        from meshwright_core.domains import gallery, meshing

        try:
            mesh = meshing.mesh_domain(gallery.shape(shape), kind)
        except ValueError as error:
            self._window.notice.tell(one_line(error))
        else:
            if self.may_drop():
                self._window.document.replace(mesh, shape)

    def choose(self) -> None:
        """Ask for a file and open it."""
        path = self._window.document.path
        folder = str(path.parent) if path else ""
        chosen, _ = QFileDialog.getOpenFileName(self._window, "Open", folder, to_open())
        if chosen:
            self.open(chosen)

    def open(self, path: str | Path) -> None:
        """Open a mesh file, a project, or the shape in a geometry file."""
        window, place = self._window, Path(path).absolute()
        if not self.may_drop():
            return
        try:
            with waiting():
                window.document.open(place)
        except (ValueError, OSError) as error:
            if not place.exists():
                window.settings.recent = [
                    one for one in window.settings.recent if one != str(place)
                ]
            window.notice.tell(one_line(error))
            return
        self._remember(place)
        self.show_all()

    def show_all(self) -> None:
        """Look at the mesh as a project says, else at all of it."""
        window = self._window
        window.canvas.fit()
        kept = window.document.settings
        view = kept.get("view")
        if isinstance(view, list) and len(view) == 3 and all(map(_is_length, view)) and view[2] > 0:
            x, y, width = view
            seen = window.canvas.viewport
            pixels = min(max(seen.size[0] / width, NEAREST), FARTHEST)
            window.canvas.see(replace(seen, centre=(x, y), pixels=pixels))
        if kept.get("policy") in shipped(window.document.kind):
            window.assistant.policy = kept["policy"]

    def show_recent(self) -> None:
        """Open the menu of recent files in the middle of the window."""
        if self.recent is not None:
            middle = self._window.mapToGlobal(self._window.rect().center())
            self.recent.popup(middle - self.recent.sizeHint().width() * QPoint(1, 0) / 2)

    # Saving

    def save(self) -> bool:
        """Write the mesh to its file, or ask for one; whether it is written."""
        if self._window.document.path is None:
            return self.save_as()
        return self._save(None)

    def save_as(self) -> bool:
        """Ask for a file and write the mesh to it, or all of the work to a project."""
        document = self._window.document
        start = str(document.path or f"{document.name or 'mesh'}{USUAL}")
        chosen = PROJECTS if document.path and is_project(document.path) else MESHES
        filters = {one.partition(" (")[0]: one for one in to_save().split(";;")}
        path, kind = QFileDialog.getSaveFileName(
            self._window, "Save as", start, to_save(), filters[chosen]
        )
        if path and not Path(path).suffix:
            path += ENDING if kind.startswith(PROJECTS) else USUAL
        return bool(path) and self._save(path)

    def _save(self, path: str | None) -> bool:
        window = self._window
        viewport = window.canvas.viewport
        window.document.settings.update(
            policy=window.assistant.policy,
            view=[*viewport.centre, viewport.size[0] / viewport.pixels],
        )
        try:
            with waiting():
                written = window.document.save(path)
        except (ValueError, OSError) as error:
            window.notice.tell(one_line(error))
            return False
        self._remember(written)
        window.say(f"Saved {written.name}.{left_out(written)}")
        return True

    def _forget(self, path: Path) -> None:
        settings = self._window.settings
        settings.recent = [one for one in settings.recent if one != str(path)]

    def _remember(self, path: Path) -> None:
        settings = self._window.settings
        settings.recent = [str(path.absolute()), *settings.recent]


@contextmanager
def waiting() -> Iterator[None]:
    """The mouse pointer says that it takes a moment."""
    QApplication.setOverrideCursor(Qt.CursorShape.WaitCursor)
    try:
        yield
    finally:
        QApplication.restoreOverrideCursor()


def to_open() -> str:
    """The groups of files that can be opened."""
    groups = {MESHES: mesh_files.endings(), PROJECTS: (ENDING,), SHAPES: formats.SHAPES}
    return _filters({"All that can be opened": sum(groups.values(), ()), **groups})


def to_save() -> str:
    """The groups of files that can be written."""
    return _filters({MESHES: mesh_files.endings(), PROJECTS: (ENDING,)})


def _filters(groups: dict[str, tuple[str, ...]]) -> str:
    named = [f"{name} ({' '.join(f'*{end}' for end in ends)})" for name, ends in groups.items()]
    return ";;".join(named)


def left_out(path: Path) -> str:
    """What a mesh file of this kind does not keep, as a sentence; empty if nothing."""
    if is_project(path) or formats.of(path).data:
        return ""
    title = formats.of(path).title
    return f" {title} files keep no corners, desired degrees or history; a project does."


def _is_length(value: Any) -> bool:
    return isinstance(value, int | float) and isfinite(value) and abs(value) < FARTHEST


def one_line(error: Exception) -> str:
    """What went wrong with a file, as one sentence."""
    if isinstance(error, OSError) and error.strerror:
        name = Path(error.filename).name if error.filename else "The file"
        return f"{name}: {error.strerror}."
    return sentence(" ".join(str(error).split()))
