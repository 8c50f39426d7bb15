"""PLY files, text and binary: any elements and properties, of which points and faces are kept.

After G. Turk, "The PLY polygon file format", 1994: the header announces elements with properties,
each a number or a list of numbers preceded by its length.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers, vtk_cells
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.fields import CellFields, keep_point_data
from meshwright_core.io.readers.numbers import CUT_OFF, Floats

_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2",
    "int32": "i4", "uint32": "u4", "int64": "i8", "uint64": "u8", "float32": "f4", "float64": "f8",
}  # fmt: skip
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_CORNERS = ("vertex_indices", "vertex_index")
_LONGEST_LINE = 4096


@dataclass
class _Property:
    """A property: its name, the type of its numbers, and of its length if it is a list."""

    name: str
    kind: str
    length: str = ""


@dataclass
class _Element:
    name: str
    count: int
    properties: list[_Property] = field(default_factory=list)


@dataclass
class _Table:
    """The rows of an element: numbers by property, lists as lengths and members end to end."""

    columns: dict[str, NDArray[Any]]
    lists: dict[str, tuple[NDArray[np.int64], NDArray[Any]]]


def read(data: bytes) -> Content:
    """Return the content of a PLY file: its points, faces, triangle strips and edges."""
    data = numbers.without_mark(data)
    order, elements, start = _header(data)
    source = _Binary(data, start, order) if order else _Text(data, start)
    build = Builder()
    tables: dict[str, _Table] = {}
    for element in elements:
        if element.name in tables:
            raise MeshError(f"it announces element {element.name[:20]!r} twice")
        tables[element.name] = source.table(element)
    _points(build, tables.get("vertex"))
    _faces(build, tables)
    edges = tables.get("edge")
    if edges is not None and {"vertex1", "vertex2"} <= edges.columns.keys():
        ends = [numbers.whole(edges.columns[name]) for name in ("vertex1", "vertex2")]
        build.cells("line", np.column_stack(ends))
    return build.content()


def _header(data: bytes) -> tuple[str, list[_Element], int]:
    """Byte order ("" for text), the elements, and where their rows begin."""
    if not data.startswith(b"ply"):
        raise MeshError('it does not begin with "ply"')
    at, order, elements = 0, None, []
    while True:
        end = data.find(b"\n", at, at + _LONGEST_LINE)
        if end < 0:
            raise MeshError(f"{CUT_OFF}: its header does not end")
        words, at = numbers.words_of(data[at:end]).split(), end + 1
        match words:
            case ["end_header"]:
                break
            case ["format", form, _]:
                if form not in _FORMATS:
                    raise MeshError(f"its format {form[:30]!r} is unknown")
                order = _FORMATS[form]
            case ["element", name, count]:
                elements.append(_Element(name, numbers.count_of(count, 2**48)))
            case ["property", "list", length, kind, name] if elements:
                known = length in _TYPES and kind in _TYPES and _TYPES[length][0] != "f"
                if not known:
                    raise MeshError(f"its property {name[:20]!r} has an unknown type")
                elements[-1].properties.append(_Property(name, _TYPES[kind], _TYPES[length]))
            case ["property", kind, name] if elements:
                if kind not in _TYPES:
                    raise MeshError(f"its property {name[:20]!r} has an unknown type")
                elements[-1].properties.append(_Property(name, _TYPES[kind]))
            case ["ply"] | ["comment" | "obj_info", *_] | []:
                pass
            case _:
                raise MeshError(f"its header has a line {' '.join(words)[:40]!r}")
    if order is None:
        raise MeshError("its header names no format")
    for element in elements:
        if not element.properties:
            element.count = 0  # nothing of it is in the file
        elif element.count > len(data) - at:
            raise MeshError(f"{CUT_OFF}: it announces {element.count} of {element.name[:20]!r}")
    return order, elements, at


class _Text:
    """Rows of text: all their numbers, one after the other."""

    def __init__(self, data: bytes, start: int) -> None:
        self._flat, self._at = numbers.floats(data[start:]), 0

    def table(self, element: _Element) -> _Table:
        rest = self._flat[self._at :]
        columns, lists, used = _walked(rest, element)
        self._at += used
        return _Table(columns, lists)


def _walked(
    flat: Floats, element: _Element
) -> tuple[dict[str, NDArray[Any]], dict[str, tuple[NDArray[np.int64], NDArray[Any]]], int]:
    """Take the rows of an element from numbers; those of equal lists all at once."""
    count, properties = element.count, element.properties
    if count == 0:
        empty = {p.name: (np.zeros(0, np.int64), np.zeros(0)) for p in properties if p.length}
        return {p.name: np.zeros(0) for p in properties if not p.length}, empty, 0
    places, at = [], 0
    for one in properties:  # of the first row
        if at >= len(flat):
            raise MeshError(f"{CUT_OFF}: {element.name[:20]!r} has not all its rows")
        size = _length(flat[at]) if one.length else 0
        places.append((at, size))
        at += 1 + size
    if count * at <= len(flat):
        table = flat[: count * at].reshape(count, at)
        same = all(
            (table[:, place] == size).all()
            for one, (place, size) in zip(properties, places, strict=True)
            if one.length
        )
        if same:
            columns = {p.name: table[:, a] for p, (a, _) in _scalars(properties, places)}
            lists = {
                p.name: (np.full(count, s), table[:, a + 1 : a + 1 + s].ravel())
                for p, (a, s) in _lists(properties, places)
            }
            return columns, lists, count * at
    return _one_by_one(flat, element)


def _scalars(
    properties: list[_Property], places: list[tuple[int, int]]
) -> list[tuple[_Property, tuple[int, int]]]:
    return [pair for pair in zip(properties, places, strict=True) if not pair[0].length]


def _lists(
    properties: list[_Property], places: list[tuple[int, int]]
) -> list[tuple[_Property, tuple[int, int]]]:
    return [pair for pair in zip(properties, places, strict=True) if pair[0].length]


def _one_by_one(
    flat: Floats, element: _Element
) -> tuple[dict[str, NDArray[Any]], dict[str, tuple[NDArray[np.int64], NDArray[Any]]], int]:
    width = len(element.properties)
    starts = np.empty((element.count, width), np.int64)
    values, at = flat.tolist(), 0
    listed = [bool(one.length) for one in element.properties]
    try:
        for i in range(element.count):
            row = starts[i]
            for j in range(width):
                row[j] = at
                at += 1 + _length(values[at]) if listed[j] else 1
    except IndexError as error:
        raise MeshError(f"{CUT_OFF}: {element.name[:20]!r} has not all its rows") from error
    if at > len(values):
        raise MeshError(f"{CUT_OFF}: {element.name[:20]!r} has not all its rows")
    columns: dict[str, NDArray[Any]] = {}
    lists: dict[str, tuple[NDArray[np.int64], NDArray[Any]]] = {}
    for j, one in enumerate(element.properties):
        if one.length:
            sizes = flat[starts[:, j]].astype(np.int64)
            lists[one.name] = (sizes, flat[_members(starts[:, j] + 1, sizes)])
        else:
            columns[one.name] = flat[starts[:, j]]
    return columns, lists, at


def _members(starts: NDArray[np.int64], sizes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Indices of the members of lists, end to end."""
    first = np.repeat(starts - np.concatenate([[0], np.cumsum(sizes)[:-1]]), sizes)
    return first + np.arange(len(first))


