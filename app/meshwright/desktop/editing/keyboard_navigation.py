"""Navigation by keyboard: view, irregular vertices, and from half-edge to half-edge."""

from __future__ import annotations

import numpy as np

from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.highlight import SpotLayer
from meshwright.desktop.controller import Controller
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.markers import label
from meshwright.graphics.theme import Theme

STRIDE = 64.0
"""Pixels by which an arrow key pans."""
ZOOM = 1.25
SIZE = 120.0
"""Minimum size in pixels of the elements around a vertex that the view moves to."""
SEEN = 60.0
"""Their size from which the view stays where it is, if all of them are in it."""
_BITS = 16


class KeyboardNavigation(Controller):
    """Moves the view and the hovered half-edge by keyboard."""

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        highlight: SpotLayer,
        status: StatusBar,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas = document, canvas
        self._highlight, self._status = highlight, status
        self._vertex = -1
        self._connections.add(document.replaced, self._on_replaced)

    def _on_replaced(self) -> None:
        self._vertex = -1

    # The view

    def pan(self, right: float, up: float) -> None:
        """Pan to the right and up by multiples of :data:`STRIDE`."""
        canvas = self._canvas
        canvas.see(canvas.viewport.panned(-STRIDE * right, STRIDE * up))

    def zoom(self, closer: bool) -> None:
        """Zoom in or out at the centre of the view."""
        canvas = self._canvas
        width, height = canvas.viewport.size
        factor = ZOOM if closer else 1.0 / ZOOM
        canvas.see(canvas.viewport.zoomed(factor, width / 2.0, height / 2.0))

    # Irregular vertices

    def to_irregular(self, step: int) -> None:
        """Go to the next (1) or previous (-1) irregular vertex, and hover one of its half-edges.

        The order is such that neighbours in it are close to each other in the plane.
        """
        mesh = self._document.mesh
        if mesh is None:
            return
        delta = mesh.irregularity()
        found = np.flatnonzero(delta)
        if not len(found):
            self._status.show_message("Every vertex is regular.")
            return
        found = found[np.argsort(_curve(mesh.points[found, :2]), kind="stable")]
        at = np.flatnonzero(found == self._vertex)
        place = (int(at[0]) + step) % len(found) if len(at) else (0 if step > 0 else -1)
        self._vertex = vertex = int(found[place])
        canvas = self._canvas
        around = mesh.points[[vertex, *mesh.neighbours(vertex)]]
        reach = float(np.abs(around - mesh.points[vertex])[:, :2].max())
        box = mesh.points[vertex] + reach * np.array([(-1.0, -1.0, 0.0), (1.0, 1.0, 0.0)])
        corners = canvas.viewport.to_screen(box)
        within = (corners > 0.0).all() and (corners < canvas.viewport.size).all()
        if not within or 2.0 * reach * canvas.viewport.pixels < SEEN:
            canvas.see(canvas.viewport.around(box, SIZE))
        canvas.pin(mesh.outgoing(vertex)[0])
        self._highlight.show(mesh.points[[vertex]])
        self._status.show_message(
            f"Vertex {vertex}: \u0394 {label(int(delta[vertex]))}, "
            f"{place % len(found) + 1:,} of {len(found):,}."
        )

    # Half-edges

    def turn(self, step: int) -> None:
        """Hover the next (1) or previous (-1) half-edge around the origin of this one."""
        mesh, halfedge = self._document.mesh, self._canvas.under_mouse
        if mesh is None or halfedge < 0:
            self._begin()
            return
        fan = mesh.outgoing(mesh.origin(halfedge))
        self._canvas.pin(fan[(fan.index(halfedge) + step) % len(fan)])
        self._keep_in_view()

    def along(self) -> None:
        """Hover the next half-edge of the element."""
        mesh, halfedge = self._document.mesh, self._canvas.under_mouse
        if mesh is None or halfedge < 0:
            self._begin()
            return
        self._canvas.pin(mesh.next(halfedge))
        self._keep_in_view()

    def across(self) -> None:
        """Hover the twin half-edge."""
        mesh, halfedge = self._document.mesh, self._canvas.under_mouse
        if mesh is None or halfedge < 0:
            self._begin()
        elif mesh.twin(halfedge) < 0:
            self._status.show_message("A half-edge on the boundary has no twin.")
        else:
            self._canvas.pin(mesh.twin(halfedge))
            self._keep_in_view()

    def _begin(self) -> None:
        """Hover a half-edge of the element nearest to the centre of the view."""
        mesh, canvas = self._document.mesh, self._canvas
        if mesh is None:
            return
        elements = mesh.elements()
        away = canvas.viewport.to_screen(mesh.points[elements].mean(axis=1))
        away = away - np.array(canvas.viewport.size) / 2.0
        row = int(np.argmin((away**2).sum(axis=1)))
        canvas.pin(mesh.k * int(mesh.element_ids()[row]))
        self._keep_in_view()

    def _keep_in_view(self) -> None:
        """Pan so that the hovered half-edge is in view."""
        mesh, canvas = self._document.mesh, self._canvas
        halfedge = canvas.under_mouse
        if mesh is None or halfedge < 0:
            return
        ends = mesh.points[[mesh.origin(halfedge), mesh.target(halfedge)]]
        x, y = canvas.viewport.to_screen(ends).mean(axis=0).tolist()
        width, height = canvas.viewport.size
        right = min(width - 48.0 - x, 0.0) + max(48.0 - x, 0.0)
        down = min(height - 48.0 - y, 0.0) + max(48.0 - y, 0.0)
        if right or down:
            canvas.see(canvas.viewport.panned(right, down))


def _curve(places: np.ndarray) -> np.ndarray:
    """(n,) Morton codes of ``places`` (n, 2): positions along a space-filling curve."""
    low = places.min(axis=0)
    size = max(float((places.max(axis=0) - low).max()), 1e-300)
    cells = ((places - low) / size * (2**_BITS - 1)).astype(np.int64)
    cells[:, 1] = 2**_BITS - 1 - cells[:, 1]  # from top to bottom, as in reading
    code = np.zeros(len(places), np.int64)
    for bit in range(_BITS):
        code |= (cells[:, 0] >> bit & 1) << 2 * bit | (cells[:, 1] >> bit & 1) << 2 * bit + 1
    return code
