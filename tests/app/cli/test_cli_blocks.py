"""``meshwright blocks``: grids of meshes and shapes, named sides, refusals."""

import json

import pytest
from block_meshes import corner_blocks, two_regions

import meshwright_core
from meshwright import cli
from meshwright.document import block_edits
from meshwright.document.document import Document
from meshwright_core.blocks.structure import BlockStructure


@pytest.fixture
def corner(tmp_path):
    path = tmp_path / "corner.vtk"
    meshwright_core.write(path, corner_blocks())
    return path


def run(capsys, *words) -> dict:
    code = cli.main(["blocks", *map(str, words), "--json"])
    values = json.loads(capsys.readouterr().out)
    assert code == 0, values
    return values


def test_a_mesh_becomes_a_grid(capsys, corner, tmp_path):
    values = run(capsys, corner, "-o", tmp_path / "corner.geo", "--size", "0.25")
    assert (values["blocks"], values["chords"], values["cells"]) == (3, 4, 48)
    assert values["score"] == values["optimum"]
    assert values["worst_scaled_jacobian"] == pytest.approx(1.0)
    assert values["patches"] == [{"name": "outline", "cells": 32}]
    assert values["area"] == pytest.approx(3.0)
    assert (tmp_path / "corner.geo").read_text().count("Transfinite Surface") == 3


def test_layers_and_numbers_on_named_sides(capsys, corner, tmp_path):
    options = ["--size", "0.25", "--wall", "outline:0.01:1.3"]
    layered = run(capsys, corner, "-o", tmp_path / "blockMeshDict", *options)
    assert layered["cells"] > 48
    assert layered["worst_aspect_ratio"] > 5
    assert "type wall;" in (tmp_path / "blockMeshDict").read_text()
    given = run(capsys, corner, "-o", tmp_path / "a.vtu", "--count", "outline:40")
    assert given["patches"] == [{"name": "outline", "cells": 40}]


def test_a_layer_without_effect_is_said_in_one_line(capsys, corner, tmp_path):
    words = [corner, "-o", tmp_path / "a.geo", "--size", "0.25", "--wall", "outline:0.5"]
    assert cli.main(["blocks", *map(str, words), "--json"]) == 0
    output = capsys.readouterr()
    (remark,) = json.loads(output.out)["remarks"]
    assert "The layer at outline has no effect" in remark
    assert remark in output.err
    assert output.err.count("\n") == 1
    thin = run(capsys, corner, "-o", tmp_path / "b.geo", "--wall", "outline:0.01")
    assert thin["remarks"] == []


def test_the_text_names_the_files(capsys, corner, tmp_path):
    assert cli.main(["blocks", str(corner), "-o", str(tmp_path / "a.xyz"), "--divide", "2"]) == 0
    output = capsys.readouterr().out
    assert "a.xyz" in output
    assert "a.nmf" in output
    assert "3, in 4 chords" in output


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["-o", "a.geo", "--wall", "inlet:0.1"], "no side named 'inlet'; there are outline"),
        (["-o", "a.geo", "--wall", "inlet"], "not of the form NAME:HEIGHT[:RATIO]"),
        (["-o", "a.geo", "--wall", "outline:0.1:99"], "ratio of growth"),
        (["-o", "a.geo", "--wall", "outline:x"], "not a number"),
        (["-o", "a.geo", "--count", "outline:1.5"], "not a whole number"),
        (["-o", "a.geo", "--count", "outline:40", "--count", "outline:42"], "given twice"),
        (["-o", "a.geo", "--count", "outline:1"], "cannot have 1 cell."),
        (["-o", "a.geo", "--size", "1", "--divide", "2"], "not allowed with"),
        (["-o", "a.geo", "--order", "2"], "order 2 cannot be written as .geo"),
        (["-o", "a.geo", "--extrude", "1", "2"], "only a blockMeshDict is extruded"),
        (["-o", "a.txt"], "not one of a grid"),
        (["-o", "a.geo", "--size", "1e-7"], "cells; at most"),
        (["-o", "a.geo", "--count", "outline:1e18"], "cells are wanted; at most"),
        (["-o", "a.geo", "--wall", "outline:1e-30"], "too thin: at coordinates up to 2"),
        (["-o", "blockMeshDict", "--extrude", "1", "1000000000"], "OpenFOAM counts up to"),
        (["-o", "a.geo", "--min-shape", "7"], "not a number of 0 to 1"),
    ],
)
def test_wrong_use_is_one_sentence(capsys, corner, tmp_path, monkeypatch, options, words):
    monkeypatch.chdir(tmp_path)
    assert cli.main(["blocks", str(corner), *options]) == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.count("\n") == 1
    assert words in output.err
    assert [path.name for path in tmp_path.iterdir()] == ["corner.vtk"]


def test_triangles_are_refused(capsys, tmp_path):
    mesh = meshwright_core.HalfEdgeMesh.from_elements([(0, 0), (1, 0), (0, 1)], [[0, 1, 2]])
    meshwright_core.write(tmp_path / "t.vtk", mesh)
    assert cli.main(["blocks", str(tmp_path / "t.vtk"), "-o", str(tmp_path / "a.geo")]) == 2
    assert "triangles" in capsys.readouterr().err


@pytest.fixture
def named(tmp_path):
    """Two squares, of steel and copper, between an inlet and an outlet, as a Gmsh file."""
    mesh = two_regions()
    for name, (a, b) in (("inlet", (3, 0)), ("outlet", (2, 5))):
        mesh.name_sides([mesh.halfedge(a, b)], name)
    mesh.name_regions([0], "steel")
    mesh.name_regions([1], "copper")
    meshwright_core.write(tmp_path / "named.msh", mesh)
    return tmp_path / "named.msh"


@pytest.mark.parametrize("ending", [".su2", ".inp", ".msh", ".vtu"])
def test_names_of_sides_reach_meshes_of_quads(capsys, named, tmp_path, ending):
    output = tmp_path / f"fine{ending}"
    run(capsys, named, "-o", output, "--divide", "3")
    sides = {name: ends for name, ends in meshwright_core.read(output).sides().items() if name}
    assert {name: len(ends) for name, ends in sides.items()} == {
        "inlet": 3, "outlet": 3, "outline": 12
    }  # fmt: skip
    mesh = meshwright_core.read(output)
    assert (mesh.points[sides["inlet"], 0] == 0.0).all()
    assert (mesh.points[sides["outlet"], 0] == 2.0).all()
    if ending != ".su2":
        assert sorted(mesh.region_names) == ["copper", "steel"]


def test_names_that_a_format_cannot_hold_are_said(capsys, named, tmp_path):
    output = tmp_path / "fine.bdf"
    assert cli.main(["blocks", str(named), "-o", str(output), "--divide", "3"]) == 0
    assert "Nastran" in (said := capsys.readouterr().err)
    assert "'inlet', 'outlet' are lost" in said
    assert sorted(meshwright_core.read(output).region_names) == ["copper", "steel"]


def test_numbers_set_in_the_window_count_for_projects(capsys, tmp_path):
    document = Document(corner_blocks())
    structure = BlockStructure.of(document.mesh)
    chord = int(structure.chord[structure.edge_between(0, 1)])
    block_edits.set_count(document, structure, chord, 9)
    path = document.save(tmp_path / "corner.meshwright")
    values = run(capsys, path, "-o", tmp_path / "a.geo", "--divide", "2")
    assert sorted(values["counts"]) == [2, 2, 2, 9]
