"""What is left to do on a large mesh: a queue of irregular vertices, kept true by every change.

Nothing here looks at the whole mesh but :func:`enlist`, once at the beginning. An operation puts
the irregular vertices that it touched back into the queue, so work is proportional to what there is
to repair. The descent, the cheapest repair, works off the queue one vertex after another.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agent.selection import permitted
from meshcore.compiled import bare_kernel
from meshcore.halfedge import (
    DEGREE,
    HALF,
    ORIGIN,
    PLACE,
    TOUCHED_COUNT,
    TRACE_IDS,
    TWIN,
    preceding,
)
from meshcore.operations import QUAD_COLLAPSE, TRI_COLLAPSE, TRI_SPLIT, rewrite, score_change
from meshcore.references import by_reference

# places in Agenda.state
HEAD, FILL = 0, 1


@by_reference
class Agenda(NamedTuple):
    """Arrays by vertex slot (V,) and element slot (E,) of one mesh."""

    queue: np.ndarray
    """(V,) int32: a ring of vertices, each at most once."""
    queued: np.ndarray
    """(V,) int8: whether a vertex is in the ring."""
    visits: np.ndarray
    """(V,) int8: how often in a row a patch around the vertex was worked on in vain."""
    owner: np.ndarray
    """(V,) int32: the number of the patch that a vertex is being worked on in, from 1; else 0."""
    place: np.ndarray
    """(E,) int32: scratch, zeros between calls."""
    number: np.ndarray
    """(V,) int32: scratch, zeros between calls."""
    state: np.ndarray
    """(2,) int64: where the ring begins, how many are in it."""


def agenda(vertices: int, elements: int) -> Agenda:
    """An empty agenda for a mesh with so many slots."""
    return Agenda(
        np.zeros(vertices, np.int32),
        np.zeros(vertices, np.int8),
        np.zeros(vertices, np.int8),
        np.zeros(vertices, np.int32),
        np.zeros(elements, np.int32),
        np.zeros(vertices, np.int32),
        np.zeros(2, np.int64),
    )


def enlarged(old: Agenda, vertices: int, elements: int) -> Agenda:
    """The same agenda for a mesh that has outgrown its slots."""
    new = agenda(vertices, elements)
    fill = int(old.state[FILL])
    new.queue[:fill] = np.roll(old.queue, -int(old.state[HEAD]))[:fill]
    new.state[FILL] = fill
    for name in ("queued", "visits", "owner"):
        getattr(new, name)[: len(old.queue)] = getattr(old, name)
    return new


@bare_kernel
def enqueue(a, v):
    """Put v at the end of the queue unless it is there."""
    if a.queued[v] == 0:
        a.queued[v] = 1
        a.queue[(a.state[HEAD] + a.state[FILL]) % len(a.queue)] = v
        a.state[FILL] += 1


@bare_kernel
def dequeue(a):
    """Take the first vertex from the queue, which must not be empty."""
    v = a.queue[a.state[HEAD]]
    a.state[HEAD] = (a.state[HEAD] + 1) % len(a.queue)
    a.state[FILL] -= 1
    a.queued[v] = 0
    return v


@bare_kernel
def irregular(m, v):
    """Whether v lives and has another degree than desired."""
    return m.vertex[v, HALF] >= 0 and m.vertex[v, PLACE] >= 0


@bare_kernel
def enlist(a, vertices):
    """Put vertices (N,) into the queue in this order."""
    for v in vertices:
        enqueue(a, v)


@bare_kernel
def descend(m, a, k, first, count, cap, floor, ceiling, extended, looks, operations, halfedges):
    """Apply operations that lower s, the best at each vertex of the queue, until it is empty.

    Each vertex is looked at with the elements around it; what an operation touches is queued again.
    Stops after `looks` vertices, or with operations and halfedges (N,) full; they receive what was
    done. Returns how many operations that were.
    """
    done = 0
    while looks > 0 and a.state[FILL] > 0 and done < len(operations):
        looks -= 1
        v = dequeue(a)
        if not irregular(m, v):
            continue
        best, operation, at = 0, -1, -1
        start = m.vertex[v, HALF]
        h = start
        for _ in range(m.vertex[v, DEGREE]):
            for g in range(h - h % k, h - h % k + k):
                for j in range(first, first + count):
                    # a change is cheap to tell where the operation makes sense at all
                    if m.edge[g, TWIN] < 0 and not _on_boundary_edges(j):
                        continue
                    change = score_change(m, j, g)
                    if change < best and permitted(m, j, g, cap, floor, ceiling, extended):
                        best, operation, at = change, j, g
            h = m.edge[preceding(h, k), TWIN]
            if h < 0 or h == start:
                break
        if at < 0:
            continue
        rewrite(m, operation, at)
        operations[done] = operation
        halfedges[done] = at
        done += 1
        for i in range(m.trace[TOUCHED_COUNT]):
            if irregular(m, m.trace[TRACE_IDS + i]):
                enqueue(a, m.trace[TRACE_IDS + i])
        if irregular(m, v):
            enqueue(a, v)
    return done


@bare_kernel
def _on_boundary_edges(operation):
    """Whether the operation has a meaning at a half-edge without twin: splits and collapses of
    triangles, collapses of quads.
    """
    return operation == TRI_SPLIT or operation == TRI_COLLAPSE or operation == QUAD_COLLAPSE


@bare_kernel
def settle(m, a, k, vertices, elements, better, seeds):
    """Account for a patch that has been worked on.

    vertices (N,): its vertices before, free again for other patches; elements (M,): its elements
    now, -1 for none. If it got better, its irregular vertices are due again, with those in `seeds`;
    if not, each of them counts one more visit in vain.
    """
    for v in vertices:
        a.owner[v] = 0
    for e in elements:
        if e < 0 or m.edge[e * k, ORIGIN] < 0:
            continue
        for h in range(e * k, e * k + k):
            v = m.edge[h, ORIGIN]
            if better:
                a.visits[v] = 0
                if irregular(m, v):
                    enqueue(a, v)
    if not better:
        for v in seeds:
            a.visits[v] += 1
            if irregular(m, v):
                enqueue(a, v)
