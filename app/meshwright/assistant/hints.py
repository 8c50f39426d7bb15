"""Hints: what the policy would do in the present state, asked for by a person."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright.assistant.run import Question
from meshwright.assistant.worker import Worker
from meshwright.document.document import Document
from meshwright.signals import Signal

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import PolicyAction


class Hinting:
    """One question at a time, whose answer holds until the document changes.

    ``changed()`` is emitted when :attr:`hints` are others.
    """

    def __init__(self, document: Document, worker: Worker) -> None:
        self.changed = Signal()
        self._document, self._worker = document, worker
        self._question: Question | None = None
        self._hints: tuple[PolicyAction, ...] = ()

    @property
    def hints(self) -> tuple[PolicyAction, ...]:
        """The policy's best few operations in the present state; empty before it is asked."""
        return self._hints

    @property
    def asking(self) -> bool:
        """True while the policy is asked."""
        return self._question is not None

    def ask(self, policy: str, near: np.ndarray | None) -> None:
        """Ask the policy; the document must have a mesh."""
        self.forget()
        mesh = self._document.mesh
        if mesh is not None:
            self._question = Question(policy, mesh.copy(), near, self._document.revision)
            self._worker.answer(self._question)

    def forget(self) -> None:
        """Take the hints away, and do not wait for those that are on their way."""
        self._question = None
        if self._hints:
            self._hints = ()
            self.changed.emit()

    def close(self, question: Question) -> bool:
        """The question is answered, or cannot be; False if nobody waits for that any more."""
        if question is not self._question:
            return False
        self._question = None
        return True

    def show(self, choices: tuple[PolicyAction, ...]) -> None:
        """These are the hints now."""
        self._hints = choices
        self.changed.emit()
