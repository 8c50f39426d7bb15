"""From what a person hands over to a document: a document, a mesh, a shape, a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from meshwright.document.document import Document
from meshwright.document.storage.project_file import is_project
from meshwright.sources import resolve
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.kinds import KIND_NOUN


def document_of(source: Any, kind: str | None = None, name: str = "") -> Document:
    """The document to show.

    Args:
        source: a document, which is returned as it is; a mesh, which is not copied; a project,
            with its history; or whatever :func:`meshwright.sources.resolve.mesh` makes a mesh of.
        kind: "tri" or "quad": what a shape is meshed with (quads by default); a mesh must be of
            that kind already.
        name: what a new document is called; by default as the shape or the file.

    Raises:
        MeshError: one sentence on what is wrong with the source.
    """
    if isinstance(source, Document):
        document = source
    elif isinstance(source, HalfEdgeMesh):
        document = Document(source, name)
    elif isinstance(source, str | Path) and is_project(source) and Path(source).is_file():
        document = Document()
        document.open(source)
    elif source is None or (isinstance(source, str) and not source.strip()):
        raise MeshError("There is nothing to show: name a shape of the gallery or a file.")
    else:
        return Document(resolve.mesh(source, kind), name or _called(source))
    if kind is not None and document.kind not in ("", kind):
        raise MeshError(
            f"This is a mesh of {KIND_NOUN[document.kind]}, not of {KIND_NOUN.get(kind, kind)}."
        )
    return document


def _called(source: Any) -> str:
    if isinstance(source, str | Path):
        return Path(source).stem
    return str(getattr(source, "name", ""))
