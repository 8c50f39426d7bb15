"""Collects what a mesh file holds, part by part, into one :class:`Content`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwright_core.core.names import safe
from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content, NamesBuilder
from meshwright_core.io.readers.numbers import Floats, Ints

CORNERS = {"vertex": 1, "line": 2, "triangle": 3, "quad": 4}
"""Corners of the cells that are kept; they come first among the nodes of a cell."""


class Placed(NamedTuple):
    """Where cells of a file went: those numbered `which` as they were added are `rows`."""

    kind: str
    rows: Ints
    which: Ints


class Builder:
    """Points, cells and groups of a file, with points and elements by their numbers in the file.

    Each part has its own numbers of points and elements, from :meth:`part` to the next.
    """

    def __init__(self) -> None:
        self.warnings: list[str] = []
        """What the file says and is not read, a sentence each."""
        self.dropped: list[str] = []
        """Fields of the file that are not kept, a phrase each."""
        self.data: dict[str, NDArray[np.generic]] = {}
        """Data by point, of files of one part."""
        self._points: list[Floats] = []
        self._total = 0
        self._first = 0
        self._ids: Ints | None = None
        self._order: Ints | None = None
        self._cells: dict[str, list[Ints]] = {}
        self._counts: dict[str, int] = {}
        self._regions: dict[str, list[tuple[Ints, Ints]]] = {}
        self._parts: list[tuple[str, bool]] = []
        self._of_part: dict[str, list[Ints]] = {}
        self._elements: list[tuple[Ints, Placed]] = []
        self._groups: list[tuple[str, str, Ints, int | None]] = []
        self._edges: list[tuple[str, Ints, int | None]] = []
        self._sets: list[tuple[str, Ints]] = []
        self._high: dict[int, int] = {}
        self._collapsed = 0

    # -- parts and points --------------------------------------------------------------------------

    def part(self, name: str = "", region: bool = False) -> None:
        """Begin a part, with its own numbers. region: in a file of several it is a region."""
        self._parts.append((name, region))
        self._first, self._ids, self._order = self._total, None, None
        self._elements = []

    @property
    def parts(self) -> int:
        """Parts that have been begun."""
        return len(self._parts)

    @property
    def total(self) -> int:
        """Points of all parts that have been added."""
        return self._total

    def numbered(self) -> list[tuple[Ints, Placed]]:
        """The elements of the part that have numbers, and where they went."""
        return self._elements

    def points(self, points: ArrayLike, ids: Ints | None = None) -> None:
        """Add points (n, 1 to 3) of the part. ids: (n,) their numbers; by default from 0."""
        if not self._parts:
            self.part()
        points = np.asarray(points, dtype=np.float64)
        if points.ndim != 2 or points.shape[1] > 3:
            points = points.reshape(len(points), -1)[:, :3]
        if points.shape[1] < 3:
            points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
        known = self._total - self._first
        if ids is None:
            ids = np.arange(known, known + len(points))
        if known:
            old = np.arange(known) if self._ids is None else self._ids
            self._ids = np.concatenate([old, ids])
        else:
            plain = len(ids) == 0 or (ids[0] == 0 and (np.diff(ids) == 1).all())
            self._ids = None if plain else np.asarray(ids, np.int64)
        self._order = None
        self._points.append(points)
        self._total += len(points)

    def shift(self, offset: Floats, turn: Floats | None = None) -> None:
        """Move the points of the part by `offset` (3,), after turning them by `turn` (3, 3)."""
        if self._total == self._first:
            return
        points = np.concatenate(self._points)
        mine = points[self._first :]
        points[self._first :] = (mine if turn is None else mine @ turn.T) + offset
        self._points = [points]

    def index(self, nodes: ArrayLike) -> Ints:
        """Numbers of points of the part as indices among all; -1 for those that do not exist."""
        nodes = np.asarray(nodes, dtype=np.int64)
        count = self._total - self._first
        if self._ids is None:
            inside = (nodes >= 0) & (nodes < count)
            return np.where(inside, nodes + self._first, -1)
        first = int(self._ids[0])
        if self._order is None and (np.diff(self._ids) == 1).all():
            inside = (nodes >= first) & (nodes < first + count)
            return np.where(inside, nodes - first + self._first, -1)
        if self._order is None:
            self._order = np.argsort(self._ids, kind="stable")
            ordered = self._ids[self._order]
            self._refuse_contradiction(ordered)
        ordered = self._ids[self._order]
        at = np.minimum(np.searchsorted(ordered, nodes), len(ordered) - 1)
        return np.where(ordered[at] == nodes, self._order[at] + self._first, -1)

    def _refuse_contradiction(self, ordered: Ints) -> None:
        """MeshError if a point is given twice, at different places."""
        assert self._order is not None
        twice = np.flatnonzero(ordered[1:] == ordered[:-1])
        if not len(twice):
            return
        points = np.concatenate(self._points)
        self._points = [points]
        mine = points[self._first :]
        apart = (mine[self._order[twice]] != mine[self._order[twice + 1]]).any(axis=1)
        if apart.any():
            number = int(ordered[twice[np.argmax(apart)]])
            raise MeshError(f"it gives point {number} twice, at different places")

    # -- cells and groups --------------------------------------------------------------------------

    def cells(
        self,
        kind: str,
        nodes: ArrayLike,
        ids: Ints | None = None,
        regions: ArrayLike | None = None,
    ) -> list[Placed]:
        """Add cells by the numbers (m, nodes) of their points; return where they went.

        kind: of :data:`CORNERS`, or another, which is refused later with its name. Nodes beyond
        the corners are left out. Quads with a corner that is given twice become triangles.
        ids: (m,) numbers of the elements. regions: (m,) a region number for each.
        """
        nodes = np.atleast_2d(np.asarray(nodes, dtype=np.int64))
        if not len(nodes) or not nodes.size:
            return []
        corners = CORNERS.get(kind, nodes.shape[1])
        if nodes.shape[1] < corners:
            raise MeshError(f"it is damaged: a {kind} has only {nodes.shape[1]} points")
        if nodes.shape[1] > corners and kind in ("triangle", "quad"):
            self._high[nodes.shape[1]] = self._high.get(nodes.shape[1], 0) + len(nodes)
        block = self.index(nodes[:, :corners])
        which = np.arange(len(block))
        placed = []
        if kind == "quad":
            again = (block == np.roll(block, -1, axis=1)) & (block >= 0)
            flat = again.sum(axis=1) == 1
            if flat.any():
                self._collapsed += int(flat.sum())
                keep = ~again[flat]
                placed.append(self._add("triangle", block[flat][keep].reshape(-1, 3), which[flat]))
                block, which = block[~flat], which[~flat]
        if len(block):
            placed.append(self._add(kind, block, which))
        for one in placed:
            if ids is not None:
                self._elements.append((np.asarray(ids, np.int64)[one.which], one))
            if regions is not None:
                self.number_regions(one, np.asarray(regions).ravel()[one.which])
        return placed

    def _add(self, kind: str, block: Ints, which: Ints) -> Placed:
        if not self._parts:
            self.part()
        if kind not in CORNERS:
            block = block[:, :1]  # of what is refused only the number counts
        first = self._counts.get(kind, 0)
        self._counts[kind] = first + len(block)
        self._cells.setdefault(kind, []).append(block)
        self._of_part.setdefault(kind, []).append(np.full(len(block), len(self._parts) - 1))
        return Placed(kind, np.arange(first, first + len(block)), which)

    def group(self, name: str, placed: list[Placed], tag: int | None = None) -> None:
        """Cells are in a named group; lines among them name sides, triangles and quads regions."""
        for kind, rows, _ in placed:
            if kind == "line":
                block = np.concatenate(self._cells["line"])
                self._cells["line"] = [block]
                self._edges.append((name, block[rows], tag))
            elif kind in ("triangle", "quad"):
                self._groups.append((name, kind, rows, tag))

    def number_regions(self, placed: Placed, regions: ArrayLike) -> None:
        """Cells (m,) that have been added are in the regions of these numbers (m,)."""
        numbers = np.asarray(regions).astype(np.int64)
        self._regions.setdefault(placed.kind, []).append((placed.rows, numbers))

    def elements(self, numbers: ArrayLike) -> list[Placed]:
        """Where the elements of the part with these numbers went; unknown ones are left out."""
        numbers = np.asarray(numbers, np.int64)
        found = []
        for ids, placed in self._elements:
            there = np.isin(ids, numbers)
            if there.any():
                found.append(Placed(placed.kind, placed.rows[there], np.flatnonzero(there)))
        return found

    def corners_of(self, placed: Placed) -> Ints:
        """The point indices (m, corners) of cells."""
        block = np.concatenate(self._cells[placed.kind])
        self._cells[placed.kind] = [block]
        return block[placed.rows]

    def edges(self, name: str, nodes: ArrayLike, tag: int | None = None) -> None:
        """Edges (n, 2), by numbers of points of the part, are a named side."""
        found = self.index(np.asarray(nodes, np.int64).reshape(-1, 2))
        self._edges.append((name, found[(found >= 0).all(axis=1)], tag))

    def edge_indices(self, name: str, ends: Ints) -> None:
        """The same by point indices."""
        self._edges.append((name, ends, None))

    def node_set(self, name: str, nodes: ArrayLike) -> None:
        """Points of the part are a named set."""
        found = self.index(np.asarray(nodes, np.int64).ravel())
        self._sets.append((name, found[found >= 0]))

    def point_set(self, name: str, points: Ints) -> None:
        """The same by point indices."""
        self._sets.append((name, points))

    # -- the result --------------------------------------------------------------------------------

    def content(self, **more: Any) -> Content:
        """All that has been added."""
        points = np.concatenate(self._points) if self._points else np.zeros((0, 3))
        cells = {kind: np.concatenate(blocks) for kind, blocks in self._cells.items()}
        named = NamesBuilder(cells)
        for name, kind, rows, tag in self._groups:
            named.add_elements(name, kind, rows, tag)
        of_part = {kind: np.concatenate(blocks) for kind, blocks in self._of_part.items()}
        used = np.unique(np.concatenate([of_part.get(k, ()) for k in ("triangle", "quad")]))
        if len(used) > 1:
            for number in used.astype(int).tolist():
                name, region = self._parts[number]
                if not region:
                    continue
                for kind in ("triangle", "quad"):
                    rows = np.flatnonzero(of_part.get(kind, np.zeros(0)) == number)
                    if len(rows):
                        named.add_elements(name or f"part {number + 1}", kind, rows)
        for name, ends, tag in self._edges:
            named.add_edges(name, ends, tag)
        for name, members in self._sets:
            named.add_points(name, members)
        regions: dict[str, NDArray[np.generic]] = {}
        for kind, pairs in self._regions.items():
            numbers = np.zeros(self._counts[kind], np.int64)
            for rows, values in pairs:
                numbers[rows] = values
            regions[kind] = numbers
        data = {n: v for n, v in self.data.items() if len(v) == len(points)}
        return Content(
            points,
            cells,
            data,
            regions=regions,
            names=named.result(),
            dropped=tuple(dict.fromkeys(self.dropped)),
            warnings=(*self._said(), *dict.fromkeys(self.warnings)),
            parts=of_part,
            part_names=tuple(name for name, _ in self._parts),
            **more,
        )

    def _said(self) -> list[str]:
        said = []
        for nodes, count in sorted(self._high.items()):
            form = "elements of" if count > 1 else "element of"
            said.append(
                f"{count} {form} {nodes} points {'are' if count > 1 else 'is'} read with straight "
                "sides: only the corners are kept"
            )
        if self._collapsed:
            more = self._collapsed > 1
            said.append(
                f"{self._collapsed} quad{'s' if more else ''} with a corner that is given twice "
                f"{'are' if more else 'is'} read as {'triangles' if more else 'a triangle'}"
            )
        names = [one[0] for one in self._groups]
        names += [one[0] for one in self._edges] + [one[0] for one in self._sets]
        for name in dict.fromkeys(names):
            if safe(name) != " ".join(name.split()):
                said.append(f"the name {name[:60]!r} is read as {safe(name)[:60]!r}")
        return said
