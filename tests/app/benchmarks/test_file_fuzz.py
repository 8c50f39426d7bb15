"""Damaged files are refused in a sentence or read as valid meshes; whole ones are read."""

import numpy as np
import pytest

from meshwright.benchmarks import file_fuzz
from meshwright.benchmarks.hostile_files import Kind
from meshwright_core.io.formats import FORMATS, SHAPES, missing_package

OTHERS = (".meshwright", ".safetensors", "level.json", "airfoil.dat")


@pytest.fixture(scope="module")
def kinds(tmp_path_factory):
    return file_fuzz.kinds(tmp_path_factory.mktemp("whole"))


def test_all_kinds_have_sources(kinds):
    assert {ending for ending, form in FORMATS.items() if not form.needs} <= set(kinds)
    assert {*SHAPES, *OTHERS} <= set(kinds)


@pytest.mark.parametrize("ending", [*FORMATS, *SHAPES, *OTHERS])
def test_mutations_cause_no_fault(ending, kinds, tmp_path):
    if ending not in kinds:
        package = missing_package(FORMATS[ending])
        assert package
        pytest.skip(f"needs {package}, a package that is not installed")
    kind = kinds[ending]
    path = tmp_path / f"a{ending}"
    for whole in kind.sources:
        path.write_bytes(whole)
        kind.read(path)
    number = 60 if ending == ".meshwright" else 15
    found = file_fuzz.fuzzed(path, kind, number, 5)
    assert found["faults"] == []
    assert found["refused"] + found["read"] == number


def test_mutations_can_be_made_again(kinds):
    for kind in kinds.values():
        assert file_fuzz.mutation(kind, 3, 1) == file_fuzz.mutation(kind, 3, 1)


def _raise(path):
    raise IndexError("list index out of range")


def _crash(path):
    import os

    os._exit(7)


def _fill(path):
    np.ones(3 << 30, np.uint8)


@pytest.mark.parametrize(
    ("read", "words"),
    [(_raise, "IndexError: list index"), (_crash, "the process ended with 7"), (_fill, "Memory")],
)
def test_faults_are_found(read, words, tmp_path):
    found = file_fuzz.fuzzed(tmp_path / "a", Kind([b"12"], read, file_fuzz.mutated), 2, 0)
    assert found["refused"] == found["read"] == 0
    assert [words in fault for fault in found["faults"]] == [True, True]
