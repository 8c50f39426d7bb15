"""Circulation around a vertex in plain Python, for views and messages."""

from __future__ import annotations

from meshwright_core.core.arrays import DEGREE, HALF, ORIGIN, SIDES, TWIN, MeshArrays


def outgoing(m: MeshArrays, v: int) -> list[int]:
    """The half-edges that leave v, counter-clockwise; plain Python, for views and messages."""
    k = int(m.counters[SIDES])
    start = int(m.vertex[v, HALF])
    found: list[int] = []
    h = start
    for _ in range(int(m.vertex[v, DEGREE])):
        found.append(h)
        h = int(m.edge[h - 1 if h % k else h + k - 1, TWIN])
        if h < 0 or h == start:
            break
    return found


def neighbours(m: MeshArrays, v: int) -> list[int]:
    """The vertices joined to v, counter-clockwise; plain Python."""
    k = int(m.counters[SIDES])
    fan = outgoing(m, v)
    found = [int(m.edge[h + 1 if (h + 1) % k else h + 1 - k, ORIGIN]) for h in fan]
    last = fan[-1] - 1 if fan[-1] % k else fan[-1] + k - 1
    if m.edge[last, TWIN] < 0:
        found.append(int(m.edge[last, ORIGIN]))
    return found
