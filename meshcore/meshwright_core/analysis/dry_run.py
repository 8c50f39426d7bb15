"""Dry run of an operation: apply it with a journal of its own, read the changes, and undo it.

The journal of the mesh is not touched, so that its undo and redo stay as they are.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np

from meshwright_core.core.arrays import (
    DEGREE,
    DESIRED,
    ELEMENT_SLOTS,
    GROUPED,
    HALF,
    JOURNAL_TOP,
    JOURNALLING,
    NEW_COUNT,
    RESTORED,
    SIDES,
    STEP,
    STEP_COLUMNS,
    STEP_END,
    TRACE_IDS,
    VERTEX_COLUMNS,
    MeshArrays,
    corners_of,
)
from meshwright_core.errors import OperationRefused
from meshwright_core.history import journal
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations import catalogue, refusals
from meshwright_core.operations.catalogue import Operation

Result = TypeVar("Result")

_ENTRIES = 1024
"""Room for journal entries at the first attempt."""


@dataclass(frozen=True)
class DryRun:
    """The changes that `operation` at half-edge `halfedge` makes; ids are those after it.

    An edge that is only split in two, or two edges that become one, count neither as added nor as
    removed.
    """

    operation: Operation
    halfedge: int
    score_change: int
    added: np.ndarray
    """(n, 2, 3) ends of each added edge, new vertices at their initial positions."""
    removed: np.ndarray
    """(m, 2, 3) ends of each removed edge."""
    vertices: np.ndarray
    """(p,) vertices whose Delta changes, new ones included."""
    places: np.ndarray
    """(p, 3) their positions."""
    delta: np.ndarray
    """(p,) their Delta after the operation."""
    new_vertices: np.ndarray
    """(q,) ids of the vertices that the operation creates."""
    gone: np.ndarray
    """(g, 3) positions of the vertices that the operation deletes."""


class _State(NamedTuple):
    """Edges and vertices of some elements, before or after the operation."""

    keys: np.ndarray
    """(n,) the edges of the elements as sorted numbers, one for each pair of vertices."""
    ends: np.ndarray
    """(n, 2) their vertex ids."""
    segments: np.ndarray
    """(n, 2, 3) the positions of their ends."""
    alive: np.ndarray
    """(p,) which of the vertices are live."""
    delta: np.ndarray
    """(p,)"""
    places: np.ndarray
    """(p, 3)"""


def dry_run(mesh: HalfEdgeMesh, operation: Operation | str, h: int) -> DryRun:
    """The changes that the operation makes at half-edge h, without smoothing.

    The mesh stays as it is to the bit, with its undo and redo; only its arrays may be enlarged.
    Raises OperationRefused where :meth:`HalfEdgeMesh.check` refuses it.
    """
    verdict = mesh.check(operation, h)
    if not verdict:
        raise OperationRefused(f"{operation} at half-edge {h} is not allowed: {verdict.reason}")
    return _aside(
        mesh, operation, h, lambda aside, change: _read(aside, Operation(operation), h, change)
    )


def score_change(mesh: HalfEdgeMesh, operation: Operation | str, h: int) -> int:
    """The change of s, for an operation that :meth:`HalfEdgeMesh.check` allows at h.

    For operations without a formula; cheaper than :func:`dry_run`.
    """
    return _aside(mesh, operation, h, _undone)


def _undone(aside: MeshArrays, change: int) -> int:
    journal.undo(aside)
    return change


def _aside(
    mesh: HalfEdgeMesh,
    operation: Operation | str,
    h: int,
    then: Callable[[MeshArrays, int], Result],
) -> Result:
    """Apply the operation with another journal; `then` gets the change of s and undoes it."""
    code = catalogue.CODES[mesh.k][Operation(operation)]
    entries = _ENTRIES
    while True:
        held = mesh.arrays.counters.copy()
        aside = mesh.arrays._replace(
            journal=np.zeros((entries, 2), np.int64), steps=np.zeros((1, STEP_COLUMNS), np.int64)
        )
        aside.counters[[JOURNAL_TOP, STEP, STEP_END, GROUPED]] = 0
        aside.counters[JOURNALLING] = 1
        try:
            done = catalogue.apply_once(aside, code, h, mesh.degree_cap)
            if done.code == refusals.ALLOWED:
                return then(aside, done.score_change)
        finally:
            aside.counters[RESTORED:] = held[RESTORED:]
        vertices, elements, more = aside.trace[TRACE_IDS : TRACE_IDS + 3].tolist()
        entries = max(entries, more)
        _make_room(mesh, vertices, elements)


def _make_room(mesh: HalfEdgeMesh, vertices: int, elements: int) -> None:
    """Room for so many more vertices and elements, at least doubled so that this is rare."""
    arrays = mesh.arrays
    slots = int(arrays.counters[ELEMENT_SLOTS])
    short = mesh.slots + vertices > len(arrays.vertex)
    if short or slots + elements > len(arrays.element_mark):
        mesh.reserve(max(vertices, mesh.slots), max(elements, slots))


def _read(aside: MeshArrays, operation: Operation, h: int, change: int) -> DryRun:
    """Undo the operation and compare the states before and after it."""
    entries = aside.journal[: aside.counters[JOURNAL_TOP], 0]
    index, kind = entries // journal.WRITE_KINDS, entries % journal.WRITE_KINDS
    k = int(aside.counters[SIDES])
    elements = np.unique(index[kind == journal.EDGE_WRITE] // (2 * k))
    vertices = np.unique(index[kind == journal.VERTEX_WRITE] // VERTEX_COLUMNS)
    new = aside.trace[TRACE_IDS : TRACE_IDS + int(aside.trace[NEW_COUNT])].astype(np.int64)
    try:
        after = _state(aside, elements, vertices)
        new_places = aside.points[new].copy()
    finally:
        journal.undo(aside)
    before = _state(aside, elements, vertices)
    added = ~np.isin(after.keys, before.keys)
    removed = ~np.isin(before.keys, after.keys)
    if operation == Operation.CLEANUP:
        gone = vertices[before.alive & ~after.alive]
        _join(before, removed, after, added, gone)
    elif len(new):
        _halve(before, removed, after, added, new, new_places)
    differs = after.alive & ((after.delta != before.delta) | ~before.alive)
    return DryRun(
        operation=operation,
        halfedge=h,
        score_change=change,
        added=after.segments[added],
        removed=before.segments[removed],
        vertices=vertices[differs],
        places=after.places[differs],
        delta=after.delta[differs],
        new_vertices=new,
        gone=before.places[before.alive & ~after.alive],
    )


def _state(m: MeshArrays, elements: np.ndarray, vertices: np.ndarray) -> _State:
    corners = corners_of(m, elements)
    corners = corners[corners[:, 0] >= 0]
    a, b = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    low, high = np.minimum(a, b), np.maximum(a, b)
    keys, first = np.unique(low * len(m.vertex) + high, return_index=True)
    ends = np.column_stack([low[first], high[first]])
    rows = m.vertex[vertices]
    return _State(
        keys=keys,
        ends=ends,
        segments=m.points[ends],
        alive=rows[:, HALF] >= 0,
        delta=(rows[:, DEGREE] - rows[:, DESIRED]).astype(np.int64),
        places=m.points[vertices],
    )


def _halve(
    before: _State,
    removed: np.ndarray,
    after: _State,
    added: np.ndarray,
    new: np.ndarray,
    places: np.ndarray,
) -> None:
    """Drop edges that a new vertex splits from `removed`, and their halves from `added`."""
    rows = np.flatnonzero(removed).tolist()
    middles = 0.5 * (before.segments[rows, 0] + before.segments[rows, 1])
    halved = {middle.tobytes(): row for row, middle in zip(rows, middles, strict=True)}
    fresh = _rows_of(after, added)
    for v, place in zip(new.tolist(), places, strict=True):
        row = halved.get(place.tobytes())
        if row is None:
            continue
        x, y = before.ends[row].tolist()
        halves = fresh.get((min(x, v), max(x, v))), fresh.get((min(y, v), max(y, v)))
        if halves[0] is not None and halves[1] is not None:
            removed[row] = added[halves[0]] = added[halves[1]] = False


def _join(
    before: _State, removed: np.ndarray, after: _State, added: np.ndarray, gone: np.ndarray
) -> None:
    """Drop pairs of edges that become one where a line is deleted: only the line is removed."""
    going = set(gone.tolist())
    beside: dict[int, list[tuple[int, int]]] = {v: [] for v in going}
    for (a, b), row in _rows_of(before, removed).items():
        if (a in going) != (b in going):
            v, other = (a, b) if a in going else (b, a)
            beside[v].append((other, row))
    fresh = _rows_of(after, added)
    for found in beside.values():
        if len(found) == 2:
            (p, first), (q, second) = sorted(found)
            joint = fresh.get((p, q))
            if joint is not None:
                removed[first] = removed[second] = added[joint] = False


def _rows_of(state: _State, chosen: np.ndarray) -> dict[tuple[int, int], int]:
    """The chosen edges of `state` by their ends."""
    rows = np.flatnonzero(chosen)
    return {
        (a, b): row for (a, b), row in zip(state.ends[rows].tolist(), rows.tolist(), strict=True)
    }
