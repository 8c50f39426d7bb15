"""Abaqus input files (.inp): nodes, elements, sets, surfaces, sections, parts and instances.

After the Abaqus Keywords Reference Guide. Each instance is a part of the file; without an assembly
each part is one. What generates nodes or elements instead of listing them is refused, since the
mesh would lack them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.builder import Builder, Placed
from meshwright_core.io.readers.numbers import CUT_OFF, Floats, Ints

_SURFACE = re.compile(
    r"(?:S|DS|STRI|CPS|CPE|CPEG|CAX|CGAX|CAXA|M3D|SFM3D|SFMGAX|MAX|DC2D|DCC2D|DCAX|DCCAX|AC2D"
    r"|ACAX|F2D|FAX|R3D|Q3D|EMC2D|COH2D|COHAX|GK2D|CINPE|CINPS|CINAX|WARP2D|PSI2D)([34689]|65)"
)
_LINE = re.compile(
    r"(?:B2|B3|T2D|T3D|R2D|RAX|SAX|MAX|DC1D|AC1D|FAX|RB2D|RB3D|PIPE2|PIPE3|SFMAX)\d+"
)
_NODES = re.compile(r"(?:C3D|DC3D|DCC3D|SC|CSS|AC3D|CCL|COH3D|CIN3D|EMC3D|F3D|Q3D|GK3D)(\d+)")
_SURFACE_NODES = {3: ("triangle", 3), 4: ("quad", 4), 6: ("triangle", 6), 65: ("triangle", 6),
                  8: ("quad", 8), 9: ("quad", 9)}  # fmt: skip
_GENERATES = frozenset(
    {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYMMETRIC MODEL GENERATION"}
)


@dataclass
class _Block:
    """A keyword with its options and its lines of data."""

    keyword: str
    options: dict[str, str]
    lines: list[bytes]


@dataclass
class _Part:
    """The blocks of a part, or of what lies outside of all parts."""

    name: str
    blocks: list[_Block] = field(default_factory=list)


@dataclass
class _Instance:
    name: str
    part: str
    blocks: list[_Block]
    place: Floats


def read(data: bytes) -> Content:
    """Return the content of an Abaqus input file.

    Raises:
        MeshError: damage, or nodes or elements that are generated, not listed.
    """
    free, parts, instances = _sorted(_blocks(numbers.text_of(data)))
    build = Builder()
    several = len(instances) + (0 if instances else len(parts)) > 1
    if instances:
        for one in instances:
            if one.part.upper() not in parts:
                raise MeshError(f"there is no part {one.part!r} of instance {one.name!r}")
            build.part(one.name, region=True)
            _Reader(build, several).take([*parts[one.part.upper()].blocks, *one.blocks])
            _placed(build, one.place)
    else:
        for part in parts.values():
            build.part(part.name, region=True)
            _Reader(build, several).take(part.blocks)
    if not (parts or instances) or any(b.keyword in ("NODE", "ELEMENT") for b in free):
        build.part()
        _Reader(build, False).take(free)
    return build.content()


def _blocks(text: bytes) -> Iterator[_Block]:
    """The keywords of a file; a keyword line that ends in a comma goes on in the next."""
    lines = text.split(b"\n")
    stars = [i for i, line in enumerate(lines) if line.lstrip().startswith(b"*")]
    heads = [i for i in stars if not lines[i].lstrip().startswith(b"**")]
    comments = set(stars) - set(heads)
    for i, stop in zip(heads, [*heads[1:], len(lines)][: len(heads)], strict=True):
        head, at = numbers.words_of(lines[i]).strip(), i + 1
        while head.endswith(",") and at < stop:
            head, at = head + numbers.words_of(lines[at]).strip(), at + 1
        keyword, *options = head[1:].split(",")
        named = dict(_option(option) for option in options if option.strip())
        body = [lines[j] for j in range(at, stop) if j not in comments and lines[j].strip()]
        yield _Block(" ".join(keyword.upper().split()), named, body)


def _option(text: str) -> tuple[str, str]:
    name, _, value = text.partition("=")
    return " ".join(name.upper().split()), value.strip().strip('"')


def _sorted(
    blocks: Iterator[_Block],
) -> tuple[list[_Block], dict[str, _Part], list[_Instance]]:
    """The blocks outside of parts and instances, the parts by name, and the instances."""
    free: list[_Block] = []
    parts: dict[str, _Part] = {}
    instances: list[_Instance] = []
    into = free
    for block in blocks:
        match block.keyword:
            case "PART":
                name = block.options.get("NAME", f"part {len(parts) + 1}")
                part = _Part(name)
                parts[name.upper()] = part
                into = part.blocks
            case "INSTANCE":
                place = numbers.floats(numbers.joined_lines(block.lines))
                one = _Instance(
                    block.options.get("NAME", ""), block.options.get("PART", ""), [], place
                )
                instances.append(one)
                into = one.blocks
            case "END PART" | "END INSTANCE":
                into = free
            case "INCLUDE":
                shown = block.options.get("INPUT", "")
                raise MeshError(f"it includes another file ({shown[:60]}), which is not read")
            case _:
                into.append(block)
    return free, parts, instances


def _placed(build: Builder, place: Floats) -> None:
    """Move and turn an instance: an offset, then an axis by two points, and an angle in degrees."""
    if len(place) >= 3:
        build.shift(place[:3])
    if len(place) < 10:
        return
    a, b, angle = place[3:6], place[6:9], np.radians(place[9])
    axis = b - a
    length = np.linalg.norm(axis)
    if length == 0:
        raise MeshError("the axis that an instance is turned about has no length")
    x, y, z = axis / length
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    build.shift(a - turn @ a, turn)


class _Reader:
    """Takes the blocks of one part."""

    def __init__(self, build: Builder, several: bool) -> None:
        self.build, self.several = build, several
        self.sets: dict[str, tuple[str, Ints]] = {}
        self.node_sets: dict[str, tuple[str, Ints]] = {}
        self.placed: dict[str, list[Placed]] = {}

    def take(self, blocks: list[_Block]) -> None:
        for block in blocks:
            if block.keyword in _GENERATES:
                raise MeshError(f"*{block.keyword} is not read: nodes or elements would be missing")
            if block.keyword == "SYSTEM" and block.lines:
                raise MeshError("*SYSTEM is not read: nodes would be at wrong places")
        for keyword, method in (
            ("NODE", self._nodes),
            ("ELEMENT", self._elements),
            ("NSET", self._node_set),
            ("ELSET", self._element_set),
            ("SURFACE", self._surface),
        ):
            for block in blocks:
                if block.keyword == keyword:
                    method(block)
        self._name()

    def _nodes(self, block: _Block) -> None:
        if block.options.get("SYSTEM", "R").upper() not in ("R", ""):
            raise MeshError("nodes in cylindrical or spherical coordinates are not read")
        if "INPUT" in block.options:
            raise MeshError("nodes in another file (INPUT=) are not read")
        if not block.lines:
            return
        table = _table(block.lines)
        ids = numbers.whole(table[:, 0])
        self.build.points(table[:, 1:4] if table.shape[1] > 1 else np.zeros((len(ids), 3)), ids)
        if name := block.options.get("NSET"):
            self._extend(self.node_sets, name, ids)

    def _elements(self, block: _Block) -> None:
        if "INPUT" in block.options:
            raise MeshError("elements in another file (INPUT=) are not read")
        code = block.options.get("TYPE", "").upper()
        kind, nodes = _kind(code)
        if not block.lines:
            return
        table = _element_table(block.lines, nodes)
        if kind in ("triangle", "quad", "line") and table.shape[1] <= nodes:
            raise MeshError(f"{CUT_OFF} or damaged: elements {code} have {nodes} nodes each")
        placed = self.build.cells(kind, table[:, 1:], table[:, 0])
        if name := block.options.get("ELSET"):
            self._extend(self.sets, name, table[:, 0])
        self.placed.setdefault(code, []).extend(placed)

    def _extend(self, sets: dict[str, tuple[str, Ints]], name: str, ids: Ints) -> None:
        known = sets.get(name.upper(), (name, np.zeros(0, np.int64)))
        sets[name.upper()] = (known[0], np.concatenate([known[1], ids]))

    def _members(self, block: _Block, sets: dict[str, tuple[str, Ints]]) -> Ints:
        """The numbers in a set: listed, as ranges, or by the names of other sets."""
        found: list[Ints] = []
        if "GENERATE" in block.options:
            for line in block.lines:
                row = numbers.ints(line.replace(b",", b" "))
                first, last, step = [*row.tolist(), 1][:3] if len(row) in (2, 3) else (0, 0, 0)
                if step < 1 or last < first:
                    raise MeshError("a range of a set is damaged")
                known = self.build.total + sum(len(ids) for ids, _ in self.build.numbered())
                if (last - first) // step > known:
                    raise MeshError("a range of a set is longer than the file")
                found.append(np.arange(first, last + 1, step))
            return np.concatenate([np.zeros(0, np.int64), *found])
        words = [word.strip() for word in b",".join(block.lines).split(b",") if word.strip()]
        plain = [word for word in words if word.isdigit()]
        found.append(numbers.ints(b" ".join(plain)))
        for word in words:
            if not word.isdigit():
                name = numbers.words_of(word).strip('"').rpartition(".")[2].upper()
                found.append(sets.get(name, ("", np.zeros(0, np.int64)))[1])
        return np.concatenate(found)

    def _node_set(self, block: _Block) -> None:
        name = block.options.get("NSET", "")
        if name and "INTERNAL" not in block.options:
            self._extend(self.node_sets, name, self._members(block, self.node_sets))

    def _element_set(self, block: _Block) -> None:
        if name := block.options.get("ELSET", ""):
            self._extend(self.sets, name, self._members(block, self.sets))

    def _surface(self, block: _Block) -> None:
        """Sides of elements: an element or a set of them, and S1 to S4 (E1 to E4 for shells)."""
        name = block.options.get("NAME", "")
        if not name or block.options.get("TYPE", "ELEMENT").upper() != "ELEMENT":
            return
        for line in block.lines:
            words = [numbers.words_of(word).strip() for word in line.split(b",")]
            side = re.fullmatch(r"[SE]([1-4])", words[1].upper()) if len(words) > 1 else None
            if side is None:
                continue
            ids = (
                np.array([int(words[0])])
                if words[0].isdigit() and len(words[0]) < 18
                else self.sets.get(words[0].strip('"').upper(), ("", np.zeros(0, np.int64)))[1]
            )
            start = int(side[1]) - 1
            for placed in self.build.elements(ids):
                corners = self.build.corners_of(placed)
                if placed.kind in ("triangle", "quad") and start < corners.shape[1]:
                    ends = [start, (start + 1) % corners.shape[1]]
                    self.build.edge_indices(name, corners[:, ends])

    def _name(self) -> None:
        """Name regions and sides by the sets; those that hold all elements name nothing new."""
        for name, ids in self.sets.values():
            if name.startswith("_"):
                continue  # of a surface, made by Abaqus/CAE
            self.build.group(name, self.build.elements(ids))
        for name, ids in self.node_sets.values():
            if name.upper() not in self.sets:  # such a set holds all nodes of its elements
                self.build.node_set(name, ids)


def _kind(code: str) -> tuple[str, int]:
    """Kind and number of nodes of an element type; 0 nodes if they are not known."""
    if found := _SURFACE.match(code):
        return _SURFACE_NODES[int(found[1])]
    if code in ("SAX1", "RAX2", "DC1D2", "AC1D2") or _LINE.fullmatch(code.rstrip("HRETW")):
        digit = code.rstrip("HRETW")[-1]
        return "line", 3 if digit in "3" and code[:2] != "T3" else 2
    found = _NODES.match(code)
    return f"type {code or '(none)'}", int(found[1]) if found else 0


def _element_table(lines: list[bytes], nodes: int) -> Ints:
    """Rows of an element's number and its nodes; a row goes on where its line ends in a comma.

    Some programs end every line with a comma: a line with all nodes of the type is then whole, if
    all lines are alike.
    """
    flat = numbers.ints(numbers.joined_lines(lines))
    first = len(lines[0].replace(b",", b" ").split())
    width = first
    if (lines[0].rstrip().endswith(b",") and first * len(lines) != len(flat)) or first <= nodes:
        width = 0
        for line in lines:
            width += len(line.replace(b",", b" ").split())
            if not line.rstrip().endswith(b","):
                break
    if width < 2 or len(flat) % width:
        raise MeshError(f"{CUT_OFF} or damaged: lines of elements of different lengths")
    return flat.reshape(-1, width)


def _table(lines: list[bytes]) -> Floats:
    """Lines of numbers as a table; missing and empty fields are 0."""
    widths = {line.rstrip().rstrip(b",").count(b",") for line in lines}
    if len(widths) == 1:
        width = widths.pop() + 1
        flat = numbers.floats(numbers.joined_lines(lines))
        if len(flat) == width * len(lines):
            return flat.reshape(-1, width)
    table = np.zeros((len(lines), 4))
    for i, line in enumerate(lines):
        words = line.split(b",")[:4]
        for j, word in enumerate(words):
            if word.strip():
                value = numbers.floats(word)
                if len(value) != 1:
                    raise MeshError("it is damaged: a node line is not understood")
                table[i, j] = value[0]
    return table
