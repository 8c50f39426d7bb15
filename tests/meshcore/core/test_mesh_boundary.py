"""Vertices on curves and elements in regions: construction, accessors, moves, copies."""

import numpy as np
import pytest

from meshwright_core import HalfEdgeMesh, MeshError
from meshwright_core.core.composite_curves import joined_curves
from meshwright_core.core.mesh_boundary import CurvePiece, Interface, MeshBoundary
from meshwright_core.testing.curved_starts import region_areas

HALF = np.sqrt(0.5)


def grid(width, height):
    points = np.array([[i, j] for j in range(height + 1) for i in range(width + 1)], float)
    first = np.array([i + j * (width + 1) for j in range(height) for i in range(width)])
    quads = np.column_stack([first, first + 1, first + width + 2, first + width + 1])
    return points, quads


def segment(a, b):
    return np.array([[*a, 0.0, 1.0], [*b, 0.0, 1.0]], float)


def quarter(centre, radius, start):
    """A quarter of a circle, counter-clockwise from `start` degrees."""
    a, b = np.radians([start, start + 90.0])
    p = np.array([[np.cos(a), np.sin(a)], [np.cos(a) + np.cos(b), np.sin(a) + np.sin(b)]])
    p = np.vstack([p, [np.cos(b), np.sin(b)]])
    control = np.column_stack([np.asarray(centre) + radius * p, np.zeros(3), np.ones(3)])
    control[1] *= HALF
    return control


def plate_with_insert(kind="quad"):
    """A square of side 6 around a disc of radius 1 of another material."""
    points, quads = grid(3, 3)
    points = 2.0 * points - 3.0
    ring = [5, 6, 10, 9]  # counter-clockwise from 225 degrees
    square = [[-3, -3], [3, -3], [3, 3], [-3, 3]]
    sides = [segment(a, b) for a, b in zip(square, square[1:] + square[:1], strict=True)]
    circle = [quarter((0, 0), 1.0, 225.0 + 90.0 * i) for i in range(4)]
    curves = joined_curves([sides, circle], [True, True])
    curve, t = np.full(16, -1), np.zeros(16)
    around = [0, 1, 2, 3, 7, 11, 15, 14, 13, 12, 8, 4]
    curve[around], t[around] = 0, 2.0 * np.arange(12)
    curve[ring], t[ring] = 1, curves.start[4:]
    boundary = MeshBoundary(
        curves,
        loops=(0,),
        interfaces=(Interface(1, 1, 0),),
        region_names=("plate", "insert"),
        pieces=(
            tuple(CurvePiece(6.0 * i, 6.0 * i + 6.0, "line", f"side {i}") for i in range(4)),
            (CurvePiece(0.0, float(curves.stop[-1]), "arc", "rim", {"radius": 1.0}),),
        ),
    )
    regions = np.zeros(9, int)
    regions[4] = 1
    return HalfEdgeMesh.from_elements(
        points, quads, boundary=boundary, seats=(curve, t), regions=regions
    )


def test_a_mesh_of_points_alone_has_its_boundary_as_curve():
    points, quads = grid(3, 2)
    mesh = HalfEdgeMesh.from_elements(points, quads)
    info = mesh.boundary_info
    assert (info.loops, info.interfaces, info.region_names) == ((0,), (), ("",))
    assert info.lengths().tolist() == [10.0]
    # straight sides are one span each
    assert info.curves.start.tolist() == [0.0, 3.0, 5.0, 8.0]
    assert mesh.parameters()[[0, 1, 2, 3, 7, 11]].tolist() == [0, 1, 2, 3, 4, 5]
    assert mesh.curve_ids()[5] == -1 and mesh.curve_of(7) == 0 and mesh.parameter_of(7) == 4.0
    assert [one.kind for one in info.pieces[0]] == ["polyline"]
    assert not mesh.off_curve().any()
    mesh.validate()


def test_a_boundary_edge_is_halved_on_its_curve():
    mesh = plate_with_insert()
    mesh.validate()
    edit = mesh.apply("global_split", mesh.halfedge(2, 6))
    new = [v for v in edit.new_vertices if mesh.curve_of(v) == 1]
    assert new
    radius = np.linalg.norm(mesh.points[new], axis=1)
    assert np.abs(radius - 1.0).max() < 1e-15
    mesh.validate()
    mesh.undo()
    mesh.validate()


def test_regions_have_the_areas_of_their_curves():
    mesh = plate_with_insert()
    areas = region_areas(mesh)
    assert np.allclose(areas, [36.0 - np.pi, np.pi], rtol=0, atol=1e-13)
    assert mesh.region_names == ("plate", "insert") and mesh.regions().tolist().count(1) == 1


