"""The panel of the Blocks view: the selected chord or block, its tools, and the whole grid."""

from __future__ import annotations

from dataclasses import dataclass

from qtpy.QtCore import QSignalBlocker, QSize, Signal
from qtpy.QtGui import QColor, QIcon, QPixmap, QResizeEvent
from qtpy.QtWidgets import (
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.widgets.action_set import ActionSet, tooltip
from meshwright.desktop.widgets.basic import ValueLine, named, rule
from meshwright.desktop.widgets.number_box import DecimalBox, IntegerBox
from meshwright.document.block_edits import MOST_ACROSS
from meshwright.graphics.theme import GRID, Theme
from meshwright_core.blocks.sizing import STEEPEST
from meshwright_core.core.grid_plan import Grading

POINT = "Click an edge to select its chord, or a quad; drag an edge to slide its line."
TOOLS = (
    ("blocks.insert", "Insert"),
    ("blocks.collapse", "Collapse"),
    ("blocks.slide_left", "Slide left"),
    ("blocks.slide_right", "Slide right"),
    ("blocks.straighten", "Straighten"),
    ("blocks.even", "Even cells"),
)
GROWTH = 1.2
BUTTON = 30
"""Height of a button in pixels."""


@dataclass(frozen=True)
class ChordShown:
    """What the panel says of the selected chord."""

    chord: int
    colour: str
    edges: int
    quads: int
    count: int
    """0 where wishes contradict each other."""
    pinned: bool
    """Whether the user has set the count."""
    grading: Grading
    shortest: float
    """The length of its shortest edge."""


class BlocksPanel(QWidget):
    """Shows the selection and the grid.

    ``count_set(n)``, ``count_freed()``, ``grading_set(Grading)``, ``size_set(h)``, 0 for none, are
    wishes of the user; ``chord_chosen(chord)`` a chord of the selected block.
    """

    count_set = Signal(int)
    count_freed = Signal()
    grading_set = Signal(object)
    size_set = Signal(float)
    chord_chosen = Signal(int)

    def __init__(self, actions: ActionSet, theme: Theme) -> None:
        super().__init__()
        self._actions, self._theme = actions, theme
        self._shown: ChordShown | None = None
        self._swatch = QLabel()
        self._title = named("", "Value")
        self._note = named(POINT, "Hint")
        self._note.setWordWrap(True)
        self.count = IntegerBox()
        self.count.setRange(1, MOST_ACROSS)
        self.count.setKeyboardTracking(False)
        self.count.setAccessibleName("Cells across the chord")
        self.free = QPushButton("Auto")
        self.free.setToolTip(tooltip(actions.entry("blocks.free")))
        self.first, self.last = self._height("First cell"), self._height("Last cell")
        self.ratio = DecimalBox()
        self.ratio.setRange(1.0, STEEPEST)
        self.ratio.setSingleStep(0.05)
        self.ratio.setKeyboardTracking(False)
        self.ratio.setAccessibleName("Growth from cell to cell")
        self.cell_size = self._height("Size of a cell", "by geometry")
        self.crossing = (QPushButton(), QPushButton())
        self.tools: dict[str, QPushButton] = {}
        self.export = QPushButton("Export blocks\u2026")
        self.values = {
            name: ValueLine(title, words)
            for name, title, words in (
                (
                    "quads",
                    "Quads, blocks, chords",
                    "Each quad is exported as a block of its own; as in the score panel, those that"
                    " form one regular grid are counted as one block. Chords are strips of quads",
                ),
                ("cells", "Cells", "Cells of the fine grid"),
                ("worst", "Worst cell", "Smallest scaled Jacobian of a cell"),
                ("aspect", "Aspect ratio", "Largest one of a cell"),
            )
        }
        self._arrange()
        self._connect()
        self.show_chord(None)

    def _height(self, name: str, none: str = "even") -> DecimalBox:
        box = DecimalBox()
        box.setDecimals(5)
        box.setRange(0.0, 1e9)
        box.setSpecialValueText(none)
        box.setKeyboardTracking(False)
        box.setAccessibleName(name)
        return box

    def _arrange(self) -> None:
        head = QHBoxLayout()
        head.setSpacing(GRID)
        head.addWidget(self._swatch)
        head.addWidget(self._title, 1)
        self._fields = QWidget()
        grid = QGridLayout(self._fields)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(GRID)
        grid.setVerticalSpacing(GRID // 2)
        count = QHBoxLayout()
        count.setSpacing(GRID // 2)
        count.addWidget(self.count, 1)
        count.addWidget(self.free)
        grid.addWidget(named("Cells", "Label"), 0, 0)
        grid.addLayout(count, 0, 1)
        for row, (title, box) in enumerate(
            (("First cell", self.first), ("Last cell", self.last), ("Growth", self.ratio)), 1
        ):
            grid.addWidget(named(title, "Label"), row, 0)
            grid.addWidget(box, row, 1)
        tools = QGridLayout()
        tools.setSpacing(GRID // 2)
        for number, (action, word) in enumerate(TOOLS):
            button = QPushButton(word)
            button.setToolTip(tooltip(self._actions.entry(action)))
            button.clicked.connect(self._actions[action].trigger)
            self.tools[action] = button
            button.setMinimumHeight(BUTTON)
            tools.addWidget(button, number // 2, number % 2)
        grid.addLayout(tools, 4, 0, 1, 2)
        self._of_block = QWidget()
        for part in (self._fields, self._of_block):
            part.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        links = QHBoxLayout(self._of_block)
        links.setContentsMargins(0, 0, 0, 0)
        for link in self.crossing:
            link.setIconSize(QSize(10, 10))
            links.addWidget(link, 1)
        whole = QHBoxLayout()
        whole.addWidget(named("Cell size", "Label"))
        whole.addWidget(self.cell_size, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(GRID)
        layout.addLayout(head)
        for part in (self._note, self._fields, self._of_block, rule()):
            layout.addWidget(part)
        layout.addLayout(whole)
        for line in self.values.values():
            layout.addWidget(line)
        self.export.setObjectName("Primary")
        self.export.setMinimumHeight(BUTTON + 2)
        for link in self.crossing:
            link.setMinimumHeight(BUTTON)
        layout.addWidget(self.export)

    def _connect(self) -> None:
        self.count.valueChanged.connect(self.count_set)
        self.free.clicked.connect(lambda: self.count_freed.emit())
        for box in (self.first, self.last, self.ratio):
            box.valueChanged.connect(self._on_grading)
        self.cell_size.valueChanged.connect(self.size_set)
        self.export.clicked.connect(self._actions["blocks.export"].trigger)
        for place, link in enumerate(self.crossing):
            link.clicked.connect(lambda checked=False, i=place: self._on_link(i))
        self._links = (-1, -1)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Give the hint the lines that it takes in this width."""
        super().resizeEvent(event)
        self._note.setMinimumHeight(self._note.heightForWidth(self._note.width()))

    def _say(self, words: str) -> None:
        self._note.setText(words)
        self._note.setMinimumHeight(self._note.heightForWidth(self._note.width()))

    def show_chord(self, shown: ChordShown | None) -> None:
        """Show the selected chord; None for none."""
        self._shown = shown
        self._fields.setVisible(shown is not None)
        self._of_block.hide()
        self._swatch.setVisible(shown is not None)
        self._title.setVisible(shown is not None)
        if shown is None:
            self._say(POINT)
            return
        self._swatch.setPixmap(_square(shown.colour))
        self._title.setText(f"Chord {shown.chord}")
        how = "cells set" if shown.pinned else "cells by size"
        edges = "1 edge" if shown.edges == 1 else f"{shown.edges} edges"
        quads = "1 quad" if shown.quads == 1 else f"{shown.quads} quads"
        self._say(f"{edges}, {quads}; {how}")
        self.free.setEnabled(shown.pinned)
        fields = (self.count, self.first, self.last, self.ratio)
        blockers = [QSignalBlocker(box) for box in fields]
        self.count.setValue(shown.count)
        for box, value in zip(fields[1:], shown.grading, strict=True):
            box.setValue(value)
        for box in (self.first, self.last):
            box.setSingleStep(0.01 * shown.shortest)
        del blockers

    def show_block(
        self, block: int, shape: tuple[int, int], chords: tuple[int, int], colours: tuple[str, str]
    ) -> None:
        """Show the selected block with the chords that cross it."""
        self.show_chord(None)
        self._title.show()
        self._title.setText(f"Quad {block}")
        self._say(f"{shape[0]} \u00d7 {shape[1]} cells, crossed by two chords:")
        self._links = chords
        for link, chord, colour in zip(self.crossing, chords, colours, strict=True):
            link.setText(f"Chord {chord}")
            link.setIcon(QIcon(_square(colour)))
        self._of_block.show()

    def show_size(self, size: float | None, usual: float) -> None:
        """Show the size of cells that was set; None for none."""
        blocker = QSignalBlocker(self.cell_size)
        self.cell_size.setSingleStep(0.1 * usual)
        self.cell_size.setValue(size or 0.0)
        del blocker

    def _on_grading(self) -> None:
        if self._shown is not None:
            self.grading_set.emit(
                Grading(self.first.value(), self.last.value(), self.ratio.value())
            )

    def _on_link(self, place: int) -> None:
        if self._links[place] >= 0:
            self.chord_chosen.emit(self._links[place])


def _square(colour: str) -> QPixmap:
    """A small square in a colour."""
    drawn = QPixmap(12, 12)
    drawn.fill(QColor(colour))
    return drawn
