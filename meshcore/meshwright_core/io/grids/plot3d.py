"""Plot3D grids of several blocks, as text or binary, and the neutral map of their boundaries.

Blocks are n + 1 by m + 1 by 1 points. The neutral map (NASA's `.nmf`) names the boundary of each
block side by its patch, and joins the others one to one.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.blocks.grid_quality import block_sides

_PER_LINE = 4
_FACE = (5, 4, 6, 3)
"""The number of each side of a block: j min, i max, j max, i min."""


def plot3d_text(grid: BlockGrid) -> str:
    """The points as text, all of x, then y, then z of each block."""
    shapes = grid.shapes + 1
    lines = [f"{len(shapes)}"]
    lines += [f"{n} {m} 1" for n, m in shapes.tolist()]
    for block in range(len(shapes)):
        values = grid.block_points(block).reshape(-1, 3).T.ravel().tolist()
        lines += [
            " ".join(f"{value:.17g}" for value in values[i : i + _PER_LINE])
            for i in range(0, len(values), _PER_LINE)
        ]
    return "\n".join(lines) + "\n"


def plot3d_bytes(grid: BlockGrid) -> bytes:
    """The same as a Fortran unformatted file: records between their lengths, double precision,
    little-endian.
    """
    shapes = np.column_stack([grid.shapes + 1, np.ones(len(grid.shapes), np.int64)])
    parts = [_record(np.array([len(shapes)], "<i4")), _record(shapes.astype("<i4"))]
    for block in range(len(shapes)):
        values = np.ascontiguousarray(grid.block_points(block).reshape(-1, 3).T, "<f8")
        parts.append(_record(values))
    return b"".join(parts)


def _record(values: np.ndarray) -> bytes:
    data = values.tobytes()
    length = np.array([len(data)], "<u4").tobytes()
    return length + data + length


def neutral_map(grid: BlockGrid) -> str:
    """The neutral map file: sizes of the blocks, one line for each side of each block.

    Faces are numbered 1 to 6: k min, k max, i min, i max, j min, j max. The range of a face at i is
    of j and k, that of a face at j of k and i.
    """
    structure = grid.structure
    shapes = (grid.shapes + 1).tolist()
    lines = ["# Neutral map file of a Meshwright grid", "# block  idim  jdim  kdim"]
    lines += [f"{len(shapes)}", ""]
    lines += [f"{b} {n} {m} 1" for b, (n, m) in enumerate(shapes, start=1)]
    lines += ["", "# type  B1 F1 S1 E1 S2 E2  B2 F2 S1 E1 S2 E2  swap"]
    name = {edge: patch.name for patch in structure.patches for edge in patch.edges.tolist()}
    for edge, (block, side, other, across) in enumerate(block_sides(structure).tolist()):
        one = _face(shapes[block], block, side, True)
        if other < 0:
            lines.append(f"'{name[edge]}' {one}")
            continue
        same = structure.forward[block, side] == structure.forward[other, across]
        # the k range of the two faces is the first one or the second one
        swap = "TRUE" if side % 2 != across % 2 else "FALSE"
        joined = _face(shapes[other], other, across, bool(same))
        lines.append(f"'ONE_TO_ONE' {one} {joined} {swap}")
    return "\n".join(lines) + "\n"


def _face(shape: list[int], block: int, side: int, ahead: bool) -> str:
    """Block, face and ranges; `ahead`: along the axis of the block."""
    count = shape[side % 2]
    low, high = (1, count) if ahead else (count, 1)
    ranges = f"1 1 {low} {high}" if side % 2 == 0 else f"{low} {high} 1 1"
    return f"{block + 1} {_FACE[side]} {ranges}"
