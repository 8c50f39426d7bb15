"""The answer of a search: operations, positions, and what the mesh is like after them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from meshwright_agent.search.annealing import Operations
from meshwright_agent.search.coarsening import replayed
from meshwright_agent.search.guarded_coarsening import ALIKE, Aims, cost
from meshwright_core.core.arrays import MeshArrays
from meshwright_core.geometry import smoothing
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.element_sines import THIN
from meshwright_core.geometry.max_min_positions import max_min_positions
from meshwright_core.geometry.quality import inverted, scaled_jacobian
from meshwright_core.geometry.shape_bound import attainable_bound, shape_bound
from meshwright_core.geometry.weighed_shapes import weighed_worst
from meshwright_core.mesh import HalfEdgeMesh

RELAXED = 2_000
"""Elements up to which a mesh is smoothed as a whole before it is judged."""
NEAR = 40
"""Vertices of a larger mesh that are smoothed at a time."""
AVERAGED, SWEEPS = 4, 5
"""How often the changed vertices of a larger mesh are averaged, by so many sweeps each time."""
FEW = 4
"""Inverted elements of it that are untangled together."""


NO_AIMS = Aims(0.0, 0.0, 0.0, False)
"""Where only s, inverted elements and their number count."""


@dataclass
class Solution:
    """The best result of a search."""

    operations: Operations
    """Operations and their half-edges, to be applied in this order."""
    score: int
    optimum: int
    inverted: int
    """Elements that stay inverted or degenerate at the positions found."""
    elements: int = 0
    rollouts: int = 0
    seconds: float = 0.0
    method: str = "none"
    """The method that found it: "rollouts", "annealing", "layouts", "patches" (large meshes), or
    "none" if nothing better than the start was found."""
    coarse: bool = True
    """Whether fewer elements count as better."""
    worst_scaled_jacobian: float = 0.0
    """Smallest scaled Jacobian of an element."""
    worst_shape: float = 0.0
    """Smallest :func:`meshwright_core.geometry.element_shapes.element_shapes`."""
    shape_bound: float = 1.0
    """q*, what the corners permit of the worst scaled Jacobian where they are regular."""
    attainable: float = 1.0
    """The same for the best distribution of the s* irregularities."""
    sum_delta2: int = 0
    """Sum of the squared irregularities."""
    aims: Aims = NO_AIMS
    """What counted besides s."""
    reason: str = ""
    """Why the search ended, or what stands in the way of the optimum, in words."""
    vertices: np.ndarray = field(default_factory=lambda: np.zeros(0, np.int64), repr=False)
    """(n,) vertices that move after the operations."""
    positions: np.ndarray = field(default_factory=lambda: np.zeros((0, 3)), repr=False)
    """(n, 3) where to."""
    parameters: np.ndarray = field(default_factory=lambda: np.zeros(0), repr=False)
    """(n,) their places on curves."""
    reached: HalfEdgeMesh | None = field(default=None, repr=False, compare=False)
    """The mesh after operations and positions, where it is at hand; for reading only."""

    @property
    def rank(self) -> tuple[bool, int, int, int, int, float, int]:
        """Solutions with a lower rank are better: valid; s; inverted elements; weighed worst scaled
        Jacobian up to the target; sum of squares; elements, weighed against shape; operations.
        """
        aims = self.aims
        worst = min(self.worst_scaled_jacobian, THIN * self.worst_shape)  # as in weighed_worst
        shape = -int(min(worst, aims.target) / ALIKE)
        spread = self.sum_delta2 if aims.spread else 0
        weighed = cost(worst, self.elements, aims) if self.coarse else 0.0
        return (
            self.inverted > 0, self.score, self.inverted, shape, spread, round(weighed, 3),
            len(self.operations),
        )  # fmt: skip

    def replay(self, mesh: HalfEdgeMesh) -> None:
        """Apply the operations to `mesh`, the mesh that they were found for.

        Raises RuntimeError if the score reached is not :attr:`score`.
        """
        for operation, halfedge in self.operations:
            mesh.apply(operation, halfedge)
        if mesh.score != self.score:
            raise RuntimeError(f"the replay ends at s = {mesh.score}, the search at {self.score}")

    def place(self, mesh: HalfEdgeMesh) -> None:
        """Move the vertices of `mesh`, after :meth:`replay`, to the positions that it was judged
        by.
        """
        if len(self.vertices):
            mesh.move(self.vertices, self.positions, self.parameters)

    def carry_out(self, mesh: HalfEdgeMesh) -> bool:
        """:meth:`replay` and :meth:`place`; whether the mesh then has no inverted element."""
        self.replay(mesh)
        self.place(mesh)
        return not len(inverted(mesh))

    @property
    def perfect(self) -> bool:
        """Whether s = s*, so that it cannot be lower, without inverted elements."""
        return self.score == self.optimum and self.inverted == 0


def judged(
    solution: Solution,
    mesh: HalfEdgeMesh,
    stop: Callable[[], bool] = lambda: False,
    placed: MeshArrays | None = None,
    reached: HalfEdgeMesh | None = None,
) -> Solution:
    """The solution with positions, its measures and counts; `mesh` is the start.

    Positions: max-min ones for quads in a plane of moderate number, else smoothed and untangled
    ones. On large meshes only vertices that the operations have touched are smoothed, until `stop`.
    placed: the state that the operations lead to, with positions to begin with. reached: that
    state itself, which is changed; by default the operations are replayed.
    """
    if reached is None:
        reached = replayed(mesh, solution.operations)
    unplaced = reached.points.copy()
    if placed is not None:
        ids = reached.vertices()
        reached.move(ids, placed.points[ids], placed.parameter[ids])
    if reached.n_elements > RELAXED:
        relax_changed(mesh, reached, stop)
    elif solution.operations or len(inverted(reached)) or _is_short(reached, solution.aims):
        _best_positions(reached, stop)
    live = reached.vertices()
    vertices = live[(reached.points[live] != unplaced[live]).any(axis=1)]
    shapes = scaled_jacobian(reached)
    return replace(
        solution,
        score=reached.score,
        elements=reached.n_elements,
        inverted=len(inverted(reached)),
        worst_scaled_jacobian=float(shapes.min(initial=1.0)),
        worst_shape=float(element_shapes(reached).min(initial=1.0)),
        shape_bound=shape_bound(mesh),
        attainable=attainable_bound(mesh),
        sum_delta2=int((reached.irregularity() ** 2).sum()),
        vertices=vertices,
        positions=reached.points[vertices].copy(),
        parameters=reached.arrays.parameter[vertices].copy(),
        reached=reached,
    )


def _is_short(mesh: HalfEdgeMesh, aims: Aims) -> bool:
    """Whether the worst element is below the target, if there is one."""
    return weighed_worst(mesh) < aims.target


def _best_positions(reached: HalfEdgeMesh, stop: Callable[[], bool]) -> None:
    """Move the vertices of `reached`."""
    before, parameters = reached.points.copy(), reached.parameters()
    valid = not len(inverted(reached))
    worst = scaled_jacobian(reached).min(initial=1.0)
    if reached.kind == "quad" and not reached.points[reached.vertices(), 2].any():
        _raise_worst(reached)
        left = len(inverted(reached))
        if valid and (left or scaled_jacobian(reached).min(initial=1.0) < worst):
            ids = reached.vertices()
            reached.move(ids, before[ids], parameters[ids])
        elif left and not stop():
            other = mesh_at(reached, before, parameters)
            if len(smoothing.relax(other)) < left:
                better = other.copy()
                _raise_worst(better)
                if len(inverted(better)) <= len(inverted(other)):
                    other = better
                ids = other.vertices()
                reached.move(ids, other.points[ids], other.arrays.parameter[ids])
    elif not stop():
        smoothing.relax(reached)


def _raise_worst(mesh: HalfEdgeMesh) -> None:
    """Give a plane quad mesh its max-min positions."""
    mesh.move(*max_min_positions(mesh))


def mesh_at(mesh: HalfEdgeMesh, points: np.ndarray, parameters: np.ndarray) -> HalfEdgeMesh:
    """A copy of a mesh with its vertices elsewhere; rows of both by vertex id."""
    copy, ids = mesh.copy(), mesh.vertices()
    copy.move(ids, points[ids], parameters[ids])
    return copy


def relax_changed(mesh: HalfEdgeMesh, reached: HalfEdgeMesh, stop: Callable[[], bool]) -> None:
    """Smooth around all vertices that are new or have another degree, as long as `stop` is false,
    those of inverted elements first.
    """
    unfold_changed(mesh, reached, stop)
    _relax_near(reached, _changed(mesh, reached), NEAR, stop)


def unfold_changed(mesh: HalfEdgeMesh, reached: HalfEdgeMesh, stop: Callable[[], bool]) -> None:
    """Average all vertices that are new or have another degree, which unfolds most of what is
    folded, then untangle what is left, as long as `stop` is false.
    """
    changed = _changed(mesh, reached)
    if not len(inverted(reached)) or not len(changed):
        return
    for _ in range(AVERAGED):
        if stop():
            return
        moved = smoothing.smooth(reached, changed.tolist(), iterations=SWEEPS)
        if not len(moved[0]):
            break
        reached.move(*moved)
    folded = inverted(reached)
    for at in range(0, len(folded), FEW):
        _relax_near(reached, np.unique(reached.corners(folded[at : at + FEW])), NEAR, stop)


def _changed(mesh: HalfEdgeMesh, reached: HalfEdgeMesh) -> np.ndarray:
    """Ids (n,) of the vertices of `reached` that `mesh` has not, or elsewhere or of another degree;
    those of inverted elements first.
    """
    live = reached.vertices()
    known = live[live < mesh.slots]
    before = mesh.degree()
    same = (before[known] == reached.degree()[known]) & (before[known] > 0)
    same &= (mesh.points[known] == reached.points[known]).all(axis=1)
    folded = np.unique(reached.corners(inverted(reached)))
    return np.concatenate([folded, np.setdiff1d(live, np.union1d(known[same], folded))])


def _relax_near(
    mesh: HalfEdgeMesh, vertices: np.ndarray, number: int, stop: Callable[[], bool]
) -> None:
    """Smooth around vertices, so many at a time, until `stop`."""
    for at in range(0, len(vertices), number):
        if stop():
            break
        smoothing.relax(mesh, vertices[at : at + number].tolist(), thorough=False)
