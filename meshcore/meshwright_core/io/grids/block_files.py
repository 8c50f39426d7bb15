"""Writes a block grid to a file; the name selects the format."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from meshwright_core.blocks.grid import BlockGrid
from meshwright_core.errors import MeshError
from meshwright_core.io import formats, mesh_files
from meshwright_core.io.atomic_write import replacing
from meshwright_core.io.grids import cgns, fine_mesh, gmsh_geo, gmsh_msh, openfoam, plot3d, vtk_xml
from meshwright_core.io.grids.openfoam import Extrusion

BLOCK_MESH_DICT = "blockMeshDict"
STRUCTURED = (BLOCK_MESH_DICT, ".geo", ".xyz", ".p3d", ".cgns", ".vtm")
"""Names and endings of formats that keep the blocks; `.xyz` is text, `.p3d` binary."""
HIGHEST_ORDER = {".msh": 3, ".vtu": 3, ".inp": 2}
"""Formats with cells of higher order."""


def endings() -> tuple[str, ...]:
    """All names and endings: those that keep the blocks, then those of meshes of quads."""
    quads = (ending for ending, form in formats.FORMATS.items() if "quad" in form.kinds)
    return (*STRUCTURED, *quads)


def check_format(path: str | os.PathLike[str], order: int = 1, extruded: bool = False) -> None:
    """Raise MeshError, one sentence that names no path, if nothing can be written there so."""
    kind = _kind(Path(path))
    if order > HIGHEST_ORDER.get(kind, 1):
        known = ", ".join(f"{ending} up to {most}" for ending, most in HIGHEST_ORDER.items())
        raise MeshError(f"cells of order {order} cannot be written as {kind}; there are {known}")
    if extruded and kind != BLOCK_MESH_DICT:
        raise MeshError(f"only a {BLOCK_MESH_DICT} is extruded, and not {kind}")
    if kind == ".cgns":
        cgns.require_h5py()


def losses(path: str | os.PathLike[str], grid: BlockGrid) -> tuple[str, ...]:
    """What a file of this name cannot hold of the names of the mesh, or holds otherwise: a sentence
    each.
    """
    kind = _kind(Path(path))
    if kind not in STRUCTURED:
        return mesh_files.losses(path, grid.structure.mesh)
    structure = grid.structure
    said, names = [], {}
    if kind == BLOCK_MESH_DICT:
        pieces, blocks = openfoam.piece_count(grid), len(structure.corners)
        if pieces > blocks:
            said.append(
                f"blockMesh takes no blocks that bend so far: the file has {pieces:,} in place of "
                f"{blocks:,}, with the same cells."
            )
        names = openfoam.side_names(grid)
        if len(structure.region_names) > 1:
            zones = openfoam.zone_names(grid)
            said += mesh_files.respelled(kind, _changed(structure.region_names, zones))
    elif kind == ".cgns":
        names, regions = cgns.families(grid)
        said += mesh_files.respelled("CGNS", _changed(tuple(regions), list(regions.values())))
    elif kind in (".xyz", ".p3d"):
        names = {patch.name: patch.name for patch in structure.patches}
    titles = tuple(patch.title for patch in structure.patches if patch.name in names)
    title = {".cgns": "CGNS", BLOCK_MESH_DICT: kind}.get(kind, "Plot3D")
    return (*said, *mesh_files.respelled(title, _changed(titles, list(names.values()))))


def _changed(old: tuple[str, ...], new: list[str]) -> dict[str, str]:
    return {a: b for a, b in zip(old, new, strict=True) if a != b}


def write_blocks(
    path: str | os.PathLike[str],
    grid: BlockGrid,
    order: int = 1,
    extrusion: Extrusion | None = None,
    walls: tuple[str, ...] = (),
) -> list[Path]:
    """Write a grid, whole or not at all, and return the files written.

    A file called "blockMeshDict" is one for OpenFOAM; otherwise the ending counts: .geo and .msh
    (Gmsh), .xyz and .p3d (Plot3D as text or binary, with a neutral map .nmf beside it), .cgns
    (needs h5py), .vtm (VTK, with a folder of the same name), and all formats of quad meshes.

    Args:
        path: the file.
        grid: the blocks.
        order: of the cells; 2 in .msh, .vtu and .inp, 3 in .msh and .vtu.
        extrusion: of a blockMeshDict.
        walls: patches that are walls there; "all" for every one.

    Raises MeshError, one sentence that begins with the path. Old files are then as they were.
    """
    place = Path(path)
    try:
        check_format(place, order, extrusion is not None)
        kind = _kind(place)
        if kind == ".vtm":
            return _write_multiblock(place, grid)
        written = [place]
        writers: dict[Path, Callable[[Path], None]] = {
            place: _writer(kind, grid, order, extrusion, walls)
        }
        if kind in (".xyz", ".p3d"):
            text = plot3d.neutral_map(grid)
            beside = place.with_suffix(".nmf")
            writers[beside] = lambda file: _put(file, text)
            written.append(beside)
        with ExitStack() as stack:
            # all are written before the first one takes its place
            places = {file: stack.enter_context(replacing(file)) for file in written}
            for file, temporary in places.items():
                writers[file](temporary)
        return written
    except MeshError as error:
        if str(error).startswith(str(place.parent)) or str(error).startswith(str(place)):
            raise
        raise MeshError(f"{place}: {str(error).rstrip('.')}.") from error


def _kind(path: Path) -> str:
    if path.name == BLOCK_MESH_DICT:
        return BLOCK_MESH_DICT
    ending = path.suffix.lower()
    if ending in STRUCTURED:
        return ending
    if ending not in endings():
        shown = f"the ending {ending!r} is not one of a grid" if ending else "no ending"
        raise MeshError(f"{shown}; there are {' '.join(endings())}")
    formats.of(path)  # refuses where a package is missing
    return ending


def _writer(
    kind: str, grid: BlockGrid, order: int, extrusion: Extrusion | None, walls: tuple[str, ...]
) -> Callable[[Path], None]:
    """What writes the file; texts are made before anything is opened."""
    if kind == ".cgns":
        return lambda file: cgns.write_cgns(file, grid)
    if kind == ".p3d":
        data = plot3d.plot3d_bytes(grid)
        return lambda file: _put_bytes(file, data)
    if kind == BLOCK_MESH_DICT:
        text = openfoam.block_mesh_dict(grid, extrusion, walls)
    elif kind == ".geo":
        text = gmsh_geo.geo_text(grid)
    elif kind == ".xyz":
        text = plot3d.plot3d_text(grid)
    elif kind == ".msh":
        text = gmsh_msh.msh_text(grid, order)
    elif kind == ".vtu" and order > 1:
        text = vtk_xml.vtu_text(grid, order)
    elif kind == ".inp" and order > 1:
        text = fine_mesh.inp_text(grid)
    else:
        return lambda file: fine_mesh.write_fine(file, grid)
    return lambda file: _put(file, text)


def _put(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")


def _put_bytes(path: Path, data: bytes) -> None:
    path.write_bytes(data)


def _write_multiblock(place: Path, grid: BlockGrid) -> list[Path]:
    """The folder first, under another name; it replaces one of an earlier grid."""
    folder = place.with_suffix("")
    if folder.exists() and not _is_ours(folder):
        raise MeshError(f"{place}: {folder} is there already, and is no folder of such a grid.")
    text = vtk_xml.vtm_text(grid, folder.name)
    temporary = place.with_name(f".{secrets.token_hex(6)}")
    old = place.with_name(f"{temporary.name}.old")
    try:
        with replacing(place) as file:
            temporary.mkdir()
            vtk_xml.write_multiblock(temporary, grid)
            _put(file, text)
            if folder.exists():
                folder.rename(old)
            temporary.rename(folder)
    except OSError as error:
        raise MeshError(f"{place}: cannot be written ({error.strerror or error}).") from error
    finally:
        if old.exists() and not folder.exists():
            old.rename(folder)
        for rest in (temporary, old):
            shutil.rmtree(rest, ignore_errors=True)
    return [place, folder]


def _is_ours(folder: Path) -> bool:
    return folder.is_dir() and all(
        file.suffix in (".vts", ".vtp") and file.name.startswith(("block_", "patch_"))
        for file in folder.iterdir()
    )
