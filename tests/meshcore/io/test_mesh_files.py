"""Mesh files: round trips in every format, and one clear line for every kind of bad file."""

import contextlib
import errno
import importlib.util
import os
import resource
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import meshwright_core
from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.domains import gallery, meshing
from meshwright_core.domains.domain import CORNER_ANGLE
from meshwright_core.io.formats import FORMATS
from meshwright_core.io.mesh_files import endings

HERE = [
    ending
    for ending, form in FORMATS.items()
    if all(importlib.util.find_spec(package) for package in form.needs)
]
WAYS = [
    (ending, kind, name)
    for ending in HERE
    for kind, name in [("tri", "triangle"), ("quad", "quad")]
    if name in FORMATS[ending].kinds
]
SINGLE_PRECISION = (".glb", ".gltf", ".3mf")
SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


@pytest.fixture(scope="module")
def meshes():
    """An airfoil of each kind: round sides without corners, a hole, and dead slots."""
    made = {}
    for kind in ("tri", "quad"):
        points, elements, geometric = meshing.mesh_arrays(gallery.shape("airfoil"), kind)
        points = np.vstack([[[9.0, 9.0]], points, [[8.0, 8.0]]])
        geometric = np.concatenate([[False], geometric, [False]])
        mesh = HalfEdgeMesh.from_elements(points, elements + 1, geometric)
        desired = mesh.desired()
        desired[mesh.boundary() & ~geometric] = 4 if kind == "tri" else 3
        desired[40] += 2
        made[kind] = HalfEdgeMesh.from_elements(points, elements + 1, geometric, desired)
    return made


def refusal(path, **options) -> str:
    with pytest.raises(MeshError) as error:
        meshwright_core.read(path, **options)
    message = str(error.value)
    assert "\n" not in message
    assert message.startswith(str(path))
    return message


def polygons(mesh):
    """The elements as sets of places, rounded; the order does not matter."""
    corners = mesh.points[mesh.elements()].round(4) + 0.0
    return sorted(sorted(map(tuple, element)) for element in corners.tolist())


@pytest.mark.parametrize(("ending", "kind", "name"), WAYS)
def test_round_trip(ending, kind, name, meshes, tmp_path, capfd):
    mesh = meshes[kind]
    path = tmp_path / f"mesh{ending}"
    meshwright_core.write(path, mesh)
    again = meshwright_core.read(path)
    again.validate()
    assert again.kind == kind
    assert os.listdir(tmp_path) == [path.name]
    assert len(again.points) >= again.n_vertices == mesh.n_vertices
    assert polygons(again) == polygons(mesh)
    live = mesh.vertices()
    if ending != ".stl":
        number = np.searchsorted(live, mesh.elements())
        assert np.array_equal(again.elements(), number)
        exact = ending not in (*SINGLE_PRECISION, ".bdf", ".nas", ".fem")
        places, expected = again.points[again.vertices()], mesh.points[live]
        assert np.abs(places - expected).max() <= (0 if exact else 1e-6)
    if FORMATS[ending].data:
        assert np.array_equal(again.geometric()[again.vertices()], mesh.geometric()[live])
        assert np.array_equal(again.desired()[again.vertices()], mesh.desired()[live])
        assert (again.score, again.optimum) == (mesh.score, mesh.optimum)
    assert capfd.readouterr() == ("", "")


@settings(max_examples=30, deadline=None)
@given(
    st.integers(3, 20),
    st.integers(0, 2**32 - 1),
    st.sampled_from([way for way in WAYS if way[0] not in SINGLE_PRECISION]),
)
@example(11, 3076, (".inp", "tri", "triangle"))
def test_straight_sides_keep_their_optimum_in_every_format(tmp_path_factory, sides, seed, way):
    ending, kind, _ = way
    mesh = meshing.benchmark_mesh(kind, sides, np.random.default_rng(seed))
    path = tmp_path_factory.mktemp("round") / f"mesh{ending}"
    meshwright_core.write(path, mesh)
    again = meshwright_core.read(path)
    assert (again.score, again.optimum) == (mesh.score, mesh.optimum)
    corners = gallery.random_corners(sides, np.random.default_rng(seed))
    way_on = np.roll(corners, -1, axis=0) - corners
    angles = np.arctan2(way_on[:, 1], way_on[:, 0])
    turns = np.abs(np.angle(np.exp(1j * (angles - np.roll(angles, 1)))))
    # a random polygon may have a corner that turns by less than a corner does in a file
    assert again.geometric().sum() == (np.degrees(turns) > CORNER_ANGLE).sum()


