"""Wavefront OBJ, Object File Format and STL files."""

from __future__ import annotations

import re

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers, vtk_cells
from meshwright_core.io.readers.builder import Builder, Placed
from meshwright_core.io.readers.numbers import CUT_OFF, Ints

_OBJ_DATA = {
    b"vt": "point data 'texture coordinates'",
    b"vn": "point data 'normals'",
    b"mtllib": "the library of materials",
}
_AFTER_SLASH = re.compile(rb"/\S*")
_OFF = re.compile(rb"(?:ST)?C?N?(4)?(n)?OFF$")
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
_END_SOLID = re.compile(rb"\bend\s*solid\b", re.IGNORECASE)
_TAIL = 4096
"""Bytes behind the last facet, at most; a comment of the program that wrote it may stand there."""
_SOLID = re.compile(rb"^\s*solid\b[ \t]*([^\n]*)", re.IGNORECASE | re.MULTILINE)


def read_obj(data: bytes) -> Content:
    """Read the vertices and faces of a Wavefront OBJ file; textures and normals are left.

    Materials, or else groups, or else objects name regions where there are several.
    """
    text = numbers.text_of(data).replace(b"\\\n", b" ")
    build = Builder()
    build.part()
    points: list[bytes] = []
    faces: list[bytes] = []
    lines: list[bytes] = []
    before: list[int] = []
    names: dict[bytes, list[tuple[int, bytes]]] = {b"usemtl": [], b"g": [], b"o": []}
    for line in text.split(b"\n"):
        key, _, rest = line.strip().partition(b" ")
        if b"\t" in key:
            key, _, rest = line.strip().partition(b"\t")
        if key == b"v":
            points.append(rest)
        elif key == b"f":
            faces.append(rest)
            before.append(len(points))
        elif key == b"l":
            lines.append(rest)
        elif key in names:
            names[key].append((len(faces), rest.strip()))
        elif key in _OBJ_DATA:
            build.dropped.append(_OBJ_DATA[key])
        elif key in (b"curv", b"surf", b"vp", b"cstype"):
            build.warnings.append("its free-form curves and surfaces are not read")
    build.points(_first_three(points))
    sizes = np.array([len(face.split(b"#")[0].split()) for face in faces], np.int64)
    flat = numbers.ints(_AFTER_SLASH.sub(b"", b"\n".join(face.split(b"#")[0] for face in faces)))
    if len(flat) != int(sizes.sum()):
        raise MeshError("it is damaged: a face is not understood")
    if (flat == 0).any():
        raise MeshError("it is damaged: a face names point 0, and they are numbered from 1")
    relative = np.repeat(np.array(before, np.int64), sizes)
    flat = np.where(flat > 0, flat - 1, relative + flat)
    placed = vtk_cells.add_lists(build, "POLYGONS", sizes, flat, 0)
    for found in names.values():
        if _name_regions(build, placed, found, len(faces)):
            break
    return build.content()


