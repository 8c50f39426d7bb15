"""Domains made of the regions that were found in a drawing."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain import Domain
from meshwright_core.io.drawings import measures
from meshwright_core.io.drawings.drawn import Points
from meshwright_core.io.drawings.report import FoundRegion, Side

FITS = ("arcs", "splines")
"""What may be found in polylines."""
_SMOOTH = 30.0
"""Degrees by which a polyline that stands for a curve turns at a point, at most."""
_EXACT = 1e-4
"""Distance from a polyline, as a share of its size, of the curves that replace it."""


def domain_of(
    regions: Sequence[FoundRegion], name: str, corner_angle: float, fit: str | None = None
) -> Domain:
    """Return the domain of regions.

    One region with straight sides without names is a polygon, as it always was.

    Args:
        regions: at least one.
        name: of the domain.
        corner_angle: degrees.
        fit: one of `FITS`, or None.
    """
    fitted: dict[int, tuple[Curve, ...]] = {}
    if fit is not None:
        for region in regions:
            for loop in region.loops:
                for side in loop:
                    if id(side.curve) not in fitted:
                        fitted[id(side.curve)] = _fitted(side.curve, fit, corner_angle)
    if len(regions) == 1 and not fitted and _is_plain(regions[0]):
        outline, *holes = [_ring(loop) for loop in regions[0].loops]
        return Domain(outline, holes, name=name, corner_angle=corner_angle)
    loops, names = [], []
    for region in regions:
        ways = [_forward(loop) for loop in region.loops]
        loops.append([_curves(loop, fitted) for loop in ways])
        names.append([_side_names(loop, fitted) for loop in ways])
    if len(regions) == 1:
        return Domain.from_curves(loops[0], name, corner_angle, names[0])
    called = [region.name for region in regions]
    return Domain.from_regions(list(zip(called, loops, strict=True)), name, corner_angle, names)


def _is_plain(region: FoundRegion) -> bool:
    return all(
        side.curve.kind in ("line", "polyline") and not side.name
        for loop in region.loops
        for side in loop
    )


def _ring(loop: tuple[Side, ...]) -> Points:
    rows = []
    for side in loop:
        points = side.curve.data["points"]
        rows.append(points[::-1][:-1] if side.back else points[:-1])
    return np.concatenate(rows)


def _forward(loop: tuple[Side, ...]) -> tuple[Side, ...]:
    """The loop in the direction in which most of it was drawn: domains turn loops themselves."""
    if 2 * sum(side.back for side in loop) <= len(loop):
        return loop
    return tuple(Side(side.curve, not side.back, side.name) for side in reversed(loop))


def _curves(loop: tuple[Side, ...], fitted: dict[int, tuple[Curve, ...]]) -> list[Curve]:
    found: list[Curve] = []
    for side in loop:
        parts = fitted.get(id(side.curve), (side.curve,))
        found += [part.reversed for part in reversed(parts)] if side.back else parts
    return found


def _side_names(loop: tuple[Side, ...], fitted: dict[int, tuple[Curve, ...]]) -> list[str]:
    return [side.name for side in loop for _ in fitted.get(id(side.curve), (side.curve,))]


def _fitted(curve: Curve, fit: str, corner_angle: float) -> tuple[Curve, ...]:
    """The curves that a polyline stands for, between its corners; other curves as they are."""
    if curve.kind != "polyline":
        return (curve,)
    from meshwright_core.curves import fitting

    points = curve.data["points"]
    tolerance = _EXACT * float(np.ptp(points, axis=0).max())
    if fit == "arcs":
        return tuple(fitting.fit_arcs(points, tolerance))
    least = max(corner_angle, _SMOOTH)
    turns = measures.inner_turns(curve)
    corners = [0, *(np.flatnonzero(turns > least) + 1).tolist(), len(points) - 1]
    if all(last - first == 1 for first, last in pairwise(corners)):
        return (curve,)
    return tuple(fitting.fit_splines(points, corners, tolerance))
