"""Our own JSON as a drawing: each region an area; the form is that of `Domain.from_json`."""

from __future__ import annotations

from typing import Any

from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain_json import PolygonContent, parsed
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import Drawing, DrawnArea, polyline


def collected(content: Any) -> Drawing:
    """Return what an object in our form holds.

    Raises:
        MeshError: it is none, with what is wrong.
    """
    found = parsed(content)
    drawing = Drawing(areas=[])
    assert drawing.areas is not None
    if isinstance(found, PolygonContent):
        curves = [_ring(ring) for ring in (found.outline, *found.holes)]
        for curve in curves:
            drawing.add(curve)
        drawing.areas.append(DrawnArea(tuple((curve,) for curve in curves)))
        return drawing
    for (name, loops), names in zip(found.regions, found.names, strict=True):
        for loop, own in zip(loops, names, strict=True):
            for curve, side in zip(loop, own, strict=True):
                drawing.add(curve, name, side)
        drawing.areas.append(DrawnArea(tuple(map(tuple, loops)), name, name))
    return drawing


def _ring(points: list[list[float]]) -> Curve:
    curve = polyline([*points, *points[:1]])
    if curve is None:
        raise MeshError("a loop has no length")
    return curve
