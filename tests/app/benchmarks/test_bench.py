"""The suites of ``meshwright bench`` run, and report numbers by name."""

import json
from types import SimpleNamespace

import pytest

from meshwright import benchmarks, cli
from meshwright.benchmarks import ablation, block_cells, gmsh_peer, parts, search_speed
from meshwright_core.domains import random_parts


def test_suites_are_listed(capsys):
    assert cli.main(["bench"]) == 0
    listed = capsys.readouterr().out
    assert all(name in listed for name in benchmarks.names())


def test_unknown_suite_is_refused(capsys):
    assert cli.main(["bench", "--suite", "speed"]) == 2
    assert "choose from" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["core", "file_fuzz", "fuzz", "large", "large_files", "levels"])
@pytest.mark.slow
def test_suite_runs(name, capsys):
    assert cli.main(["bench", "--suite", name, "--quick", "--json"]) == 0
    output = capsys.readouterr()
    assert output.err == ""
    values = json.loads(output.out)
    assert values["suite"] == name
    assert values["results"]
    assert values["machine"]["cores"]


@pytest.mark.slow
def test_fuzz_finds_no_violation(capsys):
    assert cli.main(["bench", "--suite", "fuzz", "--quick", "--json", "--seed", "3"]) == 0
    results = json.loads(capsys.readouterr().out)["results"]
    for kind in ("tri", "quad"):
        assert list(results[kind]) == ["straight", "curved", "interfaces"]
        assert all(row["violations"] == 0 for row in results[kind].values())


def test_parts_suite_prints_a_table(capsys):
    command = ["bench", "--suite", "parts", "--quick", "--seconds", "2"]
    assert cli.main([*command, "--json"]) == 0
    results = json.loads(capsys.readouterr().out)["results"]
    assert list(results) == ["gallery", "8-24 corners", "25-50 corners"]
    for group in results.values():
        assert group["meshes"] == len(group["shapes"]) == group["corners kept"]
        for row in group["shapes"].values():
            assert row["s*"] <= row["s"] <= row["s start"]
            assert 1 <= row["blocks"] <= row["elements"]
            assert (row["worst SJ"] > 0) == (row["worst shape"] > 0) == (row["inverted"] == 0)
            assert 0 < row["q*"] <= 1
            usable = row["s"] == row["s*"] and row["worst SJ"] >= parts.USABLE
            assert row["first usable"] is not None or not usable
            assert row["last better"] is not None
            assert (row["first usable"] or 0.0) <= row["last better"]


def test_share_of_rows_that_have_something_by_a_time():
    rows = [{"at": at} for at in (3.0, 1.0, None, 2.0)]
    assert [parts.reached_by(share, rows, "at") for share in (0.25, 0.5, 0.75, 0.9)] == [
        1.0, 2.0, 3.0, None,
    ]  # fmt: skip
    group = {"meshes": 1, "at, seconds, 90 %": None, "shapes": {"a": {"first usable": None}}}
    assert "90 %: never" in parts.text({"group": group})


def test_block_cells_suite_prints_a_row_for_each_number_of_cells(capsys):
    command = ["bench", "--suite", "block_cells", "--quick", "--seconds", "10"]
    assert cli.main([*command, "--json"]) == 0
    results = json.loads(capsys.readouterr().out)["results"]
    assert list(results["sizes"]) == ["1,000", "4,000"]
    for row in results["sizes"].values():
        assert row["all"] == pytest.approx(
            sum(row[stage] for stage in block_cells.STAGES), abs=0.01
        )
        assert row["cells"] > 500
    assert "blocks, s = " in block_cells.text(results)


def test_ablation_compares_the_search_with_parts_of_it_left_out(capsys):
    command = ["bench", "--suite", "ablation", "--quick", "--seconds", "1", "--meshes", "1"]
    assert cli.main([*command, "--json"]) == 0
    results = json.loads(capsys.readouterr().out)["results"]
    for group in results.values():
        assert list(group) == list(ablation.VARIANTS)
        assert all(row["parts"] == 1 and row["not inverted"] == 1 for row in group.values())


def test_speed_of_the_search_is_counted(capsys):
    command = ["bench", "--suite", "search_speed", "--quick", "--seconds", "3"]
    assert cli.main([*command, "--json"]) == 0
    results = json.loads(capsys.readouterr().out)["results"]
    assert list(results) == ["8-24 corners", "25-50 corners"]
    for row in results.values():
        assert all(rate >= 1 for rate in row.values())
    assert "evaluated moves / s" in search_speed.text(results)


def test_options_of_the_search_are_refused_by_suites_without():
    assert cli.main(["bench", "--suite", "fuzz", "--quick", "--prefer", "shape"]) == 2
    assert cli.main(["bench", "--suite", "parts", "--elements-shape", "2"]) == 2


@pytest.mark.skipif(not gmsh_peer.available(), reason="needs the module gmsh (pip install gmsh)")
def test_gmsh_meshes_a_part_with_about_as_many_quads():
    domain = random_parts.parts(2, (8, 24), 1)[1]
    columns = gmsh_peer.measured(domain, 200)
    for way in gmsh_peer.WAYS:
        assert 100 < columns[f"{way}: elements"] < 400


def test_peer_takes_the_size_that_gives_the_nearest_number(monkeypatch):
    domain = random_parts.parts(2, (8, 24), 1)[1]
    counts, tried = [None, 5, 90, 120, 500], []

    def meshed(domain, size, options):
        tried.append(size)
        count = counts[len(tried) - 1]
        return None if count is None else SimpleNamespace(n_elements=count)

    monkeypatch.setattr(gmsh_peer, "meshed", meshed)
    assert gmsh_peer.nearest(domain, 100, {}).n_elements == 90
    assert len(tried) == 4 and tried == sorted(tried, reverse=True)


def test_seconds_option_is_refused_by_suites_without_search(capsys):
    assert cli.main(["bench", "--suite", "fuzz", "--quick", "--seconds", "2"]) == 2
    assert "has no search time" in capsys.readouterr().err
    assert cli.main(["bench", "--suite", "fuzz", "--quick", "--meshes", "2"]) == 2
    assert "has fixed meshes" in capsys.readouterr().err


@pytest.mark.slow
def test_curved_parts_suite_prints_a_table(capsys):
    command = ["bench", "--suite", "curved_parts", "--quick", "--seconds", "2"]
    assert cli.main([*command, "--json"]) == 0
    results = json.loads(capsys.readouterr().out)["results"]
    assert results["meshes"] == len(results["shapes"]) == 2
    for row in results["shapes"].values():
        assert row["s*"] <= row["s"] <= row["s start"] < row["15 degrees: s"]
        assert row["quads start"] < row["15 degrees: quads"]
        assert row["area error"] < 1e-6
