"""What is shown in the place of a mesh while there is none."""

from collections.abc import Callable

from qtpy.QtCore import Qt
from qtpy.QtWidgets import (
    QHBoxLayout,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.desktop.widgets import named
from app.theme import GRID


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
