"""Better positions for chosen vertices, and for what is folded; imported late, for scipy is slow
to come.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.quality import inverted
from meshwright_core.geometry.region import chosen, elements_at
from meshwright_core.geometry.smoothing import relax, smooth
from meshwright_core.geometry.untangling import untangle

if TYPE_CHECKING:
    from meshwright.document.document import Document


def tidy(mesh: HalfEdgeMesh, vertices: np.ndarray) -> None:
    """Smooth ``vertices`` (n,), and untangle them where an element at them is folded.

    No other vertex moves; corners and locked ones stay. Writes to the mesh's journal.
    """
    _move(mesh, *smooth(mesh, vertices.tolist()))
    if len(chosen(mesh, vertices.tolist()).inverted()):
        done = untangle(mesh, vertices.tolist())
        _move(mesh, done.vertices, done.positions)


def mend(mesh: HalfEdgeMesh) -> tuple[int, int]:
    """Untangle around the inverted elements, place after place; the rest stays where it is.

    Returns how many elements were inverted, and how many still are. Writes to the mesh's journal.
    """
    pending = dict.fromkeys(inverted(mesh).tolist())
    count = len(pending)
    while pending:
        element = next(iter(pending))
        del pending[element]
        corners = mesh.corners(np.array([element]))[0]
        left = relax(mesh, corners.tolist())  # what stays folded there stays so another time too
        for seen in (*elements_at(mesh, corners).tolist(), *left.tolist()):
            pending.pop(seen, None)
    return count, len(inverted(mesh)) if count else 0


def _move(mesh: HalfEdgeMesh, vertices: np.ndarray, positions: np.ndarray) -> None:
    if len(vertices):
        mesh.move(vertices, positions)


def after_run(document: Document, by: str, held: np.ndarray | None, searched: bool) -> None:
    """What an agent's run leaves behind, in better shape, as one step; ``held`` (n,) stay.

    The whole mesh after a search, because its result is looked at; after any other run only what
    is inverted, and that only where the document smooths by itself.
    """
    mesh = document.mesh
    if mesh is None:
        return
    if held is not None:
        document.smooth(by, np.setdiff1d(mesh.vertices(), held))
    elif searched:
        document.smooth(by)
    elif document.auto_smooth and len(inverted(mesh)):
        document.untangle(by)
