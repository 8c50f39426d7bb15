"""Blocks: what is left whole when a quad mesh is cut along its separatrices."""

import numpy as np
import pytest
from tiny_meshes import grid, ring, square_of_triangles

from meshwright_core import HalfEdgeMesh
from meshwright_core.analysis.blocks import block_count, block_of, separatrices
from meshwright_core.domains import meshing
from meshwright_core.domains.elements import quadrangulation
from meshwright_core.errors import MeshError


def _slow_block_count(mesh):
    """The same by walking edge after edge from every vertex that is no grid's."""
    degree, cut = mesh.degree(), set()
    for v in mesh.vertices().tolist():
        if degree[v] > 3 if mesh.is_boundary(v) else degree[v] != 4:
            for h in mesh.outgoing(v):
                while mesh.twin(h) >= 0:
                    cut |= {h, mesh.twin(h)}
                    end = mesh.target(h)
                    if mesh.is_boundary(end) or degree[end] != 4:
                        break
                    h = mesh.next(mesh.twin(mesh.next(h)))
    seen, count = set(), 0
    for first in mesh.element_ids().tolist():
        count += first not in seen
        pending = [first]
        while pending:
            element = pending.pop()
            if element not in seen:
                seen.add(element)
                around = range(4 * element, 4 * element + 4)
                pending += [mesh.twin(h) // 4 for h in around if h not in cut and mesh.twin(h) >= 0]
    return count


def test_a_grid_is_one_block():
    assert block_count(grid(3)) == 1
    assert not separatrices(grid(3)).any()


def test_no_block_is_of_two_regions():
    """Four by four quads; the others belong to the second region."""
    whole = grid(4)
    points, elements = whole.points, whole.elements()
    middle = points[elements].mean(axis=1)
    for second, blocks in (
        (middle[:, 0] > 2, [8, 8]),
        # where the interface turns, a line leaves along each of the other two edges
        ((middle[:, 0] > 2) & (middle[:, 1] > 2), [4, 4, 4, 4]),
        (middle[:, 0] > 9, [16]),
    ):
        mesh = HalfEdgeMesh.from_elements(points, elements, regions=second.astype(int))
        assert sorted(np.bincount(block_of(mesh))) == blocks
        for block in range(len(blocks)):
            assert len(set(mesh.regions()[block_of(mesh) == block].tolist())) == 1


def test_an_l_has_three():
    # the reflex corner sends a line along each of its two inner edges
    notched = grid(4, holes=[(i, j) for i in (2, 3) for j in (2, 3)])
    assert block_count(notched) == 3
    assert sorted(np.bincount(block_of(notched))) == [4, 4, 4]


def test_a_ring_is_one_band():
    assert block_count(ring(8, 3)) == 1


def test_a_hole_in_a_grid():
    assert block_count(grid(3, holes=[(1, 1)])) == 8


def test_an_irregular_vertex_inside():
    # three quads around one vertex, each cut into four: lines from the middle to the boundary
    hexagon = [[np.cos(a), np.sin(a)] for a in np.pi / 3 * np.arange(6)]
    coarse = HalfEdgeMesh.from_elements(
        [[0, 0], *hexagon], [[0, 1, 2, 3], [0, 3, 4, 5], [0, 5, 6, 1]]
    )
    assert block_count(coarse) == 3
    once = quadrangulation.catmull_clark(coarse.points, [coarse.elements()], np.ones(7, bool))
    assert block_count(HalfEdgeMesh.from_elements(*once)) == 3


def test_corners_of_degree_three_cut_only_when_asked():
    bent = grid(2, 1, geometric=np.ones(6, bool))
    assert block_count(bent) == 1
    assert block_count(bent, corners=True) == 2


@pytest.mark.parametrize("seed", range(4))
def test_blocks_agree_with_a_naive_computation(seed):
    rng = np.random.default_rng(seed)
    mesh = meshing.benchmark_mesh("quad", 12, rng)
    operations = ("flip_left", "flip_right", "collapse", "global_split", "cleanup")
    for _ in range(60):
        h = int(rng.choice(mesh.element_ids())) * 4 + int(rng.integers(4))
        operation = operations[int(rng.integers(5))]
        if mesh.check(operation, h):
            mesh.apply(operation, h)
    assert block_count(mesh) == _slow_block_count(mesh)
    assert len(block_of(mesh)) == mesh.n_elements


def test_triangles_have_no_blocks():
    with pytest.raises(MeshError, match="quad"):
        block_count(square_of_triangles())
