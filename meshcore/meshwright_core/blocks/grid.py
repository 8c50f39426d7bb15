"""The fine grid of a block structure: vertices, cells, and where they lie in the blocks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.blocks.compiled_grid import (
    Graded,
    Layout,
    fill_cells,
    grade_edges,
    interpolate,
    number_vertices,
)
from meshwright_core.blocks.grid_quality import GridQuality, measured
from meshwright_core.blocks.plane_frame import PlaneFrame
from meshwright_core.blocks.sizing import Division, Sizing, WallLayer, division, flat_layers
from meshwright_core.blocks.smoothing import smoothed
from meshwright_core.blocks.structure import SIDE_CORNERS, BlockStructure

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

EVEN_CELLS = 10
"""Cells along a chord, at most, of the coarse grid whose smoothing the fine one starts from."""


@dataclass(frozen=True, eq=False)
class BlockGrid:
    """N vertices and M cells of b blocks. The corners of blocks come first among the vertices, in
    the order of the structure, then those inside block edges, then those inside blocks; cells come
    block by block, along the first axis first.
    """

    structure: BlockStructure
    division: Division
    layout: Layout
    share: np.ndarray
    """(N,) the fraction of the length of its edge at each vertex inside an edge, in the edge's
    direction; 0 elsewhere."""
    points: np.ndarray
    """(N, 3) the vertices; those on the boundary lie on its curves."""
    remarks: tuple[str, ...] = ()
    """Wishes that have no effect, a sentence each."""

    @property
    def cell_count(self) -> int:
        """M."""
        return int(self.layout.cell_first[-1])

    @property
    def shapes(self) -> np.ndarray:
        """(b, 2) cells along the two axes of each block."""
        return self.layout.shape

    @cached_property
    def cells(self) -> np.ndarray:
        """(M, 4) the corners of each cell, counter-clockwise."""
        found = np.empty((self.cell_count, 4), np.int64)
        fill_cells(self.layout, found)
        return found

    @cached_property
    def regions(self) -> np.ndarray:
        """(M,) the region of each cell."""
        return np.repeat(self.structure.region, np.diff(self.layout.cell_first))

    @cached_property
    def quality(self) -> GridQuality:
        """What solvers check in the cells."""
        return measured(self.structure, self.layout, self.cells, self.points)

    def block_vertices(self, block: int) -> np.ndarray:
        """(m + 1, n + 1) the vertices of a block of n by m cells: row j, column i."""
        n, m = self.layout.shape[block]
        start = self.layout.start
        return self.layout.ids[start[block] : start[block + 1]].reshape(m + 1, n + 1)

    def block_points(self, block: int) -> np.ndarray:
        """(m + 1, n + 1, 3) the points of a block."""
        return self.points[self.block_vertices(block)]

    def edge_vertices(self, edge: int) -> np.ndarray:
        """(n + 1,) the vertices along a block edge, in its direction."""
        first = self.layout.edge_first
        start, end = self.structure.edges[edge]
        return np.concatenate([[start], np.arange(first[edge], first[edge + 1]), [end]])

    def patch_faces(self) -> Mapping[str, np.ndarray]:
        """For each patch the (k, 2) boundary sides of cells, the domain on their left."""
        structure = self.structure
        found = {}
        for patch in structure.patches:
            faces = []
            for edge in patch.edges.tolist():
                line = self.edge_vertices(edge)
                if structure.neighbours[edge, 0] < 0:
                    line = line[::-1]
                faces.append(np.column_stack([line[:-1], line[1:]]))
            found[patch.name] = np.concatenate(faces)
        return found

    def edge_sizes(self, edge: int) -> np.ndarray:
        """(n,) the shares of the edge's length that its cells have, in its direction."""
        first = self.layout.edge_first
        inside = self.share[first[edge] : first[edge + 1]]
        return np.diff(np.concatenate([[0.0], inside, [1.0]]))


