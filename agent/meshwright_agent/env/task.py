"""The Markov decision process (section 4): actions, observations, transitions, episode length.

An action is an operation at one of a few candidate half-edges. An observation describes the
half-edges that the policy's convolution reads. A transition applies the operation and all clean-ups
that it makes possible. An episode ends at the optimum s*, after a number of steps proportional to
the elements at its start (section 4.1), or when no operation is permitted.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Annotated

import numpy as np
from msgspec import Meta

from meshwright_agent.env.candidates import (
    Ranking,
    Rules,
    WorkArrays,
    best_template,
    masks,
    shortlist,
    template_plan,
)
from meshwright_agent.env.local_patch import LARGEST, POTENTIALS, Patches, describe, list_patch
from meshwright_agent.env.potential import field, forget, solve_potential
from meshwright_core.core.arrays import HALF, NEW_COUNT, SIDES, TOUCHED_COUNT, TRACE_IDS, MeshArrays
from meshwright_core.core.compilation import bare_shared_kernel, shared_kernel
from meshwright_core.operations.catalogue import (
    CLEANUP,
    FLIP_LEFT,
    GLOBAL_SPLIT,
    TRI_FLIP,
    of_kind,
    rewrite,
)
from meshwright_core.operations.global_lines import cleanable_at

FIRST_OPERATION = {"tri": TRI_FLIP, "quad": FLIP_LEFT}
OPERATION_COUNT = {kind: sum(info.policy for info in of_kind(kind)) for kind in FIRST_OPERATION}
MOST_CLEANUPS = 64
_TOUCHED = 16
_FOUND = 1024


@dataclass(frozen=True)
class Task:
    """The settings that policy and environment share; saved with the policy."""

    kind: str
    """"tri" or "quad"."""
    selection: str = "shortlist"
    """"shortlist" or "template", see :mod:`meshwright_agent.env.candidates`."""
    candidates: Annotated[int, Meta(ge=1, le=1024)] = 32
    """Half-edges in the shortlist, K."""
    levels: Annotated[int, Meta(ge=0, le=5)] = 1
    """Rings of elements in the template (section 4.2.1)."""
    noise: Annotated[float, Meta(ge=0.0, le=1e6)] = 1.0
    """Scale of the Gumbel noise in the shortlist."""
    blocks: Annotated[int, Meta(ge=1, le=32)] = 4
    """Blocks of convolution (section 4.2), which set how far the policy sees."""
    channels: int = 4
    """How many of :data:`meshwright_agent.env.local_patch.CHANNELS` are observed; the paper: 2."""
    degree_cap: Annotated[int, Meta(ge=0, le=100)] = 0
    """Highest degree that an operation may produce; 0 stands for 9 (triangles) or 7 (quads)."""
    extended: bool = False
    """Whether boundary edges of triangle meshes may be collapsed; the paper does not."""
    element_floor: Annotated[float, Meta(ge=0.0, le=1e3)] = 0.0
    """Least number of elements in an episode, relative to its start."""
    element_ceiling: Annotated[float, Meta(gt=0.0, le=1e3)] = 2.0
    """Largest number of elements in an episode, relative to its start."""
    steps: Annotated[float, Meta(gt=0.0, le=1e3)] = 1.5
    """Largest number of steps of an episode, relative to the elements at its start."""

    def __post_init__(self) -> None:
        """Raise ValueError for a kind, selection or number of channels that does not exist."""
        if self.kind not in OPERATION_COUNT:
            raise ValueError(f'kind must be "tri" or "quad", not "{self.kind}"')
        if self.selection not in ("shortlist", "template"):
            raise ValueError(f'selection must be "shortlist" or "template", not "{self.selection}"')
        if self.channels not in (2, 4, 6):
            raise ValueError(f"channels must be 2, 4 or 6, not {self.channels}")

    @property
    def k(self) -> int:
        """Sides of an element: 3 or 4."""
        return 3 if self.kind == "tri" else 4

    @property
    def cap(self) -> int:
        """The degree cap, with the default for the kind filled in."""
        return self.degree_cap or (9 if self.kind == "tri" else 7)

    @property
    def first_operation(self) -> int:
        """Code of the first operation of the action set; the others follow."""
        return FIRST_OPERATION[self.kind]

    @property
    def operations(self) -> int:
        """Number of operations per half-edge, A (section 3.2)."""
        return OPERATION_COUNT[self.kind]

    @property
    def template(self) -> tuple[np.ndarray, np.ndarray]:
        """The template, see :func:`meshwright_agent.env.candidates.template_plan`."""
        return template_plan(self.k, self.levels)

    @property
    def rows(self) -> int:
        """Candidate half-edges of a decision, K."""
        return self.candidates if self.selection == "shortlist" else len(self.template[0])

    def step_limit(self, elements: int) -> int:
        """Steps of an episode that starts with so many elements, at least 10."""
        return max(10, int(self.steps * elements))

    def bounds(self, elements: int) -> tuple[int, int]:
        """Least and largest number of elements of an episode that starts with so many."""
        return int(np.ceil(self.element_floor * elements)), max(
            elements + 8, int(self.element_ceiling * elements)
        )

    def rules(self, floor: int, ceiling: int) -> Rules:
        """The rules of an episode with these bounds of the number of elements."""
        return Rules(
            self.first_operation, self.operations, self.cap, int(floor), int(ceiling), self.extended
        )

    @property
    def ranking(self) -> Ranking:
        """How the candidates are chosen."""
        return Ranking(self.selection == "shortlist", float(self.noise), *self.template)

    def to_dict(self) -> dict[str, object]:
        """The settings as plain values."""
        return asdict(self)


class Scratch:
    """Work arrays of the observation and transition kernels, reused between calls."""

    def __init__(self, task: Task, halfedges: int, vertices: int) -> None:
        """Allocate for meshes with at most so many half-edge slots and vertex slots."""
        self.work = WorkArrays(
            np.zeros(_FOUND, np.int64),
            np.zeros(_FOUND * task.k),
            np.zeros(len(task.template[0]), np.int64),
            np.zeros(LARGEST, np.int64),
            np.zeros((LARGEST, task.k + 1), np.int16),
            np.zeros(halfedges, np.int32),
        )
        self.field = field(vertices if task.channels > POTENTIALS else 0)
        self.touched = np.zeros(_TOUCHED, np.int64)
        self.cleaned = np.zeros(MOST_CLEANUPS, np.int64)


@bare_shared_kernel
def transition(m, operation, h, cap, touched, cleaned):
    """Apply an operation, then every global clean-up that it makes possible (section 3.2).

    touched (N,): scratch; cleaned (N,): receives the half-edges of the clean-ups. Returns their
    number.
    """
    rewrite(m, operation, h)
    if operation < FLIP_LEFT:
        return 0
    new, total = m.trace[NEW_COUNT], m.trace[TOUCHED_COUNT]
    count = 0
    for i in range(total):
        # a global split changes lines only at the first two of its new vertices
        if operation == GLOBAL_SPLIT and 2 <= i < new:
            continue
        if count < len(touched):
            touched[count] = m.trace[TRACE_IDS + i]
            count += 1
    cleanups = 0
    for i in range(count):
        v = touched[i]
        while m.vertex[v, HALF] >= 0 and cleanups < len(cleaned):
            line = cleanable_at(m, v, cap)
            if line < 0:
                break
            rewrite(m, CLEANUP, line)
            cleaned[cleanups] = line
            cleanups += 1
    return cleanups


@shared_kernel
def choose_candidates(m, rules, ranking, work, chosen, rng):
    """Fill `chosen` (K,) from the shortlist or the template; returns their number."""
    if ranking.shortlist:
        return shortlist(m, rules, ranking.noise, work, chosen, rng)
    return best_template(m, ranking, work, chosen, rng)


@bare_shared_kernel
def look(m, chosen, sizes, work, field, features):
    """List the local patch of the candidates and write the channels of its half-edges into
    `features` (N, C) int8.
    """
    k = m.counters[SIDES]
    list_patch(m, chosen, k, sizes, work.listed, work.reads, work.slot_of)
    solved = features.shape[1] > POTENTIALS
    elements = solve_potential(m, k, chosen, field) if solved else 0
    for i in range(sizes[0]):
        describe(m, work.listed[i], k, field, features[i])
    forget(m, k, field, elements)


@dataclass
class Observation:
    """The observation of B decisions."""

    chosen: np.ndarray
    """(B, K) int64: candidate half-edges, -1 for none."""
    mask: np.ndarray
    """(B, K, A) bool: which operations are permitted."""
    changes: np.ndarray
    """(B, K, A) int8: exact change of s of each permitted operation."""
    state: np.ndarray
    """(B, 3) float32, for the value head only: (s - s*) / 10, the share of steps left, and the
    elements relative to the start."""
    patches: Patches
    """The local patch of each decision; its first rows are the candidates that exist."""


def observe(
    arrays: MeshArrays,
    task: Task,
    bounds: tuple[int, int],
    rng: np.random.Generator,
    scratch: Scratch,
) -> Observation | None:
    """The observation of one mesh (B = 1); None where no operation is permitted.

    The state is left at zero for the caller to fill. bounds: least and largest number of elements.
    """
    rules = task.rules(*bounds)
    chosen = np.full((1, task.rows), -1, np.int64)
    choose_candidates(arrays, rules, task.ranking, scratch.work, chosen[0], rng)
    mask = np.zeros((1, task.rows, task.operations), np.bool_)
    changes = np.zeros((1, task.rows, task.operations), np.int8)
    if not masks(arrays, chosen[0], rules, mask[0], changes[0]):
        return None
    sizes = np.zeros((1, task.blocks + 1), np.int32)
    features = np.zeros((LARGEST, task.channels), np.int8)
    look(arrays, chosen[0], sizes[0], scratch.work, scratch.field, features)
    patches = Patches(features[: sizes[0, 0]], scratch.work.reads[: sizes[0, 1]].copy(), sizes)
    return Observation(chosen, mask, changes, np.zeros((1, 3), np.float32), patches)
