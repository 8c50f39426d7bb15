"""The catalogue of operations, and one compiled `check`, `rewrite` and `score_change` over all of
them.

Every change of connectivity, by a person or by the agent, is one operation on one half-edge. Its
check, its rewrite and its change of s stand side by side in the file of its group; here they are
dispatched by code, and :data:`CATALOGUE` lists everything else that is known of an operation.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple

import numba
import numpy as np

from meshwright_core.core.arrays import (
    ELEMENT_SLOTS,
    NEW_COUNT,
    ORIGIN,
    SCORE,
    SIDES,
    TOUCHED_COUNT,
    TRACE_IDS,
    TWIN,
    MeshArrays,
)
from meshwright_core.core.compilation import bare_kernel, bare_shared_kernel
from meshwright_core.core.entry_points import entry
from meshwright_core.history.journal import begin_step, end_step
from meshwright_core.operations import (
    chord_collapse,
    chord_division,
    global_lines,
    global_split,
    quad_edits,
    ring_insertion,
    triangle_edits,
)
from meshwright_core.operations.refusals import ALLOWED, DEAD_HALFEDGE


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
    INSERT_RING = "insert_ring"
    DIVIDE_CHORD = "divide_chord"


# codes for compiled kernels; triangles and quads do not share codes
TRI_FLIP, TRI_SPLIT, TRI_COLLAPSE = 0, 1, 2
FLIP_LEFT, FLIP_RIGHT, QUAD_SPLIT, QUAD_COLLAPSE = 3, 4, 5, 6
GLOBAL_SPLIT, CLEANUP, CHORD_COLLAPSE, INSERT_RING, DIVIDE_CHORD = 7, 8, 9, 10, 11


@dataclass(frozen=True, kw_only=True)
class OperationInfo:
    """All that is known of an operation besides its kernels; agents, views and help read it."""

    operation: Operation
    kind: str
    """"tri" or "quad"."""
    code: int
    """Its code in compiled kernels."""
    title: str
    summary: str
    key: str
    """The key that applies it in the editor."""
    growth: tuple[int, int] | None
    """Elements that it adds at an edge inside, and at one on the boundary; None where the number
    depends on the length of the line or strip that it follows through the mesh."""
    needs_twin: bool
    """Whether it is refused at every boundary edge; its change of s is not defined there."""
    policy: bool = True
    """Whether policies choose it; clean-ups follow their choices by themselves."""
    score_formula: bool = True
    """Whether :func:`score_change` gives its change of s; a dry run does in any case."""
    beyond_paper: bool = False

    @property
    def is_local(self) -> bool:
        """Whether it changes the elements around one edge only, however large the mesh."""
        return self.growth is not None


CATALOGUE = (
    OperationInfo(
        operation=Operation.FLIP,
        kind="tri",
        code=TRI_FLIP,
        title="Flip edge",
        summary="turns the edge between two triangles to join their other corners",
        key="F",
        growth=(0, 0),
        needs_twin=True,
    ),
    OperationInfo(
        operation=Operation.SPLIT,
        kind="tri",
        code=TRI_SPLIT,
        title="Split edge",
        summary="puts a vertex on the edge and joins it to the corners across",
        key="S",
        growth=(2, 1),
        needs_twin=False,
    ),
    OperationInfo(
        operation=Operation.COLLAPSE,
        kind="tri",
        code=TRI_COLLAPSE,
        title="Collapse edge",
        summary="merges the ends of the edge; its triangles go (on the boundary: beyond the paper)",
        key="C",
        growth=(-2, -1),
        needs_twin=False,
    ),
    OperationInfo(
        operation=Operation.FLIP_LEFT,
        kind="quad",
        code=FLIP_LEFT,
        title="Flip left",
        summary="turns the edge counter-clockwise in the hexagon of its two quads",
        key="F",
        growth=(0, 0),
        needs_twin=True,
    ),
    OperationInfo(
        operation=Operation.FLIP_RIGHT,
        kind="quad",
        code=FLIP_RIGHT,
        title="Flip right",
        summary="turns the edge clockwise in the hexagon of its two quads",
        key="R",
        growth=(0, 0),
        needs_twin=True,
    ),
    OperationInfo(
        operation=Operation.SPLIT,
        kind="quad",
        code=QUAD_SPLIT,
        title="Split vertex",
        summary="splits the vertex where the half-edge starts; a quad opens along the edge",
        key="S",
        growth=(1, 1),
        needs_twin=True,
    ),
    OperationInfo(
        operation=Operation.COLLAPSE,
        kind="quad",
        code=QUAD_COLLAPSE,
        title="Collapse quad",
        summary="merges the vertex where the half-edge starts with the opposite corner of its quad",
        key="C",
        growth=(-1, -1),
        needs_twin=False,
    ),
    OperationInfo(
        operation=Operation.GLOBAL_SPLIT,
        kind="quad",
        code=GLOBAL_SPLIT,
        title="Global split",
        summary="opens the edge into a quad and carries the cut both ways to the boundary",
        key="G",
        growth=None,
        needs_twin=True,
    ),
    OperationInfo(
        operation=Operation.CLEANUP,
        kind="quad",
        code=CLEANUP,
        title="Clean up line",
        summary="deletes the straight line of regular vertices through the edge",
        key="X",
        growth=None,
        needs_twin=True,
        policy=False,
    ),
    OperationInfo(
        operation=Operation.CHORD_COLLAPSE,
        kind="quad",
        code=CHORD_COLLAPSE,
        title="Collapse strip",
        summary="shrinks the strip of quads that crosses the edge to a line",
        key="V",
        growth=None,
        needs_twin=False,
        policy=False,
        score_formula=False,
        beyond_paper=True,
    ),
    OperationInfo(
        operation=Operation.INSERT_RING,
        kind="quad",
        code=INSERT_RING,
        title="Insert ring",
        summary="puts a layer of quads along the closed boundary loop or interface of the edge",
        key="I",
        growth=None,
        needs_twin=False,
        policy=False,
        beyond_paper=True,
    ),
    OperationInfo(
        operation=Operation.DIVIDE_CHORD,
        kind="quad",
        code=DIVIDE_CHORD,
        title="Divide strip",
        summary="cuts the strip of quads that crosses the edge in two along its length",
        key="Y",
        growth=None,
        needs_twin=False,
        policy=False,
        beyond_paper=True,
    ),
)


def of_kind(kind: str) -> tuple[OperationInfo, ...]:
    """The operations of "tri" or "quad" meshes, in the order of the catalogue."""
    return tuple(info for info in CATALOGUE if info.kind == kind)


CODES: dict[int, dict[str, int]] = {
    sides: {info.operation: info.code for info in of_kind(kind)}
    for sides, kind in ((3, "tri"), (4, "quad"))
}
"""Codes by number of sides and name; `Operation` members and strings hash alike."""

NAMES: dict[int, Operation] = {info.code: info.operation for info in CATALOGUE}

# columns of the catalogue for compiled kernels, by code
_GROWTH = np.array([info.growth or (0, 0) for info in CATALOGUE])
_NEEDS_TWIN = np.array([info.needs_twin for info in CATALOGUE])


@bare_shared_kernel
def check(m, operation, h, cap):
    """A code of :mod:`meshwright_core.operations.refusals`: may `operation` be applied to h? No
    side effect.

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
    if operation == CHORD_COLLAPSE:
        return chord_collapse.check_chord_collapse(m, h, cap)
    if operation == INSERT_RING:
        return ring_insertion.check_insert_ring(m, h, cap)
    return chord_division.check_divide_chord(m, h, cap)


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
    elif operation == CHORD_COLLAPSE:
        chord_collapse.chord_collapse(m, h)
    elif operation == INSERT_RING:
        ring_insertion.insert_ring(m, h)
    else:
        chord_division.divide_chord(m, h)
    end_step(m)


