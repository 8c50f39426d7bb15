"""Commands of the command line: their files can be read again, and their reports are right."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

import meshwright_core
from meshwright import cli
from meshwright_agent import warm_up
from meshwright_core.domains import gallery
from meshwright_core.geometry import quality

KINDS = ("tri", "quad")
pytestmark = pytest.mark.usefixtures("prepared_agent")


@pytest.fixture(autouse=True)
def in_a_folder_without_display(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.delenv(cli.DEBUG, raising=False)


@pytest.fixture
def run(capfd):
    """Run the command line with --json; return the one object that it prints."""

    def run_json(*words: str) -> dict:
        assert cli.main([*words, "--json"]) == 0, capfd.readouterr().err
        output = capfd.readouterr()
        assert output.err == ""
        assert output.out.count("\n") == 1
        return json.loads(output.out)

    return run_json


def corners(mesh) -> set[tuple[float, ...]]:
    ids = mesh.vertices()
    return {tuple(np.round(p, 9)) for p in mesh.points[ids[mesh.geometric()[ids]]]}


def test_shapes_lists_the_gallery(run, capfd):
    listed = run("shapes")["shapes"]
    assert [row["name"] for row in listed] == list(gallery.names())
    assert cli.main(["shapes"]) == 0
    assert "star" in capfd.readouterr().out


@pytest.mark.parametrize("kind", KINDS)
def test_mesh_writes_a_mesh_of_the_shape(run, kind, tmp_path):
    output = run("mesh", "star", "-o", "star.vtk", "--kind", kind)
    mesh = meshwright_core.read(tmp_path / "star.vtk")
    mesh.validate()
    domain = gallery.shape("star")
    assert corners(mesh) == {(*np.round(p, 9), 0.0) for p in domain.outline}
    assert (output["kind"], output["elements"], output["vertices"]) == (
        kind,
        mesh.n_elements,
        mesh.n_vertices,
    )
    assert (output["score"], output["optimum"]) == (mesh.score, mesh.optimum)
    assert output["inverted_elements"] == len(quality.inverted(mesh)) == 0


def test_mesh_takes_a_polygon_file(run, tmp_path):
    hole = [[1, 1], [2, 1], [2, 2], [1, 2]]
    polygon = {"outline": [[0, 0], [0, 3], [3, 3], [3, 0]], "holes": [hole]}
    (tmp_path / "a.json").write_text(json.dumps(polygon))
    output = run("mesh", "a.json", "-o", "a.obj", "--kind", "quad", "--max-edge", "0.5")
    mesh = meshwright_core.read(tmp_path / "a.obj")
    assert mesh.euler == 0
    assert output["corners"] == 8
    ends = mesh.elements()
    lengths = np.linalg.norm(mesh.points[ends] - mesh.points[np.roll(ends, -1, axis=1)], axis=2)
    assert output["elements"] == mesh.n_elements
    assert lengths.max() < 1.0


def test_same_seed_same_mesh(run, tmp_path):
    for name in ("a.obj", "b.obj"):
        run("mesh", "l-shape", "-o", name, "--kind", "tri", "--seed", "5")
    assert (tmp_path / "a.obj").read_bytes() == (tmp_path / "b.obj").read_bytes()


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.slow
def test_improve_keeps_corners_and_the_optimum(run, kind, tmp_path):
    made = run("mesh", "star", "-o", "in.vtk", "--kind", kind)
    words = ("improve", "in.vtk", "-o", "out.vtk", "--rollouts", "3", "--png", "out.png")
    output = run(*words, "--film", "out.gif")
    before, after = (
        meshwright_core.read(tmp_path / "in.vtk"),
        meshwright_core.read(tmp_path / "out.vtk"),
    )
    after.validate()
    assert corners(after) == corners(before)
    assert output["score_before"] == made["score"] == before.score
    assert output["score_after"] == after.score < before.score
    assert output["optimum"] == after.optimum == before.optimum
    assert output["elements"] == after.n_elements
    assert output["inverted_elements"] == len(quality.inverted(after))
    assert output["inverted_elements"] == len(output["inverted_ids"])
    assert 0 <= output["rollouts"] <= 3  # none where patches are enough; it stops at the optimum
    assert output["operations"] > 0
    assert 0 < output["normalised_return"] <= 1
    with Image.open(tmp_path / "out.png") as picture:
        assert picture.size == (1200, 900)
    with Image.open(tmp_path / "out.gif") as film:
        assert film.n_frames == output["operations"] + 2  # the start, and the smoothing at the end


def test_improve_announces_the_compilation(run, capfd, monkeypatch):
    run("mesh", "l-shape", "-o", "a.vtk", "--kind", "quad")
    monkeypatch.setattr(warm_up, "is_warm_on_disk", lambda: False)
    monkeypatch.setattr(warm_up, "warm", lambda tell: None)
    assert cli.main(["improve", "a.vtk", "-o", "a.vtk", "--rollouts", "1"]) == 0
    assert "Preparing the agent" in capfd.readouterr().err


@pytest.mark.slow
def test_improve_in_place_with_a_budget_and_the_same_seed(run, tmp_path):
    run("mesh", "l-shape", "-o", "a.obj", "--kind", "quad")
    original = (tmp_path / "a.obj").read_bytes()
    written = set()
    for _ in range(2):
        (tmp_path / "a.obj").write_bytes(original)
        words = ("improve", "a.obj", "-o", "a.obj", "--rollouts", "2", "--steps", "5")
        output = run(*words, "--seed", "7")
        assert output["score_after"] <= output["score_before"]
        written.add((tmp_path / "a.obj").read_bytes())
    assert len(written) == 1


def test_improve_with_a_time_limit_as_text(run, capfd):
    run("mesh", "l-shape", "-o", "a.vtk", "--kind", "quad")
    assert cli.main(["improve", "a.vtk", "-o", "b.vtk", "--search", "0.5"]) == 0
    output = capfd.readouterr()
    assert output.err == ""
    assert output.out.startswith("a.vtk -> b.vtk\n")
    for word in ("s* = ", "elements", "inverted", "operations", "seconds"):
        assert word in output.out


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.slow
def test_evaluate_reports_a_row(run, kind):
    row = run("evaluate", "--kind", kind, "--sides", "5-6", "--meshes", "2", "--rollouts", "2")
    keys = ("single_mean", "single_std", "best_mean", "best_std", "at_optimum")
    assert all(isinstance(row[key], float) for key in keys)
    assert row["operations_median"] >= 0
    assert row["seconds"] > 0
    assert row["best_mean"] >= row["single_mean"]


def test_demo_without_a_display_writes_a_picture_and_says_so(tmp_path, capfd):
    assert cli.main(["demo"]) == 0
    output = capfd.readouterr()
    assert output.err == ""
    assert output.out.count("\n") == 1
    assert "no display" in output.out
    assert str(tmp_path / "meshwright-demo.png") in output.out
    with Image.open(tmp_path / "meshwright-demo.png") as picture:
        assert picture.width == 3 * picture.height
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 20


@pytest.mark.slow
def test_demo_with_a_display_that_does_not_answer(run, monkeypatch):
    monkeypatch.setenv("DISPLAY", ":931")
    output = run("demo", "--shape", "l-shape", "--kind", "tri")
    assert output["window"] is False
    assert "Qt cannot open the display" in output["reason"]


def test_demo_writes_the_picture_that_is_asked_for(run, tmp_path):
    output = run("demo", "-o", "a.png")
    assert output["picture"] == str(tmp_path / "a.png")
    assert output["score_after"] < output["score_before"]


@pytest.mark.parametrize("words", [[], ["view"], ["star"]])
def test_window_without_a_display_is_refused(words, capfd):
    assert cli.main(words) == 2
    output = capfd.readouterr().err
    assert output.count("\n") == 1
    assert "there is no display here" in output


# How long a search takes depends on the machine, so the first report of its progress interrupts it.
_INTERRUPTED_SEARCH = """
import os, signal, sys
from meshwright.cli import main
from meshwright_agent.search import improvement

search = improvement.improve

def interrupted(*arguments, progress, **options):
    def report(done, best):
        os.kill(os.getpid(), signal.SIGINT)
        progress(done, best)
    return search(*arguments, progress=report, **options)

improvement.improve = interrupted
sys.exit(main(["improve", "a.vtk", "-o", "b.vtk", "--blocks", "--search", "60"]))
"""


@pytest.mark.slow
def test_ctrl_c_leaves_the_old_file(run, tmp_path):
    run("mesh", "l-shape", "-o", "a.vtk", "--kind", "quad", "--max-edge", "0.04")
    (tmp_path / "b.vtk").write_text("old")
    done = subprocess.run(
        [sys.executable, "-c", _INTERRUPTED_SEARCH], capture_output=True, text=True, env=os.environ
    )
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1, done.stderr
    assert "stopped by Ctrl-C" in done.stderr
    assert (tmp_path / "b.vtk").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.vtk", "b.vtk"]
