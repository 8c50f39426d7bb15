"""The menus of one vertex and of the selection: desired degree, corner, lock, and what else there
is to do with them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtGui import QAction
from qtpy.QtWidgets import QMenu

from meshwright.graphics.markers import label

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow
    from meshwright.document.document import Document

DEGREES = range(2, 9)
GONE_ON = "The mesh has changed since the menu was opened."


def vertex_menu(window: MainWindow, vertex: int) -> QMenu:
    """The menu of one vertex."""
    menu = QMenu(window)
    mesh = window.document.mesh
    if mesh is None:
        return menu
    degree, desired = int(mesh.degree()[vertex]), int(mesh.desired()[vertex])
    _head(menu, f"Vertex {vertex}: degree {degree}, \u0394 {label(degree - desired)}")
    _fill(menu, window, np.array([vertex]))
    menu.addSeparator()
    selected = vertex in window.document.selection
    choose = menu.addAction("Take out of the selection" if selected else "Add to the selection")
    choose.triggered.connect(lambda checked=False: window.document.selection.toggle(vertex))
    return menu


def selection_menu(window: MainWindow) -> QMenu:
    """The menu of all selected vertices."""
    menu = QMenu(window)
    document = window.document
    selection, mesh = document.selection, document.mesh
    if mesh is None:
        return menu
    total = int(np.abs(mesh.irregularity()[selection.vertices]).sum())
    elements = len(selection.elements)
    around = f", {elements:,} elements" if elements > 1 else ""
    _head(menu, f"{len(selection):,} vertices{around}, s {total:,}")
    _fill(menu, window, selection.vertices)
    menu.addSeparator()
    menu.addAction(window.actions_by_id["agent.region"])
    menu.addSeparator()
    for action_id in ("select.grow", "select.shrink", "select.invert", "select.none"):
        menu.addAction(window.actions_by_id[action_id])
    return menu


def _head(menu: QMenu, text: str) -> None:
    head = menu.addAction(text)
    head.setEnabled(False)
    menu.addSeparator()


def _fill(menu: QMenu, window: MainWindow, vertices: np.ndarray) -> None:
    """Desired degree, corner, lock and smoothing of ``vertices`` (n,).

    A switch is on where all of them have it on; where some do, the next click switches all on.
    What needs compiled kernels is grey until they are ready.
    """
    document = window.document
    mesh = document.mesh
    if mesh is None:
        return
    revision = document.revision

    def then(change: Callable[..., None], *values: object) -> Callable[[bool], None]:
        """Do it, unless the mesh has gone on behind the menu: ids may be of other vertices now."""

        def act(checked: bool = False) -> None:
            if document.revision == revision:
                change(vertices, *values or (checked,))
            else:
                window.say(GONE_ON)

        return act

    degrees = menu.addMenu("Desired degree")
    present = set(mesh.desired()[vertices].tolist())
    for wanted in sorted({*DEGREES, *present}):
        action = _checkable(degrees, str(wanted), present == {wanted})
        action.triggered.connect(then(document.set_desired, wanted))
    geometric, locked = mesh.geometric()[vertices], mesh.locked()[vertices]
    corner = _checkable(menu, "Corner (stays where it is)", bool(geometric.all()))
    corner.triggered.connect(then(document.set_geometric))
    lock = _checkable(menu, "Locked (nothing changes it)", bool(locked.all()))
    lock.triggered.connect(then(document.set_locked))
    smooth = menu.addAction("Smooth here")
    smooth.triggered.connect(then(_smooth, document))
    for part in (degrees, corner, lock, smooth):
        part.setEnabled(window.ready)
    for part in (degrees, corner, lock):
        if window.levels.level is not None:  # they would change the task
            part.setEnabled(False)


def _smooth(vertices: np.ndarray, document: Document) -> None:
    document.smooth(vertices=vertices)


def _checkable(menu: QMenu, title: str, checked: bool) -> QAction:
    action = menu.addAction(title)
    action.setCheckable(True)
    action.setChecked(checked)
    return action
