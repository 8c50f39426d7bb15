"""Which vertices correspond in two meshes of the same layout that differ in their ids."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.arrays import (
    ELEMENTS,
    FLAGS,
    GEOMETRIC,
    HALF,
    ORIGIN,
    SIDES,
    TWIN,
    VERTEX_SLOTS,
    MeshArrays,
)

Ids = NDArray[np.int64]


def matched_vertices(first: MeshArrays, second: MeshArrays) -> tuple[Ids, Ids] | None:
    """The ids (n,) of all vertices of `first`, and of those that correspond to them in `second`.

    The two come from one mesh by operations, so their geometric vertices have equal ids, and from
    one of these on the boundary everything else follows. None if they are not of the same layout,
    or if there is no such vertex.
    """
    k = int(first.counters[SIDES])
    begun = _first_corner(first, second)
    if begun is None or first.counters[ELEMENTS] != second.counters[ELEMENTS]:
        return None
    pairs = [begun]
    element_of: dict[int, int] = {}
    vertex_of: dict[int, int] = {}
    while pairs:
        a, b = pairs.pop()
        if a // k in element_of:
            if element_of[a // k] != b // k:
                return None
            continue
        element_of[a // k] = b // k
        for i in range(k):
            h, g = a - a % k + (a + i) % k, b - b % k + (b + i) % k
            u, v = int(first.edge[h, ORIGIN]), int(second.edge[g, ORIGIN])
            if vertex_of.setdefault(u, v) != v:
                return None
            across, other = int(first.edge[h, TWIN]), int(second.edge[g, TWIN])
            if (across < 0) != (other < 0):
                return None
            if across >= 0:
                pairs.append((across, other))
    if len(element_of) != first.counters[ELEMENTS]:
        return None
    return np.array(list(vertex_of)), np.array(list(vertex_of.values()))


def _first_corner(first: MeshArrays, second: MeshArrays) -> tuple[int, int] | None:
    """The boundary half-edges that leave the first geometric vertex of both meshes."""
    slots = min(int(first.counters[VERTEX_SLOTS]), int(second.counters[VERTEX_SLOTS]))
    for v in np.flatnonzero(first.vertex[:slots, FLAGS] & GEOMETRIC).tolist():
        a, b = int(first.vertex[v, HALF]), int(second.vertex[v, HALF])
        known = a >= 0 and b >= 0 and second.vertex[v, FLAGS] & GEOMETRIC
        if known and first.edge[a, TWIN] < 0 and second.edge[b, TWIN] < 0:
            return a, b
    return None
