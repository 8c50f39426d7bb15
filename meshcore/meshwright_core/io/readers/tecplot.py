"""Tecplot text files (.dat, .tec): finite-element and ordered zones.

After the ASCII data chapter of the Tecplot 360 Data Format Guide. Each zone is a part.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers, vtk_cells
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.fields import OURS
from meshwright_core.io.readers.numbers import CUT_OFF, Floats, Ints

_RECORD = re.compile(
    rb"^\s*(TITLE|FILETYPE|VARIABLES|ZONE|TEXT|GEOMETRY|DATASETAUXDATA|VARAUXDATA|CUSTOMLABELS"
    rb"|FUNCTION|USERREC|AUXDATA)\b",
    re.IGNORECASE,
)
_COMMENT = re.compile(rb"""^((?:[^#"]|"[^"]*")*)#.*$""")
_DATA = re.compile(rb"^\s*[-+.]?\d|^\s*nan\b|^\s*[-+]?inf", re.IGNORECASE)
_PAIR = re.compile(
    r"""([A-Za-z_0-9]+)\s*=\s*(\((?:[^()]|\([^()]*\))*\)|"(?:[^"\\]|\\.)*"|[^\s,"()]+)"""
)
_QUOTED = re.compile(r'"((?:[^"\\]|\\.)*)"|([^\s,"=]+)')
_CELLS = {"TRIANGLE": ("triangle", 3), "QUADRILATERAL": ("quad", 4), "LINESEG": ("line", 2),
          "TETRAHEDRON": ("tetra", 4), "BRICK": ("hexahedron", 8)}  # fmt: skip
_NODES = _CELLS | {f"FE{name}": cells for name, cells in _CELLS.items()}

_MOST_REPEATED = 20_000_000
"""Numbers that repetitions ("3*1.5") may stand for, at a time."""


@dataclass
class _Zone:
    head: bytes
    lines: list[bytes] = field(default_factory=list)
    variables: tuple[str, ...] = ()


def read(data: bytes) -> Content:
    """Return the content of a Tecplot file.

    Raises:
        MeshError: an unknown type of zone, or damage.
    """
    build = Builder()
    zones: list[tuple[list[Floats | None], Ints | None]] = []
    for number, zone in enumerate(_zones(numbers.text_of(data)), start=1):
        _Reader(build, zone, zones, number).take()
    return build.content()


def _zones(text: bytes) -> list[_Zone]:
    """The zones of a file with the lines of their numbers."""
    zones: list[_Zone] = []
    variables: tuple[str, ...] = ("X", "Y")
    head = b""
    record = ""

    def close() -> None:
        nonlocal variables
        if record == "VARIABLES":
            words = numbers.words_of(head).partition("=")[2]
            variables = tuple(a or b for a, b in _QUOTED.findall(words))
        elif record == "ZONE":
            zones.append(_Zone(head, [], variables))

    known = False
    for line in text.split(b"\n"):
        if b"#" in line:
            line = _COMMENT.sub(rb"\1", line)
        if not line.strip():
            continue
        found = _RECORD.match(line)
        known |= found is not None
        if found and record == "ZONE" and found[1].upper() == b"AUXDATA":
            continue
        if found:
            close()
            record, head = found[1].decode().upper(), line[found.end() :]
        elif record in ("ZONE", "") and _DATA.match(line):
            if record == "ZONE":
                close()
                record = ""
            if not zones:
                zones.append(_Zone(b"", [], variables))
            zones[-1].lines.append(line.replace(b",", b" ") if b"," in line else line)
        elif not known:
            raise MeshError("it is no Tecplot file: it begins with another word")
        else:
            head += b" " + line
    close()
    return zones


def _set(text: str) -> list[int]:
    """The numbers of "[1-3,5]" or "1,2", at most a thousand."""
    found: list[int] = []
    for a, b in re.findall(r"(\d{1,6})(?:-(\d{1,6}))?", text):
        found += range(int(a), min(int(b or a), int(a) + 1000) + 1)
    return found[:1000]


class _Reader:
    def __init__(
        self, build: Builder, zone: _Zone, zones: list[tuple[list[Floats | None], Ints | None]],
        number: int,
    ) -> None:  # fmt: skip
        self.build, self.zone, self.zones = build, zone, zones
        pairs = _PAIR.findall(numbers.words_of(zone.head))
        self.options = {key.upper(): value.strip('"') for key, value in pairs}
        self.name = self.options.get("T", "").strip() or f"zone {number}"

    def _count(self, *keys: str) -> int:
        for key in keys:
            if key in self.options:
                return numbers.count_of(self.options[key], 2**40)
        return 0

    def take(self) -> None:
        options = self.options
        form = options.get("ZONETYPE", "").upper()
        packing = options.get("DATAPACKING", options.get("F", "POINT")).upper()
        if packing in ("FEPOINT", "FEBLOCK") or (not form and "ET" in options):
            form = options.get("ET", "QUADRILATERAL").upper()
        block = packing.endswith("BLOCK")
        ordered = form in ("", "ORDERED")
        sizes = [max(1, self._count(axis)) for axis in "IJK"]
        if ordered:
            nodes, elements = sizes[0] * sizes[1] * sizes[2], 0
            cells = max(1, sizes[0] - 1) * max(1, sizes[1] - 1) * max(1, sizes[2] - 1)
        elif form in _NODES:
            nodes, elements = self._count("N", "NODES"), self._count("E", "ELEMENTS")
            cells = elements
        else:
            raise MeshError(f"a zone has the type {form[:30]!r}, which is not read")
        columns, rest = self._columns(nodes, cells, block)
        connectivity = self._connectivity(form, elements, rest) if not ordered else None
        self.zones.append((columns, connectivity))
        axes = self._axes(columns)
        self.build.part(self.name, region=True)
        self.build.points(np.column_stack(axes))
        self._fields(columns, nodes)
        if connectivity is not None:
            self.build.cells(_NODES[form][0], connectivity)
        elif nodes > 1 and sizes.count(1) == 1:
            a, b, c = sizes
            self.build.cells("quad", vtk_cells.grid_cells((a, b, c)))
        elif sizes.count(1) == 0:
            raise MeshError("an ordered zone of three dimensions holds no quads")

    def _columns(
        self, nodes: int, cells: int, block: bool
    ) -> tuple[list[Floats | None], list[bytes]]:
        """The values of each variable, None for passive ones, and the lines behind them."""
        zone, options = self.zone, self.options
        count = len(zone.variables)
        shared: dict[int, int] = {}
        for members, source in re.findall(
            r"\(?\[?([\d,\-\s]+)\]?\)?\s*=\s*(\d+)", options.get("VARSHARELIST", "")
        ):
            shared |= {one - 1: int(source) - 1 for one in _set(members)}
        passive = {one - 1 for one in _set(options.get("PASSIVEVARLIST", ""))}
        centred = {
            one - 1
            for members in re.findall(
                r"\[([\d,\-\s]+)\]\s*\)?\s*=\s*CELLCENTERED",
                options.get("VARLOCATION", ""), re.IGNORECASE,
            )
            for one in _set(members)
        }  # fmt: skip
        listed = re.findall(r"NODAL|CELLCENTERED", options.get("VARLOCATION", ""), re.IGNORECASE)
        if not centred and "[" not in options.get("VARLOCATION", ""):
            centred = {i for i, word in enumerate(listed) if word.upper() == "CELLCENTERED"}
        columns: list[Floats | None] = [None] * count
        for i, source in shared.items():
            if not (0 <= i < count and 0 <= source < len(self.zones)):
                raise MeshError(
                    f"zone {self.name!r} shares variables with a zone that is not there"
                )
            columns[i] = self.zones[source][0][i]
        own = [i for i in range(count) if i not in shared and i not in passive]
        sizes = [cells if i in centred else nodes for i in own]
        if not block and centred:
            raise MeshError("values by cell are not read in a zone of points")
        total = sum(sizes)
        flat, rest = _split(zone.lines, total)
        if block:
            cuts = np.cumsum([0, *sizes])
            for i, start, stop in zip(own, cuts[:-1], cuts[1:], strict=True):
                columns[i] = None if i in centred else flat[start:stop]
        elif own:
            table = flat.reshape(nodes, len(own))
            for j, i in enumerate(own):
                columns[i] = table[:, j]
        self.centred = centred
        return columns, rest

    def _connectivity(self, form: str, elements: int, rest: list[bytes]) -> Ints:
        source = self._count("CONNECTIVITYSHAREZONE", "DUPLIST")
        if source and "CONNECTIVITYSHAREZONE" in self.options:
            found = self.zones[source - 1][1] if source <= len(self.zones) else None
            if found is None:
                raise MeshError(f"zone {self.name!r} shares elements with a zone that is not there")
            return found
        width = _NODES[form][1]
        flat = numbers.ints(b"\n".join(rest))
        if len(flat) < width * elements:
            raise MeshError(f"{CUT_OFF}: zone {self.name!r} announces {elements} elements")
        return flat[: width * elements].reshape(-1, width) - 1

    def _axes(self, columns: list[Floats | None]) -> list[Floats]:
        """The coordinates: the variables called x, y and z, else the first two or three."""
        names = [name.split("[")[0].split("(")[0].strip().upper() for name in self.zone.variables]
        plain = {"COORDINATEX": "X", "COORDINATEY": "Y", "COORDINATEZ": "Z", "X-COORDINATE": "X",
                 "Y-COORDINATE": "Y", "Z-COORDINATE": "Z"}  # fmt: skip
        names = [plain.get(name, name) for name in names]
        rows = [names.index(axis) for axis in "XYZ" if axis in names]
        if len(rows) < 2:
            rows = list(range(min(2, len(columns))))
        found = [column for i in rows if (column := columns[i]) is not None]
        if len(found) < 2:
            raise MeshError(f"zone {self.name!r} has no coordinates")
        self.rows = rows
        return found

    def _fields(self, columns: list[Floats | None], nodes: int) -> None:
        for i, name in enumerate(self.zone.variables):
            column = columns[i]
            if i in self.rows:
                continue
            if name in OURS and column is not None and len(column) == nodes:
                self.build.data[name] = column
            elif i in self.centred:
                self.build.dropped.append(f"cell data {name!r}")
            else:
                self.build.dropped.append(f"point data {name!r}")


def _split(lines: list[bytes], total: int) -> tuple[Floats, list[bytes]]:
    """The first so many numbers, which end at the end of a line, and the lines behind them."""
    if total > sum(len(line) + 1 for line in lines):
        raise MeshError(f"{CUT_OFF}: {total} numbers are announced")
    at, found, parts = 0, 0, []
    while found < total:
        # a line holds at least one number: so many lines are not too many unless they hold more
        step = max(1, (total - found) // max(1, len(lines[at].split()) if at < len(lines) else 1))
        part = numbers.floats(b"\n".join(_repeated(lines[at : at + step])))
        if at >= len(lines):
            raise MeshError(f"{CUT_OFF}: {total} numbers are announced")
        if found + len(part) > total and step > 1:
            step = 1
            part = numbers.floats(b"\n".join(_repeated(lines[at : at + 1])))
        parts.append(part)
        found += len(part)
        at += step
    if found != total:
        raise MeshError("it is damaged: a line of numbers goes on beyond its zone's values")
    return np.concatenate([np.zeros(0), *parts]), lines[at:]


def _repeated(lines: list[bytes]) -> list[bytes]:
    """The lines with "3*1.5" written out; such repetitions are short."""
    if not any(b"*" in line for line in lines):
        return lines
    out, room = [], _MOST_REPEATED
    for line in lines:
        words = []
        for word in line.replace(b",", b" ").split():
            count, star, value = word.partition(b"*")
            times = numbers.count_of(count, room) if star else 1
            room -= times if star else 0
            words += [value if star else word] * times
        out.append(b" ".join(words))
    return out
