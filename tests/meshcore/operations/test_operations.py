"""Every operation on a hand-drawn case, and every reason for a refusal."""

import numpy as np
import pytest
from tiny_meshes import faces, fan, grid, ring, square_of_triangles

from meshwright_core import MeshError, Operation, OperationRefused
from meshwright_core.operations import catalogue


def _apply(mesh, operation, a, b):
    """Apply at the half-edge a-b, checking what holds for every edit; returns the edit."""
    before = (mesh.optimum, mesh.euler, mesh.score)
    edit = mesh.apply(operation, mesh.halfedge(a, b))
    mesh.validate()
    assert (mesh.optimum, mesh.euler) == before[:2]
    assert mesh.score == before[2] + edit.score_change
    return edit


def _reason(mesh, operation, a, b):
    h = mesh.halfedge(a, b)
    verdict = mesh.check(operation, h)
    assert not verdict
    with pytest.raises(OperationRefused, match="is not allowed"):
        mesh.apply(operation, h)
    return verdict.reason


def test_flip_turns_the_edge_and_keeps_its_id():
    mesh = square_of_triangles()
    h = mesh.halfedge(0, 2)
    edit = _apply(mesh, "flip", 0, 2)
    assert faces(mesh) == {(0, 1, 3), (1, 2, 3)}
    assert {mesh.origin(h), mesh.target(h)} == {1, 3}
    assert edit.new_vertices == ()
    assert set(edit.touched) == {0, 1, 2, 3}
    assert edit.score_change == 0  # 3 edges are desired at each corner, and two of them have 2
    _apply(mesh, "flip", 1, 3)
    assert faces(mesh) == {(0, 1, 2), (0, 2, 3)}


def test_triangle_split_inside_and_on_the_boundary():
    mesh = square_of_triangles()
    edit = _apply(mesh, "split", 0, 2)
    assert edit.new_vertices == (4,)
    assert faces(mesh) == {(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 3)}
    assert mesh.points[4].tolist() == [0.5, 0.5, 0.0]
    assert mesh.degree()[4] == 4
    assert mesh.desired()[4] == 6
    edit = _apply(mesh, "split", 0, 1)
    assert faces(mesh) == {(0, 5, 4), (1, 4, 5), (1, 2, 4), (2, 3, 4), (0, 4, 3)}
    assert mesh.is_boundary(5)
    assert (mesh.degree()[5], mesh.desired()[5]) == (3, 4)


def test_triangle_collapse_undoes_a_split_inside_and_on_the_boundary():
    mesh = square_of_triangles()
    _apply(mesh, "split", 0, 2)
    _apply(mesh, "split", 0, 1)
    _apply(mesh, "collapse", 0, 5)  # beyond the paper: on the boundary
    assert faces(mesh) == {(0, 1, 4), (1, 2, 4), (2, 3, 4), (0, 4, 3)}
    _apply(mesh, "collapse", 4, 0)
    assert faces(mesh) == {(0, 1, 2), (0, 2, 3)}


def test_flips_of_quads_turn_the_edge_both_ways():
    mesh = grid(2, 1)  # 3 4 5 over 0 1 2
    h = mesh.halfedge(1, 4)
    _apply(mesh, "flip_left", 1, 4)
    assert {mesh.origin(h), mesh.target(h)} == {2, 3}
    assert faces(mesh) == {(0, 1, 2, 3), (2, 5, 4, 3)}
    _apply(mesh, "flip_right", 2, 3)
    assert faces(mesh) == {(0, 1, 4, 3), (1, 2, 5, 4)}
    _apply(mesh, "flip_right", 1, 4)
    assert faces(mesh) == {(0, 1, 2, 5), (0, 5, 4, 3)}


def test_quad_split_opens_a_quad_and_collapse_closes_it():
    mesh = grid(3)
    edit = _apply(mesh, "split", 5, 6)  # (5, 6, 10, 9) above, (6, 5, 1, 2) below
    (v,) = edit.new_vertices
    assert faces(mesh) >= {(1, v, 9, 5), (6, 10, 9, v), (1, 2, 6, v)}
    assert mesh.degree()[v] == 3
    assert mesh.degree()[5] == 3
    assert mesh.n_elements == 10
    _apply(mesh, "collapse", 5, 1)
    assert faces(mesh) == faces(grid(3))


def test_a_doublet_can_be_made_and_removed():
    mesh = grid(3)
    (v,) = _apply(mesh, "split", 5, 6).new_vertices
    _apply(mesh, "split", v, 6)
    assert mesh.degree()[v] == 2
    assert mesh.irregularity()[v] == -2
    assert _reason(mesh, "split", v, mesh.neighbours(v)[0]) == (
        "an interior vertex would be left with too few edges"
    )
    _apply(mesh, "collapse", v, mesh.neighbours(v)[0])
    assert mesh.n_elements == 10
    assert mesh.degree()[v] > 2


