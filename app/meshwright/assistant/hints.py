"""Hints: the policy's best operations in the present state of the document."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from meshwright.assistant.run import HintRequest, RunnerProtocol
from meshwright.assistant.worker import PolicyWorker
from meshwright.document.document import Document
from meshwright.signals import Signal
from meshwright_core import HalfEdgeMesh, Operation
from meshwright_core.analysis.dry_run import score_change

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import PolicyAction


class Hinting:
    """Requests hints from the policy, one request at a time; they hold until the document changes.

    ``changed()`` is emitted when :attr:`hints` change.
    """

    def __init__(self, document: Document, worker: PolicyWorker) -> None:
        self.changed = Signal()
        self._document, self._worker = document, worker
        self._question: HintRequest | None = None
        self._hints: tuple[PolicyAction, ...] = ()
        self.next_step: PolicyAction | None = None
        """The hint that *Step* will apply; None if it is not known."""
        self.guide: Callable[[HalfEdgeMesh], tuple[Operation, int] | None] | None = None
        """What leads on in a state of the mesh, for example in a level; it is the first hint."""
        self.guided: PolicyAction | None = None
        """The hint that :attr:`guide` has given."""

    @property
    def hints(self) -> tuple[PolicyAction, ...]:
        """The policy's best few operations in the present state; empty before the first request."""
        return self._hints

    @property
    def asking(self) -> bool:
        """True while a request is pending."""
        return self._question is not None

    def ask(
        self, policy: str, near: np.ndarray | None, seed: int, runner: RunnerProtocol | None
    ) -> None:
        """Request hints, near vertices (n,) if given; nothing happens without a mesh.

        The first one is the next step of ``runner``, or of a new one with ``seed``.
        """
        self.forget()
        mesh = self._document.mesh
        if mesh is not None:
            revision = self._document.revision
            self._question = HintRequest(policy, mesh.copy(), near, revision, seed, runner)
            self._worker.answer(self._question)

    def forget(self) -> None:
        """Remove the hints and ignore the answer to a pending request."""
        self._question = self.next_step = self.guided = None
        if self._hints:
            self._hints = ()
            self.changed.emit()

    def close(self, question: HintRequest) -> bool:
        """End a request; False if it is no longer the pending one."""
        if question is not self._question:
            return False
        self._question = None
        return True

    def show(
        self, choices: tuple[PolicyAction, ...], next_step: PolicyAction | None = None
    ) -> None:
        """Set the hints, and which of them *Step* applies; that of :attr:`guide` comes first."""
        self._hints, self.next_step = self._led(choices), next_step
        self.changed.emit()

    def _led(self, choices: tuple[PolicyAction, ...]) -> tuple[PolicyAction, ...]:
        mesh = self._document.mesh
        known = self.guide(mesh) if self.guide is not None and mesh is not None else None
        if mesh is None or known is None:
            return choices
        operation, halfedge = known
        same = [c for c in choices if (c.operation, c.halfedge) == known]
        if same:
            self.guided = same[0]
        else:
            from meshwright_agent.policy.explanation_types import PolicyAction

            self.guided = PolicyAction(operation, halfedge, 0.0, score_change(mesh, *known))
        others = tuple(choice for choice in choices if choice is not self.guided)
        return (self.guided, *others)[: max(len(choices), 1)]
