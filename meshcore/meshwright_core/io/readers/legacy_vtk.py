"""Legacy VTK files: polygonal data, unstructured, structured and rectilinear grids, images.

After the VTK file formats chapter of the VTK User's Guide; versions 1.0 to 5.1, text and binary.
Of the data only whole numbers by cell, which may be regions, and our own data by point are kept.
"""

from __future__ import annotations

from collections.abc import Callable
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers, vtk_cells
from meshwright_core.io.readers.builder import Builder, Placed
from meshwright_core.io.readers.fields import CellFields, keep_point_data
from meshwright_core.io.readers.numbers import CUT_OFF, Ints
from meshwright_core.io.readers.words import Words

_TYPES = {
    "char": "i1", "signed_char": "i1", "unsigned_char": "u1", "short": "i2",
    "unsigned_short": "u2", "int": "i4", "unsigned_int": "u4", "long": "i8", "unsigned_long": "u8",
    "long_long": "i8", "unsigned_long_long": "u8", "float": "f4", "double": "f8",
    "vtkidtype": "i8", "vtktypeint8": "i1", "vtktypeuint8": "u1", "vtktypeint16": "i2",
    "vtktypeuint16": "u2", "vtktypeint32": "i4", "vtktypeuint32": "u4", "vtktypeint64": "i8",
    "vtktypeuint64": "u8", "vtktypefloat32": "f4", "vtktypefloat64": "f8",
}  # fmt: skip
_GROUPS = ("VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS")
_WIDTHS = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "TENSORS6": 6, "GLOBAL_IDS": 1,
           "PEDIGREE_IDS": 1, "EDGE_FLAGS": 1}  # fmt: skip
_MOST = 64
"""Components of an array of scalars, at most."""


class _UnknownType(MeshError):
    """An array of a type that is not known, so that its end is not known either."""


def read(data: bytes) -> Content:
    """Return the content of a legacy VTK file.

    Raises:
        MeshError: a grid of cells that are no quads, an unknown dataset, or damage.
    """
    return _Reader(data).content()


