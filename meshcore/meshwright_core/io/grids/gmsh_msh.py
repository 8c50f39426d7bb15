"""Gmsh's mesh format 2.2 with physical groups: quads and boundary lines of order 1, 2 or 3."""

from __future__ import annotations

import numpy as np

from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.blocks.high_order import HighOrderGrid, high_order
from meshwright_core.io.grids.gmsh_geo import quoted

_LINE = {1: 1, 2: 8, 3: 26}
_QUAD = {1: 3, 2: 10, 3: 36}
GMSH_NODES = {
    1: [0, 1, 3, 2],
    2: [0, 2, 8, 6, 1, 5, 7, 3, 4],
    3: [0, 3, 15, 12, 1, 2, 7, 11, 14, 13, 8, 4, 5, 6, 10, 9],
}
"""Corners, nodes of the sides in turn, nodes inside, of cells whose nodes are in rows."""


def msh_text(grid: BlockGrid, order: int = 1) -> str:
    """The text of the file. Raises MeshError for other orders than 1, 2 and 3."""
    fine = high_order(grid, order)
    structure = grid.structure
    count = len(structure.region_names)
    # regions of one name are one group: that of the first of them
    first = [structure.region_names.index(name) for name in structure.region_names]
    names = [(2, i + 1, structure.region_names[i]) for i in dict.fromkeys(first)]
    names += [(1, count + i, patch.title) for i, patch in enumerate(structure.patches, start=1)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    lines += [f'{dimension} {number} "{quoted(name)}"' for dimension, number, name in names]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(fine.points))]
    lines += [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(fine.points.tolist(), 1)]
    rows = _elements(fine, np.array(first)[grid.regions], count)
    lines += ["$EndNodes", "$Elements", str(len(rows))]
    lines += [f"{i} {row}" for i, row in enumerate(rows, start=1)]
    return "\n".join([*lines, "$EndElements", ""])


def _elements(fine: HighOrderGrid, groups: np.ndarray, regions: int) -> list[str]:
    """The lines of the file, for cells of groups (M,) and so many regions."""
    rows = []
    ends = [0, fine.order, *range(1, fine.order)]
    for i, faces in enumerate(fine.faces.values(), start=regions + 1):
        kind = f"{_LINE[fine.order]} 2 {i} {i}"
        rows += [f"{kind} {' '.join(map(str, face))}" for face in (faces[:, ends] + 1).tolist()]
    table = np.column_stack([groups, fine.cells[:, GMSH_NODES[fine.order]]]) + 1
    kind = f"{_QUAD[fine.order]} 2"
    for region, *nodes in table.tolist():
        rows.append(f"{kind} {region} {region} {' '.join(map(str, nodes))}")
    return rows
