"""Abaqus input files (.inp): nodes, elements, sets, surfaces, sections, parts and instances.

After the Abaqus Keywords Reference Guide. Each instance is a part of the file; without an assembly
each part is one. Sets and surfaces of the assembly name sides and regions of its instances. Files
that are included are read from beside the deck. What generates nodes or elements instead of listing
them is refused, since the mesh would lack them; what is no mesh, such as materials and steps, and
elements that are points or connectors are left out, and noted.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import includes, numbers
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.fields import contents_of
from meshwright_core.io.readers.numbers import CUT_OFF, Floats, Ints

_SURFACE = re.compile(
    r"(?:S|DS|STRI|CPS|CPE|CPEG|CAX|CGAX|CAXA|M3D|SFM3D|SFMGAX|MAX|DC2D|DCC2D|DCAX|DCCAX|AC2D"
    r"|ACAX|F2D|FAX|R3D|Q3D|EMC2D|COH2D|COHAX|GK2D|CINPE|CINPS|CINAX|WARP2D|PSI2D)([34689]|65)"
)
_LINE = re.compile(
    r"(?:(T2D|T3D|DC1D|AC1D)([23])|(?:B2|B3|SAX|MAX|SFMAX|PIPE2|PIPE3)([123])"
    r"|(?:R2D|RAX|FAX|RB2D|RB3D|FRAME2|FRAME3)\d)[A-Z]*"
)
_POINTS = re.compile(
    r"MASS|ROTARYI|HEATCAP|INERTIA|SPRING|DASHPOT|CONN|DCOUP|GAP|DGAP|JOINT|DRAG|ITS|ITT|ELBOW|U\d"
)
"""Types that join or load points, and are neither sides nor surfaces."""
_NODES = re.compile(r"(?:C3D|DC3D|DCC3D|SC|CSS|AC3D|CCL|COH3D|CIN3D|EMC3D|F3D|Q3D|GK3D)(\d+)")
_SURFACE_NODES = {3: ("triangle", 3), 4: ("quad", 4), 6: ("triangle", 6), 65: ("triangle", 6),
                  8: ("quad", 8), 9: ("quad", 9)}  # fmt: skip
_GENERATES = frozenset(
    {"NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYMMETRIC MODEL GENERATION"}
)
_READ = frozenset(
    {"NODE", "ELEMENT", "NSET", "ELSET", "SURFACE", "PART", "END PART", "INSTANCE", "END INSTANCE",
     "ASSEMBLY", "END ASSEMBLY", "HEADING", "PREPRINT", "END STEP"}
)  # fmt: skip
_SPLIT = re.compile(r'(?:"[^"]*"|[^,"])+|"')
"""Words between commas, of which those in quotes do not count."""
_STARTS = re.compile(rb"^[ \t]*\*[ \t]*(?:INCLUDE|NODE|ELEMENT|NSET|ELSET)\b", re.I | re.M)
_INPUT = re.compile(r",\s*INPUT\s*=\s*(\"[^\"]*\"|[^,]+)", re.I)


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


def read_path(path: Path) -> Content:
    """Return the content of an Abaqus input file and the files that it includes.

    Raises:
        MeshError: damage, a file that is not there, or nodes or elements that are generated, not
            listed.
    """
    return read(includes.expanded(path, _STARTS, _included))


def _included(line: str) -> tuple[str, str] | None:
    """What stays of a keyword line whose data are in another file, and that file."""
    found = _INPUT.search(line)
    if found is None:
        return None
    rest = "" if "INCLUDE" in line.upper().split(",")[0] else line[: found.start()]
    return rest + (line[found.end() :] if rest else ""), found[1].strip().strip('"')


def read(data: bytes) -> Content:
    """Return the content of an Abaqus input file that includes no others; errors as above."""
    deck = _sorted(_blocks(numbers.text_of(data)))
    parts, instances = deck.parts, deck.instances
    build = Builder()
    several = len(instances) + (0 if instances else len(parts)) > 1
    if instances:
        for one in instances:
            if one.part.upper() not in parts:
                raise MeshError(f"there is no part {one.part!r} of instance {one.name!r}")
            build.part(one.name, region=True)
            reader = _Reader(build, several)
            reader.take([*parts[one.part.upper()].blocks, *one.blocks])
            reader.take_assembly(one.name, [*deck.assembly, *deck.free])
            _placed(build, one.place)
    else:
        for part in parts.values():
            build.part(part.name, region=True)
            _Reader(build, several).take(part.blocks)
    free = deck.free
    if instances:
        free = [block for block in free if "INSTANCE" not in block.options]
    if not (parts or instances) or any(b.keyword in ("NODE", "ELEMENT") for b in free):
        build.part()
        _Reader(build, False).take(free)
    if deck.others:
        build.dropped.append(contents_of(deck.others))
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
        keyword, *options = _SPLIT.findall(head[1:]) or [""]
        named = dict(_option(option) for option in options if option.strip())
        body = [lines[j] for j in range(at, stop) if j not in comments and lines[j].strip()]
        yield _Block(" ".join(keyword.upper().split()), named, body)


def _option(text: str) -> tuple[str, str]:
    name, _, value = text.partition("=")
    return " ".join(name.upper().split()), value.strip().strip('"')


@dataclass
class _Deck:
    """The blocks of a file by where they stand, and the keywords of what is no mesh."""

    free: list[_Block] = field(default_factory=list)
    assembly: list[_Block] = field(default_factory=list)
    parts: dict[str, _Part] = field(default_factory=dict)
    instances: list[_Instance] = field(default_factory=list)
    others: set[str] = field(default_factory=set)


def _sorted(blocks: Iterator[_Block]) -> _Deck:
    """The blocks outside of parts, of the assembly, of parts by name, and of instances."""
    deck = _Deck()
    outside = into = deck.free
    for block in blocks:
        match block.keyword:
            case "PART":
                name = block.options.get("NAME", f"part {len(deck.parts) + 1}")
                part = _Part(name)
                deck.parts[name.upper()] = part
                into = part.blocks
            case "ASSEMBLY":
                outside = into = deck.assembly
            case "INSTANCE":
                place = numbers.floats(numbers.joined_lines(block.lines))
                one = _Instance(
                    block.options.get("NAME", ""), block.options.get("PART", ""), [], place
                )
                deck.instances.append(one)
                into = one.blocks
            case "END PART" | "END INSTANCE":
                into = outside
            case "END ASSEMBLY":
                outside = into = deck.free
            case "INCLUDE":
                shown = block.options.get("INPUT", "")
                raise MeshError(f"it includes another file ({shown[:60]}), which is not read")
            case _:
                into.append(block)
                if block.keyword not in _READ | _GENERATES:
                    deck.others.add(f"*{block.keyword[:40]}")
    return deck


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


_Sets = dict[str, tuple[str, Ints]]
"""Names and members of sets by the name in capitals."""
_NONE = ("", np.zeros(0, np.int64))


class _Reader:
    """Takes the blocks of one part or instance, and those of the assembly that name its sets."""

    def __init__(self, build: Builder, several: bool) -> None:
        self.build, self.several = build, several
        self.sets: _Sets = {}
        self.node_sets: _Sets = {}
        self.instance = ""
        self.of_part: tuple[_Sets, _Sets] = ({}, {})
        """Sets of elements and of nodes of the part, while those of the assembly are read."""

    def take(self, blocks: list[_Block]) -> None:
        for block in blocks:
            if block.keyword in _GENERATES:
                raise MeshError(f"*{block.keyword} is not read: nodes or elements would be missing")
            if block.keyword == "SYSTEM" and block.lines:
                raise MeshError("*SYSTEM is not read: nodes would be at wrong places")
        for keyword, method in (("NODE", self._nodes), ("ELEMENT", self._elements)):
            for block in blocks:
                if block.keyword == keyword:
                    method(block)
        self._take_sets(blocks)

    def take_assembly(self, instance: str, blocks: list[_Block]) -> None:
        """Take the sets and surfaces outside of the parts that are of this instance."""
        self.instance = instance.upper()
        self.of_part = (self.sets, self.node_sets)
        self.sets, self.node_sets = {}, {}
        self._take_sets(blocks)

    def _take_sets(self, blocks: list[_Block]) -> None:
        for keyword, method in (
            ("ELSET", self._element_set),
            ("NSET", self._node_set),
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
        if kind == "point":
            self.build.dropped.append(f"the elements of type {code[:20]}")
            return
        table = _element_table(block.lines, nodes)
        if kind in ("triangle", "quad", "line") and table.shape[1] <= nodes:
            raise MeshError(f"{CUT_OFF} or damaged: elements {code} have {nodes} nodes each")
        ends = table[:, [1, 3]] if kind == "line" and nodes == 3 else table[:, 1:]
        self.build.cells(kind, ends, table[:, 0])
        if name := block.options.get("ELSET"):
            self._extend(self.sets, name, table[:, 0])

    def _extend(self, sets: _Sets, name: str, ids: Ints) -> None:
        known = sets.get(name.upper(), (name, np.zeros(0, np.int64)))
        sets[name.upper()] = (known[0], np.concatenate([known[1], ids]))

    def _members(self, block: _Block, sets: _Sets) -> Ints:
        """The numbers in a set: listed, as ranges, or by the names of other sets."""
        found: list[Ints] = [np.zeros(0, np.int64)]
        mine = self._is_mine(block)
        if "GENERATE" in block.options:
            for line in block.lines if mine else ():
                row = numbers.ints(line.replace(b",", b" "))
                first, last, step = [*row.tolist(), 1][:3] if len(row) in (2, 3) else (0, 0, 0)
                if step < 1 or last < first:
                    raise MeshError("a range of a set is damaged")
                known = self.build.total + sum(len(ids) for ids, _ in self.build.numbered())
                if (last - first) // step > known:
                    raise MeshError("a range of a set is longer than the file")
                found.append(np.arange(first, last + 1, step))
            return np.concatenate(found)
        words = [word.strip() for word in b",".join(block.lines).split(b",") if word.strip()]
        plain = [word for word in words if word.isdigit()]
        if mine:
            found.append(numbers.ints(b" ".join(plain)))
        if len(plain) < len(words):
            found += [
                self._called(numbers.words_of(word), sets) for word in words if not word.isdigit()
            ]
        return np.concatenate(found)

    def _is_mine(self, block: _Block) -> bool:
        """Whether the numbers in a block are those of this part or instance."""
        return block.options.get("INSTANCE", "").upper() == self.instance

    def _called(self, word: str, sets: _Sets) -> Ints:
        """The members of a set by its name, or a number, with its instance before it or not."""
        name = word.strip().strip('"').upper()
        if name in sets:
            return sets[name][1]
        instance, dot, inner = name.rpartition(".")
        inner = inner.strip('"')
        if not dot or (self.instance and instance.strip('"') != self.instance):
            return _NONE[1]
        if inner.isdigit() and len(inner) < 18:
            return np.array([int(inner)])
        among = self.of_part[0 if sets is self.sets else 1] if self.instance else sets
        return among.get(inner, _NONE)[1]

    def _node_set(self, block: _Block) -> None:
        name = block.options.get("NSET", "")
        if not name or "INTERNAL" in block.options:
            return
        if "ELSET" in block.options:  # the nodes of a set of elements
            ids = self._called(block.options["ELSET"], self.sets)
            ends = [self.build.corners_of(one).ravel() for one in self.build.elements(ids)]
            if ends:
                self.build.point_set(name, np.unique(np.concatenate(ends)))
            return
        self._extend(self.node_sets, name, self._members(block, self.node_sets))

    def _element_set(self, block: _Block) -> None:
        if name := block.options.get("ELSET", ""):
            self._extend(self.sets, name, self._members(block, self.sets))

    def _surface(self, block: _Block) -> None:
        """Sides of elements: an element or a set of them, and S1 to S4 (E1 to E4 for shells); or
        nodes.
        """
        name = block.options.get("NAME", "")
        kind = block.options.get("TYPE", "ELEMENT").upper()
        if not name or kind not in ("ELEMENT", "NODE"):
            return
        for line in block.lines:
            words = [numbers.words_of(word).strip() for word in line.split(b",")]
            ids = self._listed(words[0], block, self.sets if kind == "ELEMENT" else self.node_sets)
            if kind == "NODE":
                self._extend(self.node_sets, name, ids)
                continue
            side = re.fullmatch(r"[SE]([1-4])", words[1].upper()) if len(words) > 1 else None
            if side is None:
                continue
            start = int(side[1]) - 1
            for placed in self.build.elements(ids):
                corners = self.build.corners_of(placed)
                if placed.kind in ("triangle", "quad") and start < corners.shape[1]:
                    ends = [start, (start + 1) % corners.shape[1]]
                    self.build.edge_indices(name, corners[:, ends])

    def _listed(self, word: str, block: _Block, sets: _Sets) -> Ints:
        """The members of a line of a surface: a number, or a set by name."""
        if word.isdigit() and len(word) < 18:
            return np.array([int(word)] if self._is_mine(block) else [], np.int64)
        return self._called(word, sets)

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
    if found := _LINE.fullmatch(code):
        return "line", 3 if found[2] == "3" or found[3] == "2" else 2
    if found := _SURFACE.match(code):
        return _SURFACE_NODES[int(found[1])]
    if _POINTS.match(code):
        return "point", 0
    found = _NODES.match(code)
    return code or "(none)", int(found[1]) if found else 0


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