def provide_rewrite(arrays: MeshArrays) -> None:
    """Compile :func:`rewrite` for such arrays, or load it, without applying an operation."""
    shared: Any = rewrite
    shared.provide((numba.typeof(arrays), numba.int64, numba.int64))


@bare_kernel
def score_change(m, operation, h):
    """The exact change of s that an allowed operation makes, without applying it.

    In O(1), and for a ring in the length of its loop.
    0 for the division of a chord, and for the collapse of one, which has no formula: a dry run
    gives its change.
    """
    if operation == TRI_FLIP:
        return triangle_edits.score_change_flip(m, h)
    if operation == TRI_SPLIT:
        return triangle_edits.score_change_split(m, h)
    if operation == TRI_COLLAPSE:
        return triangle_edits.score_change_collapse(m, h)
    if operation == FLIP_LEFT:
        return quad_edits.score_change_flip_left(m, h)
    if operation == FLIP_RIGHT:
        return quad_edits.score_change_flip_right(m, h)
    if operation == QUAD_SPLIT:
        return quad_edits.score_change_split(m, h)
    if operation == QUAD_COLLAPSE:
        return quad_edits.score_change_collapse(m, h)
    if operation == GLOBAL_SPLIT:
        return global_split.score_change_global_split(m, h)
    if operation == CLEANUP:
        return global_lines.score_change_cleanup(m, h)
    if operation == INSERT_RING:
        return ring_insertion.score_change_insert_ring(m, h)
    return 0


@bare_kernel
def growth(m, operation, h):
    """Elements that an operation adds; 0 for those whose number depends on a line or strip."""
    return _GROWTH[operation, 1 if m.edge[h, TWIN] < 0 else 0]


@bare_kernel
def needs_twin(operation):
    """Whether the operation is refused at every boundary edge; its change of s is not defined
    there.
    """
    return _NEEDS_TWIN[operation]


class Applied(NamedTuple):
    """What :func:`apply_once` did."""

    code: int
    """A code of :mod:`meshwright_core.operations.refusals`; nothing was done unless ALLOWED."""
    score_change: int
    """The change of s."""
    new_count: int
    """How many vertices are new."""
    touched_count: int
    """How many vertices the trace names, the new ones first."""
    touched: tuple[int, ...]
    """The first six of them; what is beyond `touched_count` means nothing."""


FEW = 6
"""Touched vertices that :class:`Applied` holds itself."""


@bare_kernel
def _apply(m, operation, h, cap):
    """The fields of :class:`Applied`: check, then rewrite."""
    code = check(m, operation, h, cap)
    if code != ALLOWED:
        return code, 0, 0, 0, (0, 0, 0, 0, 0, 0)
    before = m.counters[SCORE]
    rewrite(m, operation, h)
    ids = TRACE_IDS
    trace = m.trace
    return (
        code,
        m.counters[SCORE] - before,
        trace[NEW_COUNT],
        trace[TOUCHED_COUNT],
        (
            trace[ids],
            trace[ids + 1],
            trace[ids + 2],
            trace[ids + 3],
            trace[ids + 4],
            trace[ids + 5],
        ),
    )


def check_once(m: MeshArrays, operation: int, h: int, cap: int) -> int:
    """:func:`check` for callers in Python."""
    return int(entry(check, 3)(m, operation, h, cap))


def apply_once(m: MeshArrays, operation: int, h: int, cap: int) -> Applied:
    """:func:`check`, then :func:`rewrite` where it is allowed, for callers in Python."""
    return Applied(*entry(_apply, 3)(m, operation, h, cap))
