"""Finds and restores documents of processes that died, from the files of
:mod:`meshwright.document.storage.autosave`.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from msgspec import Struct

from meshwright.document.document import Document
from meshwright.document.history import HistoryStep
from meshwright.document.json_records import Count, WholeNumber, converted
from meshwright.document.storage import autosave, document_state, file_lock
from meshwright.document.storage.autosave_log import Record, records
from meshwright.document.storage.document_state import DocumentState
from meshwright_core import MeshError
from meshwright_core.io import snapshot
from meshwright_core.io.snapshot_curves import stored_names


@dataclass
class LostWork:
    """A document that can be recovered. Its file is locked until :meth:`discard` or
    :meth:`release` is called.
    """

    path: Path
    name: str
    file: Path | None
    """The file that it was opened from or saved to."""
    when: float
    """Time of the last step, in seconds since 1970."""
    now: dict[str, Any]
    """The summary that autosave writes with every event: ``steps``, ``score``, ``optimum``,
    ``elements``, ``kind``.
    """
    _descriptor: int | None = None

    def read(self) -> DocumentState:
        """The document after the last complete record; MeshError if it cannot be restored."""
        try:
            return _replayed(self.path)
        except MeshError as error:
            raise MeshError(
                f"What was kept of {self.name or 'the mesh'} cannot be recovered: {error}."
            ) from error
        except OSError as error:
            raise MeshError(
                f"What was kept of {self.name or 'the mesh'} cannot be read ({error.strerror})."
            ) from error

    def discard(self) -> None:
        """Delete the file."""
        self.release()
        autosave.remove(self.path)

    def release(self) -> None:
        """Unlock the file and leave it for another start."""
        if self._descriptor is not None:
            file_lock.let_go(self._descriptor)
        self._descriptor = None


def lost(where: Path | None = None) -> list[LostWork]:
    """The documents of processes that have ended, the latest first; their files are locked."""
    found = []
    place = where if where is not None else autosave.folder()
    try:
        paths = sorted(place.glob(f"*{autosave.ENDING}"))
    except OSError:
        return []
    for path in paths:
        try:
            descriptor = file_lock.hold(path)
            one = _look(path, descriptor) if descriptor is not None else None
        except OSError:
            continue  # deleted in the meantime, or owned by another user
        if one is not None:
            found.append(one)
    return sorted(found, key=lambda one: one.when, reverse=True)


def _look(path: Path, descriptor: int) -> LostWork | None:
    """Summary of a file from its headers; None, and the file deleted, if it holds no document."""
    when = path.stat().st_mtime
    headers = [record.header for record in records(path)]
    if not headers or headers[0].get("event") != "document":
        file_lock.let_go(descriptor)
        autosave.remove(path)
        return None
    first, now = headers[0], headers[-1].get("now")
    file = first.get("path")
    return LostWork(
        path,
        str(first.get("name") or ""),
        Path(file) if isinstance(file, str) else None,
        when,
        now if isinstance(now, dict) else {},
        descriptor,
    )


def _replayed(path: Path) -> DocumentState:
    """Read the document, then repeat the events recorded after it."""
    document = Document()
    for record in records(path):
        if document.empty:
            document.adopt(document_state.unpacked(record.header, record.arrays))
        else:
            try:
                _repeat(document, record)
            except MeshError:
                break  # the records before it are valid
    if document.empty:
        raise MeshError("there is no whole document in it")
    return document.state()


class _Event(Struct):
    """What autosave appends after each change of the document."""

    event: str
    number: WholeNumber
    row: HistoryStep | None = None
    """The step, for the event "step"."""
    room: tuple[Count, Count] | None = None
    """Vertices and elements that the mesh had room for after the step."""
    names: tuple[Count, dict[str, Any]] | None = None
    """The number and the record of the names that the step puts in force."""


def _repeat(document: Document, record: Record) -> None:
    """Apply a record of autosave; MeshError if it does not follow from this state."""
    event = converted(record.header, _Event)
    if event.event == "go":
        document.go_to(event.number)
    elif event.event == "branch":
        document.take_branch(event.number)
    elif event.event == "step" and event.row is not None:
        _make_room(document, event.room)
        mesh = document.mesh
        if mesh is not None and event.names is not None:
            number, record_of_names = event.names
            mesh.add_naming(number, stored_names(record_of_names, mesh.boundary_info))
        steps = snapshot.restored_steps(record.arrays, "step", mesh) if mesh else ()
        document.replay(event.row, steps)
    else:
        raise MeshError("an event of the record is unknown")


def _make_room(document: Document, room: tuple[int, int] | None) -> None:
    """Reserve room for vertices and elements as the mesh had it when the step was recorded."""
    mesh = document.mesh
    if mesh is None:
        return
    if room is None:
        raise MeshError("a step of the record lacks its room")
    missing = (room[0] - len(mesh.arrays.vertex), room[1] - len(mesh.arrays.element_mark))
    if max(missing) > snapshot.MOST:
        raise MeshError("a step of the record needs too much room")
    if max(missing) > 0:
        mesh.room_for(*room)
