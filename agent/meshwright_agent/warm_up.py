"""Compiles the kernels that runs, searches and fine grids of blocks need, or loads them from the
cache on disk.

`python -m meshwright_agent.warm_up` does so in a process of its own. The kernels are divided into
two sets with little in common, and a second process compiles one of them. Heavy modules are
imported inside functions, because the window calls :func:`is_warm_on_disk` when it starts.
"""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from meshwright_core.core.compilation import cache_folder, entry_points_on_disk

ENTRY_POINTS = 76
"""Kernels of both packages that :func:`warm` stores on disk, for progress messages; tested."""

_MARK = "warm"
_REPORT_SECONDS = 0.5
_CHANGING = "changing"
"""The argument with which this module compiles the second share only."""

ProgressCallback = Callable[[int, int], None]
"""Called as ``report(done, total)`` with numbers of entry points."""


def is_warm_on_disk() -> bool:
    """Whether :func:`warm` has run to its end for these very sources on this machine."""
    return (cache_folder("meshwright_agent") / _MARK).exists()


def progress() -> tuple[int, int]:
    """How many entry points are on disk, and how many there will be."""
    done = entry_points_on_disk("meshwright_agent") + entry_points_on_disk()
    return min(done, ENTRY_POINTS), ENTRY_POINTS


def warm(report: ProgressCallback | None = None) -> None:
    """Compile, or load from the cache, what runs and searches need, for both kinds of mesh, and
    fine grids.

    ``report(done, total)`` is called from another thread now and then while kernels are compiled.
    """
    from meshwright_core.warm_up import exercise_grids

    if not is_warm_on_disk():
        with _reporting(report), _second_process():
            _exercise_observing()
            exercise_grids()
    _exercise_observing()
    _exercise_changing()
    exercise_grids()
    try:
        cache_folder("meshwright_agent").mkdir(parents=True, exist_ok=True)
        (cache_folder("meshwright_agent") / _MARK).touch()
    except OSError:
        return  # a read-only home: each process compiles for itself


def _exercise_observing() -> None:
    """Observe meshes, decide, explain a decision, and smooth a mesh."""
    import numpy as np

    from meshwright_agent.env.local_patch import assemble
    from meshwright_agent.env.vector_env import Batch
    from meshwright_agent.policy.explanation import template_of
    from meshwright_agent.policy.policy_files import load, shipped
    from meshwright_core.domains.meshing import benchmark_mesh
    from meshwright_core.geometry import smoothing

    for kind in ("quad", "tri"):
        task = load(shipped(kind)[0]).task
        mesh = benchmark_mesh(kind, 8, np.random.default_rng(0))
        observation = Batch(task, [mesh], 1, np.random.default_rng(0)).observe()
        assemble(observation.patches, np.array([0]))
        template_of(mesh.arrays, task, 0)
        smoothing.relax(mesh)


def _exercise_changing() -> None:
    """Change meshes: annealing, shortening, coarsening, the step of a policy, patches of a mesh."""
    import numpy as np

    from meshwright_agent.policy.policy_files import load, shipped
    from meshwright_agent.search.annealing import Annealer
    from meshwright_agent.search.patchwise import improve_large
    from meshwright_agent.search.region_search import solve_within
    from meshwright_agent.search.solver import prepare
    from meshwright_core.core.arrays import allocate
    from meshwright_core.curves.curve import Curve
    from meshwright_core.domains.meshing import benchmark_mesh
    from meshwright_core.operations.catalogue import provide_rewrite

    provide_rewrite(allocate(4, 4, 1))  # first, while the other process compiles the checks
    for kind in ("quad", "tri"):
        policy = load(shipped(kind)[0])
        prepare(policy)
        mesh = benchmark_mesh(kind, 24, np.random.default_rng(0))
        Annealer(mesh, 0).restart()
        solve_within(mesh, policy, mesh.element_ids()[:20], rollouts=1)
        improve_large(mesh, policy, max_steps=40)
        mesh.set_locked(int(mesh.vertices()[0]))
    Curve.arc((0.0, 0.0), 1.0, 0.0, 1.0).project(np.array([[1.0, 1.0]]))


@contextmanager
def _second_process() -> Iterator[None]:
    """Compile the second share in another process, if there is a core for it; wait for it at the
    end of the block. That process ends when this one does.
    """
    if (os.cpu_count() or 1) < 2:
        yield
        return
    process = subprocess.Popen(
        [sys.executable, "-m", "meshwright_agent.warm_up", _CHANGING],
        stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        yield
        process.wait()
    finally:
        process.kill()
        process.wait()
        assert process.stdin is not None
        process.stdin.close()


@contextmanager
def _reporting(report: ProgressCallback | None) -> Iterator[None]:
    """Call ``report`` with :func:`progress` each time it has changed during the block."""
    if report is None:
        yield
        return
    ended = threading.Event()

    def watch() -> None:
        last = -1
        while not ended.wait(_REPORT_SECONDS):
            done, total = progress()
            if done != last:
                last = done
                report(done, total)

    thread = threading.Thread(target=watch, name="progress of the kernels", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def _end_with_parent() -> None:
    """Leave when the other end of stdin is closed, as it is when the parent process has ended."""

    def wait() -> None:
        sys.stdin.buffer.read()
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()


def main(arguments: list[str]) -> None:
    """Compile everything, or the second share for another process that does so."""
    from meshwright_agent.policy.policy_files import decide_on_one_thread

    decide_on_one_thread()
    if arguments == [_CHANGING]:
        _end_with_parent()
        _exercise_changing()
    else:
        warm()


if __name__ == "__main__":
    main(sys.argv[1:])
