"""Writes XDMF files, version 3, with all numbers in the file itself."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from meshwright_core.io.content import Content
from meshwright_core.io.writers import cell_arrays
from meshwright_core.io.writers import lines as form

_NAMES = {"triangle": "Triangle", "quad": "Quadrilateral"}
_CODES = {"triangle": "4", "quad": "5", "line": "2 2"}


def write(content: Content) -> str:
    """Return the content as an XDMF file; named groups are arrays, as in VTK files."""
    cells, arrays = cell_arrays.named_cells(content)
    count = sum(len(block) for block in cells.values())
    kind, elements = form.block(content)
    places = [f"{x!r} {y!r} {z!r}" for x, y, z in content.points.tolist()]
    lines = ['<Xdmf Version="3.0"><Domain><Grid Name="Grid" GridType="Uniform">']
    lines += ['<Geometry GeometryType="XYZ">', *_item("Float", content.points.shape, places)]
    topology = _NAMES[kind] if len(cells) == 1 else "Mixed"
    lines += ["</Geometry>", f'<Topology TopologyType="{topology}" NumberOfElements="{count}">']
    if len(cells) == 1:
        rows = [" ".join(map(str, row)) for row in elements.tolist()]
        lines += _item("Int", elements.shape, rows)
    else:
        rows = [
            f"{_CODES[name]} {' '.join(map(str, row))}"
            for name, block in cells.items()
            for row in block.tolist()
        ]
        size = sum(
            block.size + len(block) * len(_CODES[name].split()) for name, block in cells.items()
        )
        lines += _item("Int", (size,), rows)
    lines += ["</Topology>"]
    for name, values in content.data.items():
        lines += _attribute("Node", name, np.asarray(values))
    for name, parts in arrays.items():
        lines += _attribute("Cell", name, np.concatenate(parts))
    return form.text([*lines, "</Grid></Domain></Xdmf>"])


def _attribute(centre: str, name: str, values: NDArray[np.generic]) -> list[str]:
    head = f'<Attribute Name={quoteattr(name)} AttributeType="Scalar" Center="{centre}">'
    rows = [str(value) for value in values.tolist()]
    return [head, *_item("Int", values.shape, rows), "</Attribute>"]


def _item(number: str, shape: tuple[int, ...], rows: list[str]) -> list[str]:
    size = " ".join(map(str, shape))
    head = f'<DataItem DataType="{number}" Dimensions="{size}" Format="XML" Precision="8">'
    return [head, *rows, "</DataItem>"]
