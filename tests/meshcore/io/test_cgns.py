"""CGNS files: unstructured and structured zones, families and boundary conditions, and damage."""

import numpy as np
import pytest

from meshwright_core import MeshError
from meshwright_core.geometry.edge_curves import element_areas
from meshwright_core.io import mesh_files
from meshwright_core.io.grids.cgns import _node as node
from meshwright_core.io.grids.cgns import _text as text

h5py = pytest.importorskip("h5py")

POINTS = np.array([[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]], float)
QUADS = np.array([[1, 2, 5, 4], [2, 3, 6, 5]], np.int32)
BAR, TRIANGLE, QUAD, MIXED, NGON, TETRA = 3, 5, 7, 20, 22, 10


@pytest.fixture
def base(tmp_path):
    """The base of a file that is open, and a function that closes and reads it."""
    path = tmp_path / "a.cgns"
    file = h5py.File(path, "w", track_order=True)
    made = node(file["/"], "Base", "CGNSBase_t", np.array([2, 2], np.int32))

    def load(**options):
        file.close()
        found = mesh_files.load(path, **options)
        found.mesh.validate()
        return found

    return made, load


def zone(base, name, size, points, kind="Unstructured"):
    made = node(base, name, "Zone_t", np.array(size, np.int32))
    node(made, "ZoneType", "ZoneType_t", text(kind))
    coordinates = node(made, "GridCoordinates", "GridCoordinates_t")
    for axis in range(points.shape[-1]):
        values = np.ascontiguousarray(points[..., axis])
        node(coordinates, f"Coordinate{'XYZ'[axis]}", "DataArray_t", values)
    return made


def unstructured(base, name="Zone", points=POINTS, count=2):
    return zone(base, name, [[len(points)], [count], [0]], points)


def section(zone, name, code, first, members, count, starts=None):
    made = node(zone, name, "Elements_t", np.array([code, 0], np.int32))
    node(made, "ElementRange", "IndexRange_t", np.array([first, first + count - 1], np.int32))
    node(made, "ElementConnectivity", "DataArray_t", np.array(members, np.int32).ravel())
    if starts is not None:
        node(made, "ElementStartOffset", "DataArray_t", np.array(starts, np.int32))


def condition(zone, name, listed, location="", family="", word="PointList", kind="BCWall"):
    conditions = zone["ZoneBC"] if "ZoneBC" in zone else node(zone, "ZoneBC", "ZoneBC_t")
    made = node(conditions, name, "BC_t", text(kind))
    node(made, word, "IndexArray_t", np.array(listed, np.int32))
    if location:
        node(made, "GridLocation", "GridLocation_t", text(location))
    if family:
        node(made, "FamilyName", "FamilyName_t", text(family))


def sides(mesh):
    """Names by the middles of edges."""
    found = {}
    for name, ends in mesh.sides().items():
        for a, b in ends.tolist() if name else ():
            found[tuple(((mesh.points[a] + mesh.points[b]) / 2)[:2].tolist())] = name
    return found


def test_sections_with_conditions_on_elements_and_points(base):
    made, load = base
    one = unstructured(made)
    section(one, "edges", BAR, 1, [[1, 2], [2, 3], [3, 6]], 3)
    section(one, "cells", QUAD, 4, QUADS, 2)
    condition(one, "bottom", [[1], [2]], "EdgeCenter", word="PointRange")
    condition(one, "BC 2", [[3]], "EdgeCenter", family="outlet")
    condition(one, "left", [[1], [4]])
    condition(one, "steel", [[4]], "FaceCenter")
    condition(one, "unnamed", [[1], [4]], kind="Null")
    mesh = load().mesh
    assert mesh.region_names == ("steel", "")
    assert sides(mesh) == {
        (0.5, 0): "bottom", (1.5, 0): "bottom", (2, 0.5): "outlet", (0, 0.5): "left",
    }  # fmt: skip


@pytest.mark.parametrize("starts", [None, [0, 5, 9, 13]])
def test_mixed_sections(base, starts):
    made, load = base
    one = unstructured(made, count=3)
    members = [QUAD, 1, 2, 5, 4, TRIANGLE, 2, 3, 6, TRIANGLE, 2, 6, 5]
    section(one, "cells", MIXED, 1, members, 3, starts)
    mesh = load(to_quads=True).mesh
    assert mesh.kind == "quad"
    assert element_areas(mesh).sum() == pytest.approx(2)


def test_polygons_of_four_corners(base):
    made, load = base
    section(unstructured(made), "cells", NGON, 1, QUADS, 2, [0, 4, 8])
    assert load().mesh.n_elements == 2


def test_quadratic_elements(base):
    made, load = base
    points = np.array([[0, 0], [2, 0], [0, 2], [1, 0], [1, 1], [0, 1]], float)
    section(unstructured(made, points=points, count=1), "cells", 6, 1, [1, 2, 3, 4, 5, 6], 1)
    found = load()
    assert found.notes == (
        "1 element of 6 points is read with straight sides: only the corners are kept",
    )


