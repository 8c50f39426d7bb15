"""How much the search for blocks does in a CPU second: decisions, layouts, evaluated moves.

Random straight-sided parts as quads. Decisions are those of the policy in rollouts side by side;
layouts are what kicks of the best of what these reach lead to, coarsened; moves are the collapses
and clean-ups whose positions were found to judge them. Part i of a row depends on the seed and on i
alone.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import torch

from meshwright.benchmarks.parts import ROWS, aligned, quad_policy, shown
from meshwright.console import Update
from meshwright_agent.env.vector_env import Batch
from meshwright_agent.policy.inference import decide
from meshwright_agent.policy.policy_files import Policy
from meshwright_agent.search.layout_search import LayoutSearch, Preference
from meshwright_agent.search.search_worker import RolloutBatch, Worker
from meshwright_core.domains import meshing
from meshwright_core.domains.random_parts import parts
from meshwright_core.mesh import HalfEdgeMesh

SUMMARY = "decisions, layouts and evaluated moves of the search for blocks in a CPU second"
SECONDS = 3.0
"""Default time for the layouts of each part, in seconds."""
PARTS, QUICK = 10, 1
TOGETHER = 8
"""Rollouts side by side."""


def run(
    seed: int, quick: bool, update: Update, seconds: float = SECONDS, meshes: int = PARTS
) -> dict[str, Any]:
    """Measure on `meshes` parts of each row; quick: one part, a tenth of the time."""
    policy = quad_policy()
    found: dict[str, Any] = {}
    for low, high in ROWS:
        decided = [0, 0.0]
        searched = [0, 0, 0.0]
        for number, domain in enumerate(parts(QUICK if quick else meshes, (low, high), seed)):
            update(number, f"{low}-{high} corners: {number}")
            mesh = meshing.mesh_domain(domain, "quad")
            decided = _sum(decided, decisions(mesh, policy, seed))
            took = 0.1 * seconds if quick else seconds
            searched = _sum(searched, layouts(mesh, policy, took, seed))
        found[f"{low}-{high} corners"] = {
            "decisions / s": round(decided[0] / decided[1]),
            "layouts / s": round(searched[0] / searched[2]),
            "evaluated moves / s": round(searched[1] / searched[2]),
        }
    return found


def decisions(mesh: HalfEdgeMesh, policy: Policy, seed: int) -> list[float]:
    """The number of decisions in rollouts side by side from `mesh`, and their seconds."""
    batch = Batch(policy.task, [mesh], TOGETHER, np.random.default_rng(seed), endless=False)
    generator = torch.Generator().manual_seed(seed)
    count, began = 0, time.process_time()
    while batch.active.any():
        count += int(batch.active.sum())
        observation = batch.observe()
        batch.step(observation, decide(policy.network, observation, generator)[0])
    return [count, time.process_time() - began]


def layouts(mesh: HalfEdgeMesh, policy: Policy, seconds: float, seed: int) -> list[float]:
    """The numbers of layouts and of evaluated moves in about so many seconds, and the seconds."""
    rollouts = RolloutBatch(mesh, policy, None, mesh.score)
    Worker(rollouts, seed, lambda: False).roll(TOGETHER)
    best = min(rollouts.found, key=lambda candidate: candidate.score)
    seeker = LayoutSearch(mesh, Preference(), seed)
    began = time.process_time()

    def stop() -> bool:
        return time.process_time() - began > seconds

    seeker.add(best.operations, True, stop)
    while not stop():
        seeker.kick(stop)
    return [seeker.layouts, seeker.evaluated, time.process_time() - began]


def _sum(first: list[float], second: list[float]) -> list[float]:
    return [a + b for a, b in zip(first, second, strict=True)]


def text(results: dict[str, Any]) -> str:
    """The results as one table."""
    rows = [["parts", *next(iter(results.values()))]]
    return aligned(rows + [[name, *map(shown, row.values())] for name, row in results.items()])
