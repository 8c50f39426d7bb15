"""DOLFIN's XML files (.xml): meshes of triangles or quads."""

from __future__ import annotations

from xml.etree import ElementTree

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.numbers import CUT_OFF

_KINDS = {"interval": ("line", 2), "triangle": ("triangle", 3), "quadrilateral": ("quad", 4),
          "tetrahedron": ("tetra", 4), "hexahedron": ("hexahedron", 8)}  # fmt: skip


def read(data: bytes) -> Content:
    """Return the content of a DOLFIN XML file."""
    try:
        root = ElementTree.fromstring(numbers.without_mark(data))
    except ElementTree.ParseError as error:
        raise MeshError(f"it is cut off or damaged: {error}") from error
    mesh = root if root.tag == "mesh" else root.find("mesh")
    vertices, cells = (None, None) if mesh is None else (mesh.find("vertices"), mesh.find("cells"))
    if mesh is None or vertices is None or cells is None:
        raise MeshError("it holds no mesh of DOLFIN")
    name = mesh.get("celltype", "")
    if name not in _KINDS:
        raise MeshError(f"its cells {name[:20]!r} are unknown")
    kind, nodes = _KINDS[name]
    build = Builder()
    build.part()
    try:
        points = [
            (float(v.get("x", "")), float(v.get("y", "0")), float(v.get("z", "0")))
            for v in vertices
        ]
        ids = [int(v.get("index", "")) for v in vertices]
        rows = [[int(c.get(f"v{i}", "")) for i in range(nodes)] for c in cells]
    except ValueError as error:
        raise MeshError("it is damaged: an attribute is not a number") from error
    for element, found in ((vertices, points), (cells, rows)):
        if numbers.count_of(element.get("size", str(len(found))), 2**48) != len(found):
            raise MeshError(f"{CUT_OFF}: it has not as many {element.tag} as it announces")
    if points:
        build.points(np.array(points), numbers.whole(np.array(ids, dtype=float)))
    if rows:
        table = numbers.whole(np.array(rows, dtype=float))
        if kind == "quad":  # DOLFIN numbers the corners of quads row by row
            table = table[:, [0, 1, 3, 2]]
        build.cells(kind, table)
    return build.content()
