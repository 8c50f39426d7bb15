"""Random edits of a document, and what must be equal after an undo."""

import numpy as np

from meshwright.document.document import Document
from meshwright_core.operations.catalogue import of_kind


def wander(document: Document, steps: int, seed: int) -> None:
    """Apply ``steps`` random operations."""
    mesh = document.mesh
    rng = np.random.default_rng(seed)
    infos = of_kind(mesh.kind)
    until = document.history.cursor + steps
    while document.history.cursor < until:
        h = int(rng.choice(mesh.element_ids())) * mesh.k + int(rng.integers(mesh.k))
        operation = infos[rng.integers(len(infos))].operation
        if document.check(operation, h):
            document.submit(operation, h)


def bits(document: Document) -> tuple[bytes, bytes, list[int]]:
    """Connectivity, coordinates and history: equal if nothing differs."""
    mesh = document.mesh
    return mesh.elements().tobytes(), mesh.points.tobytes(), [r.serial for r in document.history]


def serials(rows) -> list[int]:
    return [row.serial for row in rows]
