"""A shape being drawn: loops of segments and arcs, with undo and redo, and their checks.

Imports no Qt: the drawing page and its table of coordinates are two views of one sketch.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from meshwright.signals import Signal
from meshwright.sources.arc_edges import (
    Place,
    bulge_through,
    circle_of,
    middle_of,
    part_of,
    share_at,
)
from meshwright.sources.polygon_checks import (
    PolygonLoop,
    PolygonProblem,
    name_of,
    problem_of,
)
from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError, capitalised

_NEAR = 1e-9
"""Tolerance, relative to the size of the sketch, below which two points coincide."""


class Sketch:
    """Loops of corners with segments and arcs between them. ``changed()`` after every edit.

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

    def centres(self) -> list[Place]:
        """The centres of all arcs."""
        return [
            circle_of(*loop.ends(edge), loop.bulge(edge))[0]
            for loop in self._loops
            for edge in loop.edges
            if loop.bulge(edge)
        ]

    def middles(self, apart_from: tuple[int, int] | None = None) -> list[Place]:
        """The middles of all edges, but not of those at the corner `apart_from` (loop, corner)."""
        found = []
        for i, loop in enumerate(self._loops):
            for edge in loop.edges:
                ends = edge, (edge + 1) % len(loop.corners)
                if apart_from is None or apart_from[0] != i or apart_from[1] not in ends:
                    found.append(middle_of(*loop.ends(edge), loop.bulge(edge)))
        return found

    # Edits

    def add(self, place: Place, bulge: float = 0.0) -> None:
        """Add a corner to the open loop, unless it coincides with the last corner; ``bulge`` is
        that of the edge to it.
        """
        last = self._loops[-1]
        if last.closed or (last.corners and _same(last.corners[-1], place)):
            return
        bulges = _with(last, len(last.corners) - 1, bulge) if last.corners else ()
        self._put(PolygonLoop((*last.corners, place), False, bulges))

    def close(self, bulge: float = 0.0) -> bool:
        """Close the open loop by an edge; it needs three corners, or two and an arc."""
        last = self._loops[-1]
        if last.closed or not last.corners:
            return False
        closed = PolygonLoop(last.corners, True, _with(last, len(last.corners) - 1, bulge))
        if len(last.corners) < (2 if closed.curved else 3):
            return False
        self._put(closed)
        return True

    def add_loop(self, corners: Sequence[Place], bulges: Sequence[float] = ()) -> bool:
        """Add a closed loop, as the outline if there is none, otherwise as a hole; False while a
        loop has been begun.
        """
        last = self._loops[-1]
        if not last.closed and last.corners:
            return False
        made = PolygonLoop(tuple(corners), True, _trimmed(bulges))
        self._record()
        self._set((*(self._loops if last.closed else self._loops[:-1]), made))
        return True

    def put(self, loops: Iterable[PolygonLoop]) -> None:
        """Replace all loops, for example by those of a drawing that was kept."""
        made = tuple(loops) or (PolygonLoop(),)
        if made != self._loops:
            self._record()
            self._set(made)

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
        count = len(last.corners)
        if last.closed:
            self._put(PolygonLoop(last.corners, False, _trimmed(last.bulges[: count - 1])))
        elif last.corners:
            bulges = _trimmed(last.bulges[: max(count - 2, 0)])
            self._put(PolygonLoop(last.corners[:-1], False, bulges))
        elif len(self._loops) > 1:
            self._record()
            self._set(self._loops[:-1])

    def to_json(self) -> list[dict[str, Any]]:
        """The loops as :meth:`put_json` takes them."""
        return [
            {"corners": loop.corners, "closed": loop.closed, "bulges": loop.bulges}
            for loop in self._loops
        ]

    def put_json(self, content: Any) -> None:
        """Replace all loops by what :meth:`to_json` returned; ValueError if that is damaged."""
        try:
            loops = [
                PolygonLoop(
                    tuple((float(x), float(y)) for x, y in one["corners"]),
                    bool(one["closed"]),
                    tuple(float(bulge) for bulge in one["bulges"]),
                )
                for one in content
            ]
        except (TypeError, KeyError) as error:
            raise ValueError(f"This is no drawing: {error}") from error
        if all(loop.closed for loop in loops[:-1]):
            self.put(loops)

    def begin(self) -> None:
        """Record the state before a drag, which :meth:`move` then changes."""
        self._record()

    def move(self, loop: int, corner: int, place: Place) -> None:
        """Move a corner, as part of the edit that began last."""
        corners = list(self._loops[loop].corners)
        if corners[corner] != place:
            corners[corner] = place
            self._replace(loop, corners, self._loops[loop].bulges)

    def set(self, loop: int, corner: int, place: Place) -> None:
        """Move a corner, as a separate edit."""
        if self._loops[loop].corners[corner] != place:
            self._record()
            self.move(loop, corner, place)

    def insert(self, loop: int, corner: int, place: Place) -> None:
        """Insert a corner before another one, on the edge between them."""
        self._record()
        before = self._loops[loop]
        corners, bulges = list(before.corners), _filled(before)
        bulge = bulges[corner - 1]
        share = share_at(*before.ends(corner - 1), bulge, place)
        corners.insert(corner, place)
        bulges[corner - 1 : corner] = [part_of(bulge, share), part_of(bulge, 1.0 - share)]
        self._replace(loop, corners, bulges)

    def remove(self, loop: int, corner: int) -> None:
        """Remove a corner; a loop of fewer than three becomes open, or is removed if it is not the
        last.
        """
        before = self._loops[loop]
        corners, bulges = list(before.corners), _filled(before)
        if bulges[corner - 1] and bulges[corner] and len(corners) > 2:
            a, b = corners[corner - 1], corners[(corner + 1) % len(corners)]
            bulges[corner - 1] = bulge_through(a, corners[corner], b)
        else:
            bulges[corner - 1] = 0.0
        del corners[corner], bulges[corner]
        self._record()
        last = loop == len(self._loops) - 1
        least = 2 if any(bulges) else 3
        if len(corners) < least and not last:
            self._set(tuple(one for i, one in enumerate(self._loops) if i != loop))
            return
        if len(corners) < least or not before.closed:
            kept = PolygonLoop(tuple(corners), False, _trimmed(bulges[: max(len(corners) - 1, 0)]))
        else:
            kept = PolygonLoop(tuple(corners), True, _trimmed(bulges))
        self._set((*self._loops[:loop], kept, *self._loops[loop + 1 :]))

    def bend(self, loop: int, edge: int, bulge: float) -> None:
        """Set the bulge of an edge, as a separate edit."""
        before = self._loops[loop]
        if before.bulge(edge) != bulge:
            self._record()
            self._replace(loop, before.corners, _with(before, edge, bulge))

    def scale_circle(self, loop: int, radius: float) -> None:
        """Set the radius of a circle, as a separate edit; the centre stays."""
        one = self._loops[loop]
        (x, y), present = circle_of(*one.ends(0), one.bulge(0))
        ratio = radius / present
        corners = [(x + ratio * (a - x), y + ratio * (b - y)) for a, b in one.corners]
        self._record()
        self._replace(loop, corners, one.bulges)

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
        missing = (2 if last.curved else 3) - len(last.corners)
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
        if any(loop.curved for loop in self._loops):
            rim, *inner = [_pieces(loop) for loop in self._loops]
            return {"name": "drawing", "outline": rim, "holes": inner}
        outline, *holes = [[list(p) for p in loop.corners] for loop in self._loops]
        return {
            "name": "drawing",
            "outline": outline,
            "holes": holes,
            "corners": [True] * len(outline),
            "hole_corners": [[True] * len(hole) for hole in holes],
        }

    def trial(self, place: Place, bulge: float = 0.0) -> PolygonProblem | None:
        """The problem that one more corner in the open loop would cause, None if none."""
        last = self._loops[-1]
        if last.closed or not last.corners or self.problem is not None:
            return None
        if _same(last.corners[0], place) or _same(last.corners[-1], place):
            return None
        bulges = _with(last, len(last.corners) - 1, bulge)
        found = problem_of((*self._loops[:-1], PolygonLoop((*last.corners, place), False, bulges)))
        return found if found.words else None

    def _put(self, last: PolygonLoop) -> None:
        self._record()
        self._set((*self._loops[:-1], last))

    def _replace(self, loop: int, corners: Sequence[Place], bulges: Sequence[float]) -> None:
        kept = PolygonLoop(tuple(corners), self._loops[loop].closed, _trimmed(bulges))
        self._set((*self._loops[:loop], kept, *self._loops[loop + 1 :]))

    def _record(self) -> None:
        self._done.append(self._loops)
        self._undone.clear()

    def _set(self, loops: tuple[PolygonLoop, ...]) -> None:
        self._loops = loops
        self._problem = None
        self.changed.emit()


def _trimmed(bulges: Sequence[float]) -> tuple[float, ...]:
    """Bulges without zeros at the end."""
    kept = list(bulges)
    while kept and kept[-1] == 0.0:
        kept.pop()
    return tuple(kept)


def _filled(loop: PolygonLoop) -> list[float]:
    """One bulge for each corner."""
    return [loop.bulge(edge) for edge in range(len(loop.corners))]


def _with(loop: PolygonLoop, edge: int, bulge: float) -> tuple[float, ...]:
    """The bulges of a loop with another one for an edge."""
    bulges = _filled(loop)
    bulges[edge] = bulge
    return _trimmed(bulges)


def _pieces(loop: PolygonLoop) -> list[dict[str, Any]]:
    """A loop as the pieces that a domain file holds."""
    made = []
    for edge in loop.edges:
        a, b, bulge = *loop.ends(edge), loop.bulge(edge)
        curve = Curve.arc_by_bulge(a, b, bulge) if bulge else Curve.line(a, b)
        made.append(curve.to_json())
    return made


def _same(one: Place, other: Place) -> bool:
    size = max(abs(n) for n in (*one, *other)) or 1.0
    return all(abs(a - b) <= _NEAR * size for a, b in zip(one, other, strict=True))
