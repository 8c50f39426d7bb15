"""The About dialog: version, citation and licences."""

import platform
from importlib.metadata import PackageNotFoundError, version

from qtpy import API_NAME, QT_VERSION
from qtpy.QtCore import Qt
from qtpy.QtGui import QGuiApplication
from qtpy.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.help.licences import Licence, licences
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import named
from meshwright.graphics.theme import GRID

_COLUMNS = ("Package", "Version", "Licence")
_SENTENCES = (
    "Edits the connectivity of triangle and quad meshes half-edge by half-edge, by hand or with "
    "a trained agent.",
    "After A. Narayanan, Y. Pan, P.-O. Persson, \u201cLearning topological operations on meshes "
    "with application to block decomposition of polygons\u201d.",
)
_TRIANGLE = (
    "Meshwright has the MIT licence. It meshes polygons by Shewchuk\u2019s Triangle, which is free "
    "for non-commercial use only."
)


class AboutDialog(QDialog):
    """Version and licences; the list is that of the packages installed here."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("About Meshwright")
        self.resize(640, 620)
        self.licences = licences()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(4 * GRID, 3 * GRID, 4 * GRID, 3 * GRID)
        layout.setSpacing(GRID)
        layout.addLayout(self._head())
        for sentence in _SENTENCES:
            layout.addWidget(_wrapped(sentence, "Label"))
        layout.addWidget(_wrapped(_TRIANGLE, "Value"))
        layout.addSpacing(GRID)
        layout.addWidget(named("MADE WITH", "Heading"))
        self.table = self._make_table()
        layout.addWidget(self.table, 3)
        self.text = QPlainTextEdit()
        self.text.setObjectName("LicenceText")
        self.text.setReadOnly(True)
        self.text.setAccessibleName("Text of the licence")
        self.text.setPlaceholderText("Choose a package to read its licence.")
        layout.addWidget(self.text, 2)
        layout.addLayout(self._buttons())

    def details(self) -> str:
        """Versions for a bug report, one per line."""
        lines = [f"Meshwright {own_version()}", f"Python {platform.python_version()}"]
        lines += [platform.platform(), f"{API_NAME} with Qt {QT_VERSION}"]
        telling = ("numpy", "numba", "torch", "vtk", "pyvista", "pyside6-essentials")
        for one in self.licences:
            if one.package.lower().replace("_", "-") in telling:
                lines.append(f"{one.package} {one.version}")
        return "\n".join(lines)

    def _head(self) -> QHBoxLayout:
        line = QHBoxLayout()
        line.setSpacing(2 * GRID)
        picture = named("", "Picture")
        picture.setPixmap(icons.app_icon().pixmap(48, 48))
        line.addWidget(picture)
        line.addWidget(named(f"Meshwright {own_version()}", "EmptyTitle"), 1)
        return line

    def _make_table(self) -> QTableWidget:
        table = QTableWidget(len(self.licences), len(_COLUMNS))
        table.setObjectName("Table")
        table.setAccessibleName("Packages and their licences")
        table.setHorizontalHeaderLabels(_COLUMNS)
        table.verticalHeader().hide()
        table.setShowGrid(False)
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        table.setTabKeyNavigation(False)
        for row, one in enumerate(self.licences):
            for column, text in enumerate((one.package, one.version, one.licence)):
                item = QTableWidgetItem(text)
                item.setToolTip(one.url or text)
                table.setItem(row, column, item)
        head = table.horizontalHeader()
        head.setHighlightSections(False)
        head.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        head.setSectionResizeMode(0, QHeaderView.ResizeMode.ResizeToContents)
        head.setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        head.setSectionResizeMode(2, QHeaderView.ResizeMode.Stretch)
        table.currentCellChanged.connect(self._on_row_changed)
        return table

    def _buttons(self) -> QHBoxLayout:
        copy = QPushButton("Copy versions")
        copy.setToolTip("Copy the versions of Meshwright and its libraries, for a bug report")
        copy.clicked.connect(lambda checked=False: self._copy())
        close = QPushButton("Close")
        close.setToolTip("Close this page")
        close.setDefault(True)
        close.clicked.connect(self.accept)
        line = QHBoxLayout()
        line.setSpacing(GRID)
        line.addWidget(copy)
        line.addStretch(1)
        line.addWidget(close)
        return line

    def _copy(self) -> None:
        QGuiApplication.clipboard().setText(self.details())

    def _on_row_changed(self, row: int, column: int, row_before: int, column_before: int) -> None:
        if 0 <= row < len(self.licences):
            self.text.setPlainText(_licence_text(self.licences[row]))


def own_version() -> str:
    """The version of Meshwright; empty where it is not installed."""
    try:
        return version("meshwright")
    except PackageNotFoundError:
        return ""


def _licence_text(one: Licence) -> str:
    text = one.text() or "The licence text was not installed with the package."
    home = f"\n{one.url}" if one.url else ""
    return f"{one.package} {one.version}: {one.licence}{home}\n\n{text}"


def _wrapped(text: str, name: str) -> QLabel:
    made = named(text, name)
    made.setWordWrap(True)
    return made
