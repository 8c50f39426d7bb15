"""Mesh file formats by ending: reader, writer, and which elements and data they hold.

The readers are our own (:mod:`meshwright_core.io.readers`) but for glTF and 3MF, which trimesh
reads; docs/formats.md says why. meshio and trimesh are imported on first use. They print, call
``sys.exit`` and raise anything; that is contained here and comes out as a MeshError.
"""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import io
import os
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io import text_formats
from meshwright_core.io.content import Content
from meshwright_core.io.readers import (
    abaqus,
    avs,
    cgns,
    dolfin,
    exodus,
    gmsh,
    ideas,
    legacy_vtk,
    med,
    medit,
    nastran,
    netgen,
    ply,
    su2,
    surfaces,
    tecplot,
    vtk_xml,
    xdmf,
)
from meshwright_core.io.readers.binary_scenes import require_bounded
from meshwright_core.io.writers import abaqus as abaqus_writer
from meshwright_core.io.writers import cell_arrays, vtk_polydata
from meshwright_core.io.writers import exodus as exodus_writer
from meshwright_core.io.writers import gmsh as gmsh_writer
from meshwright_core.io.writers import ideas as ideas_writer
from meshwright_core.io.writers import med as med_writer
from meshwright_core.io.writers import nastran as nastran_writer
from meshwright_core.io.writers import su2 as su2_writer
from meshwright_core.io.writers import xdmf as xdmf_writer

SHAPES = (".dxf", ".svg", ".geojson", ".wkt", ".json", ".poly")
"""Endings of files that hold a shape; see :mod:`meshwright_core.io.drawings`."""
DAT = ".dat"
"""The ending of meshes of Tecplot and of coordinates of airfoils, which hold a shape."""