def _first_three(lines: list[bytes]) -> np.ndarray:
    """The first three numbers of each line; weights and colours may follow."""
    if not lines:
        return np.zeros((0, 3))
    flat = numbers.floats(b"\n".join(line.split(b"#")[0] for line in lines))
    width = len(flat) // len(lines)
    if width >= 2 and width * len(lines) == len(flat):
        same = all(len(lines[i].split(b"#")[0].split()) == width for i in (0, -1, len(lines) // 2))
        if same and (width == 3 or all(len(one.split(b"#")[0].split()) == width for one in lines)):
            return flat.reshape(-1, width)[:, :3]
    rows = [line.split(b"#")[0].split()[:3] for line in lines]
    short = next((i for i, row in enumerate(rows) if len(row) < 2), -1)
    if short >= 0:
        raise MeshError(f"{CUT_OFF} or damaged: point {short} has not all its coordinates")
    return numbers.floats(b" ".join(b" ".join([*row, b"0"][:3]) for row in rows)).reshape(-1, 3)


def _name_regions(
    build: Builder, placed: list[Placed], found: list[tuple[int, bytes]], faces: int
) -> bool:
    """Name cells by runs of faces, (first face, name); False if there are not several names."""
    starts = np.array([start for start, _ in found] + [faces], np.int64)
    runs: dict[bytes, list[Ints]] = {}
    for (first, name), stop in zip(found, starts[1:], strict=True):
        if stop > first and name:
            runs.setdefault(name, []).append(np.arange(first, stop))
    if len(runs) < 2:
        return False
    for name, parts in runs.items():
        rows = np.concatenate(parts)
        inside = [one._replace(rows=one.rows[np.isin(one.which, rows)]) for one in placed]
        build.group(numbers.words_of(name), inside)
    return True


def read_off(data: bytes) -> Content:
    """Read an Object File Format file, one point or face a line; colours and normals are left."""
    lines = [line.partition(b"#")[0].strip() for line in numbers.text_of(data).split(b"\n")]
    lines = [line for line in lines if line]
    head = lines[0].split() if lines else []
    if len(head) in (2, 3) and all(word.isdigit() for word in head):  # the word is optional
        lines, head = [b"OFF", *lines], [b"OFF"]
    elif head[:1] == [b"off"]:
        head[0] = b"OFF"
    kind = _OFF.match(head[0]) if head else None
    if kind is None:
        raise MeshError('it does not begin with "OFF"')
    if kind[1] or kind[2]:
        raise MeshError("points of four and more coordinates are not read")
    if b"BINARY" in head:
        raise MeshError("binary files of this format are not read")
    words, at = (head[1:], 1) if len(head) > 1 else (lines[1].split() if len(lines) > 1 else [], 2)
    if len(words) < 2:
        raise MeshError(f"{CUT_OFF}: its numbers of points and faces are missing")
    n, m = (numbers.count_of(word, len(lines)) for word in words[:2])
    if len(lines) < at + n + m:
        raise MeshError(f"{CUT_OFF}: {n} points and {m} faces are announced")
    build = Builder()
    build.part()
    build.points(_first_three(lines[at : at + n]))
    faces = lines[at + n : at + n + m]
    sizes = np.array([len(line.split()) for line in faces], np.int64)
    flat = numbers.floats(b"\n".join(faces))  # colours may be fractions
    starts = np.concatenate([[0], np.cumsum(sizes)])[:-1]
    counts = numbers.whole(flat[starts]) if m else np.zeros(0, np.int64)
    if (counts < 0).any() or (counts + 1 > sizes).any():
        raise MeshError(f"{CUT_OFF} within a face")
    codes = np.full(m, 7)
    keep = np.repeat(starts + 1 - np.concatenate([[0], np.cumsum(counts)])[:-1], counts)
    members = numbers.whole(flat[keep + np.arange(len(keep))])
    vtk_cells.add_cells(build, codes, counts, members)
    return build.content()


def read_stl(data: bytes) -> Content:
    """Read an STL file, binary or text: triangles without common points; each solid is a part."""
    data = numbers.without_mark(data)
    count = int.from_bytes(data[80:84], "little")
    text = data.lstrip()[:5].lower() == b"solid"
    exact = len(data) == 84 + 50 * count
    binary = exact or not text or b"\0" in data[:256] or b"facet" not in data[:4096].lower()
    if len(data) >= 84 and binary:
        if len(data) < 84 + 50 * count:
            raise MeshError(f"{CUT_OFF}: {count} triangles are announced")
        facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
        corners = np.frombuffer(data, facet, count, 84)["corners"].astype(float)
        build = Builder()
        _add_triangles(build, "", corners.reshape(-1, 3))
        return build.content()
    if not text:
        raise MeshError("it is no STL file, neither text nor binary")
    return _text_stl(numbers.text_of(data))


def _text_stl(text: bytes) -> Content:
    tail = text[-_TAIL:]
    if not _END_SOLID.search(tail, max(0, tail.lower().rfind(b"endfacet"))):
        raise MeshError(f'{CUT_OFF}: it does not end with "endsolid"')
    build = Builder()
    heads = list(_SOLID.finditer(text))
    stops = [*(head.start() for head in heads[1:]), len(text)]
    for head, stop in zip(heads, stops, strict=True):
        body = text[head.end() : stop]
        found = _VERTEX.findall(body)
        if len(found) != 3 * body.lower().count(b"endfacet"):
            raise MeshError("its facets do not have three corners each")
        flat = numbers.floats(b" ".join(word for row in found for word in row))
        if len(flat) != 3 * len(found):
            raise MeshError("it is damaged: a coordinate is not a number")
        _add_triangles(build, numbers.words_of(head[1]).strip(), flat.reshape(-1, 3))
    return build.content()


def _add_triangles(build: Builder, name: str, corners: np.ndarray) -> None:
    build.part(name, region=bool(name))
    build.points(corners)
    build.cells("triangle", np.arange(len(corners)).reshape(-1, 3))
