"""Checks of blank, wrong and right answers; listing and copying of lessons."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest

from meshwright import cli
from meshwright.cli.commands import lessons as command
from meshwright.teaching import Answer, exercise, lessons, patch
from meshwright.teaching.exercises.answer_parsing import (
    choice,
    mesh_of,
    result_of,
    whole_number,
    whole_numbers,
    yes_or_no,
)
from meshwright.teaching.exercises.example_meshes import PATCHES
from meshwright.teaching.exercises.exercise import MODULES, NoAnswer, WrongAnswer, declare
from meshwright.teaching.exercises.result import MIME
from meshwright.teaching.lessons import ExerciseCell
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.analysis.blocks import block_count
from meshwright_core.core.irregularity import desired_on_boundary
from meshwright_core.geometry import quality

NAMES = [cell.name for lesson in lessons.shipped() for cell in lesson.exercises()]

JUNK = (
    0,
    -1,
    10**30,
    0.5,
    float("nan"),
    True,
    "x",
    b"x",
    [],
    [None],
    {"a": 1},
    object(),
    len,
    lambda *_: 1 / 0,
    np.zeros(3),
    np.zeros((2, 2)),
    np.int32(1),
)


@pytest.mark.parametrize("name", NAMES)
def test_check_never_raises(name):
    found = exercise(name)
    code = found.judge.__code__
    for junk in JUNK:
        answer = found.check(*[junk] * code.co_argcount)
        assert isinstance(answer, Answer)
        assert answer.sentence
        assert len(answer.sentence) < 300


@pytest.mark.parametrize("name", NAMES)
def test_wrong_number_of_answers(name):
    answer = exercise(name).check(*[1] * 7)
    assert answer.state == "wrong"
    assert "7" in answer.sentence


@pytest.mark.parametrize("blank", [..., None, "", "  ", [..., 1], {"a": ...}, (1, [None])])
def test_blank_answers(blank):
    answer = exercise("1.1").check(blank)
    assert answer.state == "blank"
    assert not answer
    assert repr(answer).startswith("\u2026 1.1  Not answered yet.")
    assert exercise("1.1").check().state == "blank"


def test_function_without_a_body_is_blank():
    assert exercise("1.4").check(lambda mesh, h: ...).state == "blank"
    assert exercise("1.4").check(lambda mesh, h: None).state == "blank"


def test_unedited_mesh_is_blank():
    assert exercise("1.6").check(patch("flipped grid")).state == "blank"


def test_display_of_an_answer():
    answer = exercise("1.2").check(4)
    assert answer.passed
    bundle = answer._repr_mimebundle_()
    assert bundle["text/plain"].startswith("\u2713 1.2  Right.")
    assert "<code>next</code>" in bundle["text/html"]
    assert bundle[MIME] == {"exercise": "1.2", "state": "right", "passed": True}
    json.dumps(bundle)


def test_answers_are_escaped_in_html():
    answer = exercise("1.1").check("<script>alert(1)</script>")
    assert "<script" not in answer._repr_html_()


def test_minus_signs_in_sentences():
    assert "\u22124" in Answer("2.1", "wrong", "It was -4, not non-negative.")._repr_html_()
    assert "non-negative" in Answer("2.1", "wrong", "It was -4, not non-negative.")._repr_html_()


HALVES = (45, 135, 225, 315)


@pytest.mark.parametrize("angle", HALVES)
def test_halves_go_up_in_the_desired_degree(angle):
    """Lesson 2: one function that takes one of the halves down is told about it."""
    right = exercise("2.2")

    def desired(theta):
        return max(math.floor(theta / 90 + 0.5) + 1, 2)

    assert right.check(desired).passed
    assert desired(angle) == desired_on_boundary(np.array([float(angle)]), 4)[0]
    down = right.check(lambda theta: max(desired(theta) - (theta == angle), 1))
    assert down.state == "wrong"
    assert f"At {angle} degrees" in down.sentence and "halves go up" in down.sentence


def test_pythons_round_is_told_about_halves():
    answer = exercise("2.2").check(lambda theta: max(round(theta / 90) + 1, 2))
    assert answer.state == "wrong" and "halves go up" in answer.sentence


@pytest.mark.parametrize(("angle", "degree"), [(150, 4), (270, 6), (90, 3), (30, 2)])
def test_halves_go_up_in_triangles_too(angle, degree):
    """Lesson 2 says so of 150 and 270 degrees."""
    assert desired_on_boundary(np.array([float(angle)]), 3)[0] == degree


def squares(places, n=3):
    """Unit squares at the lower left corners `places`, each divided into n x n quads."""
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    inside = np.array([(i, j) for i in range(n) for j in range(n)])
    quads = np.array([n * np.array(place) + cell + corners for place in places for cell in inside])
    points, rows = np.unique(quads.reshape(-1, 2), axis=0, return_inverse=True)
    return HalfEdgeMesh.from_elements(points / n, rows.reshape(-1, 4))


U = [(0, 1), (0, 0), (1, 0), (2, 0), (2, 1)]


@pytest.mark.parametrize(
    ("places", "inwards", "shared", "blocks"),
    [
        ([(0, 0), (1, 0), (0, 1)], 1, 0, 3),
        ([(0, 0), (1, 0), (2, 0), (1, 1)], 2, 1, 4),
        (U, 2, 0, 5),
    ],
    ids=["L", "T", "U"],
)
def test_blocks_are_counted_without_a_mesh_as_lesson_5_says(places, inwards, shared, blocks):
    mesh = squares(places)
    assert mesh.score == 0
    assert block_count(mesh) == 1 + 2 * inwards - shared == blocks


def test_the_least_number_of_blocks_holds_for_a_score_of_0_only():
    """A U of three quads that meet along lines between its corners is one bent block; exercise 5.3
    counts five.
    """
    assert exercise("5.3").check(block_count(squares(U))).passed
    points = [(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)]
    mitred = HalfEdgeMesh.from_elements(points, [(0, 5, 6, 7), (0, 1, 4, 5), (1, 2, 3, 4)])
    assert mitred.optimum == 0 < mitred.score
    assert block_count(mitred) == 1
    asked = next(
        cell for cell in lesson_texts("05-block-decomposition") if "Count blocks without" in cell
    )
    assert "if *s* is to be 0" in asked and "there may be fewer" in asked


def lesson_texts(name):
    lesson = next(lesson for lesson in lessons.shipped() if lesson.name == name)
    cells = json.loads(lesson.path.read_text(encoding="utf-8"))["cells"]
    return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown"]


def test_lines_of_a_regular_rectangle_come_out_across_and_never_at_the_side():
    """The reason for exercise 4.4: the lines from below end above, in their order."""
    mesh = patch("wide grid")
    assert mesh.score == 0
    points, boundary = mesh.points, mesh.boundary()
    for vertex in np.flatnonzero(boundary & (points[:, 1] == 0) & ~mesh.geometric()):
        (h,) = (h for h in mesh.outgoing(vertex) if not boundary[mesh.target(h)])
        while not boundary[mesh.target(h)]:
            h = mesh.next(mesh.twin(mesh.next(h)))  # straight on
        assert points[mesh.target(h), 0] == points[vertex, 0]
        assert points[mesh.target(h), 1] == points[:, 1].max()
    # and what no flip, split or collapse can change, at any of their places
    mesh = patch("three to one")
    before = np.sort(points_of(mesh), axis=0)
    rng = np.random.default_rng(0)
    for _ in range(60):
        operation = ("flip_left", "flip_right", "split", "collapse")[rng.integers(4)]
        places = [h for h in range(4 * mesh.arrays.edge.shape[0]) if mesh.live(h)]
        h = int(rng.choice(places))
        if mesh.check(operation, h):
            mesh.apply(operation, h)
    assert mesh.steps > 10 and np.array_equal(np.sort(points_of(mesh), axis=0), before)
    assert exercise("4.4").check(False).passed


def points_of(mesh):
    """The vertices on the boundary."""
    return mesh.points[mesh.boundary() & (mesh.degree() > 0)]


def test_unknown_exercise():
    exercise("1.1")
    with pytest.raises(LookupError, match=r"no exercise '1\.77'"):
        exercise("1.77")
    with pytest.raises(LookupError, match="no exercise 'nonsense'"):
        exercise("nonsense")
    with pytest.raises(LookupError, match="no exercise '3'"):
        exercise(3)


def test_solutions_compile():
    for name in NAMES:
        solution = exercise(name).solution()
        compile(solution.code, name, "exec")
        assert solution.code in repr(solution)
        assert "<pre" in solution._repr_html_()


def test_declared_checks_are_found_by_name():
    @declare("9.9", "Try it.")
    def judge(answer):
        if answer == 1:
            raise WrongAnswer("Not that.")
        if answer == 2:
            raise NoAnswer
        return "So it is."

    states = [exercise("9.9").check(n).state for n in (1, 2, 3)]
    assert states == ["wrong", "blank", "right"]


def test_answer_parsing():
    assert whole_number(np.int64(3)) == whole_number(3.0) == 3
    assert whole_numbers(np.array([1, 2]), 2) == [1, 2]
    assert yes_or_no(" No ") is False
    assert yes_or_no(np.True_) is True
    assert choice("B", "ab") == "b"
    assert mesh_of(patch("fan")).k == 3
    for wrong in (
        lambda: whole_number(True),
        lambda: whole_number("1"),
        lambda: whole_numbers(3),
        lambda: result_of(3),
    ):
        with pytest.raises(WrongAnswer):
            wrong()
    with pytest.raises(WrongAnswer, match="ZeroDivisionError"):
        result_of(lambda: 1 / 0)


@pytest.mark.parametrize("name", PATCHES)
def test_patches_are_valid(name):
    mesh = patch(name)
    mesh.validate()
    assert mesh.optimum == 0
    assert mesh.steps == 0
    assert patch(name) is not mesh
    if name != "doublet":
        assert len(quality.inverted(mesh)) == 0


def test_unknown_patch():
    with pytest.raises(MeshError, match="did you mean hexagon"):
        patch("hexagn")


def test_solution_replaces_the_blank_answer():
    cell = ExerciseCell("1.1", 'answer = ...\nmw.exercise("1.1").check(answer)', "", ())
    assert cell.answered("answer = 96") == 'answer = 96\nmw.exercise("1.1").check(answer)'


def test_teaching_needs_neither_torch_nor_qt():
    code = "import meshwright.teaching, meshwright.teaching.lessons, sys; print(*sys.modules)"
    topics = "".join(
        f"; import meshwright.teaching.exercises.{topic}" for topic in list(MODULES.values())[:4]
    )
    done = subprocess.run(
        [sys.executable, "-c", code.replace("; print", f"{topics}; print")],
        capture_output=True,
        text=True,
        check=True,
    )
    assert not {"torch", "qtpy", "PySide6", "IPython"} & set(done.stdout.split())


def run(*words, capsys):
    code = cli.main(["lessons", *map(str, words)])
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_lessons_are_listed(capsys):
    code, out, _ = run(capsys=capsys)
    assert code == 0
    assert "01-half-edges" in out
    assert "Half-edges and degrees" in out
    assert "min" in out
    code, out, _ = run("--json", capsys=capsys)
    rows = json.loads(out)["lessons"]
    assert [row["name"] for row in rows] == [lesson.name for lesson in lessons.shipped()]
    assert all(20 <= row["minutes"] <= 30 and row["exercises"] >= 3 for row in rows)


def test_lessons_are_copied_and_not_overwritten(tmp_path, capsys):
    folder = tmp_path / "my lessons" / "here"
    code, out, _ = run(folder, capsys=capsys)
    assert code == 0
    assert f"jupyter lab '{folder}'" in out
    names = {lesson.path.name for lesson in lessons.shipped()}
    assert {path.name for path in folder.iterdir()} == names
    mine = folder / "01-half-edges.ipynb"
    mine.write_text("my answers")
    code, out, err = run(folder, capsys=capsys)
    assert (code, out) == (2, "")
    assert "would be overwritten" in err
    assert "--force" in err
    assert mine.read_text() == "my answers"
    assert run(folder, "--force", capsys=capsys)[0] == 0
    assert mine.read_bytes() == lessons.shipped()[0].path.read_bytes()
    assert {path.name for path in folder.iterdir()} == names


def test_missing_jupyterlab_is_reported(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command, "find_spec", lambda name: None)
    _, out, _ = run(tmp_path, capsys=capsys)
    assert out.endswith(f"not installed here: {command.INSTALL}\n")


@pytest.mark.parametrize(
    ("words", "reason"),
    [(["a-file"], "not a folder"), (["a-file/below"], "cannot be made"), ([""], "is empty")],
)
def test_bad_folders_are_refused_in_one_sentence(words, reason, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a-file").write_text("x")
    code, out, err = run(*words, capsys=capsys)
    assert (code, out) == (2, "")
    assert reason in err
    assert err.count("\n") == 1


def test_force_without_a_folder_is_refused(capsys):
    code, _, err = run("--force", capsys=capsys)
    assert code == 2
    assert "FOLDER" in err
