"""MED files of Salome and Code_Aster (.med): HDF5 files, read with h5py.

The groups of elements and points are families: each element has the number of one, and a family has
the names of its groups. The layout is that of MED 3 and 4
(https://docs.salome-platform.org/latest/dev/MEDCoupling/developer/med-file.html).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import hdf5
from meshwright_core.io.readers.builder import Builder
from meshwright_core.io.readers.numbers import Ints

_CELLS = {
    "PO1": ("vertex", 1), "SE2": ("line", 2), "SE3": ("line", 3), "TR3": ("triangle", 3),
    "TR6": ("triangle", 6), "TR7": ("triangle", 7), "QU4": ("quad", 4), "QU8": ("quad", 8),
    "QU9": ("quad", 9), "TE4": ("tetra", 4), "T10": ("tetra", 10), "HE8": ("hexahedron", 8),
    "H20": ("hexahedron", 20), "H27": ("hexahedron", 27), "PY5": ("pyramid", 5),
    "P13": ("pyramid", 13), "PE6": ("wedge", 6), "P15": ("wedge", 15),
}  # fmt: skip


def read(path: Path) -> Content:
    """Return the mesh of a MED file; of a series over time the last state."""
    return hdf5.content_of(path, "MED", _content)


def _content(file: Any, most: int) -> Content:
    if "ENS_MAA" not in file or not len(file["ENS_MAA"]):
        raise MeshError("it holds no mesh of MED")
    meshes = file["ENS_MAA"]
    build = Builder()
    for name in meshes:
        mesh = meshes[name]
        dimension = int(mesh.attrs["ESP"])
        if dimension not in (1, 2, 3):
            raise MeshError(f"it has {dimension} dimensions")
        state = mesh if "NOE" in mesh else mesh[list(mesh)[-1]]
        families = mesh["FAS"] if "FAS" in mesh else file["FAS"].get(name, {})
        build.part(name)
        _add(build, state, families, dimension, most)
    build.dropped += [f"field {name!r}" for name in file.get("CHA", ())]
    return build.content()


def _add(
    build: Builder, state: Any, families: Mapping[str, Any], dimension: int, most: int
) -> None:
    points = hdf5.array(state["NOE"]["COO"], most)
    build.points(points.reshape(dimension, -1).T)
    if "FAM" in state["NOE"]:
        _node_sets(build, hdf5.array(state["NOE"]["FAM"], most), _names(families.get("NOEUD", {})))
    names = _names(families.get("ELEME", {}))
    for code, block in state.get("MAI", {}).items():
        if code not in _CELLS:
            raise MeshError(f"its cells {code[:20]!r} are unknown")
        kind, nodes = _CELLS[code]
        cells = hdf5.array(block["NOD"], most).reshape(nodes, -1).T - 1
        placed = build.cells(kind, cells)
        if "FAM" not in block:
            continue
        family = hdf5.array(block["FAM"], most)
        for one in placed:
            numbers = family[one.which]
            for number in np.unique(numbers).tolist():
                rows = np.flatnonzero(numbers == number)
                for group in names.get(number, ()):
                    build.group(group, [one._replace(rows=one.rows[rows], which=one.which[rows])])


def _node_sets(build: Builder, family: Ints, names: dict[int, list[str]]) -> None:
    sets: dict[str, list[Ints]] = {}
    for number, groups in names.items():
        for group in groups:
            sets.setdefault(group, []).append(np.flatnonzero(family == number))
    for group, members in sets.items():
        build.node_set(group, np.concatenate(members))


def _names(families: Mapping[str, Any]) -> dict[int, list[str]]:
    """The names of the groups of each family, by its number."""
    found = {}
    for family in families.values():
        if "GRO" in family:
            rows = np.asarray(family["GRO"]["NOM"][()]).astype(np.uint8)
            texts = [bytes(row).split(b"\0")[0] for row in rows.reshape(len(rows), -1)]
            names = [text.decode("utf-8", "replace").strip() for text in texts]
            found[int(family.attrs["NUM"])] = [name for name in names if name]
    return found
