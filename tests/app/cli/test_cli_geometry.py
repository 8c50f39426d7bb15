"""Files of shapes on the command line: drawings are meshed; bad ones end in one sentence."""

import json

import pytest

import meshwright_core
from meshwright import cli
from meshwright.cli.commands import view
from meshwright.document.document import Document

SLOT = '<path d="M0 0H60A20 20 0 0 1 60 40H0Z"/><circle cx="60" cy="20" r="8"/>'
SVG = f'<svg xmlns="http://www.w3.org/2000/svg">{SLOT}</svg>'
PAIRS = "0 SECTION 2 ENTITIES 0 LWPOLYLINE 8 0 90 4 70 1 10 0 20 0 10 9 20 0 10 9 20 4 10 0 20 4"
DXF = "\n".join(f"{PAIRS} 0 ENDSEC 0 EOF".split())
WKT = "POLYGON ((0 0, 9 0, 9 4, 0 4, 0 0), (2 1, 2 3, 4 3, 2 1))"
GEOJSON = json.dumps({"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [0, 4], [0, 0]]]})

SOUND = {"part.svg": SVG, "part.dxf": DXF, "part.wkt": WKT, "part.geojson": GEOJSON}
BAD = {
    "cut.svg": (SVG[:50], "not XML"),
    "cut.dxf": (DXF[:-8], "cut off"),
    "cut.wkt": (WKT[:30], "not sound WKT"),
    "cut.geojson": (GEOJSON[:40], "not JSON"),
    "open.dxf": (DXF.replace("70\n1", "70\n0"), "the outline is open"),
}


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(cli.DEBUG, raising=False)
    return tmp_path


@pytest.mark.parametrize("name", SOUND)
def test_mesh_of_a_drawing(here, capsys, name):
    (here / name).write_text(SOUND[name])
    assert cli.main(["mesh", name, "-o", "out.vtk", "--max-edge", "5", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    mesh = meshwright_core.read(here / "out.vtk")
    assert mesh.kind == report["kind"] == "quad"
    assert mesh.n_elements == report["elements"]
    mesh.validate()


def test_curved_sides_drawn_as_short_pieces_have_no_corners_above_the_angle(here, capsys):
    import shapely

    (here / "disc.wkt").write_text(shapely.Point(0, 0).buffer(1).wkt)
    corners = []
    for words in ([], ["--corner-angle", "20"]):
        assert cli.main(["mesh", "disc.wkt", "-o", "out.obj", "--json", *words]) == 0
        corners.append(json.loads(capsys.readouterr().out)["corners"])
    assert corners == [64, 0]


@pytest.mark.parametrize("name", BAD)
@pytest.mark.parametrize("words", [["mesh", "-o", "out.vtk"], ["view"]])
def test_bad_drawing(here, capsys, name, words):
    text, expected = BAD[name]
    (here / name).write_text(text)
    assert cli.main([words[0], name, *words[1:]]) == 2
    output = capsys.readouterr()
    assert output.out == "" and output.err.count("\n") == 1
    assert name in output.err and expected in output.err
    assert not (here / "out.vtk").exists()


def test_what_is_mended_or_left_out_is_noted(here, capsys):
    body = '<rect width="9" height="9"/><rect width="9" height="9"/><path d="M 20 0 L 20 5"/>'
    (here / "twice.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>')
    assert cli.main(["mesh", "twice.svg", "-o", "twice.vtk"]) == 0
    notes = capsys.readouterr().err.splitlines()
    assert any("twice.svg: " in note and "drawn more than once" in note for note in notes)
    assert any("left out, the first at (20, 0)" in note for note in notes)
    (here / "once.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{body[:28]}</svg>')
    assert cli.main(["mesh", "once.svg", "-o", "once.vtk"]) == 0
    assert capsys.readouterr().err == ""


def test_a_mesh_is_no_drawing(here, capsys):
    (here / "part.svg").write_text(SVG)
    assert cli.main(["mesh", "part.svg", "-o", "out.vtk"]) == 0
    capsys.readouterr()
    assert cli.main(["mesh", "out.vtk", "-o", "more.vtk"]) == 2
    assert "a file of a shape ends in one of .dxf" in capsys.readouterr().err


def test_the_window_opens_a_drawing(here):
    import argparse

    (here / "part.dxf").write_text(DXF)
    words = argparse.Namespace(file="part.dxf", kind="tri", corner_angle=None)
    document = view._document(words)
    assert (document.kind, document.name, document.path) == ("tri", "part", None)


def test_a_document_opens_a_drawing_and_is_unchanged_by_a_bad_one(here, star):
    (here / "part.svg").write_text(SVG)
    (here / "cut.svg").write_text(SVG[:50])
    document = Document(star, "star")
    with pytest.raises(meshwright_core.MeshError, match="not XML"):
        document.open(here / "cut.svg")
    assert document.mesh is star
    document.open(here / "part.svg")
    assert (document.kind, document.name, document.path) == ("quad", "part", None)
