"""Runs every kernel of the editor once, so that they are compiled, or loaded from the cache.

`python -m meshwright_core.warm_up` does so in a process of its own, whose cache others then load.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.analysis.cleanable_lines import cleanable_lines
from meshwright_core.core.compilation import warm
from meshwright_core.geometry.sides import Sides
from meshwright_core.geometry.smoothing import relax
from meshwright_core.mesh import HalfEdgeMesh


def exercise() -> None:
    """Check, apply, relax, undo and redo on two tiny meshes; these few compile everything."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    triangles = HalfEdgeMesh.from_elements(points, [[0, 1, 2], [0, 2, 3]])
    triangles.apply("flip", triangles.halfedge(0, 2))
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(3.0), np.arange(3.0)))
    corners = np.array([0, 1, 3, 4])
    quads = HalfEdgeMesh.from_elements(
        np.column_stack([x, y]),
        np.column_stack([corners, corners + 1, corners + 4, corners + 3]),
    )
    quads.move([4], np.array([[3.0, 3.0, 0.0]]))
    relax(quads, [4])
    Sides(quads).project(1, quads.points[1])
    quads.set_locked(4)
    quads.move([4], quads.points[[4]])
    while quads.undo():
        continue
    quads.redo()
    cleanable_lines(quads)
    quads.clean_all()


if __name__ == "__main__":
    warm()
