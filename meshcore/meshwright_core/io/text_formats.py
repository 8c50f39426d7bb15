"""Text formats of meshes with readers and writers of our own: exact coordinates, and quads.

Each writer returns the text of the whole file. Where the format has comments the first lines
count points and elements, so that a file that was cut off is noticed on reading.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content

_COUNTS = re.compile(rb"Meshwright: (\d+) points, (\d+) elements")
_COUNTED = 512


def announced_counts(head: bytes) -> tuple[int, int] | None:
    """Return the numbers of points and elements that the first bytes of a file of ours state."""
    found = _COUNTS.search(head[:_COUNTED])
    return (int(found[1]), int(found[2])) if found else None


def write_obj(content: Content) -> str:
    """Return the content as a Wavefront OBJ file."""
    _, elements = _block(content)
    lines = [f"# Meshwright: {len(content.points)} points, {len(elements)} elements"]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in content.points.tolist()]
    lines += ["f " + " ".join(map(str, element)) for element in (elements + 1).tolist()]
    return _text(lines)


def write_off(content: Content) -> str:
    """Return the content as an Object File Format file."""
    _, elements = _block(content)
    lines = ["OFF", f"{len(content.points)} {len(elements)} 0"]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in content.points.tolist()]
    head = f"{elements.shape[1]} "
    lines += [head + " ".join(map(str, element)) for element in elements.tolist()]
    return _text(lines)


def write_stl(content: Content) -> str:
    """Return triangles as an STL text file, the normals by the right-hand rule."""
    corners = content.points[_block(content)[1]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    lines = ["solid meshwright"]
    for (nx, ny, nz), triangle in zip(normal.tolist(), corners.tolist(), strict=True):
        lines += [f"facet normal {nx!r} {ny!r} {nz!r}", "outer loop"]
        lines += [f"vertex {x!r} {y!r} {z!r}" for x, y, z in triangle]
        lines += ["endloop", "endfacet"]
    return _text([*lines, "endsolid meshwright"])


def write_su2(content: Content) -> str:
    """Return a mesh in the plane z = 0 as an SU2 file, its boundary as one marker."""
    if content.points[:, 2].any():
        raise MeshError("an SU2 file holds no surface out of the plane z = 0")
    kind, elements = _block(content)
    code = {"triangle": 5, "quad": 9}[kind]
    rim = _rim(elements)
    lines = [f"% Meshwright: {len(content.points)} points, {len(elements)} elements"]
    lines += ["NDIME= 2", f"NELEM= {len(elements)}"]
    lines += [
        f"{code} {' '.join(map(str, nodes))} {i}" for i, nodes in enumerate(elements.tolist())
    ]
    lines += [f"NPOIN= {len(content.points)}"]
    lines += [f"{x!r} {y!r} {i}" for i, (x, y, _) in enumerate(content.points.tolist())]
    lines += ["NMARK= 1", "MARKER_TAG= 1", f"MARKER_ELEMS= {len(rim)}"]
    lines += [f"3 {a} {b}" for a, b in rim.tolist()]
    return _text(lines)


def write_inp(content: Content) -> str:
    """Return the content as an Abaqus input file of shell elements, S3 or S4."""
    _, elements = _block(content)
    lines = [f"** Meshwright: {len(content.points)} points, {len(elements)} elements", "*NODE"]
    lines += [f"{i}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in _numbered(content.points)]
    lines += [f"*ELEMENT, TYPE=S{elements.shape[1]}, ELSET=ELEMENTS"]
    lines += [f"{i}, {', '.join(map(str, nodes))}" for i, nodes in _numbered(elements + 1)]
    return _text(lines)


def write_msh(content: Content) -> str:
    """Return the content as a Gmsh 2.2 text file, with its data by node.

    Regions are physical groups, numbered from 1.
    """
    kind, elements = _block(content)
    groups = (content.regions or {}).get(kind, np.zeros(len(elements), np.int64)) + 1
    code = {"triangle": 2, "quad": 3}[kind]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", f"{len(content.points)}"]
    lines += [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in _numbered(content.points)]
    lines += ["$EndNodes", "$Elements", f"{len(elements)}"]
    tagged = np.column_stack([groups, groups, elements + 1])
    lines += [f"{i} {code} 2 {' '.join(map(str, row))}" for i, row in _numbered(tagged)]
    lines += ["$EndElements"]
    for name, values in content.data.items():
        lines += ["$NodeData", "1", f'"{name}"', "1", "0.0", "3", "0", "1", f"{len(values)}"]
        lines += [f"{i} {value}" for i, value in _numbered(values)]
        lines += ["$EndNodeData"]
    return _text(lines)


def write_bdf(content: Content) -> str:
    """Return the content as a Nastran bulk data file, coordinates in fields of 16 characters."""
    kind, elements = _block(content)
    card = {"triangle": "CTRIA3", "quad": "CQUAD4"}[kind]
    if max(len(content.points), len(elements)) > 99_999_999:
        raise MeshError("a Nastran file numbers at most 99999999 points and elements")
    lines = [f"$ Meshwright: {len(content.points)} points, {len(elements)} elements"]
    lines += ["BEGIN BULK"]
    for i, point in _numbered(content.points):
        x, y, z = (_in_16(value) for value in point)
        lines += [f"GRID*   {i:<16}{'':16}{x:>16}{y:>16}", f"*       {z:>16}"]
    for i, nodes in _numbered(elements + 1):
        lines.append(f"{card:<8}{i:<8}{1:<8}" + "".join(f"{node:<8}" for node in nodes))
    return _text([*lines, "ENDDATA"])


def write_xdmf(content: Content) -> str:
    """Return the content as an XDMF file, version 3, with its numbers in the file itself."""
    kind, elements = _block(content)
    name = {"triangle": "Triangle", "quad": "Quadrilateral"}[kind]

    def item(values: NDArray[np.generic], number: str, rows: list[str]) -> list[str]:
        shape = " ".join(map(str, values.shape))
        head = f'<DataItem DataType="{number}" Dimensions="{shape}" Format="XML" Precision="8">'
        return [head, *rows, "</DataItem>"]

    places = [f"{x!r} {y!r} {z!r}" for x, y, z in content.points.tolist()]
    nodes = [" ".join(map(str, row)) for row in elements.tolist()]
    lines = ['<Xdmf Version="3.0"><Domain><Grid Name="Grid" GridType="Uniform">']
    lines += ['<Geometry GeometryType="XYZ">', *item(content.points, "Float", places)]
    lines += ["</Geometry>"]
    lines += [f'<Topology TopologyType="{name}" NumberOfElements="{len(elements)}">']
    lines += [*item(elements, "Int", nodes), "</Topology>"]
    attributes = [("Node", key, values) for key, values in content.data.items()]
    regions = (content.regions or {}).get(kind)
    if regions is not None:
        attributes.append(("Cell", "region", regions))
    for centre, key, values in attributes:
        lines += [f'<Attribute Name="{key}" AttributeType="Scalar" Center="{centre}">']
        lines += [*item(values, "Int", [str(value) for value in values.tolist()]), "</Attribute>"]
    return _text([*lines, "</Grid></Domain></Xdmf>"])


def _in_16(value: float) -> str:
    """Return the number with as many digits as fit in 16 characters."""
    for digits in range(17, 0, -1):
        text = f"{value:#.{digits}g}".upper()
        if len(text) <= 16:
            return text
    raise MeshError(f"the coordinate {value!r} does not fit in 16 characters")


def _block(content: Content) -> tuple[str, NDArray[np.int64]]:
    ((kind, elements),) = content.cells.items()
    return kind, elements


def _numbered(array: NDArray[np.generic]) -> enumerate[list[float]]:
    return enumerate(array.tolist(), start=1)


def _rim(elements: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the boundary edges, the elements on their left."""
    ends = np.stack([elements, np.roll(elements, -1, axis=1)], axis=2).reshape(-1, 2)
    _, where, times = np.unique(
        np.sort(ends, axis=1), axis=0, return_index=True, return_counts=True
    )
    return ends[np.sort(where[times == 1])]


def _text(lines: list[str]) -> str:
    return "\n".join(lines) + "\n"
