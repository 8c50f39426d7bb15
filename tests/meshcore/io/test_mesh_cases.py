"""Files that were once refused or read wrongly, after public reports, and others like them."""

import codecs
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import meshwright_core
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.geometry.edge_curves import element_areas
from meshwright_core.io import mesh_files
from meshwright_core.io.formats import FORMATS

CASES = Path(__file__).parent / "cases"
SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)


def case(name):
    return CASES / name


def area(mesh):
    return float(element_areas(mesh).sum())


def load(path, **options):
    found = mesh_files.load(path, **options)
    found.mesh.validate()
    return found


def put(path, text):
    path.write_text(text)
    return path


# -- the cases -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "kind", "count", "size"),
    [
        ("abaqus-plane-elements/CAX4.inp", "quad", 9, 9),
        ("abaqus-plane-elements/CPE3.inp", "tri", 18, 9),
        ("abaqus-plane-elements/CPE4.inp", "quad", 9, 9),
        ("abaqus-plane-elements/CPS4.inp", "quad", 9, 9),
        ("abaqus-plane-elements/M3D4.inp", "quad", 9, 9),
        ("duplicate-nodes/two-blocks.vtk", "tri", 92, 2),
        ("groups-markers-data-dropped/data.vtk", "tri", 18, 9),
        ("groups-markers-data-dropped/groups.msh", "quad", 9, 9),
        ("groups-markers-data-dropped/markers.su2", "tri", 18, 9),
        ("msh41-partial-groups/curve-group-only.msh", "quad", 9, 9),
        ("msh41-partial-groups/no-groups.msh", "quad", 9, 9),
        ("msh41-partial-groups/one-curve-without-group.msh", "quad", 9, 9),
        ("obj-bom/bom.obj", "quad", 2, 2),
        ("ply-variants/face-colours-binary.ply", "tri", 4, 4),
        ("ply-variants/face-property-first.ply", "tri", 4, 4),
        ("ply-variants/plain.ply", "tri", 4, 4),
        ("ply-variants/vertex_index.ply", "tri", 4, 4),
        ("several-parts-in-one-file/two-parts.inp", "quad", 2, 7),
        ("several-parts-in-one-file/two-pieces.vtu", "quad", 2, 2),
        ("several-parts-in-one-file/two-zones.dat", "quad", 2, 7),
        ("several-parts-in-one-file/two-zones.su2", "quad", 2, 7),
        ("stl-near-duplicates/clean.stl", "tri", 32, 16 / 9),
        ("stl-near-duplicates/noise.stl", "tri", 32, 16 / 9),
        ("vtk-integer-data/pyvista-int32-cell-data.vtk", "quad", 9, 9),
        ("vtk-integer-data/pyvista-int64-cell-data.vtk", "quad", 9, 9),
        ("vtk-integer-data/pyvista-no-data.vtk", "quad", 9, 9),
        ("vtk-string-field-data/note.vtk", "quad", 9, 9),
        ("vtk-string-field-data/note.vtu", "quad", 9, 9),
        ("vtk-string-field-data/polydata-note.vtk", "quad", 9, 9),
        ("vtk-structured-5.1/rectilinear.vtk", "quad", 9, 9),
        ("vtk-structured-5.1/structured-4.2.vtk", "quad", 9, 9),
        ("vtk-structured-5.1/structured.vtk", "quad", 9, 9),
    ],
)
def test_sound_files_are_read(name, kind, count, size):
    mesh = load(case(name)).mesh
    assert (mesh.kind, mesh.n_elements) == (kind, count)
    assert area(mesh) == pytest.approx(size, rel=1e-5)


def test_points_of_an_interface_are_merged_and_it_is_said():
    found = load(case("duplicate-nodes/two-blocks.vtk"))
    assert found.mesh.n_vertices == 62
    assert len(found.mesh.boundary_loops()) == 1
    assert found.notes == (
        "6 pairs of points at the same place are merged, so that 2 parts become 1",
    )


def test_points_that_differ_by_rounding_are_merged_and_it_is_said():
    found = load(case("stl-near-duplicates/noise.stl"))
    assert found.mesh.n_vertices == 25
    assert len(found.mesh.boundary_loops()) == 1
    assert found.notes == ("71 points that differ by rounding only are merged",)
    assert np.ptp(found.mesh.points[:, 2]) == 0.0


