"""From what a person hands over to a document: a mesh, a shape, a file, a document."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from app.document import Document
from app.inputs import KIND_NOUN, looks_like_path, make_mesh, read_domain, read_project
from app.project import is_project
from app.report import UserError
from meshcore import HalfEdgeMesh, MeshError
from meshcore.formats import SHAPES

KINDS = ("tri", "quad")


def document_of(source: Any, kind: str | None = None, name: str = "") -> Document:
    """The document to show.

    Args:
        source: a mesh, a document (which is returned as it is), a
            :class:`~meshcore.domain.Domain`, the name of a shape of the gallery, or the path of a
            mesh, a geometry file or a project.
        kind: "tri" or "quad": of what a shape is meshed with (quads by default); a mesh must be of
            that kind already.
        name: what the document is called; by default what the shape or the file is called.

    Raises:
        MeshError: one sentence on what is wrong with the source.
        TypeError: the source is none of these.
    """
    if kind is not None and kind not in KINDS:
        raise MeshError(f"kind must be 'tri' or 'quad', not {kind!r}.")
    document = _made(source, kind, name)
    if kind is not None and document.kind not in ("", kind):
        raise MeshError(
            f"This is a mesh of {KIND_NOUN[document.kind]}; {KIND_NOUN[kind]} were asked for."
        )
    return document


def _made(source: Any, kind: str | None, name: str) -> Document:
    from meshcore.domain import Domain

    if isinstance(source, Document):
        return source
    if isinstance(source, HalfEdgeMesh):
        return Document(source, name)
    try:
        if isinstance(source, Domain):
            return Document(make_mesh(source, kind or "quad"), name or source.name)
        if isinstance(source, (str, Path)):
            return _read(str(source), kind, name)
    except UserError as error:
        raise MeshError(str(error)) from error
    raise TypeError(
        "A widget shows a mesh, a document, a domain, the name of a shape or the path of a file;"
        f" not {type(source).__name__}."
    )


def _read(text: str, kind: str | None, name: str) -> Document:
    path = Path(text)
    if not (looks_like_path(text) or path.exists()) or path.suffix.lower() in SHAPES:
        domain = read_domain(text)
        return Document(make_mesh(domain, kind or "quad"), name or domain.name or path.stem)
    if path.is_file() and is_project(path):
        return read_project(text)
    if not path.is_file():
        raise MeshError(f"{text}: there is no such file.")
    document = Document()
    document.open(path)
    return document
