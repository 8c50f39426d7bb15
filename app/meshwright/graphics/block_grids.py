"""Block grids in Python: ``meshwright.blocks``, as data, as PyVista's MultiBlock, as files."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.sources import resolve
from meshwright_core.blocks.grid import BlockGrid, BlockStructure, block_grid
from meshwright_core.blocks.grid_quality import GridQuality
from meshwright_core.blocks.sizing import Sizing, WallLayer
from meshwright_core.errors import GridWarning

if TYPE_CHECKING:
    import pyvista

    from meshwright_core import HalfEdgeMesh


@dataclass(frozen=True, eq=False)
class Blocks:
    """A block-structured grid, the result of :func:`blocks`."""

    grid: BlockGrid
    """All of its data."""

    @property
    def structure(self) -> BlockStructure:
        """Blocks, block edges, chords and patches."""
        return self.grid.structure

    @property
    def mesh(self) -> HalfEdgeMesh:
        """The quads that the blocks are."""
        return self.grid.structure.mesh

    @property
    def points(self) -> np.ndarray:
        """(n, 3) the vertices of the cells."""
        return self.grid.points

    @property
    def cells(self) -> np.ndarray:
        """(m, 4) the vertices of each cell, counter-clockwise."""
        return self.grid.cells

    @property
    def counts(self) -> np.ndarray:
        """(c,) the number of cells across each chord."""
        return self.grid.division.counts

    @property
    def quality(self) -> GridQuality:
        """Worst scaled Jacobian, aspect ratio, non-orthogonality, growth."""
        return self.grid.quality

    @property
    def patches(self) -> dict[str, np.ndarray]:
        """For each named side the (k, 2) sides of cells on it, the domain on their left."""
        return dict(self.grid.patch_faces())

    def __len__(self) -> int:
        """The number of blocks."""
        return len(self.structure.corners)

    def __getitem__(self, block: int) -> np.ndarray:
        """(m + 1, n + 1, 3) the points of a block: row, column, coordinates."""
        return self.grid.block_points(range(len(self))[block])

    def multiblock(self) -> pyvista.MultiBlock:
        """The blocks as structured grids and the patches as lines, by name."""
        import pyvista

        found = pyvista.MultiBlock()
        for block in range(len(self)):
            at = self.grid.block_points(block)
            one = pyvista.StructuredGrid(
                *(np.ascontiguousarray(at[None, :, :, c]).T for c in range(3))
            )
            one.cell_data["region"] = np.full(one.n_cells, self.structure.region[block])
            found.append(one, f"block_{block + 1}")
        sides = pyvista.MultiBlock()
        for name, faces in self.patches.items():
            used, local = np.unique(faces, return_inverse=True)
            lines = np.column_stack([np.full(len(faces), 2), local.reshape(-1, 2)])
            sides.append(pyvista.PolyData(self.points[used], lines=lines.ravel()), name)
        found.append(sides, "patches")
        return found

    def write(self, path: str | os.PathLike[str], order: int = 1, **options: Any) -> list[Path]:
        """Write the grid; see :func:`meshwright_core.io.grids.block_files.write_blocks`."""
        from meshwright_core.io.grids.block_files import write_blocks

        return write_blocks(path, self.grid, order, **options)


def blocks(
    mesh: Any,
    size: float | None = None,
    *,
    divide: int | None = None,
    walls: tuple[WallLayer, ...] | list[WallLayer] = (),
    **sizing: Any,
) -> Blocks:
    """The block-structured grid of a quad mesh, each quad a block.

    Args:
        mesh: what :func:`meshwright.mesh` takes, of quads; use :func:`meshwright.solve` first for
            few blocks.
        size: length of a cell; by default from the geometry.
        divide: cells along every block edge, in place of a size.
        walls: layers of thin cells, as ``mw.WallLayer("wall", height=1e-3, ratio=1.2)``.
        sizing: further fields of :class:`meshwright_core.blocks.sizing.Sizing`: `side_sizes`,
            `side_counts`, `edge_counts`, `chord_counts`.

    Numbers of cells, gradings and layers that were set in the window or the widget count where none
    are given here.

    Raises MeshError, one sentence: no quads, not plane, or numbers that contradict each other.
    Warns (GridWarning) of layers that have no effect, as the cells are thinner already.
    """
    wanted = Sizing(size=size, divide=divide, walls=tuple(walls), **sizing)
    structure = BlockStructure.of(found := resolve.mesh(mesh))
    kept = Sizing.planned(structure, found.grid_plan)
    grid = block_grid(structure, wanted.over(kept))
    for remark in grid.remarks:
        warnings.warn(remark, GridWarning, stacklevel=2)
    return Blocks(grid)
