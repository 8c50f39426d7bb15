"""Points in polygons, against shapely."""

import numpy as np
import shapely

from meshwright_core.geometry import polygons

SQUARE = np.array([(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)])


def test_points_against_a_concave_polygon(monkeypatch):
    rng = np.random.default_rng(4)
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, 40))
    polygon = (rng.uniform(0.3, 1.0, 40) * (np.cos(angles), np.sin(angles))).T
    points = rng.uniform(-1.1, 1.1, (500, 2))
    expected = shapely.contains_xy(shapely.Polygon(polygon), points[:, 0], points[:, 1])
    assert 50 < expected.sum() < 450
    assert (polygons.points_inside(points, polygon) == expected).all()
    assert (polygons.points_inside(points, polygon[::-1]) == expected).all()
    monkeypatch.setattr(polygons, "BLOCK", 1000)
    assert (polygons.points_inside(points, polygon) == expected).all()


def test_a_point_against_many_polygons():
    many = np.stack([SQUARE, SQUARE + 3.0, SQUARE[::-1]])
    assert polygons.contains(many, 1.0, 0.5).tolist() == [True, False, True]
    assert polygons.contains(SQUARE, 5.0, 0.0) == np.False_


def test_a_polygon_that_crosses_itself_is_even_odd():
    bow = np.array([(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)])
    points = np.array([(0.25, 1.0), (1.0, 1.5), (1.75, 1.0)])
    assert polygons.points_inside(points, bow).tolist() == [True, False, True]
