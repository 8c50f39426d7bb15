"""Lets the agent solve a level on a separate copy of its mesh."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum

from meshwright.assistant.assistant import Assistant
from meshwright.assistant.policy_catalogue import label, shipped
from meshwright.assistant.search_runner import Effort
from meshwright.document.document import Document
from meshwright.document.history import History
from meshwright.puzzles.level import Level
from meshwright.signals import Signal
from meshwright_core import Operation

SECONDS = 2.0
"""Time limit of the search, in seconds."""

MakeAssistant = Callable[[Document], Assistant]

_OPERATIONS = frozenset(operation.value for operation in Operation)


class OpponentState(StrEnum):
    """State of the agent's search."""

    ASKED = "asked"
    DONE = "done"
    FAILED = "failed"


class AgentOpponent:
    """Solves ``level`` once, with a separate assistant. ``changed()`` is emitted at the end."""

    def __init__(self, level: Level, make: MakeAssistant) -> None:
        self.changed = Signal()
        self.standing = OpponentState.ASKED
        self.operations: list[tuple[Operation, int]] = []
        self.score = 0
        self.reason = ""
        self._document = Document(level.mesh(), level.title)
        self._document.auto_smooth = False
        policies = shipped(level.kind)
        self.name = label(policies[0]) if policies else "the agent"
        self._assistant: Assistant | None = make(self._document)
        if not self._assistant.policy:
            self._assistant.policy = policies[0] if policies else ""
        self._assistant.failed.connect(self._on_failed)
        self._assistant.message.connect(self._on_message)  # every run ends with such a message
        self._assistant.search(Effort(seconds=SECONDS, coarsen=False))

    def close(self) -> None:
        """Cancel the search if it still runs, and disconnect."""
        assistant, self._assistant = self._assistant, None
        if assistant is not None:
            assistant.failed.disconnect(self._on_failed)
            assistant.message.disconnect(self._on_message)
            assistant.close()

    def _on_message(self, sentence: str) -> None:
        if self._assistant is not None and not self._assistant.running:
            self._end(OpponentState.DONE, sentence)

    def _on_failed(self, sentence: str) -> None:
        self._end(OpponentState.FAILED, sentence)

    def _end(self, standing: OpponentState, reason: str) -> None:
        if self._assistant is None or self.standing is not OpponentState.ASKED:
            return
        self.standing, self.reason = standing, reason
        self.operations = done_in(self._document.history)
        self.score = self._document.score
        self.changed.emit()


def done_in(history: History) -> list[tuple[Operation, int]]:
    """The operations up to the cursor; steps that only move vertices are left out."""
    rows = [history[i] for i in range(history.cursor)]
    return [(Operation(row.action), row.halfedge) for row in rows if row.action in _OPERATIONS]
