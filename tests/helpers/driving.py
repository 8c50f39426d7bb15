"""Driving the window by real mouse and key events, for its tests."""

import numpy as np
from qtpy.QtCore import QPoint, Qt

WAIT = 60_000
"""Milliseconds after which a window that does not answer has failed."""


def pixel(window, plane) -> QPoint:
    x, y = window.canvas.viewport.to_screen(np.asarray(plane)).tolist()
    return QPoint(round(x), round(y))


def beside(window, halfedge) -> QPoint:
    """A pixel near the middle of ``halfedge``, inside its element."""
    mesh = window.document.mesh
    first = halfedge - halfedge % mesh.k
    corners = mesh.points[[mesh.origin(first + i) for i in range(mesh.k)]][:, :2]
    middle = mesh.points[[mesh.origin(halfedge), mesh.target(halfedge)]][:, :2].mean(axis=0)
    return pixel(window, middle + 0.15 * (corners.mean(axis=0) - middle))


def point_at(qtbot, window, halfedge) -> None:
    def arrives() -> bool:  # anew each time: a window that has just opened still finds its size
        where = beside(window, halfedge)
        qtbot.mouseMove(window.canvas.plotter, where + QPoint(3, 0))
        qtbot.mouseMove(window.canvas.plotter, where)
        return window.document.hover == halfedge

    qtbot.waitUntil(arrives, timeout=WAIT)


def press(qtbot, window, key, modifier=Qt.KeyboardModifier.NoModifier) -> None:
    qtbot.keyClick(window.canvas.plotter, key, modifier)


def find(mesh, operation, allowed=True) -> int:
    return next(
        h
        for e in mesh.element_ids().tolist()
        for h in range(mesh.k * e, mesh.k * e + mesh.k)
        if bool(mesh.check(operation, h)) == allowed
    )
