"""Loading the kernels behind the window, and a window that is closed before they are loaded."""

import pytest

from meshwright.desktop.application.kernel_warmup import Warmup

KERNELS = "meshwright.desktop.application.kernel_warmup.compilation"


@pytest.fixture(autouse=True)
def _compiled_before(monkeypatch):
    monkeypatch.setattr(f"{KERNELS}.is_warm_on_disk", lambda: True)


def test_kernels_loaded_while_the_window_closes_are_not_reported(qtbot, monkeypatch):
    monkeypatch.setattr(f"{KERNELS}.warm", lambda: None)
    warmup, reported = Warmup(), []
    warmup.ready.connect(lambda: reported.append("ready"))
    warmup.start()
    warmup.stop()  # the thread has ended, and its report waits in the queue
    qtbot.wait(20)
    assert reported == []
    assert not warmup.done


def test_a_closed_window_starts_nothing(qtbot):
    warmup = Warmup()
    warmup.stop()
    warmup.start()
    assert warmup._thread is None


def test_a_failure_is_reported_as_a_sentence(qtbot, monkeypatch):
    def break_off() -> None:
        raise OSError("no room")

    monkeypatch.setattr(f"{KERNELS}.warm", break_off)
    warmup = Warmup()
    with qtbot.waitSignal(warmup.failed) as failed:
        warmup.start()
    warmup.stop()
    assert failed.args == ["The compiled kernels cannot be used: no room"]
