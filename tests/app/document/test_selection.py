"""The selection of a document: choosing, growing, and what vanishes."""

import numpy as np
import pytest

from meshwright.document.document import Document
from meshwright.document.selection import in_box
from meshwright_core import HalfEdgeMesh


@pytest.fixture
def board() -> Document:
    """Four by four unit quads; vertex i + 5 j at (i, j)."""
    points = np.array([(i, j) for j in range(5) for i in range(5)], float)
    corners = [i + 5 * j for j in range(4) for i in range(4)]
    quads = [(c, c + 1, c + 6, c + 5) for c in corners]
    return Document(HalfEdgeMesh.from_elements(points, quads))


def test_selected_vertices_and_their_region(board):
    selection, heard = board.selection, []
    selection.changed.connect(lambda: heard.append(1))
    selection.set([6, 7, 11, 12, 99, -4])
    assert selection.vertices.tolist() == [6, 7, 11, 12]
    assert selection.elements.tolist() == [5]
    assert selection.free.tolist() == []
    assert 7 in selection and 8 not in selection
    selection.toggle(7)
    assert selection.vertices.tolist() == [6, 11, 12]
    assert selection.elements.tolist() == []
    selection.toggle(7)
    selection.grow()
    assert len(selection) == 16
    assert selection.free.tolist() == [0, 1, 2, 5, 6, 7, 10, 11, 12]
    selection.shrink()
    assert selection.vertices.tolist() == [0, 1, 2, 5, 6, 7, 10, 11, 12]
    selection.invert()
    assert len(selection) == 16
    selection.everything()
    assert len(selection) == 25 and len(selection.elements) == 16 and len(selection.free) == 25
    selection.everything()
    selection.clear()
    assert len(selection) == 0
    assert len(heard) == 8  # one for each change, none where nothing changed


def test_by_degree_and_irregular(board):
    selection = board.selection
    selection.of_degree(2)
    assert selection.vertices.tolist() == [0, 4, 20, 24]
    selection.irregular()
    assert len(selection) == 0
    board.set_desired(12, 5)
    selection.irregular()
    assert selection.vertices.tolist() == [12]
    selection.add(np.array([3, 12]))
    assert selection.vertices.tolist() == [3, 12]


def test_deleted_vertices_leave_the_selection(board):
    mesh, selection = board.mesh, board.selection
    selection.everything()
    board.submit("collapse", mesh.halfedge(6, 7))
    assert len(selection) == 24
    assert set(selection.vertices.tolist()) == set(mesh.vertices().tolist())
    board.replace(None)
    assert len(selection) == 0


def test_flags_and_degrees_of_a_whole_selection_are_one_step(board):
    mesh, selection = board.mesh, board.selection
    selection.set([6, 7, 8])
    board.set_locked(selection.vertices, True)
    assert np.flatnonzero(mesh.locked()).tolist() == [6, 7, 8]
    assert board.history.last.title == "Lock, 3 vertices"
    board.set_locked(np.array([6, 7, 11]), True)
    assert board.history.last.title == "Lock"  # only one was not locked yet
    board.set_geometric(selection.vertices, True)
    board.set_desired(selection.vertices, 3)
    assert (mesh.steps, board.score) == (4, 3)
    board.set_desired(selection.vertices, 3)
    assert mesh.steps == 4
    board.go_to(0)
    assert not mesh.locked().any() and board.score == 0


def test_smoothing_a_selection_moves_nothing_else(board):
    mesh = board.mesh
    away = np.array([12, 6])
    board.move(away, mesh.points[away] + (0.3, 0.2, 0.0))
    before = mesh.points.copy()
    board.smooth(vertices=np.array([12]))
    moved = np.flatnonzero((mesh.points != before).any(axis=1))
    assert moved.tolist() == [12]
    assert board.history.last.title == "Smooth here"


def test_untangling_moves_only_vertices_at_inverted_elements(board):
    mesh = board.mesh
    assert board.untangle() == (0, 0)
    assert mesh.steps == 0
    board.move([12], np.array([[3.4, 3.4, 0.0]]))
    before = mesh.points.copy()
    found, left = board.untangle()
    assert found > 0 and left == 0
    moved = np.flatnonzero((mesh.points != before).any(axis=1))
    assert 12 in moved
    board.undo()
    assert np.array_equal(mesh.points, before)


def test_points_in_a_box():
    places = np.array([(0.5, 0.5), (2.0, 2.0), (-1.0, 0.2), (0.9, 0.1)])
    found = in_box(places, np.array([1.0, 1.0]), np.array([0.0, 0.0]))
    assert found.tolist() == [True, False, False, True]
