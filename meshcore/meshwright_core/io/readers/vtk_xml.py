"""VTK's XML files, of any number of pieces: unstructured grids (.vtu), polygonal data (.vtp), and
structured grids, images and rectilinear grids of quads (.vts, .vti, .vtr).

After the VTK file formats documentation: arrays as text, as base64 with or without compression by
zlib, LZMA or LZ4, and appended, encoded or raw.
"""

from __future__ import annotations

import base64
import binascii
import lzma
import re
import zlib
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from meshwright_core.errors import MeshError
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers, vtk_cells
from meshwright_core.io.readers.builder import Builder, Placed
from meshwright_core.io.readers.fields import CellFields, keep_point_data
from meshwright_core.io.readers.numbers import CUT_OFF, Ints

_TYPES = {
    "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4", "UInt32": "u4",
    "Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8",
}  # fmt: skip
_APPENDED = re.compile(rb"<AppendedData[^>]*>")
_ENCODING = re.compile(rb"""encoding\s*=\s*["'](\w+)["']""")
_GRIDS = ("StructuredGrid", "ImageData", "RectilinearGrid")
_SETS = ("UnstructuredGrid", "PolyData", *_GRIDS)
_LARGEST = 2**32
"""Bytes that compressed arrays of a file may have in all."""


@dataclass
class _Arrays:
    """How the arrays of a file are stored.

    Attributes:
        order: byte order.
        header: type of the numbers before binary data.
        compressor: "" for none.
        appended: the appended data behind its underscore.
        raw: whether that is not encoded.
        room: bytes that may still be uncompressed.
    """

    order: str
    header: str
    compressor: str
    appended: bytes
    raw: bool
    room: int = _LARGEST

    def read(self, element: ElementTree.Element) -> NDArray[np.generic]:
        """The numbers of a DataArray, end to end."""
        kind = element.get("type", "")
        if kind not in _TYPES:
            raise MeshError(f"it has an array of the unknown type {kind[:20]!r}")
        code = self.order + _TYPES[kind]
        match element.get("format", "ascii"):
            case "ascii":
                text = (element.text or "").encode()
                return numbers.floats(text) if "f" in code else numbers.ints(text)
            case "binary":
                data = self._bytes(b"".join((element.text or "").encode().split()), False)
            case "appended":
                offset = numbers.count_of(element.get("offset", ""), len(self.appended))
                data = self._bytes(memoryview(self.appended)[offset:], self.raw)
            case other:
                raise MeshError(f"an array has the unknown format {other[:20]!r}")
        size = np.dtype(code).itemsize
        if len(data) % size:
            raise MeshError(f"{CUT_OFF} within an array")
        return np.frombuffer(data, code)

    def _bytes(self, text: bytes | memoryview, raw: bool) -> bytes:
        width = np.dtype(self.header).itemsize

        def take(start: int, count: int) -> tuple[bytes, int]:
            """`count` bytes of what is encoded at `start`, and where the next begins."""
            if raw:
                end = start + count
                part = bytes(text[start:end])
            else:
                end = start + (count + 2) // 3 * 4
                try:
                    part = base64.b64decode(bytes(text[start:end]))[:count]
                except binascii.Error as error:
                    raise MeshError("it is damaged: an array is no base64") from error
            if len(part) < count or count < 0:
                raise MeshError(f"{CUT_OFF} within an array")
            return part, end

        def header(part: bytes) -> list[int]:
            return [int(n) for n in np.frombuffer(part, self.header)]

        if not self.compressor:
            # the number of bytes and the bytes are encoded together
            (count,) = header(take(0, width)[0])
            most = len(text) if raw else len(text) // 4 * 3
            if count > most:
                raise MeshError(f"{CUT_OFF} within an array")
            return take(0, width + count)[0][width:]
        first, _ = take(0, 3 * width)
        blocks, size, last = header(first)
        if blocks > len(text) // width or size > _LARGEST or last > size:
            raise MeshError("it is damaged: the sizes of a compressed array")
        head, at = take(0, (3 + blocks) * width)
        packed, _ = take(at, sum(header(head)[3:]))
        parts, at = [], 0
        for i, length in enumerate(header(head)[3:]):
            full = last if last and i == blocks - 1 else size
            self.room -= full
            if self.room < 0:
                raise MeshError("its compressed arrays are too large")
            parts.append(_unpacked(packed[at : at + length], full, self.compressor))
            at += length
        return b"".join(parts)


