"""Ctrl-C while machine code is linked: delivered afterwards, with whole code."""

import signal
import threading

import pytest

from meshwright_core.core.compilation import kernel
from meshwright_core.core.interrupts import interrupts_held
from meshwright_core.core.linking import EntryPoint


@kernel
def doubled(x):
    return 2 * x


def test_an_interrupt_is_delivered_when_the_block_has_ended():
    before, reached = signal.getsignal(signal.SIGINT), []
    with pytest.raises(KeyboardInterrupt), interrupts_held():  # noqa: PT012
        signal.raise_signal(signal.SIGINT)
        reached.append("end")
    assert reached == ["end"]
    assert signal.getsignal(signal.SIGINT) is before


def test_nothing_is_held_outside_the_main_thread_and_without_a_handler():
    seen = []

    def note() -> None:
        with interrupts_held():
            seen.append(signal.getsignal(signal.SIGINT))

    before = signal.getsignal(signal.SIGINT)
    thread = threading.Thread(target=note)
    thread.start()
    thread.join()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        note()
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen == [before, signal.SIG_IGN]


def test_code_that_ctrl_c_meets_while_it_is_linked_is_whole(monkeypatch):
    linked = []

    def finalize(self: EntryPoint) -> None:
        if not linked:
            signal.raise_signal(signal.SIGINT)
        linked.append(self.name)
        original(self)

    original = EntryPoint._finalize_final_module
    monkeypatch.setattr(EntryPoint, "_finalize_final_module", finalize)
    with pytest.raises(KeyboardInterrupt):
        doubled(2)
    assert len(linked) == 1
    assert doubled(3) == 6
