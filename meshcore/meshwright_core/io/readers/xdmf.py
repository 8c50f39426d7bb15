"""XDMF files (.xdmf, .xmf): uniform and rectangular grids, alone, collected, or over time.

After the XDMF model and format, version 2 and 3. Heavy data stand in the file itself, in a binary
file or in an HDF5 file beside it; the latter needs h5py. Of a series over time the last grid is
read; the grids of a spatial collection are parts.
"""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers, vtk_cells
from meshwright_core.io.readers.builder import Builder, Placed
from meshwright_core.io.readers.fields import CellFields, keep_point_data
from meshwright_core.io.readers.numbers import CUT_OFF, Ints

_KINDS = {
    "polyvertex": ("vertex", 1, 1), "polyline": ("line", 2, 2), "triangle": ("triangle", 3, 4),
    "quadrilateral": ("quad", 4, 5), "tetrahedron": ("tetra", 4, 6), "pyramid": ("pyramid", 5, 7),
    "wedge": ("wedge", 6, 8), "hexahedron": ("hexahedron", 8, 9), "edge_3": ("line", 3, 34),
    "triangle_6": ("triangle", 6, 36), "tri_6": ("triangle", 6, 36),
    "quadrilateral_8": ("quad", 8, 37), "quad_8": ("quad", 8, 37),
    "quadrilateral_9": ("quad", 9, 35), "quad_9": ("quad", 9, 35),
}  # fmt: skip
"""Kind, nodes, and number in mixed topologies."""
_BY_CODE = {code: (kind, nodes) for kind, nodes, code in _KINDS.values()}
_DEEPEST = 16
_LARGEST = 2**31


def read_path(path: Path) -> Content:
    """Return the content of an XDMF file."""
    try:
        root = ElementTree.fromstring(numbers.without_mark(path.read_bytes()))
    except ElementTree.ParseError as error:
        raise MeshError(f"it is cut off or damaged: {error}") from error
    if root.tag != "Xdmf":
        raise MeshError("it is no XDMF file")
    reader = _Reader(path, root)
    for grid in root.findall("Domain/Grid"):
        reader.grid(grid, 0)
    return reader.build.content()