def test_corners_and_desired_degrees_come_from_the_tangents():
    mesh = plate_with_insert()
    assert np.flatnonzero(mesh.geometric()).tolist() == [0, 3, 12, 15]
    assert mesh.desired()[[0, 1, 5, 6]].tolist() == [2, 3, 4, 4]
    # the one quad of the insert has corners of 180 degrees: no valid mesh has s = 0
    assert (mesh.score, mesh.optimum) == (0, 8)


def test_an_interface_edge_is_neither_flipped_nor_split_along():
    mesh = plate_with_insert()
    h = mesh.halfedge(5, 6)
    for operation in ("flip_left", "flip_right", "split", "global_split"):
        verdict = mesh.check(operation, h)
        assert not verdict and "5-6 lies on the interface of two regions" in verdict.reason
    assert "boundary or an interface" in mesh.check("collapse", mesh.halfedge(1, 2)).reason


def annulus(sectors=12):
    """Two rings of quads, each a region of its own; vertex i of circle r has the id 12 r + i."""
    angle = 2.0 * np.pi * np.arange(sectors) / sectors
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.concatenate([circle, 2.0 * circle, 3.0 * circle])
    i = np.arange(sectors)
    ring = np.column_stack([i, i + sectors, (i + 1) % sectors + sectors, (i + 1) % sectors])
    quads = np.concatenate([ring, ring + sectors])
    return HalfEdgeMesh.from_elements(
        points, quads, np.zeros(len(points), bool), regions=np.repeat([0, 1], sectors)
    )


def test_a_line_on_an_interface_is_kept_and_one_across_is_deleted():
    rings = annulus()
    assert rings.interfaces == (Interface(2, 0, 1),)
    assert "part of the line" in rings.check("cleanup", rings.halfedge(12, 13)).reason
    rings.apply("cleanup", rings.halfedge(0, 12))
    rings.validate()
    points, quads = grid(2, 2)
    halves = HalfEdgeMesh.from_elements(points, quads, regions=[0, 1, 0, 1])
    assert halves.check("cleanup", halves.halfedge(3, 4))
    halves.apply("cleanup", halves.halfedge(3, 4))
    assert halves.interfaces[0][1:3] == (0, 1) and halves.n_elements == 2
    halves.validate()


def test_vertices_merge_along_an_interface():
    points, quads = grid(2, 3)
    corners = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    mesh = HalfEdgeMesh.from_elements(points, corners, regions=[0, 1] * 6)
    (interface,) = mesh.interfaces
    assert {interface.start, interface.end} == {1, 10}
    edit = mesh.apply("split", mesh.halfedge(4, 7))
    (v,) = edit.new_vertices
    assert mesh.points[v].tolist() == [1.0, 1.5, 0.0] and mesh.desired()[v] == 6
    assert mesh.curve_of(v) == interface.curve and mesh.parameter_of(v) == 1.5
    mesh.apply("collapse", mesh.halfedge(4, v))
    mesh.apply("collapse", mesh.halfedge(4, 7))
    mesh.validate()
    assert "geometric" not in mesh.check("collapse", mesh.halfedge(1, 4)).reason
    mesh.apply("collapse", mesh.halfedge(1, 4))
    mesh.validate()


def test_interfaces_end_at_geometric_junctions_with_summed_degrees():
    """Two regions on the right of a third: they meet in the middle."""
    points, quads = grid(2, 2)
    mesh = HalfEdgeMesh.from_elements(points, quads, regions=[0, 1, 0, 2])
    assert len(mesh.interfaces) == 3
    assert {v for one in mesh.interfaces for v in one[3:]} == {1, 4, 5, 7}
    assert mesh.geometric()[[1, 4, 5, 7]].all()
    # 180 + 90 + 90 degrees in the middle, 90 + 90 on the boundary
    assert mesh.desired()[[4, 1, 5, 7]].tolist() == [4, 3, 3, 3]
    mesh.validate()
    assert mesh.junctions() == {1, 4, 5, 7}
    with pytest.raises(MeshError, match="must stay geometric"):
        mesh.set_geometric(4, False)
    # a slanted interface: 51 and 129 degrees need one element each
    points[1] = [0.2, 0.0]
    slanted = HalfEdgeMesh.from_elements(points, quads, regions=[0, 1, 0, 2])
    assert slanted.desired()[1] == 1 + 1 + 1


def test_interfaces_with_the_same_ends_are_cut_apart():
    """A lens between two others: both interfaces of the same regions have the same ends."""
    points, quads = grid(4, 3)
    regions = np.zeros(12, int)
    regions[[1, 2, 9, 10]] = 1
    mesh = HalfEdgeMesh.from_elements(points, quads, regions=regions)
    keys = [tuple(sorted(one[3:])) for one in mesh.interfaces if one.start >= 0]
    assert len(set(keys)) == len(keys)
    mesh.validate()


