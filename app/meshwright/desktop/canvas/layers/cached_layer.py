"""A layer that is cached as an image, so that a hover only copies pixels."""

from __future__ import annotations

from qtpy.QtCore import QRect, QRectF, Qt
from qtpy.QtGui import QImage, QPainter

from meshwright.desktop.canvas.layers.base import Layer
from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import Viewport


class PictureLayer(Layer):
    """Caches what :meth:`draw` paints until the view, the theme or the content changes."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._picture: QImage | None = None

    @property
    def empty(self) -> bool:
        """Whether there is nothing to draw."""
        raise NotImplementedError

    def draw(self, painter: QPainter) -> None:
        """Paint all of it, in pixels of the canvas."""
        raise NotImplementedError

    def forget(self) -> None:
        """Drop the cached image after a change of the content."""
        self._picture = None
        self.changed()

    def set_theme(self, theme: Theme) -> None:
        """Paint in the colours of ``theme``."""
        super().set_theme(theme)
        self._picture = None

    def look(self, viewport: Viewport) -> None:
        """Follow a change of the view."""
        super().look(viewport)
        self._picture = None

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Copy from the cached image, which is drawn when it is first needed."""
        if self.empty:
            return
        ratio = painter.device().devicePixelRatioF()
        if self._picture is None or self._picture.devicePixelRatio() != ratio:
            self._picture = self._drawn(ratio)
        part = QRectF(rect)
        painter.drawImage(part, self._picture, QRectF(part.topLeft() * ratio, part.size() * ratio))

    def _drawn(self, ratio: float) -> QImage:
        width, height = self.viewport.size
        argb = QImage.Format.Format_ARGB32_Premultiplied
        image = QImage(round(width * ratio), round(height * ratio), argb)
        image.setDevicePixelRatio(ratio)
        image.fill(Qt.GlobalColor.transparent)
        painter = QPainter(image)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self.draw(painter)
        painter.end()
        return image
