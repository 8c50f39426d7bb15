"""``meshwright batch``: bad files, resuming, killed workers, a cluster."""

import csv
import json
import os
import signal
import threading
import time

import pytest
from block_meshes import corner_blocks, two_regions

import meshwright_core
from meshwright import cli
from meshwright.cli.batches.cluster import run_on_cluster
from meshwright.cli.batches.workers import run_on_workers


@pytest.fixture
def parts(tmp_path):
    folder = tmp_path / "parts"
    folder.mkdir()
    for i in range(3):
        meshwright_core.write(folder / f"corner{i}.vtk", corner_blocks())
    (folder / "broken.vtk").write_text("no mesh")
    (folder / "notes.txt").write_text("no part")
    return folder


def run(capsys, parts, out, *more) -> dict:
    words = ["batch", str(parts), "-o", str(out), "--grids", "--to", ".geo"]
    assert cli.main([*words, "--options=--size 0.5", *more, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.slow
def test_a_bad_file_stops_nothing_and_a_second_run_goes_on(capsys, parts, tmp_path):
    out = tmp_path / "out"
    first = run(capsys, parts, out, "--jobs", "2")
    assert (first["parts"], first["done"], first["failed"], first["skipped"]) == (4, 3, 1, 0)
    assert "broken.vtk" in first["errors"]
    with (out / "batch.csv").open() as file:
        rows = {row["file"]: row for row in csv.DictReader(file)}
    assert rows["corner1.vtk"]["cells"] == "12"
    assert rows["broken.vtk"]["status"] == "failed"
    assert json.loads((out / "batch.json").read_text())["parts"][1]["blocks"] == 3
    before = (out / "corner0.geo").stat().st_mtime_ns
    (out / "corner1.geo").unlink()
    second = run(capsys, parts, out)
    assert (second["done"], second["skipped"]) == (3, 2)
    assert (out / "corner0.geo").stat().st_mtime_ns == before
    assert (out / "corner1.geo").exists()


@pytest.mark.slow
def test_the_part_of_a_killed_worker_is_done_by_another(parts, tmp_path):
    tasks = [
        (f"{i}", ["blocks", str(parts / f"corner{i % 3}.vtk"), "-o", str(tmp_path / f"{i}.geo")])
        for i in range(6)
    ]
    started: list[int] = []
    found = {}
    for number, (key, record) in enumerate(run_on_workers(tasks, 2, started.append)):
        found[key] = record
        if number == 0:
            os.kill(started[0], signal.SIGKILL)
    assert sorted(found) == [key for key, _ in tasks]
    assert all(record["status"] == "done" for record in found.values())
    assert len(started) >= 2
    assert all((tmp_path / f"{i}.geo").exists() for i in range(6))


@pytest.mark.slow
def test_a_cluster_does_the_parts_of_a_killed_worker_again(capsys, parts, tmp_path):
    distributed = pytest.importorskip("dask.distributed")
    for i in range(3, 9):
        meshwright_core.write(parts / f"corner{i}.vtk", two_regions())
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None
    ) as cluster:
        victim = next(iter(cluster.workers.values()))

        def kill_half_way() -> None:
            while not (tmp_path / "out" / "batch.log.jsonl").exists():
                time.sleep(0.02)
            os.kill(victim.pid, signal.SIGKILL)

        thread = threading.Thread(target=kill_half_way, daemon=True)
        thread.start()
        values = run(capsys, parts, tmp_path / "out", "--dask", cluster.scheduler_address)
        thread.join(timeout=60)
    assert (values["parts"], values["done"], values["failed"]) == (10, 9, 1)


@pytest.mark.slow
def test_a_cluster_keeps_no_records_that_were_collected(parts, tmp_path):
    """What a worker still holds when it ends, the cluster computes again."""
    distributed = pytest.importorskip("dask.distributed")
    tasks = [
        (str(i), ["blocks", str(parts / "corner0.vtk"), "-o", str(tmp_path / f"{i}.geo")])
        for i in range(4)
    ]
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=None
    ) as cluster:
        results = run_on_cluster(tasks, cluster.scheduler_address)
        assert sorted(next(results)[0] for _ in tasks) == [key for key, _ in tasks]
        until = time.monotonic() + 20.0
        while cluster.scheduler.tasks and time.monotonic() < until:
            time.sleep(0.05)
        assert not cluster.scheduler.tasks
        assert list(results) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere", "-o", "out"], "no such folder"),
        (["empty", "-o", "out"], "no drawing and no mesh file"),
        (["empty", "-o", "out", "--to", ".stl", "--grids"], "not one of a grid"),
        (["empty", "-o", "out", "--grids", "--options=--sizes 3"], "unrecognized arguments"),
        (["empty", "-o", "missing/out"], "does not exist"),
    ],
)
def test_wrong_use_is_one_sentence(capsys, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty").mkdir()
    assert cli.main(["batch", *words]) == 2
    output = capsys.readouterr()
    assert said in output.err
    assert output.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_without_dask_the_option_is_refused(capsys, parts, tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "dask.distributed", None)
    words = ["batch", str(parts), "-o", str(tmp_path / "out"), "--dask", "localhost:1"]
    assert cli.main(words) == 2
    assert "needs the package dask" in capsys.readouterr().err
