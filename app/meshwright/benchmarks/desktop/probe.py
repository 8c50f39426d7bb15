"""Measurements of the window, run as ``python -m`` this module with WHAT, BEGAN and numbers.

Prints one JSON object.
"""

from __future__ import annotations

import itertools
import json
import sys
import time
from collections.abc import Callable
from functools import partial
from statistics import median
from typing import Any

import numpy as np

HOVERS, OPERATIONS = 60, 15
PLAY_SECONDS = 6.0
PLAYED_SPEED = 20.0
"""Speed of the agent in operations per second."""
KERNELS_S = 300.0
SCRAMBLES = 50
"""One in this many elements gets an operation first, so that the mesh is irregular."""


def start(began: float, *numbers: int) -> dict[str, Any]:
    """Open the window on the star and record when each part is ready."""
    from qtpy.QtCore import QEvent, QObject

    from meshwright.desktop.main_window.startup import application, open_window

    result: dict[str, Any] = {}

    class FirstPaintFilter(QObject):
        def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
            if event.type() == QEvent.Type.Paint and "first_paint_s" not in result:
                result["first_paint_s"] = time.time() - began
                result["torch_at_first_paint"] = "torch" in sys.modules
                result["pyvista_at_first_paint"] = "pyvista" in sys.modules
                result["compiled_at_first_paint"] = window.readiness.editing
            return False

    app = application()
    watch = FirstPaintFilter()
    window = open_window("star", demo=False)
    window.installEventFilter(watch)
    _spin(app, lambda: window.canvas.built)
    _frame(app, window)
    result["mesh_drawn_s"] = time.time() - began
    # minutes where nothing was compiled yet
    _spin(app, lambda: window.readiness.editing, KERNELS_S)
    result["kernels_ready_s"] = time.time() - began
    result["torch_at_the_end"] = "torch" in sys.modules
    window.close()
    return result


def answer(began: float, size: int, seed: int) -> dict[str, Any]:
    """Move the mouse over a mesh of ``size`` quads, and do operations by key."""
    mesh = scrambled(size, seed)
    at = time.perf_counter()
    app, window = _open(mesh)
    result: dict[str, Any] = {"open_s": time.perf_counter() - at, "irregular": _irregular(mesh)}
    _hover(app, window, 1)  # the first move builds the search tree
    frames = _count_frames(window)
    times = _hover(app, window, HOVERS)
    result["hover_ms"] = {"median": median(times), "slowest": max(times)}
    result["frames_per_hover"] = frames[0] / len(times)
    result["operation_ms"] = _operate(app, window)
    window.close()
    return result


def play(began: float, size: int, seed: int) -> dict[str, Any]:
    """Let the shipped policy play on a mesh of ``size`` quads while the mouse moves."""
    from meshwright.assistant.assistant import State
    from meshwright.assistant.policy_catalogue import shipped

    mesh = scrambled(size, seed, every=5)
    app, window = _open(mesh)
    assistant, document = window.assistant, window.document
    assistant.policy = shipped("quad")[0]
    assistant.speed = PLAYED_SPEED
    assistant.play()
    _spin(app, lambda: document.history.cursor > 3, KERNELS_S)
    frames = _count_frames(window)
    cursor, at = document.history.cursor, time.perf_counter()
    times = []
    while time.perf_counter() - at < PLAY_SECONDS and assistant.state is State.PLAYING:
        times += _hover(app, window, 1)
        until = time.perf_counter() + 0.02
        while time.perf_counter() < until:
            app.processEvents()
    elapsed = time.perf_counter() - at
    result = {
        "operations_per_s": (document.history.cursor - cursor) / elapsed,
        "frames_per_s": frames[0] / elapsed,
        "seconds": elapsed,
        "answer_ms": {
            "median": median(times),
            "95 %": float(np.quantile(times, 0.95)),
            "slowest": max(times),
        },
    }
    window.close()
    return result


def _open(mesh: Any) -> tuple[Any, Any]:
    from meshwright.desktop.main_window.startup import application
    from meshwright.desktop.main_window.window import MainWindow
    from meshwright.document.document import Document
    from meshwright_core import warm_up

    warm_up.warm()
    app = application()
    window = MainWindow(Document(mesh), ready=True)
    window.resize(1280, 800)
    window.show()
    _spin(app, lambda: window.canvas.built)
    window.activateWindow()
    _frame(app, window)
    return app, window


