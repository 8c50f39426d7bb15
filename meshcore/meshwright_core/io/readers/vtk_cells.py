"""The cells of VTK by their type, and the quads of its structured grids.

After the VTK file formats chapter of the VTK User's Guide and vtkCellType.h.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.builder import Builder, Placed
from meshwright_core.io.readers.numbers import Ints

_EMPTY, _STRIP, _POLYGON, _PIXEL = 0, 6, 7, 8
_KINDS = {
    1: "vertex", 2: "vertex", 3: "line", 4: "line", 5: "triangle", 9: "quad", 10: "tetra",
    11: "voxel", 12: "hexahedron", 13: "wedge", 14: "pyramid", 21: "line", 22: "triangle",
    23: "quad", 24: "tetra", 25: "hexahedron", 28: "quad", 30: "quad", 34: "triangle",
    35: "line", 36: "polygon", 42: "polyhedron", 68: "line", 69: "triangle", 70: "quad",
    75: "line", 76: "triangle", 77: "quad",
}  # fmt: skip
_BY_SIZE = {1: "vertex", 2: "line", 3: "triangle", 4: "quad"}


def add_cells(build: Builder, codes: Ints, sizes: Ints, members: Ints) -> list[Placed]:
    """Add cells by type (m,), number of points (m,), and all points end to end.

    Triangle strips become triangles. `which` of the result counts the cells of the file.
    """
    starts = np.concatenate([[0], np.cumsum(sizes)])[:-1]
    placed: list[Placed] = []
    for code in np.unique(codes).tolist():
        rows = np.flatnonzero(codes == code)
        if code == _EMPTY:
            continue
        for among, nodes in numbers.by_length(members, starts[rows], sizes[rows]):
            if not nodes.shape[1]:
                continue
            where = rows[among]
            if code == _STRIP:
                where, nodes = _strips(where, nodes)
                kind = "triangle"
            elif code == _PIXEL and nodes.shape[1] == 4:
                nodes, kind = nodes[:, [0, 1, 3, 2]], "quad"
            elif code == _POLYGON:
                kind = _BY_SIZE.get(nodes.shape[1], "polygon")
            elif code == 4 and nodes.shape[1] > 2:
                where, nodes = _poly_lines(where, nodes)
                kind = "line"
            else:
                kind = _KINDS.get(code, f"VTK type {code}")
            if len(nodes):
                found = build.cells(kind, nodes)
                placed += [one._replace(which=where[one.which]) for one in found]
    return placed


def _strips(rows: Ints, nodes: Ints) -> tuple[Ints, Ints]:
    """Triangles of strips, alternately turned so that all run the same way."""
    count = nodes.shape[1] - 2
    if count < 1:
        return rows[:0], nodes[:0, :0]
    step = np.arange(count)
    corners = step[:, None] + np.where((step % 2 == 0)[:, None], [0, 1, 2], [1, 0, 2])
    return np.repeat(rows, count), nodes[:, corners].reshape(-1, 3)


def _poly_lines(rows: Ints, nodes: Ints) -> tuple[Ints, Ints]:
    pairs = np.stack([nodes[:, :-1], nodes[:, 1:]], axis=2)
    return np.repeat(rows, nodes.shape[1] - 1), pairs.reshape(-1, 2)


def add_lists(build: Builder, kind: str, sizes: Ints, members: Ints, first: int) -> list[Placed]:
    """Add the cells of a group of polygonal data; `first` counts the cells before them."""
    code = {"VERTICES": 2, "LINES": 4, "POLYGONS": _POLYGON, "TRIANGLE_STRIPS": _STRIP}[kind]
    placed = add_cells(build, np.full(len(sizes), code), sizes, members)
    return [one._replace(which=one.which + first) for one in placed]


def grid_cells(dimensions: tuple[int, int, int]) -> Ints:
    """The quads (m, 4) of a structured grid of so many points, of which one number must be 1.

    Raises MeshError for a grid of cells that are no quads.
    """
    wide = [n for n in dimensions if n != 1]
    if len(wide) != 2 or min(dimensions) < 1:
        shown = " x ".join(map(str, dimensions))
        raise MeshError(f"its grid of {shown} points is not one of quads")
    n, m = wide
    lower = np.arange(n - 1)[None, :] + n * np.arange(m - 1)[:, None]
    corner = lower.ravel()[:, None]
    return np.asarray(corner + [0, 1, n + 1, n], np.int64)


_MOST_POINTS = 20_000_000


def refuse_huge(count: int) -> None:
    """MeshError for a grid whose points are not in the file, if it has too many of them."""
    if count > _MOST_POINTS:
        raise MeshError(f"its grid of {count} points is too large: at most {_MOST_POINTS} are read")
