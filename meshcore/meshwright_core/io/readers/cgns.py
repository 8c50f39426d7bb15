"""CGNS files (.cgns) in HDF5: unstructured zones, and structured ones of quads, read with h5py.

Each zone is a part. Families of zones name regions, boundary conditions name sides (by their family
where they have one) or, of elements, regions. After the SIDS and its mapping to HDF5
(https://cgns.github.io/standard/SIDS/CGNS_SIDS.html).
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import hdf5, numbers
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.fields import contents_of
from meshwright_core.io.readers.numbers import CUT_OFF, Ints

_CELLS = {
    2: ("vertex", 1), 3: ("line", 2), 4: ("line", 3), 5: ("triangle", 3), 6: ("triangle", 6),
    7: ("quad", 4), 8: ("quad", 8), 9: ("quad", 9), 10: ("tetra", 4), 11: ("tetra", 10),
    12: ("pyramid", 5), 13: ("pyramid", 14), 14: ("wedge", 6), 15: ("wedge", 15),
    16: ("wedge", 18), 17: ("hexahedron", 8), 18: ("hexahedron", 20), 19: ("hexahedron", 27),
    21: ("pyramid", 13), 24: ("line", 4), 25: ("triangle", 9), 26: ("triangle", 10),
    27: ("quad", 12), 28: ("quad", 16),
}  # fmt: skip
"""Kind and nodes by the number of an element type of the SIDS."""
_MIXED, _NGON = 20, 22
_POLYGONS = {3: "triangle", 4: "quad"}
_FIELDS = frozenset({"FlowSolution_t", "DiscreteData_t"})
_AXES = ("CoordinateX", "CoordinateY", "CoordinateZ")
_OLD = b"ADF Database"


def read(path: Path) -> Content:
    """Return the content of a CGNS file.

    Raises:
        MeshError: it is in the older ADF format, points to other files, has coordinates that are
            not Cartesian, or is damaged.
    """
    with path.open("rb") as file:
        if _OLD in file.read(64):
            raise MeshError("it is a CGNS file in the ADF format: adf2hdf makes one that is read")
    return hdf5.content_of(path, "CGNS", _content)


def _content(file: Any, most: int) -> Content:
    build, dropped = Builder(), set[str]()
    bases = list(_children(file, "CGNSBase_t"))
    if not bases:
        raise MeshError("it holds no base of CGNS")
    for base in bases:
        families = {_name(one): one for one in _children(base, "Family_t")}
        for zone in _children(base, "Zone_t"):
            _Zone(build, zone, families, most).add()
            dropped.update(_name(one) for label in _FIELDS for one in _children(zone, label))
    if not build.parts:
        raise MeshError("it holds no zone of CGNS")
    if dropped:
        build.dropped.append(contents_of(dropped))
    return build.content()


class _Zone:
    """Enters one zone as a part."""

    def __init__(self, build: Builder, zone: Any, families: dict[str, Any], most: int) -> None:
        self.build, self.zone, self.families, self.most = build, zone, families, most
        # one row for the points, one for the cells, by axis
        self.size = self._numbers(zone).reshape(3, -1)
        kind = _child(zone, "ZoneType")
        self.structured = kind is None or self._text(kind) == "Structured"

    def add(self) -> None:
        build, zone = self.build, self.zone
        family = self._families(zone)
        # structured zones are blocks, not materials
        build.part(_name(zone), region=not (family or self.structured))
        build.points(self._points())
        placed = []
        if self.structured:
            placed += build.cells("quad", self._grid())
        else:
            for section in _children(zone, "Elements_t"):
                placed += self._section(section)
        for name in family:
            build.group(name, [one for one in placed if one.kind in ("triangle", "quad")])
        for conditions in _children(zone, "ZoneBC_t"):
            for condition in _children(conditions, "BC_t"):
                self._condition(condition)

    def _points(self) -> np.ndarray:
        coordinates = next(_children(self.zone, "GridCoordinates_t"), None)
        count = int(np.prod(self.size[0].astype(float)))
        if coordinates is None:
            raise MeshError(f"{CUT_OFF}: a zone has no coordinates")
        if not any(axis in coordinates for axis in _AXES):
            raise MeshError("its coordinates are not Cartesian")
        found = {axis: self._numbers(coordinates[axis]) for axis in _AXES if axis in coordinates}
        if any(len(one) != count for one in found.values()):
            raise MeshError("it is damaged: a zone has other points than its size states")
        nothing = np.zeros(count)
        return np.column_stack([found.get(axis, nothing) for axis in _AXES])

    def _grid(self) -> Ints:
        """Quads of a structured zone, by points counted along its first axis first."""
        long = [axis for axis, count in enumerate(self.size[0]) if count > 1]
        if len(long) != 2:
            shown = " x ".join(map(str, self.size[0].tolist()))
            raise MeshError(f"its zone of {shown} points is not one of quads")
        n, m = self.size[0][long].tolist()
        start = (np.arange(m - 1)[:, None] * n + np.arange(n - 1)).ravel()
        return np.column_stack([start, start + 1, start + n + 1, start + n])

    # -- elements ----------------------------------------------------------------------------------

    def _section(self, section: Any) -> list[Any]:
        """Add the elements of a section, by their numbers in the zone."""
        code = int(self._numbers(section)[0])
        first, last = self._numbers(_needed(section, "ElementRange"))[:2].tolist()
        flat = self._numbers(_needed(section, "ElementConnectivity"))
        count = last - first + 1
        if not 0 <= count <= len(flat):
            raise MeshError(f"{CUT_OFF} or damaged: a section announces {count} elements")
        ids = np.arange(first, last + 1)
        if code in _CELLS:
            kind, nodes = _CELLS[code]
            if len(flat) != nodes * count:
                raise MeshError(f"{CUT_OFF} or damaged: a section announces {count} elements")
            return self.build.cells(kind, flat.reshape(-1, nodes) - 1, ids)
        if code not in (_MIXED, _NGON):
            return self.build.cells(f"element type {code}", np.zeros((count, 1)))
        starts = self._starts(section, flat, count, code)
        lengths = np.diff(starts)
        if len(starts) != count + 1 or (lengths < 1).any() or not 0 <= starts[0] <= starts[-1]:
            raise MeshError("it is damaged: a section of elements has no sound offsets")
        if starts[-1] > len(flat):
            raise MeshError(f"{CUT_OFF} within its elements")
        placed = []
        for rows, table in numbers.by_length(flat, starts[:-1], lengths):
            if code == _NGON:
                kind = _POLYGONS.get(table.shape[1], "polygon")
                placed += self.build.cells(kind, table - 1, ids[rows])
                continue
            for one in np.unique(table[:, 0]).tolist():
                kind, nodes = _CELLS.get(one, (f"element type {one}", 0))
                mine = table[:, 0] == one
                placed += self.build.cells(kind, table[mine, 1:] - 1, ids[rows[mine]])
        return placed

    def _starts(self, section: Any, flat: Ints, count: int, code: int) -> Ints:
        """Where each element begins; files before version 4 hold that only in the elements."""
        offsets = _child(section, "ElementStartOffset")
        if offsets is not None:
            return self._numbers(offsets)
        starts, values = [0], flat.tolist()
        for _ in range(count):
            at = starts[-1]
            if at >= len(values):
                raise MeshError(f"{CUT_OFF} within its elements")
            if code == _NGON:
                raise MeshError("polygons of CGNS files before version 4 are not read")
            starts.append(at + 1 + _CELLS.get(values[at], ("", len(values)))[1])
        return np.array(starts)

    # -- boundary conditions -----------------------------------------------------------------------

    def _condition(self, condition: Any) -> None:
        names = self._families(condition)
        if not names and self._text(condition) != "Null":
            names = [_name(condition)]
        where = _child(condition, "GridLocation")
        location = "Vertex" if where is None else self._text(where)
        listed = _child(condition, "PointList") or _child(condition, "ElementList")
        span = _child(condition, "PointRange") or _child(condition, "ElementRange")
        given = listed if listed is not None else span
        if given is None or not names:
            return
        width = self.size.shape[1]
        table = self._numbers(given).reshape(-1, width)
        of_elements = location != "Vertex" or _name(given).startswith("Element")
        if self.structured:
            for name in names:
                self._on_grid(name, table - 1, span is given, of_elements)
            return
        if span is given:
            most = self.build.total + sum(len(ids) for ids, _ in self.build.numbered())
            if len(table) != 2 or not 0 <= table[1, 0] - table[0, 0] <= most:
                raise MeshError("it is damaged: the range of a boundary condition")
            table = np.arange(table[0, 0], table[1, 0] + 1)
        placed = self.build.elements(table.ravel()) if of_elements else []
        for name in names:
            if of_elements:
                self.build.group(name, placed)
            else:
                self.build.node_set(name, table.ravel() - 1)

    def _on_grid(self, name: str, table: Ints, is_range: bool, of_edges: bool) -> None:
        """A side of a structured zone: a range of points, or of its edges, or a list of points."""
        sizes = self.size[0]
        if ((table < 0) | (table >= sizes)).any() or (is_range and len(table) != 2):
            raise MeshError("it is damaged: a boundary condition leaves its zone")
        step = np.concatenate([[1], np.cumprod(sizes)[:-1]])
        if not is_range:
            if not of_edges:
                self.build.node_set(name, table @ step)
            return
        low, high = table.min(axis=0), table.max(axis=0)
        across = np.flatnonzero((sizes > 1) & (low == high))
        if of_edges and len(across) == 1:  # an edge more than edges is the last point
            along = (sizes > 1) & (np.arange(len(sizes)) != across[0])
            high = np.where(along, np.minimum(high + 1, sizes - 1), high)
        ways = np.flatnonzero(high > low)
        if len(ways) != 1:
            return  # not a line: a point, or the whole zone
        count = int(high[ways[0]] - low[ways[0]])
        start = int(low @ step) + np.arange(count) * int(step[ways[0]])
        self.build.edges(name, np.column_stack([start, start + int(step[ways[0]])]))

    # -- nodes of the tree -------------------------------------------------------------------------

    def _families(self, node: Any) -> list[str]:
        """The names of the family of a node: Gmsh gives one further names within it."""
        found = []
        for one in _children(node, "FamilyName_t"):
            family = self.families.get(self._text(one).rpartition("/")[2])
            inner = [] if family is None else list(_children(family, "FamilyName_t"))
            found += [self._text(each).rpartition("/")[2] for each in inner or [one]]
        return found

    def _numbers(self, node: Any) -> Any:
        return hdf5.array(_needed(node, " data"), self.most)

    def _text(self, node: Any) -> str:
        codes = hdf5.array(_needed(node, " data"), self.most)
        return numbers.words_of(bytes((codes & 255).astype(np.uint8).tolist())).strip(" \0")


def _children(node: Any, label: str) -> Iterator[Any]:
    """The children with a label, in the order of the file."""
    for child in node.values():
        if child is None:
            raise MeshError("a node of it cannot be opened: it is damaged, or in another file")
        kind = child.attrs.get("type", b"")
        if bytes(kind).strip(b"\0") == b"LK":
            raise MeshError("it has links to other files or nodes, which are not followed")
        if bytes(child.attrs.get("label", b"")).strip(b"\0 ") == label.encode():
            yield child


def _child(node: Any, name: str) -> Any:
    return node.get(name)


def _needed(node: Any, name: str) -> Any:
    if name not in node:
        raise MeshError(f"it is damaged: {name.strip()} is missing in {_name(node)[:40]!r}")
    return node[name]


def _name(node: Any) -> str:
    return str(node.name).rpartition("/")[2]
