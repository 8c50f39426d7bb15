"""VTK's XML files of polygons (.vtp): elements, the edges of named sides, and names as arrays.

Arrays are in base64, each with its length before it.
"""

from __future__ import annotations

import base64
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from meshwright_core.io.content import Content
from meshwright_core.io.writers import cell_arrays

_TYPES = {"float64": "Float64", "int64": "Int64", "int32": "Int32"}


def write(content: Content) -> str:
    """Return the content as a file of polygonal data; lines come before polygons there."""
    cells, fields = cell_arrays.named_cells(content)
    order = sorted(cells, key=lambda kind: kind != "line")
    place = {kind: i for i, kind in enumerate(cells)}
    lines = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        "<PolyData>",
        f'<Piece NumberOfPoints="{len(content.points)}" NumberOfVerts="0" '
        f'NumberOfLines="{len(cells.get("line", ()))}" NumberOfStrips="0" '
        f'NumberOfPolys="{sum(len(block) for kind, block in cells.items() if kind != "line")}">',
        "<PointData>",
        *(_array(name, np.asarray(values)) for name, values in content.data.items()),
        "</PointData>",
        "<CellData>",
        *(
            _array(name, np.concatenate([blocks[place[kind]] for kind in order]))
            for name, blocks in fields.items()
        ),
        "</CellData>",
        "<Points>",
        _array("Points", content.points),
        "</Points>",
    ]
    for kind in order:
        block = cells[kind]
        tag = "Lines" if kind == "line" else "Polys"
        stops = block.shape[1] * np.arange(1, len(block) + 1)
        lines += [f"<{tag}>", _array("connectivity", block.ravel()), _array("offsets", stops)]
        lines += [f"</{tag}>"]
    return "\n".join([*lines, "</Piece>", "</PolyData>", "</VTKFile>", ""])


def _array(name: str, values: NDArray[np.generic]) -> str:
    values = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
    data = values.tobytes()
    code = base64.b64encode(np.array([len(data)], "<u8").tobytes() + data).decode()
    width = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    kind = _TYPES[values.dtype.name]
    return (
        f'<DataArray type="{kind}" Name={quoteattr(name)}{width} format="binary">{code}</DataArray>'
    )
