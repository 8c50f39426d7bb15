"""The catalogue of operations, and one compiled `check`, `rewrite` and `score_change` over all of
them.

Every change of connectivity, by a person or by the agent, is one operation on one half-edge.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numba

from meshcore import chords, global_lines, global_split, quad_edits, triangle_edits
from meshcore.compiled import bare_kernel, bare_shared_kernel
from meshcore.halfedge import (
    DEGREE,
    DESIRED,
    ELEMENT_SLOTS,
    NEW_COUNT,
    ORIGIN,
    SCORE,
    SIDES,
    TOUCHED_COUNT,
    TRACE_IDS,
    TWIN,
    MeshArrays,
    following,
    preceding,
)
from meshcore.journal import begin_step, end_step
from meshcore.merging import survivor
from meshcore.refusals import ALLOWED, DEAD_HALFEDGE


class Operation(StrEnum):
    """The names of the operations; a plain string of the same value serves as well."""

    FLIP = "flip"
    FLIP_LEFT = "flip_left"
    FLIP_RIGHT = "flip_right"
    SPLIT = "split"
    COLLAPSE = "collapse"
    GLOBAL_SPLIT = "global_split"
    CLEANUP = "cleanup"
    CHORD_COLLAPSE = "chord_collapse"


# codes for compiled kernels; triangles and quads do not share codes
TRI_FLIP, TRI_SPLIT, TRI_COLLAPSE = 0, 1, 2
FLIP_LEFT, FLIP_RIGHT, QUAD_SPLIT, QUAD_COLLAPSE = 3, 4, 5, 6
GLOBAL_SPLIT, CLEANUP, CHORD_COLLAPSE = 7, 8, 9

CODES: dict[int, dict[str, int]] = {
    3: {
        Operation.FLIP: TRI_FLIP,
        Operation.SPLIT: TRI_SPLIT,
        Operation.COLLAPSE: TRI_COLLAPSE,
    },
    4: {
        Operation.FLIP_LEFT: FLIP_LEFT,
        Operation.FLIP_RIGHT: FLIP_RIGHT,
        Operation.SPLIT: QUAD_SPLIT,
        Operation.COLLAPSE: QUAD_COLLAPSE,
        Operation.GLOBAL_SPLIT: GLOBAL_SPLIT,
        Operation.CLEANUP: CLEANUP,
        Operation.CHORD_COLLAPSE: CHORD_COLLAPSE,
    },
}
"""Codes by number of sides and name; `Operation` members and strings hash alike."""

NAMES: dict[int, Operation] = {
    code: Operation(name) for codes in CODES.values() for name, code in codes.items()
}


@dataclass(frozen=True)
class OperationInfo:
    """What the menus, the help and the README say of an operation."""

    operation: Operation
    kind: str
    """"tri" or "quad"."""
    title: str
    summary: str
    key: str
    """The key that does it in the editor."""
    beyond_paper: bool = False


CATALOGUE = (
    OperationInfo(
        Operation.FLIP,
        "tri",
        "Flip edge",
        "turns the edge between two triangles to join their other corners",
        "F",
    ),
    OperationInfo(
        Operation.SPLIT,
        "tri",
        "Split edge",
        "puts a vertex on the edge and joins it to the corners across",
        "S",
    ),
    OperationInfo(
        Operation.COLLAPSE,
        "tri",
        "Collapse edge",
        "merges the ends of the edge; its triangles go (on the boundary: beyond the paper)",
        "C",
    ),
    OperationInfo(
        Operation.FLIP_LEFT,
        "quad",
        "Flip left",
        "turns the edge counter-clockwise in the hexagon of its two quads",
        "F",
    ),
    OperationInfo(
        Operation.FLIP_RIGHT,
        "quad",
        "Flip right",
        "turns the edge clockwise in the hexagon of its two quads",
        "R",
    ),
    OperationInfo(
        Operation.SPLIT,
        "quad",
        "Split vertex",
        "splits the vertex where the half-edge starts; a quad opens along the edge",
        "S",
    ),
    OperationInfo(
        Operation.COLLAPSE,
        "quad",
        "Collapse quad",
        "merges the vertex where the half-edge starts with the opposite corner of its quad",
        "C",
    ),
    OperationInfo(
        Operation.GLOBAL_SPLIT,
        "quad",
        "Global split",
        "opens the edge into a quad and carries the cut both ways to the boundary",
        "G",
    ),
    OperationInfo(
        Operation.CLEANUP,
        "quad",
        "Clean up line",
        "deletes the straight line of regular vertices through the edge",
        "X",
    ),
    OperationInfo(
        Operation.CHORD_COLLAPSE,
        "quad",
        "Collapse strip",
        "shrinks the strip of quads that crosses the edge to a line",
        "V",
        beyond_paper=True,
    ),
)


def of_kind(kind: str) -> tuple[OperationInfo, ...]:
    """The operations of "tri" or "quad" meshes, in the order of the catalogue."""
    return tuple(info for info in CATALOGUE if info.kind == kind)


@bare_shared_kernel
def check(m, operation, h, cap):
    """A code of :mod:`meshcore.refusals`: may `operation` be applied to h? No side effect.

    cap: the highest degree that a vertex may get; 0 for no limit.
    """
    if h < 0 or h >= m.counters[ELEMENT_SLOTS] * m.counters[SIDES] or m.edge[h, ORIGIN] < 0:
        return DEAD_HALFEDGE
    if operation == TRI_FLIP:
        return triangle_edits.check_flip(m, h, cap)
    if operation == TRI_SPLIT:
        return triangle_edits.check_split(m, h, cap)
    if operation == TRI_COLLAPSE:
        return triangle_edits.check_collapse(m, h, cap)
    if operation == FLIP_LEFT:
        return quad_edits.check_flip_left(m, h, cap)
    if operation == FLIP_RIGHT:
        return quad_edits.check_flip_right(m, h, cap)
    if operation == QUAD_SPLIT:
        return quad_edits.check_split(m, h, cap)
    if operation == QUAD_COLLAPSE:
        return quad_edits.check_collapse(m, h, cap)
    if operation == GLOBAL_SPLIT:
        return global_split.check_global_split(m, h, cap)
    if operation == CLEANUP:
        return global_lines.check_cleanup(m, h, cap)
    return chords.check_chord_collapse(m, h, cap)


@bare_shared_kernel
def rewrite(m, operation, h):
    """Apply an operation that :func:`check` allowed, as one step of the journal."""
    begin_step(m, operation, h)
    if operation == TRI_FLIP:
        triangle_edits.flip(m, h)
    elif operation == TRI_SPLIT:
        triangle_edits.split(m, h)
    elif operation == TRI_COLLAPSE:
        triangle_edits.collapse(m, h)
    elif operation == FLIP_LEFT:
        quad_edits.flip_left(m, h)
    elif operation == FLIP_RIGHT:
        quad_edits.flip_right(m, h)
    elif operation == QUAD_SPLIT:
        quad_edits.split(m, h)
    elif operation == QUAD_COLLAPSE:
        quad_edits.collapse(m, h)
    elif operation == GLOBAL_SPLIT:
        global_split.global_split(m, h)
    elif operation == CLEANUP:
        global_lines.cleanup(m, h)
    else:
        chords.chord_collapse(m, h)
    end_step(m)


def provide_rewrite(arrays: MeshArrays) -> None:
    """Compile :func:`rewrite` for such arrays, or load it, without applying an operation."""
    shared: Any = rewrite
    shared.provide((numba.typeof(arrays), numba.int64, numba.int64))


@bare_kernel
def check_once(
    edge, vertex, points, irregular, element_mark, trace, counters, journal, steps,
    operation, h, cap,
):  # fmt: skip
    """:func:`check` for callers in Python, who hand over arrays one by one at half the cost."""
    m = MeshArrays(
        edge, vertex, points, irregular, element_mark, trace, counters, journal, steps
    )  # fmt: skip
    return check(m, operation, h, cap)


@bare_kernel
def apply_once(
    edge, vertex, points, irregular, element_mark, trace, counters, journal, steps,
    operation, h, cap,
):  # fmt: skip
    """Check, then rewrite, for callers in Python as :func:`check_once`.

    Returns the code, the change of s, and what the trace says: the number of new and of touched
    vertices and the first six of their ids.
    """
    m = MeshArrays(
        edge, vertex, points, irregular, element_mark, trace, counters, journal, steps
    )  # fmt: skip
    code = check(m, operation, h, cap)
    if code != ALLOWED:
        return code, 0, 0, 0, 0, 0, 0, 0, 0, 0
    before = counters[SCORE]
    rewrite(m, operation, h)
    return (
        code,
        counters[SCORE] - before,
        trace[NEW_COUNT],
        trace[TOUCHED_COUNT],
        trace[TRACE_IDS],
        trace[TRACE_IDS + 1],
        trace[TRACE_IDS + 2],
        trace[TRACE_IDS + 3],
        trace[TRACE_IDS + 4],
        trace[TRACE_IDS + 5],
    )


@bare_kernel
def _step(m, v, change):
    """The change of |Delta| at v when its degree changes."""
    delta = m.vertex[v, DEGREE] - m.vertex[v, DESIRED]
    return abs(delta + change) - abs(delta)


@bare_kernel
def _merge(m, v, w, lost, k):
    """The change of |Delta| when v and w become one vertex whose degree is the sum less `lost`."""
    winner = survivor(m, v, w, k)
    before = abs(m.vertex[v, DEGREE] - m.vertex[v, DESIRED])
    before += abs(m.vertex[w, DEGREE] - m.vertex[w, DESIRED])
    degree = m.vertex[v, DEGREE] + m.vertex[w, DEGREE] - lost
    return abs(degree - m.vertex[winner, DESIRED]) - before


@bare_kernel
def score_change(m, operation, h):
    """The exact change of s that an allowed operation makes, without doing it, in O(1).

    A clean-up changes nothing; for the collapse of a chord, which agents do not use, 0 is returned.
    """
    if operation >= CLEANUP:
        return 0
    t = m.edge[h, TWIN]
    if operation <= TRI_COLLAPSE:
        b = m.edge[following(h, 3), ORIGIN]
        a, c = m.edge[h, ORIGIN], m.edge[preceding(h, 3), ORIGIN]
        if operation == TRI_SPLIT:
            if t < 0:
                return 1 + _step(m, c, 1)
            return 2 + _step(m, c, 1) + _step(m, m.edge[preceding(t, 3), ORIGIN], 1)
        if operation == TRI_COLLAPSE and t < 0:
            return _merge(m, a, b, 3, 3) + _step(m, c, -1)
        d = m.edge[preceding(t, 3), ORIGIN]
        if operation == TRI_COLLAPSE:
            return _merge(m, a, b, 4, 3) + _step(m, c, -1) + _step(m, d, -1)
        return _step(m, a, -1) + _step(m, b, -1) + _step(m, c, 1) + _step(m, d, 1)
    n, p = following(h, 4), preceding(h, 4)
    a, b, d = m.edge[h, ORIGIN], m.edge[n, ORIGIN], m.edge[p, ORIGIN]
    if operation == QUAD_COLLAPSE:
        c = m.edge[following(n, 4), ORIGIN]
        return _merge(m, a, c, 2, 4) + _step(m, b, -1) + _step(m, d, -1)
    if operation == GLOBAL_SPLIT:
        return _step(m, a, 1) + _step(m, b, -1)
    f = m.edge[following(following(t, 4), 4), ORIGIN]
    if operation == QUAD_SPLIT:
        return 1 + _step(m, a, -1) + _step(m, d, 1) + _step(m, f, 1)
    if operation == FLIP_LEFT:
        x, y = f, m.edge[following(n, 4), ORIGIN]
    else:
        x, y = d, m.edge[preceding(t, 4), ORIGIN]
    return _step(m, a, -1) + _step(m, b, -1) + _step(m, x, 1) + _step(m, y, 1)
