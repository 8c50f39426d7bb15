"""What operations would do at a half-edge, before anything is done: ghosts and numbers for views.

Knows neither Qt nor torch; the window and the notebook show the same.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshwright_core import HalfEdgeMesh, Operation, Verdict
from meshwright_core.analysis.dry_run import dry_run
from meshwright_core.analysis.dry_run import score_change as tried_change
from meshwright_core.operations.catalogue import CODES, OperationInfo, of_kind, score_change

BARRED = -1
"""The code of a verdict that is not the mesh's own: what is being played does without it."""


@dataclass(frozen=True)
class Choice:
    """One operation of the mesh's kind at one half-edge."""

    info: OperationInfo
    verdict: Verdict
    change: int | None
    """How s would change; None where the operation is refused."""

    @property
    def operation(self) -> Operation:
        """Which one."""
        return self.info.operation

    @property
    def allowed(self) -> bool:
        """Whether it may be done."""
        return bool(self.verdict)


@dataclass(frozen=True)
class Ghost:
    """What would be there and what would go, in the plane of the view."""

    operation: Operation
    halfedge: int
    change: int
    """How s would change."""
    added: np.ndarray
    """(n, 2, 2) ends of the edges that there would be."""
    removed: np.ndarray
    """(m, 2, 2) ends of the edges that would go."""
    gone: np.ndarray
    """(g, 2) places of the vertices that would go."""
    places: np.ndarray
    """(p, 2) where vertices would have another Delta than they have now."""
    delta: np.ndarray
    """(p,) the Delta that they would have; 0 for those that become regular. New vertices that are
    regular are no news.
    """

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least x and y, largest x and y of all there is to see; zeros where there is nothing."""
        seen = np.concatenate([self.added.reshape(-1, 2), self.removed.reshape(-1, 2), self.places])
        if not len(seen):
            return 0.0, 0.0, 0.0, 0.0
        (x, y), (right, top) = seen.min(axis=0).tolist(), seen.max(axis=0).tolist()
        return x, y, right, top


def ghost(mesh: HalfEdgeMesh, operation: Operation | str, halfedge: int) -> Ghost:
    """The ghost of an operation, positions as they are before smoothing.

    The mesh stays as it is, to the bit. Raises OperationRefused where it is not allowed.
    """
    seen = dry_run(mesh, operation, halfedge)
    told = (seen.delta != 0) | ~np.isin(seen.vertices, seen.new_vertices)
    return Ghost(
        operation=seen.operation,
        halfedge=halfedge,
        change=seen.score_change,
        added=seen.added[:, :, :2],
        removed=seen.removed[:, :, :2],
        gone=seen.gone[:, :2],
        places=seen.places[told, :2],
        delta=seen.delta[told],
    )


def choices(
    mesh: HalfEdgeMesh, halfedge: int, bar: Callable[[str], str] | None = None
) -> tuple[Choice, ...]:
    """Verdict and change of s of every operation at a live half-edge, in the catalogue's order.

    ``bar`` is that of the document: why an operation is not done there, whatever the mesh says.
    """
    return tuple(_choice(mesh, info, halfedge, bar) for info in of_kind(mesh.kind))


def _choice(
    mesh: HalfEdgeMesh, info: OperationInfo, halfedge: int, bar: Callable[[str], str] | None
) -> Choice:
    why = bar(info.operation.value) if bar is not None else ""
    verdict = Verdict(BARRED, why.rstrip(".")) if why else mesh.check(info.operation, halfedge)
    if not verdict:
        return Choice(info, verdict, None)
    if not info.score_formula:
        return Choice(info, verdict, tried_change(mesh, info.operation, halfedge))
    code = CODES[mesh.k][info.operation]
    return Choice(info, verdict, int(score_change(mesh.arrays, code, halfedge)))


def best(offered: tuple[Choice, ...]) -> Choice | None:
    """The allowed one with the lowest change of s, the first of equals; None if none is allowed.

    One that changes the mesh from boundary to boundary comes only where no local one is allowed: a
    person who points at an edge means what lies there.
    """

    def rank(choice: Choice) -> tuple[bool, int]:
        return not choice.info.is_local, choice.change or 0

    return min((choice for choice in offered if choice.allowed), key=rank, default=None)


def following(offered: tuple[Choice, ...], current: Operation | None, step: int) -> Choice | None:
    """The allowed one ``step`` places after the current one, from the last to the first again."""
    open_to = [choice for choice in offered if choice.allowed]
    if not open_to:
        return None
    at = next((i for i, choice in enumerate(open_to) if choice.operation == current), None)
    if at is None:
        return open_to[0 if step > 0 else -1]
    return open_to[(at + step) % len(open_to)]
