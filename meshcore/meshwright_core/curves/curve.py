"""The pieces that drawings are made of: segments, arcs of circles and ellipses, B-splines.

Every piece is stored as rational Bezier spans, which represent all of them exactly, together with
the numbers that define it. Evaluation and projection are the compiled kernels that move vertices,
so that a drawing and the mesh made of it agree to the last bit. SciPy's B-splines are not rational
and geomdl is interpreted Python; both evaluate splines only.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from meshwright_core.core.composite_curves import (
    Curves,
    halves,
    nearest_parameters,
    place_all,
    span_points,
    tangents,
)
from meshwright_core.curves import bezier_spans, curve_json
from meshwright_core.curves.bezier_spans import evened, homogeneous, segment, span_lengths
from meshwright_core.curves.part_data import image_of_conic, part_of_conic, spline_of_spans
from meshwright_core.errors import MeshError

Array = NDArray[np.float64]

STRAIGHT = 1e-12
"""Distance from its chord, relative to it, up to which a curve counts as straight."""
KINK = 1e-6
"""Radians by which the tangent jumps at a kink, at least."""
LARGEST_DEGREE = 25
_FLAT = 0.01
"""Radians of sweep below which an arc is not written by its centre, which is far away."""
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(24)
_GAUSS, _WEIGHTS = 0.5 * (_GAUSS + 1.0), 0.5 * _WEIGHTS
_DENSE = np.linspace(0.0, 1.0, 33)


class Curve:
    """A piece of a drawing, immutable; made by the class methods.

    The parameter t runs from 0 to `length`; it is the arc length at the ends of the spans and close
    to it in between.

    Attributes:
        kind: "line", "arc", "ellipse", "spline" or "polyline".
        data: the numbers that define it, as in :meth:`to_json`, with angles in radians.
        spans: (d + 1, 4) homogeneous control points of each rational Bezier span.
    """

    def __init__(
        self, kind: str, data: dict[str, Any], spans: list[Array], lengths: Array | None = None
    ) -> None:
        """For the class methods below. `lengths` (s,) of the spans, where they are known."""
        if not spans or not np.isfinite(np.concatenate(spans)).all():
            raise MeshError(f"a curve ({kind}) has a number that is not finite, or no length")
        for span in spans:
            span.flags.writeable = False
        self.kind, self.data, self.spans = kind, data, spans
        self._lengths = span_lengths(spans) if lengths is None else lengths
        if not self.length > 0.0:
            raise MeshError(f"a curve ({kind}) has no length")

    # Ways to make one

    @classmethod
    def line(cls, a: ArrayLike, b: ArrayLike) -> Curve:
        """The segment from a (2,) to b (2,)."""
        ends = np.array([a, b], np.float64)
        return cls("line", {"points": ends}, [segment(*ends)], _distances(ends))

    @classmethod
    def polyline(cls, points: ArrayLike) -> Curve:
        """Straight edges through points (n, 2), n at least 2; repeats are left out."""
        corners = without_repeats(np.array(points, np.float64).reshape(-1, 2))
        if len(corners) < 2:
            raise MeshError("a polyline has no length")
        if len(corners) == 2:
            return cls.line(*corners)
        spans = [segment(a, b) for a, b in pairwise(corners)]
        return cls("polyline", {"points": corners}, spans, _distances(corners))

    @classmethod
    def arc(cls, centre: ArrayLike, radius: float, start: float, sweep: float) -> Curve:
        """An arc of a circle; radians, counter-clockwise where `sweep` is positive.

        |sweep| of 2 pi or more is a whole circle.
        """
        if not (radius > 0.0 and sweep != 0.0):
            raise MeshError("an arc needs a radius above 0 and a sweep")
        middle = np.array(centre, np.float64)
        sweep = whole_turn(sweep)
        spans = bezier_spans.circle_spans(middle, float(radius), float(start), sweep)
        data = {"centre": middle, "radius": float(radius), "start": float(start), "sweep": sweep}
        lengths = np.full(len(spans), float(radius) * abs(sweep) / len(spans))
        return cls("arc", data, spans, lengths)

    @classmethod
    def arc_by_bulge(cls, a: ArrayLike, b: ArrayLike, bulge: float) -> Curve:
        """The arc from a to b; `bulge` is the tangent of a quarter of its sweep, as in DXF."""
        ends = np.array([a, b], np.float64)
        chord = ends[1] - ends[0]
        if bulge == 0.0 or not chord.any():
            return cls.line(*ends)
        spans = bezier_spans.bulge_spans(ends[0], ends[1], bulge)
        # the centre lies on the bisector, (1 - bulge^2) / (4 bulge) chords to the left
        offset = (1.0 - bulge * bulge) / (4.0 * bulge)
        centre = 0.5 * (ends[0] + ends[1]) + offset * np.array([-chord[1], chord[0]])
        radius = float(np.hypot(*chord)) * (1.0 + bulge * bulge) / (4.0 * abs(bulge))
        start = float(np.arctan2(*(ends[0] - centre)[::-1]))
        sweep = 4.0 * math.atan(bulge)
        data = {"centre": centre, "radius": radius, "start": start, "sweep": sweep}
        return cls("arc", data, spans)

    @classmethod
    def arc_through(cls, a: ArrayLike, middle: ArrayLike, b: ArrayLike) -> Curve:
        """The arc from a over `middle` to b; a segment if they lie on a line, or if `middle` is one
        of the ends; a whole circle if only the ends coincide.

        Raises MeshError if `middle` lies on the line beyond the ends.
        """
        p, m, q = (np.array(x, np.float64) for x in (a, middle, b))
        if (p == m).all() or (m == q).all():
            return cls.line(p, q)
        if (p == q).all():
            return cls.arc(0.5 * (p + m), 0.5 * float(np.hypot(*(m - p))),
                           float(np.arctan2(*(p - m)[::-1])), 2.0 * math.pi)  # fmt: skip
        # the angle at the middle point is pi less half of the sweep
        u, v = p - m, q - m
        angle = float(np.arctan2(u[0] * v[1] - u[1] * v[0], u @ v))
        if angle == 0.0:
            raise MeshError("an arc has its middle on a line with its ends, beyond them")
        half_sweep = math.copysign(math.pi, angle) - angle
        return cls.arc_by_bulge(p, q, -math.tan(0.5 * half_sweep))

    @classmethod
    def ellipse(
        cls, centre: ArrayLike, major: ArrayLike, minor: ArrayLike, start: float, sweep: float
    ) -> Curve:
        """The points centre + cos(a) major + sin(a) minor, a from `start` to start + sweep.

        `major` and `minor` (2,) are conjugate half diameters, usually the half axes.
        """
        axes = np.array([major, minor], np.float64)
        middle, sweep = np.array(centre, np.float64), whole_turn(sweep)
        if np.linalg.det(axes) == 0.0 or sweep == 0.0:
            raise MeshError("an ellipse needs two half axes and a sweep")
        unit = bezier_spans.circle_spans(np.zeros(2), 1.0, float(start), sweep)
        matrix = np.column_stack([axes.T, middle])
        spans = evened([_mapped(span, matrix) for span in unit])
        data = {
            "centre": middle, "major": axes[0], "minor": axes[1],
            "start": float(start), "sweep": sweep,
        }  # fmt: skip
        return cls("ellipse", data, spans)

    @classmethod
    def bezier(cls, control: ArrayLike, weights: ArrayLike | None = None) -> Curve:
        """A Bezier curve of control points (d + 1, 2), rational with weights (d + 1,) above 0."""
        points = np.array(control, np.float64)
        degree = len(points) - 1
        return cls.spline(points, np.repeat([0.0, 1.0], degree + 1), degree, weights)

    @classmethod
    def spline(
        cls, control: ArrayLike, knots: ArrayLike, degree: int, weights: ArrayLike | None = None
    ) -> Curve:
        """A B-spline (NURBS with weights).

        Args:
            control: (n, 2) control points, n above `degree`.
            knots: (n + degree + 1,), not decreasing; the curve runs from knot `degree` to knot n.
            degree: 1 to 25.
            weights: (n,) above 0.

        Raises:
            MeshError: numbers that do not fit together.
        """
        points, knot = np.array(control, np.float64), np.array(knots, np.float64)
        if points.ndim != 2 or points.shape[1] != 2 or not 1 <= degree <= LARGEST_DEGREE:
            raise MeshError(
                f"a spline needs control points in the plane and a degree of 1 to {LARGEST_DEGREE}"
            )
        if len(points) <= degree or knot.shape != (len(points) + degree + 1,):
            raise MeshError(
                f"a spline of degree {degree} with {len(points)} control points cannot have"
                f" {knot.size} knots"
            )
        weight = None if weights is None else np.array(weights, np.float64)
        if weight is not None and (weight.shape != (len(points),) or not (weight > 0.0).all()):
            raise MeshError("the weights of a spline must be positive, one for each control point")
        if not (np.isfinite(knot).all() and (np.diff(knot) >= 0.0).all()):
            raise MeshError("the knots of a spline must not decrease")
        if not knot[len(points)] > knot[degree]:
            raise MeshError("the knots of a spline leave nothing of it")
        if degree == 1 and weight is None:
            return cls.polyline(points)
        spans = evened(bezier_spans.spline_spans(homogeneous(points, weight), knot, degree))
        data = {"degree": degree, "control": points, "knots": knot, "weights": weight}
        return cls("spline", data, [span for span in spans if _extent(span) > 0.0])

    @classmethod
    def through(cls, points: ArrayLike, closed: bool = False) -> Curve:
        """The cubic spline that interpolates points (n, 2), C2, by cumulative chord length.

        closed: join the last point to the first one smoothly (the first one is not repeated).
        """
        from scipy.interpolate import CubicSpline  # here: it takes a quarter of a second

        line = without_repeats(np.array(points, np.float64).reshape(-1, 2))
        if closed and len(line) > 2 and (line[0] != line[-1]).any():
            line = np.vstack([line, line[:1]])
        if len(line) < 3:
            return cls.polyline(line)
        t = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        spline = CubicSpline(t, line, bc_type="periodic" if closed else "not-a-knot")
        slope = spline(t, 1)
        step = np.diff(t)[:, None] / 3.0
        # each interval as a cubic Bezier curve of ends and slopes; a knot of multiplicity 3
        inner = np.stack([line[:-1] + step * slope[:-1], line[1:] - step * slope[1:]], axis=1)
        control = np.concatenate(
            [np.concatenate([line[:-1, None], inner], 1).reshape(-1, 2), line[-1:]]
        )
        knots = np.concatenate([t[:1], np.repeat(t, 3), t[-1:]])
        return cls.spline(control, knots, 3)

    # What it is

    @cached_property
    def flat(self) -> Curves:
        """The curve as arrays for compiled kernels; curve 0."""
        return Curves(
            control=np.concatenate(self.spans),
            first_control=np.cumsum([0, *map(len, self.spans)]),
            start=self.stops[:-1].copy(),
            stop=self.stops[1:].copy(),
            first_span=np.array([0, len(self.spans)]),
            closed=np.array([self.closed]),
        )

    @property
    def closed(self) -> bool:
        """Whether it ends exactly where it begins."""
        return bool((self.start == self.end).all())

    @cached_property
    def start(self) -> Array:
        """(2,) its first point, read-only."""
        return _point_of(self.spans[0][0])

    @cached_property
    def end(self) -> Array:
        """(2,) its last point, read-only."""
        return _point_of(self.spans[-1][-1])

    @cached_property
    def stops(self) -> Array:
        """(s + 1,) parameters where the spans begin and end, read-only."""
        found = np.zeros(len(self.spans) + 1)
        np.cumsum(self._lengths, out=found[1:])
        found.flags.writeable = False
        return found

    @cached_property
    def length(self) -> float:
        """Its arc length, the largest parameter."""
        return float(self.stops[-1])

    @cached_property
    def box(self) -> Array:
        """(2, 2) lower and upper corner of a box around the control points: not always tight."""
        control = np.concatenate(self.spans)
        points = control[:, :2] / control[:, 3:]
        return np.array([points.min(axis=0), points.max(axis=0)])

    @cached_property
    def turning(self) -> float:
        """Radians by which the tangent turns in all, without sign; kinks count."""
        if self.kind == "line":
            return 0.0
        angles = np.concatenate([_angles(span_points(span, _DENSE)[1]) for span in self.spans])
        return float(np.abs(np.angle(np.exp(1j * np.diff(angles)))).sum())

    @cached_property
    def straight(self) -> bool:
        """Whether it runs along its chord, within 1e-12 of it."""
        if self.kind == "line":
            return True
        chord = self.end - self.start
        size = float(np.hypot(*chord))
        if size < (1.0 - 1e-9) * self.length:
            return False
        points = np.concatenate([span_points(span, _DENSE)[0][:, :2] for span in self.spans])
        off = (points - self.start) @ np.array([-chord[1], chord[0]]) / size
        return bool(np.abs(off).max() <= STRAIGHT * size)

    @cached_property
    def kinks(self) -> Array:
        """(k,) parameters inside at which the tangent jumps."""
        come = np.array([span_points(span, np.ones(1))[1][0] for span in self.spans[:-1]])
        go = np.array([span_points(span, np.zeros(1))[1][0] for span in self.spans[1:]])
        if not len(come):
            return np.zeros(0)
        turn = np.abs(np.angle(np.exp(1j * (_angles(go) - _angles(come)))))
        return self.stops[1:-1][turn > KINK]

    def point(self, t: ArrayLike) -> Array:
        """Points (n, 2), or (2,), at parameters t (n,), or one."""
        return self._evaluated(place_all, t)

    def tangent(self, t: ArrayLike) -> Array:
        """Unit tangents (n, 2), or (2,), at parameters t (n,), or one."""
        found = self._evaluated(tangents, t)
        return found / np.linalg.norm(found, axis=-1, keepdims=True)

    def _evaluated(self, kernel: Any, t: ArrayLike) -> Array:
        at = np.asarray(t, np.float64)
        rows = kernel(self.flat, np.zeros(at.size, np.int64), np.ascontiguousarray(at.ravel()))
        found: Array = rows[:, :2].reshape(*at.shape, 2)
        return found

    def curvature(self, t: ArrayLike) -> Array:
        """Signed curvature (n,), 1 / length, at parameters t (n,); positive to the left.

        Turning of the tangent over a step of 1e-5 of the length, to about five digits.
        """
        at = np.atleast_1d(np.asarray(t, np.float64))
        step = 1e-5 * self.length
        low, high = np.clip(at - step, 0.0, None), np.clip(at + step, None, self.length)
        turn = np.angle(np.exp(1j * (_angles(self.tangent(high)) - _angles(self.tangent(low)))))
        way = np.linalg.norm(self.point(high) - self.point(low), axis=1)
        found: Array = turn / way
        return found if np.ndim(t) else found[0]

    def project(self, points: ArrayLike) -> tuple[Array, Array]:
        """Parameters (n,) of the nearest points to points (n, 2), and the distances (n,)."""
        goal = np.array(points, np.float64).reshape(-1, 2)
        t = nearest_parameters(self.flat, 0, np.column_stack([goal, np.zeros(len(goal))]))
        return t, np.hypot(*(self.point(t) - goal).T)

    def area_about(self, origin: ArrayLike = (0.0, 0.0)) -> float:
        """Half the integral of x dy - y dx along it, with coordinates from `origin` (2,).

        Summed over a closed chain with one origin this is the area enclosed, positive if it turns
        counter-clockwise. Gauss-Legendre quadrature of order 24 on each span.
        """
        start, end = self.start, self.end
        (x, y), (dx, dy) = start - np.asarray(origin, np.float64), end - start
        return self._own_area + 0.5 * float(x * dy - y * dx)

    @cached_property
    def _own_area(self) -> float:
        """:meth:`area_about` its start; of arcs, unless all but straight, in closed form."""
        if self.kind == "line":
            return 0.0
        if self.kind == "arc" and abs(self.data["sweep"]) > _FLAT:
            (x, y), (dx, dy) = self.data["centre"] - self.start, self.end - self.start
            return 0.5 * float(self.data["radius"] ** 2 * self.data["sweep"] + x * dy - y * dx)
        total = 0.0
        for degree in {len(span) - 1 for span in self.spans}:
            spans = np.stack([span for span in self.spans if len(span) == degree + 1])
            value, slope = _at_nodes(spans)
            weight = value[..., 2:]
            point = value[..., :2] / weight
            along = (slope[..., :2] - point * slope[..., 2:]) / weight
            x, y = np.moveaxis(point - self.start, -1, 0)
            total += 0.5 * float(((x * along[..., 1] - y * along[..., 0]) @ _WEIGHTS).sum())
        return total

    @property
    def area(self) -> float:
        """:meth:`area_about` the origin of the coordinates."""
        return self.area_about()

    def sampled(self, turn_degrees: float = 5.0, tolerance: float = 0.0) -> Array:
        """(n, 2) points along it, both ends among them: a polyline for pictures and estimates.

        It turns by `turn_degrees` at each point, at most, and where `tolerance` is above 0 it stays
        within that distance instead.
        """
        rows = [self.start[None]]
        for span in self.spans:
            count = 1
            if len(span) > 2:
                point, slope = span_points(span, _DENSE)
                turn = float(np.abs(np.angle(np.exp(1j * np.diff(_angles(slope))))).sum())
                if tolerance > 0.0:
                    # the sagitta of an arc of length l that turns by a is l a / 8
                    way = float(np.linalg.norm(np.diff(point, axis=0), axis=1).sum())
                    count = math.ceil(math.sqrt(max(turn * way / 8.0 / tolerance, 1.0)))
                else:
                    count = math.ceil(math.degrees(turn) / turn_degrees - 1e-9)
            u = np.linspace(0.0, 1.0, min(max(count, 1), 4096) + 1)[1:]
            rows.append(span_points(span, u)[0][:, :2])
        return np.concatenate(rows)

    # Others made of it

    @cached_property
    def reversed(self) -> Curve:
        """The same, run through from its end to its start."""
        data = dict(self.data)
        if "sweep" in data:
            data.update(start=data["start"] + data["sweep"], sweep=-data["sweep"])
        elif "points" in data:
            data["points"] = data["points"][::-1].copy()
        elif "knots" in data:
            knots, weights = data["knots"], data["weights"]
            data["control"] = data["control"][::-1].copy()
            data["knots"] = (knots[0] + knots[-1]) - knots[::-1]
            data["weights"] = None if weights is None else weights[::-1].copy()
        spans = [span[::-1].copy() for span in reversed(self.spans)]
        found = Curve(self.kind, data, spans, self._lengths[::-1])
        known = self.__dict__
        found.__dict__.update({name: known[name] for name in ("box", "straight") if name in known})
        if "_own_area" in known:
            found.__dict__["_own_area"] = -self._own_area
        return found

    def split(self, t: ArrayLike) -> tuple[Curve, ...]:
        """Its parts between parameters t (n,), ascending, strictly between 0 and the length.

        Each part begins exactly where the one before it ends.
        """
        cuts = np.atleast_1d(np.asarray(t, np.float64)).tolist()
        stops = self.stops
        groups: list[list[Array]] = [[]]
        for span, start, stop in zip(self.spans, stops[:-1], stops[1:], strict=True):
            left, begin = span, start
            while cuts and cuts[0] < stop:
                cut = cuts.pop(0)
                if cut > begin:
                    head, left = halves(left, (cut - begin) / (stop - begin))
                    groups[-1].append(head)
                    begin = cut
                groups.append([])
            groups[-1].append(left)
        return tuple(self._like(spans) for spans in groups)

    def part(self, low: float, high: float) -> Curve:
        """The part from parameter `low` to `high`, 0 <= low < high <= length."""
        inner = [t for t in (low, high) if 0.0 < t < self.length]
        if not inner:
            return self
        return self.split(inner)[1 if low > 0.0 else 0]

    def transformed(self, matrix: ArrayLike) -> Curve:
        """Its image under the affine map of a (2, 3) matrix, which must not be singular."""
        affine = np.array(matrix, np.float64)
        return self._like([_mapped(span, affine) for span in self.spans], affine)

    def moved_ends(self, start: ArrayLike, end: ArrayLike) -> Curve:
        """Nearly the same curve with exactly these ends (2,), to close small gaps.

        By the similarity that takes the old ends to the new ones: arcs stay arcs. A closed curve
        is moved to `start`.
        """
        a, b = np.array(start, np.float64), np.array(end, np.float64)
        if (a == self.start).all() and (b == self.end).all():
            return self
        if self.kind == "line":
            return Curve.line(a, b)
        old, new = self.end - self.start, b - a
        if self.closed or not new.any():
            turn = np.eye(2)
        elif self.kind == "arc":
            return Curve.arc_by_bulge(a, b, math.tan(0.25 * self.data["sweep"]))
        else:
            cosine = np.array([old @ new, old[0] * new[1] - old[1] * new[0]]) / (old @ old)
            turn = np.array([[cosine[0], -cosine[1]], [cosine[1], cosine[0]]])
        found = self.transformed(np.column_stack([turn, a - turn @ self.start]))
        first, last = found.spans[0].copy(), found.spans[-1].copy()
        if len(found.spans) == 1:
            last = first
        first[0, :2], last[-1, :2] = a * first[0, 3], b * last[-1, 3]
        return Curve(found.kind, found.data, [first, *found.spans[1:-1], last][-len(found.spans) :])

    def _like(self, spans: list[Array], affine: Array | None = None) -> Curve:
        """A curve of these spans, parts or images of its own, with the data that fits them."""
        if self.kind in ("line", "polyline"):
            return Curve.polyline(
                [span[0, :2] / span[0, 3] for span in spans]
                + [spans[-1][-1, :2] / spans[-1][-1, 3]]
            )
        if self.kind == "spline":
            if affine is None:
                return Curve("spline", spline_of_spans(spans), spans)
            data = dict(self.data, control=self.data["control"] @ affine[:, :2].T + affine[:, 2])
            return Curve("spline", data, spans)
        axes = self.data.get("radius", 1.0) * np.eye(2)
        if self.kind == "ellipse":
            axes = np.array([self.data["major"], self.data["minor"]])
        if affine is None:
            return Curve(self.kind, part_of_conic(axes, self.data, spans), spans)
        kind, data = image_of_conic(axes, self.data, affine)
        return Curve(kind, data, spans if kind == "arc" else evened(spans))

    def to_json(self) -> dict[str, Any]:
        """The piece as an object of a domain file; see :mod:`.curve_json`."""
        if self.kind == "ellipse" and abs(self.data["sweep"]) < _FLAT:
            return curve_json.to_json("spline", spline_of_spans(self.spans))
        if self.kind == "arc" and abs(self.data["sweep"]) < _FLAT:
            bulge = math.tan(0.25 * self.data["sweep"])
            return {"arc": {"from": self.start.tolist(), "to": self.end.tolist(), "bulge": bulge}}
        return curve_json.to_json(self.kind, self.data)

    @classmethod
    def from_json(cls, content: Mapping[str, Any]) -> Curve:
        """The piece of :meth:`to_json`; MeshError, one sentence, if it is none."""
        kind, data = curve_json.from_json(content)
        if kind == "line":
            return cls.line(*data["points"])
        if kind == "polyline":
            return cls.polyline(data["points"])
        if kind == "spline":
            return cls.spline(**data)
        if "bulge" in data:
            return cls.arc_by_bulge(data["points"][0], data["points"][1], data["bulge"])
        return cls.arc(**data) if kind == "arc" else cls.ellipse(**data)

    def __repr__(self) -> str:
        """Kind, ends and length."""
        (x, y), (z, w) = self.start, self.end
        return f"<Curve {self.kind} ({x:.6g}, {y:.6g}) - ({z:.6g}, {w:.6g}), {self.length:.6g}>"


def without_repeats(points: Array) -> Array:
    """Points (n, 2) without those that are the same as the one before."""
    keep = np.ones(len(points), dtype=bool)
    keep[1:] = (np.diff(points, axis=0) != 0).any(axis=1)
    return points[keep]


def whole_turn(sweep: float) -> float:
    """The sweep in radians, exactly one turn if it is that or more."""
    sweep = float(sweep)
    if abs(sweep) >= 2.0 * math.pi - 1e-9:
        return math.copysign(2.0 * math.pi, sweep)
    return sweep


def polygon_area(chain: Sequence[Curve]) -> float:
    """Signed area inside a closed chain of curves, about its first point."""
    origin = chain[0].start
    return sum(curve.area_about(origin) for curve in chain)


def _at_nodes(spans: Array) -> tuple[Array, Array]:
    """Homogeneous (x, y, w) at the Gauss nodes of spans (s, d + 1, 4), and derivatives by u:
    (s, 24, 3) each.
    """
    u = _GAUSS[:, None]
    level = [row[:, None, [0, 1, 3]] for row in np.moveaxis(spans, 1, 0)]
    while len(level) > 2:
        level = [(1.0 - u) * a + u * b for a, b in pairwise(level)]
    slope = (spans.shape[1] - 1) * (level[1] - level[0])
    return (1.0 - u) * level[0] + u * level[1], np.broadcast_to(slope, (len(spans), len(u), 3))


def _point_of(control: Array) -> Array:
    """The place (2,) of a homogeneous control point, read-only."""
    place: Array = control[:2] / control[3]
    place.flags.writeable = False
    return place


def _distances(points: Array) -> Array:
    """(n - 1,) distances between each two points of (n, 2) that follow each other."""
    found: Array = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return found


def _extent(span: Array) -> float:
    points = span[:, :2] / span[:, 3:]
    return float(np.ptp(points, axis=0).max())


def _angles(vectors: Array) -> Array:
    found: Array = np.arctan2(vectors[:, 1], vectors[:, 0])
    return found


def _mapped(span: Array, affine: Array) -> Array:
    image = span.copy()
    image[:, :2] = span[:, :2] @ affine[:, :2].T + span[:, 3:] * affine[:, 2]
    return image
