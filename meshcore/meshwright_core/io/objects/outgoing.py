"""A mesh as an object of PyVista, trimesh, meshio or shapely, with its data as arrays.

Only live vertices and elements are handed over, renumbered in order. The data:

===================  ===============================================================
by point             ``degree``, ``desired_degree``, ``delta``, ``geometric`` (0 or 1)
by element           ``region``, ``scaled_jacobian``, ``shape``
===================  ===============================================================
"""

from __future__ import annotations

import importlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.names import groups
from meshwright_core.errors import MeshError
from meshwright_core.geometry import quality
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.mesh import HalfEdgeMesh

Ints = NDArray[np.int64]


class Parts(NamedTuple):
    """A mesh without gaps in its numbers."""

    points: NDArray[np.float64]
    """(n, 3)."""
    elements: Ints
    """(m, k)."""
    by_point: dict[str, np.ndarray]
    by_element: dict[str, np.ndarray]
    region_names: list[str]
    """By the numbers of ``region``."""
    sides: dict[str, Ints]
    """(s, 2) the edges of each side with a name."""


class ShapelyMesh(NamedTuple):
    """A mesh as arrays of shapely's geometries, and its data as arrays."""

    elements: np.ndarray
    """(m,) a Polygon for each element."""
    points: np.ndarray
    """(n,) a Point for each vertex."""
    regions: dict[str, Any]
    """The Polygon or MultiPolygon that the elements of each region make up, by name."""
    sides: dict[str, Any]
    """The LineString or MultiLineString of each named side."""
    outline: Any
    """The Polygon or MultiPolygon that all elements make up."""
    by_point: dict[str, np.ndarray]
    """Data by point, (n,) each."""
    by_element: dict[str, np.ndarray]
    """Data by element, (m,) each."""


