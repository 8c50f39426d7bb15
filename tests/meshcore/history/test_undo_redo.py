"""Undo and redo far back, steps cut out and grafted on again; all exact to the bit."""

import numpy as np
import pytest
from mesh_edits import state, wander

from meshwright_core import MeshError, OperationRefused
from meshwright_core.core.arrays import STEP
from meshwright_core.domains import gallery, meshing
from meshwright_core.history import step_archive
from meshwright_core.history.packed_steps import Steps, pack, unpack


@pytest.fixture
def small_pieces(monkeypatch):
    monkeypatch.setattr(step_archive, "PIECE", 4)
    monkeypatch.setattr(step_archive, "LOOSE", 16)


@pytest.mark.usefixtures("small_pieces")
@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_packed_steps_are_undone_and_redone_to_the_bit(kind):
    mesh = meshing.mesh_domain(gallery.shape("star"), kind)
    states = [state(mesh)]
    for part in range(8):
        states += wander(mesh, 15, part)
        mesh.trim()
    assert mesh.steps == 120
    assert mesh.arrays.counters[STEP] < 40  # the others are packed
    for back in range(119, -1, -1):
        assert mesh.undo()
        assert state(mesh) == states[back]
    assert not mesh.undo()
    for on in range(1, 121):
        assert mesh.can_redo
        assert mesh.redo()
        assert state(mesh) == states[on]
    assert not mesh.redo()
    assert mesh.steps == 120
    mesh.validate()


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_undone_steps_are_cut_and_grafted(kind):
    mesh = meshing.mesh_domain(gallery.shape("star"), kind)
    wander(mesh, 10)
    fork, end = state(mesh), wander(mesh, 20, 1)[-1]
    for _ in range(20):
        mesh.undo()
    kept = mesh.cut_redo()
    assert not mesh.can_redo
    assert sum(map(len, kept)) == 20
    other = wander(mesh, 5, 2)[-1]
    for _ in range(5):
        mesh.undo()
    assert state(mesh) == fork
    second = mesh.cut_redo()
    mesh.graft_redo(kept)
    while mesh.redo():
        pass
    assert state(mesh) == end
    for _ in range(20):
        mesh.undo()
    mesh.graft_redo(second)
    while mesh.redo():
        pass
    assert state(mesh) == other
    mesh.validate()


def test_the_last_step_is_redone_on_a_copy():
    mesh = meshing.mesh_domain(gallery.shape("star"), "quad")
    other = mesh.copy()
    other.reserve(50, 50)
    for seed in range(30):
        after = wander(mesh, 1, seed)[-1]
        before = state(other)
        other.graft_redo([mesh.last_step()])
        other.redo()
        assert state(other) == after
        other.undo()
        assert state(other) == before
        other.redo()


def test_a_refused_edit_or_empty_transaction_keeps_the_redo_steps():
    mesh = meshing.mesh_domain(gallery.shape("star"), "quad")
    end = wander(mesh, 6)[-1]
    for _ in range(4):
        mesh.undo()
    with mesh.transaction():
        pass
    boundary = int(np.flatnonzero(mesh.arrays.edge[:, 1] < 0)[0])
    with pytest.raises(OperationRefused):
        mesh.apply("flip_left", boundary)

    def fail() -> None:
        with mesh.transaction():
            mesh.move([0], mesh.points[:1] + 1.0)
            mesh.apply("flip_left", boundary)

    with pytest.raises(OperationRefused):
        fail()
    while mesh.redo():
        pass
    assert state(mesh) == end


def test_an_edit_discards_grafted_steps():
    mesh = meshing.mesh_domain(gallery.shape("star"), "quad")
    wander(mesh, 4)
    for _ in range(4):
        mesh.undo()
    mesh.graft_redo(mesh.cut_redo())
    assert mesh.can_redo
    wander(mesh, 1, 7)
    assert not mesh.can_redo


def test_a_copy_with_history():
    mesh = meshing.mesh_domain(gallery.shape("star"), "tri")
    first, last = state(mesh), wander(mesh, 30)[-1]
    copy = mesh.copy(history=True)
    while copy.undo():
        pass
    assert state(copy) == first
    assert state(mesh) == last
    assert mesh.copy().steps == 0


def test_packing_keeps_z_coordinates_and_refuses_inconsistent_arrays():
    mesh = meshing.mesh_domain(gallery.shape("star"), "tri")
    mesh.move([3, 5], np.array([(0.5, 0.25, -0.0), (0.5, 0.5, 2.0)]))
    steps = mesh.last_step()
    assert steps.coordinates.shape == (2, 3)
    rows, entries = unpack(steps)
    assert rows[0, :2].tolist() == [0, 6]
    none = steps.parameters
    assert len(none) == 0
    with pytest.raises(MeshError, match="cut off"):
        pack(rows, entries[:5])
    with pytest.raises(MeshError, match="not of one vertex"):
        pack(rows, entries[[0, 2, 1, 3, 4, 5]])
    with pytest.raises(MeshError, match="another length"):
        unpack(Steps.of(steps.rows[:0], steps.places, steps.whole, steps.coordinates, none))
    with pytest.raises(MeshError, match="no step"):
        mesh.copy().last_step()
