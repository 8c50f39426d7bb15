"""Medit files (.mesh), text and binary, after the documentation of libMeshb (P.-L. George).

The reference of a triangle, quad or edge names its region or side: "ref=3".
"""

from __future__ import annotations

import re

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.fields import contents_of
from meshwright_core.io.readers.numbers import CUT_OFF, Floats
from meshwright_core.io.readers.words import Words

_CELLS = {
    "EDGES": ("line", 2), "TRIANGLES": ("triangle", 3), "QUADRILATERALS": ("quad", 4),
    "QUADS": ("quad", 4), "TETRAHEDRA": ("tetra", 4), "HEXAHEDRA": ("hexahedron", 8),
    "HEXAEDRA": ("hexahedron", 8), "PRISMS": ("wedge", 6), "PRISM": ("wedge", 6),
    "PYRAMIDS": ("pyramid", 5), "EDGESP2": ("line", 3), "TRIANGLESP2": ("triangle", 6),
    "QUADRILATERALSQ2": ("quad", 9),
}  # fmt: skip
_ROWS = {"CORNERS": 1, "RIDGES": 1, "REQUIREDVERTICES": 1, "REQUIREDEDGES": 1, "NORMALS": 3,
         "REQUIREDTRIANGLES": 1, "TANGENTS": 3, "NORMALATVERTICES": 2, "TANGENTATVERTICES": 2,
         "NORMALATTRIANGLEVERTICES": 3, "TANGENTATEDGES": 3, "REQUIREDQUADRILATERALS": 1,
         "EDGEONGEOMETRICEDGE": 2, "VERTEXONGEOMETRICVERTEX": 2, "VERTEXONGEOMETRICEDGE": 3,
         "TANGENTATEDGE": 3}  # fmt: skip
_COMMENT = re.compile(rb"#[^\n]*")
_KEYWORD = re.compile(rb"([A-Z][A-Za-z]+(?:[ \t]+\d+(?=[ \t]+\S))?)")
"""A keyword, and the number that more follows behind in its line."""
_BINARY = {4: "VERTICES", 5: "EDGES", 6: "TRIANGLES", 7: "QUADRILATERALS", 8: "TETRAHEDRA",
           9: "PRISMS", 10: "HEXAHEDRA", 24: "TRIANGLESP2", 25: "EDGESP2", 27: "QUADRILATERALSQ2",
           49: "PYRAMIDS"}  # fmt: skip


def read(data: bytes) -> Content:
    """Return the content of a Medit file, text or binary."""
    if data[:4] in (b"\1\0\0\0", b"\0\0\0\1"):
        return _Binary(data).content()
    return _Text(data).content()


class _Medit:
    def __init__(self) -> None:
        self.build = Builder()
        self.dimension = 0

    def points(self, table: Floats) -> None:
        self.build.part()
        self.build.points(table[:, : self.dimension], np.arange(1, len(table) + 1))

    def cells(self, keyword: str, table: np.ndarray) -> None:
        kind, _ = _CELLS[keyword]
        placed = self.build.cells(kind, table[:, :-1])
        refs = numbers.whole(table[:, -1])
        used = np.unique(refs).tolist()
        if used == [0] or (used == [1] and kind != "line"):
            return  # as programs write where nothing is marked
        for ref in used:
            if kind == "line" and ref == 0:
                continue
            rows = [one._replace(rows=one.rows[refs[one.which] == ref]) for one in placed]
            self.build.group(f"ref={ref}", rows, ref)


def _on_its_line(match: re.Match[bytes]) -> bytes:
    """A keyword at the beginning of a line, with its number alone where it has one."""
    ends = b"\n" if match[1][-1:].isdigit() else b""
    return b"\n" + match[1] + ends


