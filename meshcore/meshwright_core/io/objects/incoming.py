"""Meshes and shapes from objects of PyVista, trimesh, meshio and shapely.

An object is known by the module of its class, so nothing is imported to tell what it is.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from meshwright_core.core.irregularity import CORNER_ANGLE
from meshwright_core.core.names import groups
from meshwright_core.domains.domain import Domain
from meshwright_core.errors import FileWarning, MeshError, sentence
from meshwright_core.io import mesh_files
from meshwright_core.io.content import Content
from meshwright_core.io.readers import numbers, vtk_cells
from meshwright_core.io.readers.builder import Builder, Placed
from meshwright_core.io.readers.fields import CellFields, keep_point_data
from meshwright_core.mesh import HalfEdgeMesh

_LIBRARIES = ("pyvista", "trimesh", "meshio", "shapely", "vtkmodules")
_DERIVED = frozenset(
    {
        "degree", "delta", "scaled_jacobian", "shape", "element",
        "Normals", "TextureCoordinates", "Texture Coordinates",
        "vtkOriginalPointIds", "vtkOriginalCellIds",
    }
)  # fmt: skip
"""Data that follow from the mesh: our own, and those that libraries add by themselves."""
_CORNERS = {3: "triangle", 4: "quad"}
_SAME = {"triangle6": "triangle", "triangle7": "triangle", "quad8": "quad", "quad9": "quad",
         "line3": "line", "line4": "line", "triangle10": "triangle", "quad16": "quad"}  # fmt: skip


def library_of(source: Any) -> str:
    """The library that an object is of, "" for none of those that are taken."""
    roots = (one.__module__.partition(".")[0] for one in type(source).__mro__)
    return next((root for root in roots if root in _LIBRARIES), "")


def points_and_cells(source: Any) -> Content | None:
    """The content of a pair of points (n, 2|3) and cells, None if a source is none.

    Cells are an array (m, 3|4), a list of elements of three and four corners, or blocks by type,
    as meshio's: a dictionary or a list of pairs.

    Raises:
        MeshError: the cells are understood, but not as numbers of points.
    """
    if not isinstance(source, tuple | list) or len(source) != 2:
        return None
    try:
        points = np.asarray(source[0], dtype=np.float64)
    except (ValueError, TypeError):
        return None
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        return None
    blocks = _blocks(source[1])
    if blocks is None:
        return None
    build = Builder()
    build.points(points)
    for kind, cells in blocks:
        build.cells(_SAME.get(kind, kind), numbers.whole(cells))
    return build.content()


def _blocks(cells: Any) -> list[tuple[str, np.ndarray]] | None:
    """Cells of a pair by type; None if they are none."""
    if isinstance(cells, Mapping):
        pairs = list(cells.items())
    elif isinstance(cells, list | tuple) and all(
        isinstance(one, list | tuple) and len(one) == 2 and isinstance(one[0], str) for one in cells
    ):
        pairs = list(cells)
    else:
        return _listed(cells)
    try:
        return [(str(kind), np.atleast_2d(np.asarray(block))) for kind, block in pairs]
    except (ValueError, TypeError):
        return None


def _listed(cells: Any) -> list[tuple[str, np.ndarray]] | None:
    """Elements in one list, by their number of corners."""
    try:
        sizes = {len(one) for one in cells}
        blocks = [np.asarray([one for one in cells if len(one) == size]) for size in sorted(sizes)]
    except (ValueError, TypeError):
        return None
    if not sizes or not sizes <= _CORNERS.keys() or any(b.dtype.kind not in "iuf" for b in blocks):
        return None
    return [(_CORNERS[block.shape[1]], block) for block in blocks]


def taken(
    source: Any,
    corner_angle: float = CORNER_ANGLE,
    to_quads: bool = False,
    part: str | None = None,
    region: str | None = None,
) -> HalfEdgeMesh | Domain | None:
    """The mesh in an object, the shape in it, or None if it is of another kind.

    Meshes are pyvista.PolyData and other datasets of PyVista, Trimesh and Scene of trimesh,
    meshio.Mesh, and pairs of points and elements (:func:`points_and_cells`); shapes are
    trimesh.path.Path2D, polygons of shapely and lists of them. What is not kept is said by a
    FileWarning each. Other arguments are as for files.

    Raises:
        MeshError: one sentence that begins with the type of the object, as for a file.
    """
    library = library_of(source)
    kind = type(source).__name__
    several = not library and isinstance(source, list | tuple) and len(source) > 0
    if several and all(library_of(one) == "shapely" for one in source):
        library, kind = "shapely", f"{type(source[0]).__name__}s"
    try:
        if library == "shapely":
            return _shape(source, corner_angle, region)
        if library == "trimesh" and hasattr(source, "entities"):
            return _path(source, corner_angle, region)
        content = _content(library, source) if library else points_and_cells(source)
        if content is None:
            return None
        kind = kind if library else "(points, cells)"
        loaded = mesh_files.from_content(content, corner_angle, to_quads, part)
    except MeshError as error:
        raise MeshError(f"{kind}: {sentence(str(error))}") from error
    for line in loaded.said():
        warnings.warn(f"{kind}: {sentence(line)}", FileWarning, stacklevel=2)
    return loaded.mesh


def _content(library: str, source: Any) -> Content:
    if library in ("pyvista", "vtkmodules"):
        return _dataset(source)
    if library == "meshio" and hasattr(source, "cells"):
        return _meshio(source)
    if library == "trimesh" and hasattr(source, "to_geometry"):  # a scene, its parts in place
        source = source.to_geometry()
    if library == "trimesh" and hasattr(source, "faces"):
        return _trimesh(source)
    raise MeshError("no mesh is in an object of this type")


def _dataset(source: Any) -> Content:
    """A dataset of PyVista or VTK; the blocks of several are one mesh."""
    if not hasattr(source, "cast_to_unstructured_grid") and not hasattr(source, "combine"):
        import importlib

        source = importlib.import_module("pyvista").wrap(source)
    if hasattr(source, "combine"):
        source = source.combine()
    names = source.field_data
    grid = source.cast_to_unstructured_grid()
    build = Builder()
    build.points(np.asarray(grid.points, float))
    # the older name since PyVista 0.49 only warns
    offsets = grid.cell_offsets if hasattr(grid, "cell_offsets") else grid.offset
    sizes = np.diff(np.asarray(offsets, np.int64)).astype(np.int64)
    members = np.asarray(grid.cell_connectivity, np.int64)
    placed = vtk_cells.add_cells(build, np.asarray(grid.celltypes, np.int64), sizes, members)
    for name, values in grid.point_data.items():
        _keep_points(build, name, values)
    fields = CellFields(build, placed, len(sizes))
    for name, values in grid.cell_data.items():
        _keep_cells(fields, name, values)
    if "side_names" in names and "side_edges" in names:
        _sides(build, list(names["side_names"]), names["side_edges"], names["side_of_edge"])
    if "region_names" in names and "region" in grid.cell_data:
        region = np.asarray(grid.cell_data["region"])
        _regions(build, placed, region, [str(name) for name in names["region_names"]])
    return build.content()


def _meshio(source: Any) -> Content:
    build = Builder()
    build.points(np.asarray(source.points, float))
    blocks: list[list[Placed]] = []
    first, starts = 0, []
    for block in source.cells:
        starts.append(first)
        cells = build.cells(_SAME.get(block.type, block.type), np.asarray(block.data))
        blocks.append(cells)
        first += len(block.data)
    placed = [
        one._replace(which=one.which + start)
        for start, some in zip(starts, blocks, strict=True)
        for one in some
    ]
    for name, values in source.point_data.items():
        _keep_points(build, name, values)
    fields = CellFields(build, placed, first)
    tags = {
        (int(dimension), int(tag)): name for name, (tag, dimension) in _pairs(source.field_data)
    }
    for name, parts in source.cell_data.items():
        if name == "gmsh:physical":
            _physical(build, blocks, parts, tags)
        elif name != "gmsh:geometrical":
            _keep_cells(fields, name, np.concatenate([np.asarray(part) for part in parts]))
    for name, rows in source.cell_sets.items():
        if name.startswith("gmsh:"):
            continue
        for some, chosen in zip(blocks, rows, strict=False):
            if chosen is not None:
                build.group(name, [_chosen(one, np.isin(one.which, chosen)) for one in some])
    for name, ids in source.point_sets.items():
        build.node_set(name, np.asarray(ids))
    return build.content()


def _pairs(field_data: Mapping[str, Any]) -> Iterable[tuple[str, tuple[int, int]]]:
    for name, values in field_data.items():
        numbers = np.asarray(values).ravel()
        if len(numbers) == 2 and numbers.dtype.kind in "iu":
            yield name, (int(numbers[0]), int(numbers[1]))


def _physical(
    build: Builder, blocks: list[list[Placed]], parts: Any, names: dict[tuple[int, int], str]
) -> None:
    """Physical groups of Gmsh, with the names that meshio keeps in its field data."""
    for some, values in zip(blocks, parts, strict=True):
        values = np.asarray(values).ravel()
        for tag in np.unique(values[values != 0]).tolist():
            for one in some:
                dimension = 1 if one.kind == "line" else 2
                name = names.get((dimension, tag), str(tag))
                build.group(name, [_chosen(one, values[one.which] == tag)], tag)


def _trimesh(source: Any) -> Content:
    build = Builder()
    points, faces = np.asarray(source.vertices, float), np.asarray(source.faces, np.int64)
    build.points(points)
    placed = build.cells("triangle", faces)
    for name, values in source.vertex_attributes.items():
        _keep_points(build, name, values)
    fields = CellFields(build, placed, len(faces))
    for name, values in source.face_attributes.items():
        _keep_cells(fields, name, values)
    sides = source.metadata.get("sides")
    if isinstance(sides, Mapping):
        for name, edges in sides.items():
            for group in groups(str(name)):
                build.edges(group, np.asarray(edges, np.int64).reshape(-1, 2))
    names, region = source.metadata.get("region_names"), source.face_attributes.get("region")
    if isinstance(names, list) and region is not None:
        _regions(build, placed, np.asarray(region), [str(name) for name in names])
    return build.content()


def _regions(build: Builder, placed: list[Placed], region: Any, names: list[str]) -> None:
    """Name the regions of cells by their numbers."""
    for number, name in enumerate(names):
        for group in groups(name):
            build.group(group, [_chosen(one, region[one.which] == number) for one in placed])


def _sides(build: Builder, names: list[Any], edges: Any, row: Any) -> None:
    edges, row = np.asarray(edges, np.int64).reshape(-1, 2), np.asarray(row).ravel()
    for number, name in enumerate(names):
        for group in groups(str(name)):
            build.edges(group, edges[row == number])


def _chosen(placed: Placed, mask: np.ndarray) -> Placed:
    return placed._replace(rows=placed.rows[mask], which=placed.which[mask])


def _keep_points(build: Builder, name: str, values: Any) -> None:
    if name not in _DERIVED:
        keep_point_data(build, name, np.asarray(values))


def _keep_cells(fields: CellFields, name: str, values: Any) -> None:
    if name not in _DERIVED:
        values = np.asarray(values)
        fields.keep(name, values if values.ndim == 1 else np.zeros(0))


def _shape(source: Any, corner_angle: float, region: str | None) -> Domain:
    """The polygons of a geometry of shapely, or several of them; those that touch are regions of
    one domain.
    """
    import shapely

    from meshwright_core.io import drawings
    from meshwright_core.io.drawings.readers import wkt

    if isinstance(source, list | tuple):
        source = shapely.GeometryCollection(list(source))
    if source.geom_type == "Polygon" and not source.is_empty:
        holes = [np.asarray(ring.coords)[:, :2] for ring in source.interiors]
        outline = np.asarray(source.exterior.coords)[:, :2]
        return Domain(outline, holes, corner_angle=corner_angle)
    text = shapely.to_wkt(source, rounding_precision=-1, output_dimension=2)
    return drawings.domain_in(wkt.read(text.encode()), corner_angle, region)


def _path(source: Any, corner_angle: float, region: str | None) -> Domain:
    """The regions that the lines and arcs of a trimesh path enclose."""
    from meshwright_core.curves.curve import Curve
    from meshwright_core.io import drawings
    from meshwright_core.io.drawings.drawn import Drawing, polyline

    drawing = Drawing()
    for entity in source.entities:
        layer = str(entity.layer) if getattr(entity, "layer", None) else ""
        nodes = np.asarray(source.vertices)[np.asarray(entity.points)][:, :2]
        if type(entity).__name__ == "Arc" and not entity.closed and len(nodes) == 3:
            drawing.add(Curve.arc_through(*nodes), layer)
        elif type(entity).__name__ == "Line":
            drawing.add(polyline(nodes), layer)
        else:
            drawing.add(polyline(np.asarray(entity.discrete(source.vertices))[:, :2]), layer)
    return drawings.domain_in(drawing, corner_angle, region)
