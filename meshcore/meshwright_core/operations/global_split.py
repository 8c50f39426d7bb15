"""The global split of quad meshes (sections 2.2 and 4.1 of the paper).

The edge a-b opens into a quad; the two hanging vertices that this leaves are carried straight
through quad after quad, each cut in two, until the boundary.

A walk straight through quads is reversible, so it can meet an edge that was split already only by
coming back into one of the two quads beside the edge a-b. It may cross a quad a second time, the
other way: the two cuts then cross in a new regular vertex.
"""

from __future__ import annotations

from meshwright_core.core.arrays import (
    BOUNDARY_EDGES,
    DEGREE,
    ELEMENTS,
    HALF,
    ORIGIN,
    TWIN,
    constrained,
    following,
    opposite,
    preceding,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.irregularity import QUAD_INSIDE, QUAD_STRAIGHT
from meshwright_core.history.journal import (
    add_degree,
    has_room,
    link,
    new_element,
    on_edge,
    put_edge,
    put_vertex,
    touch,
    touch_new,
)
from meshwright_core.operations.refusals import (
    ALLOWED,
    BOUNDARY_EDGE,
    DEGREE_CAP,
    DEGREE_TOO_LOW,
    INTERFACE_EDGE,
    NEED_ROOM,
    NEVER_ENDS,
    SPLITS_AGAIN,
)
from meshwright_core.operations.score_terms import degree_term


@bare_kernel
def crossings(m, entry, h, limit):
    """How many quads a walk crosses that enters through `entry`; -1 if it meets a quad beside h, -2
    if they are more than `limit`.
    """
    e, f = h // 4, m.edge[h, TWIN] // 4
    count = 0
    while entry >= 0:
        if entry // 4 == e or entry // 4 == f:
            return -1
        count += 1
        if count > limit:
            return -2
        entry = m.edge[opposite(entry), TWIN]
    return count


@bare_kernel
def check_global_split(m, h, cap):
    """Interior edge, b keeps enough edges, and both hanging vertices reach the boundary."""
    t = m.edge[h, TWIN]
    if t < 0:
        return BOUNDARY_EDGE
    if constrained(m, h, 4):
        return INTERFACE_EDGE
    if m.vertex[m.edge[t, ORIGIN], DEGREE] <= 2:
        return DEGREE_TOO_LOW
    if cap > 0 and m.vertex[m.edge[h, ORIGIN], DEGREE] >= cap:
        return DEGREE_CAP
    limit = 2 * m.counters[ELEMENTS]
    first = crossings(m, m.edge[following(h, 4), TWIN], h, limit)
    second = crossings(m, m.edge[preceding(t, 4), TWIN], h, limit)
    if first == -1 or second == -1:
        return SPLITS_AGAIN
    if first == -2 or second == -2:
        return NEVER_ENDS
    # where the cuts cross, a quad is met twice and the second cut makes two new quads
    cuts = 2 * (first + second) + 3
    return ALLOWED if has_room(m, 4, cuts, cuts, 96 * cuts) else NEED_ROOM


@bare_kernel
def cut(m, entry, v, before, after):
    """Cut the quad entered through `entry`, whose edge x-y the vertex v halves, and continue.

    before, after: the half-edges y-v and v-x on the other side of that edge. Returns the half-edge
    through which the cut enters the next quad (-1 on the boundary), the vertex put on the far edge
    and the two halves of that edge on this side.

    w --m-- z
    |   |   |
    |   |   |
    x --v-- y    `entry` runs from x to y
    """
    n, o = following(entry, 4), opposite(entry)
    y, z = m.edge[n, ORIGIN], m.edge[o, ORIGIN]
    yz, zw = m.edge[n, TWIN], m.edge[o, TWIN]

    inside = zw >= 0
    far = on_edge(m, o, 3, QUAD_INSIDE if inside else QUAD_STRAIGHT, 4)
    q = new_element(
        m, m.region[entry // 4], 4
    )  # (v, y, z, far); the quad of `entry` keeps (x, v, far, w)
    put_edge(m, n, ORIGIN, v)
    put_edge(m, o, ORIGIN, far)
    put_edge(m, q, ORIGIN, v)
    put_edge(m, q + 1, ORIGIN, y)
    put_edge(m, q + 2, ORIGIN, z)
    put_edge(m, q + 3, ORIGIN, far)
    link(m, entry, after)
    link(m, q, before)
    link(m, q + 1, yz)
    link(m, n, q + 3)
    put_edge(m, q + 2, TWIN, -1)
    put_edge(m, o, TWIN, -1)
    if m.vertex[y, HALF] == n:
        put_vertex(m, y, HALF, q + 1)
    if m.vertex[z, HALF] == o:
        put_vertex(m, z, HALF, q + 2)
    put_vertex(m, far, HALF, o)
    if not inside:
        m.counters[BOUNDARY_EDGES] += 1
    add_degree(m, v, 1)
    touch_new(m, far)
    return zw, far, q + 2, o


@bare_kernel
def carry(m, entry, v, before, after):
    """Carry the hanging vertex v straight on until the boundary."""
    while entry >= 0:
        entry, v, before, after = cut(m, entry, v, before, after)


@bare_kernel
def global_split(m, h):
    """Open the edge a-b into the quad (a, n2, b, n1) and carry n1 and n2 to the boundary.

    a gains an edge, b loses one; all new vertices are regular; V+L, E+2L-1, F+L-1 for L new
    vertices. All old ids live; h then runs from a to n1.

    d ----- c         d ----- c
    |       |         |     n1  ...
    a --h-- b    ->   a <    > b
    |       |         |     n2  ...
    f ----- g         f ----- g
    """
    n, t = following(h, 4), m.edge[h, TWIN]
    tp = preceding(t, 4)
    a, b, c = m.edge[h, ORIGIN], m.edge[n, ORIGIN], m.edge[following(n, 4), ORIGIN]
    g = m.edge[tp, ORIGIN]
    bc, gb = m.edge[n, TWIN], m.edge[tp, TWIN]

    # the degree of a hanging vertex counts the cut that will leave it, added by cut
    n1 = on_edge(m, n, 3, QUAD_INSIDE if bc >= 0 else QUAD_STRAIGHT, 4)
    touch_new(m, n1)
    n2 = on_edge(m, tp, 3, QUAD_INSIDE if gb >= 0 else QUAD_STRAIGHT, 4)
    touch_new(m, n2)
    q = new_element(m, m.region[h // 4], 4)  # (a, n2, b, n1)
    put_edge(m, n, ORIGIN, n1)
    put_edge(m, t, ORIGIN, n2)
    put_edge(m, q, ORIGIN, a)
    put_edge(m, q + 1, ORIGIN, n2)
    put_edge(m, q + 2, ORIGIN, b)
    put_edge(m, q + 3, ORIGIN, n1)
    link(m, h, q + 3)
    link(m, t, q)
    put_edge(m, q + 1, TWIN, -1)
    put_edge(m, q + 2, TWIN, -1)
    put_edge(m, n, TWIN, -1)
    put_vertex(m, n1, HALF, n)
    put_vertex(m, n2, HALF, q + 1)
    if m.vertex[b, HALF] == n or m.vertex[b, HALF] == t:
        put_vertex(m, b, HALF, q + 2)
    if bc < 0:
        m.counters[BOUNDARY_EDGES] += 1
    if gb < 0:
        m.counters[BOUNDARY_EDGES] += 1
    add_degree(m, a, 1)
    add_degree(m, b, -1)
    carry(m, bc, n1, q + 2, n)
    # the first cut may have crossed the quad that the second one enters
    carry(m, m.edge[tp, TWIN], n2, tp, q + 1)
    touch(m, a)
    touch(m, b)
    touch(m, c)
    touch(m, g)


@bare_kernel
def score_change_global_split(m, h):
    """The change of s by :func:`global_split`: a gains an edge, b loses one."""
    a, b = m.edge[h, ORIGIN], m.edge[following(h, 4), ORIGIN]
    return degree_term(m, a, 1) + degree_term(m, b, -1)
