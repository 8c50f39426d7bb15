"""``meshwright shapes FILE`` and the regions of drawings on the command line."""

import json
import math

import pytest

import meshwright_core
from meshwright import cli

BODY = (
    '<g id="steel"><path d="M0 0H50V40H0z"/></g><g id="copper"><path d="M50 0H90V40H50z"/></g>'
    '<circle cx="20" cy="20" r="5"/><path id="lug" d="M200 0H210V10H200z"/><text>A</text>'
)
SVG = f'<svg xmlns="http://www.w3.org/2000/svg">{BODY}</svg>'


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Run a command in a folder with a drawing; return code, output and errors."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(cli.DEBUG, raising=False)
    (tmp_path / "parts.svg").write_text(SVG)

    def run(*words: str) -> tuple[int, str, str]:
        code = cli.main(list(words))
        output = capsys.readouterr()
        return code, output.out, output.err

    return run


def test_regions_of_a_drawing_as_json(run):
    code, out, err = run("shapes", "parts.svg", "--json")
    assert (code, err) == (0, "")
    report = json.loads(out)
    assert [(r["name"], r["holes"], r["corners"], r["layer"]) for r in report["regions"]] == [
        ("steel", 1, 4, "steel"),
        ("copper", 0, 4, "copper"),
        ("lug", 0, 4, "lug"),
    ]
    areas = [region["area"] for region in report["regions"]]
    assert areas == pytest.approx([2000 - 25 * math.pi, 1600, 100])
    assert [r["touches"] for r in report["regions"]] == [["copper"], ["steel"], []]
    assert report["ignored"] == ["1 text left out"]
    assert report["repairs"] == []


def test_regions_of_a_drawing_as_a_table(run):
    code, out, _ = run("shapes", "parts.svg")
    assert code == 0
    lines = out.splitlines()
    assert lines[0] == "parts.svg: 3 regions"
    assert lines[1].split("  ")[1:3] == ["1", "steel"]
    assert "area 1921.46, 4 corners, 1 hole, touches 2" in lines[1]
    assert lines[-1] == "ignored: 1 text left out"


def test_mesh_of_regions(run):
    code, _, err = run("mesh", "parts.svg", "-o", "out.vtk")
    assert code == 2 and err.count("\n") == 1
    assert "2 separate outlines" in err and "--region" in err and "'steel'" in err
    for region, area in (("lug", 100), ("2", 1600), ("steel,copper", 3600 - 25 * math.pi)):
        code, out, _ = run("mesh", "parts.svg", "-o", "out.vtk", "--region", region, "--json")
        assert code == 0
        assert json.loads(out)["area"] == pytest.approx(area, rel=1e-6)
        meshwright_core.read("out.vtk").validate()
    code, _, err = run("mesh", "parts.svg", "-o", "out.vtk", "--region", "lid")
    assert (
        code == 2 and "no region 'lid'; the drawing has 'steel' (1), 'copper' (2), 'lug' (3)" in err
    )


def test_gaps_are_closed_as_wide_as_one_asks(run, tmp_path):
    (tmp_path / "open.wkt").write_text("LINESTRING(0 0, 4 0, 4 4, 0 4, 0 0.2)")
    code, _, err = run("shapes", "open.wkt")
    assert code == 2 and "(0, 0.2)" in err and "0.2 away" in err
    code, out, _ = run("shapes", "open.wkt", "--gap", "0.3")
    assert code == 0 and "mended: a gap of 0.2 closed at (0, 0.1)" in out


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["shapes", "none.svg"], "no such file"),
        (["shapes", "--gap", "1"], "--gap: this is for a drawing"),
        (["shapes", "parts.svg", "--gap", "-1"], "at least 0"),
        (["shapes", "parts.svg", "--layer", "lid"], "nothing on the layer lid"),
        (["mesh", "star", "-o", "out.vtk", "--region", "1"], "--region: this is for drawings"),
        (["mesh", "parts.svg", "-o", "out.vtk", "--region", "lug", "--curve-step", "0"], "0 deg"),
        (
            ["mesh", "parts.svg", "-o", "out.vtk", "--region", "lug", "--curve-step", "1e-6"],
            "no more than 50,000 are made",
        ),
    ],
)
def test_wrong_use(run, words, reason):
    code, _, err = run(*words)
    assert code == 2 and err.count("\n") == 1 and reason in err


def test_a_drawing_that_takes_too_long_is_refused_in_a_line(run, tmp_path):
    circles = "".join(f'<circle cx="9" cy="9" r="{1 + i / 3000}"/>' for i in range(1500))
    (tmp_path / "rings.svg").write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{circles}</svg>')
    for words in (["shapes", "rings.svg"], ["mesh", "rings.svg", "-o", "m.vtk"]):
        code, out, err = run(*words, "--time-limit", "0.2")
        assert (code, out) == (2, "")
        assert "more than 0.2 s of processor time" in err
        assert err.count("\n") == 1
    assert not (tmp_path / "m.vtk").exists()
