"""Smooths chosen vertices and untangles inverted elements; imports scipy, so import it late."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.composite_curves import place_all
from meshwright_core.geometry.max_min_positions import max_min_positions
from meshwright_core.geometry.movable_part import chosen, elements_at, live, rings
from meshwright_core.geometry.quality import inverted, scaled_jacobian
from meshwright_core.geometry.smoothing import RINGS, relax, smooth
from meshwright_core.geometry.untangling import untangle
from meshwright_core.geometry.weighed_shapes import weighed_shapes, weighed_worst

FEW = 300
"""Elements of a mesh that counts as one of blocks."""
POOR, FAIR = 0.3, 0.5
"""Weighed sines of the worst element below which it is better to look further, and to worry."""
ALIKE = 1e-3
"""Difference of two such sines that is none."""
CLOSE = 0.9
"""How much of it is kept is not worse."""


def tidy(mesh: HalfEdgeMesh, vertices: np.ndarray) -> None:
    """Smooth ``vertices`` (n,), and untangle them where an element at them is inverted.

    No other vertex moves; corners and locked ones stay. Few quads in the plane keep the shape of
    the worst of them as in :func:`relax_around`. Writes to the mesh's journal.
    """
    before = mesh.copy() if _few_plane_quads(mesh) else None
    _move(mesh, *smooth(mesh, vertices.tolist()))
    if len(chosen(mesh, vertices.tolist()).inverted()):
        done = untangle(mesh, vertices.tolist())
        _move(mesh, done.vertices, done.positions, done.parameters)
    if before is not None:
        _keep_shapes(mesh, before, vertices)


def relax_around(mesh: HalfEdgeMesh, touched: Iterable[int], thorough: bool = True) -> None:
    """Smooth after an edit that touched these vertices, as
    :func:`meshwright_core.geometry.smoothing.relax` does, and writing to the journal too.

    Averages and the energy of untangling make all elements alike and spoil blocks, which are
    coarse. So in a mesh of at most :data:`FEW` plane quads the worst of the elements around does
    not become worse by it if the positions whose worst element is best prevent that.
    """
    before = mesh.copy() if _few_plane_quads(mesh) else None
    relax(mesh, touched, thorough)
    if before is None:
        return
    moved = (mesh.points != before.points).any(axis=1)
    near = rings(mesh, live(mesh, touched), RINGS)
    _keep_shapes(mesh, before, np.union1d(near, np.flatnonzero(moved)))


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
    if not _few_plane_quads(mesh):
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


def _few_plane_quads(mesh: HalfEdgeMesh) -> bool:
    return mesh.k == 4 and mesh.n_elements <= FEW and not mesh.points[mesh.vertices(), 2].any()


def _keep_shapes(mesh: HalfEdgeMesh, before: HalfEdgeMesh, vertices: np.ndarray) -> None:
    """Give ``vertices`` (n,) the positions whose worst element is best, if the worst one at them is
    worse than ``before``, which is the same mesh with other positions, or badly shaped.
    """
    around = np.isin(mesh.element_ids(), elements_at(mesh, vertices))

    def sine(placed: HalfEdgeMesh) -> float:
        return float(scaled_jacobian(placed)[around].min(initial=1.0))

    def weighed(placed: HalfEdgeMesh) -> float:
        return float(weighed_shapes(placed)[around].min(initial=1.0))

    least = sine(before) - ALIKE
    if sine(mesh) >= least and weighed(mesh) >= max(POOR, weighed(before) - ALIKE):
        return
    relaxed, kept = mesh.copy(), before.copy()
    for placed in (relaxed, kept):
        placed.move(*max_min_positions(placed, vertices))
    keeping = [placed for placed in (mesh, relaxed, kept) if sine(placed) >= least]
    best = max(
        keeping or (mesh, relaxed, kept, before), key=lambda m: (-len(inverted(m)), weighed(m))
    )
    if best is not mesh:
        mesh.move(vertices, best.points[vertices], best.arrays.parameter[vertices])


def _worst(mesh: HalfEdgeMesh, elements: np.ndarray) -> float:
    rows = np.isin(mesh.element_ids(), elements)
    return float(weighed_shapes(mesh)[rows].min())


def _move(
    mesh: HalfEdgeMesh, vertices: np.ndarray, positions: np.ndarray, parameters: np.ndarray
) -> None:
    if len(vertices):
        mesh.move(vertices, positions, parameters)