@pytest.mark.parametrize(
    ("name", "parts", "sizes"),
    [
        ("two-parts.inp", ("A-1", "B-1"), (1, 6)),
        ("two-pieces.vtu", ("part 1", "part 2"), (1, 1)),
        ("two-zones.dat", ("a", "b"), (1, 6)),
        ("two-zones.su2", ("zone 1", "zone 2"), (1, 6)),
    ],
)
def test_parts_are_listed_and_one_can_be_read_alone(name, parts, sizes):
    path = case(f"several-parts-in-one-file/{name}")
    found = load(path)
    assert found.parts == parts
    assert found.notes[-1].startswith(f"there are 2 parts: {parts[0]} (1 quad), ")
    for number, (part, size) in enumerate(zip(parts, sizes, strict=True), start=1):
        for wanted in (part, part.upper(), str(number)):
            assert area(load(path, part=wanted).mesh) == pytest.approx(size)
    with pytest.raises(MeshError, match=r"no part 'x': there are 2 parts: .* \(1 quad\)"):
        mesh_files.load(path, part="x")


def test_an_element_that_is_there_twice_is_read_once():
    found = load(case("quads-off-the-xy-plane/pillow.off"))
    assert found.mesh.n_elements == 1
    assert found.notes == ("1 triangle that is there more than once is read once",)


# -- others like them ------------------------------------------------------------------------------


# those that trimesh reads are not text
TEXTS = [
    ending
    for ending, form in FORMATS.items()
    if ending not in (".glb", ".gltf", ".meshb") and form.kinds and not form.needs
]


@pytest.mark.parametrize("ending", TEXTS)
def test_a_byte_order_mark_changes_nothing(ending, tmp_path):
    form = FORMATS[ending]
    faces = [[0, 1, 2, 3]] if "quad" in form.kinds else [[0, 1, 2], [0, 2, 3]]
    meshwright_core.write(tmp_path / f"plain{ending}", HalfEdgeMesh.from_elements(SQUARE, faces))
    whole = (tmp_path / f"plain{ending}").read_bytes()
    for data in (codecs.BOM_UTF8 + whole, whole.replace(b"\n", b"\r\n")):
        if b"\r" in data and (b"BINARY" in whole or b"binary" in whole):
            continue
        marked = tmp_path / f"marked{ending}"
        marked.write_bytes(data)
        again = load(marked).mesh
        assert (again.n_vertices, again.n_elements) == (4, len(faces))
        assert area(again) == pytest.approx(1)


@pytest.mark.parametrize(
    "code",
    [
        "S4",
        "S4R",
        "S4RS",
        "S4R5",
        "CPS4R",
        "CPS4I",
        "CPE4H",
        "CPE4RH",
        "CPE4P",
        "CAX4R",
        "CAX4RT",
        "CGAX4",
        "M3D4R",
        "SFM3D4",
        "DC2D4",
        "DCAX4",
        "R3D4",
        "AC2D4",
        "cps4",
    ],
)
def test_quads_of_abaqus(code, tmp_path):
    path = put(
        tmp_path / "a.inp",
        f"*Node\n1, 0, 0\n2, 1., 0.\n 7, 1.d0, 1.\n9,,1.\n*ELEMENT,type={code}\n5,1,2,7,9\n",
    )
    assert area(load(path).mesh) == pytest.approx(1)


@pytest.mark.parametrize(("code", "nodes"), [("CPS8R", 8), ("S8R5", 8), ("M3D9", 9), ("CPE6", 6)])
def test_quadratic_elements_are_read_with_straight_sides(code, nodes, tmp_path):
    corners = [(0, 0), (2, 0), (2, 2), (0, 2)][: 3 if nodes == 6 else 4]
    ends = [*corners, corners[0]]
    middles = [((a + c) / 2, (b + d) / 2) for (a, b), (c, d) in pairwise(ends)]
    points = [*corners, *middles, (1, 1)][:nodes]
    lines = [f"{i}, {x}, {y}, 0." for i, (x, y) in enumerate(points, start=1)]
    row = ", ".join(map(str, range(1, nodes + 1)))
    text = "\n".join(["*NODE", *lines, f"*ELEMENT, TYPE={code}", f"1, {row}"])
    found = load(put(tmp_path / "a.inp", text))
    assert found.mesh.n_vertices == len(corners)
    assert found.notes == (
        f"1 element of {nodes} points is read with straight sides: only the corners are kept",
    )


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("*NGEN\n1,3,1\n", r"\*NGEN is not read"),
        ("*INCLUDE, INPUT=x.inp\n", "includes the file 'x.inp'"),
        ("*NODE, SYSTEM=C\n1,0,0\n", "cylindrical"),
        ("*NODE\n1,0,0\n*ELEMENT,TYPE=C3D8\n1,1,1,1,1,1,1,1,1\n", "1 of type C3D8"),
        ("*NODE\n1,0,0\n1,1,0\n3,1,1\n*ELEMENT,TYPE=S3\n1,1,1,3\n", "point 1 twice"),
        ("*NODE\n1,0,0\n2,1,0\n3,1,1\n*ELEMENT,TYPE=S3\n1,1,2,9\n", "not among the 3"),
    ],
)
def test_what_of_abaqus_is_refused(text, reason, tmp_path):
    with pytest.raises(MeshError, match=reason):
        mesh_files.load(put(tmp_path / "a.inp", text))