def test_corner_angle_raises_the_bar_for_corners(meshes, tmp_path):
    path = tmp_path / "wing.obj"
    meshwright_core.write(path, meshes["tri"])
    assert meshwright_core.read(path).geometric().sum() > 15
    assert meshwright_core.read(path, corner_angle=89).geometric().sum() == 5


def test_formats_that_hold_no_quads_say_so(meshes, tmp_path):
    for ending in (".stl", ".glb", ".xml"):
        with pytest.raises(MeshError, match=r"files hold no quads\.$"):
            meshwright_core.write(tmp_path / f"mesh{ending}", meshes["quad"])
    assert os.listdir(tmp_path) == []


def test_packages_that_a_format_needs_are_named(meshes, tmp_path, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(MeshError, match="need the package lxml, which is not installed"):
        meshwright_core.write(tmp_path / "mesh.3mf", meshes["tri"])


def test_surfaces_out_of_the_plane(tmp_path):
    tetrahedron = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]
    mesh = HalfEdgeMesh.from_elements(tetrahedron, faces)
    for ending in (".ply", ".stl", ".vtk"):
        meshwright_core.write(tmp_path / f"solid{ending}", mesh)
        assert meshwright_core.read(tmp_path / f"solid{ending}").euler == 2
    with pytest.raises(MeshError, match="plane z = 0"):
        meshwright_core.write(tmp_path / "solid.su2", mesh)
    assert not (tmp_path / "solid.su2").exists()


# -- what is repaired on reading ------------------------------------------------------------------


def put_obj(path, points, faces):
    lines = ["v " + " ".join(map(str, point)) for point in points]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(lines))
    return path


def signed_areas(mesh):
    x, y = mesh.points[mesh.elements()][..., 0], mesh.points[mesh.elements()][..., 1]
    return (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1) / 2


@pytest.mark.parametrize("kind", ["tri", "quad"])
@pytest.mark.parametrize("share", [0.3, 1.0])
def test_orientation_is_made_consistent(kind, share, tmp_path):
    points, elements, _ = meshing.grid_arrays(kind, 50)
    turned = np.random.default_rng(3).random(len(elements)) < share
    faces = [e[::-1] if t else e for e, t in zip(elements.tolist(), turned, strict=True)]
    points = np.column_stack([points, np.zeros(len(points))])
    mesh = meshwright_core.read(put_obj(tmp_path / "mixed.obj", points.tolist(), faces))
    assert (signed_areas(mesh) > 0).all()


def test_each_part_is_oriented_for_itself(tmp_path):
    points = [*SQUARE, *([x + 3, y, 0] for x, y, _ in SQUARE)]
    mesh = meshwright_core.read(put_obj(tmp_path / "two.obj", points, [[0, 3, 2, 1], [4, 5, 6, 7]]))
    assert (signed_areas(mesh) > 0).all()


def test_moebius_strip_cannot_be_oriented(tmp_path):
    points, faces = [], []
    for i in range(8):
        angle, half = 2 * np.pi * i / 8, np.pi * i / 8
        for side in (-0.3, 0.3):
            r = 1 + side * np.cos(half)
            points.append([r * np.cos(angle), r * np.sin(angle), side * np.sin(half)])
        a, b = 2 * i, 2 * i + 1
        c, d = (a + 2, b + 2) if i < 7 else (1, 0)
        faces.append([a, c, d, b])
    assert "Moebius" in refusal(put_obj(tmp_path / "strip.obj", points, faces))


def test_unused_points_are_dropped(tmp_path):
    points = [[7, 7, 7], *SQUARE, [float("nan")] * 3]
    mesh = meshwright_core.read(put_obj(tmp_path / "loose.obj", points, [[1, 2, 3, 4]]))
    assert mesh.n_vertices == 4
    assert mesh.points[:4].tolist() == SQUARE


def test_obj_as_others_write_it(tmp_path):
    path = tmp_path / "other.obj"
    path.write_text(
        "# someone else's\nmtllib a.mtl\no thing\n"
        + "".join(f"v {x} {y} {z} 1.0\n" for x, y, z in SQUARE)
        + "vt 0 0\nvn 0 0 1\ns off\nusemtl m\ng part\nf -4/1/1 -3//1 \\\n -2/1\nf 1 3 4\nl 1 2\n"
    )
    mesh = meshwright_core.read(path)
    assert mesh.elements().tolist() == [[0, 1, 2], [0, 2, 3]]


def test_off_as_others_write_it(tmp_path):
    path = tmp_path / "other.off"
    path.write_text("OFF 4 2 5 # counts\n\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n3 0 2 3\n")
    assert meshwright_core.read(path).n_elements == 2


