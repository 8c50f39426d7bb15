"""Smooths chosen vertices and untangles inverted elements; imports scipy, so import it late."""

from __future__ import annotations

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.movable_part import chosen, elements_at
from meshwright_core.geometry.quality import inverted
from meshwright_core.geometry.smoothing import relax, smooth
from meshwright_core.geometry.untangling import untangle


def tidy(mesh: HalfEdgeMesh, vertices: np.ndarray) -> None:
    """Smooth ``vertices`` (n,), and untangle them where an element at them is inverted.

    No other vertex moves; corners and locked ones stay. Writes to the mesh's journal.
    """
    _move(mesh, *smooth(mesh, vertices.tolist()))
    if len(chosen(mesh, vertices.tolist()).inverted()):
        done = untangle(mesh, vertices.tolist())
        _move(mesh, done.vertices, done.positions, done.parameters)


def repair(mesh: HalfEdgeMesh) -> tuple[int, int]:
    """Untangle around each inverted element in turn; other vertices stay where they are.

    Returns the number of inverted elements before and after. Writes to the mesh's journal.
    """
    pending = dict.fromkeys(inverted(mesh).tolist())
    count = len(pending)
    while pending:
        element = next(iter(pending))
        del pending[element]
        corners = mesh.corners(np.array([element]))[0]
        # what stays inverted now would stay so at a second attempt
        left = relax(mesh, corners.tolist())
        for seen in (*elements_at(mesh, corners).tolist(), *left.tolist()):
            pending.pop(seen, None)
    return count, len(inverted(mesh)) if count else 0


def settle(mesh: HalfEdgeMesh) -> list[int]:
    """Smooth and untangle the whole mesh; return the elements that stay inverted.

    An element is named by its row in ``mesh.elements()``, which is its place in a written file,
    counted from 0.
    """
    still_inverted = relax(mesh)
    return [int(row) for row in np.flatnonzero(np.isin(mesh.element_ids(), still_inverted))]


def _move(
    mesh: HalfEdgeMesh, vertices: np.ndarray, positions: np.ndarray, parameters: np.ndarray
) -> None:
    if len(vertices):
        mesh.move(vertices, positions, parameters)
