"""The mesh class: construction, bad input, history, transactions, copies, validation."""

import numpy as np
import pytest
from tiny_meshes import faces, fan, grid, ring, square_of_triangles

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.arrays import (
    DEGREE,
    HALF,
    JOURNAL_TOP,
    MARK,
    ORIGIN,
    SCORE,
    STEP_COLUMNS,
    TWIN,
)
from meshwright_core.testing.fuzzing import agree, snapshot

_ANYWHERE = np.random.default_rng(0).random((7, 3))


def test_ids_are_those_of_the_input():
    mesh = grid(2, holes=[(0, 0)])
    mesh.validate()
    assert mesh.points[8].tolist() == [2, 2, 0]
    assert mesh.elements()[0].tolist() == [1, 2, 5, 4]
    assert 0 not in mesh.vertices()  # a point of no element is a dead id
    assert (mesh.n_vertices, mesh.n_edges, mesh.n_elements, mesh.euler) == (8, 10, 3, 1)
    assert mesh.halfedge(0, 1) == mesh.halfedge(1, 0) == -1
    assert (mesh.origin(0), mesh.target(0), mesh.next(3), mesh.prev(0)) == (1, 2, 0, 3)


def test_desired_degrees_are_those_of_equation_2():
    mesh = grid(3)
    desired = mesh.desired().reshape(4, 4)
    assert desired.tolist() == [[2, 3, 3, 2], [3, 4, 4, 3], [3, 4, 4, 3], [2, 3, 3, 2]]
    assert mesh.score == mesh.optimum == mesh.irregular_count == 0
    bent = grid(2, holes=[(1, 1)])  # an L: the inner corner has 270 degrees
    assert bent.desired()[4] == 4
    triangles = fan(6)
    assert triangles.desired().tolist() == [6, 3, 3, 3, 3, 3, 3]
    assert triangles.geometric().tolist() == [False] + [True] * 6


def test_the_corner_angle_decides_what_is_geometric():
    mesh = grid(2)
    assert np.flatnonzero(mesh.geometric()).tolist() == [0, 2, 6, 8]
    soft = HalfEdgeMesh.from_elements(mesh.points, mesh.elements(), corner_angle=100.0)
    assert not soft.geometric().any()


@pytest.mark.parametrize(
    ("points", "elements", "words"),
    [
        ([[0, 0], [1, 0]], [[0, 1, 2]], "names a vertex that does not exist"),
        ([[0, 0], [1, 0], [0, 1]], [[0, 1, -1]], "names a vertex that does not exist"),
        ([[0, 0], [1, 0], [0, 1]], [[0, 1, 1]], "repeats a vertex"),
        ([[0, 0], [1, np.nan], [0, 1]], [[0, 1, 2]], "point 1 has a coordinate"),
        ([[0, 0], [1, 0], [0, 1]], np.zeros((0, 3), int), "no elements"),
        ([[0, 0], [1, 0], [0, 1]], [[0, 1]], "elements must be"),
        ([[0], [1], [2]], [[0, 1, 2]], "points must be"),
        ([[0, 0], [1, 0], [0, 1]], [[0, 1, 1.5]], "whole numbers"),
        (_ANYWHERE[:5, :2], [[0, 1, 2], [1, 0, 3], [0, 1, 4]], "share the edge"),
        (_ANYWHERE[:4, :2], [[0, 1, 2], [0, 1, 3]], "oriented against each other"),
        (_ANYWHERE[:5, :2], [[0, 1, 2], [0, 3, 4]], "touch only in vertex 0"),
        (
            _ANYWHERE,  # two closed cones that share their tip
            [[0, 1, 2], [0, 2, 3], [0, 3, 1], [0, 4, 5], [0, 5, 6], [0, 6, 4]],
            "touch only in vertex 0",
        ),
    ],
)
def test_invalid_input_is_refused_with_its_place(points, elements, words):
    with pytest.raises(MeshError, match=words):
        HalfEdgeMesh.from_elements(points, elements)


