"""The worker process that makes the meshes of the dialog, and the requests to it."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Mapping
from typing import Any

from qtpy.QtCore import QByteArray, QObject, QProcess, QProcessEnvironment, QTimer, Signal

from meshwright.sources import mesh_worker, new_mesh

PAUSE = 120
"""Milliseconds without a further change after which a request is sent."""
PATIENCE = 300
"""Milliseconds that an outdated request may take before the process is replaced."""

GONE = "Meshing failed: the process ended unexpectedly, perhaps for lack of memory."


class MeshProcess(QObject):
    """Sends requests to the process, and emits ``made(NewMesh)`` or ``failed(sentence)``; before
    either ``found(DrawingContents)``, with None if no drawing was read.

    Requests are as :func:`meshwright.sources.mesh_worker.make` takes them. A new one replaces the
    previous one.
    """

    found = Signal(object)
    made = Signal(object)
    failed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._process: QProcess | None = None
        self._received = bytearray()
        self._wanted: Mapping[str, Any] | None = None
        self._asked: Mapping[str, Any] | None = None
        self._pause = QTimer(self)
        self._pause.setSingleShot(True)
        self._pause.timeout.connect(self._send)
        self._patience = QTimer(self)
        self._patience.setSingleShot(True)
        self._patience.timeout.connect(self._replace)

    @property
    def busy(self) -> bool:
        """True while an answer is pending."""
        return self._wanted is not None

    def start(self) -> None:
        """Start the process ahead of the first request: its imports take a while."""
        if self._process is not None:
            return
        process = QProcess(self)
        environment = QProcessEnvironment.systemEnvironment()
        environment.insert("PYTHONPATH", os.pathsep.join(path for path in sys.path if path))
        process.setProcessEnvironment(environment)
        process.setStandardErrorFile(QProcess.nullDevice())
        self._attach(process)
        process.start(sys.executable, ["-m", mesh_worker.__name__])

    def ask(self, request: Mapping[str, Any], at_once: bool = False) -> None:
        """Request a mesh, in place of the previous request."""
        self._wanted = request
        self._pause.start(0 if at_once else PAUSE)

    def cancel(self) -> None:
        """Drop the request."""
        self._wanted = None
        self._pause.stop()
        self._give_up_soon()

    def close(self) -> None:
        """End the process."""
        self._wanted = self._asked = None
        self._pause.stop()
        self._patience.stop()
        self._end()

    def _send(self) -> None:
        if self._wanted is None:
            return
        if self._asked is not None:
            self._give_up_soon()
            return
        self.start()
        self._asked = self._wanted
        if self._process is not None:
            self._process.write(QByteArray(json.dumps(self._asked).encode() + b"\n"))

    def _give_up_soon(self) -> None:
        if self._asked is not None and not self._patience.isActive():
            self._patience.start(PATIENCE)

    def _replace(self) -> None:
        if self._asked is None or self._asked is self._wanted:
            return
        self._asked = None
        self._end()
        self.start()
        self._send()

    def _attach(self, process: QProcess) -> None:
        process.readyReadStandardOutput.connect(self._on_answer)
        process.finished.connect(self._on_ended)
        process.errorOccurred.connect(self._on_ended)
        self._process, self._received = process, bytearray()

    def _detach(self) -> QProcess | None:
        process, self._process = self._process, None
        if process is not None:
            process.readyReadStandardOutput.disconnect(self._on_answer)
            process.finished.disconnect(self._on_ended)
            process.errorOccurred.disconnect(self._on_ended)
        return process

    def _end(self) -> None:
        process = self._detach()
        if process is None:
            return
        process.kill()
        process.waitForFinished(1000)
        process.deleteLater()

    def _on_answer(self) -> None:
        if self._process is None:
            return
        self._received += self._process.readAllStandardOutput().data()
        if len(self._received) < new_mesh.length(self._received):
            return
        answer, self._received = new_mesh.unframed(self._received), bytearray()
        asked, self._asked = self._asked, None
        self._patience.stop()
        if asked is not self._wanted:
            self._send()
            return
        self._wanted = None
        self.found.emit(answer.contents)
        if answer.mesh is None:
            self.failed.emit(answer.refusal)
        else:
            self.made.emit(answer.mesh)

    def _on_ended(self) -> None:
        """Handle an unexpected end of the process."""
        self._end()
        asked, self._asked = self._asked, None
        if asked is not None and asked is self._wanted:
            self._wanted = None
            self.failed.emit(GONE)
        elif self._wanted is not None:
            self._send()
