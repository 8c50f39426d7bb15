"""Validates arrays that were read from a file before they are used as a mesh.

:mod:`meshwright_core.core.validation` checks a mesh vertex by vertex, for tests; here whole arrays
are checked, and no index is used before it is known to be in range.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

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
    FREE_VERTEX,
    HALF,
    IRREGULAR,
    NAMING,
    ORIGIN,
    PLACE,
    RESTORED,
    SCORE,
    SIDES,
    TWIN,
    VERTEX_COLUMNS,
    VERTEX_SLOTS,
    VERTICES,
    MeshArrays,
)
from meshwright_core.core.construction import halves_of, twins_of
from meshwright_core.core.vertex_flags import UNMOVED
from meshwright_core.errors import MeshError
from meshwright_core.history.journal import (
    EDGE_WRITE,
    LIST_WRITE,
    PARAMETER_WRITE,
    POINT_WRITE,
    REGION_WRITE,
    VERTEX_WRITE,
    WRITE_KINDS,
)
from meshwright_core.history.packed_steps import COUNTERS, Steps, unpack

_MOST = np.iinfo(np.int32).max


def _require(condition: bool | np.bool_, sentence: str) -> None:
    if not condition:
        raise MeshError(sentence)


def require_sound(m: MeshArrays, k: int) -> None:
    """Raise MeshError unless all invariants of :mod:`meshwright_core.core.arrays` hold.

    Nothing about the numbers in the arrays is taken for granted.
    """
    slots, element_slots = int(m.counters[VERTEX_SLOTS]), int(m.counters[ELEMENT_SLOTS])
    _require(0 < slots <= len(m.vertex), "its number of vertices is wrong")
    _require(0 < element_slots <= len(m.element_mark), "its number of elements is wrong")
    _require(np.isfinite(m.points).all(), "a coordinate is not a finite number")
    origin = m.edge[: element_slots * k, ORIGIN].reshape(-1, k)
    alive: np.ndarray = np.all(origin >= 0, axis=1)
    _require((origin[~alive] == -1).all(), "an element is half dead")
    _require(alive.any(), "the mesh has no elements")
    _require((origin < slots).all(), "an element names a vertex that does not exist")
    ids = np.flatnonzero(alive)
    elements = origin[ids].astype(np.int64)
    ordered = np.sort(elements, axis=1)
    _require((ordered[:, 1:] != ordered[:, :-1]).all(), "an element repeats a vertex")
    twin = twins_of(elements)
    half = halves_of(elements, twin, slots)
    in_slots = np.where(twin >= 0, ids[twin // k] * k + twin % k, -1)
    stored = m.edge[: element_slots * k, TWIN].reshape(-1, k)
    _require((stored[ids].ravel() == in_slots).all(), "two elements disagree about their edge")
    _check_vertices(m, k, elements, twin, ids, half)
    _check_scores(m, elements, twin)
    _check_chains(m, k, half < 0, ~alive)


def _check_vertices(
    m: MeshArrays,
    k: int,
    elements: np.ndarray,
    twin: np.ndarray,
    ids: np.ndarray,
    half: np.ndarray,
) -> None:
    slots, limit = len(half), int(m.counters[ELEMENT_SLOTS]) * k
    live = half >= 0
    stored = m.vertex[:slots, HALF].astype(np.int64)
    _require(((stored >= 0) == live).all(), "a dead vertex belongs to an element")
    _require((stored < limit).all(), "a vertex names a half-edge that does not exist")
    _require(
        (m.edge[stored[live], ORIGIN] == np.flatnonzero(live)).all(),
        "a vertex has a wrong half-edge",
    )
    starts = np.flatnonzero(twin < 0)
    on_boundary = np.zeros(slots, bool)
    on_boundary[elements.ravel()[starts]] = True
    expected = ids[half // k] * k + half % k
    _require((stored == expected)[on_boundary].all(), "a boundary vertex has a wrong half-edge")
    degree = np.bincount(elements.ravel(), minlength=slots) + on_boundary
    _require((m.vertex[:slots, DEGREE] == degree).all(), "a vertex has a wrong degree")
    least = 3 if k == 3 else 2
    _require((degree[live & ~on_boundary] >= least).all(), "a vertex has too few edges")
    desired = m.vertex[:slots, DESIRED]
    _require((desired[live] >= 1).all(), "a desired degree is not positive")
    _require((desired[~live] == 0).all(), "a dead vertex has a desired degree")
    flags = m.vertex[:slots, FLAGS]
    _require(((flags & ~UNMOVED) == 0).all(), "a vertex has unknown flags")


def _check_scores(m: MeshArrays, elements: np.ndarray, twin: np.ndarray) -> None:
    slots = int(m.counters[VERTEX_SLOTS])
    rows = m.vertex[:slots].astype(np.int64)
    delta = rows[:, DEGREE] - rows[:, DESIRED]
    irregular = np.flatnonzero(delta)
    for counter, value in (
        (VERTICES, (rows[:, HALF] >= 0).sum()),
        (ELEMENTS, len(elements)),
        (BOUNDARY_EDGES, (twin < 0).sum()),
        (SCORE, np.abs(delta).sum()),
        (DELTA_SUM, delta.sum()),
        (IRREGULAR, len(irregular)),
    ):
        _require(int(m.counters[counter]) == int(value), "its counts and scores are wrong")
    listed = m.irregular[: len(irregular)]
    _require((np.sort(listed) == irregular).all(), "its list of irregular vertices is wrong")
    place = np.full(slots, -1)
    place[listed] = np.arange(len(listed))
    _require((rows[:, PLACE] == place).all(), "its list of irregular vertices is wrong")


def _check_chains(m: MeshArrays, k: int, dead: np.ndarray, dead_elements: np.ndarray) -> None:
    """The chains of free slots hold each dead slot once."""
    ahead = -2 - m.vertex[: len(dead), HALF].astype(np.int64)
    _follow(int(m.counters[FREE_VERTEX]), ahead, dead)
    _follow(
        int(m.counters[FREE_ELEMENT]), m.edge[: len(dead_elements) * k : k, TWIN], dead_elements
    )


def _follow(at: int, ahead: np.ndarray, dead: np.ndarray) -> None:
    left = dead.copy()
    for _ in range(int(dead.sum())):
        _require(0 <= at < len(left) and left[at], "its list of free places is wrong")
        left[at] = False
        at = int(ahead[at])
    _require(at == -1, "its list of free places is wrong")


def require_within(steps: Steps, m: MeshArrays, namings: Sequence[int]) -> None:
    """Raise MeshError unless every write of the steps, done or undone, stays within the arrays and
    puts there what may point no farther. namings: the numbers of names that there are.
    """
    k, vertices, elements = int(m.counters[SIDES]), len(m.vertex), len(m.element_mark)
    entries, places = unpack(steps)[1], steps.places
    _require((places >= 0).all(), "a step of the history writes nowhere")
    _require(np.isfinite(steps.coordinates).all(), "a coordinate of the history is not finite")
    _require(np.isfinite(steps.parameters).all(), "a parameter of the history is not finite")
    halfedges = k * elements
    counters = steps.rows[:, COUNTERS:]
    lowest, highest = np.zeros(RESTORED, np.int64), np.zeros(RESTORED, np.int64)
    for counter, low, high in (
        (VERTEX_SLOTS, 0, vertices),
        (ELEMENT_SLOTS, 0, elements),
        (VERTICES, 0, vertices),
        (ELEMENTS, 0, elements),
        (BOUNDARY_EDGES, 0, halfedges),
        (FREE_VERTEX, -1, vertices - 1),
        (FREE_ELEMENT, -1, elements - 1),
        (SCORE, 0, _MOST),
        (DELTA_SUM, -_MOST, _MOST),
        (IRREGULAR, 0, vertices),
    ):
        lowest[counter], highest[counter] = low, high
    inside = (counters >= lowest) & (counters <= highest)
    _require(inside.all(), "a step of the history has impossible counts")
    index, written = entries[:, 0] // WRITE_KINDS, entries[:, 0] % WRITE_KINDS
    value = entries[:, 1]
    good = (written == POINT_WRITE) & (index < 3 * vertices)
    good |= (written == PARAMETER_WRITE) & (index < vertices)
    for form, width, length, column, low, high in (
        (EDGE_WRITE, 2, halfedges, ORIGIN, -1, vertices - 1),
        (EDGE_WRITE, 2, halfedges, TWIN, -1, halfedges - 1),
        (VERTEX_WRITE, VERTEX_COLUMNS, vertices, HALF, -1 - vertices, halfedges - 1),
        (VERTEX_WRITE, VERTEX_COLUMNS, vertices, DEGREE, 0, vertices),
        (VERTEX_WRITE, VERTEX_COLUMNS, vertices, DESIRED, 0, _MOST),
        (VERTEX_WRITE, VERTEX_COLUMNS, vertices, FLAGS, 0, UNMOVED),
        (VERTEX_WRITE, VERTEX_COLUMNS, vertices, PLACE, -1, vertices - 1),
        (VERTEX_WRITE, VERTEX_COLUMNS, vertices, CURVE, -1, len(m.interface) - 1),
        (LIST_WRITE, 1, vertices, 0, -1, vertices - 1),
        (REGION_WRITE, 1, elements, 0, 0, int(m.region.max())),
    ):
        these = (written == form) & (index % width == column) & (index < width * length)
        good |= these & (value >= low) & (value <= high)
    naming = (written == VERTEX_WRITE) & (index == NAMING)
    good |= naming & np.isin(value, namings)
    _require(good.all(), "a step of the history points beyond the mesh")
    first = places[places % WRITE_KINDS == POINT_WRITE] // WRITE_KINDS
    _require((first % 3 == 0).all(), "a move of the history begins in the middle")
