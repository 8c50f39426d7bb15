"""Kernels in fresh processes: compiled once, loaded afterwards, compiled anew after an edit."""

import json
import os
import subprocess
import sys
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


@pytest.fixture
def tiny(tmp_path):
    """Runs a script over three kernels in a fresh process; prints value, misses, parts."""
    package = tmp_path / "code" / "tiny_kernels"
    package.mkdir(parents=True)

    def write(factor: int) -> None:
        (package / "__init__.py").write_text(KERNELS + f"\n\nFACTOR = {factor}\n")

    def run(cache=tmp_path / "cache", **options):
        paths = os.pathsep.join([str(package.parent), *sys.path])
        environment = {**os.environ, "MESHWRIGHT_CACHE_DIR": str(cache), "PYTHONPATH": paths}
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT],
            env=environment,
            capture_output=True,
            text=True,
            **options,
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    write(2)
    run.write = write
    return run


EXPECTED = (2 * 3 + 7) + 1000 * (2 * 7 + 3)


def test_a_filled_cache_compiles_nothing(tiny):
    assert tiny() == [EXPECTED, 2, 3]  # two entry points of three parts: both, and what is shared
    assert tiny() == [EXPECTED, 0, 0]


def test_an_edit_means_a_fresh_cache(tiny):
    tiny()
    tiny.write(3)
    value, misses, _ = tiny()
    assert value == (3 * 3 + 7) + 1000 * (3 * 7 + 3)
    assert misses == 2


def test_a_folder_that_cannot_be_written_leaves_the_cache_in_memory(tiny, tmp_path):
    (tmp_path / "file").write_text("")
    assert tiny(tmp_path / "file" / "below") == [EXPECTED, 2, 3]


def test_a_shared_kernel_that_is_gone_from_the_cache_is_compiled_again(tiny, tmp_path):
    tiny()
    for path in (tmp_path / "cache").rglob("*shared_sum*"):
        path.unlink()
    assert tiny() == [EXPECTED, 1, 2]


@pytest.mark.parametrize("ending", [".nbi", ".nbc"])
@pytest.mark.parametrize("kept", [0, 20])
def test_a_damaged_file_of_the_cache_is_replaced(tiny, tmp_path, ending, kept):
    tiny()
    for path in (tmp_path / "cache").rglob(f"*both*{ending}"):
        path.write_bytes(path.read_bytes()[:kept])
    assert tiny()[:2] == [EXPECTED, 1]
    assert tiny() == [EXPECTED, 0, 0]


def test_no_file_is_written_beside_the_sources(tiny, tmp_path):
    (tmp_path / "file").write_text("")
    tiny(tmp_path / "file")
    assert not list((tmp_path / "code").rglob("*.nb?"))


@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
def test_a_full_disk_costs_only_the_cache(tiny):
    import resource

    limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))  # noqa: E731
    assert tiny(preexec_fn=limit)[0] == EXPECTED


def test_integers_have_one_type_between_kernels():
    assert canonical(numba.int32) == canonical(numba.uint8) == numba.int64
    assert canonical(numba.types.literal(3)) == numba.int64
    for kind in (numba.uint64, numba.boolean, numba.float32, numba.typeof(np.zeros(2, np.int32))):
        assert canonical(kind) == kind


def test_entry_points_are_counted(tiny, tmp_path, monkeypatch):
    tiny()
    monkeypatch.setattr(compilation, "cache_folder", lambda package: tmp_path / "cache")
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
