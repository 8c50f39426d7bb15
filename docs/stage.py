"""A window that is driven by mouse and key events and photographed.

Importing this directs settings and autosaves of the process to a temporary folder.
"""

import os
import tempfile
import time
from collections.abc import Callable
from typing import Any

HOME = tempfile.mkdtemp()
os.environ.update(XDG_CONFIG_HOME=HOME, XDG_STATE_HOME=HOME)

import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402
from qtpy.QtCore import QPoint, Qt, QTimer  # noqa: E402
from qtpy.QtGui import QImage  # noqa: E402
from qtpy.QtTest import QTest  # noqa: E402
from qtpy.QtWidgets import QApplication  # noqa: E402

from meshwright.desktop.main_window.window import MainWindow  # noqa: E402
from meshwright.document.document import Document  # noqa: E402
from meshwright_core import HalfEdgeMesh, Operation  # noqa: E402
from meshwright_core.domains import gallery, meshing  # noqa: E402

SMALL, LARGE = (1280, 800), (1920, 1080)
NONE = Qt.KeyboardModifier.NoModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
CONTROL = Qt.KeyboardModifier.ControlModifier


class Stage:
    """A window with a size and a theme, its input events, and screenshots of it."""

    def __init__(
        self, mesh: HalfEdgeMesh | None, name: str, size: tuple[int, int], theme: str
    ) -> None:
        self.window = MainWindow(Document(mesh, name), ready=True)
        self.window.set_theme(theme)
        self.window.resize(*size)
        self.window.move(0, 0)
        self.window.show()
        self.window.activateWindow()
        self.until(lambda: self.window.canvas.built)
        self.rest(0.6)

    @property
    def plotter(self) -> Any:
        """The widget that receives mouse events."""
        return self.window.canvas.plotter

    def rest(self, seconds: float) -> None:
        """Process events for some seconds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            QApplication.processEvents()
            time.sleep(0.005)

    def until(self, condition: Callable[[], bool], seconds: float = 120.0) -> None:
        """Process events until ``condition()``."""
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise RuntimeError("the window did not get there")
            self.rest(0.02)

    def pixel(self, place: Any) -> QPoint:
        """The pixel of the canvas at a point of the plane."""
        x, y = self.window.canvas.viewport.to_screen(np.asarray(place, float)).tolist()
        return QPoint(round(x), round(y))

    def beside(self, halfedge: int) -> QPoint:
        """A pixel near the middle of a half-edge, inside its element."""
        mesh = self.window.document.mesh
        first = halfedge - halfedge % mesh.k
        corners = mesh.points[[mesh.origin(first + i) for i in range(mesh.k)]]
        middle = mesh.points[[mesh.origin(halfedge), mesh.target(halfedge)]].mean(axis=0)
        return self.pixel(middle + 0.2 * (corners.mean(axis=0) - middle))

    def point_at(self, halfedge: int) -> None:
        """Move the pointer to a pixel."""
        where = self.beside(halfedge)
        QTest.mouseMove(self.plotter, where + QPoint(2, 0))
        QTest.mouseMove(self.plotter, where)
        self.rest(0.3)

    def drag(self, places: list[QPoint], modifier: Any = NONE, release: bool = True) -> None:
        """Press at the first pixel, move along the others, and release at the last."""
        QTest.mouseMove(self.plotter, places[0])
        QTest.mousePress(self.plotter, Qt.MouseButton.LeftButton, modifier, places[0])
        for place in places[1:]:
            QTest.mouseMove(self.plotter, place)
            self.rest(0.05)
        if release:
            QTest.mouseRelease(self.plotter, Qt.MouseButton.LeftButton, modifier, places[-1])
        self.rest(0.3)

    def key(self, key: Any, modifier: Any = NONE) -> None:
        """Press a key."""
        QTest.keyClick(self.plotter, key, modifier)
        self.rest(0.2)

    def during(self, call: Callable[[], None], act: Callable[[], None], seconds: float) -> None:
        """Call what opens a dialog, and ``act`` while it is open."""

        def once() -> None:
            act()
            over = QApplication.activeModalWidget()
            if over is not None:
                over.close()

        QTimer.singleShot(int(1000 * seconds), once)
        call()
        self.rest(0.1)

    def picture(self) -> Image.Image:
        """A screenshot of the window."""
        QApplication.processEvents()
        size = self.window.size()
        return _pillow(
            QApplication.primaryScreen().grabWindow(0, 0, 0, size.width(), size.height())
        )

    def picture_of(self, dialog: Any) -> Image.Image:
        """A dialog on a plain background of the size of the window."""
        taken = _pillow(dialog.grab())
        size = self.window.size() * self.window.devicePixelRatio()
        ground = Image.new("RGB", (size.width(), size.height()), self.window.theme.pressed)
        ground.paste(
            taken, ((size.width() - taken.width) // 2, (size.height() - taken.height) // 2)
        )
        return ground

    def close(self) -> None:
        """Close the window without a question about unsaved changes."""
        self.window.document.replace(None)
        self.window.close()
        self.rest(0.1)


def shape(name: str, kind: str = "quad") -> HalfEdgeMesh:
    """A mesh of the gallery."""
    return meshing.mesh_domain(gallery.shape(name), kind)


def allowed(mesh: HalfEdgeMesh, operation: str) -> list[int]:
    """Half-edges where an operation may be done, those near the middle first."""
    live = mesh.halfedges_of(mesh.element_ids()).ravel().tolist()
    found = [h for h in live if mesh.check(Operation(operation), h)]
    centre = mesh.points[mesh.vertices()].mean(axis=0)
    return sorted(found, key=lambda h: float(np.linalg.norm(mesh.points[mesh.origin(h)] - centre)))


def _pillow(shot: Any) -> Image.Image:
    """A pixmap of Qt's as an image of Pillow's."""
    image = shot.toImage().convertToFormat(QImage.Format.Format_RGB888)
    size = (image.width(), image.height())
    raw = bytes(image.constBits())
    return Image.frombuffer("RGB", size, raw, "raw", "RGB", image.bytesPerLine(), 1).copy()
