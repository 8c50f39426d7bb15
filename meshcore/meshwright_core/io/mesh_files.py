"""Reads and writes mesh files; the ending of the name selects the format."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.errors import FileWarning, MeshError
from meshwright_core.io import cleaning, formats, named_groups, text_formats
from meshwright_core.io.atomic_write import replacing
from meshwright_core.io.content import Content
from meshwright_core.io.file_checks import naming, size_of
from meshwright_core.mesh import HalfEdgeMesh

_SHOWN = 6


def endings() -> tuple[str, ...]:
    """Return the endings that `read` and `write` know, with their dots."""
    return tuple(formats.FORMATS)


def read(path: str | os.PathLike[str], corner_angle: float = CORNER_ANGLE) -> HalfEdgeMesh:
    """Read a mesh file.

    Points that no element uses are dropped and the rest renumbered in order; plane formats get
    z = 0. In formats without shared points (STL, glTF, 3MF) points at the same place are merged.
    Where neighbouring elements run against each other they are turned to agree, and meshes in
    a plane z = const run counter-clockwise afterwards. Named groups of elements become regions,
    those of edges and points sides: see :meth:`HalfEdgeMesh.sides` and `region_names`. What of
    the file is not kept is said by a FileWarning each.

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
        mesh, said = _mesh(content, form, head, corner_angle)
    if mesh.left_out:
        said.append(f"{', '.join(mesh.left_out)} {_are(mesh.left_out)} not kept")
    for line in said:
        warnings.warn(f"{place}: {line.rstrip('.')}.", FileWarning, stacklevel=2)
    return mesh


def write(path: str | os.PathLike[str], mesh: HalfEdgeMesh) -> None:
    """Write a mesh to a file, whole or not at all.

    Only live vertices and elements are written, renumbered in order. Coordinates are exact (17
    digits where they need them) but in Nastran (at least nine digits), glTF and 3MF (single
    precision) files. Geometric flags and desired degrees go along as point data where the format
    has it; elsewhere `read` finds the corners by angle. Names of sides and regions are written
    where the format has them, see `losses`; a FileWarning says which are lost. A Gmsh file of
    version 4 that is replaced stays one. Edges along curves become straight: mesh files hold no
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
        lost = losses(place, mesh)
    except MeshError as error:
        raise MeshError(f"{place}: {error}.") from error
    put = form.write
    if place.suffix.lower() == ".msh" and _is_version_4(place):
        put = formats.write_msh_4
    with replacing(path) as temporary:
        try:
            with formats.contained():
                put(temporary, content)
        except MeshError as error:
            raise MeshError(f"{place}: it cannot be written: {error}.") from error
        _refuse_incomplete(form, temporary, content)
    for line in lost:
        warnings.warn(f"{place}: {line}", FileWarning, stacklevel=2)


def losses(path: str | os.PathLike[str], mesh: HalfEdgeMesh) -> tuple[str, ...]:
    """What a mesh file of this ending cannot hold of the names of a mesh: a sentence each.

    Raises:
        MeshError: the ending is unknown.
    """
    form = formats.of(path)
    sides = [name for name in mesh.sides() if name]
    regions = [name for name in dict.fromkeys(mesh.region_names) if name]
    lost = []
    if sides and not form.sides:
        lost.append(f"of the sides {_listed(sides)}")
    if regions and not form.regions:
        lost.append(f"of the regions {_listed(regions)}")
    if lost:
        return (f"{form.title} files hold no such names: those {' and '.join(lost)} are lost.",)
    if form.numbers and (sides or regions):
        return (
            f"{form.title} files hold numbers in place of names: {_listed([*sides, *regions])} "
            "become numbers.",
        )
    return ()


def _listed(names: Sequence[str]) -> str:
    shown = [repr(name) for name in names[:_SHOWN]]
    more = len(names) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")


def _are(things: Sequence[str]) -> str:
    return "is" if len(things) == 1 else "are"


def _is_version_4(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            return file.read(64).split()[:2][-1:] in ([b"4.1"], [b"4.0"], [b"4"])
    except OSError:
        return False


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


def _mesh(
    content: Content, form: formats.Format, head: bytes, corner_angle: float
) -> tuple[HalfEdgeMesh, list[str]]:
    """The mesh in a file, and what is to be said of it."""
    elements = cleaning.single_kind(content)
    promise = text_formats.announced_counts(head)
    if promise and promise != (len(content.points), len(elements)):
        raise MeshError(
            f"it is cut off: {promise[0]} points and {promise[1]} elements are announced, "
            f"but {len(content.points)} and {len(elements)} are there"
        )
    kind = "triangle" if elements.shape[1] == 3 else "quad"
    cleaning.refuse_strays(content.points, elements)
    if form.merge:
        content, elements = cleaning.merged(content, elements)
    content, elements = cleaning.compacted(content, elements)
    points = content.points
    if points.shape[1] < 3:
        points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
    elements = cleaning.oriented(points, elements)
    found = named_groups.named(content, kind, elements)
    mesh = HalfEdgeMesh.from_elements(
        points,
        elements,
        cleaning.flags(content.data, len(points)),
        cleaning.desired(content.data, len(points)),
        corner_angle,
        regions=found.regions,
        names=found.names,
    )
    mesh.left_out = content.dropped
    return mesh, [*content.warnings, *found.warnings]


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
    names = named_groups.names_of(mesh, number, kind) if form.regions or form.sides else None
    return Content(
        mesh.points[vertices].copy(),
        {kind: number[mesh.elements()]},
        marks if form.data else {},
        {kind: regions} if several else {},
        names,
    )
