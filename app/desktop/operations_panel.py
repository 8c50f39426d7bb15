"""The operations of the mesh's kind with their keys, dimmed where the half-edge refuses them."""

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QGridLayout, QLabel, QVBoxLayout, QWidget

from app.desktop.widgets import named, sentence
from app.document import Document
from app.theme import GRID
from meshcore.operations import Operation, of_kind


class OperationsPanel(QWidget):
    """Follows the document's kind and hover. ``ready`` is set once verdicts can be asked for."""

    def __init__(self, document: Document) -> None:
        super().__init__()
        self._document = document
        self.ready = False
        self._kind = ""
        self._labels: dict[Operation, tuple[QLabel, QLabel]] = {}
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(GRID)
        layout.addWidget(named("OPERATIONS", "Heading"))
        self._hint = named("", "Hint")
        self._hint.setWordWrap(True)
        layout.addWidget(self._hint)
        self._body = QWidget()
        layout.addWidget(self._body)
        document.replaced.connect(self._on_replaced)
        document.hover_changed.connect(self._on_hover_changed)
        self._on_replaced()

    def release(self) -> None:
        """Let go of the document."""
        self._document.replaced.disconnect(self._on_replaced)
        self._document.hover_changed.disconnect(self._on_hover_changed)

    def _on_replaced(self) -> None:
        kind = self._document.kind
        self._hint.setText(
            "Point at a half-edge, press a key or click."
            if kind
            else "Operations appear here when there is a mesh."
        )
        if kind == self._kind:
            return
        self._kind = kind
        body = QWidget()
        grid = QGridLayout(body)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(GRID)
        grid.setVerticalSpacing(GRID)
        grid.setColumnStretch(1, 1)
        grid.setColumnStretch(3, 1)
        self._labels = {}
        for number, info in enumerate(of_kind(kind)):
            row, column = number // 2, 2 * (number % 2)
            key, title = named(info.key.upper(), "Key"), named(info.title, "Operation")
            key.setAlignment(Qt.AlignmentFlag.AlignCenter)
            key.setMinimumWidth(24)
            title.setToolTip(sentence(info.summary))
            grid.addWidget(key, row, column)
            grid.addWidget(title, row, column + 1)
            self._labels[info.operation] = (key, title)
        self.layout().replaceWidget(self._body, body)
        self._body.deleteLater()
        self._body = body

    def _on_hover_changed(self, halfedge: int) -> None:
        verdicts = self._document.allowed(halfedge) if self.ready and halfedge >= 0 else {}
        for operation, labels in self._labels.items():
            enabled = bool(verdicts.get(operation, True))
            for part in labels:
                part.setEnabled(enabled)
