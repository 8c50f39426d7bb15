"""The document: steps, history, scores, files; no window."""

import subprocess
import sys

import numpy as np
import pytest

from meshwright.document.document import NO_MESH, Document
from meshwright.document.history import History
from meshwright_core import HalfEdgeMesh, MeshError, OperationRefused
from meshwright_core.core.score import normalised_return
from meshwright_core.operations.catalogue import of_kind


def first_allowed(mesh: HalfEdgeMesh, operation: str) -> int:
    return next(
        h
        for e in mesh.element_ids().tolist()
        for h in range(mesh.k * e, mesh.k * e + mesh.k)
        if mesh.check(operation, h)
    )


class Ears:
    """Counts the events of a document."""

    def __init__(self, document: Document) -> None:
        self.heard: list[str] = []
        for name in ("replaced", "changed", "score_changed", "history_changed", "saved_changed"):
            getattr(document, name).connect(lambda name=name: self.heard.append(name))


def test_one_submit_is_one_step_one_row_and_one_round_of_events(star):
    document = Document(star, "star")
    ears = Ears(document)
    before = star.points.copy()
    edit = document.submit("flip_left", first_allowed(star, "flip_left"))
    assert star.steps == 1
    row = document.history.last
    assert (row.action, row.title, row.by) == ("flip_left", "Flip left", "you")
    assert row.change == edit.score_change
    assert sorted(ears.heard) == ["changed", "history_changed", "saved_changed", "score_changed"]
    assert not np.array_equal(star.points[:, :2], before[:, :2])  # smoothed around it
    document.undo()
    assert star.steps == 0
    assert np.array_equal(star.points, before)
    assert not document.mesh_modified


@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_random_steps_undo_to_the_first_bit_and_redo(kind, star, triangles):
    mesh = star if kind == "quad" else triangles
    document = Document(mesh)
    rng = np.random.default_rng(5)
    start = (mesh.elements(), mesh.points.copy())
    infos = of_kind(kind)
    while document.history.cursor < 25:
        h = int(rng.choice(mesh.element_ids())) * mesh.k + int(rng.integers(mesh.k))
        operation = infos[rng.integers(len(infos))].operation
        if document.check(operation, h):
            document.submit(operation, h)
    end, scores = (mesh.elements(), mesh.points.copy()), [row.after for row in document.history]
    document.go_to(0)
    assert np.array_equal(mesh.elements(), start[0])
    assert np.array_equal(mesh.points[: len(start[1])], start[1])
    document.go_to(len(document.history))
    assert np.array_equal(mesh.elements(), end[0])
    assert np.array_equal(mesh.points, end[1])
    assert document.best_score == min([document.start_score, *scores])
    mesh.validate()


def test_a_refused_operation_changes_nothing_and_says_why(star):
    document = Document(star)
    ears = Ears(document)
    boundary = next(h for h in range(star.k * star.n_elements) if star.twin(h) < 0)
    with pytest.raises(OperationRefused, match=r"."):
        document.submit("flip_left", boundary)
    assert ears.heard == []
    assert document.history.cursor == star.steps == 0


def test_scores_and_normalised_return():
    assert normalised_return(12, 4, 4) == 1.0
    assert normalised_return(12, 8, 4) == 0.5
    assert normalised_return(4, 4, 4) == 1.0


def test_history_tracks_the_best_score_and_keeps_undone_steps_as_a_branch():
    history = History(10, 2)
    for before, after in ((10, 8), (8, 6), (6, 9)):
        history.append("flip", "Flip", 0, "you", before, after, 2)
    assert (history.start_score, history.best_score) == (10, 6)
    assert history.best_index(0) == 2
    assert history.best_index(2) == 2
    assert history.best_index(3) == 3
    history.step_back()
    history.step_back()
    assert history.best_score == 8
    history.append("flip", "Flip", 0, "you", 8, 7, 2)
    assert [row.after for row in history] == [8, 7]
    assert not history.can_redo
    assert [(branch.at, [row.after for row in branch.rows]) for branch in history.branches] == [
        (1, [6, 9])
    ]


def test_changing_a_desired_degree_restarts_the_return(star):
    document = Document(star)
    document.submit("flip_left", first_allowed(star, "flip_left"))
    interior = next(v for v in star.vertices().tolist() if not star.is_boundary(v))
    document.set_desired(interior, 5)
    assert document.start_score == document.score == document.best_score
    assert document.optimum == star.optimum
    document.undo()
    assert document.start_score == 12


def test_flags_are_steps_too(star):
    document = Document(star)
    vertex = int(star.vertices()[-1])
    document.set_locked(vertex, True)
    document.set_geometric(vertex, True)
    assert star.locked()[vertex]
    assert star.geometric()[vertex]
    assert [row.title for row in document.history] == ["Lock", "Make corner"]
    document.go_to(0)
    assert not star.locked()[vertex]
    assert not star.geometric()[vertex]


def test_at_the_optimum(strip):
    document = Document(strip)
    assert document.score == document.optimum == 0
    assert document.at_optimum
    assert document.normalised_return == 1.0


def test_clean_all_removes_the_lines_of_a_grid():
    side = np.arange(4)
    points = np.array([(x, y) for y in side for x in side], dtype=float)
    quads = [
        (4 * y + x, 4 * y + x + 1, 4 * y + x + 5, 4 * y + x + 4) for y in range(3) for x in range(3)
    ]
    document = Document(HalfEdgeMesh.from_elements(points, np.array(quads)))
    assert document.clean_all() > 0
    assert document.mesh.n_elements == 1
    assert document.history.cursor == 1
    assert document.clean_all() == 0
    assert document.history.cursor == 1
    document.undo()
    assert document.mesh.n_elements == 9


def test_an_empty_document_refuses_in_one_sentence():
    document = Document()
    assert document.empty
    assert document.score == document.optimum == 0
    assert not document.at_optimum
    assert document.undo() is None
    with pytest.raises(MeshError, match=r"no mesh yet"):
        document.submit("flip", 0)
    assert NO_MESH.endswith(".")


def test_files(star, tmp_path):
    document = Document(star, "star")
    with pytest.raises(MeshError, match="Save as"):
        document.save()
    document.submit("flip_left", first_allowed(star, "flip_left"))
    assert document.modified
    assert document.save(tmp_path / "five.vtk") == tmp_path / "five.vtk"
    assert not document.mesh_modified
    assert document.name == "five"
    other = Document()
    ears = Ears(other)
    other.open(tmp_path / "five.vtk")
    assert ears.heard[0] == "replaced"
    assert other.score == document.score
    (tmp_path / "broken.vtk").write_text("no mesh at all")
    kept = other.mesh
    with pytest.raises(MeshError):
        other.open(tmp_path / "broken.vtk")
    assert other.mesh is kept


def test_hover_ends_when_its_half_edge_is_deleted(star):
    document = Document(star)
    received: list[int] = []
    document.hover_changed.connect(received.append)
    collapsing = first_allowed(star, "collapse")
    document.hover = collapsing
    document.submit("collapse", collapsing)
    assert document.hover == -1
    assert received == [collapsing, -1]


@pytest.mark.parametrize(
    "module",
    [
        "meshwright.document.document",
        "meshwright.assistant.assistant",
        "meshwright.graphics.vtk_scene",
    ],
)
def test_import_brings_neither_qt_nor_torch(module):
    code = (
        f"import sys, {module}; "
        "sys.exit(any(m.split('.')[0] in ('torch', 'qtpy', 'PySide6', 'meshwright_agent') "
        "for m in sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0
