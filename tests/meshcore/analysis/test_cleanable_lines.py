"""The lines that may be cleaned up."""

from itertools import pairwise

import pytest
from tiny_meshes import grid, ring, square_of_triangles

from meshwright_core.analysis.cleanable_lines import cleanable_lines
from meshwright_core.domains import gallery, meshing


def test_a_grid_has_one_line_for_each_inner_row_and_column():
    lines = cleanable_lines(grid(4, 3))
    assert sorted(sorted(line.vertices.tolist()) for line in lines) == sorted(
        [[5 * j + i for j in range(4)] for i in (1, 2, 3)]
        + [[5 * j + i for i in range(5)] for j in (1, 2)]
    )
    assert not any(line.closed for line in lines)
    for line in lines:
        mesh = grid(4, 3)
        edit = mesh.apply("cleanup", line.halfedge)
        assert not set(line.vertices.tolist()) & set(mesh.vertices().tolist())
        assert edit.score_change == 0


def test_rings_are_lines_too():
    mesh = ring(5, 3)
    lines = [line for line in cleanable_lines(mesh) if line.closed]
    assert sorted(sorted(set(line.vertices.tolist())) for line in lines) == [
        [5, 6, 7, 8, 9],
        [10, 11, 12, 13, 14],
    ]
    mesh.apply("cleanup", lines[0].halfedge)
    mesh.validate()


def test_the_vertices_follow_one_another_along_edges():
    mesh = meshing.mesh_domain(gallery.shape("l-shape"), "quad")
    for line in cleanable_lines(mesh):
        chain = line.vertices.tolist()
        assert all(mesh.halfedge(a, b) >= 0 for a, b in pairwise(chain))
        assert mesh.check("cleanup", line.halfedge)


@pytest.mark.parametrize("locked", [0, 6])
def test_lines_with_a_locked_vertex_are_left_out(locked):
    mesh = grid(2)
    mesh.set_locked(4, locked == 0)
    assert len(cleanable_lines(mesh)) == (0 if locked == 0 else 2)
    assert cleanable_lines(square_of_triangles()) == []
