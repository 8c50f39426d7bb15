"""Sources: what a person may name when a mesh is wanted, in Python and in notebooks.

The command line has its own door, :mod:`meshwright.cli.arguments`, with errors of its own.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core import HalfEdgeMesh, MeshError

if TYPE_CHECKING:
    from meshwright_core.domains.domain import Domain


def mesh(
    source: HalfEdgeMesh | Domain | str | Path | np.ndarray | list | tuple,
    kind: str | None = None,
    *,
    max_edge: float | None = None,
    min_angle: float | None = None,
    seed: int = 0,
) -> HalfEdgeMesh:
    """A mesh of what ``source`` names.

    Args:
        source: a name of the gallery (``"star"``), a mesh file, a project, a geometry file, a
            domain, the corners of a polygon (n, 2), or a mesh, which is copied.
        kind: ``"tri"`` or ``"quad"`` (if left out) for what has to be meshed; a mesh that is
            there already must be of this kind.
        max_edge: length that no edge exceeds.
        min_angle: degrees, the angle that Triangle aims at.
        seed: 0 is the plain mesh, others let Triangle choose otherwise where it can.

    Raises MeshError, in one sentence, where there is no such thing or it cannot be meshed.
    """
    from meshwright_core.domains import meshing

    if kind not in (None, "tri", "quad"):
        raise MeshError(f"There is no kind of mesh {kind!r}: it is 'tri' or 'quad'.")
    found = source.copy() if isinstance(source, HalfEdgeMesh) else _found(source)
    if not isinstance(found, HalfEdgeMesh):
        return meshing.mesh_domain(
            found, kind or "quad", max_edge=max_edge, min_angle=min_angle, seed=seed
        )
    if kind not in (None, found.kind):
        raise MeshError(f"This mesh is of kind '{found.kind}', not '{kind}'.")
    return found


def _found(source: Domain | str | Path | np.ndarray | list | tuple) -> HalfEdgeMesh | Domain:
    """The mesh or the domain that is meant."""
    from meshwright.document.storage import project_file
    from meshwright_core.domains import gallery
    from meshwright_core.domains.domain import Domain
    from meshwright_core.io import drawings, mesh_files

    if isinstance(source, Domain):
        return source
    if isinstance(source, np.ndarray | list | tuple):
        return Domain(source)
    if not isinstance(source, str | Path):
        raise MeshError(f"A mesh cannot be made of {type(source).__name__}.")
    path = Path(source)
    if isinstance(source, str) and not path.suffix and not path.exists():
        return gallery.shape(source)
    if project_file.is_project(path):
        return project_file.read(path).mesh
    if drawings.is_geometry(path):
        return drawings.read_domain(path)
    return mesh_files.read(path)
