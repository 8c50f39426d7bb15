"""Exodus II files of Cubit, MOOSE and Sandia's codes (.exo, .e): netCDF files, read with netCDF4.

Element blocks are regions, side sets name sides, node sets points (Schoof and Yarberry, EXODUS II,
SAND92-2137, appendix A).
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from meshwright_core.core.names import groups
from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers.builder import CORNERS, Builder, Placed
from meshwright_core.io.readers.numbers import Ints

_KINDS = {
    "SPHERE": "vertex", "POINT": "vertex", "BEAM": "line", "BAR": "line", "EDGE": "line",
    "TRUSS": "line", "TRI": "triangle", "TRIANGLE": "triangle", "TRISHELL": "triangle",
    "QUAD": "quad", "SHELL": "quad", "TET": "tetra", "TETRA": "tetra", "HEX": "hexahedron",
    "HEXAHEDRON": "hexahedron", "PYRAMID": "pyramid", "WEDGE": "wedge",
}  # fmt: skip
_FAULTS = (OSError, RuntimeError, LookupError, AttributeError, ValueError, ArithmeticError)
"""What the library raises on damaged files."""
_EXPANDED = 100
"""Times that an array may be larger than the whole file, where that is compressed."""


def read(path: Path) -> Content:
    """Return the mesh of an Exodus file."""
    import netCDF4

    data = path.read_bytes()
    try:
        with netCDF4.Dataset("mesh", mode="r", memory=data) as file:
            return _Exodus(file, _EXPANDED * len(data) + 2**20).content()
    except _FAULTS as error:
        raise MeshError("it is cut off or damaged: its netCDF structure") from error


class _Block(NamedTuple):
    """The elements from `start` to `stop`, where they went, and the sides that are faces."""

    start: int
    stop: int
    placed: list[Placed]
    faces: int


class _Exodus:
    def __init__(self, file: Any, most: int) -> None:
        file.set_auto_mask(False)
        self.file, self.most = file, most
        self.build = Builder()

    def content(self) -> Content:
        file, build = self.file, self.build
        if "num_nodes" not in file.dimensions:
            raise MeshError("it holds no mesh of Exodus")
        build.part()
        if "coord" in file.variables:
            build.points(self.array("coord").T)
        else:
            build.points(
                np.column_stack([self.array(f"coord{x}") for x in "xyz" if self.has(f"coord{x}")])
            )
        titles = self.texts("eb_names")
        first = 0
        every: list[_Block] = []
        flat = len(file.dimensions["num_dim"]) < 3 if "num_dim" in file.dimensions else False
        for number in self.numbers("connect"):
            connect = self.array(f"connect{number}")
            word = str(file.variables[f"connect{number}"].elem_type).upper().rstrip("0123456789")
            if word not in _KINDS:
                raise MeshError(f"its elements {word[:20]!r} are unknown")
            kind = "triangle" if word == "SHELL" and connect.shape[1] in (3, 6) else _KINDS[word]
            placed = build.cells(kind, connect - 1)
            title = self.named(titles, number, "eb_prop1", "block")
            for group in groups(title):
                build.group(group, placed)
            # the sides of shells are numbered from their two faces on
            shell = "SHELL" in word or (kind == "triangle" and not flat)
            every.append(_Block(first, first + len(connect), placed, 2 if shell else 0))
            first += len(connect)
        self.side_sets(every)
        names = self.texts("ns_names")
        for number in self.numbers("node_ns"):
            members = self.array(f"node_ns{number}") - 1
            build.node_set(self.named(names, number, "ns_prop1", "node set"), members)
        for key in ("name_nod_var", "name_elem_var"):
            build.dropped += [f"field {name!r}" for name in self.texts(key) if name]
        return build.content()

    def side_sets(self, every: list[_Block]) -> None:
        """Name the sides of elements: 1 is that from the first corner to the second one."""
        names = self.texts("ss_names")
        for number in self.numbers("elem_ss"):
            title = self.named(names, number, "ss_prop1", "side set")
            elements = self.array(f"elem_ss{number}") - 1
            sides = self.array(f"side_ss{number}") - 1
            for block in every:
                mine = (elements >= block.start) & (elements < block.stop)
                for one in block.placed:
                    if one.kind not in ("triangle", "quad"):
                        continue
                    corners = CORNERS[one.kind]
                    row = np.full(block.stop - block.start, -1)
                    row[one.which] = np.arange(len(one.which))
                    at, side = row[elements[mine] - block.start], sides[mine] - block.faces
                    good = (at >= 0) & (side >= 0) & (side < corners)
                    nodes = self.build.corners_of(one)[at[good]]
                    rows, side = np.arange(len(nodes)), side[good]
                    ends = np.column_stack([nodes[rows, side], nodes[rows, (side + 1) % corners]])
                    self.build.edge_indices(title, ends)

    def has(self, name: str) -> bool:
        return name in self.file.variables

    def numbers(self, word: str) -> list[int]:
        """The numbers of the variables that are called so."""
        found = (re.fullmatch(rf"{word}(\d+)", name) for name in self.file.variables)
        return sorted(int(one[1]) for one in found if one)

    def array(self, name: str) -> Any:
        data = self.file.variables[name]
        if data.size * 8 > self.most:
            raise MeshError("it is damaged: an array is larger than the file can hold")
        found = np.asarray(data[...])
        return found.astype(np.int64 if found.dtype.kind in "iu" else np.float64)

    def texts(self, name: str) -> list[str]:
        """The rows of an array of letters."""
        if not self.has(name):
            return []
        rows = np.asarray(self.file.variables[name][...])
        return [
            b"".join(row.ravel().tolist()).split(b"\0")[0].decode("utf-8", "replace").strip()
            for row in rows
        ]

    def named(self, titles: list[str], number: int, ids: str, word: str) -> str:
        """The name of a block or set, else one of its number in the file."""
        if number <= len(titles) and titles[number - 1]:
            return titles[number - 1]
        own: Ints = self.array(ids).ravel() if self.has(ids) else np.zeros(0, np.int64)
        return f"{word} {own[number - 1] if number <= len(own) else number}"
