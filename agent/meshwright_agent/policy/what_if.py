"""A policy's probabilities at half-edges of one's choice, also where they are not its candidates.

For studying a policy; :mod:`meshwright_agent.policy.explanation` describes the decisions of an
episode. Nothing here changes the mesh.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright_agent.env.candidates import gather, masks
from meshwright_agent.env.local_patch import LARGEST, Patches
from meshwright_agent.env.task import Observation, Scratch, Task, choose_candidates, look
from meshwright_agent.policy.explanation import action_probabilities
from meshwright_agent.policy.policy_files import Policy, PolicyError, require_kind
from meshwright_core.core.arrays import ORIGIN, MeshArrays
from meshwright_core.mesh import HalfEdgeMesh


@dataclass(frozen=True, eq=False)
class Outlook:
    """A policy's decision among given half-edges."""

    halfedges: np.ndarray
    """(K,) int64: the candidates."""
    probabilities: np.ndarray
    """(K, A) float64: of each operation at each candidate. They sum to 1, or to 0 where no
    operation is permitted."""
    permitted: np.ndarray
    """(K, A) bool: the action mask; the others have probability 0."""
    changes: np.ndarray
    """(K, A) int64: the exact change of s of each permitted operation."""
    value: float
    """The predicted normalised return; NaN where no operation is permitted."""


def outlook(mesh: HalfEdgeMesh, policy: Policy, halfedges: np.ndarray) -> Outlook:
    """The policy's probabilities if these half-edges (K,) were its candidates.

    Raises PolicyError if the policy is for the other kind of mesh, or a half-edge does not exist.
    """
    task, arrays = policy.task, mesh.arrays
    _require(mesh, policy, halfedges)
    scratch = Scratch(task, len(arrays.edge), len(arrays.vertex))
    chosen = np.asarray(halfedges, np.int64).reshape(1, -1)
    shape = (1, chosen.shape[1], task.operations)
    mask, changes = np.zeros(shape, np.bool_), np.zeros(shape, np.int8)
    settings = (task.first_operation, task.operations, task.cap, *task.bounds(mesh.n_elements))
    some = masks(arrays, chosen[0], *settings, task.extended, mask[0], changes[0])
    if not some:
        nothing = np.zeros(shape[1:])
        return Outlook(chosen[0], nothing, mask[0], changes[0].astype(np.int64), float("nan"))
    sizes = np.zeros((1, task.blocks + 1), np.int32)
    features = np.zeros((LARGEST, task.channels), np.int8)
    look(
        arrays, chosen[0], task.k, sizes[0], scratch.listed, scratch.reads, scratch.slot_of,
        scratch.field, features,
    )  # fmt: skip
    patches = Patches(features[: sizes[0, 0]], scratch.reads[: sizes[0, 1]].copy(), sizes)
    state = np.array([[(mesh.score - mesh.optimum) / 10.0, 1.0, 1.0]], np.float32)
    probabilities, value = action_probabilities(
        policy.network, Observation(chosen, mask, changes, state, patches)
    )
    return Outlook(chosen[0], probabilities, mask[0], changes[0].astype(np.int64), value)


def template_slots(arrays: MeshArrays, task: Task, h: int) -> np.ndarray:
    """(N,) int64: the half-edge in each slot of the template of h, -1 beyond the boundary."""
    source, turn = task.template
    slots = np.full(len(source), -1, np.int64)
    gather(arrays, h, task.k, source, turn, slots)
    return slots


def candidates(mesh: HalfEdgeMesh, policy: Policy, h: int = -1, seed: int = 0) -> np.ndarray:
    """(K,) int64: the candidates of the policy's next decision, without the noise of the shortlist.

    With h, the template of h, or a shortlist whose last entry is replaced by h if h is not in it.
    seed: of the random choices that remain.
    """
    task, arrays = policy.task, mesh.arrays
    _require(mesh, policy, np.array([h] if h >= 0 else [], np.int64))
    if task.selection == "template" and h >= 0:
        slots = template_slots(arrays, task, h)
        real = slots[slots >= 0]
        return real[np.sort(np.unique(real, return_index=True)[1])]
    scratch = Scratch(task, len(arrays.edge), len(arrays.vertex))
    chosen = np.full(task.rows, -1, np.int64)
    source, turn = task.template
    choose_candidates(
        arrays, task.k, task.first_operation, task.operations, task.cap,
        *task.bounds(mesh.n_elements), task.extended, task.selection == "shortlist", 0.0,
        source, turn, np.random.default_rng(seed), scratch.found, scratch.keys, scratch.slots,
        chosen,
    )  # fmt: skip
    chosen = chosen[chosen >= 0]
    if h >= 0 and h not in chosen:
        chosen = np.append(chosen[: task.rows - 1], h)
    return chosen


def _require(mesh: HalfEdgeMesh, policy: Policy, halfedges: np.ndarray) -> None:
    require_kind(policy, mesh.kind)
    slots = mesh.k * len(mesh.arrays.element_mark)
    for h in np.asarray(halfedges).tolist():
        if not 0 <= h < slots or mesh.arrays.edge[h, ORIGIN] < 0:
            raise PolicyError(f"there is no half-edge {h} in this mesh")
