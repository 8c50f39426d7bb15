"""A mesh with its history as arrays and back; arrays that lie are refused in words."""

from pathlib import Path

import numba
import numpy as np
import pytest
from mesh_edits import state, wander

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.domains import gallery, meshing
from meshwright_core.history import step_archive
from meshwright_core.history.packed_steps import WRITE_KINDS
from meshwright_core.io import snapshot
from meshwright_core.testing.fuzzing import start_mesh


@pytest.fixture(params=["tri", "quad"])
def mesh(request, monkeypatch) -> HalfEdgeMesh:
    """In the middle of a long history, part of it packed."""
    monkeypatch.setattr(step_archive, "PIECE", 4)
    monkeypatch.setattr(step_archive, "LOOSE", 16)
    made = meshing.mesh_domain(gallery.shape("square-with-hole"), request.param)
    made.degree_cap = 9
    for part in range(4):
        wander(made, 15, part)
        made.trim()
    for _ in range(20):
        made.undo()
    made.set_locked(int(made.vertices()[3]))
    made.undo()
    wander(made, 10, 9)
    for _ in range(5):
        made.undo()
    return made


def copied(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    return {name: array.copy() for name, array in arrays.items()}


def test_round_trip_of_mesh_and_history(mesh):
    other = snapshot.from_arrays(copied(snapshot.to_arrays(mesh)))
    assert state(other) == state(mesh)
    assert (other.steps, other.can_redo, other.degree_cap) == (mesh.steps, True, 9)
    for own, stored in zip(mesh.boundary_info.curves, other.boundary_info.curves, strict=True):
        assert np.array_equal(own, stored)
    for walk in ("redo", "undo", "redo"):
        while getattr(mesh, walk)():
            assert getattr(other, walk)()
            assert state(other) == state(mesh)
        assert not getattr(other, walk)()
        other.validate()
    for array, other_array in zip(mesh.arrays[:4], other.arrays[:4], strict=True):
        assert np.array_equal(array, other_array)
    assert wander(mesh, 5, 3) == wander(other, 5, 3)


def test_arrays_that_are_views_of_a_file_give_a_mesh_of_the_same_compiled_types(mesh):
    arrays = snapshot.to_arrays(mesh)
    views = {
        name: np.frombuffer(array.tobytes(), array.dtype).reshape(array.shape)
        for name, array in arrays.items()
    }
    assert numba.typeof(snapshot.from_arrays(views).arrays) == numba.typeof(mesh.arrays)


def test_a_missing_or_misshapen_array_is_refused(mesh):
    whole = snapshot.to_arrays(mesh)
    for name in whole:
        with pytest.raises(MeshError, match="lacks"):
            snapshot.from_arrays({key: array for key, array in whole.items() if key != name})
        for wrong in (whole[name].astype(np.float32), whole[name][None], whole[name][:-1]):
            if len(whole[name]):
                with pytest.raises(MeshError):
                    snapshot.from_arrays({**whole, name: wrong})


def test_changed_numbers_are_refused_or_give_a_valid_mesh(mesh):
    """One number of one array at a time is turned into something else."""
    whole = snapshot.to_arrays(mesh)
    rng = np.random.default_rng(2)
    refused = 0
    for trial in range(400):
        arrays = copied(whole)
        name = list(arrays)[trial % len(arrays)]
        flat = arrays[name].reshape(-1)
        if not len(flat):
            continue
        at = int(rng.integers(len(flat)))
        flat[at] = rng.choice([-(1 << 31), -7, -1, 0, 1, 5, 1000, (1 << 31) - 1, flat[at] + 1])
        try:
            got = snapshot.from_arrays(arrays)
        except MeshError as error:
            refused += 1
            assert "\n" not in str(error)
            continue
        got.validate()
        while got.undo():
            pass
        while got.redo():
            pass
    assert refused > 200


@pytest.mark.parametrize(
    ("name", "change", "words"),
    [
        ("points", lambda a: a.__setitem__((0, 0), np.nan), "not a finite"),
        ("edge", lambda a: a.__setitem__((0, 0), 1 << 30), "does not exist"),
        ("edge", lambda a: a.__setitem__((0, 1), a[1, 1]), "disagree"),
        ("vertex", lambda a: a.__setitem__((0, 1), 77), "degree"),
        ("counters", lambda a: a.__setitem__(7, 1), "scores"),
        ("done.places", lambda a: a.__setitem__(0, 1 << 30), "beyond|lacks|length"),
        ("done.rows", lambda a: a.__setitem__((0, 0), 1 << 20), "length"),
        ("done.rows", lambda a: a.__setitem__((0, 3), 1 << 20), "impossible"),
        ("curve", lambda a: a.__setitem__(0, 1 << 30), "curve that does not exist"),
        ("parameter", lambda a: a.__setitem__(0, 1e9), "beyond the ends"),
        ("region", lambda a: a.__setitem__(0, 1), "region that does not exist"),
        ("curves.control", lambda a: a.__setitem__((0, 3), 0.0), "curves"),
        ("curves.first_control", lambda a: a.__setitem__(1, 1 << 40), "curves"),
        ("interface", lambda a: a.__setitem__((0, 0), 0), "interface|curve"),
        ("boundary", lambda a: a.__setitem__(0, 255), "names"),
        ("sizes", lambda a: a.__setitem__(0, 5), "sizes"),
        ("sizes", lambda a: a.__setitem__(2, 1 << 24), "room"),
    ],
)
def test_messages_name_what_is_wrong(mesh, name, change, words):
    arrays = copied(snapshot.to_arrays(mesh))
    change(arrays[name])
    with pytest.raises(MeshError, match=words):
        snapshot.from_arrays(arrays)


def test_a_write_to_the_scratch_of_the_checks_is_refused(mesh):
    arrays = copied(snapshot.to_arrays(mesh))
    places = arrays["done.places"]
    vertex_write = int(np.flatnonzero(places % WRITE_KINDS == 1)[0])
    places[vertex_write] = 5 * WRITE_KINDS + 1
    with pytest.raises(MeshError, match="beyond the mesh"):
        snapshot.from_arrays(arrays)


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_curves_and_regions_are_stored(kind):
    mesh = start_mesh(kind, 7, np.random.default_rng(5), curved=True, interfaces=True)
    wander(mesh, 20, 2)
    other = snapshot.from_arrays(copied(snapshot.to_arrays(mesh)))
    other.validate()
    assert state(other) == state(mesh)
    info, got = mesh.boundary_info, other.boundary_info
    assert (got.loops, got.interfaces, got.pieces) == (info.loops, info.interfaces, info.pieces)
    assert got.region_names == info.region_names
    for array, stored in zip(info.curves, got.curves, strict=True):
        assert array.tobytes() == stored.tobytes()
    while mesh.undo():
        assert other.undo()
        assert state(other) == state(mesh)


@pytest.mark.parametrize("kind", ["tri", "quad"])
def test_files_from_before_meshes_had_curves_are_read(kind):
    """`without_curves_*.npz` hold a star after 30 random edits of which 7 are undone."""
    path = Path(__file__).parent / "snapshots" / f"without_curves_{kind}.npz"
    with np.load(path) as arrays:
        mesh = snapshot.from_arrays(dict(arrays))
    mesh.validate()
    assert mesh.boundary_info.lengths() == pytest.approx(
        meshing.mesh_domain(gallery.shape("star"), kind).boundary_info.lengths()
    )
    assert mesh.off_curve()[mesh.geometric()].max() < 0.05
    assert (mesh.steps, mesh.can_redo) == (23, True)
    before = state(mesh)
    for step in ("redo", "undo"):
        while getattr(mesh, step)():
            mesh.validate()
    for _ in range(23):
        mesh.redo()
    assert state(mesh) == before
    again = snapshot.from_arrays(copied(snapshot.to_arrays(mesh)))
    assert state(again) == before
    while again.undo():
        again.validate()
