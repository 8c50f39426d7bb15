"""The blocks of a quad mesh: the faces of its base complex.

A separatrix leaves every vertex at which the mesh is no grid (inside: degree not 4; on the
boundary: degree above 3) along each of its edges, and goes straight on through inside vertices of
degree 4 until it meets the boundary or another such vertex. Interfaces of regions separate blocks,
too, and where one turns inside, separatrices leave. Cut along all of them, the mesh falls into
blocks, each a regular grid of quads, or a closed band of them around a hole. Coarse meshes at the
optimum have few blocks: this is the block decomposition that the paper aims at.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.core.arrays import ELEMENT_SLOTS, ORIGIN, TWIN
from meshwright_core.core.components import components
from meshwright_core.errors import MeshError

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


def separatrices(mesh: HalfEdgeMesh, corners: bool = False) -> np.ndarray:
    """(half-edge slots,) bool: the half-edges inside, both of an edge, on which blocks meet.

    Args:
        mesh: a quad mesh.
        corners: cut also from geometric vertices of degree 3, so that no side of a block turns at
            a corner of the outline.

    Raises:
        MeshError: the mesh is of triangles.
    """
    if mesh.k != 4:
        raise MeshError("Only quad meshes have blocks.")
    slots = 4 * int(mesh.arrays.counters[ELEMENT_SLOTS])
    origin = mesh.arrays.edge[:slots, ORIGIN].astype(np.int64)
    twin = mesh.arrays.edge[:slots, TWIN].astype(np.int64)
    degree, boundary = mesh.degree(), mesh.boundary()
    sources = np.where(boundary, degree > 3, degree != 4)
    if corners:
        sources |= boundary & mesh.geometric() & (degree == 3)
    straight = ~boundary & (degree == 4)
    inside = (origin >= 0) & (twin >= 0)
    cut = np.zeros(slots, bool)
    region, rows = mesh.arrays.region, np.arange(slots) // 4
    cut[inside] = region[rows[inside]] != region[twin[inside] // 4]
    entering = np.flatnonzero(cut & straight[np.maximum(origin[twin], 0)])
    turning = ~cut[_next(twin[_next(entering)])]
    sources[origin[twin[entering[turning]]]] = True
    walking = np.flatnonzero(inside & sources[np.maximum(origin, 0)])
    while len(walking):
        back = twin[walking]
        cut[walking] = cut[back] = True
        # straight on: past the end of each, by the edge across from it
        ahead = walking[straight[origin[back]]]
        onward = _next(twin[_next(ahead)])
        walking = onward[~cut[onward]]
    return cut


def block_of(mesh: HalfEdgeMesh, corners: bool = False) -> np.ndarray:
    """(m,) the block, counted from 0, of each element in the order of `mesh.elements()`.

    Raises MeshError for triangles; `corners` as in :func:`separatrices`.
    """
    cut = separatrices(mesh, corners)
    edge = mesh.arrays.edge[: len(cut)]
    joined = np.flatnonzero((edge[:, ORIGIN] >= 0) & (edge[:, TWIN] >= 0) & ~cut)
    slots = len(cut) // 4
    label = components(joined // 4, edge[joined, TWIN] // 4, slots)[1][mesh.element_ids()]
    return np.unique(label, return_inverse=True)[1].ravel()


def block_count(mesh: HalfEdgeMesh, corners: bool = False) -> int:
    """The number of blocks; errors and `corners` as in :func:`block_of`."""
    blocks = block_of(mesh, corners)
    return int(blocks.max()) + 1 if len(blocks) else 0


def _next(h: np.ndarray) -> np.ndarray:
    return h - h % 4 + (h + 1) % 4