def test_global_split_runs_to_the_boundary_both_ways():
    mesh = grid(4, 3)
    edit = _apply(mesh, "global_split", 7, 6)
    assert len(edit.new_vertices) == 4
    assert mesh.n_elements == 12 + 4 - 1
    degree, desired = mesh.degree(), mesh.desired()
    assert all(degree[v] == desired[v] for v in edit.new_vertices)
    assert degree[7] == 5
    assert degree[6] == 3


def test_global_split_that_comes_back_is_refused():
    mesh = ring(8, 3)
    assert "come back to where it began" in _reason(mesh, "global_split", 8, 9)
    assert mesh.check("global_split", mesh.halfedge(8, 16))  # this one leaves to both circles


def test_cleanup_deletes_a_line_and_merges_its_sides():
    mesh = grid(3)
    edit = _apply(mesh, "cleanup", 5, 6)
    assert mesh.n_elements == 6
    assert mesh.n_vertices == 12
    assert edit.score_change == 0
    assert (0, 1, 9, 8) in faces(mesh)


def test_cleanup_deletes_a_closed_ring_around_a_hole():
    mesh = ring(6, 3)
    _apply(mesh, "cleanup", 6, 7)
    assert mesh.n_elements == 12
    assert mesh.n_vertices == 18
    _apply(mesh, "cleanup", 12, 13)
    assert mesh.n_elements == 6
    assert "boundary" in _reason(mesh, "cleanup", 1, 0)


def test_clean_all_leaves_nothing_to_clean():
    mesh = grid(6, 4)
    edits = mesh.clean_all()
    assert len(edits) == 5 + 3
    assert mesh.n_elements == 1
    mesh.validate()
    assert mesh.undo()
    assert faces(mesh) == faces(grid(6, 4))


def test_chord_collapse_removes_a_strip():
    mesh = grid(4, 2)
    _apply(mesh, "chord_collapse", 1, 2)
    assert mesh.n_elements == 6
    assert mesh.n_vertices == 12
    _apply(mesh, "chord_collapse", 5, 0)
    assert mesh.n_elements == 3


def test_chord_collapse_of_a_ring():
    mesh = ring(6, 3)
    _apply(mesh, "chord_collapse", 6, 12)
    assert mesh.n_elements == 12


def test_a_geometric_vertex_wins_over_a_boundary_one_over_an_interior_one():
    mesh = fan(6)
    place = mesh.points[1].copy()
    _apply(mesh, "collapse", 0, 1)
    assert 0 not in mesh.vertices()
    assert mesh.points[1].tolist() == place.tolist()
    inner = grid(4)
    inner.set_geometric(12)
    _apply(inner, "collapse", 6, 7)  # the quad (6, 7, 12, 11): 6 meets 12
    assert 12 in inner.vertices()
    assert 6 not in inner.vertices()
    assert inner.geometric()[12]


def test_reasons_of_triangle_operations():
    mesh = square_of_triangles()
    assert "boundary" in _reason(mesh, "flip", 0, 1)
    assert "both lie on the boundary" in _reason(mesh, "collapse", 0, 2)
    assert "geometric" in _reason(mesh, "collapse", 0, 1)
    assert "too few edges" in _reason(fan(3), "flip", 0, 1)
    capped = fan(8)
    capped.degree_cap = 6
    assert "degree cap of 6" in _reason(capped, "collapse", 0, 1)
    locked = fan(6)
    locked.set_locked(0)
    assert "locked" in _reason(locked, "collapse", 0, 1)
    own = fan(6)
    own.set_desired(0, 5)
    assert "desired degree of its own" in _reason(own, "collapse", 0, 1)


def test_reasons_of_quad_operations():
    mesh = grid(2)
    assert "boundary" in _reason(mesh, "flip_left", 0, 1)
    assert "both lie on the boundary" in _reason(mesh, "collapse", 1, 4)
    assert "no line" in _reason(grid(2, geometric=np.ones(9, bool)), "cleanup", 4, 5)
    locked = grid(2)
    locked.set_locked(4)
    assert "locked" in _reason(locked, "cleanup", 4, 5)
    strip = grid(3, 1, geometric=np.zeros(8, bool), desired_degree=np.full(8, 3))
    assert "without an element" in _reason(strip, "chord_collapse", 4, 0)


def test_refusals_that_are_no_operation_of_the_mesh():
    mesh = square_of_triangles()
    verdict = mesh.check("global_split", 0)
    assert verdict.reason == "global_split is not an operation of tri meshes"
    assert "no half-edge 99" in mesh.check("flip", 99).reason
    assert "no half-edge -1" in mesh.check("flip", -1).reason
    with pytest.raises(OperationRefused):
        mesh.apply("flip_left", 0)
    with pytest.raises(ValueError, match="twist"):
        mesh.check("twist", 0)
    assert issubclass(OperationRefused, MeshError)


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_the_catalogue_names_every_operation_of_the_kind(kind):
    mesh = square_of_triangles() if kind == "tri" else grid(2)
    names = [info.operation for info in catalogue.of_kind(kind)]
    assert set(mesh.allowed(0)) == set(names)
    assert all(isinstance(name, Operation) for name in names)
    assert len({info.key for info in catalogue.of_kind(kind)}) == len(names)
