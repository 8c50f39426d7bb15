"""GeoJSON (RFC 7946): polygons as named areas, lines as curves, in plane coordinates."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import Drawing, DrawnArea, polyline

_TYPES = (
    "Feature",
    "FeatureCollection",
    "GeometryCollection",
    "LineString",
    "MultiLineString",
    "MultiPoint",
    "MultiPolygon",
    "Point",
    "Polygon",
)
_NAMES = ("name", "title", "label", "material", "region", "layer", "id")
"""Properties that may name a feature, in this order; in any case of letters."""
_DEPTH = 32


def is_geojson(content: Any) -> bool:
    """Whether a JSON value is an object of GeoJSON."""
    return isinstance(content, Mapping) and content.get("type") in _TYPES


def read(content: bytes) -> Drawing:
    """Return what a GeoJSON file holds.

    Raises:
        MeshError: it is not JSON (with the place), or not sound GeoJSON.
    """
    try:
        value = json.loads(content.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise MeshError("this is not a text file") from error
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise MeshError(f"{place}: this is not JSON ({error.msg})") from error
    except (RecursionError, ValueError) as error:
        raise MeshError("this JSON is too deep or its numbers too long") from error
    if not is_geojson(value):
        raise MeshError("it is JSON but not a GeoJSON geometry, feature or collection of them")
    return collected(value)


def collected(value: Mapping[str, Any]) -> Drawing:
    """Return what an object of GeoJSON holds.

    Raises:
        MeshError: it is not sound.
    """
    drawing = Drawing()
    areas: list[DrawnArea] = []
    for geometry, name in _geometries(value, "", drawing, 0):
        kind, coordinates = geometry["type"], geometry.get("coordinates")
        if kind in ("Polygon", "MultiPolygon"):
            for rings in [coordinates] if kind == "Polygon" else _list(coordinates, kind):
                area = _area(_list(rings, kind), kind, name)
                for ring in area.rings:
                    for curve in ring:
                        drawing.add(curve, name)
                if area.rings:
                    areas.append(area)
        elif kind in ("LineString", "MultiLineString"):
            for line in [coordinates] if kind == "LineString" else _list(coordinates, kind):
                drawing.add(polyline(_positions(line, kind)), name, name)
        else:
            drawing.ignored[kind] += 1
    drawing.areas = areas or None
    return drawing


def _geometries(
    value: Any, name: str, drawing: Drawing, depth: int
) -> Iterator[tuple[Mapping[str, Any], str]]:
    """Yield each single geometry with the name of its feature."""
    if value is None:
        drawing.ignored["feature without geometry"] += 1
        return
    if not is_geojson(value) or depth > _DEPTH:
        raise MeshError("it is not sound GeoJSON: a geometry or feature has no known type")
    kind = value["type"]
    if kind == "FeatureCollection":
        for feature in _list(value.get("features"), kind):
            yield from _geometries(feature, name, drawing, depth + 1)
    elif kind == "Feature":
        yield from _geometries(value.get("geometry"), _name(value), drawing, depth + 1)
    elif kind == "GeometryCollection":
        for geometry in _list(value.get("geometries"), kind):
            yield from _geometries(geometry, name, drawing, depth + 1)
    else:
        yield value, name


def _name(feature: Mapping[str, Any]) -> str:
    properties = feature.get("properties")
    given = {}
    if isinstance(properties, Mapping):
        given = {str(key).lower(): value for key, value in properties.items()}
    given.setdefault("id", feature.get("id"))
    for key in _NAMES:
        value = given.get(key)
        if isinstance(value, str | int) and not isinstance(value, bool) and str(value).strip():
            return " ".join(str(value).split())[:80]
    return ""


def _area(rings: list[Any], kind: str, name: str) -> DrawnArea:
    curves = []
    for ring in rings:
        positions = _positions(ring, kind)
        if len(positions) and (positions[0] != positions[-1]).any():
            raise MeshError(f"it is not sound GeoJSON: a ring of a {kind} is not closed")
        curve = polyline(positions)
        if curve is not None:
            curves.append((curve,))
    return DrawnArea(tuple(curves), name, name)


def _positions(value: Any, kind: str) -> np.ndarray:
    rows = _list(value, kind)
    try:
        pairs = [(float(row[0]), float(row[1])) for row in rows]
    except (TypeError, ValueError, IndexError, KeyError, OverflowError) as error:
        raise MeshError(
            f"it is not sound GeoJSON: the coordinates of a {kind} are not pairs of numbers"
        ) from error
    return np.array(pairs, dtype=np.float64).reshape(-1, 2)


def _list(value: Any, kind: str) -> list[Any]:
    if not isinstance(value, list):
        raise MeshError(f"it is not sound GeoJSON: the {kind} lacks a list")
    return value
