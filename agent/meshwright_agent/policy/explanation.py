"""Looking into a policy: its probabilities, its template and its field of view at one state.

Nothing here decides anything or changes a mesh. :func:`insight` is for a decision that is about to
be taken, :func:`hints` for a person who asks what the policy would do.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import torch

from meshwright_agent.env.candidates import LOOKED_AT
from meshwright_agent.env.task import Observation, Scratch, Task, observe
from meshwright_agent.policy.explanation_types import Choice, Insight
from meshwright_agent.policy.inference import tensors
from meshwright_agent.policy.network import PolicyNetwork
from meshwright_agent.policy.policy_files import Policy, require_kind
from meshwright_core.core.arrays import IRREGULAR, ORIGIN, TWIN, MeshArrays, preceding
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import NAMES, Operation

HINTS = 5
"""Hints that are given at once."""
WEIGHED = 128
"""Half-edges among which hints are sought: more than a decision looks at, and without chance."""
_FAINT = 5e-4  # choices less likely than this are not worth a line


@torch.no_grad()
def weigh(network: PolicyNetwork, seen: Observation) -> tuple[np.ndarray, float]:
    """The probability of each candidate's operations (K, A) float64, and the value."""
    logits, values = network(*tensors(seen))
    spread = torch.softmax(logits[0].double(), dim=0).numpy()
    mask = seen.mask[0]
    return np.where(mask, spread.reshape(mask.shape), 0.0), float(values[0])


def insight(arrays: MeshArrays, policy: Policy, seen: Observation, action: int) -> Insight:
    """What the policy sees at the state that `seen` (of one decision) was made from, where it is
    about to take `action`.
    """
    task = policy.task
    probabilities, value = weigh(policy.network, seen)
    row, column = divmod(action, task.operations)
    h = int(seen.chosen[0, row])
    real = seen.chosen[0] >= 0
    template, missing = template_of(arrays, task, h)
    return Insight(
        choices=_merged(arrays, task, seen, probabilities),
        wanted=Choice(
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
) -> tuple[Choice, ...]:
    """The policy's best few operations on the mesh, the likeliest first.

    near (n,): vertex ids; only the irregular ones among them, the first LOOKED_AT, are looked
    around, as long as there are any. A policy looks at a few half-edges at a time, drawn with some
    noise; here it is asked about WEIGHED of them, those whose best operation lowers s most, without
    noise, so that the same question gets the same answer. Raises PolicyError if the policy is for
    the other kind of mesh.
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
    return _merged(arrays, task, seen, weigh(policy.network, seen)[0])[:count]


def _narrowed(mesh: HalfEdgeMesh, near: np.ndarray | None) -> MeshArrays:
    """The mesh with only the irregular vertices listed that are to be looked at."""
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
    """The template of h as :attr:`Insight.template` has it, and its slots beyond the boundary."""
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
    """The vertex of a half-edge: opposite in a triangle, origin in a quad (section 4.1)."""
    return int(arrays.edge[preceding(h, k) if k == 3 else h, ORIGIN])


def _ring(element: int, k: int) -> int:
    """The ring of the element with this number in the template: 1, then k, then k (k - 1), ..."""
    ring, last, size = 0, 0, k
    while element > last:
        ring, last, size = ring + 1, last + size, size * (k - 1)
    return ring


def field_of_view(arrays: MeshArrays, k: int, blocks: int, h: int) -> np.ndarray:
    """Elements on which the embedding of h depends after so many blocks, and the block that each
    comes in with: (M, 2), the nearest first.

    One block gives a half-edge what its element and its twin held.
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
) -> tuple[Choice, ...]:
    """The permitted operations, the likeliest first, those with the same result taken together."""
    found: dict[tuple[int, int], Choice] = {}
    chosen, changes = seen.chosen[0], seen.changes[0]
    for row, column in np.argwhere(probabilities > 0.0).tolist():
        h, code = int(chosen[row]), task.first_operation + column
        choice = Choice(
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
    """The lowest of the half-edges on which the operation has the same result as on h."""
    twin = int(arrays.edge[h, TWIN])
    if k == 3 or operation in (Operation.FLIP_LEFT, Operation.FLIP_RIGHT):
        return h if twin < 0 else min(h, twin)
    if operation == Operation.COLLAPSE:
        return h - h % 4 + h % 2  # the diagonal from either of its ends
    return h
