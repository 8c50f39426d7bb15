"""A polygon being drawn: loops of corners, taken back and done again, and what is wrong with it.

Knows no window: the drawing page and its table of coordinates are two views on one sketch.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from app.signals import Signal
from meshcore.errors import MeshError

Place = tuple[float, float]

_NEAR = 1e-9
"""Share of the sketch's size below which two places are one."""


@dataclass(frozen=True)
class Loop:
    """Corners in order; the first loop is the outline, the others are holes."""

    corners: tuple[Place, ...] = ()
    closed: bool = False


@dataclass(frozen=True)
class Problem:
    """A sentence, and the edges to mark: (loop, corner at which the edge begins), and places."""

    words: str
    edges: tuple[tuple[int, int], ...] = ()
    places: tuple[Place, ...] = ()


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
            self._problem = _problem(self._loops)
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
            return f"{_capital(what)} needs at least {more} more."
        return f"Click the first corner to close {what}, or go on."

    def domain(self) -> dict[str, Any]:
        """The polygon as :meth:`meshcore.domain.Domain.from_json` takes it; MeshError if it is not
        complete.
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
        found = _problem((*self._loops[:-1], Loop((*last.corners, place))))
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


def name_of(loop: int) -> str:
    """``the outline``, ``hole 1`` and so on."""
    return "the outline" if loop == 0 else f"hole {loop}"


def _problem(loops: tuple[Loop, ...]) -> Problem:
    crossing = _crossing(loops)
    if crossing is not None:
        return crossing
    outline = loops[0]
    for i, loop in enumerate(loops[1:], start=1):
        if not loop.corners:
            continue
        edges = tuple((i, j) for j in range(len(loop.corners)))
        if not _inside(loop.corners[0], outline.corners):
            return Problem(f"Hole {i} lies outside the outline.", edges, loop.corners)
        for j, other in enumerate(loops[1:], start=1):
            if i != j and other.closed and _inside(loop.corners[0], other.corners):
                return Problem(f"Hole {i} lies inside hole {j}.", edges, loop.corners)
    for i, loop in enumerate(loops):
        if loop.closed and _flat(loop.corners):
            edges = tuple((i, j) for j in range(len(loop.corners)))
            return Problem(f"{_capital(name_of(i))} encloses no area.", edges)
    return Problem("")


def _crossing(loops: tuple[Loop, ...]) -> Problem | None:
    """The first two edges that meet where they should not, and where."""
    owner = [(i, j) for i, loop in enumerate(loops) for j in range(len(loop.corners) - 1)]
    owner += [(i, len(loop.corners) - 1) for i, loop in enumerate(loops) if loop.closed]
    if len(owner) < 2:
        return None
    corners = [loop.corners for loop in loops]
    a = np.array([corners[i][j] for i, j in owner])
    b = np.array([corners[i][(j + 1) % len(corners[i])] for i, j in owner])
    ring = np.array([i for i, _ in owner])
    index = np.array([j for _, j in owner])
    count = np.array([len(corners[i]) for i, _ in owner])
    gap = (index[None] - index[:, None]) % count[:, None]
    chained = np.array([loops[i].closed for i in ring])[:, None] | (
        abs(index[None] - index[:, None]) == 1
    )
    after = (ring[:, None] == ring[None]) & (gap == 1) & chained
    meeting = _meet(a, b) & ~after & ~after.T
    # neighbours share a corner; only one that runs back over the other is wrong
    meeting |= (after & _folds(a, b)) | (after & _folds(a, b)).T
    one, other = np.nonzero(np.triu(meeting, 1))
    if len(one) == 0:
        return None
    e, f = int(one[0]), int(other[0])
    place = _place(a[e], b[e], a[f], b[f])
    spot = f"({place[0]:.4g}, {place[1]:.4g})"
    i, j = owner[e][0], owner[f][0]
    if i == j:
        words = f"{_capital(name_of(i))} crosses or touches itself near {spot}."
    else:
        words = (
            f"{_capital(name_of(max(i, j)))} crosses or touches {name_of(min(i, j))} near {spot}."
        )
    return Problem(words, (owner[e], owner[f]), (place,))


def _side(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Sign of where p lies beside the line from a to b; 0 within rounding of it."""
    u, v = b - a, p - a
    across = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    size = np.abs(u).sum(axis=-1) * np.abs(v).sum(axis=-1)
    sign: np.ndarray = np.where(np.abs(across) <= _NEAR * size, 0.0, np.sign(across))
    return sign


def _meet(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(e, e) whether edges have a point in common."""
    p, q, r, s = a[:, None], b[:, None], a[None], b[None]
    one, other = _side(p, q, r), _side(p, q, s)
    third, fourth = _side(r, s, p), _side(r, s, q)
    proper = (one * other < 0) & (third * fourth < 0)
    touching = (
        ((one == 0) & _between(p, q, r))
        | ((other == 0) & _between(p, q, s))
        | ((third == 0) & _between(r, s, p))
        | ((fourth == 0) & _between(r, s, q))
    )
    result: np.ndarray = proper | touching
    return result


def _between(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
    low, high = np.minimum(a, b), np.maximum(a, b)
    room = _NEAR * (np.abs(low) + np.abs(high) + (high - low))
    inside: np.ndarray = ((p >= low - room) & (p <= high + room)).all(axis=-1)
    return inside


def _folds(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(e, e) whether the second edge runs back along the first."""
    u, v = (b - a)[:, None], (b - a)[None]
    ahead = (u * v).sum(axis=-1)
    result: np.ndarray = (_side(a[:, None], b[:, None], b[:, None] + v) == 0) & (ahead < 0)
    return result


def _place(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> Place:
    u, v, w = b - a, d - c, c - a
    across = u[0] * v[1] - u[1] * v[0]
    if abs(across) > _NEAR * np.abs(u).sum() * np.abs(v).sum():
        share = (w[0] * v[1] - w[1] * v[0]) / across
        return float(a[0] + share * u[0]), float(a[1] + share * u[1])
    middle = np.sort(np.array([a, b, c, d]), axis=0)[1:3].mean(axis=0)
    return float(middle[0]), float(middle[1])


def _inside(place: Place, corners: tuple[Place, ...]) -> bool:
    x, y = place
    inside = False
    for (x1, y1), (x2, y2) in zip(corners, (*corners[1:], *corners[:1]), strict=True):
        if (y1 > y) != (y2 > y) and x < x1 + (y - y1) / (y2 - y1) * (x2 - x1):
            inside = not inside
    return inside


def _flat(corners: tuple[Place, ...]) -> bool:
    p = np.array(corners)
    x, y = (p - p[0]).T
    area = abs(float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y)))
    return area <= _NEAR * float(np.ptp(p, axis=0).max()) ** 2


def _same(one: Place, other: Place) -> bool:
    size = max(abs(n) for n in (*one, *other)) or 1.0
    return all(abs(a - b) <= _NEAR * size for a, b in zip(one, other, strict=True))


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
