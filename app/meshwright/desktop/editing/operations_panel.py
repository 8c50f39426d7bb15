"""The panel of operations for the kind of mesh: keys, changes of s and shape, armed operation."""

from __future__ import annotations

from functools import partial

from qtpy.QtCore import QRectF, QSize, Qt, Signal
from qtpy.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from qtpy.QtWidgets import QAbstractButton, QVBoxLayout, QWidget

from meshwright.desktop.canvas.layers.ghost import change_colour
from meshwright.desktop.controller import Connections
from meshwright.desktop.widgets.basic import named, tabular
from meshwright.document.document import Document
from meshwright.document.operation_preview import OperationOffer
from meshwright.graphics.markers import label
from meshwright.graphics.theme import GRID, Theme
from meshwright_core.errors import sentence
from meshwright_core.operations.catalogue import Operation, OperationInfo, of_kind

HEIGHT = 26
SHAPE_GAP = 28
"""Pixels at the right of the change of shape, for the change of s."""
POINT = "Point at a half-edge to see how each operation changes s."
ARMED = "{}: click half-edges to apply it; Esc cancels."
EMPTY = "Operations are listed here when there is a mesh."


class OperationsPanel(QWidget):
    """A row for each operation; ``chosen(operation)`` when one is clicked."""

    chosen = Signal(object)

    def __init__(self, document: Document, theme: Theme) -> None:
        super().__init__()
        self._document = document
        self._theme = theme
        self._kind = ""
        self._armed: Operation | None = None
        self.rows: list[OperationButton] = []
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(GRID)
        self._hint = named(EMPTY, "Hint")
        self._hint.setWordWrap(True)
        self._column.addWidget(self._hint)
        self._body = QWidget()
        self._column.addWidget(self._body)
        self._connections = Connections()
        self._connections.add(document.replaced, self._on_replaced)
        self._on_replaced()

    def release(self) -> None:
        """Disconnect from the document."""
        self._connections.close()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        for row in self.rows:
            row.set_theme(theme)

    def offer(self, choices: tuple[OperationOffer, ...], current: Operation | None) -> None:
        """Show what is allowed at the hovered half-edge; an empty tuple without one."""
        by_operation = {choice.operation: choice for choice in choices}
        for row in self.rows:
            row.offer(by_operation.get(row.info.operation), row.info.operation == current)

    def show_shapes(self, changes: dict[Operation, float]) -> None:
        """Show how operations would change the worst scaled Jacobian near them."""
        for row in self.rows:
            row.show_shape(changes.get(row.info.operation))

    def arm(self, operation: Operation | None) -> None:
        """Mark the armed operation; None for none."""
        self._armed = operation
        for row in self.rows:
            row.setChecked(row.info.operation == operation)
        self._tell()

    def _tell(self) -> None:
        titles = {row.info.operation: row.info.title for row in self.rows}
        if self._armed in titles:
            self._hint.setText(ARMED.format(titles[self._armed]))
        else:
            self._hint.setText(POINT if self._kind else EMPTY)

    def _on_replaced(self) -> None:
        kind = self._document.kind
        if kind != self._kind:
            self._kind = kind
            self._fill()
        self._tell()

    def _fill(self) -> None:
        body = QWidget()
        column = QVBoxLayout(body)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.rows = [OperationButton(info, self._theme) for info in of_kind(self._kind)]
        for row in self.rows:
            row.clicked.connect(partial(self._on_clicked, row))
            column.addWidget(row)
        self._column.replaceWidget(self._body, body)
        self._body.deleteLater()
        self._body = body

    def _on_clicked(self, row: OperationButton, checked: bool = False) -> None:
        row.setChecked(row.info.operation == self._armed)  # arm() decides whether it is armed
        self.chosen.emit(row.info.operation)


