"""The table of docs/formats.md: every cell is what reading and writing do."""

from pathlib import Path

import numpy as np
import pytest

import meshwright_core
from meshwright_core import HalfEdgeMesh
from meshwright_core.io import mesh_files
from meshwright_core.io.formats import FORMATS

DOCUMENT = Path(__file__).parents[3] / "docs" / "formats.md"
COLUMNS = ("title", "triangles", "quads", "regions", "sides", "quadratic", "parts", "binary")
ALIKE = {
    ".nas": ".bdf",
    ".fem": ".bdf",
    ".tec": ".dat",
    ".gltf": ".glb",
    ".xmf": ".xdmf",
    ".meshb": ".mesh",
    ".vti": ".vts",
    ".vtr": ".vts",
    ".e": ".exo",
}
POINTS = "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 .5 0 0\n5 .5 .5 0\n6 0 .5 0\n"
PLAIN = "0 0 0\n1 0 0\n0 1 0\n.5 0 0\n.5 .5 0\n0 .5 0\n"
ZONE = 'ZONE T="{0}", N=3, E=1, F=FEPOINT, ET=TRIANGLE\n{1} 0\n{2} 0\n{1} 1\n1 2 3\n'
PIECE = (
    '<Piece NumberOfPoints="3" NumberOfCells="1"><Points><DataArray type="Float64" '
    'NumberOfComponents="3">{0} 0 0 {1} 0 0 {0} 1 0</DataArray></Points><Cells>'
    '<DataArray type="Int64" Name="connectivity">0 1 2</DataArray><DataArray type="Int64" '
    'Name="offsets">3</DataArray><DataArray type="UInt8" Name="types">5</DataArray></Cells></Piece>'
)
SU2_ZONE = (
    "IZONE= {0}\nNDIME= 2\nNELEM= 1\n5 0 1 2 0\nNPOIN= 3\n{1} 0 0\n{2} 0 1\n{1} 1 2\nNMARK= 0\n"
)
SOLID = (
    "solid {0}\nfacet normal 0 0 1\nouter loop\nvertex {1} 0 0\nvertex {2} 0 0\nvertex {1} 1 0\n"
    "endloop\nendfacet\nendsolid {0}\n"
)
GRID = (
    '<Grid Name="{0}" GridType="Uniform"><Geometry GeometryType="XYZ"><DataItem Dimensions="3 3" '
    'Format="XML">{1} 0 0 {2} 0 0 {1} 1 0</DataItem></Geometry><Topology TopologyType="Triangle">'
    '<DataItem DataType="Int" Dimensions="1 3" Format="XML">0 1 2</DataItem></Topology></Grid>'
)
PART = "*PART,NAME={0}\n*NODE\n1,{1},0\n2,{2},0\n3,{1},1\n*ELEMENT,TYPE=S3\n1,1,2,3\n*END PART\n"

QUADRATIC = {
    ".msh": f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n{POINTS}$EndNodes\n$Elements\n1\n"
    "1 9 2 0 1 1 2 3 4 5 6\n$EndElements\n",
    ".vtk": "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    f"POINTS 6 float\n{PLAIN}CELLS 1 7\n6 0 1 2 3 4 5\nCELL_TYPES 1\n22\n",
    ".vtu": '<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="6" '
    f'NumberOfCells="1"><Points><DataArray type="Float64">{PLAIN}</DataArray></Points><Cells>'
    '<DataArray type="Int64" Name="connectivity">0 1 2 3 4 5</DataArray><DataArray type="Int64" '
    'Name="offsets">6</DataArray><DataArray type="UInt8" Name="types">22</DataArray></Cells>'
    "</Piece></UnstructuredGrid></VTKFile>",
    ".inp": f"*NODE\n{POINTS.replace(' ', ',')}*ELEMENT,TYPE=CPS6\n1,1,2,3,4,5,6\n",
    ".su2": f"NDIME= 3\nNELEM= 1\n22 0 1 2 3 4 5 0\nNPOIN= 6\n{PLAIN}",
    ".mesh": "MeshVersionFormatted 2\nDimension 3\nVertices 6\n"
    + PLAIN.replace("\n", " 0\n")
    + "TrianglesP2 1\n1 2 3 4 5 6 0\nEnd\n",
    ".unv": "    -1\n  2411\n"
    + "".join(f"{i} 1 1 11\n{line}\n" for i, line in enumerate(PLAIN.splitlines(), start=1))
    + "    -1\n    -1\n  2412\n1 92 1 1 7 6\n1 4 2 5 3 6\n    -1\n",
    ".vol": "mesh3d\ndimension\n3\nsurfaceelements\n1\n1 1 0 0 6 1 2 3 4 5 6\n"
    f"points\n6\n{PLAIN}endmesh\n",
    ".bdf": "".join(f"GRID,{i},,{x},{y},0.\n" for i, (x, y) in enumerate(
        [("0.", "0."), ("1.", "0."), ("0.", "1."), (".5", "0."), (".5", ".5"), ("0.", ".5")], 1))
    + "CTRIA6,1,1,1,2,3,4,5,6\n",
    ".xdmf": '<Xdmf Version="3.0"><Domain><Grid><Geometry GeometryType="XYZ"><DataItem '
    f'Dimensions="6 3" Format="XML">{PLAIN}</DataItem></Geometry><Topology '
    'TopologyType="Triangle_6"><DataItem DataType="Int" Dimensions="1 6" Format="XML">0 1 2 3 4 5'
    "</DataItem></Topology></Grid></Domain></Xdmf>",
}  # fmt: skip
PARTS = {
    ".vtp": '<VTKFile type="PolyData"><PolyData>'
    + "".join(PIECE.format(a, b).replace("Cells", "Polys") for a, b in ((0, 1), (5, 6)))
    + "</PolyData></VTKFile>",
    ".vtu": '<VTKFile type="UnstructuredGrid"><UnstructuredGrid>'
    + PIECE.format(0, 1) + PIECE.format(5, 6) + "</UnstructuredGrid></VTKFile>",
    ".inp": PART.format("a", "0.", "1.") + PART.format("b", "5.", "6."),
    ".su2": "NZONE= 2\n" + SU2_ZONE.format(1, 0, 1) + SU2_ZONE.format(2, 5, 6),
    ".stl": SOLID.format("a", 0, 1) + SOLID.format("b", 5, 6),
    ".dat": 'VARIABLES = "X" "Y"\n' + ZONE.format("a", 0, 1) + ZONE.format("b", 5, 6),
    ".xdmf": '<Xdmf Version="3.0"><Domain><Grid GridType="Collection" CollectionType="Spatial">'
    + GRID.format("a", 0, 1) + GRID.format("b", 5, 6) + "</Grid></Domain></Xdmf>",
}  # fmt: skip