def scrambled(size: int, seed: int, every: int = SCRAMBLES) -> Any:
    """A square grid of ``size`` quads after random flips, smoothed."""
    from meshwright_core import warm_up
    from meshwright_core.domains import meshing
    from meshwright_core.geometry import smoothing

    warm_up.warm()
    rng = np.random.default_rng(seed)
    mesh = meshing.grid("quad", size)
    for h in rng.integers(0, 4 * mesh.n_elements, size // every).tolist():
        if mesh.check("flip_left", h):
            mesh.apply("flip_left", h)
    smoothing.relax(mesh)
    return mesh.copy()  # without a history


def _irregular(mesh: Any) -> int:
    return int(np.count_nonzero(mesh.irregularity()))


def _hover(app: Any, window: Any, count: int) -> list[float]:
    """Milliseconds from a mouse move until the overlay has been painted."""
    from qtpy.QtCore import QEvent, QObject, QPoint
    from qtpy.QtTest import QTest

    painted = [0]

    class EventFilter(QObject):
        def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
            painted[0] += event.type() == QEvent.Type.Paint
            return False

    watch = EventFilter()
    overlay, plotter = window.canvas.overlay, window.canvas.plotter
    overlay.installEventFilter(watch)
    times = []
    for _ in range(count):
        before, halfedge, at = painted[0], window.document.hover, time.perf_counter()
        while window.document.hover == halfedge:  # a move within one half-edge paints nothing
            at = time.perf_counter()
            step = next(_steps)
            x = 200 + 17 * step % 300
            QTest.mouseMove(plotter, QPoint(x, 200 + 11 * step % 200))
        _spin(app, partial(_above, painted, before))
        times.append(1000.0 * (time.perf_counter() - at))
    overlay.removeEventFilter(watch)
    return times


def _above(counter: list[int], before: int) -> bool:
    return counter[0] > before


_steps = itertools.count(1)
"""Positions of the mouse continue from one measurement to the next."""


def _operate(app: Any, window: Any) -> dict[str, float]:
    """Medians in milliseconds from a key to the drawn operation, in total and by part; besides
    ``first``, the first operation, and ``undo``, the first undo, both in total.
    """
    from qtpy.QtCore import QPoint, Qt
    from qtpy.QtTest import QTest

    canvas, document = window.canvas, window.document
    shares = ("whole", "document", "prepare", "frame", "show")
    spans: dict[str, list[float]] = {name: [] for name in shares}
    marks: dict[str, float] = {}
    document.changed.connect(lambda: marks.setdefault("document", time.perf_counter()))
    observers = [
        canvas.plotter.ren_win.AddObserver(event, lambda *_, e=event: marks.setdefault(e, _now()))
        for event in ("StartEvent", "EndEvent")
    ]

    def swapped() -> None:
        if "EndEvent" in marks:  # else it was a repaint of the overlay alone
            marks.setdefault("shown", _now())

    canvas.plotter.frameSwapped.connect(swapped)

    def pressed(key: Any, modifier: Any = Qt.KeyboardModifier.NoModifier) -> float | None:
        """Seconds from the key to the picture; None if it has changed nothing."""
        cursor, at = document.history.cursor, _now()
        marks.clear()
        QTest.keyClick(canvas.plotter, key, modifier)
        if document.history.cursor == cursor:
            return None
        _spin(app, lambda: "shown" in marks)
        marks["key"] = at
        return marks["shown"] - at

    undo = None
    for i in range(OPERATIONS):
        QTest.mouseMove(canvas.plotter, QPoint(200 + 23 * i, 240 + 7 * i))
        _spin(app, lambda: document.hover >= 0)
        app.processEvents()
        whole = pressed(Qt.Key.Key_F)
        if whole is None:
            continue
        spans["whole"].append(whole)
        spans["document"].append(marks["document"] - marks["key"])
        spans["prepare"].append(marks["StartEvent"] - marks["document"])
        spans["frame"].append(marks["EndEvent"] - marks["StartEvent"])
        spans["show"].append(marks["shown"] - marks["EndEvent"])
        if undo is None:
            undo = pressed(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    for tag in observers:
        canvas.plotter.ren_win.RemoveObserver(tag)
    seconds = {name: median(times) for name, times in spans.items()}
    seconds |= {"first": spans["whole"][0], "undo": undo or 0.0}
    return {name: 1000.0 * taken for name, taken in seconds.items()}


def _now() -> float:
    return time.perf_counter()


def _count_frames(window: Any) -> list[int]:
    frames = [0]

    def count(*_: Any) -> None:
        frames[0] += 1

    window.canvas.plotter.ren_win.AddObserver("EndEvent", count)
    return frames


def _frame(app: Any, window: Any) -> None:
    """Run the event loop until the plotter has drawn the present state."""
    frames = _count_frames(window)
    _spin(app, lambda: bool(frames[0]))


def _spin(app: Any, condition: Callable[[], bool], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise RuntimeError(f"the window did not answer within {seconds:g} s")
        app.processEvents()


if __name__ == "__main__":
    _measurement: Any = {"start": start, "answer": answer, "play": play}[sys.argv[1]]
    sys.stdout.write(
        json.dumps(_measurement(float(sys.argv[2]), *(int(n) for n in sys.argv[3:]))) + "\n"
    )
