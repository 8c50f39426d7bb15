"""What was found in a drawing: its regions, of which some are chosen, and what was mended."""

from __future__ import annotations

from collections.abc import Sequence

from qtpy.QtCore import QSignalBlocker, QSize, Qt, Signal
from qtpy.QtGui import QColor, QIcon, QPainter, QPixmap
from qtpy.QtWidgets import (
    QAbstractItemView,
    QGridLayout,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.widgets.basic import named, tabular
from meshwright.desktop.widgets.wording import plural
from meshwright.graphics.theme import GRID, Theme, region_swatches
from meshwright.sources.new_mesh import DrawingContents, RegionRow
from meshwright_core.errors import sentence

MOST_ROWS = 8
"""Rows of the table that are visible at a time."""
MOST_SENTENCES = 4
"""Sentences of one sort that are shown; the number of the others is told."""
NONE_CHOSEN = "Tick at least one region of the drawing."
TIP = "Ticked regions are meshed, together where they touch. A double click chooses one alone."
_ROW = 28
_SWATCH = 12
_TITLES = ("Region", "Area", "Holes", "Corners", "Layer")
_NUMBERS = (1, 2, 3)
"""Columns that hold numbers."""


class FoundRegions(QWidget):
    """The table of regions and the sentences below it; ``changed()`` when others are chosen."""

    changed = Signal()

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self._theme = theme
        self._contents: DrawingContents | None = None
        self.title = named("", "Value")
        self.all = QPushButton("Choose all")
        self.all.setObjectName("Link")
        self.all.setAutoDefault(False)
        self.table, self._head = _table()
        self._labels: list[QLabel] = []  # a title and its sentences, in turn
        self._words = QGridLayout()
        self._words.setContentsMargins(0, 0, 0, 0)
        self._words.setHorizontalSpacing(2 * GRID)
        self._words.setVerticalSpacing(GRID // 2)
        self._words.setColumnMinimumWidth(0, 8 * GRID)
        self._words.setColumnStretch(1, 1)
        head = QHBoxLayout()
        head.addWidget(self.title)
        head.addStretch(1)
        head.addWidget(self.all)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(GRID)
        layout.addLayout(head)
        layout.addWidget(self.table)
        layout.addLayout(self._words)
        self.table.itemChanged.connect(self._on_ticked)
        self.table.cellDoubleClicked.connect(self._on_double_click)
        self.all.clicked.connect(self._on_all)
        self.show_contents(None)

    @property
    def chosen(self) -> list[int]:
        """The indices of the ticked regions."""
        rows = range(self.table.rowCount())
        return list(rows) if len(rows) == 1 else [row for row in rows if self._is_ticked(row)]

    @property
    def choice(self) -> str | None:
        """The chosen regions as :func:`meshwright.sources.mesh_worker.make` takes them, empty for
        none; None before anything was found.
        """
        if self._contents is None or not self._contents.regions:
            return None
        return ",".join(str(row + 1) for row in self.chosen)

    @property
    def sentences(self) -> list[str]:
        """The sentences below the table."""
        return [label.text() for label in self._labels[1::2]]

    def show_contents(self, contents: DrawingContents | None) -> None:
        """Show what was found in a drawing; None for no drawing."""
        before, self._contents = self._contents, contents
        self.setVisible(contents is not None)
        if contents is None:
            return
        units = f" ({contents.units}\u00b2)" if contents.units else ""
        self._head[1].setText(f"Area{units}")
        count = len(contents.regions)
        groups = 1 + max((row.group for row in contents.regions), default=-1)
        apart = f", in {groups} parts" if groups > 1 else ""
        if groups == 1 < count:
            apart = ", which touch"
        self.title.setText(f"{plural(count, 'region')} in the drawing{apart}")
        with QSignalBlocker(self.table):
            if before is None or before.regions != contents.regions:
                self.table.setRowCount(count)
                for row, region in enumerate(contents.regions):
                    self._fill(row, region, row in contents.chosen, count > 1)
        self.table.setColumnHidden(4, not any(row.layer for row in contents.regions))
        height = self.table.horizontalHeader().sizeHint().height() + 2
        self.table.setFixedHeight(height + _ROW * min(max(count, 1), MOST_ROWS))
        self.table.setVisible(count > 0)
        self.all.setVisible(count > 1)
        self._mark()
        self._say(contents)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self._mark()

    def _fill(self, row: int, region: RegionRow, ticked: bool, several: bool) -> None:
        counts = str(region.holes), str(region.corners)
        texts = (region.name, f"{region.area:,.6g}", *counts, region.layer)
        for column, text in enumerate(texts):
            item = QTableWidgetItem(text)
            flags = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
            if column == 0 and several:
                flags |= Qt.ItemFlag.ItemIsUserCheckable
                item.setCheckState(Qt.CheckState.Checked if ticked else Qt.CheckState.Unchecked)
            side = Qt.AlignmentFlag.AlignRight if column in _NUMBERS else Qt.AlignmentFlag.AlignLeft
            item.setTextAlignment(side | Qt.AlignmentFlag.AlignVCenter)
            item.setFlags(flags)
            if several:
                item.setToolTip(TIP)
            self.table.setItem(row, column, item)

    def _mark(self) -> None:
        """Give the chosen regions the colours that they have in the preview."""
        chosen = self.chosen
        swatches = region_swatches(self._theme, len(chosen))
        with QSignalBlocker(self.table):  # an icon counts as a change of its item
            for row in range(self.table.rowCount()):
                icon = QIcon()
                if len(chosen) > 1:
                    colour = swatches[chosen.index(row)] if row in chosen else ""
                    icon = _swatch(colour, self._theme, self.devicePixelRatioF())
                self._item(row).setIcon(icon)

    def _say(self, contents: DrawingContents) -> None:
        for label in self._labels:
            self._words.removeWidget(label)
            label.hide()
            label.deleteLater()
        self._labels = []
        row = 0
        for title, sentences in (
            ("Open", contents.missed), ("Mended", contents.repairs), ("Left out", contents.ignored),
        ):  # fmt: skip
            if not sentences:
                continue
            label = named(title, "Hint")
            self._words.addWidget(label, row, 0, Qt.AlignmentFlag.AlignTop)
            words = named(_joined(sentences), "Hint")
            words.setWordWrap(True)
            words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            self._words.addWidget(words, row, 1)
            self._labels += [label, words]
            row += 1

    def _is_ticked(self, row: int) -> bool:
        return bool(self._item(row).checkState() == Qt.CheckState.Checked)

    def _item(self, row: int) -> QTableWidgetItem:
        found = self.table.item(row, 0)
        assert found is not None
        return found

    def _tick(self, rows: Sequence[int]) -> None:
        with QSignalBlocker(self.table):
            for row in range(self.table.rowCount()):
                state = Qt.CheckState.Checked if row in rows else Qt.CheckState.Unchecked
                self._item(row).setCheckState(state)
        self._on_ticked()

    def _on_ticked(self) -> None:
        self._mark()
        self.changed.emit()

    def _on_double_click(self, row: int, column: int) -> None:
        self._tick([row])

    def _on_all(self) -> None:
        self._tick(range(self.table.rowCount()))


def _table() -> tuple[QTableWidget, list[QTableWidgetItem]]:
    """The empty table, and the items of its header."""
    made = QTableWidget(0, len(_TITLES))
    made.setObjectName("Table")
    made.setAccessibleName("Regions in the drawing")
    made.verticalHeader().hide()
    made.verticalHeader().setDefaultSectionSize(_ROW)
    made.setShowGrid(False)
    made.setFont(tabular(made.font()))
    made.setIconSize(QSize(_SWATCH, _SWATCH))
    made.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    made.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    made.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
    made.setTabKeyNavigation(False)
    header = made.horizontalHeader()
    header.setHighlightSections(False)
    header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
    header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
    head = []
    for column, title in enumerate(_TITLES):
        item = QTableWidgetItem(title)
        side = Qt.AlignmentFlag.AlignRight if column in _NUMBERS else Qt.AlignmentFlag.AlignLeft
        item.setTextAlignment(side | Qt.AlignmentFlag.AlignVCenter)
        made.setHorizontalHeaderItem(column, item)
        head.append(item)
    return made, head


def _swatch(colour: str, theme: Theme, ratio: float) -> QIcon:
    """A small square of a colour; "" for an empty one."""
    drawn = QPixmap(QSize(_SWATCH, _SWATCH) * ratio)
    drawn.setDevicePixelRatio(ratio)
    drawn.fill(Qt.GlobalColor.transparent)
    if colour:
        painter = QPainter(drawn)
        painter.setPen(QColor(theme.boundary))
        painter.setBrush(QColor(colour))
        painter.drawRect(0, 0, _SWATCH - 1, _SWATCH - 1)
        painter.end()
    return QIcon(drawn)


def _joined(sentences: Sequence[str]) -> str:
    """Sentences one below the other, the first few of them."""
    lines = [sentence(words) for words in sentences[:MOST_SENTENCES]]
    more = len(sentences) - len(lines)
    if more:
        lines.append(f"And {more:,} more.")
    return "\n".join(lines)