def test_binary_stl(tmp_path):
    corners = np.array(SQUARE, dtype="<f4")[[[0, 1, 2], [0, 2, 3]]]
    facets = np.zeros(2, dtype=[("n", "<f4", 3), ("c", "<f4", (3, 3)), ("a", "<u2")])
    facets["c"] = corners
    whole = b"solid but binary".ljust(80) + (2).to_bytes(4, "little") + facets.tobytes()
    path = tmp_path / "plate.stl"
    path.write_bytes(whole)
    mesh = meshwright_core.read(path)
    assert (mesh.n_vertices, mesh.n_elements) == (4, 2)
    path.write_bytes(b"binary".ljust(80) + whole[80:-20])
    assert "cut off" in refusal(path)


@pytest.mark.parametrize("version", ["3.0", "5.1"])
def test_vtk_polygonal_data(version, tmp_path):
    polygons = (
        "POLYGONS 3 8\nOFFSETS vtktypeint64\n0 4 8\nCONNECTIVITY vtktypeint64\n0 1 2 3 1 4 5 2\n"
        if version == "5.1"
        else "POLYGONS 2 10\n4 0 1 2 3\n4 1 4 5 2\n"
    )
    path = tmp_path / "plate.vtk"
    path.write_text(
        f"# vtk DataFile Version {version}\nplate\nASCII\nDATASET POLYDATA\nPOINTS 6 float\n"
        "0 0 0 1 0 0 1 1 0\n0 1 0 2 0 0 2 1 0\nMETADATA\nINFORMATION 0\n\n"
        f"{polygons}POINT_DATA 6\nNORMALS n float\n" + "0 0 1\n" * 6
    )
    assert meshwright_core.read(path).elements().tolist() == [[0, 1, 2, 3], [1, 4, 5, 2]]
    path.write_text(path.read_text().partition("POINT_DATA")[0][:-6])
    assert "cut off" in refusal(path)


def test_vtk_triangle_strips(tmp_path):
    path = tmp_path / "strip.vtk"
    path.write_text(
        "# vtk DataFile Version 3.0\nstrip\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
        "0 0 0 1 0 0 0 1 0 1 1 0\nTRIANGLE_STRIPS 1 5\n4 0 1 2 3\n"
    )
    assert meshwright_core.read(path).elements().tolist() == [[0, 1, 2], [2, 1, 3]]


def test_foreign_point_data_is_not_taken_for_ours(tmp_path):
    import meshio

    data = {"geometric": np.array([0.5, 0, 1, 0]), "desired_degree": np.array([-1, 2, 2, 2])}
    foreign = meshio.Mesh(np.array(SQUARE, float), [("quad", [[0, 1, 2, 3]])], point_data=data)
    foreign.write(tmp_path / "foreign.vtu")
    mesh = meshwright_core.read(tmp_path / "foreign.vtu")
    assert mesh.geometric().sum() == 4
    assert mesh.desired()[:4].tolist() == [2, 2, 2, 2]


# -- bad files -------------------------------------------------------------------------------------


@pytest.mark.parametrize("ending", HERE)
def test_missing_folder_empty_text(ending, tmp_path):
    path = tmp_path / f"bad{ending}"
    assert "no such file" in refusal(path)
    path.mkdir()
    assert "folder" in refusal(path)
    path.rmdir()
    path.write_bytes(b"")
    assert "empty" in refusal(path)
    path.write_text("Dear reader,\nthis is no mesh at all.\n\n1 2 3\nGood-bye\n")
    refusal(path)
    path.write_bytes(np.random.default_rng(0).bytes(3000))
    refusal(path)


@pytest.mark.timeout(60)
@pytest.mark.parametrize(("ending", "kind", "name"), WAYS)
def test_cut_off_files(ending, kind, name, tmp_path, capfd):
    path = tmp_path / f"whole{ending}"
    meshwright_core.write(path, meshing.benchmark_mesh(kind, 8, np.random.default_rng(4)))
    whole = path.read_bytes()
    cut = tmp_path / f"cut{ending}"
    for length in np.linspace(1, 0.9 * len(whole), 12).astype(int):
        cut.write_bytes(whole[:length])
        if ending == ".su2" and b"MARKER" in whole[:length]:
            continue  # the boundary is all that can be missing, and it is not read
        refusal(cut)
    assert capfd.readouterr() == ("", "")


def test_cells_of_both_kinds(tmp_path):
    points = [*SQUARE, [2, 0.5, 0], [0, 2, 0], [1, 2, 0]]
    faces = [[0, 1, 2, 3], [1, 4, 2], [3, 2, 6, 5]]
    message = refusal(put_obj(tmp_path / "both.obj", points, faces))
    assert "1 triangle and 2 quads" in message
    assert "(1.333, 0.5)" in message