def test_zones_are_parts_and_families_regions(base):
    made, load = base
    inner = node(made, "S_1", "Family_t")
    node(inner, "steel", "FamilyName_t", text("steel"))  # as Gmsh names its physical groups
    node(made, "copper", "Family_t")
    for name, family, shift in (("A", "S_1", 0.0), ("B", "copper", 2.0)):
        one = unstructured(made, name, POINTS + [shift, 0])
        section(one, "cells", QUAD, 1, QUADS, 2)
        node(one, "Family", "FamilyName_t", text(family))
        node(one, "Flow", "FlowSolution_t")
    found = load()
    assert found.parts == ("A", "B")
    assert found.mesh.region_names == ("steel", "copper")
    assert found.dropped == ("the content of Flow",)
    assert found.notes[0] == (
        "2 pairs of points at the same place are merged, so that 2 parts become 1"
    )


@pytest.mark.parametrize("flat", [False, True])
def test_structured_zones(base, flat):
    """flat: three axes, of which one has one point."""
    made, load = base
    points = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0)), axis=-1)
    size = [[4, 3], [3, 2], [0, 0]]
    ones = [1] if flat else []
    if flat:
        points, size = points[None], [[4, 3, 1], [3, 2, 0], [0, 0, 0]]
    one = zone(made, "Zone", size, points, "Structured")
    condition(one, "bottom", [[1, 1, *ones], [4, 1, *ones]], word="PointRange")
    condition(one, "right", [[4, 1, *ones], [4, 2, *ones]], "EdgeCenter", word="PointRange")
    condition(one, "corner", [[1, 3, *ones], [2, 3, *ones]])
    mesh = load().mesh
    assert (mesh.n_elements, mesh.n_vertices) == (6, 12)
    assert sides(mesh) == {
        (0.5, 0): "bottom", (1.5, 0): "bottom", (2.5, 0): "bottom", (3, 0.5): "right",
        (3, 1.5): "right", (0.5, 2): "corner",
    }  # fmt: skip


def test_volumes_are_refused(base):
    made, load = base
    section(unstructured(made), "cells", TETRA, 1, [1, 2, 3, 4], 1)
    with pytest.raises(MeshError, match="only triangles or quads can be edited"):
        load()


def put(node, *values):
    """Other data for a node."""
    del node[" data"]
    node.create_dataset(" data", data=np.array(values))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda zone: zone.pop("GridCoordinates"), "a zone has no coordinates"),
        (lambda zone: put(zone["GridCoordinates/CoordinateX"], 0.0, 1.0), "other points than its"),
        (lambda zone: zone["cells"].pop("ElementRange"), "ElementRange is missing in 'cells'"),
        (lambda zone: put(zone["cells/ElementRange"], 1, 99), "announces 99 elements"),
        (lambda zone: put(zone["cells"], MIXED, 0), "within its elements"),
        (lambda zone: put(zone["cells"], NGON, 0), "polygons of CGNS files before version 4"),
        (lambda zone: put(zone["cells/ElementConnectivity"], *range(2, 10)), "names a point that"),
        (lambda zone: zone["ZoneType"].attrs.modify("type", np.bytes_("LK")), "has links to other"),
        (lambda zone: zone.__setitem__("x", h5py.SoftLink("/nowhere")), "cannot be opened"),
        (lambda zone: zone["cells"].move(" data", "data"), "data is missing in 'cells'"),
        (lambda zone: condition(zone, "w", [[1], [10**9]], word="PointRange"), "the range of a"),
    ],
)
def test_damaged_files(base, change, words):
    made, load = base
    one = unstructured(made)
    section(one, "cells", QUAD, 1, QUADS, 2)
    change(one)
    with pytest.raises(MeshError, match=words):
        load()


def test_a_plane_without_one_of_its_axes(base):
    made, load = base
    one = unstructured(made)
    one["GridCoordinates"].move("CoordinateX", "CoordinateZ")
    section(one, "cells", QUAD, 1, QUADS, 2)
    assert abs(load().mesh.plane.normal[0]) == pytest.approx(1)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"@(#)ADF Database Version B02012>", "adf2hdf makes one that is read"),
        (b"CGNS", "does not begin as HDF5 does"),
        (b"\x89HDF\r\n\x1a\n" + bytes(600), "its HDF5 structure"),
    ],
)
def test_files_that_are_no_cgns(data, words, tmp_path):
    (tmp_path / "a.cgns").write_bytes(data)
    with pytest.raises(MeshError, match=words):
        mesh_files.load(tmp_path / "a.cgns")


def test_coordinates_that_are_not_cartesian(base):
    made, load = base
    one = unstructured(made)
    for old, new in (("CoordinateX", "CoordinateR"), ("CoordinateY", "CoordinateTheta")):
        one["GridCoordinates"].move(old, new)
    with pytest.raises(MeshError, match="not Cartesian"):
        load()


def test_cgns_is_only_read(base):
    made, load = base
    section(unstructured(made), "cells", QUAD, 1, QUADS, 2)
    with pytest.raises(MeshError, match=r"CGNS files \(.cgns\) are only read"):
        mesh_files.write("b.cgns", load().mesh)
