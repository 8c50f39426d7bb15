"""Obstacles to drawing: each kind on a tiny mesh, none where there is a drawing."""

import numpy as np
import pytest
from round_meshes import (
    annulus_sector,
    boundary_of,
    curved_mesh,
    polar,
    round_disc,
    round_insert,
    round_ring,
)
from tiny_meshes import grid, ring

from meshwright_core import HalfEdgeMesh
from meshwright_core.analysis.drawability import Obstacles
from meshwright_core.curves.curve import Curve
from meshwright_core.domains import gallery, mesh_on_domain, meshing
from meshwright_core.domains.domain import Domain
from meshwright_core.geometry import smoothing

DART = [[0, 0], [1, -1], [0.4, 0], [1, 1]]
HALF_SQUARE = [[0, 0], [1, 0], [2, 0], [1, 1]]


def _count(mesh):
    return Obstacles(mesh).count(mesh)


@pytest.mark.parametrize("name", ["star", "l-shape", "square-with-hole", "annulus", "arch", "gear"])
@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_fresh_meshes_have_no_obstacles(name, kind):
    assert _count(meshing.mesh_domain(gallery.shape(name), kind)) == 0


def test_grids_and_rings_have_no_obstacles():
    assert _count(grid(3, 2)) == 0
    assert _count(ring(8, 2)) == 0


@pytest.mark.parametrize(
    ("points", "elements", "count"),
    [
        pytest.param(HALF_SQUARE, [[0, 1, 2, 3]], 1, id="a flat vertex of one quad"),
        pytest.param(DART, [[0, 1, 2, 3]], 1, id="a reflex corner of one quad"),
        pytest.param(
            [[0, 0], [2, 0], [2, 2], [0, 2], [1, 1]],
            [[0, 1, 2, 4], [0, 4, 2, 3]],
            1,
            id="a doublet",
        ),
        pytest.param(
            HALF_SQUARE, [[0, 1, 2], [0, 2, 3]], 2, id="a flat vertex, and an edge along its side"
        ),
        pytest.param(
            DART,
            [[0, 1, 3], [1, 2, 3]],
            2,
            id="a reflex corner, and an edge that leaves the domain",
        ),
        pytest.param(DART, [[0, 1, 2], [0, 2, 3]], 0, id="a reflex corner of two triangles"),
    ],
)
def test_each_kind_of_obstacle(points, elements, count):
    assert _count(HalfEdgeMesh.from_elements(points, elements)) == count


def _arch(pieces):
    """Half a ring of so many quads; its corners are the vertices 0 to 3."""
    angle = np.pi * np.arange(pieces + 1) / pieces
    arc = np.column_stack([np.cos(angle), np.sin(angle)])
    outer = 2 + 2 * np.arange(pieces + 1)
    outer[[0, -1]] = 0, 1
    inner = outer + np.where(outer < 2, 2, 1)
    points = np.zeros((2 * (pieces + 1), 2))
    points[outer], points[inner] = 2 * arc, arc
    quads = np.column_stack([inner[:-1], outer[:-1], outer[1:], inner[1:]])
    return HalfEdgeMesh.from_elements(points, quads, np.arange(len(points)) < 4)


def test_sides_that_turn_keep_their_edges():
    assert _count(round_ring(3)) == 0
    assert _count(annulus_sector(90.0)) == 0
    # one edge for half a circle would do, but not well
    assert _count(annulus_sector(180.0)) == 1 + 1


def test_sides_that_bend_keep_some_edges():
    # an edge along a curve turns by 135 degrees at most: three around a circle; the arcs of 18
    # degrees a piece turn by 162 in all
    assert Obstacles(ring(24, 1)).count(ring(3, 1)) == 0
    assert Obstacles(_arch(10)).count(_arch(2)) == 0
    assert Obstacles(_arch(10)).count(_arch(1)) == 1 + 1


def test_vertices_of_one_quad_need_a_kink():
    """On a smooth curve their corner would be flat."""
    points = [[1, 0], [0, 1], [-1, 0], [0, -1]]
    square = HalfEdgeMesh.from_elements(points, [[0, 1, 2, 3]], [False] * 4)
    assert _count(square) == 0
    disc = Domain.from_curves([[Curve.arc((0, 0), 1.0, 0.0, 2 * np.pi)]])
    assert _count(mesh_on_domain.placed(square, disc)) == 4


def test_smooth_vertices_need_two_elements():
    assert _count(round_disc()) == 0
    # a half disc of one quad: flat at the smooth vertex, and at the middle of the diameter
    points = np.vstack([polar(1.0, [0.0, 90.0, 180.0]), [[0.0, 0.0]]])
    loop = [Curve.arc((0, 0), 1.0, 0.0, np.pi), Curve.polyline(points[[2, 3, 0]])]
    mesh = curved_mesh(points, [[0, 1, 2, 3]], boundary_of([loop]), [range(4)], [0, 2])
    assert _count(mesh) == 2


def test_each_side_of_an_interface_needs_its_own_elements():
    mesh = round_insert()
    assert _count(mesh) == 0
    # one quad for the whole insert: flat at all four vertices, from the inside only
    elements = np.vstack([[[4, 5, 6, 7]], mesh.elements()[5:]]) - 4
    boundary = mesh.boundary_info
    k = np.arange(4)
    coarse = curved_mesh(
        mesh.points[4:, :2], elements, boundary, [k + 4, k], range(4, 8), regions=[1, 0, 0, 0, 0]
    )
    assert _count(coarse) == 4
    assert len(smoothing.relax(coarse)) == 1


def test_sectors_at_a_junction_are_counted_by_region():
    # two unit squares side by side: the interface meets straight sides, 90 degrees each
    points = np.array([[0, 0], [1, 0], [2, 0], [2, 1], [1, 1], [0, 1]], float)
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 4, 5], [1, 2, 3, 4]], regions=[0, 1])
    assert _count(mesh) == 0
    # with a bay between: each region has a reflex corner of its own, and one quad there
    points[[1, 4]] = [[1, 0.2], [1, 0.8]]
    bay = HalfEdgeMesh.from_elements(points, [[0, 1, 4, 5], [1, 2, 3, 4]], regions=[0, 1])
    assert _count(bay) == 0


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_meshes_with_obstacles_stay_inverted(kind):
    rng = np.random.default_rng(3)
    mesh = meshing.benchmark_mesh(kind, 8, rng)
    obstacles = Obstacles(mesh)
    seen = 0
    for _ in range(200):
        h = int(rng.choice(mesh.element_ids())) * mesh.k + int(rng.integers(mesh.k))
        allowed = [name for name, verdict in mesh.allowed(h).items() if verdict]
        if not allowed:
            continue
        mesh.apply(allowed[int(rng.integers(len(allowed)))], h)
        if obstacles.count(mesh):
            seen += 1
            assert len(smoothing.relax(mesh.copy()))
            mesh.undo()
        if seen == 4:
            break
    assert seen == 4
