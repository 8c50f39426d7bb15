"""The project file: mesh, history, branches and settings come back; broken files are refused."""

import io
import json
import zipfile

import numpy as np
import pytest
from document_edits import bits, serials, wander

from meshwright.cli import arguments
from meshwright.console import UserError
from meshwright.document.document import Document
from meshwright.document.storage import project_file
from meshwright_core import MeshError


@pytest.fixture(params=["quad", "tri"])
def document(request, star, triangles) -> Document:
    """In the middle of a history with branches on branches."""
    made = Document(star if request.param == "quad" else triangles, "star")
    wander(made, 6, 1)
    made.go_to(4)
    wander(made, 2, 2)
    made.go_to(2)
    wander(made, 5, 3)
    made.go_to(5)
    made.settings["view"] = {"centre": [0.5, 0.25], "scale": 3.5}
    return made


def test_a_project_restores_everything(document, tmp_path):
    path = tmp_path / "star.meshwright"
    document.save(path)
    assert not document.modified
    other = Document()
    other.open(path)
    assert (other.name, other.path, other.modified) == ("star", path, False)
    assert other.settings == document.settings
    assert bits(other) == bits(document)
    assert [(row.title, row.by) for row in other.history] == [
        (row.title, row.by) for row in document.history
    ]
    assert other.history.cursor == 5
    for cursor in (0, 7, 3):
        document.go_to(cursor)
        other.go_to(cursor)
        assert bits(other) == bits(document)
    for index in (0, 1, 0):
        document.take_branch(index)
        other.take_branch(index)
        assert bits(other) == bits(document)
        assert serials(other.history) == serials(document.history)
    wander(document, 3, 8)
    wander(other, 3, 8)
    assert bits(other) == bits(document)
    assert (other.start_score, other.best_score) == (document.start_score, document.best_score)
    other.mesh.validate()


def test_a_project_is_modified_by_a_step_even_when_it_is_undone(document, tmp_path):
    document.save(tmp_path / "a.meshwright")
    document.go_to(4)
    assert document.modified
    document.go_to(5)
    assert not document.modified
    document.go_to(7)
    wander(document, 1, 5)
    document.go_to(5)
    assert document.modified
    document.save(tmp_path / "a.vtk")
    wander(document, 1, 5)
    document.undo()
    assert document.modified  # a mesh file has no history
    assert not document.mesh_modified


def test_projects_are_read_by_numpy(document, tmp_path):
    document.save(tmp_path / "a.meshwright")
    with np.load(tmp_path / "a.meshwright") as arrays:
        assert np.array_equal(arrays["points"], document.mesh.points)


def test_a_truncated_or_damaged_file_is_refused_in_one_sentence(document, tmp_path):
    path = tmp_path / "a.meshwright"
    document.save(path)
    whole = path.read_bytes()
    before = bits(document)
    broken = tmp_path / "b.meshwright"
    rng = np.random.default_rng(0)
    for trial in range(150):
        data = bytearray(whole)
        if trial % 2:
            del data[int(rng.integers(len(data))) :]
        else:
            for at in rng.integers(len(data), size=3):
                data[at] ^= int(rng.integers(1, 256))
        broken.write_bytes(data)
        try:
            Document().open(broken)
        except MeshError as error:
            assert str(error).startswith(str(broken))
            assert str(error).endswith(".")
            assert "\n" not in str(error)
    with pytest.raises(MeshError):
        document.open(broken)
    assert bits(document) == before


def rewritten(path, change) -> None:
    """The project with another header, or another array."""
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    change(members)
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in members.items():
            archive.writestr(name, data)


def header_with(**changes):
    def change(members) -> None:
        header = json.loads(members["project.json"])
        members["project.json"] = json.dumps({**header, **changes})

    return change


