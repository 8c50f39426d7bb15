"""Sound files of an unusual form: what they hold is read, and what of it is not kept is said."""

import struct

import numpy as np
import pytest

from meshwright_core import MeshError
from meshwright_core.geometry.edge_curves import element_areas
from meshwright_core.io import mesh_files
from meshwright_core.io.named_groups import unique_pairs

SQUARE = "1,0,0\n2,1,0\n3,1,1\n4,0,1\n"
TWO = "1,0,0\n2,1,0\n3,2,0\n4,0,1\n5,1,1\n6,2,1\n"
NODES = "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n"
MESH = "MeshVersionFormatted 2\nDimension 2\n"
GRID = "GRID,1,,0.,0.\nGRID,2,,1.,0.\nGRID,3,,2.,0.\nGRID,4,,0.,1.\nGRID,5,,1.,1.\nGRID,6,,2.,1.\n"
PLACES = "0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0\n"
VTK = f"# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n{PLACES}"

SOUND = {
    "periodic, partitions and point elements.msh": (
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{NODES}$Elements\n4\n1 15 2 0 1 1\n"
        "2 1 2 1 1 4 1\n7 3 5 2 1 2 1 -2 1 2 5 4\n9 3 2 2 1 2 3 6 5\n$EndElements\n"
        "$Periodic\n1\n1 2 1\nAffine 1 0 0 2 0 1 0 0 0 0 1 0 0 0 0 1\n1\n3 1\n$EndPeriodic\n",
        2,
        2,
    ),
    "comments first.msh": (
        "$Comments\nby hand, no $Nodes\n$EndComments\n$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
        f"{NODES}$Elements\n1\n1 3 0 1 2 5 4\n$EndElements\n",
        1,
        1,
    ),
    "strip.vtk": (f"{VTK}CELLS 1 7\n6 0 3 1 4 2 5\nCELL_TYPES 1\n6\n", 4, 2),
    "pixels.vtk": (f"{VTK}CELLS 2 10\n4 0 1 3 4\n4 1 2 4 5\nCELL_TYPES 2\n8 8\n", 2, 2),
    "points and lines too.vtk": (
        f"{VTK}CELLS 4 15\n1 0\n2 0 1\n4 0 1 4 3\n4 1 2 5 4\nCELL_TYPES 4\n1 3 9 9\n",
        2,
        2,
    ),
    "turned instances.inp": (
        f"*PART,NAME=p\n*NODE\n{SQUARE}*ELEMENT,TYPE=S4\n1,1,2,3,4\n*END PART\n*ASSEMBLY,NAME=a\n"
        "*INSTANCE,NAME=i,PART=p\n*END INSTANCE\n*INSTANCE,NAME=j,PART=p\n5,5,0\n"
        "5,5,0,5,5,1,90\n*END INSTANCE\n*END ASSEMBLY\n",
        2,
        2,
    ),
    "continued rows.inp": (
        f"*NODE\n{SQUARE}*ELEMENT, \nTYPE=S4\n1,1,2,\n3,4\n** end",
        1,
        1,
    ),
    "marker sent.su2": (
        "NDIME=2\nNELEM=1\n9 0 1 2 3 0\nNPOIN= 4 4\n0 0\n1.0D+00 0\n1 1\n0 1\nNMARK=1\n"
        "MARKER_TAG=w\nMARKER_ELEMS=1\nSEND_RECV= 1\n3 0 1\n",
        1,
        1,
    ),
    "one line.mesh": (
        "MeshVersionFormatted 2 Dimension 2 Vertices 3 0 0 0 1 0 0 0 1 0 Triangles 1 1 2 3 0 End",
        1,
        0.5,
    ),
    "comments and exponents.mesh": (
        f"{MESH}# Vertices 9\nVertices # four\n4\n0.0D+00 0 0\n1.0E0 0 0 1 1 0\n0 1 0\n"
        "Quadrilaterals 1\n1 2 3 4 0\nEnd\n",
        1,
        1,
    ),
    "exponents.bdf": (
        "BEGIN BULK\nGRID    1               0.0     0.0     0.0\n"
        "GRID    2               2.0-1   0.0     0.0\nGRID    3               0.0     1.5+2\n"
        "CTRIA3  1       1       1       2       3\nENDDATA\n",
        1,
        15,
    ),
    "shared.dat": (
        'VARIABLES="x" "y"\nZONE N=4, E=1, F=FEPOINT, ET=QUADRILATERAL\n0 0\n1 0\n1 1\n0 1\n'
        "1 2 3 4\nZONE N=4, E=1, F=FEPOINT, ET=QUADRILATERAL, CONNECTIVITYSHAREZONE=1\n"
        "5 0\n6 0\n6 1\n5 1\n",
        2,
        2,
    ),
    "faces with other lists.ply": (
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty float nx\n"
        "property double y\nproperty list uchar int tags\nelement face 1\nproperty uchar flag\n"
        "property list uchar uint vertex_indices\nproperty list uchar float texcoord\nend_header\n"
        "0 9 0 2 1 2\n1 9 0 0\n1 9 1 1 5\n0 9 1 0\n7 4 0 1 2 3 2 .5 .5\n",
        1,
        1,
    ),
    "continued and relative.obj": (
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 2 \\\n -2/1 4\n",
        1,
        1,
    ),
    "colours.off": ("# a\nOFF # b\n4 1 0 # c\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 9 0 0\n", 1, 1),
}


