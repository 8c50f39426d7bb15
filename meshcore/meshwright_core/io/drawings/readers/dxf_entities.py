"""Entities of DXF drawings as curves in the plane: what each type means.

Arcs stay arcs and splines splines. Lines, ellipses and splines are given in world coordinates, the
others in the plane of the entity, which may lie face down (Autodesk's DXF reference, *Object
coordinate systems*).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from meshwright_core.curves.curve import Curve
from meshwright_core.errors import MeshError
from meshwright_core.io.drawings.drawn import LARGEST, Points, polyline

_TILT = 1e-6
"""Slope of an entity's plane against the drawing's up to which it lies in it."""


class TiltedError(Exception):
    """An entity does not lie in the plane of the drawing."""


def curves_of(entity: Any) -> Iterator[Curve]:
    """Yield the curves of an entity whose type is in `KINDS`.

    Raises:
        TiltedError: it lies across the plane of the drawing.
        MeshError: its numbers do not fit together.
    """
    kind = entity.dxftype()
    try:
        for curve in KINDS[kind](entity):
            if curve is not None:
                yield curve
    except MeshError as error:
        raise MeshError(f"the {kind}{_handle(entity)}: {str(error).rstrip('.')}") from error
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise MeshError(f"the {kind}{_handle(entity)} is damaged") from error


def mirror(entity: Any) -> float:
    """1 for an entity that lies in the plane face up, -1 face down: then its x axis is mirrored.

    Raises:
        TiltedError: it lies across the plane.
    """
    x, y, z = entity.dxf.get("extrusion", (0.0, 0.0, 1.0))
    if math.hypot(x, y) > _TILT * abs(z) or z == 0.0:
        raise TiltedError
    return math.copysign(1.0, z)


def _handle(entity: Any) -> str:
    handle = entity.dxf.get("handle")
    return f" #{handle} on layer {entity.dxf.layer}" if handle else f" on layer {entity.dxf.layer}"


def _plane(point: Any) -> Points:
    found = np.array([point[0], point[1]], dtype=np.float64)
    if not (np.abs(found) < LARGEST).all():
        raise MeshError("a coordinate is not a finite number")
    return found


def _line(entity: Any) -> Iterator[Curve | None]:
    yield polyline([_plane(entity.dxf.start), _plane(entity.dxf.end)])


def _round(entity: Any) -> Iterator[Curve | None]:
    """A circle or an arc of one."""
    side = mirror(entity)
    radius = float(entity.dxf.radius)
    if radius == 0.0:  # a point, as is a line of no length
        return
    if not 0.0 < radius < LARGEST:
        raise MeshError(f"it has the radius {radius:g}")
    start, sweep = 0.0, 2 * math.pi
    if entity.dxftype() == "ARC":
        start, stop = math.radians(entity.dxf.start_angle), math.radians(entity.dxf.end_angle)
        sweep = (stop - start) % (2 * math.pi) or 2 * math.pi
    centre = _plane(entity.dxf.center) * (side, 1.0)
    if side < 0:
        start, sweep = math.pi - start, -sweep
    yield Curve.arc(centre, radius, start, sweep)


def _ellipse(entity: Any) -> Iterator[Curve | None]:
    side = mirror(entity)
    major = _plane(entity.dxf.major_axis)
    minor = side * float(entity.dxf.ratio) * np.array([-major[1], major[0]])
    if not (major.any() and minor.any()):
        raise MeshError("it has no width")
    start, stop = float(entity.dxf.start_param), float(entity.dxf.end_param)
    sweep = (stop - start) % (2 * math.pi)
    sweep = 2 * math.pi if sweep < 1e-9 else sweep
    yield Curve.ellipse(_plane(entity.dxf.center), major, minor, start, sweep)


def _light(entity: Any) -> Iterator[Curve | None]:
    side = mirror(entity)
    rows = [(x, y, bulge) for x, y, bulge in entity.get_points("xyb")]
    yield from with_bulges(rows, bool(entity.closed), side)


def _heavy(entity: Any) -> Iterator[Curve | None]:
    if entity.is_polygon_mesh or entity.is_poly_face_mesh:
        raise TiltedError
    side = 1.0 if entity.is_3d_polyline else mirror(entity)
    # 16: control points of a curve whose own points are there too
    vertices = [v for v in entity.vertices if not int(v.dxf.flags) & 16]
    rows = [(v.dxf.location.x, v.dxf.location.y, v.dxf.get("bulge", 0.0)) for v in vertices]
    yield from with_bulges(rows, bool(entity.is_closed), side)


def with_bulges(
    rows: list[tuple[float, float, float]], closed: bool, side: float
) -> Iterator[Curve | None]:
    """Straight runs and arcs of a polyline of (x, y, bulge).

    A bulge is the tangent of a quarter of the sweep of the arc to the next point. `side` as
    :func:`mirror` returns it.
    """
    if len(rows) < 2:
        return
    given = np.array(rows, dtype=np.float64)
    if not (np.abs(given) < LARGEST).all():
        raise MeshError("a coordinate is not a finite number")
    points, bulges = given[:, :2] * (side, 1.0), side * given[:, 2]
    ends = np.roll(points, -1, axis=0)
    run = [points[0]]
    for i in range(len(points) if closed else len(points) - 1):
        if bulges[i] == 0 or (points[i] == ends[i]).all():
            run.append(ends[i])
            continue
        yield polyline(run)
        yield Curve.arc_by_bulge(points[i], ends[i], float(bulges[i]))
        run = [ends[i]]
    yield polyline(run)


def _spline(entity: Any) -> Iterator[Curve | None]:
    control = np.array([tuple(point)[:2] for point in entity.control_points]).reshape(-1, 2)
    fit = np.array([tuple(point)[:2] for point in entity.fit_points]).reshape(-1, 2)
    if len(control) == 0:
        yield _through(entity, fit)
        return
    degree = int(entity.dxf.degree)
    knots = np.array(entity.knots, dtype=np.float64)
    weights = np.array(entity.weights, dtype=np.float64)
    yield nurbs(control, knots, weights if len(weights) else None, degree)


def nurbs(control: Points, knots: Points, weights: Points | None, degree: int) -> Curve:
    """A B-spline with the checks of its numbers.

    Raises:
        MeshError: they do not fit together.
    """
    fits = 1 <= degree < len(control) and len(knots) == len(control) + degree + 1
    fits = fits and bool((np.diff(knots) >= 0).all()) and knots[degree] < knots[len(control)]
    fits = fits and (weights is None or (len(weights) == len(control) and weights.min() > 0))
    if not fits:
        raise MeshError("the knots and points of the SPLINE do not fit")
    if weights is not None and (weights == weights[0]).all():
        weights = None
    return Curve.spline(control, knots, degree, weights)


def _through(entity: Any, fit: Points) -> Curve | None:
    """A spline given by the points that it runs through, with tangents at its ends or without."""
    if len(fit) < 2:
        raise MeshError("it has no points")
    closed = bool(entity.closed) or bool((fit[0] == fit[-1]).all())
    if closed or len(fit) < 3:
        return Curve.through(fit, closed=closed and len(fit) > 3)
    from ezdxf.math import fit_points_to_cad_cv

    tangents = [entity.dxf.get(name) for name in ("start_tangent", "end_tangent")]
    given = None if None in tangents else [(t[0], t[1], 0.0) for t in tangents]
    made = fit_points_to_cad_cv([(x, y, 0.0) for x, y in fit], tangents=given)
    control = np.array([tuple(point)[:2] for point in made.control_points])
    return nurbs(control, np.array(made.knots()), None, made.degree)


def _hatch(entity: Any) -> Iterator[Curve | None]:
    """The boundaries of a hatched area."""
    side = mirror(entity)
    for path in entity.paths:
        if hasattr(path, "vertices"):
            yield from with_bulges([tuple(row) for row in path.vertices], True, side)
            continue
        for edge in path.edges:
            curve = _edge(edge)
            if curve is not None and side < 0:
                curve = curve.transformed([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
            yield curve


def _edge(edge: Any) -> Curve | None:
    """One edge of the boundary of a hatch, in its own plane."""
    name = type(edge).__name__
    if name == "LineEdge":
        return polyline([_plane(edge.start), _plane(edge.end)])
    if name == "ArcEdge":
        start, stop = math.radians(edge.start_angle), math.radians(edge.end_angle)
        sweep = (stop - start) % (2 * math.pi) or 2 * math.pi
        return Curve.arc(_plane(edge.center), float(edge.radius), start, sweep)
    if name == "EllipseEdge":
        major = _plane(edge.major_axis)
        minor = float(edge.ratio) * np.array([-major[1], major[0]])
        sweep = (edge.end_param - edge.start_param) % (2 * math.pi)
        sweep = 2 * math.pi if sweep < 1e-9 else sweep
        return Curve.ellipse(_plane(edge.center), major, minor, edge.start_param, sweep)
    control = np.array([tuple(point)[:2] for point in edge.control_points])
    weights = np.array(edge.weights) if edge.weights else None
    return nurbs(control, np.array(edge.knot_values), weights, int(edge.degree))


KINDS: dict[str, Callable[[Any], Iterator[Curve | None]]] = {
    "ARC": _round,
    "CIRCLE": _round,
    "ELLIPSE": _ellipse,
    "HATCH": _hatch,
    "LINE": _line,
    "LWPOLYLINE": _light,
    "POLYLINE": _heavy,
    "SPLINE": _spline,
}
