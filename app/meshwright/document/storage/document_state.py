"""A document as it is kept in files: a header that JSON can hold, and arrays.

The project file and the autosave both keep this; they differ in how they put it on the disk. What
comes back from a file may hold anything: :func:`restored` checks all of it.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

from meshwright.document.branches import Branch, Branches
from meshwright.document.history import History, Row
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.history.packed_steps import Steps
from meshwright_core.io import snapshot
from meshwright_core.io.snapshot import Arrays

VERSION = 1
"""Of the header and of the arrays; files of a later one are refused in words."""

Header = dict[str, Any]

_FIELDS = tuple((part.name, part.type) for part in fields(Row))
_LARGEST = 1 << 53
_DEEPEST = 60


@dataclass(frozen=True)
class Kept:
    """What is kept of a document.

    ``path`` is the file that *Save* writes; ``saved`` what the document was when it was written,
    as :attr:`meshwright.document.document.Document.saved_state`; ``settings`` what the views want
    to find again.
    """

    mesh: HalfEdgeMesh
    history: History
    name: str = ""
    path: Path | None = None
    saved: tuple[int, int] = (0, 0)
    settings: Mapping[str, Any] = field(default_factory=dict)


def taken(kept: Kept) -> tuple[Header, Arrays]:
    """The header and the arrays; those of the mesh itself are not copied."""
    arrays = snapshot.to_arrays(kept.mesh)
    history = kept.history
    branches = [
        _branch_record(branch, f"branch{number}", arrays)
        for number, branch in enumerate(history.branches)
    ]
    header = {
        "version": VERSION,
        "name": kept.name,
        "path": str(kept.path) if kept.path else None,
        "saved": list(kept.saved),
        "settings": dict(kept.settings),
        "first": list(history.first),
        "given": list(history.given),
        "cursor": history.cursor,
        "rows": [row_record(row) for row in history],
        "branches": branches,
    }
    return header, arrays


def restored(header: Any, arrays: Mapping[str, Any]) -> Kept:
    """What was taken. MeshError, in words without the file's name, if it is not whole."""
    if not isinstance(header, dict):
        raise MeshError("its header is none")
    version = _number(header, "version")
    if version > VERSION:
        raise MeshError("it was made by a later version of Meshwright")
    mesh = snapshot.from_arrays(arrays)
    rows = [row_of(record) for record in _list(header, "rows")]
    cursor = _number(header, "cursor")
    steps = (sum(map(len, side)) for side in mesh.packed_steps())
    if (cursor, len(rows) - cursor) != tuple(steps):
        raise MeshError("its history has other rows than steps")
    branches = _branches(_list(header, "branches"), arrays, mesh, (0, len(rows)), 0)
    first, given, saved = (_pair(header, name) for name in ("first", "given", "saved"))
    serials = [row.serial for row in _every_row(rows, branches)]
    if len(set(serials)) != len(serials) or max(serials, default=0) > given[0]:
        raise MeshError("its history counts its rows wrong")
    path, settings = header.get("path"), header.get("settings")
    if not (path is None or isinstance(path, str)) or not isinstance(settings, dict):
        raise MeshError("its settings are none")
    history = History.of(*first, rows, cursor, branches, *given)
    name = header.get("name")
    if not isinstance(name, str):
        raise MeshError("its name is none")
    return Kept(mesh, history, name, Path(path) if path else None, saved, settings)


def row_record(row: Row) -> list[Any]:
    """A row as a list for JSON."""
    return [getattr(row, name) for name, _ in _FIELDS]


def row_of(record: Any) -> Row:
    """The row of such a list; MeshError if it is none."""
    if not isinstance(record, list) or len(record) != len(_FIELDS):
        raise MeshError("a row of its history is cut off")
    for (_, kind), value in zip(_FIELDS, record, strict=True):
        if type(value) is not kind or (kind is int and abs(value) > _LARGEST):
            raise MeshError("a row of its history is none")
    return Row(*record)


def _branch_record(branch: Branch, name: str, arrays: Arrays) -> Header:
    arrays.update(snapshot.steps_arrays(branch.steps, name))
    return {
        "at": branch.at,
        "made": branch.made,
        "steps": name,
        "rows": [row_record(row) for row in branch.rows],
        "branches": [
            _branch_record(inner, f"{name}.{number}", arrays)
            for number, inner in enumerate(branch.branches)
        ],
    }


def _branches(
    records: list[Any],
    arrays: Mapping[str, Any],
    mesh: HalfEdgeMesh,
    within: tuple[int, int],
    depth: int,
) -> Branches:
    """The branches that fork from cursor ``within[0]`` on, and before ``within[1]``."""
    if depth > _DEEPEST:
        raise MeshError("its branches fork too often")
    made = []
    for record in records:
        if not isinstance(record, dict) or not isinstance(record.get("steps"), str):
            raise MeshError("a branch of its history is none")
        at = _number(record, "at")
        rows = tuple(row_of(row) for row in _list(record, "rows"))
        steps: tuple[Steps, ...] = snapshot.restored_steps(arrays, record["steps"], mesh)
        if not within[0] <= at <= within[1] or not rows or len(rows) != sum(map(len, steps)):
            raise MeshError("a branch of its history leads nowhere")
        inner = _branches(
            _list(record, "branches"), arrays, mesh, (at + 1, at + len(rows)), depth + 1
        )
        made.append(Branch(at, rows, steps, inner, _number(record, "made")))
    return tuple(made)


def _every_row(rows: list[Row] | tuple[Row, ...], branches: Branches) -> Iterator[Row]:
    yield from rows
    for branch in branches:
        yield from _every_row(branch.rows, branch.branches)


def _number(record: Header, name: str) -> int:
    found = record.get(name)
    if type(found) is not int or not 0 <= found <= _LARGEST:
        raise MeshError(f"its {name} is no number")
    return found


def _pair(record: Header, name: str) -> tuple[int, int]:
    found = _list(record, name)
    if len(found) != 2:
        raise MeshError(f"its {name} are no two numbers")
    first, second = ({name: value} for value in found)
    return _number(first, name), _number(second, name)


def _list(record: Header, name: str) -> list[Any]:
    found = record.get(name)
    if not isinstance(found, list):
        raise MeshError(f"its {name} are missing")
    return found
