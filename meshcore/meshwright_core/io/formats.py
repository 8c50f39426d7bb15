"""Mesh file formats by ending: reader, writer, and which elements and data they hold.

meshio and trimesh are imported on first use. Their readers print, call ``sys.exit``, raise
anything, and some never end on a file that is cut off; all that is contained here and comes out
as a MeshError.
"""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import io
import os
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io import legacy_vtk, text_formats
from meshwright_core.io.content import Content
from meshwright_core.io.writers import abaqus, cell_arrays, gmsh, nastran, su2

SHAPES = (".dxf", ".svg", ".geojson", ".wkt", ".json", ".poly")
"""Endings of files that hold a shape; see :mod:`meshwright_core.io.drawings`."""
DAT = ".dat"
"""The ending of meshes of Tecplot and of coordinates of airfoils, which hold a shape."""

_ENDS = 1000
"""Empty reads at the end of a file after which its reader is taken to be stuck."""


@dataclass(frozen=True)
class Format:
    """One file format.

    Attributes:
        title: its name in messages.
        read: from a path to its content.
        write: the content to a path.
        kinds: the element types that it holds.
        data: whether it holds data by point.
        regions: whether it holds the region of each element.
        sides: whether it holds sides.
        numbers: whether sides and regions have numbers there, in place of names.
        merge: whether points at the same place are to be merged on reading.
        needs: packages that reading and writing take beyond our own dependencies.
    """

    title: str
    read: Callable[[Path], Content]
    write: Callable[[Path, Content], None]
    kinds: tuple[str, ...] = ("triangle", "quad")
    data: bool = False
    regions: bool = False
    sides: bool = False
    numbers: bool = False
    merge: bool = False
    needs: tuple[str, ...] = ()


def of(path: str | os.PathLike[str]) -> Format:
    """Return the format of a file by the ending of its name.

    Raises:
        MeshError: no format has this ending; the message does not name the path.
    """
    ending = Path(path).suffix.lower()
    if ending in SHAPES:
        raise MeshError(f"a {ending} file holds a shape (outline and holes), not a mesh")
    if ending not in FORMATS:
        shown = f"the ending {ending!r} is not one of a mesh file" if ending else "no ending"
        raise MeshError(f"{shown}; there are {' '.join(FORMATS)}")
    form = FORMATS[ending]
    for package in form.needs:
        if importlib.util.find_spec(package) is None:
            raise MeshError(
                f"{form.title} files need the package {package}, which is not installed"
            )
    return form


class _Bounded(io.BufferedReader):
    """A binary file that raises EOFError when it is read at its end repeatedly."""

    _ends = 0

    def readline(self, size: int | None = -1, /) -> bytes:
        line = super().readline(-1 if size is None else size)
        self._ends = 0 if line else self._ends + 1
        if self._ends > _ENDS:
            raise EOFError
        return line


class _BoundedText(io.TextIOWrapper):
    """The same for text."""

    _ends = 0

    def readline(self, size: int = -1, /) -> str:  # type: ignore[override]
        line = super().readline(size)
        self._ends = 0 if line else self._ends + 1
        if self._ends > _ENDS:
            raise EOFError
        return line


@contextlib.contextmanager
def contained() -> Any:
    """Capture the output of foreign code; turn its ``sys.exit`` and exceptions into MeshError.

    The system's errors and our own pass unchanged.
    """
    printed = io.StringIO()
    try:
        with (
            contextlib.redirect_stdout(printed),
            contextlib.redirect_stderr(printed),
            warnings.catch_warnings(),
            np.errstate(all="ignore"),
        ):
            warnings.simplefilter("ignore")
            # older numpy only warns when the numbers end too early
            warnings.filterwarnings("error", message="string or file could not be read")
            yield
    except (MeshError, OSError):
        raise
    except (Exception, SystemExit) as error:
        raise MeshError(_why(error, printed.getvalue())) from error


