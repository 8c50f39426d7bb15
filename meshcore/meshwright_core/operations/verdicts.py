"""Results of `check` and `apply`: a verdict with its reason, and the record of an edit."""

from __future__ import annotations

from meshwright_core.core.mesh_view import MeshView
from meshwright_core.operations import refusals
from meshwright_core.operations.catalogue import Operation


class Verdict:
    """True when the operation is allowed; otherwise `reason` is the cause in words."""

    __slots__ = ("code", "reason")

    def __init__(self, code: int, reason: str) -> None:
        """code: one of :mod:`meshwright_core.operations.refusals`; reason: empty if it is
        ALLOWED.
        """
        self.code = code
        self.reason = reason

    @classmethod
    def refused(
        cls, code: int, mesh: MeshView, operation: Operation, h: int, degree_cap: int
    ) -> Verdict:
        """A refusal with its reason in words, which names the end vertices of half-edge h."""
        return cls(code, _sentence(code, mesh, operation, h, degree_cap))

    def __bool__(self) -> bool:
        """Whether the operation is allowed."""
        return self.code == refusals.ALLOWED

    def __repr__(self) -> str:
        """The verdict in words."""
        return f"<Verdict: {self.reason or 'allowed'}>"


YES = Verdict(refusals.ALLOWED, "")
"""The verdict on everything that is allowed."""


def _sentence(code: int, mesh: MeshView, operation: Operation, h: int, degree_cap: int) -> str:
    live = mesh.live(h)
    return refusals.SENTENCES[code].format(
        h=h,
        a=mesh.origin(h) if live else -1,
        b=mesh.target(h) if live else -1,
        cap=degree_cap,
        operation=str(operation),
        kind=mesh.kind,
    )


class Edit:
    """What an applied operation did."""

    __slots__ = ("_new_count", "halfedge", "operation", "score_change", "touched")

    def __init__(
        self,
        operation: Operation | str,
        halfedge: int,
        score_change: int,
        new_count: int,
        touched: tuple[int, ...],
    ) -> None:
        """touched: vertex ids, the `new_count` new ones first."""
        self.operation = operation
        """The operation, as the caller named it."""
        self.halfedge = halfedge
        """The half-edge that it was applied to."""
        self.score_change = score_change
        """Change of s."""
        self.touched = touched
        """Live vertices around which something changed, new ones first; may repeat."""
        self._new_count = new_count

    @property
    def new_vertices(self) -> tuple[int, ...]:
        """Ids of the vertices that came to be."""
        return self.touched[: self._new_count]

    def __repr__(self) -> str:
        """Operation, half-edge and change of s."""
        return f"<Edit {self.operation} at {self.halfedge}: s {self.score_change:+d}>"
