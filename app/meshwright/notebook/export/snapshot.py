"""Snapshots: what a saved notebook shows of a mesh while no kernel runs."""

from __future__ import annotations

from typing import Any

from meshwright.document.document import Document
from meshwright.notebook.export.recording import record

MOST_ELEMENTS = 20_000
"""Meshes of more elements have no snapshot: a notebook would become too large."""
FILM_ELEMENTS, FILM_STEPS = 2_000, 400
"""Up to these, a snapshot holds the whole history."""
MOST_BYTES = 1_000_000
"""Size of the arrays of a history above which only the present state is kept."""


def snapshot(document: Document) -> dict[str, Any]:
    """The recording of the history where it is small, otherwise of the present state; empty without
    a mesh, and where that is large.

    The form is that of :func:`meshwright.notebook.export.recording.record`.
    """
    mesh = document.mesh
    if mesh is None or mesh.n_elements > MOST_ELEMENTS:
        return {}
    if mesh.n_elements <= FILM_ELEMENTS and len(document.history) <= FILM_STEPS:
        whole = record(document)
        if sum(len(step["arrays"]) for step in whole["steps"]) <= MOST_BYTES:
            return whole
    return record(Document(mesh.copy(), document.name))
