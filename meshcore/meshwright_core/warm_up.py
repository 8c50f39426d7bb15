"""Runs every kernel of the editor once, so that they are compiled, or loaded from the cache.

`python -m meshwright_core.warm_up` does so in a process of its own, whose cache others then load.
"""

from __future__ import annotations

import shutil
import time
from pathlib import Path

import numpy as np

from meshwright_core.analysis.cleanable_lines import cleanable_lines
from meshwright_core.core.compilation import cache_folder, cache_root
from meshwright_core.core.composite_curves import curve_length, nearest_parameters
from meshwright_core.geometry.coons import at_corners, curved_corners
from meshwright_core.geometry.curved_elements import curved_elements
from meshwright_core.geometry.edge_curves import curved_edge_polylines, edge_points
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.max_min_positions import max_min_positions
from meshwright_core.geometry.quality import inverted
from meshwright_core.geometry.smoothing import relax
from meshwright_core.io.history_checks import require_history
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import CODES, Operation, score_change

_KEPT_SECONDS = 30 * 24 * 3600
_WARM_MARK = "warm"


def exercise() -> None:
    """Check, apply, relax, undo and redo on tiny meshes; these few compile everything."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    triangles = HalfEdgeMesh.from_elements(points, [[0, 1, 2], [0, 2, 3]])
    score_change(triangles.arrays, CODES[3][Operation.FLIP], triangles.halfedge(0, 2))
    triangles.apply("flip", triangles.halfedge(0, 2))
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(3.0), np.arange(3.0)))
    corners = np.array([0, 1, 3, 4])
    places = np.column_stack([x, y])
    elements = np.column_stack([corners, corners + 1, corners + 4, corners + 3])
    halves = HalfEdgeMesh.from_elements(places, elements, regions=[0, 1, 0, 1])
    halves.move([4], halves.points[[4]], halves.parameters()[[4]])
    halves.off_curve()
    ids = halves.element_ids()
    bent = curved_elements(halves, ids, halves.elements())  # none; the types are what counts
    curved_corners(bent, halves.points, np.zeros((len(ids), 3)))
    curve_length(bent.curves, 0)
    nearest_parameters(bent.curves, 0, halves.points[:1])
    at_corners(bent, halves.points, np.array([0.0, 0.0, 1.0]))
    quads = HalfEdgeMesh.from_elements(places, elements)
    quads.move([4], np.array([[3.0, 3.0, 0.0]]))
    relax(quads, [4])
    max_min_positions(quads, np.array([4]))
    inverted(quads)
    element_shapes(quads)
    edge_points(quads, 0, [0.5])
    curved_edge_polylines(quads, 0.1)
    quads.set_locked(4)
    quads.move([4], quads.points[[4]])
    while quads.undo():
        continue
    quads.redo()
    require_history(quads)
    cleanable_lines(quads)
    quads.clean_all()


def exercise_grids() -> None:
    """Make a small fine grid of four blocks with layers at walls, which compiles all its kernels.

    Not a part of :func:`exercise`: editing needs none of them.
    """
    # imported here: the window asks at its start whether this module has run
    from meshwright_core.blocks.grid import EVEN_CELLS, block_grid
    from meshwright_core.blocks.sizing import Sizing, WallLayer

    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(3.0), np.arange(3.0)))
    corners = np.array([0, 1, 3, 4])
    elements = np.column_stack([corners, corners + 1, corners + 4, corners + 3])
    quads = HalfEdgeMesh.from_elements(np.column_stack([x, y]), elements)
    cells = 2 + EVEN_CELLS  # more than the coarse grid has, which is smoothed first
    grid = block_grid(quads, Sizing(divide=cells, walls=(WallLayer("all", 0.02),)))
    if not grid.quality.worst_scaled_jacobian > 0.0:
        raise RuntimeError("the fine grid of four squares is not valid")


def is_warm_on_disk() -> bool:
    """Whether :func:`warm` has run to its end for these very sources on this machine."""
    return (cache_folder() / _WARM_MARK).exists()


def warm() -> None:
    """Compile, or load from the cache, every kernel that editing needs. Blocks; thread-safe."""
    exercise()
    try:
        folder = cache_folder()
        folder.mkdir(parents=True, exist_ok=True)
        (folder / _WARM_MARK).touch()
        _remove_stale(cache_root())
    except OSError:
        return  # a read-only home: the kernels are in memory, which is what matters now


def _remove_stale(root: Path) -> None:
    deadline = time.time() - _KEPT_SECONDS
    for folder in root.iterdir():
        if folder.is_dir() and folder.stat().st_mtime < deadline:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    warm()