def test_an_instance_is_moved_and_turned(tmp_path):
    part = (
        "*PART, NAME=P\n*NODE\n1,0,0\n2,1,0\n3,1,2\n4,0,2\n*ELEMENT,TYPE=S4\n1,1,2,3,4\n*END PART\n"
    )
    place = "*INSTANCE,NAME=I,PART=p\n10.,0.,0.\n10.,0.,0.,10.,0.,1.,90.\n*END INSTANCE\n"
    mesh = load(put(tmp_path / "a.inp", f"{part}*ASSEMBLY\n{place}*END ASSEMBLY\n")).mesh
    assert np.allclose(mesh.points[:4, :2], [[10, 0], [10, 1], [8, 1], [8, 0]])


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("extra", ["", "list uchar float texcoord", "uchar red", "float64 q"])
@pytest.mark.parametrize("first", [False, True])
def test_ply_properties_in_any_order(binary, extra, first, tmp_path):
    corners = "list uint8 int32 vertex_index"
    properties = [p for p in ((extra, corners) if first else (corners, extra)) if p]
    head = ["ply", f"format {'binary_big_endian' if binary else 'ascii'} 1.0", "element vertex 4"]
    head += [f"property double {axis}" for axis in "xyz"] + ["element face 2"]
    head += [f"property {one}" for one in properties]
    head += ["element edge 1", "property int vertex1", "property int vertex2", "end_header"]
    values = {
        corners: ([3, 0, 1, 2], [3, 0, 2, 3], ["u1", "i4", "i4", "i4"]),
        "list uchar float texcoord": ([2, 0.5, 0.25], [2, 0.5, 0.75], ["u1", "f4", "f4"]),
        "uchar red": ([3], [4], ["u1"]),
        "float64 q": ([1.5], [2.5], ["f8"]),
    }
    rows = [[SQUARE[i].tolist(), ["f8"] * 3] for i in range(4)]
    for face in (0, 1):
        numbers = [n for p in properties for n in values[p][face]]
        rows.append([numbers, [c for p in properties for c in values[p][2]]])
    rows.append([[0, 1], ["i4", "i4"]])
    if binary:
        body = b"".join(
            np.array(n, f">{c}").tobytes() for row in rows for n, c in zip(*row, strict=True)
        )
    else:
        body = "\n".join(" ".join(map(str, numbers)) for numbers, _ in rows).encode()
    path = tmp_path / "a.ply"
    path.write_bytes("\n".join(head).encode() + b"\n" + body)
    assert load(path).mesh.elements().tolist() == [[0, 1, 2], [0, 2, 3]]


def test_tecplot_blocks_sharing_and_ordered_zones(tmp_path):
    path = put(
        tmp_path / "a.dat",
        'TITLE = "t"\nVARIABLES = "X", "Y", "p"\n'
        'ZONE T="one", N=4, E=1, DATAPACKING=BLOCK, ZONETYPE=FEQUADRILATERAL,\n'
        "VARLOCATION=([3]=CELLCENTERED)\n0 1 1 0\n2*0 2*1\n7.5\n1 2 3 4\n"
        'ZONE T="two", N=4, E=2, F=FEPOINT, ET=TRIANGLE\n'
        "5 0 0\n6 0 0\n6 1 0\n5 1 0\n1 2 3\n1 3 4\n",
    )
    with pytest.raises(MeshError, match="it mixes 2 triangles and 1 quad"):
        mesh_files.load(path)
    found = load(path, part="one")
    assert area(found.mesh) == pytest.approx(1)
    assert "cell data 'p'" in found.dropped
    grid = put(
        tmp_path / "b.dat",
        "VARIABLES = X Y\nZONE I=3, J=2, F=POINT\n0 0\n1 0\n2 0\n0 1\n1 1\n2 1\n",
    )
    assert load(grid).mesh.n_elements == 2


