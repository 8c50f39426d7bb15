"""Curves of drawings: evaluation, projection, parts, images, and their JSON."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import BSpline

from meshwright_core.curves.curve import Curve, polygon_area
from meshwright_core.errors import MeshError

RATIONAL = Curve.spline(
    [[0, 0], [1, 2], [3, 2.5], [4, 0], [6, -1], [7, 1]],
    [0, 0, 0, 0, 0.3, 0.7, 1, 1, 1, 1],
    3,
    [1, 2, 0.5, 1, 3, 1],
)
CURVES = {
    "line": Curve.line([1, 2], [4, 6]),
    "polyline": Curve.polyline([[0, 0], [2, 0], [2, 1], [5, 1]]),
    "arc": Curve.arc([2, 1], 3, 0.3, -4.0),
    "bulge": Curve.arc_by_bulge([0, 0], [3, 1], 1.7),
    "flat arc": Curve.arc_by_bulge([0, 0], [1, 0], 1e-9),
    "ellipse": Curve.ellipse([1, 2], [5, 1], [-0.2, 1], 0.5, 5.0),
    "spline": RATIONAL,
    "interpolating": Curve.through([[0, 0], [1, 1], [2, 0], [3, 1], [5, 0]]),
    "quadratic": Curve.bezier([[0, 0], [1, 2], [3, 0]]),
}


@pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES.keys())
def test_every_curve_is_consistent(curve: Curve) -> None:
    t = np.linspace(0, curve.length, 200)
    points = curve.point(t)
    assert (points[0] == curve.start).all() and (points[-1] == curve.end).all()
    size = np.ptp(points, axis=0).max()
    # the parameter is close to the arc length, and the tangent is the direction of the chord
    steps = np.hypot(*np.diff(curve.sampled(turn_degrees=0.5), axis=0).T).sum()
    assert steps == pytest.approx(curve.length, rel=1e-4)
    _, away = curve.project(points)
    assert away.max() <= 1e-14 * size
    off = points + 1e-3 * size * np.array([0.3, -0.7])
    near, distance = curve.project(off)
    assert (distance <= np.hypot(*(off - points).T) * (1 + 1e-12)).all()
    foot = curve.point(near)
    inner = (near > 1e-9) & (near < curve.length * (1 - 1e-9))
    if not len(curve.kinks):
        along = ((off - foot) * curve.tangent(near)).sum(axis=1)
        assert np.abs(along[inner]).max() <= 1e-12 * size


@pytest.mark.parametrize("curve", CURVES.values(), ids=CURVES.keys())
def test_parts_images_and_reverse_lie_on_the_curve(curve: Curve) -> None:
    size = np.ptp(curve.box, axis=0).max()
    parts = curve.split([0.2 * curve.length, 0.55 * curve.length])
    assert sum(part.length for part in parts) == pytest.approx(curve.length, rel=1e-9)
    for part in parts:
        assert part.kind in (curve.kind, "line")
        assert curve.project(part.sampled(1.0))[1].max() <= 1e-13 * size
        again = Curve.from_json(part.to_json())
        assert curve.project(again.sampled(1.0))[1].max() <= 1e-12 * size
    for a, b in pairwise(parts):
        assert (a.end == b.start).all()
    back = curve.reversed
    assert (back.start == curve.end).all() and (back.end == curve.start).all()
    assert back.area == pytest.approx(-curve.area, abs=1e-12 * size**2)
    again = Curve.from_json(back.to_json())
    assert np.abs(again.point([0, again.length]) - [back.start, back.end]).max() <= 1e-12 * size
    matrix = np.array([[0.3, -1.2, 5], [0.9, 0.4, -3]])
    image = curve.transformed(matrix)
    mapped = curve.sampled(1.0) @ matrix[:, :2].T + matrix[:, 2]
    assert image.project(mapped)[1].max() <= 1e-12 * size
    assert Curve.from_json(image.to_json()).project(mapped)[1].max() <= 1e-12 * size
    moved = curve.moved_ends(curve.start + 1e-7, curve.end - 2e-7)
    assert (moved.start == curve.start + 1e-7).all() and (moved.end == curve.end - 2e-7).all()
    assert moved.kind == curve.kind
    assert curve.project(moved.sampled(1.0))[1].max() <= 1e-5


def test_a_circle_is_a_circle() -> None:
    circle = Curve.arc([1, 2], 3, 0.7, 2 * math.pi)
    assert circle.closed and circle.length == pytest.approx(6 * math.pi, rel=1e-15)
    assert circle.area == pytest.approx(9 * math.pi, rel=1e-14)
    assert circle.turning == pytest.approx(2 * math.pi, rel=1e-12)
    points = circle.point(np.linspace(0, circle.length, 1000))
    assert np.abs(np.hypot(*(points - [1, 2]).T) - 3).max() < 2e-15
    assert circle.curvature(np.array([1.0, 5.0])) == pytest.approx([1 / 3, 1 / 3], rel=1e-4)
    assert not len(circle.kinks)


def test_bulges_agree_with_centre_and_radius() -> None:
    half = Curve.arc_by_bulge([0, 0], [2, 0], 1.0)
    assert half.data["centre"] == pytest.approx([1, 0]) and half.data["radius"] == 1.0
    assert half.point(half.length / 2) == pytest.approx([1, -1])
    over = Curve.arc_through([0, 0], [1, 1], [2, 0])
    assert over.point(over.length / 2) == pytest.approx([1, 1])
    assert over.data["sweep"] == pytest.approx(-math.pi)
    big = Curve.arc_through([1, 0], [-1, 0], [0, 1])
    assert big.data["centre"] == pytest.approx([0, 0], abs=1e-15)
    assert big.data["sweep"] == pytest.approx(-1.5 * math.pi)
    flat = CURVES["flat arc"]
    assert flat.point(flat.length / 2)[1] == pytest.approx(-5e-10, rel=1e-9)
    assert Curve.arc_through([0, 0], [1, 0], [2, 0]).kind == "line"
    for end in ([0, 0], [2, 0]):  # as some programs write a segment
        assert Curve.arc_through([0, 0], end, [2, 0]).kind == "line"
    with pytest.raises(MeshError, match="beyond them"):
        Curve.arc_through([0, 0], [3, 0], [2, 0])


def test_splines_agree_with_scipy() -> None:
    data = RATIONAL.data
    weights = np.asarray(data["weights"])[:, None]
    curve = BSpline(data["knots"], np.hstack([data["control"] * weights, weights]), 3)
    values = curve(np.linspace(0, 1, 301)[:-1])
    points = values[:, :2] / values[:, 2:]
    assert RATIONAL.project(points)[1].max() < 1e-14
    unclamped = Curve.spline(RATIONAL.data["control"], np.arange(10.0), 3)
    plain = BSpline(np.arange(10.0), RATIONAL.data["control"], 3)
    assert unclamped.project(plain(np.linspace(3, 6, 50)))[1].max() < 1e-14
    assert unclamped.start == pytest.approx(plain(3.0), abs=1e-14)


def test_interpolating_splines_pass_through_their_points() -> None:
    points = np.array([[0, 0], [2, 1], [3, 3], [1, 4], [-1, 2]], float)
    for closed in (False, True):
        curve = Curve.through(points, closed)
        assert curve.closed == closed
        assert curve.project(points)[1].max() < 1e-14
        assert not len(curve.kinks)


def test_area_of_a_closed_chain() -> None:
    chain = [
        Curve.line([0, 0], [4, 0]),
        Curve.arc_by_bulge([4, 0], [4, 2], 1.0),
        Curve.line([4, 2], [0, 2]),
        Curve.arc_by_bulge([0, 2], [0, 0], -1.0),
    ]
    assert polygon_area(chain) == pytest.approx(8.0, rel=1e-15)
    far = [curve.transformed([[1, 0, 1e6], [0, 1, -1e6]]) for curve in chain]
    assert polygon_area(far) == pytest.approx(8.0, rel=1e-9)


def test_kinks_and_straightness() -> None:
    assert CURVES["polyline"].kinks == pytest.approx([2.0, 3.0])
    assert CURVES["line"].straight and not CURVES["quadratic"].straight
    assert Curve.bezier([[0, 0], [1, 1], [3, 3]]).straight
    assert not Curve.bezier([[0, 0], [3, 3], [1, 1]]).straight
    assert not CURVES["flat arc"].straight
    assert Curve.arc_by_bulge([0, 0], [1, 0], 1e-14).straight


@pytest.mark.parametrize(
    "make",
    [
        lambda: Curve.line([1, 1], [1, 1]),
        lambda: Curve.arc([0, 0], 0, 0, 1),
        lambda: Curve.arc([0, 0], 1, 0, 0),
        lambda: Curve.arc([0, math.nan], 1, 0, 1),
        lambda: Curve.ellipse([0, 0], [1, 1], [2, 2], 0, 1),
        lambda: Curve.spline([[0, 0], [1, 1]], [0, 0, 1], 1),
        lambda: Curve.spline([[0, 0], [1, 1], [2, 0]], [0, 0, 0, 1, 1, 0.5], 2),
        lambda: Curve.spline([[0, 0], [1, 1], [2, 0]], [0, 0, 0, 1, 1, 1], 2, [1, 0, 1]),
        lambda: Curve.bezier([[0, 0], [0, 0], [0, 0]]),
        lambda: Curve.from_json({"arc": {"centre": [0, 0], "radius": "1", "sweep": 5}}),
        lambda: Curve.from_json({"line": [[0, 0], [1, 1], [2, 2]]}),
        lambda: Curve.from_json({"circle": 3}),
        lambda: Curve.from_json([1, 2]),
    ],
)
def test_wrong_numbers_are_one_sentence(make) -> None:
    with pytest.raises(MeshError) as caught:
        make()
    assert "\n" not in str(caught.value)