def _length(value: float) -> int:
    if not 0 <= value < 2**31 or value != int(value):
        raise MeshError(f"{value:g} is no length of a list")
    return int(value)


class _Binary:
    """Binary rows, which all have the same bytes where their lists are equally long."""

    def __init__(self, data: bytes, start: int, order: str) -> None:
        self._data, self._at, self._order = data, start, order

    def table(self, element: _Element) -> _Table:
        if element.count == 0 or any(p.length for p in element.properties):
            return self._rows(element)
        row = np.dtype([(f"p{j}", self._order + p.kind) for j, p in enumerate(element.properties)])
        table = self._take(row, element.count, element)
        return _Table({p.name: table[f"p{j}"] for j, p in enumerate(element.properties)}, {})

    def _take(self, row: np.dtype[Any], count: int, element: _Element) -> NDArray[Any]:
        if self._at + count * row.itemsize > len(self._data):
            raise MeshError(f"{CUT_OFF}: {element.name[:20]!r} has not all its rows")
        table = np.frombuffer(self._data, row, count, self._at)
        self._at += table.nbytes
        return table

    def _layout(self, element: _Element, at: int) -> tuple[np.dtype[Any], tuple[int, ...]]:
        """The record of the row at a place, and the lengths of its lists."""
        fields: list[tuple[Any, ...]] = []
        sizes = []
        for j, one in enumerate(element.properties):
            if not one.length:
                fields.append((f"p{j}", self._order + one.kind))
                at += np.dtype(one.kind).itemsize
                continue
            code = np.dtype(self._order + one.length)
            if at + code.itemsize > len(self._data):
                raise MeshError(f"{CUT_OFF}: {element.name[:20]!r} has not all its rows")
            size = int(np.frombuffer(self._data, code, 1, at)[0])
            if not 0 <= size <= len(self._data) - at:
                raise MeshError(f"{CUT_OFF} or damaged: a list of {size} numbers is announced")
            fields += [(f"n{j}", code), (f"p{j}", self._order + one.kind, (size,))]
            sizes.append(size)
            at += code.itemsize + size * np.dtype(one.kind).itemsize
        return np.dtype(fields), tuple(sizes)

    def _rows(self, element: _Element) -> _Table:
        """Rows with lists: as many at once as have lists of the same lengths."""
        blocks: list[NDArray[Any]] = []
        left, step = element.count, element.count
        while left > 0:
            row, sizes = self._layout(element, self._at)
            fit = min(left, step, max(0, len(self._data) - self._at) // row.itemsize)
            table = self._take(row, max(1, fit), element)
            same = np.ones(len(table), bool)
            names = [f"n{j}" for j, p in enumerate(element.properties) if p.length]
            for name, size in zip(names, sizes, strict=True):
                same &= table[name] == size
            good = len(same) if same.all() else int(np.argmin(same))
            self._at -= (len(table) - good) * row.itemsize
            blocks.append(table[:good])
            left -= good
            step = 4 * step if good == len(same) else max(1, good)
        columns: dict[str, NDArray[Any]] = {}
        lists = {}
        for j, one in enumerate(element.properties):
            parts = [block[f"p{j}"] for block in blocks]
            if not one.length:
                columns[one.name] = np.concatenate(parts) if parts else np.zeros(0)
                continue
            sizes_of = [np.full(len(part), part.shape[1]) for part in parts]
            flat = [part.ravel() for part in parts]
            lists[one.name] = (
                np.concatenate([np.zeros(0, np.int64), *sizes_of]),
                np.concatenate(flat) if flat else np.zeros(0),
            )
        return _Table(columns, lists)


def _points(build: Builder, table: _Table | None) -> None:
    if table is None or not {"x", "y"} <= table.columns.keys():
        raise MeshError("it has no points: no element vertex with x and y")
    columns = table.columns
    axes = [columns[axis] for axis in "xyz" if axis in columns]
    build.part()
    build.points(np.column_stack([np.asarray(axis, np.float64) for axis in axes]))
    for name, values in columns.items():
        if name not in ("x", "y", "z"):
            keep_point_data(build, name, values)


def _faces(build: Builder, tables: dict[str, _Table]) -> None:
    for name, group in (("face", "POLYGONS"), ("tristrips", "TRIANGLE_STRIPS")):
        table = tables.get(name)
        if table is None:
            continue
        found = next((table.lists[one] for one in _CORNERS if one in table.lists), None)
        if found is None:
            if any(len(column) for column in table.columns.values()) or table.lists:
                raise MeshError(f"the corners of its element {name} are missing")
            continue
        sizes, members = found[0], numbers.whole(found[1])
        if group == "TRIANGLE_STRIPS":
            sizes, members = _cut_strips(sizes, members)
        placed = vtk_cells.add_lists(build, group, sizes, members, 0)
        fields = CellFields(build, placed, len(sizes))
        for column, values in table.columns.items():
            if values.dtype.kind == "f" and (values == np.floor(values)).all():
                values = values.astype(np.int64)
            fields.keep(column, values)


def _cut_strips(
    sizes: NDArray[np.int64], members: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Strips that are separated by -1 within a list as lists of their own."""
    ends = np.zeros(len(members), bool)
    if len(members):
        ends[np.cumsum(sizes)[sizes > 0] - 1] = True
    breaks = members == -1
    strip = np.cumsum(breaks | np.concatenate([[False], ends[:-1]])[: len(members)])
    return np.unique(strip[~breaks], return_counts=True)[1], members[~breaks]
