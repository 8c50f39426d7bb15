"""The task: what the agent may do, what it sees, what a step is, when a run ends (section 4)."""

from __future__ import annotations

from dataclasses import asdict, dataclass

import numpy as np

from agent.patch import LARGEST, POTENTIALS, Patches, describe, list_patch
from agent.potential import field, forget, solve_potential
from agent.selection import best_template, masks, shortlist, template_plan
from meshcore.compiled import bare_shared_kernel, shared_kernel
from meshcore.halfedge import (
    HALF,
    NEW_COUNT,
    TOUCHED_COUNT,
    TRACE_IDS,
    MeshArrays,
)
from meshcore.navigation import cleanable_at
from meshcore.operations import CLEANUP, FLIP_LEFT, GLOBAL_SPLIT, TRI_FLIP, rewrite

FIRST_OPERATION = {"tri": TRI_FLIP, "quad": FLIP_LEFT}
OPERATION_COUNT = {"tri": 3, "quad": 5}
MOST_CLEANUPS = 64
_TOUCHED = 16
_FOUND = 1024


@dataclass(frozen=True)
class Task:
    """Everything that a policy must agree on with its environment; saved with the policy."""

    kind: str
    """"tri" or "quad"."""
    selection: str = "shortlist"
    """"shortlist" or "template", see :mod:`agent.selection`."""
    candidates: int = 32
    """Half-edges in the shortlist."""
    levels: int = 1
    """Rings of elements in the template."""
    noise: float = 1.0
    """Scale of the Gumbel noise in the shortlist."""
    blocks: int = 4
    """Blocks of convolution, and with them the reach of the patch."""
    channels: int = 4
    """How many of agent.patch.CHANNELS the policy sees; the paper: 2."""
    degree_cap: int = 0
    """Highest degree that an operation may bring about; 0: 9 for triangles, 7 for quads."""
    extended: bool = False
    """Whether boundary edges of triangle meshes may be collapsed (beyond the paper)."""
    element_floor: float = 0.0
    """Elements that a run must keep, relative to its start."""
    element_ceiling: float = 2.0
    """Elements that a run may reach, relative to its start."""
    steps: float = 1.5
    """Length of a run, relative to the number of elements at its start."""

    def __post_init__(self) -> None:
        """Refuse settings that mean nothing."""
        if self.kind not in OPERATION_COUNT:
            raise ValueError(f'a task is of kind "tri" or "quad", not "{self.kind}"')
        if self.selection not in ("shortlist", "template"):
            raise ValueError(f'selection is "shortlist" or "template", not "{self.selection}"')
        if self.channels not in (2, 4, 6):
            raise ValueError(f"a policy sees 2, 4 or 6 channels, not {self.channels}")

    @property
    def k(self) -> int:
        """Sides of an element."""
        return 3 if self.kind == "tri" else 4

    @property
    def cap(self) -> int:
        """The degree cap in force."""
        return self.degree_cap or (9 if self.kind == "tri" else 7)

    @property
    def first_operation(self) -> int:
        """Code of the first operation; the others follow."""
        return FIRST_OPERATION[self.kind]

    @property
    def operations(self) -> int:
        """Number of operations per half-edge."""
        return OPERATION_COUNT[self.kind]

    @property
    def template(self) -> tuple[np.ndarray, np.ndarray]:
        """Source and turn of the template."""
        return template_plan(self.k, self.levels)

    @property
    def rows(self) -> int:
        """Half-edges among which one decision chooses."""
        return self.candidates if self.selection == "shortlist" else len(self.template[0])

    def step_limit(self, elements: int) -> int:
        """Steps of a run that starts with so many elements."""
        return max(10, int(self.steps * elements))

    def bounds(self, elements: int) -> tuple[int, int]:
        """Floor and ceiling of the number of elements of such a run."""
        return int(np.ceil(self.element_floor * elements)), max(
            elements + 8, int(self.element_ceiling * elements)
        )

    def to_dict(self) -> dict[str, object]:
        """The settings as plain values."""
        return asdict(self)


