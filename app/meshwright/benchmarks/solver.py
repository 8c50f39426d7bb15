"""The anytime solver against annealing alone: how good each is after how many seconds of one core.

Both have the same action set and the same bounds of the number of elements. Seconds are those of
the processor, so that a busy machine does not blur them; each mesh is given the longest time once,
and what either had reached earlier is read off on the way.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from statistics import fmean
from typing import Any

import numpy as np

from meshwright.console import Update
from meshwright_agent.env.vector_env import start_meshes
from meshwright_agent.policy.policy_files import Policy, decide_on_one_thread, load, shipped
from meshwright_agent.search.annealing import SLICE, Annealer
from meshwright_agent.search.solver import prepare, solve
from meshwright_core import HalfEdgeMesh

SUMMARY = "share of meshes at s* after 0.3 to 10 s of one core: the solver, and annealing alone"

ROWS = ((10, 20), (20, 30), (30, 50))
"""Sides of the polygons."""
SECONDS = (0.3, 1.0, 3.0, 10.0)
MESHES = 20
QUICK = (2, (0.1, 0.3))

Found = list[tuple[float, int]]
"""Seconds and s whenever s fell."""


def run(
    seed: int,
    quick: bool,
    update: Update,
    meshes: int = MESHES,
    seconds: tuple[float, ...] = SECONDS,
    rows: tuple[tuple[int, int], ...] = ROWS,
    kinds: tuple[str, ...] = ("quad", "tri"),
) -> dict[str, Any]:
    """Measure all rows of both kinds (quick: two meshes, 0.3 s)."""
    if quick:
        meshes, seconds = QUICK
    decide_on_one_thread()
    found: dict[str, Any] = {}
    for kind in kinds:
        policy = load(shipped(kind)[0])
        prepare(policy)
        for row in rows:
            drawn = start_meshes(kind, row, meshes, np.random.default_rng([seed, 2]))
            useful = [mesh for mesh in drawn if mesh.score > mesh.optimum]
            traces: dict[str, list[Found]] = {"solver": [], "annealing": []}
            for number, mesh in enumerate(useful):
                update(number, f"{kind} {row[0]}-{row[1]}")
                traces["solver"].append(solved(mesh, policy, seconds[-1], seed + number))
                traces["annealing"].append(annealed(mesh, policy, seconds[-1], seed + number))
            found[f"{kind} {row[0]}-{row[1]}"] = {
                method: {f"{t:g} s": shares(useful, given, t) for t in seconds}
                for method, given in traces.items()
            }
    return found


def shares(meshes: list[HalfEdgeMesh], traces: list[Found], seconds: float) -> dict[str, float]:
    """Return the share at s* and the mean normalised return after so many seconds."""
    at_optimum, returns = [], []
    for mesh, trace in zip(meshes, traces, strict=True):
        best = min((s for when, s in trace if when <= seconds), default=mesh.score)
        at_optimum.append(best == mesh.optimum)
        returns.append((mesh.score - best) / (mesh.score - mesh.optimum))
    return {"at s*": fmean(at_optimum), "return": fmean(returns)}


def solved(mesh: HalfEdgeMesh, policy: Policy, seconds: float, seed: int) -> Found:
    """Return when the solver's best s fell, and to what."""
    elapsed, trace = _clock(), Found()

    def on_progress(done: int, best: int) -> None:
        if not trace or best < trace[-1][1]:
            trace.append((elapsed(), best))

    def enough() -> bool:
        return elapsed() > seconds or bool(trace and trace[-1][1] == mesh.optimum)

    # time is kept by `enough`, since the solver itself goes by the clock on the wall
    solve(
        mesh, policy, seconds=1e6, seed=seed, coarsen=False, shorten=False, progress=on_progress,
        cancelled=enough,
    )  # fmt: skip
    return trace


def annealed(mesh: HalfEdgeMesh, policy: Policy, seconds: float, seed: int) -> Found:
    """Return when the best s of annealing from the start fell, and to what."""
    elapsed, trace = _clock(), Found()
    floor, ceiling = policy.task.bounds(mesh.n_elements)
    annealer = Annealer(
        mesh, seed, extended=policy.task.extended, floor=floor, ceiling=ceiling
    )  # fmt: skip
    best = mesh.score
    while elapsed() < seconds and not annealer.finished:
        annealer.run(SLICE)
        if annealer.best_score < best:
            best = annealer.best_score
            trace.append((elapsed(), best))
    return trace


def _clock() -> Callable[[], float]:
    began = time.process_time()
    return lambda: time.process_time() - began
