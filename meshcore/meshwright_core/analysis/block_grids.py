"""The block decomposition as a structured multi-block grid: the vertices of each block in rows.

Each block of :mod:`meshwright_core.analysis.blocks` is a regular grid of quads, or a closed band of
them around a hole. Here it becomes an array of vertex ids, the form that structured solvers read.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.analysis.blocks import block_of, separatrices
from meshwright_core.core.arrays import ORIGIN, TWIN
from meshwright_core.errors import MeshError

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

_STEP = ((0, -1), (1, 0), (0, 1), (-1, 0))
"""Where the element across each side lies, in columns and rows, the first side below."""


@dataclass(frozen=True, eq=False)
class Grid:
    """One block."""

    vertices: np.ndarray
    """(m + 1, n + 1) int64 vertex ids; in a closed band the last column is the first again."""
    elements: np.ndarray
    """(m, n) int64 element ids; the corners of element [i, j] are the vertices [i, j],
    [i, j + 1], [i + 1, j + 1], [i + 1, j], counter-clockwise."""
    closed: bool
    """Whether it is a band around a hole."""

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of quads."""
        rows, columns = self.elements.shape
        return rows, columns


def grids(mesh: HalfEdgeMesh, corners: bool = False) -> list[Grid]:
    """All blocks, in the order in which :func:`meshwright_core.analysis.blocks.block_of` counts
    them.

    Args:
        mesh: a quad mesh.
        corners: as in :func:`meshwright_core.analysis.blocks.separatrices`.

    Raises:
        MeshError: the mesh is of triangles, or a block is not a grid, which means that the mesh is
        corrupt.
    """
    cut = separatrices(mesh, corners)
    blocks, ids = block_of(mesh, corners), mesh.element_ids()
    found = []
    for block in range(int(blocks.max()) + 1 if len(blocks) else 0):
        mine = ids[blocks == block]
        places, period = _walked(mesh, cut, int(mine[0]))
        if len(places) != len(mine):
            raise MeshError(f"Block {block} is not connected.")
        found.append(_grid(mesh, places, period, block))
    return found


def _walked(
    mesh: HalfEdgeMesh, cut: np.ndarray, first: int
) -> tuple[dict[int, tuple[int, int, int]], tuple[int, int]]:
    """Column, row and lowest side of every element of a block, and the step after which a band
    comes back to where it was, (0, 0) if it is none.
    """
    twin = mesh.arrays.edge[:, TWIN]
    places = {first: (0, 0, 0)}
    period = (0, 0)
    waiting = deque([first])
    while waiting:
        element = waiting.popleft()
        column, row, low = places[element]
        for side, (right, up) in enumerate(_STEP):
            h = 4 * element + (low + side) % 4
            if twin[h] < 0 or cut[h]:
                continue
            other, back = divmod(int(twin[h]), 4)
            # the side that it came in by is the one across
            place = (column + right, row + up, (back - (side + 2)) % 4)
            known = places.setdefault(other, place)
            if known is place:
                waiting.append(other)
            elif known != place:
                period = (abs(place[0] - known[0]), abs(place[1] - known[1]))
    return places, period


def _grid(
    mesh: HalfEdgeMesh,
    places: dict[int, tuple[int, int, int]],
    period: tuple[int, int],
    block: int,
) -> Grid:
    table = np.array([(e, *place) for e, place in places.items()], np.int64)
    if period[1]:  # let a band run along its rows: a quarter turn
        turned = np.column_stack([table[:, 2], -table[:, 1], (table[:, 3] + 1) % 4])
        table[:, 1:], period = turned, (period[1], period[0])
    if period[0]:
        table[:, 1] %= period[0]
    table[:, 1:3] -= table[:, 1:3].min(axis=0)
    columns, rows = (table[:, 1:3].max(axis=0) + 1).tolist()
    elements = np.full((rows, columns), -1, np.int64)
    elements[table[:, 2], table[:, 1]] = table[:, 0]
    if period[1] or rows * columns != len(table) or (elements < 0).any():
        raise MeshError(f"Block {block} is not a grid.")
    low = np.zeros((rows, columns), np.int64)
    low[table[:, 2], table[:, 1]] = table[:, 3]
    origin = mesh.arrays.edge[:, ORIGIN].astype(np.int64)
    vertices = np.full((rows + 1, columns + 1), -1, np.int64)
    for corner, (i, j) in enumerate(((0, 0), (0, 1), (1, 1), (1, 0))):
        vertices[i : i + rows, j : j + columns] = origin[4 * elements + (low + corner) % 4]
    return Grid(vertices, elements, bool(period[0]))
