"""Files that hold a shape rather than a mesh: DXF, SVG, GeoJSON, WKT, and our own JSON."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import shapely

from meshwright_core.domains.domain import CORNER_ANGLE, Domain, load_json
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings import curves, dxf, svg
from meshwright_core.io.drawings.curves import CURVE_STEP, Piece
from meshwright_core.io.drawings.loop_tracing import traced
from meshwright_core.io.file_checks import naming, size_of
from meshwright_core.io.formats import SHAPES

MAX_BYTES = 256 * 2**20
"""Size of a file beyond which it is not read."""

_GEOJSON = (
    "Feature",
    "FeatureCollection",
    "GeometryCollection",
    "LineString",
    "MultiLineString",
    "MultiPolygon",
    "Polygon",
)
_SRID = re.compile(r"\s*SRID\s*=\s*\d+\s*;", re.IGNORECASE)

Read = Callable[[bytes, float, float], list[Piece]]


def endings() -> tuple[str, ...]:
    """Return the endings of geometry files, with their dots."""
    return SHAPES


def is_geometry(path: str | os.PathLike[str]) -> bool:
    """Whether a file, by its ending, holds a shape, which must be meshed first."""
    return Path(path).suffix.lower() in SHAPES


def read_domain(
    path: str | os.PathLike[str],
    corner_angle: float = CORNER_ANGLE,
    curve_step: float = CURVE_STEP,
) -> Domain:
    """Read the shape in a file; coordinates and units stay those of the drawing.

    Lines and curves may come in any order and direction; their ends are joined where they all but
    meet. The longest way round is the outline, the loops inside it are holes. The domain is named
    after the file.

    Args:
        path: a file whose ending `endings` lists. A .json file holds a domain in our own form
            (see `Domain.from_json`) or GeoJSON. The coordinates of GeoJSON are taken as plane ones.
        corner_angle: degrees by which the boundary must turn at a corner; where a curve is
            involved 1 degree at least. A .json file in our own form may name its corners itself.
        curve_step: degrees by which the polyline that stands for a curve turns at a point, at
            most; smaller values follow the curve more closely.

    Raises:
        MeshError: one sentence that begins with the path: the file is missing, empty, cut off,
            damaged or of another kind; the outline is open, or there are several; and all that
            `Domain` refuses.
    """
    place = Path(path)
    ending = place.suffix.lower()
    if ending == ".json":
        return _json(place, corner_angle)
    with naming(place):
        if ending not in _READERS:
            raise MeshError(f"a file of a shape ends in one of {' '.join(endings())}")
        pieces = _READERS[ending](_bytes(place), corner_angle, curve_step)
        return traced(pieces, corner_angle, place.stem)


def _bytes(path: Path) -> bytes:
    if size_of(path) > MAX_BYTES:
        raise MeshError(f"the file has more than {MAX_BYTES // 2**20} MiB")
    return path.read_bytes()


def _json(path: Path, corner_angle: float) -> Domain:
    """Read a .json file, which may be GeoJSON too."""
    content = load_json(path)
    if not _is_geojson(content):
        return Domain.from_json(path, corner_angle)
    with naming(path):
        return traced(_collected(content, corner_angle), corner_angle, path.stem)


def _geojson(content: bytes, corner_angle: float, step: float) -> list[Piece]:
    try:
        collection = json.loads(_text(content))
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        raise MeshError(f"{place}: this is not JSON ({error.msg})") from error
    except (RecursionError, ValueError) as error:
        raise MeshError("this JSON is too deep or its numbers too long") from error
    if not _is_geojson(collection):
        raise MeshError("it is JSON but not a GeoJSON geometry, feature or collection of them")
    return _collected(collection, corner_angle)


def _is_geojson(content: Any) -> bool:
    return isinstance(content, Mapping) and content.get("type") in _GEOJSON


def _collected(collection: Any, corner_angle: float) -> list[Piece]:
    with _geos("it is not sound GeoJSON"):
        shape = shapely.from_geojson(json.dumps(collection))
    return list(_pieces(shape, corner_angle))


def _wkt(content: bytes, corner_angle: float, step: float) -> list[Piece]:
    with _geos("it is not sound WKT"):
        shape = shapely.from_wkt(_SRID.sub("", _text(content), count=1))
    return list(_pieces(shape, corner_angle))


def _text(content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise MeshError("this is not a text file") from error


@contextmanager
def _geos(lead: str) -> Iterator[None]:
    """Turn what shapely raises into a MeshError that begins with `lead`."""
    try:
        yield
    except (shapely.GEOSException, ValueError, TypeError) as error:
        reason = " ".join(str(error).split()).rsplit("Exception: ", 1)[-1].rstrip(".")
        reason = reason if len(reason) <= 100 else reason[:97] + "..."
        raise MeshError(f"{lead} ({reason[:1].lower() + reason[1:]})") from error


def _pieces(shape: Any, corner_angle: float) -> Iterator[Piece]:
    """Yield the rings and lines of a shapely geometry, however deep its collections."""
    pending = [shape]
    while pending:
        part = pending.pop()
        if part is None or part.is_empty:
            continue
        if hasattr(part, "geoms"):
            pending += list(part.geoms)
        elif part.geom_type == "Polygon":
            pending += [part.exterior, *part.interiors]
        elif part.geom_type in ("LineString", "LinearRing"):
            piece = curves.straight(shapely.get_coordinates(part), corner_angle)
            if piece is not None:
                yield piece


_READERS: dict[str, Read] = {".dxf": dxf.read, ".svg": svg.read, ".geojson": _geojson, ".wkt": _wkt}
