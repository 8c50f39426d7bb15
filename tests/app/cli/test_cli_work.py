"""The command line at work: what it writes can be read again, and says what it has done."""

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
        said = capfd.readouterr()
        assert said.err == ""
        assert said.out.count("\n") == 1
        return json.loads(said.out)

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
    said = run("mesh", "star", "-o", "star.vtk", "--kind", kind)
    mesh = meshwright_core.read(tmp_path / "star.vtk")
    mesh.validate()
    domain = gallery.shape("star")
    assert corners(mesh) == {(*np.round(p, 9), 0.0) for p in domain.outline}
    assert (said["kind"], said["elements"], said["vertices"]) == (
        kind,
        mesh.n_elements,
        mesh.n_vertices,
    )
    assert (said["score"], said["optimum"]) == (mesh.score, mesh.optimum)
    assert said["inverted_elements"] == len(quality.inverted(mesh)) == 0


def test_mesh_takes_a_polygon_file(run, tmp_path):
    hole = [[1, 1], [2, 1], [2, 2], [1, 2]]
    polygon = {"outline": [[0, 0], [0, 3], [3, 3], [3, 0]], "holes": [hole]}
    (tmp_path / "a.json").write_text(json.dumps(polygon))
    said = run("mesh", "a.json", "-o", "a.obj", "--kind", "quad", "--max-edge", "0.5")
    mesh = meshwright_core.read(tmp_path / "a.obj")
    assert mesh.euler == 0
    assert said["corners"] == 8
    ends = mesh.elements()
    lengths = np.linalg.norm(mesh.points[ends] - mesh.points[np.roll(ends, -1, axis=1)], axis=2)
    assert said["elements"] == mesh.n_elements
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
    said = run(*words, "--film", "out.gif")
    before, after = (
        meshwright_core.read(tmp_path / "in.vtk"),
        meshwright_core.read(tmp_path / "out.vtk"),
    )
    after.validate()
    assert corners(after) == corners(before)
    assert said["score_before"] == made["score"] == before.score
    assert said["score_after"] == after.score < before.score
    assert said["optimum"] == after.optimum == before.optimum
    assert said["elements"] == after.n_elements
    assert said["inverted_elements"] == len(said["inverted_ids"]) == len(quality.inverted(after))
    assert 1 <= said["rollouts"] <= 3  # it stops at the optimum
    assert said["operations"] > 0
    assert 0 < said["normalised_return"] <= 1
    with Image.open(tmp_path / "out.png") as picture:
        assert picture.size == (1200, 900)
    with Image.open(tmp_path / "out.gif") as film:
        assert film.n_frames == said["operations"] + 2  # the start, and the smoothing at the end


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
        said = run(*words, "--seed", "7")
        assert said["score_after"] <= said["score_before"]
        written.add((tmp_path / "a.obj").read_bytes())
    assert len(written) == 1


def test_improve_with_a_time_limit_as_text(run, capfd):
    run("mesh", "l-shape", "-o", "a.vtk", "--kind", "quad")
    assert cli.main(["improve", "a.vtk", "-o", "b.vtk", "--search", "0.5"]) == 0
    said = capfd.readouterr()
    assert said.err == ""
    assert said.out.startswith("a.vtk -> b.vtk\n")
    for word in ("s* = ", "elements", "inverted", "operations", "seconds"):
        assert word in said.out


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
    said = capfd.readouterr()
    assert said.err == ""
    assert said.out.count("\n") == 1
    assert "no display" in said.out
    assert str(tmp_path / "meshwright-demo.png") in said.out
    with Image.open(tmp_path / "meshwright-demo.png") as picture:
        assert picture.width == 3 * picture.height
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 20


@pytest.mark.slow
def test_demo_with_a_display_that_does_not_answer(run, monkeypatch):
    monkeypatch.setenv("DISPLAY", ":931")
    said = run("demo", "--shape", "l-shape", "--kind", "tri")
    assert said["window"] is False
    assert "Qt cannot open the display" in said["reason"]


def test_demo_writes_the_picture_that_is_asked_for(run, tmp_path):
    said = run("demo", "-o", "a.png")
    assert said["picture"] == str(tmp_path / "a.png")
    assert said["score_after"] < said["score_before"]


@pytest.mark.parametrize("words", [[], ["view"], ["star"]])
def test_window_without_a_display_is_refused(words, capfd):
    assert cli.main(words) == 2
    said = capfd.readouterr().err
    assert said.count("\n") == 1
    assert "there is no display here" in said


@pytest.mark.slow
def test_ctrl_c_leaves_the_old_file(run, tmp_path):
    run("mesh", "l-shape", "-o", "a.vtk", "--kind", "quad", "--max-edge", "0.04")
    (tmp_path / "b.vtk").write_text("old")
    code = (
        "import os, signal, sys, threading; from meshwright.cli import main; "
        "threading.Timer(5, os.kill, (os.getpid(), signal.SIGINT)).start(); "
        "sys.exit(main(['improve', 'a.vtk', '-o', 'b.vtk', '--search', '60']))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=os.environ
    )
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1, done.stderr
    assert "stopped by Ctrl-C" in done.stderr
    assert (tmp_path / "b.vtk").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.vtk", "b.vtk"]
