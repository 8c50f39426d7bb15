"""Extracting patches of a large mesh as separate meshes, and applying their operations to it.

A patch is a connected set of elements without a pinched vertex. Patches that are edited at the same
time share no vertex. Each vertex of a patch has the same Delta as in the large mesh, so an
operation changes s by the same amount in both; vertices on the rim, where the patch was cut, are
locked. Half-edge j of element i of a patch corresponds to half-edge j of the i-th extracted
element. The correspondence is kept up when operations create and delete elements in both meshes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_agent.env.vector_env import member
from meshwright_agent.search.repair_queue import FILL, dequeue, enqueue, irregular
from meshwright_core.core.arrays import (
    BOUNDARY_EDGES,
    CURVE,
    DEGREE,
    DELTA_SUM,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    FLAGS,
    FREE_ELEMENT,
    HALF,
    IRREGULAR,
    JOURNAL_TOP,
    JOURNALLING,
    LOCKED,
    ORIGIN,
    PLACE,
    SCORE,
    SIDES,
    STEP,
    STEP_END,
    TWIN,
    VERTEX_SLOTS,
    VERTICES,
    following,
    turned,
)
from meshwright_core.core.compilation import bare_kernel, kernel
from meshwright_core.core.references import by_reference
from meshwright_core.history.journal import undo
from meshwright_core.operations.catalogue import check, rewrite, score_change
from meshwright_core.operations.refusals import ALLOWED

MOST_TAKEN = 2
"""Largest number of element slots that a local operation takes."""


@by_reference
class Edits(NamedTuple):
    """Operations and the half-edges that they are applied to, in arrays of one shape."""

    operations: np.ndarray
    halfedges: np.ndarray


@bare_kernel
def next_patch(m, a, smallest, largest, patience, number, tries, found):
    """Grow a patch around the first vertex of the agenda that allows it.

    A vertex that was visited in vain i times gets smallest * 2^i elements, `largest` at most, and
    none after `patience` visits; one whose surroundings belong to another patch goes to the end of
    the queue. At most `tries` vertices are looked at. number: of the new patch, from 1; found (N,):
    receives the elements. Returns how many, the tries left, and the vertex; 0 where there is none.
    Until :func:`meshwright_agent.search.repair_queue.settle` frees them the vertices belong to the
    patch; so does `place`, which :func:`cut_out` clears.
    """
    k = m.counters[SIDES]
    while tries > 0 and a.state[FILL] > 0:
        tries -= 1
        v = dequeue(a)
        if not irregular(m, v) or a.visits[v] >= patience:
            continue
        size = smallest
        for _ in range(a.visits[v]):
            size = min(2 * size, largest)
        count = _grow(m, a, v, k, size, number, found)
        if count > 0:
            return count, tries, v
        enqueue(a, v)
    return 0, tries, -1


@bare_kernel
def _is_free(m, a, e, k, number):
    """Whether no other patch has a vertex of element e."""
    for h in range(e * k, e * k + k):
        owner = a.owner[m.edge[h, ORIGIN]]
        if owner != 0 and owner != number:
            return False
    return True


@bare_kernel
def _take(m, a, e, k, number, found, count):
    """Add element e to the patch; returns the new count.

    -1 if `found` is full or another patch has a vertex of e.
    """
    if a.place[e]:
        return count
    if count >= len(found) or not _is_free(m, a, e, k, number):
        return -1
    found[count] = e
    a.place[e] = count + 1
    for h in range(e * k, e * k + k):
        a.owner[m.edge[h, ORIGIN]] = number
    return count + 1


@bare_kernel
def _take_star(m, a, v, k, number, found, count):
    """Add all elements at v; returns the new count, and whether all could be added."""
    start = m.vertex[v, HALF]
    h = start
    for _ in range(m.vertex[v, DEGREE]):
        more = _take(m, a, h // k, k, number, found, count)
        if more < 0:
            return count, False
        count = more
        h = turned(m, h, k)
        if h < 0 or h == start:
            break
    return count, True


@bare_kernel
def _pinched(m, a, v, k):
    """Whether the patch is pinched at v: its elements at v are not connected by shared edges."""
    gaps = 0
    start = m.vertex[v, HALF]
    h = start
    for _ in range(m.vertex[v, DEGREE]):
        t = m.edge[h, TWIN]
        if a.place[h // k] and (t < 0 or a.place[t // k] == 0):
            gaps += 1
        h = turned(m, h, k)
        if h < 0 or h == start:
            break
    return gaps > 1


@bare_kernel
def _grow(m, a, v, k, size, number, found):
    """Grow a patch of about `size` elements around v, then add all elements at pinched vertices.

    Returns the number of elements, 0 if another patch is in the way.
    """
    if a.owner[v] != 0:
        return 0
    count, whole = _take_star(m, a, v, k, number, found, 0)
    at = 0
    while whole and at < count and count < size:
        for h in range(found[at] * k, found[at] * k + k):
            t = m.edge[h, TWIN]
            if t >= 0 and count < size:
                count = max(count, _take(m, a, t // k, k, number, found, count))
        at += 1
    # elements added here are appended to the list, so they are checked too
    at = 0
    while whole and at < count:
        for h in range(found[at] * k, found[at] * k + k):
            w = m.edge[h, ORIGIN]
            if whole and _pinched(m, a, w, k):
                count, whole = _take_star(m, a, w, k, number, found, count)
        at += 1
    if whole:
        return count
    for i in range(count):
        a.place[found[i]] = 0
        for h in range(found[i] * k, found[i] * k + k):
            a.owner[m.edge[h, ORIGIN]] = 0
    return 0


@bare_kernel
def cut_out(m, a, k, found, whole_rim, out, ids):
    """Write the patch of the elements `found` (N,) into the empty arrays `out`.

    ids (M,): receives the vertex of the large mesh for each of the patch; returns their number.
    whole_rim: whether vertices on the boundary of the large mesh are locked too, by which no global
    line can be deleted in the patch alone.
    """
    vertices = 0
    for i in range(len(found)):
        out.region[i] = m.region[found[i]]
        for j in range(k):
            v = m.edge[found[i] * k + j, ORIGIN]
            if a.number[v] == 0:
                ids[vertices] = v
                out.vertex[vertices, FLAGS] = m.vertex[v, FLAGS]
                out.vertex[vertices, CURVE] = m.vertex[v, CURVE]
                vertices += 1
                a.number[v] = vertices
            w, t = a.number[v] - 1, m.edge[found[i] * k + j, TWIN]
            h = i * k + j
            out.edge[h, ORIGIN] = w
            if t >= 0 and a.place[t // k]:
                out.edge[h, TWIN] = (a.place[t // k] - 1) * k + t % k
            out.vertex[w, DEGREE] += 1
            out.vertex[w, HALF] = h
    rim = 0
    for h in range(len(found) * k):
        if out.edge[h, TWIN] < 0:
            v, w = out.edge[h, ORIGIN], out.edge[following(h, k), ORIGIN]
            out.vertex[v, DEGREE] += 1
            out.vertex[v, HALF] = h
            # on some curve, as all vertices on a boundary; a patch has no curves to place them on
            out.vertex[v, CURVE] = max(out.vertex[v, CURVE], 0)
            if whole_rim or m.edge[found[h // k] * k + h % k, TWIN] >= 0:
                out.vertex[v, FLAGS] |= LOCKED
                out.vertex[w, FLAGS] |= LOCKED
            rim += 1
    for w in range(vertices):
        _copy_vertex(m, ids[w], out, w)
        a.number[ids[w]] = 0
    for e in found:
        a.place[e] = 0
    counters = out.counters
    counters[VERTEX_SLOTS] = counters[VERTICES] = vertices
    counters[ELEMENT_SLOTS] = counters[ELEMENTS] = len(found)
    counters[BOUNDARY_EDGES] = rim
    counters[JOURNALLING] = 0
    return vertices


@bare_kernel
def _copy_vertex(m, v, out, w):
    """Give vertex w of the patch, whose degree is known, the position and the Delta of v."""
    for axis in range(3):
        out.points[w, axis] = m.points[v, axis]
    delta = m.vertex[v, DEGREE] - m.vertex[v, DESIRED]
    out.vertex[w, DESIRED] = out.vertex[w, DEGREE] - delta
    out.counters[SCORE] += abs(delta)
    out.counters[DELTA_SUM] += delta
    if delta != 0:
        place = out.counters[IRREGULAR]
        out.irregular[place] = w
        out.vertex[w, PLACE] = place
        out.counters[IRREGULAR] = place + 1


@kernel
def mask_rim(patches, chosen, mask):
    """Forbid operations on the rim of triangle patches, whose edges are not boundary in the mesh.

    mask (B, K, A) bool: the action mask for the candidates `chosen` (B, K) of B patches.
    """
    for b in range(len(chosen)):
        m = member(patches, b)
        for i in range(chosen.shape[1]):
            h = chosen[b, i]
            if h < 0 or m.edge[h, TWIN] >= 0:
                continue
            end = m.edge[following(h, 3), ORIGIN]
            if m.vertex[m.edge[h, ORIGIN], FLAGS] & LOCKED and m.vertex[end, FLAGS] & LOCKED:
                mask[b, i] = False


@bare_kernel
def _coming(m, k, slots):
    """Write the element slots that operations will take next into `slots` (N,)."""
    e, unused = m.counters[FREE_ELEMENT], m.counters[ELEMENT_SLOTS]
    for i in range(len(slots)):
        if e >= 0:
            slots[i] = e
            e = m.edge[e * k, TWIN]
        else:
            slots[i] = unused
            unused += 1


@bare_kernel
def _put_back(m, patch, cap, elements, operations, halfedges, slots, done):
    """Apply the operations of one patch to the large mesh; see :func:`put_back`."""
    k = m.counters[SIDES]
    counters = m.counters
    counters[JOURNALLING] = 1
    counters[JOURNAL_TOP] = counters[STEP] = counters[STEP_END] = 0
    best, kept, count = counters[SCORE], 0, 0
    for i in range(len(operations)):
        operation, h = operations[i], halfedges[i]
        there = elements[h // k] * k + h % k
        if check(m, operation, there, cap) != ALLOWED:
            break
        if score_change(m, operation, there) != score_change(patch, operation, h):
            break
        _coming(m, k, slots[0])
        _coming(patch, k, slots[1])
        rewrite(m, operation, there)
        rewrite(patch, operation, h)
        for j in range(slots.shape[1]):
            elements[slots[1, j]] = slots[0, j]
        done.operations[count] = operation
        done.halfedges[count] = there
        count += 1
        if counters[SCORE] < best:
            best, kept = counters[SCORE], count
    for _ in range(count - kept):
        undo(m)
    counters[JOURNALLING] = counters[JOURNAL_TOP] = counters[STEP] = counters[STEP_END] = 0
    return kept


@kernel
def put_back(m, patches, cap, elements, edits, counts, slots, done):
    """Do on the large mesh what was done on B patches, one after the other.

    patches: as they were cut out, stacked; they follow. elements (B, E): the element of the large
    mesh for each slot of a patch, -1 for none; follows too. edits (T, B): the first `counts` (B,)
    of a patch are its own. Every operation is checked again, and must change s as in
    the patch; a patch whose operation fails keeps what came before, up to its lowest s. slots
    (2, MOST_TAKEN): scratch. done (N,): receives the edits as they replay on the large mesh.
    Returns their number; `counts` receives how many each patch kept.
    """
    total = 0
    for b in range(len(counts)):
        n = counts[b]
        counts[b] = _put_back(
            m, member(patches, b), cap, elements[b], edits.operations[:n, b].copy(),
            edits.halfedges[:n, b].copy(), slots,
            Edits(done.operations[total:], done.halfedges[total:]),
        )  # fmt: skip
        total += counts[b]
    return total
