"""What is stored of a document: a header that JSON can hold, and arrays.

Project files and autosave both store this; they differ in the file format. What is read back may
hold anything: :func:`unpacked` checks all of it.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from msgspec import Struct, to_builtins

from meshwright.document.branches import Branch, Branches
from meshwright.document.history import History, HistoryStep
from meshwright.document.json_records import Count, converted
from meshwright.document.storage.file_stamp import Stamp
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.arrays import DELTA_SUM, SCORE
from meshwright_core.history.packed_steps import COUNTERS, Steps
from meshwright_core.io import snapshot
from meshwright_core.io.history_checks import require_history
from meshwright_core.io.snapshot import Arrays

VERSION = 1
"""Version of the header and the arrays; files of a later one are refused."""

DEEPEST = 60
"""Branches on branches on branches: levels that a file may have."""


@dataclass(frozen=True)
class DocumentState:
    """What is stored of a document.

    ``path`` is the file that *Save* writes, and ``stamp`` identifies its content when it was read
    or written last (None: as it is now); ``saved`` is
    :attr:`meshwright.document.document.Document.saved_state` when it was written; ``settings`` are
    the plain values that the views store.
    """

    mesh: HalfEdgeMesh
    history: History
    name: str = ""
    path: Path | None = None
    saved: tuple[int, int] = (0, 0)
    settings: Mapping[str, Any] = field(default_factory=dict)
    stamp: Stamp | None = None


class _Version(Struct):
    version: Count


class _BranchRecord(Struct):
    at: Count
    made: Count
    steps: str
    """Name of the arrays that hold its steps."""
    rows: list[HistoryStep]
    branches: "list[_BranchRecord]"


class _Header(Struct):
    version: Count
    name: str
    saved: tuple[Count, Count]
    settings: dict[str, Any]
    first: tuple[Count, Count]
    given: tuple[Count, Count]
    cursor: Count
    rows: list[HistoryStep]
    branches: list[_BranchRecord]
    path: str | None = None
    stamp: tuple[int, int] | None = None


def packed(state: DocumentState) -> tuple[dict[str, Any], Arrays]:
    """The header and the arrays; those of the mesh itself are not copied.

    Steps that the mesh had before the history began are left out.
    """
    history = state.history
    arrays = snapshot.to_arrays(state.mesh, history.cursor, len(history) - history.cursor)
    header = _Header(
        version=VERSION,
        name=state.name,
        saved=state.saved,
        settings=dict(state.settings),
        first=history.first,
        given=history.given,
        cursor=history.cursor,
        rows=list(history),
        branches=[
            _branch_record(branch, f"branch{number}", arrays)
            for number, branch in enumerate(history.branches)
        ],
        path=str(state.path) if state.path else None,
        stamp=state.stamp,
    )
    return to_builtins(header), arrays


def unpacked(header: Any, arrays: Mapping[str, Any]) -> DocumentState:
    """The state in a header and arrays, which may come from a damaged file.

    Raises MeshError, the second part of a sentence without the file's name, if they are not sound.
    """
    if converted(header, _Version).version > VERSION:
        raise MeshError("it was made by a later version of Meshwright")
    record = converted(header, _Header)
    mesh = snapshot.from_arrays(arrays)
    steps = tuple(sum(map(len, side)) for side in mesh.packed_steps())
    if (record.cursor, len(record.rows) - record.cursor) != steps:
        raise MeshError("its history has other rows than steps")
    branches = _branches(record.branches, arrays, mesh, (0, len(record.rows)), 0)
    if not record.rows and not branches:
        # a file may be from before s* counted what regions cannot cancel
        mesh.renew_bound()
        record.first = (mesh.score, mesh.optimum)
    excesses = frozenset(names.bound_excess for names in mesh.namings.values())
    _require_scores(record.rows, _scores(mesh), branches, excesses)
    require_history(mesh, branches)
    serials = [row.serial for row in _every_row(record.rows, branches)]
    if len(set(serials)) != len(serials) or max(serials, default=0) > record.given[0]:
        raise MeshError("its history counts its rows wrong")
    history = History.of(*record.first, record.rows, record.cursor, branches, *record.given)
    path = Path(record.path) if record.path else None
    return DocumentState(
        mesh, history, record.name, path, record.saved, record.settings, record.stamp
    )


def _branch_record(branch: Branch, name: str, arrays: Arrays) -> _BranchRecord:
    arrays.update(snapshot.steps_arrays(branch.steps, name))
    return _BranchRecord(
        at=branch.at,
        made=branch.made,
        steps=name,
        rows=list(branch.rows),
        branches=[
            _branch_record(inner, f"{name}.{number}", arrays)
            for number, inner in enumerate(branch.branches)
        ],
    )


def _branches(
    records: list[_BranchRecord],
    arrays: Mapping[str, Any],
    mesh: HalfEdgeMesh,
    within: tuple[int, int],
    depth: int,
) -> Branches:
    """The branches that fork from cursor ``within[0]`` on, and before ``within[1]``."""
    if depth > DEEPEST:
        raise MeshError("its branches fork too often")
    made = []
    for record in records:
        at, rows = record.at, tuple(record.rows)
        steps = snapshot.restored_steps(arrays, record.steps, mesh)
        if not within[0] <= at <= within[1] or not rows or len(rows) != sum(map(len, steps)):
            raise MeshError("a branch of its history leads nowhere")
        inner = _branches(record.branches, arrays, mesh, (at + 1, at + len(rows)), depth + 1)
        made.append(Branch(at, rows, steps, inner, record.made))
    return tuple(made)


def _scores(mesh: HalfEdgeMesh) -> list[tuple[int, int]]:
    """s and |sum of Delta| of every state of the mesh's history, as its steps state them."""
    done, undone = mesh.packed_steps()
    now = abs(int(mesh.arrays.counters[DELTA_SUM]))
    return [*_stated(done), (mesh.score, now), *_stated(undone)]


def _stated(pieces: Iterable[Steps]) -> list[tuple[int, int]]:
    """s and |sum of Delta| in the counters of steps: before done ones, after undone ones."""
    found: list[tuple[int, int]] = []
    for piece in pieces:
        counters = piece.rows[:, COUNTERS:].astype(int)
        sums = abs(counters[:, DELTA_SUM])
        found += zip(counters[:, SCORE].tolist(), sums.tolist(), strict=True)
    return found


def _require_scores(
    rows: Iterable[HistoryStep],
    states: list[tuple[int, int]],
    branches: Branches,
    excesses: frozenset[int],
    first: int = 0,
) -> None:
    """Raise MeshError unless rows hold the scores of the states that they lead from and to.

    ``states`` are s and |sum of Delta| of all states from the start of the history on; ``rows``
    lead on from state ``first``. ``excesses``: what s* has been larger by at times.
    """
    for row, (before, after) in zip(rows, pairwise(states[first:]), strict=True):
        scores = (row.before, row.after) == (before[0], after[0])
        if not scores or row.optimum - after[1] not in excesses:
            raise MeshError("its history states other scores than its mesh has")
    for branch in branches:
        along = [*states[: branch.at + 1], *_stated(branch.steps)]
        _require_scores(branch.rows, along, branch.branches, excesses, branch.at)


def _every_row(rows: Iterable[HistoryStep], branches: Branches) -> Iterator[HistoryStep]:
    yield from rows
    for branch in branches:
        yield from _every_row(branch.rows, branch.branches)
