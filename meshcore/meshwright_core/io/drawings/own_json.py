"""Our own JSON: an outline, holes, or named regions, as lists of points or of curves.

``{"outline": loop, "holes": [loop, ...], "name": ...}``, or ``{"regions": [{"name": ...,
"outline": loop, "holes": [loop, ...]}, ...]}``. A loop is a list of [x, y], closed by itself, or a
list of pieces in the form of :meth:`Curve.to_json`, each with an optional ``"name"``.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import DrawnArea, DrawnCurve, Drawing, polyline


def collected(content: Any) -> Drawing:
    """Return what an object in our form holds.

    Raises:
        MeshError: it is none, with what is wrong.
    """
    if not isinstance(content, Mapping):
        raise MeshError('a domain is a JSON object with an "outline"')
    regions = content.get("regions")
    if regions is None:
        regions = [content]
    if not isinstance(regions, list):
        raise MeshError('"regions" is not a list')
    drawing = Drawing()
    areas = []
    for i, region in enumerate(regions):
        what = "the domain" if region is content else f"region {i}"
        if not isinstance(region, Mapping) or "outline" not in region:
            raise MeshError(f'{what} has no "outline"')
        name = region.get("name") or ""
        if not isinstance(name, str):
            raise MeshError(f"the name of {what} is not text")
        rings = []
        holes = region.get("holes") or []
        if not isinstance(holes, list):
            raise MeshError(f"the holes of {what} are not a list")
        for ring in [region["outline"], *holes]:
            pieces = _loop(ring, what)
            for piece in pieces:
                drawing.add(piece.curve, name, piece.name)
            rings.append(tuple(piece.curve for piece in pieces))
        areas.append(DrawnArea(tuple(rings), name, name))
    drawing.areas = areas
    return drawing


def _loop(ring: Any, what: str) -> list[DrawnCurve]:
    if not isinstance(ring, list) or not ring:
        raise MeshError(f"a loop of {what} is not a list of points or pieces")
    if not isinstance(ring[0], Mapping):
        try:
            curve = polyline([*ring, ring[0]])
        except (TypeError, ValueError) as error:
            raise MeshError(f"a loop of {what} is not a list of [x, y] pairs of numbers") from error
        if curve is None:
            raise MeshError(f"a loop of {what} has no length")
        return [DrawnCurve(curve)]
    pieces = []
    for piece in ring:
        if not isinstance(piece, Mapping):
            raise MeshError(f"a loop of {what} mixes points and pieces")
        own = {key: value for key, value in piece.items() if key != "name"}
        name = piece.get("name") or ""
        if not isinstance(name, str):
            raise MeshError(f"the name of a piece of {what} is not text")
        pieces.append(DrawnCurve(Curve.from_json(own), "", name))
    return pieces
