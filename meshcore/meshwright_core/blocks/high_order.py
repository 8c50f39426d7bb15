"""Cells of higher order: a node every so many parts of a side, curved as the grid and its curves.

Lines of the grid are interpolated by cubics through its vertices. On the boundary and on interfaces
the nodes lie on the curves exactly; what they differ there from the cubics fades across the block,
so that thin layers at a curved wall curve with it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright_core.blocks.grid import BlockGrid, grid_layout
from meshwright_core.blocks.structure import SIDE_CORNERS
from meshwright_core.errors import MeshError

ORDERS = (1, 2, 3)


@dataclass(frozen=True, eq=False)
class HighOrderGrid:
    """N nodes and M cells of one order."""

    order: int
    points: np.ndarray
    """(N, 3) the nodes."""
    cells: np.ndarray
    """(M, (order + 1)^2) the nodes of each cell, along the first axis first."""
    faces: dict[str, np.ndarray]
    """For each patch the (k, order + 1) nodes along the sides of cells, the domain on the left."""


def high_order(grid: BlockGrid, order: int) -> HighOrderGrid:
    """The cells of a grid with nodes at all multiples of 1 / order. Raises MeshError for orders
    other than 1, 2 and 3.
    """
    if order not in ORDERS:
        raise MeshError(f"Cells are of order 1, 2 or 3, not {order}.")
    structure = grid.structure
    fine = grid_layout(structure, order * grid.division.counts)
    points = np.zeros((int(fine.block_first[-1]), 3))
    points[: len(structure.points)] = grid.points[: len(structure.points)]
    lines = [_edge_nodes(grid, edge, order) for edge in range(len(structure.edges))]
    for edge, line in enumerate(lines):
        points[fine.edge_first[edge] : fine.edge_first[edge + 1]] = line[1:-1]
    cells = []
    for block in range(len(structure.corners)):
        n, m = (order * grid.shapes[block]).tolist()
        ids = fine.ids[fine.start[block] : fine.start[block + 1]].reshape(m + 1, n + 1)
        nodes = _block_nodes(grid, block, order, lines)
        points[ids[1:-1, 1:-1]] = nodes[1:-1, 1:-1]
        local = [
            ids[j : j + m - order + 1 : order, i : i + n - order + 1 : order].ravel()
            for j in range(order + 1)
            for i in range(order + 1)
        ]
        cells.append(np.column_stack(local))
    faces = {}
    for patch in structure.patches:
        sides = []
        for edge in patch.edges.tolist():
            start, end = structure.edges[edge]
            inside = np.arange(fine.edge_first[edge], fine.edge_first[edge + 1])
            line = np.concatenate([[start], inside, [end]])
            if structure.neighbours[edge, 0] < 0:
                line = line[::-1]
            begins = np.arange(0, len(line) - 1, order)
            sides.append(line[begins[:, None] + np.arange(order + 1)])
        faces[patch.name] = np.concatenate(sides)
    return HighOrderGrid(order, points, np.concatenate(cells), faces)


def _edge_nodes(grid: BlockGrid, edge: int, order: int) -> np.ndarray:
    """(order n + 1, 3) nodes of an edge, in its direction; on its curve where it has one."""
    structure = grid.structure
    line = grid.points[grid.edge_vertices(edge)]
    if structure.parts.curve[edge] < 0:
        return _refined(line, order)
    share = np.concatenate([[0.0], np.cumsum(grid.edge_sizes(edge))])
    share[-1] = 1.0
    fine = np.interp(np.arange(order * (len(share) - 1) + 1) / order, np.arange(len(share)), share)
    nodes = structure.edge_points(np.full(len(fine), edge), fine)
    nodes[::order] = line
    return nodes


def _block_nodes(grid: BlockGrid, block: int, order: int, lines: list[np.ndarray]) -> np.ndarray:
    """(order m + 1, order n + 1, 3) nodes of a block."""
    structure = grid.structure
    nodes = _refined(_refined(grid.block_points(block), order).swapaxes(0, 1), order)
    nodes = np.ascontiguousarray(nodes.swapaxes(0, 1))
    v, u = _shares(nodes), _shares(nodes.swapaxes(0, 1)).T
    added = np.zeros_like(nodes)
    for side in range(len(SIDE_CORNERS)):
        line = lines[structure.sides[block, side]]
        if not structure.forward[block, side]:
            line = line[::-1]
        if side % 2 == 0:
            row = 0 if side == 0 else -1
            fade = 1.0 - v if side == 0 else v
            added += fade[..., None] * (line - nodes[row])[None, :]
        else:
            column = 0 if side == 3 else -1
            fade = 1.0 - u if side == 3 else u
            added += fade[..., None] * (line - nodes[:, column])[:, None]
    corrected: np.ndarray = nodes + added
    return corrected


def _shares(nodes: np.ndarray) -> np.ndarray:
    """(p, q) the fraction of the length of each column of nodes (p, q, 3) that lies before each."""
    steps = np.linalg.norm(np.diff(nodes, axis=0), axis=2)
    arc = np.concatenate([np.zeros((1, nodes.shape[1])), np.cumsum(steps, axis=0)])
    found: np.ndarray = arc / np.where(arc[-1:] > 0.0, arc[-1:], 1.0)
    return found


def _refined(points: np.ndarray, order: int) -> np.ndarray:
    """(order n + 1, ...) cubic interpolation of points (n + 1, ...) along the first axis."""
    n = len(points) - 1
    if order == 1:
        return points.copy()
    if n == 1:
        before, after = 2.0 * points[:1] - points[1:2], 2.0 * points[1:2] - points[:1]
    else:
        before = 3.0 * points[:1] - 3.0 * points[1:2] + points[2:3]
        after = 3.0 * points[-1:] - 3.0 * points[-2:-1] + points[-3:-2]
    whole = np.concatenate([before, points, after])
    found = np.empty((order * n + 1, *points.shape[1:]))
    found[::order] = points
    a, b, c, d = whole[:-3], whole[1:-2], whole[2:-1], whole[3:]
    for k in range(1, order):
        t = k / order
        found[k::order] = 0.5 * (
            2.0 * b
            + t * (c - a)
            + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d)
            + t**3 * (3.0 * b - a - 3.0 * c + d)
        )
    return found
