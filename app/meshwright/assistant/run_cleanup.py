"""Untangles what a run of the agent has left inverted; imports scipy."""

from __future__ import annotations

from meshwright.document.document import Document
from meshwright_core.geometry.quality import inverted


def clean_up(document: Document, by: str) -> None:
    """Untangle inverted elements, as one step of the history by ``by``, if the document smooths by
    itself.
    """
    mesh = document.mesh
    if mesh is not None and document.auto_smooth and len(inverted(mesh)):
        document.untangle(by)
