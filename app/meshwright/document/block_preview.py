"""The block structure of a document's mesh with its wishes, and the fine grid for the view."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.blocks.grid import BlockGrid, block_grid, interpolated
from meshwright_core.blocks.grid_quality import GridQuality
from meshwright_core.blocks.sizing import (
    Division,
    GridConflictError,
    Sizing,
    division,
    flat_layers,
)
from meshwright_core.blocks.structure import BlockStructure

MOST_BLOCKS = 3000
"""Blocks of a mesh that are shown; a mesh of more is no block structure that one edits by hand."""
ALONG_CURVES = 65
"""Points of a block edge on a curve."""
MOST_CELLS = 60_000
"""Cells that a preview has."""


@dataclass(frozen=True, eq=False)
class PlannedBlocks:
    """The blocks of one state of a mesh, divided as its wishes have it."""

    structure: BlockStructure
    """Of a copy of the mesh, which a thread may use."""
    sizing: Sizing
    division: Division | None
    """None where the wishes contradict each other."""
    problem: str = ""
    """How they do, in a sentence."""
    chords: tuple[int, ...] = ()
    """The chords that this is about."""

    @classmethod
    def of(cls, mesh: HalfEdgeMesh) -> PlannedBlocks:
        """The blocks of a quad mesh. Raises MeshError where there are none, or too many to show."""
        if mesh.kind == "quad" and mesh.n_elements > MOST_BLOCKS:
            raise MeshError(
                f"Each of the {mesh.n_elements:,} quads would be a block, and {MOST_BLOCKS:,} are "
                "shown at most: let the agent find a decomposition first (Agent > Complete)."
            )
        structure = BlockStructure.of(mesh.copy())
        sizing = Sizing()
        try:
            sizing = Sizing.planned(structure, mesh.grid_plan)
            return cls(structure, sizing, division(structure, sizing))
        except GridConflictError as error:
            return cls(structure, sizing, None, str(error), tuple(error.chords))
        except MeshError as error:
            return cls(structure, sizing, None, str(error))

    @property
    def cells(self) -> int:
        """How many cells the grid has; 0 where there is none."""
        if self.division is None:
            return 0
        return int(self.division.counts[self.structure.crossing].prod(axis=1).sum())

    @property
    def remarks(self) -> tuple[str, ...]:
        """Wishes that have no effect, a sentence each."""
        if self.division is None:
            return ()
        return flat_layers(self.structure, self.sizing, self.division)

    def pinned(self) -> set[int]:
        """The chords whose number of cells the user has set."""
        return set(self.sizing.chord_counts)


@dataclass(frozen=True, eq=False)
class GridPreview:
    """The fine grid as lines for the view."""

    lines: list[np.ndarray]
    """(p, 2) each, the lines inside of blocks."""
    edges: list[np.ndarray]
    """(p, 2) each, the block edges, in the direction of their chords; smoothing bends those that
    are not on curves."""
    corners: np.ndarray
    """(v, 2) the corners of blocks, as :attr:`BlockStructure.vertices` has them."""
    quality: GridQuality
    final: bool
    """Whether it is the grid that is exported, and not yet without its smoothing."""


def previews(
    planned: PlannedBlocks, show: Callable[[GridPreview], None], stopped: Callable[[], bool]
) -> None:
    """Show the grid by interpolation, then the smoothed one, until `stopped`. Raises MeshError."""
    if planned.division is None or planned.cells > MOST_CELLS:
        return
    rough = interpolated(planned.structure, planned.division)
    if not stopped():
        show(_preview(rough, False))
    if not stopped():
        fine = block_grid(planned.structure, planned.sizing)
        if not stopped():
            show(_preview(fine, True))


def _preview(grid: BlockGrid, final: bool) -> GridPreview:
    corners = grid.points[: len(grid.structure.points), :2]
    return GridPreview(_lines(grid), _edges(grid), corners, grid.quality, final)


def _lines(grid: BlockGrid) -> list[np.ndarray]:
    found: list[np.ndarray] = []
    for block in range(len(grid.shapes)):
        at = grid.block_points(block)[:, :, :2]
        found += [*at[1:-1], *at[:, 1:-1].swapaxes(0, 1)]
    return found


def _edges(grid: BlockGrid) -> list[np.ndarray]:
    structure, found = grid.structure, []
    w = np.linspace(0.0, 1.0, ALONG_CURVES)
    for edge, curve in enumerate(structure.parts.curve.tolist()):
        if curve < 0:
            found.append(grid.points[grid.edge_vertices(edge), :2])
        else:
            found.append(structure.parts.points(np.full(len(w), edge), w)[:, :2])
    return found
