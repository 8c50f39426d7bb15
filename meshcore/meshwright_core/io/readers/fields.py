"""Data of mesh files by point and cell: what is kept of them, and what is lost."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from meshwright_core.io.readers.builder import Builder, Placed
from meshwright_core.io.writers.cell_arrays import REGION, SIDE

OURS = ("geometric", "desired_degree")
"""Data by point that we write ourselves."""
_LISTED = 6
_MOST_GROUPS = 1000
"""Different whole numbers of data by cell up to which they are taken for groups."""
_BOOKKEEPING = frozenset(
    {"vtkOriginalCellIds", "vtkGhostType", "vtkGhostLevels", "GlobalCellId", "GlobalElementId"}
)
_TAGS = ("CellEntityIds", "region", "gmsh:physical", "medit:ref", "avsucd:material", "su2:tag")


def keep_point_data(build: Builder, name: str, values: NDArray[np.generic]) -> None:
    """Keep our own data by point; note the name of any other."""
    if name in OURS:
        build.data[name] = np.asarray(values).ravel()
    else:
        build.dropped.append(f"point data {name!r}")


def contents_of(words: Iterable[str]) -> str:
    """What is not kept of a file by the words that it stands under there, as a phrase."""
    listed = sorted(set(words))
    more = len(listed) - _LISTED
    return f"the content of {', '.join(listed[:_LISTED])}" + (
        f" and {more} more" if more > 0 else ""
    )


class CellFields:
    """Takes data by cell: whole numbers become groups of cells, others are noted as lost."""

    def __init__(self, build: Builder, placed: list[Placed], rows: int) -> None:
        """placed: where the cells went, counted through the file; rows: their number there."""
        self._build, self._placed, self._rows = build, placed, rows

    def keep(self, name: str, values: NDArray[np.generic]) -> None:
        """Take an array of one value for each cell of the file."""
        values = np.asarray(values).ravel()
        kept = [one for one in self._placed if one.kind in ("triangle", "quad")]
        edges = [one for one in self._placed if one.kind == "line"]
        if not kept or name in _BOOKKEEPING:
            return
        whole = values.dtype.kind in "biu" and len(values) == self._rows
        if not whole or len(values) == 0:
            self._build.dropped.append(f"cell data {name!r}")
            return
        for prefix, placed in ((REGION, kept), (SIDE, edges)):
            if name.startswith(prefix):
                self._group(name[len(prefix) :], placed, values == 1)
                return
        mine = np.unique(values[np.concatenate([one.which for one in kept])])
        if name == "region":  # of our own files
            for one in kept:
                self._build.number_regions(one, values[one.which])
            return
        marks = values[np.concatenate([one.which for one in edges])] if edges else values[:0]
        if len(mine) > 1 or name in _TAGS:
            if len(mine) > min(_MOST_GROUPS, max(2, self._rows // 2)):
                self._build.dropped.append(f"cell data {name!r}")
                return
            for value in mine.tolist():
                self._group(f"{name}={int(value)}", kept, values == value)
        elif not marks.any():
            self._build.dropped.append(f"cell data {name!r}")
        if len(np.unique(marks)) <= _MOST_GROUPS:
            for value in np.unique(marks[marks != 0]).tolist():
                self._group(f"{name}={int(value)}", edges, values == value)

    def _group(self, name: str, placed: list[Placed], inside: NDArray[np.bool_]) -> None:
        rows = [one._replace(rows=one.rows[inside[one.which]]) for one in placed]
        self._build.group(name, rows)
