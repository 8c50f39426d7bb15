"""Autosave: writes every step to a file at once, so that a killed process loses at most the last.

The first step after a mesh was opened or saved writes the whole document; each later event appends
its change. Saving all of it and closing remove the file; saving to a mesh file, which has no
history, begins it anew. Files of processes that died are found by
:mod:`meshwright.document.storage.recovery`.
"""

import errno
import os
import secrets
import time
from pathlib import Path
from typing import Any

import platformdirs
from msgspec import to_builtins

from meshwright.document.document import Document
from meshwright.document.storage import document_state, file_lock
from meshwright.document.storage.autosave_log import encoded
from meshwright.signals import Signal
from meshwright_core.io import snapshot
from meshwright_core.io.atomic_write import reason
from meshwright_core.io.snapshot import Arrays
from meshwright_core.io.snapshot_curves import names_record

ENDING = ".journal"
WAITING_BYTES = 256 << 20
"""Limit on the bytes of records that could not be written and wait for the next event."""
_PATIENCE = 20
"""After a failed write of the whole document, the wait is this many times its duration."""

Buffers = list[bytes | memoryview]


def folder() -> Path:
    """The folder of the files; `MESHWRIGHT_STATE_DIR` overrides the user's state folder."""
    chosen = os.environ.get("MESHWRIGHT_STATE_DIR")
    return Path(chosen or platformdirs.user_state_path("meshwright")) / "autosave"


class Autosave:
    """Records one document until :meth:`close` or :meth:`leave`.

    ``failed(sentence)`` is emitted when writing fails for the first time; it is tried again with
    every later event. ``resumed(sentence)`` is emitted when writing works again.
    """

    def __init__(self, document: Document, where: Path | None = None) -> None:
        self.failed = Signal()
        self.resumed = Signal()
        self._document = document
        self._folder = where if where is not None else folder()
        self._enabled = True
        self._path: Path | None = None
        self._descriptor: int | None = None
        self._length = 0
        self._waiting: list[Buffers] = []
        self._failing = False
        self._not_before = 0.0
        self._namings: set[int] = set()  # the numbers of names that the file holds
        document.recorded.connect(self._on_recorded)
        document.replaced.connect(self._remove)

    @property
    def path(self) -> Path | None:
        """The file, None while there are no unsaved changes."""
        return self._path

    @property
    def enabled(self) -> bool:
        """Whether steps are recorded."""
        return self._enabled

    @enabled.setter
    def enabled(self, enabled: bool) -> None:
        self._enabled = enabled
        if not enabled:
            self._remove()

    def begin(self) -> bool:
        """Write the whole document now, as after a recovery; True on success."""
        return self._enabled and self._begin()

    def close(self) -> None:
        """Stop recording and remove the file."""
        self._disconnect()
        self._remove()

    def leave(self) -> None:
        """Stop recording and leave the file for the next start."""
        self._disconnect()
        if self._descriptor is not None:
            file_lock.let_go(self._descriptor)
        self._path = self._descriptor = None

    # Events

    def _on_recorded(self, event: str, number: int) -> None:
        if event == "python":  # not one step: the whole document is written again
            self._remove()
        if event == "saved" or self._document.passing:
            self._remove()
            if self._enabled and self._document.modified:
                self._begin()
        elif self._enabled and self._path is None:
            self._begin()
        elif self._enabled:
            self._append(*self._record(event, number))

    def _record(self, event: str, number: int) -> tuple[dict[str, Any], Arrays]:
        header: dict[str, Any] = {"event": event, "number": number, "now": self._now()}
        mesh, row = self._document.mesh, self._document.history.last
        if event != "step" or mesh is None or row is None:
            return header, {}
        header["row"] = to_builtins(row)
        header["room"] = [len(mesh.arrays.vertex), len(mesh.arrays.element_mark)]
        if mesh.naming not in self._namings:
            self._namings.add(mesh.naming)
            header["names"] = [mesh.naming, names_record(mesh.boundary_info)]
        return header, snapshot.steps_arrays([mesh.last_step()], "step")

    def _now(self) -> dict[str, Any]:
        """Summary of the work, shown when it is offered for recovery."""
        document = self._document
        return {
            "steps": document.history.cursor,
            "score": document.score,
            "optimum": document.optimum,
            "elements": document.mesh.n_elements if document.mesh is not None else 0,
            "kind": document.kind,
        }

    # The file

    def _begin(self) -> bool:
        """Begin a new file with the whole document."""
        begun = time.monotonic()
        if begun < self._not_before:
            return False
        state = self._document.state()
        self._namings = set(state.mesh.namings)
        header, arrays = document_state.packed(state)
        path = self._folder / f"{os.getpid()}-{secrets.token_hex(6)}{ENDING}"
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            descriptor = file_lock.hold(path, fresh=True)
        except OSError as error:
            self._tell(error)
            return False
        self._path, self._descriptor, self._length = path, descriptor, 0
        self._append({"event": "document", "now": self._now(), **header}, arrays)
        if not self._waiting:
            return True
        self._remove()
        self._not_before = begun + _PATIENCE * (time.monotonic() - begun)
        return False

    def _append(self, header: dict[str, Any], arrays: Arrays) -> None:
        self._waiting.append(encoded(header, arrays))
        try:
            while self._waiting:
                self._write(self._waiting[0])
                del self._waiting[0]
        except OSError as error:
            self._cut()
            self._tell(error)
            if sum(len(part) for record in self._waiting for part in record) > WAITING_BYTES:
                self._remove()  # the next event writes the whole document
        else:
            if self._failing:
                self._failing = False
                self.resumed.emit("Autosave works again.")

    def _write(self, buffers: Buffers) -> None:
        """Write one record; a small one by a single system call."""
        if self._descriptor is None:
            raise OSError(errno.EBADF, os.strerror(errno.EBADF))
        if sum(map(len, buffers)) < 1 << 16:
            buffers = [b"".join(buffers)]
        written = 0
        for part in buffers:
            view = memoryview(part)
            while view:
                count = os.write(self._descriptor, view)
                written += count
                view = view[count:]
        self._length += written

    def _cut(self) -> None:
        """Remove the incomplete record of a failed write."""
        try:
            if self._descriptor is not None:
                os.ftruncate(self._descriptor, self._length)
        except OSError:
            self._remove()

    def _tell(self, error: OSError) -> None:
        if not self._failing:
            self._failing = True
            self.failed.emit(
                f"Autosave cannot write to {self._folder} ({reason(error)}); it tries again with"
                " every step. Save your work yourself until then."
            )

    def _remove(self) -> None:
        """Close and delete the file."""
        path, descriptor = self._path, self._descriptor
        self._path = self._descriptor = None
        self._waiting.clear()
        if descriptor is not None:
            file_lock.let_go(descriptor)
        if path is not None:
            remove(path)

    def _disconnect(self) -> None:
        self._document.recorded.disconnect(self._on_recorded)
        self._document.replaced.disconnect(self._remove)


def remove(path: Path) -> bool:
    """Delete a file of autosave; False if the system refuses."""
    try:
        path.unlink(missing_ok=True)
    except OSError:
        return False
    return True
