"""`meshwright improve`: forms of answers, what the report says of them, and refusals."""

import json

import pytest

import meshwright as mw
import meshwright_core
from meshwright import cli
from meshwright.cli.commands.improve import search_time
from meshwright_core.geometry.element_shapes import element_shapes

pytestmark = pytest.mark.usefixtures("prepared_agent")


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(cli.DEBUG, raising=False)


@pytest.fixture
def run(capfd):
    def run_json(*words: str, code: int = 0) -> dict:
        assert cli.main([*words, "--json"]) == code
        return json.loads(capfd.readouterr().out)

    return run_json


@pytest.fixture
def fine(run):
    run("mesh", "star", "-o", "fine.vtk", "--max-edge", "0.2")
    return "fine.vtk"


def test_meshes_keep_their_size_and_drawings_become_blocks(run, fine):
    kept = run("improve", fine, "-o", "kept.vtk", "--rollouts", "4")
    assert kept["size_kept"] and kept["at_optimum"] and kept["valid"]
    assert abs(kept["elements"] / kept["elements_before"] - 1) <= 0.25
    blocks = run("improve", fine, "-o", "blocks.vtk", "--rollouts", "4", "--blocks")
    drawn = run("improve", "star", "-o", "drawn.vtk", "--rollouts", "4")
    for found in (blocks, drawn):
        assert not found["size_kept"] and found["elements"] < 0.3 * kept["elements"]
        assert found["blocks"] <= found["elements"]


def test_the_report_names_measures_bounds_and_the_end(run, capfd):
    words = ("improve", "star", "-o", "a.vtk", "--rollouts", "2")
    values = run(*words)
    mesh = meshwright_core.read("a.vtk")
    assert values["worst_shape"] == pytest.approx(element_shapes(mesh).min())
    assert values["worst_scaled_jacobian"] <= values["attainable"] + 1e-9
    assert 0 < values["shape_bound"] <= 1 and values["reason"] and values["valid"]
    assert values["sum_of_squares"] >= values["score_after"]
    assert cli.main([*words]) == 0
    text = capfd.readouterr().out
    bound = f"of at most {values['attainable']:.2f}"
    assert bound in text and "sum of squares" in text and values["reason"] in text


def test_preferences_and_wanted_shapes(run):
    words = ("improve", "star", "-o", "a.vtk", "--rollouts", "2")
    few = run(*words, "--prefer", "blocks")
    good = run(*words, "--prefer", "shape")
    assert few["elements"] <= good["elements"]
    assert few["worst_scaled_jacobian"] <= good["worst_scaled_jacobian"] + 1e-9
    divided = run(*words, "--elements-shape", "0.6")
    assert divided["worst_shape"] >= 0.6 and divided["divided"]
    assert run(*words, "--min-shape", "0.2")["worst_scaled_jacobian"] >= 0.2 - 1e-3


def test_an_input_with_inverted_elements_is_said(capfd):
    points = [(0, 0), (2, 0), (2, 2), (0, 2), (2.5, 1)]
    mesh = mw.HalfEdgeMesh.from_elements(
        points, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)], corner_angle=30
    )
    mw.write("folded.vtk", mesh)
    words = ["improve", "folded.vtk", "-o", "b.vtk", "--rollouts", "1"]
    assert cli.main(words) == 0
    output = capfd.readouterr()
    assert "none (before: 1)" in output.out
    assert "1 element was inverted; none is now" in output.err


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        (("--prefer", "few"), "invalid choice"),
        (("--min-shape", "2"), "not a number of 0 to 1"),
        (("--elements-shape", "1"), "between 0 and 1"),
        (("--blocks", "--kind", "tri"), "only quad meshes have blocks"),
        (("--elements-shape", "0.3", "--kind", "tri"), "only quad meshes have blocks"),
    ],
)
def test_what_cannot_be_asked_is_refused(more, sentence, capfd, tmp_path):
    assert cli.main(["improve", "star", "-o", "c.vtk", *more]) == 2
    assert sentence in capfd.readouterr().err
    assert not (tmp_path / "c.vtk").exists()


def test_the_same_in_python():
    mesh = mw.mesh("star")
    found = mw.solve(mesh, rollouts=2, elements_shape=0.5)
    assert found.worst_shape >= 0.5 and found.at_optimum and found.reason
    kept = mw.improve(mw.mesh("star"), rollouts=2)
    assert abs(kept.mesh.n_elements / mesh.n_elements - 1) <= 0.25
    with pytest.raises(mw.MeshError, match="prefer must be one of"):
        mw.solve(mesh, prefer="few")


@pytest.mark.parametrize(
    ("wanted", "loading", "left"), [(None, 3, None), (10, 0.4, 10), (10, 3, 8), (4, 30, 2)]
)
def test_long_loading_is_taken_off_the_time_of_the_search(wanted, loading, left):
    assert search_time(wanted, loading) == left
