"""Netgen files (.vol): surface elements, boundary edges and their names, of dimension 2 and 3."""

from __future__ import annotations

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.builder import Builder, Placed
from meshwright_core.io.readers.numbers import CUT_OFF, Ints

_COUNTED = frozenset({
    "surfaceelements", "surfaceelementsgi", "surfaceelementsuv", "surfaceelementstgi",
    "volumeelements", "edgesegments", "edgesegmentsgi", "edgesegmentsgi2", "points",
    "pointelements", "materials", "bcnames", "cd2names", "cd3names", "face_colours",
    "singular_edge_left", "singular_edge_right", "singular_points", "singular_face_inside",
    "singular_face_outside", "identifications", "identificationtypes", "identificationnames",
    "curvedelements",
})  # fmt: skip
_KINDS = {3: ("triangle", 3), 4: ("quad", 4), 6: ("triangle", 6), 8: ("quad", 8)}


def read(data: bytes) -> Content:
    """Return the content of a Netgen file."""
    lines = [line.partition(b"#")[0].strip() for line in numbers.text_of(data).split(b"\n")]
    lines = [line for line in lines if line]
    if not lines or lines[0].lower() != b"mesh3d":
        raise MeshError('it does not begin with "mesh3d"')
    sections: dict[str, list[bytes]] = {}
    dimension, at, ended = 3, 1, False
    while at < len(lines):
        key = numbers.words_of(lines[at]).split()[0].lower()
        at += 1
        if key == "endmesh":
            ended = True
            break
        if key in ("dimension", "geomtype"):
            value = lines[at] if at < len(lines) else b""
            if key == "dimension":
                dimension = numbers.count_of(value, 3)
            at += 1
        elif key in _COUNTED and at < len(lines):
            count = numbers.count_of(lines[at].split()[0], len(lines) - at - 1)
            sections[key] = lines[at + 1 : at + 1 + count]
            at += 1 + count
    if not ended:
        raise MeshError(f"{CUT_OFF}: endmesh is missing")
    return _built(sections, dimension)


def _built(sections: dict[str, list[bytes]], dimension: int) -> Content:
    build = Builder()
    build.part()
    lines = sections.get("points", [])
    flat = numbers.floats(b"\n".join(lines))
    if len(flat) != 3 * len(lines):
        raise MeshError("it is damaged: its points")
    build.points(flat.reshape(-1, 3), np.arange(1, len(lines) + 1))
    names = _names(sections.get("materials" if dimension == 2 else "bcnames", []))
    for key in ("surfaceelements", "surfaceelementsgi", "surfaceelementsuv", "surfaceelementstgi"):
        for _, table in _rows(sections.get(key, [])):
            if table.shape[1] < 6:
                raise MeshError("it is damaged: a surface element is too short")
            for count in np.unique(table[:, 4]).tolist():
                rows = table[table[:, 4] == count]
                kind, nodes = _KINDS.get(count, ("polygon", count))
                if nodes > table.shape[1] - 5 or nodes < 1:
                    raise MeshError("it is damaged: a surface element is too short")
                placed = build.cells(kind, rows[:, 5 : 5 + nodes])
                _name(build, placed, rows[:, 1], names)
    if count := len(sections.get("volumeelements", [])):
        build.cells("volume", np.zeros((count, 1)))
    sides = _names(sections.get("bcnames" if dimension == 2 else "cd2names", []))
    for key in ("edgesegments", "edgesegmentsgi", "edgesegmentsgi2"):
        for _, table in _rows(sections.get(key, [])):
            if table.shape[1] < 4:
                raise MeshError("it is damaged: an edge is too short")
            placed = build.cells("line", table[:, 2:4])
            _name(build, placed, table[:, 0], sides)
    return build.content()


def _rows(lines: list[bytes]) -> list[tuple[Ints, Ints]]:
    """Lines of numbers as tables, by length."""
    if not lines:
        return []
    flat = numbers.floats(b"\n".join(lines))
    sizes = np.array([len(line.split()) for line in lines])
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]])
    found = numbers.by_length(flat.astype(np.int64), starts, sizes)
    return found


def _names(lines: list[bytes]) -> dict[int, str]:
    found = {}
    for line in lines:
        number, _, name = numbers.words_of(line).partition(" ")
        if not name and "\t" in number:
            number, _, name = number.partition("\t")
        if number.isdigit():
            found[int(number[:9])] = name.strip()
    return found


def _name(build: Builder, placed: list[Placed], tags: Ints, names: dict[int, str]) -> None:
    used = np.unique(tags).tolist()
    for tag in used:
        name = names.get(tag, "")
        if name in ("", "default") and len(used) < 2:
            continue
        rows = [one._replace(rows=one.rows[tags[one.which] == tag]) for one in placed]
        build.group(name or f"domain={tag}", rows, tag)
