"""Preparing the kernels behind the window: stages, failure, and a window that closes meanwhile."""

import sys
import threading

import pytest
from driving import WAIT, press
from qtpy.QtCore import Qt

from meshwright.assistant.kernel_preparation import KernelPreparation, Stage
from meshwright.desktop.application import kernel_warmup
from meshwright.desktop.application.kernel_warmup import (
    LOADING,
    MINUTES,
    UNUSABLE,
    KernelWarmup,
)
from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.widgets.basic import NoticeBar
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.graphics.theme import theme


def waiting(path) -> list[str]:
    """A command that ends when a file appears."""
    code = "import os, sys, time\nwhile not os.path.exists(sys.argv[1]): time.sleep(0.01)"
    return [sys.executable, "-c", code, str(path)]


class Prepared:
    """A warm-up whose compilations end when files appear in ``folder``."""

    def __init__(self, qtbot, folder, cold=(), load=lambda: None):
        self.folder, self.cold = folder, list(cold)
        self.readiness, self.status = Readiness(), StatusBar()
        self.notice = NoticeBar(theme("light"))
        for widget in (self.status, self.notice):
            qtbot.addWidget(widget)
        self.warmup = KernelWarmup(
            self.readiness, self.status, self.notice, theme("light"), self._prepare, load
        )

    def _prepare(self, load) -> KernelPreparation:
        return KernelPreparation(
            lambda stage: stage not in self.cold, load, lambda stage: waiting(self.folder / stage)
        )

    def finish(self, stage: Stage) -> None:
        self.cold.remove(stage)
        (self.folder / stage).touch()


@pytest.fixture
def prepared(qtbot, tmp_path):
    made = []

    def build(*arguments, **named) -> Prepared:
        made.append(Prepared(qtbot, tmp_path, *arguments, **named))
        return made[-1]

    yield build
    for one in made:
        one.warmup.close()


def test_each_stage_is_shown_and_enables_what_it_compiled(qtbot, prepared):
    state = prepared([Stage.EDITING, Stage.AGENT])
    state.warmup.start()
    assert state.status.preparation.startswith("Preparing the operations, once after an update: ")
    assert state.readiness.preparing == f"{state.status.preparation} {MINUTES}"
    assert 0 <= state.readiness.share <= 1
    assert not state.readiness.editing
    state.finish(Stage.EDITING)
    qtbot.waitUntil(lambda: "search" in state.status.preparation, timeout=WAIT)
    assert state.readiness.editing
    assert not state.readiness.agent
    state.finish(Stage.AGENT)
    qtbot.waitUntil(lambda: state.readiness.agent, timeout=WAIT)
    assert state.status.preparation == ""


def test_compiled_kernels_are_only_loaded(qtbot, prepared):
    shown = threading.Event()
    state = prepared(load=lambda: shown.wait(WAIT / 1000) and None)
    state.warmup.start()
    assert state.status.preparation == LOADING
    shown.set()
    qtbot.waitUntil(lambda: state.readiness.agent, timeout=WAIT)
    assert state.readiness.editing
    assert state.status.preparation == ""


def test_nothing_is_reported_after_closing(qtbot, prepared):
    closing = threading.Event()
    state = prepared(load=lambda: closing.wait(WAIT / 1000) and None)
    state.warmup.start()
    closing.set()
    state.warmup.close()  # the thread has ended, and its report waits in the queue
    qtbot.wait(20)
    assert not state.readiness.editing


def test_closing_kills_the_compiling_process(prepared):
    state = prepared([Stage.EDITING])
    state.warmup.start()
    state.warmup.close()  # waits for the thread
    assert not state.readiness.editing


def test_nothing_starts_after_closing(prepared):
    state = prepared()
    state.warmup.close()
    state.warmup.start()
    assert state.status.preparation == ""


def test_a_failure_is_reported_as_a_sentence(qtbot, prepared):
    def fail() -> None:
        raise OSError("no room")

    state = prepared([Stage.EDITING], load=fail)
    state.warmup.start()
    state.finish(Stage.EDITING)
    qtbot.waitUntil(lambda: state.notice.text != "", timeout=WAIT)
    assert state.notice.text == "The compiled kernels cannot be used: no room"
    qtbot.wait(20)
    assert not state.readiness.editing
    assert state.status.preparation == state.readiness.preparing == UNUSABLE


def test_the_agent_panel_says_what_is_prepared_until_complete_can_be_pressed(
    qtbot, open_window, star, tmp_path, monkeypatch
):
    cold = [Stage.AGENT]
    monkeypatch.setattr(
        kernel_warmup,
        "KernelPreparation",
        lambda load: KernelPreparation(
            lambda stage: stage not in cold, load, lambda stage: waiting(tmp_path / "compiled")
        ),
    )
    window = open_window(star, ready=False)
    panel = window.agent_panel
    said = panel.progress.text
    qtbot.waitUntil(lambda: said().startswith("Preparing the search"), timeout=WAIT)
    assert "once after an update" in said() and MINUTES in said()
    assert panel.bar.isVisible() and 0 <= panel.bar.share <= 1
    assert not panel.complete.isEnabled()
    press(qtbot, window, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)
    assert window.status.message == (
        "Complete: Needs a mesh and a policy that is ready: see the panel Agent."
    )
    cold.clear()
    (tmp_path / "compiled").touch()
    qtbot.waitUntil(panel.complete.isEnabled, timeout=WAIT)
    assert said() == "Ready" and not panel.bar.isVisible()
    qtbot.mouseClick(panel.complete, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: window.document.history.cursor > 0, timeout=WAIT)
