"""Snapping of new corners to points, middles of edges, directions and a grid, with guide lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshwright.sources.arc_edges import Place


@dataclass(frozen=True)
class Snap:
    """The snapped position, what it snapped to (``"point"``, ``"middle"``, ``"angle"``, ``"grid"``
    or empty), and guides: lines to show, each from one point to another.
    """

    place: Place
    met: str = ""
    guides: tuple[tuple[Place, Place], ...] = ()


@dataclass(frozen=True)
class Snapper:
    """Settings: snap to points, middles of edges, right angles and a grid; each may be off."""

    grid: float = 0.0
    points: bool = True
    angles: bool = True
    middles: bool = True

    def snap(
        self,
        place: Place,
        reach: float,
        corners: Sequence[Place] = (),
        before: Place | None = None,
        first: Place | None = None,
        behind: Place | None = None,
        middles: Sequence[Place] = (),
    ) -> Snap:
        """Return the snapped position of a corner set at `place`.

        Args:
            place: where the mouse is.
            reach: distance within which a corner snaps.
            corners: all that exist.
            before: the corner where the new edge begins; the edge snaps to the directions of the
                axes, and to right angles with the edge before it.
            first: the first corner of the loop; the new corner snaps to its row and column.
            behind: the corner before `before`.
            middles: those of all edges; a corner within reach goes first.
        """
        for wanted, places, met in (
            (self.points, corners, "point"),
            (self.middles, middles, "middle"),
        ):
            if wanted and (found := _nearest(place, reach, places)) is not None:
                return Snap(found, met)
        lines = self._lines(before, first, behind) if self.angles else []
        hits = sorted(
            (distance, k)
            for k, (start, along) in enumerate(lines)
            if (distance := _distance(place, start, along)) <= reach
        )
        if hits:
            return self._on_lines(place, reach, [lines[k] for _, k in hits])
        if self.grid > 0:
            return Snap(self._on_grid(place), "grid")
        return Snap(place)

    def _lines(
        self, before: Place | None, first: Place | None, behind: Place | None
    ) -> list[tuple[Place, Place]]:
        lines: list[tuple[Place, Place]] = []
        for start in (before, first):
            if start is not None:
                lines += [(start, (1.0, 0.0)), (start, (0.0, 1.0))]
        if before is not None and behind is not None:
            u = np.subtract(before, behind)
            length = float(np.hypot(*u))
            if length > 0 and min(abs(u)) > 1e-9 * length:
                x, y = (u / length).tolist()
                lines.append((before, (-y, x)))
        return lines

    def _on_lines(self, place: Place, reach: float, lines: list[tuple[Place, Place]]) -> Snap:
        start, along = lines[0]
        for other, across in lines[1:]:
            crossing = _crossing(start, along, other, across)
            if crossing is not None and np.hypot(*np.subtract(crossing, place)) <= 1.5 * reach:
                return Snap(crossing, "angle", ((start, crossing), (other, crossing)))
        share = float(np.dot(np.subtract(place, start), along))
        x, y = start[0] + share * along[0], start[1] + share * along[1]
        if self.grid > 0 and 0.0 in along:
            # along an axis, the other coordinate snaps to the grid
            gx, gy = self._on_grid((x, y))
            x, y = (gx, start[1]) if along[1] == 0.0 else (start[0], gy)
        return Snap((x, y), "angle", ((start, (x, y)),))

    def _on_grid(self, place: Place) -> Place:
        # rounded to 12 digits, so that steps of 0.1 give short decimals
        x, y = (float(f"{round(n / self.grid) * self.grid:.12g}") for n in place)
        return x, y


def _nearest(place: Place, reach: float, places: Sequence[Place]) -> Place | None:
    """The nearest of the places that lie within reach."""
    if not places:
        return None
    near = np.asarray(places, float) - place
    apart = np.hypot(near[:, 0], near[:, 1])
    i = int(np.argmin(apart))
    return places[i] if apart[i] <= reach else None


def _distance(place: Place, start: Place, along: Place) -> float:
    x, y = place[0] - start[0], place[1] - start[1]
    return abs(x * along[1] - y * along[0])


def _crossing(start: Place, along: Place, other: Place, across: Place) -> Place | None:
    turn = along[0] * across[1] - along[1] * across[0]
    if abs(turn) < 1e-6:
        return None
    x, y = other[0] - start[0], other[1] - start[1]
    share = (x * across[1] - y * across[0]) / turn
    return start[0] + share * along[0], start[1] + share * along[1]
