"""Searches for the block decomposition that a structured grid is made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from meshwright.assistant.torch_threads import one_thread
from meshwright.document.position_repair import settle, square_up

if TYPE_CHECKING:
    from meshwright_agent.policy.policy_files import Policy
    from meshwright_core import HalfEdgeMesh

PREFERENCES = ("blocks", "balanced", "shape")


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
    """A quad mesh of few blocks at a low s, smoothed; `mesh` is not changed."""
    from meshwright_agent.search import solver

    with one_thread():
        found = solver.solve(
            mesh, policy, seconds=search.seconds, seed=search.seed, prefer=search.prefer,
            min_shape=search.min_shape, progress=progress,
        )  # fmt: skip
    result = mesh.copy()
    if not found.carry_out(result):
        settle(result)
    square_up(result)
    return result
