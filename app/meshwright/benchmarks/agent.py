"""Speed of the agent: environment steps in a batch, and one decision of the policy by mesh size.

*Random steps* apply a random permitted operation, clean up, score, and start a run afresh where it
has ended: what an environment costs without a policy. *With observation* adds what a policy looks
at. The decisions are those of the shipped policies on grids a quarter of whose edges were flipped
at random.
"""

from __future__ import annotations

import statistics
import time
from typing import Any

import numpy as np

from meshwright.benchmarks.core import apply_all
from meshwright.console import Update
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import JOURNALLING
from meshwright_core.domains.meshing import grid
from meshwright_core.operations import catalogue

SUMMARY = "environment steps per second, and the time of one decision by mesh size"

SIZES = (1_000, 10_000, 100_000, 1_000_000)


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Measure both kinds."""
    found: dict[str, Any] = {}
    for kind in ("tri", "quad"):
        update(0, f"{kind}: environment steps")
        found[f"{kind} environment"] = environment(kind, seed, quick)
        sizes = SIZES[:2] if quick else SIZES
        times = {}
        for size in sizes:
            update(0, f"{kind}: decisions at {size:,} elements")
            times[f"{size} elements, ms"] = 1e3 * decision(kind, size, seed, 20 if quick else 200)
        times["largest / smallest"] = times[f"{sizes[-1]} elements, ms"] / next(
            iter(times.values())
        )
        found[f"{kind} decision"] = times
    return found


def environment(kind: str, seed: int, quick: bool) -> dict[str, float]:
    """Return steps per second of 256 runs on polygons of 10 to 30 sides."""
    from meshwright_agent.env.task import Task
    from meshwright_agent.env.vector_env import Batch, start_meshes

    rng = np.random.default_rng(seed)
    task = Task(kind, extended=True)
    batch = Batch(task, start_meshes(kind, (10, 30), 200, rng), 256, rng)
    batch.play_at_random(1)
    rounds = []
    for _ in range(1 if quick else 5):
        start = time.perf_counter()
        steps = batch.play_at_random(20 if quick else 400)
        rounds.append(steps / (time.perf_counter() - start))
    batch.observe()
    start = time.perf_counter()
    for _ in range(3):
        batch.observe()
    looked = 3 * 256 / (time.perf_counter() - start)
    steps_per_second = statistics.median(rounds)
    return {
        "random steps per second": steps_per_second,
        "with observation": 1.0 / (1.0 / steps_per_second + 1.0 / looked),
    }


def decision(kind: str, size: int, seed: int, count: int) -> float:
    """Return the median seconds of one decision, operation and clean-ups included."""
    from meshwright_agent.policy.policy_files import decide_on_one_thread, load, shipped
    from meshwright_agent.policy.rollout import Runner

    decide_on_one_thread()
    runner = Runner(disturbed(kind, size, seed), load(shipped(kind)[0]), seed, max_steps=10**9)
    seconds = []
    for _ in range(count + 10):
        start = time.perf_counter()
        runner.step()
        seconds.append(time.perf_counter() - start)
    return statistics.median(seconds[10:])


def disturbed(kind: str, size: int, seed: int) -> HalfEdgeMesh:
    """Return a grid of about so many elements, as irregular everywhere whatever its size."""
    mesh = grid(kind, size)
    rng = np.random.default_rng(seed)
    flips = [catalogue.TRI_FLIP] if kind == "tri" else [catalogue.FLIP_LEFT, catalogue.FLIP_RIGHT]
    count = mesh.n_elements // 4
    mesh.arrays.counters[JOURNALLING] = 0
    halfedges = rng.integers(0, mesh.k * mesh.n_elements, count)
    apply_all(mesh.arrays, rng.choice(flips, count), halfedges, 0)
    mesh.arrays.counters[JOURNALLING] = 1
    return mesh
