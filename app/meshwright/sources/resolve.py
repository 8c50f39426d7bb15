"""What a name, a path or an object means where a mesh is wanted.

The command line, the window, the widget, the experiments and ``meshwright.mesh`` all decide here.
The gallery and the mesh generator, which need shapely and Triangle, are imported late.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from meshwright.document.document import Document
from meshwright.document.storage import document_file
from meshwright.document.storage.document_state import DocumentState
from meshwright.sources.naming import looks_like_path
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.core.kinds import KIND_NOUN
from meshwright_core.io.formats import SHAPES

if TYPE_CHECKING:
    from meshwright_core.domains.domain import Domain

NOTHING = "There is nothing to show or to mesh: name a shape of the gallery or a file."


def names_file(source: object) -> bool:
    """Whether the source is a path, or a text that is read as one.

    The name of a gallery shape always means the shape; any other text that has an ending or a
    folder in it, or that names something that exists, is a path.
    """
    if not isinstance(source, str):
        return isinstance(source, os.PathLike)
    if looks_like_path(source):
        return True
    from meshwright_core.domains import gallery

    return source not in gallery.names() and Path(source).exists()


def resolve(
    source: Any,
    name: str = "",
    *,
    corner_angle: float | None = None,
    curve_step: float | None = None,
    region: str | None = None,
    gap: float | None = None,
    fit: str | None = None,
    part: str | None = None,
    to_quads: bool = False,
) -> Document | Domain:
    """The document or the domain that a source means.

    Args:
        source: a document, which is returned as it is; a mesh, which is not copied; an object with
            a ``mesh``, such as a widget or a film; a domain; the corners of a polygon (n, 2); an
            object of PyVista, trimesh, meshio or shapely, or a pair of points and elements
            (:func:`meshwright_core.io.objects.incoming.taken`); the name of a gallery shape; or
            the path of a mesh file, a project or a drawing.
        name: name of a new document; by default that of the file.
        corner_angle: degrees by which the boundary of a mesh file or drawing must turn at a
            corner; None for the default, 0.01.
        curve_step: degrees that an edge of a mesh turns along a curve of a drawing, at most; None
            for as much as the shape allows.
        region: names or numbers of regions of a drawing, separated by commas, or ``"all"``; None
            for all of them if they touch.
        gap: width of gaps of a drawing that are closed, in its units; None for 0.001 of its size.
        fit: ``"arcs"`` or ``"splines"`` that are to be found in polylines of a drawing.
        part: name or number of the only part of a mesh file that is to be read: a zone, piece or
            instance, or a connected component.
        to_quads: make quads of the triangles of a mesh file: in pairs, and what is left by a split.

    Returns a domain for a gallery shape, a drawing, a polygon and a domain, else a document.

    Raises MeshError, one sentence, if the source means nothing or cannot be read.
    """
    if source is None or (isinstance(source, str) and not source.strip()):
        raise MeshError(NOTHING)
    if isinstance(source, Document):
        return source
    if isinstance(source, HalfEdgeMesh):
        return Document(source, name)
    if names_file(source):
        found = document_file.read(
            Path(source), corner_angle, curve_step, region, gap, fit, part, to_quads
        )
        return _opened(found, name) if isinstance(found, DocumentState) else found
    from meshwright_core.domains import gallery
    from meshwright_core.domains.domain import Domain

    if isinstance(source, str):
        return gallery.shape(source)
    if isinstance(source, Domain):
        return source
    from meshwright_core.io.objects import incoming

    angle = CORNER_ANGLE if corner_angle is None else corner_angle
    if (foreign := incoming.taken(source, angle, to_quads, part, region)) is not None:
        return foreign if isinstance(foreign, Domain) else Document(foreign, name)
    if isinstance(source, np.ndarray | list | tuple):
        return Domain(source)
    if not hasattr(source, "mesh"):
        raise MeshError(f"A mesh cannot be made of {type(source).__name__}.")
    if not isinstance(source.mesh, HalfEdgeMesh):
        raise MeshError("There is no mesh here yet.")
    return Document(source.mesh, name)


def mesh(
    source: Any,
    kind: str | None = None,
    *,
    max_edge: float | None = None,
    min_angle: float | None = None,
    seed: int = 0,
    part: str | None = None,
    to_quads: bool = False,
    region: str | None = None,
) -> HalfEdgeMesh:
    """A new mesh of what ``source`` means.

    Args:
        source: the name of a gallery shape (``"star"``); a mesh file, a project, or a drawing; a
            domain; the corners of a polygon (n, 2); a dataset of PyVista, a Trimesh, Scene or
            Path2D of trimesh, a meshio.Mesh, polygons of shapely, a pair of points and elements;
            or a mesh or document, whose mesh is copied.
        kind: ``"tri"`` or ``"quad"`` (the default) for what has to be meshed; a mesh that is
            there already must be of this kind.
        max_edge: upper bound on the length of edges, in the units of the source.
        min_angle: lower bound, in degrees, that Triangle aims at for the angles.
        seed: 0 for the plain mesh; other values vary it where Triangle has a choice.
        part: the only part of a mesh file or object that is read, as for :func:`resolve`.
        to_quads: make quads of the triangles of a mesh file or object.
        region: regions of a drawing or of shapely's polygons, as for :func:`resolve`.

    Raises MeshError, one sentence, if the source means nothing or cannot be meshed.
    """
    _check_kind(kind)
    found = resolve(source, part=part, to_quads=to_quads, region=region)
    if not isinstance(found, Document):
        from meshwright_core.domains import meshing

        return meshing.mesh_domain(
            found, kind or "quad", max_edge=max_edge, min_angle=min_angle, seed=seed
        )
    if found.mesh is None:
        raise MeshError("There is no mesh here yet.")
    _require_kind(found, kind)
    return found.mesh.copy()


def document(source: Any, kind: str | None = None, name: str = "") -> Document:
    """The document to show for a source.

    Args:
        source: as for :func:`resolve`; a document is returned as it is, and a mesh is not copied.
        kind: ``"tri"`` or ``"quad"`` (the default) for what has to be meshed; a mesh that is
            there already must be of this kind.
        name: name of a new document; by default that of the shape or file.

    Raises MeshError, one sentence, if the source means nothing or cannot be meshed.
    """
    _check_kind(kind)
    found = resolve(source, name)
    if not isinstance(found, Document):
        from meshwright_core.domains import meshing

        return Document(meshing.mesh_domain(found, kind or "quad"), name or found.name)
    _require_kind(found, kind)
    return found


def domain(
    source: Any,
    *,
    corner_angle: float | None = None,
    curve_step: float | None = None,
    region: str | None = None,
    gap: float | None = None,
    fit: str | None = None,
) -> Domain:
    """The domain that a source means: a gallery shape, a drawing, a polygon or a domain.

    Arguments as for :func:`resolve`.

    Raises MeshError, one sentence, for any other source.
    """
    if names_file(source) and not document_file.is_drawing(source):
        raise MeshError(f"{source}: a file of a shape ends in one of {' '.join(SHAPES)}.")
    found = resolve(
        source, corner_angle=corner_angle, curve_step=curve_step, region=region, gap=gap, fit=fit
    )
    if isinstance(found, Document):
        raise MeshError("This is a mesh, not a shape that can be meshed.")
    return found


def _opened(state: DocumentState, name: str) -> Document:
    """The document in a mesh file or project."""
    opened = Document()
    opened.adopt(replace(state, name=name or state.name))
    return opened


def _check_kind(kind: str | None) -> None:
    if kind is not None and kind not in KIND_NOUN:
        raise MeshError(f"There is no kind of mesh {kind!r}: it is 'tri' or 'quad'.")


def _require_kind(found: Document, kind: str | None) -> None:
    if kind is not None and found.kind not in ("", kind):
        raise MeshError(f"This is a mesh of {KIND_NOUN[found.kind]}, not of {KIND_NOUN[kind]}.")
