"""VTK's XML formats: the blocks as `.vtm`, a `.vts` each, and cells of higher order as `.vtu`.

Arrays are in base64, each with its length before it.
"""

from __future__ import annotations

import base64
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.blocks.high_order import high_order

_NAMES = {"float64": "Float64", "int64": "Int64", "uint8": "UInt8", "int32": "Int32"}
_QUAD, _BIQUADRATIC, _LAGRANGE = 9, 28, 70
_VTK_NODES = {
    1: [0, 1, 3, 2],
    2: [0, 2, 8, 6, 1, 5, 7, 3, 4],
    3: [0, 3, 15, 12, 1, 2, 7, 11, 13, 14, 4, 8, 5, 6, 9, 10],
}
"""Corners, nodes of the sides, nodes inside; sides along the axes in the Lagrange cell."""


def _array(name: str, values: np.ndarray) -> str:
    values = np.ascontiguousarray(values)
    data = values.tobytes()
    code = base64.b64encode(np.array([len(data)], "<u8").tobytes() + data).decode()
    width = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    kind = _NAMES[str(values.dtype)]
    return (
        f'<DataArray type="{kind}" Name={quoteattr(name)}{width} format="binary">{code}</DataArray>'
    )


def _file(kind: str, body: list[str]) -> str:
    head = f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">'
    return "\n".join(['<?xml version="1.0"?>', head, *body, "</VTKFile>", ""])


def vts_text(grid: BlockGrid, block: int) -> str:
    """One block as a structured grid."""
    n, m = grid.shapes[block].tolist()
    extent = f"0 {n} 0 {m} 0 0"
    region = np.full(n * m, grid.structure.region[block], np.int32)
    return _file("StructuredGrid", [
        f'<StructuredGrid WholeExtent="{extent}">', f'<Piece Extent="{extent}">',
        "<CellData>", _array("region", region), "</CellData>",
        "<Points>", _array("Points", grid.block_points(block).reshape(-1, 3)), "</Points>",
        "</Piece>", "</StructuredGrid>",
    ])  # fmt: skip


def vtp_text(grid: BlockGrid, patch: str) -> str:
    """One patch as lines."""
    faces = grid.patch_faces()[patch]
    used, lines = np.unique(faces, return_inverse=True)
    count = len(faces)
    return _file("PolyData", [
        "<PolyData>",
        f'<Piece NumberOfPoints="{len(used)}" NumberOfVerts="0" NumberOfLines="{count}" '
        'NumberOfStrips="0" NumberOfPolys="0">',
        "<Points>", _array("Points", grid.points[used]), "</Points>",
        "<Lines>", _array("connectivity", lines.ravel().astype(np.int64)),
        _array("offsets", 2 * np.arange(1, count + 1)), "</Lines>",
        "</Piece>", "</PolyData>",
    ])  # fmt: skip


def vtm_text(grid: BlockGrid, folder: str) -> str:
    """The list of the files in `folder`: the blocks, by region where there are several, and the
    patches.
    """
    structure = grid.structure
    body = ["<vtkMultiBlockDataSet>"]
    for region, name in enumerate(structure.region_names):
        body.append(f'<Block index="{region}" name={quoteattr(name)}>')
        for i, block in enumerate(np.flatnonzero(structure.region == region).tolist()):
            file = quoteattr(f"{folder}/{block_file(block)}")
            body.append(f'<DataSet index="{i}" name="block_{block + 1}" file={file}/>')
        body.append("</Block>")
    body.append(f'<Block index="{len(structure.region_names)}" name="patches">')
    for i, patch in enumerate(structure.patches):
        file = quoteattr(f"{folder}/{patch_file(patch.name)}")
        body.append(f'<DataSet index="{i}" name={quoteattr(patch.title)} file={file}/>')
    return _file("vtkMultiBlockDataSet", [*body, "</Block>", "</vtkMultiBlockDataSet>"])


def block_file(block: int) -> str:
    """The name of the file of a block."""
    return f"block_{block + 1}.vts"


def patch_file(patch: str) -> str:
    """The name of the file of a patch."""
    return f"patch_{patch}.vtp"


def write_multiblock(folder: Path, grid: BlockGrid) -> None:
    """Write the files that :func:`vtm_text` lists into an empty folder."""
    for block in range(len(grid.shapes)):
        (folder / block_file(block)).write_text(vts_text(grid, block), encoding="ascii")
    for patch in grid.structure.patches:
        (folder / patch_file(patch.name)).write_text(vtp_text(grid, patch.name), encoding="ascii")


def vtu_text(grid: BlockGrid, order: int) -> str:
    """The cells of order 1, 2 (9 nodes) or 3 (16 nodes, Lagrange) as an unstructured grid."""
    fine = high_order(grid, order)
    cells = fine.cells[:, _VTK_NODES[order]].astype(np.int64)
    kind = {1: _QUAD, 2: _BIQUADRATIC, 3: _LAGRANGE}[order]
    count, width = cells.shape
    return _file("UnstructuredGrid", [
        "<UnstructuredGrid>",
        f'<Piece NumberOfPoints="{len(fine.points)}" NumberOfCells="{count}">',
        "<Points>", _array("Points", fine.points), "</Points>",
        "<CellData>", _array("region", grid.regions.astype(np.int32)), "</CellData>",
        "<Cells>", _array("connectivity", cells.ravel()),
        _array("offsets", width * np.arange(1, count + 1)),
        _array("types", np.full(count, kind, np.uint8)), "</Cells>",
        "</Piece>", "</UnstructuredGrid>",
    ])  # fmt: skip
