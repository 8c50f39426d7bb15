"""Plane meshes that are clockwise throughout are turned."""

import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.quality import inverted

POINTS = np.array([(x, y) for y in range(4) for x in range(4)], float)
QUADS = np.array([(4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4)
                  for j in range(3) for i in range(3)])  # fmt: skip


@pytest.mark.parametrize("lift", [None, 2.5])
def test_a_reversed_grid_is_the_grid(lift):
    points = POINTS if lift is None else np.column_stack([POINTS, np.full(16, lift)])
    mesh = HalfEdgeMesh.from_elements(points, QUADS[:, ::-1])
    assert (mesh.score, mesh.optimum, len(inverted(mesh))) == (0, 0, 0)
    assert mesh.elements()[0].tolist() == [4, 0, 1, 5]
    mesh.validate()


def test_triangles_are_turned_and_keep_their_first_vertex():
    mesh = HalfEdgeMesh.from_elements([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 2, 1), (0, 3, 2)])
    assert mesh.elements().tolist() == [[0, 1, 2], [0, 2, 3]]


def test_an_inverted_element_in_a_mesh_that_is_not_clockwise_stays():
    points = POINTS.copy()
    points[5] = (2.4, 2.4)
    mesh = HalfEdgeMesh.from_elements(points, QUADS)
    assert np.array_equal(mesh.elements(), QUADS)
    assert len(inverted(mesh)) > 0
