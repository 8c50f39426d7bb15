"""Blocks as structured grids: every quad once, corners counter-clockwise, bands closed."""

import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.analysis.block_grids import grids
from meshwright_core.analysis.blocks import block_of
from meshwright_core.domains import gallery, meshing


def ring(sides: int, rows: int) -> HalfEdgeMesh:
    """A band of quads around a hole."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.concatenate([circle * (1.0 + row) for row in range(rows + 1)])
    i = np.arange(sides)
    quads = [
        np.column_stack([i, i + sides, (i + 1) % sides + sides, (i + 1) % sides]) + row * sides
        for row in range(rows)
    ]
    nowhere = np.zeros(len(points), bool)
    desired = np.where(np.isin(np.arange(len(points)) // sides, (0, rows)), 3, 4)
    return HalfEdgeMesh.from_elements(points, np.concatenate(quads), nowhere, desired)


def check(mesh: HalfEdgeMesh) -> None:
    found = grids(mesh)
    ids = np.concatenate([grid.elements.ravel() for grid in found])
    assert sorted(ids) == mesh.element_ids().tolist()
    corners = dict(zip(mesh.element_ids().tolist(), mesh.elements().tolist(), strict=True))
    blocks = dict(zip(mesh.element_ids().tolist(), block_of(mesh).tolist(), strict=True))
    for number, grid in enumerate(found):
        v = grid.vertices
        quads = np.stack([v[:-1, :-1], v[:-1, 1:], v[1:, 1:], v[1:, :-1]], axis=-1)
        for element, quad in zip(grid.elements.ravel(), quads.reshape(-1, 4), strict=True):
            own = corners[int(element)]
            at = own.index(int(quad[0]))
            assert own[at:] + own[:at] == quad.tolist()
            assert blocks[int(element)] == number
        assert grid.closed == bool((v[:, 0] == v[:, -1]).all())


def test_a_plain_grid_is_one_block() -> None:
    mesh = meshing.grid("quad", 24)
    (grid,) = grids(mesh)
    assert grid.elements.size == mesh.n_elements and not grid.closed
    assert len(np.unique(grid.vertices)) == mesh.n_vertices
    check(mesh)


@pytest.mark.parametrize("name", ["star", "l-shape", "square-with-hole", "single-notch"])
def test_a_fresh_mesh_falls_into_grids(name: str) -> None:
    check(meshing.mesh_domain(gallery.shape(name), "quad"))


@pytest.mark.parametrize(("sides", "rows"), [(4, 1), (7, 3), (5, 2)])
def test_a_ring_is_a_closed_band(sides: int, rows: int) -> None:
    mesh = ring(sides, rows)
    (grid,) = grids(mesh)
    assert grid.closed and grid.shape == (rows, sides)
    check(mesh)


def test_after_a_global_split_blocks_are_longer() -> None:
    mesh = meshing.mesh_domain(gallery.shape("cross"), "quad")
    for h in range(0, 4 * mesh.n_elements, 3):
        if mesh.check("global_split", h):
            mesh.apply("global_split", h)
            break
    check(mesh)


def test_triangles_have_no_blocks() -> None:
    with pytest.raises(MeshError, match="Only quad meshes"):
        grids(meshing.mesh_domain(gallery.shape("star"), "tri"))
