"""Background compilation with the first view; requests that need kernels are refused until then."""

import sys
import threading
import time

import pytest
from porting import Port, allowed, script_agent

from meshwright.assistant.kernel_preparation import KernelPreparation, Stage
from meshwright.document.document import Document
from meshwright.notebook.session import Session


@pytest.fixture
def port(star, monkeypatch, greedy):
    script_agent(monkeypatch, greedy)
    port = Port(Session.of(Document(star)))
    yield port
    port.close()


class Gates:
    """A preparation with processes that the test ends."""

    def __init__(self, tmp_path, cold: tuple[Stage, ...], code: int = 0) -> None:
        self.cold, self.loaded = list(cold), 0
        self._folder, self._code = tmp_path, code
        self.preparation = KernelPreparation(
            lambda stage: stage not in self.cold, self._load, self._go
        )

    def _load(self) -> None:
        self.loaded += 1

    def _go(self, stage: Stage) -> list[str]:
        code = (
            "import os, sys, time\n"
            "while not os.path.exists(sys.argv[1]): time.sleep(0.01)\n"
            f"sys.exit({self._code})"
        )
        return [sys.executable, "-c", code, str(self._folder / stage)]

    def open(self, stage: Stage) -> None:
        self.cold.remove(stage)
        (self._folder / stage).touch()


def until(port, condition) -> None:
    assert port.session.loop.pump(condition, 20)


def test_ready_at_once_with_a_warm_cache(port, tmp_path, monkeypatch):
    gates = Gates(tmp_path, ())
    monkeypatch.setattr("meshwright.notebook.kernel_warmup.PREPARATION", gates.preparation)
    port.ask("hello")
    port.operate(*allowed(port.session.mesh))
    assert port.of("notice") == [] and len(port.session.document.history) == 1
    until(port, lambda: gates.loaded == 1)
    time.sleep(0.05)
    port.session.loop.drain()
    assert port.of("notice") == []


@pytest.mark.parametrize("code", [0, 1])
def test_requests_that_need_kernels_are_refused_until_compiled(port, tmp_path, monkeypatch, code):
    gates = Gates(tmp_path, (Stage.EDITING, Stage.AGENT), code)
    monkeypatch.setattr("meshwright.notebook.kernel_warmup.PREPARATION", gates.preparation)
    state, *_, notice = port.ask("hello")
    assert state["type"] == "state" and notice["tone"] == "info"
    assert notice["sentence"].startswith("Preparing the operations")
    [ghost] = port.ask("hover", halfedge=4, operation=None)
    assert ghost["halfedge"] == -1
    port.operate(*allowed(port.session.mesh))
    assert (
        port.sentence.startswith("Preparing the operations") and not port.session.document.history
    )
    gates.open(Stage.EDITING)
    until(port, lambda: port.sentence == "The operations are ready.")
    port.operate(*allowed(port.session.mesh))
    assert port.session.document.history.cursor == 1
    port.ask("agent", action="step")
    assert port.sentence.startswith("Preparing the agent")
    gates.open(Stage.AGENT)
    until(port, lambda: port.sentence == "Everything is ready.")
    port.ask("agent", action="step")
    assert port.session.wait(10) and port.session.document.history.cursor > 1
    assert gates.loaded == 1


def test_a_failed_compilation_is_logged_and_blocks_nothing(port, monkeypatch, caplog):
    def broken() -> None:
        raise RuntimeError("no compiler")

    preparation = KernelPreparation(lambda stage: True, broken)
    monkeypatch.setattr("meshwright.notebook.kernel_warmup.PREPARATION", preparation)
    port.ask("hello")
    until(port, lambda: "no compiler" in caplog.text)
    port.operate(*allowed(port.session.mesh))
    assert port.session.document.history.cursor == 1


def test_two_sessions_are_notified_by_one_thread(port, triangles, tmp_path, monkeypatch):
    gates = Gates(tmp_path, (Stage.EDITING,))
    monkeypatch.setattr("meshwright.notebook.kernel_warmup.PREPARATION", gates.preparation)
    other = Port(Session.of(Document(triangles)))
    port.ask("hello")
    other.ask("hello")
    assert sum(thread.name == "kernel-preparation" for thread in threading.enumerate()) == 1
    gates.open(Stage.EDITING)
    until(port, lambda: port.sentence == "Everything is ready.")
    until(other, lambda: other.sentence == "Everything is ready.")
    other.close()