def library(name: str) -> Any:
    """Import an optional library; MeshError if it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise MeshError(
            f"This needs the package {name}, which is not installed: pip install {name}."
        ) from error


def parts_of(mesh: HalfEdgeMesh) -> Parts:
    """The points, elements, data and names of a mesh."""
    live = mesh.vertices()
    number = np.full(mesh.slots, -1, np.int64)
    number[live] = np.arange(len(live))
    return Parts(
        mesh.points[live].copy(),
        number[mesh.elements()],
        {
            "degree": mesh.degree()[live],
            "desired_degree": mesh.desired()[live],
            "delta": mesh.irregularity()[live],
            "geometric": mesh.geometric()[live].astype(np.uint8),
        },
        {
            "region": mesh.regions().astype(np.int32),
            "scaled_jacobian": quality.scaled_jacobian(mesh),
            "shape": element_shapes(mesh),
        },
        list(mesh.region_names),
        {name: number[ends] for name, ends in mesh.sides().items() if name},
    )


def to_pyvista(mesh: HalfEdgeMesh) -> Any:
    """The mesh as a pyvista.PolyData.

    ``field_data`` holds the names: ``region_names`` by the numbers of the cell data ``region``,
    ``side_names``, and the edges of sides as ``side_edges`` (s, 2) with their row in
    ``side_names`` as ``side_of_edge``.
    """
    pyvista = library("pyvista")
    parts = parts_of(mesh)
    made = pyvista.PolyData.from_regular_faces(parts.points, parts.elements)
    for name, values in parts.by_point.items():
        made.point_data[name] = values
    for name, values in parts.by_element.items():
        made.cell_data[name] = values
    made.field_data["region_names"] = parts.region_names
    if parts.sides:
        made.field_data["side_names"] = list(parts.sides)
        made.field_data["side_edges"] = np.concatenate(list(parts.sides.values()))
        made.field_data["side_of_edge"] = np.repeat(
            np.arange(len(parts.sides)), [len(ends) for ends in parts.sides.values()]
        )
    made.set_active_scalars(None)
    return made


def to_trimesh(mesh: HalfEdgeMesh) -> Any:
    """The mesh as a trimesh.Trimesh; quads are cut along their shorter diagonal.

    ``vertex_attributes`` and ``face_attributes`` hold the data, the latter also ``element``, the
    row of the element that a face is a part of; ``metadata`` holds ``region_names``, ``sides``
    (the edges (s, 2) by name) and ``elements`` (m, k).
    """
    trimesh = library("trimesh")
    parts = parts_of(mesh)
    faces, element = parts.elements, np.arange(len(parts.elements))
    if mesh.k == 4:
        p = parts.points[parts.elements]
        first, second = (np.linalg.norm(p[:, i] - p[:, i + 2], axis=1) for i in (0, 1))
        # cut from corner 0 to 2, or from 1 to 3
        turned = np.where((first <= second)[:, None], faces, np.roll(faces, -1, axis=1))
        faces = np.stack([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]], axis=1).reshape(-1, 3)
        element = np.repeat(element, 2)
    return trimesh.Trimesh(
        parts.points,
        faces,
        vertex_attributes=parts.by_point,
        face_attributes={
            "element": element,
            **{name: values[element] for name, values in parts.by_element.items()},
        },
        metadata={
            "region_names": parts.region_names,
            "sides": parts.sides,
            "elements": parts.elements,
        },
        process=False,
    )


def to_meshio(mesh: HalfEdgeMesh) -> Any:
    """The mesh as a meshio.Mesh.

    Edges of named sides are a second block of cells, of type line, where the data by cell are 0 or
    nan. ``cell_sets`` holds the groups of regions and sides by name.
    """
    meshio = library("meshio")
    parts = parts_of(mesh)
    kind = "triangle" if mesh.k == 3 else "quad"
    cells: list[tuple[str, Ints]] = [(kind, parts.elements)]
    data = {name: [values] for name, values in parts.by_element.items()}
    sets: dict[str, list[Any]] = {}
    none = np.zeros(0, np.int64)
    region = parts.by_element["region"]
    for number, name in enumerate(parts.region_names):
        for group in groups(name):
            rows = np.flatnonzero(region == number)
            there = sets.setdefault(group, [none, none])
            there[0] = np.union1d(there[0], rows)
    if parts.sides:
        counts = [len(ends) for ends in parts.sides.values()]
        cells.append(("line", np.concatenate(list(parts.sides.values()))))
        for values in data.values():
            whole = values[0].dtype.kind in "iu"
            values.append(np.full(sum(counts), 0 if whole else np.nan, values[0].dtype))
        stops = np.cumsum([0, *counts])
        for name, first, last in zip(parts.sides, stops[:-1], stops[1:], strict=True):
            for group in groups(name):
                there = sets.setdefault(group, [none, none])
                there[1] = np.union1d(there[1], np.arange(first, last))
    kept = {name: there[: len(cells)] for name, there in sets.items()}
    return meshio.Mesh(
        parts.points, cells, point_data=parts.by_point, cell_data=data, cell_sets=kept
    )


def to_shapely(mesh: HalfEdgeMesh) -> ShapelyMesh:
    """The mesh, seen from above, as arrays of shapely's geometries."""
    shapely = library("shapely")
    parts = parts_of(mesh)
    flat = parts.points[:, :2]
    polygons = shapely.polygons(flat[parts.elements])
    region = parts.by_element["region"]
    regions = {}
    for name in dict.fromkeys(parts.region_names):
        numbers = [i for i, one in enumerate(parts.region_names) if one == name]
        regions[name] = shapely.unary_union(polygons[np.isin(region, numbers)])
    sides = {
        name: shapely.line_merge(shapely.MultiLineString(list(flat[ends])))
        for name, ends in parts.sides.items()
    }
    return ShapelyMesh(
        polygons,
        shapely.points(flat),
        regions,
        sides,
        shapely.unary_union(polygons),
        parts.by_point,
        parts.by_element,
    )
