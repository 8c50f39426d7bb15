"""The page with the shapes of the gallery."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QVBoxLayout

from meshwright.desktop.files.new_mesh.page_base import Page, Pictures, words_of
from meshwright.graphics.theme import Theme
from meshwright_core.domains import gallery
from meshwright_core.domains.domain import Domain


@cache
def _drawn() -> dict[str, Domain]:
    """The shapes as the pictures show them, made once; nobody may change them."""
    return gallery.gallery()


class GalleryPage(Page):
    """Offers the named shapes of the gallery."""

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self._theme = theme
        self.shapes = Pictures("Shapes of the gallery")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.shapes)
        self.shapes.currentItemChanged.connect(self._on_chosen)

    @property
    def source(self) -> dict[str, Any] | None:
        """The chosen shape."""
        return {"shape": self.shapes.key} if self.shapes.key else None

    @property
    def state(self) -> dict[str, Any]:
        """The chosen shape."""
        return {"shape": self.shapes.key}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Choose the same shape again."""
        if state["shape"]:
            self.choose(state["shape"])

    def fill(self) -> None:
        """Draw the pictures."""
        if self.shapes.count() == 0:
            for name, domain in _drawn().items():
                self.shapes.add(words_of(name), name, domain, self._theme)
            self.shapes.setCurrentRow(0)
        self.shapes.setFocus()

    def choose(self, name: str) -> None:
        """Choose a shape by its name."""
        self.fill()
        for row in range(self.shapes.count()):
            if self.shapes.item(row).data(Qt.ItemDataRole.UserRole) == name:
                self.shapes.setCurrentRow(row)

    def _on_chosen(self) -> None:
        self.changed.emit()
