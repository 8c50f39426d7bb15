"""On sides that bend the drawn outline keeps following the shape."""

import numpy as np
import pytest

from meshwright_core.domains import gallery
from meshwright_core.domains.meshing import mesh_domain
from meshwright_core.geometry import movable_part, smoothing
from meshwright_core.geometry.boundary_spacing import anchors, bending


def _area(points):
    x, y = points[:, 0], points[:, 1]
    return 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def _gaps(points):
    return np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)


def _coarsened(name, rng):
    """A mesh of the shape from which clean-ups and collapses have taken boundary vertices."""
    mesh = mesh_domain(gallery.shape(name), "quad")
    for _ in range(4000):
        ids = mesh.element_ids()
        h = int(rng.choice(ids)) * 4 + int(rng.integers(4))
        operation = ("cleanup", "chord_collapse")[int(rng.integers(2))]
        if mesh.n_elements > 24 and mesh.check(operation, h):
            mesh.apply(operation, h)
    return mesh


def test_a_disc_stays_round():
    mesh = mesh_domain(gallery.shape("disc"), "quad")
    (loop,) = mesh.boundary_loops()
    # crowd the boundary vertices on one half of the circle
    angle = np.arctan2(mesh.points[loop, 1], mesh.points[loop, 0])
    crowded = angle * np.abs(angle) / np.pi
    radius = np.linalg.norm(mesh.points[loop], axis=1).mean()
    circle = radius * np.column_stack([np.cos(crowded), np.sin(crowded), np.zeros(len(loop))])
    mesh.move(loop, circle)
    assert len(smoothing.relax(mesh)) == 0
    drawn = mesh.points[loop]
    assert _gaps(drawn).max() < 1.3 * _gaps(drawn).min()
    n = len(loop)
    assert _area(drawn) > 0.97 * 0.5 * n * radius**2 * np.sin(2 * np.pi / n)


@pytest.mark.parametrize("name", ["annulus", "half-disc", "disc-with-square-hole"])
def test_coarse_boundaries_keep_their_spacing(name):
    mesh = _coarsened(name, np.random.default_rng(2))
    corners = np.flatnonzero(mesh.geometric())
    places = mesh.points[corners].copy()
    smoothing.relax(mesh)
    assert (mesh.points[corners] == places).all()
    for loop in mesh.boundary_loops():
        if not mesh.geometric()[loop].any():
            gaps = _gaps(mesh.points[loop])
            assert gaps.max() < 2.0 * gaps.min()


def test_a_hole_pulled_off_its_circle_goes_back_to_it():
    mesh = mesh_domain(gallery.shape("annulus"), "quad")
    inner, outer = sorted(mesh.boundary_loops(), key=lambda loop: _area(mesh.points[loop]))
    radii = [np.linalg.norm(mesh.points[loop], axis=1).mean() for loop in (inner, outer)]
    mesh.move(inner, 0.4 * mesh.points[inner])
    mesh.move(outer, 0.6 * mesh.points[outer])
    assert len(smoothing.relax(mesh)) == 0
    for loop, radius in zip((inner, outer), radii, strict=True):
        assert np.linalg.norm(mesh.points[loop], axis=1).mean() == pytest.approx(radius, rel=0.03)


@pytest.mark.parametrize("name", ["star", "l-shape", "plate-with-holes", "gear"])
def test_only_curved_sides_are_spread(name):
    mesh = mesh_domain(gallery.shape(name), "quad")
    whole = region.whole(mesh)
    bent = whole.vertices[bending(whole)]
    curved = name in ("plate-with-holes", "gear")
    assert (len(bent) > 0) == curved
    assert mesh.boundary()[bent].all()


@pytest.mark.parametrize(
    ("name", "count"), [("disc", 12), ("annulus", 24), ("half-disc", 5), ("star", 0)]
)
def test_anchors_keep_the_shape_of_curved_sides(name, count):
    mesh = mesh_domain(gallery.shape(name), "quad")
    chosen = anchors(mesh)
    assert len(chosen) == count
    assert mesh.boundary()[chosen].all()
    assert not mesh.geometric()[chosen].any()
    for loop in mesh.boundary_loops():
        kept = np.isin(loop, chosen) | mesh.geometric()[loop]
        if count and kept.any() and not mesh.geometric()[loop].all():
            assert _area(mesh.points[loop[kept]]) > 0.94 * _area(mesh.points[loop])


def test_with_anchors_locked_a_disc_is_not_coarsened_to_a_square():
    mesh = mesh_domain(gallery.shape("disc"), "quad")
    for vertex in anchors(mesh).tolist():
        mesh.set_locked(vertex)
    rng = np.random.default_rng(0)
    for _ in range(1500):
        h = int(rng.choice(mesh.element_ids())) * 4 + int(rng.integers(4))
        operation = ("cleanup", "chord_collapse")[int(rng.integers(2))]
        if mesh.check(operation, h):
            mesh.apply(operation, h)
    assert len(mesh.boundary_loops()[0]) >= 12
