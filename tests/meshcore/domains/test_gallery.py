"""The gallery and the benchmark's random polygons."""

import numpy as np
import pytest

from meshwright_core import MeshError
from meshwright_core.domains import gallery as shapes

IN_THE_PAPER = {
    "l-shape",
    "star",
    "single-notch",
    "double-notch",
    "disc-with-square-hole",
    "square-with-hole",
}


def test_gallery_has_the_papers_shapes_and_more():
    gallery = shapes.gallery()
    assert gallery.keys() >= IN_THE_PAPER
    assert len(gallery) >= len(IN_THE_PAPER) + 6
    assert tuple(gallery) == shapes.names()
    assert all(domain.name == name for name, domain in gallery.items())


@pytest.mark.parametrize("name", shapes.names())
def test_shapes_are_of_order_one(name):
    domain = shapes.shape(name)
    assert 1.5 < domain.diameter < 2.5
    assert 1.0 < domain.area < 3.0


def test_star_has_five_tips():
    star = shapes.shape("star")
    radius = np.linalg.norm(star.outline, axis=1)
    assert (radius > 0.9).sum() == 5
    assert star.corners.all()
    assert len(star.outline) == 10


def test_curved_sides_have_no_corners():
    disc = shapes.shape("disc-with-square-hole")
    assert not disc.corners.any()
    assert disc.hole_corners[0].all()
    assert shapes.shape("airfoil").hole_corners[0].sum() == 1


def test_unknown_shape_names_close_matches():
    with pytest.raises(MeshError, match="did you mean l-shape"):
        shapes.shape("L_Shape")
    with pytest.raises(MeshError, match="there are star, "):
        shapes.shape("xyzzy")


@pytest.mark.parametrize(("code", "thickness"), [("0012", 0.12), ("2415", 0.15), ("4421", 0.21)])
def test_airfoil_is_as_thick_as_its_code_says(code, thickness):
    wing = shapes.naca4(code, pieces=200)
    upper, lower = wing[:201], np.vstack([wing[200:], wing[:1]])
    x = np.linspace(0.05, 0.95, 100)
    gap = np.interp(x, upper[::-1, 0], upper[::-1, 1]) - np.interp(x, lower[:, 0], lower[:, 1])
    assert gap.max() == pytest.approx(thickness, rel=0.01)
    assert wing[0] == pytest.approx([1, 0])


@pytest.mark.parametrize("code", ["12", "0000", "12a5", "²415"])
def test_bad_airfoil_code(code):
    with pytest.raises(MeshError, match="four digits"):
        shapes.naca4(code)


def test_random_polygon_follows_the_benchmark():
    polygon = shapes.random_polygon(12, np.random.default_rng(5))
    radius = 0.5 + 0.5 * np.random.default_rng(5).random(12)
    angle = 2 * np.pi * np.arange(12) / 12
    expected = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    assert np.array_equal(polygon.outline, expected)
    assert polygon.corners.all()


def test_random_polygon_needs_three_sides():
    with pytest.raises(MeshError, match="at least 3 sides"):
        shapes.random_polygon(2, np.random.default_rng(0))
