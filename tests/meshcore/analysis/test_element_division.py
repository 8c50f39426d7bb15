"""Division of chords: the same s, all vertices new ones regular, shapes as wanted."""

import numpy as np
import pytest
from tests.helpers.round_meshes import round_ring

from meshwright_core.analysis.element_division import chords, divided, divided_for_shape, divisions
from meshwright_core.errors import MeshError
from meshwright_core.geometry.element_shapes import element_shapes
from meshwright_core.geometry.size_field import SizeField
from meshwright_core.mesh import HalfEdgeMesh


def strip():
    """Two quads side by side, 8 by 1 and 1 by 1."""
    points = np.array([(0, 0), (8, 0), (9, 0), (9, 1), (8, 1), (0, 1)], float)
    return HalfEdgeMesh.from_elements(points, [[0, 1, 4, 5], [1, 2, 3, 4]])


def test_a_long_quad_is_divided_along_its_length_only():
    mesh = strip()
    assert len(np.unique(chords(mesh))) == 3
    assert sorted(divisions(mesh, 0.3)) == [1, 1, 2]
    fine = divided_for_shape(mesh, 0.3)
    fine.validate()
    assert fine.n_elements == 3
    assert element_shapes(fine).min() >= 0.3
    assert (fine.score, fine.optimum) == (mesh.score, mesh.optimum)


@pytest.mark.parametrize(
    ("places", "wanted"),
    [
        ([(0, 0), (6, 0), (2, 2), (0, 2)], [1, 1]),  # its sharpest corner is not its longest
        ([(0, 0), (6, 0), (5, 1), (0, 1)], [1, 1]),
        ([(0, 0), (8, 0), (1, 3), (-2, 3)], [1, 2]),
    ],
)
def test_each_corner_is_judged_by_its_own_angle_and_sides(places, wanted):
    quad = HalfEdgeMesh.from_elements(places, [[0, 1, 2, 3]])
    count = divisions(quad, 0.3)
    assert count.tolist() == wanted
    assert element_shapes(divided(quad, count)).min() >= 0.3


def test_curves_are_kept():
    ring = round_ring(4)
    fine = divided(ring, np.full(int(chords(ring).max()) + 1, 3))
    fine.validate()
    assert fine.n_elements == 36 and fine.score == ring.score
    radius = np.hypot(*fine.points[fine.boundary(), :2].T)
    assert np.minimum(abs(radius - 1.0), abs(radius - 2.0)).max() < 1e-12


def test_triangles_have_no_chords():
    mesh = HalfEdgeMesh.from_elements([(0, 0), (1, 0), (0, 1)], [[0, 1, 2]])
    with pytest.raises(MeshError, match="quads"):
        divisions(mesh, 0.3)


def test_a_field_of_sizes_is_followed_along_edges():
    x = np.array([0.0, 1.0, 2.0, 3.0, 7.0, 11.0])
    points = np.vstack([np.column_stack([x, 0 * x]), np.column_stack([x, 0 * x + 2.0])])
    graded = HalfEdgeMesh.from_elements(points, [[i, i + 1, i + 7, i + 6] for i in range(5)])
    block = HalfEdgeMesh.from_elements([(0, 0), (11, 0), (11, 2), (0, 2)], [[0, 1, 2, 3]])
    counts = np.ones(2, np.int64)
    counts[chords(block)[0, 0]] = 5
    fine = divided(block, counts, SizeField(graded))
    fine.validate()
    below = np.sort(fine.points[fine.points[:, 1] == 0.0, 0])
    steps = np.diff(below)
    assert steps[0] < 1.7 and steps[-1] > 2.5
    even = divided(block, counts)
    assert np.diff(np.sort(even.points[even.points[:, 1] == 0.0, 0])) == pytest.approx(2.2)
