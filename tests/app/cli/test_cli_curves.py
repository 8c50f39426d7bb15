"""Curved shapes on the command line: drawings improved, meshes placed on drawings, exit codes."""

import json

import numpy as np
import pytest

import meshwright_core
from meshwright import cli
from meshwright_core import HalfEdgeMesh
from meshwright_core.curves.curve import Curve
from meshwright_core.domains import gallery, meshing
from meshwright_core.domains.domain import Domain
from meshwright_core.geometry import quality

pytestmark = pytest.mark.usefixtures("prepared_agent")

SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]
CIRCLE = {"arc": {"centre": [2, 2], "radius": 1, "start": 0, "sweep": 360}}
PLATE = {"outline": SQUARE, "holes": [[CIRCLE]]}
STADIUM = {
    "outline": [
        {"line": [[0, 0], [4, 0]]},
        {"arc": {"centre": [4, 1], "radius": 1, "start": -90, "sweep": 180}},
        {"line": [[4, 2], [0, 2]]},
        {"arc": {"centre": [0, 1], "radius": 1, "start": 90, "sweep": 180}},
    ]
}
INSERT = {
    "regions": [
        {"name": "steel", "outline": SQUARE, "holes": [[CIRCLE]]},
        {"name": "copper", "outline": [CIRCLE]},
    ]
}
AREAS = {"plate": 16 - np.pi, "stadium": 8 + np.pi, "insert": 16.0}


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv(cli.DEBUG, raising=False)
    for name, content in (("plate", PLATE), ("stadium", STADIUM), ("insert", INSERT)):
        (tmp_path / f"{name}.json").write_text(json.dumps(content))
    return tmp_path


@pytest.fixture
def run(capfd):
    """Run the command line with --json; return the exit code, the object and stderr."""

    def run_json(*words: str) -> tuple[int, dict, str]:
        code = cli.main([*words, "--json"])
        output = capfd.readouterr()
        assert output.out.count("\n") == 1
        return code, json.loads(output.out), output.err

    return run_json


def chords(name: str, path, edge: float = 0.5) -> HalfEdgeMesh:
    """Write a mesh of the polylines of a drawing, as other programs have them; return it."""
    domain = Domain.from_json(f"{name}.json")
    mesh = meshing.mesh_domain(Domain(domain.outline, domain.holes), "quad", max_edge=edge)
    meshwright_core.write(path, mesh)
    return mesh


def worst(mesh: HalfEdgeMesh) -> float:
    return float(quality.scaled_jacobian(mesh).min())


@pytest.mark.parametrize("kind", ["quad", "tri"])
@pytest.mark.parametrize("name", ["plate", "stadium"])
def test_a_drawing_is_improved_as_a_mesh_is(run, here, name, kind):
    words = ("improve", f"{name}.json", "-o", "out.vtk", "--kind", kind, "--search", "3")
    code, output, err = run(*words, "--png", "out.png")
    assert (code, err) == (0, "")
    assert output["area"] == pytest.approx(AREAS[name], rel=1e-9)
    assert output["inverted_elements"] == 0
    assert 0 < output["worst_scaled_jacobian"] <= 1
    assert output["optimum"] == Domain.from_json(f"{name}.json").optimum(kind)
    mesh = meshwright_core.read(here / "out.vtk")
    assert (mesh.kind, mesh.n_elements) == (kind, output["elements"])
    assert output["score_after"] <= output["score_before"]
    assert (here / "out.png").stat().st_size > 2000


def test_the_regions_of_a_drawing_stay(run, here):
    code, output, _ = run("improve", "insert.json", "-o", "out.vtk", "--search", "2")
    assert code == 0
    assert [row["name"] for row in output["regions"]] == ["steel", "copper"]
    areas = [row["area"] for row in output["regions"]]
    assert areas == pytest.approx([16 - np.pi, np.pi], rel=1e-9)
    assert sum(row["elements"] for row in output["regions"]) == output["elements"]
    mesh = meshwright_core.read(here / "out.vtk")
    assert np.bincount(mesh.regions()).tolist() == [r["elements"] for r in output["regions"]]


def test_a_shape_of_the_gallery_is_a_drawing_too(run):
    code, output, _ = run("improve", "l-shape", "-o", "out.vtk", "--rollouts", "1")
    assert code == 0
    assert output["area"] == pytest.approx(gallery.shape("l-shape").area)


def test_a_mesh_is_put_on_its_geometry(run, here):
    mesh = chords("plate", "in.vtk")
    words = ("improve", "in.vtk", "-o", "out.obj", "--geometry", "plate.json", "--search", "2")
    code, output, err = run(*words)
    assert (code, err) == (0, "")
    assert output["area"] == pytest.approx(AREAS["plate"], rel=1e-9)
    after = meshwright_core.read(here / "out.obj")
    rim = np.flatnonzero(after.boundary())
    away = np.hypot(*(after.points[rim, :2] - [2, 2]).T)
    on_hole = away < 1.5
    assert np.abs(away[on_hole] - 1.0).max() < 1e-12
    assert np.isin(after.points[rim[~on_hole], :2], (0.0, 4.0)).any(axis=1).all()
    assert output["elements_before"] == mesh.n_elements


