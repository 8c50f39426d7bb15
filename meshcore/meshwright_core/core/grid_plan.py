"""What a user wants of the block grid of a quad mesh; kept with the mesh and its history.

Numbers of cells and gradings belong to block edges, by the ids of their two vertices: those of a
chord carry them all, so that they survive operations elsewhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from meshwright_core.errors import MeshError

Edge = tuple[int, int]
"""The ids of the vertices at its ends."""
MOST = 100_000_000
"""A number of cells or an id in a file is below this."""


class Grading(NamedTuple):
    """How the cells along an edge grow."""

    first: float = 0.0
    """Length of the first cell, at the first vertex; 0 where it is free."""
    last: float = 0.0
    """Length of the last cell, at the second vertex; 0 where it is free."""
    ratio: float = 1.2
    """Growth from one cell to the next, at least 1."""

    @property
    def turned(self) -> Grading:
        """The same seen from the other end."""
        return Grading(self.last, self.first, self.ratio)


class Wall(NamedTuple):
    """Thin cells along a named side."""

    name: str
    """Of the side; "all" for every one."""
    height: float
    """Of the first cell."""
    ratio: float = 1.2
    """Growth from one cell to the next, at least 1."""


@dataclass(frozen=True)
class GridPlan:
    """Wishes for a block grid. Without size and division the geometry decides."""

    size: float | None = None
    """Length of a cell."""
    divide: int | None = None
    """Cells along every block edge, in place of a size."""
    walls: tuple[Wall, ...] = ()
    """Layers at named sides."""
    side_counts: Mapping[str, int] = field(default_factory=dict)
    """Cells on named sides in all."""
    counts: Mapping[Edge, int] = field(default_factory=dict)
    """Cells on block edges, by ends in ascending order; they hold for the whole chord."""
    gradings: Mapping[Edge, Grading] = field(default_factory=dict)
    """Gradings of block edges, in the direction of their ends."""

    @property
    def empty(self) -> bool:
        """Whether nothing is asked for."""
        return self == GridPlan()

    def with_count(self, edges: list[Edge], count: int | None) -> GridPlan:
        """With this number of cells on edges, those of one chord; None for no wish."""
        keys = [_ordered(edge) for edge in edges]
        kept = {edge: n for edge, n in self.counts.items() if edge not in set(keys)}
        if count is not None:
            kept.update(dict.fromkeys(keys, count))
        return replace(self, counts=kept)

    def with_grading(self, edges: list[Edge], grading: Grading | None) -> GridPlan:
        """With this grading on edges, all in the direction of the chord; None for no wish."""
        gone = {_ordered(edge) for edge in edges}
        kept = {edge: g for edge, g in self.gradings.items() if _ordered(edge) not in gone}
        if grading is not None:
            kept.update(dict.fromkeys(edges, grading))
        return replace(self, gradings=kept)

    def with_side_renamed(self, old: str, new: str) -> GridPlan:
        """With the wishes for one side moved to another name; dropped if that is ""."""

        def named(name: str) -> str:
            return new if name == old else name

        return replace(
            self,
            walls=tuple(
                wall._replace(name=named(wall.name)) for wall in self.walls if named(wall.name)
            ),
            side_counts={named(name): n for name, n in self.side_counts.items() if named(name)},
        )

    def kept(self, live: Callable[[int, int], bool]) -> GridPlan:
        """Without the wishes for edges that `live` does not know; itself if there are none."""
        counts = {edge: n for edge, n in self.counts.items() if live(*edge)}
        gradings = {edge: g for edge, g in self.gradings.items() if live(*edge)}
        if len(counts) == len(self.counts) and len(gradings) == len(self.gradings):
            return self
        return replace(self, counts=counts, gradings=gradings)

    def renumbered(self, vertices: np.ndarray) -> GridPlan:
        """The same with new ids of vertices: `vertices` (slots,) maps old ones to them."""

        def new(edge: Edge) -> Edge:
            return int(vertices[edge[0]]), int(vertices[edge[1]])

        alive = self.kept(lambda a, b: max(a, b) < len(vertices) and min(*new((a, b))) >= 0)
        return replace(
            alive,
            counts={_ordered(new(edge)): n for edge, n in alive.counts.items()},
            gradings={new(edge): g for edge, g in alive.gradings.items()},
        )

    def record(self) -> dict[str, Any]:
        """The plan as JSON can hold it."""
        return {
            "size": self.size,
            "divide": self.divide,
            "walls": [list(wall) for wall in self.walls],
            "sides": dict(self.side_counts),
            "counts": [[*edge, count] for edge, count in self.counts.items()],
            "gradings": [[*edge, *grading] for edge, grading in self.gradings.items()],
        }

    @classmethod
    def of_record(cls, record: Any) -> GridPlan:
        """The plan in a record, which may come from a damaged file; MeshError if it is none."""
        try:
            size, divide = record.get("size"), record.get("divide")
            plan = cls(
                None if size is None else _positive(size),
                None if divide is None else _number(divide, 1),
                tuple(
                    Wall(_text(name), _positive(height), _growth(ratio))
                    for name, height, ratio in record.get("walls", ())
                ),
                {_text(name): _number(n, 1) for name, n in record.get("sides", {}).items()},
                {
                    _ordered((_number(a), _number(b))): _number(n, 1)
                    for a, b, n in record.get("counts", ())
                },
                {
                    (_number(a), _number(b)): Grading(_length(x), _length(y), _growth(ratio))
                    for a, b, x, y, ratio in record.get("gradings", ())
                },
            )
        except (ValueError, TypeError, AttributeError, OverflowError) as error:
            raise MeshError("its wishes for a block grid are damaged") from error
        return plan


def _ordered(edge: Edge) -> Edge:
    return min(edge), max(edge)


def _number(value: Any, least: int = 0) -> int:
    if not isinstance(value, int) or isinstance(value, bool) or not least <= value < MOST:
        raise ValueError
    return value


def _length(value: Any) -> float:
    found = float(value)
    if not (math.isfinite(found) and found >= 0.0):
        raise ValueError
    return found


def _positive(value: Any) -> float:
    found = _length(value)
    if not found:
        raise ValueError
    return found


def _growth(value: Any) -> float:
    found = _length(value)
    if found < 1.0:
        raise ValueError
    return found


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError
    return value
