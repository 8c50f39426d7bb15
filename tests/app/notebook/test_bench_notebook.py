"""The benchmark suite of the widget, and its errors where a program is missing."""

import json
import socket
import subprocess
import sys
import time

import pytest

from meshwright import cli
from meshwright.benchmarks.notebook import chromium, servers
from meshwright.console import UserError


@pytest.mark.needs("chromium")
def test_suite_measures_clicks_panning_and_bytes(warm, capsys):
    assert cli.main(["bench", "--suite", "notebook", "--quick", "--json"]) == 0
    results = json.loads(capsys.readouterr().out)["results"]
    assert list(results) == ["100 elements", "1,000 elements"]
    for row in results.values():
        click = row["click_to_redrawn_ms"]
        parts = sum(click[name] for name in ("browser", "python", "transport", "paint"))
        assert 0 < parts < 2 * click["total"] <= 2 * click["slowest"]
        assert 0 < row["bytes"]["patch"] <= row["bytes"]["all"]
        assert row["panning"]["frames_per_second"] > 5
    small, large = (row["bytes"] for row in results.values())
    assert large["state"] > 5 * small["state"]
    assert large["patch"] < 2 * small["patch"]


@pytest.mark.parametrize(
    ("missing", "expected"),
    [("jupyterlab", "JupyterLab is not installed: pip install jupyterlab"), ("playwright", "Play")],
)
def test_suite_names_what_to_install(missing, expected, monkeypatch, capsys):
    find = servers.find_spec
    monkeypatch.setattr(servers, "find_spec", lambda name: None if name == missing else find(name))
    assert cli.main(["bench", "--suite", "notebook", "--quick"]) == 2
    output = capsys.readouterr().err
    assert expected in output and output.count("\n") == 1


def test_missing_chromium_is_named(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UserError, match="install the package chromium"):
        chromium.executable()


def test_server_that_does_not_start_reports_the_reason(tmp_path):
    words = "import sys; sys.exit('the port is taken')"
    command = [servers.sys.executable, "-c", words]
    with (
        pytest.raises(RuntimeError, match="the port is taken"),
        servers.running(command, servers.apart(tmp_path, {}), tmp_path / "log", "http://127.0.0.1"),
    ):
        pytest.fail("it did")


def test_server_ends_with_its_parent_process(tmp_path):
    path = tmp_path / "book.py"
    path.write_text("import marimo\napp = marimo.App()\n")
    code = (
        "import os, pathlib, sys; from meshwright.benchmarks.notebook import servers\n"
        "with servers.marimo(pathlib.Path(sys.argv[1])) as server:\n"
        "    print(server.url, flush=True)\n"
        "    os.kill(os.getpid(), 9)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, path], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == -9
    address = ("127.0.0.1", int(done.stdout.strip().rpartition(":")[2]))
    last = time.monotonic() + 20
    while time.monotonic() < last:
        try:
            socket.create_connection(address, timeout=1).close()
        except OSError:
            return
        time.sleep(0.1)
    pytest.fail("the server still runs")