@dataclass(frozen=True)
class Format:
    """One file format.

    Attributes:
        title: its name in messages.
        read: from a path to its content.
        write: the content to a path.
        kinds: the element types that it holds; none for formats that are only read.
        data: whether it holds data by point.
        regions: whether it holds the region of each element.
        sides: whether it holds sides.
        numbers: whether sides and regions have numbers there, in place of names.
        spelling: from names of sides and of regions to how they are written, None for as they are.
        longest: bytes that a name may have, 0 for any.
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
    spelling: Callable[[Sequence[str], Sequence[str]], dict[str, str]] | None = None
    longest: int = 0
    merge: bool = False
    needs: tuple[str, ...] = ()


def of(path: str | os.PathLike[str], written: bool = False) -> Format:
    """Return the format of a file by the ending of its name. written: it is to be written.

    Raises:
        MeshError: no format has this ending, or it is only read; the message does not name the
            path.
    """
    ending = Path(path).suffix.lower()
    if ending in SHAPES:
        raise MeshError(f"a {ending} file holds a shape (outline and holes), not a mesh")
    if ending not in FORMATS:
        shown = f"the ending {ending!r} is not one of a mesh file" if ending else "no ending"
        raise MeshError(f"{shown}; there are {' '.join(FORMATS)}")
    form = FORMATS[ending]
    if written and not form.kinds:
        raise MeshError(f"{form.title} files ({ending}) are only read: .vtu and .vtp hold any mesh")
    package = missing_package(form)
    if package is not None:
        raise MeshError(
            f"{form.title} files need the package {package}, which is not installed "
            f"(pip install {package}, or meshwright[files])"
        )
    return form


def missing_package(form: Format) -> str | None:
    """The package that a format needs and that is not installed; None if there is none."""
    return next((name for name in form.needs if importlib.util.find_spec(name) is None), None)


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
    except MemoryError as error:
        raise MeshError("it does not fit into memory") from error
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


def _meshio_write(module: str, **options: Any) -> Callable[[Path, Content], None]:
    """Return the writer of a meshio module."""

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

    return write


NOT_UNDERSTOOD = "it is not understood"
"""How the message on an error begins that a reader of our own has not foreseen."""


def _own_read(read: Callable[[bytes], Content]) -> Callable[[Path], Content]:
    return _own_path(lambda path: read(path.read_bytes()))


def _own_path(read: Callable[[Path], Content]) -> Callable[[Path], Content]:
    def take(path: Path) -> Content:
        try:
            with np.errstate(all="ignore"):
                return read(path)
        except (MeshError, OSError):
            raise
        except MemoryError as error:
            raise MeshError("it does not fit into memory") from error
        except Exception as error:
            text = " ".join(f"{type(error).__name__}: {error}".split())[:120]
            raise MeshError(f"{NOT_UNDERSTOOD} ({text})") from error

    return take


def _own_write(write: Callable[[Content], str]) -> Callable[[Path, Content], None]:
    def put(path: Path, content: Content) -> None:
        path.write_text(write(content), encoding="utf-8", newline="\n")

    return put


def _not_written(path: Path, content: Content) -> None:
    """Of formats that are only read; :func:`mesh_files.write` refuses them before."""
    raise MeshError("this format is only read")


write_msh_4 = _own_write(lambda content: gmsh_writer.write(content, "4.1"))
"""Writes a Gmsh file of version 4.1."""


def _trimesh(kind: str) -> tuple[Any, Any]:
    def read(path: Path) -> Content:
        require_bounded(path, kind)
        import trimesh

        with contained():
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


_ARRAYS = ("vtk", "vtu")
"""Modules that write data by cell under any name."""
_REFERENCES = {"medit": ("medit:ref", True), "avsucd": ("avsucd:material", False)}
"""Modules that write one number for each cell: the array that holds it, and whether edges have one
too."""

_TRIANGLES = ("triangle",)
_OBJ = Format("OBJ", _own_read(surfaces.read_obj), _own_write(text_formats.write_obj))
_OFF = Format("OFF", _own_read(surfaces.read_off), _own_write(text_formats.write_off))
_STL = Format(
    "STL",
    _own_read(surfaces.read_stl),
    _own_write(text_formats.write_stl),
    _TRIANGLES,
    merge=True,
)
_MSH = Format(
    "Gmsh",
    _own_read(gmsh.read),
    _own_write(gmsh_writer.write),
    data=True,
    regions=True,
    sides=True,
)
_VTK = Format(
    "VTK", _own_read(legacy_vtk.read), _meshio_write("vtk"), data=True, regions=True, sides=True
)
_VTU = Format(
    "VTU", _own_read(vtk_xml.read), _meshio_write("vtu"), data=True, regions=True, sides=True
)
_VTP = Format(
    "VTK polygonal data",
    _own_read(vtk_xml.read),
    _own_write(vtk_polydata.write),
    data=True,
    regions=True,
    sides=True,
)
_GRID = Format("VTK grid", _own_read(vtk_xml.read), _not_written, kinds=())
_UNV = Format(
    "I-DEAS universal",
    _own_read(ideas.read),
    _own_write(ideas_writer.write),
    regions=True,
    sides=True,
)
_INP = Format(
    "Abaqus",
    _own_path(abaqus.read_path),
    _own_write(abaqus_writer.write),
    regions=True,
    sides=True,
    spelling=abaqus_writer.spelling,
)
_SU2 = Format(
    "SU2",
    _own_read(su2.read),
    _own_write(su2_writer.write),
    sides=True,
    spelling=su2_writer.spelling,
)
_BDF = Format(
    "Nastran", _own_path(nastran.read_path), _own_write(nastran_writer.write), regions=True
)
_DAT = Format("Tecplot", _own_read(tecplot.read), _meshio_write("tecplot"), data=True)
_PLY = Format("PLY", _own_read(ply.read), _meshio_write("ply"), data=True)
_MESH = Format(
    "Medit", _own_read(medit.read), _meshio_write("medit"), regions=True, sides=True, numbers=True
)
_AVS = Format(
    "AVS-UCD", _own_read(avs.read), _meshio_write("avsucd"), data=True, regions=True, numbers=True
)
_XML = Format("DOLFIN XML", _own_read(dolfin.read), _meshio_write("dolfin"), kinds=_TRIANGLES)
_VOL = Format("Netgen", _own_read(netgen.read), _meshio_write("netgen"))
_XDMF = Format(
    "XDMF",
    _own_path(xdmf.read_path),
    _own_write(xdmf_writer.write),
    data=True,
    regions=True,
    sides=True,
)

_EXODUS = Format(
    "Exodus",
    _own_path(exodus.read),
    exodus_writer.write,
    regions=True,
    sides=True,
    longest=exodus_writer.LETTERS,
    needs=("netCDF4",),
)

FORMATS: dict[str, Format] = {
    ".msh": _MSH,
    ".vtk": _VTK,
    ".vtu": _VTU,
    ".vtp": _VTP,
    ".vts": _GRID,
    ".vti": _GRID,
    ".vtr": _GRID,
    ".inp": _INP,
    ".su2": _SU2,
    ".obj": _OBJ,
    ".ply": _PLY,
    ".stl": _STL,
    ".off": _OFF,
    ".mesh": _MESH,
    ".meshb": _MESH,
    ".avs": _AVS,
    ".xml": _XML,
    ".vol": _VOL,
    ".bdf": _BDF,
    ".nas": _BDF,
    ".fem": _BDF,
    ".unv": _UNV,
    ".dat": _DAT,
    ".tec": _DAT,
    ".glb": Format("glTF", *_trimesh("glb"), kinds=_TRIANGLES, merge=True),
    ".gltf": Format("glTF", *_trimesh("gltf"), kinds=_TRIANGLES, merge=True),
    ".3mf": Format("3MF", *_trimesh("3mf"), kinds=_TRIANGLES, merge=True, needs=("lxml",)),
    ".xdmf": _XDMF,
    ".xmf": _XDMF,
    ".med": Format(
        "MED",
        _own_path(med.read),
        med_writer.write,
        regions=True,
        sides=True,
        longest=med_writer.LETTERS,
        needs=("h5py",),
    ),
    ".cgns": Format("CGNS", _own_path(cgns.read), _not_written, kinds=(), needs=("h5py",)),
    ".exo": _EXODUS,
    ".e": _EXODUS,
}
"""Every ending that is read; those whose format has kinds are written too.

XDMF is written as plain XML, MED and Exodus in memory first: the HDF5 library kills the process
when the disk is full.
"""