def test_arcs_are_found_in_the_boundary_of_a_mesh(run):
    pytest.importorskip("meshwright_core.curves.fitting")
    angles = np.radians(np.linspace(-90, 90, 7))
    arc = np.column_stack((np.cos(angles), np.sin(angles)))
    outline = np.vstack(([4, 1] + arc, [0, 1] - arc))
    mesh = meshing.mesh_domain(Domain(outline), "quad", max_edge=1.0)
    meshwright_core.write("in.vtk", mesh)
    words = ("improve", "in.vtk", "-o", "out.vtk", "--fit-arcs", "--rollouts", "1")
    code, output, err = run(*words, "--steps", "20")
    assert (code, err) == (0, "")
    assert output["area"] == pytest.approx(AREAS["stadium"], rel=1e-6)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["in.vtk", "--geometry", "stadium.json"], "in.vtk: The boundary of the mesh has 2 loops"),
        (["in.vtk", "--geometry", "none.json"], "none.json: there is no such file"),
        (["in.vtk", "--geometry", "in.vtk"], "a file of a shape ends in one of"),
        (["plate.json", "--geometry", "plate.json"], "plate.json is itself a shape, no mesh"),
        (["in.vtk", "--kind", "tri"], "--kind: this is for drawings, and in.vtk is a mesh"),
        (["in.vtk", "--max-edge", "1"], "--max-edge: this is for drawings"),
        (["in.vtk", "--curve-step", "20"], "--curve-step: this is for drawings"),
        (["in.vtk", "--gap", "0.1"], "--gap: this is for drawings"),
        (["none.vtk"], "none.vtk: there is no such file"),
    ],
)
def test_what_does_not_fit_is_said(here, capfd, words, sentence):
    chords("plate", "in.vtk", 1.5)
    assert cli.main(["improve", *words, "-o", "out.vtk"]) == 2
    output = capfd.readouterr()
    assert output.out == "" and output.err.count("\n") == 1
    assert sentence in output.err
    assert not (here / "out.vtk").exists()


def test_elements_that_stay_inverted_give_exit_code_3(run, here):
    """A single quad with a reflex corner: nothing can be done about it."""
    dart = HalfEdgeMesh.from_elements([[0, 0], [2, 1], [0, 2], [1, 1]], [[0, 1, 2, 3]])
    meshwright_core.write("dart.vtk", dart)
    code, output, err = run("improve", "dart.vtk", "-o", "out.vtk", "--rollouts", "1")
    assert code == 3
    assert (output["inverted_elements"], output["inverted_ids"]) == (1, [0])
    assert output["worst_scaled_jacobian"] < 0
    assert err == "meshwright improve: out.vtk: 1 element is still inverted\n"
    assert (here / "out.vtk").exists()


def test_the_report_is_aligned(capfd):
    words = ["improve", "insert.json", "-o", "out.vtk", "--rollouts", "1"]
    assert cli.main(words) == 0
    lines = capfd.readouterr().out.splitlines()
    assert lines[0] == "insert.json -> out.vtk"
    names = [line[:16].strip() for line in lines[1:]]
    assert names == [
        "s", "elements", "area", "shape", "sum of squares", "blocks", "regions", "inverted",
        "operations", "end", "seconds",
    ]  # fmt: skip
    assert {line[:2] for line in lines[1:]} == {"  "}
    assert {line[16:18].strip() == "" for line in lines[1:]} == {True}
    assert any("steel" in line and "copper" in line for line in lines)


def test_mesh_measures_too(run):
    code, output, _ = run("mesh", "plate.json", "-o", "out.msh")
    assert code == 0
    assert output["area"] == pytest.approx(AREAS["plate"], rel=1e-9)
    assert output["worst_scaled_jacobian"] > 0
    assert "regions" not in output
    code, output, _ = run("mesh", "insert.json", "-o", "out.msh", "--kind", "tri")
    assert [row["name"] for row in output["regions"]] == ["steel", "copper"]


def test_curves_are_part_of_projects(here):
    """A mesh on curves that is saved as a project has its curves when it is read again."""
    from meshwright.document.document import Document

    mesh = meshing.mesh_domain(Domain.from_json("plate.json"), "quad")
    assert mesh.boundary_info.count == 2
    document = Document(mesh, "plate")
    document.save(here / "plate.meshwright")
    again = Document()
    again.open(here / "plate.meshwright")
    assert again.mesh is not None
    pieces = again.mesh.boundary_info.pieces
    assert sorted({piece.kind for row in pieces for piece in row}) == ["arc", "line"]


def test_an_arc_of_json_reads_as_itself():
    (loop,) = Domain.from_json("plate.json").boundary[1:]
    assert [curve.kind for curve in loop] == ["arc"]
    assert isinstance(loop[0], Curve)
