"""What is shown without a mesh, and the pages of help."""

from collections.abc import Callable
from importlib.metadata import PackageNotFoundError, version

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QDialog,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.desktop import icons
from app.desktop.action import Action, key_text
from app.desktop.widgets import named
from app.theme import GRID

MOUSE = (
    ("Move", "Points at the half-edge nearest to the mouse"),
    ("Click", "Operations of the half-edge"),
    ("Right click", "Desired degree, corner, lock of a vertex"),
    ("Drag", "Moves the picture"),
    ("Wheel", "Zooms at the mouse"),
)


class EmptyPage(QWidget):
    """Shown in the canvas's place while there is no mesh."""

    def __init__(self, new: Callable[[], None], open_file: Callable[[], None]) -> None:
        super().__init__()
        self.setObjectName("Empty")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        title = named("No mesh yet", "EmptyTitle")
        text = named("Take a shape from the gallery, or open a triangle or quad mesh.", "EmptyText")
        shape, file = QPushButton("Take a shape\u2026"), QPushButton("Open a file\u2026")
        shape.setObjectName("Primary")
        shape.clicked.connect(lambda checked=False: new())
        file.clicked.connect(lambda checked=False: open_file())
        buttons = QHBoxLayout()
        buttons.setSpacing(GRID)
        buttons.addStretch(1)
        buttons.addWidget(shape)
        buttons.addWidget(file)
        buttons.addStretch(1)
        layout = QVBoxLayout(self)
        layout.setSpacing(GRID)
        layout.addStretch(1)
        for part in (title, text):
            part.setAlignment(Qt.AlignmentFlag.AlignHCenter)
            layout.addWidget(part)
        layout.addSpacing(2 * GRID)
        layout.addLayout(buttons)
        layout.addStretch(1)


class KeysDialog(QDialog):
    """All keys, from the table of actions, and the mouse."""

    def __init__(self, groups: list[tuple[str, list[Action]]], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Keys and mouse")
        columns = QHBoxLayout(self)
        columns.setContentsMargins(4 * GRID, 3 * GRID, 4 * GRID, 4 * GRID)
        columns.setSpacing(6 * GRID)
        blocks = [
            (menu, [(key_text(a.shortcuts[0]), a.title) for a in members if a.shortcuts])
            for menu, members in groups
        ]
        blocks.append(("Mouse", list(MOUSE)))
        left = [block for block in blocks if block[0] in ("Mesh", "Agent")]
        right = [block for block in blocks if block not in left]
        for side in (left, right):
            column = QVBoxLayout()
            column.setSpacing(2 * GRID)
            for title, lines in side:
                column.addLayout(self._block(title, lines))
            column.addStretch(1)
            columns.addLayout(column)

    def _block(self, title: str, lines: list[tuple[str, str]]) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(2 * GRID)
        grid.setVerticalSpacing(6)
        grid.setColumnStretch(1, 1)
        grid.addWidget(named(title.upper(), "Heading"), 0, 0, 1, 2)
        for row, (keys, text) in enumerate(lines, start=1):
            key = named(keys, "Key")
            key.setAlignment(Qt.AlignmentFlag.AlignCenter)
            grid.addWidget(key, row, 0)
            grid.addWidget(named(text.rstrip("\u2026"), "Operation"), row, 1)
        return grid


class AboutDialog(QDialog):
    """What this is, its version and licences."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("About Meshwright")
        self.setFixedWidth(440)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(4 * GRID, 4 * GRID, 4 * GRID, 3 * GRID)
        layout.setSpacing(GRID)
        picture = named("", "Picture")
        picture.setPixmap(icons.app_icon().pixmap(48, 48))
        layout.addWidget(picture)
        layout.addWidget(named(f"Meshwright {_version()}", "EmptyTitle"))
        for sentence in (
            "Edits the connectivity of triangle and quad meshes half-edge by half-edge, "
            "with a trained agent beside you.",
            "After A. Narayanan, Y. Pan, P.-O. Persson, \u201cLearning topological operations on "
            "meshes with application to block decomposition of polygons\u201d.",
            "MIT licence. Uses Qt for Python (LGPL), VTK and PyVista, NumPy, Numba, PyTorch, and "
            "Shewchuk\u2019s Triangle, which is free for non-commercial use only.",
        ):
            text = named(sentence, "Label")
            text.setWordWrap(True)
            layout.addWidget(text)
        close = QPushButton("Close")
        close.clicked.connect(self.accept)
        line = QHBoxLayout()
        line.addStretch(1)
        line.addWidget(close)
        layout.addSpacing(GRID)
        layout.addLayout(line)


def _version() -> str:
    try:
        return version("meshwright")
    except PackageNotFoundError:
        return ""