def array_of(name: str, array: np.ndarray):
    def change(members) -> None:
        stream = io.BytesIO()
        np.save(stream, array)
        members[name + ".npy"] = stream.getvalue()

    return change


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (header_with(format="something else"), "not a Meshwright project"),
        (header_with(version=99), "later version"),
        (header_with(rows=[]), "rows"),
        (header_with(rows=[[1, 2]]), r"rows\[0\]"),
        (header_with(cursor=-1), "cursor"),
        (header_with(cursor="five"), "cursor"),
        (header_with(given=[2, 1]), "counts its rows"),
        (header_with(branches=[{"at": 0}]), "branch"),
        (
            header_with(
                branches=[{"at": 0, "rows": [], "steps": "done", "made": 1, "branches": []}]
            ),
            "nowhere",
        ),
        (header_with(branches=7), "branches"),
        (header_with(settings=[]), "settings"),
        (header_with(name=3), "name"),
        (lambda members: members.update({"project.json": b"[" * 100_000}), "not a whole one"),
        (lambda members: members.update({"project.json": b"\xff\xfe"}), "not a whole one"),
        (lambda members: members.pop("project.json"), "not a whole one"),
        (lambda members: members.pop("edge.npy"), "lacks its edge"),
        (array_of("points", np.array(["text"])), "not a whole one"),
        (array_of("points", np.zeros((3, 3))), "should"),
        (array_of("sizes", np.array([4, 1 << 60, 1 << 60, 0])), "sizes"),
        (array_of("sizes", np.array([4, 1 << 25, 1 << 25, 0])), "room|irregular"),
        (array_of("irregular", np.zeros(1 << 25, np.int32)), "too large|irregular"),
    ],
)
def test_invalid_projects_are_refused_with_a_reason(document, tmp_path, change, words):
    path = tmp_path / "a.meshwright"
    document.save(path)
    rewritten(path, change)
    with pytest.raises(MeshError, match=words):
        project_file.read(path)


def changed(name: str, row: int, column: int, by: int):
    """The project with another number in an array of two dimensions."""

    def change(members) -> None:
        array = np.load(io.BytesIO(members[name + ".npy"])).copy()
        array = array.reshape(-1, column + 1) if array.ndim == 1 else array
        array[row, column] += by
        array_of(name, array if column else array.ravel())(members)

    return change


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (changed("done.rows", 0, 10, 2), "other scores"),  # s
        (changed("undone.rows", -1, 11, 4), "other scores"),  # the sum of Delta
        (changed("done.rows", 0, 5, 1), "leads to a broken mesh"),  # the number of vertices
        (changed("undone.whole", 1, 0, 1), "leads to a broken mesh|beyond"),
        (changed("branch0.whole", -1, 0, 1), "leads to a broken mesh|beyond"),
        (changed("branch0.0.whole", 2, 0, 1), "leads to a broken mesh|beyond"),
    ],
)
def test_steps_that_lead_to_a_broken_mesh_are_refused(document, tmp_path, change, words):
    path = tmp_path / "a.meshwright"
    document.save(path)
    rewritten(path, change)
    with pytest.raises(MeshError, match=words):
        project_file.read(path)


def test_files_that_are_no_policies(tmp_path):
    for name, data in (("empty", b""), ("text", b"hello"), ("zip", b"PK\x03\x04" + bytes(60))):
        path = tmp_path / f"{name}.meshwright"
        path.write_bytes(data)
        with pytest.raises(MeshError, match="not a Meshwright project"):
            project_file.read(path)
    with pytest.raises(MeshError, match="no such file"):
        project_file.read(tmp_path / "nowhere.meshwright")
    with pytest.raises(MeshError, match="cannot be read"):
        project_file.read(tmp_path)


def test_a_save_that_fails_leaves_the_old_file(document, tmp_path, monkeypatch):
    path = tmp_path / "a.meshwright"
    document.save(path)
    before = path.read_bytes()
    wander(document, 1, 4)

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(np.lib.format, "write_array", full)
    with pytest.raises(MeshError, match="no space left"):
        document.save()
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]
    assert document.modified


def test_commands_read_projects(document, tmp_path):
    path = tmp_path / "a.meshwright"
    document.save(path)
    opened = arguments.read_document(str(path), "quad")
    assert bits(opened) == bits(document)
    assert opened.path == path
    mesh = arguments.read_mesh(str(path))
    assert np.array_equal(mesh.points, document.mesh.points)
    assert mesh.steps == 0
    path.write_text("nothing of the kind")
    with pytest.raises(UserError, match="not a Meshwright project"):
        arguments.read_document(str(path), "quad")
    with pytest.raises(UserError, match="not a Meshwright project"):
        arguments.read_mesh(str(path))
