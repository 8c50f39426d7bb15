"""MED and Exodus files: names survive, what damages them is said, and the packages are optional."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import meshwright_core
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.io import mesh_files

PACKAGES = {".med": "h5py", ".exo": "netCDF4"}
CASES = Path(__file__).parent / "cases" / "quadratic-med"
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


# -- quadratic elements ----------------------------------------------------------------------------

CORNERS = [(0, 0), (2, 0), (2, 2), (0, 2)]
MIDDLES = [(1, 0), (2, 1), (1, 2), (0, 1), (1, 1)]
SIX = [*CORNERS[:3], (1, 0), (2, 1), (1, 1), (4 / 3, 2 / 3)]


@pytest.mark.parametrize(
    ("name", "kind", "nodes", "count"),
    [("quads8", "quad", 8, 2), ("quads9", "quad", 9, 2), ("triangles6", "tri", 6, 4)],
)
def test_quadratic_elements_of_med_by_gmsh(name, kind, nodes, count):
    """Written by Gmsh 4.15.2, with groups of quadratic edges."""
    need(".med")
    found = mesh_files.load(CASES / f"gmsh-{name}.med")
    assert (found.mesh.kind, found.mesh.n_elements, found.mesh.n_vertices) == (kind, count, 6)
    assert any(f"{nodes} points are read with straight sides" in note for note in found.notes)
    sides, regions = names(found.mesh)
    assert sides == {
        frozenset({(0, 0, 0), (0, 1, 0)}): "in let",
        frozenset({(1, 0, 0), (1, 1, 0)}): "joint",
    }
    assert sorted(set(regions.values())) == ["copper", "steel"]
    areas = found.mesh.points[found.mesh.elements()][..., 0]
    assert np.ptp(areas, axis=1).max() == 1  # each corner is a corner


def put_med(path, code, points, cells, lines=()):
    """A file of one kind of elements, points counted from 0, and edges in the group 'low'."""
    import h5py

    with h5py.File(path, "w") as file:
        mesh = file.create_group("ENS_MAA/m")
        mesh.attrs.update({"ESP": 2, "DIM": 2})
        state = mesh.create_group("-0000000000000000001-0000000000000000001")
        state["NOE/COO"] = np.array(points, float).T.ravel()
        state[f"MAI/{code}/NOD"] = np.array(cells).T.ravel() + 1
        if len(lines):
            state["MAI/SE3/NOD"] = np.array(lines).T.ravel() + 1
            state["MAI/SE3/FAM"] = np.full(len(lines), -4)
            family = file.create_group("FAS/m/ELEME/low")
            family.attrs["NUM"] = -4
            letters = np.frombuffer(b"low".ljust(80, b"\0"), np.int8)
            family.create_dataset("GRO/NOM", data=letters.reshape(1, -1))


@pytest.mark.parametrize(
    ("code", "points"),
    [("TR6", SIX[:6]), ("TR7", SIX), ("QU8", CORNERS + MIDDLES[:4]), ("QU9", CORNERS + MIDDLES)],
)
def test_quadratic_elements_of_med(code, points, tmp_path):
    need(".med")
    path = tmp_path / "a.med"
    put_med(path, code, points, [range(len(points))], [(0, 1, 3 if code[0] == "T" else 4)])
    found = mesh_files.load(path)
    assert found.notes == (
        f"1 element of {len(points)} points is read with straight sides: only the corners are kept",
    )
    size = 3 if code[0] == "T" else 4
    assert found.mesh.points[:, :2].tolist() == [list(map(float, p)) for p in CORNERS[:size]]
    assert names(found.mesh)[0] == {frozenset({(0, 0, 0), (2, 0, 0)}): "low"}


def put_exodus(path, word, points, cells, dimension):
    """A file of one block, its second side in the side set 7."""
    import netCDF4

    with netCDF4.Dataset(path, "w", format="NETCDF3_64BIT_OFFSET") as file:
        table = np.array(cells) + 1
        sizes = {"num_dim": dimension, "num_nodes": len(points), "num_elem": len(table),
                 "num_el_blk": 1, "num_el_in_blk1": len(table),
                 "num_nod_per_el1": table.shape[1], "num_side_sets": 1,
                 "num_side_ss1": 1}  # fmt: skip
        for name, size in sizes.items():
            file.createDimension(name, size)
        places = np.zeros((len(points), 3))
        places[:, :2] = points
        for i, axis in enumerate("xyz"[:dimension]):
            file.createVariable(f"coord{axis}", "f8", ("num_nodes",))[:] = places[:, i]
        made = file.createVariable("connect1", "i4", ("num_el_in_blk1", "num_nod_per_el1"))
        made.elem_type = word
        made[:] = table
        file.createVariable("ss_prop1", "i4", ("num_side_sets",))[:] = 7
        file.createVariable("elem_ss1", "i4", ("num_side_ss1",))[:] = 1
        side = 2 if dimension == 2 else 4  # behind the two faces of a shell
        file.createVariable("side_ss1", "i4", ("num_side_ss1",))[:] = side


@pytest.mark.parametrize(
    ("word", "points", "dimension"),
    [
        ("TRI6", SIX[:6], 2),
        ("TRI7", SIX, 2),
        ("TRISHELL6", SIX[:6], 3),
        ("QUAD8", CORNERS + MIDDLES[:4], 2),
        ("QUAD9", CORNERS + MIDDLES, 2),
        ("SHELL8", CORNERS + MIDDLES[:4], 3),
        ("SHELL9", CORNERS + MIDDLES, 3),
        ("quad", CORNERS + MIDDLES, 2),
    ],
)
def test_quadratic_elements_of_exodus(word, points, dimension, tmp_path):
    need(".exo")
    path = tmp_path / "a.exo"
    put_exodus(path, word, points, [range(len(points))], dimension)
    found = mesh_files.load(path)
    assert found.notes == (
        f"1 element of {len(points)} points is read with straight sides: only the corners are kept",
    )
    size = 3 if word.upper().startswith("TRI") else 4
    assert found.mesh.points[:, :2].tolist() == [list(map(float, p)) for p in CORNERS[:size]]
    assert names(found.mesh)[0] == {frozenset({(2, 0, 0), (2, 2, 0)}): "side set 7"}


@pytest.mark.parametrize("ending", PACKAGES)
@pytest.mark.parametrize("kind", ["triangle6", "quad8", "quad9"])
def test_quadratic_elements_by_meshio(ending, kind, tmp_path):
    need(ending)
    meshio = pytest.importorskip("meshio")
    points = {"triangle6": SIX[:6], "quad8": CORNERS + MIDDLES[:4], "quad9": CORNERS + MIDDLES}[
        kind
    ]
    if (ending, kind) == (".med", "quad9"):
        pytest.skip("meshio writes no such cells to MED")
    places = np.column_stack([points, np.zeros(len(points))])
    path = tmp_path / f"a{ending}"
    meshio.write(path, meshio.Mesh(places, [(kind, np.array([range(len(points))]))]))
    mesh = mesh_files.load(path).mesh
    assert mesh.n_vertices == (3 if kind == "triangle6" else 4)


@pytest.mark.parametrize(("ending", "longest"), [(".med", 80), (".exo", 256)])
def test_a_name_that_is_too_long_is_said(ending, longest, tmp_path):
    need(ending)
    (tmp_path / "a.msh").write_text(MSH.format(0).replace("inlet", "ä" * 200))
    mesh = meshwright_core.read(tmp_path / "a.msh")
    assert any(f"at most {longest} bytes" in line for line in mesh_files.losses(f"a{ending}", mesh))
    with pytest.warns(meshwright_core.errors.FileWarning, match="at most"):
        meshwright_core.write(tmp_path / f"a{ending}", mesh)
    assert names(meshwright_core.read(tmp_path / f"a{ending}"))[0][
        frozenset({(0, 0, 0), (0, 1, 0)})
    ] == "ä" * (longest // 2)


def test_gmsh_reads_the_groups_of_med(tmp_path):
    """The MED library takes names of groups as arrays of 80 letters only."""
    need(".med")
    import h5py

    (tmp_path / "a.msh").write_text(MSH.format(0))
    path = tmp_path / "a.med"
    meshwright_core.write(path, meshwright_core.read(tmp_path / "a.msh"))
    with h5py.File(path) as file:
        assert file["FAS/mesh/ELEME/FAM_-1/GRO/NOM"].id.get_type().get_array_dims() == (80,)
    gmsh = pytest.importorskip("gmsh", reason="needs the package gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        found = {gmsh.model.getPhysicalName(*group) for group in gmsh.model.getPhysicalGroups()}
    finally:
        gmsh.finalize()
    assert found == {"inlet", "wall", "steel", "copper"}
