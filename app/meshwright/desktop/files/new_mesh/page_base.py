"""The base class of the dialog's pages, and lists of pictures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from qtpy.QtCore import QSize, Qt, Signal
from qtpy.QtGui import QIcon, QPainter, QPixmap
from qtpy.QtWidgets import QListView, QListWidget, QListWidgetItem, QWidget

from meshwright.desktop.files.new_mesh.painting import paint_shape, squares
from meshwright.graphics.theme import GRID, Theme
from meshwright.graphics.viewport import Viewport
from meshwright_core.domains.domain import Domain
from meshwright_core.errors import capitalised

PICTURE = QSize(112, 88)


class Page(QWidget):
    """One source of shapes. ``changed()`` when another shape is chosen; ``message(sentence)`` for
    the status line.

    A page fills itself when it is first shown.
    """

    changed = Signal()
    message = Signal(str)

    @property
    def takes_settings(self) -> bool:
        """Whether kind, size and quality apply to what is chosen here."""
        return True

    @property
    def source(self) -> dict[str, Any] | None:
        """As :func:`meshwright.sources.mesh_worker.make` takes it; None while there is nothing to
        mesh.
        """
        raise NotImplementedError

    @property
    def state(self) -> dict[str, Any]:
        """What :meth:`restore` needs to show the same again, as JSON has it."""
        return {}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Show what was shown when ``state`` was read; ValueError, KeyError or TypeError if that is
        damaged.
        """

    @property
    def words(self) -> str:
        """Why there is nothing to mesh, or what to do next."""
        return ""

    @property
    def is_wrong(self) -> bool:
        """Whether :attr:`words` describe an error rather than the next step."""
        return False

    def fill(self) -> None:
        """Fill the page with what takes time to compute."""

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""

    def release(self) -> None:
        """Disconnect, and end processes."""


class Pictures(QListWidget):
    """A list of shapes as small pictures."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.setAccessibleName(name)
        self.setViewMode(QListView.ViewMode.IconMode)
        self.setResizeMode(QListView.ResizeMode.Adjust)
        self.setMovement(QListView.Movement.Static)
        self.setIconSize(PICTURE)
        self.setWordWrap(True)
        self.setTextElideMode(Qt.TextElideMode.ElideNone)
        self.setSpacing(0)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setGridSize(QSize(PICTURE.width() + 5 * GRID // 2, PICTURE.height() + 6 * GRID))

    def add(self, title: str, key: object, domain: Domain, theme: Theme) -> None:
        """Add a shape at the end."""
        item = QListWidgetItem(picture(domain, theme, self.devicePixelRatioF()), title)
        item.setData(Qt.ItemDataRole.UserRole, key)
        item.setTextAlignment(Qt.AlignmentFlag.AlignHCenter)
        self.addItem(item)

    @property
    def key(self) -> Any:
        """The key of the chosen shape, None if there is none."""
        item = self.currentItem()
        return None if item is None else item.data(Qt.ItemDataRole.UserRole)


def picture(domain: Domain, theme: Theme, ratio: float = 1.0) -> QIcon:
    """A small drawing of a domain: its outline and holes, its corners as squares."""
    drawn = QPixmap(PICTURE * ratio)
    drawn.setDevicePixelRatio(ratio)
    drawn.fill(Qt.GlobalColor.transparent)
    view = Viewport(size=(PICTURE.width(), PICTURE.height())).fitted(domain.outline, 8.0)
    painter = QPainter(drawn)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    paint_shape(painter, view, domain.loops, theme, 1.25)
    for loop, flags in zip(domain.loops, domain.loop_corners, strict=True):
        if flags.any():
            squares(painter, view.to_screen(loop[flags]), theme, 3.5)
    painter.end()
    made = QIcon(drawn)
    made.addPixmap(drawn, QIcon.Mode.Selected)
    return made


def words_of(name: str) -> str:
    """A shape's name as a title."""
    return capitalised(name.replace("_", " ").replace("-", " "))
