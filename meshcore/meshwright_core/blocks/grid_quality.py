"""The quality of a block-structured grid, in the measures that solvers check."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.blocks.compiled_grid import Layout, fill_faces, measure_cells, measure_faces
from meshwright_core.blocks.plane_frame import PlaneFrame

if TYPE_CHECKING:
    from meshwright_core.blocks.structure import BlockStructure


@dataclass(frozen=True, eq=False)
class GridQuality:
    """M cells, their worst and their single values."""

    sines: np.ndarray
    """(M,) scaled Jacobians: the smallest sine of a corner, negative where folded."""
    areas: np.ndarray
    """(M,)"""
    worst_scaled_jacobian: float
    inverted: int
    """Cells with a corner of 180 degrees or more."""
    worst_aspect: float
    """The largest ratio of the longest to the shortest side of a cell."""
    non_orthogonality: float
    """Degrees, at most, between the line that joins the centres of two neighbouring cells and the
    normal of their common side, as OpenFOAM's checkMesh has it; 0 for a single cell."""
    growth: float
    """The largest ratio of the areas of two neighbouring cells."""


def measured(
    structure: BlockStructure, layout: Layout, cells: np.ndarray, points: np.ndarray
) -> GridQuality:
    """The quality of a grid with these points (N, 3)."""
    flat = PlaneFrame.of(structure).flat(points)
    flat = flat - flat[0]  # areas of parts that are far from the origin
    count = len(cells)
    sine, aspect, area = np.empty(count), np.empty(count), np.empty(count)
    measure_cells(flat, cells, sine, aspect, area)
    n, m = layout.shape[:, 0], layout.shape[:, 1]
    inner = int(((n - 1) * m + n * (m - 1)).sum())
    owners = block_sides(structure)
    shared = owners[:, 2] >= 0
    inner += int(np.diff(layout.edge_first)[shared].sum() + shared.sum())
    faces = np.empty((inner, 4), np.int64)
    fill_faces(layout, owners, faces)
    angle, growth = np.zeros(inner), np.ones(inner)
    measure_faces(flat, cells, faces, area, angle, growth)
    return GridQuality(
        sine, area, float(sine.min()), int((sine <= 0.0).sum()), float(aspect.max()),
        float(np.degrees(angle.max(initial=0.0))), float(growth.max(initial=1.0)),
    )  # fmt: skip


def block_sides(structure: BlockStructure) -> np.ndarray:
    """(e, 4) block and side on one side of each edge, block and side on the other, or -1."""
    flat = structure.sides.ravel()
    order = np.argsort(flat, kind="stable")
    first = np.searchsorted(flat[order], np.arange(len(structure.edges)))
    found = np.full((len(structure.edges), 4), -1, np.int64)
    found[:, 0], found[:, 1] = order[first] // 4, order[first] % 4
    shared = (structure.neighbours >= 0).all(axis=1)
    second = order[first[shared] + 1]
    found[shared, 2], found[shared, 3] = second // 4, second % 4
    return found
