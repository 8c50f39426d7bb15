import numpy as np
import pytest
from round_meshes import annulus_sector, polar, round_disc, round_insert, round_ring
from tiny_meshes import grid

from meshwright_core import HalfEdgeMesh
from meshwright_core.geometry.edge_curves import (
    curved_edge_polylines,
    curved_halfedges,
    edge_points,
    edge_polyline,
    element_areas,
    is_straight,
)

SHARES = np.linspace(0.0, 1.0, 7)


def test_edges_of_a_ring_are_arcs():
    mesh = round_ring(3)
    curved = curved_halfedges(mesh)
    assert len(curved) == 6
    for h in range(12):
        points = edge_points(mesh, h, SHARES)
        assert points[0].tolist() == mesh.points[mesh.origin(h)].tolist()
        assert points[-1].tolist() == mesh.points[mesh.target(h)].tolist()
        radius = np.linalg.norm(points, axis=1)
        assert is_straight(mesh, h) == (h not in curved)
        if h in curved:
            assert radius == pytest.approx(radius[0], abs=1e-14)
        else:
            assert np.diff(points, axis=0) == pytest.approx(np.diff(points, axis=0)[[0] * 6])


@pytest.mark.parametrize(
    ("mesh", "area"),
    [
        pytest.param(round_ring(3), 3 * np.pi, id="ring"),
        pytest.param(round_disc(), np.pi, id="disc"),
        pytest.param(round_insert(), 16.0, id="insert"),
        pytest.param(annulus_sector(180.0), 1.5 * np.pi, id="half ring"),
        pytest.param(grid(3, 2), 6.0, id="grid"),
    ],
)
def test_areas_are_exact(mesh, area):
    assert element_areas(mesh).sum() == pytest.approx(area, rel=1e-14)


def test_areas_of_both_sides_of_an_interface():
    mesh = round_insert()
    areas = element_areas(mesh)
    assert areas[mesh.regions() == 1].sum() == pytest.approx(np.pi, rel=1e-14)
    edges = curved_halfedges(mesh)
    assert len(edges) == 8
    assert sorted(edges.tolist()) == sorted(mesh.twin(h) for h in edges.tolist())
    for h in edges.tolist():
        there, back = edge_points(mesh, h, SHARES), edge_points(mesh, mesh.twin(h), SHARES)
        assert there == pytest.approx(back[::-1], abs=1e-15)


def test_an_end_dragged_off_its_curve_takes_the_edge_along():
    mesh = annulus_sector()
    h = mesh.halfedge(1, 2)
    before = edge_points(mesh, h, SHARES)
    mesh.move([2], mesh.points[[2]] + [0.0, 0.6, 0.0])
    after = edge_points(mesh, h, SHARES)
    assert after - before == pytest.approx(np.outer(SHARES, [0.0, 0.6, 0.0]), abs=1e-15)
    mesh.undo()
    assert edge_points(mesh, h, SHARES).tobytes() == before.tobytes()


@pytest.mark.parametrize("tolerance", [0.1, 1e-3, 1e-6])
def test_polylines_keep_their_tolerance(tolerance):
    mesh = round_ring(4)
    halfedges, first, points = curved_edge_polylines(mesh, tolerance)
    assert halfedges.tolist() == curved_halfedges(mesh).tolist()
    for i, h in enumerate(halfedges.tolist()):
        own = points[first[i] : first[i + 1]]
        assert own.tobytes() == edge_polyline(mesh, h, tolerance).tobytes()
        assert own[0].tolist() == mesh.points[mesh.origin(h)].tolist()
        assert own[-1].tolist() == mesh.points[mesh.target(h)].tolist()
        middle = np.linalg.norm(0.5 * (own[1:] + own[:-1]), axis=1)
        assert np.abs(np.linalg.norm(own[0]) - middle).max() <= tolerance


def test_an_interface_is_drawn_once():
    halfedges, first, _ = curved_edge_polylines(round_insert(), 1e-3)
    assert len(halfedges) == 4
    assert len(first) == 5


def test_a_polyline_side_has_a_point_at_every_kink():
    # a regular polygon of 16 sides without geometric vertices, turned by half a side
    degrees = 22.5 * np.arange(16)
    points = np.vstack([polar(2.0, degrees), polar(1.0, degrees)])
    k = np.arange(16)
    quads = np.column_stack([k + 16, k, (k + 1) % 16, (k + 1) % 16 + 16])
    mesh = HalfEdgeMesh.from_elements(points, quads, np.zeros(32, bool))
    assert len(curved_halfedges(mesh)) == 0
    corners = mesh.points[:16].copy()
    mesh.move(k, 0.5 * (corners + np.roll(corners, -1, axis=0)))
    assert len(curved_halfedges(mesh)) == 16
    _, first, found = curved_edge_polylines(mesh, 1e-3)
    assert np.diff(first).tolist() == [3] * 16
    away = np.linalg.norm(found[1::3, None] - corners[None], axis=2).min(axis=1)
    assert away.max() < 1e-12
