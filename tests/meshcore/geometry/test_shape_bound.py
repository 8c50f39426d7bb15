"""The bound q* by hand, and what is attainable with irregular vertices."""

import numpy as np
import pytest

from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.shape_bound import attainable_bound, corner_angles, shape_bound
from meshwright_core.mesh import HalfEdgeMesh


def quad(*points):
    return HalfEdgeMesh.from_elements(np.array(points, float), [[0, 1, 2, 3]])


def test_a_square_permits_1_a_rhombus_the_sine_of_its_angle():
    assert shape_bound(quad((0, 0), (1, 0), (1, 1), (0, 1))) == 1.0
    h = np.sin(np.radians(60))
    rhombus = quad((0, 0), (1, 0), (1.5, h), (0.5, h))
    assert np.degrees(corner_angles(rhombus)) == pytest.approx([60, 120, 60, 120])
    assert shape_bound(rhombus) == attainable_bound(rhombus) == pytest.approx(h)


def test_two_quads_share_a_corner_of_more_than_135_degrees():
    mesh = quad((0, 0), (2, 0), (2 + np.cos(np.radians(30)), 0.5), (0, 1))
    angles = np.degrees(corner_angles(mesh))
    assert angles[1] == pytest.approx(150)
    desired = mesh.desired()
    assert desired[1] == 3  # two quads of 75 degrees
    shares = np.radians(angles[:4]) / (desired[:4] - 1)
    assert shape_bound(mesh) == pytest.approx(np.sin(shares).min())


def test_irregular_vertices_inside_limit_what_is_attainable():
    disc = mesh_domain(gallery.shape("disc"), "quad")
    assert disc.optimum == 4 and shape_bound(disc) == 1.0
    assert attainable_bound(disc) == pytest.approx(np.sin(np.radians(60)))


def test_the_shape_sees_the_aspect_ratio():
    long = quad((0, 0), (10, 0), (10, 1), (0, 1))
    assert element_shapes(long) == pytest.approx([20 / 101])
    assert element_shapes(quad((0, 0), (1, 0), (1, 1), (0, 1))) == pytest.approx([1.0])
