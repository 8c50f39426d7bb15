"""SU2 files (.su2): points, elements, markers and zones, after the documentation of SU2."""

from __future__ import annotations

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.builder import CORNERS, Builder
from meshwright_core.io.readers.numbers import CUT_OFF, Ints

_KINDS = {1: "vertex", 3: "line", 5: "triangle", 9: "quad", 10: "tetra", 12: "hexahedron",
          13: "wedge", 14: "pyramid", 21: "line", 22: "triangle", 23: "quad", 28: "quad",
          34: "triangle", 35: "line", 68: "line", 69: "triangle", 70: "quad"}  # fmt: skip
"""Kinds of cells by the numbers of VTK; of those with more nodes the corners come first."""


def read(data: bytes) -> Content:
    """Return the content of an SU2 file; each zone is a part."""
    lines = numbers.text_of(data).split(b"\n")
    if any(b"%" in line for line in lines):
        lines = [line.partition(b"%")[0] for line in lines]
    return _Reader([line for line in lines if line.strip()]).content()


class _Reader:
    def __init__(self, lines: list[bytes]) -> None:
        self.lines, self.at = lines, 0
        self.build = Builder()
        self.points: np.ndarray | None = None
        self.elements: list[bytes] | None = None
        self.markers: list[tuple[str, list[bytes]]] = []
        self.zone = ""
        self.dimension = 2

    def content(self) -> Content:
        while self.at < len(self.lines):
            key, sign, value = numbers.words_of(self.lines[self.at]).partition("=")
            self.at += 1
            key, value = key.strip().upper(), value.strip()
            if not sign:
                raise MeshError(f"a line is not understood: {key[:40]!r}")
            match key:
                case "IZONE":
                    self._flush()
                    self.zone = f"zone {value}"
                case "NDIME":
                    if self.points is not None and self.elements is not None:
                        self._flush()
                    if value not in ("2", "3"):
                        raise MeshError(f"it has {value[:10]!r} dimensions")
                    self.dimension = int(value)
                case "NELEM":
                    self.elements = self._take(self._count(value))
                case "NPOIN":
                    self._points(self._count(value.split()[0] if value.split() else ""))
                case "MARKER_TAG":
                    self.markers.append((value, []))
                case "MARKER_ELEMS":
                    name = self.markers.pop()[0] if self.markers else "marker"
                    count = self._count(value)
                    if self.lines[self.at : self.at + 1] and b"SEND_RECV" in self.lines[self.at]:
                        self.at += 1  # of points between partitions
                    self.markers.append((name, self._take(count)))
                case _:
                    if key.startswith("FFD"):
                        self.build.dropped.append("the free-form deformation")
                    self._pass_over()
        self._flush()
        return self.build.content()

    def _count(self, value: str) -> int:
        return numbers.count_of(value, len(self.lines) - self.at)

    def _take(self, count: int) -> list[bytes]:
        lines = self.lines[self.at : self.at + count]
        if any(b"=" in line for line in lines):
            raise MeshError(f"{CUT_OFF}: {count} lines are announced before the next key")
        self.at += count
        return lines

    def _pass_over(self) -> None:
        while self.at < len(self.lines) and b"=" not in self.lines[self.at]:
            self.at += 1

    def _points(self, count: int) -> None:
        flat = numbers.floats(b"\n".join(self._take(count)))
        if count == 0:
            self.points = np.zeros((0, self.dimension))
            return
        width = len(flat) // count
        if width * count != len(flat) or width < self.dimension:
            raise MeshError(f"{CUT_OFF} or damaged: {count} points are announced")
        self.points = flat.reshape(count, width)[:, : self.dimension]

    def _flush(self) -> None:
        """Enter the zone that has been read."""
        if self.points is None and self.elements is None:
            return
        if self.points is None or self.elements is None:
            missing = "points" if self.points is None else "elements"
            raise MeshError(f"{CUT_OFF}: the {missing} of a zone are missing")
        self.build.part(self.zone, region=True)
        self.build.points(self.points)
        for kind, nodes in _cells(self.elements):
            self.build.cells(kind, nodes)
        for name, lines in self.markers:
            cells = _cells(lines)
            for kind, nodes in cells:
                if kind == "line":
                    self.build.edges(name, nodes[:, :2])
            if cells and not any(kind == "line" for kind, _ in cells):
                self.build.dropped.append(f"the marker {name!r}, which has no edges,")
        self.points = self.elements = None
        self.markers = []


def _cells(lines: list[bytes]) -> list[tuple[str, Ints]]:
    """Cells of lines "type nodes [number]", by kind."""
    flat = numbers.ints(b"\n".join(lines))
    if not lines:
        return []
    width = len(flat) // len(lines)
    if width * len(lines) == len(flat) and width:
        table = flat.reshape(-1, width)
        if (table[:, 0] == table[0, 0]).all() and all(
            len(line.split()) == width for line in (lines[0], lines[-1])
        ):
            return [_kind(int(table[0, 0]), table)]
    sizes = np.array([len(line.split()) for line in lines])
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    return [
        _kind(code, table[table[:, 0] == code])
        for _, table in numbers.by_length(flat, starts, sizes)
        for code in np.unique(table[:, 0]).tolist()
    ]


def _kind(code: int, table: Ints) -> tuple[str, Ints]:
    if code not in _KINDS:
        raise MeshError(f"it has elements of the unknown type {code}")
    kind = _KINDS[code]
    # behind the nodes there may be a number; a corner that is missing is refused with the cells
    numbered = table.shape[1] > 1 + CORNERS.get(kind, 1)
    return kind, table[:, 1 : -1 if numbered else None]
