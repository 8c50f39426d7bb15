"""Smooths chosen vertices and untangles inverted elements; imports scipy, so import it late."""

from __future__ import annotations

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.composite_curves import place_all
from meshwright_core.geometry.max_min_positions import max_min_positions
from meshwright_core.geometry.movable_part import chosen, elements_at
from meshwright_core.geometry.quality import inverted
from meshwright_core.geometry.smoothing import relax, smooth
from meshwright_core.geometry.untangling import untangle
from meshwright_core.geometry.weighed_shapes import weighed_shapes, weighed_worst

FEW = 300
"""Elements of a mesh that counts as one of blocks."""
POOR, FAIR = 0.3, 0.5
"""Weighed sines of the worst element below which it is better to look further, and to worry."""
CLOSE = 0.9
"""How much of it is kept is not worse."""


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
    relax(mesh)
    still_inverted = inverted(mesh)
    return [int(row) for row in np.flatnonzero(np.isin(mesh.element_ids(), still_inverted))]


def smooth_all(mesh: HalfEdgeMesh) -> None:
    """Smooth and untangle the whole mesh, writing to its journal.

    Averages spoil blocks, which are coarse: where they leave an element of at most :data:`FEW`
    plane quads badly shaped, in its corners or as a long thin one, or clearly worse than before
    unless it is still :data:`FAIR`, the vertices get the positions whose worst element is best.
    """
    before = mesh.copy()
    relax(mesh)
    if mesh.k != 4 or mesh.n_elements > FEW or mesh.points[mesh.vertices(), 2].any():
        return
    enough = max(POOR, min(FAIR, CLOSE * weighed_worst(before)))
    if weighed_worst(mesh) >= enough:
        return
    relaxed, kept = mesh.copy(), before.copy()
    for placed in (relaxed, kept):
        placed.move(*max_min_positions(placed))
    best = max((mesh, relaxed, kept, before), key=lambda m: (-len(inverted(m)), weighed_worst(m)))
    ids = mesh.vertices()
    mesh.move(ids, best.points[ids], best.arrays.parameter[ids])


def square_up(mesh: HalfEdgeMesh) -> int:
    """Move vertices along the boundary to where the one edge from there inside meets it at a right
    angle; returns how many.

    Each stays between its neighbours, and moves only where the worst element at it does not become
    worse, in its corners or as a long thin one; in a mesh of more than :data:`FEW` elements nothing
    moves. A search often ends just beside such positions, and the lines of a grid between parallel
    sides would be oblique. Writes to the mesh's journal.
    """
    moved = 0
    if mesh.n_elements > FEW:
        return moved
    free = mesh.boundary() & ~mesh.geometric() & ~mesh.locked() & ~mesh.pinned()
    for v in np.flatnonzero(free & (mesh.degree() == 3)).tolist():
        (inside,) = (h for h in mesh.outgoing(v) if mesh.twin(h) >= 0)
        curve, parameter = mesh.curve_of(v), mesh.parameter_of(v)
        if curve < 0:
            continue
        there, around = mesh.points[[v]].copy(), elements_at(mesh, np.array([v]))
        before = _worst(mesh, around)
        mesh.move([v], mesh.points[[mesh.target(inside)]])  # finds the parameter
        foot = np.array([mesh.parameter_of(v)])
        mesh.move([v], place_all(mesh.boundary_info.curves, np.array([curve]), foot), foot)
        if _worst(mesh, around) < before:
            mesh.move([v], there, [parameter])
        else:
            moved += 1
    return moved


def _worst(mesh: HalfEdgeMesh, elements: np.ndarray) -> float:
    rows = np.isin(mesh.element_ids(), elements)
    return float(weighed_shapes(mesh)[rows].min())


def _move(
    mesh: HalfEdgeMesh, vertices: np.ndarray, positions: np.ndarray, parameters: np.ndarray
) -> None:
    if len(vertices):
        mesh.move(vertices, positions, parameters)
