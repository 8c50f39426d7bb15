"""Arcs and splines fitted to polylines."""

import math
from itertools import pairwise

import numpy as np
import pytest

from meshwright_core.curves.curve import Curve
from meshwright_core.curves.fitting import fit_arcs, fit_splines
from meshwright_core.domains.airfoils import naca4
from meshwright_core.errors import MeshError

SLOT = [
    Curve.line((0, 0), (60, 0)),
    Curve.arc((60, 20), 20, -0.5 * math.pi, math.pi),
    Curve.line((60, 40), (0, 40)),
    Curve.arc((0, 20), 20, 0.5 * math.pi, math.pi),
]


def flattened(curves, step=15.0):
    return np.vstack([*(curve.sampled(step)[:-1] for curve in curves), curves[0].start])


def farthest(curves, points):
    return max(min(float(c.project(p)[1][0]) for c in curves) for p in points)


def angles_between(curves):
    return [
        math.degrees(math.acos(np.clip(a.tangent(a.length) @ b.tangent(0.0), -1, 1)))
        for a, b in pairwise(curves)
    ]


def test_arcs_and_segments_of_a_slot_are_found():
    points = flattened(SLOT)
    found = fit_arcs(points, 1e-6)
    assert sorted(curve.kind for curve in found) == ["arc", "arc", "line", "line"]
    assert all((a.end == b.start).all() for a, b in pairwise([*found, found[0]]))
    for curve in found:
        if curve.kind == "arc":
            assert curve.data["radius"] == pytest.approx(20)
    assert max(angles_between([*found, found[0]])) < 1e-5


@pytest.mark.parametrize("turned", [False, True])
def test_circle(turned):
    points = Curve.arc((3, 4), 5, 0.3, -2 * math.pi if turned else 2 * math.pi).sampled(15)
    (circle,) = fit_arcs(points, 1e-9)
    assert circle.kind == "arc" and circle.closed
    assert circle.data["radius"] == pytest.approx(5)
    assert circle.data["sweep"] == pytest.approx(-2 * math.pi if turned else 2 * math.pi)


@pytest.mark.parametrize("sides", [3, 4, 5, 8])
def test_polygons_stay_polygons(sides):
    angle = 2 * math.pi * np.arange(sides + 1) / sides
    points = np.column_stack([np.cos(angle), np.sin(angle)])
    points[-1] = points[0]
    found = fit_arcs(points, 1e-3)
    assert [curve.kind for curve in found] == ["line"] * sides


def test_collinear_points_make_one_segment():
    points = np.column_stack([np.linspace(0, 1, 11), np.zeros(11)])
    found = fit_arcs(np.vstack([points, [[1, 1]]]), 1e-9)
    assert [curve.length for curve in found] == [1, 1]


def test_arcs_keep_the_tolerance_on_a_spline():
    curve = Curve.through([[0, 0], [1, 1], [2, 0.3], [3, 1.2], [5, 0]])
    points = curve.sampled(1.0)
    for tolerance in (1e-2, 1e-3):
        found = fit_arcs(points, tolerance)
        assert farthest(found, points) <= tolerance * (1 + 1e-9)
        assert len(found) < len(points) / 4
        assert (found[0].start == points[0]).all() and (found[-1].end == points[-1]).all()


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-5])
def test_spline_of_an_airfoil(tolerance):
    wing = naca4("2412", 60)
    points = np.vstack([wing, wing[:1]])
    (spline,) = fit_splines(points, None, tolerance)
    assert spline.kind == "spline"
    assert (spline.start == points[0]).all() and (spline.end == points[-1]).all()
    assert spline.project(points)[1].max() <= tolerance
    assert len(spline.data["control"]) < 60


def test_splines_between_corners():
    points = flattened(SLOT, 5.0)
    corners = np.zeros(len(points), bool)
    corners[[0, 1, 37, 38]] = True
    found = fit_splines(points, corners, 1e-4)
    assert [curve.kind for curve in found] == ["line", "spline", "line", "spline"]
    assert farthest(found, points) <= 1e-4
    assert all((a.end == b.start).all() for a, b in pairwise([*found, found[0]]))


def test_closed_smooth_spline():
    angle = np.linspace(0, 2 * math.pi, 81)
    radius = 1 + 0.2 * np.cos(3 * angle)
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    points[-1] = points[0]
    (spline,) = fit_splines(points, None, 1e-4)
    assert spline.closed
    assert spline.project(points)[1].max() <= 1e-4
    assert spline.tangent(0.0) @ spline.tangent(spline.length) == pytest.approx(1, abs=1e-8)


def test_short_polylines():
    assert fit_splines([[0, 0], [1, 0]], None, 1e-3)[0].kind == "line"
    assert fit_splines([[0, 0], [1, 0.1], [2, 0]], None, 1e-3)[0].kind == "spline"
    triangle = fit_splines([[0, 0], [1, 0], [0, 1], [0, 0]], None, 1e-3)
    assert [curve.kind for curve in triangle] == ["line"] * 3


@pytest.mark.parametrize("function", [fit_arcs, lambda p, t: fit_splines(p, None, t)])
def test_bad_input(function):
    for points, tolerance in (([[0, 0]], 1), ([[0, 0], [0, 0]], 1), ([[0, 0], [1, 0]], 0.0)):
        with pytest.raises(MeshError):
            function(points, tolerance)
    with pytest.raises(MeshError, match="as many flags"):
        fit_splines([[0, 0], [1, 0]], [True], 1.0)
