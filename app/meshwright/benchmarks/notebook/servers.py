"""Starts JupyterLab or marimo on a free port with temporary folders, and always ends it.

The user's settings are neither read nor written, and no other machine is contacted.
"""

from __future__ import annotations

import os
import secrets
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from meshwright.console import UserError

PATIENCE = 90.0
"""Seconds until a server must answer."""
SETTINGS = """{
    "@jupyterlab/apputils-extension:notification":
        {"fetchNews": "false", "checkForUpdates": false, "doNotDisturbMode": true},
    "@jupyterlab/notebook-extension:tracker": {"windowingMode": "none"},
    "@jupyterlab/docmanager-extension:plugin": {"autosave": false}
}"""
KEEPER = """
import os, subprocess, sys, threading
server = subprocess.Popen(sys.argv[1:], stdin=subprocess.DEVNULL)
threading.Thread(target=lambda: os._exit(server.wait()), daemon=True).start()
sys.stdin.read()  # ends when the parent process closes it or ends
server.terminate()
try:
    server.wait(10)
except subprocess.TimeoutExpired:
    server.kill()
"""
"""Ends a server when the process that started it has ended, even if it was killed."""
MARIMO = """[runtime]
auto_instantiate = true
auto_reload = "off"
[display]
theme = "system"
[save]
autosave = "off"
"""


@dataclass(frozen=True)
class Server:
    """Where a server answers, and the folder that its notebooks are in."""

    url: str
    folder: Path
    token: str = ""


@contextmanager
def jupyterlab() -> Iterator[Server]:
    """Start JupyterLab in an empty folder and yield it.

    Raises UserError if it is not installed, RuntimeError if it does not come up.
    """
    need("jupyterlab", "JupyterLab")
    with tempfile.TemporaryDirectory(prefix="meshwright-lab-") as name:
        home = Path(name)
        book = home / "books"
        book.mkdir()
        settings = home / "app-settings"
        settings.mkdir()
        (settings / "overrides.json").write_text(SETTINGS)
        port, token = free_port(), secrets.token_hex(16)
        command = [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root"]
        command += ["--ServerApp.ip=127.0.0.1", f"--ServerApp.port={port}"]
        command += ["--ServerApp.port_retries=0", f"--ServerApp.root_dir={book}"]
        command += [f"--IdentityProvider.token={token}", "--LabApp.expose_app_in_browser=True"]
        command += ["--LabApp.extension_manager=readonly", f"--LabApp.app_settings_dir={settings}"]
        command += ["--LabApp.news_url=", "--ServerApp.terminals_enabled=False"]
        own = {
            "JUPYTER_CONFIG_DIR": home / "config",
            "JUPYTER_DATA_DIR": home / "data",
            "JUPYTER_RUNTIME_DIR": home / "runtime",
            "JUPYTERLAB_SETTINGS_DIR": home / "settings",
            "JUPYTERLAB_WORKSPACES_DIR": home / "workspaces",
            "IPYTHONDIR": home / "ipython",
        }
        url = f"http://127.0.0.1:{port}"
        with running(command, apart(home, own), home / "log", f"{url}/api?token={token}"):
            yield Server(url, book, token)


@contextmanager
def marimo(path: Path, run: bool = False) -> Iterator[Server]:
    """Start marimo with the notebook at ``path``, to be edited or just run, and yield it.

    Raises UserError if it is not installed, RuntimeError if it does not come up.
    """
    need("marimo", "marimo")
    with tempfile.TemporaryDirectory(prefix="meshwright-marimo-") as name:
        home = Path(name)
        (home / "marimo").mkdir()
        (home / "marimo" / "marimo.toml").write_text(MARIMO)
        port = free_port()
        command = [sys.executable, "-m", "marimo", "--quiet", "run" if run else "edit", str(path)]
        command += ["--headless", "--no-token", "--host=127.0.0.1", f"--port={port}"]
        if not run:
            command.append("--skip-update-check")
        url = f"http://127.0.0.1:{port}"
        with running(command, apart(home, {}), home / "log", f"{url}/health"):
            yield Server(url, path.parent)


def need(module: str, title: str) -> None:
    """Raise UserError with what to install if ``module`` is missing."""
    if find_spec(module) is None:
        raise UserError(f"{title} is not installed: pip install {module}")


def free_port() -> int:
    """A free port."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        port: int = listener.getsockname()[1]
        return port


def apart(home: Path, own: dict[str, Path]) -> dict[str, str]:
    """The environment of a process that keeps what it writes in ``home``."""
    folders = {f"XDG_{what}_HOME": str(home) for what in ("CONFIG", "STATE", "DATA")}
    more = {name: str(path) for name, path in own.items()}
    return {**os.environ, **folders, **more, "NO_PROXY": "127.0.0.1"}


@contextmanager
def running(command: Sequence[str], environment: dict[str, str], log: Path, url: str) -> Iterator:
    """Run a server until the block ends; the block begins when ``url`` answers."""
    with log.open("w") as output:
        process = subprocess.Popen(
            [sys.executable, "-c", KEEPER, *command],
            cwd=log.parent,  # python -m looks into the present folder first
            env=environment,
            stdin=subprocess.PIPE,
            stdout=output,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
    try:
        _await(process, url, log)
        yield
    finally:
        _end(process)


def _await(process: subprocess.Popen[bytes], url: str, log: Path) -> None:
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))
    last = time.monotonic() + PATIENCE
    while time.monotonic() < last:
        if process.poll() is not None:
            break
        try:
            with opener.open(url, timeout=5):
                return
        except OSError:  # not yet
            time.sleep(0.05)
    words = log.read_text(errors="replace").strip().splitlines()[-3:]
    raise RuntimeError(f"The notebook server did not come up: {' '.join(words) or 'no message'}")


def _end(process: subprocess.Popen[bytes]) -> None:
    """Shut the server and its kernels down; kill it if it does not end."""
    if process.stdin is not None:
        process.stdin.close()
    try:
        process.wait(15.0)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
