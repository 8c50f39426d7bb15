"""Reads and writes the files that a document is opened from or saved to.

The ending of its name decides what a file is: a project (a mesh with its history), a drawing (a
shape that has to be meshed first), or a mesh file.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from meshwright.document.history import History
from meshwright.document.storage import file_stamp, project_file
from meshwright.document.storage.document_state import DocumentState
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.io import mesh_files
from meshwright_core.io.formats import DAT, SHAPES

if TYPE_CHECKING:
    from meshwright_core.domains.domain import Domain


def is_drawing(path: str | Path) -> bool:
    """Whether a file holds a shape, which has to be meshed: by its ending.

    Of .dat files those with coordinates of an airfoil do; the others are meshes of Tecplot.
    """
    ending = Path(path).suffix.lower()
    if ending != DAT:
        return ending in SHAPES
    from meshwright_core.io import drawings

    return drawings.is_geometry(path)


def read(
    path: str | Path,
    corner_angle: float | None = None,
    curve_step: float | None = None,
    region: str | None = None,
    gap: float | None = None,
    fit: str | None = None,
    part: str | None = None,
    to_quads: bool = False,
) -> DocumentState | Domain:
    """Read a file: a drawing as a domain, a project or a mesh file as the state of a document.

    Args:
        path: the file.
        corner_angle: degrees by which the boundary of a mesh or drawing must turn at a corner;
            None for the default, 0.01. A project stores its corners.
        curve_step: degrees that an edge of a mesh turns along a curve of a drawing, at most; None
            for as much as the shape allows.
        region: names or numbers of regions of a drawing, or "all"; None for all if they touch.
        gap: width of gaps of a drawing that are closed, in its units; None for 0.001 of its size.
        fit: "arcs" or "splines" that are to be found in polylines of a drawing.
        part: name or number of the only part of a mesh file that is to be read.
        to_quads: make quads of the triangles of a mesh file.

    Raises MeshError, one sentence that names the file, if it cannot be read.
    """
    path = Path(path)
    angle = CORNER_ANGLE if corner_angle is None else corner_angle
    stamp = file_stamp.of(path)  # before it is read: what is written meanwhile counts as a change
    if project_file.is_project(path):
        return replace(project_file.read(path), stamp=stamp)
    if is_drawing(path):
        # imported late: the readers of drawings need shapely
        from meshwright_core.io import drawings

        return drawings.read_domain(path, angle, curve_step, region, gap=gap, fit=fit)
    mesh = mesh_files.read(path, angle, part, to_quads)
    history = History(mesh.score, mesh.optimum)
    if part is not None or to_quads:  # not what the file holds: it must not be replaced by it
        return DocumentState(mesh, history, path.stem)
    return DocumentState(mesh, history, path.stem, path, stamp=stamp)


def read_meshed(path: str | Path, kind: str, to_quads: bool = False) -> DocumentState:
    """Read a file as :func:`read` does, and mesh a drawing with elements of ``kind``.

    The path of the result is None for a drawing: a mesh is not saved to the file of its shape.
    """
    found = read(path, to_quads=to_quads)
    if isinstance(found, DocumentState):
        return found
    from meshwright_core.domains import meshing

    mesh: HalfEdgeMesh = meshing.mesh_domain(found, kind)
    return DocumentState(mesh, History(mesh.score, mesh.optimum), Path(path).stem)


def write(path: str | Path, state: DocumentState) -> None:
    """Write a project, with the whole history, or a mesh file, by the ending.

    Raises MeshError, one sentence that names the file, if it cannot be written.
    """
    if project_file.is_project(path):
        project_file.write(path, state)
    else:
        mesh_files.write(path, state.mesh)
