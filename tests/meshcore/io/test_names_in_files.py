"""Names of sides and regions in mesh files: written, read, through operations and back."""

import warnings

import numpy as np
import pytest
from named_plate import EXPECTED, edit, measures, plate

from meshwright_core import read, write
from meshwright_core.errors import FileWarning
from meshwright_core.io import mesh_files
from meshwright_core.io.formats import FORMATS

NAMED = (".msh", ".vtk", ".vtu", ".vtp", ".inp", ".unv", ".xdmf")
"""Endings of formats that hold names of sides and regions."""


@pytest.mark.parametrize("kind", ["quad", "tri"])
@pytest.mark.parametrize("ending", NAMED)
def test_all_names_come_back(ending, kind, tmp_path):
    mesh = plate(kind)
    assert measures(mesh) == EXPECTED
    path = tmp_path / f"plate{ending}"
    write(path, mesh)
    again = read(path)
    assert measures(again) == EXPECTED
    again.validate()


def test_gmsh_keeps_its_version_and_the_numbers_of_groups(tmp_path):
    path = tmp_path / "plate.msh"
    path.write_text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n")
    write(path, plate())
    text = path.read_text()
    assert text.startswith("$MeshFormat\n4.1 0 8\n")
    assert '1 7 "inlet"' in text
    assert '2 3 "steel"' in text
    assert measures(read(path)) == EXPECTED
    other = tmp_path / "old.msh"
    write(other, read(path))
    assert other.read_text().startswith("$MeshFormat\n2.2 0 8\n")
    assert '1 7 "inlet"' in other.read_text()


def test_su2_has_a_marker_for_every_edge_of_the_boundary(tmp_path):
    path = tmp_path / "plate.su2"
    with pytest.warns(FileWarning, match="those of the regions 'steel', 'copper' are lost"):
        write(path, plate())
    text = path.read_text()
    tags = [line.split()[1] for line in text.splitlines() if line.startswith("MARKER_TAG")]
    assert sorted(tags) == ["inlet", "joint", "unnamed", "wall", "wall&hot"]
    again = read(path)
    found = measures(again)
    assert {name: found[name] for name in ("inlet", "joint")} == {
        name: EXPECTED[name] for name in ("inlet", "joint")
    }
    assert "unnamed" not in found


def test_nastran_has_properties_with_names(tmp_path):
    path = tmp_path / "plate.bdf"
    with pytest.warns(FileWarning, match="Nastran files hold no such names: those of the sides"):
        write(path, plate())
    again = read(path)
    assert set(again.region_names) == {"steel", "copper"}
    assert "CQUAD4  1       3  " in path.read_text()


def test_medit_has_numbers(tmp_path):
    path = tmp_path / "plate.mesh"
    with pytest.warns(FileWarning, match="hold numbers in place of names"):
        write(path, plate())
    again = read(path)
    assert len(set(again.region_names)) == 2
    assert measures(again)["ref=7"] == EXPECTED["inlet"]


def test_names_that_are_written_in_another_way_are_said():
    mesh = plate()
    (line,) = mesh_files.losses("a.su2", mesh)[1:]
    assert line == "Names in SU2 files are single words: 'wall; hot' becomes 'wall&hot'."
    assert mesh_files.losses("a.inp", mesh) == ()
    mesh.rename("inlet", "hot inlet, left")
    (line,) = mesh_files.losses("a.inp", mesh)
    assert line.endswith("single words: 'hot inlet, left' becomes 'hot_inlet_left'.")


@pytest.mark.parametrize(
    "ending",
    [
        e
        for e in mesh_files.endings(written=True)
        if e not in (*NAMED, ".xmf") and not FORMATS[e].needs
    ],
)
def test_what_a_format_loses_is_said(ending, tmp_path):
    form = FORMATS[ending]
    mesh = plate("quad" if "quad" in form.kinds else "tri")
    said = mesh_files.losses(f"plate{ending}", mesh)
    assert len(said) == (2 if ending in (".su2", ".avs") else 1)
    assert all(form.title in line for line in said)
    if not form.regions:
        assert "of the regions 'steel', 'copper' are lost" in said[0]
    if not form.sides:
        assert "'inlet'" in said[0]


@pytest.mark.parametrize("ending", NAMED)
def test_names_stay_through_200_operations(ending, tmp_path):
    first, second = tmp_path / f"a{ending}", tmp_path / f"b{ending}"
    write(first, plate())
    mesh = read(first)
    edit(mesh, np.random.default_rng(5))
    write(second, mesh)
    assert measures(read(second)) == EXPECTED


def test_regions_of_a_file_are_one_where_a_named_line_does_not_cut_them(tmp_path):
    path = tmp_path / "lines.msh"
    quads = "\n".join(
        f"{i} 3 2 9 1 {a} {a + 1} {a + 5} {a + 4}"
        for i, a in enumerate((1, 2, 3, 5, 6, 7, 9, 10, 11), start=10)
    )
    points = "\n".join(f"{i + 1} {i % 4} {i // 4} 0" for i in range(16))
    lines = "1 1 2 4 1 5 6\n2 1 2 4 1 6 7\n3 1 2 4 1 7 8\n4 1 2 5 2 14 10"
    path.write_text(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n"
        '1 4 "cut"\n1 5 "slit"\n2 9 "all"\n$EndPhysicalNames\n'
        f"$Nodes\n16\n{points}\n$EndNodes\n$Elements\n13\n{lines}\n{quads}\n$EndElements\n"
    )
    with pytest.warns(FileWarning, match="1 edge lies within a region and cuts? nothing off"):
        mesh = read(path)
    assert mesh.region_names == ("all", "all")
    assert measures(mesh)["cut"] == (3.0, 0.0, 1.0, 3.0, 1.0)
    assert np.bincount(mesh.regions()).tolist() in ([3, 6], [6, 3])


def test_fields_that_are_dropped_are_named(tmp_path):
    path = tmp_path / "data.vtk"
    points = "\n".join(f"{i % 3} {i // 3} 0" for i in range(9))
    path.write_text(
        "# vtk DataFile Version 3.0\ndata\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n"
        f"{points}\nCELLS 4 20\n4 0 1 4 3\n4 1 2 5 4\n4 3 4 7 6\n4 4 5 8 7\n"
        "CELL_TYPES 4\n9\n9\n9\n9\n"
        "POINT_DATA 9\nSCALARS height double 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7 8\n"
        "CELL_DATA 4\nSCALARS material int 1\nLOOKUP_TABLE default\n4 7 4 7\n"
    )
    with pytest.warns(FileWarning, match="point data 'height' is not kept"):
        mesh = read(path)
    assert mesh.left_out == ("point data 'height'",)
    assert mesh.region_names == ("material=4", "material=7")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        write(tmp_path / "again.vtk", mesh)
        again = read(tmp_path / "again.vtk")
    assert again.region_names == mesh.region_names
    import meshio

    kept = meshio.read(tmp_path / "again.vtk")
    assert kept.cell_data["material"][0].tolist() == [4, 7, 4, 7]


def test_physical_groups_without_elements_are_said(tmp_path):
    path = tmp_path / "a.msh"
    path.write_text(
        '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 "left"\n2 2 "right"\n'
        "$EndPhysicalNames\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n1\n"
        "1 2 2 1 1 1 2 3\n$EndElements\n"
    )
    found = mesh_files.load(path)
    assert any("no element is in the physical groups 'right'" in note for note in found.notes)
