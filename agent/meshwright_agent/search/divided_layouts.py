"""Layouts that can be drawn only when they are finer.

Few quads between the sides of a part often cannot be drawn with the connectivity that a rollout has
found, since edges are straight inside. With every strip cut in two the connectivity is the same, s
too, and edges can bend. What is not needed is collapsed again by what follows.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from meshwright_agent.search.annealing import Annealer, Operations
from meshwright_core.analysis.element_division import chords
from meshwright_core.geometry.layout_positions import layout_bound
from meshwright_core.geometry.smoothing import draw
from meshwright_core.mesh import HalfEdgeMesh
from meshwright_core.operations.catalogue import Operation

FINEST = 1000
"""Elements that a layout may have once it is divided: positions for more take seconds."""
LEAST_BOUND = 0.1
"""Sine of the worst corner that the degrees of a layout must permit for it to be drawn."""
FEW = 14
"""Inverted elements up to which the strips through them are divided once more."""

WAYS, PROPOSALS = 30, 100_000
"""Ways down that are annealed from a state, and proposals of each."""
LONGEST = 1000
"""Operations of a way."""
WARM, COLD = 0.4, 0.3
"""Temperatures, see :mod:`meshwright_agent.search.annealing`."""
SLICE = 20_000
"""Proposals between two looks at the clock."""


def ways_down(
    mesh: HalfEdgeMesh, goal: int, rng: np.random.Generator, stop: Callable[[], bool]
) -> list[Operations]:
    """Operations by which annealing leads from `mesh` to an s of `goal`, the shortest first.

    Long ways are left out: what they end at has little to do with the positions at their start.
    """
    found = []
    for _ in range(WAYS):
        annealer = Annealer(mesh, int(rng.integers(1 << 31)), goal=goal, temperatures=(WARM, COLD))
        for _ in range(PROPOSALS // SLICE):
            if stop() or annealer.run(SLICE):
                break
        if stop():
            break
        if annealer.finished and len(way := annealer.operations()) <= LONGEST:
            found.append(way)
    return sorted(found, key=len)


def collapse_chords(
    mesh: HalfEdgeMesh, most: int, rng: np.random.Generator, usable: Callable[[HalfEdgeMesh], bool]
) -> Operations:
    """Collapse strips of a quad mesh, in place and in random order, until it has `most` elements or
    no more can go without higher s. Returns the operations.

    usable: of the mesh after a collapse; one after which it is not is undone.
    """
    done: Operations = []
    score, gone = mesh.score, True
    while gone and mesh.n_elements > most:
        gone = False
        for h in rng.permutation(4 * mesh.element_ids()).tolist():
            for side in (h, h + 1):
                if not mesh.check(Operation.CHORD_COLLAPSE, side):
                    continue
                mesh.apply(Operation.CHORD_COLLAPSE, side)
                if mesh.score <= score and usable(mesh):
                    done.append((Operation.CHORD_COLLAPSE, side))
                    gone = True
                    break
                mesh.undo()
            if mesh.n_elements <= most:
                break
    return done


def divide_chords(mesh: HalfEdgeMesh, through: np.ndarray | None = None) -> Operations:
    """Cut strips of a quad mesh in two, in place, but for those that close in a ring.

    through: ids of elements; by default all strips are cut, else those through these elements.
    Returns the operations.
    """
    crossing, ids = chords(mesh), mesh.element_ids()
    numbers, first = np.unique(crossing.ravel(), return_index=True)
    if through is not None:
        first = first[np.isin(numbers, crossing[np.isin(ids, through)])]
    done: Operations = []
    for place in first.tolist():
        # chord j of an element crosses its sides j and j + 2
        h = 4 * int(ids[place // 2]) + place % 2
        if mesh.check(Operation.DIVIDE_CHORD, h):
            mesh.apply(Operation.DIVIDE_CHORD, h)
            done.append((Operation.DIVIDE_CHORD, h))
    return done


def drawable(mesh: HalfEdgeMesh, angle: np.ndarray) -> bool:
    """Whether the degrees of a quad mesh permit corners that are worth looking for positions.

    angle: radians of the corners of the boundary by vertex, see
    :func:`meshwright_core.geometry.shape_bound.corner_angles`; operations add no corner.
    """
    return bool(layout_bound(mesh.arrays, angle) > LEAST_BOUND)


def divisible(elements: int) -> bool:
    """Whether a mesh of so many quads has at most :data:`FINEST` once its strips are divided."""
    return 4 * elements <= FINEST


def drawn_divided(
    reached: HalfEdgeMesh, stop: Callable[[], bool], attempts: int
) -> tuple[Operations, bool]:
    """Divide the strips of a plane quad mesh, in place, and look for positions.

    Where few elements stay inverted the strips through them are divided once more, after which more
    than half of these can be drawn. A mesh that would have more than :data:`FINEST` elements at
    first is drawn as it is. Returns the operations and whether nothing is inverted.
    """
    divisions = divide_chords(reached) if divisible(reached.n_elements) else []
    inverted = draw(reached, stop, attempts)
    if 0 < len(inverted) <= FEW and reached.n_elements <= FINEST and not stop():
        divisions += divide_chords(reached, inverted)
        inverted = draw(reached, stop, 1)
    return divisions, not len(inverted)
