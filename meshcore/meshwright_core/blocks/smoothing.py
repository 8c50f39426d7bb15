"""Smooths a block-structured grid in linear time: coarsely to the end, then the fine cells.

A coarse grid of the same blocks, without grading, is smoothed until nothing moves any more, across
the interfaces between blocks; its displacements carry over to the fine grid by cubic interpolation.
A few sweeps over the fine grid follow, which aim at the sizes of its own interpolation, so that
layers at walls keep their heights and become orthogonal; the lines that lead away from walls are
then spaced anew. The compiled loops are in :mod:`.compiled_relaxation`.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.blocks.compiled_grid import (
    Graded,
    Layout,
    displace,
    measure_cells,
    space_layers,
)
from meshwright_core.blocks.compiled_relaxation import Grid, cells_around, least_corner, relax

if TYPE_CHECKING:
    from meshwright_core.blocks.grid import BlockGrid
    from meshwright_core.blocks.plane_frame import PlaneFrame
    from meshwright_core.blocks.structure import BlockStructure

COARSE_SWEEPS = 200
"""Sweeps over the coarse grid, at most."""
SWEEPS = 6
"""Sweeps over the fine grid, at least..."""
MOVES = 2_000_000
"""... and more on small ones, up to as many as move this number of vertices."""
STILL = 1e-3
"""Largest move of a vertex, in sizes of its cells, below which a grid is taken to be smooth."""
UNFOLDING = 40
"""Sweeps that unfold, at most."""
WALL_WEIGHT = 4.0
"""Weight of the corners on walls with layers, so that their cells become orthogonal."""
KEPT = 0.98
"""Share of the worst scaled Jacobian of the interpolation that the smoothed grid has, at least."""
CHUNK = 20_000
"""Vertices inside blocks that one thread takes at a time, at least."""


def smoothed(
    structure: BlockStructure, coarse: BlockGrid, grid: BlockGrid, frame: PlaneFrame
) -> np.ndarray:
    """(N, 3) the smoothed points of `grid`; `coarse` is of the same blocks, without grading.

    Where the interpolation is valid the result is so too.
    """
    weights = np.ones(len(grid.points))
    walls = wall_vertices(grid)
    weights[walls] = WALL_WEIGHT
    first = frame.flat(grid.points)
    work = _Relaxation(grid, first, weights)
    with _threads() as pool:
        if len(coarse.points) < len(grid.points):
            trial = first.copy()
            _add_coarse(coarse, grid, frame, trial, pool)
            if work.sine(trial) > 0.0 or work.sine(first) <= 0.0:
                work.points[:] = trial
        found = work.between(
            first, work.run(pool, max(SWEEPS, min(COARSE_SWEEPS, MOVES // len(first))))
        )
    division = grid.division
    if (division.first > 0.0).any() or (division.last > 0.0).any():
        spaced = found.copy()
        chord = structure.chord
        graded = Graded(
            grid.share, division.first[chord], division.last[chord], division.ratio[chord]
        )
        space_layers(grid.layout, graded, structure.parts.curve < 0, spaced)
        # the lines may come out crowded where blocks are bent
        if work.sine(spaced) > min(0.9 * work.sine(found), 0.3):
            found = spaced
    points = grid.points.copy()
    moved = (found != first).any(axis=1)
    points[moved] = frame.space(found[moved])
    return points


def wall_vertices(grid: BlockGrid) -> np.ndarray:
    """The vertices on boundary edges that layers lead away from."""
    structure, division = grid.structure, grid.division
    found = [np.zeros(0, np.int64)]
    for patch in structure.patches:
        for edge in patch.edges.tolist():
            block = int(structure.neighbours[edge].max())
            side = int(np.flatnonzero(structure.sides[block] == edge)[0])
            across = (side + 1) % 2
            at_start = (side in (0, 3)) == structure.forward[block, across]
            heights = division.first if at_start else division.last
            if heights[structure.crossing[block, across]] > 0.0:
                found.append(grid.edge_vertices(edge))
    return np.unique(np.concatenate(found))


def _add_coarse(
    coarse: BlockGrid, grid: BlockGrid, frame: PlaneFrame, points: np.ndarray,
    pool: ThreadPoolExecutor,
) -> None:  # fmt: skip
    """Add the displacements of the smoothed coarse grid to points (N, 2)."""
    start = frame.flat(coarse.points)
    work = _Relaxation(coarse, start, np.ones(len(start)))
    moved = work.run(pool, COARSE_SWEEPS) - start
    zeros = np.zeros(len(grid.structure.edges))
    displace(
        coarse.layout, moved, grid.layout, Graded(grid.share, zeros, zeros, zeros + 1.0), points
    )


class _Relaxation:
    """Smooths one grid; `points` (N, 2) are its own."""

    def __init__(self, grid: BlockGrid, points: np.ndarray, weights: np.ndarray) -> None:
        self.grid, self.points = grid, points.copy()
        cells = grid.cells
        first = np.zeros(len(points) + 1, np.int64)
        around = np.empty(4 * len(cells), np.int64)
        cells_around(cells, first, around)
        side = np.linalg.norm(points[np.roll(cells, -1, axis=1)] - points[cells], axis=2)
        sizes = 0.5 * (side[:, :2] + side[:, 2:])
        tiny = 1e-12 * max(float(sizes.max(initial=0.0)), 1e-300)
        self.work = Grid(cells, first, around, np.maximum(sizes, tiny), weights)
        self.free = _free(grid)
        self.ranges = _ranges(grid.layout)

    def sine(self, points: np.ndarray) -> float:
        """The smallest sine of a corner at points (N, 2)."""
        count = len(self.work.cells)
        sine, aspect, area = np.empty(count), np.empty(count), np.empty(count)
        measure_cells(points, self.work.cells, sine, aspect, area)
        return float(sine.min())

    def between(self, start: np.ndarray, end: np.ndarray) -> np.ndarray:
        """`end` (N, 2) or, where its worst corner is worse than that of `start`, the best on the
        way: the energy is a sum over all corners.
        """
        wanted = KEPT * self.sine(start)
        best, reached = end, self.sine(end)
        for share in (0.75, 0.5, 0.25, 0.0):
            if reached >= wanted:
                break
            trial = start + share * (end - start)
            sine = self.sine(trial)
            if sine > reached:
                best, reached = trial, sine
        return best

    def run(self, pool: ThreadPoolExecutor, sweeps: int) -> np.ndarray:
        """Smooth, unfolding first where needed, and return the points (N, 2)."""
        least = self._least()
        if least <= 0.0:
            self._unfold(pool, least)
            least = self._least()
        regular = 0.0 if least > 0.0 else -least + 1e-3
        for _ in range(sweeps):
            if self._sweep(pool, regular) < STILL:
                break
        return self.points

    def _unfold(self, pool: ThreadPoolExecutor, least: float) -> None:
        before = self.points.copy()
        for _ in range(UNFOLDING):
            self._sweep(pool, max(1e-3, -0.5 * least))
            least = self._least()
            if least > 0.0:
                return
        if self.sine(self.points) < self.sine(before):
            self.points[:] = before

    def _least(self) -> float:
        return float(least_corner(self.work, self.points, 0, len(self.work.cells)))

    def _sweep(self, pool: ThreadPoolExecutor, regular: float) -> float:
        """Move every free vertex once: those on the edges in order, then the blocks side by side,
        which do not touch.
        """
        between = int(self.grid.layout.edge_first[-1])
        largest = float(relax(self.work, self.points, self.free, 0, between, regular))
        tasks = [
            pool.submit(relax, self.work, self.points, self.free, low, high, regular)
            for low, high in self.ranges
        ]
        return max([largest, *(float(task.result()) for task in tasks)])


def _free(grid: BlockGrid) -> np.ndarray:
    """(N,) bool: the vertices off all curves that the user keeps neither locked nor pinned."""
    free = np.ones(len(grid.points), bool)
    structure = grid.structure
    on_curves = np.flatnonzero(structure.parts.curve >= 0)
    free[structure.edges[on_curves].ravel()] = False
    kept = structure.mesh.locked() | structure.mesh.pinned()
    free[np.flatnonzero(kept[structure.vertices])] = False
    for edge in on_curves.tolist():
        free[grid.layout.edge_first[edge] : grid.layout.edge_first[edge + 1]] = False
    return free


def _ranges(layout: Layout) -> list[tuple[int, int]]:
    """Ranges of vertices inside blocks, whole blocks each."""
    first = layout.block_first
    cuts = [int(first[0])]
    for stop in first[1:].tolist():
        if stop - cuts[-1] >= CHUNK or stop == first[-1]:
            cuts.append(stop)
    return [(a, b) for a, b in pairwise(cuts) if b > a]


@contextmanager
def _threads() -> Iterator[ThreadPoolExecutor]:
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        yield pool
