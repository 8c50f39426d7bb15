"""The tags of a DXF file, checked and completed before ezdxf reads them.

ezdxf requires the subclass markers that the reference prescribes, which many writers leave out, and
its messages do not say where a number is wrong. A binary file is turned into text first, so that
the same repairs apply to it.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator

from meshwright_core.errors import MeshError

_BINARY = b"AutoCAD Binary DXF"
_DAMAGED = "it is a binary DXF file that is cut off or damaged"
_MARKERS = {
    b"ELLIPSE": b"AcDbEllipse",
    b"HATCH": b"AcDbHatch",
    b"LWPOLYLINE": b"AcDbPolyline",
    b"SPLINE": b"AcDbSpline",
}
"""Subclasses without whose marker ezdxf does not read an entity."""
_COMMON = {5, 6, 8, 48, 60, 62, 67, 102, 284, 330, 347, 348, 360, 370, 390, 410, 420, 430, 440}
"""Group codes that all entities have."""
_SOLIDS = {b"3DSOLID", b"BODY", b"HELIX", b"MESH", b"REGION", b"SURFACE"}
"""Entities that are left out before ezdxf sees them: it requires all of their parts."""
_READ = {b"ARC", b"CIRCLE", b"ELLIPSE", b"INSERT", b"LINE", b"LWPOLYLINE", b"SPLINE", b"VERTEX"}
"""Entities whose numbers are checked."""

_MODERN, _UNICODE = b"AC1015", b"AC1021"
"""The versions with all these entities, and in which names are in UTF-8."""

Tag = tuple[int, bytes, int]
"""Group code, value, and the line of the value; 0 for the line in a binary file."""


def completed(content: bytes) -> tuple[bytes, list[str], Counter[str]]:
    """Make the content of a DXF file such that ezdxf reads it.

    Returns:
        The content as text; what was repaired; how many entities of which kind were left out.

    Raises:
        MeshError: with the line, where it is not DXF, or cut off within a tag; a curve has a
            number that is none, or lacks one; there is no section of entities.
    """
    binary = content.startswith(_BINARY)
    lines: list[bytes] = []
    sections: set[bytes] = set()
    kinds: set[bytes] = set()
    dropped: Counter[str] = Counter()
    blocks, inserted = set(), {}
    variables: dict[bytes, int] = {}
    ended, previous, kind = False, b"", b""
    entity: list[Tag] = []
    for tag in _binary_tags(content) if binary else _text_tags(content):
        code, value, _ = tag
        if code == 0:
            _append(lines, entity, variables)
            entity = [] if value in _SOLIDS else [tag]
            dropped[value.decode("utf-8", "replace")] += value in _SOLIDS
            kinds.add(value)
            kind = value
            if value == b"EOF":
                ended = True
                break
        elif entity:
            entity.append(tag)
            if code == 2 and kind == b"BLOCK":
                blocks.add(value.upper())
            elif code == 2 and kind == b"INSERT":
                inserted[value.upper()] = value
        if code == 2 and previous == b"SECTION":
            sections.add(value.upper())
        previous = value if code == 0 else b""
    if not ended:
        _append(lines, entity, variables)
    if b"ENTITIES" not in sections and b"BLOCKS" not in sections:
        raise MeshError("it is not a DXF file, or cut off: it has no section ENTITIES")
    notes = [] if ended else ["the end of the file is not marked (EOF): it may be cut off"]
    for name in inserted.keys() - blocks:
        shown = inserted[name].decode("utf-8", "replace")[:40]
        notes.append(f"there is no block named {shown!r}")
    head = _set_version(lines, variables, bool(kinds & _MARKERS.keys()))
    return b"\n".join([*head, *lines, b"0", b"EOF", b""]), notes, +dropped


def _set_version(lines: list[bytes], variables: dict[bytes, int], modern: bool) -> list[bytes]:
    """Correct the version of a file that names none, or one older than its entities.

    Returns:
        A header to be put in front.
    """
    at = variables.get(b"$ACADVER")
    if at is not None:
        if modern and lines[at] < _MODERN:
            lines[at] = _MODERN
        return []
    version = _MODERN
    if b"$DWGCODEPAGE" not in variables:
        try:
            everything = b"\n".join(lines)
            version = _MODERN if everything.isascii() or not everything.decode() else _UNICODE
        except UnicodeDecodeError:
            version = _MODERN
    if not (modern or version == _UNICODE):
        return []
    return [b"0", b"SECTION", b"2", b"HEADER", b"9", b"$ACADVER", b"1", version, b"0", b"ENDSEC"]


def _append(lines: list[bytes], entity: list[Tag], variables: dict[bytes, int]) -> None:
    """Append the lines of an entity, checked, with the markers of its subclass.

    `variables` takes the line of the value of each variable of the header.
    """
    if not entity:
        return
    kind = entity[0][1]
    if kind == b"SECTION" and len(entity) > 1 and entity[1][1] == b"HEADER":
        for i, (code, value, _) in enumerate(entity):
            if code == 9:
                variables[value] = len(lines) + 2 * i + 3
    if kind in _READ:
        _check_numbers(kind.decode(), entity)
    if kind in _MARKERS and (100, _MARKERS[kind]) not in {tag[:2] for tag in entity}:
        rest = [tag for tag in entity[1:] if tag[0] != 100]
        common = [tag for tag in rest if tag[0] in _COMMON]
        own = [tag for tag in rest if tag[0] not in _COMMON]
        marker = (100, b"AcDbEntity", 0), (100, _MARKERS[kind], 0)
        entity = [entity[0], marker[0], *common, marker[1], *own]
    for code, value, _ in entity:
        lines.append(b"%d" % code)
        lines.append(value)


def _check_numbers(kind: str, entity: list[Tag]) -> None:
    abscissas = ordinates = 0
    for code, value, line in entity:
        if not 10 <= code <= 59:
            continue
        abscissas += code == 10
        ordinates += code == 20
        try:
            number = float(value)
        except ValueError:
            number = math.nan
        if not abs(number) < 1e100:
            shown = value.decode("utf-8", "replace")[:40]
            what = f"{shown!r} is no number" if shown else "a number is missing"
            raise MeshError(f"{_at(line)}in the {kind} {what} (group code {code})")
    if abscissas != ordinates:
        code = 20 if abscissas > ordinates else 10
        line = entity[0][2]
        raise MeshError(f"{_at(line)}in the {kind} a number is missing (group code {code})")


def _at(line: int) -> str:
    return f"line {line}: " if line else ""


def _text_tags(content: bytes) -> Iterator[Tag]:
    lines = content.removeprefix(b"\xef\xbb\xbf").splitlines()
    for i in range(0, len(lines), 2):
        head = lines[i].strip()
        try:
            code = int(head)
        except ValueError:
            if not head and not any(line.strip() for line in lines[i:]):
                return
            text = head.decode("utf-8", "replace")
            shown = repr(text if len(text) <= 20 else text[:17] + "...")
            raise MeshError(
                f"line {i + 1}: {shown} stands where a DXF file has a group code"
            ) from None
        if i + 1 == len(lines):
            raise MeshError(f"it is cut off: a value is missing after line {i + 1}")
        if code != 999:
            yield code, lines[i + 1].strip(), i + 2


def _binary_tags(content: bytes) -> Iterator[Tag]:
    from ezdxf.lldxf.tagger import binary_tags_loader
    from ezdxf.tools.codepage import toencoding

    try:
        tags = list(binary_tags_loader(content))
    except Exception as error:
        # what its unpacking raises on damaged files is not documented
        raise MeshError(_DAMAGED) from error
    if not tags:
        raise MeshError(_DAMAGED)
    variables = {
        str(tag.value): str(tags[i + 1].value) for i, tag in enumerate(tags[:-1]) if tag.code == 9
    }
    encoding = "utf-8"
    if variables.get("$ACADVER", "AC1009") < "AC1021":
        encoding = toencoding(variables.get("$DWGCODEPAGE", "ANSI_1252"))
    for tag in tags:
        value = tag.value
        if isinstance(value, bytes):
            written = value.hex().upper().encode()
        elif isinstance(value, str):
            written = value.encode(encoding, "surrogateescape")
        else:
            written = repr(value).encode()
        yield tag.code, written.replace(b"\n", b" ").replace(b"\r", b" "), 0
