"""What a decision of a policy rests on: its probabilities, template and field of view in one state.

:func:`insight` describes the next decision of an episode, :func:`hints` lists the operations that
the policy prefers on a mesh. Neither changes the mesh.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import torch

from meshwright_agent.env.candidates import LOOKED_AT
from meshwright_agent.env.task import Observation, Scratch, Task, observe
from meshwright_agent.policy.explanation_types import Insight, PolicyAction
from meshwright_agent.policy.inference import tensors
from meshwright_agent.policy.network import PolicyNetwork
from meshwright_agent.policy.policy_files import Policy, require_kind
from meshwright_core.core.arrays import IRREGULAR, ORIGIN, TWIN, MeshArrays, preceding
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES, Operation

HINTS = 5
"""Default number of hints."""
WEIGHED = 128
"""Candidates that hints are chosen among: more than in a decision, and selected without noise."""
_FAINT = 5e-4  # operations less likely than this are left out


@torch.no_grad()
def action_probabilities(network: PolicyNetwork, seen: Observation) -> tuple[np.ndarray, float]:
    """Probabilities (K, A) float64 of all actions of one decision, and the predicted value."""
    logits, values = network(*tensors(seen))
    spread = torch.softmax(logits[0].double(), dim=0).numpy()
    mask = seen.mask[0]
    return np.where(mask, spread.reshape(mask.shape), 0.0), float(values[0])


def insight(arrays: MeshArrays, policy: Policy, seen: Observation, action: int) -> Insight:
    """The basis of one decision: `seen` is the observation (B = 1), `action` what was sampled."""
    task = policy.task
    probabilities, value = action_probabilities(policy.network, seen)
    row, column = divmod(action, task.operations)
    h = int(seen.chosen[0, row])
    real = seen.chosen[0] >= 0
    template, missing = template_of(arrays, task, h)
    return Insight(
        choices=_merged(arrays, task, seen, probabilities),
        wanted=PolicyAction(
            NAMES[task.first_operation + column],
            h,
            float(probabilities[row, column]),
            int(seen.changes[0, row, column]),
        ),
        halfedges=seen.chosen[0][real].copy(),
        weights=probabilities.sum(axis=1)[real],
        template=template,
        missing=missing,
        field=field_of_view(arrays, task.k, task.blocks, h),
        value=value,
    )


def hints(
    mesh: HalfEdgeMesh, policy: Policy, count: int = HINTS, near: np.ndarray | None = None
) -> tuple[PolicyAction, ...]:
    """The `count` operations to which the policy gives the highest probabilities, best first.

    In an episode a policy chooses among a few candidates that are selected with noise. Here the
    candidates are the WEIGHED half-edges whose best operation lowers s most, without noise, so that
    the result is reproducible.

    near (n,): vertex ids; if irregular vertices are among them, only the first LOOKED_AT of these
    are considered. Raises PolicyError if the policy is for the other kind of mesh.
    """
    require_kind(policy, mesh.kind)
    task = replace(policy.task, selection="shortlist", candidates=WEIGHED, noise=0.0)
    arrays = mesh.arrays
    scratch = Scratch(task, len(arrays.edge), len(arrays.vertex))
    narrowed = _narrowed(mesh, near)
    bounds = task.bounds(mesh.n_elements)
    seen = observe(narrowed, task, bounds, np.random.default_rng(0), scratch)
    if seen is None:
        return ()
    seen.state[0] = ((mesh.score - mesh.optimum) / 10.0, 1.0, 1.0)
    return _merged(arrays, task, seen, action_probabilities(policy.network, seen)[0])[:count]


def _narrowed(mesh: HalfEdgeMesh, near: np.ndarray | None) -> MeshArrays:
    """The mesh with its list of irregular vertices restricted to those that are considered."""
    arrays = mesh.arrays
    listed = arrays.irregular[: mesh.irregular_count]
    if near is not None:
        here = np.intersect1d(near, listed)
        order = {int(v): i for i, v in enumerate(near.tolist())}
        wanted = sorted(here.tolist(), key=order.__getitem__)[:LOOKED_AT]
        if wanted:
            listed = np.array(wanted, arrays.irregular.dtype)
    listed = listed[:LOOKED_AT]
    counters = arrays.counters.copy()
    counters[IRREGULAR] = len(listed)
    return arrays._replace(irregular=np.ascontiguousarray(listed), counters=counters)


def template_of(arrays: MeshArrays, task: Task, h: int) -> tuple[np.ndarray, int]:
    """:attr:`Insight.template` of h, and the number of slots beyond the boundary."""
    k = task.k
    source, turn = task.template
    slots = np.full(len(source), -1, np.int64)
    slots[0] = h
    for i in range(1, len(source)):
        came = int(slots[source[i]])
        if came >= 0:
            slots[i] = (
                arrays.edge[came, TWIN]
                if turn[i] < 0
                else came - came % k + (came + int(turn[i])) % k
            )
    rows: list[tuple[int, int, int]] = []
    met: set[int] = set()
    for slot in np.flatnonzero(slots >= 0).tolist():
        vertex = _seen_vertex(arrays, int(slots[slot]), k)
        if vertex not in met:
            met.add(vertex)
            rows.append((vertex, slot, _ring(slot // k, k)))
    return np.array(rows, np.int64).reshape(-1, 3), int((slots < 0).sum())


def _seen_vertex(arrays: MeshArrays, h: int, k: int) -> int:
    """The vertex of a half-edge: opposite in a triangle, origin in a quad (section 3.1)."""
    return int(arrays.edge[preceding(h, k) if k == 3 else h, ORIGIN])


def _ring(element: int, k: int) -> int:
    """The ring of an element from its number in the template; rings hold 1, k, k (k - 1), ..."""
    ring, last, size = 0, 0, k
    while element > last:
        ring, last, size = ring + 1, last + size, size * (k - 1)
    return ring


def field_of_view(arrays: MeshArrays, k: int, blocks: int, h: int) -> np.ndarray:
    """The elements on which the embedding of h depends (section 4.2), nearest first.

    (M, 2) int64: element, and the block of convolution that adds it. Each block combines the
    half-edges of an element and the twin.
    """
    reached = {h}
    elements = {h // k: 0}
    edge: list[int] = [h]
    for block in range(1, blocks + 1):
        onward: list[int] = []
        for g in edge:
            twin = int(arrays.edge[g, TWIN])
            around = [g - g % k + i for i in range(k)] + ([twin] if twin >= 0 else [])
            for other in around:
                if other not in reached:
                    reached.add(other)
                    onward.append(other)
                    elements.setdefault(other // k, block)
        edge = onward
    return np.array(list(elements.items()), np.int64).reshape(-1, 2)


def _merged(
    arrays: MeshArrays, task: Task, seen: Observation, probabilities: np.ndarray
) -> tuple[PolicyAction, ...]:
    """The permitted operations, likeliest first; those with the same result are merged."""
    found: dict[tuple[int, int], PolicyAction] = {}
    chosen, changes = seen.chosen[0], seen.changes[0]
    for row, column in np.argwhere(probabilities > 0.0).tolist():
        h, code = int(chosen[row]), task.first_operation + column
        choice = PolicyAction(
            NAMES[code], h, float(probabilities[row, column]), int(changes[row, column])
        )
        key = code, same_result(arrays, task.k, NAMES[code], h)
        known = found.get(key, choice)
        if known is not choice:
            likelier = max(known, choice, key=lambda one: one.probability)
            choice = replace(likelier, probability=known.probability + choice.probability)
        found[key] = choice
    ordered = sorted(found.values(), key=lambda choice: (-choice.probability, choice.halfedge))
    some = [choice for choice in ordered if choice.probability >= _FAINT]
    return tuple(some or ordered[:1])


def same_result(arrays: MeshArrays, k: int, operation: Operation, h: int) -> int:
    """The lowest half-edge at which the operation has the same result as at h."""
    twin = int(arrays.edge[h, TWIN])
    if k == 3 or operation in (Operation.FLIP_LEFT, Operation.FLIP_RIGHT):
        return h if twin < 0 else min(h, twin)
    if operation == Operation.COLLAPSE:
        return h - h % 4 + h % 2  # the diagonal from either of its ends
    return h
