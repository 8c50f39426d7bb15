"""Reads and writes mesh files; the ending of the name selects the format."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.core.names import groups
from meshwright_core.errors import FileWarning, MeshError
from meshwright_core.io import (
    cleaning,
    formats,
    named_groups,
    parts,
    plane_frames,
    surface,
    text_formats,
    welding,
)
from meshwright_core.io.atomic_write import replacing
from meshwright_core.io.content import Content
from meshwright_core.io.file_checks import naming, size_of
from meshwright_core.mesh import HalfEdgeMesh

_SHOWN = 6
SURFACE = (
    "it is a surface that is not plane: smoothing, and the agent with it, does not hold it to its "
    "shape"
)
"""What is said of a mesh that lies in no plane."""


def endings(written: bool = False) -> tuple[str, ...]:
    """Return the endings that `read` knows, or those that `write` does, with their dots."""
    return tuple(ending for ending, form in formats.FORMATS.items() if form.kinds or not written)


class Loaded(NamedTuple):
    """What has been read from a mesh file.

    Attributes:
        mesh: the mesh.
        notes: what was mended, merged or read otherwise than it stands there, a sentence each.
        dropped: what of the file is not kept, such as fields: a phrase each, "point data 'height'".
        parts: names of the parts that can be read alone.
    """

    mesh: HalfEdgeMesh
    notes: tuple[str, ...] = ()
    dropped: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()

    def said(self) -> list[str]:
        """The notes, and one on what is not kept."""
        if not self.dropped:
            return list(self.notes)
        several = len(self.dropped) > 1 or self.dropped[0].startswith("the elements")
        are = "are" if several else "is"
        return [*self.notes, f"{', '.join(self.dropped)} {are} not kept"]


def read(
    path: str | os.PathLike[str],
    corner_angle: float = CORNER_ANGLE,
    part: str | None = None,
    to_quads: bool = False,
) -> HalfEdgeMesh:
    """Read a mesh file; see :func:`load`. What it notes is said by a FileWarning each."""
    found = load(path, corner_angle, part, to_quads)
    for line in found.said():
        warnings.warn(f"{path}: {line.rstrip('.')}.", FileWarning, stacklevel=2)
    return found.mesh


def load(
    path: str | os.PathLike[str],
    corner_angle: float = CORNER_ANGLE,
    part: str | None = None,
    to_quads: bool = False,
) -> Loaded:
    """Read a mesh file.

    Points that no element uses are dropped and the rest renumbered in order; plane formats get
    z = 0. In formats without shared points (STL, glTF, 3MF) points at the same place are merged;
    in others where that makes one surface of two. Elements that are there more than once are read
    once, and those of higher order with straight sides. Where neighbouring elements run against
    each other they are turned to agree, and meshes in a plane z = const run counter-clockwise
    afterwards. Named groups of elements become regions, those of edges and points sides: see
    :meth:`HalfEdgeMesh.sides` and `region_names`.

    Args:
        path: a file whose ending `endings` lists.
        corner_angle: degrees by which the boundary must turn at a geometric vertex. A file that
            carries our own point data "geometric" and "desired_degree" (VTK, VTU, Gmsh, PLY,
            AVS-UCD, Tecplot, XDMF) keeps its corners and desired degrees instead.
        part: the name or number of the part to read: a zone, piece or instance, or a connected
            component where the file has one part; all of them by default.
        to_quads: make quads of triangles, in pairs, and split what is left.

    Raises:
        MeshError: one sentence that begins with the path: the file is missing, a folder, empty,
            cut off or in another format; it mixes triangles and quads, and `to_quads` is not set,
            or holds other cells; it has no such part; a coordinate is not a finite number; the
            mesh is not manifold.
    """
    place = Path(path)
    with naming(place):
        head = _head(place)
        form = formats.of(place)
        content = _prepared(form.read(place), form.merge, head, part, to_quads)
        return _loaded(content, corner_angle)


def from_content(
    content: Content,
    corner_angle: float = CORNER_ANGLE,
    to_quads: bool = False,
    part: str | None = None,
) -> Loaded:
    """The mesh in content that does not come from a file; arguments and errors as for `load`."""
    return _loaded(_prepared(content, False, b"", part, to_quads), corner_angle)


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
        form = formats.of(place, written=True)
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
    said = []
    if lost:
        said.append(f"{form.title} files hold no such names: those {' and '.join(lost)} are lost.")
    count = len(np.unique(mesh.regions()))
    if not lost and count > 1 and not form.regions:
        said.append(f"{form.title} files hold no regions: what parts the {count} of them is lost.")
    sides, regions = sides if form.sides else [], regions if form.regions else []
    if form.numbers and (sides or regions):
        said.append(
            f"{form.title} files hold numbers in place of names: {_listed([*sides, *regions])} "
            "become numbers."
        )
    if form.longest:
        every = dict.fromkeys(group for name in (*sides, *regions) for group in groups(name))
        long = [name for name in every if len(name.encode()) > form.longest]
        if long:
            said.append(
                f"Names in {form.title} files have at most {form.longest} bytes: {_listed(long)} "
                "will be shorter."
            )
    if form.spelling is not None:
        written = form.spelling(sides, regions)
        said += respelled(form.title, {a: b for a, b in written.items() if a != b})
    return tuple(said)


def respelled(title: str, names: Mapping[str, str]) -> list[str]:
    """A sentence on names that a format writes in another way."""
    if not names:
        return []
    shown = [f"{old!r} becomes {new!r}" for old, new in list(names.items())[:_SHOWN]]
    more = len(names) - len(shown)
    changes = ", ".join(shown) + (f", and {more} more change" if more else "")
    return [f"Names in {title} files are single words: {changes}."]


def _listed(names: Sequence[str]) -> str:
    shown = [repr(name) for name in names[:_SHOWN]]
    more = len(names) - len(shown)
    return ", ".join(shown) + (f" and {more} more" if more else "")


def _is_version_4(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            return file.read(64).split()[:2][-1:] in ([b"4.1"], [b"4.0"], [b"4"])
    except OSError:
        return False


def _refuse_incomplete(form: formats.Format, path: Path, content: Content) -> None:
    """Read a file back; numpy's tofile does not notice when its last buffer meets a full disk."""
    ((kind, block),) = content.cells.items()
    try:
        there = form.read(path)
        elements = surface.surface_of(there).cells[kind]
    except (MeshError, KeyError) as error:
        raise OSError("it did not arrive whole") from error
    if len(elements) != len(block) or not (form.merge or len(there.points) == len(content.points)):
        raise OSError("it did not arrive whole")


