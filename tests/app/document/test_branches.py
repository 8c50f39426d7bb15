"""Branches of the history: what was undone and left is kept, and taken again exactly."""

import numpy as np
import pytest
from document_edits import bits, serials, wander

from meshwright.document import branches
from meshwright.document.branches import every
from meshwright.document.document import Document
from meshwright_core import MeshError, OperationRefused


@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_undone_steps_are_kept_as_a_branch_and_restored_exactly(kind, star, triangles):
    document = Document(star if kind == "quad" else triangles)
    wander(document, 8, 1)
    first = bits(document)
    document.go_to(3)
    wander(document, 4, 2)
    second = bits(document)
    (kept,) = document.history.branches
    assert (kept.at, kept.end, serials(kept.rows)) == (3, 8, [4, 5, 6, 7, 8])
    document.take_branch(0)
    assert bits(document) == first
    (other,) = document.history.branches
    assert (other.at, serials(other.rows)) == (3, [9, 10, 11, 12])
    document.go_to(1)
    document.take_branch(0)
    assert bits(document) == second
    document.go_to(0)
    document.go_to(7)
    assert bits(document) == second
    document.mesh.validate()


def test_branches_fork_on_branches(star):
    document = Document(star)
    wander(document, 6, 1)
    six = bits(document)
    document.go_to(4)
    wander(document, 2, 2)
    document.go_to(2)
    wander(document, 3, 3)
    five = bits(document)
    (outer,) = document.history.branches
    assert (outer.at, serials(outer.rows)) == (2, [3, 4, 7, 8])
    (inner,) = outer.branches
    assert (inner.at, serials(inner.rows)) == (4, [5, 6])
    document.take_branch(0)
    assert [branch.at for branch in document.history.branches] == [2, 4]
    document.take_branch(1)
    assert bits(document) == six
    document.take_branch(0)
    assert bits(document) == five
    assert len(list(every(document.history.branches))) == 2


def test_modified_compares_states_and_not_paths(star, tmp_path):
    document = Document(star)
    wander(document, 3, 1)
    document.save(tmp_path / "three.vtk")
    assert document.modified  # the history is in no file
    assert not document.mesh_modified
    document.go_to(1)
    assert document.mesh_modified
    wander(document, 2, 2)
    assert document.mesh_modified
    document.take_branch(0)
    assert not document.mesh_modified
    document.take_branch(0)
    assert document.mesh_modified
    document.save(tmp_path / "all.meshwright")
    assert not document.modified
    document.save(tmp_path / "again.vtk")
    assert not document.modified  # all.meshwright has the history


def test_steps_that_were_undone_count_as_modified(star):
    document = Document(star)
    assert not document.modified
    wander(document, 3, 1)
    document.go_to(0)
    assert document.modified
    assert not document.mesh_modified


def test_a_refused_or_idle_action_after_an_undo_leaves_what_can_be_redone(star):
    document = Document(star)
    document.clean_all()
    wander(document, 4, 1)
    end = bits(document)
    document.go_to(len(document.history) - 2)
    boundary = next(h for h in range(star.k * star.n_elements) if star.live(h) and star.twin(h) < 0)
    with pytest.raises(OperationRefused):
        document.submit("flip_left", boundary)
    document.move(np.zeros(0, int), np.zeros((0, 3)))
    assert document.history.branches == ()
    document.go_to(len(document.history))
    assert bits(document) == end


def test_the_oldest_branches_are_dropped(star, monkeypatch):
    monkeypatch.setattr(branches, "MOST_BRANCHES", 5)
    document = Document(star)
    wander(document, 1, 0)
    for seed in range(1, 10):
        document.go_to(0)
        wander(document, 1, seed)
    assert [serials(branch.rows) for branch in document.history.branches] == [
        [5],
        [6],
        [7],
        [8],
        [9],
    ]
    monkeypatch.setattr(branches, "MOST_BYTES", 0)
    document.go_to(0)
    wander(document, 1, 10)
    assert [serials(branch.rows) for branch in document.history.branches] == [[10]]


def test_a_missing_branch_is_refused(star):
    document = Document(star)
    with pytest.raises(MeshError, match="no branch 0"):
        document.take_branch(0)
    wander(document, 1, 0)
    assert document.history.branches == ()