class OperationButton(QAbstractButton):
    """One row: key, title, and the changes of shape and of s at the hovered half-edge."""

    def __init__(self, info: OperationInfo, theme: Theme) -> None:
        super().__init__()
        self.info = info
        self._theme = theme
        self._choice: OperationOffer | None = None
        self._current = False
        self._shape: float | None = None
        self.setText(info.title)
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self._describe()

    @property
    def change(self) -> str:
        """The change of s as a signed number; empty if it is unknown."""
        change = self._choice.change if self._choice is not None else None
        return "" if change is None else label(change)

    @property
    def allowed(self) -> bool:
        """False if the operation is not allowed at the hovered half-edge."""
        return self._choice is None or self._choice.allowed

    def offer(self, choice: OperationOffer | None, current: bool) -> None:
        """Set the choice at the hovered half-edge; ``current``: this operation is previewed."""
        if choice != self._choice or current != self._current:
            if choice != self._choice:
                self._shape = None
            self._choice, self._current = choice, current
            self._describe()
            self.update()

    @property
    def shape(self) -> str:
        """The change of the worst scaled Jacobian near the half-edge; empty if it is unknown."""
        if self._shape is None:
            return ""
        if abs(self._shape) < 0.005:
            return "\u00b1.00"
        sign = "+" if self._shape > 0 else "\u2212"
        return sign + f"{abs(self._shape):.2f}".removeprefix("0")

    def show_shape(self, change: float | None) -> None:
        """Show the change of the worst scaled Jacobian; None: nothing."""
        if change != self._shape:
            self._shape = change
            self._describe()
            self.update()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:  # noqa: N802
        """As wide as there is room, one line high."""
        return QSize(200, HEIGHT)

    def _describe(self) -> None:
        text = sentence(self.info.summary)
        if not self.allowed and self._choice is not None:
            text = f"{text}\nNot here: {self._choice.verdict.reason}."
        else:
            text += "\nClick to choose it; each click on the mesh then applies it."
        if self.shape:
            text += f"\nWorst scaled Jacobian near it: {self.shape}"
        self.setToolTip(text)
        self.setAccessibleDescription(text)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Key in a frame, title, change of s at the right."""
        theme = self._theme
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint_back(painter)
        allowed = self.allowed
        key = QRectF(4.0, (self.height() - 18.0) / 2.0, 22.0, 18.0)
        painter.setPen(QPen(QColor(theme.line), 1.0))
        painter.setBrush(QColor(theme.raised))
        painter.drawRoundedRect(key.adjusted(0.5, 0.5, -0.5, -0.5), 4.0, 4.0)
        font = tabular(QFont(self.font()))
        font.setPixelSize(11)
        painter.setFont(font)
        painter.setPen(QColor(theme.muted if allowed else theme.faint))
        painter.drawText(key, Qt.AlignmentFlag.AlignCenter, self.info.key.upper())
        font.setPixelSize(13)
        font.setWeight(QFont.Weight.DemiBold if self._current else QFont.Weight.Normal)
        painter.setFont(font)
        painter.setPen(QColor(theme.text if allowed else theme.faint))
        inner = QRectF(self.rect()).adjusted(36, 0, -8, 0)
        middle = Qt.AlignmentFlag.AlignVCenter
        painter.drawText(inner, Qt.AlignmentFlag.AlignLeft | middle, self.info.title)
        if self._choice is not None and self._choice.change is not None:
            painter.setPen(QColor(change_colour(self._choice.change, theme)))
            painter.drawText(inner, Qt.AlignmentFlag.AlignRight | middle, self.change)
            font.setPixelSize(11)
            font.setWeight(QFont.Weight.Normal)
            painter.setFont(font)
            painter.setPen(QColor(theme.muted))
            beside = inner.adjusted(0, 0, -SHAPE_GAP, 0)
            painter.drawText(beside, Qt.AlignmentFlag.AlignRight | middle, self.shape)
        painter.end()

    def _paint_back(self, painter: QPainter) -> None:
        back = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        if self.isChecked():
            painter.setPen(QPen(QColor(self._theme.accent), 1.5))
            painter.setBrush(QColor(self._theme.accent_soft))
        elif self._current or self.underMouse():
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(
                QColor(self._theme.accent_soft if self._current else self._theme.hover)
            )
        else:
            return
        painter.drawRoundedRect(back, 5.0, 5.0)
