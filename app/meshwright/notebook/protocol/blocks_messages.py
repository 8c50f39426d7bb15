"""Blocks in a notebook: edges with the numbers of cells of their chords, and files of the grid."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.document import block_edits
from meshwright.document.block_preview import PlannedBlocks
from meshwright.graphics.colouring import chord_colours
from meshwright.graphics.theme import DARK, LIGHT
from meshwright.notebook.protocol import requests
from meshwright.notebook.protocol.mesh_sync import CoordinateFrame, Packet
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.blocks.grid import block_grid
from meshwright_core.blocks.sizing import GridConflictError
from meshwright_core.errors import sentence
from meshwright_core.io.grids.block_files import BLOCK_MESH_DICT, losses, write_blocks

if TYPE_CHECKING:
    from meshwright.notebook.session import Session

FORMATS = (
    (BLOCK_MESH_DICT, "OpenFOAM"),
    (".geo", "Gmsh geometry"),
    (".msh", "Gmsh mesh"),
    (".cgns", "CGNS"),
    (".xyz", "Plot3D"),
    (".vtm", "VTK blocks"),
    (".vtu", "VTK quads"),
    (".su2", "SU2"),
    (".inp", "Abaqus"),
    (".bdf", "Nastran"),
)
"""Endings of files on offer, with their names."""
DEVIATION = 1e-3
"""How far a curved edge may be off its line, in the browser's frame."""
MOST_CELLS = 1_000_000
"""Cells of a grid that is sent to the browser."""


def show_blocks(session: Session, request: requests.ShowBlocks) -> str:
    """Answer with the blocks of the present state."""
    frame = session.broadcaster.mesh_sync.frame
    _answer(session, request, blocks_packet(session.mesh, frame))
    return ""


def set_chord_count(session: Session, request: requests.ChordCount) -> str:
    """Set the number of cells across the chord of an edge, as the window does."""
    planned = PlannedBlocks.of(session.mesh)
    edge = planned.structure.edge_between(*request.ends)
    if edge < 0:
        raise MeshError("the mesh has changed here in the meantime: nothing was done")
    chord = int(planned.structure.chord[edge])
    try:
        block_edits.set_count(session.document, planned.structure, chord, request.count)
    except GridConflictError as error:
        frame = session.broadcaster.mesh_sync.frame
        _answer(session, request, blocks_packet(session.mesh, frame, tuple(error.chords)))
        raise
    return ""


def export_blocks(session: Session, request: requests.ExportBlocks) -> str:
    """Answer with a file of the fine grid, which the browser keeps."""
    if request.ending not in dict(FORMATS):
        raise MeshError("there is no such format")
    name, data, words = exported(session.mesh, request.ending, session.document.name)
    _answer(session, request, Packet({"type": "file", "name": name}, [data]))
    return words


def exported(mesh: HalfEdgeMesh, ending: str, title: str) -> tuple[str, bytes, str]:
    """The file of a grid: its name, its bytes, and a sentence on what is in it.

    Formats of several files become one zip archive. Raises MeshError where there is no grid.
    """
    planned = PlannedBlocks.of(mesh)
    if planned.division is None:
        raise MeshError(planned.problem)
    if planned.cells > MOST_CELLS:
        raise MeshError(
            f"the grid would have {planned.cells:,} cells, and {MOST_CELLS:,} are sent at most: "
            "use meshwright.blocks"
        )
    grid = block_grid(planned.structure, planned.sizing)
    stem = "".join(c if c.isalnum() or c in "-_" else "_" for c in title).strip("_") or "grid"
    with TemporaryDirectory(prefix="meshwright-") as made:
        folder = Path(made)
        path = folder / (ending if ending == BLOCK_MESH_DICT else stem + ending)
        try:
            walls = tuple(wall.name for wall in planned.sizing.walls)
            write_blocks(path, grid, walls=walls)
        except MeshError as error:
            raise MeshError(str(error).replace(f"{path}: ", "")) from None
        files = sorted(file for file in folder.rglob("*") if file.is_file())
        if len(files) == 1:
            name, data = files[0].name, files[0].read_bytes()
        else:
            name, archive = f"{stem}.zip", io.BytesIO()
            with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
                for file in files:
                    packed.write(file, file.relative_to(folder))
            data = archive.getvalue()
    worst = grid.quality.worst_scaled_jacobian
    words = f"Exported {name}: {grid.cell_count:,} cells, worst scaled Jacobian {worst:.2f}."
    return name, data, " ".join((words, *grid.remarks, *losses(path, grid)))


def blocks_packet(
    mesh: HalfEdgeMesh, frame: CoordinateFrame, wrong: tuple[int, ...] = ()
) -> Packet:
    """The block edges as lines, their chords, and the numbers of cells.

    wrong: chords that a refused wish is about. The buffers are the points of all lines, float32
    (n, 2) in the frame, and where each line begins, int32 (e + 1,). Raises MeshError where there
    are no blocks, or too many to show.
    """
    planned = PlannedBlocks.of(mesh)
    structure = planned.structure
    points, first = structure.parts.polylines(DEVIATION * frame.scale)
    counts = planned.division.counts.tolist() if planned.division is not None else None
    content: dict[str, Any] = {
        "type": "blocks",
        "ends": structure.vertices[structure.edges].tolist(),
        "chord": structure.chord.tolist(),
        "counts": counts,
        "set": sorted(planned.pinned()),
        "wrong": sorted({*planned.chords, *wrong}),
        "problem": sentence(planned.problem) if planned.problem else "",
        "quads": len(structure.corners),
        "cells": planned.cells,
        "colours": {
            theme.name: chord_colours(structure.chord_count, theme) for theme in (LIGHT, DARK)
        },
        "formats": [list(one) for one in FORMATS],
    }
    lines = frame.normalised(np.asarray(points))
    return Packet(content, [lines.tobytes(), np.asarray(first).astype("<i4").tobytes()])


def _answer(session: Session, request: requests.Request, packet: Packet) -> None:
    """Send a packet to the view that asked; the other views leave it aside."""
    for port in session.broadcaster.ports:
        session.broadcaster.post(port, packet, request)
