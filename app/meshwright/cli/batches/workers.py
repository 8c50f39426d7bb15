"""Worker processes that survive the end of any of them: its part is given to a new one."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from queue import Queue
from typing import Any

TRIES = 3
"""How often a part is given to a worker before its process's end counts as its result."""

Task = tuple[str, Sequence[str]]
"""A key and the words of a command."""


def run_on_workers(
    tasks: Sequence[Task], jobs: int, started: Callable[[int], None] | None = None
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield (key, record) of each task as soon as it is there, in any order.

    Args:
        tasks: what to do.
        jobs: the number of processes, at least 1.
        started: called with the process id of each worker that is started.
    """
    waiting = deque((key, words, 1) for key, words in tasks)
    results: Queue[tuple[str, dict[str, Any]]] = Queue()
    lock, stop = threading.Lock(), threading.Event()

    def serve() -> None:
        worker: subprocess.Popen[str] | None = None
        while not stop.is_set():
            with lock:
                if not waiting:
                    break
                key, words, attempt = waiting.popleft()
            if worker is None:
                worker = _start()
                if started is not None:
                    started(worker.pid)
            record = _ask(worker, words)
            if record is None:
                _end(worker)
                worker = None
                if attempt < TRIES:
                    with lock:
                        waiting.append((key, words, attempt + 1))
                    continue
                record = {"status": "failed", "error": f"its process ended {TRIES} times"}
            results.put((key, record))
        if worker is not None:
            _end(worker)

    threads = [threading.Thread(target=serve, daemon=True) for _ in range(min(jobs, len(tasks)))]
    for thread in threads:
        thread.start()
    try:
        for _ in tasks:
            yield results.get()
    finally:
        stop.set()
        for thread in threads:
            thread.join(timeout=60.0)


def _start() -> subprocess.Popen[str]:
    # one thread each: the processes share the cores
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, "-m", "meshwright.cli.batches.one_part"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        env=environment,
    )  # fmt: skip


def _ask(worker: subprocess.Popen[str], words: Sequence[str]) -> dict[str, Any] | None:
    """The record of a task; None if the process has ended."""
    assert worker.stdin is not None
    assert worker.stdout is not None
    try:
        worker.stdin.write(json.dumps(list(words)) + "\n")
        worker.stdin.flush()
        line = worker.stdout.readline()
        record: dict[str, Any] = json.loads(line)
    except (OSError, ValueError):
        return None
    return record


def _end(worker: subprocess.Popen[str]) -> None:
    assert worker.stdin is not None
    assert worker.stdout is not None
    with suppress(OSError):
        worker.stdin.close()
    try:
        worker.wait(timeout=5.0)
    except subprocess.TimeoutExpired:
        worker.kill()
        worker.wait()
    worker.stdout.close()
