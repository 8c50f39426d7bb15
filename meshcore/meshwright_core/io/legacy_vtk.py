"""Legacy VTK files with polygonal data, and others that meshio does not read.

Only the geometry is read, up to the first POINT_DATA or CELL_DATA. After the VTK file formats
chapter of the VTK User's Guide; versions 2.0 to 5.1, text and binary.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content

_TYPES = {
    "bit": "u1",
    "char": "i1",
    "unsigned_char": "u1",
    "short": ">i2",
    "unsigned_short": ">u2",
    "int": ">i4",
    "unsigned_int": ">u4",
    "long": ">i8",
    "unsigned_long": ">u8",
    "float": ">f4",
    "double": ">f8",
    "vtkidtype": ">i8",
    "vtktypeint32": ">i4",
    "vtktypeint64": ">i8",
}
_CELLS = {1: "vertex", 2: "vertex", 3: "line", 4: "line", 5: "triangle", 7: "", 9: "quad"}
_GROUPS = {"VERTICES": "vertex", "LINES": "line", "POLYGONS": "", "TRIANGLE_STRIPS": "strip"}
_BY_SIZE = {3: "triangle", 4: "quad"}


class _Reader:
    """Walks through the bytes of a file, by lines and by arrays."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0
        head = self.line()
        if not head.startswith("# vtk DataFile Version"):
            raise MeshError("it does not begin like a VTK file")
        self.offsets = float(head.split()[-1]) >= 5.0
        self.line()
        coding = self.words()
        if coding not in (["ASCII"], ["BINARY"]):
            raise MeshError("its third line is neither ASCII nor BINARY")
        self.binary = coding == ["BINARY"]

    def line(self) -> str:
        end = self.data.find(b"\n", self.at)
        end = len(self.data) if end < 0 else end
        text = self.data[self.at : end].decode("latin-1").strip()
        self.at = end + 1
        return text

    def words(self) -> list[str]:
        """Return the words of the next line that has any; none at the end of the file."""
        while self.at < len(self.data):
            words = self.line().split()
            if words:
                return words
        return []

    def array(self, count: int, kind: str) -> NDArray[np.generic]:
        code = _TYPES.get(kind.lower())
        if code is None:
            raise MeshError(f"it holds numbers of the unknown type {kind!r}")
        if self.binary:
            values = np.frombuffer(self.data, code, count, self.at)
            self.at += values.nbytes
            return values
        words: list[str] = []
        while len(words) < count:
            more = self.words()
            if not more:
                raise MeshError("it is cut off")
            words += more
        if len(words) > count:
            raise MeshError("a list of numbers is longer than announced")
        return np.array(words).astype(code)

    def titled(self, title: str, count: int) -> NDArray[np.int64]:
        match self.words():
            case [found, kind] if found == title:
                return self.array(count, kind).astype(np.int64)
        raise MeshError(f"it is cut off or damaged: {title} is missing")

    def lists(self, first: int, second: int) -> list[NDArray[np.int64]]:
        """Return the point lists of cells in either of the two layouts."""
        if not self.offsets:
            flat = self.array(second, "int").astype(np.int64)
            found, at = [], 0
            for _ in range(first):
                found.append(flat[at + 1 : at + 1 + int(flat[at])])
                at += 1 + int(flat[at])
            return found
        cuts = self.titled("OFFSETS", first)
        flat = self.titled("CONNECTIVITY", second)
        return np.split(flat, cuts[1:-1]) if first > 1 else []


def read(data: bytes) -> Content:
    """Return the points and cells of a legacy VTK file, POLYDATA or UNSTRUCTURED_GRID.

    Raises:
        MeshError: it is another dataset, holds triangle strips, or is damaged.
    """
    reader = _Reader(data)
    dataset = reader.words()
    if dataset not in (["DATASET", "POLYDATA"], ["DATASET", "UNSTRUCTURED_GRID"]):
        raise MeshError(f"a VTK {' '.join(dataset[1:]) or 'file without dataset'} is not read")
    points = np.empty((0, 3))
    found: dict[str, list[NDArray[np.int64]]] = {}
    lists: list[NDArray[np.int64]] = []
    while words := reader.words():
        match words:
            case ["POINTS", count, kind]:
                points = reader.array(3 * int(count), kind).astype(float).reshape(-1, 3)
            case ["METADATA", *_]:
                while reader.line():
                    pass
            case ["FIELD", _, count]:
                for _ in range(int(count)):
                    _name, width, rows, kind = reader.words()
                    reader.array(int(width) * int(rows), kind)
            case ["CELLS", first, second]:
                lists = reader.lists(int(first), int(second))
            case ["CELL_TYPES", count]:
                codes = reader.array(int(count), "int").tolist()
                for code, cell in zip(codes, lists, strict=True):
                    _add(found, _CELLS.get(code, f"VTK type {code}"), cell)
            case [group, first, second] if group in _GROUPS:
                for cell in reader.lists(int(first), int(second)):
                    _add(found, _GROUPS[group], cell)
            case ["POINT_DATA" | "CELL_DATA", *_]:
                break
            case _:
                raise MeshError(f"it has an unknown section {words[0][:20]!r}")
    cells = {
        kind: np.array(block) if kind in ("triangle", "quad") else np.zeros((len(block), 1), int)
        for kind, block in found.items()
    }
    return Content(points, cells, {})


def _add(found: dict[str, list[NDArray[np.int64]]], kind: str, cell: NDArray[np.int64]) -> None:
    """File a cell under its kind; a polygon, kind "", goes by its number of corners."""
    found.setdefault(kind or _BY_SIZE.get(len(cell), "polygon"), []).append(cell)
