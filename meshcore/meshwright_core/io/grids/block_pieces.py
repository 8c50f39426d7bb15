"""Blocks as blockMesh accepts them.

It takes a block for inside out whose corners, joined by straight lines, make no convex quad, as
those of half a ring do. Such blocks are cut along lines of the grid, with all blocks of their
chords, so that the pieces meet side by side and the cells stay the same.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.blocks.structure import SIDE_CORNERS
from meshwright_core.io.grids.block_edges import EdgeShape, curve_shape, line_shape

LEAST_SINE = 0.05
"""Smallest sine of a corner of the straight quad of a block that is not cut."""
MOST_PARTS = 16
"""Parts of a chord, at most."""


class PieceLine(NamedTuple):
    """A side of pieces."""

    vertices: np.ndarray
    """(k + 1,) of the grid."""
    sizes: np.ndarray
    """(k,) lengths of its cells, to a common factor."""
    shape: EdgeShape


@dataclass(frozen=True, eq=False)
class BlockPieces:
    """p pieces of the blocks of a grid; without cuts these are the blocks."""

    corners: np.ndarray
    """(p, 4) vertices of the grid, counter-clockwise."""
    shapes: np.ndarray
    """(p, 2) cells along the two axes."""
    region: np.ndarray
    """(p,)"""
    sides: np.ndarray
    """(p, 4) the line of each side, numbered as the sides of blocks are."""
    forward: np.ndarray
    """(p, 4) whether the line runs in the direction of the axis."""
    lines: list[PieceLine]
    faces: dict[str, list[tuple[int, int]]]
    """For each patch the ends of its lines, the domain on their left."""

    @classmethod
    def of(cls, grid: BlockGrid) -> BlockPieces:
        """Cut the blocks of a grid as far as necessary."""
        return _Cutter(grid, part_counts(grid)).pieces()


def part_counts(grid: BlockGrid) -> np.ndarray:
    """(c,) into how many parts each chord is cut."""
    structure, counts = grid.structure, grid.division.counts
    parts = np.ones(len(counts), np.int64)
    if (_sines(grid.points[structure.corners]) >= LEAST_SINE).all():
        return parts
    while True:
        worst = {}
        for block, (one, other) in enumerate(structure.crossing.tolist()):
            table = grid.block_vertices(block)
            ahead = structure.forward[block]
            rows = _places(counts[other], parts[other], ahead[1])
            columns = _places(counts[one], parts[one], ahead[0])
            at = grid.points[table[np.ix_(rows, columns)]]
            quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=2)
            if (_sines(quads.reshape(-1, 4, 3)) >= LEAST_SINE).all():
                continue
            points = grid.points[table]
            bends = [_bend(points.swapaxes(0, 1), columns), _bend(points, rows)]
            chord = (one, other)[int(np.argmax(bends))]
            worst[chord] = max(bends)
        grown = [
            chord for chord in worst
            if 2 * parts[chord] <= min(MOST_PARTS, counts[chord])
        ]  # fmt: skip
        if not grown:
            return parts
        chord = max(grown, key=worst.__getitem__)
        parts[chord] *= 2


def _sines(corners: np.ndarray) -> np.ndarray:
    """(n,) the smallest sine of a corner of straight quads (n, 4, 3) in the plane of x and y."""
    ahead = np.roll(corners, -1, axis=1) - corners
    back = np.roll(corners, 1, axis=1) - corners
    cross = ahead[..., 0] * back[..., 1] - ahead[..., 1] * back[..., 0]
    lengths = np.linalg.norm(ahead, axis=2) * np.linalg.norm(back, axis=2)
    least: np.ndarray = (cross / np.where(lengths > 0.0, lengths, 1.0)).min(axis=1)
    return least


def _bend(points: np.ndarray, cuts: np.ndarray) -> float:
    """The largest ratio of length to chord between cuts, of the outer columns of (k, q, 3)."""
    worst = 1.0
    for column in (0, -1):
        line = points[:, column]
        arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        straight = np.linalg.norm(np.diff(line[cuts], axis=0), axis=1)
        ratio = np.diff(arc[cuts]) / np.where(straight > 0.0, straight, 1.0)
        worst = max(worst, float(ratio.max()))
    return worst


def _places(count: int, parts: int, ahead: bool = True) -> np.ndarray:
    """(parts + 1,) where a line of cells in the direction of its chord, or against it, is cut."""
    places = np.arange(parts + 1) * int(count) // int(parts)
    return places if ahead else int(count) - places[::-1]


class _Cutter:
    def __init__(self, grid: BlockGrid, parts: np.ndarray) -> None:
        self.grid, self.parts = grid, parts
        structure = grid.structure
        on_edges = parts[structure.chord]
        self.first = np.concatenate([[0], np.cumsum(on_edges)]).astype(np.int64)
        """The lines of each edge begin here."""
        self.lines = [
            line for edge in range(len(structure.edges)) for line in self.edge_lines(edge)
        ]

    def edge_lines(self, edge: int) -> list[PieceLine]:
        """The lines of a block edge, in its direction."""
        grid = self.grid
        vertices, sizes = grid.edge_vertices(edge), grid.edge_sizes(edge)
        share = np.concatenate([[0.0], np.cumsum(sizes)])
        share[-1] = 1.0
        cuts = _places(len(sizes), self.parts[grid.structure.chord[edge]]).tolist()
        found = []
        for low, high in pairwise(cuts):
            own = vertices[low : high + 1]
            if grid.structure.parts.curve[edge] < 0:
                shape = line_shape(grid.points[own])
            else:
                shape = curve_shape(grid, edge, own, (float(share[low]), float(share[high])))
            found.append(PieceLine(own, sizes[low:high], shape))
        return found

    def pieces(self) -> BlockPieces:
        structure, grid = self.grid.structure, self.grid
        corners, shapes, region, sides, forward = [], [], [], [], []
        for block, (one, other) in enumerate(structure.crossing.tolist()):
            table = grid.block_vertices(block)
            n, m = grid.shapes[block].tolist()
            ahead = structure.forward[block]
            columns = _places(n, self.parts[one], ahead[0]).tolist()
            rows = _places(m, self.parts[other], ahead[1]).tolist()
            across, along = self.inside(block, table, rows, columns)
            for j in range(len(rows) - 1):
                for i in range(len(columns) - 1):
                    left, right, low, high = columns[i], columns[i + 1], rows[j], rows[j + 1]
                    corners.append([
                        table[low, left], table[low, right], table[high, right], table[high, left]
                    ])  # fmt: skip
                    shapes.append([right - left, high - low])
                    region.append(int(structure.region[block]))
                    four = (
                        along[j][i], across[i + 1][j], along[j + 1][i], across[i][j],
                    )  # fmt: skip
                    sides.append([line for line, _ in four])
                    forward.append([ahead for _, ahead in four])
        return BlockPieces(
            np.array(corners), np.array(shapes), np.array(region), np.array(sides),
            np.array(forward), self.lines, self.faces(),
        )  # fmt: skip

    def inside(
        self, block: int, table: np.ndarray, rows: list[int], columns: list[int]
    ) -> tuple[list[list[tuple[int, bool]]], list[list[tuple[int, bool]]]]:
        """The lines of a block, and whether they run along its axes: those of each column of cuts
        from the first row on, and those of each row; lines inside are added.
        """
        n, m = self.grid.shapes[block].tolist()
        sizes = [self.side_sizes(block, side) for side in range(len(SIDE_CORNERS))]
        across, along = [], []
        for at in columns:
            if at in (0, n):
                across.append(self.outer(block, 1 if at else 3, len(rows) - 1))
                continue
            own = (1.0 - at / n) * sizes[3] + at / n * sizes[1]
            across.append(self.added(table[:, at], own, rows))
        for at in rows:
            if at in (0, m):
                along.append(self.outer(block, 2 if at else 0, len(columns) - 1))
                continue
            own = (1.0 - at / m) * sizes[0] + at / m * sizes[2]
            along.append(self.added(table[at], own, columns))
        return across, along

    def side_sizes(self, block: int, side: int) -> np.ndarray:
        structure = self.grid.structure
        sizes = self.grid.edge_sizes(int(structure.sides[block, side]))
        return sizes if structure.forward[block, side] else sizes[::-1]

    def outer(self, block: int, side: int, parts: int) -> list[tuple[int, bool]]:
        structure = self.grid.structure
        start, ahead = (
            int(self.first[structure.sides[block, side]]), bool(structure.forward[block, side])
        )  # fmt: skip
        found = [(start + part, ahead) for part in range(parts)]
        return found if ahead else found[::-1]

    def added(
        self, vertices: np.ndarray, sizes: np.ndarray, cuts: list[int]
    ) -> list[tuple[int, bool]]:
        found = []
        for low, high in pairwise(cuts):
            own = vertices[low : high + 1]
            shape = line_shape(self.grid.points[own])
            found.append((len(self.lines), True))
            self.lines.append(PieceLine(own, sizes[low:high], shape))
        return found

    def faces(self) -> dict[str, list[tuple[int, int]]]:
        structure = self.grid.structure
        found: dict[str, list[tuple[int, int]]] = {}
        for patch in structure.patches:
            ends = found.setdefault(patch.name, [])
            for edge in patch.edges.tolist():
                lines = self.lines[self.first[edge] : self.first[edge + 1]]
                pairs = [(int(line.vertices[0]), int(line.vertices[-1])) for line in lines]
                if structure.neighbours[edge, 0] < 0:
                    pairs = [(b, a) for a, b in reversed(pairs)]
                ends += pairs
        return found
