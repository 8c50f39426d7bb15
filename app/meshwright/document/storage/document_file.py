"""Reads and writes the files that a document is opened from or saved to.

The ending of its name decides what a file is: a project (a mesh with its history), a drawing (a
shape that has to be meshed first), or a mesh file.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from meshwright.document.history import History
from meshwright.document.storage import project_file
from meshwright.document.storage.document_state import DocumentState
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.io import mesh_files
from meshwright_core.io.formats import SHAPES

if TYPE_CHECKING:
    from meshwright_core.domains.domain import Domain


def is_drawing(path: str | Path) -> bool:
    """Whether the ending is that of a file with a shape, which has to be meshed."""
    return Path(path).suffix.lower() in SHAPES


def read(
    path: str | Path, corner_angle: float | None = None, curve_step: float | None = None
) -> DocumentState | Domain:
    """Read a file: a drawing as a domain, a project or a mesh file as the state of a document.

    Args:
        path: the file.
        corner_angle: degrees by which the boundary of a mesh or drawing must turn at a corner;
            None for the default, 0.01. A project stores its corners.
        curve_step: degrees by which a polyline that replaces a curve turns at each point, at most;
            None for the default, 15.

    Raises MeshError, one sentence that names the file, if it cannot be read.
    """
    path = Path(path)
    angle = CORNER_ANGLE if corner_angle is None else corner_angle
    if project_file.is_project(path):
        return project_file.read(path)
    if is_drawing(path):
        # imported late: the readers of drawings need shapely
        from meshwright_core.io import drawings

        step = drawings.CURVE_STEP if curve_step is None else curve_step
        return drawings.read_domain(path, angle, step)
    mesh = mesh_files.read(path, angle)
    return DocumentState(mesh, History(mesh.score, mesh.optimum), path.stem, path)


def read_meshed(path: str | Path, kind: str) -> DocumentState:
    """Read a file as :func:`read` does, and mesh a drawing with elements of ``kind``.

    The path of the result is None for a drawing: a mesh is not saved to the file of its shape.
    """
    found = read(path)
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
