"""The cells of a block grid as an unstructured mesh: all formats of meshes, with names."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.blocks.high_order import high_order
from meshwright_core.io import formats
from meshwright_core.io.content import Content, NamesBuilder
from meshwright_core.io.writers.lines import words


def fine_content(grid: BlockGrid) -> Content:
    """Points, quads, regions and the names of sides and regions of all cells."""
    structure = grid.structure
    cells = {"quad": grid.cells}
    names = NamesBuilder(cells)
    for region, name in enumerate(structure.region_names):
        names.add_elements(name, "quad", np.flatnonzero(grid.regions == region))
    for name, faces in grid.patch_faces().items():
        names.add_edges(structure.patch(name).title, faces)
    several = len(structure.region_names) > 1
    return Content(
        grid.points, cells, {}, {"quad": grid.regions} if several else None, names.result()
    )


def write_fine(path: Path, grid: BlockGrid) -> None:
    """Write the cells in the format that the ending of the path means."""
    form = formats.of(path)
    with formats.contained():
        form.write(path, fine_content(grid))


def inp_text(grid: BlockGrid) -> str:
    """Abaqus elements of 8 nodes (CPS8) on the true curves, with sets of sides and regions."""
    fine = high_order(grid, 2)
    # corners, then the middle of each side; the node in the middle is not used
    rows = fine.cells[:, [0, 2, 8, 6, 1, 5, 7, 3]]
    used, local = np.unique(rows, return_inverse=True)
    local = local.reshape(rows.shape) + 1
    number = np.zeros(len(fine.points), np.int64)
    number[used] = np.arange(1, len(used) + 1)
    lines = [f"** Meshwright: {len(used)} points, {len(rows)} elements", "*NODE"]
    points = fine.points[used].tolist()
    lines += [f"{i}, {x!r}, {y!r}, {z!r}" for i, (x, y, z) in enumerate(points, start=1)]
    lines.append("*ELEMENT, TYPE=CPS8, ELSET=ELEMENTS")
    elements: list[list[int]] = [row.tolist() for row in local]
    lines += [f"{i}, {', '.join(map(str, row))}" for i, row in enumerate(elements, 1)]
    structure = grid.structure
    titles = [patch.title for patch in structure.patches]
    label = words(dict.fromkeys([*structure.region_names, *titles]))
    for region, name in enumerate(structure.region_names):
        lines.append(f"*ELSET, ELSET={label[name]}")
        lines += _listed(np.flatnonzero(grid.regions == region) + 1)
    for title, faces in zip(titles, fine.faces.values(), strict=True):
        lines.append(f"*NSET, NSET={label[title]}")
        lines += _listed(np.unique(number[faces]))
    return "\n".join(lines) + "\n"


def _listed(numbers: np.ndarray) -> list[str]:
    """Lines of 16 numbers, as many as Abaqus takes."""
    values = numbers.tolist()
    return [", ".join(map(str, values[i : i + 16])) for i in range(0, len(values), 16)]