def _unpacked(packed: bytes, size: int, compressor: str) -> bytes:
    try:
        if compressor == "vtkZLibDataCompressor":
            data = zlib.decompressobj().decompress(packed, size)
        elif compressor == "vtkLZMADataCompressor":
            data = lzma.LZMADecompressor(memlimit=2**28).decompress(packed, size)
        elif compressor == "vtkLZ4DataCompressor":
            data = _lz4(packed, size)
        else:
            raise MeshError(f"its compression {compressor[:30]!r} is unknown")
    except (zlib.error, lzma.LZMAError) as error:
        raise MeshError("it is damaged: a compressed array") from error
    if len(data) != size:
        raise MeshError(f"{CUT_OFF} within a compressed array")
    return data


def _lz4(packed: bytes, size: int) -> bytes:
    """Decompress an LZ4 block of `size` bytes (LZ4 block format description, Y. Collet)."""
    data, at = bytearray(), 0
    try:
        while at < len(packed):
            token = packed[at]
            literals, at = _lz4_length(packed, at + 1, token >> 4)
            data += packed[at : at + literals]
            at += literals
            if at >= len(packed) or len(data) > size:
                break
            offset = packed[at] | packed[at + 1] << 8
            length, at = _lz4_length(packed, at + 2, token & 15)
            length += 4
            start = len(data) - offset
            if offset == 0 or start < 0 or len(data) + length > size:
                raise MeshError("it is damaged: a compressed array")
            seed = bytes(data[start : start + length])
            data += (seed * (length // len(seed) + 1))[:length]
    except IndexError:
        return b""
    return bytes(data)


def _lz4_length(packed: bytes, at: int, length: int) -> tuple[int, int]:
    while length >= 15:
        length, at = length + packed[at], at + 1
        if packed[at - 1] != 255:
            break
    return length, at


def read(data: bytes) -> Content:
    """Return the content of a VTK XML file; each piece is a part.

    Raises:
        MeshError: another dataset, an unknown encoding, or damage.
    """
    root, appended, raw = _parsed(data)
    name = root.get("type", "")
    if root.tag != "VTKFile" or name not in _SETS:
        raise MeshError(f"a VTK {name[:30] or 'file without dataset'} is not read")
    order = ">" if root.get("byte_order") == "BigEndian" else "<"
    header = {"UInt32": "u4", "UInt64": "u8"}.get(root.get("header_type", "UInt32"))
    if header is None:
        raise MeshError("its header_type is unknown")
    arrays = _Arrays(order, order + header, root.get("compressor", ""), appended, raw)
    dataset = root.find(name)
    build = Builder()
    pieces = [] if dataset is None else dataset.findall("Piece")
    for piece in pieces:
        build.part()
        if name in _GRIDS and dataset is not None:
            placed, rows = _structured(build, name, dataset, piece, arrays)
            _fields(build, piece, arrays, placed, rows, only=len(pieces) == 1)
            continue
        count = numbers.count_of(piece.get("NumberOfPoints", "0"), 2**48)
        points = piece.find("Points/DataArray")
        if count and points is None:
            raise MeshError(f"{CUT_OFF}: the points of a piece are missing")
        if points is not None:
            flat = arrays.read(points)
            if len(flat) != 3 * count:
                raise MeshError(f"{CUT_OFF} or damaged: {count} points are announced")
            build.points(flat.reshape(-1, 3))
        read_cells = _grid_cells if name == "UnstructuredGrid" else _polygons
        placed, rows = read_cells(build, piece, arrays)
        _fields(build, piece, arrays, placed, rows, only=len(pieces) == 1)
    return build.content()


def _parsed(data: bytes) -> tuple[ElementTree.Element, bytes, bool]:
    """The XML tree without appended data, that data, and whether it is raw."""
    found = _APPENDED.search(data)
    appended, raw = b"", False
    if found:
        encoding = _ENCODING.search(found[0])
        raw = encoding is not None and encoding[1] == b"raw"
        start = data.find(b"_", found.end()) + 1
        end = data.rfind(b"</AppendedData>")
        if start == 0 or end < start:
            raise MeshError(f"{CUT_OFF}: its appended data do not end")
        appended = data[start:end]
        if not raw:
            appended = b"".join(appended.split())
        data = data[: found.start()] + data[end + len(b"</AppendedData>") :]
    try:
        return ElementTree.fromstring(data), appended, raw
    except ElementTree.ParseError as error:
        raise MeshError(f"it is cut off or damaged: {error}") from error


def _grid_cells(
    build: Builder, piece: ElementTree.Element, arrays: _Arrays
) -> tuple[list[Placed], int]:
    count = numbers.count_of(piece.get("NumberOfCells", "0"), 2**48)
    if count == 0:
        return [], 0
    named = {one.get("Name"): one for one in piece.findall("Cells/DataArray")}
    if not {"connectivity", "offsets", "types"} <= named.keys():
        raise MeshError(f"{CUT_OFF}: the cells of a piece are missing")
    members = numbers.whole(arrays.read(named["connectivity"]))
    codes = numbers.whole(arrays.read(named["types"]))
    sizes = _sizes(numbers.whole(arrays.read(named["offsets"])), count, len(members))
    if len(codes) != count:
        raise MeshError(f"{CUT_OFF} or damaged: {count} cells are announced")
    return vtk_cells.add_cells(build, codes, sizes, members), count


def _structured(
    build: Builder, name: str, dataset: ElementTree.Element, piece: ElementTree.Element,
    arrays: _Arrays,
) -> tuple[list[Placed], int]:  # fmt: skip
    """The quads of a piece of a grid, and their number."""
    extent = _listed(piece.get("Extent", ""), 6)
    low, high = numbers.whole(extent[::2]), numbers.whole(extent[1::2])
    if (high < low).any():
        raise MeshError("it is damaged: the extent of a piece")
    a, b, c = (high - low + 1).tolist()
    count = a * b * c
    if name == "StructuredGrid":
        points = piece.find("Points/DataArray")
        flat = np.zeros(0) if points is None else arrays.read(points)
        if len(flat) != 3 * count:
            raise MeshError(f"{CUT_OFF} or damaged: {count} points are announced")
        build.points(flat.reshape(-1, 3))
    else:
        vtk_cells.refuse_huge(count)
        axes = [np.arange(first, last + 1.0) for first, last in zip(low, high, strict=True)]
        if name == "RectilinearGrid":
            found = [arrays.read(one) for one in piece.findall("Coordinates/DataArray")]
            if [len(axis) for axis in found] != [a, b, c]:
                raise MeshError("its coordinates do not fit its extent")
            axes = [axis.astype(np.float64) for axis in found]
        z, y, x = np.meshgrid(*axes[::-1], indexing="ij")
        places = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
        if name == "ImageData":
            turn = _listed(dataset.get("Direction", "1 0 0 0 1 0 0 0 1"), 9).reshape(3, 3)
            spacing = _listed(dataset.get("Spacing", "1 1 1"), 3)
            places = _listed(dataset.get("Origin", "0 0 0"), 3) + (places * spacing) @ turn.T
        build.points(places)
    quads = vtk_cells.grid_cells((a, b, c))
    return build.cells("quad", quads), len(quads)


def _listed(text: str, count: int) -> np.ndarray:
    """The numbers of an attribute."""
    found = numbers.floats(text.encode())
    if len(found) != count:
        raise MeshError(f"it is damaged: {text[:40]!r} stands where {count} numbers belong")
    return found


def _polygons(
    build: Builder, piece: ElementTree.Element, arrays: _Arrays
) -> tuple[list[Placed], int]:
    placed: list[Placed] = []
    rows = 0
    for tag, group in (("Verts", "VERTICES"), ("Lines", "LINES"), ("Polys", "POLYGONS"),
                       ("Strips", "TRIANGLE_STRIPS")):  # fmt: skip
        count = numbers.count_of(piece.get(f"NumberOf{tag}", "0"), 2**48)
        if count == 0:
            continue
        named = {one.get("Name"): one for one in piece.findall(f"{tag}/DataArray")}
        if not {"connectivity", "offsets"} <= named.keys():
            raise MeshError(f"{CUT_OFF}: the cells of a piece are missing")
        members = numbers.whole(arrays.read(named["connectivity"]))
        sizes = _sizes(numbers.whole(arrays.read(named["offsets"])), count, len(members))
        placed += vtk_cells.add_lists(build, group, sizes, members, rows)
        rows += count
    return placed, rows


def _sizes(stops: Ints, count: int, members: int) -> Ints:
    sizes = np.diff(stops, prepend=0)
    if len(stops) != count or (sizes < 0).any() or int(sizes.sum()) > members:
        raise MeshError(f"{CUT_OFF} or damaged: the offsets of its cells")
    return sizes


def _fields(
    build: Builder,
    piece: ElementTree.Element,
    arrays: _Arrays,
    placed: list[Placed],
    rows: int,
    only: bool,
) -> None:
    """Take the data by point and cell; what cannot be read of them is noted as lost."""
    fields = CellFields(build, placed, rows)
    for element in piece.findall("PointData/DataArray"):
        name = element.get("Name", "")
        wanted = only and element.get("NumberOfComponents", "1") in ("1", "")
        values = _values(arrays, element) if wanted else np.zeros(0)
        keep_point_data(build, name, values)
    for element in piece.findall("CellData/DataArray"):
        name, width = element.get("Name", ""), element.get("NumberOfComponents", "1")
        whole = _TYPES.get(element.get("type", ""), "f")[0] in "iu" and width in ("1", "")
        fields.keep(name, _values(arrays, element) if whole else np.zeros(0))


def _values(arrays: _Arrays, element: ElementTree.Element) -> NDArray[np.generic]:
    try:
        return arrays.read(element)
    except MeshError:
        return np.zeros(0)
