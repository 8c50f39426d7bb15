r"""Local edits of triangle meshes: flip, split, collapse (section 2.2 of the paper).

Each edit is a pair: ``check_*`` has no side effect and returns a code of
:mod:`meshwright_core.operations.refusals`;
the rewrite requires that the check returned ALLOWED. Letters: h runs from a to b in the triangle
(a, b, c), its twin t from b to a in the triangle (b, a, d).

            c
          /   \
        a --h-- b
          \   /
            d
"""

from __future__ import annotations

from meshwright_core.core.arrays import (
    BOUNDARY_EDGES,
    DEGREE,
    DESIRED,
    HALF,
    ORIGIN,
    TWIN,
    common_neighbours,
    constrained,
    following,
    joined,
    on_boundary,
    preceding,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.irregularity import TRIANGLE_INSIDE, TRIANGLE_STRAIGHT
from meshwright_core.history.journal import (
    add_degree,
    drop_element,
    drop_vertex,
    has_room,
    link,
    new_element,
    on_edge,
    put_edge,
    put_vertex,
    set_degrees,
    touch,
    touch_new,
)
from meshwright_core.operations.refusals import (
    ALLOWED,
    BOUNDARY_EDGE,
    DEGREE_CAP,
    DEGREE_TOO_LOW,
    ENDS_COINCIDE,
    ENDS_JOINED,
    INTERFACE_EDGE,
    LINK_CONDITION,
    NEED_ROOM,
)
from meshwright_core.operations.score_terms import degree_term, merge_term
from meshwright_core.operations.vertex_merge import (
    check_loser,
    check_pair,
    check_sides,
    hand_over,
    survivor,
)


@bare_kernel
def check_flip(m, h, cap):
    """Edge flip: interior edge, its new ends distinct and not joined, ends keep degree 3 inside."""
    t = m.edge[h, TWIN]
    if t < 0:
        return BOUNDARY_EDGE
    if constrained(m, h, 3):
        return INTERFACE_EDGE
    a, b = m.edge[h, ORIGIN], m.edge[t, ORIGIN]
    c, d = m.edge[preceding(h, 3), ORIGIN], m.edge[preceding(t, 3), ORIGIN]
    if c == d:
        return ENDS_COINCIDE
    if m.vertex[a, DEGREE] <= 3 and not on_boundary(m, a):
        return DEGREE_TOO_LOW
    if m.vertex[b, DEGREE] <= 3 and not on_boundary(m, b):
        return DEGREE_TOO_LOW
    if cap > 0 and (m.vertex[c, DEGREE] >= cap or m.vertex[d, DEGREE] >= cap):
        return DEGREE_CAP
    if joined(m, c, d, 3):
        return ENDS_JOINED
    return ALLOWED if has_room(m, 3, 0, 0, 64) else NEED_ROOM


@bare_kernel
def flip(m, h):
    r"""Turn the edge a-b counter-clockwise into d-c; V, E, F stay; h runs from d to c, all ids
    live.

            c                 c
          /   \             / | \
        a --h-- b    ->   a   h   b
          \   /             \ | /
            d                 d
    """
    n, p, t = following(h, 3), preceding(h, 3), m.edge[h, TWIN]
    tn, tp = following(t, 3), preceding(t, 3)
    a, b, c, d = m.edge[h, ORIGIN], m.edge[t, ORIGIN], m.edge[p, ORIGIN], m.edge[tp, ORIGIN]
    bc, ca, ad, db = m.edge[n, TWIN], m.edge[p, TWIN], m.edge[tn, TWIN], m.edge[tp, TWIN]

    put_edge(m, h, ORIGIN, d)
    put_edge(m, n, ORIGIN, c)
    put_edge(m, p, ORIGIN, a)
    put_edge(m, t, ORIGIN, c)
    put_edge(m, tn, ORIGIN, d)
    put_edge(m, tp, ORIGIN, b)
    link(m, n, ca)
    link(m, p, ad)
    link(m, tn, db)
    link(m, tp, bc)
    if m.vertex[a, HALF] == h or m.vertex[a, HALF] == tn:
        put_vertex(m, a, HALF, p)
    if m.vertex[b, HALF] == t or m.vertex[b, HALF] == n:
        put_vertex(m, b, HALF, tp)
    if m.vertex[c, HALF] == p:
        put_vertex(m, c, HALF, n)
    if m.vertex[d, HALF] == tp:
        put_vertex(m, d, HALF, tn)

    add_degree(m, a, -1)
    add_degree(m, b, -1)
    add_degree(m, c, 1)
    add_degree(m, d, 1)
    touch(m, a)
    touch(m, b)
    touch(m, c)
    touch(m, d)


@bare_kernel
def score_change_flip(m, h):
    """The change of s by :func:`flip`: the ends lose an edge, the apexes gain one."""
    t = m.edge[h, TWIN]
    a, b = m.edge[h, ORIGIN], m.edge[t, ORIGIN]
    c, d = m.edge[preceding(h, 3), ORIGIN], m.edge[preceding(t, 3), ORIGIN]
    return (
        degree_term(m, a, -1) + degree_term(m, b, -1) + degree_term(m, c, 1) + degree_term(m, d, 1)
    )


@bare_kernel
def check_split(m, h, cap):
    """Edge split: always possible, on the boundary too."""
    if cap > 0:
        if m.vertex[m.edge[preceding(h, 3), ORIGIN], DEGREE] >= cap:
            return DEGREE_CAP
        t = m.edge[h, TWIN]
        if t >= 0 and m.vertex[m.edge[preceding(t, 3), ORIGIN], DEGREE] >= cap:
            return DEGREE_CAP
    return ALLOWED if has_room(m, 3, 1, 2, 96) else NEED_ROOM


@bare_kernel
def split(m, h):
    r"""Put a vertex v on the edge a-b. Inside: V+1, E+3, F+2; on the boundary: V+1, E+2, F+1.

            c                 c
          /   \             / | \
        a --h-- b    ->   a-h-v---b        h then runs from a to v; all old ids live.
          \   /             \ | /
            d                 d
    """
    n, p, t = following(h, 3), preceding(h, 3), m.edge[h, TWIN]
    a, b, c = m.edge[h, ORIGIN], m.edge[n, ORIGIN], m.edge[p, ORIGIN]
    bc = m.edge[n, TWIN]

    inside = t >= 0
    v = on_edge(m, h, 4 if inside else 3, TRIANGLE_INSIDE if inside else TRIANGLE_STRAIGHT, 3)
    x = new_element(m, m.region[h // 3], 3)  # (v, b, c)
    put_edge(m, n, ORIGIN, v)
    put_edge(m, x, ORIGIN, v)
    put_edge(m, x + 1, ORIGIN, b)
    put_edge(m, x + 2, ORIGIN, c)
    link(m, n, x + 2)
    link(m, x + 1, bc)
    put_vertex(m, v, HALF, x)
    if m.vertex[b, HALF] == n:
        put_vertex(m, b, HALF, x + 1)
    if not inside:
        put_edge(m, x, TWIN, -1)
        m.counters[BOUNDARY_EDGES] += 1
        add_degree(m, c, 1)
        touch_new(m, v)
        touch(m, a)
        touch(m, b)
        touch(m, c)
        return

    tp = preceding(t, 3)
    d, db = m.edge[tp, ORIGIN], m.edge[tp, TWIN]
    y = new_element(m, m.region[t // 3], 3)  # (b, v, d)
    put_edge(m, t, ORIGIN, v)
    put_edge(m, y, ORIGIN, b)
    put_edge(m, y + 1, ORIGIN, v)
    put_edge(m, y + 2, ORIGIN, d)
    link(m, x, y)
    link(m, tp, y + 1)
    link(m, y + 2, db)
    if m.vertex[b, HALF] == t:
        put_vertex(m, b, HALF, y)
    if m.vertex[d, HALF] == tp:
        put_vertex(m, d, HALF, y + 2)
    add_degree(m, c, 1)
    add_degree(m, d, 1)
    touch_new(m, v)
    touch(m, a)
    touch(m, b)
    touch(m, c)
    touch(m, d)


@bare_kernel
def score_change_split(m, h):
    """The change of s by :func:`split`: v has Delta -2 inside, -1 on the boundary."""
    t = m.edge[h, TWIN]
    change = degree_term(m, m.edge[preceding(h, 3), ORIGIN], 1)
    if t < 0:
        return 1 + change
    return 2 + change + degree_term(m, m.edge[preceding(t, 3), ORIGIN], 1)


@bare_kernel
def check_collapse(m, h, cap):
    """Edge collapse: the link condition, one end at most on a curve, the loser unprotected.

    An edge on the boundary or an interface may be collapsed too (beyond the paper) when one end is
    not geometric, and no third vertex of its triangles lies between the ends on curves.
    """
    n, p, t = following(h, 3), preceding(h, 3), m.edge[h, TWIN]
    a, b, c = m.edge[h, ORIGIN], m.edge[n, ORIGIN], m.edge[p, ORIGIN]
    winner = survivor(m, a, b, 3)
    loser = a + b - winner
    if t < 0:
        refused = check_loser(m, loser, TRIANGLE_STRAIGHT)
    else:
        refused = check_pair(m, h, a, b, loser, 3)
        if refused == ALLOWED:
            refused = check_loser(m, loser, TRIANGLE_INSIDE)
    if refused != ALLOWED:
        return refused
    refused = check_sides(m, n, p, 3)
    if refused != ALLOWED:
        return refused
    if m.vertex[c, DEGREE] <= 3 and not on_boundary(m, c):
        return DEGREE_TOO_LOW
    merged = m.vertex[a, DEGREE] + m.vertex[b, DEGREE] - 3
    if t >= 0:
        tn, tp = following(t, 3), preceding(t, 3)
        d = m.edge[tp, ORIGIN]
        refused = check_sides(m, tn, tp, 3)
        if refused != ALLOWED:
            return refused
        if m.vertex[d, DEGREE] <= 3 and not on_boundary(m, d):
            return DEGREE_TOO_LOW
        merged -= 1
    if cap > 0 and merged > cap:
        return DEGREE_CAP
    if common_neighbours(m, a, b, 3) != (1 if t < 0 else 2):
        return LINK_CONDITION
    return ALLOWED if has_room(m, 3, 0, 0, 96 + 2 * m.vertex[loser, DEGREE]) else NEED_ROOM


@bare_kernel
def collapse(m, h):
    r"""Merge a and b. Inside: V-1, E-3, F-2; a boundary edge: V-1, E-2, F-1.

    The survivor (see :func:`survivor`) keeps its place, id, desired degree and flags. The elements
    at the edge die with their half-edges, h among them.

            c                 c
          /   \               |
        a --h-- b    ->       w
          \   /               |
            d                 d
    """
    n, p, t = following(h, 3), preceding(h, 3), m.edge[h, TWIN]
    a, b, c = m.edge[h, ORIGIN], m.edge[n, ORIGIN], m.edge[p, ORIGIN]
    bc, ca = m.edge[n, TWIN], m.edge[p, TWIN]
    winner = survivor(m, a, b, 3)
    loser = a + b - winner
    degree = m.vertex[a, DEGREE] + m.vertex[b, DEGREE] - 3

    # an outgoing half-edge of the winner that lives on, the one without twin on the boundary
    if t < 0:
        half = ca if m.vertex[b, HALF] == n else m.vertex[b, HALF]
    else:
        half = m.vertex[winner, HALF]
        tn, tp = following(t, 3), preceding(t, 3)
        d, ad, db = m.edge[tp, ORIGIN], m.edge[tn, TWIN], m.edge[tp, TWIN]
        if half == tn:
            half = db
        elif half == h or half == t or half == n:
            half = ca

    hand_over(m, loser, winner, 3)
    link(m, bc, ca)
    if m.vertex[c, HALF] == p:
        put_vertex(m, c, HALF, bc)
    drop_element(m, h, 3)
    if t >= 0:
        link(m, ad, db)
        if m.vertex[d, HALF] == tp:
            put_vertex(m, d, HALF, ad)
        drop_element(m, t, 3)
    if m.vertex[winner, HALF] != half:
        put_vertex(m, winner, HALF, half)
    drop_vertex(m, loser)

    if t >= 0:
        degree -= 1
        add_degree(m, d, -1)
    else:
        m.counters[BOUNDARY_EDGES] -= 1
    add_degree(m, c, -1)
    set_degrees(m, winner, degree, m.vertex[winner, DESIRED])
    touch(m, winner)
    touch(m, c)
    if t >= 0:
        touch(m, d)


@bare_kernel
def score_change_collapse(m, h):
    """The change of s by :func:`collapse`: a and b become one vertex, each apex loses an edge."""
    t = m.edge[h, TWIN]
    a, b = m.edge[h, ORIGIN], m.edge[following(h, 3), ORIGIN]
    change = degree_term(m, m.edge[preceding(h, 3), ORIGIN], -1)
    if t < 0:
        return merge_term(m, a, b, 3, 3) + change
    d = m.edge[preceding(t, 3), ORIGIN]
    return merge_term(m, a, b, 4, 3) + change + degree_term(m, d, -1)