class _Reader:
    def __init__(self, path: Path, root: ElementTree.Element) -> None:
        self.path, self.root, self.build = path, root, Builder()
        self.room = max(path.stat().st_size, 1)

    def grid(self, grid: ElementTree.Element, depth: int) -> None:
        if depth > _DEEPEST:
            raise MeshError("its grids are nested too deeply")
        kind = grid.get("GridType", "Uniform").lower()
        inner = grid.findall("Grid")
        if kind in ("collection", "tree"):
            if grid.get("CollectionType", "").lower() == "temporal" and len(inner) > 1:
                self.build.warnings.append(f"of its {len(inner)} moments the last is read")
                inner = inner[-1:]
            for one in inner:
                self.grid(one, depth + 1)
            return
        if kind != "uniform":
            raise MeshError(f"a grid of type {kind[:20]!r} is not read")
        topology, geometry = (self._resolved(grid.find(tag)) for tag in ("Topology", "Geometry"))
        if topology is None or geometry is None:
            return
        self.build.part(grid.get("Name", ""))
        self._geometry(geometry)
        placed, rows = self._topology(topology)
        self._attributes(grid, placed, rows)

    def _resolved(self, element: ElementTree.Element | None) -> ElementTree.Element | None:
        """The element itself, or the one that it refers to."""
        if element is None:
            return None
        reference = element.get("Reference")
        if reference is None:
            return element
        place = (element.text or "").strip() if reference == "XML" else reference.strip()
        found = None
        if place.startswith("/Xdmf/"):
            try:
                found = self.root.find(place[len("/Xdmf/") :])
            except (SyntaxError, KeyError):
                found = None
        if found is None or found.get("Reference") is not None:
            raise MeshError("a reference in it leads nowhere")
        return found

    def _geometry(self, geometry: ElementTree.Element) -> None:
        kind = (geometry.get("GeometryType") or geometry.get("Type") or "XYZ").upper()
        items = geometry.findall("DataItem")
        if kind in ("XYZ", "XY") and items:
            width = len(kind)
            flat = self._data(items[0]).astype(np.float64).ravel()
            if len(flat) % width:
                raise MeshError(f"{CUT_OFF} or damaged: its points")
            self.build.points(flat.reshape(-1, width))
        elif kind in ("X_Y_Z", "X_Y") and len(items) >= 2:
            axes = [self._data(item).astype(np.float64).ravel() for item in items]
            if len({len(axis) for axis in axes}) != 1:
                raise MeshError("its coordinates are not equally many")
            self.build.points(np.column_stack(axes))
        else:
            raise MeshError(f"a geometry of type {kind[:20]!r} is not read")

    def _topology(self, topology: ElementTree.Element) -> tuple[list[Placed], int]:
        kind = (topology.get("TopologyType") or topology.get("Type") or "").lower()
        item = topology.find("DataItem")
        if kind in ("2dsmesh", "3dsmesh"):
            words = (topology.get("Dimensions") or "").split()
            sizes = [numbers.count_of(word, self.build.total) for word in words]
            a, b, c = ([1, 1, 1] + sizes)[-3:]
            if a * b * c != self.build.total:
                raise MeshError("its points do not fit its dimensions")
            quads = vtk_cells.grid_cells((c, b, a))
            return self.build.cells("quad", quads), len(quads)
        if item is None:
            raise MeshError(f"{CUT_OFF}: the elements of a grid are missing")
        flat = numbers.whole(self._data(item).ravel())
        if kind == "mixed":
            return self._mixed(flat)
        if kind not in _KINDS:
            raise MeshError(f"a topology of type {kind[:20]!r} is not read")
        name, nodes, _ = _KINDS[kind]
        if kind in ("polyline", "polyvertex"):
            nodes = numbers.count_of(topology.get("NodesPerElement", str(nodes)), 1000)
        if nodes < 1 or len(flat) % nodes:
            raise MeshError(f"{CUT_OFF} or damaged: its elements")
        return self.build.cells(name, flat.reshape(-1, nodes)), len(flat) // nodes

    def _mixed(self, flat: Ints) -> tuple[list[Placed], int]:
        starts: dict[int, tuple[list[int], list[int]]] = {}
        values, at, row = flat.tolist(), 0, 0
        while at < len(values):
            code = values[at]
            if code not in _BY_CODE:
                raise MeshError(f"it has elements of the unknown type {code}")
            head = 2 if code in (1, 2) else 1  # these have their number of points
            if head == 2 and values[at + 1 : at + 2] != [_BY_CODE[code][1]]:
                raise MeshError("a line of more than two points is not read")
            rows, places = starts.setdefault(code, ([], []))
            rows.append(row)
            places.append(at + head)
            at, row = at + head + _BY_CODE[code][1], row + 1
        if at != len(values):
            raise MeshError(f"{CUT_OFF} within its elements")
        placed = []
        for code, (rows, places) in starts.items():
            kind, nodes = _BY_CODE[code]
            table = flat[np.array(places)[:, None] + np.arange(nodes)]
            which = np.array(rows)
            placed += [
                one._replace(which=which[one.which]) for one in self.build.cells(kind, table)
            ]
        return placed, row

    def _attributes(self, grid: ElementTree.Element, placed: list[Placed], rows: int) -> None:
        fields = CellFields(self.build, placed, rows)
        for attribute in grid.findall("Attribute"):
            name, item = attribute.get("Name", ""), attribute.find("DataItem")
            centre = attribute.get("Center", "Node").lower()
            scalar = (attribute.get("AttributeType") or attribute.get("Type") or "Scalar").lower()
            values: NDArray[np.generic] = np.zeros(0)
            if item is not None and scalar == "scalar":
                try:
                    values = self._data(item).ravel()
                except MeshError:
                    values = np.zeros(0)
            if centre == "cell":
                fields.keep(name, values)
            elif self.build.parts == 1:
                keep_point_data(self.build, name, values)
            else:
                self.build.dropped.append(f"point data {name!r}")

    def _data(self, item: ElementTree.Element) -> NDArray[np.generic]:
        found = self._resolved(item)
        assert found is not None
        item = found
        if item.get("ItemType", "Uniform").lower() != "uniform":
            raise MeshError("an item of data that is not uniform is not read")
        kind = (item.get("NumberType") or item.get("DataType") or "Float").lower()
        size = numbers.count_of(item.get("Precision", "4"), 8)
        code = {"float": "f", "int": "i", "uint": "u", "char": "i", "uchar": "u"}.get(kind)
        if code is None or size not in (1, 2, 4, 8):
            raise MeshError(f"it has numbers of the unknown type {kind[:20]!r}")
        if kind in ("char", "uchar"):
            size = 1
        words = item.get("Dimensions", "").split()
        count = 1
        for word in words:
            count *= numbers.count_of(word, 2**40)
        text = (item.text or "").strip()
        flat: NDArray[np.generic]
        match item.get("Format", "XML").upper():
            case "XML":
                flat = numbers.floats(text.encode()) if code == "f" else numbers.ints(text.encode())
            case "BINARY":
                order = ">" if item.get("Endian", "Native").lower() == "big" else "<"
                flat = self._binary(text, order + code + str(size), item, count)
            case "HDF":
                flat = self._hdf(text)
            case other:
                raise MeshError(f"an item has the unknown format {other[:20]!r}")
        if words and len(flat) != count:
            raise MeshError(f"{CUT_OFF} or damaged: {count} numbers are announced")
        return flat

    def _beside(self, name: str) -> Path:
        """A file in the folder of this one, or below it."""
        folder = self.path.parent.resolve()
        place = (folder / name).resolve()
        if not place.is_relative_to(folder):
            raise MeshError("its data are in a file that is not beside it, which is not read")
        if not place.is_file():
            raise MeshError(f"the file {name[:60]!r} with its data is missing")
        return place

    def _binary(
        self, name: str, code: str, item: ElementTree.Element, count: int
    ) -> NDArray[np.generic]:
        place = self._beside(name)
        seek = numbers.count_of(item.get("Seek", "0"), place.stat().st_size)
        if count * np.dtype(code).itemsize > place.stat().st_size - seek:
            raise MeshError(f"{CUT_OFF}: {count} numbers are announced")
        return np.fromfile(place, code, count, offset=seek)

    def _hdf(self, text: str) -> NDArray[np.generic]:
        try:
            import h5py
        except ImportError as error:
            raise MeshError("its data are in HDF5, which needs the package h5py") from error
        name, _, inside = text.rpartition(":")
        try:
            with h5py.File(self._beside(name), "r") as file:
                dataset = file[inside]
                if not isinstance(dataset, h5py.Dataset) or dataset.dtype.kind not in "biuf":
                    raise MeshError("its data in HDF5 are no numbers")
                if dataset.size * dataset.dtype.itemsize > _LARGEST:
                    raise MeshError("its data in HDF5 are too large")
                return np.asarray(dataset[()]).ravel()
        except (OSError, KeyError, RuntimeError, ValueError) as error:
            if isinstance(error, MeshError):
                raise
            raise MeshError(f"its data in HDF5 cannot be read ({str(error)[:80]})") from error
