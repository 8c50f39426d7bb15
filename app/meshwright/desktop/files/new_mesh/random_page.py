"""The page of random shapes: pictures of several seeds to choose from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from qtpy.QtCore import QSignalBlocker, Qt, QTimer
from qtpy.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout

from meshwright.desktop.files.new_mesh.controls import SegmentedButtons
from meshwright.desktop.files.new_mesh.page_base import Page, Pictures
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import named
from meshwright.desktop.widgets.number_box import IntegerBox
from meshwright.graphics.theme import GRID, Theme
from meshwright_core.domains import gallery, random_parts
from meshwright_core.domains.domain import Domain

SHOWN = 20
"""Number of seeds that are shown at a time."""
FEWEST, MOST = 3, 60
FEWEST_OF_PART = 4
LAST_SEED = 999_999_999
KINDS = (("polygon", "Star-like polygon"), ("part", "Engineering part"))


class RandomPage(Page):
    """A random polygon, as the benchmark has them, or a random part with steps, slots and holes."""

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self._theme = theme
        self.kind = SegmentedButtons(KINDS, "Kind of shape")
        self.sides = IntegerBox()
        self.sides.setRange(FEWEST, MOST)
        self.sides.setValue(10)
        self.sides.setAccessibleName("Sides")
        self.seed = IntegerBox()
        self.seed.setRange(0, LAST_SEED)
        self.seed.setAccessibleName("Seed")
        self.seed.setToolTip("The same number of sides and seed always give the same shape")
        self.seed.setMinimumWidth(10 * GRID)
        for field in (self.sides, self.seed):
            field.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.sides.setFixedWidth(8 * GRID)
        self.dice = QPushButton("Other seeds")
        self.dice.setToolTip("Show shapes of other seeds")
        self.dice.setAutoDefault(False)
        self.pictures = Pictures("Random shapes by seed")
        self._pause = QTimer(self)
        self._pause.setSingleShot(True)
        self._pause.setInterval(60)
        self._pause.timeout.connect(self._draw)
        self._arrange()
        self.kind.changed.connect(self._on_kind_changed)
        self.sides.valueChanged.connect(self._on_changed)
        self.seed.valueChanged.connect(self._on_seed_typed)
        self.dice.clicked.connect(self.roll)
        self.pictures.currentItemChanged.connect(self._on_picked)
        self.set_theme(theme)

    def _arrange(self) -> None:
        line = QHBoxLayout()
        line.setSpacing(GRID)
        line.addWidget(named("Sides", "Label"))
        line.addWidget(self.sides)
        line.addSpacing(GRID)
        line.addWidget(named("Seed", "Label"))
        line.addWidget(self.seed)
        line.addWidget(self.dice)
        line.addStretch(1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2 * GRID)
        layout.addWidget(self.kind)
        layout.addLayout(line)
        layout.addWidget(self.pictures, 1)

    @property
    def source(self) -> dict[str, Any] | None:
        """The kind, the sides and the seed."""
        return {self.kind.key: self.sides.value(), "seed": self.seed.value()}

    @property
    def state(self) -> dict[str, Any]:
        """The kind, the sides and the seed."""
        return {"kind": self.kind.key, "sides": self.sides.value(), "seed": self.seed.value()}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Choose the same shape again."""
        self.kind.key = state["kind"]
        self._on_kind_changed()
        self.sides.setValue(state["sides"])
        self.seed.setValue(state["seed"])

    def fill(self) -> None:
        """Draw the pictures."""
        if self.pictures.count() == 0:
            self._draw()

    def roll(self) -> None:
        """Show other seeds, and choose the first of them."""
        self._draw_from((self.seed.value() // SHOWN + 1) * SHOWN % LAST_SEED)
        self.seed.setValue(int(self.pictures.key))

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.dice.setIcon(icons.icon("dice", theme))
        if self.pictures.count():
            self._draw()

    def release(self) -> None:
        """Stop drawing pictures."""
        self._pause.stop()

    def _draw(self) -> None:
        self._draw_from(self.seed.value() // SHOWN * SHOWN)

    def _draw_from(self, first: int) -> None:
        with QSignalBlocker(self.pictures):
            self.pictures.clear()
            for seed in range(first, min(first + SHOWN, LAST_SEED + 1)):
                self.pictures.add(f"{seed}", seed, self._shape(seed), self._theme)
            self._mark()

    def _mark(self) -> None:
        """Select the picture of the seed, or the first one."""
        self.pictures.setCurrentRow(max(0, self.seed.value() - self._first()))

    def _first(self) -> int:
        return int(self.pictures.item(0).text()) if self.pictures.count() else 0

    def _shape(self, seed: int) -> Domain:
        rng = np.random.default_rng(seed)
        if self.kind.key == "part":
            return random_parts.random_part(self.sides.value(), rng)
        return gallery.random_polygon(self.sides.value(), rng)

    def _on_kind_changed(self) -> None:
        self.sides.setMinimum(FEWEST_OF_PART if self.kind.key == "part" else FEWEST)
        self._on_changed()

    def _on_changed(self) -> None:
        self._pause.start()
        self.changed.emit()

    def _on_seed_typed(self) -> None:
        seed, first = self.seed.value(), self._first()
        if first <= seed < first + self.pictures.count():
            with QSignalBlocker(self.pictures):
                self._mark()
        else:
            self._pause.start()
        self.changed.emit()

    def _on_picked(self) -> None:
        if self.pictures.key is not None:
            self.seed.setValue(int(self.pictures.key))
