"""Getting the kernels ready behind the window, and a window that is closed before they are."""

from meshwright.desktop.application.kernel_warmup import Warmup


def test_what_was_loaded_when_the_window_closed_is_told_to_nobody(qtbot, monkeypatch):
    monkeypatch.setattr(
        "meshwright.desktop.application.kernel_warmup.compilation.is_warm_on_disk", lambda: True
    )
    monkeypatch.setattr(
        "meshwright.desktop.application.kernel_warmup.compilation.warm", lambda: None
    )
    warmup, told = Warmup(), []
    warmup.ready.connect(lambda: told.append("ready"))
    warmup.start()
    warmup.stop()  # the thread has ended, and its report waits in the queue
    qtbot.wait(20)
    assert told == []
    assert not warmup.done


def test_a_window_that_has_closed_starts_nothing(qtbot, monkeypatch):
    monkeypatch.setattr(
        "meshwright.desktop.application.kernel_warmup.compilation.is_warm_on_disk", lambda: True
    )
    warmup = Warmup()
    warmup.stop()
    warmup.start()
    assert warmup._thread is None


def test_failure_is_told_in_a_sentence(qtbot, monkeypatch):
    def break_off() -> None:
        raise OSError("no room")

    monkeypatch.setattr(
        "meshwright.desktop.application.kernel_warmup.compilation.is_warm_on_disk", lambda: True
    )
    monkeypatch.setattr("meshwright.desktop.application.kernel_warmup.compilation.warm", break_off)
    warmup = Warmup()
    with qtbot.waitSignal(warmup.failed) as failed:
        warmup.start()
    warmup.stop()
    assert failed.args == ["The compiled kernels cannot be used: no room"]
