"""Checks of blank, wrong and right answers; listing and copying of lessons."""

import json
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
from meshwright_core import MeshError
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
