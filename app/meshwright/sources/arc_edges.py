"""Circular edges of a drawing by their bulges.

The bulge of the edge from a to b is tan(θ / 4), where θ is the angle of its arc; it is positive
where the arc turns left on its way, so that it lies to the right of the chord, and 0 for a segment.
This is the form of polylines in DXF files.
"""

from __future__ import annotations

import math

Place = tuple[float, float]

STEP = math.radians(7.5)
"""Largest angle between neighbours in the polyline of an arc."""


def bulge_through(a: Place, p: Place, b: Place) -> float:
    """The bulge of the arc from `a` through `p` to `b`; 0 if they lie on one line."""
    ux, uy, vx, vy = a[0] - p[0], a[1] - p[1], b[0] - p[0], b[1] - p[1]
    across, along = ux * vy - uy * vx, ux * vx + uy * vy
    if abs(across) <= 1e-12 * (math.hypot(ux, uy) * math.hypot(vx, vy) + 1e-300):
        return 0.0
    # p sees the chord under the angle φ, and θ is 2π - 2φ
    seen = math.atan2(abs(across), along)
    return math.copysign(1.0 / math.tan(seen / 2.0), -across)


def bulge_of_radius(a: Place, b: Place, radius: float, left: bool, large: bool) -> float:
    """The bulge of the arc of this radius from `a` to `b`; ValueError if it is too small.

    left: the arc lies to the left of the chord; large: it is more than a half circle.
    """
    chord = math.dist(a, b)
    if radius * (1.0 + 1e-9) < chord / 2.0 or chord == 0.0:
        raise ValueError(f"the radius is less than half of the chord, {chord / 2.0:.6g}")
    half = math.asin(min(chord / (2.0 * radius), 1.0))
    angle = 2.0 * (math.pi - half if large else half)
    return math.tan(angle / 4.0) * (-1.0 if left else 1.0)


def circle_of(a: Place, b: Place, bulge: float) -> tuple[Place, float]:
    """Centre and radius of an arc with a bulge that is not 0."""
    offset = (1.0 - bulge * bulge) / (4.0 * bulge)
    x = (a[0] + b[0]) / 2.0 - offset * (b[1] - a[1])
    y = (a[1] + b[1]) / 2.0 + offset * (b[0] - a[0])
    return (x, y), math.dist((x, y), a)


def middle_of(a: Place, b: Place, bulge: float) -> Place:
    """The point halfway along an edge."""
    # the arc is bulge / 2 chords away from the middle of its chord, to the right
    x = (a[0] + b[0]) / 2.0 + bulge / 2.0 * (b[1] - a[1])
    y = (a[1] + b[1]) / 2.0 - bulge / 2.0 * (b[0] - a[0])
    return x, y


def points_of(a: Place, b: Place, bulge: float, step: float = STEP) -> list[Place]:
    """Points of an edge in order, `a` and `b` included; a segment has these two only."""
    if bulge == 0.0 or a == b:
        return [a, b]
    (x, y), radius = circle_of(a, b, bulge)
    sweep = 4.0 * math.atan(bulge)
    first = math.atan2(a[1] - y, a[0] - x)
    count = max(2, math.ceil(abs(sweep) / step))
    angles = (first + sweep * i / count for i in range(1, count))
    inner = [(x + radius * math.cos(t), y + radius * math.sin(t)) for t in angles]
    return [a, *inner, b]


def share_at(a: Place, b: Place, bulge: float, p: Place) -> float:
    """Where `p`, near the edge, lies on it: 0 at `a`, 1 at `b`."""
    if bulge == 0.0:
        ux, uy = b[0] - a[0], b[1] - a[1]
        size = ux * ux + uy * uy
        share = ((p[0] - a[0]) * ux + (p[1] - a[1]) * uy) / size if size > 0 else 0.0
        return min(max(share, 0.0), 1.0)
    (x, y), _ = circle_of(a, b, bulge)
    sweep = 4.0 * math.atan(bulge)
    turned = math.atan2(p[1] - y, p[0] - x) - math.atan2(a[1] - y, a[0] - x)
    turned = math.copysign((turned * math.copysign(1.0, bulge)) % (2.0 * math.pi), bulge)
    return min(turned / sweep, 1.0)


def part_of(bulge: float, share: float) -> float:
    """The bulge of a part of an arc, as long as `share` of it."""
    return math.tan(math.atan(bulge) * share)
