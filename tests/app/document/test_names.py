"""Names as steps of the document: undo, branches, projects, autosave."""

import numpy as np

from meshwright.document.document import Document
from meshwright.document.storage import autosave, project_file, recovery
from meshwright_core import HalfEdgeMesh


def quads(n: int = 3) -> HalfEdgeMesh:
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    cells = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1).reshape(-1, 4)
    y, x = np.divmod(np.arange((n + 1) ** 2), n + 1)
    return HalfEdgeMesh.from_elements(np.column_stack([x, y]).astype(float), cells)


def named_document() -> Document:
    """Two names, one of them undone into a branch, and an operation between."""
    document = Document(quads(), "plate")
    document.name_sides(np.array([document.mesh.halfedge(0, 1)]), "first")
    document.undo()
    document.name_sides(np.array([document.mesh.halfedge(1, 2)]), "second")
    document.submit("global_split", document.mesh.halfedge(5, 6))
    document.name_regions([0], "steel")
    return document


def names(document: Document) -> tuple[set[str], tuple[str, ...]]:
    return set(document.mesh.sides()), document.mesh.region_names


def check_history(document: Document) -> None:
    """What :func:`named_document` did is there, step by step."""
    assert names(document) == ({"second", ""}, ("steel",))
    assert document.history.last.title == "Name regions steel"
    document.undo()
    assert names(document) == ({"second", ""}, ("",))
    document.go_to(0)
    assert names(document) == ({""}, ("",))
    document.take_branch(0)
    assert names(document) == ({"first", ""}, ("",))


def test_names_are_steps_of_the_history():
    check_history(named_document())


def test_renaming_is_a_step_and_ends_of_sides_stay_corners():
    document = Document(quads())
    document.name_sides(np.array([document.mesh.halfedge(1, 2)]), "wall")
    document.set_geometric(np.array([1]), False)
    assert document.mesh.geometric()[1]
    document.rename("wall", "fence")
    assert set(document.mesh.sides()) == {"fence", ""}
    assert [step.title for step in document.history] == ["Name sides wall", "Rename wall fence"]


def test_a_project_keeps_all_names_of_its_history(tmp_path):
    path = tmp_path / "a.meshwright"
    named_document().save(path)
    state = project_file.read(path)
    state.mesh.validate()
    document = Document()
    document.adopt(state)
    check_history(document)


def test_names_are_recovered_from_autosave(tmp_path):
    document = Document(quads(), "plate")
    saver = autosave.Autosave(document, tmp_path)
    document.submit("global_split", document.mesh.halfedge(5, 6))
    document.name_sides(np.array([document.mesh.halfedge(1, 2)]), "second")
    document.name_regions([0], "steel")
    saver.leave()
    (work,) = recovery.lost(tmp_path)
    found = Document()
    found.adopt(work.read())
    assert names(found) == ({"second", ""}, ("steel",))
    found.undo()
    assert names(found) == ({"second", ""}, ("",))
    found.go_to(0)
    assert names(found) == ({""}, ("",))
