"""The page of shortcuts: all keys of the action table, and the mouse gestures."""

from collections.abc import Sequence

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QDialog,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.widgets.action_set import ActionEntry, key_text
from meshwright.desktop.widgets.basic import named
from meshwright.graphics.theme import GRID

MOST_COLUMNS = 5
"""There are as many columns as fit the window, up to this number."""
Block = tuple[str, list[tuple[str, str, str]]]
"""A heading, and for each line the keys, the title of the action, and its tooltip."""

MOUSE = (
    ("Move", "Point at a half-edge"),
    ("Click", "Menu of operations"),
    ("Right click", "Desired degree, corner, pin, lock"),
    ("Drag", "Move a vertex, or pan"),
    ("Wheel", "Zoom"),
    ("Shift click", "Add to the selection"),
    ("Shift drag", "Box; with Alt a lasso"),
)


class ShortcutsDialog(QDialog):
    """All keys in columns; stays open beside the window."""

    def __init__(
        self, groups: Sequence[tuple[str, Sequence[ActionEntry]]], parent: QWidget
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("Keyboard and mouse")
        room = parent.window().size()
        most = room.width() - 4 * GRID - 2 * GRID
        blocks = key_blocks(groups)
        for count in range(MOST_COLUMNS, 0, -1):
            body = _body(spread(blocks, count))
            if body.sizeHint().width() <= most or count == 1:
                break
            body.deleteLater()
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(body)
        area.setAccessibleName("Keyboard and mouse")
        close = QPushButton("Close")
        close.setToolTip("Close this page")
        close.setDefault(True)
        close.clicked.connect(self.accept)
        line = QHBoxLayout()
        line.setContentsMargins(4 * GRID, GRID, 4 * GRID, 2 * GRID)
        line.addStretch(1)
        line.addWidget(close)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(area, 1)
        layout.addLayout(line)
        wanted = body.sizeHint()
        width = min(max(wanted.width() + 2 * GRID, 880), room.width() - 4 * GRID)
        self.resize(width, min(wanted.height() + 10 * GRID, room.height() - 8 * GRID))


def _body(columns: Sequence[Sequence[Block]]) -> QWidget:
    """The page in columns."""
    made = QWidget()
    made.setObjectName("SidebarBody")
    row = QHBoxLayout(made)
    row.setContentsMargins(4 * GRID, 3 * GRID, 4 * GRID, 2 * GRID)
    row.setSpacing(3 * GRID)
    for blocks in columns:
        column = QVBoxLayout()
        column.setSpacing(2 * GRID)
        for title, lines in blocks:
            column.addLayout(_block(title, lines))
        column.addStretch(1)
        row.addLayout(column, 1)
    return made


def key_blocks(groups: Sequence[tuple[str, Sequence[ActionEntry]]]) -> list[Block]:
    """The blocks of the page: one for each menu that has shortcuts, then the mouse."""
    blocks: list[Block] = []
    for menu, members in groups:
        lines = [
            (key_text(action.shortcuts[0]), action.title.rstrip("\u2026"), action.tooltip)
            for action in members
            if action.shortcuts
        ]
        if lines:
            blocks.append((menu, lines))
    blocks.append(("Mouse", [(gesture, text, text) for gesture, text in MOUSE]))
    return blocks


def spread(blocks: Sequence[Block], columns: int) -> list[list[Block]]:
    """The blocks, in order, in ``columns`` columns of which the highest is as low as possible."""
    heights = [len(lines) + 2 for _, lines in blocks]
    low, high = max(heights), sum(heights)
    while low < high:
        middle = (low + high) // 2
        if len(_filled(blocks, heights, middle)) <= columns:
            high = middle
        else:
            low = middle + 1
    return _filled(blocks, heights, low)


def _filled(blocks: Sequence[Block], heights: Sequence[int], most: int) -> list[list[Block]]:
    made: list[list[Block]] = [[]]
    height = 0
    for block, lines in zip(blocks, heights, strict=True):
        if made[-1] and height + lines > most:
            made.append([])
            height = 0
        made[-1].append(block)
        height += lines
    return made


def _block(title: str, lines: Sequence[tuple[str, str, str]]) -> QGridLayout:
    grid = QGridLayout()
    grid.setHorizontalSpacing(12)
    grid.setVerticalSpacing(4)
    grid.setColumnMinimumWidth(0, 13 * GRID)
    grid.setColumnStretch(1, 1)
    grid.addWidget(named(title.upper(), "Heading"), 0, 0, 1, 2)
    for row, (keys, text, tooltip) in enumerate(lines, start=1):
        key = named(keys, "Key")
        key.setAlignment(Qt.AlignmentFlag.AlignCenter)
        what = named(text, "Operation")
        what.setToolTip(tooltip)
        key.setFixedHeight(20)
        grid.addWidget(key, row, 0, Qt.AlignmentFlag.AlignLeft)
        grid.addWidget(what, row, 1)
    return grid