class _Text(_Medit):
    def __init__(self, data: bytes) -> None:
        super().__init__()
        text = numbers.text_of(data)
        if b"#" in text:
            text = _COMMENT.sub(b"", text)
        self.words = Words(_KEYWORD.sub(_on_its_line, text))

    def content(self) -> Content:
        words = self.words
        others: set[str] = set()
        seen = False
        while head := words.words():
            keyword, rest = head[0].upper(), head[1:]
            seen |= keyword.startswith("MESHVERSION")
            if not seen:
                raise MeshError("it does not begin with MeshVersionFormatted")
            if keyword == "END":
                break
            if not keyword[0].isalpha():
                raise MeshError("it is damaged: a section is longer than it announces")
            if keyword.startswith(("MESHVERSION", "DIMENSION")):
                value = (rest or words.words() or ["?"])[0]
                if keyword == "DIMENSION":
                    if value not in ("2", "3"):
                        raise MeshError(f"it has {value[:10]!r} dimensions")
                    self.dimension = int(value)
            elif keyword == "VERTICES":
                if not self.dimension:
                    raise MeshError("its Dimension is missing")
                width = self.dimension + 1
                flat = words.floats(width * self._count(rest, width))
                self.points(flat.reshape(-1, width))
            elif keyword in _CELLS:
                count = self._count(rest, 2)
                width = self._width(keyword, count)
                numbers.count_of(str(count), words.left() // (2 * width - 1) + 1)
                nodes = words.ints("", width * count)
                self.cells(keyword, nodes.reshape(-1, width))
            elif keyword in _ROWS:
                width = self.dimension if keyword in ("NORMALS", "TANGENTS") else _ROWS[keyword]
                words.text(width * self._count(rest, width))
                others.add(head[0])
            else:
                self._pass_over()
                others.add(head[0][:40])
        else:
            if not seen:
                raise MeshError("it does not begin with MeshVersionFormatted")
            raise MeshError(f"{CUT_OFF}: End is missing")
        if others:
            self.build.dropped.append(contents_of(others))
        return self.build.content()

    def _width(self, keyword: str, count: int) -> int:
        """Numbers of a row; Gmsh writes quads of 8 and 9 nodes under the keyword of plain ones."""
        words = self.words
        place = words.at
        found = {len(words.words()) for _ in range(min(count, 2))}
        words.at = place
        high = keyword == "QUADRILATERALS" and found in ({9}, {10})
        return found.pop() if high else _CELLS[keyword][1] + 1

    def _count(self, rest: list[str], width: int) -> int:
        if rest:
            return numbers.count_of(rest[0], self.words.left() // (2 * width) + 1)
        return self.words.count_line(2 * width - 1)

    def _pass_over(self) -> None:
        """Go to the next line that begins with a letter: what a section holds is numbers."""
        words = self.words
        while words.left():
            place = words.at
            line = words.line().strip()
            if line[:1].isalpha():
                words.at = place
                return


class _Binary(_Medit):
    """Keywords are numbers, each followed by the place of the next."""

    def __init__(self, data: bytes) -> None:
        super().__init__()
        self.words = Words(data)
        self.words.binary = True
        self.words.order = "<" if data[:4] == b"\1\0\0\0" else ">"

    def content(self) -> Content:
        words = self.words
        words.at = 4
        version = int(words.ints("i4", 1)[0])
        if version not in (1, 2, 3, 4):
            raise MeshError(f"version {version} of Medit files is unknown")
        real = "f4" if version == 1 else "f8"
        whole = "i8" if version == 4 else "i4"
        place = "i4" if version < 3 else "i8"
        while words.left() >= 4:
            code = int(words.ints("i4", 1)[0])
            if code == 54:  # End
                return self.build.content()
            start = words.at
            stop = int(words.ints(place, 1)[0])
            if code == 3:
                self.dimension = int(words.ints("i4", 1)[0])
                if self.dimension not in (2, 3):
                    raise MeshError(f"it has {self.dimension} dimensions")
            elif code == 4 or _BINARY.get(code) in _CELLS:
                keyword = _BINARY[code]
                count = int(words.ints(whole, 1)[0])
                numbers.count_of(str(count), words.left() // 4)
                if code == 4:
                    fields = [
                        ("x", words.order + real, (self.dimension,)),
                        ("r", words.order + whole),
                    ]
                    self.points(words.records(np.dtype(fields), count)["x"].astype(np.float64))
                else:
                    width = _CELLS[keyword][1] + 1
                    self.cells(keyword, words.ints(whole, width * count).reshape(-1, width))
            if not start < stop <= len(words.data):
                break
            words.at = stop
        raise MeshError(f"{CUT_OFF}: End is missing")
