"""Text formats of meshes with readers and writers of our own: exact coordinates, and quads.

Each writer returns the text of the whole file. Where the format has comments the first lines
count points and elements, so that a file that was cut off is noticed on reading.
"""

from __future__ import annotations

import re

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.writers import lines as form

_COUNTS = re.compile(rb"Meshwright: (\d+) points, (\d+) elements")
_COUNTED = 512
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)")
_NAMES = {3: "triangle", 4: "quad"}


def announced_counts(head: bytes) -> tuple[int, int] | None:
    """Return the numbers of points and elements that the first bytes of a file of ours state."""
    found = _COUNTS.search(head[:_COUNTED])
    return (int(found[1]), int(found[2])) if found else None


def read_obj(text: bytes) -> Content:
    """Read the vertices and faces of a Wavefront OBJ file; textures, normals, lines are left."""
    points: list[list[float]] = []
    faces: dict[int, list[list[int]]] = {}
    for number, line in enumerate(text.replace(b"\\\n", b" ").splitlines(), start=1):
        words = line.split()
        if not words or words[0] not in (b"v", b"f"):
            continue
        try:
            if words[0] == b"v":
                x, y, z = words[1:4]
                points.append([float(x), float(y), float(z)])
            else:
                face = [int(word.partition(b"/")[0]) for word in words[1:]]
                face = [i - 1 if i > 0 else len(points) + i for i in face]
                faces.setdefault(len(face), []).append(face)
        except ValueError as error:
            raise MeshError(f"line {number} cannot be understood: {_shown(line)}") from error
    return _content(points, faces)


def read_off(text: bytes) -> Content:
    """Read an Object File Format file, one point or face a line; colours are left."""
    lines = [line.partition(b"#")[0].split() for line in text.splitlines()]
    lines = [words for words in lines if words]
    if not lines or lines[0][0] != b"OFF":
        raise MeshError('it does not begin with "OFF"')
    lines[0] = lines[0][1:]
    if not lines[0]:
        lines.pop(0)
    faces: dict[int, list[list[int]]] = {}
    try:
        n, m = int(lines[0][0]), int(lines[0][1])
        if len(lines) < 1 + n + m:
            raise MeshError(f"it is cut off: {n} points and {m} faces are announced")
        points = [[float(word) for word in words[:3]] for words in lines[1 : 1 + n]]
        for words in lines[1 + n : 1 + n + m]:
            k = int(words[0])
            face = [int(word) for word in words[1 : 1 + k]]
            if len(face) < k:
                raise MeshError("it is cut off within a face")
            faces.setdefault(k, []).append(face)
    except (ValueError, IndexError) as error:
        raise MeshError("a line holds something else than the numbers that belong there") from error
    return _content(points, faces)


def read_stl(data: bytes) -> Content:
    """Read an STL file, binary or text: triangles without common points."""
    count = int.from_bytes(data[80:84], "little")
    if len(data) >= 84 and (len(data) == 84 + 50 * count or not data.startswith(b"solid")):
        if len(data) < 84 + 50 * count:
            raise MeshError(f"it is cut off: {count} triangles are announced")
        facet = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
        corners = np.frombuffer(data, facet, count, 84)["corners"].astype(float)
    else:
        if not data.lstrip().startswith(b"solid"):
            raise MeshError("it is no STL file, neither text nor binary")
        if data.rstrip().rpartition(b"\n")[2].split()[:1] != [b"endsolid"]:
            raise MeshError('it is cut off: it does not end with "endsolid"')
        try:
            found = np.array(_VERTEX.findall(data)).astype(float)
        except ValueError as error:
            raise MeshError("a coordinate is not a number") from error
        if len(found) != 3 * data.count(b"endfacet"):
            raise MeshError("its facets do not have three corners each")
        corners = found.reshape(-1, 3, 3)
    index = np.arange(3 * len(corners)).reshape(-1, 3)
    return Content(corners.reshape(-1, 3), {"triangle": index}, {})


def write_obj(content: Content) -> str:
    """Return the content as a Wavefront OBJ file."""
    _, elements = form.block(content)
    lines = [f"# Meshwright: {len(content.points)} points, {len(elements)} elements"]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in content.points.tolist()]
    lines += ["f " + " ".join(map(str, element)) for element in (elements + 1).tolist()]
    return form.text(lines)


def write_off(content: Content) -> str:
    """Return the content as an Object File Format file."""
    _, elements = form.block(content)
    lines = ["OFF", f"{len(content.points)} {len(elements)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in content.points.tolist()]
    head = f"{elements.shape[1]} "
    lines += [head + " ".join(map(str, element)) for element in elements.tolist()]
    return form.text(lines)


def write_stl(content: Content) -> str:
    """Return triangles as an STL text file, the normals by the right-hand rule."""
    corners = content.points[form.block(content)[1]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    lines = ["solid meshwright"]
    for (nx, ny, nz), triangle in zip(normal.tolist(), corners.tolist(), strict=True):
        lines += [f"facet normal {nx!r} {ny!r} {nz!r}", "outer loop"]
        lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    return form.text([*lines, "endsolid meshwright"])


def _content(points: list[list[float]], faces: dict[int, list[list[int]]]) -> Content:
    cells = {_NAMES.get(k, "polygon"): np.array(f, dtype=np.int64) for k, f in faces.items()}
    return Content(np.array(points, dtype=float).reshape(-1, 3), cells, {})


def _shown(text: bytes) -> str:
    shown = text[:60].decode("utf-8", "replace")
    return repr(shown if len(text) <= 60 else shown[:57] + "...")
