"""Previews of the operations at a half-edge: whether they are allowed, and what they would change.

Imports neither Qt nor torch; window and notebook share it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from meshwright_core import HalfEdgeMesh, Operation, Verdict
from meshwright_core.analysis.dry_run import dry_run
from meshwright_core.analysis.dry_run import score_change as tried_change
from meshwright_core.geometry.edge_parts import EdgeParts
from meshwright_core.operations.catalogue import CODES, OperationInfo, of_kind, score_change

BARRED = -1
"""Code of the verdict on an operation that the level being played excludes."""


@dataclass(frozen=True)
class OperationOffer:
    """One operation of the mesh's kind at one half-edge."""

    info: OperationInfo
    verdict: Verdict
    change: int | None
    """Change of s; None if the operation is refused."""

    @property
    def operation(self) -> Operation:
        """The operation."""
        return self.info.operation

    @property
    def allowed(self) -> bool:
        """Whether the operation is allowed."""
        return bool(self.verdict)


@dataclass(frozen=True)
class Ghost:
    """Edges and vertices that an operation would add and remove, in the plane of the view."""

    operation: Operation
    halfedge: int
    change: int
    """Change of s."""
    added_edges: EdgeParts
    """The n new edges."""
    removed_edges: EdgeParts
    """The m removed edges."""
    fresh: np.ndarray
    """(q, 2) positions of the new vertices, those on a curve exactly there."""
    gone: np.ndarray
    """(g, 2) positions of the removed vertices."""
    places: np.ndarray
    """(p, 2) positions of the vertices whose irregularity Delta would change."""
    delta: np.ndarray
    """(p,) their new Delta, 0 for those that become regular. New regular vertices are left out."""

    @property
    def added(self) -> np.ndarray:
        """(n, 2, 2) ends of the new edges."""
        return self.added_edges.ends[:, :, :2]

    @property
    def removed(self) -> np.ndarray:
        """(m, 2, 2) ends of the removed edges."""
        return self.removed_edges.ends[:, :, :2]

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Bounding box as least x, least y, largest x, largest y; zeros if it is empty."""
        edges = [part for part in (self.added_edges, self.removed_edges) if len(part)]
        seen = np.concatenate([*(part.box[:, :2] for part in edges), self.places, self.fresh])
        if not len(seen):
            return 0.0, 0.0, 0.0, 0.0
        (x, y), (right, top) = seen.min(axis=0).tolist(), seen.max(axis=0).tolist()
        return x, y, right, top


def ghost(mesh: HalfEdgeMesh, operation: Operation | str, halfedge: int) -> Ghost:
    """The preview of an operation, with positions before smoothing.

    The mesh is not changed. Raises OperationRefused if the operation is not allowed.
    """
    seen = dry_run(mesh, operation, halfedge)
    shown = (seen.delta != 0) | ~np.isin(seen.vertices, seen.new_vertices)
    return Ghost(
        operation=seen.operation,
        halfedge=halfedge,
        change=seen.score_change,
        added_edges=seen.added_edges,
        removed_edges=seen.removed_edges,
        fresh=seen.new_places[:, :2],
        gone=seen.gone[:, :2],
        places=seen.places[shown, :2],
        delta=seen.delta[shown],
    )


def choices(
    mesh: HalfEdgeMesh, halfedge: int, bar: Callable[[str], str] | None = None
) -> tuple[OperationOffer, ...]:
    """Verdict and change of s of every operation at a live half-edge, in the catalogue's order.

    ``bar`` is :attr:`meshwright.document.document.Document.bar`.
    """
    return tuple(_choice(mesh, info, halfedge, bar) for info in of_kind(mesh.kind))


def _choice(
    mesh: HalfEdgeMesh, info: OperationInfo, halfedge: int, bar: Callable[[str], str] | None
) -> OperationOffer:
    why = bar(info.operation.value) if bar is not None else ""
    verdict = Verdict(BARRED, why.rstrip(".")) if why else mesh.check(info.operation, halfedge)
    if not verdict:
        return OperationOffer(info, verdict, None)
    if not info.score_formula:
        return OperationOffer(info, verdict, tried_change(mesh, info.operation, halfedge))
    code = CODES[mesh.k][info.operation]
    return OperationOffer(info, verdict, int(score_change(mesh.arrays, code, halfedge)))


def best(offered: tuple[OperationOffer, ...]) -> OperationOffer | None:
    """The allowed operation with the lowest change of s, the first of equals; None without any.

    An operation that changes the mesh from boundary to boundary is chosen only if no local one is
    allowed, since pointing at an edge suggests a local change.
    """

    def rank(choice: OperationOffer) -> tuple[bool, int]:
        return not choice.info.is_local, choice.change or 0

    return min((choice for choice in offered if choice.allowed), key=rank, default=None)


def following(
    offered: tuple[OperationOffer, ...], current: Operation | None, step: int
) -> OperationOffer | None:
    """The allowed operation ``step`` places after the current one, in cyclic order."""
    open_to = [choice for choice in offered if choice.allowed]
    if not open_to:
        return None
    at = next((i for i, choice in enumerate(open_to) if choice.operation == current), None)
    if at is None:
        return open_to[0 if step > 0 else -1]
    return open_to[(at + step) % len(open_to)]
