"""Files that hold a shape rather than a mesh.

Drawings (DXF, SVG), geometry (GeoJSON, WKT, Triangle's .poly), coordinates of airfoils (.dat), and
our own JSON. Each reader gives curves; :mod:`.tracing.regions` finds the regions that they enclose.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Mapping
from pathlib import Path
from typing import Any

from meshwright_core.core.time_limit import SECONDS, time_limit
from meshwright_core.domains.domain import CORNER_ANGLE, Domain, load_json
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.domains import FITS, domain_of
from meshwright_core.io.drawings.drawn import Drawing
from meshwright_core.io.drawings.readers import (
    airfoil,
    dxf,
    geojson,
    own_json,
    svg,
    triangle_poly,
    wkt,
)
from meshwright_core.io.drawings.report import DrawingReport, FoundRegion
from meshwright_core.io.drawings.tracing.regions import traced
from meshwright_core.io.file_checks import naming, size_of
from meshwright_core.io.formats import DAT, SHAPES

__all__ = [
    "FITS",
    "MAX_BYTES",
    "DrawingReport",
    "FoundRegion",
    "domain_in",
    "endings",
    "is_geometry",
    "read_domain",
    "read_regions",
]

MAX_BYTES = 64 * 2**20
"""Size of a file beyond which it is not read."""

_HEAD = 4096
"""Bytes of a .dat file by which airfoils are told from meshes of Tecplot."""


def endings() -> tuple[str, ...]:
    """Return the endings of geometry files, with their dots; .dat is also one of mesh files."""
    return (*SHAPES, DAT)


def is_geometry(path: str | os.PathLike[str]) -> bool:
    """Whether a file holds a shape, which must be meshed first: by its ending.

    A .dat file is one if its beginning is that of the coordinates of an airfoil; else it is a mesh
    of Tecplot.
    """
    ending = Path(path).suffix.lower()
    if ending != DAT:
        return ending in SHAPES
    try:
        with open(path, "rb") as file:
            return airfoil.is_airfoil(file.read(_HEAD))
    except (OSError, ValueError):
        return False


def read_regions(
    path: str | os.PathLike[str],
    corner_angle: float = CORNER_ANGLE,
    gap: float | None = None,
    layers: Collection[str] | None = None,
    seconds: float = SECONDS,
) -> DrawingReport:
    """Find all regions in a file; coordinates and units stay those of the drawing.

    Lines and curves may come in any order and direction. Ends that all but meet are joined, what is
    drawn twice counts once, and a line that ends on another one splits it. Loops inside others are
    holes, and islands in holes are regions again; regions may touch. What encloses nothing is left
    out.

    Args:
        path: a file whose ending `endings` lists, or coordinates of an airfoil (.dat). A .json file
            holds a domain in our own form (see `Domain.from_json`) or GeoJSON. The coordinates of
            GeoJSON are taken as plane ones.
        corner_angle: degrees by which the boundary turns at a corner; where a curve is involved 1
            degree at least.
        gap: width of gaps at loose ends that are closed, in the units of the drawing; None: 0.001
            of its size.
        layers: of DXF, or groups or ids of SVG, that are read; None: all.
        seconds: processor time that it may take; a limit that holds already
            (:func:`meshwright_core.core.time_limit.time_limit`) stays.

    Raises:
        MeshError: one sentence that begins with the path: the file is missing, empty, cut off,
            damaged or of another kind; or nothing in it is closed, with the place and width of the
            gap; more time than it may take.
    """
    place = Path(path)
    wanted = None if layers is None else frozenset(layers)
    key = (_stamp(place), corner_angle, gap, wanted)
    if key[0] is not None and _last and _last[0][0] == key:
        return _last[0][1]
    with time_limit(seconds):
        drawing = _drawing(place)
        with naming(place):
            report = traced(drawing, corner_angle, gap, layers)
    _last[:] = [(key, report)]
    return report


def read_domain(
    path: str | os.PathLike[str],
    corner_angle: float = CORNER_ANGLE,
    curve_step: float | None = None,
    region: str | int | None = None,
    *,
    gap: float | None = None,
    layers: Collection[str] | None = None,
    fit: str | None = None,
    seconds: float = SECONDS,
) -> Domain:
    """Read the shape in a file: one region of it, or several that are meshed together.

    The domain is named after the file, or after the region that was chosen.

    Args:
        path: as for `read_regions`.
        corner_angle: as there. A .json file in our own form may name its corners itself.
        curve_step: degrees that an edge of a mesh turns along a curve, at most; None: as much as
            the shape allows.
        region: names or numbers of regions, separated by commas, or "all"; None: all of them, if
            they touch, directly or through others.
        gap: as there.
        layers: as there.
        fit: "arcs" or "splines" that are to be found in polylines; None: they stay as they are.
        seconds: as there.

    Raises:
        MeshError: as `read_regions`; there is no such region; regions lie apart, and none was
            named; a boundary crosses itself or another one; an outline is open; and all that
            `Domain` refuses.
    """
    place = Path(path)
    if fit not in (None, *FITS):
        raise MeshError(f"Curves are fitted as {' or '.join(FITS)}, not {fit!r}.")
    with time_limit(seconds):
        return _read_domain(place, corner_angle, curve_step, region, gap, layers, fit)


def _read_domain(
    place: Path,
    corner_angle: float,
    curve_step: float | None,
    region: str | int | None,
    gap: float | None,
    layers: Collection[str] | None,
    fit: str | None,
) -> Domain:
    plain = region is None and gap is None and layers is None and fit is None
    if place.suffix.lower() == ".json" and plain:
        content = load_json(place)
        if not geojson.is_geojson(content):
            # which may name its corners
            domain = Domain.from_json(place, corner_angle)
            domain.curve_step = curve_step
            return domain
    report = read_regions(place, corner_angle, gap, layers)
    with naming(place):
        chosen = report.chosen(region)
        alone = region is not None and len(chosen) == 1 and len(report.regions) > 1
        name = f"{place.stem} {chosen[0].name}" if alone else place.stem
        domain = domain_of(chosen, name, corner_angle, fit)
        domain.curve_step = curve_step
        return domain


def domain_in(
    drawing: Drawing, corner_angle: float = CORNER_ANGLE, region: str | None = None
) -> Domain:
    """The domain of the chosen regions in a drawing that comes from elsewhere than a file.

    region: their names or numbers, "all", or None for all if they touch.

    Raises:
        MeshError: as `read_domain`, without a path.
    """
    return domain_of(
        traced(drawing, corner_angle, None, None).chosen(region), "", corner_angle, None
    )


_last: list[tuple[Any, DrawingReport]] = []
"""The last report and what it is of: whoever lists the regions of a file meshes them next."""


def _stamp(place: Path) -> tuple[Any, ...] | None:
    """What changes when a file does; None if there is none, or if it belongs to other files."""
    try:
        state = place.stat()
    except (OSError, ValueError):  # no such file; no name for one
        return None
    if place.suffix.lower() == ".poly":  # its points may be in a file of their own
        return None
    return (place.absolute(), state.st_mtime_ns, state.st_size, state.st_ino)


def _drawing(place: Path) -> Drawing:
    ending = place.suffix.lower()
    if ending == ".json":
        content = load_json(place)
        with naming(place):
            return _of_json(content)
    with naming(place):
        if ending == ".poly":
            return triangle_poly.read(_bytes(place), place)
        if ending not in _READERS:
            raise MeshError(f"a file of a shape ends in one of {' '.join(endings())}")
        return _READERS[ending](_bytes(place))


def _of_json(content: Any) -> Drawing:
    if isinstance(content, Mapping) and geojson.is_geojson(content):
        return geojson.collected(content)
    return own_json.collected(content)


def _bytes(path: Path) -> bytes:
    if size_of(path) > MAX_BYTES:
        raise MeshError(f"the file has more than {MAX_BYTES // 2**20} MiB")
    return path.read_bytes()


_READERS: dict[str, Callable[[bytes], Drawing]] = {
    ".dxf": dxf.read,
    ".svg": svg.read,
    ".geojson": geojson.read,
    ".wkt": wkt.read,
    DAT: airfoil.read,
}
