"""Names as arrays of whole numbers by cell, for VTK, VTU and XDMF files.

A group is an array "region:NAME" or "side:NAME", 1 for the cells in it, so that every program can
show it. A group "ARRAY=VALUE" is in the array of that name. Sides are cells of type line.
"""

from __future__ import annotations

from urllib.parse import quote

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.names import numbered
from meshwright_core.io.content import Content
from meshwright_core.io.named_groups import group_edges, group_rows, region_groups, tags_of
from meshwright_core.io.writers import lines as form

_PLAIN = ":=&()[]{}<>,;.+*/!?@#$"
"""Signs that names in legacy VTK files may have."""
REGION, SIDE = "region:", "side:"
"""How the names of the arrays of named groups begin."""


def named_cells(
    content: Content, quoted: bool = False
) -> tuple[dict[str, NDArray[np.int64]], dict[str, list[NDArray[np.int32]]]]:
    """Cells by type, the named edges among them, and data by cell: an array for each type.

    quoted: names without blanks and other signs, as in legacy VTK files.
    """
    kind, elements = form.block(content)
    names = form.names(content)
    cells = {kind: elements}
    ends, place = np.unique(np.sort(names.edges, axis=1), axis=0, return_inverse=True)
    if len(ends):
        cells["line"] = names.edges[np.unique(place.ravel(), return_index=True)[1]]
    counts = [len(block) for block in cells.values()]
    arrays = _Arrays(counts, quoted)
    regions = (content.regions or {}).get(kind)
    if regions is not None:
        arrays.of("region", -1)[0][:] = regions
    for name, rows in group_rows(names, kind).items():
        arrays.put(REGION, name, 0, rows)
    keys = {tuple(pair): row for row, pair in enumerate(ends.tolist())}
    for name, edges in group_edges(names).items():
        members = [keys[a, b] for a, b in np.sort(edges, axis=1).tolist()]
        arrays.put(SIDE, name, 1, np.array(members, np.int64))
    return cells, arrays.data


class _Arrays:
    """Arrays of whole numbers by cell, one for each type of cells."""

    def __init__(self, counts: list[int], quoted: bool) -> None:
        self.data: dict[str, list[NDArray[np.int32]]] = {}
        self._counts, self._quoted = counts, quoted

    def of(self, name: str, rest: int) -> list[NDArray[np.int32]]:
        """The arrays of this name; `rest` is the value of cells that are given none."""
        name = quote(name, safe=_PLAIN) if self._quoted else name
        if name not in self.data:
            self.data[name] = [np.full(count, rest, np.int32) for count in self._counts]
        return self.data[name]

    def put(self, prefix: str, name: str, block: int, rows: NDArray[np.int64]) -> None:
        """The cells `rows` of a type are in a group."""
        called = numbered(name)
        if called is not None and abs(called[1]) < 2**31:
            self.of(called[0], 0)[block][rows] = called[1]
        else:
            self.of(prefix + name, 0)[block][rows] = 1


def referenced_cells(
    content: Content, array: str, edges: bool
) -> tuple[dict[str, NDArray[np.int64]], dict[str, list[NDArray[np.int32]]]]:
    """Cells by type, and one number for each of them: of the region, and of the side of edges.

    Numbers are those of :func:`meshwright_core.io.named_groups.tags_of`, by the whole name.
    """
    kind, elements = form.block(content)
    names = form.names(content)
    groups = region_groups(content, kind, len(elements))
    plain = len(groups.keys) == 1 and not names.regions
    number = np.zeros(len(elements), np.int64) if plain else groups.numbers()
    cells, data = {kind: elements}, [number.astype(np.int32)]
    if edges and len(names.edges):
        side = tags_of(list(names.sides), 1, names.tags)
        cells["line"] = names.edges
        data.append(np.array([side[name] for name in names.sides], np.int32)[names.edge_sides])
    return cells, {array: data}