def test_cells_of_other_kinds(tmp_path):
    points = [*SQUARE, [0.5, 2, 0]]
    message = refusal(put_obj(tmp_path / "five.obj", points, [[0, 1, 2, 4, 3]]))
    assert "1 of type polygon" in message
    assert "no triangles and no quads" in refusal(put_obj(tmp_path / "none.obj", points, []))


@pytest.mark.parametrize(
    ("points", "faces", "reason"),
    [
        ([[0, 0, 0], [1, 0, 0], ["nan", 1, 0]], [[0, 1, 2]], ["point 2", "nan"]),
        ([[0, 0, 0], [1, 0, 0], ["1e300", 1, 0]], [[0, 1, 2]], ["point 2", "1e+300"]),
        ([[0, 0, 0], [1, 0, 0]], [[0, 1, 2]], ["element 0", "not among the 2"]),
        (SQUARE, [[0, 1, 1]], ["element 0 repeats"]),
        ([*SQUARE, [2, 2, 0]], [[0, 1, 2], [0, 2, 3], [0, 2, 4]], ["not manifold", "2-0"]),
        (
            [[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]],
            [[0, 1, 2], [0, 3, 4]],
            ["not manifold", "vertex 0"],
        ),
    ],
)
def test_bad_meshes(points, faces, reason, tmp_path):
    message = refusal(put_obj(tmp_path / "bad.obj", points, faces))
    assert all(part in message for part in reason), message


def test_odd_paths(tmp_path, meshes):
    assert "holds a shape" in refusal(put_obj(tmp_path / "shape.json", [], [[0]]))
    assert "'.foo'" in refusal(put_obj(tmp_path / "mesh.foo", [], [[0]]))
    with pytest.raises(MeshError, match="no name for a file"):
        meshwright_core.read("mesh\0.vtk")
    with pytest.raises(MeshError, match="no name for a file"):
        meshwright_core.write("mesh\0.vtk", meshes["tri"])
    with pytest.raises(MeshError, match=r"'\.foo' is not one of a mesh file"):
        meshwright_core.write(tmp_path / "mesh.foo", meshes["tri"])
    os.mkfifo(tmp_path / "pipe.vtk")
    assert "not an ordinary file" in refusal(tmp_path / "pipe.vtk")
    with pytest.raises(MeshError, match="not an ordinary file"):
        meshwright_core.write(tmp_path / "pipe.vtk", meshes["tri"])


# -- writing whole or not at all -------------------------------------------------------------------


def assert_old_file_is_whole(path, old, mesh, match):
    with pytest.raises(MeshError, match=match) as error:
        meshwright_core.write(path, mesh)
    assert str(error.value).startswith(str(path))
    assert "\n" not in str(error.value)
    assert path.read_bytes() == old
    assert os.listdir(path.parent) == [path.name]


