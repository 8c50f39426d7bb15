"""A queue of the irregular vertices of a large mesh, and greedy descent along it.

The queue is filled with all irregular vertices once, at the beginning. After that each operation
adds the irregular vertices that it touched, so the work is proportional to their number and not to
the size of the mesh.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_agent.env.candidates import permitted
from meshwright_core.core.arrays import (
    DEGREE,
    HALF,
    ORIGIN,
    PLACE,
    TOUCHED_COUNT,
    TRACE_IDS,
    TWIN,
    turned,
)
from meshwright_core.core.compilation import bare_kernel
from meshwright_core.core.references import by_reference
from meshwright_core.operations.catalogue import (
    needs_twin,
    rewrite,
    score_change,
)

# indices in Agenda.state
HEAD, FILL = 0, 1


@by_reference
class Agenda(NamedTuple):
    """Arrays by vertex slot (V,) and element slot (E,) of one mesh."""

    queue: np.ndarray
    """(V,) int32: a ring buffer of vertices, each at most once."""
    queued: np.ndarray
    """(V,) int8: 1 if a vertex is in the queue."""
    visits: np.ndarray
    """(V,) int8: consecutive patches around the vertex that brought no improvement."""
    owner: np.ndarray
    """(V,) int32: the number of the current patch of a vertex, from 1; 0 if it is in none."""
    place: np.ndarray
    """(E,) int32: scratch, zeros between calls."""
    number: np.ndarray
    """(V,) int32: scratch, zeros between calls."""
    state: np.ndarray
    """(2,) int64: the index of the first vertex in the ring buffer, and their number."""


def agenda(vertices: int, elements: int) -> Agenda:
    """An empty agenda for a mesh with so many vertex and element slots."""
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
    """A copy of an agenda for a mesh with more slots."""
    new = agenda(vertices, elements)
    fill = int(old.state[FILL])
    new.queue[:fill] = np.roll(old.queue, -int(old.state[HEAD]))[:fill]
    new.state[FILL] = fill
    for name in ("queued", "visits", "owner"):
        getattr(new, name)[: len(old.queue)] = getattr(old, name)
    return new


@bare_kernel
def enqueue(a, v):
    """Append v to the queue unless it is in it."""
    if a.queued[v] == 0:
        a.queued[v] = 1
        a.queue[(a.state[HEAD] + a.state[FILL]) % len(a.queue)] = v
        a.state[FILL] += 1


@bare_kernel
def dequeue(a):
    """Remove and return the first vertex of the queue, which must not be empty."""
    v = a.queue[a.state[HEAD]]
    a.state[HEAD] = (a.state[HEAD] + 1) % len(a.queue)
    a.state[FILL] -= 1
    a.queued[v] = 0
    return v


@bare_kernel
def irregular(m, v):
    """Whether v exists and is irregular."""
    return m.vertex[v, HALF] >= 0 and m.vertex[v, PLACE] >= 0


@bare_kernel
def enlist(a, vertices):
    """Append vertices (N,) to the queue in this order."""
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
                    # the change is cheap to compute, but undefined without a twin
                    if m.edge[g, TWIN] < 0 and needs_twin(j):
                        continue
                    change = score_change(m, j, g)
                    if change < best and permitted(m, j, g, cap, floor, ceiling, extended):
                        best, operation, at = change, j, g
            h = turned(m, h, k)
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
def settle(m, a, k, vertices, elements, better, seeds):
    """Update the agenda after an attempt to improve a patch.

    vertices (N,): its former vertices, which become free for other patches; elements (M,): its
    current elements, -1 for none; seeds (L,): its former irregular vertices. If it was improved,
    its irregular vertices are queued again; if not, the visits of `seeds` are counted up, and they
    are queued again.
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
