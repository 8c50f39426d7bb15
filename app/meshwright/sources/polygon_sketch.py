"""A polygon being drawn: loops of corners, with undo and redo, and the checks of the polygon.

Imports no Qt: the drawing page and its table of coordinates are two views of one sketch.
"""

from __future__ import annotations

from typing import Any

from meshwright.signals import Signal
from meshwright.sources.polygon_checks import (
    Place,
    PolygonLoop,
    PolygonProblem,
    name_of,
    problem_of,
)
from meshwright_core.errors import MeshError, capitalised

_NEAR = 1e-9
"""Tolerance, relative to the size of the sketch, below which two points coincide."""


class Sketch:
    """Loops of corners. ``changed()`` after every edit.

    The last loop may be open: corners are added to it. All edits can be undone; a drag is one
    edit (`begin`).
    """

    def __init__(self) -> None:
        self.changed = Signal()
        self._loops: tuple[PolygonLoop, ...] = (PolygonLoop(),)
        self._undone: list[tuple[PolygonLoop, ...]] = []
        self._done: list[tuple[PolygonLoop, ...]] = []
        self._problem: PolygonProblem | None = None

    @property
    def loops(self) -> tuple[PolygonLoop, ...]:
        """The outline, then the holes."""
        return self._loops

    @property
    def open(self) -> bool:
        """True while the last loop is open."""
        return not self._loops[-1].closed

    @property
    def empty(self) -> bool:
        """True while nothing is drawn."""
        return self._loops == (PolygonLoop(),)

    @property
    def complete(self) -> bool:
        """True if every loop is closed and there is no problem."""
        return not self.open and self.problem is None

    def corners(self) -> list[tuple[int, int, Place]]:
        """Every corner as (loop, index in the loop, position)."""
        return [(i, j, p) for i, loop in enumerate(self._loops) for j, p in enumerate(loop.corners)]

    # Edits

    def add(self, place: Place) -> None:
        """Add a corner to the open loop, unless it coincides with the last corner."""
        last = self._loops[-1]
        if last.closed or (last.corners and _same(last.corners[-1], place)):
            return
        self._put(PolygonLoop((*last.corners, place)))

    def close(self) -> bool:
        """Close the open loop if it has three corners."""
        last = self._loops[-1]
        if last.closed or len(last.corners) < 3:
            return False
        self._put(PolygonLoop(last.corners, True))
        return True

    def add_hole(self) -> bool:
        """Begin a hole; False while a loop is open."""
        if self.open:
            return False
        self._record()
        self._set((*self._loops, PolygonLoop()))
        return True

    def take_back(self) -> None:
        """Open the last loop, or remove its last corner, or remove an empty hole."""
        last = self._loops[-1]
        if last.closed:
            self._put(PolygonLoop(last.corners))
        elif last.corners:
            self._put(PolygonLoop(last.corners[:-1]))
        elif len(self._loops) > 1:
            self._record()
            self._set(self._loops[:-1])

    def begin(self) -> None:
        """Record the state before a drag, which :meth:`move` then changes."""
        self._record()

    def move(self, loop: int, corner: int, place: Place) -> None:
        """Move a corner, as part of the edit that began last."""
        corners = list(self._loops[loop].corners)
        if corners[corner] != place:
            corners[corner] = place
            self._replace(loop, corners)

    def set(self, loop: int, corner: int, place: Place) -> None:
        """Move a corner, as a separate edit."""
        if self._loops[loop].corners[corner] != place:
            self._record()
            self.move(loop, corner, place)

    def insert(self, loop: int, corner: int, place: Place) -> None:
        """Insert a corner before another one."""
        self._record()
        corners = list(self._loops[loop].corners)
        corners.insert(corner, place)
        self._replace(loop, corners)

    def remove(self, loop: int, corner: int) -> None:
        """Remove a corner; a loop of fewer than three becomes open, or is removed if it is not the
        last.
        """
        corners = list(self._loops[loop].corners)
        del corners[corner]
        self._record()
        last = loop == len(self._loops) - 1
        if len(corners) < 3 and not last:
            self._set(tuple(one for i, one in enumerate(self._loops) if i != loop))
            return
        kept = PolygonLoop(tuple(corners), self._loops[loop].closed and len(corners) >= 3)
        self._set((*self._loops[:loop], kept, *self._loops[loop + 1 :]))

    def clear(self) -> None:
        """Remove all loops."""
        if not self.empty:
            self._record()
            self._set((PolygonLoop(),))

    @property
    def can_undo(self) -> bool:
        """True if there is an edit to undo."""
        return bool(self._done)

    @property
    def can_redo(self) -> bool:
        """True if there is an edit to redo."""
        return bool(self._undone)

    def undo(self) -> None:
        """Undo the last edit."""
        if self._done:
            self._undone.append(self._loops)
            self._set(self._done.pop())

    def redo(self) -> None:
        """Redo the edit that was undone last."""
        if self._undone:
            self._done.append(self._loops)
            self._set(self._undone.pop())

    # Checks and result

    @property
    def problem(self) -> PolygonProblem | None:
        """The first problem, None if there is none; too few corners do not count as one."""
        if self._problem is None:
            self._problem = problem_of(self._loops)
        return self._problem if self._problem.words else None

    @property
    def words(self) -> str:
        """The sentence of the problem, or a hint on the next corner."""
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
        return f"Click the first corner to close {what}, or add more."

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

    def trial(self, place: Place) -> PolygonProblem | None:
        """The problem that one more corner in the open loop would cause, None if none."""
        last = self._loops[-1]
        if last.closed or not last.corners or self.problem is not None:
            return None
        if _same(last.corners[0], place) or _same(last.corners[-1], place):
            return None
        found = problem_of((*self._loops[:-1], PolygonLoop((*last.corners, place))))
        return found if found.words else None

    def _put(self, last: PolygonLoop) -> None:
        self._record()
        self._set((*self._loops[:-1], last))

    def _replace(self, loop: int, corners: list[Place]) -> None:
        kept = PolygonLoop(tuple(corners), self._loops[loop].closed)
        self._set((*self._loops[:loop], kept, *self._loops[loop + 1 :]))

    def _record(self) -> None:
        self._done.append(self._loops)
        self._undone.clear()

    def _set(self, loops: tuple[PolygonLoop, ...]) -> None:
        self._loops = loops
        self._problem = None
        self.changed.emit()


def _same(one: Place, other: Place) -> bool:
    size = max(abs(n) for n in (*one, *other)) or 1.0
    return all(abs(a - b) <= _NEAR * size for a, b in zip(one, other, strict=True))
