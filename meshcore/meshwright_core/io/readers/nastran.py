"""Nastran bulk data (.bdf, .nas, .fem): GRID points and shell elements, in fields of 8 or 16
characters or separated by commas.

After the MSC Nastran Quick Reference Guide. The property of an element is its region, named by the
comments of HyperMesh ("$HMNAME PROP"), ANSA ("$ANSA_NAME_COMMENT") and Femap ("$ Femap Property").
Files that are included are read from beside the deck. Cards that are no mesh are left out, and
noted.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import includes, numbers
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.fields import contents_of
from meshwright_core.io.readers.numbers import Floats

_NODES = {
    "CTRIA3": ("triangle", 3), "CTRIAR": ("triangle", 3), "CTRIA6": ("triangle", 6),
    "CQUAD4": ("quad", 4), "CQUADR": ("quad", 4), "CQUAD8": ("quad", 8), "CQUAD": ("quad", 9),
    "CQUAD9": ("quad", 9),
    "CSHEAR": ("quad", 4), "CPLSTN3": ("triangle", 3), "CPLSTN4": ("quad", 4),
    "CPLSTN6": ("triangle", 6), "CPLSTN8": ("quad", 8), "CPLSTS3": ("triangle", 3),
    "CPLSTS4": ("quad", 4), "CPLSTS6": ("triangle", 6), "CPLSTS8": ("quad", 8),
    "CTRIAX": ("triangle", 6), "CQUADX": ("quad", 9), "CTRAX3": ("triangle", 3),
    "CTRAX6": ("triangle", 6), "CQUADX4": ("quad", 4), "CQUADX8": ("quad", 8),
    "CBAR": ("line", 2), "CBEAM": ("line", 2), "CROD": ("line", 2), "CTUBE": ("line", 2),
    "PLOTEL": ("line", 2),
}  # fmt: skip
_VOLUMES = frozenset({"CTETRA", "CHEXA", "CPENTA", "CPYRAM", "CPYRA"})
_NAMES = (
    re.compile(r'\$HMNAME\s+PROP\s+(\d{1,9})\s*"([^"]*)"'),
    re.compile(r"\$ANSA_NAME_COMMENT;(\d{1,9});P[A-Z]+;([^;]+);"),
    re.compile(r"\$ Femap Property (\d{1,9}) : (.+)"),
)
_COMPONENT = re.compile(r'\$HMNAME\s+COMP\s+(\d{1,9})\s*"([^"]*)"')
"""A component of HyperMesh, which names its property where nothing else does."""
_STARTS = re.compile(rb"^INCLUDE\b", re.IGNORECASE | re.MULTILINE)
_INCLUDE = re.compile(r"""INCLUDE\s*=?\s*(?:'([^']+)'|"([^"]+)"|(\S+))""", re.IGNORECASE)
_SILENT = frozenset({"ENDDATA", "BEGIN", "PARAM", "PLOTEL"})
_EXPONENT = re.compile(rb"(?<=[\d.])([-+])(?=\d)")
_FIELDS = 8
_CORNERS = {"triangle": 3, "quad": 4, "line": 2}


def read_path(path: Path) -> Content:
    """Return the content of a Nastran bulk data file and those that it includes.

    Raises:
        MeshError: points in a coordinate system of their own, a file that is not there, or damage.
    """
    return read(includes.expanded(path, _STARTS, _included))


def _included(line: str) -> tuple[str, str] | None:
    found = _INCLUDE.match(line)
    return ("", (found[1] or found[2] or found[3]).strip()) if found else None


def read(data: bytes) -> Content:
    """Return the content of a Nastran bulk data file that includes no others; errors as above."""
    text = numbers.text_of(data)
    build = Builder()
    ids: list[bytes] = []
    places: list[bytes] = []
    elements: dict[tuple[str, int], list[list[bytes]]] = {}
    volumes: dict[str, int] = {}
    names: dict[int, str] = {}
    plane_systems: set[bytes] = set()
    others: set[str] = set()
    default, alone = b"", False  # the system of points that name none
    for name, fields in _cards(text, names):
        if name == "GRID":
            if len(fields) > 1 and fields[1] not in (b"", b"0"):
                plane_systems.add(fields[1])
            alone |= len(fields) < 2 or not fields[1]
            ids.append(fields[0] if fields else b"")
            places += [field or b"0." for field in (*fields[2:5], b"", b"", b"")[:3]]
        elif name in _NODES:
            kind, nodes = _NODES[name]
            skip = 1 if name == "PLOTEL" else 2
            row = [field for field in fields[skip : skip + nodes]]
            corners = row[: _CORNERS[kind]]
            if len(corners) < _CORNERS[kind] or not all(corners):
                if kind == "line":
                    continue
                raise MeshError(f"it is cut off or damaged: a card {name} lacks points")
            extra = [field for field in row[_CORNERS[kind] :] if field]
            owner = fields[1] if skip == 2 and fields[1] else b"0"
            block = elements.setdefault((kind, len(corners) + (len(extra) if nodes > 4 else 0)), [])
            block.append([fields[0], owner, *corners, *(extra if nodes > 4 else [])])
        elif name in _VOLUMES:
            volumes[name] = volumes.get(name, 0) + 1
        elif name == "INCLUDE":
            raise MeshError("it includes another file, which is not read")
        elif name == "GRDSET":
            default = fields[1] if len(fields) > 1 else b""
        elif name.startswith(("CQUAD", "CTRIA")):
            raise MeshError(f"elements {name[:12]} are not read")
        elif name not in _SILENT and name.isalnum():
            others.add(name[:8])
    if alone and default not in (b"", b"0"):
        plane_systems.add(default)
    if plane_systems:
        shown = numbers.words_of(min(plane_systems))
        raise MeshError(f"points in a coordinate system of their own ({shown}) are not read")
    build.part()
    build.points(_decimal(places).reshape(-1, 3), _whole(ids))
    _add(build, elements, names)
    for name, count in volumes.items():
        build.cells(name, np.zeros((count, 1)))
    if others:
        build.dropped.append(contents_of(others))
    return build.content()


