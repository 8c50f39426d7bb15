"""Kernels compiled once for all tests: by the warm-ups, in an empty cache.

`tests/conftest.py` calls :func:`prepare` before the first test, and `.ci/run` runs this file.
Copies of the cache as it is after each warm-up are kept, for `tests/test_cold_start.py`, which
would otherwise compile everything again.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numba
from filelock import FileLock

import meshwright_agent
import meshwright_core
from meshwright_agent import warm_up
from meshwright_core.core.compilation import cache_root, entry_points_on_disk

PACKAGES = ("meshwright_core", "meshwright_agent")
AGENT, EDITOR = "agent", "editor"
"""What has been warmed up: the agent in an empty cache, then the editor in the same one."""


def _kept() -> Path:
    """Where the copies are kept; the name contains a hash of all sources of both packages.

    Kernels are not enough: which of them are compiled depends on what calls them.
    """
    digest = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    for package in (meshwright_core, meshwright_agent):
        folder = Path(str(package.__file__)).parent
        digest.update(str(folder).encode())
        for path in sorted(folder.rglob("*.py")):
            digest.update(path.read_bytes())
    return cache_root() / f"tests-{digest.hexdigest()[:16]}"


def kept(stage: str) -> Path | None:
    """The cache after the warm-up `stage`, to be copied and not to be changed; None if there is
    none of these sources.
    """
    folder = _kept() / stage
    return folder if folder.is_dir() else None


def run(code: list[str], cache: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run Python with these arguments in `folder`, with the kernels in `cache`."""
    environment = {**os.environ, "MESHWRIGHT_CACHE_DIR": str(cache)}
    return subprocess.run(
        [sys.executable, *code], env=environment, cwd=folder, capture_output=True, text=True
    )


def prepare(report: Callable[[str], None]) -> None:
    """Compile what is missing, in one process at a time; `report` says so if it takes time."""
    if warm_up.is_warm_on_disk():
        return
    cache_root().mkdir(parents=True, exist_ok=True)
    with FileLock(cache_root() / "tests.lock"):
        if warm_up.is_warm_on_disk():
            return  # another process has compiled while this one waited
        report("compiling kernels; this takes some minutes, once")
        if not _compile_all():
            for package in PACKAGES:
                subprocess.run([sys.executable, "-m", f"{package}.warm_up"], check=False)


def _compile_all() -> bool:
    """Fill the empty cache of this machine, and keep copies; False if it is not empty, or if a
    warm-up failed.
    """
    if any(map(entry_points_on_disk, PACKAGES)):
        return False
    cache_root().mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=cache_root(), prefix="tests-") as scratch:
        cache, copies = Path(scratch) / "kernels", Path(scratch) / "copies"
        for stage, package in zip((AGENT, EDITOR), reversed(PACKAGES), strict=True):
            if run(["-m", f"{package}.warm_up"], cache, Path(scratch)).returncode:
                return False
            shutil.copytree(cache, copies / stage)
        if not _kept().exists():
            copies.rename(_kept())
        if any(map(entry_points_on_disk, PACKAGES)):
            return False  # another process has begun to fill it
        shutil.copytree(cache, cache_root(), dirs_exist_ok=True)
    return True


if __name__ == "__main__":
    prepare(print)
