"""Dragging vertices: where they may go."""

from threading import Event

import curved_meshes
import numpy as np
import pytest

from meshwright.document.document import Document
from meshwright.document.vertex_drag import CORNER, LOCK, Drag, refusal
from meshwright_core import HalfEdgeMesh
from meshwright_core.domains import gallery, meshing


@pytest.fixture
def board() -> HalfEdgeMesh:
    """Four by four unit quads; vertex i + 5 j at (i, j)."""
    points = np.array([(i, j) for j in range(5) for i in range(5)], float)
    corners = [i + 5 * j for j in range(4) for i in range(4)]
    return HalfEdgeMesh.from_elements(points, [(c, c + 1, c + 6, c + 5) for c in corners])


def test_an_inner_vertex_follows_the_mouse_and_the_mesh_is_unchanged(board):
    drag = Drag(board, [12], 12)
    assert not drag.moved
    drag.to(2.4, 1.7)
    assert drag.moved
    assert drag.places.tolist() == [[2.4, 1.7, 0.0]]
    assert board.points[12].tolist() == [2.0, 2.0, 0.0]
    assert len(drag.segments) == 4
    assert len(drag.folded) == 0
    drag.to(3.4, 3.3)
    assert len(drag.folded) > 0
    document = Document(board)
    document.move(drag.vertices, drag.places)
    assert board.points[12].tolist() == [3.4, 3.3, 0.0]
    document.undo()
    assert board.points[12].tolist() == [2.0, 2.0, 0.0]


def test_a_boundary_vertex_stays_on_its_side_and_between_its_neighbours(board):
    drag = Drag(board, [2], 2)
    drag.to(2.3, 1.5)
    assert drag.places.tolist() == [[2.3, 0.0, 0.0]]
    drag.to(9.0, -4.0)
    assert 2.9 < drag.places[0, 0] < 3.0 and drag.places[0, 1] == 0.0
    assert len(drag.folded) == 0


def test_a_boundary_vertex_follows_a_curved_side():
    mesh = meshing.mesh_domain(gallery.shape("disc"), "quad")
    slides = mesh.boundary() & ~mesh.geometric()
    vertex = int(np.flatnonzero(slides)[0])
    drag = Drag(mesh, [vertex], vertex)
    x, y = mesh.points[vertex, :2]
    drag.to(x - 0.05 * y, y + 0.05 * x)
    assert drag.moved
    radius = np.hypot(*mesh.points[vertex, :2])
    assert abs(np.hypot(*drag.places[0, :2]) - radius) < 0.02 * radius


def test_vertices_slide_exactly_along_the_curve_and_over_its_seam():
    mesh = curved_meshes.disc()
    parameters = mesh.parameters()
    last = int(np.argmax(parameters))
    drag = Drag(mesh, [last], last)
    for angle in (-1.2, -0.3, 0.4, 3.0):  # the circle begins at angle 0
        drag.to(1.4 * np.cos(angle), 1.4 * np.sin(angle))
        assert abs(np.hypot(*drag.places[0, :2]) - 1.0) < 1e-15
        assert 0.0 <= drag.parameters[0] < 2 * np.pi
    drag.to(1.4 * np.cos(0.4), 1.4 * np.sin(0.4))
    assert drag.parameters[0] == pytest.approx(0.4, abs=1e-3)  # nearly the arc length
    bent = drag.edges.polylines(1e-4)[0]
    assert len(bent) > 20
    assert len(drag.folded_sides) == mesh.k * len(drag.folded)
    document = Document(mesh)
    document.move(drag.vertices, drag.places, parameters=drag.parameters)
    mesh.validate()
    assert mesh.off_curve().max() < 1e-15
    document.undo()
    assert (mesh.parameters() == parameters).all()


def test_corners_and_locked_vertices_are_refused(board):
    assert refusal(board, 0) == CORNER
    board.set_locked(12)
    assert refusal(board, 12) == LOCK
    assert refusal(board, 6) == refusal(board, 2) == ""


def test_a_selection_moves_as_one_without_those_that_stay(board):
    board.set_locked(13)
    drag = Drag(board, [0, 1, 2, 6, 7, 12, 13], 7)
    assert drag.vertices.tolist() == [1, 2, 6, 7, 12]
    drag.to(2.2, 1.1)
    moved = dict(zip(drag.vertices.tolist(), drag.places.tolist(), strict=True))
    assert moved[6] == pytest.approx([1.2, 1.1, 0.0])
    assert moved[12] == pytest.approx([2.2, 2.1, 0.0])
    assert moved[1] == pytest.approx([1.2, 0.0, 0.0]) and moved[2] == pytest.approx([2.2, 0.0, 0.0])


def test_a_vertex_put_by_hand_stays_when_the_mesh_is_smoothed(board):
    document = Document(board)
    drag = Drag(board, [12, 2], 12)
    drag.to(2.4, 2.3)
    document.move(drag.vertices, drag.places, parameters=drag.parameters, pin=True)
    there = board.points[[2, 12]].copy()
    assert board.pinned().nonzero()[0].tolist() == [2, 12]
    document.smooth()
    document.smooth(vertices=np.array([2, 12]))
    document.submit("flip_left", board.halfedge(12, 13))
    document.untangle()
    assert np.array_equal(board.points[[2, 12]], there)
    document.go_to(1)
    document.undo()  # one step: position and pin
    assert not board.pinned().any()
    assert board.points[12].tolist() == [2.0, 2.0, 0.0]
    document.redo()
    document.set_pinned(12, False)
    document.smooth()
    assert not np.array_equal(board.points[12], there[1])
    assert np.array_equal(board.points[2], there[0])


def test_no_search_moves_or_removes_a_pinned_vertex(board, monkeypatch):
    from meshwright.assistant.search_runner import Effort, SearchRunner

    board.set_pinned(12)
    seen = []
    for name in ("_search", "_search_in_size"):
        monkeypatch.setattr(SearchRunner, name, lambda self: seen.append(self._mesh) or [])
    runner = SearchRunner(board.copy(), None, 0, Effort(), Event(), lambda *_: None)
    assert runner.step() == []
    assert np.flatnonzero(seen[0].locked()).tolist() == [12]
    assert not board.locked().any()
