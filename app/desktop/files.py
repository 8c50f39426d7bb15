"""Meshes that come and go: what the window does about files and shapes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from qtpy.QtWidgets import QFileDialog

from app.desktop.widgets import sentence
from meshcore import io

if TYPE_CHECKING:
    from app.desktop.window import MainWindow


class Files:
    """New, open and save for one window; what goes wrong is one sentence in its notice bar."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window

    def connect(self) -> None:
        """Follow the document."""
        self._window.document.saved_changed.connect(self._on_saved_changed)
        self._on_saved_changed()

    def release(self) -> None:
        """Let go of the document."""
        self._window.document.saved_changed.disconnect(self._on_saved_changed)

    def _on_saved_changed(self) -> None:
        document = self._window.document
        self._window.setWindowTitle(f"{document.name or 'No mesh'}[*] \u2013 Meshwright")
        self._window.setWindowModified(document.modified)

    def new(self, file: str = "") -> None:
        """Ask for a shape and how it is meshed, beginning with ``file`` if one is given."""
        from app.desktop.new_mesh import NewMeshDialog

        window = self._window
        dialog = NewMeshDialog(window.document.kind, window.theme, window, file)
        if dialog.exec() and dialog.made is not None:
            made = dialog.made
            window.document.replace(made.mesh(), made.name, made.path or None)
        dialog.deleteLater()

    def make(self, shape: str, kind: str) -> None:
        """Mesh a gallery shape with elements of ``kind``."""
        from meshcore import generate, shapes

        try:
            mesh = generate.mesh_domain(shapes.shape(shape), kind)
        except ValueError as error:
            self._window.notice.tell(one_line(error))
        else:
            self._window.document.replace(mesh, shape)

    def choose(self) -> None:
        """Ask for a file and open it."""
        path = self._window.document.path
        folder = str(path.parent) if path else ""
        chosen, _ = QFileDialog.getOpenFileName(self._window, "Open a mesh", folder, patterns())
        if chosen:
            self.open(chosen)

    def open(self, path: str | Path) -> None:
        """Open a mesh file."""
        try:
            self._window.document.open(path)
        except (ValueError, OSError) as error:
            self._window.notice.tell(one_line(error))
        else:
            self._window.canvas.fit()

    def save(self) -> None:
        """Write the mesh to its file, or ask for one."""
        if self._window.document.path is None:
            self.save_as()
        else:
            self._save(None)

    def save_as(self) -> None:
        """Ask for a file and write the mesh to it."""
        document = self._window.document
        start = str(document.path or f"{document.name or 'mesh'}.vtk")
        path, _ = QFileDialog.getSaveFileName(self._window, "Save the mesh as", start, patterns())
        if path:
            self._save(path)

    def _save(self, path: str | None) -> None:
        try:
            written = self._window.document.save(path)
        except (ValueError, OSError) as error:
            self._window.notice.tell(one_line(error))
        else:
            self._window.say(f"Saved {written.name}.")


def patterns() -> str:
    """The endings that the file dialogs offer."""
    endings = " ".join(f"*{ending}" for ending in io.endings())
    return f"Meshes ({endings});;All files (*)"


def one_line(error: Exception) -> str:
    """What went wrong with a file, as one sentence."""
    if isinstance(error, OSError) and error.strerror:
        name = Path(error.filename).name if error.filename else "The file"
        return f"{name}: {error.strerror}."
    return sentence(" ".join(str(error).split()))