def _why(error: BaseException, printed: str) -> str:
    mute = isinstance(error, SystemExit | KeyError | AssertionError | EOFError)
    text = "" if mute else str(error)
    text = " ".join((text or printed).split()).rstrip(".")
    damaged = "it is cut off or damaged"
    if not text:
        return damaged
    return f"{damaged}: {text if len(text) <= 120 else text[:117] + '...'}"


_REGIONS = ("region", "gmsh:physical")
"""Data by cell in which files keep regions."""


def _content(mesh: Any) -> Content:
    cells: dict[str, Any] = {}
    for block in mesh.cells:
        cells.setdefault(block.type, []).append(np.asarray(block.data))
    joined = {
        kind: np.concatenate([np.atleast_2d(block) for block in blocks if len(block)])
        for kind, blocks in cells.items()
        if any(len(block) for block in blocks)
    }
    points = np.asarray(mesh.points, dtype=float)
    return Content(points, joined, dict(mesh.point_data), _regions(mesh))


def _regions(mesh: Any) -> dict[str, Any]:
    """The region of each cell by type, from the first data that is one number for each cell."""
    for name in _REGIONS:
        found: dict[str, Any] = {}
        for block, values in zip(mesh.cells, mesh.cell_data.get(name, ()), strict=False):
            found.setdefault(block.type, []).append(np.asarray(values).ravel())
        if found:
            return {kind: np.concatenate(parts) for kind, parts in found.items()}
    return {}


def _meshio_path(module: str, **options: Any) -> tuple[Any, Any]:
    """Return reader and writer of a meshio module that opens the path itself."""

    def read(path: Path) -> Content:
        return _content(importlib.import_module(f"meshio.{module}").read(str(path)))

    def write(path: Path, content: Content) -> None:
        import meshio

        named: dict[str, Any] = content.cells
        cell_data: dict[str, Any] = {}
        if module in _ARRAYS:
            named, cell_data = cell_arrays.named_cells(content, quoted=module == "vtk")
        elif module in _REFERENCES:
            named, cell_data = cell_arrays.referenced_cells(content, *_REFERENCES[module])
        cells = [(kind, block.astype(np.int32)) for kind, block in named.items()]
        mesh = meshio.Mesh(content.points, cells, point_data=content.data, cell_data=cell_data)
        importlib.import_module(f"meshio.{module}").write(str(path), mesh, **options)

    return read, write


def _meshio_text(module: str, **options: Any) -> tuple[Any, Any]:
    """Return reader and writer of a meshio module that reads from a text file."""

    def read(path: Path) -> Content:
        foreign = importlib.import_module(f"meshio.{module}")
        with _BoundedText(io.FileIO(path), encoding="utf-8", errors="replace") as file:
            return _content(foreign.read(file))

    return read, _meshio_path(module, **options)[1]


def _meshio_binary(module: str, reader: str = "read", **options: Any) -> tuple[Any, Any]:
    """Return reader and writer of a meshio module that reads from a binary file."""

    def read(path: Path) -> Content:
        foreign = importlib.import_module(f"meshio.{module}")
        with _Bounded(io.FileIO(path)) as file:
            return _content(getattr(foreign, reader)(file))

    return read, _meshio_path(module, **options)[1]


def _own_read(read: Callable[[bytes], Content]) -> Callable[[Path], Content]:
    return lambda path: read(path.read_bytes())


def _own_write(write: Callable[[Content], str]) -> Callable[[Path, Content], None]:
    def put(path: Path, content: Content) -> None:
        path.write_text(write(content), encoding="utf-8", newline="\n")

    return put


write_msh_4 = _own_write(lambda content: gmsh.write(content, "4.1"))
"""Writes a Gmsh file of version 4.1."""


def _trimesh(kind: str) -> tuple[Any, Any]:
    def read(path: Path) -> Content:
        import trimesh

        mesh: Any = trimesh.load(path, file_type=kind, force="mesh", process=False)
        cells = {"triangle": np.asarray(mesh.faces, dtype=np.int64)} if len(mesh.faces) else {}
        return Content(np.asarray(mesh.vertices, dtype=np.float64), cells, {})

    def write(path: Path, content: Content) -> None:
        import trimesh

        mesh = trimesh.Trimesh(content.points, content.cells["triangle"], process=False)
        options: dict[str, Any] = {"embed_buffers": True} if kind == "gltf" else {}
        made: Any = mesh.export(file_type=kind, **options)
        path.write_bytes(made["model.gltf"] if kind == "gltf" else made)

    return read, write


