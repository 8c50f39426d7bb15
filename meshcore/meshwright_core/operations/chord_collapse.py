"""The collapse of a chord, the strip of quads that a walk across opposite edges crosses.

Beyond the paper: it undoes the growth that a global split brings. Every edge that the walk crosses
(a rung) shrinks to a vertex, and the two rails of the strip merge into one chain of edges.

    x0 -- x1 -- x2
    |     |     |          rungs x0-y0, x1-y1, x2-y2    ->    m0 -- m1 -- m2
    y0 -- y1 -- y2
"""

from __future__ import annotations

from meshwright_core.core.arrays import (
    BOUNDARY_EDGES,
    DEGREE,
    DESIRED,
    ELEMENTS,
    HALF,
    MARK,
    ORIGIN,
    TWIN,
    following,
    joined,
    neighbour,
    on_boundary,
    opposite,
    preceding,
    turned,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.irregularity import QUAD_INSIDE, QUAD_STRAIGHT
from meshwright_core.history.journal import (
    drop_element,
    drop_vertex,
    has_room,
    link,
    put_vertex,
    set_degrees,
    touch,
)
from meshwright_core.operations.refusals import (
    ALLOWED,
    CHORD_CROSSES_ITSELF,
    CHORD_PINCHES,
    DEGREE_CAP,
    MERGED_EDGES_MEET,
    NEED_ROOM,
)
from meshwright_core.operations.vertex_merge import (
    check_loser,
    check_pair,
    check_sides,
    hand_over,
    survivor,
)


@bare_kernel
def chord_start(m, h):
    """The half-edge through which the strip of h's quad and edge begins; h itself for a ring."""
    entry = h
    for _ in range(2 * m.counters[ELEMENTS]):
        t = m.edge[entry, TWIN]
        if t < 0:
            return entry
        entry = opposite(t)
        if entry == h:
            return h
    return h


@bare_kernel
def strip_length(m, start):
    """Quads of the strip that begins at `start`, at most twice the number of elements."""
    entry = start
    for count in range(1, 2 * m.counters[ELEMENTS] + 1):
        entry = m.edge[opposite(entry), TWIN]
        if entry < 0 or entry == start:
            return count
    return 0


@bare_kernel
def _rung(m, start, i, entry, ring, length):
    """The ends x, y of rung i; `entry` is the entry of quad i, or of the last quad for i =
    length.
    """
    if i < length:
        return m.edge[entry, ORIGIN], m.edge[following(entry, 4), ORIGIN]
    o = opposite(entry)
    return m.edge[following(o, 4), ORIGIN], m.edge[o, ORIGIN]


@bare_kernel
def _mark_strip(m, start, length, ring):
    """Mark quads and rails, x of rung i by i + 1 and y by -(i + 1); False if any is met twice."""
    entry = start
    once = True
    for i in range(length if ring else length + 1):
        if i < length:
            if i > 0:
                entry = m.edge[opposite(entry), TWIN]
            if m.element_mark[entry // 4]:
                once = False
            m.element_mark[entry // 4] = 1
        x, y = _rung(m, start, i, entry, ring, length)
        if m.vertex[x, MARK] or m.vertex[y, MARK]:
            once = False
        m.vertex[x, MARK] = i + 1
        m.vertex[y, MARK] = -(i + 1)
    return once


@bare_kernel
def _unmark_strip(m, start, length):
    entry = start
    for i in range(length):
        if i > 0:
            entry = m.edge[opposite(entry), TWIN]
        m.element_mark[entry // 4] = 0
        for corner in range(4):
            m.vertex[m.edge[entry - entry % 4 + corner, ORIGIN], MARK] = 0


@bare_kernel
def _across_rung(m, u):
    """The other end of the rung of the rail vertex u."""
    wanted = -m.vertex[u, MARK]
    h = m.vertex[u, HALF]
    for _ in range(m.vertex[u, DEGREE]):
        w = neighbour(m, h, 4)
        if m.vertex[w, MARK] == wanted:
            return w
        if h < 0:
            break
        h = turned(m, h, 4)
    return -1


@bare_kernel
def _joined_once(m, v, u, partner, i, sign, rungs, ring):
    """Whether u, a neighbour of v, would be joined only once to what v and its partner become."""
    mark = m.vertex[u, MARK]
    if u == partner:
        return True
    if mark == 0:
        return not joined(m, u, partner, 4)
    gap = abs(i - (abs(mark) - 1))
    if gap == 1 or (ring and gap == rungs - 1):
        return mark * sign > 0 and not (ring and rungs == 2)
    other = _across_rung(m, u)
    return not (joined(m, v, other, 4) or joined(m, partner, u, 4) or joined(m, partner, other, 4))


@bare_kernel
def _rails_apart(m, v, partner, i, sign, rungs, ring):
    """Whether no neighbour of v would be joined twice to the vertex that v and partner become."""
    h = m.vertex[v, HALF]
    for _ in range(m.vertex[v, DEGREE]):
        if not _joined_once(m, v, neighbour(m, h, 4), partner, i, sign, rungs, ring):
            return False
        if h < 0:
            break
        h = turned(m, h, 4)
    return True


@bare_kernel
def _check_rungs(m, start, length, ring, cap):
    entry = start
    rungs = length if ring else length + 1
    for i in range(rungs):
        if 0 < i < length:
            entry = m.edge[opposite(entry), TWIN]
        x, y = _rung(m, start, i, entry, ring, length)
        at_end = not ring and (i == 0 or i == length)
        loser = x + y - survivor(m, x, y, 4)
        if at_end:
            refused = check_loser(m, loser, QUAD_STRAIGHT)
        elif on_boundary(m, x) and on_boundary(m, y):
            return CHORD_PINCHES
        else:
            rung = entry if i < length else opposite(entry)
            refused = check_pair(m, rung, x, y, loser, 4)
            if refused == ALLOWED:
                refused = check_loser(m, loser, QUAD_INSIDE)
        if refused != ALLOWED:
            return refused
        merged = m.vertex[x, DEGREE] + m.vertex[y, DEGREE] - (3 if at_end else 4)
        if cap > 0 and merged > cap:
            return DEGREE_CAP
        if i < length:
            refused = check_sides(m, following(entry, 4), preceding(entry, 4), 4)
            if refused != ALLOWED:
                return refused
        if not _rails_apart(m, x, y, i, 1, rungs, ring):
            return MERGED_EDGES_MEET
        if not _rails_apart(m, y, x, i, -1, rungs, ring):
            return MERGED_EDGES_MEET
    return ALLOWED


@bare_kernel
def check_chord_collapse(m, h, cap):
    """The strip meets no quad and no vertex twice, every rung may shrink, and no edge is
    doubled.
    """
    start = chord_start(m, h)
    ring = m.edge[start, TWIN] >= 0
    length = strip_length(m, start)
    refused = CHORD_CROSSES_ITSELF
    if _mark_strip(m, start, length, ring):
        refused = _check_rungs(m, start, length, ring, cap)
    _unmark_strip(m, start, length)
    if refused != ALLOWED:
        return refused
    entries = 0
    entry = start
    for i in range(length + 1):
        if 0 < i < length:
            entry = m.edge[opposite(entry), TWIN]
        x, y = _rung(m, start, i, entry, ring, length)
        entries += 72 + 2 * (m.vertex[x, DEGREE] + m.vertex[y, DEGREE])
    return ALLOWED if has_room(m, 4, 0, 0, entries) else NEED_ROOM


@bare_kernel
def _set_outgoing(m, v, h):
    """Set HALF of v as invariant 4 requires; h is any half-edge that leaves v."""
    half = h
    for _ in range(m.vertex[v, DEGREE]):
        t = m.edge[half, TWIN]
        if t < 0:
            break
        half = following(t, 4)
        if half == h:
            break
    if m.vertex[v, HALF] != half:
        put_vertex(m, v, HALF, half)


@bare_kernel
def chord_collapse(m, h):
    """Collapse the strip of h: open, of L quads: V-(L+1), E-(2L+1), F-L; a ring: V-L, E-2L, F-L.

    Of each rung the survivor keeps its place, id, desired degree and flags; the quads die.
    """
    start = chord_start(m, h)
    ring = m.edge[start, TWIN] >= 0
    length = strip_length(m, start)
    rungs = length if ring else length + 1

    entry = start
    for i in range(rungs):
        if 0 < i < length:
            entry = m.edge[opposite(entry), TWIN]
        x, y = _rung(m, start, i, entry, ring, length)
        winner = survivor(m, x, y, 4)
        hand_over(m, x + y - winner, winner, 4)
        degree = m.vertex[x, DEGREE] + m.vertex[y, DEGREE]
        degree -= 3 if not ring and (i == 0 or i == length) else 4
        drop_vertex(m, x + y - winner)
        set_degrees(m, winner, degree, m.vertex[winner, DESIRED])

    entry = start
    for _ in range(length):
        onward = m.edge[opposite(entry), TWIN]
        n, p = following(entry, 4), preceding(entry, 4)
        right, left = m.edge[n, TWIN], m.edge[p, TWIN]
        near, far = m.edge[entry, ORIGIN], m.edge[p, ORIGIN]
        link(m, right, left)
        drop_element(m, entry, 4)
        # left runs from near to far, right from far to near; HALF of each vertex is final when the
        # second of its two quads has been dropped
        _set_outgoing(m, near, left if left >= 0 else following(right, 4))
        _set_outgoing(m, far, right if right >= 0 else following(left, 4))
        touch(m, near)
        touch(m, far)
        entry = onward
    if not ring:
        m.counters[BOUNDARY_EDGES] -= 2
