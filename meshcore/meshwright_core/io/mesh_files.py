"""Reads and writes mesh files; the ending of the name selects the format."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.errors import MeshError
from meshwright_core.io import cleaning, formats, text_formats
from meshwright_core.io.atomic_write import replacing
from meshwright_core.io.content import Content
from meshwright_core.io.file_checks import naming, size_of
from meshwright_core.mesh import HalfEdgeMesh


def endings() -> tuple[str, ...]:
    """Return the endings that `read` and `write` know, with their dots."""
    return tuple(formats.FORMATS)


def read(path: str | os.PathLike[str], corner_angle: float = CORNER_ANGLE) -> HalfEdgeMesh:
    """Read a mesh file.

    Points that no element uses are dropped and the rest renumbered in order; plane formats get
    z = 0. In formats without shared points (STL, glTF, 3MF) points at the same place are merged.
    Where neighbouring elements run against each other they are turned to agree, and meshes in
    a plane z = const run counter-clockwise afterwards. Regions are read from cell data "region"
    (VTK, VTU) and from the physical groups of Gmsh files.

    Args:
        path: a file whose ending `endings` lists.
        corner_angle: degrees by which the boundary must turn at a geometric vertex. A file that
            carries our own point data "geometric" and "desired_degree" (VTK, VTU, Gmsh, PLY,
            AVS-UCD, Tecplot, XDMF) keeps its corners and desired degrees instead.

    Raises:
        MeshError: one sentence that begins with the path: the file is missing, a folder, empty,
            cut off or in another format; it mixes triangles and quads or holds other cells; a
            coordinate is not a finite number; the mesh is not manifold.
    """
    place = Path(path)
    with naming(place):
        head = _head(place)
        form = formats.of(place)
        with formats.contained():
            content = form.read(place)
        return _mesh(content, form, head, corner_angle)


def write(path: str | os.PathLike[str], mesh: HalfEdgeMesh) -> None:
    """Write a mesh to a file, whole or not at all.

    Only live vertices and elements are written, renumbered in order. Coordinates are exact (17
    digits where they need them) but in Nastran (at least nine digits), glTF and 3MF (single
    precision) files. Geometric flags and desired degrees go along as point data where the format
    has it; elsewhere `read` finds the corners by angle. Several regions become cell data "region"
    (VTK, VTU) or physical groups (Gmsh). Edges along curves become straight: mesh files hold no
    curves, projects do.

    Raises:
        MeshError: one sentence that begins with the path: the ending is unknown, the format does
            not hold this kind of mesh, the folder does not exist, the disk is full, and so on.
            An old file is then as it was.
    """
    place = Path(path)
    try:
        form = formats.of(place)
        kind = "triangle" if mesh.k == 3 else "quad"
        if kind not in form.kinds:
            raise MeshError(f"{form.title} files hold no {kind}s")
        content = _live(mesh, kind, form)
    except MeshError as error:
        raise MeshError(f"{place}: {error}.") from error
    with replacing(path) as temporary:
        try:
            with formats.contained():
                form.write(temporary, content)
        except MeshError as error:
            raise MeshError(f"{place}: it cannot be written: {error}.") from error
        _refuse_incomplete(form, temporary, content)


def _refuse_incomplete(form: formats.Format, path: Path, content: Content) -> None:
    """Read a file back; numpy's tofile does not notice when its last buffer meets a full disk."""
    try:
        with formats.contained():
            there = form.read(path)
        elements = cleaning.single_kind(there)
    except MeshError as error:
        raise OSError("it did not arrive whole") from error
    (block,) = content.cells.values()
    if len(elements) != len(block) or not (form.merge or len(there.points) == len(content.points)):
        raise OSError("it did not arrive whole")


def _head(path: Path) -> bytes:
    size_of(path)
    with path.open("rb") as file:
        return file.read(1024)


def _mesh(content: Content, form: formats.Format, head: bytes, corner_angle: float) -> HalfEdgeMesh:
    elements = cleaning.single_kind(content)
    promise = text_formats.announced_counts(head)
    if promise and promise != (len(content.points), len(elements)):
        raise MeshError(
            f"it is cut off: {promise[0]} points and {promise[1]} elements are announced, "
            f"but {len(content.points)} and {len(elements)} are there"
        )
    regions = cleaning.regions(content, len(elements))
    cleaning.refuse_strays(content.points, elements)
    if form.merge:
        content, elements = cleaning.merged(content, elements)
    content, elements = cleaning.compacted(content, elements)
    points = content.points
    if points.shape[1] < 3:
        points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
    elements = cleaning.oriented(points, elements)
    return HalfEdgeMesh.from_elements(
        points,
        elements,
        cleaning.flags(content.data, len(points)),
        cleaning.desired(content.data, len(points)),
        corner_angle,
        regions=regions,
    )


def _live(mesh: HalfEdgeMesh, kind: str, form: formats.Format) -> Content:
    vertices = mesh.vertices()
    number = np.full(len(mesh.points), -1, dtype=np.int64)
    number[vertices] = np.arange(len(vertices))
    marks = {
        "geometric": mesh.geometric()[vertices].astype(np.int32),
        "desired_degree": mesh.desired()[vertices].astype(np.int32),
    }
    regions = mesh.regions()
    several = form.regions and bool((regions != regions[:1]).any())
    return Content(
        mesh.points[vertices].copy(),
        {kind: number[mesh.elements()]},
        marks if form.data else {},
        {kind: regions} if several else {},
    )