def _read_vtk(path: Path) -> Content:
    """Read by meshio, with its data, or by our own reader where meshio supports less."""
    import meshio

    try:
        return _content(meshio.vtk.read(str(path)))
    except meshio.ReadError as error:
        if not any(part in str(error) for part in ("POLYDATA", "Unknown section")):
            raise
        return legacy_vtk.read(path.read_bytes())


_ARRAYS = ("vtk", "vtu", "xdmf")
"""Modules that write data by cell under any name."""
_REFERENCES = {"medit": ("medit:ref", True), "avsucd": ("avsucd:material", False)}
"""Modules that write one number for each cell: the array that holds it, and whether edges have one
too."""

_TRIANGLES = ("triangle",)
_OBJ = Format("OBJ", _own_read(text_formats.read_obj), _own_write(text_formats.write_obj))
_OFF = Format("OFF", _own_read(text_formats.read_off), _own_write(text_formats.write_off))
_STL = Format(
    "STL",
    _own_read(text_formats.read_stl),
    _own_write(text_formats.write_stl),
    _TRIANGLES,
    merge=True,
)
_MSH = Format(
    "Gmsh",
    _meshio_binary("gmsh.main", "read_buffer")[0],
    _own_write(gmsh.write),
    data=True,
    regions=True,
    sides=True,
)
_INP = Format(
    "Abaqus", _meshio_text("abaqus")[0], _own_write(abaqus.write), regions=True, sides=True
)
_SU2 = Format("SU2", _meshio_text("su2")[0], _own_write(su2.write), sides=True)
_BDF = Format("Nastran", _meshio_text("nastran")[0], _own_write(nastran.write), regions=True)
_DAT = Format("Tecplot", *_meshio_text("tecplot"), data=True)
_XDMF = Format(
    "XDMF",
    *_meshio_path("xdmf", data_format="XML"),
    data=True,
    regions=True,
    sides=True,
    needs=("h5py",),
)

FORMATS: dict[str, Format] = {
    ".msh": _MSH,
    ".vtk": Format("VTK", _read_vtk, _meshio_path("vtk")[1], data=True, regions=True, sides=True),
    ".vtu": Format("VTU", *_meshio_path("vtu"), data=True, regions=True, sides=True),
    ".inp": _INP,
    ".su2": _SU2,
    ".obj": _OBJ,
    ".ply": Format("PLY", *_meshio_binary("ply"), data=True),
    ".stl": _STL,
    ".off": _OFF,
    ".mesh": Format("Medit", *_meshio_text("medit"), regions=True, sides=True, numbers=True),
    ".avs": Format("AVS-UCD", *_meshio_text("avsucd"), data=True, regions=True, numbers=True),
    ".xml": Format("DOLFIN XML", *_meshio_path("dolfin"), kinds=_TRIANGLES),
    ".vol": Format("Netgen", *_meshio_text("netgen")),
    ".bdf": _BDF,
    ".nas": _BDF,
    ".fem": _BDF,
    ".dat": _DAT,
    ".tec": _DAT,
    ".glb": Format("glTF", *_trimesh("glb"), kinds=_TRIANGLES, merge=True),
    ".gltf": Format("glTF", *_trimesh("gltf"), kinds=_TRIANGLES, merge=True),
    ".3mf": Format("3MF", *_trimesh("3mf"), kinds=_TRIANGLES, merge=True, needs=("lxml",)),
    ".xdmf": _XDMF,
    ".xmf": _XDMF,
}
"""Every ending that is read and written.

MED, Exodus, CGNS and the like are left out: their HDF5 library kills the process when the disk
is full. XDMF is written as plain XML.
"""
