"""Kernels in fresh processes: compiled once, loaded afterwards, compiled anew after an edit."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
import pytest

from meshwright_core.core import compilation
from meshwright_core.core.compilation import kernel
from meshwright_core.core.linking import canonical
from meshwright_core.core.references import by_reference

KERNELS = """
from typing import NamedTuple

import numpy as np

from meshwright_core.core.compilation import bare_kernel, bare_shared_kernel, kernel
from meshwright_core.core.references import by_reference


@by_reference
class Pair(NamedTuple):
    first: np.ndarray
    second: np.ndarray


@bare_kernel
def scaled(pair, i, by):
    return by * pair.first[i] + pair.second[i]


@bare_shared_kernel
def shared_sum(pair, by):
    total = 0.0
    for i in range(len(pair.first)):
        total += scaled(pair, i, by)
    return total


@kernel
def both(pair, by):
    swapped = Pair(pair.second, pair.first)
    return shared_sum(pair, by) + 1000.0 * shared_sum(swapped, np.int32(by))
"""

SCRIPT = """
import json
from numba.core import event
import numpy as np
from tiny_kernels import FACTOR, Pair, both, shared_sum, scaled

pair = Pair(np.array([1.0, 2.0]), np.array([3.0, 4.0]))
value = both(pair, FACTOR)
misses = sum(sum(k._cache_misses.values()) for k in (both, shared_sum, scaled))
parts = sum(len(k._parts) for k in (both, shared_sum, scaled))
print(json.dumps([value, misses, parts]))
"""


class Tiny:
    """Three kernels in a package of their own, and a script that calls them in fresh processes."""

    def __init__(self, folder: Path) -> None:
        self.package = folder / "code" / "tiny_kernels"
        self.package.mkdir(parents=True)
        self.cache = folder / "cache"
        self.write(2)

    def write(self, factor: int) -> None:
        """Edit the package."""
        (self.package / "__init__.py").write_text(KERNELS + f"\n\nFACTOR = {factor}\n")

    def run(self, cache: Path | None = None, **options):
        """Value, misses, parts."""
        paths = os.pathsep.join([str(self.package.parent), *sys.path])
        chosen = str(cache or self.cache)
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT],
            env={**os.environ, "MESHWRIGHT_CACHE_DIR": chosen, "PYTHONPATH": paths},
            capture_output=True,
            text=True,
            **options,
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)


@pytest.fixture(scope="module")
def tiny(tmp_path_factory):
    """With a filled cache, which tests copy and do not change."""
    made = Tiny(tmp_path_factory.mktemp("tiny"))
    assert made.run() == [EXPECTED, 2, 3]  # two entry points of three parts: both, what is shared
    return made


@pytest.fixture
def cache(tiny, tmp_path):
    """A copy of the filled cache."""
    return shutil.copytree(tiny.cache, tmp_path / "cache")


EXPECTED = (2 * 3 + 7) + 1000 * (2 * 7 + 3)


def test_a_filled_cache_compiles_nothing(tiny):
    assert tiny.run() == [EXPECTED, 0, 0]


def test_another_installation_of_the_same_sources_compiles_nothing(tiny, tmp_path):
    other = Tiny(tmp_path)
    assert other.run(tiny.cache) == [EXPECTED, 0, 0]


def test_an_edit_means_a_fresh_cache(tmp_path):
    tiny = Tiny(tmp_path)
    assert tiny.run() == [EXPECTED, 2, 3]
    tiny.write(3)
    value, misses, _ = tiny.run()
    assert value == (3 * 3 + 7) + 1000 * (3 * 7 + 3)
    assert misses == 2


def test_a_folder_that_cannot_be_written_leaves_the_cache_in_memory(tiny, tmp_path):
    (tmp_path / "file").write_text("")
    assert tiny.run(tmp_path / "file" / "below") == [EXPECTED, 2, 3]
    assert not list(tiny.package.parent.rglob("*.nb?"))  # nor beside the sources


def test_a_shared_kernel_that_is_gone_from_the_cache_is_compiled_again(tiny, cache):
    for path in cache.rglob("*shared_sum*"):
        path.unlink()
    assert tiny.run(cache) == [EXPECTED, 1, 2]


@pytest.mark.parametrize("ending", [".nbi", ".nbc"])
@pytest.mark.parametrize("kept", [0, 20])
def test_a_damaged_file_of_the_cache_is_replaced(tiny, cache, ending, kept):
    damaged = list(cache.rglob(f"*both*{ending}"))
    assert damaged
    for path in damaged:
        path.write_bytes(path.read_bytes()[:kept])
    assert tiny.run(cache)[:2] == [EXPECTED, 1]
    assert tiny.run(cache) == [EXPECTED, 0, 0]


@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
def test_a_full_disk_costs_only_the_cache(tiny, tmp_path):
    import resource

    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))  # noqa: E731
    assert tiny.run(tmp_path / "full", preexec_fn=limit)[0] == EXPECTED


def test_integers_have_one_type_between_kernels():
    assert canonical(numba.int32) == canonical(numba.uint8) == numba.int64
    assert canonical(numba.types.literal(3)) == numba.int64
    for kind in (numba.uint64, numba.boolean, numba.float32, numba.typeof(np.zeros(2, np.int32))):
        assert canonical(kind) == kind


def test_entry_points_are_counted(cache, monkeypatch):
    monkeypatch.setattr(compilation, "cache_folder", lambda package: cache)
    assert compilation.entry_points_on_disk() == 2


@by_reference
class Samples(NamedTuple):
    values: np.ndarray
    weights: np.ndarray


@kernel
def weighted_sum(samples):
    scratch = np.zeros(len(samples.values))
    for i in range(len(scratch)):
        scratch[i] = samples.values[i] * samples.weights[i]
    return scratch.sum()


def test_a_call_from_python_keeps_no_reference_to_the_arrays_of_a_tuple():
    samples = Samples(np.arange(3.0), np.ones(3))
    before = [sys.getrefcount(array) for array in samples]
    for _ in range(5):
        assert weighted_sum(samples) == 3.0
    assert [sys.getrefcount(array) for array in samples] == before
