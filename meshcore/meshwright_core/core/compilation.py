"""Compiled kernels: one decorator, one cache on disk, one warm-up.

Numba's own cache is invalidated by edits of the file of the function only, not by those of an
*imported* kernel. Here the name of the cache folder contains a hash of all sources of the package,
so that any edit leads to a new folder. Folders that were not used for a month are removed.
"""

from __future__ import annotations

import hashlib
import importlib
import os
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
import platformdirs
from numba.core import config as numba_config

from meshwright_core.core.linking import Kernel, SharedKernel, note_unwritable

F = TypeVar("F", bound=Callable[..., Any])


@cache
def _source_hash(folder: Path) -> str:
    """Hash of the sources below `folder` that take part in kernels, and of the versions of numba
    and Python. Constants count too, so every file that kernels import is among them.
    """
    digest = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    for path in sorted(folder.rglob("*.py")):
        source = path.read_bytes()
        if b"kernel" in source or path.name == "refusals.py":
            digest.update(path.name.encode())
            digest.update(source)
    return digest.hexdigest()[:16]


def cache_root() -> Path:
    """Folder of all kernel caches; `MESHWRIGHT_CACHE_DIR` overrides the user's cache folder."""
    chosen = os.environ.get("MESHWRIGHT_CACHE_DIR")
    return Path(chosen) if chosen else Path(platformdirs.user_cache_dir("meshwright")) / "kernels"


@cache
def cache_folder(package: str = "meshwright_core") -> Path:
    """Cache folder of the kernels of one package, keyed by its sources and those of
    meshwright_core.
    """
    key = _source_hash(Path(__file__).parents[1])
    if package != "meshwright_core":
        module = importlib.import_module(package)
        key += "-" + _source_hash(Path(str(module.__file__)).parent)
    return cache_root() / key


def kernel(function: F) -> F:
    """Compile `function` with numba: no GIL, C division, cached on disk under :func:`cache_folder`.

    Falls back to a cache in memory where no folder can be written.
    """
    return _compiled(function, counts_references=True)


def bare_kernel(function: F) -> F:
    """A kernel that allocates nothing and so counts no references; numba refuses others.

    Reference counting takes several times as long as the work itself where small functions over
    :class:`~meshwright_core.core.arrays.MeshArrays` call each other, as all rewrites do.
    """
    return _compiled(function, counts_references=False)


def shared_kernel(function: F) -> F:
    """A kernel whose code is compiled once and linked into none of its callers.

    For code that several large kernels call: LLVM optimises it once and not once in each caller. A
    call takes some nanoseconds longer, which is negligible compared with an operation.
    """
    return _compiled(function, counts_references=True, form=SharedKernel)


def bare_shared_kernel(function: F) -> F:
    """A shared kernel that allocates nothing, as :func:`bare_kernel`."""
    return _compiled(function, counts_references=False, form=SharedKernel)


def _compiled(function: F, counts_references: bool, form: type[Kernel] = Kernel) -> F:
    options = {
        "nopython": True, "nogil": True, "error_model": "numpy", "_nrt": counts_references,
        "boundscheck": None,
    }  # fmt: skip
    # numba's types do not know its configuration
    configuration: Any = numba_config
    compiled = form(function, targetoptions=options)
    before = configuration.CACHE_DIR
    configuration.CACHE_DIR = str(cache_folder(function.__module__.partition(".")[0]))
    try:
        compiled.enable_caching()
    except (RuntimeError, OSError):  # the folder cannot be written
        note_unwritable(str(cache_root()), "it is not a writable folder")
    finally:
        configuration.CACHE_DIR = before
    return cast(F, compiled)


def entry_points_on_disk(package: str = "meshwright_core") -> int:
    """How many kernels of the package are in its cache, in one form at least."""
    return sum(1 for _ in cache_folder(package).rglob("*.nbi"))
