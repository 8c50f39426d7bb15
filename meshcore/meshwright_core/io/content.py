"""What readers hand over and writers take: points, cells, names, and what of a file is not kept."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwright_core.core.names import joined, safe

Cells = dict[str, NDArray[np.int64]]


@dataclass(frozen=True, eq=False)
class Names:
    """The named groups of a mesh file.

    A cell or edge of several groups has them all in one name, joined by
    :func:`meshwright_core.core.names.joined`.
    """

    regions: tuple[str, ...] = ()
    """The names of regions."""
    elements: dict[str, NDArray[np.int64]] = field(default_factory=dict)
    """By type of cell, the row in `regions` of each cell, -1 for none."""
    sides: tuple[str, ...] = ()
    """The names of sides."""
    edges: NDArray[np.int64] = field(default_factory=lambda: np.zeros((0, 2), np.int64))
    """(n, 2) point indices of the ends of named edges, in any direction."""
    edge_sides: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    """(n,) the row in `sides` of each edge."""
    points: dict[str, NDArray[np.int64]] = field(default_factory=dict)
    """Named sets of points; an edge of the boundary with both ends in one has its name."""
    tags: dict[tuple[int, str], int] = field(default_factory=dict)
    """The number that a file gives to a name, by (dimension, name): 1 of sides, 2 of regions."""


class Content(NamedTuple):
    """What a mesh file holds."""

    points: NDArray[np.float64]
    """(n, 2 or 3) coordinates."""
    cells: Cells
    """Cells by type, (m, nodes) point indices."""
    data: dict[str, NDArray[np.generic]]
    """Data by point."""
    regions: dict[str, NDArray[np.generic]] | None = None
    """The number of the region of each cell by type, where a file has no names."""
    names: Names | None = None
    """The named groups, where there are any."""
    dropped: tuple[str, ...] = ()
    """What of the file is not kept, such as fields: a phrase each, "point data 'height'"."""
    warnings: tuple[str, ...] = ()
    """What the reader warns of: a sentence each, without the path."""
    parts: dict[str, NDArray[np.int64]] = {}  # noqa: RUF012 - never written
    """By type of cell, the part of the file of each cell, a row in `part_names`."""
    part_names: tuple[str, ...] = ()
    """The names of the parts of the file, such as zones, pieces or instances; "" for none."""


class NamesBuilder:
    """Collects groups, which may overlap, in any order, and makes :class:`Names` of them.

    >>> names = NamesBuilder(cells)
    >>> names.add_elements("steel", "quad", [0, 1, 2], tag=3)
    >>> names.add_edges("inlet", [(0, 4), (4, 8)])
    >>> content = Content(points, cells, {}, names=names.result())
    """

    def __init__(self, cells: Cells) -> None:
        """cells: the cells by type of the content to be; only their numbers are looked at."""
        self._counts = {kind: len(block) for kind, block in cells.items()}
        self._elements: list[tuple[str, str, NDArray[np.int64]]] = []
        self._edges: list[tuple[str, NDArray[np.int64]]] = []
        self._points: dict[str, NDArray[np.int64]] = {}
        self._tags: dict[tuple[int, str], int] = {}

    def add_elements(self, name: str, kind: str, rows: ArrayLike, tag: int | None = None) -> None:
        """The cells `rows` of type `kind` are in the group."""
        name = safe(name)
        self._elements.append((name, kind, np.asarray(rows, np.int64).ravel()))
        if tag is not None:
            self._tags[2, name] = int(tag)

    def add_numbers(self, array: str, kind: str, values: ArrayLike) -> None:
        """The cells of type `kind` are in groups by an array of whole numbers: "array=value"."""
        values = np.asarray(values).ravel()
        for value in np.unique(values).tolist():
            self.add_elements(f"{array}={int(value)}", kind, np.flatnonzero(values == value))

    def add_edges(self, name: str, edges: ArrayLike, tag: int | None = None) -> None:
        """The edges (n, 2), by point indices, are in the group."""
        name = safe(name)
        self._edges.append((name, np.asarray(edges, np.int64).reshape(-1, 2)))
        if tag is not None:
            self._tags[1, name] = int(tag)

    def add_points(self, name: str, points: ArrayLike) -> None:
        """The points are in the group."""
        there = self._points.get(safe(name), np.zeros(0, np.int64))
        self._points[safe(name)] = np.union1d(there, np.asarray(points, np.int64).ravel())

    def result(self) -> Names | None:
        """The names; None if no group has been added."""
        if not (self._elements or self._edges or self._points):
            return None
        regions: dict[str, int] = {}
        elements = {}
        for kind in dict.fromkeys(kind for _, kind, _ in self._elements):
            groups = [(name, rows) for name, there, rows in self._elements if there == kind]
            elements[kind] = _overlapped(groups, self._counts.get(kind, 0), regions)
        ends = np.concatenate([np.zeros((0, 2), np.int64), *(ends for _, ends in self._edges)])
        edges, row = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True)
        sides: dict[str, int] = {}
        stops = np.cumsum([0, *(len(ends) for _, ends in self._edges)])
        parts = zip(self._edges, stops[:-1], stops[1:], strict=True)
        groups = [(name, row.ravel()[a:b]) for (name, _), a, b in parts]
        named = _overlapped(groups, len(edges), sides)
        return Names(tuple(regions), elements, tuple(sides), edges, named, self._points, self._tags)


def _overlapped(
    groups: Sequence[tuple[str, NDArray[np.int64]]], count: int, numbers: dict[str, int]
) -> NDArray[np.int64]:
    """The number (count,) of the name of each thing, by groups of them that may overlap.

    New names are entered into `numbers`, those of things in several groups joined; -1 is none.
    """
    found = np.full(count, -1, np.int64)
    spelled: list[tuple[str, ...]] = [()]
    code = {(): 0}
    state = np.zeros(count, np.int64)
    for name, rows in groups:
        rows = rows[(rows >= 0) & (rows < count)]
        old, place = np.unique(state[rows], return_inverse=True)
        new = []
        for one in old.tolist():
            key = tuple(dict.fromkeys((*spelled[one], name)))
            if key not in code:
                code[key] = len(spelled)
                spelled.append(key)
            new.append(code[key])
        state[rows] = np.array(new, np.int64)[place.ravel()] if len(rows) else state[rows]
    for one in np.unique(state).tolist():
        if spelled[one]:
            text = joined(spelled[one])
            found[state == one] = numbers.setdefault(text, len(numbers))
    return found