def test_desired_degrees_must_be_positive():
    with pytest.raises(MeshError, match="positive"):
        HalfEdgeMesh.from_elements([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]], None, [2, 0, 2])


def test_surfaces_take_the_angles_of_their_elements():
    # three faces of a cube: the boundary vertices beside the tip see two right angles
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]])
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 2, 3], [1, 0, 4, 5], [0, 3, 6, 4]])
    mesh.validate()
    assert mesh.desired().tolist() == [4, 3, 2, 3, 3, 2, 2]
    assert mesh.optimum == 1


def test_boundary_loops_have_the_domain_on_their_left():
    mesh = ring(5, 1)
    inner, outer = mesh.boundary_loops()
    assert inner.tolist() == [0, 4, 3, 2, 1]
    assert outer.tolist() == [5, 6, 7, 8, 9]


def test_neighbours_go_round_counter_clockwise():
    assert grid(2).neighbours(4) in ([5, 7, 3, 1], [7, 3, 1, 5], [3, 1, 5, 7], [1, 5, 7, 3])
    assert grid(2).neighbours(1) == [2, 4, 0]


def test_undo_and_redo_are_exact_and_a_new_edit_ends_redo():
    mesh = grid(4)
    states = [snapshot(mesh)]
    for operation, a, b in (("flip_left", 6, 7), ("split", 12, 13), ("global_split", 7, 8)):
        mesh.apply(operation, mesh.halfedge(a, b))
        states.append(snapshot(mesh))
    for state in states[-2::-1]:
        assert mesh.undo()
        assert agree(state, snapshot(mesh))
    assert not mesh.undo()
    assert mesh.redo()
    assert agree(states[1], snapshot(mesh))
    mesh.apply("split", mesh.halfedge(16, 17))
    assert not mesh.can_redo
    assert not mesh.redo()
    mesh.validate()


def test_setters_and_moves_are_undone_too():
    mesh = grid(3)
    before = snapshot(mesh)
    mesh.set_desired(5, 6)
    assert (mesh.score, mesh.optimum, mesh.irregularity()[5]) == (2, 2, -2)
    mesh.set_geometric(5)
    mesh.set_locked(6)
    assert mesh.geometric()[5]
    assert mesh.locked()[6]
    mesh.move([5, 6], np.array([[1.1, 1.2, 0.0], [2.5, 1.0, 0.0]]))
    assert mesh.points[5].tolist() == [1.1, 1.2, 0.0]
    mesh.set_geometric(5, False)
    mesh.validate()
    assert mesh.steps == 5
    while mesh.undo():
        continue
    assert agree(before, snapshot(mesh))


@pytest.mark.parametrize(
    "change",
    [
        lambda mesh: mesh.set_desired(99, 3),
        lambda mesh: mesh.set_desired(4, 0),
        lambda mesh: mesh.set_locked(-1),
        lambda mesh: mesh.move([0], np.zeros((2, 3))),
        lambda mesh: mesh.move([0], np.full((1, 3), np.nan)),
        lambda mesh: mesh.move([4, 400], np.zeros((2, 3))),
    ],
)
def test_refused_settings_change_nothing(change):
    mesh = grid(2)
    before = snapshot(mesh)
    with pytest.raises(MeshError):
        change(mesh)
    assert agree(before, snapshot(mesh))
    assert mesh.steps == 0


def test_a_transaction_is_one_step_and_rolls_back_when_it_fails():
    mesh = grid(4)
    start = snapshot(mesh)
    with mesh.transaction():
        mesh.apply("flip_left", mesh.halfedge(6, 7))
        with mesh.transaction():
            mesh.apply("split", mesh.halfedge(12, 13))
        mesh.set_locked(18)
    assert mesh.steps == 1
    middle = snapshot(mesh)

    def break_off():
        with mesh.transaction():
            mesh.apply("split", mesh.halfedge(17, 18))
            raise RuntimeError("half-way")

    with pytest.raises(RuntimeError, match="half-way"):
        break_off()
    assert agree(middle, snapshot(mesh))
    assert mesh.steps == 1
    assert not mesh.can_redo
    with mesh.transaction():
        pass
    assert mesh.steps == 1
    with mesh.transaction(), pytest.raises(MeshError, match="transaction is open"):
        mesh.undo()
    assert mesh.undo()
    assert agree(start, snapshot(mesh))


