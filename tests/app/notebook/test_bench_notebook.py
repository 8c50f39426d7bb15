"""The suite that measures the widget in a browser, and what it says where something is missing."""

import json

import pytest

from app import cli
from app.benchmarks.notebook import chromium, servers
from app.report import UserError


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
    ("missing", "told"),
    [("jupyterlab", "JupyterLab is not installed: pip install jupyterlab"), ("playwright", "Play")],
)
def test_suite_says_what_to_install(missing, told, monkeypatch, capsys):
    find = servers.find_spec
    monkeypatch.setattr(servers, "find_spec", lambda name: None if name == missing else find(name))
    assert cli.main(["bench", "--suite", "notebook", "--quick"]) == 2
    said = capsys.readouterr().err
    assert told in said and said.count("\n") == 1


def test_missing_chromium_is_named(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UserError, match="install the package chromium"):
        chromium.executable()


def test_server_that_does_not_come_up_says_why(tmp_path):
    words = "import sys; sys.exit('the port is taken')"
    command = [servers.sys.executable, "-c", words]
    with (
        pytest.raises(RuntimeError, match="the port is taken"),
        servers.running(command, servers.apart(tmp_path, {}), tmp_path / "log", "http://127.0.0.1"),
    ):
        pytest.fail("it did")