@pytest.mark.parametrize(
    "card",
    [
        "CTRIA3  1       7       1       2       3",
        "CTRIA3,1,7,1,2,3",
        "CTRIA3* 1               7               1               2               *C1\n*C1     3",
        "CTRIA6  1       7       1       2       3       4       5       +\n+       6",
        "CTRIAR  1               1       2       3",
    ],
)
def test_fields_of_nastran(card, tmp_path):
    grid = [
        "GRID    1               0.      0.      0.",
        "GRID,2,,1.,0.",
        "GRID    3               1.0     1.+0",
    ]
    grid += [f"GRID,{i},,.5,{i}.-1" for i in (4, 5, 6)]
    path = put(tmp_path / "a.bdf", "\n".join(["BEGIN BULK", *grid, card, "ENDDATA"]))
    assert area(load(path).mesh) == pytest.approx(0.5)


def test_points_of_nastran_in_another_system_are_refused(tmp_path):
    text = "GRID,1,5,0.,0.\nGRID,2,,1.,0.\nGRID,3,,1.,1.\nCTRIA3,1,1,1,2,3\n"
    with pytest.raises(MeshError, match="coordinate system"):
        mesh_files.load(put(tmp_path / "a.bdf", text))


def test_collapsed_quads_are_triangles(tmp_path):
    text = "*NODE\n1,0,0\n2,1,0\n3,1,1\n*ELEMENT,TYPE=S4\n1,1,2,3,3\n"
    found = load(put(tmp_path / "a.inp", text))
    assert found.mesh.kind == "tri"
    assert "1 quad with a corner that is given twice is read as a triangle" in found.notes


def test_two_sheets_that_lie_on_one_another_are_not_glued(tmp_path):
    points = "".join(f"v {x} {y} {z}\n" for _ in (0, 1) for x, y, z in SQUARE.astype(int))
    found = load(put(tmp_path / "a.obj", f"{points}f 1 2 3 4\nf 5 6 7 8\n"))
    assert found.mesh.n_vertices == 8
    assert any("lie on one another" in note for note in found.notes)


def test_a_crack_stays_open(tmp_path):
    points = [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (1, 0)]
    faces = [(1, 2, 5, 4), (7, 3, 6, 5)]
    text = "".join(f"v {x} {y} 0\n" for x, y in points)
    text += "".join("f " + " ".join(map(str, face)) + "\n" for face in faces)
    text += "v 0 2 0\nv 1 2 0\nv 2 2 0\nf 4 5 9 8\nf 5 6 10 9\n"
    found = load(put(tmp_path / "a.obj", text))
    assert found.mesh.n_vertices == 10
    assert found.notes == ()


def test_solids_of_an_stl_file_are_parts(tmp_path):
    def solid(name, shift):
        corners = "".join(f"vertex {x + shift} {y} 0\n" for x, y in ((0, 0), (1, 0), (1, 1)))
        return (
            f"solid {name}\nfacet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\nendsolid\n"
        )

    found = load(put(tmp_path / "a.stl", solid("left", 0) + solid("right", 5)))
    assert found.parts == ("left", "right")


def test_groups_of_an_obj_file_are_regions(tmp_path):
    points = "".join(f"v {x} {y} 0\n" for y in (0, 1) for x in (0, 1, 2))
    text = f"{points}usemtl steel\nf 1 2 5 4\nusemtl copper\nf 2 3 6 5\n"
    assert load(put(tmp_path / "a.obj", text)).mesh.regions().tolist() == [0, 1]


# -- all quads -------------------------------------------------------------------------------------