def block_grid(
    mesh: HalfEdgeMesh | BlockStructure, sizing: Sizing | None = None, smooth: bool = True
) -> BlockGrid:
    """The fine grid of the blocks of a quad mesh in a plane.

    The block edges are divided on their true curves, the blocks by transfinite interpolation
    (Gordon and Hall 1973), and the inside, interfaces between blocks included, is smoothed; where
    the interpolation folds, it is unfolded. Time and memory are linear in the number of cells.

    Args:
        mesh: the quads, or their structure.
        sizing: numbers of cells and layers at walls; by default from the geometry.
        smooth: False for the interpolation alone.

    Raises MeshError: no quads, a mesh that is not plane, or a sizing that does not fit.
    """
    structure = mesh if isinstance(mesh, BlockStructure) else BlockStructure.of(mesh)
    frame = PlaneFrame.of(structure)
    wanted = division(structure, sizing or Sizing())
    remarks = flat_layers(structure, sizing or Sizing(), wanted)
    grid = replace(interpolated(structure, wanted), remarks=remarks)
    if not smooth:
        return grid
    coarse = interpolated(structure, _evened(wanted))
    return replace(grid, points=smoothed(structure, coarse, grid, frame))


def interpolated(structure: BlockStructure, wanted: Division) -> BlockGrid:
    """The grid by transfinite interpolation of the divided block edges alone."""
    layout = grid_layout(structure, wanted.counts)
    edges = len(structure.edges)
    corners, outer = len(structure.points), int(layout.edge_first[-1])
    share = np.zeros(int(layout.block_first[-1]))
    graded = graded_edges(structure, wanted, share)
    counts = wanted.counts[structure.chord]
    grade_edges(structure.lengths, counts, graded, layout.edge_first[:-1], share)
    points = np.zeros((len(share), 3))
    points[:corners] = structure.points
    owner = np.repeat(np.arange(edges), counts - 1)
    points[corners:outer] = structure.edge_points(owner, share[corners:outer])
    interpolate(layout, graded, points)
    return BlockGrid(structure, wanted, layout, share, points)


def graded_edges(structure: BlockStructure, wanted: Division, share: np.ndarray) -> Graded:
    """The grading of the edges for the compiled loops."""
    chord = structure.chord
    return Graded(share, wanted.first[chord], wanted.last[chord], wanted.ratio[chord])


def _evened(wanted: Division) -> Division:
    """A coarse division without grading."""
    zeros = np.zeros(len(wanted.counts))
    counts = np.minimum(wanted.counts, EVEN_CELLS)
    return Division(counts, zeros, zeros, np.ones(len(counts)))


def grid_layout(structure: BlockStructure, counts: np.ndarray) -> Layout:
    """The numbering of a grid with so many cells (c,) across the chords."""
    on_edges = counts[structure.chord] - 1
    shape = np.ascontiguousarray(counts[structure.crossing])
    inside = (shape - 1).prod(axis=1)
    edge_first = len(structure.points) + _sums(on_edges)
    block_first = edge_first[-1] + _sums(inside)
    start = _sums((shape + 1).prod(axis=1))
    layout = Layout(
        np.ascontiguousarray(structure.sides), np.ascontiguousarray(structure.forward),
        np.ascontiguousarray(structure.corners), shape, edge_first, block_first, start,
        _sums(shape.prod(axis=1)), np.full(int(start[-1]), -1, np.int64),
    )  # fmt: skip
    number_vertices(layout)
    return layout


def _sums(numbers: np.ndarray) -> np.ndarray:
    """(n + 1,) the sums of the first numbers (n,)."""
    return np.concatenate([[0], np.cumsum(numbers)]).astype(np.int64)


__all__ = [
    "SIDE_CORNERS", "BlockGrid", "BlockStructure", "Division", "Sizing", "WallLayer", "block_grid",
]  # fmt: skip