def table():
    rows = [line for line in DOCUMENT.read_text().splitlines() if line.startswith("| .")]
    cells = [[cell.strip() for cell in row.strip("|").split("|")] for row in rows]
    return {row[0]: dict(zip(COLUMNS, row[1:], strict=True)) for row in cells}


TABLE = table()


def test_every_ending_is_in_the_table():
    assert set(TABLE) | set(ALIKE) == set(FORMATS)
    assert all(FORMATS[a].title == FORMATS[b].title for a, b in ALIKE.items())


@pytest.mark.parametrize("ending", list(TABLE))
def test_what_is_written(ending):
    form, row = FORMATS[ending], TABLE[ending]
    assert ("triangle" in form.kinds) == (row["triangles"] == "rw")
    assert ("quad" in form.kinds) == (row["quads"] == "rw")
    assert form.regions == ("w" in row["regions"])
    assert form.sides == ("w" in row["sides"])
    assert form.numbers == ("n" in row["regions"])


def test_quadratic_elements_of_the_table_are_tested():
    """Those of MED and Exodus are in test_med_exodus.py, and of CGNS in test_cgns.py."""
    assert {*QUADRATIC, ".med", ".exo", ".cgns"} == {
        e for e, row in TABLE.items() if row["quadratic"]
    }


@pytest.mark.parametrize("ending", [e for e in QUADRATIC if TABLE[e]["quadratic"]])
def test_quadratic_elements_are_read(ending, tmp_path):
    path = tmp_path / f"a{ending}"
    path.write_text(QUADRATIC[ending])
    found = mesh_files.load(path)
    assert (found.mesh.kind, found.mesh.n_vertices) == ("tri", 3)
    assert any("6 points is read with straight sides" in note for note in found.notes)


def test_parts_of_the_table_are_tested():
    """Those of CGNS are in test_cgns.py."""
    assert {*PARTS, ".cgns"} == {e for e, row in TABLE.items() if row["parts"]}


@pytest.mark.parametrize("ending", [e for e in PARTS if TABLE[e]["parts"]])
def test_parts_are_read(ending, tmp_path):
    path = tmp_path / f"a{ending}"
    path.write_text(PARTS[ending])
    found = mesh_files.load(path)
    assert found.mesh.n_elements == len(found.parts) == 2
    assert mesh_files.load(path, part="2").mesh.points[:, 0].max() == 6


@pytest.mark.parametrize("ending", [e for e, row in TABLE.items() if "w" in row["binary"]])
def test_binary_files_are_written(ending, tmp_path):
    if any(FORMATS[ending].needs):
        pytest.importorskip(FORMATS[ending].needs[0])
    mesh = HalfEdgeMesh.from_elements([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]])
    path = tmp_path / f"a{ending}"
    meshwright_core.write(path, mesh)
    data = path.read_bytes()
    text = data.decode("latin-1")
    assert not text.isprintable()
    assert (
        np.float64(1).tobytes() in data
        or np.float32(1).tobytes() in data
        or (b"binary" in data.lower() or data.startswith(b"PK") or b"\x3f\xf0" in data)
    )
