"""One call that lets the agent improve the connectivity of a mesh: ``meshwright.solve``."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.assistant.torch_threads import one_thread
from meshwright.sources import resolve
from meshwright_core import HalfEdgeMesh, MeshError, Operation
from meshwright_core.arguments import whole_number
from meshwright_core.core.notebook_display import Bundle
from meshwright_core.core.score import normalised_return
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.quality import inverted, scaled_jacobian
from meshwright_core.geometry.shape_bound import attainable_bound, shape_bound

if TYPE_CHECKING:
    from meshwright_agent.policy.policy_files import Policy

SECONDS = 10.0
"""Time limit of :func:`solve` where no limit is given."""


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
    """Operations and half-edges that lead from the source to the solved mesh, or to its blocks if
    they were divided after it, in this order; none where the blocks are new ones of the domain."""
    seconds: float
    """Time that the search took."""
    policy: str
    """Name of the policy."""
    inverted: list[int]
    """Rows of ``mesh.elements()`` that smoothing and untangling have left inverted."""
    worst_scaled_jacobian: float = 0.0
    """Smallest scaled Jacobian of an element."""
    worst_shape: float = 0.0
    """Smallest shape 2J/(a*a + b*b) of an element, which sees the ratio of its sides."""
    shape_bound: float = 1.0
    """q*, the bound on the worst scaled Jacobian by the corners of the domain."""
    attainable: float = 1.0
    """The same for meshes at s*."""
    sum_delta2: int = 0
    """Sum of the squared irregularities."""
    reason: str = ""
    """Why the search ended, or what stands in the way of the optimum."""

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
    seconds: float | None = None,
    *,
    rollouts: int | None = None,
    policy: str | os.PathLike[str] | Policy | None = None,
    seed: int = 0,
    prefer: str = "balanced",
    min_shape: float | None = None,
    elements_shape: float | None = None,
    keep_size: bool = False,
) -> SolvedMesh:
    """Search for the connectivity of a mesh with the lowest score s and good shapes.

    Rollouts of a trained policy and simulated annealing take turns; quad meshes become blocks: of
    the meshes of lowest s the one with a good worst shape, then few elements. The search ends
    early where nothing more can be won. A valid mesh never becomes an invalid one.

    Args:
        mesh: what :func:`meshwright.mesh` takes; a mesh or document is not changed. A shape is
            meshed with quads.
        seconds: time limit of the search, in seconds, above 0; 10 if no rollouts are given.
            Compiling kernels on first use takes additional time.
        rollouts: limit in rollouts; without seconds the answer then depends on the arguments alone.
        policy: name of a shipped policy, a policy file, or a loaded policy; None for the one
            shipped for this kind of mesh.
        seed: at least 0. How far a search comes in a given time depends on the machine, too.
        prefer: "blocks" for few, whatever their shape, "shape" for the best worst shape, or
            "balanced".
        min_shape: worst scaled Jacobian, 0 to 1, beyond which only the number of blocks counts.
        elements_shape: divide the blocks until every element has this shape, between 0 and 1.
        keep_size: keep the size of the elements instead (quads and triangles).

    Raises MeshError, one sentence, if the source is no mesh or has no elements, if the policy
    cannot be loaded or is for the other kind of mesh, or if an argument is out of range.
    """
    start = resolve.mesh(mesh)
    if start.n_elements == 0:
        raise MeshError("This mesh has no elements.")
    if rollouts is not None:
        rollouts = whole_number(rollouts, 1, "rollouts")
    limit = SECONDS if seconds is None and rollouts is None else seconds
    number = isinstance(limit, int | float | np.number) and not isinstance(limit, bool)
    if limit is not None and (not number or not 0 < limit < math.inf):
        raise MeshError(f"seconds is a number above 0, not {limit!r}.")
    seed = whole_number(seed, 0, "seed")
    if seed >= 2**63:
        raise MeshError("seed must be below 2**63.")
    from meshwright_agent.policy import policy_files
    from meshwright_agent.search import improvement

    try:
        wishes = improvement.Wishes(prefer, min_shape, elements_shape, keep_size)
    except (ValueError, TypeError) as error:
        raise MeshError(f"{error}.") from None
    if elements_shape is not None and start.kind == "tri":
        raise MeshError("Only quad meshes have blocks that can be divided for elements_shape.")
    try:
        chosen = policy_files.shipped(start.kind)[0] if policy is None else policy
        if not isinstance(chosen, policy_files.Policy | str | os.PathLike):
            raise MeshError(f"policy is a name, a file or a loaded policy, not {chosen!r}.")
        if not isinstance(chosen, policy_files.Policy):
            chosen = policy_files.load(chosen)
        policy_files.require_kind(chosen, start.kind)
    except policy_files.PolicyError as error:
        raise MeshError(f"{str(error).rstrip('.')}.") from None
    with one_thread():
        found = improvement.improve(
            start, chosen, wishes, rollouts=rollouts,
            seconds=None if limit is None else float(limit), seed=seed,
        )  # fmt: skip
    made = found.mesh
    bad = inverted(made)
    rows = {int(e): row for row, e in enumerate(made.element_ids())}
    return SolvedMesh(
        made, start.score, made.score, made.optimum, found.operations, found.seconds, chosen.name,
        [rows[int(e)] for e in bad], float(scaled_jacobian(made).min()),
        float(element_shapes(made).min()), shape_bound(made), attainable_bound(made),
        int((made.irregularity() ** 2).sum()), found.reason,
    )  # fmt: skip


def improve(mesh: Any, seconds: float | None = None, **wishes: Any) -> SolvedMesh:
    """:func:`solve` with `keep_size` by default: an improved mesh of elements of the same size.

    Takes the arguments of :func:`solve`.
    """
    return solve(mesh, seconds, **{"keep_size": wishes.get("elements_shape") is None, **wishes})
