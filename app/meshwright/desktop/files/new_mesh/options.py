"""The right side of the dialog: preview, counts, and the options kind, size and quality."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from qtpy.QtCore import QSize, Qt, Signal
from qtpy.QtWidgets import QGridLayout, QLabel, QVBoxLayout, QWidget

from meshwright.desktop.files.new_mesh.controls import OptionalNumber, SegmentedButtons, heading
from meshwright.desktop.files.new_mesh.preview import Preview
from meshwright.desktop.widgets.basic import named, tabular
from meshwright.graphics.theme import GRID, Theme
from meshwright.sources.new_mesh import NewMesh

WIDTH = 352
KINDS = (("quad", "Quads"), ("tri", "Triangles"))
RULES = (("catmull-clark", "Cut triangles"), ("pairing", "Pair triangles"))
RULE_TIPS = {
    "catmull-clark": "Each triangle is cut into three quads: few elements, many irregular vertices",
    "pairing": "Triangles are joined in pairs: more regular elements of one size",
}
_COARSEST, _FINEST = 0.5, 1 / 1000
"""Range of the slider for the longest edge, as fractions of the shape's size."""


class Options(QWidget):
    """Preview and options; ``changed()`` when an option has changed."""

    changed = Signal()

    def __init__(self, kind: str, theme: Theme) -> None:
        super().__init__()
        self.setMaximumWidth(WIDTH)
        self.preview = Preview(theme)
        self.kind = SegmentedButtons(KINDS, "Elements", kind or "quad")
        self.rule = SegmentedButtons(RULES, "Quads by")
        for key, button in self.rule.buttons.items():
            button.setToolTip(RULE_TIPS[key])
        self.size_of = OptionalNumber(
            "Longest edge", "automatic", 0.001, 1.0, 0.2, 4, geometric=True
        )
        self.quality = OptionalNumber(
            "Minimum angle of triangles", "automatic", 0.0, 34.0, 28.0, 1, "°"
        )
        self.quality.setToolTip(
            "Lower bound of all angles in degrees; smaller angles of the shape itself remain"
        )
        self._values: dict[str, QLabel] = {}
        self._size = 0.0
        self._arrange()
        self.kind.changed.connect(self._on_kind_changed)
        self.rule.changed.connect(self._on_kind_changed)
        self.size_of.changed.connect(self.changed.emit)
        self.quality.changed.connect(self.changed.emit)
        self._on_kind_changed()

    def sizeHint(self) -> QSize:  # noqa: N802
        """As wide as it may be; less where the dialog has no room."""
        return QSize(WIDTH, super().sizeHint().height())

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.preview, 1)
        layout.addSpacing(GRID)
        layout.addLayout(self._numbers())
        layout.addSpacing(2 * GRID)
        self.settings = QWidget()
        inner = QVBoxLayout(self.settings)
        inner.setContentsMargins(0, 0, 0, 0)
        inner.setSpacing(GRID)
        inner.addWidget(heading("ELEMENTS"))
        inner.addWidget(self.kind)
        inner.addWidget(self.rule)
        inner.addSpacing(GRID // 2)
        inner.addWidget(self.size_of)
        inner.addWidget(self.quality)
        layout.addWidget(self.settings)

    def _numbers(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(GRID)
        grid.setVerticalSpacing(2)
        titles = (
            ("elements", "Elements", "Number of elements of the mesh"),
            ("vertices", "Vertices", "Number of vertices of the mesh"),
            ("score", "s", "s: the sum of |degree \u2212 desired degree| over all vertices"),
            ("optimum", "s*", "s*: no connectivity can have a lower score"),
        )
        for i, (key, title, tip) in enumerate(titles):
            value = named("\u2013", "Value")
            value.setFont(tabular(value.font()))
            value.setAccessibleName(title)
            value.setToolTip(tip)
            self._values[key] = value
            name = named(title, "Label")
            name.setToolTip(tip)
            row, at = divmod(i, 2)
            grid.addWidget(name, row, 3 * at)
            value.setAlignment(Qt.AlignmentFlag.AlignRight)
            grid.addWidget(value, row, 3 * at + 1)
        grid.setColumnStretch(1, 1)
        grid.setColumnMinimumWidth(2, 3 * GRID)
        grid.setColumnStretch(4, 1)
        return grid

    @property
    def request(self) -> dict[str, Any]:
        """The request without its source; see :func:`meshwright.sources.mesh_worker.make`."""
        return {
            "kind": self.kind.key,
            "max_edge": self.size_of.value,
            "min_angle": self.quality.value,
            "quads": self.rule.key if self.kind.key == "quad" else None,
        }

    @property
    def numbers(self) -> dict[str, str]:
        """The counts that are shown: elements, vertices, score, optimum."""
        return {key: str(label.text()) for key, label in self._values.items()}

    @property
    def state(self) -> dict[str, Any]:
        """The options, for :meth:`restore`."""
        return {**self.request, "quads": self.rule.key}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Choose the same options again, except for the kind of elements."""
        self.rule.key = state["quads"]
        self.size_of.value = state["max_edge"]
        self.quality.value = state["min_angle"]
        self._on_kind_changed()

    def show_made(self, made: NewMesh) -> None:
        """Show the mesh and its counts."""
        self.preview.show_made(made)
        counts = {"elements": len(made.elements), "vertices": len(made.points)}
        for key, number in {**counts, "score": made.score, "optimum": made.optimum}.items():
            self._values[key].setText(f"{number:,}")

    def show_words(self, words: str, stale: bool) -> None:
        """Show why there is no mesh (yet)."""
        self.preview.show_words(words, stale)
        for label in self._values.values():
            label.setText("\u2026" if stale else "\u2013")

    def set_extent(self, size: float) -> None:
        """Adapt the range of edge lengths to the size of the shape."""
        if size > 0 and not 0.99 < size / (self._size or 1e-300) < 1.01:
            self._size = size
            self.size_of.set_range(_FINEST * size, _COARSEST * size, 0.1 * size)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self.preview.set_theme(theme)

    def _on_kind_changed(self) -> None:
        self.rule.setVisible(self.kind.key == "quad")
        self.changed.emit()