@pytest.mark.parametrize("name", SOUND)
def test_unusual_files_are_read(name, tmp_path):
    text, count, area = SOUND[name]
    (tmp_path / name).write_text(text)
    mesh = mesh_files.load(tmp_path / name).mesh
    mesh.validate()
    assert mesh.n_elements == count
    assert element_areas(mesh).sum() == pytest.approx(area)


def load(path, text):
    path.write_text(text)
    return mesh_files.load(path)


def test_what_medit_holds_beside_its_mesh_is_said(tmp_path):
    text = (
        f"{MESH}Vertices\n3\n0 0 0\n1 0 0\n0 1 0\nTriangles\n1\n1 2 3 0\nCorners 2\n1\n2\n"
        "RequiredVertices\n1\n3\nSolution 1\n7\nEnd\n"
    )
    found = load(tmp_path / "a.mesh", text)
    assert found.dropped == ("the content of Corners, RequiredVertices, Solution",)


def test_markers_of_points_are_said(tmp_path):
    text = (
        "NDIME=2\nNELEM=1\n9 0 1 2 3\nNPOIN=4\n0 0\n1 0\n1 1\n0 1\nNMARK=2\nMARKER_TAG=tip\n"
        "MARKER_ELEMS=1\n1 0\nMARKER_TAG=wall\nMARKER_ELEMS=1\n3 0 1\n"
    )
    found = load(tmp_path / "a.su2", text)
    assert found.said() == ["the marker 'tip', which has no edges, is not kept"]
    assert set(filter(None, found.mesh.sides())) == {"wall"}


def test_elements_that_are_points_are_said_in_the_plural(tmp_path):
    text = f"*NODE\n{SQUARE}*ELEMENT,TYPE=MASS,ELSET=m\n9,3\n*ELEMENT,TYPE=S4\n1,1,2,3,4\n"
    assert load(tmp_path / "a.inp", text).said() == ["the elements of type MASS are not kept"]


def test_properties_win_over_components_of_hypermesh(tmp_path):
    text = (
        '$HMNAME COMP                   2"Duct"\n$HMNAME PROP                   2"Steel, 2 mm"\n'
        f'BEGIN BULK\n{GRID}$HMNAME COMP                   3"Fin"\n'
        '$HMNAME COMP                   2"Inlet"\nCQUAD4,1,2,1,2,5,4\nCQUAD4,2,3,2,3,6,5\nENDDATA\n'
    )
    assert load(tmp_path / "a.bdf", text).mesh.region_names == ("Steel, 2 mm", "Fin")


def test_a_name_that_is_read_otherwise_is_said(tmp_path):
    text = (
        '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 "hot; dry"\n'
        f"$EndPhysicalNames\n{NODES}$Elements\n2\n1 3 2 1 1 1 2 5 4\n2 3 2 0 1 2 3 6 5\n"
        "$EndElements\n"
    )
    found = load(tmp_path / "a.msh", text)
    assert found.notes == ("the name 'hot; dry' is read as 'hot, dry'",)
    assert found.mesh.region_names == ("hot, dry", "")


@pytest.mark.parametrize(
    ("nodes", "words"),
    [
        ("1,0,0\n2,1,0\n3,2,0\n4,3,0\n", "no area: all its points lie on one line"),
        ("1,0,0\n2,1,0\n3,0,1\n4,1,1\n", r"no area\.$"),  # a quad that crosses itself
        ("1,0,0\n2,1e-200,0\n3,1e-200,1e-200\n4,0,1e-200\n", r"no area\.$"),
    ],
)
def test_meshes_without_area_are_refused(nodes, words, tmp_path):
    with pytest.raises(MeshError, match=words):
        load(tmp_path / "a.inp", f"*NODE\n{nodes}*ELEMENT,TYPE=S4\n1,1,2,3,4\n")


def test_big_endian_gmsh_file(tmp_path):
    data = b"$MeshFormat\n2.2 1 8\n" + struct.pack(">i", 1) + b"\n$EndMeshFormat\n$Nodes\n4\n"
    for i, (x, y) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)], start=1):
        data += struct.pack(">i3d", i, x, y, 0)
    data += b"\n$EndNodes\n$Elements\n1\n" + struct.pack(">10i", 3, 1, 2, 1, 5, 1, 1, 2, 3, 4)
    (tmp_path / "a.msh").write_bytes(data + b"\n$EndElements\n")
    mesh = mesh_files.load(tmp_path / "a.msh").mesh
    assert (mesh.n_elements, mesh.region_names) == (1, ("5",))


def test_unique_pairs():
    rng = np.random.default_rng(3)
    first, second = rng.integers(-2, 3, (2, 50))
    pairs, place = unique_pairs(first, second)
    both = np.column_stack([first, second])
    assert np.array_equal(pairs, np.unique(both, axis=0))
    assert np.array_equal(pairs[place], both)
    assert len(unique_pairs(first[:0], second[:0])[0]) == 0
