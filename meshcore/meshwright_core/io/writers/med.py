"""MED files (.med): elements and edges with the families of their groups, written with h5py."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.names import groups
from meshwright_core.io.content import Content
from meshwright_core.io.writers import lines as form

_CODES = {"triangle": "TR3", "quad": "QU4"}
_PROFILE = np.bytes_("MED_NO_PROFILE_INTERNAL")
_STEP = "-0000000000000000001-0000000000000000001"
LETTERS = 80
"""Bytes of the name of a group."""


def write(path: Path, content: Content) -> None:
    """Write the content as a MED file of version 3.0, which all readers take.

    It is made in memory first: the HDF5 library may end the program where the disk is full.
    """
    import h5py

    memory = io.BytesIO()
    with h5py.File(memory, "w", libver=("earliest", "v108")) as file:
        _write(file, content)
    path.write_bytes(memory.getvalue())


def _write(file: Any, content: Content) -> None:
    kind, elements = form.block(content)
    names = form.names(content)
    dimension = 3
    points = np.column_stack(
        [content.points, np.zeros((len(content.points), dimension - content.points.shape[1]))]
    )
    file.create_group("INFOS_GENERALES").attrs.update({"MAJ": 3, "MIN": 0, "REL": 0})
    mesh = file.create_group("ENS_MAA/mesh")
    mesh.attrs.update(
        {
            "DIM": 2, "ESP": dimension, "REP": 0, "UNT": np.bytes_(" "), "UNI": np.bytes_(" "),
            "SRT": 1, "NOM": np.bytes_("".join(f"{axis:<16}" for axis in "XYZ")),
            "DES": np.bytes_("Meshwright"), "TYP": 0,
        }
    )  # fmt: skip
    state = mesh.create_group(_STEP)
    state.attrs.update({"CGT": 1, "NDT": -1, "NOR": -1, "PDT": -1.0})
    nodes = state.create_group("NOE")
    nodes.attrs.update({"CGT": 1, "CGS": 1, "PFL": _PROFILE})
    _dataset(nodes, "COO", points.T.ravel(), len(points))
    cells = state.create_group("MAI")
    cells.attrs["CGT"] = 1
    _cells(cells, _CODES[kind], elements, names.elements.get(kind), 0)
    if len(names.edges):
        _cells(cells, "SE2", names.edges, names.edge_sides, len(names.regions))
    families = file.create_group("FAS/mesh")
    families.create_group("FAMILLE_ZERO").attrs["NUM"] = 0
    every = [groups(name) for name in (*names.regions, *names.sides)]
    for number, own in enumerate(every, 1):
        if own:
            family = families.create_group(f"ELEME/FAM_{-number}")
            family.attrs["NUM"] = -number
            listed = family.create_group("GRO")
            listed.attrs["NBR"] = len(own)
            texts = [form.cut(name, LETTERS).ljust(LETTERS, b"\0") for name in own]
            rows = np.frombuffer(b"".join(texts), np.int8).reshape(-1, LETTERS)
            # an array type for each name: the MED library reads no table of bytes
            made = listed.create_dataset("NOM", (len(own),), np.dtype((np.int8, (LETTERS,))))
            for i, row in enumerate(rows):
                made[i] = row


def _cells(
    cells: Any, code: str, nodes: NDArray[np.int64], rows: NDArray[np.int64] | None, first: int
) -> None:
    """Cells with the families -first - row - 1, 0 for none."""
    block = cells.create_group(code)
    block.attrs.update({"CGT": 1, "CGS": 1, "PFL": _PROFILE})
    _dataset(block, "NOD", nodes.T.ravel().astype(np.int32) + np.int32(1), len(nodes))
    if rows is not None:
        family = np.where(rows < 0, 0, -first - rows - 1)
        _dataset(block, "FAM", family.astype(np.int32), len(nodes))


def _dataset(group: Any, name: str, values: NDArray[Any], count: int) -> None:
    made = group.create_dataset(name, data=values)
    made.attrs.update({"CGT": 1, "NBR": count})
