"""Sizes of elements as a function of place."""

import numpy as np
import pytest

from meshwright_core.domains.meshing import grid
from meshwright_core.geometry.size_field import SizeField, element_sizes
from meshwright_core.mesh import HalfEdgeMesh


@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_an_even_mesh_has_one_size_everywhere(kind):
    mesh = grid(kind, 64)
    field = SizeField(mesh)
    assert field.at(mesh.points[mesh.vertices()]) == pytest.approx(element_sizes(mesh)[0])
    assert field.ratios(mesh) == pytest.approx(1.0)


def test_sizes_follow_a_graded_strip():
    x = np.array([0.0, 1.0, 2.0, 6.0, 10.0])
    points = np.vstack([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + 1.0])])
    quads = [[i, i + 1, i + 6, i + 5] for i in range(4)]
    field = SizeField(HalfEdgeMesh.from_elements(points, quads))
    small, large = field.at(np.array([(0.5, 0.5, 0.0), (8.0, 0.5, 0.0)]))
    assert small == pytest.approx(1.0, rel=0.1) and large == pytest.approx(2.0, rel=0.1)
