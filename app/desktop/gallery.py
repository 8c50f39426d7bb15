"""The dialog that makes a mesh of a gallery shape."""

from qtpy.QtCore import QPointF, QSize, Qt
from qtpy.QtGui import QColor, QIcon, QPainter, QPainterPath, QPen, QPixmap
from qtpy.QtWidgets import (
    QButtonGroup,
    QDialog,
    QHBoxLayout,
    QListView,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.desktop.widgets import named
from app.theme import GRID, Theme
from app.viewport import Viewport
from meshcore import shapes
from meshcore.domain import Domain

THUMBNAIL = QSize(112, 88)
KINDS = (("Quads", "quad"), ("Triangles", "tri"))


class Gallery(QDialog):
    """Asks for a shape and a kind of element."""

    def __init__(self, kind: str, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("New from shape")
        self.resize(832, 640)
        self._kind = kind or "quad"
        self.shapes = QListWidget()
        self.shapes.setViewMode(QListView.ViewMode.IconMode)
        self.shapes.setResizeMode(QListView.ResizeMode.Adjust)
        self.shapes.setMovement(QListView.Movement.Static)
        self.shapes.setIconSize(THUMBNAIL)
        self.shapes.setGridSize(QSize(THUMBNAIL.width() + 4 * GRID, THUMBNAIL.height() + 5 * GRID))
        self.shapes.setUniformItemSizes(True)
        self.shapes.setWordWrap(True)
        for name, domain in shapes.gallery().items():
            item = QListWidgetItem(thumbnail(domain, theme, self.devicePixelRatioF()), _title(name))
            item.setData(Qt.ItemDataRole.UserRole, name)
            item.setTextAlignment(Qt.AlignmentFlag.AlignHCenter)
            self.shapes.addItem(item)
        self.shapes.setCurrentRow(0)
        self.shapes.itemDoubleClicked.connect(self.accept)
        self._arrange()

    @property
    def shape(self) -> str:
        """Name of the chosen shape."""
        return str(self.shapes.currentItem().data(Qt.ItemDataRole.UserRole))

    @property
    def kind(self) -> str:
        """``"quad"`` or ``"tri"``."""
        return self._kind

    def _arrange(self) -> None:
        layout = QVBoxLayout(self)
        layout.setContentsMargins(3 * GRID, 3 * GRID, 3 * GRID, 2 * GRID)
        layout.setSpacing(2 * GRID)
        layout.addWidget(self.shapes, 1)
        line = QHBoxLayout()
        line.setSpacing(0)
        line.addWidget(named("Elements", "Label"))
        line.addSpacing(12)
        self.kinds = QButtonGroup(self)
        for title, kind in KINDS:
            button = QPushButton(title)
            button.setObjectName("Segment")
            button.setCheckable(True)
            button.setAutoDefault(False)
            button.setChecked(kind == self._kind)
            button.toggled.connect(self._on_kind_toggled)
            button.setProperty("kind", kind)
            self.kinds.addButton(button)
            line.addWidget(button)
        line.addStretch(1)
        cancel, make = QPushButton("Cancel"), QPushButton("Make mesh")
        make.setObjectName("Primary")
        make.setDefault(True)
        cancel.setAutoDefault(False)
        cancel.clicked.connect(self.reject)
        make.clicked.connect(self.accept)
        line.addWidget(cancel)
        line.addSpacing(GRID)
        line.addWidget(make)
        layout.addLayout(line)

    def _on_kind_toggled(self, checked: bool) -> None:
        if checked:
            self._kind = self.sender().property("kind")


def _title(name: str) -> str:
    words = name.replace("_", " ").replace("-", " ")
    return words[:1].upper() + words[1:]


def thumbnail(domain: Domain, theme: Theme, ratio: float = 1.0) -> QIcon:
    """A small drawing of a domain: its outline and holes, its corners as squares."""
    drawn = QPixmap(THUMBNAIL * ratio)
    drawn.setDevicePixelRatio(ratio)
    drawn.fill(Qt.GlobalColor.transparent)
    view = Viewport(size=(THUMBNAIL.width(), THUMBNAIL.height()))
    view = view.fitted(domain.outline, margin=10.0)
    path = QPainterPath()
    for loop in (domain.outline, *domain.holes):
        points = [QPointF(x, y) for x, y in view.to_screen(loop).tolist()]
        path.addPolygon([*points, points[0]])
    painter = QPainter(drawn)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(QColor(theme.boundary), 1.25))
    painter.setBrush(QColor(theme.fill))
    painter.drawPath(path)
    painter.end()
    made = QIcon(drawn)
    made.addPixmap(drawn, QIcon.Mode.Selected)
    return made
