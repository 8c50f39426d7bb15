"""Elements with curved sides: closed-form cases, and what the grid of samples can miss."""

import numpy as np
import pytest
from round_meshes import (
    annulus_sector,
    boundary_of,
    curved_mesh,
    fan,
    polar,
    round_disc,
    round_ring,
)

from meshwright_core.curves.curve import Curve
from meshwright_core.geometry import quality
from meshwright_core.geometry.edge_curves import edge_points

FINE = np.linspace(0.0, 1.0, 65)


@pytest.mark.parametrize("degrees", [30.0, 90.0, 180.0, 270.0])
def test_the_coons_map_of_an_annulus_sector_is_polar_coordinates(degrees):
    mesh = annulus_sector(degrees)
    assert quality.scaled_jacobian(mesh) == pytest.approx(1.0, abs=1e-14)
    assert quality.angles(mesh) == pytest.approx(90.0)
    assert len(quality.inverted(mesh)) == 0


def test_chords_that_cut_the_corner_do_not_invert():
    mesh = annulus_sector(270.0)
    upwards = np.array([[0.0, 0.0, 1.0]])
    assert quality.corner_sines(mesh.points, mesh.elements(), upwards).min() < -0.5
    assert len(quality.inverted(mesh)) == 0


def test_an_arc_that_crosses_the_opposite_side_inverts():
    points = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
    for sagitta, bad in ((0.5, 0), (1.2, 1)):
        loop = [
            Curve.arc_through(points[0], [1.0, sagitta], points[1]),
            Curve.line(points[1], points[2]),
            Curve.line(points[2], points[3]),
            Curve.line(points[3], points[0]),
        ]
        mesh = curved_mesh(points, [[0, 1, 2, 3]], boundary_of([loop]), [range(4)], range(4))
        assert len(quality.inverted(mesh)) == bad


def test_a_smooth_boundary_vertex_of_one_quad_is_flat():
    # a half disc of one quad: its chords would give 90 degrees at the smooth vertex
    points = np.vstack([polar(1.0, [0.0, 90.0, 180.0]), [[0.0, 0.0]]])
    loop = [Curve.arc((0, 0), 1.0, 0.0, np.pi), Curve.polyline(points[[2, 3, 0]])]
    mesh = curved_mesh(points, [[0, 1, 2, 3]], boundary_of([loop]), [range(4)], [0, 2])
    assert quality.inverted(mesh).tolist() == [0]
    assert np.mod(quality.angles(mesh)[0, 1], 360.0) == pytest.approx(180.0)


@pytest.mark.parametrize("pieces", [3, 4, 8])
def test_triangles_with_arcs(pieces):
    # cones over arcs are valid, seen from the centre
    mesh = fan(pieces)
    assert len(quality.inverted(mesh)) == 0
    corner = quality.angles(mesh)
    assert corner[:, 2] == pytest.approx(360.0 / pieces)
    assert corner[:, :2] == pytest.approx(90.0)


def test_straight_elements_are_measured_as_before():
    mesh = round_disc()
    middle = quality.scaled_jacobian(mesh)[0]
    assert middle == pytest.approx(1.0, abs=1e-15)
    # 90 degrees at the circle, and two of (360 - 90) / 2 at the square
    assert quality.angles(mesh)[1] == pytest.approx([135.0, 90.0, 90.0, 135.0])


def _coons(mesh):
    """The smallest Jacobian of a quad's Coons map on a fine grid, from sampled sides."""
    sides = [edge_points(mesh, h, FINE)[:, :2] for h in range(4)]
    bottom, right = sides[0][:, None], sides[1][None]
    top, left = sides[2][::-1][:, None], sides[3][::-1][None]
    u, v = FINE[:, None, None], FINE[None, :, None]
    a, b, c, d = mesh.points[:4, :2]
    corners = (1 - u) * (1 - v) * a + u * (1 - v) * b + u * v * c + (1 - u) * v * d
    x = (1 - v) * bottom + v * top + (1 - u) * left + u * right - corners
    p, q = np.gradient(x, FINE, axis=0, edge_order=2), np.gradient(x, FINE, axis=1, edge_order=2)
    return (p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]).min()


def test_what_the_samples_miss_for_arcs():
    rng = np.random.default_rng(0)
    seen = missed = 0
    for _ in range(400):
        points = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) + rng.uniform(-0.35, 0.35, (4, 2))
        turn = np.radians(rng.uniform(-90, 90, 4)) * (rng.random(4) < 0.6)
        loop = [
            Curve.arc_by_bulge(points[i], points[(i + 1) % 4], np.tan(turn[i] / 4))
            for i in range(4)
        ]
        mesh = curved_mesh(points, [[0, 1, 2, 3]], boundary_of([loop]), [range(4)], range(4))
        if len(quality.inverted(mesh)):
            continue
        seen += 1
        missed += _coons(mesh) < -1e-3
    assert seen > 150
    assert missed <= 1


def test_rings_are_regular():
    for pieces in (3, 5):
        assert quality.scaled_jacobian(round_ring(pieces)) == pytest.approx(1.0, abs=1e-14)
