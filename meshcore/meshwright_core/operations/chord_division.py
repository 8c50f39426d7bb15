"""The division of a chord: every quad of the strip that crosses an edge is cut in two.

Beyond the paper: the inverse of the collapse of a chord whose line is straight. A new vertex on the
boundary edge where the strip begins is carried straight through quad after quad, as the hanging
vertices of a global split are, to the boundary where the strip ends. All new vertices are regular,
so s stays as it is. A strip that closes in a ring has no such ends, and is refused.

    x0 -- x1 -- x2         x0 -- x1 -- x2
    |     |     |          |     |     |
    |     |     |    ->    v0 -- v1 -- v2
    |     |     |          |     |     |
    y0 -- y1 -- y2         y0 -- y1 -- y2
"""

from __future__ import annotations

from meshwright_core.core.arrays import BOUNDARY_EDGES, HALF, TWIN
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.irregularity import QUAD_STRAIGHT
from meshwright_core.history.journal import has_room, on_edge, put_vertex, touch_new
from meshwright_core.operations.chord_collapse import chord_start, strip_length
from meshwright_core.operations.global_split import carry, cut
from meshwright_core.operations.refusals import ALLOWED, NEED_ROOM, NEVER_ENDS


@bare_kernel
def check_divide_chord(m, h, cap):
    """The strip reaches the boundary; new vertices have four edges, within any cap."""
    start = chord_start(m, h)
    if m.edge[start, TWIN] >= 0:
        return NEVER_ENDS
    # where the strip crosses itself, the second cut of a quad makes two new quads
    cuts = 2 * strip_length(m, start) + 1
    return ALLOWED if has_room(m, 4, cuts, cuts, 48 * cuts) else NEED_ROOM


@bare_kernel
def divide_chord(m, h):
    """Cut the strip of h's quad and edge in two: V+L+1, E+2L+1, F+L for a strip of L quads that
    does not cross itself. All old ids live.
    """
    start = chord_start(m, h)
    # the degree counts the cut that will leave the vertex
    v = on_edge(m, start, 2, QUAD_STRAIGHT, 4)
    touch_new(m, v)
    m.counters[BOUNDARY_EDGES] += 1
    entry, far, before, after = cut(m, start, v, -1, -1)
    put_vertex(m, v, HALF, before - before % 4)
    carry(m, entry, far, before, after)
