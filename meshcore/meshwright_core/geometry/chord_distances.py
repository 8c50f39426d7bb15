"""How far curved edges lie from the straight edges that mesh files hold."""

from __future__ import annotations

import numpy as np

from meshwright_core.geometry.edge_parts import EdgeParts
from meshwright_core.mesh import HalfEdgeMesh

SAMPLES = 9
"""Points of each edge that are measured."""


def largest_chord_distance(mesh: HalfEdgeMesh) -> float:
    """The largest distance of a point of an edge, along its curve, from the straight edge between
    the same ends, as a fraction of the mesh's size; 0 if no edge is curved.
    """
    parts = EdgeParts.of(mesh.arrays, mesh.halfedges_of(mesh.element_ids()).ravel(), mesh.k)
    parts = parts.take(np.flatnonzero(parts.curve >= 0))
    if not len(parts):
        return 0.0
    fractions = np.linspace(0.0, 1.0, SAMPLES + 2)[1:-1]
    rows = np.repeat(np.arange(len(parts)), SAMPLES)
    points = parts.points(rows, np.tile(fractions, len(parts)))
    start, along = parts.ends[rows, 0], parts.ends[rows, 1] - parts.ends[rows, 0]
    length = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(((points - start) * along).sum(axis=1) / length, 0.0, 1.0)
    away = np.linalg.norm(points - start - share[:, None] * along, axis=1).max()
    used = mesh.points[mesh.vertices()]
    return float(away / max(float(np.ptp(used, axis=0).max()), 1e-300))
