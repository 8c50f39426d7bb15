"""Walks and small writes that the mesh class needs beside the operations."""

from __future__ import annotations

import numpy as np

from meshwright_core.core.arrays import (
    DEGREE,
    DESIRED,
    ELEMENT_SLOTS,
    FLAGS,
    HALF,
    ORIGIN,
    SIDES,
    TWIN,
    VERTEX_SLOTS,
    MeshArrays,
    following,
    on_boundary,
    preceding,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.history.journal import begin_step, end_step, put_point, put_vertex, set_degrees
from meshwright_core.operations.global_lines import check_cleanup
from meshwright_core.operations.refusals import ALLOWED, NEED_ROOM


def outgoing(m: MeshArrays, v: int) -> list[int]:
    """The half-edges that leave v, counter-clockwise; plain Python, for views and messages."""
    k = int(m.counters[SIDES])
    start = int(m.vertex[v, HALF])
    found: list[int] = []
    h = start
    for _ in range(int(m.vertex[v, DEGREE])):
        found.append(h)
        h = int(m.edge[h - 1 if h % k else h + k - 1, TWIN])
        if h < 0 or h == start:
            break
    return found


def neighbours(m: MeshArrays, v: int) -> list[int]:
    """The vertices joined to v, counter-clockwise; plain Python."""
    k = int(m.counters[SIDES])
    fan = outgoing(m, v)
    found = [int(m.edge[h + 1 if (h + 1) % k else h + 1 - k, ORIGIN]) for h in fan]
    last = fan[-1] - 1 if fan[-1] % k else fan[-1] + k - 1
    if m.edge[last, TWIN] < 0:
        found.append(int(m.edge[last, ORIGIN]))
    return found


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


@bare_kernel
def cleanable_at(m, v, cap):
    """A half-edge that leaves v on a line that may be cleaned up, or -1."""
    start = m.vertex[v, HALF]
    h = start
    for _ in range(m.vertex[v, DEGREE]):
        code = check_cleanup(m, h, cap)
        if code == ALLOWED or code == NEED_ROOM:
            return h
        h = m.edge[preceding(h, 4), TWIN]
        if h < 0 or h == start:
            break
    return -1


@bare_kernel
def cleanable(m, first, cap):
    """A half-edge on an open global line that may be cleaned up, or -1.

    Lines are looked for at boundary vertices with ids from `first` on: one sweep.
    """
    for v in range(first, m.counters[VERTEX_SLOTS]):
        if m.vertex[v, HALF] < 0 or m.vertex[v, DEGREE] != 3 or not on_boundary(m, v):
            continue
        h = m.edge[preceding(m.vertex[v, HALF], 4), TWIN]
        code = check_cleanup(m, h, cap)
        if code == ALLOWED or code == NEED_ROOM:
            return h
    return -1


@bare_kernel
def is_ring(m, start, seen, cap):
    """Whether `start` lies on a closed line that may be cleaned up.

    Marks the half-edges that it walks over in `seen` (uint8), and passes over marked ones.
    """
    h = start
    while m.edge[h, ORIGIN] >= 0 and not seen[h]:
        t = m.edge[h, TWIN]
        seen[h] = 1
        if t < 0:
            return False
        seen[t] = 1
        v = m.edge[t, ORIGIN]
        if m.vertex[v, DEGREE] != 4 or on_boundary(m, v):
            return False
        h = following(m.edge[following(h, 4), TWIN], 4)
        if h == start:
            code = check_cleanup(m, h, cap)
            return code == ALLOWED or code == NEED_ROOM
    return False


@kernel
def cleanable_ring(m, cap):
    """A half-edge on a closed line that may be cleaned up, or -1. Every edge is walked over
    once.
    """
    seen = np.zeros(m.counters[ELEMENT_SLOTS] * 4, np.uint8)
    for start in range(len(seen)):
        if is_ring(m, start, seen, cap):
            return start
    return -1
