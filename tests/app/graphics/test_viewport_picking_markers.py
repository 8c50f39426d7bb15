"""Viewport, picking and markers."""

import numpy as np
import pytest

from meshwright.graphics.markers import label, markers
from meshwright.graphics.picking import Picker
from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh


def test_viewport_maps_points_to_pixels_and_back():
    view = Viewport(centre=(3.0, -2.0), pixels=37.0, size=(640, 480))
    assert view.to_plane(*view.to_screen(np.array([4.0, 1.5]))) == pytest.approx((4.0, 1.5))
    assert view.to_screen(np.array([3.0, -2.0])).tolist() == [320.0, 240.0]
    closer = view.zoomed(2.5, 100, 50)
    assert closer.to_plane(100, 50) == pytest.approx(view.to_plane(100, 50))
    assert view.panned(10, -5).to_screen(np.array([3.0, -2.0])).tolist() == [330.0, 235.0]
    corners = np.array([[0.0, 0.0], [10.0, 1.0]])
    seen = view.fitted(corners, margin=40).to_screen(corners)
    assert seen[:, 0].tolist() == pytest.approx([40.0, 600.0])


@pytest.mark.parametrize("points", [np.empty((0, 2)), np.zeros((1, 2)), np.full((3, 2), 1e9)])
def test_viewport_of_no_points_or_one_point(points):
    view = Viewport().fitted(points)
    assert np.isfinite([*view.centre, view.pixels]).all()


def test_picking_agrees_with_every_element(star):
    picker = Picker(star)
    rng = np.random.default_rng(1)
    for row, corners in enumerate(star.points[star.elements()][:, :, :2]):
        weights = rng.dirichlet(np.ones(4) * 4)
        x, y = weights @ corners
        if picker.element_row(x, y) != row:  # a dented quad need not hold its mixtures
            continue
        h = picker.halfedge(x, y)
        assert h // 4 == star.element_ids()[row]
    middle = star.points[star.elements()[3]].mean(axis=0)
    assert picker.element_row(middle[0], middle[1]) == 3
    assert picker.halfedge(50.0, 50.0) == -1
    assert picker.vertex(*star.points[7][:2] + 1e-6, reach=1e-3) == 7
    assert picker.vertex(50.0, 50.0, reach=1.0) == -1


def test_picking_a_long_thin_element_among_small_ones():
    columns = np.linspace(0, 1, 200)
    points = [(x, y) for y in (0.0, 0.005) for x in columns] + [(0.0, 8.0), (1.0, 8.0)]
    quads = [(i, i + 1, 201 + i, 200 + i) for i in range(199)]
    thin = HalfEdgeMesh.from_elements(
        np.array(points), np.array([*quads[:1], (200, 201, 401, 400)])
    )
    assert Picker(thin).element_row(0.003, 0.02) == 1


def test_markers(star):
    marks = markers(star)
    assert np.abs(marks.delta).sum() == star.score
    radii = marks.radii(Viewport(pixels=1000.0))
    assert radii[np.argmax(np.abs(marks.delta))] == radii.max()
    assert (marks.radii(Viewport(pixels=5.0)) < radii).all()
    assert len(marks.loops) == 1
    assert (marks.loops[0][0] == marks.loops[0][-1]).all()
    assert [label(2), label(-1), label(0)] == ["+2", "\u22121", "0"]
