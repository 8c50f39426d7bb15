"""Checks every invariant of :mod:`meshwright_core.core.arrays`, element by element.

It reads the raw arrays and avoids the traversal functions that it is meant to check.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from meshwright_core.core.arrays import (
    BOUNDARY_EDGES,
    DEGREE,
    DELTA_SUM,
    DESIRED,
    ELEMENT_SLOTS,
    ELEMENTS,
    FREE_ELEMENT,
    FREE_VERTEX,
    HALF,
    IRREGULAR,
    MARK,
    ORIGIN,
    PLACE,
    SCORE,
    SIDES,
    TWIN,
    VERTEX_SLOTS,
    VERTICES,
    MeshArrays,
)
from meshwright_core.core.curve_checks import require_seats
from meshwright_core.core.mesh_boundary import MeshBoundary
from meshwright_core.errors import MeshError


def _require(condition: bool, sentence: str) -> None:
    if not condition:
        raise MeshError(f"broken mesh: {sentence}")


def validate(m: MeshArrays, boundary: MeshBoundary) -> None:
    """Raise MeshError, saying which invariant is broken and where, unless all hold."""
    elements = _check_elements(m)
    edges = _check_twins(m, elements)
    _check_vertices(m, elements, edges)
    _check_counters(m, edges)
    _check_free_slots(m)
    try:
        # patches of searches have a boundary but no curves
        if boundary.count:
            require_seats(m, boundary)
    except MeshError as error:
        raise MeshError(f"broken mesh: {error}") from None


def _check_elements(m: MeshArrays) -> dict[int, list[int]]:
    """Invariant 1; returns the corners of each live element."""
    k = int(m.counters[SIDES])
    slots = int(m.counters[ELEMENT_SLOTS])
    elements = {}
    for e in range(slots):
        corners = m.edge[e * k : e * k + k, ORIGIN].tolist()
        if all(v == -1 for v in corners):
            continue
        _require(min(corners) >= 0, f"element {e} is half dead: {corners}")
        _require(len(set(corners)) == k, f"element {e} repeats a vertex: {corners}")
        for v in corners:
            _require(v < m.counters[VERTEX_SLOTS], f"element {e} names vertex {v} beyond the last")
            _require(m.vertex[v, HALF] >= 0, f"element {e} names the dead vertex {v}")
        elements[e] = corners
    _require(bool((m.edge[slots * k :, ORIGIN] == -1).all()), "an unused element slot is not empty")
    return elements


def _check_twins(m: MeshArrays, elements: dict[int, list[int]]) -> dict[tuple[int, int], int]:
    """Invariants 2 and 3; returns the half-edge of each pair (origin, target)."""
    k = int(m.counters[SIDES])
    directed: dict[tuple[int, int], int] = {}
    for e, corners in elements.items():
        for i, a in enumerate(corners):
            pair = (a, corners[(i + 1) % k])
            _require(pair not in directed, f"two half-edges run from {pair[0]} to {pair[1]}")
            directed[pair] = e * k + i
    for (a, b), h in directed.items():
        expected = directed.get((b, a), -1)
        found = int(m.edge[h, TWIN])
        _require(found == expected, f"half-edge {h} ({a}-{b}) has twin {found}, not {expected}")
    return directed


def _check_vertices(
    m: MeshArrays, elements: dict[int, list[int]], directed: dict[tuple[int, int], int]
) -> None:
    """Invariants 4 and 5: each vertex has one fan of elements, and its degree is right."""
    k = int(m.counters[SIDES])
    joined: dict[int, set[int]] = defaultdict(set)
    for a, b in directed:
        joined[a].add(b)
        joined[b].add(a)
    corner_links: dict[int, dict[int, int]] = defaultdict(dict)
    for corners in elements.values():
        for i, v in enumerate(corners):
            # in the link of v, the element leads from its next corner to its previous one
            corner_links[v][corners[(i + 1) % k]] = corners[i - 1]
    boundary_out = {a: h for (a, b), h in directed.items() if (b, a) not in directed}
    for v in range(int(m.counters[VERTEX_SLOTS])):
        half, degree = int(m.vertex[v, HALF]), int(m.vertex[v, DEGREE])
        if half < 0:
            _require(v not in joined, f"the dead vertex {v} is part of an element")
            _require(degree == 0 and m.vertex[v, DESIRED] == 0, f"the dead vertex {v} has a degree")
            continue
        _require(v in joined, f"vertex {v} belongs to no element")
        _require(int(m.edge[half, ORIGIN]) == v, f"the half-edge of vertex {v} starts elsewhere")
        _require(degree == len(joined[v]), f"vertex {v} has degree {degree}, not {len(joined[v])}")
        _require(degree >= 2, f"vertex {v} has degree {degree}")
        links = corner_links[v]
        if v in boundary_out:
            _require(half == boundary_out[v], f"boundary vertex {v} does not start its sweep right")
            start = int(m.edge[half + 1 if (half + 1) % k else half + 1 - k, ORIGIN])
        else:
            _require(k == 4 or degree > 2, f"interior vertex {v} has degree {degree}")
            start = next(iter(links))
        met, at = 0, start
        while at in links and met < len(links):
            at = links[at]
            met += 1
        _require(met == len(links), f"vertex {v} is pinched: its elements form more than one fan")


def _check_counters(m: MeshArrays, directed: dict[tuple[int, int], int]) -> None:
    """Invariants 6, 7 and 8."""
    k = int(m.counters[SIDES])
    slots = int(m.counters[VERTEX_SLOTS])
    live = m.vertex[:slots, HALF] >= 0
    delta = m.vertex[:slots, DEGREE] - m.vertex[:slots, DESIRED]
    boundary = sum((b, a) not in directed for a, b in directed)
    expected = {
        VERTICES: int(live.sum()),
        ELEMENTS: len(directed) // k,
        BOUNDARY_EDGES: boundary,
        SCORE: int(np.abs(delta).sum()),
        DELTA_SUM: int(delta.sum()),
        IRREGULAR: int((delta != 0).sum()),
    }
    for counter, value in expected.items():
        found = int(m.counters[counter])
        _require(found == value, f"counter {counter} is {found}, not {value}")
    listed = m.irregular[: expected[IRREGULAR]].tolist()
    _require(
        sorted(listed) == np.flatnonzero(delta).tolist(),
        f"the list of irregular vertices is {sorted(listed)}",
    )
    for place, v in enumerate(listed):
        _require(int(m.vertex[v, PLACE]) == place, f"irregular vertex {v} does not know its place")
    _require(
        bool((m.vertex[:slots, PLACE][delta == 0] == -1).all()), "a regular vertex has a place"
    )
    _require(not m.vertex[:, MARK].any(), "a vertex mark was left behind")
    _require(not m.element_mark.any(), "an element mark was left behind")


def _check_free_slots(m: MeshArrays) -> None:
    """The chains of dead slots hold every dead slot once."""
    k = int(m.counters[SIDES])
    chain: list[int] = []
    v = int(m.counters[FREE_VERTEX])
    while v >= 0 and len(chain) <= len(m.vertex):
        chain.append(v)
        v = -2 - int(m.vertex[v, HALF])
    dead = np.flatnonzero(m.vertex[: int(m.counters[VERTEX_SLOTS]), HALF] < 0).tolist()
    _require(sorted(chain) == dead, "the chain of dead vertices misses some or repeats one")
    chain = []
    e = int(m.counters[FREE_ELEMENT])
    while e >= 0 and len(chain) <= len(m.element_mark):
        chain.append(e)
        e = int(m.edge[e * k, TWIN])
    slots = int(m.counters[ELEMENT_SLOTS])
    dead = np.flatnonzero(m.edge[: slots * k : k, ORIGIN] < 0).tolist()
    _require(sorted(chain) == dead, "the chain of dead elements misses some or repeats one")
