"""All global lines of a quad mesh that may be cleaned up, as chains of vertices, to show them.

Each line is checked by itself in the present mesh: deleting one may make another deletable, or no
longer deletable, since two lines can cross or share an element.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from meshwright_core.core.arrays import (
    DEGREE,
    ELEMENT_SLOTS,
    HALF,
    ORIGIN,
    TWIN,
    VERTEX_SLOTS,
    VERTICES,
    following,
    on_boundary,
    turned,
)
from meshwright_core.core.compilation import kernel
from meshwright_core.operations.global_lines import check_cleanup, is_ring
from meshwright_core.operations.refusals import ALLOWED, NEED_ROOM

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


class CleanableLine(NamedTuple):
    """One line that may be deleted."""

    halfedge: int
    """A half-edge on it: the one to apply `cleanup` to."""
    vertices: np.ndarray
    """(n,) the vertices along it; a closed line ends with the vertex it begins with."""

    @property
    def closed(self) -> bool:
        """Whether it is a ring."""
        return bool(self.vertices[0] == self.vertices[-1])


@kernel
def _follow(m, h, chain, count):
    """Write the vertices of the allowed line that begins with h from chain[count] on; its end."""
    start = h
    chain[count] = m.edge[h, ORIGIN]
    count += 1
    for _ in range(m.counters[VERTICES]):
        v = m.edge[m.edge[h, TWIN], ORIGIN]
        chain[count] = v
        count += 1
        if on_boundary(m, v):
            break
        h = following(m.edge[following(h, 4), TWIN], 4)
        if h == start:
            break
    return count


@kernel
def find_lines(m, cap):
    """Half-edges (n,) that begin the lines that may be cleaned up, the ends of their chains (n,),
    and the chains, one after the other.

    Every vertex of a line is regular, so that two lines at most run through it.
    """
    starts = np.empty(m.counters[VERTICES] + 1, np.int64)
    ends = np.empty(m.counters[VERTICES] + 1, np.int64)
    chain = np.empty(4 * m.counters[VERTICES] + 4, np.int64)
    found, count = 0, 0
    for v in range(m.counters[VERTEX_SLOTS]):
        if m.vertex[v, HALF] < 0 or m.vertex[v, DEGREE] != 3 or not on_boundary(m, v):
            continue
        h = turned(m, m.vertex[v, HALF], 4)
        code = check_cleanup(m, h, cap)
        if code != ALLOWED and code != NEED_ROOM:
            continue
        end = _follow(m, h, chain, count)
        if chain[end - 1] < v:
            continue  # found already from its other end
        starts[found], ends[found] = h, end
        found, count = found + 1, end
    seen = np.zeros(m.counters[ELEMENT_SLOTS] * 4, np.uint8)
    for start in range(len(seen)):
        if is_ring(m, start, seen, cap):
            count = _follow(m, start, chain, count)
            starts[found], ends[found] = start, count
            found += 1
    return starts[:found], ends[:found], chain[:count]


def cleanable_lines(mesh: HalfEdgeMesh) -> list[CleanableLine]:
    """Every line of `mesh` that `cleanup` would delete now; [] for triangles. O(half-edges)."""
    if mesh.k == 3:
        return []
    starts, ends, chain = find_lines(mesh.arrays, mesh.degree_cap)
    pieces = np.split(chain, ends[:-1]) if len(ends) else []
    return [CleanableLine(int(h), piece) for h, piece in zip(starts, pieces, strict=True)]
