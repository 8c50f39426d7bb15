"""The chord tools of the Blocks view: edits of the selected chord, each one undoable step."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from qtpy.QtCore import Qt

from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.desktop.widgets.wording import step_message
from meshwright.document import block_edits
from meshwright.document.document import PLAN, Document
from meshwright_core import MeshError, Operation
from meshwright_core.blocks.sizing import GridConflictError
from meshwright_core.core.grid_plan import Grading

if TYPE_CHECKING:
    from meshwright.desktop.blocks.blocks_controller import BlocksController

NUDGE = 0.1
"""Share of the way to the next line that a key slides a line."""
SELECT_FIRST = "Select a chord first: click one of its edges."


class ChordTools:
    """Edits of what is selected in ``view``. What is impossible is said in its notice bar."""

    def __init__(self, document: Document, view: BlocksController, status: StatusBar) -> None:
        self._document, self._view, self._status = document, view, status

    def set_count(self, count: int | None) -> None:
        """Give the selected chord a number of cells; None: by size."""
        if self._need_chord() and self._view.planned is not None:
            structure, chord = self._view.planned.structure, self._view.chord
            self._try(lambda: block_edits.set_count(self._document, structure, chord, count))

    def add_cells(self, more: int) -> None:
        """Change the number of cells across the selected chord."""
        planned = self._view.planned
        if self._need_chord() and planned is not None and planned.division is not None:
            self.set_count(max(int(planned.division.counts[self._view.chord]) + more, 1))

    def set_grading(self, grading: Grading | None) -> None:
        """Grade the selected chord; None for even cells or the layers of walls."""
        if self._need_chord() and self._view.planned is not None:
            structure, chord = self._view.planned.structure, self._view.chord
            self._try(lambda: block_edits.set_grading(self._document, structure, chord, grading))

    def set_size(self, size: float) -> None:
        """Set the length of cells, 0 for what the geometry makes of it."""
        plan = self._document.need_mesh().grid_plan
        wanted = replace(plan, size=size or None, divide=None)
        title = f"Cell size {size:g}" if size else "Cell size by geometry"
        self._try(lambda: block_edits.change_plan(self._document, wanted, title))

    def apply(self, operation: Operation) -> None:
        """Apply an operation to the selected edge: the global split that inserts a chord, a ring
        along its loop, or the collapse of the chord.
        """
        if self._need_chord():
            halfedge = self._view.halfedge
            self._try(lambda: self._document.submit(operation, halfedge))

    def nudge(self, share: float) -> None:
        """Slide the line through the selected edge by a share of the way to the next one."""
        if self._need_chord():
            halfedge = self._view.halfedge
            self._try(lambda: block_edits.slide(self._document, halfedge, share))

    def straighten(self) -> None:
        """Make the line through the selected edge straight between its ends."""
        if self._need_chord():
            halfedge = self._view.halfedge
            self._try(lambda: block_edits.straighten(self._document, halfedge))

    def focus_count(self) -> None:
        """Put the keyboard into the field of the number of cells."""
        if self._need_chord():
            self._view.panel.count.setFocus(Qt.FocusReason.ShortcutFocusReason)
            self._view.panel.count.selectAll()

    def focus_grading(self) -> None:
        """Put the keyboard into the field of the first cell."""
        if self._need_chord():
            self._view.panel.first.setFocus(Qt.FocusReason.ShortcutFocusReason)
            self._view.panel.first.selectAll()

    def slide(self, halfedge: int, share: float) -> None:
        """Slide the line through a half-edge, as it was dragged."""
        if abs(share) > 1e-3:
            self._try(lambda: block_edits.slide(self._document, halfedge, share))

    def _try(self, edit: Callable[[], object]) -> None:
        """Do an edit, or say in the notice bar why not, with the chords it is about."""
        done = self._document.history.mark
        try:
            edit()
        except GridConflictError as error:
            self._refuse(str(error), frozenset(error.chords))
        except MeshError as error:
            chord = self._view.chord
            self._refuse(str(error), frozenset([chord] if chord >= 0 else []))
        else:
            if self._document.history.mark != done:
                row = self._document.history.last
                plain = row is not None and row.action == PLAN
                words = f"{row.title}." if row is not None and plain else step_message(row)
                self._status.show_message(words)

    def _refuse(self, words: str, chords: frozenset[int]) -> None:
        self._view.say(words)
        if self._view.layer.shown is not None:
            self._view.layer.show(replace(self._view.layer.shown, wrong=chords))
        self._view.show_selection()  # the fields show what holds

    def _need_view(self) -> bool:
        if not self._view.shown:
            self._view.show(True)
        return self._view.shown

    def _need_chord(self) -> bool:
        if self._need_view() and self._view.chord < 0:
            self._status.show_message(SELECT_FIRST)
        return self._view.chord >= 0
