"""Smooths and untangles the document's mesh after a run of the agent; imports scipy."""

from __future__ import annotations

import numpy as np

from meshwright.document.document import Document
from meshwright_core.geometry.quality import inverted


def clean_up(document: Document, by: str, held: np.ndarray | None, searched: bool) -> None:
    """Improve the vertex positions after a run, as one step of the history.

    Args:
        document: smoothed as a whole after a search; after any other run only inverted elements
            are untangled, and only if the document smooths by itself. A surface that is not plane
            is left as it is, unless the document smooths such ones.
        by: author of the step, the name of the policy.
        held: (n,) vertices that stay where they are, None for no such restriction.
        searched: whether the run was a search.
    """
    mesh = document.mesh
    if mesh is None or not (document.plane or document.smooth_surfaces):
        return
    if held is not None:
        document.smooth(by, np.setdiff1d(mesh.vertices(), held))
    elif searched:
        document.smooth(by)
    elif document.auto_smooth and len(inverted(mesh)):
        document.untangle(by)
