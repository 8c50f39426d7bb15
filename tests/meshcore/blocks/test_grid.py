"""Fine grids: every cell once, points on curves, layers, valid after smoothing, linear."""

import numpy as np
import pytest
from block_meshes import annulus, corner_blocks, quarter_ring, two_regions

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.blocks.grid import Sizing, WallLayer, block_grid
from meshwright_core.blocks.high_order import high_order

MAKERS = [quarter_ring, annulus, corner_blocks, two_regions]


@pytest.mark.parametrize("make", MAKERS)
def test_cells_tile_the_domain(make):
    grid = block_grid(make(), Sizing(size=0.21))
    assert sorted(np.unique(grid.cells)) == list(range(len(grid.points)))
    assert (grid.layout.ids >= 0).all()
    assert grid.quality.inverted == 0
    fine = HalfEdgeMesh.from_elements(grid.points, grid.cells)  # manifold, counter-clockwise
    assert fine.n_elements == grid.cell_count
    boundary = sum(len(faces) for faces in grid.patch_faces().values())
    assert boundary == sum(len(loop) for loop in fine.boundary_loops())
    for faces in grid.patch_faces().values():
        for a, b in faces.tolist():
            assert fine.halfedge(a, b) >= 0  # the domain on the left


@pytest.mark.parametrize("make", MAKERS)
def test_rows_and_cells_of_a_block_agree(make):
    grid = block_grid(make(), Sizing(divide=3))
    for block in range(len(grid.shapes)):
        v = grid.block_vertices(block)
        quads = np.stack([v[:-1, :-1], v[:-1, 1:], v[1:, 1:], v[1:, :-1]], axis=-1)
        first = grid.layout.cell_first
        assert (grid.cells[first[block] : first[block + 1]] == quads.reshape(-1, 4)).all()


def test_boundary_points_lie_on_their_curves():
    grid = block_grid(annulus(), Sizing(size=0.1))
    for name, radius in (("wall", 1.0), ("far", 2.0)):
        at = grid.points[np.unique(grid.patch_faces()[name])]
        assert np.abs(np.linalg.norm(at, axis=1) - radius).max() < 1e-9


def test_the_grid_of_a_ring_is_the_polar_one():
    grid = block_grid(annulus(), Sizing(size=0.2))
    radius = np.linalg.norm(grid.points, axis=1)
    levels = np.linspace(1.0, 2.0, grid.shapes.min() + 1)
    assert np.abs(radius[:, None] - levels).min(axis=1).max() < 0.01
    assert grid.quality.worst_scaled_jacobian > 0.98


def test_layers_have_their_height_and_growth_and_are_orthogonal():
    height, ratio = 2e-3, 1.25
    sizing = Sizing(size=0.1, walls=(WallLayer("wall", height, ratio),))
    grid = block_grid(annulus(), sizing)
    wall = np.unique(grid.patch_faces()["wall"])
    for block in range(4):
        v = grid.block_vertices(block)
        if not np.isin(v[0], wall).all():
            v = next(w for w in (v[::-1], v.T, v.T[::-1]) if np.isin(w[0], wall).all())
        p = grid.points[v]
        steps = np.linalg.norm(np.diff(p, axis=0), axis=2)
        assert steps[0] == pytest.approx(np.full(steps.shape[1], height), rel=1e-3)
        growth = steps[1:] / steps[:-1]
        assert growth.max() < ratio * 1.01
        out = p[1] - p[0]
        away = np.einsum("ij,ij->i", out, p[0]) / np.linalg.norm(out, axis=1)
        assert away.min() > np.cos(np.radians(3.0))
    assert grid.quality.inverted == 0


def test_layers_on_both_sides():
    sizing = Sizing(size=0.1, walls=(WallLayer("all", 1e-3, 1.3),))
    grid = block_grid(quarter_ring(), sizing)
    for edge in range(4):
        sizes = grid.edge_sizes(edge) * grid.structure.lengths[edge]
        assert sizes[[0, -1]] == pytest.approx([1e-3, 1e-3], rel=1e-6)
        assert (sizes[1:] / sizes[:-1]).max() < 1.31
    assert grid.quality.inverted == 0