def test_moved_vertices_slide_along_their_curve():
    mesh = plate_with_insert()
    mesh.move([5], np.array([[-0.8, -0.7, 0.0]]))
    t = mesh.parameter_of(5)
    assert 0.0 < t < mesh.parameter_of(6) or t > mesh.parameter_of(9)
    there = np.array([-0.8, -0.7]) / np.hypot(0.8, 0.7)
    assert mesh.off_curve()[5] == pytest.approx(abs(np.hypot(0.8, 0.7) - 1.0), abs=1e-12)
    mesh.move([5], np.array([[*there, 0.0]]))
    assert mesh.off_curve()[5] < 1e-12
    mesh.validate()
    # never past a neighbour on the curve
    mesh.move([5], np.array([[1.0, 1.0, 0.0]]))
    mesh.validate()
    while mesh.undo():
        mesh.validate()
    assert mesh.parameter_of(5) == 0.0


def test_a_geometric_vertex_keeps_its_point_of_the_curve():
    points, quads = grid(2, 2)
    mesh = HalfEdgeMesh.from_elements(points, quads)
    mesh.move([2], np.array([[2.5, -0.5, 0.0]]))
    assert mesh.parameter_of(2) == 2.0 and mesh.off_curve()[2] == pytest.approx(np.sqrt(0.5))
    # a new vertex is off by half of it
    tri = HalfEdgeMesh.from_elements(points[[0, 2, 8, 6]], [[0, 1, 2], [0, 2, 3]])
    tri.move([1], np.array([[2.5, -0.5, 0.0]]))
    (v,) = tri.apply("split", tri.halfedge(0, 1)).new_vertices
    assert tri.points[v].tolist() == [1.25, -0.25, 0.0] and tri.parameter_of(v) == 1.0


def test_parameters_are_taken_with_positions():
    mesh = plate_with_insert()
    t = 0.5 * mesh.parameter_of(6)
    mesh.move([5], mesh.points[[5]], [t])
    assert mesh.parameter_of(5) == t
    mesh.undo()
    assert mesh.parameter_of(5) == 0.0
    with pytest.raises(MeshError, match="beyond the ends"):
        mesh.move([5], mesh.points[[5]], [1e9])
    with pytest.raises(MeshError, match="parameters must be"):
        mesh.move([5], mesh.points[[5]], [0.0, 1.0])


def test_copies_share_curves_and_compaction_keeps_them():
    points, quads = grid(2, 4)
    mesh = HalfEdgeMesh.from_elements(points, quads, regions=[0, 1] * 4)
    other = mesh.copy(history=True)
    assert other.boundary_info is mesh.boundary_info
    assert other.arrays.curves is mesh.arrays.curves
    mesh.apply("cleanup", mesh.halfedge(3, 4))
    vertex_map, _ = mesh.compact()
    mesh.validate()
    assert mesh.arrays.curves is other.arrays.curves
    assert mesh.interfaces[0].end == vertex_map[other.interfaces[0].end]
    other.validate()


def test_wrong_seats_are_refused():
    mesh = plate_with_insert()
    info, curve, t = mesh.boundary_info, mesh.curve_ids(), mesh.parameters()

    def made(curve, t, regions=None):
        regions = mesh.regions() if regions is None else regions
        return HalfEdgeMesh.from_elements(
            mesh.points, mesh.elements(), boundary=info, seats=(curve, t), regions=regions
        )

    made(curve, t).validate()
    swapped = t.copy()
    swapped[[1, 2]] = t[[2, 1]]
    for wrong, words in (
        ((np.full(16, -1), np.zeros(16)), "no edge on one"),
        ((curve, swapped), "follow each other"),
        ((curve, t + 100.0), "beyond the ends"),
        ((curve + 1, t), "does not exist|no curve|interface"),
        ((curve[:3], t), "for each point"),
        ((curve, t, np.zeros(9, int)), "no edge on one"),
        ((curve, t, np.full(9, 7)), "does not exist"),
    ):
        with pytest.raises(MeshError, match=words):
            made(*wrong)
    with pytest.raises(MeshError, match="seats"):
        HalfEdgeMesh.from_elements(mesh.points, mesh.elements(), boundary=info)
    with pytest.raises(MeshError, match="regions"):
        HalfEdgeMesh.from_elements(mesh.points, mesh.elements(), regions=[0.5] * 9)


def test_coinciding_boundary_points_do_no_harm():
    points = np.zeros((4, 2))
    mesh = HalfEdgeMesh.from_elements(points, [[0, 1, 2], [0, 2, 3]])
    mesh.apply("split", mesh.halfedge(0, 1))
    assert np.isfinite(mesh.points).all()
    mesh.validate()
