"""Gmsh files (.msh): versions 1, 2, 4.0 and 4.1, text and binary, with their physical groups.

After the section "MSH file format" of the Gmsh reference manual. A cell without a physical group is
in no region; it may be in several, which versions up to 2.2 express by writing it once for each.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.numbers import CUT_OFF, Floats, Ints
from meshwright_core.io.readers.words import Words

TYPES = {
    1: ("line", 2), 2: ("triangle", 3), 3: ("quad", 4), 4: ("tetra", 4), 5: ("hexahedron", 8),
    6: ("wedge", 6), 7: ("pyramid", 5), 8: ("line", 3), 9: ("triangle", 6), 10: ("quad", 9),
    11: ("tetra", 10), 12: ("hexahedron", 27), 13: ("wedge", 18), 14: ("pyramid", 14),
    15: ("vertex", 1), 16: ("quad", 8), 17: ("hexahedron", 20), 18: ("wedge", 15),
    19: ("pyramid", 13), 20: ("triangle", 9), 21: ("triangle", 10), 22: ("triangle", 12),
    23: ("triangle", 15), 24: ("triangle", 15), 25: ("triangle", 21), 26: ("line", 4),
    27: ("line", 5), 28: ("line", 6), 29: ("tetra", 20), 30: ("tetra", 35), 31: ("tetra", 56),
    36: ("quad", 16), 37: ("quad", 25), 38: ("quad", 36), 39: ("quad", 12), 40: ("quad", 16),
    41: ("quad", 20), 42: ("triangle", 28), 43: ("triangle", 36), 44: ("triangle", 45),
    45: ("triangle", 55), 46: ("triangle", 66), 47: ("quad", 49), 48: ("quad", 64),
    49: ("quad", 81), 50: ("quad", 100), 51: ("quad", 121),
}  # fmt: skip
"""Kind and nodes of the cells by their number; of kinds we keep the corners come first."""
_DIMENSION = {"vertex": 0, "line": 1, "triangle": 2, "quad": 2}
_SILENT = frozenset({"Comments", "EndMeshFormat", "Parametrizations", "InterpolationScheme"})
_KEPT = ("geometric", "desired_degree")


class _Cells(NamedTuple):
    """A block of cells: their kind, nodes (m, n), and the entity or physical tag of each (m,)."""

    kind: str
    nodes: Ints
    tags: Ints


def read(data: bytes) -> Content:
    """Return the content of a Gmsh file."""
    return _Reader(data).content()


class _Reader:
    def __init__(self, data: bytes) -> None:
        data = numbers.without_mark(data)
        self.words = Words(data)
        self.version = 0.0
        self.names: dict[tuple[int, int], str] = {}
        self.groups: dict[tuple[int, int], tuple[int, ...]] = {}
        self.nodes: list[tuple[Ints, Floats]] = []
        self.cells: list[_Cells] = []
        self.build = Builder()
        self.values: dict[str, tuple[Ints, Floats]] = {}

    def content(self) -> Content:
        words = self.words
        sections = {
            "PhysicalNames": self._physical_names,
            "Entities": self._entities,
            "PartitionedEntities": lambda: self._entities(partitioned=True),
            "Nodes": self._nodes,
            "ParametricNodes": self._parametric_nodes,
            "Elements": self._elements,
            "NodeData": self._node_data,
            "NOD": self._nodes,
            "ELM": self._elements,
        }
        start = words.at
        while (first := self._section()) == "Comments" and words.skip_past(b"$EndComments"):
            start = words.at
        if first == "NOD":
            words.at, self.version = start, 1.0
        elif first != "MeshFormat":
            raise MeshError("it does not begin with $MeshFormat")
        else:
            self._format()
        while name := self._section():
            if name in sections:
                sections[name]()
                words.skip_line_end()
            elif name in ("ElementData", "ElementNodeData"):
                self._dropped(name)
            elif name not in _SILENT:
                self.build.dropped.append(f"the section ${name[:40]}")
            if not words.skip_past((b"$END" if name.isupper() else b"$End") + name.encode()):
                raise MeshError(f"{CUT_OFF}: $End{name} is missing")
        return self._result()

    def _section(self) -> str:
        """Go to the next section; its name, empty at the end of the file."""
        if not self.words.skip_past(b"$"):
            return ""
        return self.words.line().strip()

    def _format(self) -> None:
        words = self.words
        head = words.line().split()
        if len(head) != 3:
            raise MeshError("its $MeshFormat is not understood")
        self.version = float(numbers.floats(head[0].encode())[0])
        if self.version not in (2.0, 2.1, 2.2, 4.0, 4.1):
            raise MeshError(f"version {head[0]} of Gmsh files is not read: it is 2.2, 4.0 or 4.1")
        words.binary = head[1] == "1"
        if words.binary:
            if self.version == 4.0:
                raise MeshError("binary Gmsh files of version 4.0 are not read: 2.2 and 4.1 are")
            if head[2] != "8":
                raise MeshError(f"its numbers have {head[2]} bytes, and only 8 are read")
            if words.array("i4", 1)[0] != 1:
                words.at -= 4
                words.order = ">"
                if words.array("i4", 1)[0] != 1:
                    raise MeshError("its $MeshFormat is damaged")
        words.skip_past(b"$EndMeshFormat")

    def _physical_names(self) -> None:
        words = self.words
        for _ in range(words.count_line()):
            parts = words.line().split(None, 2)
            if len(parts) != 3:
                raise MeshError("its $PhysicalNames are damaged")
            dimension, tag = numbers.ints(" ".join(parts[:2]).encode()).tolist()
            self.names[dimension, tag] = parts[2].strip().strip('"')

    def _entities(self, partitioned: bool = False) -> None:
        words, old = self.words, self.version == 4.0
        if partitioned:
            words.size()
            for _ in range(words.size(each=8)):
                words.ints("i4", 2)
        for dimension, count in enumerate([words.size(each=8) for _ in range(4)]):
            for _ in range(count):
                tag = words.ints("i4", 1)[0]
                if partitioned:
                    words.ints("i4", 2)
                    words.ints("i4", words.size(each=1))
                words.floats(3 if dimension == 0 and not old else 6)
                physical = words.ints("i4", words.size(each=1)).tolist()
                if dimension:
                    words.ints("i4", words.size(each=1))
                if physical:
                    self.groups[dimension, int(tag)] = tuple(abs(one) for one in physical)

    def _nodes(self) -> None:
        words = self.words
        if self.version < 4:
            count = words.count_line(least=8)
            if words.binary:
                row = np.dtype([("id", words.order + "i4"), ("x", words.order + "f8", 3)])
                table = words.records(row, count)
                self.nodes.append((table["id"].astype(np.int64), table["x"]))
            else:
                flat = words.floats(4 * count).reshape(-1, 4)
                self.nodes.append((numbers.whole(flat[:, 0]), flat[:, 1:]))
            return
        blocks = words.size(each=4)
        for _ in range(3 if self.version > 4.0 else 1):
            words.size()
        for _ in range(blocks):
            first, second, parametric = words.ints("i4", 3).tolist()
            dimension = second if self.version == 4.0 else first
            if not 0 <= dimension <= 3:
                raise MeshError("a block of its nodes has no sound dimension")
            count = words.size(each=7)
            width = 3 + (dimension if parametric else 0)
            if self.version == 4.0:
                flat = words.floats((width + 1) * count).reshape(-1, width + 1)
                self.nodes.append((numbers.whole(flat[:, 0]), flat[:, 1:4]))
                continue
            tags = words.ints("u8", count)
            self.nodes.append((tags, words.floats(width * count).reshape(-1, width)[:, :3]))

    def _parametric_nodes(self) -> None:
        """Nodes of version 2 that also hold their place on their curve or surface."""
        words = self.words
        count = words.count_line(least=8)
        if not words.binary:
            lines = [line.split()[:4] for line in words.text_to(b"$").splitlines()[:count]]
            flat = numbers.floats(b" ".join(word for line in lines for word in line))
            if len(flat) != 4 * count:
                raise MeshError(f"{CUT_OFF}: {count} nodes are announced")
            flat = flat.reshape(-1, 4)
            self.nodes.append((numbers.whole(flat[:, 0]), flat[:, 1:]))
            return
        ids, points = np.empty(count, np.int64), np.empty((count, 3))
        for i in range(count):
            ids[i] = words.ints("i4", 1)[0]
            points[i] = words.floats(3)
            dimension = int(words.ints("i4", 2)[0])
            if not 0 <= dimension <= 3:
                raise MeshError("a node has no sound dimension")
            words.floats(dimension if dimension < 3 else 0)
        self.nodes.append((ids, points))

    def _elements(self) -> None:
        words = self.words
        if self.version >= 4:
            blocks = words.size(each=4)
            for _ in range(3 if self.version > 4.0 else 1):
                words.size()
            for _ in range(blocks):
                head = words.ints("i4", 3).tolist()
                tag = head[0] if self.version == 4.0 else head[1]
                kind, nodes = self._type(head[2])
                count = words.size(each=2)
                table = words.ints("u8", count * (nodes + 1)).reshape(-1, nodes + 1)
                self.cells.append(_Cells(kind, table[:, 1:], np.full(len(table), tag)))
            return
        count = words.count_line(least=4)
        if not words.binary:
            self._old_elements(numbers.ints(words.text_to(b"$")), count)
            return
        while count > 0:
            code, block, tags = words.ints("i4", 3).tolist()
            kind, nodes = self._type(code)
            if not (0 < block <= count and 0 <= tags <= 64):
                raise MeshError("a block of its elements is damaged")
            table = words.ints("i4", block * (1 + tags + nodes)).reshape(block, -1)
            group = table[:, 1] if tags else np.zeros(block, np.int64)
            self.cells.append(_Cells(kind, table[:, 1 + tags :], group))
            count -= block

    def _old_elements(self, flat: Ints, count: int) -> None:
        """Elements of version 2, as text: id, type, number of tags, tags, nodes."""
        at, block = 0, 1
        while count > 0:
            if at + 3 > len(flat):
                raise MeshError(f"{CUT_OFF}: {count} elements are missing")
            code, tags = flat[at + 1 : at + 3].tolist()
            tags = tags if self.version > 1 else 2
            kind, nodes = self._type(code)
            if not 0 <= tags <= 64:
                raise MeshError("an element has no sound number of tags")
            width = 3 + tags + nodes
            fit = min(block, count, (len(flat) - at) // width)
            if fit == 0:
                raise MeshError(f"{CUT_OFF}: {count} elements are missing")
            table = flat[at : at + fit * width].reshape(fit, width)
            # of version 1: id, type, physical and elementary tag, number of nodes, nodes
            first, column = (3, 2) if self.version > 1 else (2, 4)
            same = (table[:, 1] == code) & (table[:, column] == (tags if first == 3 else nodes))
            if not same[0]:
                raise MeshError("an element has another number of nodes than its type")
            rows = fit if same.all() else int(np.argmin(same))
            table = table[:rows]
            group = table[:, first] if tags else np.zeros(rows, np.int64)
            self.cells.append(_Cells(kind, table[:, 3 + tags :], group))
            at, count = at + rows * width, count - rows
            block = 4 * block if rows == fit else max(1, rows)

    def _type(self, code: int) -> tuple[str, int]:
        if code not in TYPES:
            raise MeshError(f"it has elements of the unknown type {code}")
        return TYPES[code]

    def _dropped(self, section: str) -> None:
        if self.words.count_line():
            name = self.words.line().strip().strip('"')
            self.build.dropped.append(f"cell data {name!r}")

    def _node_data(self) -> None:
        """Our own data by node is read; the names of others are kept for a line on what is lost."""
        words = self.words
        names = [words.line().strip().strip('"') for _ in range(words.count_line())]
        if not names or names[0] not in _KEPT:
            self.build.dropped.append(f"point data {names[0] if names else ''!r}")
            return
        for _ in range(words.count_line()):
            words.line()
        tags = [numbers.count_of(words.line(), 2**31) for _ in range(words.count_line())]
        if len(tags) < 3 or tags[1] != 1:
            return
        if words.binary:
            row = np.dtype([("id", words.order + "i4"), ("x", words.order + "f8")])
            table = words.records(row, tags[2])
            self.values[names[0]] = (table["id"].astype(np.int64), table["x"])
        else:
            flat = words.floats(2 * numbers.count_of(str(tags[2]), words.left())).reshape(-1, 2)
            self.values[names[0]] = (numbers.whole(flat[:, 0]), flat[:, 1])

    def _result(self) -> Content:
        build = self.build
        ids = np.concatenate([np.zeros(0, np.int64), *(ids for ids, _ in self.nodes)])
        build.part()
        if len(ids):
            build.points(np.concatenate([points for _, points in self.nodes]), ids)
        used: set[tuple[int, int]] = set()
        for block in _together(self.cells):
            placed = build.cells(block.kind, block.nodes)
            dimension = _DIMENSION.get(block.kind, 3)
            if dimension in (0, 3):
                continue
            for tag in np.unique(block.tags).tolist():
                for group in self._groups_of(dimension, tag):
                    used.add((dimension, group))
                    name = self.names.get((dimension, group), str(group))
                    rows = [
                        one._replace(rows=one.rows[block.tags[one.which] == tag]) for one in placed
                    ]
                    build.group(name, rows, group)
        # as in files of meshio, which writes no entities
        lost = [n for key, n in self.names.items() if key[0] in (1, 2) and key not in used]
        if lost:
            build.warnings.append(
                f"no element is in the physical groups {', '.join(map(repr, lost))}"
            )
        for name, (nodes, values) in self.values.items():
            place = build.index(nodes) if len(ids) else nodes
            if len(place) == len(ids) and (np.sort(place) == np.arange(len(ids))).all():
                ordered = np.zeros(len(ids))
                ordered[place] = values
                build.data[name] = ordered
        return build.content()

    def _groups_of(self, dimension: int, tag: int) -> tuple[int, ...]:
        """The physical groups of a cell: up to version 2.2 it has its own, later its entity's."""
        if self.version < 4:
            return (tag,) if tag else ()
        return self.groups.get((dimension, tag), ())


def _together(cells: list[_Cells]) -> list[_Cells]:
    """The blocks with those of the same kind and number of nodes joined."""
    groups: dict[tuple[str, int], list[_Cells]] = {}
    for block in cells:
        groups.setdefault((block.kind, block.nodes.shape[1]), []).append(block)
    return [
        _Cells(
            kind,
            np.concatenate([one.nodes for one in blocks]),
            np.concatenate([one.tags for one in blocks]),
        )
        for (kind, _), blocks in groups.items()
    ]
