"""Runs every kernel of the editor once, so that they are compiled, or loaded from the cache.

`python -m meshcore.warm_up` does so in a process of its own, whose cache others then load.
"""

from __future__ import annotations

import numpy as np

from meshcore.compiled import warm
from meshcore.mesh import HalfEdgeMesh


def exercise() -> None:
    """Check, apply, undo and redo on two tiny meshes; all operations compile with these few."""
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    triangles = HalfEdgeMesh.from_elements(points, [[0, 1, 2], [0, 2, 3]])
    triangles.apply("flip", triangles.halfedge(0, 2))
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(3.0), np.arange(3.0)))
    corners = np.array([0, 1, 3, 4])
    quads = HalfEdgeMesh.from_elements(
        np.column_stack([x, y]),
        np.column_stack([corners, corners + 1, corners + 4, corners + 3]),
    )
    quads.set_locked(4)
    quads.move([4], quads.points[[4]])
    while quads.undo():
        continue
    quads.redo()
    quads.clean_all()


if __name__ == "__main__":
    warm()
