"""Damaged files are refused in a sentence or read as valid meshes; sources are whole."""

import numpy as np
import pytest

from meshwright.benchmarks import file_fuzz
from meshwright_core.io.formats import FORMATS, SHAPES


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    return dict(file_fuzz._sources(tmp_path_factory.mktemp("whole")))


def test_all_formats_have_sources(sources):
    assert {ending for ending, form in FORMATS.items() if not form.needs} <= set(sources)
    assert set(SHAPES) <= set(sources)


@pytest.mark.parametrize("ending", [*FORMATS, *SHAPES])
def test_mutations_cause_no_fault(ending, sources, tmp_path):
    if ending not in sources:
        pytest.skip("needs a package that is not installed")
    read = file_fuzz._read_drawing if ending in SHAPES else file_fuzz._read_mesh
    path = tmp_path / f"a{ending}"
    for whole in sources[ending]:
        path.write_bytes(whole)
        read(path)
    rng = np.random.default_rng(5)
    found = file_fuzz.fuzzed(path, sources[ending], read, 15, rng)
    assert found["faults"] == []
    assert found["refused"] + found["read"] == 15


def test_faults_are_found(tmp_path):
    def broken(path):
        raise IndexError("list index out of range")

    found = file_fuzz.fuzzed(tmp_path / "a", [b"12"], broken, 2, np.random.default_rng(0))
    assert found["faults"] == ["IndexError: list index out of range"] * 2