@contextlib.contextmanager
def files_no_longer_than(size):
    """Let the system refuse to write more than `size` bytes to a file, as a full disk would."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize(("ending", "kind", "name"), WAYS)
def test_old_file_survives_a_disk_that_takes_no_more(ending, kind, name, tmp_path, monkeypatch):
    path = tmp_path / f"mesh{ending}"
    meshwright_core.write(path, meshing.grid(kind, 4))
    old = path.read_bytes()
    large = meshing.grid(kind, 400, np.random.default_rng(0))
    with files_no_longer_than(4096):
        assert_old_file_is_whole(path, old, large, "cannot be written")

    def full(descriptor):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    assert_old_file_is_whole(path, old, large, r"cannot be written \(no space left on device\)")


def test_output_folder_that_does_not_exist(meshes, tmp_path):
    path = tmp_path / "missing" / "mesh.vtk"
    with pytest.raises(MeshError, match=r"the folder .*missing does not exist"):
        meshwright_core.write(path, meshes["tri"])
    assert os.listdir(tmp_path) == []


def test_output_that_is_a_folder(meshes, tmp_path):
    path = tmp_path / "mesh.vtk"
    path.mkdir()
    with pytest.raises(MeshError, match="folder, not a file"):
        meshwright_core.write(path, meshes["tri"])
    assert os.listdir(tmp_path) == ["mesh.vtk"]


def test_interrupt_leaves_nothing_behind(meshes, tmp_path, monkeypatch):
    path = tmp_path / "mesh.obj"
    meshwright_core.write(path, meshes["tri"])
    old = path.read_bytes()

    def interrupt(descriptor):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        meshwright_core.write(path, meshes["quad"])
    assert path.read_bytes() == old
    assert os.listdir(tmp_path) == ["mesh.obj"]


def test_links_are_followed_and_permissions_kept(meshes, tmp_path):
    (tmp_path / "store").mkdir()
    target, link = tmp_path / "store" / "mesh.obj", tmp_path / "link.obj"
    meshwright_core.write(target, meshes["tri"])
    target.chmod(0o640)
    link.symlink_to(target)
    meshwright_core.write(link, meshes["quad"])
    assert link.is_symlink()
    assert target.stat().st_mode & 0o777 == 0o640
    assert meshwright_core.read(target).kind == "quad"


def test_mesh_libraries_are_not_imported_with_the_package():
    code = (
        "import sys, meshcore; "
        "sys.exit(bool({'meshio', 'trimesh', 'shapely', 'networkx', 'triangle'}"
        " & sys.modules.keys()))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_endings_are_listed():
    assert {".msh", ".vtk", ".vtu", ".inp", ".su2", ".obj", ".ply", ".stl"} <= set(endings())


def two_halves(kind: str) -> HalfEdgeMesh:
    """A rectangle of two squares, each a region."""
    points = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
    quads = [[0, 1, 4, 3], [1, 2, 5, 4]]
    triangles = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]]
    if kind == "quad":
        return HalfEdgeMesh.from_elements(points, quads, regions=[0, 1])
    return HalfEdgeMesh.from_elements(points, triangles, regions=[0, 0, 1, 1])


@pytest.mark.parametrize("ending", [".msh", ".vtk", ".vtu"])
@pytest.mark.parametrize("kind", ["quad", "tri"])
def test_regions_go_along(ending, kind, tmp_path):
    mesh = two_halves(kind)
    path = tmp_path / f"mesh{ending}"
    meshwright_core.write(path, mesh)
    again = meshwright_core.read(path)
    assert again.regions().tolist() == mesh.regions().tolist()
    assert len(again.interfaces) == 1
    shared = again.halfedge(1, 4)
    assert shared >= 0
    assert not again.check("collapse", shared)


def test_physical_groups_of_a_gmsh_file_are_regions(tmp_path):
    path = tmp_path / "mesh.msh"
    meshwright_core.write(path, two_halves("quad"))
    text = path.read_text()
    assert "\n1 3 2 1 1 " in text and "\n2 3 2 2 2 " in text
    path.write_text(text.replace("\n2 3 2 2 2 ", "\n2 3 2 17 4 "))
    assert meshwright_core.read(path).regions().tolist() == [0, 1]


def test_data_by_element_that_makes_no_regions_is_left(tmp_path):
    path = tmp_path / "mesh.vtu"
    meshwright_core.write(path, two_halves("quad"))
    import meshio

    for values in ([0.5, 1.0], [np.nan, 1.0], [3, 3]):
        mesh = meshio.read(path)
        mesh.cell_data = {"region": [np.array(values)]}
        mesh.write(path)
        assert meshwright_core.read(path).regions().tolist() == [0, 0]


@pytest.mark.parametrize(
    "ending",
    [
        e
        for e in endings(written=True)
        if e in HERE and e not in (*SINGLE_PRECISION, ".bdf", ".nas", ".fem", ".stl")
    ],
)
def test_positions_are_written_with_all_their_digits(ending, tmp_path):
    rng = np.random.default_rng(5)
    points = np.array(SQUARE, float) + np.column_stack([rng.random((4, 2)) / 7.0, np.zeros(4)])
    points[:, 0] *= 1e-7
    points[:, 1] += 1e5
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 2], [0, 2, 3]])
    meshwright_core.write(tmp_path / f"mesh{ending}", mesh)
    assert np.array_equal(meshwright_core.read(tmp_path / f"mesh{ending}").points, mesh.points)


def test_a_point_number_that_is_too_large_is_said(tmp_path):
    vertices = "".join(f'<vertex index="{i}" x="{i % 2}" y="{i // 2}" z="0"/>' for i in range(4))
    cells = "".join(
        f'<triangle index="{i}" v0="{a}" v1="{b}" v2="{c}"/>'
        for i, (a, b, c) in enumerate([(0, 1, 3), (0, 3518446744073709551615, 2)])
    )
    path = tmp_path / "a.xml"
    path.write_text(
        f'<dolfin><mesh celltype="triangle" dim="2"><vertices size="4">{vertices}</vertices>'
        f'<cells size="2">{cells}</cells></mesh></dolfin>'
    )
    with pytest.raises(MeshError, match="where a whole number belongs"):
        meshwright_core.io.mesh_files.load(path)
