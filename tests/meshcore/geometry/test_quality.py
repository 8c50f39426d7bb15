import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry import quality

SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]


def quad(*points):
    return HalfEdgeMesh.from_elements(np.array(points, float), [[0, 1, 2, 3]])


def test_square_is_perfect():
    mesh = quad(*SQUARE)
    assert len(quality.inverted(mesh)) == 0
    assert quality.scaled_jacobian(mesh) == pytest.approx([1.0])
    assert quality.angles(mesh) == pytest.approx(np.full((1, 4), 90.0))


@pytest.mark.parametrize(
    ("corner", "bad"),
    [([0.9, 0.9], False), ([0.5, 0.5], True), ([0.2, 0.2], True), ([0.5 + 1e-6, 0.5], False)],
)
def test_a_quad_is_valid_only_if_strictly_convex(corner, bad):
    mesh = quad([0, 0], [1, 0], corner, [0, 1])
    assert quality.inverted(mesh).tolist() == ([0] if bad else [])
    reflex = corner == [0.2, 0.2]
    assert (quality.max_angle(mesh)[0] > 180.0) == reflex
    assert (quality.scaled_jacobian(mesh)[0] < 0.0) == reflex


def test_triangles_by_orientation():
    points = np.array([[0, 0], [1, 0], [0.5, np.sqrt(0.75)], [1.5, np.sqrt(0.75)]])
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 2], [1, 3, 2]])
    assert quality.scaled_jacobian(mesh) == pytest.approx([1.0, 1.0])
    assert quality.min_angle(mesh) == pytest.approx([60.0, 60.0])
    mesh.points[3, :2] = [0.2, 0.3]
    assert quality.inverted(mesh).tolist() == [1]


def test_tolerance_is_relative_to_size():
    for size in (1e-6, 1.0, 1e6):
        points = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * size
        mesh = quad(*points)
        assert len(quality.inverted(mesh)) == 0
        mesh.points[2, :2] = 0.5 * size
        assert len(quality.inverted(mesh)) == 1


def test_doublet_is_degenerate():
    points = np.array([[0, 0], [2, 0], [2, 2], [0, 2], [1, 1]])
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 2, 4], [0, 4, 2, 3]])
    assert quality.inverted(mesh).tolist() == [0, 1]


def test_ids_after_edits():
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(4.0), np.arange(4.0)))
    a = np.array([i + 4 * j for j in range(3) for i in range(3)])
    mesh = HalfEdgeMesh.from_elements(
        np.column_stack([x, y]), np.column_stack([a, a + 1, a + 5, a + 4])
    )
    mesh.apply("collapse", 4 * 4)  # element 4 in the middle is gone
    assert 4 not in mesh.element_ids()
    assert len(quality.scaled_jacobian(mesh)) == mesh.n_elements == 8
    assert set(quality.inverted(mesh)) <= set(mesh.element_ids().tolist())


def folded_sheet():
    """Two unit squares with a right angle between them: no plane holds both."""
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]]
    mesh = HalfEdgeMesh.from_elements(np.array(points, float), [[0, 1, 2, 3], [1, 4, 5, 2]])
    mesh.points[4:] = [[1, 0, 1], [1, 1, 1]]
    return mesh


def test_surfaces_are_measured_against_local_normals():
    mesh = folded_sheet()
    assert len(quality.inverted(mesh)) == 0
    assert quality.scaled_jacobian(mesh) == pytest.approx([1.0, 1.0])
    assert quality.angles(mesh) == pytest.approx(np.full((2, 4), 90.0))


def test_a_tilted_plane_is_a_plane():
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    points = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [0.9, 0.6, 0], [1, 2, 0]])
    mesh = HalfEdgeMesh.from_elements(points @ turn.T, [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    assert len(quality.inverted(mesh)) == 0
    mesh.points[4] = turn @ [5.0, 0.5, 0.0]
    assert len(quality.inverted(mesh)) > 0


def test_no_length_is_flat():
    mesh = quad([0, 0], [1, 0], [1, 0], [0, 1])
    assert quality.inverted(mesh).tolist() == [0]
    assert np.isfinite(quality.scaled_jacobian(mesh)).all()
