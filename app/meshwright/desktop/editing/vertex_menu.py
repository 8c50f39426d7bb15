"""The context menus of a vertex and of the selection: desired degree, corner, pin, lock,
smoothing.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qtpy.QtGui import QAction
from qtpy.QtWidgets import QMenu, QWidget

from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.levels.level_controller import LevelController
from meshwright.desktop.widgets.action_set import ActionSet
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.markers import label
from meshwright_core import HalfEdgeMesh

DEGREES = range(2, 9)
OUTDATED = "The mesh has changed since the menu was opened."


class VertexMenus:
    """Makes the context menus of vertices; ``parent`` is the window that they belong to."""

    def __init__(
        self,
        document: Document,
        levels: LevelController,
        readiness: Readiness,
        actions: ActionSet,
        status: StatusBar,
        parent: QWidget,
    ) -> None:
        self._document, self._levels, self._readiness = document, levels, readiness
        self._actions, self._status, self._parent = actions, status, parent

    def of_vertex(self, vertex: int) -> QMenu:
        """The menu of one vertex."""
        menu = QMenu(self._parent)
        mesh, selection = self._document.mesh, self._document.selection
        if mesh is None:
            return menu
        degree, desired = int(mesh.degree()[vertex]), int(mesh.desired()[vertex])
        _head(menu, f"Vertex {vertex}: degree {degree}, \u0394 {label(degree - desired)}")
        self._fill(menu, mesh, np.array([vertex]))
        menu.addSeparator()
        selected = vertex in selection
        toggle = menu.addAction("Remove from selection" if selected else "Add to selection")
        toggle.triggered.connect(lambda checked=False: selection.toggle(vertex))
        return menu

    def of_selection(self) -> QMenu:
        """The menu of all selected vertices."""
        menu = QMenu(self._parent)
        mesh, selection = self._document.mesh, self._document.selection
        if mesh is None:
            return menu
        total = int(np.abs(mesh.irregularity()[selection.vertices]).sum())
        elements = len(selection.elements)
        around = f", {elements:,} elements" if elements > 1 else ""
        _head(menu, f"{len(selection):,} vertices{around}, s {total:,}")
        self._fill(menu, mesh, selection.vertices)
        menu.addSeparator()
        menu.addAction(self._actions["agent.region"])
        menu.addAction(self._actions["names"])
        menu.addSeparator()
        for action_id in ("select.grow", "select.shrink", "select.invert", "select.none"):
            menu.addAction(self._actions[action_id])
        return menu

    def _fill(self, menu: QMenu, mesh: HalfEdgeMesh, vertices: np.ndarray) -> None:
        """Add desired degree, corner, pin, lock and smoothing of ``vertices`` (n,).

        A switch is on where it is on for all of them; where it is for some, the next click
        switches all on. Entries that need compiled kernels are disabled until these are loaded.
        """
        document, revision = self._document, self._document.revision

        def then(change: Callable[..., None], *values: object) -> Callable[[bool], None]:
            """Make the change, unless the mesh has changed since: ids may be reused."""

            def act(checked: bool = False) -> None:
                if document.revision == revision:
                    change(vertices, *values or (checked,))
                else:
                    self._status.show_message(OUTDATED)

            return act

        degrees = menu.addMenu("Desired degree")
        present = set(mesh.desired()[vertices].tolist())
        for wanted in sorted({*DEGREES, *present}):
            action = _checkable(degrees, str(wanted), present == {wanted})
            action.triggered.connect(then(document.set_desired, wanted))
        geometric, locked = mesh.geometric()[vertices], mesh.locked()[vertices]
        pinned = mesh.pinned()[vertices]
        corner = _checkable(menu, "Corner (keeps its position)", bool(geometric.all()))
        corner.triggered.connect(then(document.set_geometric))
        pin = _checkable(menu, "Pinned (not moved by smoothing)", bool(pinned.all()))
        pin.triggered.connect(then(document.set_pinned))
        lock = _checkable(menu, "Locked (not moved or removed)", bool(locked.all()))
        lock.triggered.connect(then(document.set_locked))
        smooth = menu.addAction("Smooth here")
        smooth.triggered.connect(then(_smooth, document))
        for part in (degrees, corner, pin, lock, smooth):
            part.setEnabled(self._readiness.editing)
        for part in (degrees, corner, lock):
            if self._levels.level is not None:  # they would change the puzzle
                part.setEnabled(False)


def _head(menu: QMenu, text: str) -> None:
    head = menu.addAction(text)
    head.setEnabled(False)
    menu.addSeparator()


def _smooth(vertices: np.ndarray, document: Document) -> None:
    document.smooth(vertices=vertices)


def _checkable(menu: QMenu, title: str, checked: bool) -> QAction:
    action = menu.addAction(title)
    action.setCheckable(True)
    action.setChecked(checked)
    return action
