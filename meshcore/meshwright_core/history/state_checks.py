"""Checks every state that the steps of a journal lead to, at the cost of what each step changes.

The steps of a file may lie. After each one the invariants of :mod:`meshwright_core.core.arrays` are
checked again at the vertices that it has written, or whose elements it has; all others hold as
before. Sums, such as s, the elements at each vertex, or how often a side runs around its curve, are
carried along: what the step changes is subtracted before it and added after it. No index is used
before it is known to be in range, given that places and values of the writes are
(:func:`meshwright_core.io.snapshot_checks.require_within`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import (
    BOUNDARY_EDGES,
    CURVE,
    DEGREE,
    DELTA_SUM,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    END,
    FLAGS,
    FREE_ELEMENT,
    FREE_VERTEX,
    GEOMETRIC,
    HALF,
    IRREGULAR,
    LEFT,
    NAMING,
    ORIGIN,
    PLACE,
    RESTORED,
    RIGHT,
    SCORE,
    SIDES,
    START,
    STEP,
    STEP_COUNTERS,
    STEP_START,
    STEP_STOP,
    TWIN,
    VERTEX_COLUMNS,
    VERTEX_SLOTS,
    VERTICES,
    MeshArrays,
    following,
    preceding,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.composite_curves import curve_length
from meshwright_core.core.curve_edges import edge_curve
from meshwright_core.core.references import by_reference
from meshwright_core.history.journal import (
    EDGE_WRITE,
    LIST_WRITE,
    PARAMETER_WRITE,
    REGION_WRITE,
    VERTEX_WRITE,
    WRITE_KINDS,
    redo,
    undo,
)

SOUND, ELEMENT, EDGE, VERTEX, COUNTS, LISTED, FREE, SEAT = range(8)
"""What is wrong after a step, if anything."""
WORDS = (
    "",
    "an element is broken",
    "two elements disagree about their edge",
    "a vertex is broken",
    "its counts and scores are wrong",
    "its list of irregular vertices is wrong",
    "its list of free places is wrong",
    "a vertex does not lie on the curve of its side",
)
"""A sentence for each."""

# indices of Carried.state
_STAMP, _PASS, _SWEEP, _VERTICES, _ELEMENTS, _FAN, _OPEN_TURNS, _SEATS, _REGIONS = range(9)


@by_reference
class Carried(NamedTuple):
    """What is known of a state, and lists of what the next step changes."""

    corners: np.ndarray
    """(V,) int32: live elements at each vertex."""
    rims: np.ndarray
    """(V,) int32: half-edges between two regions that leave each vertex."""
    vertex_rank: np.ndarray
    """(V,) int32: place of each free vertex, from the end of their chain, from 1; else 0."""
    element_rank: np.ndarray
    """(E,) int32: the same of elements."""
    turns: np.ndarray
    """(n,) int64: how often sides run along each curve."""
    tally: np.ndarray
    """(10,) int64: counters of the mesh, summed up."""
    ends: np.ndarray
    """(V,) bool: the vertices at which interfaces end."""
    state: np.ndarray
    """(9,) int64: numbers of the step, pass and sweep, lengths of the lists, curves not run along
    once, whether seats are checked, number of regions."""
    vertex_stamp: np.ndarray
    """(V, 3) int64: the last steps that touched each vertex and that wrote its link, the last sweep
    that met it."""
    element_stamp: np.ndarray
    """(E, 3) int64: the last steps that wrote each element and its link, the last pass that met
    it."""
    vertices: np.ndarray
    """(V,) int32: touched vertices."""
    elements: np.ndarray
    """(E,) int32: written elements."""
    fan: np.ndarray
    """(E,) int32: elements at touched vertices."""


def carried(m: MeshArrays, ends: np.ndarray, seats: bool, regions: int) -> Carried:
    """Nothing known yet.

    Args:
        m: the mesh.
        ends: ids of the vertices at which interfaces end.
        seats: whether steps hold the seats of vertices on curves, which are then checked.
        regions: number of regions.
    """
    vertices, elements = len(m.vertex), len(m.element_mark)
    is_end = np.zeros(vertices, np.bool_)
    is_end[ends] = True
    return Carried(
        corners=np.zeros(vertices, np.int32),
        rims=np.zeros(vertices, np.int32),
        vertex_rank=np.zeros(vertices, np.int32),
        element_rank=np.zeros(elements, np.int32),
        turns=np.zeros(len(m.interface), np.int64),
        tally=np.zeros(RESTORED, np.int64),
        ends=is_end,
        state=np.array([0, 0, 0, 0, 0, 0, len(m.interface), int(seats), regions], np.int64),
        vertex_stamp=np.zeros((vertices, 3), np.int64),
        element_stamp=np.zeros((elements, 3), np.int64),
        vertices=np.zeros(vertices, np.int32),
        elements=np.zeros(elements, np.int32),
        fan=np.zeros(elements, np.int32),
    )


@bare_kernel
def walk(m, c, count, forward):
    """Redo (forward) or undo so many steps of the journal; returns what is wrong after the last
    one, at the first that leads to a broken state. The first call checks the present state too.
    """
    k = m.counters[SIDES]
    begun = c.state[_STAMP] > 0
    for i in range(0 if begun else -1, count):
        former = m.counters[IRREGULAR]
        if i < 0:
            _collect_all(m, c)
        else:
            row = m.counters[STEP] if forward else m.counters[STEP] - 1
            wrong = _collected(m, c, row, k)
            if wrong:
                return wrong
            _subtract(m, c, k)
            if forward:
                redo(m)
            else:
                undo(m)
        for j in range(c.state[_ELEMENTS]):
            _count_corners(m, c, c.elements[j], 1, k)
        wrong = _settled(m, c, former, k)
        if wrong:
            return wrong
    return SOUND


@bare_kernel
def _collect_all(m, c):
    """List all vertices and elements, as if one step had made the mesh."""
    c.state[_STAMP] = 1
    for v in range(m.counters[VERTEX_SLOTS]):
        _touch(c, v)
        c.vertex_stamp[v, 1] = 1
    for e in range(m.counters[ELEMENT_SLOTS]):
        _write_element(c, e)
        c.element_stamp[e, 1] = 1


# before a step


@bare_kernel
def _touch(c, v):
    if c.vertex_stamp[v, 0] != c.state[_STAMP]:
        c.vertex_stamp[v, 0] = c.state[_STAMP]
        c.vertices[c.state[_VERTICES]] = v
        c.state[_VERTICES] += 1


@bare_kernel
def _write_element(c, e):
    if c.element_stamp[e, 0] != c.state[_STAMP]:
        c.element_stamp[e, 0] = c.state[_STAMP]
        c.elements[c.state[_ELEMENTS]] = e
        c.state[_ELEMENTS] += 1


@bare_kernel
def _collected(m, c, row, k):
    """List the vertices that a step touches and the elements that it writes."""
    c.state[_STAMP] += 1
    c.state[_VERTICES] = c.state[_ELEMENTS] = 0
    first, stop = m.steps[row, STEP_START], m.steps[row, STEP_STOP]
    for j in range(first, stop):
        index, kind = m.journal[j, 0] // WRITE_KINDS, m.journal[j, 0] % WRITE_KINDS
        value = m.journal[j, 1]
        if kind == EDGE_WRITE:
            e = index // (2 * k)
            _write_element(c, e)
            c.element_stamp[e, 1] = c.state[_STAMP]
            if index % 2 == ORIGIN and value >= 0:
                _touch(c, value)
        elif kind == REGION_WRITE:
            _write_element(c, index)
        elif kind == VERTEX_WRITE:
            v, column = index // VERTEX_COLUMNS, index % VERTEX_COLUMNS
            if column != NAMING:
                _touch(c, v)
            if column == HALF:
                c.vertex_stamp[v, 1] = c.state[_STAMP]
        elif kind == PARAMETER_WRITE:
            _touch(c, index)
        elif kind == LIST_WRITE:
            if value >= 0:
                _touch(c, value)
            if m.irregular[index] >= 0:
                _touch(c, m.irregular[index])
    # slots that begin or cease to be in use have all been written by a step that is true
    now, then = m.counters[VERTEX_SLOTS], m.steps[row, STEP_COUNTERS + VERTEX_SLOTS]
    if abs(now - then) > stop - first:
        return COUNTS
    for v in range(min(now, then), max(now, then)):
        _touch(c, v)
        c.vertex_stamp[v, 1] = c.state[_STAMP]
    now, then = m.counters[ELEMENT_SLOTS], m.steps[row, STEP_COUNTERS + ELEMENT_SLOTS]
    if abs(now - then) > stop - first:
        return COUNTS
    for e in range(min(now, then), max(now, then)):
        _write_element(c, e)
        c.element_stamp[e, 1] = c.state[_STAMP]
    for i in range(c.state[_ELEMENTS]):
        e = c.elements[i]
        for h in range(e * k, e * k + k):
            if m.edge[h, ORIGIN] >= 0:
                _touch(c, m.edge[h, ORIGIN])
    return SOUND


@bare_kernel
def _subtract(m, c, k):
    """Take what the touched vertices and their elements add to all sums out of them."""
    c.state[_FAN] = 0
    c.state[_PASS] += 1
    for i in range(c.state[_VERTICES]):
        v = c.vertices[i]
        _count_vertex(m, c, v, -1)
        h = m.vertex[v, HALF]
        if h < 0:
            continue
        for _ in range(c.corners[v]):
            _list_fan(c, h // k)
            h = m.edge[preceding(h, k), TWIN]
    for i in range(c.state[_FAN]):
        e = c.fan[i]
        for h in range(e * k, e * k + k):
            _count_edge(m, c, h, -1, k)
    for i in range(c.state[_ELEMENTS]):
        _count_corners(m, c, c.elements[i], -1, k)


@bare_kernel
def _list_fan(c, e):
    if c.element_stamp[e, 2] != c.state[_PASS]:
        c.element_stamp[e, 2] = c.state[_PASS]
        c.fan[c.state[_FAN]] = e
        c.state[_FAN] += 1


# sums


@bare_kernel
def _count_corners(m, c, e, sign, k):
    """Add an element, if it is alive, to those of its vertices."""
    for h in range(e * k, e * k + k):
        if m.edge[h, ORIGIN] < 0:
            return
    for h in range(e * k, e * k + k):
        c.corners[m.edge[h, ORIGIN]] += sign
    c.tally[ELEMENTS] += sign


@bare_kernel
def _count_vertex(m, c, v, sign):
    if m.vertex[v, HALF] >= 0:
        c.tally[VERTICES] += sign
    delta = m.vertex[v, DEGREE] - m.vertex[v, DESIRED]
    c.tally[SCORE] += sign * abs(delta)
    c.tally[DELTA_SUM] += sign * delta
    if delta != 0:
        c.tally[IRREGULAR] += sign


@bare_kernel
def _turn(c, curve, change):
    if c.turns[curve] == 1:
        c.state[_OPEN_TURNS] += 1
    c.turns[curve] += change
    if c.turns[curve] == 1:
        c.state[_OPEN_TURNS] -= 1


@bare_kernel
def _count_edge(m, c, h, sign, k):
    """Add a half-edge to the sums of boundary and interfaces; whether it runs along its curve."""
    t = m.edge[h, TWIN]
    if t < 0:
        c.tally[BOUNDARY_EDGES] += sign
    elif m.region[h // k] == m.region[t // k]:
        return True
    if not c.state[_SEATS]:
        return True
    a, b = m.edge[h, ORIGIN], m.edge[following(h, k), ORIGIN]
    if t < 0:
        curve = m.vertex[a, CURVE]
        if curve < 0 or curve != m.vertex[b, CURVE] or m.interface[curve, LEFT] >= 0:
            return False
        if m.parameter[b] <= m.parameter[a]:
            _turn(c, curve, sign)
        return True
    c.rims[a] += sign
    curve = edge_curve(m, h, k)
    if curve < 0:
        return False
    own, other = m.region[h // k], m.region[t // k]
    left, right = m.interface[curve, LEFT], m.interface[curve, RIGHT]
    if own != left:
        return own == right and other == left
    if other != right:
        return False
    start, end = m.interface[curve, START], m.interface[curve, END]
    if start != end and (b == start or a == end):
        return False
    length = curve_length(m.curves, curve)
    low = 0.0 if a == start else m.parameter[a]
    high = length if b == end else m.parameter[b]
    wrapped = high <= low
    if wrapped and not m.curves.closed[curve]:
        return False
    _turn(c, curve, sign * (int(a == start) + int(wrapped)))
    return True


# after a step


@bare_kernel
def _settled(m, c, former, k):
    """Check all that the step has touched; former: the number of irregular vertices before it."""
    c.state[_FAN] = 0
    c.state[_PASS] += 1
    for i in range(c.state[_ELEMENTS]):
        if not _element_sound(m, c, c.elements[i], k):
            return ELEMENT
    for i in range(c.state[_VERTICES]):
        v = c.vertices[i]
        _count_vertex(m, c, v, 1)
        if v >= m.counters[VERTEX_SLOTS]:
            if m.vertex[v, HALF] != -1 or c.corners[v] or not _empty(m, c, v):
                return VERTEX
        elif m.vertex[v, HALF] < 0:
            if c.corners[v] or not _empty(m, c, v):
                return VERTEX
        else:
            wrong = _fan_wrong(m, c, v, k)
            if wrong:
                return wrong
    for i in range(c.state[_FAN]):
        e = c.fan[i]
        for h in range(e * k, e * k + k):
            if not _twins(m, h, k):
                return EDGE
    sound = True
    for i in range(c.state[_FAN]):
        e = c.fan[i]
        for h in range(e * k, e * k + k):
            sound = _count_edge(m, c, h, 1, k) and sound
    for counter in (VERTICES, ELEMENTS, BOUNDARY_EDGES, SCORE, DELTA_SUM, IRREGULAR):
        if c.tally[counter] != m.counters[counter]:
            return COUNTS
    if not _list_sound(m, c, former):
        return LISTED
    if not _chains_sound(m, c, k):
        return FREE
    if c.state[_SEATS] and not (sound and _seats_sound(m, c, k)):
        return SEAT
    return SOUND


@bare_kernel
def _element_sound(m, c, e, k):
    dead = m.edge[e * k, ORIGIN] < 0
    for h in range(e * k, e * k + k):
        v = m.edge[h, ORIGIN]
        if (v < 0) != dead:
            return False
        if dead:
            if e >= m.counters[ELEMENT_SLOTS] and m.edge[h, TWIN] >= 0:
                return False
            continue
        if v >= m.counters[VERTEX_SLOTS] or m.vertex[v, HALF] < 0:
            return False
        for g in range(h + 1, e * k + k):
            if m.edge[g, ORIGIN] == v:
                return False
    if dead:
        return True
    return e < m.counters[ELEMENT_SLOTS] and m.region[e] < c.state[_REGIONS]


@bare_kernel
def _empty(m, c, v):
    if m.vertex[v, DEGREE] or m.vertex[v, DESIRED] or m.vertex[v, PLACE] != -1:
        return False
    free = m.vertex[v, CURVE] == -1 and m.parameter[v] == 0.0
    return (free or not c.state[_SEATS]) and not c.ends[v]


@bare_kernel
def _fan_wrong(m, c, v, k):
    """What is wrong with the live vertex v and the elements around it; lists them."""
    h = m.vertex[v, HALF]
    limit = m.counters[ELEMENT_SLOTS] * k
    if h >= limit or m.edge[h, ORIGIN] != v:
        return VERTEX
    c.state[_SWEEP] += 1
    start, met, last = h, 0, -1
    while True:
        if h >= limit or m.edge[h, ORIGIN] != v or met == c.corners[v]:
            return EDGE
        _list_fan(c, h // k)
        met += 1
        b = m.edge[following(h, k), ORIGIN]
        if b < 0 or c.vertex_stamp[b, 2] == c.state[_SWEEP]:
            return EDGE
        c.vertex_stamp[b, 2] = c.state[_SWEEP]
        back = preceding(h, k)
        h = m.edge[back, TWIN]
        if h < 0:
            last = m.edge[back, ORIGIN]
            if last < 0 or c.vertex_stamp[last, 2] == c.state[_SWEEP]:
                return EDGE
            break
        if h == start:
            break
    if met != c.corners[v] or (m.edge[start, TWIN] < 0) != (last >= 0):
        return VERTEX
    degree = met + int(last >= 0)
    least = 2 if last >= 0 or k == 4 else 3
    if m.vertex[v, DEGREE] != degree or degree < least or m.vertex[v, DESIRED] < 1:
        return VERTEX
    return SOUND


@bare_kernel
def _twins(m, h, k):
    """Whether h and its twin are twins of each other, with the same ends."""
    t = m.edge[h, TWIN]
    if t < 0:
        return t == -1
    if t >= m.counters[ELEMENT_SLOTS] * k or m.edge[t, TWIN] != h:
        return False
    a, b = m.edge[h, ORIGIN], m.edge[following(h, k), ORIGIN]
    return m.edge[t, ORIGIN] == b and m.edge[following(t, k), ORIGIN] == a


@bare_kernel
def _list_sound(m, c, former):
    count = m.counters[IRREGULAR]
    for i in range(c.state[_VERTICES]):
        v = c.vertices[i]
        place = m.vertex[v, PLACE]
        if m.vertex[v, DEGREE] == m.vertex[v, DESIRED]:
            if place != -1:
                return False
        elif place < 0 or place >= count or m.irregular[place] != v:
            return False
    for i in range(count, former):  # no place that the list has lost is still in use
        v = m.irregular[i]
        if v >= 0 and m.vertex[v, PLACE] == i:
            return False
    return True


@bare_kernel
def _chains_sound(m, c, k):
    """Whether the chains of free slots hold each dead slot once.

    Links that a step does not write lead on as before, so that only the start of a chain, up to
    the first of those, has to be followed.
    """
    kept = np.iinfo(np.int32).max  # of those written, the place nearest to the end
    for i in range(c.state[_VERTICES]):
        v = c.vertices[i]
        if c.vertex_stamp[v, 1] == c.state[_STAMP] and c.vertex_rank[v] > 0:
            kept = min(kept, c.vertex_rank[v])
            c.vertex_rank[v] = 0
    at, met = m.counters[FREE_VERTEX], 0
    while at >= 0 and c.vertex_stamp[at, 1] == c.state[_STAMP]:
        if at >= m.counters[VERTEX_SLOTS] or m.vertex[at, HALF] >= 0 or met > c.state[_VERTICES]:
            return False
        met += 1
        at = -2 - m.vertex[at, HALF]
    behind = c.vertex_rank[at] if at >= 0 else 0
    if at >= 0 and (behind == 0 or behind >= kept):
        return False
    if met + behind != m.counters[VERTEX_SLOTS] - m.counters[VERTICES]:
        return False
    at = m.counters[FREE_VERTEX]
    for i in range(met):
        if c.vertex_rank[at]:
            return False  # met twice
        c.vertex_rank[at] = behind + met - i
        at = -2 - m.vertex[at, HALF]

    kept = np.iinfo(np.int32).max
    for i in range(c.state[_ELEMENTS]):
        e = c.elements[i]
        if c.element_stamp[e, 1] == c.state[_STAMP] and c.element_rank[e] > 0:
            kept = min(kept, c.element_rank[e])
            c.element_rank[e] = 0
    at, met = m.counters[FREE_ELEMENT], 0
    while at >= 0 and c.element_stamp[at, 1] == c.state[_STAMP]:
        dead = at < m.counters[ELEMENT_SLOTS] and m.edge[at * k, ORIGIN] < 0
        if not dead or met > c.state[_ELEMENTS]:
            return False
        met += 1
        at = m.edge[at * k, TWIN]
        if at >= len(c.element_rank):
            return False
    behind = c.element_rank[at] if at >= 0 else 0
    if at >= 0 and (behind == 0 or behind >= kept):
        return False
    if met + behind != m.counters[ELEMENT_SLOTS] - m.counters[ELEMENTS]:
        return False
    at = m.counters[FREE_ELEMENT]
    for i in range(met):
        if c.element_rank[at]:
            return False
        c.element_rank[at] = behind + met - i
        at = m.edge[at * k, TWIN]
    return True


@bare_kernel
def _seats_sound(m, c, k):
    if c.state[_OPEN_TURNS]:
        return False
    for i in range(c.state[_VERTICES]):
        v = c.vertices[i]
        h = m.vertex[v, HALF]
        if h < 0 or v >= m.counters[VERTEX_SLOTS]:
            continue
        curve, t = m.vertex[v, CURVE], m.parameter[v]
        along = m.edge[h, TWIN] < 0 or c.rims[v] > 0
        if along != (curve >= 0):
            return False
        if c.ends[v] and (curve < 0 or not m.vertex[v, FLAGS] & GEOMETRIC):
            return False
        if curve < 0:
            if t != 0.0:
                return False
            continue
        length = curve_length(m.curves, curve)
        if not 0.0 <= t <= length or (t == length and m.curves.closed[curve]):
            return False
    for i in range(c.state[_FAN]):
        e = c.fan[i]
        for h in range(e * k, e * k + k):
            t = m.edge[h, TWIN]
            if t < 0 or m.region[e] == m.region[t // k]:
                continue
            v, curve = m.edge[h, ORIGIN], edge_curve(m, h, k)
            if m.interface[curve, START] == v or m.interface[curve, END] == v:
                continue
            if c.rims[v] != 2 or m.vertex[v, CURVE] != curve:
                return False
            if m.interface[m.vertex[v, CURVE], LEFT] < 0:
                return False
    return True
