"""A polygon being drawn: loops of corners, taken back and done again, and what is wrong with it.

Knows no window: the drawing page and its table of coordinates are two views on one sketch.
"""

from __future__ import annotations

from typing import Any

from meshwright.signals import Signal
from meshwright.sources.polygon_checks import Loop, Place, Problem, name_of, problem_of
from meshwright_core.errors import MeshError, capitalised

_NEAR = 1e-9
"""Share of the sketch's size below which two places are one."""


class Sketch:
    """Loops of corners. ``changed()`` after every edit.

    The last loop may be open: corners are added to it. All edits can be taken back; one that
    goes on, such as a drag, is one edit (`begin`).
    """

    def __init__(self) -> None:
        self.changed = Signal()
        self._loops: tuple[Loop, ...] = (Loop(),)
        self._undone: list[tuple[Loop, ...]] = []
        self._done: list[tuple[Loop, ...]] = []
        self._problem: Problem | None = None

    @property
    def loops(self) -> tuple[Loop, ...]:
        """The outline, then the holes."""
        return self._loops

    @property
    def open(self) -> bool:
        """True while the last loop takes corners."""
        return not self._loops[-1].closed

    @property
    def empty(self) -> bool:
        """True while nothing is drawn."""
        return self._loops == (Loop(),)

    @property
    def complete(self) -> bool:
        """True if every loop is closed and nothing is wrong."""
        return not self.open and self.problem is None

    def corners(self) -> list[tuple[int, int, Place]]:
        """Every corner with its loop and its place in the loop."""
        return [(i, j, p) for i, loop in enumerate(self._loops) for j, p in enumerate(loop.corners)]

    # Edits

    def add(self, place: Place) -> None:
        """Add a corner to the open loop; a place that the last corner has already adds none."""
        last = self._loops[-1]
        if last.closed or (last.corners and _same(last.corners[-1], place)):
            return
        self._put(Loop((*last.corners, place)))

    def close(self) -> bool:
        """Close the open loop if it has three corners."""
        last = self._loops[-1]
        if last.closed or len(last.corners) < 3:
            return False
        self._put(Loop(last.corners, True))
        return True

    def add_hole(self) -> bool:
        """Begin a hole; False while a loop is open."""
        if self.open:
            return False
        self._record()
        self._set((*self._loops, Loop()))
        return True

    def take_back(self) -> None:
        """Open the last loop, or take its last corner away, or the hole that has none."""
        last = self._loops[-1]
        if last.closed:
            self._put(Loop(last.corners))
        elif last.corners:
            self._put(Loop(last.corners[:-1]))
        elif len(self._loops) > 1:
            self._record()
            self._set(self._loops[:-1])

    def begin(self) -> None:
        """Record the state before a drag, which :meth:`move` then changes."""
        self._record()

    def move(self, loop: int, corner: int, place: Place) -> None:
        """Put a corner elsewhere, as part of the edit that began last."""
        corners = list(self._loops[loop].corners)
        if corners[corner] != place:
            corners[corner] = place
            self._replace(loop, corners)

    def set(self, loop: int, corner: int, place: Place) -> None:
        """Put a corner elsewhere, as an edit of its own."""
        if self._loops[loop].corners[corner] != place:
            self._record()
            self.move(loop, corner, place)

    def insert(self, loop: int, corner: int, place: Place) -> None:
        """Put a new corner before another one."""
        self._record()
        corners = list(self._loops[loop].corners)
        corners.insert(corner, place)
        self._replace(loop, corners)

    def remove(self, loop: int, corner: int) -> None:
        """Take a corner away; a loop of fewer than three is open again, or goes if it is not the
        last.
        """
        corners = list(self._loops[loop].corners)
        del corners[corner]
        self._record()
        last = loop == len(self._loops) - 1
        if len(corners) < 3 and not last:
            self._set(tuple(one for i, one in enumerate(self._loops) if i != loop))
            return
        kept = Loop(tuple(corners), self._loops[loop].closed and len(corners) >= 3)
        self._set((*self._loops[:loop], kept, *self._loops[loop + 1 :]))

    def clear(self) -> None:
        """Begin anew."""
        if not self.empty:
            self._record()
            self._set((Loop(),))

    @property
    def can_undo(self) -> bool:
        """True if there is an edit to take back."""
        return bool(self._done)

    @property
    def can_redo(self) -> bool:
        """True if an edit was taken back."""
        return bool(self._undone)

    def undo(self) -> None:
        """Take back the last edit."""
        if self._done:
            self._undone.append(self._loops)
            self._set(self._done.pop())

    def redo(self) -> None:
        """Do again what was taken back last."""
        if self._undone:
            self._done.append(self._loops)
            self._set(self._undone.pop())

    # What is wrong, and what comes out

    @property
    def problem(self) -> Problem | None:
        """What would keep the sketch from being a polygon; too few corners are not yet wrong."""
        if self._problem is None:
            self._problem = problem_of(self._loops)
        return self._problem if self._problem.words else None

    @property
    def words(self) -> str:
        """What is wrong, or what to do next."""
        if self.problem is not None:
            return self.problem.words
        last, what = self._loops[-1], name_of(len(self._loops) - 1)
        if last.closed:
            return ""
        if not last.corners:
            inside = " inside the outline" if len(self._loops) > 1 else ""
            return f"Click{inside} to place the first corner of {what}."
        missing = 3 - len(last.corners)
        if missing > 0:
            more = "one corner" if missing == 1 else f"{missing} corners"
            return f"{capitalised(what)} needs at least {more} more."
        return f"Click the first corner to close {what}, or go on."

    def domain(self) -> dict[str, Any]:
        """The polygon as :meth:`meshwright_core.domains.domain.Domain.from_json` takes it;
        MeshError if it is not complete.
        """
        if not self.complete:
            raise MeshError(self.words)
        outline, *holes = [[list(p) for p in loop.corners] for loop in self._loops]
        return {
            "name": "drawing",
            "outline": outline,
            "holes": holes,
            "corners": [True] * len(outline),
            "hole_corners": [[True] * len(hole) for hole in holes],
        }

    def trial(self, place: Place) -> Problem | None:
        """What would be wrong with one more corner in the open loop, if nothing else is."""
        last = self._loops[-1]
        if last.closed or not last.corners or self.problem is not None:
            return None
        if _same(last.corners[0], place) or _same(last.corners[-1], place):
            return None
        found = problem_of((*self._loops[:-1], Loop((*last.corners, place))))
        return found if found.words else None

    def _put(self, last: Loop) -> None:
        self._record()
        self._set((*self._loops[:-1], last))

    def _replace(self, loop: int, corners: list[Place]) -> None:
        kept = Loop(tuple(corners), self._loops[loop].closed)
        self._set((*self._loops[:loop], kept, *self._loops[loop + 1 :]))

    def _record(self) -> None:
        self._done.append(self._loops)
        self._undone.clear()

    def _set(self, loops: tuple[Loop, ...]) -> None:
        self._loops = loops
        self._problem = None
        self.changed.emit()


def _same(one: Place, other: Place) -> bool:
    size = max(abs(n) for n in (*one, *other)) or 1.0
    return all(abs(a - b) <= _NEAR * size for a, b in zip(one, other, strict=True))
