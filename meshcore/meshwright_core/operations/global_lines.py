"""The clean-up of quad meshes: deleting a global line (sections 2.2 and 4.1 of the paper).

A global line is a chain of edges that goes straight through interior vertices of degree 4, none
geometric, from one non-geometric boundary vertex of degree 3 to another; or the same in a closed
ring, which the paper leaves open. Deleting it merges the elements on its two sides pairwise.

    p0 --- p1 --- p2 --- p3           p0 --- p1 --- p2 --- p3
    |      |      |      |            |      |      |      |
    v0 --- v1 --- v2 --- v3    ->     |      |      |      |
    |      |      |      |            |      |      |      |
    q0 --- q1 --- q2 --- q3           q0 --- q1 --- q2 --- q3
"""

from __future__ import annotations

import numpy as np

from meshwright_core.core.arrays import (
    BOUNDARY_EDGES,
    DEGREE,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    FLAGS,
    GEOMETRIC,
    HALF,
    LOCKED,
    MARK,
    ORIGIN,
    TWIN,
    VERTEX_SLOTS,
    constrained,
    following,
    neighbour,
    on_boundary,
    opposite,
    preceding,
    turned,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.irregularity import QUAD_INSIDE, QUAD_STRAIGHT
from meshwright_core.history.journal import (
    drop_element,
    drop_vertex,
    has_room,
    link,
    put_edge,
    put_vertex,
    touch,
)
from meshwright_core.operations.refusals import (
    ALLOWED,
    BOUNDARY_EDGE,
    LINE_CROWDED,
    LINE_DESIRED,
    LINE_LOCKED,
    LINE_ON_INTERFACE,
    MERGED_EDGES_MEET,
    NEED_ROOM,
    NOT_A_LINE,
)


@bare_kernel
def _straight_on(m, h):
    """The half-edge that continues h beyond its end, an interior vertex of degree 4."""
    return following(m.edge[following(h, 4), TWIN], 4)


@bare_kernel
def line_start(m, h):
    """The first half-edge of the line through h, on the boundary; h itself on a ring; -1 if h lies
    on no line.
    """
    if m.edge[h, TWIN] < 0:
        return -1
    # walk backward: along the twin, whose end is the origin of h
    back = m.edge[h, TWIN]
    for _ in range(m.counters[ELEMENTS] + 1):
        v = m.edge[following(back, 4), ORIGIN]
        if m.vertex[v, FLAGS] & GEOMETRIC:
            return -1
        if on_boundary(m, v):
            return m.edge[back, TWIN] if m.vertex[v, DEGREE] == 3 else -1
        if m.vertex[v, DEGREE] != 4:
            return -1
        back = _straight_on(m, back)
        if back == m.edge[h, TWIN]:
            return h
    return -1


@bare_kernel
def _length(m, start):
    """Edges of the line that begins with `start`; 0 if it ends elsewhere than on the boundary or at
    its own start.
    """
    h = start
    for count in range(1, m.counters[ELEMENTS] + 2):
        v = m.edge[m.edge[h, TWIN], ORIGIN]
        if m.vertex[v, FLAGS] & GEOMETRIC:
            return 0
        if on_boundary(m, v):
            return count if m.vertex[v, DEGREE] == 3 else 0
        if m.vertex[v, DEGREE] != 4:
            return 0
        h = _straight_on(m, h)
        if h == start:
            return count
    return 0


@bare_kernel
def _across(m, h, at_end):
    """The neighbours p and q left and right of the origin of h, or of its end."""
    t = m.edge[h, TWIN]
    if at_end:
        return (
            m.edge[opposite(h), ORIGIN],
            m.edge[preceding(t, 4), ORIGIN],
        )
    return m.edge[preceding(h, 4), ORIGIN], m.edge[opposite(t), ORIGIN]


@bare_kernel
def _doubled_edge(m, v, p, q):
    """Whether joining p and q over the line vertex v would make a second edge between them."""
    if p == q:
        return True
    h = m.vertex[p, HALF]
    for _ in range(m.vertex[p, DEGREE]):
        w = neighbour(m, h, 4)
        if w == q:
            return True
        if w != v and m.vertex[w, MARK] and _straight_across(m, w, p) == q:
            return True
        if h < 0:
            break
        h = turned(m, h, 4)
    return False


@bare_kernel
def _straight_across(m, w, p):
    """The vertex straight across the line vertex w, seen from its neighbour p; -1 if there is none.

    On the boundary (degree 3) the two boundary neighbours are across from each other.
    """
    h = m.vertex[w, HALF]
    if on_boundary(m, w):
        first = neighbour(m, h, 4)
        last = neighbour(m, turned(m, turned(m, h, 4), 4), 4)
        if p == first:
            return last
        return first if p == last else -1
    for _ in range(4):
        if neighbour(m, h, 4) == p:
            return neighbour(m, turned(m, turned(m, h, 4), 4), 4)
        h = turned(m, h, 4)
    return -1


@bare_kernel
def _check_vertex(m, h, at_end):
    v = m.edge[m.edge[h, TWIN], ORIGIN] if at_end else m.edge[h, ORIGIN]
    if m.vertex[v, FLAGS] & LOCKED:
        return LINE_LOCKED
    usual = QUAD_STRAIGHT if on_boundary(m, v) else QUAD_INSIDE
    if m.vertex[v, DESIRED] != usual:
        return LINE_DESIRED
    p, q = _across(m, h, at_end)
    return MERGED_EDGES_MEET if _doubled_edge(m, v, p, q) else ALLOWED


@bare_kernel
def _mark_line(m, start, length, sign):
    """Mark (sign 1) or unmark (sign -1) the line's vertices and flanking elements; the largest
    mark.
    """
    h = start
    most = 0
    for i in range(length):
        t = m.edge[h, TWIN]
        m.element_mark[h // 4] += sign
        m.element_mark[t // 4] += sign
        most = max(most, m.element_mark[h // 4], m.element_mark[t // 4])
        m.vertex[m.edge[h, ORIGIN], MARK] = 1 if sign > 0 else 0
        m.vertex[m.edge[t, ORIGIN], MARK] = 1 if sign > 0 else 0
        if i + 1 < length:
            h = _straight_on(m, h)
    return most


@bare_kernel
def _check_marked(m, start, length, ring):
    h = start
    for i in range(length):
        refused = _check_vertex(m, h, False)
        if refused != ALLOWED:
            return refused
        p, q = _across(m, h, False)
        if constrained(m, h, 4):
            return LINE_ON_INTERFACE
        p_end, q_end = _across(m, h, True)
        if p == q_end or q == p_end:
            return MERGED_EDGES_MEET
        if i + 1 < length:
            h = _straight_on(m, h)
    return ALLOWED if ring else _check_vertex(m, h, True)


@bare_kernel
def check_cleanup(m, h, cap):
    """A line through h whose flanking elements differ, and whose deletion doubles no edge."""
    if m.edge[h, TWIN] < 0:
        return BOUNDARY_EDGE
    start = line_start(m, h)
    if start < 0:
        return NOT_A_LINE
    length = _length(m, start)
    if length == 0:
        return NOT_A_LINE
    ring = not on_boundary(m, m.edge[start, ORIGIN])
    refused = LINE_CROWDED
    if _mark_line(m, start, length, 1) == 1:
        refused = _check_marked(m, start, length, ring)
    _mark_line(m, start, length, -1)
    if refused != ALLOWED:
        return refused
    return ALLOWED if has_room(m, 4, 0, 0, 72 * (length + 1)) else NEED_ROOM


@bare_kernel
def cleanup(m, h):
    """Delete the line through h. Open line of L edges: V-(L+1), E-(2L+1), F-L; ring: V-L, E-2L,
    F-L.

    The quads on the left of the line, seen along its first half-edge, live on with their ids; those
    on its right die. No other vertex changes its degree.
    """
    step = line_start(m, h)
    length = _length(m, step)
    ring = not on_boundary(m, m.edge[step, ORIGIN])
    for i in range(length):
        onward = _straight_on(m, step) if i + 1 < length else -1
        end = _merge_across(m, step)
        if i + 1 == length and not ring:
            drop_vertex(m, end)
            m.counters[BOUNDARY_EDGES] -= 2
        step = onward


@bare_kernel
def score_change_cleanup(m, h):
    """The change of s by :func:`cleanup`, 0: the line is regular, no other degree changes."""
    return 0


@bare_kernel
def _merge_across(m, h):
    """Merge the quads left and right of the line's edge v-w into the left one; v dies. Returns w.

    p ---- r      left: h = v-w, w-r, r-p, p-v
    |      |
    v -h-- w      right: t = w-v, v-q, q-u, u-w
    |      |
    q ---- u      merged, in the slots of the left: q-u, u-r, r-p, p-q
    """
    n, p_v, t = following(h, 4), preceding(h, 4), m.edge[h, TWIN]
    q_u, u_w = following(following(t, 4), 4), preceding(t, 4)
    v, w, r = m.edge[h, ORIGIN], m.edge[n, ORIGIN], m.edge[following(n, 4), ORIGIN]
    p, q, u = m.edge[p_v, ORIGIN], m.edge[q_u, ORIGIN], m.edge[u_w, ORIGIN]
    below = m.edge[q_u, TWIN]

    # the twins of w-r and p-v are the neighbours along the line, and stay so when these have merged
    put_edge(m, h, ORIGIN, q)
    put_edge(m, n, ORIGIN, u)
    link(m, h, below)
    if m.vertex[q, HALF] == q_u:
        put_vertex(m, q, HALF, h)
    if m.vertex[u, HALF] == u_w:
        put_vertex(m, u, HALF, n)
    drop_element(m, t, 4)
    drop_vertex(m, v)

    touch(m, p)
    touch(m, q)
    touch(m, r)
    touch(m, u)
    return w


@bare_kernel
def cleanable_at(m, v, cap):
    """A half-edge that leaves v on a line that may be cleaned up, or -1."""
    h = m.vertex[v, HALF]
    for _ in range(m.vertex[v, DEGREE]):
        code = check_cleanup(m, h, cap)
        if code == ALLOWED or code == NEED_ROOM:
            return h
        h = turned(m, h, 4)
        if h < 0:
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
        h = turned(m, m.vertex[v, HALF], 4)
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
