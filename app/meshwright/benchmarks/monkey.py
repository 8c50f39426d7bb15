"""Monkey test of the window: sends random mouse and key events and reports failures.

Moves, clicks, drags and wheel turns at random positions, and the keys of the action table and
others, go to the window, its dialogs and menus, while the agent may be running. Every step is saved
automatically, and questions about unsaved work are asked. The program is never quit and no file is
chosen. The window is small, since drawing its pixels is most of the work: 36 ms of CPU time an
event at 900 x 620, with software OpenGL, and 53 ms at 1280 x 800.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from traceback import extract_tb
from typing import Any

import numpy as np

from meshwright.benchmarks.desktop.display import display
from meshwright.console import Update, no_update

SUMMARY = "random mouse and key events at the window: exceptions, threads, timers, the mesh"
EVENTS, QUICK_EVENTS = 20_000, 400
LONGEST = 7200.0
SIZE = (900, 620)
"""Of the window, in pixels."""
EVERY = 250
"""Events between two reports of progress."""
SMALLEST, LARGEST = 4, 2000
"""A mesh with more elements is replaced by the star, and one with fewer soon."""
STUCK, SILENT = 20.0, 300.0
"""Seconds of CPU time, and of wall time, without an iteration of the event loop after which the
window counts as hung.
"""
PROGRESS = "progress "
"""How a line on the process's stderr begins that says how many events were sent."""
ENDING = 30.0
"""Time limit, in seconds, for threads to end after the window was closed."""


def run(seed: int = 0, quick: bool = False, update: Update = no_update) -> dict[str, Any]:
    """Send 20,000 events (``quick``: 400) to a window on the star and report what went wrong.

    Keys: ``events``, ``exceptions`` (their last lines), ``steps`` (of the history, by hand or
    agent), ``dialogs`` (which were opened), ``in_dialogs`` (events that went to a dialog or menu),
    ``slowest_ms`` (the longest time that an event took, and ``slowest_was``: which), ``threads``
    and ``timers`` that outlived the window, ``valid`` (is the mesh valid at the end?), ``undone``
    (did undoing everything lead back to the first state?). Raises RuntimeError without a display
    and if the window crashes.
    """
    with display() as environment, tempfile.TemporaryDirectory() as home:
        apart = {**environment, "XDG_CONFIG_HOME": home, "XDG_STATE_HOME": home}
        command = [sys.executable, "-m", __name__, str(seed)]
        command.append(str(QUICK_EVENTS if quick else EVENTS))
        code, result, remarks = _follow(command, apart, home, update)
    if code != 0 or not result:
        last = remarks[-1] if remarks else f"it ended with code {code}"
        raise RuntimeError(f"The window died under seed {seed}: {last}")
    return result


