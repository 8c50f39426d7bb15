"""Sight: what the policy sees in the present state, as it was told last."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshwright.document.document import Document
from meshwright.signals import Signal

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight


class Sight:
    """An insight, and the state of the document that it is of.

    ``changed()`` is emitted when there is another, or none any more.
    """

    def __init__(self, document: Document) -> None:
        self.changed = Signal()
        self._document = document
        self._last: Insight | None = None
        self._at = -1

    @property
    def insight(self) -> Insight | None:
        """What the policy sees in the present state; None if not known."""
        return self._last if self._at == self._document.revision else None

    @property
    def last(self) -> Insight | None:
        """What was seen last, whatever has moved since then."""
        return self._last

    def see(self, insight: Insight | None) -> None:
        """This is what the policy sees in the present state; None: that is not known."""
        if insight is not None or self._last is not None:
            self._last, self._at = insight, self._document.revision
            self.changed.emit()
