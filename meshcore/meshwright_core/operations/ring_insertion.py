"""The insertion of a ring: a layer of quads between a closed loop of edges and its elements.

Beyond the paper: the global split that closes around a hole. The loop is a boundary loop, whatever
corners it has, or one side of an interface that closes without a junction. Every vertex of the loop
stays where it is, and hands the edges on the side of the new layer to a new vertex beside it:

    u0    u1    u2             u0    u1    u2
    |     |     |              |     |     |
    |     |     |              w0 -- w1 -- w2        w: new vertices
    |     |     |              |     |     |
    v0 -- v1 -- v2     ->      v0 -- v1 -- v2        v: the loop, the layer's side above it

So on a smooth boundary all irregularities of the loop move to the new vertices, and s stays as it
is. A corner keeps 3 edges, whatever its desired degree: where that is another number, s changes.
"""

from __future__ import annotations

from meshwright_core.core.arrays import (
    DEGREE,
    DESIRED,
    ELEMENTS,
    HALF,
    ORIGIN,
    START,
    TRACE_IDS,
    TWIN,
    constrained,
    following,
    neighbour,
    opposite,
    preceding,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.curve_edges import edge_curve
from meshwright_core.core.irregularity import QUAD_INSIDE
from meshwright_core.history.journal import (
    add_degree,
    has_room,
    link,
    new_element,
    new_vertex,
    on_edge_at,
    put_edge,
    put_vertex,
    touch,
    touch_new,
)
from meshwright_core.operations.refusals import (
    ALLOWED,
    DEGREE_CAP,
    INTERFACES_AT_LOOP,
    LOOP_NOT_CLOSED,
    NEED_ROOM,
    NO_LOOP,
)

_SHARE = 1.0 / 3.0
"""Where the new vertices are put, from the loop to the next vertices: edges from the loop to itself
get two of them."""


@bare_kernel
def _on_loop(m, g, outer):
    """Whether the edge of g belongs to the loop, or to another one that it meets."""
    return m.edge[g, TWIN] < 0 if outer else constrained(m, g, 4)


@bare_kernel
def _onward(m, h, outer):
    """The next half-edge of the loop after h, on the same side; -1 if there is none."""
    g = following(h, 4)
    for _ in range(m.counters[ELEMENTS] + 1):
        if _on_loop(m, g, outer):
            return g
        t = m.edge[g, TWIN]
        if t < 0:
            return -1
        g = following(t, 4)
    return -1


@bare_kernel
def loop_length(m, h):
    """Edges of the boundary loop, or of the closed interface, of h; 0 if h is on none."""
    outer = m.edge[h, TWIN] < 0
    g = h
    for count in range(1, 4 * m.counters[ELEMENTS] + 1):
        g = _onward(m, g, outer)
        if g == h:
            return count
        if g < 0:
            return 0
    return 0


@bare_kernel
def _fan(m, h, outer):
    """The elements at the origin of h on the side of the loop: how many, how many interfaces run
    between them, and the half-edge along the last of these, -1 if there is none.
    """
    count, interfaces, along = 1, 0, -1
    g = h
    for _ in range(m.vertex[m.edge[h, ORIGIN], DEGREE]):
        back = preceding(g, 4)
        if _on_loop(m, back, outer):
            break
        g = m.edge[back, TWIN]
        if constrained(m, g, 4):
            interfaces += 1
            along = g
        count += 1
    return count, interfaces, along


@bare_kernel
def check_insert_ring(m, h, cap):
    """h lies on a boundary loop or on a closed interface, and no two interfaces meet in a vertex of
    the loop.
    """
    outer = m.edge[h, TWIN] < 0
    if not outer:
        if not constrained(m, h, 4):
            return NO_LOOP
        curve = edge_curve(m, h, 4)
        if curve < 0 or m.interface[curve, START] >= 0:
            return LOOP_NOT_CLOSED
    length = loop_length(m, h)
    if length == 0:
        return LOOP_NOT_CLOSED
    elements = 0
    g = h
    for _ in range(length):
        count, interfaces, _ = _fan(m, g, outer)
        if interfaces > 1:
            return INTERFACES_AT_LOOP
        kept = m.vertex[m.edge[g, ORIGIN], DEGREE] + 2 - count
        if cap > 0 and max(count + 2, kept) > cap:
            return DEGREE_CAP
        elements += count
        g = _onward(m, g, outer)
    return ALLOWED if has_room(m, 4, length, length, 64 * length + elements) else NEED_ROOM


@bare_kernel
def _beside(m, h, outer):
    """The new vertex beside the origin of h, with the degree that it will have."""
    count, interfaces, along = _fan(m, h, outer)
    if interfaces:
        return on_edge_at(m, along, _SHARE, count + 2, QUAD_INSIDE, 4)
    v = m.edge[h, ORIGIN]
    x, y, z = 0.0, 0.0, 0.0
    g = h
    for _ in range(count - 1):
        g = m.edge[preceding(g, 4), TWIN]
        u = neighbour(m, g, 4)
        x += m.points[u, 0]
        y += m.points[u, 1]
        z += m.points[u, 2]
    ends = max(count - 1, 1)
    if count == 1:
        u = m.edge[opposite(h), ORIGIN]
        x, y, z = m.points[u, 0], m.points[u, 1], m.points[u, 2]
    keep, share = 1.0 - _SHARE, _SHARE / ends
    return new_vertex(
        m,
        count + 2,
        QUAD_INSIDE,
        keep * m.points[v, 0] + share * x,
        keep * m.points[v, 1] + share * y,
        keep * m.points[v, 2] + share * z,
    )


@bare_kernel
def insert_ring(m, h):
    """Insert a layer of L quads along the loop of h, which has L edges: V+L, E+2L, F+L.

    All old ids live; the loop's vertices keep place, curve, flags and desired degree. h then runs
    from w0 to w1.
    """
    outer = m.edge[h, TWIN] < 0
    length = loop_length(m, h)
    w, v = TRACE_IDS, TRACE_IDS + length  # the trace holds the new vertices, then the loop's

    g = h
    for _ in range(length):
        touch_new(m, _beside(m, g, outer))
        g = _onward(m, g, outer)
    for _ in range(length):
        touch(m, m.edge[g, ORIGIN])
        g = _onward(m, g, outer)

    for i in range(length):
        onward = _onward(m, g, outer)
        count, _, _ = _fan(m, g, outer)
        add_degree(m, m.trace[v + i], 2 - count)
        put_vertex(m, m.trace[w + i], HALF, g)
        for _ in range(count):
            put_edge(m, g, ORIGIN, m.trace[w + i])
            g = m.edge[preceding(g, 4), TWIN]
        g = onward

    first, before = -1, -1
    for i in range(length):
        onward = _onward(m, g, outer) if i + 1 < length else h
        j = i + 1 if i + 1 < length else 0
        q = new_element(m, m.region[g // 4], 4)  # (v_i, v_j, w_j, w_i)
        put_edge(m, q, ORIGIN, m.trace[v + i])
        put_edge(m, q + 1, ORIGIN, m.trace[v + j])
        put_edge(m, q + 2, ORIGIN, m.trace[w + j])
        put_edge(m, q + 3, ORIGIN, m.trace[w + i])
        link(m, q, m.edge[g, TWIN])
        link(m, q + 2, g)
        if i == 0:
            first = q
        else:
            link(m, q + 3, before + 1)
        put_vertex(m, m.trace[v + i], HALF, q)
        before = q
        g = onward
    link(m, first + 3, before + 1)


@bare_kernel
def score_change_insert_ring(m, h):
    """The change of s by :func:`insert_ring`, 0 where the loop is smooth: O(length of the loop)."""
    outer = m.edge[h, TWIN] < 0
    change = 0
    g = h
    for _ in range(loop_length(m, h)):
        count, _, _ = _fan(m, g, outer)
        v = m.edge[g, ORIGIN]
        delta = m.vertex[v, DEGREE] - m.vertex[v, DESIRED]
        change += abs(delta + 2 - count) - abs(delta) + abs(count + 2 - QUAD_INSIDE)
        g = _onward(m, g, outer)
    return change