def _add(
    build: Builder, elements: dict[tuple[str, int], list[list[bytes]]], names: dict[int, str]
) -> None:
    owners = set()
    blocks = []
    for (kind, nodes), rows in elements.items():
        flat = _whole([field for row in rows for field in row]).reshape(-1, nodes + 2)
        blocks.append((kind, flat))
        if kind != "line":
            owners |= set(np.unique(flat[:, 1]).tolist())
    for kind, flat in blocks:
        placed = build.cells(kind, flat[:, 2:], flat[:, 0])
        for owner in np.unique(flat[:, 1]).tolist():
            if owner == 0 or (kind != "line" and len(owners) < 2 and owner not in names):
                continue  # no property, or one without a name, which says nothing
            mine = [one._replace(rows=one.rows[flat[one.which, 1] == owner]) for one in placed]
            build.group(names.get(owner, f"property={owner}"), mine, owner)


def _whole(fields: list[bytes]) -> np.ndarray:
    found = numbers.ints(b" ".join(fields))
    if len(found) != len(fields):
        raise MeshError("it is cut off or damaged: a field is empty or holds blanks")
    return found


def _decimal(fields: list[bytes]) -> Floats:
    """Numbers as Nastran writes them: 1.5, 1.5E+3, 1.5D+3, or 1.5+3."""
    text = b" ".join(fields)
    if b"+" in text or b"-" in text:
        text = _EXPONENT.sub(rb"e\1", text)
    found = numbers.floats(text)
    if len(found) != len(fields):
        raise MeshError("it is cut off or damaged: a coordinate is not a number")
    return found


def _cards(text: bytes, names: dict[int, str]) -> Iterator[tuple[str, list[bytes]]]:
    """The cards of the bulk data: name and fields, continuation lines joined."""
    lines = text.split(b"\n")
    start = next((i + 1 for i, line in enumerate(lines) if line.upper().startswith(b"BEGIN")), 0)
    _take_names(lines, names)
    name, fields, width = "", list[bytes](), _FIELDS
    for line in lines[start:]:
        if line.startswith(b"$") or not line.strip():
            continue
        if b"$" in line:
            line = line.partition(b"$")[0]
        if line.upper().startswith(b"ENDDATA"):
            break
        head, more = _fields(line)
        if head[:1] in (b"", b"+", b"*"):
            fields += [b""] * (width - len(fields)) + more
            width += _FIELDS // 2 if head[:1] == b"*" else _FIELDS
            continue
        if name:
            yield name, fields
        name, fields = head.rstrip(b"*").decode("latin-1").upper(), more
        width = _FIELDS // 2 if head.endswith(b"*") else _FIELDS
    if name:
        yield name, fields


def _take_names(lines: list[bytes], names: dict[int, str]) -> None:
    """Enter the names that comments give to properties, by their numbers."""
    components = {}
    for line in lines:
        if not line.startswith((b"$HMNAME", b"$ANSA_NAME", b"$ Femap Prop")):
            continue
        text = numbers.words_of(line)
        if found := _COMPONENT.match(text):
            components[int(found[1])] = found[2].strip()
        for found in filter(None, (one.match(text) for one in _NAMES)):
            names[int(found[1])] = found[2].strip()
    for number, name in components.items():
        names.setdefault(number, name)


def _fields(line: bytes) -> tuple[bytes, list[bytes]]:
    """Name and fields of one line."""
    if b"," in line:
        words = [word.strip() for word in line.split(b",")]
        return words[0], words[1 : 1 + (4 if words[0].endswith(b"*") else _FIELDS)]
    line = line.expandtabs(8)
    head = line[:8].strip()
    if b"*" in head:
        return head, [line[i : i + 16].strip() for i in range(8, min(72, len(line)), 16)]
    return head, [line[i : i + 8].strip() for i in range(8, min(72, len(line)), 8)]
