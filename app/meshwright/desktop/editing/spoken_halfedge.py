"""What a screen reader is told of the canvas: the half-edge that is chosen by keyboard."""

from __future__ import annotations

from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.controller import Controller
from meshwright.desktop.editing.hover_controller import HoverController
from meshwright.desktop.widgets.announcements import announce
from meshwright.desktop.widgets.wording import halfedge_words
from meshwright.document.document import Document
from meshwright.document.operation_preview import OperationOffer
from meshwright.graphics.markers import label
from meshwright.graphics.theme import Theme
from meshwright_core import HalfEdgeMesh

NOTHING = "No half-edge is chosen. N goes to an irregular vertex, E, D and Q from edge to edge."


class SpokenHalfedge(Controller):
    """Keeps the accessible description of the canvas, and announces each half-edge that is chosen
    by keyboard, with its ends and the current operation.
    """

    def __init__(
        self, document: Document, canvas: Canvas, hover: HoverController, theme: Theme
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._hover = document, canvas, hover
        self._said = ""
        self._connections.add(hover.offered, self._on_offered)

    def _on_offered(self) -> None:
        mesh, halfedge = self._document.mesh, self._document.hover
        if mesh is None or halfedge < 0 or not mesh.live(halfedge):
            text = NOTHING
        elif not self._canvas.by_keyboard:
            return  # the mouse moves too often, and whoever uses it sees the mesh
        else:
            text = spoken(mesh, halfedge, self._hover.current)
        if text != self._said:
            self._said = text
            self._canvas.plotter.setAccessibleDescription(text)
            if text != NOTHING:
                announce(self._canvas.plotter, text)


def spoken(mesh: HalfEdgeMesh, halfedge: int, offer: OperationOffer | None) -> str:
    """A half-edge, its ends and the operation ``offer`` in a few sentences."""
    ends = []
    for vertex in (mesh.origin(halfedge), mesh.target(halfedge)):
        degree, desired = int(mesh.degree()[vertex]), int(mesh.desired()[vertex])
        wanted = "" if degree == desired else f", desired {desired}"
        ends.append(f"vertex {vertex}: degree {degree}{wanted}")
    edge = "on the boundary" if mesh.twin(halfedge) < 0 else f"element {halfedge // mesh.k}"
    words = halfedge_words(mesh, halfedge).replace("\u2192", "to").replace("  ", " ")
    text = f"{words}, {edge}. From {ends[0]}; to {ends[1]}."
    if offer is None:
        return f"{text} No operation is allowed here."
    if offer.change is None:
        return f"{text} {offer.info.title}."
    return f"{text} {offer.info.title}: s {label(offer.change)}."
