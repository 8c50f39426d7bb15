"""Calls into the document's thread: order, exceptions, with and without an event loop."""

import asyncio
import threading
import time

import pytest

from meshwright.notebook import thread_loop as loops
from meshwright.notebook.thread_loop import ThreadLoop


def in_thread(work) -> None:
    thread = threading.Thread(target=work)
    thread.start()
    thread.join(10)
    assert not thread.is_alive()


def test_without_an_event_loop_the_queue_waits_for_a_pump():
    loop, seen = ThreadLoop(), []
    assert loop.here and not loop.running
    in_thread(lambda: [loop(lambda i=i: seen.append(i)) for i in range(100)])
    assert seen == []
    assert loop.pump(lambda: len(seen) == 100, timeout=5)
    assert seen == list(range(100))


def test_an_event_loop_runs_the_queue_unless_a_pump_is_earlier():
    seen = []

    async def cell() -> None:
        loop = ThreadLoop()
        assert loop.running
        in_thread(lambda: [loop(lambda i=i: seen.append(i)) for i in range(10)])
        assert loop.pump(lambda: len(seen) >= 5)  # the event loop is blocked meanwhile
        assert seen == list(range(5))
        await asyncio.sleep(0.05)
        assert seen == list(range(10))

    asyncio.run(cell())


def test_queued_calls_survive_the_end_of_an_event_loop():
    seen, kept = [], []

    async def cell() -> None:
        kept.append(ThreadLoop())

    async def later() -> None:
        assert kept[0].running
        await asyncio.sleep(0.02)

    asyncio.run(cell())
    kept[0](lambda: seen.append(1))
    assert not kept[0].running and seen == []
    asyncio.run(later())
    assert seen == [1]


def test_another_thread_replaces_an_owner_that_has_ended():
    made, seen = [], []
    in_thread(lambda: made.append(ThreadLoop()))
    made[0](lambda: seen.append(1))
    assert made[0].here
    made[0].drain()
    assert seen == [1]


def test_another_thread_gets_the_result_or_the_exception():
    loop, got = ThreadLoop(), []

    def ask() -> None:
        got.append(loop.do(threading.get_ident))
        with pytest.raises(ValueError, match="mine"):
            loop.do(lambda: (_ for _ in ()).throw(ValueError("mine")))
        got.append("end")

    thread = threading.Thread(target=ask)
    thread.start()
    assert loop.pump(lambda: len(got) == 2, timeout=5)
    thread.join(5)
    assert got == [threading.get_ident(), "end"]


def test_calls_from_another_thread_time_out(monkeypatch):
    monkeypatch.setattr(loops, "TIMEOUT", 0.05)
    loop, done = ThreadLoop(), []

    def ask() -> None:
        with pytest.raises(TimeoutError, match="busy"):
            loop.do(lambda: done.append(1))

    in_thread(ask)
    loop.drain()
    assert done == []  # what was given up is not done later


def test_a_pump_times_out_and_only_waits_in_other_threads():
    loop, seen, waited = ThreadLoop(), [], []
    begun = time.monotonic()
    assert not loop.pump(lambda: False, timeout=0.1)
    assert 0.09 < time.monotonic() - begun < 2
    loop(lambda: seen.append(threading.get_ident()))
    in_thread(lambda: waited.append(loop.pump(lambda: bool(seen), timeout=0.1)))
    assert waited == [False] and seen == []
    thread = threading.Thread(target=lambda: waited.append(loop.pump(lambda: bool(seen), 5)))
    thread.start()
    loop.drain()
    thread.join(5)
    assert waited == [False, True] and seen == [threading.get_ident()]


def test_an_exception_in_a_call_is_reported_and_the_next_call_runs(caplog):
    errors, seen = [], []
    loop = ThreadLoop(errors.append)
    loop(lambda: 1 / 0)
    loop(lambda: seen.append(1))
    loop.drain()
    assert [type(error) for error in errors] == [ZeroDivisionError] and seen == [1]
    assert "ZeroDivisionError" in caplog.text