class Scratch:
    """Arrays that looking at meshes needs and that nobody else looks at."""

    def __init__(self, task: Task, halfedges: int, vertices: int) -> None:
        """For meshes with at most so many half-edge slots and vertex slots."""
        self.found = np.zeros(_FOUND, np.int64)
        self.keys = np.zeros(_FOUND * task.k)
        self.slots = np.zeros(len(task.template[0]), np.int64)
        self.listed = np.zeros(LARGEST, np.int64)
        self.reads = np.zeros((LARGEST, task.k + 1), np.int16)
        self.slot_of = np.zeros(halfedges, np.int32)
        self.field = field(vertices if task.channels > POTENTIALS else 0)
        self.touched = np.zeros(_TOUCHED, np.int64)
        self.cleaned = np.zeros(MOST_CLEANUPS, np.int64)


@bare_shared_kernel
def transition(m, operation, h, cap, touched, cleaned):
    """One step of the run: the operation, then every clean-up that it makes possible (section 4.1).

    touched (N,): scratch; cleaned (N,): receives the half-edges of the clean-ups. Returns their
    number.
    """
    rewrite(m, operation, h)
    if operation < FLIP_LEFT:
        return 0
    new, total = m.trace[NEW_COUNT], m.trace[TOUCHED_COUNT]
    count = 0
    for i in range(total):
        # of the new vertices of a global split the first two are where lines have changed
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
def choose_candidates(
    m, k, first, count, cap, floor, ceiling, extended, listed, noise, source, turn, rng,
    found, keys, slots, chosen,
):  # fmt: skip
    """Fill `chosen` by the shortlist (listed) or the template; returns how many are real."""
    if listed:
        return shortlist(
            m, k, first, count, cap, floor, ceiling, extended, noise, rng, found, keys, chosen
        )
    return best_template(m, k, source, turn, rng, found, slots, chosen)


@bare_shared_kernel
def look(m, chosen, k, sizes, listed, reads, slot_of, field, features):
    """List the patch of the candidates and describe its half-edges: rows of `features` (N, C)
    int8.
    """
    list_patch(m, chosen, k, sizes, listed, reads, slot_of)
    solved = features.shape[1] > POTENTIALS
    elements = solve_potential(m, k, chosen, field) if solved else 0
    for i in range(sizes[0]):
        describe(m, listed[i], k, field, features[i])
    forget(m, k, field, elements)


@dataclass
class Observation:
    """What B decisions look at."""

    chosen: np.ndarray
    """(B, K) int64 candidate half-edges, -1 for none."""
    mask: np.ndarray
    """(B, K, A) bool: permitted operations."""
    changes: np.ndarray
    """(B, K, A) int8: exact change of s of each permitted operation."""
    state: np.ndarray
    """(B, 3) float32: a tenth of the gap to the optimum, share of steps left, elements relative to
    the start; for the value baseline only."""
    patches: Patches
    """The patches of the candidates of each decision; the first rows belong to the real ones."""


def observe(
    arrays: MeshArrays,
    task: Task,
    bounds: tuple[int, int],
    rng: np.random.Generator,
    scratch: Scratch,
) -> Observation | None:
    """One decision on one mesh (B = 1); None where no operation is permitted."""
    source, turn = task.template
    settings = (task.first_operation, task.operations, task.cap, *bounds, task.extended)
    chosen = np.full((1, task.rows), -1, np.int64)
    choose_candidates(
        arrays, task.k, *settings, task.selection == "shortlist", task.noise, source, turn, rng,
        scratch.found, scratch.keys, scratch.slots, chosen[0],
    )  # fmt: skip
    mask = np.zeros((1, task.rows, task.operations), np.bool_)
    changes = np.zeros((1, task.rows, task.operations), np.int8)
    if not masks(arrays, chosen[0], *settings, mask[0], changes[0]):
        return None
    sizes = np.zeros((1, task.blocks + 1), np.int32)
    features = np.zeros((LARGEST, task.channels), np.int8)
    look(
        arrays,
        chosen[0],
        task.k,
        sizes[0],
        scratch.listed,
        scratch.reads,
        scratch.slot_of,
        scratch.field,
        features,
    )
    patches = Patches(features[: sizes[0, 0]], scratch.reads[: sizes[0, 1]].copy(), sizes)
    return Observation(chosen, mask, changes, np.zeros((1, 3), np.float32), patches)