def _head(path: Path) -> bytes:
    size_of(path)
    with path.open("rb") as file:
        return file.read(1024)


def _prepared(
    content: Content, merge: bool, head: bytes, part: str | None, to_quads: bool
) -> Content:
    """One kind of elements, which share the points that are theirs."""
    content = surface.surface_of(content)
    promise = text_formats.announced_counts(head)
    count = sum(len(block) for block in content.cells.values())
    if promise and promise != (len(content.points), count):
        raise MeshError(
            f"it is cut off: {promise[0]} points and {promise[1]} elements are announced, "
            f"but {len(content.points)} and {count} are there"
        )
    content = surface.without_repeats(surface.compacted(content))
    content = welding.welded(content, merge)
    if part is not None:
        content = parts.one_part(content, part)
    if to_quads:
        # imported late: domains need shapely
        from meshwright_core.io import all_quads

        content = all_quads.converted(content)
    cleaning.refuse_mixed(content)
    return surface.compacted(content)


def _loaded(content: Content, corner_angle: float) -> Loaded:
    ((kind, elements),) = content.cells.items()
    points = content.points
    elements = cleaning.oriented(points, elements)
    points, plane, flat = plane_frames.flattened(points, elements)
    if flat:
        elements = cleaning.oriented(points, elements)
    content = content._replace(points=points, cells={kind: elements})
    found = named_groups.named(content, kind, elements)
    mesh = HalfEdgeMesh.from_elements(
        points,
        elements,
        cleaning.flags(content.data, len(points)),
        cleaning.desired(content.data, len(points)),
        corner_angle,
        regions=found.regions,
        names=found.names,
        plane=plane,
    )
    cleaning.refuse_flat(points, elements)
    mesh.left_out = content.dropped
    if plane is not None:
        shown = ", ".join(f"{round(value, 6) + 0.0:.4g}" for value in plane.normal)
        said = f"it lies in a plane with the normal ({shown}): it is edited in that plane"
        found.warnings.append(f"{said}, and written back to it")
    elif not flat:
        found.warnings.append(SURFACE)
    there = parts.part_names(content)
    notes = (*content.warnings, *found.warnings)
    if len(there) > 1:
        notes = (*notes, f"there {parts.listed_parts(content)}")
    return Loaded(mesh, notes, content.dropped, tuple(there))


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
        mesh.points_in_space()[vertices],
        {kind: number[mesh.elements()]},
        marks if form.data else {},
        {kind: regions} if several else {},
        names,
    )