class _Reader:
    def __init__(self, data: bytes) -> None:
        self.words = Words(numbers.without_mark(data))
        head = self.words.line()
        if not head.startswith("# vtk DataFile Version"):
            raise MeshError("it does not begin like a VTK file")
        version = numbers.floats(head.split()[-1].encode())
        self.offsets = len(version) > 0 and version[0] >= 5.0
        self.words.line()
        coding = [word.upper() for word in self.words.words()]
        if coding not in (["ASCII"], ["BINARY"]):
            raise MeshError("its third line is neither ASCII nor BINARY")
        self.words.binary = coding == ["BINARY"]
        self.words.order = ">"
        self.build = Builder()
        self.placed: list[Placed] = []
        self.fields: CellFields | None = None
        self.points = 0
        self.rows = 0
        self.lists: tuple[Ints, Ints] = (np.zeros(0, np.int64), np.zeros(0, np.int64))

    def content(self) -> Content:
        dataset = [word.upper() for word in self.words.words()]
        known = ("POLYDATA", "UNSTRUCTURED_GRID", "STRUCTURED_GRID", "RECTILINEAR_GRID",
                 "STRUCTURED_POINTS")  # fmt: skip
        if dataset == ["FIELD"] or dataset[:1] == ["FIELD"]:  # data of the file before its dataset
            self.words.at = self.words.data.upper().find(b"DATASET ", self.words.at)
            dataset = [word.upper() for word in self.words.words()]
        if len(dataset) != 2 or dataset[0] != "DATASET" or dataset[1] not in known:
            raise MeshError(f"a VTK {' '.join(dataset[1:]) or 'file without dataset'} is not read")
        self._geometry(dataset[1])
        try:
            self._data()
        except _UnknownType as error:
            self.build.warnings.append(f"the data behind its mesh is not read: {error}")
        return self.build.content()

    def _geometry(self, dataset: str) -> None:
        """Read up to the first data by point or cell."""
        words, axes = self.words, {}
        dimensions: tuple[int, int, int] | None = None
        origin, spacing = np.zeros(3), np.ones(3)
        codes: Ints | None = None
        while True:
            words.skip_line_end()
            start = words.at
            line = words.words()
            match [line[0].upper(), *line[1:]] if line else []:
                case []:
                    break
                case ["POINT_DATA" | "CELL_DATA", *_]:
                    words.at = start
                    break
                case ["POINTS", count, kind]:
                    self.points = numbers.count_of(count, words.left())
                    self.build.points(self._array(3 * self.points, kind).reshape(-1, 3))
                case ["METADATA", *_]:
                    self._metadata()
                case ["FIELD", _, count]:
                    self._field(numbers.count_of(count, words.left()), None)
                case ["DIMENSIONS", *sizes] if len(sizes) == 3:
                    a, b, c = (numbers.count_of(size, 2**40) for size in sizes)
                    dimensions = (a, b, c)
                case ["ORIGIN", *values] if len(values) == 3:
                    origin = numbers.floats(" ".join(values).encode())
                case ["SPACING" | "ASPECT_RATIO", *values] if len(values) == 3:
                    spacing = numbers.floats(" ".join(values).encode())
                case [("X_COORDINATES" | "Y_COORDINATES" | "Z_COORDINATES") as axis, count, kind]:
                    size = numbers.count_of(count, words.left())
                    axes[axis[0]] = self._array(size, kind).astype(float)
                case ["BLANKING", *_]:
                    raise MeshError("a grid with blanked points is not read")
                case ["CELLS", first, second]:
                    self.lists = self._lists(first, second)
                case ["CELL_TYPES", count]:
                    codes = self._array(numbers.count_of(count, words.left()), "int").astype(int)
                case [("VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS") as group, first,
                      second]:  # fmt: skip
                    self._group(group, *self._lists(first, second))
                case _:
                    raise MeshError(f"it has an unknown section {line[0][:20]!r}")
        if dataset == "UNSTRUCTURED_GRID":
            self._cells(codes, *self.lists)
        elif dataset != "POLYDATA":
            self._grid(dataset, dimensions, axes, origin, spacing)

    def _group(self, name: str, sizes: Ints, members: Ints) -> None:
        self.placed += vtk_cells.add_lists(self.build, name, sizes, members, self.rows)
        self.rows += len(sizes)

    def _cells(self, codes: Ints | None, sizes: Ints, members: Ints) -> None:
        if codes is None or len(codes) != len(sizes):
            raise MeshError(f"{CUT_OFF}: the types of its cells are missing")
        self.placed += vtk_cells.add_cells(self.build, codes, sizes, members)
        self.rows = len(sizes)

    def _grid(
        self,
        dataset: str,
        dimensions: tuple[int, int, int] | None,
        axes: dict[str, NDArray[np.float64]],
        origin: NDArray[np.float64],
        spacing: NDArray[np.float64],
    ) -> None:
        if dataset == "RECTILINEAR_GRID" and dimensions is None and len(axes) == 3:
            dimensions = (len(axes["X"]), len(axes["Y"]), len(axes["Z"]))
        if dimensions is None:
            raise MeshError(f"{CUT_OFF}: its DIMENSIONS are missing")
        count = dimensions[0] * dimensions[1] * dimensions[2]
        if dataset == "STRUCTURED_POINTS":
            vtk_cells.refuse_huge(count)
            axes = {
                axis: origin[i] + spacing[i] * np.arange(dimensions[i])
                for i, axis in enumerate("XYZ")
            }
        if dataset != "STRUCTURED_GRID":
            if tuple(len(axes.get(axis, ())) for axis in "XYZ") != dimensions:
                raise MeshError("its coordinates do not fit its DIMENSIONS")
            vtk_cells.refuse_huge(count)
            z, y, x = np.meshgrid(axes["Z"], axes["Y"], axes["X"], indexing="ij")
            self.build.points(np.column_stack([x.ravel(), y.ravel(), z.ravel()]))
            self.points = count
        if self.points != count:
            raise MeshError(f"it has {self.points} points, and DIMENSIONS say {count}")
        quads = vtk_cells.grid_cells(dimensions)
        self.placed += self.build.cells("quad", quads)
        self.rows = len(quads)

    # -- data --------------------------------------------------------------------------------------

    def _data(self) -> None:
        words = self.words
        fields = CellFields(self.build, self.placed, self.rows)
        count, of_cells = 0, False
        while line := words.words():
            head = line[0].upper()
            keep: Callable[[str, NDArray[np.generic]], None] = (
                fields.keep if of_cells else lambda n, v: keep_point_data(self.build, n, v)
            )
            match [head, *line[1:]]:
                case ["POINT_DATA" | "CELL_DATA", number]:
                    count, of_cells = numbers.count_of(number, 2**40), head == "CELL_DATA"
                case ["SCALARS", name, kind, *more]:
                    width = numbers.count_of(more[0], _MOST) if more else 1
                    words.skip_line_end()
                    place, table = words.at, words.words()
                    if not table or table[0].upper() != "LOOKUP_TABLE":
                        words.at = place
                    keep(unquote(name), self._array(count * width, kind))
                case ["COLOR_SCALARS", name, width]:
                    size = count * numbers.count_of(width, _MOST)
                    self._array(size, "unsigned_char" if words.binary else "float")
                    keep(name, np.zeros(0))
                case ["LOOKUP_TABLE", _, size]:
                    rows = 4 * numbers.count_of(size, words.left())
                    self._array(rows, "unsigned_char" if words.binary else "float")
                case ["TEXTURE_COORDINATES", name, width, kind]:
                    self._array(count * numbers.count_of(width, _MOST), kind)
                    keep(name, np.zeros(0))
                case [("VECTORS" | "NORMALS" | "TENSORS" | "TENSORS6" | "GLOBAL_IDS"
                       | "PEDIGREE_IDS" | "EDGE_FLAGS"), name, kind]:  # fmt: skip
                    values = self._array(count * _WIDTHS[head], kind)
                    keep(unquote(name), values if _WIDTHS[head] == 1 else np.zeros(0))
                case ["FIELD", _, number]:
                    self._field(numbers.count_of(number, words.left()), keep)
                case ["METADATA", *_]:
                    self._metadata()
                case _:
                    if not words.left():
                        raise MeshError(CUT_OFF)
                    raise _UnknownType(f"there is {line[0][:20]!r} in it")

    def _field(self, count: int, keep: Callable[[str, NDArray[np.generic]], None] | None) -> None:
        for _ in range(count):
            head = self.words.words()
            if head[:1] == ["METADATA"]:
                self._metadata()
                head = self.words.words()
            if len(head) != 4:
                raise MeshError(CUT_OFF if not head else "it is damaged: its FIELD data")
            name, width, rows, kind = head
            total = numbers.count_of(width, 2**40) * numbers.count_of(rows, 2**40)
            values = self._array(total, kind)
            if keep is not None:
                keep(unquote(name), values if width == "1" else np.zeros(0))
        self.words.skip_line_end()

    def _metadata(self) -> None:
        while self.words.line().strip():
            pass

    def _array(self, count: int, kind: str) -> NDArray[np.generic]:
        words, kind = self.words, kind.lower()
        if kind in ("string", "utf8_string"):
            self._strings(count)
            return np.zeros(0)
        if kind == "bit":
            if words.binary:
                return np.unpackbits(words.array("u1", (count + 7) // 8).astype(np.uint8))[:count]
            return words.ints("u1", count)
        code = _TYPES.get(kind)
        if code is None and not words.left():
            raise MeshError(CUT_OFF)
        if code is None:
            raise _UnknownType(f"it holds numbers of the unknown type {kind[:20]!r}")
        if words.binary:
            return words.array(code, count)
        return words.floats(count) if code[0] == "f" else words.ints(code, count)

    def _strings(self, count: int) -> None:
        """Pass over texts: each is a line, or its length of 1 to 8 bytes precedes it."""
        words = self.words
        numbers.count_of(str(count), words.left())
        for _ in range(count):
            if not words.binary:
                if not words.left():
                    raise MeshError(CUT_OFF)
                words.line()
                continue
            first = int(words.array("u1", 1)[0])
            length = first & 0x3F
            for byte in words.array("u1", (7, 3, 1, 0)[first >> 6]).tolist():
                length = length * 256 + byte
            words.at += numbers.count_of(str(length), words.left())

    def _lists(self, first: str, second: str) -> tuple[Ints, Ints]:
        """The sizes of cells and their points end to end, from either of the two layouts."""
        words = self.words
        count, size = (numbers.count_of(word, words.left() + 1) for word in (first, second))
        if self.offsets:
            if count == 0:
                return np.zeros(0, np.int64), np.zeros(0, np.int64)
            cuts = self._titled("OFFSETS", count)
            members = self._titled("CONNECTIVITY", size)
            sizes = np.diff(cuts)
            if cuts[0] != 0 or (sizes < 0).any() or cuts[-1] != size:
                raise MeshError("it is damaged: the offsets of its cells")
            return sizes, members
        flat = self._array(size, "int").astype(np.int64)
        sizes = np.empty(count, np.int64)
        keep = np.ones(size, bool)
        for rows, table in numbers.prefixed(flat, count):
            sizes[rows] = table.shape[1]
        starts = np.concatenate([[0], np.cumsum(sizes + 1)])
        if starts[-1] != size:
            raise MeshError("it is damaged: a list of cells is longer than announced")
        keep[starts[:-1]] = False
        return sizes, flat[keep]

    def _titled(self, title: str, count: int) -> Ints:
        match self.words.words():
            case [found, kind] if found.upper() == title:
                return self._array(count, kind).astype(np.int64)
        raise MeshError(f"{CUT_OFF} or damaged: {title} is missing")