def test_smoothing_unfolds_what_the_interpolation_folds():
    # the middle of the upper side dips almost to the lower one
    top = [(4, 2), (2.4, 2), (2, 0.3), (1.6, 2), (0, 2)]
    points = [(0, 0), (4, 0), *top]
    mesh = HalfEdgeMesh.from_elements(
        [*points[:3], points[6]], [[0, 1, 2, 3]], geometric=[True] * 4
    )
    assert block_grid(mesh, Sizing(divide=12)).quality.inverted == 0
    skewed = HalfEdgeMesh.from_elements(
        [(0, 0), (1, 0), (2, 0), (0, 1), (0.05, 0.9), (2, 1), (0, 2), (1, 2), (2, 2)],
        [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]],
    )
    plain = block_grid(skewed, Sizing(divide=10), smooth=False).quality
    better = block_grid(skewed, Sizing(divide=10)).quality
    assert better.worst_scaled_jacobian > plain.worst_scaled_jacobian + 0.2
    assert better.inverted == 0


def test_an_interface_between_regions_stays():
    grid = block_grid(two_regions(), Sizing(size=0.1))
    left = np.unique(grid.cells[grid.regions == 0])
    right = np.unique(grid.cells[grid.regions == 1])
    assert grid.points[np.intersect1d(left, right), 0] == pytest.approx(np.ones(11), abs=1e-12)


def test_quality_agrees_with_a_slow_measure():
    grid = block_grid(corner_blocks(), Sizing(size=0.3))
    worst, growth = np.inf, 1.0
    areas = {}
    sides: dict[tuple[int, int], list[int]] = {}
    for c, cell in enumerate(grid.cells.tolist()):
        p = grid.points[cell, :2]
        for k in range(4):
            a, b = p[(k + 1) % 4] - p[k], p[k - 1] - p[k]
            sine = (a[0] * b[1] - a[1] * b[0]) / np.hypot(*a) / np.hypot(*b)
            worst = min(worst, sine)
            sides.setdefault(tuple(sorted((cell[k], cell[(k + 1) % 4]))), []).append(c)
        x, y = p.T
        areas[c] = 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))
    for cells in sides.values():
        if len(cells) == 2:
            one, other = areas[cells[0]], areas[cells[1]]
            growth = max(growth, one / other, other / one)
    assert grid.quality.worst_scaled_jacobian == pytest.approx(worst)
    assert grid.quality.growth == pytest.approx(growth)
    assert grid.quality.areas.sum() == pytest.approx(3.0)


@pytest.mark.parametrize("order", [2, 3])
def test_nodes_of_higher_order_lie_on_the_curves_and_between_the_vertices(order):
    grid = block_grid(annulus(), Sizing(size=0.3, walls=(WallLayer("wall", 1e-3, 1.5),)))
    fine = high_order(grid, order)
    corners = fine.cells[:, [0, order, (order + 1) ** 2 - 1, order * (order + 1)]]
    assert fine.points[corners] == pytest.approx(grid.points[grid.cells], abs=1e-12)
    wall = np.unique(fine.faces["wall"])
    assert len(wall) == order * len(grid.patch_faces()["wall"])
    assert np.abs(np.linalg.norm(fine.points[wall], axis=1) - 1.0).max() < 1e-9
    # rows of nodes do not cross, although the first one is thinner than the arc of a cell is high
    rows = fine.points[fine.cells].reshape(len(fine.cells), order + 1, order + 1, 3)
    a, b = np.diff(rows, axis=2)[:, :-1], np.diff(rows, axis=1)[:, :, :-1]
    assert np.cross(a, b)[..., 2].min() > 0.0
    with pytest.raises(MeshError, match="order 1, 2 or 3"):
        high_order(grid, 4)


def test_meshes_off_a_plane_are_refused():
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 1), (0, 1, 0)]
    with pytest.raises(MeshError, match="plane"):
        block_grid(HalfEdgeMesh.from_elements(np.array(points, float), [[0, 1, 2, 3]]))


def test_areas_of_a_part_far_from_the_origin():
    mesh = corner_blocks()
    points = mesh.points + np.array([1e9, -1e9, 0.0])
    far = HalfEdgeMesh.from_elements(points, mesh.elements())
    assert block_grid(far, Sizing(divide=4)).quality.areas.sum() == pytest.approx(3.0, rel=1e-6)
