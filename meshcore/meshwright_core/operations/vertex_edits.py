"""Edits that leave the connectivity as it is: position, desired degree and flags of vertices."""

from __future__ import annotations

from meshwright_core.core.arrays import DEGREE, DESIRED, FLAGS
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.history.journal import begin_step, end_step, put_point, put_vertex, set_degrees


@bare_kernel
def move(m, vertices, positions):
    """Write positions (n, 3) of vertices (n,) as one step."""
    begin_step(m, -1, -1)
    for i in range(len(vertices)):
        put_point(m, vertices[i], positions[i, 0], positions[i, 1], positions[i, 2])
    end_step(m)


@bare_kernel
def set_vertex(m, v, column, value):
    """Write the desired degree or the flags of v as one step."""
    begin_step(m, -1, -1)
    if column == DESIRED:
        set_degrees(m, v, m.vertex[v, DEGREE], value)
    else:
        put_vertex(m, v, FLAGS, value)
    end_step(m)
