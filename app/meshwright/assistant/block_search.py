"""Searches for the block decomposition that a structured grid is made of."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from meshwright.assistant.torch_threads import one_thread
from meshwright.document.position_repair import settle, square_up

if TYPE_CHECKING:
    from meshwright_agent.policy.policy_files import Policy
    from meshwright_agent.search.solution import Solution
    from meshwright_core import HalfEdgeMesh

PREFERENCES = ("blocks", "balanced", "shape")

PRICE = 2.0
"""Of a better worst corner: a block of a structured grid is one more that a person has to set up,
so each tenth of the bound is worth 1.2 times as many only."""
FEW = 0.15
"""Share of the time of a balanced search that goes into one for few blocks, at least."""
RUNS = 12
"""The most of these, if they end early: there are many layouts of few blocks, and their shape is a
matter of chance."""


@dataclass(frozen=True)
class BlockSearch:
    """How to search."""

    seconds: float
    """Above 0."""
    prefer: str = "balanced"
    """"blocks", "balanced" or "shape", as :func:`meshwright_agent.search.solver.solve` has it."""
    min_shape: float | None = None
    """Worst scaled Jacobian beyond which only the number of blocks counts."""
    seed: int = 0


def decomposed(
    mesh: HalfEdgeMesh,
    policy: Policy,
    search: BlockSearch,
    progress: Callable[[int, int], None] | None = None,
) -> HalfEdgeMesh:
    """A quad mesh of few blocks at a low s, smoothed; `mesh` is not changed.

    The measure of the search counts long thin elements as bad ones. Blocks may be long, as they are
    divided into cells, so a balanced search is followed by some for few blocks, and the answer is
    :func:`better_blocks` of all.
    """
    from meshwright_agent.search import solver

    began = time.perf_counter()
    twice = search.prefer == "balanced" and search.min_shape is None
    with one_thread():
        found = solver.solve(
            mesh, policy, seconds=search.seconds * (1.0 - FEW if twice else 1.0), seed=search.seed,
            prefer=search.prefer, min_shape=search.min_shape, price=PRICE, progress=progress,
        )  # fmt: skip
        for i in range(RUNS if twice else 0):
            left = began + search.seconds - time.perf_counter()
            if i and left <= 0.0:
                break
            few = solver.solve(
                mesh, policy, seconds=max(left, FEW * search.seconds), seed=search.seed + i,
                prefer="blocks",
            )  # fmt: skip
            found = better_blocks(found, few)
    result = mesh.copy()
    if not found.carry_out(result):
        settle(result)
    square_up(result)
    return result


def better_blocks(first: Solution, second: Solution) -> Solution:
    """The better one of two answers by the aims of the first, with the scaled Jacobian as the only
    measure: how long and thin elements are does not count.
    """
    return min(first, second, key=lambda one: replace(one, worst_shape=1.0, aims=first.aims).rank)