def test_the_arrays_grow_as_needed():
    mesh = square_of_triangles()
    rng = np.random.default_rng(0)
    start = snapshot(mesh)
    for _ in range(3000):
        mesh.apply("split", int(rng.integers(mesh.n_elements * 3)))
    assert mesh.n_elements > 5000
    mesh.validate()
    while mesh.undo():
        continue
    assert agree(start, snapshot(mesh))


def test_history_costs_less_than_two_kilobytes_an_operation():
    mesh = grid(20)
    rng = np.random.default_rng(0)
    done = 0
    for _ in range(4000):
        h = int(rng.integers(4 * 400))
        operation = ("flip_left", "flip_right", "split", "collapse")[int(rng.integers(4))]
        if mesh.live(h) and mesh.check(operation, h):
            mesh.apply(operation, h)
            done += 1
    entries = int(mesh.arrays.counters[JOURNAL_TOP])
    assert done > 1000
    assert (16 * entries + 8 * STEP_COLUMNS * done) / done < 2048


def test_a_copy_is_independent_with_the_same_ids():
    mesh = grid(4)
    mesh.apply("collapse", mesh.halfedge(6, 7))
    copy = mesh.copy()
    assert copy.steps == 0
    for one in (mesh, copy):
        edit = one.apply("split", one.halfedge(17, 18))
        assert edit.new_vertices == (6,) or edit.new_vertices == (12,)
    assert agree(snapshot(mesh), snapshot(copy))
    copy.apply("flip_left", copy.halfedge(16, 17))
    assert faces(mesh) != faces(copy)


def test_compact_returns_the_maps_of_ids():
    mesh = grid(4)
    mesh.set_locked(18)
    mesh.set_desired(17, 5)
    mesh.apply("collapse", mesh.halfedge(6, 7))
    before, score, points = mesh.elements(), mesh.score, mesh.points.copy()
    vertices, elements = mesh.compact()
    mesh.validate()
    assert mesh.n_vertices == mesh.slots == 24
    assert (mesh.elements() == vertices[before]).all()
    assert (elements >= 0).sum() == mesh.n_elements == 15
    assert mesh.score == score
    assert mesh.locked()[vertices[18]]
    assert mesh.desired()[vertices[17]] == 5
    assert (mesh.points[vertices[18]] == points[18]).all()
    assert not mesh.can_undo
    assert mesh.off_curve().max() == 0.0


def _spoil_twin(m):
    m.edge[1, TWIN] = 9


def _spoil_origin(m):
    m.edge[2, ORIGIN] = m.edge[1, ORIGIN]


def _spoil_half(m):
    m.vertex[1, HALF] = m.edge[m.vertex[1, HALF] - m.vertex[1, HALF] % 4 + 3, TWIN]


def _spoil_degree(m):
    m.vertex[4, DEGREE] += 1


def _spoil_score(m):
    m.counters[SCORE] += 1


def _spoil_mark(m):
    m.vertex[0, MARK] = 1


@pytest.mark.parametrize(
    "spoil", [_spoil_twin, _spoil_origin, _spoil_half, _spoil_degree, _spoil_score, _spoil_mark]
)
def test_the_validator_finds_each_broken_invariant(spoil):
    mesh = grid(2)
    mesh.validate()
    spoil(mesh.arrays)
    with pytest.raises(MeshError, match="broken mesh"):
        mesh.validate()


def test_repr_shows_the_score():
    assert repr(grid(2)) == "<HalfEdgeMesh quad: 9 vertices, 4 elements, s = 0, s* = 0>"
    assert "allowed" in repr(grid(2).check("flip_left", 1))
