"""Block grids as files: each format read back by a slow reader, or by VTK."""

import re

import numpy as np
import pytest
from block_meshes import annulus, corner_blocks, quarter_ring, two_regions

from meshwright_core import MeshError, read
from meshwright_core.blocks.grid import BlockGrid, Sizing, WallLayer, block_grid
from meshwright_core.blocks.grid_quality import block_sides
from meshwright_core.io import mesh_files
from meshwright_core.io.grids import cgns, plot3d
from meshwright_core.io.grids.block_files import write_blocks
from meshwright_core.io.grids.openfoam import Extrusion, block_mesh_dict


@pytest.fixture(scope="module")
def ring() -> BlockGrid:
    return block_grid(annulus(), Sizing(size=0.3, walls=(WallLayer("wall", 0.01, 1.3),)))


def area(points: np.ndarray, cells: np.ndarray) -> float:
    p = points[cells][:, :, :2]
    diagonals = p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]
    return float(0.5 * (diagonals[0][:, 0] * diagonals[1][:, 1]
                        - diagonals[0][:, 1] * diagonals[1][:, 0]).sum())  # fmt: skip


def test_plot3d_text_and_binary_hold_the_same_points(tmp_path, ring):
    files = write_blocks(tmp_path / "ring.xyz", ring)
    assert [file.name for file in files] == ["ring.xyz", "ring.nmf"]
    words = (tmp_path / "ring.xyz").read_text().split()
    shapes = np.array(words[1:13], int).reshape(4, 3)
    assert words[0] == "4"
    assert (shapes[:, :2] == ring.shapes + 1).all()
    values = np.array(words[13:], float)
    expected = np.concatenate([ring.block_points(b).reshape(-1, 3).T.ravel() for b in range(4)])
    assert (values == expected).all()
    data = plot3d.plot3d_bytes(ring)
    at, records = 0, []
    while at < len(data):
        size = int.from_bytes(data[at : at + 4], "little")
        records.append(data[at + 4 : at + 4 + size])
        assert data[at + 4 + size : at + 8 + size] == data[at : at + 4]
        at += 8 + size
    assert np.concatenate([np.frombuffer(r, "<f8") for r in records[2:]]) == pytest.approx(values)


@pytest.mark.parametrize("make", [annulus, corner_blocks, two_regions])
def test_the_neutral_map_joins_points_that_are_the_same(make):
    grid = block_grid(make(), Sizing(divide=3))
    lines = plot3d.neutral_map(grid).splitlines()
    joined = [line.split() for line in lines if line.startswith("'ONE_TO_ONE'")]
    named = [line for line in lines if line.startswith("'") and "ONE_TO_ONE" not in line]
    inner = int((block_sides(grid.structure)[:, 2] >= 0).sum())
    assert len(joined) == inner
    assert len(named) == sum(len(patch.edges) for patch in grid.structure.patches)

    def ids(block: int, face: int, ranges: list[int]) -> np.ndarray:
        v = grid.block_vertices(block - 1)
        low, high = ranges[2:] if face in (5, 6) else ranges[:2]
        step = 1 if high > low else -1
        along = np.arange(low, high + step, step) - 1
        return {5: v[0, along % v.shape[1]], 6: v[-1, along % v.shape[1]],
                3: v[along % v.shape[0], 0], 4: v[along % v.shape[0], -1]}[face]  # fmt: skip

    for words in joined:
        n = [int(word) for word in words[1:13]]
        assert (ids(n[0], n[1], n[2:6]) == ids(n[6], n[7], n[8:12])).all()


@pytest.mark.parametrize("make", [annulus, corner_blocks, two_regions])
def test_joints_of_cgns_map_every_point_to_its_own(make):
    grid = block_grid(make(), Sizing(divide=3))
    for block, joints in enumerate(cgns._joints(grid)):
        for donor, own, theirs, transform in joints:
            matrix = np.zeros((2, 2), int)
            for axis, t in enumerate(transform):
                matrix[abs(t) - 1, axis] = np.sign(t)
            steps = int(np.abs(own[1] - own[0]).max())
            for k in range(steps + 1):
                here = own[0] + k * np.sign(own[1] - own[0])
                there = theirs[0] + matrix @ (here - own[0])
                assert (
                    grid.block_vertices(block)[here[1] - 1, here[0] - 1]
                    == grid.block_vertices(donor)[there[1] - 1, there[0] - 1]
                )
            assert (theirs[0] + matrix @ (own[1] - own[0]) == theirs[1]).all()
            # one step out of the block is one step into the other
            n, m = grid.shapes[block] + 1
            outside = np.array([-1 if own[0, 0] == own[1, 0] == 1 else
                                int(own[0, 0] == own[1, 0] == n),
                                -1 if own[0, 1] == own[1, 1] == 1 else
                                int(own[0, 1] == own[1, 1] == m)])  # fmt: skip
            inside = theirs[0] + matrix @ outside
            assert (inside >= 1).all()
            assert (inside <= grid.shapes[donor] + 1).all()


