"""The menu of a vertex: its desired degree, corner or not, locked or not."""

from qtpy.QtGui import QAction
from qtpy.QtWidgets import QMenu, QWidget

from app.document import Document
from app.markers import label

DEGREES = range(2, 9)


def vertex_menu(document: Document, vertex: int, ready: bool, parent: QWidget) -> QMenu:
    """The menu of ``vertex``; what needs compiled kernels is grey until ``ready``."""
    menu = QMenu(parent)
    mesh = document.mesh
    if mesh is None:
        return menu
    degree, desired = int(mesh.degree()[vertex]), int(mesh.desired()[vertex])
    head = menu.addAction(f"Vertex {vertex}: degree {degree}, \u0394 {label(degree - desired)}")
    head.setEnabled(False)
    menu.addSeparator()
    degrees = menu.addMenu("Desired degree")
    for wanted in sorted({*DEGREES, desired}):
        action = _checkable(degrees, str(wanted), wanted == desired)
        action.triggered.connect(
            lambda checked=False, wanted=wanted: document.set_desired(vertex, wanted)
        )
    geometric, locked = bool(mesh.geometric()[vertex]), bool(mesh.locked()[vertex])
    corner = _checkable(menu, "Corner (stays where it is)", geometric)
    corner.triggered.connect(lambda checked: document.set_geometric(vertex, checked))
    lock = _checkable(menu, "Locked (nothing changes it)", locked)
    lock.triggered.connect(lambda checked: document.set_locked(vertex, checked))
    for part in (degrees, corner, lock):
        part.setEnabled(ready)
    return menu


def _checkable(menu: QMenu, title: str, checked: bool) -> QAction:
    action = menu.addAction(title)
    action.setCheckable(True)
    action.setChecked(checked)
    return action
