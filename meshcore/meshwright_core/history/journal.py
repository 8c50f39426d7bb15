"""The undo journal: each write of an edit as (place, former value); undo is exact to the bit.

A step is one row of ``steps``: where its journal entries start and stop, the operation and
half-edge that made it, and the counters before it. Undoing swaps the entries with the arrays, last
one first; redo swaps the same values back in. One journal serves the undo of the editor, the
rollback of a failed transaction, and backtracking in a search.
"""

from __future__ import annotations

from numba import types
from numba.extending import intrinsic

from meshwright_core.core.arrays import (
    CURVE,
    DEGREE,
    DELTA_SUM,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    FLAGS,
    FREE_ELEMENT,
    FREE_VERTEX,
    GROUPED,
    HALF,
    IRREGULAR,
    JOURNAL_TOP,
    JOURNALLING,
    NEW_COUNT,
    ORIGIN,
    PLACE,
    RESTORED,
    SCORE,
    STEP,
    STEP_COUNTERS,
    STEP_END,
    STEP_HALFEDGE,
    STEP_OPERATION,
    STEP_START,
    STEP_STOP,
    TOUCHED_COUNT,
    TRACE_IDS,
    TWIN,
    VERTEX_COLUMNS,
    VERTEX_SLOTS,
    VERTICES,
    along_curve,
    following,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.composite_curves import (
    coordinate_in_span,
    curve_length,
    span_and_share,
)
from meshwright_core.core.curve_edges import edge_curve, edge_range

EDGE_WRITE, VERTEX_WRITE, POINT_WRITE, LIST_WRITE, PARAMETER_WRITE, REGION_WRITE = range(6)
WRITE_KINDS = 8
"""A place is index * WRITE_KINDS + the kind of write."""
_NEAR = 1e-12
"""Distance from its curve, relative to the curve's length, below which a vertex lies on it."""


@intrinsic
def _bits_of(typingctx, value):
    """The 64 bits of a float as an integer."""

    def codegen(context, builder, signature, args):
        return builder.bitcast(args[0], context.get_value_type(types.int64))

    return types.int64(types.float64), codegen


@intrinsic
def _float_of(typingctx, value):
    """The float with these 64 bits."""

    def codegen(context, builder, signature, args):
        return builder.bitcast(args[0], context.get_value_type(types.float64))

    return types.float64(types.int64), codegen


@bare_kernel
def _note(m, kind, index, former):
    top = m.counters[JOURNAL_TOP]
    m.journal[top, 0] = index * WRITE_KINDS + kind
    m.journal[top, 1] = former
    m.counters[JOURNAL_TOP] = top + 1


@bare_kernel
def put_edge(m, h, column, value):
    """Write origin or twin of h."""
    if m.counters[JOURNALLING]:
        _note(m, EDGE_WRITE, h * 2 + column, m.edge[h, column])
    m.edge[h, column] = value


@bare_kernel
def put_vertex(m, v, column, value):
    """Write one column of vertex v."""
    if m.counters[JOURNALLING]:
        _note(m, VERTEX_WRITE, v * VERTEX_COLUMNS + column, m.vertex[v, column])
    m.vertex[v, column] = value


@bare_kernel
def put_point(m, v, x, y, z):
    """Write the coordinates of vertex v."""
    if m.counters[JOURNALLING]:
        for axis in range(3):
            _note(m, POINT_WRITE, v * 3 + axis, _bits_of(m.points[v, axis]))
    m.points[v, 0] = x
    m.points[v, 1] = y
    m.points[v, 2] = z


@bare_kernel
def put_parameter(m, v, t):
    """Write the parameter of vertex v."""
    if m.counters[JOURNALLING]:
        _note(m, PARAMETER_WRITE, v, _bits_of(m.parameter[v]))
    m.parameter[v] = t


@bare_kernel
def put_region(m, e, region):
    """Write the region of element e."""
    if m.counters[JOURNALLING]:
        _note(m, REGION_WRITE, e, m.region[e])
    m.region[e] = region


@bare_kernel
def put_listed(m, place, v):
    """Write one entry of the list of irregular vertices."""
    if m.counters[JOURNALLING]:
        _note(m, LIST_WRITE, place, m.irregular[place])
    m.irregular[place] = v


@bare_kernel
def link(m, h, t):
    """Make h and t twins; either may be -1."""
    if h >= 0:
        put_edge(m, h, TWIN, t)
    if t >= 0:
        put_edge(m, t, TWIN, h)


@bare_kernel
def set_degrees(m, v, degree, desired):
    """Set degree and desired degree of v; updates s, the sum of Delta and the irregular list."""
    before = m.vertex[v, DEGREE] - m.vertex[v, DESIRED]
    after = degree - desired
    if m.vertex[v, DEGREE] != degree:
        put_vertex(m, v, DEGREE, degree)
    if m.vertex[v, DESIRED] != desired:
        put_vertex(m, v, DESIRED, desired)
    if before == after:
        return
    m.counters[SCORE] += abs(after) - abs(before)
    m.counters[DELTA_SUM] += after - before
    if before == 0:
        place = m.counters[IRREGULAR]
        put_listed(m, place, v)
        put_vertex(m, v, PLACE, place)
        m.counters[IRREGULAR] = place + 1
    elif after == 0:
        place = m.vertex[v, PLACE]
        last = m.counters[IRREGULAR] - 1
        moved = m.irregular[last]
        if moved != v:
            put_listed(m, place, moved)
            put_vertex(m, moved, PLACE, place)
        put_vertex(m, v, PLACE, -1)
        m.counters[IRREGULAR] = last


@bare_kernel
def add_degree(m, v, change):
    """Add `change` to the degree of v."""
    set_degrees(m, v, m.vertex[v, DEGREE] + change, m.vertex[v, DESIRED])


@bare_kernel
def new_vertex(m, degree, desired, x, y, z):
    """Take a vertex slot: the last one freed, else the next unused one. The caller sets HALF."""
    v = m.counters[FREE_VERTEX]
    if v >= 0:
        m.counters[FREE_VERTEX] = -2 - m.vertex[v, HALF]
    else:
        v = m.counters[VERTEX_SLOTS]
        m.counters[VERTEX_SLOTS] = v + 1
    m.counters[VERTICES] += 1
    put_point(m, v, x, y, z)
    if m.vertex[v, FLAGS] != 0:
        put_vertex(m, v, FLAGS, 0)
    set_degrees(m, v, degree, desired)
    return v


@bare_kernel
def midway(m, a, b, degree, desired):
    """A new vertex in the middle of a and b, on no curve."""
    p = m.points
    return new_vertex(
        m,
        degree,
        desired,
        0.5 * (p[a, 0] + p[b, 0]),
        0.5 * (p[a, 1] + p[b, 1]),
        0.5 * (p[a, 2] + p[b, 2]),
    )


@bare_kernel
def on_edge(m, h, degree, desired, k):
    """A new vertex in the middle of the edge of h: on its curve where it lies on one.

    Its parameter is the mean of those of the ends; its distance from the curve too, where the ends
    have been moved off it.
    """
    if not along_curve(m, h, k):
        return midway(m, m.edge[h, ORIGIN], m.edge[following(h, k), ORIGIN], degree, desired)
    return on_edge_at(m, h, 0.5, degree, desired, k)


@bare_kernel
def on_edge_at(m, h, share, degree, desired, k):
    """A new vertex on an edge along a curve, that share of the way from the origin of h.

    The share is one of the parameter, and of the distance from the curve where the ends have been
    moved off it.
    """
    a, b = m.edge[h, ORIGIN], m.edge[following(h, k), ORIGIN]
    keep = 1.0 - share
    c = edge_curve(m, h, k)
    if c < 0:
        p = m.points
        v = new_vertex(
            m,
            degree,
            desired,
            keep * p[a, 0] + share * p[b, 0],
            keep * p[a, 1] + share * p[b, 1],
            keep * p[a, 2] + share * p[b, 2],
        )
        put_vertex(m, v, CURVE, m.vertex[a, CURVE])
        return v
    t_a, t_b = edge_range(m, h, c, k)
    t = keep * t_a + share * t_b
    length = curve_length(m.curves, c)
    if m.curves.closed[c] and t >= length:
        t -= length
    span_a, u_a = span_and_share(m.curves, c, t_a)
    span_b, u_b = span_and_share(m.curves, c, t_b)
    span, u = span_and_share(m.curves, c, t)
    x = keep * _offset(m, a, span_a, u_a, 0) + share * _offset(m, b, span_b, u_b, 0)
    y = keep * _offset(m, a, span_a, u_a, 1) + share * _offset(m, b, span_b, u_b, 1)
    z = keep * _offset(m, a, span_a, u_a, 2) + share * _offset(m, b, span_b, u_b, 2)
    slack = _NEAR * length
    x = x if abs(x) > slack else 0.0
    y = y if abs(y) > slack else 0.0
    z = z if abs(z) > slack else 0.0
    v = new_vertex(
        m,
        degree,
        desired,
        coordinate_in_span(m.curves, span, u, 0) + x,
        coordinate_in_span(m.curves, span, u, 1) + y,
        coordinate_in_span(m.curves, span, u, 2) + z,
    )
    put_vertex(m, v, CURVE, c)
    put_parameter(m, v, t)
    return v


@bare_kernel
def _offset(m, v, span, u, axis):
    """Coordinate `axis` of the way from the curve's point to the vertex v."""
    return m.points[v, axis] - coordinate_in_span(m.curves, span, u, axis)


@bare_kernel
def drop_vertex(m, v):
    """Free the slot of v; its coordinates stay until the slot is taken again."""
    set_degrees(m, v, 0, 0)
    if m.vertex[v, FLAGS] != 0:
        put_vertex(m, v, FLAGS, 0)
    if m.vertex[v, CURVE] >= 0:
        put_vertex(m, v, CURVE, -1)
        put_parameter(m, v, 0.0)
    put_vertex(m, v, HALF, -2 - m.counters[FREE_VERTEX])
    m.counters[FREE_VERTEX] = v
    m.counters[VERTICES] -= 1


@bare_kernel
def new_element(m, region, k):
    """Take an element slot; returns its first half-edge. The caller sets origins and twins."""
    e = m.counters[FREE_ELEMENT]
    if e >= 0:
        m.counters[FREE_ELEMENT] = m.edge[e * k, TWIN]
    else:
        e = m.counters[ELEMENT_SLOTS]
        m.counters[ELEMENT_SLOTS] = e + 1
    m.counters[ELEMENTS] += 1
    if m.region[e] != region:
        put_region(m, e, region)
    return e * k


@bare_kernel
def drop_element(m, h, k):
    """Free the slot of the element of h."""
    first = h - h % k
    for i in range(first, first + k):
        put_edge(m, i, ORIGIN, -1)
        put_edge(m, i, TWIN, -1)
    put_edge(m, first, TWIN, m.counters[FREE_ELEMENT])
    m.counters[FREE_ELEMENT] = first // k
    m.counters[ELEMENTS] -= 1


@bare_kernel
def has_room(m, k, vertices, elements, entries):
    """Whether the arrays can take so many new vertices, elements and journal entries.

    Slots on the free lists are left out of account, which only enlarges early. Where there is not
    enough room, the three numbers are written to the trace.
    """
    short = m.counters[VERTEX_SLOTS] + vertices > m.vertex.shape[0]
    short = short or m.counters[ELEMENT_SLOTS] + elements > m.element_mark.shape[0]
    if m.counters[JOURNALLING]:
        short = short or m.counters[JOURNAL_TOP] + entries > m.journal.shape[0]
        short = short or m.counters[STEP] + 1 > m.steps.shape[0]
    if short:
        m.trace[TRACE_IDS] = vertices
        m.trace[TRACE_IDS + 1] = elements
        m.trace[TRACE_IDS + 2] = entries
    return not short


@bare_kernel
def begin_step(m, operation, h):
    """Open a step unless one is open; steps that could be redone are discarded."""
    m.trace[NEW_COUNT] = 0
    m.trace[TOUCHED_COUNT] = 0
    if m.counters[GROUPED] or not m.counters[JOURNALLING]:
        return
    row = m.counters[STEP]
    top = m.steps[row - 1, STEP_STOP] if row > 0 else 0
    m.counters[JOURNAL_TOP] = top
    m.steps[row, STEP_START] = top
    m.steps[row, STEP_OPERATION] = operation
    m.steps[row, STEP_HALFEDGE] = h
    for i in range(RESTORED):
        m.steps[row, STEP_COUNTERS + i] = m.counters[i]


@bare_kernel
def end_step(m):
    """Close the step that :func:`begin_step` opened."""
    if m.counters[GROUPED] or not m.counters[JOURNALLING]:
        return
    row = m.counters[STEP]
    m.steps[row, STEP_STOP] = m.counters[JOURNAL_TOP]
    m.counters[STEP] = row + 1
    m.counters[STEP_END] = row + 1


@bare_kernel
def _swap_entry(m, j):
    index = m.journal[j, 0] // WRITE_KINDS
    kind = m.journal[j, 0] % WRITE_KINDS
    stored = m.journal[j, 1]
    if kind == EDGE_WRITE:
        m.journal[j, 1] = m.edge[index // 2, index % 2]
        m.edge[index // 2, index % 2] = stored
    elif kind == VERTEX_WRITE:
        row, column = index // VERTEX_COLUMNS, index % VERTEX_COLUMNS
        m.journal[j, 1] = m.vertex[row, column]
        m.vertex[row, column] = stored
    elif kind == POINT_WRITE:
        m.journal[j, 1] = _bits_of(m.points[index // 3, index % 3])
        m.points[index // 3, index % 3] = _float_of(stored)
    elif kind == PARAMETER_WRITE:
        m.journal[j, 1] = _bits_of(m.parameter[index])
        m.parameter[index] = _float_of(stored)
    elif kind == REGION_WRITE:
        m.journal[j, 1] = m.region[index]
        m.region[index] = stored
    else:
        m.journal[j, 1] = m.irregular[index]
        m.irregular[index] = stored


@bare_kernel
def _swap_counters(m, row):
    for i in range(RESTORED):
        stored = m.steps[row, STEP_COUNTERS + i]
        m.steps[row, STEP_COUNTERS + i] = m.counters[i]
        m.counters[i] = stored


@bare_kernel
def undo(m):
    """Undo the last step; False if there is none."""
    row = m.counters[STEP] - 1
    if row < 0:
        return False
    for j in range(m.steps[row, STEP_STOP] - 1, m.steps[row, STEP_START] - 1, -1):
        _swap_entry(m, j)
    _swap_counters(m, row)
    m.counters[STEP] = row
    m.counters[JOURNAL_TOP] = m.steps[row, STEP_START]
    return True


@bare_kernel
def redo(m):
    """Redo the step that was undone last; False if there is none."""
    row = m.counters[STEP]
    if row >= m.counters[STEP_END]:
        return False
    for j in range(m.steps[row, STEP_START], m.steps[row, STEP_STOP]):
        _swap_entry(m, j)
    _swap_counters(m, row)
    m.counters[STEP] = row + 1
    m.counters[JOURNAL_TOP] = m.steps[row, STEP_STOP]
    return True


@bare_kernel
def touch(m, v):
    """Add v to the trace of vertices around which the last operation changed something."""
    count = m.trace[TOUCHED_COUNT]
    m.trace[TRACE_IDS + count] = v
    m.trace[TOUCHED_COUNT] = count + 1


@bare_kernel
def touch_new(m, v):
    """Add a new vertex to the trace; to be called before any :func:`touch`."""
    touch(m, v)
    m.trace[NEW_COUNT] += 1
