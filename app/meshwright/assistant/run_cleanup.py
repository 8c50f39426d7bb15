"""Untangles what a run of the agent has left inverted; imports scipy."""

from __future__ import annotations

from meshwright.document.document import Document
from meshwright_core.geometry.quality import inverted


def clean_up(document: Document, by: str) -> None:
    """Untangle inverted elements, as one step of the history by ``by``, if the document smooths by
    itself; a surface that is not plane only if the document smooths such ones.
    """
    mesh = document.mesh
    if mesh is None or not (document.plane or document.smooth_surfaces):
        return
    if document.auto_smooth and len(inverted(mesh)):
        document.untangle(by)
