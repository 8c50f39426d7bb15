"""Meshes of any size: how long a repair takes, and what share of the irregular vertices it removes.

Quads: a random polygon, cut into quads and refined by Catmull-Clark splits; triangles: a grid. Each
is scrambled by one random valid operation for every five elements: flips, splits and collapses in
equal parts, anywhere on the mesh. Global splits are not among them, since each would cut a whole
row of quads: 200,000 of them would multiply a million elements by hundreds. Then the shipped policy
repairs it (:func:`meshwright_agent.search.patchwise.improve_large`). *Growth* compares the time per
element with that of
the smallest mesh; processor time is used, because other programs may be running.

Polygons of 200 and 400 sides, in quads as in the benchmark, are played as a whole, in single
rollouts.
"""

from __future__ import annotations

import statistics
import time
from typing import Any

import numpy as np

from meshwright.benchmarks.core import apply_all
from meshwright.console import Update
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import ELEMENT_SLOTS, JOURNALLING
from meshwright_core.domains import meshing
from meshwright_core.domains.elements import quadrangulation
from meshwright_core.operations import catalogue

SUMMARY = "repair of scrambled meshes of up to a million elements, and polygons of many sides"

REFINED = ((15, 4), (35, 5), (23, 7))
"""Sides of the polygon and levels of refinement: 9,984, 101,376 and 1,032,192 quads."""
TRIANGLES = (10_000, 100_000)
SMALL = ((9, 2), (9, 3))
"""The same for a quick run: 336 and 1,344 quads."""
POLYGONS = (200, 400)
LOCAL = {"tri": catalogue.CODES[3].values(), "quad": tuple(catalogue.CODES[4].values())[:4]}


def run(seed: int, quick: bool, update: Update) -> dict[str, Any]:
    """Measure everything; ``quick`` uses small meshes only."""
    from meshwright_agent.policy.policy_files import decide_on_one_thread

    decide_on_one_thread()
    found: dict[str, Any] = {}
    by_size([refined(*SMALL[0], seed)], seed, update)  # compiles what is measured below
    quads = [refined(sides, levels, seed) for sides, levels in (SMALL if quick else REFINED)]
    found["quads"] = by_size(quads, seed, update)
    if not quick:
        found["triangles"] = by_size(
            [meshing.grid("tri", size) for size in TRIANGLES], seed, update
        )
    for sides in (SMALL[0][0],) if quick else POLYGONS:
        update(0, f"polygons of {sides} sides")
        found[f"polygons of {sides} sides"] = polygons(sides, seed, 1 if quick else 10)
    return found


def refined(sides: int, levels: int, seed: int) -> HalfEdgeMesh:
    """Return a random polygon in 3 (sides - 2) 4^levels quads."""
    rng = np.random.default_rng(seed)
    points, quads, geometric = meshing.benchmark_arrays("quad", sides, rng)
    for _ in range(levels):
        points, quads, geometric = quadrangulation.catmull_clark(points, [quads], geometric)
    return HalfEdgeMesh.from_elements(points, quads, geometric)


def scramble(mesh: HalfEdgeMesh, count: int, rng: np.random.Generator) -> None:
    """Apply so many random valid local operations, without history."""
    codes = np.array(list(LOCAL[mesh.kind]))
    mesh.reserve(2 * count, 2 * count)
    mesh.arrays.counters[JOURNALLING] = 0
    while count > 0:
        slots = int(mesh.arrays.counters[ELEMENT_SLOTS])
        halfedges = rng.integers(0, mesh.k * slots, count)
        count -= apply_all(mesh.arrays, rng.choice(codes, count), halfedges, 0)[1]
    mesh.arrays.counters[JOURNALLING] = 1


def by_size(meshes: list[HalfEdgeMesh], seed: int, update: Update) -> dict[str, Any]:
    """Scramble and repair each; returns the numbers by size."""
    rows: dict[str, Any] = {}
    per_element: list[float] = []
    for mesh in meshes:
        size = mesh.n_elements
        update(0, f"{size:,} {mesh.kind} elements")
        scramble(mesh, size // 5, np.random.default_rng(seed))
        row = repaired(mesh, seed, update)
        per_element.append(row["processor seconds"] / size)
        row["growth of time over growth of size"] = per_element[-1] / per_element[0]
        rows[f"{size} elements"] = row
    return rows


def repaired(mesh: HalfEdgeMesh, seed: int, update: Update) -> dict[str, float]:
    """Repair the mesh with the policy that is shipped for it; returns the numbers."""
    from meshwright_agent.policy.policy_files import load, shipped
    from meshwright_agent.search.patchwise import improve_large

    policy = load(shipped(mesh.kind)[0])
    began, processor = time.perf_counter(), time.process_time()
    done = improve_large(
        mesh, policy, seed=seed, progress=lambda count, s: update(count, f"s {s:,}")
    )
    seconds, processor = time.perf_counter() - began, time.process_time() - processor
    return {
        "s before": mesh.score,
        "s after": done.score,
        "s*": done.optimum,
        "irregular before": done.start_irregular,
        "irregular after": done.irregular,
        "share removed": done.removed,
        "elements after": done.mesh.n_elements,
        "operations kept": len(done.operations),
        "of these by descent": done.descent,
        "decisions": done.decisions,
        "seconds": seconds,
        "processor seconds": processor,
        "decisions per processor second": done.decisions / processor,
        "operations kept per processor second": len(done.operations) / processor,
        "processor seconds per million elements": 1e6 * processor / mesh.n_elements,
    }


def polygons(sides: int, seed: int, count: int) -> dict[str, float]:
    """Play single rollouts of the shipped policy on so many polygons, to their best states."""
    from meshwright_agent.policy.policy_files import load, shipped
    from meshwright_agent.policy.rollout import Runner

    policy = load(shipped("quad")[0])
    returns: list[float] = []
    steps, processor = 0, time.process_time()
    for i in range(count):
        mesh = meshing.benchmark_mesh("quad", sides, np.random.default_rng([seed, sides, i]))
        runner = Runner(mesh, policy, seed + i)
        while runner.step():
            steps += 1
        returns.append((mesh.score - runner.best_score) / (mesh.score - mesh.optimum))
    return {
        "meshes": count,
        "normalised return, mean": statistics.mean(returns),
        "normalised return, lowest": min(returns),
        "decisions per processor second": steps / (time.process_time() - processor),
    }
