"""The policy's latest view of the document, and whether it is still valid."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshwright.document.document import Document
from meshwright.signals import Signal

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight


class InsightStore:
    """Stores an insight together with the revision of the document that it describes.

    ``changed()`` is emitted when it is set or cleared.
    """

    def __init__(self, document: Document) -> None:
        self.changed = Signal()
        self._document = document
        self._last: Insight | None = None
        self._at = -1

    @property
    def insight(self) -> Insight | None:
        """The insight for the present state; None if there is none."""
        return self._last if self._at == self._document.revision else None

    @property
    def last(self) -> Insight | None:
        """The insight set last, even if the document has changed since."""
        return self._last

    def see(self, insight: Insight | None) -> None:
        """Set the insight for the present state; None clears it."""
        if insight is not None or self._last is not None:
            self._last, self._at = insight, self._document.revision
            self.changed.emit()
