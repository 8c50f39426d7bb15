"""A mesh, a policy and a window for the tests of the application; no torch needed."""

import threading
from collections.abc import Callable, Iterator
from queue import Empty, Queue
from typing import Any

import numpy as np
import pytest

from meshwright_agent.policy.explanation_types import Insight, PolicyAction
from meshwright_core import HalfEdgeMesh, Operation
from meshwright_core.domains import gallery, meshing
from meshwright_core.operations.catalogue import of_kind

LOCAL = ("flip", "flip_left", "flip_right", "split", "collapse")


class Greedy:
    """Stands in for ``meshwright_agent.policy.rollout.Runner``: the best single operation;
    sometimes a bad one.
    """

    def __init__(self, mesh: HalfEdgeMesh, bad_steps: int = 0, longest: int = 60) -> None:
        self.mesh = mesh.copy()
        self.bad_steps = bad_steps
        self.longest = longest
        self.steps = 0
        self.rng = np.random.default_rng(4)
        self.choices: list[PolicyAction] = []
        self.wanted: PolicyAction | None = None
        self.finished = False
        self.reason = ""

    def look(self) -> Insight | None:
        """Sees all of the best operations, each as likely as the others."""
        wanted = self._choose()
        if wanted is None:
            return None
        halfedges = np.array(sorted({choice.halfedge for choice in self.choices}))
        ends = [self.mesh.origin(wanted.halfedge), self.mesh.target(wanted.halfedge)]
        return Insight(
            choices=tuple(self.choices),
            wanted=wanted,
            halfedges=halfedges,
            weights=np.full(len(halfedges), 1.0 / len(halfedges)),
            template=np.array([(v, slot, 0) for slot, v in enumerate(ends)]),
            missing=0,
            field=np.array([(wanted.halfedge // self.mesh.k, 0)]),
            value=0.5,
        )

    def step(self) -> list[tuple[Operation, int]]:
        wanted, self.wanted = self._choose(), None
        if wanted is None:
            return []
        self.mesh.apply(wanted.operation, wanted.halfedge)
        self.steps += 1
        if self.mesh.score == self.mesh.optimum:
            self._finish("the optimum is reached")
        elif self.steps == self.longest:
            self._finish("out of steps")
        return [(wanted.operation, wanted.halfedge)]

    def _choose(self) -> PolicyAction | None:
        if self.wanted is not None:
            return self.wanted
        if self.mesh.score == self.mesh.optimum and not self.bad_steps:
            self._finish("the optimum is reached")
            return None
        if self.steps == self.longest:
            self._finish("out of steps")
            return None
        changes = []
        for halfedge in (self.mesh.element_ids()[:, None] * self.mesh.k + range(self.mesh.k)).flat:
            for info in of_kind(self.mesh.kind):
                if info.operation.value in LOCAL and self.mesh.check(info.operation, halfedge):
                    edit = self.mesh.apply(info.operation, int(halfedge))
                    self.mesh.undo()
                    changes.append((edit.score_change, info.operation, int(halfedge)))
        wanted = (max if self.steps < self.bad_steps else min)(change[0] for change in changes)
        changes = [change for change in changes if change[0] == wanted]
        self.choices = [PolicyAction(o, h, 1.0 / len(changes), change) for change, o, h in changes]
        self.wanted = self.choices[self.rng.integers(len(changes))]
        return self.wanted

    def _finish(self, reason: str) -> None:
        self.finished, self.reason = True, reason


def ask_greedy(
    mesh: HalfEdgeMesh, policy: str, near: np.ndarray | None
) -> tuple[PolicyAction, ...]:
    """Stands in for ``meshwright_agent.policy.explanation.hints``: the first five of the best
    operations.
    """
    insight = Greedy(mesh).look()
    return () if insight is None else insight.choices[:5]


class Desk:
    """The document's thread in tests without Qt: a queue of calls, worked off on demand."""

    def __init__(self) -> None:
        self.calls: Queue[Callable[[], None]] = Queue()
        self.thread = threading.current_thread()

    def dispatch(self, call: Callable[[], None]) -> None:
        self.calls.put(call)

    def until(self, condition: Callable[[], bool], seconds: float = 60.0) -> None:
        """Work off calls until ``condition()``; fails after ``seconds`` without a call."""
        while not condition():
            try:
                self.calls.get(timeout=seconds)()
            except Empty:
                pytest.fail("the assistant fell silent")

    def work(self) -> None:
        """Work off what is there."""
        while not self.calls.empty():
            self.calls.get()()


@pytest.fixture(scope="session")
def prepared_agent() -> None:
    """The agent's kernels are compiled, so that no command reports that it compiles them."""
    from meshwright_agent import warm_up

    if not warm_up.is_warm_on_disk():
        warm_up.warm()


@pytest.fixture
def desk() -> Desk:
    return Desk()


@pytest.fixture
def greedy() -> type[Greedy]:
    return Greedy


@pytest.fixture(scope="session")
def _star() -> dict[str, HalfEdgeMesh]:
    return {kind: meshing.mesh_domain(gallery.shape("star"), kind) for kind in ("quad", "tri")}


@pytest.fixture
def star(_star: dict[str, HalfEdgeMesh]) -> HalfEdgeMesh:
    """The star in quads: s 12, optimum 4."""
    return _star["quad"].copy()


@pytest.fixture
def triangles(_star: dict[str, HalfEdgeMesh]) -> HalfEdgeMesh:
    """The star in triangles."""
    return _star["tri"].copy()


@pytest.fixture
def strip() -> HalfEdgeMesh:
    """Two quads side by side on the rectangle from (0, 0) to (2, 1); four corners."""
    points = np.array([(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)], dtype=float)
    return HalfEdgeMesh.from_elements(points, np.array([(0, 1, 4, 3), (1, 2, 5, 4)]))


@pytest.fixture(scope="session", autouse=True)
def _own_state(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Nothing that a person's own windows have left behind is offered to tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MESHWRIGHT_STATE_DIR", str(tmp_path_factory.mktemp("state")))
        yield


@pytest.fixture(scope="session")
def _own_settings(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Windows of tests keep their settings in a folder of the tests."""
    from qtpy.QtCore import QSettings

    folder = str(tmp_path_factory.mktemp("settings"))
    QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, folder)


@pytest.fixture(scope="session")
def _application(qapp: Any, _own_settings: None) -> None:
    """The application is set up as Meshwright does it, and the kernels are loaded, once: Qt applies
    a style to all widgets there are, also to those of a window that has just been closed.
    """
    from meshwright.desktop.main_window.startup import application
    from meshwright_core import warm_up

    warm_up.warm()
    application()


def _without_question(window: Any) -> None:
    """After a test, no dialog or worker is left to answer."""
    if window.isVisible():
        window.files.leave()


@pytest.fixture
def open_window(qtbot: Any, greedy: type[Greedy], _application: None) -> Iterator[Callable]:
    """Opens a window on a mesh, with :class:`Greedy` as its policy; closed after the test."""
    from driving import WAIT
    from qtpy.QtCore import QTimer

    from meshwright.assistant.assistant import Assistant
    from meshwright.desktop.application.main_thread import Dispatcher
    from meshwright.desktop.application.settings import Settings
    from meshwright.desktop.main_window.window import MainWindow
    from meshwright.document.document import Document

    Settings().clear()
    windows = []

    def build(mesh: HalfEdgeMesh | None = None, ready: bool = True, **options: int) -> MainWindow:
        document = Document(mesh, "star" if mesh is not None else "")
        assistant = Assistant(
            document,
            Dispatcher(),
            load=lambda name: name,
            make_runner=lambda mesh, policy, seed: greedy(mesh, **options),
            make_search=lambda mesh, *_: greedy(mesh, **options),
            ask=ask_greedy,
        )
        window = MainWindow(document, assistant=assistant, ready=ready)
        window.resize(1000, 700)
        assistant.policy = "greedy" if mesh is not None else ""
        windows.append(window)
        qtbot.addWidget(window, before_close_func=_without_question)
        with qtbot.waitSignal(window.opened, timeout=WAIT):
            window.show()
        window.activateWindow()  # there is no window manager to do it
        qtbot.waitUntil(window.isActiveWindow, timeout=WAIT)
        qtbot.waitUntil(lambda: window.canvas.viewport.size[0] > 300, timeout=WAIT)
        return window

    yield build
    for window in windows:
        window.close()
        assert not [t for t in window.findChildren(QTimer) if t.isActive()]
    for thread in threading.enumerate():
        if thread.name.startswith(("assistant", "kernel-preparation", "quality")):
            thread.join(10)
            assert not thread.is_alive()
