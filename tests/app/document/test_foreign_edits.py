"""Changes that are made on the mesh itself, beside the document."""

import numpy as np
import pytest
from document_edits import bits, wander

from meshwright.document.document import Document
from meshwright.document.storage import recovery
from meshwright.document.storage.autosave import Autosave
from meshwright_core import HalfEdgeMesh


def free(mesh: HalfEdgeMesh, operation: str = "flip_left") -> int:
    return next(h for h in range(4 * mesh.n_elements) if mesh.check(operation, h))


@pytest.fixture
def document(star) -> Document:
    return Document(star, "star")


def test_an_edit_of_the_mesh_is_recorded_as_a_step(document):
    mesh = document.mesh
    start = mesh.points.copy(), mesh.elements()
    document.submit("flip_left", free(mesh))
    mesh.apply("flip_left", free(mesh))
    mesh.apply("flip_right", free(mesh, "flip_right"))
    assert document.catch_up()
    assert not document.catch_up()
    assert [row.title for row in document.history][1:] == ["Edit in Python"] * 2
    assert [row.after for row in document.history][:-1] == [row.before for row in document.history][
        1:
    ]
    assert document.history.last.after == mesh.score == document.score
    document.undo()
    document.go_to(0)
    assert np.array_equal(mesh.points, start[0]) and np.array_equal(mesh.elements(), start[1])
    document.go_to(3)
    assert document.history.cursor == 3
    mesh.validate()


def test_an_undo_of_the_document_after_an_edit_of_the_mesh_takes_that_edit_back(document):
    mesh = document.mesh
    document.submit("flip_left", free(mesh))
    before = mesh.points.copy(), mesh.elements()
    mesh.apply("flip_left", free(mesh))
    assert document.undo().title == "Edit in Python"
    assert np.array_equal(mesh.elements(), before[1])
    assert document.history.cursor == 1


def test_an_undo_of_the_mesh_moves_the_cursor(document):
    wander(document, 3, 1)
    document.mesh.undo()
    document.catch_up()
    assert (document.history.cursor, len(document.history)) == (2, 3)
    document.redo()
    document.mesh.undo()
    document.mesh.undo()
    document.mesh.apply("flip_left", free(document.mesh))
    document.catch_up()
    assert (document.history.cursor, len(document.history)) == (2, 2)
    assert document.history.last.title == "Edit in Python"
    document.go_to(0)
    document.go_to(2)
    document.mesh.validate()


def test_steps_that_the_mesh_has_dropped_leave_the_history(document):
    wander(document, 3, 1)
    document.go_to(1)
    document.mesh.apply("flip_left", free(document.mesh))
    document.mesh.undo()  # as many undone steps as before at most, but others
    document.catch_up()
    assert (document.history.cursor, len(document.history)) == (1, 1)
    assert not document.can_redo
    document.undo()
    assert document.history.cursor == 0


def test_a_renumbered_mesh_begins_a_new_history(document):
    wander(document, 3, 1)
    document.mesh.compact()
    document.catch_up()
    assert len(document.history) == 0
    assert document.modified
    wander(document, 2, 1)
    document.go_to(0)
    document.mesh.validate()


def test_previews_and_refused_calls_are_no_edits(document):
    from meshwright.document.operation_preview import choices

    wander(document, 2, 1)
    document.undo()
    mesh = document.mesh
    choices(mesh, free(mesh), None)
    assert not document.catch_up()
    assert document.redo() is not None


def test_edits_of_the_mesh_are_saved_at_the_next_use(document, tmp_path):
    keeper = Autosave(document, tmp_path)
    wander(document, 1, 1)
    document.mesh.apply("flip_left", free(document.mesh))
    document.catch_up()
    wander(document, 1, 2)
    keeper.leave()
    (lost,) = recovery.lost(tmp_path)
    state = lost.read()
    lost.discard()
    assert [row.title for row in state.history][1] == "Edit in Python"
    assert np.array_equal(state.mesh.elements(), document.mesh.elements())


@pytest.mark.parametrize("steps", [1, 70, 300])
def test_steps_from_before_the_document_are_not_saved(triangles, tmp_path, steps):
    mesh = triangles
    for _ in range(steps):
        edge = next(h for h in range(3 * mesh.n_elements) if mesh.check("flip", h))
        mesh.apply("flip", edge)
    mesh.undo()
    document = Document(mesh, "disc")
    path = tmp_path / "disc.meshwright"
    document.save(path)
    other = Document()
    other.open(path)
    assert (len(other.history), other.mesh.steps, other.mesh.undone_steps) == (0, 0, 0)
    assert np.array_equal(other.mesh.elements(), mesh.elements())

    document = Document(mesh, "disc")
    before = mesh.elements()
    wander(document, 5, 2)
    document.go_to(3)
    document.save(path)
    other.open(path)
    assert (len(other.history), other.history.cursor) == (5, 3)
    assert (other.mesh.steps, other.mesh.undone_steps) == (3, 2)
    assert bits(other) == bits(document)
    other.go_to(0)
    assert np.array_equal(other.mesh.elements(), before)
