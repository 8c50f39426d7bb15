"""How an operation, with the smoothing that follows it, would change the shape of elements near it.

Imports scipy (smoothing), so import it late.
"""

from __future__ import annotations

import numpy as np

from meshwright.document.position_repair import relax_around
from meshwright_core import HalfEdgeMesh, MeshError, Operation
from meshwright_core.geometry.movable_part import elements_at
from meshwright_core.geometry.planes import plane_normal
from meshwright_core.geometry.quality import Measure


class _RollBackError(Exception):
    """Ends a transaction whose changes are not wanted."""


def shape_change(
    mesh: HalfEdgeMesh, operation: Operation, halfedge: int, smooth: bool = True
) -> float | None:
    """Change of the smallest scaled Jacobian among the elements that an operation touches.

    The operation is carried out, smoothed around as in the window if ``smooth``, measured and
    rolled back, so that the mesh is as before to the bit. None where the mesh lies in no plane, or
    the operation is refused or touches nothing that was there before.
    """
    normal = plane_normal(mesh)
    if normal is None:
        return None
    points, after, touched = mesh.points.copy(), 0.0, np.zeros(0, np.int64)
    try:
        with mesh.transaction():
            edit = mesh.apply(operation, halfedge)
            touched = np.unique(np.asarray(edit.touched, np.int64))
            if smooth:
                relax_around(mesh, edit.touched, thorough=False)
            shared = min(len(points), len(mesh.points))
            moved = (mesh.points[:shared] != points[:shared]).any(axis=1)
            touched = np.union1d(touched, np.flatnonzero(moved))
            after = _worst(mesh, touched, normal)
            raise _RollBackError
    except _RollBackError:
        pass
    except MeshError:
        return None
    before = _worst(mesh, touched, normal)
    return None if np.isinf(before) or np.isinf(after) else after - before


def _worst(mesh: HalfEdgeMesh, vertices: np.ndarray, normal: np.ndarray) -> float:
    """The smallest scaled Jacobian of the elements at those of the vertices that there are."""
    there = vertices[vertices < mesh.slots]
    there = there[mesh.degree()[there] > 0]
    ids = elements_at(mesh, there)
    sines = Measure(mesh, ids, normal).everything().sine
    ideal = 1.0 if mesh.k == 4 else float(np.sqrt(0.75))
    return float(sines.min(initial=np.inf)) / ideal