def test_mixed_meshes_become_quads(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 3\n"
    path = put(tmp_path / "a.obj", text)
    with pytest.raises(MeshError, match="--to-quads"):
        mesh_files.load(path)
    found = load(path, to_quads=True)
    assert (found.mesh.kind, found.mesh.n_elements) == ("quad", 7)
    assert area(found.mesh) == pytest.approx(1.5)
    assert "every element is split" in found.notes[-1]


def test_pairs_of_triangles_become_quads(tmp_path):
    points = "".join(f"v {x} {y} 0\n" for y in (0, 1) for x in (0, 1, 2))
    text = f"{points}usemtl a\nf 1 2 5\nf 1 5 4\nusemtl b\nf 2 3 6\nf 2 6 5\n"
    found = load(put(tmp_path / "a.obj", text), to_quads=True)
    assert found.mesh.elements().shape == (2, 4)
    assert sorted(found.mesh.regions().tolist()) == [0, 1]
    assert found.notes == ("4 triangles are joined in 2 pairs to make quads",)


def test_a_surface_of_triangles_becomes_quads():
    found = load(case("stl-near-duplicates/clean.stl"), to_quads=True)
    assert found.mesh.kind == "quad"
    assert area(found.mesh) == pytest.approx(16 / 9, rel=1e-5)


# -- planes in space -------------------------------------------------------------------------------


def turned(points, normal):
    """Points of the plane z = 0 turned to a plane with this normal, away from the origin."""
    n = np.asarray(normal, float) / np.linalg.norm(normal)
    u = np.cross([0.0, 1.0, 0.0] if abs(n[1]) < 0.9 else [1.0, 0.0, 0.0], n)
    u /= np.linalg.norm(u)
    return points[:, :1] * u + points[:, 1:2] * np.cross(n, u) + 3.0 * n


@pytest.mark.parametrize("name", ["star-xz.obj", "star-z-1e-17.obj"])
def test_a_mesh_in_a_plane_is_edited_there(name):
    flat = load(case("quads-off-the-xy-plane/star-xy.obj")).mesh
    mesh = load(case(f"quads-off-the-xy-plane/{name}")).mesh
    assert not mesh.points[mesh.vertices(), 2].any()
    assert (mesh.score, mesh.optimum) == (flat.score, flat.optimum) == (12, 4)
    assert area(mesh) == pytest.approx(area(flat))


@pytest.mark.parametrize("normal", [(1, 0, 0), (0, -1, 0), (1, 2, 3), (0, 1, 1), (0, 0, -1)])
@pytest.mark.parametrize("noise", [0.0, 1e-9])
def test_any_plane_is_written_back(normal, noise, tmp_path):
    flat = load(case("quads-off-the-xy-plane/star-xy.obj")).mesh
    points = turned(flat.points[:, :2], normal)
    rng = np.random.default_rng(1)
    there = points + noise * np.ptp(points) * rng.uniform(-0.5, 0.5, points.shape)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in there.tolist()]
    lines += ["f " + " ".join(map(str, face)) for face in (flat.elements() + 1).tolist()]
    found = load(put(tmp_path / "a.obj", "\n".join(lines)))
    mesh = found.mesh
    assert np.ptp(mesh.points[:, 2]) == 0
    assert (mesh.score, mesh.optimum) == (12, 4)
    assert (mesh.plane is None) == (normal == (0, 0, -1))
    assert any("is edited in that plane" in note for note in found.notes) == (
        mesh.plane is not None
    )
    meshwright_core.write(tmp_path / "b.obj", mesh)
    text = (tmp_path / "b.obj").read_text()
    written = np.array([line.split()[1:] for line in text.splitlines() if line[:2] == "v "], float)
    assert np.abs(written - there).max() <= max(1e-13, 2 * noise * np.ptp(points))


def test_coordinates_in_planes_of_the_axes_stay_to_the_bit(tmp_path):
    path = case("quads-off-the-xy-plane/star-xz.obj")
    meshwright_core.write(tmp_path / "b.obj", load(path).mesh)

    def places(file):
        rows = [line.split()[1:] for line in file.read_text().splitlines() if line[:2] == "v "]
        return np.array(rows, float)

    assert np.array_equal(places(tmp_path / "b.obj"), places(path))


@pytest.mark.parametrize("name", ["cube.off", "torus.off", "star-on-cylinder.obj"])
def test_surfaces_that_are_not_plane_say_so(name):
    found = load(case(f"quads-off-the-xy-plane/{name}"))
    assert mesh_files.SURFACE in found.notes
    assert found.mesh.plane is None


def test_a_snapshot_keeps_the_plane():
    from meshwright_core.io import snapshot

    mesh = load(case("quads-off-the-xy-plane/star-xz.obj")).mesh
    again = snapshot.from_arrays(snapshot.to_arrays(mesh))
    assert again.plane == mesh.plane is not None
    assert np.array_equal(again.points_in_space(), mesh.points_in_space())
    assert mesh.copy().plane == mesh.plane
