"""Local edits of quad meshes: flips, vertex split, element collapse (section 2.2 of the paper).

Each edit is a pair, as in :mod:`meshwright_core.operations.triangle_edits`. Letters: h runs from a
to b in the quad (a, b, c, d), its twin t from b to a in the quad (b, a, f, g).

        d ----- c
        |       |
        a --h-- b
        |       |
        f ----- g
"""

from __future__ import annotations

from meshwright_core.core.arrays import (
    DEGREE,
    DESIRED,
    HALF,
    ORIGIN,
    TWIN,
    common_neighbours,
    constrained,
    following,
    joined,
    opposite,
    preceding,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.irregularity import QUAD_INSIDE
from meshwright_core.history.journal import (
    add_degree,
    drop_element,
    drop_vertex,
    has_room,
    link,
    midway,
    new_element,
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
    NO_ELEMENT_LEFT,
)
from meshwright_core.operations.score_terms import degree_term, merge_term
from meshwright_core.operations.vertex_merge import check_loser, check_pair, hand_over, survivor


@bare_kernel
def _check_turn(m, h, x, y, cap):
    """Whether the edge of h may be turned to join x and y."""
    a, b = m.edge[h, ORIGIN], m.edge[following(h, 4), ORIGIN]
    if x == y:
        return ENDS_COINCIDE
    if m.vertex[a, DEGREE] <= 2 or m.vertex[b, DEGREE] <= 2:
        return DEGREE_TOO_LOW
    if cap > 0 and (m.vertex[x, DEGREE] >= cap or m.vertex[y, DEGREE] >= cap):
        return DEGREE_CAP
    if joined(m, x, y, 4):
        return ENDS_JOINED
    return ALLOWED if has_room(m, 4, 0, 0, 80) else NEED_ROOM


@bare_kernel
def check_flip_left(m, h, cap):
    """Flip counter-clockwise: interior edge, f and c distinct and not joined."""
    t = m.edge[h, TWIN]
    if t < 0:
        return BOUNDARY_EDGE
    if constrained(m, h, 4):
        return INTERFACE_EDGE
    f, c = m.edge[opposite(t), ORIGIN], m.edge[opposite(h), ORIGIN]
    return _check_turn(m, h, f, c, cap)


@bare_kernel
def check_flip_right(m, h, cap):
    """Flip clockwise: interior edge, d and g distinct and not joined."""
    t = m.edge[h, TWIN]
    if t < 0:
        return BOUNDARY_EDGE
    if constrained(m, h, 4):
        return INTERFACE_EDGE
    d, g = m.edge[preceding(h, 4), ORIGIN], m.edge[preceding(t, 4), ORIGIN]
    return _check_turn(m, h, d, g, cap)


@bare_kernel
def _halfedges(m, h):
    """The other half-edges of the two quads at h: three of its own, its twin, three of the
    twin's.
    """
    n, p, t = following(h, 4), preceding(h, 4), m.edge[h, TWIN]
    tn = following(t, 4)
    return n, following(n, 4), p, t, tn, following(tn, 4), preceding(t, 4)


@bare_kernel
def _corners(m, h, n, o, p, to, tp):
    """The six vertices a, b, c, d, f, g of the two quads at h."""
    edge = m.edge
    return (
        edge[h, ORIGIN],
        edge[n, ORIGIN],
        edge[o, ORIGIN],
        edge[p, ORIGIN],
        edge[to, ORIGIN],
        edge[tp, ORIGIN],
    )


@bare_kernel
def flip_left(m, h):
    """Turn the edge a-b counter-clockwise into f-c; V, E, F stay; h runs from f to c, all ids live.

    d ----- c         d ----- c
    |       |         |     / |
    a --h-- b    ->   a   h   b
    |       |         | /     |
    f ----- g         f ----- g
    """
    n, o, p, t, tn, to, tp = _halfedges(m, h)
    a, b, c, d, f, g = _corners(m, h, n, o, p, to, tp)
    bc, cd, da = m.edge[n, TWIN], m.edge[o, TWIN], m.edge[p, TWIN]
    af, fg, gb = m.edge[tn, TWIN], m.edge[to, TWIN], m.edge[tp, TWIN]

    put_edge(m, h, ORIGIN, f)  # (f, c, d, a)
    put_edge(m, n, ORIGIN, c)
    put_edge(m, o, ORIGIN, d)
    put_edge(m, p, ORIGIN, a)
    put_edge(m, t, ORIGIN, c)  # (c, f, g, b)
    put_edge(m, tn, ORIGIN, f)
    put_edge(m, to, ORIGIN, g)
    put_edge(m, tp, ORIGIN, b)
    link(m, n, cd)
    link(m, o, da)
    link(m, p, af)
    link(m, tn, fg)
    link(m, to, gb)
    link(m, tp, bc)
    if m.vertex[a, HALF] == h or m.vertex[a, HALF] == tn:
        put_vertex(m, a, HALF, p)
    if m.vertex[b, HALF] == t or m.vertex[b, HALF] == n:
        put_vertex(m, b, HALF, tp)
    if m.vertex[c, HALF] == o:
        put_vertex(m, c, HALF, n)
    if m.vertex[d, HALF] == p:
        put_vertex(m, d, HALF, o)
    if m.vertex[f, HALF] == to:
        put_vertex(m, f, HALF, tn)
    if m.vertex[g, HALF] == tp:
        put_vertex(m, g, HALF, to)

    _turned(m, a, b, c, d, f, g)
    add_degree(m, f, 1)
    add_degree(m, c, 1)


@bare_kernel
def score_change_flip_left(m, h):
    """The change of s by :func:`flip_left`: the edge a-b goes, f-c comes."""
    f, c = m.edge[opposite(m.edge[h, TWIN]), ORIGIN], m.edge[opposite(h), ORIGIN]
    return _score_change_turn(m, h, f, c)


@bare_kernel
def flip_right(m, h):
    r"""Turn the edge a-b clockwise into d-g; V, E, F stay; h runs from d to g, all ids live.

    d ----- c         d ----- c
    |       |         | \     |
    a --h-- b    ->   a   h   b
    |       |         |     \ |
    f ----- g         f ----- g
    """
    n, o, p, t, tn, to, tp = _halfedges(m, h)
    a, b, c, d, f, g = _corners(m, h, n, o, p, to, tp)
    bc, cd, da = m.edge[n, TWIN], m.edge[o, TWIN], m.edge[p, TWIN]
    af, fg, gb = m.edge[tn, TWIN], m.edge[to, TWIN], m.edge[tp, TWIN]

    put_edge(m, h, ORIGIN, d)  # (d, g, b, c)
    put_edge(m, n, ORIGIN, g)
    put_edge(m, o, ORIGIN, b)
    put_edge(m, p, ORIGIN, c)
    put_edge(m, t, ORIGIN, g)  # (g, d, a, f)
    put_edge(m, tn, ORIGIN, d)
    put_edge(m, to, ORIGIN, a)
    put_edge(m, tp, ORIGIN, f)
    link(m, n, gb)
    link(m, o, bc)
    link(m, p, cd)
    link(m, tn, da)
    link(m, to, af)
    link(m, tp, fg)
    if m.vertex[a, HALF] == h or m.vertex[a, HALF] == tn:
        put_vertex(m, a, HALF, to)
    if m.vertex[b, HALF] == t or m.vertex[b, HALF] == n:
        put_vertex(m, b, HALF, o)
    if m.vertex[c, HALF] == o:
        put_vertex(m, c, HALF, p)
    if m.vertex[d, HALF] == p:
        put_vertex(m, d, HALF, tn)
    if m.vertex[f, HALF] == to:
        put_vertex(m, f, HALF, tp)
    if m.vertex[g, HALF] == tp:
        put_vertex(m, g, HALF, n)

    _turned(m, a, b, c, d, f, g)
    add_degree(m, d, 1)
    add_degree(m, g, 1)


@bare_kernel
def score_change_flip_right(m, h):
    """The change of s by :func:`flip_right`: the edge a-b goes, d-g comes."""
    d, g = m.edge[preceding(h, 4), ORIGIN], m.edge[preceding(m.edge[h, TWIN], 4), ORIGIN]
    return _score_change_turn(m, h, d, g)


@bare_kernel
def _score_change_turn(m, h, x, y):
    a, b = m.edge[h, ORIGIN], m.edge[following(h, 4), ORIGIN]
    return (
        degree_term(m, a, -1) + degree_term(m, b, -1) + degree_term(m, x, 1) + degree_term(m, y, 1)
    )


@bare_kernel
def _turned(m, a, b, c, d, f, g):
    add_degree(m, a, -1)
    add_degree(m, b, -1)
    touch(m, a)
    touch(m, b)
    touch(m, c)
    touch(m, d)
    touch(m, f)
    touch(m, g)


@bare_kernel
def check_split(m, h, cap):
    """Vertex split of a along h: h inside, a keeps degree 2 or more."""
    t = m.edge[h, TWIN]
    if t < 0:
        return BOUNDARY_EDGE
    if constrained(m, h, 4):
        return INTERFACE_EDGE
    if m.vertex[m.edge[h, ORIGIN], DEGREE] <= 2:
        return DEGREE_TOO_LOW
    if cap > 0:
        d, f = m.edge[preceding(h, 4), ORIGIN], m.edge[opposite(t), ORIGIN]
        if m.vertex[d, DEGREE] >= cap or m.vertex[f, DEGREE] >= cap:
            return DEGREE_CAP
    return ALLOWED if has_room(m, 4, 1, 1, 80) else NEED_ROOM


@bare_kernel
def split(m, h):
    r"""Split a along h: a new vertex v takes over the edge to b, and a quad (v, d, a, f) opens.

    V+1, E+2, F+1; h then runs from v to b; all old ids live.

    d ----- c         d ----- c
    |       |         | \     |
    a --h-- b    ->   a   v-h-b
    |       |         | /     |
    f ----- g         f ----- g
    """
    p, t = preceding(h, 4), m.edge[h, TWIN]
    tn = following(t, 4)
    a, b, d = m.edge[h, ORIGIN], m.edge[t, ORIGIN], m.edge[p, ORIGIN]
    f = m.edge[following(tn, 4), ORIGIN]
    da, af = m.edge[p, TWIN], m.edge[tn, TWIN]

    v = midway(m, a, b, 3, QUAD_INSIDE)
    q = new_element(m, m.region[h // 4], 4)
    put_edge(m, h, ORIGIN, v)
    put_edge(m, tn, ORIGIN, v)
    put_edge(m, q, ORIGIN, v)
    put_edge(m, q + 1, ORIGIN, d)
    put_edge(m, q + 2, ORIGIN, a)
    put_edge(m, q + 3, ORIGIN, f)
    link(m, p, q)
    link(m, q + 1, da)
    link(m, q + 2, af)
    link(m, q + 3, tn)
    put_vertex(m, v, HALF, h)
    if m.vertex[a, HALF] == h or m.vertex[a, HALF] == tn:
        put_vertex(m, a, HALF, q + 2)
    if m.vertex[d, HALF] == p:
        put_vertex(m, d, HALF, q + 1)

    add_degree(m, a, -1)
    add_degree(m, d, 1)
    add_degree(m, f, 1)
    touch_new(m, v)
    touch(m, a)
    touch(m, b)
    touch(m, d)
    touch(m, f)


@bare_kernel
def score_change_split(m, h):
    """The change of s by :func:`split`: v has Delta -1, a loses an edge, d and f gain one."""
    a, d = m.edge[h, ORIGIN], m.edge[preceding(h, 4), ORIGIN]
    f = m.edge[opposite(m.edge[h, TWIN]), ORIGIN]
    return 1 + degree_term(m, a, -1) + degree_term(m, d, 1) + degree_term(m, f, 1)


@bare_kernel
def check_collapse(m, h, cap):
    """Element collapse: a and c merge. Not both on curves, not joined, only b and d in
    common; b and d keep enough edges; the loser unprotected.
    """
    n, p = following(h, 4), preceding(h, 4)
    o = following(n, 4)
    a, b, c, d = m.edge[h, ORIGIN], m.edge[n, ORIGIN], m.edge[o, ORIGIN], m.edge[p, ORIGIN]
    winner = survivor(m, a, c, 4)
    loser = a + c - winner
    refused = check_pair(m, -1, a, c, loser, 4)
    if refused != ALLOWED:
        return refused
    refused = check_loser(m, loser, QUAD_INSIDE)
    if refused != ALLOWED:
        return refused
    if m.edge[h, TWIN] < 0 and m.edge[n, TWIN] < 0:
        return NO_ELEMENT_LEFT
    if m.edge[o, TWIN] < 0 and m.edge[p, TWIN] < 0:
        return NO_ELEMENT_LEFT
    if m.vertex[b, DEGREE] <= 2 or m.vertex[d, DEGREE] <= 2:
        return DEGREE_TOO_LOW
    if cap > 0 and m.vertex[a, DEGREE] + m.vertex[c, DEGREE] - 2 > cap:
        return DEGREE_CAP
    if joined(m, a, c, 4):
        return ENDS_JOINED
    if common_neighbours(m, a, c, 4) != 2:
        return LINK_CONDITION
    return ALLOWED if has_room(m, 4, 0, 0, 80 + 2 * m.vertex[loser, DEGREE]) else NEED_ROOM


@bare_kernel
def collapse(m, h):
    r"""Merge a and the opposite corner c of h's quad: V-1, E-2, F-1.

    The survivor keeps its place, id, desired degree and flags; the quad dies, h with it.

    d ----- c         d
    |       |          \
    |       |    ->      w
    |       |          /   \
    a --h-- b                b
    """
    n, p = following(h, 4), preceding(h, 4)
    o = following(n, 4)
    a, b, c, d = m.edge[h, ORIGIN], m.edge[n, ORIGIN], m.edge[o, ORIGIN], m.edge[p, ORIGIN]
    ab, bc, cd, da = m.edge[h, TWIN], m.edge[n, TWIN], m.edge[o, TWIN], m.edge[p, TWIN]
    winner = survivor(m, a, c, 4)
    loser = a + c - winner
    degree = m.vertex[a, DEGREE] + m.vertex[c, DEGREE] - 2
    half = m.vertex[winner, HALF]
    if half == h:
        half = bc
    elif half == o:
        half = da

    hand_over(m, loser, winner, 4)
    link(m, ab, bc)
    link(m, cd, da)
    if m.vertex[b, HALF] == n:
        put_vertex(m, b, HALF, ab)
    if m.vertex[d, HALF] == p:
        put_vertex(m, d, HALF, cd)
    if m.vertex[winner, HALF] != half:
        put_vertex(m, winner, HALF, half)
    drop_element(m, h, 4)
    drop_vertex(m, loser)

    add_degree(m, b, -1)
    add_degree(m, d, -1)
    set_degrees(m, winner, degree, m.vertex[winner, DESIRED])
    touch(m, winner)
    touch(m, b)
    touch(m, d)


@bare_kernel
def score_change_collapse(m, h):
    """The change of s by :func:`collapse`: a and c become one vertex, b and d lose an edge."""
    a, b = m.edge[h, ORIGIN], m.edge[following(h, 4), ORIGIN]
    c, d = m.edge[opposite(h), ORIGIN], m.edge[preceding(h, 4), ORIGIN]
    return merge_term(m, a, c, 2, 4) + degree_term(m, b, -1) + degree_term(m, d, -1)
