"""Positions of a plane quad mesh of which the worst corner is as good as can be."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.core.arrays import FLAGS, LOCKED
from meshwright_core.errors import MeshError
from meshwright_core.geometry.layout_positions import (
    INNER,
    POLISH,
    ROUNDS,
    Effort,
    position,
    position_some,
    rails_of,
)

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

STEPS = 150
"""Of each stage of the optimisation."""


def max_min_positions(
    mesh: HalfEdgeMesh, vertices: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Positions with the best worst element that is found, by its corners and, for long thin ones,
    the ratio of its sides; then better shapes of the other elements.

    It begins at the present positions; corners, locked and pinned vertices stay, those on curves
    slide along them. The mesh itself is not changed. A mesh of hundreds of quads takes a second.

    Args:
        mesh: the mesh.
        vertices: ids (n,) of those that may move; None: all. Then only their elements count.

    Returns:
        ids (n,) of the vertices that may move, their places (n, 3), and parameters (n,), as
        :meth:`HalfEdgeMesh.move` takes them.

    Raises:
        MeshError: the mesh is of triangles, or not in the plane z = 0.
    """
    if mesh.k != 4 or mesh.points[mesh.vertices(), 2].any():
        raise MeshError("Only quads in the plane have such positions.")
    placed = mesh.copy()
    placed.arrays.vertex[mesh.pinned().nonzero()[0], FLAGS] |= LOCKED
    rails, live = rails_of(placed, len(placed.arrays.vertex)), mesh.vertices()
    if vertices is None:
        position(placed.arrays, rails, 1.0, STEPS)
    else:
        live = np.intersect1d(live, vertices)
        active = np.zeros(len(placed.arrays.vertex), np.bool_)
        active[live] = True
        position_some(placed.arrays, rails, Effort(1.0, STEPS, ROUNDS, INNER, POLISH), active)
    ids = live[~(placed.geometric() | placed.locked())[live]]
    return ids, placed.points[ids].copy(), placed.arrays.parameter[ids].copy()
