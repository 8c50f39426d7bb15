"""The panels at the right, one above the other."""

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QFrame, QScrollArea, QVBoxLayout, QWidget

from app.desktop.widgets import rule
from app.theme import GRID

WIDTH = 312


def sidebar(*panels: QWidget) -> QWidget:
    """A column of ``panels`` with a thin line between them; it scrolls in a low window."""
    body = QWidget()
    body.setObjectName("SidebarBody")
    column = QVBoxLayout(body)
    column.setContentsMargins(3 * GRID, 2 * GRID, 3 * GRID, 2 * GRID)
    column.setSpacing(2 * GRID)
    for number, panel in enumerate(panels):
        if number:
            column.addWidget(rule())
        column.addWidget(panel)
    column.addStretch(1)
    area = QScrollArea()
    area.setWidgetResizable(True)
    area.setFrameShape(QFrame.Shape.NoFrame)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    area.setWidget(body)
    area.viewport().setAutoFillBackground(False)
    frame = QFrame()
    frame.setObjectName("Sidebar")
    frame.setFixedWidth(WIDTH)
    layout = QVBoxLayout(frame)
    layout.setContentsMargins(0, 0, 0, 0)
    layout.addWidget(area)
    return frame