def _follow(
    command: list[str], environment: dict[str, str], folder: str, update: Update
) -> tuple[int, dict[str, Any], list[str]]:
    """Run the process of the window: its exit code, its result and what it wrote on stderr but for
    its reports of progress, which go to ``update``.
    """
    process = subprocess.Popen(
        command,
        env=environment,
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    ending = threading.Timer(LONGEST, process.kill)
    ending.start()
    remarks: list[str] = []
    try:
        assert process.stdout is not None
        assert process.stderr is not None
        for line in process.stderr:
            if line.startswith(PROGRESS):
                sent, *remark = line[len(PROGRESS) :].split(maxsplit=1)
                update(int(sent), "".join(remark).strip())
            elif line.strip():
                remarks.append(line.strip())
        out = process.stdout.read().strip()  # one line, written at the end
        code = process.wait()
    finally:
        ending.cancel()
        process.kill()
        process.wait()
    return code, json.loads(out.splitlines()[-1]) if out else {}, remarks


class Monkey:
    """Sends ``events`` random events to ``window`` from within the event loop.

    One timer shot, one event; the next shot is ordered before the event is sent, because an event
    that opens a dialog returns only when the dialog is closed.
    """

    def __init__(self, window: Any, seed: int, events: int, report: Update) -> None:
        from meshwright.desktop.actions.registry import ACTIONS

        self._report = report
        self.window, self.left, self.sent = window, events, 0
        self.rng = np.random.default_rng(seed)
        self.slowest, self.slowest_was = 0.0, ""
        self.doing = ""
        self.dialogs: set[str] = set()
        self.steps = 0
        self.over = 0  # events that went to a dialog or a menu
        self.busy: list[Any] = []  # the dialog or menu that was open when each event was sent
        window.document.recorded.connect(self._count)
        self.shortcuts = [
            keys for action in ACTIONS for keys in action.shortcuts if action.id != "quit"
        ]
        self.keys = ["Tab", "Return", "Esc", "Space", "Up", "Down", "Left", "Right", "Backspace"]
        self.keys += list("0123456789abcxyz-.,")

    def shoot(self) -> None:
        """Schedule the next call, then send one event if the last one has been processed."""
        from qtpy.QtCore import QTimer
        from qtpy.QtWidgets import QApplication

        if self.left <= 0:
            self._finish()
            return
        QTimer.singleShot(1, self.shoot)
        open_now = QApplication.activePopupWidget() or QApplication.activeModalWidget()
        if self.busy and self.busy[-1] is open_now:
            return  # QTest lets the event loop run before it returns
        self.left -= 1
        self.sent += 1
        if self.sent % EVERY == 0:
            self._report(self.sent)
        self.busy.append(open_now)
        began = time.perf_counter()
        try:
            self._send(open_now)
        finally:
            self.busy.pop()
        if open_now is None and not QApplication.activeModalWidget():
            taken = time.perf_counter() - began
            if taken > self.slowest:
                self.slowest, self.slowest_was = taken, self.doing

    def _count(self, event: str, number: int) -> None:
        self.steps += event == "step"

    def _pick(self, things: Sequence[Any]) -> Any:
        return things[int(self.rng.integers(len(things)))]

    def _finish(self) -> None:
        from qtpy.QtCore import QTimer
        from qtpy.QtWidgets import QApplication

        over = QApplication.activePopupWidget() or QApplication.activeModalWidget()
        if over is not None:
            over.close()
            QTimer.singleShot(10, self._finish)
        elif self.busy:
            QTimer.singleShot(10, self._finish)
        else:
            QApplication.exit(0)

    def _send(self, open_now: Any) -> None:
        from qtpy.QtWidgets import QDialog, QFileDialog

        document = self.window.document
        self.over += open_now is not None
        if not self.window.isVisible():
            self.left = 0
            raise RuntimeError(f"the window was closed by: {self.doing}")
        count = document.mesh.n_elements if document.mesh is not None else 0
        if not count or count > LARGEST or (count < SMALLEST and self.rng.random() < 0.05):
            document.replace(_star(self._pick(["tri", "quad"])), "star")
            return
        if isinstance(open_now, QFileDialog):
            open_now.reject()  # no file is named, opened or written
            return
        if isinstance(open_now, QDialog):
            self.dialogs.add(type(open_now).__name__)
        elif open_now is None:
            self.window.activateWindow()  # there may be no window manager to do it
        target = open_now or self.window
        what = self.rng.random()
        if open_now is not None and what < 0.1:
            self._press(target, "Esc")
        elif open_now is None and what < 0.3:
            self._edit()
        elif what < 0.7:
            self._mouse(target)
        else:
            self._key(target)

    def _mouse(self, target: Any) -> None:
        from qtpy.QtCore import QPoint, Qt
        from qtpy.QtTest import QTest

        rng = self.rng
        if target is self.window and rng.random() < 0.7 and self.window.canvas.built:
            widget = self.window.canvas.plotter
        else:
            at = QPoint(*(int(rng.integers(max(n, 1))) for n in (target.width(), target.height())))
            widget = target.childAt(at) or target
        if not widget.isVisible():
            return
        self.doing = f"mouse on {type(widget).__name__}"

        def place() -> QPoint:
            size = (widget.width(), widget.height())
            return QPoint(*(int(rng.integers(max(n, 1))) for n in size))

        left, right = Qt.MouseButton.LeftButton, Qt.MouseButton.RightButton
        button = self._pick([left, left, left, left, right])
        none, shift = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
        alt, control = Qt.KeyboardModifier.AltModifier, Qt.KeyboardModifier.ControlModifier
        modifier = self._pick([none, none, none, none, shift, shift | alt, control])
        what = rng.random()
        if what < 0.35:
            QTest.mouseMove(widget, place())
        elif what < 0.7:
            QTest.mouseClick(widget, button, modifier, place())
        elif what < 0.75:
            QTest.mouseDClick(widget, button, modifier, place())
        elif what < 0.9:
            start, end = place(), place()
            QTest.mousePress(widget, button, modifier, start)
            for share in (0.2, 0.5, 0.8):
                QTest.mouseMove(widget, start + (end - start) * share)
            QTest.mouseRelease(widget, button, modifier, end)
        else:
            self._wheel(widget, place())

    def _wheel(self, widget: Any, at: Any) -> None:
        from qtpy.QtCore import QPoint, Qt
        from qtpy.QtGui import QWheelEvent
        from qtpy.QtWidgets import QApplication

        event = QWheelEvent(
            at.toPointF(),
            widget.mapToGlobal(at).toPointF(),
            QPoint(),
            QPoint(0, self._pick([-240, -120, 120, 240])),
            Qt.MouseButton.NoButton,
            Qt.KeyboardModifier.NoModifier,
            Qt.ScrollPhase.NoScrollPhase,
            False,
        )
        QApplication.sendEvent(widget, event)

    def _edit(self) -> None:
        """Point somewhere on the canvas and press the key of an operation."""
        from qtpy.QtCore import QPoint
        from qtpy.QtTest import QTest

        from meshwright_core.operations.catalogue import of_kind

        canvas, mesh = self.window.canvas, self.window.document.mesh
        if not canvas.built or not canvas.isVisible():
            return
        place = mesh.points[self._pick(mesh.vertices())]
        x, y = canvas.viewport.to_screen(place) + self.rng.normal(0.0, 12.0, 2)
        if not (0 <= x < canvas.width() and 0 <= y < canvas.height()):  # may be far outside
            self._press(self.window, "Home")
            return
        QTest.mouseMove(canvas.plotter, QPoint(round(x), round(y)))
        self._press(self.window, self._pick(of_kind(mesh.kind)).key)

    def _key(self, target: Any) -> None:
        self._press(target, self._pick(self.shortcuts if self.rng.random() < 0.7 else self.keys))

    def _press(self, target: Any, name: str) -> None:
        from qtpy.QtGui import QKeySequence
        from qtpy.QtTest import QTest

        combination: Any = QKeySequence(name)[0]  # type: ignore[index]
        self.doing = f"key {name}, {self.window.document.mesh.n_elements} elements"
        widget = target.focusWidget() or target
        if widget.isVisible():
            QTest.keyClick(widget, combination.key(), combination.keyboardModifiers())


def _star(kind: str) -> Any:
    from meshwright_core.domains import gallery, meshing

    return meshing.mesh_domain(gallery.shape("star"), kind)


def _play(seed: int, events: int) -> dict[str, Any]:
    """Open a window, send the events, close it, and check what is left."""
    from qtpy.QtCore import QTimer
    from qtpy.QtWidgets import QApplication

    from meshwright.desktop.main_window.startup import application
    from meshwright.desktop.main_window.window import MainWindow
    from meshwright.document.document import Document
    from meshwright_agent import warm_up as agent_warm_up
    from meshwright_core import warm_up

    warm_up.warm()
    agent_warm_up.warm()  # numba compiles in one thread at a time, for which the window would wait
    exceptions: list[str] = []

    def report(done: int, remark: str = "") -> None:
        last = f"{len(exceptions)} exceptions, the last: {exceptions[-1]}" if exceptions else ""
        sys.stderr.write(f"{PROGRESS}{done} {last}\n")
        sys.stderr.flush()

    def note(kind: Any, value: Any, trace: Any) -> None:
        calls = [f"{Path(call.filename).name}:{call.lineno}" for call in extract_tb(trace)]
        exceptions.append(f"{kind.__name__}: {value} ({' '.join(calls[-12:])})")

    sys.excepthook = note
    threading.excepthook = lambda given: note(given.exc_type, given.exc_value, given.exc_traceback)
    app = application()
    app.setQuitOnLastWindowClosed(False)
    before = {thread.name for thread in threading.enumerate()}
    window = MainWindow(Document(_star("quad"), "star"), ready=True)
    folder = tempfile.TemporaryDirectory()
    window.files.watch(Path(folder.name))
    window.actions_by_id["quit"].setVisible(False)  # it is in a menu, too; refresh() enables it
    window.resize(*SIZE)
    window.show()
    window.activateWindow()
    monkey = Monkey(window, seed, events, report)
    window.opened.connect(lambda: QTimer.singleShot(0, monkey.shoot))
    beat = [time.process_time(), time.monotonic()]
    pulse = QTimer()
    pulse.timeout.connect(
        lambda: beat.__setitem__(slice(None), (time.process_time(), time.monotonic()))
    )
    pulse.start(200)
    threading.Thread(target=_watch, args=(beat, monkey), daemon=True, name="watch").start()
    app.exec()
    beat[:] = [float("inf")] * 2
    pulse.stop()
    document = window.document
    result = {
        "events": monkey.sent,
        "dialogs": sorted(monkey.dialogs),
        "steps": monkey.steps,
        "in_dialogs": monkey.over,
        "slowest_ms": 1000.0 * monkey.slowest,
        "slowest_was": monkey.slowest_was,
        **_sound(document),
        **_ended(app, window, before),
        "exceptions": exceptions,
    }
    QApplication.processEvents()
    folder.cleanup()
    return result


def _watch(beat: list[float], monkey: Monkey) -> None:
    """End the process if the event loop hangs."""
    import faulthandler
    import os

    while True:
        time.sleep(1.0)
        if time.process_time() - beat[0] > STUCK or time.monotonic() - beat[1] > SILENT:
            faulthandler.dump_traceback(all_threads=True)
            sys.stderr.write(f"\nthe event loop stood still after {monkey.sent} events\n")
            sys.stderr.flush()
            os._exit(3)


def _ended(app: Any, window: Any, before: set[str]) -> dict[str, Any]:
    """Close the window without saving; threads and timers that are still there afterwards."""
    from qtpy.QtCore import QTimer

    window.leave()
    end = time.monotonic() + ENDING
    ours = before | {"watch", "MainThread"}
    threads = sorted(t.name for t in threading.enumerate() if t.name not in ours)
    while threads and time.monotonic() < end:
        app.processEvents()
        time.sleep(0.05)
        threads = sorted(t.name for t in threading.enumerate() if t.name not in ours)
    timers = [t for t in window.findChildren(QTimer) if t.isActive()]
    return {"threads": threads, "timers": len(timers), "closed": not window.isVisible()}


def _sound(document: Any) -> dict[str, bool]:
    """Is the mesh valid, and does undoing everything lead back to a valid first state?"""
    if document.mesh is None:
        return {"valid": True, "undone": True}
    document.mesh.validate()
    end = document.mesh.elements()
    steps = document.history.cursor
    document.go_to(0)
    document.mesh.validate()
    document.go_to(steps)
    return {"valid": True, "undone": bool(np.array_equal(document.mesh.elements(), end))}


if __name__ == "__main__":
    sys.stdout.write(json.dumps(_play(int(sys.argv[1]), int(sys.argv[2]))) + "\n")
