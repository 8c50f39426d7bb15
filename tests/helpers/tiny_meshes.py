"""Tiny meshes for hand-drawn cases."""

import numpy as np

from meshwright_core import HalfEdgeMesh


def square_of_triangles():
    """Two triangles (0, 1, 2), (0, 2, 3) on a square; half-edge 3 runs from 0 to 2."""
    points = [[0, 0], [1, 0], [1, 1], [0, 1]]
    return HalfEdgeMesh.from_elements(points, [[0, 1, 2], [0, 2, 3]])


def fan(k):
    """k triangles around vertex 0 inside."""
    angles = 2 * np.pi * np.arange(k) / k
    points = np.concatenate([[[0, 0]], np.column_stack([np.cos(angles), np.sin(angles)])])
    ring = np.arange(1, k + 1)
    return HalfEdgeMesh.from_elements(
        points, np.column_stack([np.zeros(k, int), ring, np.roll(ring, -1)])
    )


def grid(width, height=None, holes=(), **kwargs):
    """width x height unit quads, vertex i + j * (width + 1) at (i, j); `holes` names cells left
    out."""
    height = height or width
    cells = [(i, j) for j in range(height) for i in range(width) if (i, j) not in holes]
    corner = [i + j * (width + 1) for i, j in cells]
    quads = [[c, c + 1, c + width + 2, c + width + 1] for c in corner]
    points = [[i, j] for j in range(height + 1) for i in range(width + 1)]
    return HalfEdgeMesh.from_elements(points, quads, **kwargs)


def ring(around, across):
    """An annulus of around x across quads; vertex i + j * around on circle j, the inner one
    first."""
    angles = 2 * np.pi * np.arange(around) / around
    points = np.concatenate(
        [(1.0 + j) * np.column_stack([np.cos(angles), np.sin(angles)]) for j in range(across + 1)]
    )
    quads = [
        [i + j * around, i + (j + 1) * around, o + (j + 1) * around, o + j * around]
        for j in range(across)
        for i, o in zip(range(around), [*range(1, around), 0], strict=True)
    ]
    boundary = np.zeros(len(points), bool)
    degrees = np.full(len(points), 4)
    degrees[:around] = degrees[-around:] = 3
    return HalfEdgeMesh.from_elements(points, quads, boundary, degrees)


def faces(mesh):
    """The elements as a set, each begun at its least vertex."""
    found = set()
    for row in mesh.elements().tolist():
        i = row.index(min(row))
        found.add(tuple(row[i:] + row[:i]))
    return found
