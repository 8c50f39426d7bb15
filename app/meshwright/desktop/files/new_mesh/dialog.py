"""The dialog for new meshes: source of the shape, meshing options, preview."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QAbstractSpinBox,
    QDialog,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QStackedWidget,
    QTableWidget,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.files.new_mesh.controls import SegmentedButtons
from meshwright.desktop.files.new_mesh.draw_page import DrawPage
from meshwright.desktop.files.new_mesh.file_page import FilePage
from meshwright.desktop.files.new_mesh.gallery_page import GalleryPage
from meshwright.desktop.files.new_mesh.mesh_process import MeshProcess
from meshwright.desktop.files.new_mesh.options import Options
from meshwright.desktop.files.new_mesh.page_base import Page
from meshwright.desktop.files.new_mesh.random_page import RandomPage
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import named
from meshwright.desktop.widgets.event_filters import PanelInput
from meshwright.graphics.theme import GRID, Theme
from meshwright.sources.new_mesh import DrawingContents, NewMesh
from meshwright_core.errors import sentence

PAGES = (("gallery", "Gallery"), ("random", "Random"), ("draw", "Draw"), ("file", "File"))
WOULD_BE_LOST = "The drawing would be lost: press Cancel to close without it."
WORKING = "Making the mesh\u2026"
NOTHING = "The mesh is shown here as soon as there is a shape."
NO_MESH = "There is no mesh to show: see below."
MAKE, OPEN = "Make mesh", "Open mesh"
FRAME = 48
"""Pixels of the height of a screen that title bars take."""


class _Restorable(Protocol):
    def restore(self, state: Mapping[str, Any]) -> None: ...


class NewMeshDialog(QDialog):
    """Accepted, it has a mesh in ``made``.

    Args:
        kind: "quad" or "tri" to begin with; empty for quads.
        theme: its colours.
        parent: the window over which it opens.
        file: a file to begin with, on its page.
        state: what :attr:`state` of an earlier dialog was, which is shown again.
    """

    def __init__(
        self,
        kind: str,
        theme: Theme,
        parent: QWidget | None = None,
        file: str = "",
        state: Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("New mesh")
        room = self.screen().availableSize()
        # the layout asks for no less than it needs
        self.resize(min(1120, room.width() - GRID), min(720, room.height() - FRAME))
        self.made: NewMesh | None = None
        self.maker = MeshProcess(self)
        self.maker.start()
        self.options = Options(kind, theme)
        self.gallery, self.random = GalleryPage(theme), RandomPage(theme)
        self.draw, self.file = DrawPage(theme), FilePage(theme)
        self._pages: dict[str, Page] = {
            "gallery": self.gallery,
            "random": self.random,
            "draw": self.draw,
            "file": self.file,
        }
        self._asked: Mapping[str, Any] | None = None
        self._error = self._path = ""
        self._theme = theme
        self._accepting = False
        self.setStyleSheet(_style(theme))
        self._arrange()
        self._connect()
        PanelInput(self)
        first = self._restored(state or {}, with_file=not file)
        self.show_page("file" if file else first)
        if file:
            self.file.take(file)

    def _arrange(self) -> None:
        self.tabs = SegmentedButtons(PAGES, "Source of the shape")
        self.stack = QStackedWidget()
        for page in self._pages.values():
            self.stack.addWidget(page)
        self.status = named("", "Status")
        self.status.setWordWrap(True)
        self.status.setAccessibleName("Status")
        self.cancel, self.make = QPushButton("Cancel"), QPushButton(MAKE)
        self.make.setObjectName("Primary")
        self.make.setDefault(True)
        self.cancel.setAutoDefault(False)
        left = QVBoxLayout()
        left.setSpacing(2 * GRID)
        left.addWidget(self.tabs)
        left.addWidget(self.stack, 1)
        middle = QHBoxLayout()
        middle.setSpacing(3 * GRID)
        middle.addLayout(left, 1)
        middle.addWidget(self.options)
        foot = QHBoxLayout()
        foot.setSpacing(GRID)
        self.mark = QLabel()
        self.mark.setPixmap(
            icons.pixmap("alert", self._theme.warning, 16, self.devicePixelRatioF())
        )
        foot.addWidget(self.mark)
        foot.addWidget(self.status, 1)
        foot.addWidget(self.cancel)
        foot.addWidget(self.make)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(3 * GRID, 3 * GRID, 3 * GRID, 2 * GRID)
        layout.setSpacing(2 * GRID)
        layout.addLayout(middle, 1)
        layout.addLayout(foot)

    def _connect(self) -> None:
        self.tabs.changed.connect(self.show_page)
        self.options.changed.connect(self._on_changed)
        for page in self._pages.values():
            page.changed.connect(self._on_changed)
            page.message.connect(self._on_message)
        for pictures in (self.gallery.shapes, self.random.pictures):
            pictures.itemDoubleClicked.connect(self.accept)
        self.maker.found.connect(self._on_found)
        self.maker.made.connect(self._on_made)
        self.maker.failed.connect(self._on_failed)
        self.cancel.clicked.connect(self.reject)
        self.make.clicked.connect(self.accept)

    @property
    def state(self) -> dict[str, Any]:
        """The page and what is chosen on each of them, as JSON has it."""
        pages = {key: page.state for key, page in self._pages.items()}
        return {"page": self.tabs.key, "options": self.options.state, "pages": pages}

    def _restored(self, state: Mapping[str, Any], with_file: bool) -> str:
        """Restore a state as far as it can be read, and return its page.

        with_file: otherwise the file page stays empty.
        """
        pages = state.get("pages", {})
        parts: list[tuple[_Restorable, Any]] = [(self.options, state.get("options"))]
        parts += [
            (page, pages.get(key))
            for key, page in self._pages.items()
            if key != "file" or with_file
        ]
        for part, kept in parts:
            try:
                if kept:
                    part.restore(kept)
            except (KeyError, TypeError, ValueError):
                continue  # written by another version: this part begins anew
        page = state.get("page")
        return page if page in self._pages else "gallery"

    @property
    def page(self) -> Page:
        """The current page."""
        return self._pages[self.tabs.key]

    def show_page(self, key: str) -> None:
        """Switch to a page: "gallery", "random", "draw" or "file"."""
        self.tabs.key = key
        self.stack.setCurrentWidget(self._pages[key])
        self.page.fill()
        self._on_changed()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.setStyleSheet(_style(theme))
        self.options.set_theme(theme)
        for page in self._pages.values():
            page.set_theme(theme)

    def accept(self) -> None:
        """Accept the mesh, once it is made."""
        if self.made is not None:
            super().accept()
        elif self.maker.busy:
            self._accepting = True
            self._refresh()

    def done(self, result: int) -> None:
        """Close the dialog and end the process."""
        self.maker.close()
        for page in self._pages.values():
            page.release()
        super().done(result)

    def keyPressEvent(self, event: Any) -> None:  # noqa: N802
        """Let Return in a field end its editing only, and keep Escape from discarding a drawing."""
        typing = isinstance(self.focusWidget(), QAbstractSpinBox | QLineEdit | QTableWidget)
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and typing:
            event.accept()
        elif (
            event.key() == Qt.Key.Key_Escape
            and self.page is self.draw
            and not self.draw.sketch.empty
        ):
            self._on_message(WOULD_BE_LOST)
        else:
            super().keyPressEvent(event)

    def _on_changed(self) -> None:
        page = self.page
        self.options.settings.setEnabled(page.takes_settings)
        source = page.source
        self._accepting, self._error = False, ""
        path = source.get("file", "") if source else ""
        if path and path != self._path:
            self._path = path
            self.options.size_of.tick.setChecked(False)  # its suitable options are not known yet
        if source is None:
            self._asked = self.made = None
            self.maker.cancel()
            self.options.show_words(NOTHING, stale=False)
        else:
            request = {"source": source, **self.options.request}
            if request != self._asked:
                self._asked, self.made = request, None
                self.maker.ask(request)
                self.options.show_words(WORKING, stale=True)
        self._refresh()

    def _on_found(self, contents: DrawingContents | None) -> None:
        if self.page is self.file:
            self.file.show_contents(contents)
            if self._asked is not None:  # the choice of regions is part of the request
                self._asked = {**self._asked, "source": self.file.source}

    def _on_made(self, made: NewMesh) -> None:
        self.made = made
        self.options.set_extent(made.extent)
        self.options.show_made(made)
        if self._accepting:
            self.accept()
        else:
            self._refresh()

    def _on_failed(self, words: str) -> None:
        self._accepting = False
        self.options.show_words(NO_MESH, stale=False)
        self._refresh(sentence(words))

    def _on_message(self, words: str) -> None:
        self._error = words
        self._refresh()

    def _refresh(self, failed: str = "") -> None:
        self.make.setText(
            WORKING if self._accepting else MAKE if self.page.takes_settings else OPEN
        )
        self.make.setEnabled(not self._accepting and (self.made is not None or self.maker.busy))
        wrong = failed or self._error or (self.page.words if self.page.is_wrong else "")
        self.status.setText(wrong or self.page.words)
        self.mark.setVisible(bool(wrong))
        if self.status.property("warns") != bool(wrong):
            self.status.setProperty("warns", bool(wrong))
            self.status.style().unpolish(self.status)
            self.status.style().polish(self.status)


def _style(theme: Theme) -> str:
    return f"""
#Status {{ color: {theme.muted}; }}
#Status[warns="true"] {{ color: {theme.warning}; }}
#Table QHeaderView::section {{ padding: 4px 11px; }}
#Table QLineEdit {{ padding: 0 4px; border-radius: 0; border: 1px solid {theme.accent}; }}
QListWidget {{ font-size: 12px; }}
QListWidget::item {{ padding: 4px 2px; }}
#DropZone {{ border: 1px dashed {theme.faint}; border-radius: 8px;
            background: {theme.background}; }}
#DropZone[over="true"] {{ border-color: {theme.accent}; background: {theme.accent_soft}; }}
"""
