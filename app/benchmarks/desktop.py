"""The desktop measured: how soon the window is there, and how soon it answers.

Every measurement is made in a process of its own that drives the window by Qt's own events. A
display is needed; where there is none and Xvfb is installed, a virtual one is started.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from statistics import median
from typing import Any

import numpy as np

from app.report import Update

SUMMARY = "start of the window, and its answers to mouse and keys"
SIZES = (1_000, 10_000, 100_000)
"""Quads of the meshes that hover and operations are measured on."""
REPEATS = 15
LONGEST = 300.0


def run(
    seed: int = 0, quick: bool = False, update: Update = lambda done, remark: None
) -> dict[str, Any]:
    """Seconds from the start of a process to the first paint and to the mesh on the screen, and
    milliseconds from a mouse move to the drawn half-edge and from a key to the drawn operation.

    ``quick`` measures the smallest mesh only; nothing here is random. Keys: ``first_paint_s``,
    ``mesh_drawn_s``, ``kernels_ready_s``, ``torch_at_first_paint``, ``pyvista_at_first_paint`` and
    ``compiled_at_first_paint`` (were these modules or the kernels loaded then?), ``hover_ms`` and
    ``operation_ms`` by number of quads, and ``display``. Raises RuntimeError without a display.
    """
    with _display() as environment:
        update(0, "kernels")
        subprocess.run([sys.executable, "-m", "meshcore.warm_up"], check=True, capture_output=True)
        update(1, "start")
        _probe("start", environment)  # warm: the second start is the one that counts
        started = _probe("start", environment)
        update(2, "answers")
        answers = _probe("answer", environment, SIZES[:1] if quick else SIZES)
    return {"display": environment["DISPLAY"], **started, **answers}


@contextmanager
def _display() -> Iterator[dict[str, str]]:
    environment = dict(os.environ)
    if environment.get("DISPLAY") or sys.platform != "linux":
        environment.setdefault("DISPLAY", "")
        yield environment
        return
    if shutil.which("Xvfb") is None:
        raise RuntimeError("The desktop cannot be measured: there is no display and no Xvfb.")
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1920x1200x24"]
    server = subprocess.Popen(command, pass_fds=(write,), stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as told:
            environment["DISPLAY"] = ":" + told.readline().strip()
        yield environment
    finally:
        server.terminate()
        server.wait()


def _probe(what: str, environment: dict[str, str], sizes: tuple[int, ...] = ()) -> dict[str, Any]:
    """Run one of the measurements below in a fresh process."""
    command = [sys.executable, "-m", "app.benchmarks.desktop", what, repr(time.time())]
    command += [str(size) for size in sizes]
    done = subprocess.run(
        command, env=environment, capture_output=True, text=True, timeout=LONGEST, check=False
    )
    if done.returncode != 0:
        last = (done.stderr.strip() or "no message").splitlines()[-1]
        raise RuntimeError(f"The window could not be measured: {last}")
    result: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return result


def _start(began: float, sizes: list[int]) -> dict[str, Any]:
    """Open the window on the star and note when what is there."""
    from qtpy.QtCore import QEvent, QObject

    from app.desktop.application import application, open_window

    result: dict[str, Any] = {}

    class Watch(QObject):
        def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
            if event.type() == QEvent.Type.Paint and "first_paint_s" not in result:
                result["first_paint_s"] = time.time() - began
                result["torch_at_first_paint"] = "torch" in sys.modules
                result["pyvista_at_first_paint"] = "pyvista" in sys.modules
                result["compiled_at_first_paint"] = window.ready
            return False

    app = application()
    watch = Watch()
    window = open_window("star", demo=False)
    window.installEventFilter(watch)
    _spin(app, lambda: window.canvas.plotter is not None)
    _frame(app, window)
    result["mesh_drawn_s"] = time.time() - began
    _spin(app, lambda: window.ready, LONGEST)  # minutes where nothing was compiled yet
    result["kernels_ready_s"] = time.time() - began
    result["torch_at_the_end"] = "torch" in sys.modules
    window.close()
    return result


def _answer(began: float, sizes: list[int]) -> dict[str, Any]:
    """Move the mouse over meshes of several sizes, and do operations by key."""
    from app.desktop.application import application
    from app.desktop.window import MainWindow
    from app.document import Document
    from meshcore import HalfEdgeMesh, compiled

    compiled.warm()
    app = application()
    result: dict[str, Any] = {"hover_ms": {}, "operation_ms": {}}
    for size in sizes:
        side = round(size**0.5)
        points, quads = _grid(side)
        window = MainWindow(Document(HalfEdgeMesh.from_elements(points, quads)), ready=True)
        window.resize(1280, 800)
        window.show()
        _spin(app, partial(_is_built, window))
        window.activateWindow()
        _frame(app, window)
        result["hover_ms"][str(side * side)] = _hover(app, window)
        result["operation_ms"][str(side * side)] = _operation(app, window)
        window.close()
    return result


def _hover(app: Any, window: Any) -> float:
    from qtpy.QtCore import QEvent, QObject, QPoint
    from qtpy.QtTest import QTest

    painted = [0]

    class Watch(QObject):
        def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
            painted[0] += event.type() == QEvent.Type.Paint
            return False

    watch = Watch()
    window.canvas.overlay.installEventFilter(watch)
    plotter, times = window.canvas.plotter, []
    for i in range(REPEATS):
        count, at = painted[0], time.perf_counter()
        QTest.mouseMove(plotter, QPoint(200 + 17 * i, 200 + 11 * i))
        _spin(app, partial(_exceeds, painted, count))
        times.append(time.perf_counter() - at)
    window.canvas.overlay.removeEventFilter(watch)
    return 1000.0 * median(times[1:])  # the first move builds the search tree


def _operation(app: Any, window: Any) -> float:
    from qtpy.QtCore import QPoint, Qt
    from qtpy.QtTest import QTest

    plotter, times = window.canvas.plotter, []
    for i in range(REPEATS):
        QTest.mouseMove(plotter, QPoint(200 + 23 * i, 240 + 7 * i))
        _spin(app, lambda: window.document.hover >= 0)
        cursor, at = window.document.history.cursor, time.perf_counter()
        QTest.keyClick(plotter, Qt.Key.Key_F)
        if window.document.history.cursor > cursor:
            _frame(app, window)
            times.append(time.perf_counter() - at)
    return 1000.0 * median(times)


def _exceeds(counter: list[int], count: int) -> bool:
    return counter[0] > count


def _is_built(window: Any) -> bool:
    return window.canvas.plotter is not None


def _grid(side: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and elements of a square grid of ``side`` by ``side`` quads."""
    x, y = np.meshgrid(np.linspace(0, 1, side + 1), np.linspace(0, 1, side + 1))
    ids = np.arange((side + 1) ** 2).reshape(side + 1, side + 1)
    corners = (ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1])
    quads = np.stack([part.ravel() for part in corners], axis=1)
    return np.column_stack((x.ravel(), y.ravel())), quads


def _frame(app: Any, window: Any) -> None:
    """Let the event loop run until the plotter has drawn what is there now."""
    frames: list[object] = []
    tag = window.canvas.plotter.ren_win.AddObserver("EndEvent", lambda *_: frames.append(1))
    _spin(app, lambda: bool(frames))
    window.canvas.plotter.ren_win.RemoveObserver(tag)


def _spin(app: Any, condition: Callable[[], bool], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError(f"the window did not answer within {seconds:g} s")
        app.processEvents()


if __name__ == "__main__":
    _measurement = {"start": _start, "answer": _answer}[sys.argv[1]]
    sys.stdout.write(
        json.dumps(_measurement(float(sys.argv[2]), [int(size) for size in sys.argv[3:]])) + "\n"
    )