def test_cgns_has_the_layout_of_the_standard(tmp_path, ring):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "ring.cgns"
    write_blocks(path, ring)
    with h5py.File(path) as file:
        assert file.attrs["label"] == b"Root Node of HDF5 File"
        base = file["Base"]
        assert base[" data"][:].tolist() == [2, 3]
        nodes = {name: node for name, node in base.items() if name != " data"}
        zones = [n for n in nodes.values() if n.attrs["label"] == b"Zone_t"]
        assert len(zones) == 4
        families = [name for name, n in nodes.items() if n.attrs["label"] == b"Family_t"]
        assert sorted(families) == ["far", "wall"]
        for block, zone in enumerate(zones):
            size = zone[" data"][:]
            assert size[0].tolist() == (ring.shapes[block] + 1).tolist()
            x = zone["GridCoordinates"]["CoordinateX"][" data"][:]
            assert (x == ring.block_points(block)[:, :, 0]).all()
            assert len(zone["ZoneGridConnectivity"]) == 2
    found = mesh_files.load(path)
    assert found.mesh.n_elements == ring.cell_count
    assert len(found.parts) == 4
    assert set(found.mesh.sides()) == {"far", "wall"}


def test_without_h5py_cgns_is_refused(tmp_path, ring, monkeypatch):
    monkeypatch.setattr(cgns.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(MeshError, match="need the package h5py"):
        write_blocks(tmp_path / "ring.cgns", ring)
    assert list(tmp_path.iterdir()) == []


def test_gmsh_geometry_adds_up(tmp_path, ring):
    write_blocks(tmp_path / "ring.geo", ring)
    text = (tmp_path / "ring.geo").read_text()
    curves = {int(n): kind for kind, n in re.findall(r"^(Line|Circle|Spline)\((\d+)\)", text, re.M)}
    cells = {
        int(n): int(c) - 1 for n, c in re.findall(r"Transfinite Curve \{(\d+)\} = (\d+)", text)
    }
    assert set(curves) == set(cells)
    assert "Circle" in curves.values()
    total = 0
    for loop in re.findall(r"Curve Loop\(\d+\) = \{(.*)\}", text):
        sides = [abs(int(word)) for word in loop.split(",")]
        assert sum(cells[c] for c in sides) % 2 == 0
        total += sum(cells[c] for c in sides)
    assert total == 2 * int(ring.shapes.sum())
    assert set(re.findall(r'Physical \w+\("(\w+)"\)', text)) == {"far", "wall", "region_1"}


@pytest.mark.parametrize("order", [1, 2, 3])
def test_gmsh_meshes_have_names_and_cells_of_every_order(tmp_path, ring, order):
    write_blocks(tmp_path / "ring.msh", ring, order)
    import meshio

    found = meshio.read(tmp_path / "ring.msh")
    kind = {1: "quad", 2: "quad9", 3: "quad16"}[order]
    assert len(found.cells_dict[kind]) == ring.cell_count
    assert set(found.field_data) == {"far", "wall", "region_1"}
    corners = found.cells_dict[kind][:, :4]
    assert area(found.points, corners) == pytest.approx(ring.quality.areas.sum())
    line = {1: "line", 2: "line3", 3: "line4"}[order]
    assert len(found.cells_dict[line]) == sum(map(len, ring.patch_faces().values()))


def test_vtk_files_hold_blocks_and_patches(tmp_path, ring):
    pyvista = pytest.importorskip("pyvista")
    write_blocks(tmp_path / "ring.vtm", ring)
    write_blocks(tmp_path / "ring.vtm", ring)  # again, over the first one
    found = pyvista.read(tmp_path / "ring.vtm")
    blocks = found["region_1"]
    assert sum(block.n_cells for block in blocks) == ring.cell_count
    assert found["patches"].keys() == [patch.name for patch in ring.structure.patches]
    size = sum(block.compute_cell_sizes()["Area"].sum() for block in blocks)
    assert size == pytest.approx(ring.quality.areas.sum())
    exact = 3.0 * np.pi
    for order in (2, 3):
        write_blocks(tmp_path / f"ring{order}.vtu", ring, order)
        curved = pyvista.read(tmp_path / f"ring{order}.vtu")
        assert curved.n_cells == ring.cell_count
        fine = curved.tessellate(max_n_subdivide=3).compute_cell_sizes()["Area"].sum()
        assert abs(fine - exact) < 0.1 * abs(ring.quality.areas.sum() - exact)


@pytest.mark.parametrize("ending", [".su2", ".inp", ".bdf", ".vtk", ".vtu", ".obj", ".mesh"])
def test_formats_of_meshes_hold_the_fine_cells(tmp_path, ring, ending):
    write_blocks(tmp_path / f"ring{ending}", ring)
    found = read(tmp_path / f"ring{ending}")
    assert found.n_elements == ring.cell_count
    assert area(found.points, found.elements()) == pytest.approx(ring.quality.areas.sum(), rel=1e-6)


def test_abaqus_takes_elements_of_eight_nodes(tmp_path, ring):
    write_blocks(tmp_path / "ring.inp", ring, 2)
    text = (tmp_path / "ring.inp").read_text()
    assert "TYPE=CPS8" in text
    body = text.split("ELSET=ELEMENTS\n")[1].split("*ELSET")[0].splitlines()
    assert len(body) == ring.cell_count
    assert all(len(line.split(",")) == 9 for line in body)
    assert "*NSET, NSET=wall" in text


def test_block_mesh_dict_has_arcs_gradings_and_patches(ring):
    text = block_mesh_dict(ring, walls=("wall",))
    assert len(re.findall(r"^    hex ", text, re.M)) == 4
    assert len(re.findall(r"^    arc ", text, re.M)) == 16  # eight arcs, front and back
    assert re.search(r"wall\s*\{\s*type wall;", text)
    assert re.search(r"far\s*\{\s*type patch;", text)
    assert re.search(r"frontAndBack\s*\{\s*type empty;", text)
    vertices = text.split("vertices\n(")[1].split(");")[0].strip().splitlines()
    assert len(vertices) == 16
    assert "edgeGrading" in text
    thick = block_mesh_dict(ring, Extrusion(0.5, 4))
    assert re.search(r"\(\d+ \d+ 4\)", thick)
    assert "type empty" not in thick


def test_a_wedge_joins_front_and_back_on_the_axis():
    grid = block_grid(quarter_ring(), Sizing(divide=2))
    text = block_mesh_dict(grid, Extrusion(wedge=True))
    vertices = text.split("vertices\n(")[1].split(");")[0].strip().splitlines()
    assert len(vertices) == 6  # of four corners two lie on the axis
    assert text.count("type wedge") == 2
    assert re.search(r"axis\s*\{\s*type empty;", text)
    low = block_grid(annulus(), Sizing(divide=2))
    with pytest.raises(MeshError, match="above that axis"):
        block_mesh_dict(low, Extrusion(wedge=True))


@pytest.mark.parametrize(
    ("name", "order", "words"),
    [
        ("x.stl", 1, "not one of a grid"),
        ("x", 1, "no ending"),
        ("x.geo", 2, "order 2 cannot be written as .geo"),
        ("x.inp", 3, "order 3"),
        ("missing/x.geo", 1, "does not exist"),
    ],
)
def test_what_cannot_be_written_is_refused_in_one_sentence(tmp_path, ring, name, order, words):
    with pytest.raises(MeshError, match=words):
        write_blocks(tmp_path / name, ring, order)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_of_something_else_is_left_alone(tmp_path, ring):
    (tmp_path / "ring").mkdir()
    (tmp_path / "ring" / "notes.txt").write_text("mine")
    with pytest.raises(MeshError, match="no folder of such a grid"):
        write_blocks(tmp_path / "ring.vtm", ring)
    assert (tmp_path / "ring" / "notes.txt").read_text() == "mine"
    assert not (tmp_path / "ring.vtm").exists()
