"""Ends of lines on the boundary are squared up where no element becomes worse."""

import numpy as np
import pytest

from meshwright.document.position_repair import square_up
from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.quality import scaled_jacobian


@pytest.fixture
def bracket() -> HalfEdgeMesh:
    """An L of three blocks; the ends of its two cuts are not across from the inner corner."""
    points = [(0, 0), (4, 0), (4, 1), (1, 1), (1, 3), (0, 3), (1.03, 0), (0, 1.02)]
    geometric = np.arange(8) < 6
    return HalfEdgeMesh.from_elements(points, [(0, 6, 3, 7), (6, 1, 2, 3), (7, 3, 4, 5)], geometric)


def test_cuts_of_a_bracket_become_straight(bracket):
    assert scaled_jacobian(bracket).min() < 1.0
    assert square_up(bracket) == 2
    assert bracket.points[6:].tolist() == [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    assert scaled_jacobian(bracket).min() == pytest.approx(1.0, abs=1e-15)
    assert bracket.off_curve().max() == 0.0
    bracket.validate()


def test_locked_and_pinned_vertices_and_corners_stay(bracket):
    bracket.set_locked(6)
    bracket.set_pinned(7)
    before = bracket.points.copy()
    assert square_up(bracket) == 0 and np.array_equal(bracket.points, before)


def test_nothing_moves_where_an_element_would_become_worse():
    """The foot of the only edge inside lies at a corner: the quad there would become a triangle."""
    points = [(0, 0), (2, 0), (3, 2), (0, 2), (1, 0), (0.02, 1.98)]
    mesh = HalfEdgeMesh.from_elements(
        points, [(0, 4, 5, 3), (4, 1, 2, 5)], np.array([1, 1, 1, 1, 0, 0], bool)
    )
    before = mesh.points.copy()
    shape = scaled_jacobian(mesh).min()
    square_up(mesh)
    assert scaled_jacobian(mesh).min() >= shape
    assert np.array_equal(mesh.points[:4], before[:4])
    mesh.validate()


def test_no_element_becomes_long_and_thin():
    """The foot of the left line inside lies close to the end of the other one."""
    points = [(0, 0), (1, 0), (2, 0), (4, 0), (4, 1), (2.98, 1), (1.98, 1), (0, 1)]
    corners = np.isin(np.arange(8), (0, 3, 4, 7))
    mesh = HalfEdgeMesh.from_elements(points, [(0, 1, 6, 7), (1, 2, 5, 6), (2, 3, 4, 5)], corners)
    for vertex in (2, 5, 6):
        mesh.set_pinned(vertex)
    assert square_up(mesh) == 0
    assert mesh.points[1].tolist() == [1.0, 0.0, 0.0]
