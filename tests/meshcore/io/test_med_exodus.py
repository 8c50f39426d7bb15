"""MED and Exodus files: names survive, what damages them is said, and the packages are optional."""

import importlib.util

import numpy as np
import pytest

import meshwright_core
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.io import mesh_files

PACKAGES = {".med": "h5py", ".exo": "netCDF4"}
POINTS = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
QUADS = [[0, 1, 4, 3], [1, 2, 5, 4]]
MSH = (
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 1 \"inlet\"\n1 2 \"wall\"\n"
    "2 3 \"steel\"\n2 4 \"copper\"\n$EndPhysicalNames\n$Nodes\n6\n1 0 0 {0}\n2 1 0 {0}\n3 2 0 {0}\n"
    "4 0 1 {0}\n5 1 1 {0}\n6 2 1 {0}\n$EndNodes\n$Elements\n5\n1 1 2 1 1 4 1\n2 1 2 2 2 1 2\n"
    "3 1 2 2 2 2 3\n4 3 2 3 3 1 2 5 4\n5 3 2 4 4 2 3 6 5\n$EndElements\n"
)  # fmt: skip


def need(ending):
    package = PACKAGES[ending]
    if importlib.util.find_spec(package) is None:
        pytest.skip(f"needs {package}, a package that is not installed")


def names(mesh):
    """Names of sides by their ends, and of regions by the middle of an element."""
    place = {v: tuple(mesh.points[v].round(6).tolist()) for v in mesh.vertices().tolist()}
    sides = {}
    for name, ends in mesh.sides().items():
        for a, b in ends.tolist() if name else ():
            sides[frozenset({place[a], place[b]})] = name
    regions = {
        tuple(mesh.points[nodes].mean(axis=0).round(6).tolist()): mesh.region_names[number]
        for nodes, number in zip(mesh.elements(), mesh.regions(), strict=True)
    }
    return sides, regions


@pytest.mark.parametrize("ending", PACKAGES)
@pytest.mark.parametrize("height", [0.0, 3.0])
def test_names_in_and_out(tmp_path, ending, height):
    need(ending)
    (tmp_path / "a.msh").write_text(MSH.format(height))
    mesh = meshwright_core.read(tmp_path / "a.msh")
    first = tmp_path / f"a{ending}"
    meshwright_core.write(first, mesh)
    again = meshwright_core.read(first)
    assert names(again) == names(mesh)
    sides, regions = names(again)
    assert sorted(sides.values()) == ["inlet", "wall", "wall"]
    assert sorted(regions.values()) == ["copper", "steel"]


@pytest.mark.parametrize("ending", PACKAGES)
def test_meshio_reads_what_is_written(tmp_path, ending):
    need(ending)
    meshio = pytest.importorskip("meshio")
    (tmp_path / "a.msh").write_text(MSH.format(0))
    path = tmp_path / f"a{ending}"
    meshwright_core.write(path, meshwright_core.read(tmp_path / "a.msh"))
    found = meshio.read(path)
    assert len(found.points) == 6
    assert sum(len(block.data) for block in found.cells if block.type == "quad") == 2
    if ending == ".med":
        assert {n for own in found.cell_tags.values() for n in own} == {
            "inlet", "wall", "steel", "copper"
        }  # fmt: skip


@pytest.mark.parametrize("ending", PACKAGES)
def test_what_meshio_writes_is_read(tmp_path, ending):
    need(ending)
    meshio = pytest.importorskip("meshio")
    points = np.column_stack([POINTS, np.zeros(6)])
    cells = [("line", np.array([[0, 3], [0, 1]])), ("quad", np.array(QUADS))]
    mesh = meshio.Mesh(points, cells, point_data={"heat": np.arange(6.0)})
    if ending == ".med":
        mesh.cell_data["cell_tags"] = [np.array([-1, -2]), np.array([-3, -4])]
        mesh.cell_tags = {-1: ["inlet"], -2: ["wall"], -3: ["steel"], -4: ["copper"]}
    else:
        mesh.cells = mesh.cells[1:]
    path = tmp_path / f"a{ending}"
    meshio.write(path, mesh)
    found = mesh_files.load(path)
    assert found.mesh.n_elements == 2
    assert any("heat" in what for what in found.dropped)
    if ending == ".med":
        sides, regions = names(found.mesh)
        assert sorted(sides.values()) == ["inlet", "wall"]
        assert sorted(regions.values()) == ["copper", "steel"]


@pytest.mark.parametrize("ending", PACKAGES)
def test_damaged_files_are_refused_in_a_sentence(tmp_path, ending):
    need(ending)
    path = tmp_path / f"a{ending}"
    meshwright_core.write(path, HalfEdgeMesh.from_elements(POINTS, QUADS))
    whole = path.read_bytes()
    for data in (b"words", whole[: len(whole) // 2], whole[:100]):
        path.write_bytes(data)
        with pytest.raises(MeshError) as error:
            mesh_files.load(path)
        assert "\n" not in str(error.value)
        assert "not understood" not in str(error.value)


@pytest.mark.parametrize("ending", PACKAGES)
def test_a_package_that_is_missing_is_named(tmp_path, ending, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    path = tmp_path / f"a{ending}"
    path.write_bytes(b"\0")
    with pytest.raises(MeshError, match=rf"{PACKAGES[ending]}.*meshwright\[files\]") as error:
        mesh_files.load(path)
    assert "\n" not in str(error.value)


def test_a_size_beyond_all_memory_is_refused_in_a_sentence(tmp_path, monkeypatch):
    need(".med")
    import h5py

    def fails(*given):
        raise OverflowError("Python int too large to convert to C ssize_t")

    path = tmp_path / "a.med"
    meshwright_core.write(path, HalfEdgeMesh.from_elements(POINTS, QUADS))
    monkeypatch.setattr(h5py, "File", fails)
    with pytest.raises(MeshError, match="cut off or damaged"):
        mesh_files.load(path)
