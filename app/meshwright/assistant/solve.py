"""One call that lets the agent improve the connectivity of a mesh: ``meshwright.solve``."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.assistant.torch_threads import one_thread
from meshwright.document.position_repair import settle
from meshwright.sources import resolve
from meshwright_core import HalfEdgeMesh, MeshError, Operation
from meshwright_core.arguments import whole_number
from meshwright_core.core.notebook_display import Bundle
from meshwright_core.core.score import normalised_return

if TYPE_CHECKING:
    from meshwright_agent.policy.policy_files import Policy

SECONDS = 10.0
"""Time limit of :func:`solve` where none is given."""


@dataclass(frozen=True, eq=False)
class SolvedMesh:
    """The result of :func:`solve`; shows itself as a picture in a notebook."""

    mesh: HalfEdgeMesh
    """The solved mesh, smoothed and untangled; not the source itself."""
    score_before: int
    """s, the sum of absolute irregularities (equation 1 of the paper), of the source."""
    score: int
    """s of the solved mesh."""
    optimum: int
    """s*, a lower bound on s that no operation changes (equation 3)."""
    operations: list[tuple[Operation, int]] = field(repr=False)
    """Operations and half-edges that lead from the source to the solved mesh, in this order."""
    seconds: float
    """Time that the search took."""
    policy: str
    """Name of the policy."""
    inverted: list[int]
    """Rows of ``mesh.elements()`` that smoothing and untangling have left inverted."""

    @property
    def at_optimum(self) -> bool:
        """Whether s = s*, which proves that no connectivity has a lower score."""
        return self.score == self.optimum

    @property
    def normalised_return(self) -> float:
        """(s before - s) / (s before - s*), equation 6: 1 at the optimum, 0 without progress."""
        return normalised_return(self.score_before, self.score, self.optimum)

    def _repr_mimebundle_(self, include: object = None, exclude: object = None) -> Bundle:
        data, metadata = self.mesh._repr_mimebundle_()
        return {**data, "text/plain": repr(self)}, metadata


def solve(
    mesh: Any,
    seconds: float = SECONDS,
    *,
    policy: str | os.PathLike[str] | Policy | None = None,
    seed: int = 0,
) -> SolvedMesh:
    """Search for the connectivity of a mesh with the lowest score s, and smooth the result.

    Rollouts of a trained policy and simulated annealing take turns; the operations found are then
    shortened. The search ends early, with a proof, at s = s*.

    Args:
        mesh: what :func:`meshwright.mesh` takes; a mesh or document is not changed. A shape is
            meshed with quads.
        seconds: time limit of the search, in seconds, above 0. Smoothing the result, and compiling
            kernels on first use, take additional time.
        policy: name of a shipped policy, a policy file, or a loaded policy; None for the one
            shipped for this kind of mesh.
        seed: at least 0. How far a search comes in a given time depends on the machine, too.

    Raises MeshError, one sentence, if the source is no mesh or has no elements, if the policy
    cannot be loaded or is for the other kind of mesh, or if an argument is out of range.
    """
    start = resolve.mesh(mesh)
    if start.n_elements == 0:
        raise MeshError("This mesh has no elements.")
    number = isinstance(seconds, int | float | np.number) and not isinstance(seconds, bool)
    if not number or not 0 < seconds < math.inf:
        raise MeshError(f"seconds is a number above 0, not {seconds!r}.")
    seed = whole_number(seed, 0, "seed")
    if seed >= 2**63:
        raise MeshError("seed must be below 2**63.")
    from meshwright_agent.policy import policy_files
    from meshwright_agent.search import solver

    try:
        chosen = policy_files.shipped(start.kind)[0] if policy is None else policy
        if not isinstance(chosen, policy_files.Policy | str | os.PathLike):
            raise MeshError(f"policy is a name, a file or a loaded policy, not {chosen!r}.")
        if not isinstance(chosen, policy_files.Policy):
            chosen = policy_files.load(chosen)
        policy_files.require_kind(chosen, start.kind)
    except policy_files.PolicyError as error:
        raise MeshError(f"{str(error).rstrip('.')}.") from None
    before = start.score
    with one_thread():
        found = solver.solve(start, chosen, seconds=float(seconds), seed=seed)
    inverted = [] if found.carry_out(start) else settle(start)
    return SolvedMesh(
        start, before, found.score, found.optimum, found.operations, found.seconds, chosen.name,
        inverted,
    )  # fmt: skip
