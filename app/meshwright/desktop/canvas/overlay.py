"""The overlay: marks over the mesh that need no new frame of VTK.

It is a transparent widget whose layers are painted by QPainter: a hover repaints a few hundred
pixels, whatever the size of the mesh.
"""

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from qtpy.QtCore import QRectF, Qt
from qtpy.QtGui import QPainter, QPaintEvent
from qtpy.QtWidgets import QWidget

from meshwright.desktop.canvas.layers.base import Layer
from meshwright.desktop.canvas.layers.hover import ArrowLayer, ElementLayer
from meshwright.desktop.canvas.layers.markers import MarkersLayer
from meshwright.desktop.canvas.layers.text_card import CardLayer
from meshwright.graphics.markers import Markers
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import TrueEdges
from meshwright.graphics.viewport import Viewport

AnyLayer = TypeVar("AnyLayer", bound=Layer)


class Overlay(QWidget):
    """Paints its ``layers`` from the lowest to the highest; it receives no mouse events."""

    def __init__(self, parent: QWidget, theme: Theme) -> None:
        super().__init__(parent)
        for attribute in (
            Qt.WidgetAttribute.WA_TransparentForMouseEvents,
            Qt.WidgetAttribute.WA_NoSystemBackground,
            Qt.WidgetAttribute.WA_TranslucentBackground,
        ):
            self.setAttribute(attribute)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.layers: list[Layer] = []
        self.element = self.add(ElementLayer(theme))
        self.markers = self.add(MarkersLayer(theme, self.font()))
        self.arrow = self.add(ArrowLayer(theme))
        self.card = self.add(CardLayer(theme, self.font(), self))

    def add(self, layer: AnyLayer, below: Layer | None = None) -> AnyLayer:
        """Add ``layer`` just below another one, or on top, and return it."""
        place = len(self.layers) if below is None else self.layers.index(below)
        self.layers.insert(place, layer)
        layer.repaint = self._repaint
        return layer

    def set_theme(self, theme: Theme) -> None:
        """Paint in the colours of ``theme``."""
        for layer in self.layers:
            layer.set_theme(theme)
        self.update()

    def look(self, viewport: Viewport) -> None:
        """Follow a change of the view, and repaint all layers."""
        for layer in self.layers:
            layer.look(viewport)
        self.update()

    def show_markers(
        self,
        marks: Markers | None,
        edges: TrueEdges | None,
        viewport: Viewport,
        crowd: bool,
        outlined: bool,
    ) -> None:
        """Paint these markers as seen through ``viewport``; see :class:`MarkersLayer`."""
        self.markers.show(marks, edges, viewport, crowd, outlined)
        self.look(viewport)

    def show_hover(self, sides: Sequence[np.ndarray] | None, side: int) -> None:
        """Show the arrow along edge ``side`` of the element with these ``sides``, each (n, 2) in
        pixels; None for no element.
        """
        self.element.show(sides)
        self.arrow.show(sides, side)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint the part inside the region that Qt requests."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        try:  # an unfinished painter crashes the process at the next paint
            for layer in self.layers:
                if layer.visible:
                    painter.save()
                    layer.paint(painter, event.rect())
                    painter.restore()
        finally:
            painter.end()

    def _repaint(self, rect: QRectF | None) -> None:
        if rect is None:
            self.update()
        elif not rect.isEmpty():
            self.update(rect.toAlignedRect().adjusted(-1, -1, 1, 1))
