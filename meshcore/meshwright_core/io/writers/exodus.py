"""Exodus II files (.exo, .e): regions are element blocks, sides are side sets; by netCDF4."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core.io.content import Content
from meshwright_core.io.named_groups import group_edges
from meshwright_core.io.writers import lines as form

_TYPES = {("triangle", 2): "TRI3", ("quad", 2): "QUAD4",
          ("triangle", 3): "TRISHELL3", ("quad", 3): "SHELL4"}  # fmt: skip
LETTERS = 256
"""Bytes of the name of a block or set."""


def write(path: Path, content: Content) -> None:
    """Write the content as an Exodus file, made in memory first: the library may end the program
    where the disk is full.
    """
    import netCDF4

    file = netCDF4.Dataset("mesh", mode="w", memory=1024, format="NETCDF3_64BIT_OFFSET")
    _write(file, content)
    path.write_bytes(file.close())


def _write(file: Any, content: Content) -> None:
    kind, elements = form.block(content)
    names = form.names(content)
    rows = names.elements.get(kind, np.full(len(elements), -1))
    count = len(content.points)
    file.api_version = file.version = np.float32(5.1)
    file.floating_point_word_size = np.int32(8)
    file.file_size = np.int32(1)
    file.title = "Meshwright"
    used = np.unique(rows).tolist()
    sides = group_edges(names)
    flat = content.points.shape[1] < 3 or not content.points[:, 2].any()
    dimension = 2 if flat else 3
    sizes = {"num_dim": dimension, "num_nodes": count, "num_elem": len(elements),
             "num_el_blk": len(used), "len_name": LETTERS, "time_step": None}  # fmt: skip
    if sides:
        sizes["num_side_sets"] = len(sides)
    for name, size in sizes.items():
        file.createDimension(name, size)
    for i, axis in enumerate("xyz"[:dimension]):
        file.createVariable(f"coord{axis}", "f8", ("num_nodes",))[:] = content.points[:, i]
    order = np.concatenate([np.flatnonzero(rows == row) for row in used])
    _listed(file, "eb", "num_el_blk", [names.regions[row] if row >= 0 else "" for row in used])
    for number, row in enumerate(used, 1):
        block = elements[rows == row]
        file.createDimension(f"num_el_in_blk{number}", len(block))
        file.createDimension(f"num_nod_per_el{number}", elements.shape[1])
        made = file.createVariable(
            f"connect{number}", "i4", (f"num_el_in_blk{number}", f"num_nod_per_el{number}")
        )
        made.elem_type = _TYPES[kind, dimension]
        made[:] = block + 1
    place = np.empty(len(elements), np.int64)
    place[order] = np.arange(len(elements))
    start, end = elements, np.roll(elements, -1, axis=1)
    key = (np.minimum(start, end) * count + np.maximum(start, end)).ravel()
    sort = np.argsort(key, kind="stable")
    first = 1 if flat else 3  # after the two faces of shells
    if sides:
        _listed(file, "ss", "num_side_sets", list(sides))
    for number, edges in enumerate(sides.values(), 1):
        wanted = edges.min(axis=1) * count + edges.max(axis=1)
        element, side = np.divmod(sort[np.searchsorted(key[sort], wanted)], elements.shape[1])
        file.createDimension(f"num_side_ss{number}", len(edges))
        for word, values in (("elem", place[element] + 1), ("side", side + first)):
            name = f"{word}_ss{number}"
            file.createVariable(name, "i4", (f"num_side_ss{number}",))[:] = values


def _listed(file: Any, word: str, dimension: str, titles: list[str]) -> None:
    """State, numbers and names of blocks or sets."""
    file.createVariable(f"{word}_status", "i4", (dimension,))[:] = 1
    numbers = file.createVariable(f"{word}_prop1", "i4", (dimension,))
    numbers.setncattr("name", "ID")
    numbers[:] = np.arange(1, len(titles) + 1)
    rows = np.zeros((len(titles), LETTERS), "S1")
    for row, title in zip(rows, titles, strict=True):
        letters = form.cut(title, LETTERS)
        row[: len(letters)] = np.frombuffer(letters, "S1")
    file.createVariable(f"{word}_names", "S1", (dimension, "len_name"))[:] = rows
